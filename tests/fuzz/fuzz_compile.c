/* links: compile core */
/* Any bytes as a level that is compiled: whatever the importer lets through becomes a map that enf_map_check finds sound (the compiler
 * asks it), or is no level (ENF_ERROR_LEVEL). */
#include "compile/compile.h"
#include "compile/source.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "harness/harness.h"

/* The importer lets it through: then nothing but the level itself may be to blame. */
static bool is_sound_file(const char *path) {
    EnfSource source;
    EnfDiagnosis diagnosis = {0};
    EnfError error = {0};
    bool sound = enf_source_import(&source, path, &diagnosis, &error) == ENF_OK;
    if (sound) {
        enf_source_free(&source);
    }
    enf_diagnosis_free(&diagnosis);
    return sound;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bool binary = size >= 4 && memcmp(data, "glTF", 4) == 0;
    const char *path = enf_test_temp_path(binary ? "level.glb" : "level.gltf");
    enf_test_write_file(path, data, size);
    EnfCompileDef def = enf_compile_def_default();
    EnfCompileReport report;
    EnfError error = {0};
    def.level = path;
    EnfResult result = enf_compile(&def, &report, &error);
    bool named = result == ENF_OK || error.message[0];
    if (!named || (result != ENF_OK && result != ENF_ERROR_LEVEL && is_sound_file(path))) {
        __builtin_trap(); /* refused without a word, or not sound by the compiler's own fault */
    }
    enf_compile_report_free(&report);
    return 0;
}

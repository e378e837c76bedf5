/* links: compile core */
/* Any bytes as a level: refused with a message, or a source whose numbers can be walked. The importer reads files, so the
 * bytes are written to one; as .glb if they claim to be one, else as .gltf. */
#include "compile/diagnosis.h"
#include "compile/source.h"

#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "harness/harness.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    bool binary = size >= 4 && memcmp(data, "glTF", 4) == 0;
    const char *path = enf_test_temp_path(binary ? "level.glb" : "level.gltf");
    enf_test_write_file(path, data, size);
    EnfSource source;
    EnfDiagnosis diagnosis = {0};
    EnfError error = {0};
    EnfResult result = enf_source_import(&source, path, &diagnosis, &error);
    if (result == ENF_OK) {
        enf_source_free(&source);
    } else if (!error.message[0]) {
        __builtin_trap(); /* refused without a word */
    }
    enf_diagnosis_free(&diagnosis);
    return 0;
}

/* A level project: a JSON file that names a level and the settings to compile it with. */
#ifndef ENFILADE_COMPILE_PROJECT_H
#define ENFILADE_COMPILE_PROJECT_H

#include "compile/layout.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Project files larger than this are refused. */
#define ENF_PROJECT_SIZE_MAX ((size_t)1 << 20)

#define ENF_PROJECT_WARNINGS 16

typedef struct EnfLevelProject {
    char *source; /**< path of the level: as written if absolute, else beside the project file; NULL if not named */
    char *output; /**< path of the map, likewise; NULL if not named */
    EnfCompileSettings settings;
    char *warnings[ENF_PROJECT_WARNINGS]; /**< sentences about unknown keys; further ones are left out */
    uint32_t warning_count;
} EnfLevelProject;

/** {"source": "hall.glb", "output": "hall.enfmap", "settings": {"max_image": 1024, …}}; every key may be absent. Unknown keys are
 *  warned of; wrong types and values out of range are errors with a byte offset. Free with enf_level_project_free. */
EnfResult enf_level_project_read(EnfLevelProject *project, const char *path, EnfError *error);
void enf_level_project_free(EnfLevelProject *project);

/** The hash of settings, 0 for the defaults. */
uint64_t enf_settings_hash(const EnfCompileSettings *settings);

#ifdef __cplusplus
}
#endif
#endif

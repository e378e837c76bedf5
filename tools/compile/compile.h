/* The compiler as a function: level file → EnfMap file, with a report. enfc is its command line. */
#ifndef ENFILADE_COMPILE_COMPILE_H
#define ENFILADE_COMPILE_COMPILE_H

#include "compile/diagnosis.h"
#include "compile/layout.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct EnfCompileReport {
    uint32_t cells, portals, half_portals; /**< portals: openings as authored (twins count once) */
    uint64_t triangles, triangles_stored;  /**< of the level (instanced); after dropping and splitting */
    uint32_t clusters, kd_nodes, lights;
    uint32_t movers, meshes; /**< what moves or only collides; the meshes that they share */
    uint64_t bytes;
    double seconds_import, seconds_cells, seconds_kd, seconds_write;
    EnfDiagnosis diagnosis;
} EnfCompileReport;

typedef void EnfProgressFn(void *user, const char *stage, double fraction);

typedef struct EnfCompileDef {
    const char *level;   /**< .glb or .gltf */
    const char *output;  /**< .enfmap, or NULL: compile and check only */
    const char *plan;    /**< .svg, or NULL */
    const char *overlay; /**< .glb, or NULL */
    EnfCompileSettings settings;
    EnfProgressFn *progress; /**< or NULL */
    void *user;
} EnfCompileDef;
EnfCompileDef enf_compile_def_default(void);

/** Compiles. `report` is filled as far as it got, also on failure; free with enf_compile_report_free. */
EnfResult enf_compile(const EnfCompileDef *def, EnfCompileReport *report, EnfError *error);
void enf_compile_report_free(EnfCompileReport *report);

#ifdef __cplusplus
}
#endif
#endif

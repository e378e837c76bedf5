/* The compiler as a function: import → layout → soup → regions → clusters → trees and lights → check → write. */
#include "compile/compile.h"

#include "compile/assemble.h"
#include "compile/overlay_glb.h"
#include "compile/plan_svg.h"
#include "compile/project.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

/* Everything between the level and the map. */
typedef struct Compiler {
    const EnfCompileDef *def;
    EnfCompileReport *report;
    EnfError *error;
    EnfSource source;
    EnfLayout layout;
    EnfSoup soup;
    EnfReach *reach;
    EnfClusters clusters;
    EnfAssembly assembly;
    bool has_source, has_layout, has_soup;
} Compiler;

EnfCompileDef enf_compile_def_default(void) {
    EnfCompileDef def;
    memset(&def, 0, sizeof def);
    def.settings = enf_compile_settings_default();
    return def;
}

/* Seconds of a clock that never goes back; for the report alone. */
static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static void tell(const Compiler *compiler, const char *stage, double fraction) {
    if (compiler->def->progress) {
        compiler->def->progress(compiler->def->user, stage, fraction);
    }
}

/* ---- stages ----------------------------------------------------------------------------------------------------- */

static EnfResult import(Compiler *compiler) {
    double start = now();
    tell(compiler, "import", 0);
    EnfResult result = enf_source_import(&compiler->source, compiler->def->level, &compiler->report->diagnosis,
                                         compiler->error);
    compiler->has_source = result == ENF_OK;
    compiler->report->seconds_import = now() - start;
    return result;
}

/* Triangles of the level that are drawn, as authored. */
static uint64_t drawn_triangles(const Compiler *compiler) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < compiler->soup.triangle_count; i++) {
        count += !(compiler->source.materials[compiler->soup.triangles[i].material].flags & ENF_MATERIAL_NODRAW);
    }
    return count;
}

static void count_layout(Compiler *compiler) {
    EnfCompileReport *report = compiler->report;
    const EnfLayout *layout = &compiler->layout;
    report->half_portals = layout->portal_count;
    for (uint32_t i = 0; i < layout->cell_count; i++) {
        report->cells += !(layout->cells[i].flags & ENF_CELL_OUTSIDE);
    }
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        const EnfLayoutPortal *portal = &layout->portals[i];
        bool opening = !(portal->flags & ENF_PORTAL_OVERLAP);
        report->portals += opening && (portal->twin == ENF_NONE || portal->twin >= i);
    }
}

static EnfResult divide(Compiler *compiler) {
    double start = now();
    EnfDiagnosis *diagnosis = &compiler->report->diagnosis;
    const EnfCompileSettings *settings = &compiler->def->settings;
    tell(compiler, "cells", 0.2);
    EnfResult result = enf_layout_build(&compiler->layout, &compiler->source, settings, diagnosis, compiler->error);
    compiler->has_layout = result == ENF_OK;
    if (result == ENF_OK) {
        tell(compiler, "geometry", 0.3);
        result = enf_soup_build(&compiler->soup, &compiler->source, &compiler->layout, settings, diagnosis, compiler->error);
        compiler->has_soup = result == ENF_OK;
    }
    if (result == ENF_OK && compiler->soup.triangle_count == 0) {
        enf_diagnose(diagnosis, ENF_DIAGNOSIS_NO_GEOMETRY, "", "the level has no triangle to draw");
        result = enf_error_set(compiler->error, ENF_ERROR_LEVEL, UINT64_MAX, "the level has no triangle to draw");
    }
    if (result == ENF_OK) {
        tell(compiler, "regions", 0.5);
        result = enf_regions_assign(&compiler->layout, &compiler->soup, &compiler->source, settings, diagnosis);
        if (result != ENF_OK) {
            enf_error_set(compiler->error, result, UINT64_MAX, "%s while assigning triangles to cells",
                          enf_result_text(result));
        }
    }
    compiler->report->seconds_cells = now() - start;
    return result;
}

static EnfResult assemble(Compiler *compiler) {
    double start = now();
    EnfCompileReport *report = compiler->report;
    tell(compiler, "clusters", 0.6);
    EnfResult result = enf_clusters_build(&compiler->clusters, &compiler->soup, &compiler->layout, compiler->error);
    if (result == ENF_OK) {
        compiler->reach = enf_reach_create(&compiler->layout, &compiler->soup);
        if (!compiler->reach) {
            result = enf_error_set(compiler->error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the cells' shells");
        }
    }
    if (result == ENF_OK) {
        tell(compiler, "trees and lights", 0.7);
        EnfAssemblyParts parts = {&compiler->source,   &compiler->layout,        &compiler->soup,   compiler->reach,
                                  &compiler->clusters, &compiler->def->settings, &report->diagnosis};
        result = enf_assemble(&compiler->assembly, &parts, compiler->error);
        enf_reach_report(compiler->reach, &report->diagnosis);
    }
    report->clusters = compiler->assembly.clusters.count;
    report->kd_nodes = compiler->assembly.kd_nodes.count;
    report->lights = compiler->assembly.lights.count;
    report->movers = compiler->assembly.movers.count;
    report->meshes = compiler->assembly.meshes.count;
    report->seconds_kd = now() - start;
    return result;
}

/* What the map's file will be known by: the level's bytes and the settings. */
static uint64_t source_hash(const Compiler *compiler) {
    uint64_t settings = enf_settings_hash(&compiler->def->settings);
    return settings ? enf_hash64(compiler->source.hash, &settings, sizeof settings) : compiler->source.hash;
}

static EnfResult check_and_write(Compiler *compiler) {
    double start = now();
    const char *output = compiler->def->output;
    EnfMap map = enf_assembly_map(&compiler->assembly, source_hash(compiler));
    tell(compiler, "check", 0.9);
    EnfResult result = enf_map_check(&map, compiler->error);
    if (result == ENF_OK && output) {
        tell(compiler, "write", 0.95);
        result = enf_map_write(&map, output, compiler->error);
        struct stat status;
        if (result == ENF_OK && stat(output, &status) == 0) {
            compiler->report->bytes = (uint64_t)status.st_size;
        }
    }
    compiler->report->seconds_write = now() - start;
    return result;
}

/* ---- pictures of the level -------------------------------------------------------------------------------------- */

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Plan and overlay explain a level, above all one that fails: they are written as soon as there is a layout to show. */
static EnfResult draw(Compiler *compiler) {
    const EnfCompileDef *def = compiler->def;
    EnfResult result = ENF_OK;
    if (def->plan && compiler->has_soup) {
        result = enf_plan_write(def->plan, file_name(def->level), &compiler->layout, &compiler->soup, compiler->error);
    }
    if (def->overlay && compiler->has_layout && result == ENF_OK) {
        result = enf_overlay_write(def->overlay, &compiler->layout, &compiler->report->diagnosis, compiler->error);
    }
    return result;
}

/* ---- all -------------------------------------------------------------------------------------------------------- */

static void count_all(Compiler *compiler) {
    EnfCompileReport *report = compiler->report;
    if (compiler->has_layout) {
        count_layout(compiler);
    }
    if (compiler->has_soup) {
        report->triangles_stored = drawn_triangles(compiler);
        report->triangles = compiler->soup.source_triangle_count;
    }
}

static void release(Compiler *compiler) {
    enf_assembly_free(&compiler->assembly);
    enf_clusters_free(&compiler->clusters);
    if (compiler->reach) {
        enf_reach_destroy(compiler->reach);
    }
    if (compiler->has_soup) {
        enf_soup_free(&compiler->soup);
    }
    if (compiler->has_layout) {
        enf_layout_free(&compiler->layout);
    }
    if (compiler->has_source) {
        enf_source_free(&compiler->source);
    }
}

EnfResult enf_compile(const EnfCompileDef *def, EnfCompileReport *report, EnfError *error) {
    ENF_ASSERT(def && def->level && report);
    Compiler compiler;
    memset(&compiler, 0, sizeof compiler);
    memset(report, 0, sizeof *report);
    compiler.def = def;
    compiler.report = report;
    compiler.error = error;
    EnfResult result = import(&compiler);
    if (result == ENF_OK) {
        result = divide(&compiler);
    }
    if (result == ENF_OK) {
        result = assemble(&compiler);
    }
    if (result == ENF_OK) {
        result = check_and_write(&compiler);
    }
    count_all(&compiler);
    EnfError own;
    compiler.error = result == ENF_OK ? error : &own; /* the first error is the one to tell */
    EnfResult drawn = draw(&compiler);
    release(&compiler);
    tell(&compiler, "done", 1);
    if (result == ENF_OK) {
        result = drawn;
    }
    return result == ENF_OK ? ENF_OK : enf_error_file(error, result, def->level);
}

void enf_compile_report_free(EnfCompileReport *report) {
    enf_diagnosis_free(&report->diagnosis);
    memset(report, 0, sizeof *report);
}

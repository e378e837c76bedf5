/* Compile time against size: grid levels of growing size, each compiled whole (import, cells, kd, write). A near-linear cost shows as
 * a time a triangle that stays level; the hash of a row is that of the map, so a faster compiler must still make the same one. */
#include "compile/compile.h"
#include "enfbench/bench.h"
#include "scenes/grid_level.h"

#include <enfilade/map.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct Files {
    char folder[200], level[256], map[256];
} Files;

/* Rooms are laid out as square as can be, on storeys of at most 64 × 64. */
static EnfGridLevel layout_for(uint32_t rooms, uint32_t tables) {
    EnfGridLevel level = {1, 1, 1, tables, true, true};
    while (level.rooms_x < 64 && level.rooms_x * level.rooms_x < rooms) {
        level.rooms_x++;
    }
    while (level.rooms_z < 64 && level.rooms_x * level.rooms_z < rooms) {
        level.rooms_z++;
    }
    uint32_t storey = level.rooms_x * level.rooms_z;
    level.storeys = (rooms + storey - 1) / storey;
    return level;
}

static bool fail(const char *what, const EnfError *error) {
    fprintf(stderr, "enfbench: compile: %s: %s\n", what, error->message);
    return false;
}

static bool compile_once(const Files *files, EnfCompileReport *report) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfCompileDef def = enf_compile_def_default();
    def.level = files->level;
    def.output = files->map;
    if (enf_compile(&def, report, &error) != ENF_OK) {
        enf_compile_report_free(report);
        return fail(files->level, &error);
    }
    return true;
}

/* The content hash of the map, and what it says of itself. */
static bool read_map(const Files *files, BenchRow *row) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfMap map;
    if (enf_map_read(&map, files->map, NULL, &error) != ENF_OK) {
        return fail(files->map, &error);
    }
    row->hash = map.hash;
    row->objects = (double)map.clusters_count;
    enf_map_free(&map);
    return true;
}

static bool measure(BenchRun *run, const Files *files, const EnfGridLevel *level, uint32_t repeat) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfGridLevelCounts counts;
    double times[64];
    if (enf_grid_level_write(level, files->level, &counts, &error) != ENF_OK) {
        return fail(files->level, &error);
    }
    char scene[64];
    snprintf(scene, sizeof scene, "grid %ux%ux%u", level->rooms_x, level->rooms_z, level->storeys);
    BenchRow row = bench_row("compile", scene, "enfc");
    for (uint32_t r = 0; r < repeat; r++) {
        EnfCompileReport report;
        bench_progress(run, "compile: %u triangles, run %u of %u", counts.triangles, r + 1, repeat);
        double start = bench_now_us();
        if (!compile_once(files, &report)) {
            return false;
        }
        times[r] = bench_now_us() - start;
        snprintf(row.params, sizeof row.params, "triangles=%u import=%.2fs cells=%.2fs kd=%.2fs write=%.2fs", counts.triangles,
                 report.seconds_import, report.seconds_cells, report.seconds_kd, report.seconds_write);
        row.cells = (double)report.cells;
        row.portals = (double)report.portals;
        row.nodes = (double)report.kd_nodes;
        /* The error of a compiler: cells, portals or triangles that went missing. */
        row.lost_objects = (double)(counts.cells - report.cells) + (double)(counts.portals - report.portals) +
                           (double)(counts.triangles - report.triangles);
        enf_compile_report_free(&report);
    }
    row.frames = repeat;
    row.p99_us = bench_quantile(times, repeat, 0.99);
    row.median_us = bench_quantile(times, repeat, 0.5);
    bool ok = read_map(files, &row);
    bench_rows_add(&run->rows, &row);
    return ok;
}

static bool make_files(Files *files) {
    if (!bench_temporary_folder(files->folder, sizeof files->folder)) {
        return false;
    }
    snprintf(files->level, sizeof files->level, "%s/level.glb", files->folder);
    snprintf(files->map, sizeof files->map, "%s/level.enfmap", files->folder);
    return true;
}

bool bench_compile(BenchRun *run) {
    uint32_t sizes[64];
    uint32_t size_count = bench_knob_list(&run->knobs, "rooms", "100,500,2000,7000", 100000, sizes, 64);
    uint32_t tables = bench_knob_whole(&run->knobs, "tables", 1, 0, 100);
    uint32_t repeat = bench_knob_whole(&run->knobs, "repeat", 1, 1, 64);
    Files files;
    if (!make_files(&files)) {
        return false;
    }
    bool ok = true;
    for (uint32_t n = 0; n < size_count && ok; n++) {
        EnfGridLevel level = layout_for(sizes[n], tables);
        ok = measure(run, &files, &level, repeat);
    }
    remove(files.level);
    remove(files.map);
    rmdir(files.folder);
    return ok;
}

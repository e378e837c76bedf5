/* The compiler from end to end: levels made here and real ones, the command line, its reports, determinism. */
#include "compile/compile.h"
#include "compile/project.h"
#include "harness/program.h"
#include "scenes/grid_level.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const EnfGridLevel small_level = {3, 2, 2, 1, true, true};

/* Writes a grid level into the temporary folder; returns its path. */
static const char *write_level(const EnfGridLevel *level, const char *name, EnfGridLevelCounts *counts) {
    EnfError error;
    const char *path = enf_test_temp_path(name);
    if (enf_grid_level_write(level, path, counts, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    return path;
}

static EnfResult compile(const char *level, const char *output, EnfCompileReport *report, EnfError *error) {
    EnfCompileDef def = enf_compile_def_default();
    def.level = level;
    def.output = output;
    memset(error, 0, sizeof *error);
    return enf_compile(&def, report, error);
}

static void read_map(EnfMap *map, const char *path) {
    EnfError error;
    if (enf_map_read(map, path, NULL, &error) != ENF_OK) {
        fail_msg("%s: %s", path, error.message);
    }
}

static void assert_same_files(const char *a, const char *b) {
    size_t a_size, b_size;
    uint8_t *a_data = enf_test_read_file(a, &a_size), *b_data = enf_test_read_file(b, &b_size);
    assert_int_equal(a_size, b_size);
    assert_memory_equal(a_data, b_data, a_size);
    free(a_data);
    free(b_data);
}

/* ---- the library ------------------------------------------------------------------------------------------------ */

static void a_grid_of_rooms(void **state) {
    (void)state;
    EnfGridLevelCounts counts;
    EnfCompileReport report;
    EnfError error;
    EnfMap map;
    const char *level = write_level(&small_level, "grid.glb", &counts), *output = enf_test_temp_path("grid.enfmap");
    if (compile(level, output, &report, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(report.cells, counts.cells);
    assert_int_equal(report.portals, counts.portals);
    assert_int_equal(report.half_portals, 2 * counts.portals);
    assert_int_equal(report.triangles, counts.triangles);
    assert_true(report.triangles_stored >= report.triangles);
    assert_int_equal(report.lights, counts.cells);
    assert_int_equal(report.diagnosis.count, 0);
    read_map(&map, output);
    assert_int_equal(map.cells_count, counts.cells);
    assert_int_equal(map.clusters_count, report.clusters);
    assert_int_equal(map.kd_nodes_count, report.kd_nodes);
    assert_int_equal(map.file.size, report.bytes);
    for (uint32_t cell = 0; cell < map.cells_count; cell++) {
        assert_true(map.cells[cell].light_count >= 1);
    }
    for (uint32_t room = 0; room < counts.cells; room++) {
        char name[32];
        snprintf(name, sizeof name, "r%05u-room", room);
        uint32_t cell = enf_map_find_cell(&map, name);
        assert_int_not_equal(cell, ENF_NONE);
        EnfVec3 inside = {ENF_GRID_ROOM * (room % 3) + 0.7, ENF_GRID_STOREY * (room / 6) + 1.5,
                          ENF_GRID_ROOM * (room / 3 % 2) + 0.9};
        assert_int_equal(enf_map_locate(&map, inside), cell);
    }
    enf_map_free(&map);
    enf_compile_report_free(&report);
}

/* No room in the level: one cell holds it all, and the compiler says so. */
static void a_level_without_rooms(void **state) {
    (void)state;
    EnfGridLevel plain = small_level;
    EnfGridLevelCounts counts;
    EnfCompileReport report;
    EnfError error;
    plain.named = false;
    const char *level = write_level(&plain, "plain.glb", &counts);
    assert_int_equal(compile(level, NULL, &report, &error), ENF_OK);
    assert_int_equal(report.cells, 1);
    assert_int_equal(report.portals, 0);
    bool told = false;
    for (uint32_t i = 0; i < report.diagnosis.count; i++) {
        told = told || report.diagnosis.findings[i].code == ENF_DIAGNOSIS_NO_ROOMS;
    }
    assert_true(told);
    enf_compile_report_free(&report);
}

static void same_level_same_bytes(void **state) {
    (void)state;
    EnfCompileReport report;
    EnfError error;
    const char *level = write_level(&small_level, "grid.glb", NULL);
    for (int i = 0; i < 2; i++) {
        EnfCompileDef def = enf_compile_def_default();
        def.level = level;
        def.output = enf_test_temp_path(i ? "b.enfmap" : "a.enfmap");
        def.plan = enf_test_temp_path(i ? "b.svg" : "a.svg");
        def.overlay = enf_test_temp_path(i ? "b.glb" : "a.glb");
        assert_int_equal(enf_compile(&def, &report, &error), ENF_OK);
        enf_compile_report_free(&report);
    }
    assert_same_files(enf_test_temp_path("a.enfmap"), enf_test_temp_path("b.enfmap"));
    assert_same_files(enf_test_temp_path("a.svg"), enf_test_temp_path("b.svg"));
    assert_same_files(enf_test_temp_path("a.glb"), enf_test_temp_path("b.glb"));
}

/* The overlay is a level like any other: the importer reads it. */
static void the_overlay_is_gltf(void **state) {
    (void)state;
    EnfCompileReport report;
    EnfError error;
    EnfSource source;
    EnfGridLevelCounts counts;
    EnfCompileDef def = enf_compile_def_default();
    EnfDiagnosis diagnosis = {NULL, 0, 0};
    def.level = write_level(&small_level, "grid.glb", &counts);
    def.overlay = enf_test_temp_path("overlay.glb");
    assert_int_equal(enf_compile(&def, &report, &error), ENF_OK);
    if (enf_source_import(&source, def.overlay, &diagnosis, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(source.node_count, counts.portals + 2);
    assert_int_equal(source.triangle_count, 2 * counts.portals);
    enf_source_free(&source);
    enf_diagnosis_free(&diagnosis);
    enf_compile_report_free(&report);
}

static void settings_change_the_map(void **state) {
    (void)state;
    EnfCompileReport report;
    EnfError error;
    EnfMap map;
    EnfCompileDef def = enf_compile_def_default();
    def.level = write_level(&small_level, "grid.glb", NULL);
    def.output = enf_test_temp_path("settings.enfmap");
    uint64_t hashes[2];
    uint64_t stored[2];
    for (int i = 0; i < 2; i++) {
        def.settings.weld_tjunctions = i == 0;
        assert_int_equal(enf_compile(&def, &report, &error), ENF_OK);
        read_map(&map, def.output);
        hashes[i] = map.source_hash;
        stored[i] = report.triangles_stored;
        enf_map_free(&map);
        enf_compile_report_free(&report);
    }
    assert_true(hashes[0] != hashes[1]);
    assert_true(stored[0] > stored[1]);
    EnfCompileSettings standard = enf_compile_settings_default();
    assert_int_equal(enf_settings_hash(&standard), 0);
}

/* What fails says why, and leaves an older map alone. */
static void failure_leaves_the_old_map(void **state) {
    (void)state;
    static const char no_mesh[] = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
                                  "\"nodes\":[{\"name\":\"nothing\"}]}";
    EnfCompileReport report;
    EnfError error;
    const char *level = enf_test_temp_path("empty.gltf"), *output = enf_test_temp_path("old.enfmap");
    enf_test_write_file(level, no_mesh, sizeof no_mesh - 1);
    enf_test_write_file(output, "old", 3);
    assert_int_equal(compile(level, output, &report, &error), ENF_ERROR_LEVEL);
    assert_non_null(strstr(error.file, "empty.gltf"));
    assert_true(report.diagnosis.count > 0);
    enf_compile_report_free(&report);
    assert_int_not_equal(compile(enf_test_temp_path("absent.glb"), output, &report, &error), ENF_OK);
    assert_non_null(strstr(error.file, "absent.glb"));
    enf_compile_report_free(&report);
    size_t size;
    uint8_t *old = enf_test_read_file(output, &size);
    assert_int_equal(size, 3);
    assert_memory_equal(old, "old", 3);
    free(old);
}

/* ---- projects --------------------------------------------------------------------------------------------------- */

static EnfResult read_project(EnfLevelProject *project, const char *text, EnfError *error) {
    const char *path = enf_test_temp_path("project.json");
    enf_test_write_file(path, text, strlen(text));
    memset(error, 0, sizeof *error);
    return enf_level_project_read(project, path, error);
}

static void projects_set_and_warn(void **state) {
    (void)state;
    EnfLevelProject project;
    EnfError error;
    assert_int_equal(read_project(&project, "{}", &error), ENF_OK);
    assert_null(project.source);
    assert_int_equal(enf_settings_hash(&project.settings), 0);
    enf_level_project_free(&project);
    assert_int_equal(read_project(&project,
                                  "{\"source\": \"a/b.glb\", \"output\": \"/x.enfmap\", \"colour\": 1, \"settings\":"
                                  " {\"max_image\": 64, \"leak_gap\": 0.5, \"weld_tjunctions\": false, \"x\": []}}",
                                  &error),
                     ENF_OK);
    assert_string_equal(project.source, enf_test_temp_path("a/b.glb"));
    assert_string_equal(project.output, "/x.enfmap");
    assert_int_equal(project.settings.max_image, 64);
    assert_false(project.settings.weld_tjunctions);
    assert_true(project.settings.leak_gap == 0.5);
    assert_int_equal(project.warning_count, 2);
    assert_non_null(strstr(project.warnings[0], "colour"));
    enf_level_project_free(&project);
}

static void bad_projects_are_refused(void **state) {
    (void)state;
    static const char *const bad[] = {"",
                                      "[]",
                                      "{\"source\": 1}",
                                      "{\"source\": \"\"}",
                                      "{\"source\": \"a\\u0000b\"}",
                                      "{\"settings\": 3}",
                                      "{\"settings\": {\"max_image\": 0}}",
                                      "{\"settings\": {\"max_image\": 1.5}}",
                                      "{\"settings\": {\"max_image\": \"big\"}}",
                                      "{\"settings\": {\"leak_gap\": 1e999}}",
                                      "{\"settings\": {\"detect_leaks\": 1}}",
                                      "{\"settings\": {\"detect_leaks\": true}"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        EnfLevelProject project;
        EnfError error;
        assert_int_not_equal(read_project(&project, bad[i], &error), ENF_OK);
        assert_non_null(strstr(error.file, "project.json"));
        assert_true(error.message[0] != '\0');
    }
}

/* ---- the program ------------------------------------------------------------------------------------------------ */

/* Runs enfc in the temporary folder, so that names need no folder; fails the case unless it ends with `status`, and says `out` on
 * stdout and `err` on stderr. */
static void enfc(const char *arguments, int status, const char *out, const char *err) {
    EnfTestSaid said;
    int got = enf_test_program_in(enf_test_temp_folder(), "enfc", arguments, &said);
    if (got != status || !strstr(said.out, out) || !strstr(said.err, err)) {
        fail_msg("enfc %s: status %d, not %d with \"%s\" and \"%s\":\n%s%s", arguments, got, status, out, err, said.out,
                 said.err);
    }
    enf_test_said_free(&said);
}

static bool file_has(const char *name, const char *text) {
    size_t size;
    uint8_t *data = enf_test_read_file(enf_test_temp_path(name), &size);
    bool found = strstr((const char *)data, text) != NULL;
    free(data);
    return found;
}

static void the_program_compiles(void **state) {
    (void)state;
    write_level(&small_level, "level.glb", NULL);
    enfc("level.glb --json report.json --plan plan.svg --overlay diag.glb", 0, "cells", "");
    static const char *const keys[] = {"\"cells\": 12", "\"portals\"",    "\"triangles\"", "\"clusters\"",
                                       "\"kd_nodes\"",  "\"lights\": 12", "\"bytes\"",     "\"seconds\"",
                                       "\"import\"",    "\"kd\"",         "\"write\"",     "\"warnings\": []"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (!file_has("report.json", keys[i])) {
            fail_msg("the report lacks %s", keys[i]);
        }
    }
    assert_true(file_has("plan.svg", "</svg>"));
    assert_true(file_has("plan.svg", ">r00000</text>"));
    EnfMap map;
    read_map(&map, enf_test_temp_path("level.enfmap"));
    enf_map_free(&map);
    EnfTestSaid said;
    assert_int_equal(enf_test_program_in(enf_test_temp_folder(), "enfc", "level.glb -o other.enfmap --quiet", &said), 0);
    assert_string_equal(said.out, "");
    enf_test_said_free(&said);
    assert_same_files(enf_test_temp_path("level.enfmap"), enf_test_temp_path("other.enfmap"));
}

static void the_program_takes_projects(void **state) {
    (void)state;
    static const char text[] = "{\"source\": \"level.glb\", \"output\": \"made.enfmap\", \"tint\": 1}";
    write_level(&small_level, "level.glb", NULL);
    enf_test_write_file(enf_test_temp_path("p.json"), text, sizeof text - 1);
    enfc("p.json --quiet", 0, "", "warning: project: p.json: unknown key \"tint\"");
    EnfMap map;
    read_map(&map, enf_test_temp_path("made.enfmap"));
    enf_map_free(&map);
    enfc("--project p.json -o again.enfmap", 0, "", "");
    assert_same_files(enf_test_temp_path("made.enfmap"), enf_test_temp_path("again.enfmap"));
}

static void the_program_reports_failure(void **state) {
    (void)state;
    enf_test_write_file(enf_test_temp_path("bad.glb"), "glTF\2\0\0\0", 8);
    enfc("bad.glb --json bad.json", 1, "", "error: bad.glb: ");
    assert_true(file_has("bad.json", "\"error\": {"));
    assert_true(file_has("bad.json", "\"ok\": false"));
    enfc("bad.glb --nonsense", 2, "", "--nonsense");
    enfc("", 2, "", "");
    enfc("a.glb b.glb", 2, "", "");
    enfc("--help", 0, "--overlay", "");
    enfc("--version", 0, "enfc", "");
}

/* ---- real levels ------------------------------------------------------------------------------------------------ */

static void real_levels_compile(void **state) {
    (void)state;
    static const struct {
        const char *path;
        uint32_t cells, portals;
    } levels[] = {{"freedoom/E1M1_rooms.glb", 34, 61},  {"freedoom/E1M1_sector.glb", 131, 431},
                  {"freedoom/E3M8_rooms.glb", 39, 95},  {"freedoom/MAP01_rooms.glb", 41, 47},
                  {"freedoom/MAP26_rooms.glb", 51, 75}, {"buildings/duplex.glb", 32, 38}};
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
        const char *path = enf_test_data(levels[i].path);
        EnfCompileReport report;
        EnfError error;
        if (compile(path, enf_test_temp_path("real.enfmap"), &report, &error) != ENF_OK) {
            fail_msg("%s: %s", levels[i].path, error.message);
        }
        assert_int_equal(report.cells, levels[i].cells);
        assert_int_equal(report.portals, levels[i].portals);
        EnfMap map;
        read_map(&map, enf_test_temp_path("real.enfmap"));
        uint32_t spawns = 0;
        for (uint32_t e = 0; e < map.entities_count; e++) {
            bool spawn = map.entities[e].camera != ENF_NONE;
            spawns += spawn;
            assert_true(!spawn || map.entities[e].cell != ENF_NONE);
        }
        assert_true(spawns > 0);
        enf_map_free(&map);
        enf_compile_report_free(&report);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_grid_of_rooms),
    cmocka_unit_test(a_level_without_rooms),
    cmocka_unit_test(same_level_same_bytes),
    cmocka_unit_test(the_overlay_is_gltf),
    cmocka_unit_test(settings_change_the_map),
    cmocka_unit_test(failure_leaves_the_old_map),
    cmocka_unit_test(projects_set_and_warn),
    cmocka_unit_test(bad_projects_are_refused),
    cmocka_unit_test(the_program_compiles),
    cmocka_unit_test(the_program_takes_projects),
    cmocka_unit_test(the_program_reports_failure),
    cmocka_unit_test(real_levels_compile),
};
ENF_TEST_MAIN(tests)

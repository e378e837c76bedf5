/* Loads scenes and walks their paths: the eye's cell is tracked through portals as in a game, and located anew where a path jumps. */
#include "enfbench/views.h"
#include "common/path_csv.h"
#include "compile/compile.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const BenchTechnique bench_techniques[BENCH_TECHNIQUE_COUNT] = {
    {"none", ENF_CULL_NONE, ENF_WINDOW_BOX},
    {"frustum", ENF_CULL_FRUSTUM, ENF_WINDOW_BOX},
    {"sequences-box", ENF_CULL_SEQUENCES, ENF_WINDOW_BOX},
    {"sequences-polygon", ENF_CULL_SEQUENCES, ENF_WINDOW_POLYGON},
    {"worklist-box", ENF_CULL_WORKLIST, ENF_WINDOW_BOX},
    {"worklist-polygon", ENF_CULL_WORKLIST, ENF_WINDOW_POLYGON},
};

/* A step longer than this is a teleport: no portal was crossed on the way. Metres; a runner at 30 Hz moves 0.3. */
#define JUMP 2.0

typedef struct SceneFiles {
    const char *name, *level, *path;
} SceneFiles;

/* What to do with each scene. */
typedef struct Each {
    BenchSceneFn *function;
    const void *user;
} Each;

static const SceneFiles known[] = {
    {"palace", "assets/palace/palace.glb", "maps/palace/tour.csv"},
    {"freedoom", "freedoom/E1M1_rooms.glb", "freedoom/E1M1_rooms.walk.csv"},
    {"freedoom", "freedoom/E1M1_sector.glb", "freedoom/E1M1_sector.walk.csv"},
    {"freedoom", "freedoom/E3M8_rooms.glb", "freedoom/E3M8_rooms.walk.csv"},
    {"freedoom", "freedoom/MAP01_rooms.glb", "freedoom/MAP01_rooms.walk.csv"},
    {"freedoom", "freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.walk.csv"},
    {"freedoom", "freedoom/MAP26_rooms.glb", "freedoom/MAP26_rooms.demo.csv"},
    {"buildings", "buildings/duplex.glb", "buildings/duplex.walk.csv"},
};

static bool complain(const char *what, const EnfError *error) {
    fprintf(stderr, "enfbench: %s: %s: %s\n", what, error->file, error->message);
    return false;
}

static bool has_suffix(const char *text, const char *suffix) {
    size_t a = strlen(text);
    size_t b = strlen(suffix);
    return a >= b && strcmp(text + a - b, suffix) == 0;
}

/* Compiles into a temporary map, which is gone as soon as it is read. */
static bool compile_level(const char *level, EnfMap *map) {
    char folder[200];
    char temporary[256];
    if (!bench_temporary_folder(folder, sizeof folder)) {
        return false;
    }
    snprintf(temporary, sizeof temporary, "%s/level.enfmap", folder);
    EnfError error = {ENF_OK, 0, "", ""};
    EnfCompileReport report;
    EnfCompileDef def = enf_compile_def_default();
    def.level = level;
    def.output = temporary;
    EnfResult result = enf_compile(&def, &report, &error);
    enf_compile_report_free(&report);
    if (result == ENF_OK) {
        result = enf_map_read(map, temporary, NULL, &error);
    }
    remove(temporary);
    rmdir(folder);
    return result == ENF_OK || complain(level, &error);
}

static bool load_map(const char *level, EnfMap *map) {
    if (!has_suffix(level, ".enfmap")) {
        return compile_level(level, map);
    }
    EnfError error = {ENF_OK, 0, "", ""};
    return enf_map_read(map, level, NULL, &error) == ENF_OK || complain(level, &error);
}

/* The cell of the next eye of a path. */
static uint32_t follow(const EnfMap *map, uint32_t cell, EnfVec3 from, EnfVec3 to) {
    if (cell != ENF_NONE && enf_length(enf_sub(to, from)) <= JUMP) {
        uint32_t next = enf_map_track(map, cell, from, to);
        if (next != ENF_NONE && enf_map_cell_contains(map, next, to)) {
            return next;
        }
    }
    return enf_map_locate(map, to);
}

static bool make_views(BenchRun *run, BenchScene *scene, const EnfPathCsv *path, uint32_t frames) {
    uint32_t width = bench_knob_whole(&run->knobs, "width", 640, 1, 8192);
    uint32_t height = bench_knob_whole(&run->knobs, "height", 480, 1, 8192);
    double fov = bench_knob(&run->knobs, "fov", 60.0, 1.0, 170.0);
    scene->view_count = path->count < frames ? path->count : frames;
    scene->views = calloc(scene->view_count, sizeof *scene->views);
    if (scene->views == NULL) {
        return false;
    }
    uint32_t cell = ENF_NONE;
    EnfVec3 last = enf_v3(0.0, 0.0, 0.0);
    uint32_t frame = 0;
    for (uint32_t i = 0; i < path->count && frame < scene->view_count; i++) {
        const EnfPathRow *row = &path->rows[i];
        EnfVec3 eye = enf_v3(row->x, row->y, row->z);
        cell = follow(&scene->map, cell, last, eye);
        last = eye;
        if (i == (uint32_t)((uint64_t)frame * path->count / scene->view_count)) {
            scene->views[frame] = enf_view_default();
            scene->views[frame].camera = enf_camera(eye, enf_turn(row->yaw_deg, row->pitch_deg, 0.0), fov, width, height);
            scene->views[frame].cell = cell;
            frame++;
        }
    }
    return true;
}

static bool with_scene(BenchRun *run, const SceneFiles *files, uint32_t frames, const Each *each) {
    BenchScene scene;
    memset(&scene, 0, sizeof scene);
    const char *base = strrchr(files->path, '/');
    snprintf(scene.name, sizeof scene.name, "%.63s", base == NULL ? files->path : base + 1);
    char *dot = strrchr(scene.name, '.');
    if (dot != NULL) {
        *dot = '\0';
    }
    EnfError error = {ENF_OK, 0, "", ""};
    EnfPathCsv path;
    bench_progress(run, "%s: compiling", scene.name);
    if (enf_path_csv_read(&path, files->path, &error) != ENF_OK) {
        return complain(files->path, &error);
    }
    bool ok = load_map(files->level, &scene.map);
    if (ok) {
        ok = enf_portals_create(&scene.portals, &scene.map, NULL, &error) == ENF_OK && make_views(run, &scene, &path, frames) &&
             each->function(run, &scene, each->user);
        enf_portals_destroy(&scene.portals);
        enf_map_free(&scene.map);
        free(scene.views);
    }
    enf_path_csv_free(&path);
    return ok;
}

/* The file as it is, in the project's folder, or among the shared data beside it. */
static bool find_file(const char *name, char *out, size_t size) {
    const char *shared = getenv("ENF_SHARED_DATA");
    const char *roots[] = {".", ENF_SOURCE_DIR, shared == NULL ? ENF_SHARED_DATA : shared};
    for (size_t i = 0; i < sizeof roots / sizeof *roots; i++) {
        snprintf(out, size, "%s/%s", roots[i], name);
        if (access(out, R_OK) == 0) {
            return true;
        }
    }
    snprintf(out, size, "%s", name);
    return access(out, R_OK) == 0;
}

static bool scene_from_files(BenchRun *run, const SceneFiles *files, uint32_t frames, const Each *each) {
    char level[1024];
    char path[1024];
    if (!find_file(files->level, level, sizeof level) || !find_file(files->path, path, sizeof path)) {
        fprintf(stderr, "enfbench: skipped: %s or %s is not there\n", files->level, files->path);
        return false;
    }
    SceneFiles found = {files->name, level, path};
    return with_scene(run, &found, frames, each);
}

/* One name of the list: a known set of scenes or a file. Returns how many were run. */
static uint32_t run_name(BenchRun *run, const char *name, uint32_t frames, const Each *each) {
    uint32_t ran = 0;
    bool is_known = false;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(known[i].name, name) == 0) {
            is_known = true;
            ran += scene_from_files(run, &known[i], frames, each) ? 1U : 0U;
        }
    }
    if (!is_known) {
        char path[1024];
        const char *stem_end = strrchr(name, '.');
        int stem = stem_end == NULL ? (int)strlen(name) : (int)(stem_end - name);
        snprintf(path, sizeof path, "%.*s.walk.csv", stem, name);
        SceneFiles files = {name, name, bench_knob_text(&run->knobs, "path", path)};
        ran = scene_from_files(run, &files, frames, each) ? 1U : 0U;
    }
    return ran;
}

bool bench_each_scene(BenchRun *run, uint32_t frames, BenchSceneFn *function, const void *user) {
    Each each = {function, user};
    char names[BENCH_TEXT];
    snprintf(names, sizeof names, "%s", bench_knob_text(&run->knobs, "scene", "palace,freedoom,buildings"));
    uint32_t ran = 0;
    for (char *name = names; name != NULL;) {
        char *comma = strchr(name, ',');
        if (comma != NULL) {
            *comma++ = '\0';
        }
        ran += run_name(run, name, frames, &each);
        name = comma;
    }
    if (ran == 0) {
        fprintf(stderr, "enfbench: no scene of '%s' could be run\n", names);
    }
    return ran > 0;
}

/* Scenes and paths of the experiments on views: which map, which eye, in which cell. */
#ifndef ENFBENCH_VIEWS_H
#define ENFBENCH_VIEWS_H

#include "enfbench/bench.h"

#include <enfilade/vis.h>

/** A level of the benchmark: compiled from a glTF or read, with the eyes of its path. */
typedef struct BenchScene {
    char name[64];
    EnfMap map;
    EnfPortals portals;
    EnfView *views; /**< one a frame: camera and eye's cell */
    uint32_t view_count;
} BenchScene;

/** The scenes that a `scene` knob names: "palace", "freedoom" (every level with a path that is there), or a file. Calls `each`
 *  for every one that could be loaded; a missing optional one is named on stderr and skipped. False if none could. */
typedef bool BenchSceneFn(BenchRun *run, BenchScene *scene, const void *user);
bool bench_each_scene(BenchRun *run, uint32_t frames, BenchSceneFn *each, const void *user);

/** A technique of the comparison. */
typedef struct BenchTechnique {
    const char *name;
    EnfCull cull;
    EnfWindowMode window;
} BenchTechnique;

enum { BENCH_TECHNIQUE_COUNT = 6 };
/** The first is the baseline: everything. */
extern const BenchTechnique bench_techniques[BENCH_TECHNIQUE_COUNT];

#endif

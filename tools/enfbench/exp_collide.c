/* Swept capsules and walking bodies against brute force over every triangle of the level: moves a second, triangles looked at, and
 * how often the answers differ. */
#include "enfbench/bench.h"
#include "enfbench/views.h"
#include "scenes/solid_oracle.h"

#include <enfilade/collide.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The moves of a technique on one scene. */
typedef struct Course {
    EnfCollider *collider;
    EnfOracle oracle;
    const BenchScene *scene;
    uint32_t moves;
    double speed; /* m/s */
    uint64_t seed;
    double *times;
    double brute_every;
    EnfVec3 at;
    EnfCapsule capsule;
    double worst; /* metres between the ends of the collider and of brute force */
} Course;

/* SplitMix64: the seed names the course on every machine. */
static double unit(Course *course) {
    course->seed += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = course->seed;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static EnfVec3 way(Course *course) {
    double x = unit(course) - 0.5, y = unit(course) - 0.5, z = unit(course) - 0.5;
    EnfVec3 v = enf_normalize(enf_v3(x, y, z));
    return v;
}

/* From the eye of a frame, where there is room for a body. */
static void throw_in(Course *course) {
    for (int i = 0; i < 64; i++) {
        uint32_t frame = (uint32_t)(unit(course) * (double)course->scene->view_count);
        course->at = course->scene->views[frame].camera.eye_ws;
        course->at.y -= 1.6;
        if (enf_collide_way_out(course->collider, &course->capsule, course->at, 0.5, &course->at)) {
            return;
        }
    }
}

/* ---- sweeps ----------------------------------------------------------------------------------------------------- */

static double brute_move(Course *course, EnfVec3 delta, const EnfSweepHit *hit, BenchRow *row) {
    EnfOracleMove move = {course->capsule, course->at, delta};
    double free, start = bench_now_us();
    enf_oracle_near(&course->oracle, enf_oracle_box(&course->capsule, course->at, delta), true);
    bool met = enf_oracle_sweep(&course->oracle, &move, &free);
    double time = bench_now_us() - start, apart = fabs(free - hit->t) * enf_length(delta);
    EnfVec3 end = enf_add(course->at, enf_scale(delta, hit->t));
    row->lost_objects += met != (hit->cluster != ENF_NONE) ? 1.0 : 0.0;
    row->lost_objects += enf_oracle_depth(&course->oracle, &course->capsule, end) > 0x1p-20 ? 1.0 : 0.0;
    row->lost_objects += enf_oracle_tunnels(&course->oracle, &course->capsule, course->at, end) ? 1.0 : 0.0;
    course->worst = apart > course->worst ? apart : course->worst;
    return time;
}

static void add_row(BenchRun *run, Course *course, BenchRow *row, const char *what) {
    snprintf(row->params, sizeof row->params, "%s speed=%.0f seed=%.0f worst_m=%.2g", what, course->speed, 1.0, course->worst);
    row->p99_us = bench_quantile(course->times, row->frames, 0.99);
    row->median_us = bench_quantile(course->times, row->frames, 0.5);
    bench_rows_add(&run->rows, row);
}

static void time_sweeps(BenchRun *run, Course *course) {
    BenchRow row = bench_row("collide", course->scene->name, "sweep"),
             brute = bench_row("collide", course->scene->name, "brute");
    double *brute_times = calloc(course->moves, sizeof *brute_times);
    EnfColliderCounters before = enf_collider_counters(course->collider);
    row.lost_objects = 0.0;
    for (uint32_t i = 0; i < course->moves && brute_times != NULL; i++) {
        if (i % 100 == 0) {
            throw_in(course);
        }
        EnfVec3 delta = enf_scale(way(course), course->speed / ENF_TICK_RATE);
        EnfSweepHit hit;
        double start = bench_now_us();
        (void)enf_collide_sweep(course->collider, &course->capsule, course->at, delta, &hit);
        course->times[i] = bench_now_us() - start;
        if (fmod((double)i, course->brute_every) == 0.0) {
            brute_times[brute.frames++] = brute_move(course, delta, &hit, &row);
        }
        course->at = enf_add(course->at, enf_scale(delta, hit.t));
        row.hash = enf_hash64(row.hash, &course->at, sizeof course->at);
    }
    EnfColliderCounters after = enf_collider_counters(course->collider);
    row.frames = course->moves;
    row.boxes = (double)(after.triangles - before.triangles) / (double)course->moves;
    row.objects = (double)(after.tested - before.tested) / (double)course->moves;
    add_row(run, course, &row, "capsule");
    brute.boxes = (double)course->oracle.count;
    brute.lost_objects = 0.0;
    brute.p99_us = bench_quantile(brute_times, brute.frames, 0.99);
    brute.median_us = bench_quantile(brute_times, brute.frames, 0.5);
    snprintf(brute.params, sizeof brute.params, "every triangle, speed=%.0f", course->speed);
    bench_rows_add(&run->rows, &brute);
    free(brute_times);
}

/* ---- bodies ----------------------------------------------------------------------------------------------------- */

/* Where the body goes: somewhere else every second. */
static void wander(Course *course, uint32_t tick, EnfCharacterInput *input) {
    if (tick % ENF_TICK_RATE == 0) {
        EnfVec3 to = way(course);
        input->wish = enf_normalize(enf_v3(to.x, 0.0, to.z));
        input->run = unit(course) < 0.5;
        input->crouch = unit(course) < 0.1;
    }
    input->jump = tick % 97 == 0;
}

static void time_bodies(BenchRun *run, Course *course) {
    BenchRow row = bench_row("collide", course->scene->name, "walk");
    EnfColliderCounters before = enf_collider_counters(course->collider);
    EnfCharacterDef def = enf_character_def_default();
    EnfCharacter body;
    EnfCharacterInput input = {{0.0, 0.0, 0.0}, false, false, false, ENF_CHARACTER_WALK};
    row.lost_objects = 0.0;
    for (uint32_t i = 0; i < course->moves; i++) {
        if (i % 600 == 0) {
            throw_in(course);
            (void)enf_character_spawn(&body, course->collider, &def, course->at);
        }
        wander(course, i, &input);
        double start = bench_now_us();
        enf_character_move(&body, course->collider, &input, NULL);
        course->times[i] = bench_now_us() - start;
        EnfCapsule capsule = enf_character_capsule(&body);
        enf_oracle_near(&course->oracle, enf_oracle_box(&capsule, body.position, enf_v3(0.0, 0.0, 0.0)), false);
        row.lost_objects += enf_oracle_depth(&course->oracle, &capsule, body.position) > 0x1p-20 ? 1.0 : 0.0;
        row.hash = enf_hash64(row.hash, &body, sizeof body);
    }
    EnfColliderCounters after = enf_collider_counters(course->collider);
    row.frames = course->moves;
    row.boxes = (double)(after.triangles - before.triangles) / (double)course->moves;
    row.objects = (double)(after.tested - before.tested) / (double)course->moves;
    course->worst = 0.0;
    add_row(run, course, &row, "body");
}

static bool measure(BenchRun *run, BenchScene *scene, const void *user) {
    Course course;
    (void)user;
    memset(&course, 0, sizeof course);
    course.scene = scene;
    course.capsule = (EnfCapsule){0.3, 1.75};
    course.moves = bench_knob_whole(&run->knobs, "moves", 100000, 1, 100000000);
    course.brute_every = bench_knob(&run->knobs, "brute", 1000.0, 1.0, 1e9);
    course.times = calloc(course.moves, sizeof *course.times);
    bool ok = course.times != NULL && enf_oracle_build(&course.oracle, &scene->map);
    ok = ok && enf_collider_create(&course.collider, &scene->map, NULL, NULL, NULL) == ENF_OK;
    static const double speeds[] = {3.0, 30.0, 300.0};
    for (int i = 0; ok && i < 3; i++) {
        course.speed = speeds[i];
        course.seed = 1;
        course.worst = 0.0;
        time_sweeps(run, &course);
    }
    course.speed = 5.0;
    course.seed = 1;
    if (ok) {
        time_bodies(run, &course);
        enf_oracle_free(&course.oracle);
    }
    enf_collider_destroy(course.collider);
    free(course.times);
    return ok;
}

bool bench_collide(BenchRun *run) {
    uint32_t frames = bench_knob_whole(&run->knobs, "frames", 500, 1, 1000000);
    return bench_each_scene(run, frames, measure, NULL);
}

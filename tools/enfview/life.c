/* Makes the world of a view run: the map's movers, doors that open and shut in turn, and the volumes that follow them. */
#include <math.h>

#include "common/report.h"
#include "enfview/viewer.h"

/* A door opens every eight seconds and shuts half way, each at its own time. */
enum { DOOR_CYCLE = 480, DOOR_SHIFT = 37 };

/* As large as a person, and without a mesh: only volumes show it. */
static EnfResult add_recorded(Viewer *viewer, const char *file_name, EnfError *error) {
    EnfResult result = enf_mover_csv_read(&viewer->recorded, file_name, error);
    for (uint32_t i = 0; i < viewer->recorded.count && result == ENF_OK; i++) {
        EnfObjectDef def = enf_object_def_default();
        def.local.min = enf_v3(-0.4, 0.0, -0.4);
        def.local.max = enf_v3(0.4, 1.75, 0.4);
        def.mesh = ENF_NONE;
        bool made = enf_mover_csv_motion(&viewer->recorded.objects[i], true, ENF_WRAP_PING_PONG, &def.motion) &&
                    enf_world_add(viewer->world, &def, NULL).generation != 0;
        result = made ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory");
    }
    return result;
}

EnfResult life_open(Viewer *viewer, EnfError *error) {
    const EnfMap *map = &viewer->map;
    viewer->frame_evaluated = UINT64_MAX;
    EnfResult result = enf_world_create(&viewer->world, map, map->movers_count + 1, NULL, error);
    result = result == ENF_OK ? enf_world_populate(viewer->world, error) : result;
    if (result == ENF_OK && viewer->options->movers) {
        result = add_recorded(viewer, viewer->options->movers, error);
    }
    if (result == ENF_OK && viewer->options->dbv != DBV_OFF && enf_world_object_limit(viewer->world) > 0) {
        EnfDbvDef def = enf_dbv_def_default();
        def.policy = (EnfDbvPolicy)(viewer->options->dbv - 1);
        result = enf_dbv_create(&viewer->dbv, viewer->world, &def, NULL, error);
    }
    return result;
}

void life_close(Viewer *viewer) {
    enf_dbv_destroy(viewer->dbv);
    enf_world_destroy(viewer->world);
    enf_mover_csv_free(&viewer->recorded);
}

static bool is_door(const EnfMover *mover) {
    return (mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE) && !(mover->flags & ENF_MOVER_LOCKED);
}

/* Sends the doors whose time it is. True if one was sent. */
static bool send_doors(Viewer *viewer, int64_t tick) {
    const EnfMap *map = &viewer->map;
    bool sent = false;
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfMover *mover = &map->movers[i];
        uint32_t group = mover->portal != ENF_NONE ? mover->portal : i; /* both leaves of a door at once */
        int64_t phase = (tick + (int64_t)group * DOOR_SHIFT) % DOOR_CYCLE;
        if (is_door(mover) && (phase == 0 || phase == DOOR_CYCLE / 2)) {
            double open = mover->high >= -mover->low ? (double)mover->high : (double)mover->low;
            sent = enf_world_swing(viewer->world, enf_world_object(viewer->world, i), phase == 0 ? open : 0.0) || sent;
        }
    }
    return sent;
}

static bool is_leaf(const EnfMover *mover) {
    return mover->portal != ENF_NONE && (mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE);
}

static bool is_shut(Viewer *viewer, uint32_t mover) {
    EnfObjectDef def = enf_mover_def(&viewer->map, mover);
    EnfPose now = enf_world_pose(viewer->world, mover), rest = def.motion.as.swing.rest;
    EnfVec3 way = enf_sub(now.position, rest.position);
    double turn = now.rotation.x * rest.rotation.x + now.rotation.y * rest.rotation.y + now.rotation.z * rest.rotation.z +
                  now.rotation.w * rest.rotation.w;
    return enf_dot(way, way) < 1e-18 && fabs(turn) > 1.0 - 1e-12;
}

/* Leaves at rest fill their opening (the compiler chose the portal by that): it is closed while all of them are shut. */
static void close_portals(Viewer *viewer) {
    const EnfMap *map = &viewer->map;
    for (int opens = 0; opens < 2; opens++) {
        for (uint32_t i = 0; i < map->movers_count; i++) {
            if (is_leaf(&map->movers[i]) && is_shut(viewer, i) == (opens == 0)) {
                enf_portals_set_open(&viewer->portals, map->movers[i].portal, opens != 0);
            }
        }
    }
}

void life_run(Viewer *viewer, int64_t tick) {
    int doors = viewer->options->doors;
    while (enf_world_tick(viewer->world) < tick) {
        int64_t step = doors == DOORS_REST ? tick - enf_world_tick(viewer->world) : 1;
        enf_world_advance(viewer->world, step);
        if (doors != DOORS_REST && send_doors(viewer, enf_world_tick(viewer->world)) && viewer->dbv) {
            (void)enf_dbv_begin(viewer->dbv,
                                NULL); /* volumes hear of changes in their tick; a failure shows in the next frame */
            uint32_t count;
            (void)enf_dbv_end(viewer->dbv, &count);
        }
    }
    if (doors == DOORS_CLOSE) {
        close_portals(viewer);
    }
}

/* ---- counters --------------------------------------------------------------------------------------------------- */

/* X(counter of EnfDbvCounters). */
#define DBV_COUNTERS(X) X(exposed) X(appeared) X(drawn) X(expired) X(reinserted) X(avoided) X(late) X(tested) X(nodes)

static void report_counters(EnfReport *report, const char *key, const EnfDbvCounters *counters, uint64_t evaluated) {
    enf_report_object(report, key);
    enf_report_count(report, "evaluated", evaluated);
#define REPORT_COUNTER(name) enf_report_count(report, #name, counters->name);
    DBV_COUNTERS(REPORT_COUNTER)
#undef REPORT_COUNTER
    enf_report_end_object(report);
}

void viewer_report_dbv(const Viewer *viewer, EnfReport *report, const char *key) {
    static const char *const policies[] = {"constant", "adaptive", "maximal", "optimal", "reach"};
    if (!viewer->dbv) {
        return;
    }
    EnfDbvCounters total = enf_dbv_total_counters(viewer->dbv);
    enf_report_object(report, key);
    enf_report_text(report, "policy", policies[viewer->options->dbv - 1]);
    enf_report_count(report, "bytes", enf_dbv_bytes(viewer->dbv));
    if (viewer->frame_evaluated != UINT64_MAX) {
        report_counters(report, "frame", &viewer->frame_counters, viewer->frame_evaluated);
    }
    report_counters(report, "total", &total, enf_world_evaluations(viewer->world));
    enf_report_end_object(report);
}

/* Somebody who looks on while a recording is walked again: visibility at every tick, with volumes for what moves. He is to change
 * nothing. */
#ifndef ENF_TESTS_ONLOOKER_H
#define ENF_TESTS_ONLOOKER_H

#include "harness/walk.h"

#include <enfilade/vis.h>

typedef struct EnfOnlooker {
    EnfVis *vis;
    EnfDbvIndex *dbv;
    uint64_t seen;
} EnfOnlooker;

/** `policy` < 0: without volumes. */
static inline EnfOnlooker enf_onlooker_begin(Sim *sim, const EnfMap *map, int policy) {
    EnfOnlooker onlooker = {NULL, NULL, 0};
    EnfDbvDef def = enf_dbv_def_default();
    EnfError error;
    assert_int_equal(enf_vis_create(&onlooker.vis, map, NULL, &error), ENF_OK);
    if (policy >= 0) {
        def.policy = (EnfDbvPolicy)policy;
        assert_int_equal(enf_dbv_create(&onlooker.dbv, sim_world(sim), &def, NULL, &error), ENF_OK);
    }
    return onlooker;
}

static inline void enf_onlooker_end(EnfOnlooker *onlooker) {
    enf_dbv_destroy(onlooker->dbv);
    enf_vis_destroy(onlooker->vis);
}

static inline EnfView enf_onlooker_view(const EnfOnlooker *onlooker, Sim *sim, uint32_t width, uint32_t height) {
    SimEye eye = sim_eye(sim);
    EnfView view = enf_view_default();
    view.camera = enf_camera(eye.eye_ws, enf_turn(eye.yaw_deg, eye.pitch_deg, 0.0), 70.0, width, height);
    view.cell = eye.cell;
    view.dbv = onlooker->dbv;
    return view;
}

static inline void enf_onlooker_look(EnfOnlooker *onlooker, Sim *sim, EnfCull cull) {
    EnfView view = enf_onlooker_view(onlooker, sim, 320, 240);
    view.cull = cull;
    onlooker->seen += enf_vis_run(onlooker->vis, sim_portals(sim), &view)->entry_count;
}

#endif

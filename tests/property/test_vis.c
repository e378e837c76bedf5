/* Nothing visible is lost: every traversal, window and grain against rays through the picture that know no cell, portal, tree or
 * window (scenes/oracle.h). Eyes stand anywhere in a grid of rooms, in doorways, on thresholds' planes and a hair beside them. */
#include "harness/purse.h"
#include "scenes/oracle.h"
#include "scenes/rooms.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The traversals under test. */
typedef struct Mode {
    EnfCull cull;
    EnfWindowMode window;
    EnfGrain grain;
} Mode;

static const Mode modes[] = {
    {ENF_CULL_NONE, ENF_WINDOW_BOX, ENF_GRAIN_OBJECTS},        {ENF_CULL_FRUSTUM, ENF_WINDOW_BOX, ENF_GRAIN_OBJECTS},
    {ENF_CULL_WORKLIST, ENF_WINDOW_BOX, ENF_GRAIN_OBJECTS},    {ENF_CULL_WORKLIST, ENF_WINDOW_POLYGON, ENF_GRAIN_OBJECTS},
    {ENF_CULL_SEQUENCES, ENF_WINDOW_BOX, ENF_GRAIN_OBJECTS},   {ENF_CULL_SEQUENCES, ENF_WINDOW_POLYGON, ENF_GRAIN_OBJECTS},
    {ENF_CULL_WORKLIST, ENF_WINDOW_BOX, ENF_GRAIN_PRIMITIVES}, {ENF_CULL_SEQUENCES, ENF_WINDOW_BOX, ENF_GRAIN_PRIMITIVES},
};
enum { MODE_COUNT = sizeof modes / sizeof *modes, RAYS = 24 };

typedef struct Stage {
    EnfRooms rooms;
    EnfPortals portals;
    EnfVis *vis;
} Stage;

static void open_stage(Stage *stage, const EnfRoomsDef *def) {
    EnfError error = {ENF_OK, 0, "", ""};
    if (!enf_rooms_create(&stage->rooms, def, &error)) {
        fail_msg("scene: %s", error.message);
    }
    assert_int_equal(enf_portals_create(&stage->portals, stage->rooms.map, NULL, &error), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, stage->rooms.map, NULL, &error), ENF_OK);
}

static void close_stage(Stage *stage) {
    enf_vis_destroy(stage->vis);
    enf_portals_destroy(&stage->portals);
    enf_rooms_destroy(&stage->rooms);
}

/* The middle of a random door and the direction through it. */
static EnfVec3 door_point(const Stage *stage, EnfTestRng *rng) {
    const EnfMap *map = stage->rooms.map;
    const EnfPortal *portal = &map->portals[enf_test_below(rng, map->portals_count)];
    const double *o = map->cells[portal->source].origin;
    EnfVec3 a = enf_v3_from_f(map->portal_vertices[portal->vertex_first]);
    EnfVec3 b = enf_v3_from_f(map->portal_vertices[portal->vertex_first + 2]);
    double s = enf_test_double(rng, 0.01, 0.99);
    double t = enf_test_double(rng, 0.01, 0.99);
    EnfVec3 p = enf_v3(a.x + s * (b.x - a.x), a.y + t * (b.y - a.y), a.z + s * (b.z - a.z));
    return enf_add(p, enf_v3(o[0], o[1], o[2]));
}

/* Anywhere inside, or in a doorway within a hair of its plane. */
static EnfVec3 random_eye(const Stage *stage, EnfTestRng *rng) {
    const EnfRoomsDef *def = &stage->rooms.def;
    if (stage->rooms.map->portals_count > 0 && enf_test_chance(rng, 3)) {
        static const double hairs[] = {0.0, 1e-12, 1e-7, 1e-4, 1.0 / 4096.0, 0.004, 0.0079, 0.02, 0.3};
        double hair = hairs[enf_test_below(rng, sizeof hairs / sizeof *hairs)];
        double angle = enf_test_double(rng, 0.0, 2.0 * ENF_PI);
        return enf_add(door_point(stage, rng), enf_v3(hair * cos(angle), 0.0, hair * sin(angle)));
    }
    double x = enf_test_double(rng, 0.01, def->room.x * def->nx - 0.01);
    double z = enf_test_double(rng, 0.01, def->room.z * def->nz - 0.01);
    return enf_add(def->origin, enf_v3(x, enf_test_double(rng, 0.01, def->room.y - 0.01), z));
}

static EnfCamera random_camera(EnfVec3 eye, EnfTestRng *rng) {
    static const uint32_t sizes[][2] = {{640, 480}, {1, 1}, {37, 1023}, {1920, 1080}};
    const uint32_t *size = sizes[enf_test_below(rng, 4)];
    double fov = enf_test_chance(rng, 4) ? enf_test_double(rng, 1.0, 170.0) : 60.0;
    double pitch = enf_test_chance(rng, 2) ? enf_test_double(rng, -90.0, 90.0) : enf_test_double(rng, -10.0, 10.0);
    double roll = enf_test_chance(rng, 3) ? enf_test_double(rng, -180.0, 180.0) : 0.0;
    return enf_camera(eye, enf_turn(enf_test_double(rng, 0.0, 360.0), pitch, roll), fov, size[0], size[1]);
}

/* What a few rays of this view meet; one run of rays serves every mode. */
static uint32_t shoot(const Stage *stage, const EnfCamera *camera, EnfTestRng *rng, uint32_t *met) {
    uint32_t count = 0;
    for (int i = 0; i < RAYS; i++) {
        double x = enf_test_double(rng, 0.0, (double)camera->width_px);
        double y = enf_test_double(rng, 0.0, (double)camera->height_px);
        double t = 0.0;
        count += enf_oracle_ray(stage->rooms.map, camera, x, y, &met[count], &t) ? 1U : 0U;
    }
    return count;
}

static void check_view(Stage *stage, const EnfCamera *camera, uint32_t cell, const uint32_t *met, uint32_t met_count) {
    for (uint32_t m = 0; m < MODE_COUNT; m++) {
        EnfView view = enf_view_default();
        view.camera = *camera;
        view.cell = cell;
        view.cull = modes[m].cull;
        view.window = modes[m].window;
        view.grain = modes[m].grain;
        const EnfVisSet *set = enf_vis_run(stage->vis, &stage->portals, &view);
        for (uint32_t i = 0; i < met_count; i++) {
            if (!enf_oracle_listed(set, met[i])) {
                fail_msg("mode %u: cluster %u is seen from (%.17g, %.17g, %.17g) in cell %u and was not listed", m, met[i],
                         camera->eye_ws.x, camera->eye_ws.y, camera->eye_ws.z, cell);
            }
        }
    }
}

static void compare_views(Stage *stage, uint32_t rounds, EnfTestRng *rng) {
    for (uint32_t r = 0; r < rounds; r++) {
        EnfVec3 eye = random_eye(stage, rng);
        uint32_t cell = enf_rooms_cell_at(&stage->rooms, eye);
        if (cell == ENF_NONE || enf_rooms_in_furniture(&stage->rooms, eye, 0.0)) {
            continue;
        }
        EnfCamera camera = random_camera(eye, rng);
        uint32_t met[RAYS];
        uint32_t count = shoot(stage, &camera, rng, met);
        check_view(stage, &camera, cell, met, count);
    }
}

static void test_grid(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    for (uint32_t scene = 0; scene < 6; scene++) {
        EnfRoomsDef def = enf_rooms_def_default();
        def.seed = enf_test_u64(&rng);
        def.thresholds = scene % 2 == 1;
        def.door_percent = scene < 2 ? 100 : 60;
        if (scene == 3) { /* open plan: doors as wide as walls allow */
            def.door_width = 4.25;
            def.door_height = 2.75;
        }
        if (scene == 4) {
            def.origin = enf_v3(100000.0, -3000.0, -100000.0);
        }
        if (scene == 5) { /* narrow slits */
            def.door_width = 1.0 / 64.0;
        }
        Stage stage;
        open_stage(&stage, &def);
        compare_views(&stage, enf_test_rounds(250, 5000), &rng);
        close_stage(&stage);
    }
}

/* The cells of a set, as bits. */
static uint64_t cells_of(const EnfVisSet *set) {
    uint64_t bits = 0;
    for (uint32_t i = 0; i < set->cell_count; i++) {
        assert_true(set->cells[i] < 64);
        bits |= 1ULL << set->cells[i];
    }
    return bits;
}

/* Sequences see no more than the worklist, and portals no more than the frustum. Of clusters this is true in sum only: a box that
 * straddles the eye's plane may be kept by the narrower of two pyramids and dropped by the wider, and is in neither's picture. */
static void test_order(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Stage stage;
    EnfRoomsDef def = enf_rooms_def_default();
    open_stage(&stage, &def);
    static const EnfCull order[] = {ENF_CULL_SEQUENCES, ENF_CULL_WORKLIST, ENF_CULL_FRUSTUM, ENF_CULL_NONE};
    uint64_t total[4] = {0, 0, 0, 0};
    for (uint32_t r = 0; r < enf_test_rounds(300, 5000); r++) {
        EnfVec3 eye = random_eye(&stage, &rng);
        EnfView view = enf_view_default();
        view.camera = random_camera(eye, &rng);
        view.cell = enf_rooms_cell_at(&stage.rooms, eye);
        if (view.cell == ENF_NONE) {
            continue;
        }
        uint64_t cells[4];
        for (uint32_t i = 0; i < 4; i++) {
            view.cull = order[i];
            const EnfVisSet *seen = enf_vis_run(stage.vis, &stage.portals, &view);
            cells[i] = cells_of(seen);
            total[i] += seen->entry_count;
        }
        assert_true((cells[0] & ~cells[1]) == 0);
        assert_true((cells[1] & ~cells[3]) == 0);
    }
    assert_true(total[0] > 0 && total[0] <= total[1] && total[1] < total[2] && total[2] < total[3]);
    close_stage(&stage);
}

/* ---- cost ------------------------------------------------------------------------------------------------------- */

/* The same rooms seen in a small and in a large building cost the same: nothing is spent on what is not seen. */
static void test_cost_follows_what_is_seen(void **state) {
    (void)state;
    EnfVisCounters seen[2];
    for (uint32_t size = 0; size < 2; size++) {
        EnfRoomsDef def = enf_rooms_def_default();
        def.nx = def.nz = size == 0 ? 4 : 40;
        def.door_percent = 0; /* closed rooms: the view stays in its own */
        Stage stage;
        open_stage(&stage, &def);
        EnfView view = enf_view_default();
        view.camera = enf_camera(enf_v3(2.5, 1.5, 2.5), enf_turn(30.0, 0.0, 0.0), 60.0, 640, 480);
        view.cell = 0;
        seen[size] = enf_vis_run(stage.vis, &stage.portals, &view)->counters;
        close_stage(&stage);
    }
    assert_int_equal(seen[0].cells, 1);
    assert_memory_equal(&seen[0], &seen[1], sizeof seen[0]);
}

/* The second walk over the same views makes no heap call. */
static void test_no_heap_in_a_warm_frame(void **state) {
    (void)state;
    Purse heap = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&heap);
    EnfRoomsDef def = enf_rooms_def_default();
    Stage stage;
    open_stage(&stage, &def);
    EnfVis *vis = NULL;
    assert_int_equal(enf_vis_create(&vis, stage.rooms.map, &allocator, NULL), ENF_OK);
    uint32_t cold = 0;
    for (uint32_t pass = 0; pass < 2; pass++) {
        EnfTestRng rng = enf_test_rng(3);
        cold = heap.calls;
        for (uint32_t r = 0; r < 200; r++) {
            EnfVec3 eye = random_eye(&stage, &rng);
            EnfView view = enf_view_default();
            view.camera = random_camera(eye, &rng);
            view.cell = enf_rooms_cell_at(&stage.rooms, eye);
            for (uint32_t m = 0; m < MODE_COUNT; m++) {
                view.cull = modes[m].cull;
                view.window = modes[m].window;
                view.grain = modes[m].grain;
                (void)enf_vis_run(vis, &stage.portals, &view);
            }
        }
    }
    assert_true(cold > 0);
    assert_int_equal(heap.calls, cold);
    enf_vis_destroy(vis);
    purse_assert_whole(&heap);
    close_stage(&stage);
}

/* Memory that runs out at any allocation of any frame shows more, and hides nothing. */
static void test_memory_failure_draws_more(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    EnfRoomsDef def = enf_rooms_def_default();
    Stage stage;
    open_stage(&stage, &def);
    EnfVis *plenty = stage.vis;
    uint32_t ran = 0, poor = 0;
    for (uint32_t left = 0; left < 40; left++) {
        Purse miser = purse_with(left);
        EnfAllocator allocator = purse_allocator(&miser);
        EnfError error = {ENF_OK, 0, "", ""};
        stage.vis = NULL;
        if (enf_vis_create(&stage.vis, stage.rooms.map, &allocator, &error) != ENF_OK) {
            assert_int_equal(error.code, ENF_ERROR_MEMORY);
            assert_null(stage.vis);
            assert_true(miser.refused > 0);
            purse_assert_whole(&miser);
            continue;
        }
        ran++;
        compare_views(&stage, 4, &rng);
        enf_vis_destroy(stage.vis);
        purse_assert_whole(&miser);
        poor += miser.refused > 0;
    }
    printf("memory: %u of 40 could be made, %u of them ran out of it in a frame\n", ran, poor);
    assert_true(ran > 0 && ran < 40 && poor > 0);
    stage.vis = plenty;
    close_stage(&stage);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_grid),
    cmocka_unit_test(test_order),
    cmocka_unit_test(test_cost_follows_what_is_seen),
    cmocka_unit_test(test_no_heap_in_a_warm_frame),
    cmocka_unit_test(test_memory_failure_draws_more),
};

ENF_TEST_MAIN(tests)

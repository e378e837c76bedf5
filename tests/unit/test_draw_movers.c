/* engine/draw, what moves: the canonical order with clusters, matrices between two ticks, cells touched, no heap call in a warm frame,
 * and lists that stay sound when memory runs out. */
#include "harness/purse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/draw.h>

#include "scenes/moving_rooms.h"

enum { ITEMS = 8192 };

/* A cluster, or a part of an object: what a list draws, in its order. */
typedef struct Item {
    uint32_t object, number; /* ENF_NONE and the cluster; or the object and the part's first index */
} Item;

typedef struct Stage {
    EnfMovingRooms moving;
    EnfVis *vis;
    EnfDbvIndex *dbv;
} Stage;

static void open_stage(Stage *stage, uint64_t seed, bool trail) {
    EnfMovingRoomsDef def = enf_moving_rooms_def_default();
    EnfError error = {0};
    def.rooms.seed = seed;
    def.trail = trail;
    if (!enf_moving_rooms_create(&stage->moving, &def, &error)) {
        fail_msg("%s", error.message);
    }
    EnfDbvDef policy = enf_dbv_def_default();
    assert_int_equal(enf_vis_create(&stage->vis, stage->moving.rooms.map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_dbv_create(&stage->dbv, stage->moving.world, &policy, NULL, NULL), ENF_OK);
}

static void close_stage(Stage *stage) {
    enf_dbv_destroy(stage->dbv);
    enf_vis_destroy(stage->vis);
    enf_moving_rooms_destroy(&stage->moving);
}

static EnfView random_view(const Stage *stage, EnfTestRng *rng) {
    EnfBox3 room = enf_rooms_box(&stage->moving.rooms, enf_test_below(rng, stage->moving.rooms.map->cells_count));
    EnfView view = enf_view_default();
    EnfVec3 eye = enf_v3(enf_test_double(rng, room.min.x, room.max.x), 1.5, enf_test_double(rng, room.min.z, room.max.z));
    view.camera = enf_camera(eye, enf_turn(enf_test_double(rng, -180.0, 180.0), 0.0, 0.0), 70.0, 640, 480);
    view.cell = enf_rooms_cell_at(&stage->moving.rooms, eye);
    view.dbv = stage->dbv;
    return view;
}

static uint32_t expand(const EnfMap *map, const EnfDrawList *list, Item *items) {
    uint32_t count = 0;
    for (uint32_t b = 0; b < list->batch_count; b++) {
        const EnfDrawBatch *batch = &list->batches[b];
        for (uint32_t r = batch->range_first; r < batch->range_first + batch->range_count; r++) {
            const EnfDrawRange *range = &list->ranges[r];
            if (batch->mover != ENF_NONE) {
                assert_int_equal(range->cluster, ENF_NONE);
                items[count++] = (Item){list->movers[batch->mover].object, range->index_first};
                continue;
            }
            uint32_t cluster = range->cluster;
            for (uint32_t left = range->index_count; left; left -= map->clusters[cluster - 1].index_count) {
                items[count++] = (Item){ENF_NONE, cluster++};
            }
        }
    }
    assert_true(count < ITEMS);
    return count;
}

static bool is_subsequence(const Item *part, uint32_t part_count, const Item *all, uint32_t all_count) {
    uint32_t matched = 0;
    for (uint32_t i = 0; i < all_count && matched < part_count; i++) {
        matched += all[i].object == part[matched].object && all[i].number == part[matched].number ? 1U : 0U;
    }
    return matched == part_count;
}

/* The rank of a batch before what is blended: clusters, then movers; opaque, then masked; by material; by object. */
static void check_order(const EnfMap *map, const EnfDrawList *list) {
    uint64_t last = 0;
    for (uint32_t b = 0; b < list->opaque_batch_count; b++) {
        const EnfDrawBatch *batch = &list->batches[b];
        bool moves = batch->mover != ENF_NONE, masked = map->materials[batch->material].alpha_mode == ENF_ALPHA_MASK;
        uint64_t object = moves ? list->movers[batch->mover].object : 0;
        uint64_t rank = 1 + ((uint64_t)moves << 63 | (uint64_t)masked << 62 | (uint64_t)batch->material << 32 | object);
        assert_true(rank > last);
        last = rank;
    }
    for (uint32_t b = list->opaque_batch_count; b < list->batch_count; b++) {
        assert_int_equal(map->materials[list->batches[b].material].alpha_mode, ENF_ALPHA_BLEND);
    }
}

static double blended_distance2(const EnfDrawList *list, uint32_t batch, EnfVec3 eye) {
    const EnfDrawMover *mover = &list->movers[list->batches[batch].mover];
    EnfVec3 low = enf_v3_from_f(mover->box.min), high = enf_v3_from_f(mover->box.max);
    EnfVec3 to = enf_sub(enf_add(mover->position_ws, enf_scale(enf_add(low, high), 0.5)), eye);
    return enf_dot(to, to);
}

static void culled_lists_are_subsequences(void **state) {
    (void)state;
    static Item all[ITEMS], part[ITEMS];
    EnfTestRng rng = enf_test_rng(1);
    Stage stage;
    open_stage(&stage, enf_test_u64(&rng), false);
    const EnfMap *map = stage.moving.rooms.map;
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, map, NULL, NULL), ENF_OK);
    uint32_t seen = 0, blended = 0;
    for (uint32_t round = 0; round < enf_test_rounds(100, 3000); round++) {
        enf_moving_rooms_step(&stage.moving);
        EnfView view = random_view(&stage, &rng), everything = view;
        everything.cull = ENF_CULL_NONE;
        everything.dbv = NULL;
        const EnfDrawList *list = enf_draw_build(draw, enf_vis_run(stage.vis, &stage.moving.portals, &everything), 0.02,
                                                 stage.moving.world, 1.0);
        uint32_t all_count = expand(map, list, all);
        check_order(map, list);
        double last = HUGE_VAL;
        for (uint32_t b = list->opaque_batch_count; b < list->batch_count; b++, blended++) { /* no cluster here is blended */
            double distance2 = blended_distance2(list, b, view.camera.eye_ws);
            assert_true(distance2 <= last + 1e-5);
            last = distance2;
        }
        list = enf_draw_build(draw, enf_vis_run(stage.vis, &stage.moving.portals, &view), 0.02, stage.moving.world, 1.0);
        uint32_t part_count = expand(map, list, part);
        check_order(map, list);
        assert_true(is_subsequence(part, part_count, all, all_count));
        seen += list->mover_count;
    }
    assert_true(seen > 100 && blended > 100);
    enf_draw_destroy(draw);
    close_stage(&stage);
}

/* A point of the mesh's box, as a matrix has it relative to the eye, and as poses have it. */
static void check_matrix(const EnfDrawMover *mover, const EnfPose poses[2], double alpha, EnfVec3 p, EnfVec3 eye) {
    const float *m = mover->eye_from_model;
    EnfVec3 drawn = {(double)m[0] * p.x + (double)m[3] * p.y + (double)m[6] * p.z + (double)m[9],
                     (double)m[1] * p.x + (double)m[4] * p.y + (double)m[7] * p.z + (double)m[10],
                     (double)m[2] * p.x + (double)m[5] * p.y + (double)m[8] * p.z + (double)m[11]};
    EnfVec3 a = enf_pose_point(&poses[0], p), b = enf_pose_point(&poses[1], p);
    EnfVec3 chord = enf_add(a, enf_scale(enf_sub(b, a), alpha));
    assert_true(enf_length(enf_sub(enf_add(drawn, eye), chord)) < 1e-5);
}

static void pictures_between_ticks_blend_matrices(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Stage stage;
    open_stage(&stage, enf_test_u64(&rng), true);
    const EnfMap *map = stage.moving.rooms.map;
    EnfWorld *world = stage.moving.world;
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, map, NULL, NULL), ENF_OK);
    for (uint32_t round = 0; round < enf_test_rounds(50, 1000); round++) {
        enf_moving_rooms_step(&stage.moving);
        EnfView view = random_view(&stage, &rng);
        view.dbv = NULL;
        double alpha = round % 3 == 0 ? 0.0 : enf_test_double(&rng, 0.0, 1.0);
        const EnfDrawList *list = enf_draw_build(draw, enf_vis_run(stage.vis, &stage.moving.portals, &view), 0.02, world,
                                                 alpha);
        for (uint32_t i = 0; i < list->mover_count; i++) {
            const EnfDrawMover *mover = &list->movers[i];
            const EnfMesh *mesh = &map->meshes[mover->mesh];
            EnfPose poses[2] = {{{0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0}}, enf_world_pose(world, mover->object)};
            (void)enf_world_last_pose(world, mover->object, &poses[0]);
            EnfVec3 p = enf_v3((double)mesh->min[0], (double)mesh->max[1], (double)mesh->min[2]);
            check_matrix(mover, poses, alpha, p, view.camera.eye_ws);
            for (uint32_t c = 0; c < mover->cell_count; c++) {
                assert_true(c == 0 || mover->cells[c] > mover->cells[c - 1]);
            }
            uint32_t home = enf_rooms_cell_at(&stage.moving.rooms, mover->position_ws);
            bool found = home == ENF_NONE;
            for (uint32_t c = 0; c < mover->cell_count; c++) {
                found = found || mover->cells[c] == home;
            }
            assert_true(found || mover->cell_count > 0); /* an origin in a wall may be in either room */
        }
    }
    enf_draw_destroy(draw);
    close_stage(&stage);
}

/* ---- heap ------------------------------------------------------------------------------------------------------- */

static void add_many(EnfMovingRooms *moving, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        EnfObjectDef def = enf_object_def_default();
        def.mesh = i % moving->rooms.map->meshes_count;
        def.motion.as.still.position = enf_v3(2.5, 1.5, 2.5);
        assert_true(enf_world_add(moving->world, &def, NULL).generation != 0);
    }
}

static void a_warm_frame_makes_no_heap_call(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    Stage stage;
    open_stage(&stage, enf_test_u64(&rng), false);
    add_many(&stage.moving, 2000);
    Purse purse = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&purse);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, stage.moving.rooms.map, &allocator, NULL), ENF_OK);
    uint32_t before = 0;
    for (uint32_t round = 0; round < 50; round++) {
        enf_moving_rooms_step(&stage.moving);
        EnfView view = random_view(&stage, &rng);
        view.dbv = round % 2 ? stage.dbv : NULL; /* the first frame shows all */
        const EnfDrawList *list = enf_draw_build(draw, enf_vis_run(stage.vis, &stage.moving.portals, &view), 0.02,
                                                 stage.moving.world, 1.0);
        assert_false(list->movers_failed);
        before = round == 0 ? purse.calls : before;
    }
    assert_int_equal(purse.calls, before);
    enf_draw_destroy(draw);
    purse_assert_whole(&purse);
    close_stage(&stage);
}

/* No room for more: the list says so, and holds what there was room for. */
static void lists_without_memory_are_sound(void **state) {
    (void)state;
    static Item items[ITEMS];
    EnfTestRng rng = enf_test_rng(4);
    Stage stage;
    open_stage(&stage, enf_test_u64(&rng), false);
    add_many(&stage.moving, 2000);
    Purse purse = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&purse);
    EnfDraw *draw;
    assert_int_equal(enf_draw_create(&draw, stage.moving.rooms.map, &allocator, NULL), ENF_OK);
    EnfView view = random_view(&stage, &rng);
    view.dbv = NULL;
    const EnfVisSet *set = enf_vis_run(stage.vis, &stage.moving.portals, &view);
    purse.budget = 0;
    const EnfDrawList *list = enf_draw_build(draw, set, 0.02, stage.moving.world, 1.0);
    assert_true(list->movers_failed && purse.refused > 0);
    assert_true(list->mover_count > 100);
    expand(stage.moving.rooms.map, list, items);
    check_order(stage.moving.rooms.map, list);
    purse.budget = PURSE_FULL;
    list = enf_draw_build(draw, set, 0.02, stage.moving.world, 1.0);
    assert_false(list->movers_failed);
    assert_true(list->mover_count >= 2000);
    enf_draw_destroy(draw);
    purse_assert_whole(&purse);
    close_stage(&stage);
}

/* Objects without a mesh of the map's, and lists without a world, show nothing. */
static void what_has_no_mesh_is_not_drawn(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(5);
    EnfRooms rooms;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfWorld *world;
    EnfVis *vis;
    EnfDraw *draw;
    EnfPortals portals;
    assert_true(enf_rooms_create(&rooms, &def, NULL));
    assert_int_equal(enf_portals_create(&portals, rooms.map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_world_create(&world, rooms.map, 4, NULL, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&vis, rooms.map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_draw_create(&draw, rooms.map, NULL, NULL), ENF_OK);
    EnfObjectDef object = enf_object_def_default();
    for (uint32_t i = 0; i < 4; i++) {
        object.mesh = i % 2 ? ENF_NONE : i;
        assert_true(enf_world_add(world, &object, NULL).generation != 0);
    }
    EnfView view = enf_view_default();
    view.camera.eye_ws = enf_v3(enf_test_double(&rng, 1.0, 4.0), 1.5, 2.0);
    const EnfVisSet *set = enf_vis_run(vis, &portals, &view);
    assert_int_equal(enf_draw_build(draw, set, 0.02, world, 1.0)->mover_count, 0);
    assert_int_equal(enf_draw_build(draw, set, 0.02, NULL, 1.0)->mover_count, 0);
    enf_draw_destroy(draw);
    enf_vis_destroy(vis);
    enf_world_destroy(world);
    enf_portals_destroy(&portals);
    enf_rooms_destroy(&rooms);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(culled_lists_are_subsequences),   cmocka_unit_test(pictures_between_ticks_blend_matrices),
    cmocka_unit_test(a_warm_frame_makes_no_heap_call), cmocka_unit_test(lists_without_memory_are_sound),
    cmocka_unit_test(what_has_no_mesh_is_not_drawn),
};

ENF_TEST_MAIN(tests)

/* Moving objects in pictures: drawn with any culling, any policy of volumes or none, at every tick and between two, the picture equals
 * the one of everything, byte for byte; with doors that close their portals, objects that are born, die and are set elsewhere, in both
 * headless contexts. Their light does not ask what is visible, and is that of the walls. No picture is stored. */
#include "harness/harness.h"
#include "harness/pictures.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/gl.h>

#include "gl/bake.h"
#include "gl/mover_lights.h"
#include "scenes/moving_rooms.h"
#include "scenes/oracle.h"

enum { WIDTH = 256, HEIGHT = 192, SIZE = WIDTH * HEIGHT * 4, POLICIES = 6 };
static const double NEAR = 0.02;

static const EnfDbvDef policies[POLICIES] = {
    {ENF_DBV_CONSTANT, ENF_DBV_LCA, 7, 1U << 30}, {ENF_DBV_ADAPTIVE, ENF_DBV_NAIVE, 4, 1U << 30},
    {ENF_DBV_MAXIMAL, ENF_DBV_LCA, 16, 1U << 30}, {ENF_DBV_OPTIMAL, ENF_DBV_LCA, 8, 1U << 30},
    {ENF_DBV_REACH, ENF_DBV_LCA, 16, 1U << 30},   {ENF_DBV_CONSTANT, ENF_DBV_LCA, 1, 1U << 30},
};

typedef struct Stage {
    EnfMovingRooms moving;
    const EnfMap *map;
    EnfContext *context;
    EnfGl *gl;
    EnfGlTarget *target;
    EnfVis *vis;
    EnfDraw *draw;
    EnfDbvIndex *indices[POLICIES];
    uint8_t *pictures[4]; /* everything: colour, ids; culled: colour, ids */
    double alpha;
    uint32_t movers_seen;
} Stage;

static void open_stage(Stage *stage, const EnfMovingRoomsDef *def, EnfContextKind kind) {
    EnfError error = {0};
    memset(stage, 0, sizeof *stage);
    stage->alpha = 1.0;
    if (enf_context_create(&stage->context, kind, &error) != ENF_OK) {
        printf("no context: %s\n", error.message);
        skip();
    }
    if (!enf_moving_rooms_create(&stage->moving, def, &error)) {
        fail_msg("%s", error.message);
    }
    stage->map = stage->moving.rooms.map;
    if (enf_gl_create(&stage->gl, stage->map, enf_context_loader(stage->context), &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_gl_target_create(stage->gl, &stage->target, WIDTH, HEIGHT, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, stage->map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_draw_create(&stage->draw, stage->map, NULL, NULL), ENF_OK);
    for (uint32_t i = 0; i < POLICIES; i++) {
        assert_int_equal(enf_dbv_create(&stage->indices[i], stage->moving.world, &policies[i], NULL, NULL), ENF_OK);
    }
    for (int i = 0; i < 4; i++) {
        stage->pictures[i] = malloc(SIZE);
        assert_non_null(stage->pictures[i]);
    }
}

static void close_stage(Stage *stage) {
    for (int i = 0; i < 4; i++) {
        free(stage->pictures[i]);
    }
    for (uint32_t i = 0; i < POLICIES; i++) {
        enf_dbv_destroy(stage->indices[i]);
    }
    enf_draw_destroy(stage->draw);
    enf_vis_destroy(stage->vis);
    enf_gl_target_destroy(stage->target);
    enf_gl_destroy(stage->gl);
    enf_moving_rooms_destroy(&stage->moving);
    enf_context_destroy(stage->context);
}

static void shoot(Stage *stage, const EnfView *view, uint8_t **pictures) {
    const EnfVisSet *set = enf_vis_run(stage->vis, &stage->moving.portals, view);
    const EnfDrawList *list = enf_draw_build(stage->draw, set, NEAR, stage->moving.world, stage->alpha);
    assert_false(list->movers_failed);
    for (int mode = 0; mode < 2; mode++) {
        enf_gl_target_bind(stage->target, (EnfRenderMode)mode);
        enf_gl_draw(stage->gl, list, (EnfRenderMode)mode);
        enf_gl_target_read(stage->target, (EnfRenderMode)mode, pictures[mode]);
    }
}

/* ---- what a ray meets ------------------------------------------------------------------------------------------- */

/* The nearest point of the object's triangles, front or back, along the ray from the eye; DBL_MAX for none. */
static double ray_to_mover(const Stage *stage, const EnfDrawMover *mover, EnfVec3 direction) {
    const EnfMesh *mesh = &stage->map->meshes[mover->mesh];
    const float *m = mover->eye_from_model;
    double best = DBL_MAX;
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &stage->map->mesh_parts[p];
        for (uint32_t i = 0; i < part->index_count; i += 3) {
            EnfVec3 v[3];
            for (uint32_t k = 0; k < 3; k++) {
                const float *q = stage->map->vertices[stage->map->indices[part->index_first + i + k]].position;
                double x = (double)q[0], y = (double)q[1], z = (double)q[2];
                v[k] = enf_v3((double)m[0] * x + (double)m[3] * y + (double)m[6] * z + (double)m[9],
                              (double)m[1] * x + (double)m[4] * y + (double)m[7] * z + (double)m[10],
                              (double)m[2] * x + (double)m[5] * y + (double)m[8] * z + (double)m[11]);
            }
            EnfVec3 e1 = enf_sub(v[1], v[0]), e2 = enf_sub(v[2], v[0]), s = enf_scale(v[0], -1.0);
            EnfVec3 h = enf_cross(direction, e2), q = enf_cross(s, e1);
            double det = enf_dot(e1, h), u = enf_dot(s, h) / det, w = enf_dot(direction, q) / det, t = enf_dot(e2, q) / det;
            bool hit = det != 0.0 && u >= 0.0 && w >= 0.0 && u + w <= 1.0 && t > 0.0;
            best = hit && t < best ? t : best;
        }
    }
    return best;
}

/* What a pixel of the picture of everything shows behind all that is blended. */
static uint32_t solid_id(Stage *stage, const EnfDrawList *list, size_t pixel) {
    EnfDrawList solid = *list;
    solid.batch_count = solid.opaque_batch_count;
    uint8_t *ids = malloc(SIZE);
    assert_non_null(ids);
    enf_gl_target_bind(stage->target, ENF_RENDER_IDS);
    enf_gl_draw(stage->gl, &solid, ENF_RENDER_IDS);
    enf_gl_target_read(stage->target, ENF_RENDER_IDS, ids);
    uint32_t id = enf_test_id_at(ids, pixel);
    free(ids);
    return id;
}

/* Whose pictures, and of which eye. */
typedef struct Shot {
    Stage *stage;
    const EnfView *view;
} Shot;

/* Is what the picture of everything shows in a pixel really there, in front of all walls? Rooms of this scene have T-junctions (a
 * door's corner on the edge of a ceiling), between whose triangles the rasteriser may let what is behind shine through; exact rays
 * meet the wall there. tests/golden/test_levels excuses nothing: compiled levels are welded. */
static bool is_real(const void *user, size_t pixel) {
    const Shot *shot = user;
    Stage *stage = shot->stage;
    const EnfCamera *camera = &shot->view->camera;
    EnfView all = *shot->view;
    all.cull = ENF_CULL_NONE;
    all.dbv = NULL;
    const EnfVisSet *set = enf_vis_run(stage->vis, &stage->moving.portals, &all);
    const EnfDrawList *list = enf_draw_build(stage->draw, set, NEAR, stage->moving.world, stage->alpha);
    uint32_t id = enf_test_id_at(stage->pictures[1], pixel);
    if (id == enf_test_id_at(stage->pictures[3], pixel)) { /* the same pane in both: it is what lies behind that differs */
        id = solid_id(stage, list, pixel);
    }
    for (int i = 0; i < ENF_TEST_RAYS; i++) {
        double uv[2];
        enf_test_ray_of(pixel, WIDTH, i, uv);
        double x = (2.0 * uv[0] / WIDTH - 1.0) * camera->tan_x, y = (2.0 * uv[1] / HEIGHT - 1.0) * camera->tan_y;
        EnfVec3 direction = enf_add(camera->forward, enf_add(enf_scale(camera->right, x), enf_scale(camera->up, y)));
        uint32_t cluster = ENF_NONE;
        double wall = DBL_MAX, nearest = DBL_MAX;
        bool sure = enf_oracle_ray(stage->map, camera, uv[0], uv[1], &cluster, &wall);
        for (uint32_t m = 0; m < list->mover_count; m++) {
            if (list->movers[m].object + stage->map->clusters_count + 1 == id) {
                nearest = ray_to_mover(stage, &list->movers[m], direction);
            }
        }
        if (sure && (id == cluster + 1 || nearest < wall)) {
            return true;
        }
    }
    return false;
}

static uint32_t count_lost(Stage *stage, const EnfView *view) {
    if (memcmp(stage->pictures[0], stage->pictures[2], SIZE) == 0 &&
        memcmp(stage->pictures[1], stage->pictures[3], SIZE) == 0) {
        return 0;
    }
    uint8_t *const *of = stage->pictures;
    const EnfTestPictures pictures = {{of[0], of[1], of[2], of[3]}, (size_t)WIDTH * HEIGHT};
    const Shot shot = {stage, view};
    return enf_test_count_lost(&pictures, is_real, &shot);
}

/* ---- eyes ------------------------------------------------------------------------------------------------------- */

/* Away from walls: in a shut door there is nothing to see, and both rooms beside it. */
static EnfVec3 in_room(const Stage *stage, EnfTestRng *rng) {
    EnfBox3 box = enf_rooms_box(&stage->moving.rooms, enf_test_below(rng, stage->map->cells_count));
    return enf_v3(enf_test_double(rng, box.min.x + 0.2, box.max.x - 0.2),
                  enf_test_double(rng, box.min.y + 0.2, box.max.y - 0.2),
                  enf_test_double(rng, box.min.z + 0.2, box.max.z - 0.2));
}

/* In the opening of a door that is open, or anywhere in a room. */
static EnfVec3 in_door(const Stage *stage, EnfTestRng *rng) {
    uint32_t p = enf_test_below(rng, stage->map->portals_count);
    if (!enf_portals_is_open(&stage->moving.portals, p)) {
        return in_room(stage, rng);
    }
    const EnfPortal *portal = &stage->map->portals[p];
    const EnfVec3f *v = &stage->map->portal_vertices[portal->vertex_first];
    const double *o = stage->map->cells[portal->source].origin;
    EnfVec3 middle = enf_scale(enf_add(enf_v3_from_f(v[0]), enf_v3_from_f(v[2])), 0.5);
    EnfVec3 away = enf_v3(enf_test_double(rng, -0.3, 0.3), enf_test_double(rng, -0.3, 0.3), enf_test_double(rng, -0.3, 0.3));
    return enf_add(enf_add(enf_v3(o[0], o[1], o[2]), middle), away);
}

static EnfView random_view(const Stage *stage, EnfTestRng *rng, uint32_t round) {
    EnfVec3 eye;
    do {
        eye = round % 3 == 2 ? in_door(stage, rng) : in_room(stage, rng);
    } while (enf_rooms_in_furniture(&stage->moving.rooms, eye, 0.1));
    EnfView view = enf_view_default();
    view.camera = enf_camera(eye, enf_turn(enf_test_double(rng, -180.0, 180.0), enf_test_double(rng, -40.0, 40.0), 0.0),
                             enf_test_double(rng, 40.0, 90.0), WIDTH, HEIGHT);
    view.cell = enf_rooms_cell_at(&stage->moving.rooms, eye);
    return view;
}

/* ---- equality --------------------------------------------------------------------------------------------------- */

static void count_movers(Stage *stage) {
    for (size_t i = 0; i < SIZE / 4; i++) {
        stage->movers_seen += enf_test_id_at(stage->pictures[1], i) > stage->map->clusters_count ? 1U : 0U;
    }
}

/* Every policy looks with its own way to cull, a different one in each frame. */
static void check_frame(Stage *stage, EnfView view, uint32_t frame) {
    static const struct {
        EnfCull cull;
        EnfWindowMode window;
    } ways[] = {{ENF_CULL_WORKLIST, ENF_WINDOW_BOX},     {ENF_CULL_SEQUENCES, ENF_WINDOW_POLYGON},
                {ENF_CULL_WORKLIST, ENF_WINDOW_POLYGON}, {ENF_CULL_SEQUENCES, ENF_WINDOW_BOX},
                {ENF_CULL_FRUSTUM, ENF_WINDOW_BOX},      {ENF_CULL_NONE, ENF_WINDOW_BOX}};
    view.cull = ENF_CULL_NONE;
    view.dbv = NULL;
    shoot(stage, &view, stage->pictures);
    count_movers(stage);
    for (uint32_t i = 0; i < POLICIES; i++) {
        uint32_t way = (frame + i) % 6;
        view.cull = ways[way].cull;
        view.window = ways[way].window;
        view.dbv = stage->indices[i];
        shoot(stage, &view, stage->pictures + 2);
        uint32_t lost = count_lost(stage, &view);
        if (lost) {
            EnfVec3 e = view.camera.eye_ws;
            fail_msg("frame %u, policy %u, cull %d, window %d: %u pixels lost; eye %.17g %.17g %.17g in cell %u", frame, i,
                     view.cull, view.window, lost, e.x, e.y, e.z, view.cell);
        }
    }
}

/* Volumes must see every tick, pictures are taken of some. */
static void pass_tick(Stage *stage, const EnfView *view) {
    enf_moving_rooms_step(&stage->moving);
    EnfView blind = *view;
    for (uint32_t i = 0; i < POLICIES; i++) {
        blind.dbv = stage->indices[i];
        enf_vis_run(stage->vis, &stage->moving.portals, &blind);
    }
}

static void culled_equals_unculled(EnfContextKind kind, bool trail, uint64_t stream) {
    EnfTestRng rng = enf_test_rng(stream);
    EnfMovingRoomsDef def = enf_moving_rooms_def_default();
    def.rooms.seed = enf_test_u64(&rng);
    def.trail = trail;
    Stage stage;
    open_stage(&stage, &def, kind);
    EnfView view = random_view(&stage, &rng, 0);
    for (uint32_t frame = 0; frame < enf_test_rounds(40, 2000); frame++) {
        uint32_t ticks = 1 + (frame % 8 == 7 ? 60 : enf_test_below(&rng, 4));
        for (uint32_t i = 1; i < ticks; i++) {
            pass_tick(&stage, &view);
        }
        enf_moving_rooms_step(&stage.moving);
        view = frame % 2 ? random_view(&stage, &rng, frame) : view; /* every eye looks twice */
        bool open = enf_rooms_cell_at(&stage.moving.rooms, view.camera.eye_ws) == view.cell;
        assert_true(open);
        stage.alpha = trail ? enf_test_double(&rng, 0.0, 1.0) : 1.0;
        check_frame(&stage, view, frame);
    }
    assert_true(stage.movers_seen > 1000);
    close_stage(&stage);
}

static void culled_equals_unculled_with_egl(void **state) {
    (void)state;
    culled_equals_unculled(ENF_CONTEXT_EGL, false, 1);
}

static void culled_equals_unculled_with_osmesa(void **state) {
    (void)state;
    culled_equals_unculled(ENF_CONTEXT_OSMESA, false, 2);
}

static void pictures_between_ticks_lose_nothing(void **state) {
    (void)state;
    culled_equals_unculled(ENF_CONTEXT_ANY, true, 3);
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

static const EnfDrawMover *find_mover(const EnfDrawList *list, uint32_t object) {
    for (uint32_t i = 0; i < list->mover_count; i++) {
        if (list->movers[i].object == object) {
            return &list->movers[i];
        }
    }
    return NULL;
}

/* The same object, listed alone by a culled view and among all: one light, to the last bit. */
static void light_does_not_ask_what_is_visible(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    EnfMovingRoomsDef def = enf_moving_rooms_def_default();
    def.movers = 16;
    Stage stage;
    open_stage(&stage, &def, ENF_CONTEXT_ANY);
    EnfDraw *draw_all;
    EnfGlLights lights;
    assert_int_equal(enf_draw_create(&draw_all, stage.map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_gl_lights_build(&lights, stage.map, NULL), ENF_OK);
    uint32_t compared = 0, lit = 0;
    for (uint32_t round = 0; round < enf_test_rounds(50, 1000); round++) {
        EnfView view = random_view(&stage, &rng, round), all = view;
        enf_moving_rooms_step(&stage.moving);
        view.dbv = stage.indices[2];
        all.cull = ENF_CULL_NONE;
        const EnfDrawList *everything = enf_draw_build(draw_all, enf_vis_run(stage.vis, &stage.moving.portals, &all), NEAR,
                                                       stage.moving.world, 1.0);
        const EnfDrawList *list = enf_draw_build(stage.draw, enf_vis_run(stage.vis, &stage.moving.portals, &view), NEAR,
                                                 stage.moving.world, 1.0);
        assert_true(list->mover_count <= everything->mover_count);
        for (uint32_t i = 0; i < list->mover_count; i++) {
            static EnfGlMoverLights a, b;
            const EnfDrawMover *other = find_mover(everything, list->movers[i].object);
            assert_non_null(other);
            enf_gl_mover_lights(&a, &lights, stage.map, &list->movers[i]);
            enf_gl_mover_lights(&b, &lights, stage.map, other);
            assert_int_equal(a.count, b.count);
            assert_memory_equal(a.vectors, b.vectors, a.count * sizeof *a.vectors);
            lit += a.light_count > 0 ? 1U : 0U;
            compared++;
        }
    }
    assert_true(compared > 100 && lit > compared / 2);
    enf_gl_lights_free(&lights);
    enf_draw_destroy(draw_all);
    close_stage(&stage);
}

/* A room with three lamps of different colour, one of them behind a window, and a box in it: at rest, or a mesh of its own. */
static EnfMaker *make_lit_room(bool moves) {
    static const EnfBox3 room = {{0, 0, 0}, {6, 3, 6}}, thing = {{-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}};
    static const EnfPlane4f window[2] = {{{0.8f, 0.0f, 0.6f}, 0.0f}, {{-0.6f, 0.0f, 0.8f}, 0.0f}};
    EnfMaker *maker = enf_maker_create();
    assert_non_null(maker);
    uint32_t cell;
    enf_maker_cell(maker, "room", enf_v3(0, 0, 0), &cell);
    enf_maker_box(maker, cell, 0, room, true);
    enf_maker_material(maker, "thing", 0.8f, 0.8f, 0.8f);
    enf_maker_light(maker, cell, enf_v3(1, 2.5, 1), (EnfVec3f){12, 3, 3}, 9);
    enf_maker_light(maker, cell, enf_v3(5, 2, 2), (EnfVec3f){3, 12, 3}, 9);
    enf_maker_light(maker, cell, enf_v3(2, 1, 1.5), (EnfVec3f){3, 3, 12}, 9);
    enf_maker_light_window(maker, window, 2);
    enf_maker_group(maker);
    EnfBox3 placed = {enf_add(thing.min, enf_v3(3, 1.25, 3)), enf_add(thing.max, enf_v3(3, 1.25, 3))};
    if (moves) {
        enf_maker_mesh(maker, "thing", 1, thing);
    } else {
        enf_maker_box(maker, cell, 1, placed, false);
    }
    return maker;
}

/* Of twenty equal lamps the eight nearest to the object's box, nearest first. */
static void the_brightest_lights_are_chosen(void **state) {
    (void)state;
    enum { LAMPS = 20 };
    EnfTestRng rng = enf_test_rng(5);
    EnfMaker *maker = enf_maker_create();
    uint32_t cell;
    EnfVec3 lamps[LAMPS];
    assert_non_null(maker);
    enf_maker_cell(maker, "room", enf_v3(0, 0, 0), &cell);
    enf_maker_box(maker, cell, 0, (EnfBox3){{0, 0, 0}, {20, 4, 20}}, true);
    enf_maker_mesh(maker, "thing", 0, (EnfBox3){{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}});
    for (uint32_t i = 0; i < LAMPS; i++) {
        lamps[i] = enf_v3(enf_test_double(&rng, 0.5, 19.5), 3.5, enf_test_double(&rng, 0.5, 19.5));
        enf_maker_light(maker, cell, lamps[i], (EnfVec3f){200, 200, 200}, 40);
    }
    const EnfMap *map = enf_maker_finish(maker, NULL);
    assert_non_null(map);
    EnfGlLights lights;
    assert_int_equal(enf_gl_lights_build(&lights, map, NULL), ENF_OK);
    for (uint32_t round = 0; round < 100; round++) {
        static EnfGlMoverLights chosen;
        EnfDrawMover mover = {.cell_count = 1, .box = {{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}};
        mover.position_ws = enf_v3(enf_test_double(&rng, 1, 19), 1, enf_test_double(&rng, 1, 19));
        enf_gl_mover_lights(&chosen, &lights, map, &mover);
        double farthest = 0.0;
        for (uint32_t i = 0; i < chosen.light_count; i++) {
            EnfVec3 to = enf_sub(lamps[chosen.numbers[i]], mover.position_ws);
            double x = fmax(fabs(to.x) - 0.5, 0.0), z = fmax(fabs(to.z) - 0.5, 0.0), d = x * x + 4.0 + z * z;
            assert_true(d >= farthest - 1e-4);
            farthest = d;
        }
        assert_in_range(chosen.light_count, 1, ENF_GL_MOVER_LIGHTS);
        for (uint32_t k = 0; k < LAMPS && chosen.light_count == ENF_GL_MOVER_LIGHTS; k++) {
            bool listed = false;
            for (uint32_t i = 0; i < chosen.light_count; i++) {
                listed = listed || chosen.numbers[i] == k;
            }
            EnfVec3 to = enf_sub(lamps[k], mover.position_ws);
            double x = fmax(fabs(to.x) - 0.5, 0.0), z = fmax(fabs(to.z) - 0.5, 0.0);
            assert_true(listed || x * x + 4.0 + z * z >= farthest - 1e-4);
        }
    }
    enf_gl_lights_free(&lights);
    enf_maker_destroy(maker);
}

static void add_thing(EnfMaker *maker) {
    enf_maker_mesh(maker, "thing", 0, (EnfBox3){{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}});
}

/* How much of the slot's light a point gets through its windows, as the shader has it. */
static float through(const EnfGlMoverLights *lights, uint32_t slot, EnfVec3 p) {
    int code = (int)lights->vectors[ENF_GL_MOVER_HEAD + slot * ENF_GL_MOVER_LIGHT_VECTORS + 1][3];
    uint32_t first = ENF_GL_MOVER_HEAD + lights->light_count * ENF_GL_MOVER_LIGHT_VECTORS + (uint32_t)code / 128;
    float lit = code == 0 ? 1.0f : 0.0f, window = 1.0f;
    for (uint32_t i = first; i < first + (uint32_t)code % 128; i++) {
        const float *plane = lights->vectors[i];
        float inside = plane[0] * (float)p.x + plane[1] * (float)p.y + plane[2] * (float)p.z + plane[3];
        if (plane[0] == 0.0f && plane[1] == 0.0f && plane[2] == 0.0f) {
            lit = fmaxf(lit, window);
            window = 1.0f;
        } else {
            window = fminf(window, fminf(fmaxf(inside, 0.0f), 1.0f));
        }
    }
    return lit;
}

/* Each room's lamp reaches its own room alone: what stands between two has both, each on its own side. */
static void both_rooms_light_what_stands_between(void **state) {
    (void)state;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfRooms rooms;
    EnfGlLights lights;
    EnfGlMoverLights found;
    def.nx = 2;
    def.nz = 1;
    def.extend = add_thing;
    assert_true(enf_rooms_create(&rooms, &def, NULL));
    assert_int_equal(enf_gl_lights_build(&lights, rooms.map, NULL), ENF_OK);
    double wall = enf_rooms_box(&rooms, 0).max.x;
    EnfDrawMover mover = {.cell_count = 2, .cells = {0, 1}, .box = {{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}};
    mover.position_ws = enf_v3(wall, 1.0, 2.5);
    enf_gl_mover_lights(&found, &lights, rooms.map, &mover);
    assert_int_equal(found.light_count, 2);
    for (uint32_t slot = 0; slot < 2; slot++) {
        double side = found.numbers[slot] == 0 ? -0.1 : 0.1; /* lamps are numbered as rooms are */
        assert_true(through(&found, slot, enf_v3(side, 0.0, 0.0)) == 1.0f);
        assert_true(through(&found, slot, enf_v3(-side, 0.0, 0.0)) == 0.0f);
        assert_true(through(&found, slot, enf_v3(0.0, 0.0, 0.0)) == 1.0f);
    }
    mover.cell_count = 1; /* wholly in one room: no window is needed */
    mover.position_ws.x = wall - 1.0;
    enf_gl_mover_lights(&found, &lights, rooms.map, &mover);
    assert_int_equal(found.light_count, 1);
    assert_true(through(&found, 0, enf_v3(0.4, 0.0, 0.0)) == 1.0f);
    enf_gl_lights_free(&lights);
    enf_rooms_destroy(&rooms);
}

static void shoot_lit_room(bool moves, EnfVec3 eye, double yaw, uint8_t *picture) {
    EnfMaker *maker = make_lit_room(moves);
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(maker, &error);
    if (!map) {
        fail_msg("%s", error.message);
    }
    Stage stage = {.map = map};
    assert_int_equal(enf_context_create(&stage.context, ENF_CONTEXT_ANY, NULL), ENF_OK);
    assert_int_equal(enf_gl_create(&stage.gl, map, enf_context_loader(stage.context), &error), ENF_OK);
    assert_int_equal(enf_gl_target_create(stage.gl, &stage.target, WIDTH, HEIGHT, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&stage.vis, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_draw_create(&stage.draw, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_portals_create(&stage.moving.portals, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_world_create(&stage.moving.world, map, 1, NULL, NULL), ENF_OK);
    EnfObjectDef def = enf_object_def_default();
    def.mesh = 0;
    def.motion.as.still.position = enf_v3(3, 1.25, 3);
    if (moves) {
        enf_world_add(stage.moving.world, &def, NULL);
    }
    EnfView view = enf_view_default();
    view.camera = enf_camera(eye, enf_turn(yaw, 0.0, 0.0), 60.0, WIDTH, HEIGHT);
    view.cell = 0;
    const EnfVisSet *set = enf_vis_run(stage.vis, &stage.moving.portals, &view);
    const EnfDrawList *list = enf_draw_build(stage.draw, set, NEAR, stage.moving.world, 1.0);
    enf_gl_target_bind(stage.target, ENF_RENDER_COLOR);
    enf_gl_draw(stage.gl, list, ENF_RENDER_COLOR);
    enf_gl_target_read(stage.target, ENF_RENDER_COLOR, picture);
    enf_world_destroy(stage.moving.world);
    enf_portals_destroy(&stage.moving.portals);
    enf_draw_destroy(stage.draw);
    enf_vis_destroy(stage.vis);
    enf_gl_target_destroy(stage.target);
    enf_gl_destroy(stage.gl);
    enf_context_destroy(stage.context);
    enf_maker_destroy(maker);
}

/* The same box as a cluster (its light baked at its vertices) and as a mover (the same formulas in the shader). A baked light is stored
 * in a byte: four steps of the picture are allowed. */
static void movers_look_like_walls(void **state) {
    (void)state;
    static const struct {
        EnfVec3 eye;
        double yaw;
    } eyes[] = {{{3, 1.5, 5.5}, 0.0}, {{0.5, 2.0, 3}, -90.0}, {{3, 1.0, 0.5}, 180.0}, {{5.5, 1.5, 3}, 90.0}};
    EnfContext *context;
    if (enf_context_create(&context, ENF_CONTEXT_ANY, NULL) != ENF_OK) {
        skip();
    }
    enf_context_destroy(context);
    uint8_t *rest = malloc(SIZE), *moved = malloc(SIZE);
    assert_true(rest && moved);
    for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++) {
        shoot_lit_room(false, eyes[e].eye, eyes[e].yaw, rest);
        shoot_lit_room(true, eyes[e].eye, eyes[e].yaw, moved);
        int most = 0;
        for (size_t i = 0; i < SIZE; i++) {
            int d = abs((int)rest[i] - (int)moved[i]);
            most = d > most ? d : most;
        }
        assert_in_range(most, 0, 4);
    }
    free(rest);
    free(moved);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(light_does_not_ask_what_is_visible),   cmocka_unit_test(movers_look_like_walls),
    cmocka_unit_test(culled_equals_unculled_with_egl),      cmocka_unit_test(culled_equals_unculled_with_osmesa),
    cmocka_unit_test(pictures_between_ticks_lose_nothing),  cmocka_unit_test(the_brightest_lights_are_chosen),
    cmocka_unit_test(both_rooms_light_what_stands_between),
};

ENF_TEST_MAIN(tests)

/* engine/gl: culled pictures equal unculled ones byte for byte, in both headless contexts; the id-buffer names what rays
 * hit; colours come out as they went in. No picture is stored: both sides of each comparison are drawn in this run. */
#include "harness/harness.h"
#include "harness/pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <enfilade/gl.h>

#include "gl/lights.h"
#include "scenes/oracle.h"
#include "scenes/rooms.h"

enum { WIDTH = 320, HEIGHT = 240, SIZE = WIDTH * HEIGHT * 4 };
#define PIXEL(x, y) ((size_t)(y)*WIDTH + (x))
static const double NEAR = 0.02;

/* A map on a target in a context, with the visibility of two views: everything, and culled. */
typedef struct Stage {
    const EnfMap *map;
    EnfContext *context;
    EnfGl *gl;
    EnfGlTarget *target;
    EnfPortals portals;
    EnfVis *vis, *vis_all;
    EnfDraw *draw, *draw_all;
    uint8_t *pictures[4];
} Stage;

/* Skips the running case where this machine has no such context. */
static void open_stage(Stage *stage, const EnfMap *map, EnfContextKind kind) {
    EnfError error = {0};
    memset(stage, 0, sizeof *stage);
    stage->map = map;
    if (enf_context_create(&stage->context, kind, &error) != ENF_OK) {
        printf("no context: %s\n", error.message);
        skip();
    }
    if (enf_gl_create(&stage->gl, map, enf_context_loader(stage->context), &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_gl_target_create(stage->gl, &stage->target, WIDTH, HEIGHT, NULL), ENF_OK);
    assert_int_equal(enf_portals_create(&stage->portals, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_vis_create(&stage->vis_all, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_draw_create(&stage->draw, map, NULL, NULL), ENF_OK);
    assert_int_equal(enf_draw_create(&stage->draw_all, map, NULL, NULL), ENF_OK);
    for (int i = 0; i < 4; i++) {
        stage->pictures[i] = malloc(SIZE);
        assert_non_null(stage->pictures[i]);
    }
}

static void close_stage(Stage *stage) {
    for (int i = 0; i < 4; i++) {
        free(stage->pictures[i]);
    }
    enf_draw_destroy(stage->draw_all);
    enf_draw_destroy(stage->draw);
    enf_vis_destroy(stage->vis_all);
    enf_vis_destroy(stage->vis);
    enf_portals_destroy(&stage->portals);
    enf_gl_target_destroy(stage->target);
    enf_gl_destroy(stage->gl);
    enf_context_destroy(stage->context);
}

static void shoot(Stage *stage, const EnfDrawList *list, EnfRenderMode mode, uint8_t *picture) {
    enf_gl_target_bind(stage->target, mode);
    enf_gl_draw(stage->gl, list, mode);
    enf_gl_target_read(stage->target, mode, picture);
}

/* Draws everything into pictures 0 (colour) and 1 (ids). */
static void shoot_all(Stage *stage, const EnfView *view) {
    EnfView all = *view;
    all.cull = ENF_CULL_NONE;
    const EnfDrawList *list = enf_draw_build(stage->draw_all, enf_vis_run(stage->vis_all, &stage->portals, &all), NEAR, NULL,
                                             1.0);
    shoot(stage, list, ENF_RENDER_COLOR, stage->pictures[0]);
    shoot(stage, list, ENF_RENDER_IDS, stage->pictures[1]);
}

/* Draws what `view` sees into pictures 2 and 3; returns its list. */
static const EnfDrawList *shoot_culled(Stage *stage, const EnfView *view) {
    const EnfDrawList *list = enf_draw_build(stage->draw, enf_vis_run(stage->vis, &stage->portals, view), NEAR, NULL, 1.0);
    shoot(stage, list, ENF_RENDER_COLOR, stage->pictures[2]);
    shoot(stage, list, ENF_RENDER_IDS, stage->pictures[3]);
    return list;
}

/* Whose pictures, and of which eye. */
typedef struct Shot {
    const Stage *stage;
    const EnfCamera *camera;
} Shot;

/* Does an exact ray through the middle of the pixel, or nearly, meet the cluster that the unculled picture shows? */
static bool is_real(const void *user, size_t pixel) {
    const Shot *shot = user;
    for (int i = 0; i < ENF_TEST_RAYS; i++) {
        uint32_t cluster;
        double t, uv[2];
        enf_test_ray_of(pixel, WIDTH, i, uv);
        if (enf_oracle_ray(shot->stage->map, shot->camera, uv[0], uv[1], &cluster, &t) &&
            enf_test_id_at(shot->stage->pictures[1], pixel) == cluster + 1) {
            return true;
        }
    }
    return false;
}

/* Pixels that differ. Rooms of this scene have T-junctions (a door's corner on the edge of a ceiling), between whose
 * triangles the rasteriser may let a pixel of what is behind shine through; exact rays meet the wall there and not what
 * the unculled picture shows, and such pixels are not counted. Levels are welded by the compiler: for them
 * tests/golden/test_levels excuses nothing. */
static uint32_t count_lost(const Stage *stage, const EnfCamera *camera) {
    uint8_t *const *of = stage->pictures;
    const EnfTestPictures pictures = {{of[0], of[1], of[2], of[3]}, (size_t)WIDTH * HEIGHT};
    const Shot shot = {stage, camera};
    return enf_test_count_lost(&pictures, is_real, &shot);
}

/* ---- eyes ------------------------------------------------------------------------------------------------------- */

static EnfRooms make_rooms(void) {
    EnfRoomsDef def = enf_rooms_def_default();
    EnfRooms rooms;
    EnfError error = {0};
    def.thresholds = true;
    if (!enf_rooms_create(&rooms, &def, &error)) {
        fail_msg("%s", error.message);
    }
    return rooms;
}

/* A point of a random portal, at most `far` metres before or behind it. */
static EnfVec3 near_portal(const EnfMap *map, EnfTestRng *rng, double far) {
    const EnfPortal *portal = &map->portals[enf_test_below(rng, map->portals_count)];
    const EnfVec3f *v = &map->portal_vertices[portal->vertex_first];
    const double *o = map->cells[portal->source].origin;
    EnfVec3 a = enf_v3_from_f(v[0]), u = enf_sub(enf_v3_from_f(v[1]), a), w = enf_sub(enf_v3_from_f(v[3]), a);
    EnfVec3 p = enf_add(enf_add(a, enf_scale(u, enf_test_double(rng, 0.1, 0.9))), enf_scale(w, enf_test_double(rng, 0.1, 0.9)));
    EnfVec3 n = enf_normalize(enf_cross(u, w));
    p = enf_add(p, enf_scale(n, enf_test_double(rng, -far, far)));
    return enf_add(p, enf_v3(o[0], o[1], o[2]));
}

static EnfVec3 in_room(const EnfRooms *rooms, EnfTestRng *rng) {
    EnfBox3 box = enf_rooms_box(rooms, enf_test_below(rng, rooms->map->cells_count));
    double margin = 0.1;
    return enf_v3(enf_test_double(rng, box.min.x + margin, box.max.x - margin),
                  enf_test_double(rng, box.min.y + margin, box.max.y - margin),
                  enf_test_double(rng, box.min.z + margin, box.max.z - margin));
}

/* An eye in a room, near a portal, or on it: outside of furniture, from which nothing would be seen anyway. */
static EnfView random_view(const EnfRooms *rooms, EnfTestRng *rng, uint32_t round) {
    static const double distances[] = {0.5, 0.01, 1e-6};
    EnfVec3 eye;
    do {
        eye = round % 4 == 0 ? in_room(rooms, rng) : near_portal(rooms->map, rng, distances[round % 4 - 1]);
    } while (enf_rooms_in_furniture(rooms, eye, 0.1));
    EnfView view = enf_view_default();
    double roll = round % 3 ? 0.0 : enf_test_double(rng, -180.0, 180.0);
    view.camera = enf_camera(eye, enf_turn(enf_test_double(rng, -180.0, 180.0), enf_test_double(rng, -60.0, 60.0), roll),
                             enf_test_double(rng, 30.0, 100.0), WIDTH, HEIGHT);
    view.cell = enf_rooms_cell_at(rooms, eye);
    return view;
}

/* ---- equality --------------------------------------------------------------------------------------------------- */

static void check_view(Stage *stage, EnfView view, uint32_t round) {
    static const struct {
        EnfCull cull;
        EnfWindowMode window;
    } ways[] = {{ENF_CULL_WORKLIST, ENF_WINDOW_BOX},
                {ENF_CULL_SEQUENCES, ENF_WINDOW_POLYGON},
                {ENF_CULL_WORKLIST, ENF_WINDOW_POLYGON},
                {ENF_CULL_SEQUENCES, ENF_WINDOW_BOX},
                {ENF_CULL_FRUSTUM, ENF_WINDOW_BOX}};
    shoot_all(stage, &view);
    for (int i = 0; i < 5; i++) {
        view.cull = ways[i].cull;
        view.window = ways[i].window;
        shoot_culled(stage, &view);
        uint32_t lost = count_lost(stage, &view.camera);
        if (lost) {
            EnfVec3 e = view.camera.eye_ws;
            fail_msg("view %u, cull %d, window %d: %u pixels lost; eye %.17g %.17g %.17g in cell %u", round, view.cull,
                     view.window, lost, e.x, e.y, e.z, view.cell);
        }
    }
}

static void culled_equals_unculled(EnfContextKind kind, uint64_t stream) {
    EnfTestRng rng = enf_test_rng(stream);
    EnfRooms rooms = make_rooms();
    Stage stage;
    open_stage(&stage, rooms.map, kind);
    for (uint32_t round = 0; round < enf_test_rounds(24, 1000); round++) {
        check_view(&stage, random_view(&rooms, &rng, round), round);
    }
    close_stage(&stage);
    enf_rooms_destroy(&rooms);
}

static void culled_equals_unculled_with_egl(void **state) {
    (void)state;
    culled_equals_unculled(ENF_CONTEXT_EGL, 1);
}

static void culled_equals_unculled_with_osmesa(void **state) {
    (void)state;
    culled_equals_unculled(ENF_CONTEXT_OSMESA, 2);
}

static void both_contexts_draw_the_same(void **state) {
    (void)state;
    EnfRooms rooms = make_rooms();
    uint64_t hashes[2];
    for (int kind = 0; kind < 2; kind++) {
        EnfTestRng rng = enf_test_rng_fixed(3, 3);
        Stage stage;
        open_stage(&stage, rooms.map, kind ? ENF_CONTEXT_OSMESA : ENF_CONTEXT_EGL);
        assert_string_equal(enf_context_name(stage.context), kind ? "osmesa" : "egl");
        hashes[kind] = ENF_HASH_START;
        for (uint32_t round = 0; round < 6; round++) {
            EnfView view = random_view(&rooms, &rng, round);
            shoot_culled(&stage, &view);
            hashes[kind] = enf_hash64(enf_hash64(hashes[kind], stage.pictures[2], SIZE), stage.pictures[3], SIZE);
        }
        close_stage(&stage);
    }
    assert_true(hashes[0] == hashes[1]);
    enf_rooms_destroy(&rooms);
}

/* ---- ids -------------------------------------------------------------------------------------------------------- */

/* Is the pixel inside one cluster, away from its edges? */
static bool is_inner(const uint8_t *ids, uint32_t x, uint32_t y) {
    for (uint32_t v = y - 1; v <= y + 1; v++) {
        for (uint32_t u = x - 1; u <= x + 1; u++) {
            if (enf_test_id_at(ids, PIXEL(u, v)) != enf_test_id_at(ids, PIXEL(x, y))) {
                return false;
            }
        }
    }
    return true;
}

static void ids_name_what_rays_hit(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(4);
    EnfRooms rooms = make_rooms();
    Stage stage;
    open_stage(&stage, rooms.map, ENF_CONTEXT_ANY);
    uint32_t compared = 0;
    for (uint32_t round = 0; round < enf_test_rounds(8, 100); round++) {
        EnfView view = random_view(&rooms, &rng, 0);
        shoot_all(&stage, &view);
        for (uint32_t i = 0; i < 100; i++) {
            uint32_t x = 1 + enf_test_below(&rng, WIDTH - 2), y = 1 + enf_test_below(&rng, HEIGHT - 2);
            uint32_t cluster;
            double t;
            if (is_inner(stage.pictures[1], x, y) && enf_oracle_ray(rooms.map, &view.camera, x + 0.5, y + 0.5, &cluster, &t)) {
                assert_int_equal(enf_test_id_at(stage.pictures[1], PIXEL(x, y)), cluster + 1);
                compared++;
            }
        }
    }
    assert_true(compared > 200);
    close_stage(&stage);
    enf_rooms_destroy(&rooms);
}

/* ---- colours ---------------------------------------------------------------------------------------------------- */

/* A wall two metres in front of an eye at the origin that looks down −Z, of two layers: the nearer one is `front`. */
static EnfMaker *make_wall(EnfMaterial **back, EnfMaterial **front, const uint8_t *texel) {
    EnfMaker *maker = enf_maker_create();
    assert_non_null(maker);
    uint32_t cell;
    enf_maker_cell(maker, "room", enf_v3(0, 0, 0), &cell);
    for (uint32_t layer = 0; layer < 2; layer++) {
        double z = layer ? -1.5 : -2.0;
        EnfVec3 points[4] = {{-4, -4, z}, {4, -4, z}, {4, 4, z}, {-4, 4, z}};
        EnfMaterial *material = enf_maker_material(maker, layer ? "front" : "back", 1.0f, 1.0f, 1.0f);
        material->flags = ENF_MATERIAL_UNLIT;
        *(layer ? front : back) = material;
        if (layer == 0 && texel) {
            uint32_t image = enf_maker_image(maker, 1, 1, texel);
            material->texture = enf_maker_texture(maker, image);
        }
        enf_maker_group(maker);
        enf_maker_polygon(maker, cell, 1 + layer, points, 4);
    }
    return maker;
}

static void shoot_middle(const EnfMap *map, uint8_t color[4], uint32_t *id) {
    Stage stage;
    open_stage(&stage, map, ENF_CONTEXT_ANY);
    EnfView view = enf_view_default();
    view.camera = enf_camera(enf_v3(0, 0, 0), enf_turn(0, 0, 0), 60, WIDTH, HEIGHT);
    shoot_all(&stage, &view);
    memcpy(color, stage.pictures[0] + ((size_t)HEIGHT / 2 * WIDTH + WIDTH / 2) * 4, 4);
    *id = enf_test_id_at(stage.pictures[1], PIXEL(WIDTH / 2, HEIGHT / 2));
    close_stage(&stage);
}

/* Texels are sRGB, light is linear, the target is sRGB: an unlit texel comes out as it went in. */
static void unlit_texels_come_out_unchanged(void **state) {
    (void)state;
    static const uint8_t texels[][4] = {{200, 100, 50, 255}, {1, 2, 3, 255}, {255, 128, 0, 255}};
    for (size_t i = 0; i < sizeof texels / sizeof *texels; i++) {
        EnfMaterial *back, *front;
        EnfMaker *maker = make_wall(&back, &front, texels[i]);
        front->flags |= ENF_MATERIAL_NODRAW;
        const EnfMap *map = enf_maker_finish(maker, NULL);
        assert_non_null(map);
        uint8_t color[4];
        uint32_t id;
        shoot_middle(map, color, &id);
        for (int k = 0; k < 3; k++) {
            assert_in_range(color[k] + 1, texels[i][k], texels[i][k] + 2);
        }
        assert_int_equal(id, 1);
        enf_maker_destroy(maker);
    }
}

static uint8_t encode_srgb(double linear) {
    double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
    return (uint8_t)(encoded * 255.0 + 0.5);
}

static void blending_is_linear_and_ids_take_the_front(void **state) {
    (void)state;
    EnfMaterial *back, *front;
    EnfMaker *maker = make_wall(&back, &front, NULL);
    front->alpha_mode = ENF_ALPHA_BLEND;
    front->base_color[0] = 0.0f;
    front->base_color[3] = 0.25f;
    const EnfMap *map = enf_maker_finish(maker, NULL);
    assert_non_null(map);
    uint8_t color[4];
    uint32_t id;
    shoot_middle(map, color, &id);
    assert_in_range(color[0] + 1, encode_srgb(0.75), encode_srgb(0.75) + 2);
    assert_int_equal(color[1], 255);
    assert_int_equal(id, 2);
    enf_maker_destroy(maker);
}

static void masks_cut_colour_and_ids_alike(void **state) {
    (void)state;
    for (int opaque = 0; opaque < 2; opaque++) {
        EnfMaterial *back, *front;
        EnfMaker *maker = make_wall(&back, &front, NULL);
        front->alpha_mode = ENF_ALPHA_MASK;
        front->alpha_cutoff = 0.5f;
        front->base_color[1] = 0.0f;
        front->base_color[3] = opaque ? 0.5f : 0.49f;
        const EnfMap *map = enf_maker_finish(maker, NULL);
        assert_non_null(map);
        uint8_t color[4];
        uint32_t id;
        shoot_middle(map, color, &id);
        assert_int_equal(color[1], opaque ? 0 : 255);
        assert_int_equal(id, opaque ? 2 : 1);
        enf_maker_destroy(maker);
    }
}

/* ---- lights ----------------------------------------------------------------------------------------------------- */

static void lights_are_listed_where_they_reach(void **state) {
    (void)state;
    EnfRooms rooms = make_rooms();
    EnfGlLights lights;
    assert_int_equal(enf_gl_lights_build(&lights, rooms.map, NULL), ENF_OK);
    for (uint32_t c = 0; c < rooms.map->clusters_count; c++) {
        uint32_t first = lights.cluster_lists[c] >> 8, count = (lights.cluster_lists[c] & 255u) + 1;
        assert_true(count <= rooms.map->cells[rooms.map->clusters[c].cell].light_count);
        assert_true(first + count <= lights.light_count);
    }
    enf_gl_lights_free(&lights);
    enf_rooms_destroy(&rooms);
}

/* Two references of one light are one light with two windows; one out of range or out of its windows is not listed. */
static void references_of_a_light_are_one(void **state) {
    (void)state;
    EnfCell cell = {.cluster_count = 3, .light_count = 3};
    EnfCluster clusters[3] = {
        {.min = {1, 0, 0}, .max = {2, 1, 1}}, {.min = {-2, 0, 0}, .max = {-1, 1, 1}}, {.min = {1, 0, 50}, .max = {2, 1, 51}}};
    EnfLight list[2] = {{.color = {1, 1, 1}, .range = 10}, {.color = {1, 1, 1}, .range = 10, .position = {0, 0, 45}}};
    EnfPlane4f planes[2] = {{{1, 0, 0}, 0}, {{1, 0, 0}, -0.5f}};
    EnfLightRef refs[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 1}};
    EnfMap map = {0};
    map.cells = &cell;
    map.cells_count = 1;
    map.clusters = clusters;
    map.clusters_count = 3;
    map.lights = list;
    map.lights_count = 2;
    map.light_refs = refs;
    map.light_refs_count = 3;
    map.light_planes = planes;
    map.light_planes_count = 2;
    EnfGlLights lights;
    assert_int_equal(enf_gl_lights_build(&lights, &map, NULL), ENF_OK);
    assert_int_equal(lights.plane_count, 1 + 4);        /* one that lights all; two planes, two ends */
    assert_int_equal(lights.light_count, 1 + 2);        /* the dark one; one a lit cluster */
    assert_int_equal(lights.cluster_lists[0], 1u << 8); /* the first light, in its windows */
    assert_int_equal(lights.lights[1].windows & 63u, 3);
    assert_int_equal(lights.cluster_lists[1], 0);       /* outside of both windows: dark */
    assert_int_equal(lights.cluster_lists[2], 2u << 8); /* the second light, which has none */
    assert_int_equal(lights.lights[2].windows, 0);
    enf_gl_lights_free(&lights);
}

/* ---- debug and errors ------------------------------------------------------------------------------------------- */

static void lines_and_wireframe_draw_over_the_picture(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(5, 5);
    EnfRooms rooms = make_rooms();
    Stage stage;
    open_stage(&stage, rooms.map, ENF_CONTEXT_ANY);
    EnfView view = random_view(&rooms, &rng, 0);
    const EnfDrawList *list = shoot_culled(&stage, &view);
    EnfVec3 f = view.camera.forward, r = view.camera.right;
    EnfDebugVertex line[2] = {{{(float)(f.x - r.x), (float)(f.y - r.y), (float)(f.z - r.z)}, 0xff0000ffu},
                              {{(float)(f.x + r.x), (float)(f.y + r.y), (float)(f.z + r.z)}, 0xff0000ffu}};
    enf_gl_target_bind(stage.target, ENF_RENDER_COLOR);
    enf_gl_draw_lines(stage.gl, list->clip_from_eye, line, 2, true);
    enf_gl_target_read(stage.target, ENF_RENDER_COLOR, stage.pictures[0]);
    uint32_t changed = enf_test_differing(stage.pictures[0], stage.pictures[2], (size_t)WIDTH * HEIGHT);
    assert_in_range(changed, WIDTH / 2, 2 * WIDTH);
    enf_gl_draw_wireframe(stage.gl, list, 0xffffffffu);
    enf_gl_target_read(stage.target, ENF_RENDER_COLOR, stage.pictures[1]);
    assert_true(enf_test_differing(stage.pictures[1], stage.pictures[2], (size_t)WIDTH * HEIGHT) > changed);
    shoot(&stage, list, ENF_RENDER_COLOR, stage.pictures[1]); /* and leave no state behind */
    assert_int_equal(enf_test_differing(stage.pictures[1], stage.pictures[2], (size_t)WIDTH * HEIGHT), 0);
    close_stage(&stage);
    enf_rooms_destroy(&rooms);
}

/* A window is framebuffer 0 of somebody's context; OSMesa has one, of 16 × 16 px. The loader is the caller's own. */
static EnfGlLoadFn *foreign;

static void *load_foreign(const char *name) {
    return foreign(name);
}

typedef void ReadFn(int x, int y, int width, int height, unsigned format, unsigned type, void *pixels);

static void pictures_are_shown_in_windows(void **state) {
    (void)state;
    enum { WINDOW = 16 };
    EnfTestRng rng = enf_test_rng_fixed(6, 6);
    EnfRooms rooms = make_rooms();
    EnfError error = {0};
    Stage stage;
    open_stage(&stage, rooms.map, ENF_CONTEXT_OSMESA);
    foreign = enf_context_loader(stage.context);
    EnfGl *gl;
    EnfGlTarget *target;
    assert_int_equal(enf_gl_create(&gl, rooms.map, load_foreign, &error), ENF_OK);
    assert_int_equal(enf_gl_target_create(gl, &target, WINDOW, WINDOW, &error), ENF_OK);
    EnfView view = random_view(&rooms, &rng, 0);
    const EnfDrawList *list = enf_draw_build(stage.draw, enf_vis_run(stage.vis, &stage.portals, &view), NEAR, NULL, 1.0);
    uint8_t made[WINDOW * WINDOW * 4], shown[WINDOW * WINDOW * 4];
    enf_gl_target_bind(target, ENF_RENDER_COLOR);
    enf_gl_draw(gl, list, ENF_RENDER_COLOR);
    enf_gl_target_read(target, ENF_RENDER_COLOR, made);
    enf_gl_target_show(target, WINDOW, WINDOW);
    ReadFn *read;
    void *address = foreign("glReadPixels");
    memcpy(&read, &address, sizeof read);
    read(0, 0, WINDOW, WINDOW, 0x1908 /* GL_RGBA */, 0x1401 /* GL_UNSIGNED_BYTE */, shown);
    assert_memory_equal(made, shown, sizeof made);
    enf_gl_target_destroy(target);
    enf_gl_destroy(gl);
    close_stage(&stage);
    enf_rooms_destroy(&rooms);
}

static void *load_nothing(const char *name) {
    (void)name;
    return NULL;
}

static void failures_are_reported(void **state) {
    (void)state;
    EnfRooms rooms = make_rooms();
    EnfError error = {0};
    EnfGl *gl;
    assert_int_equal(enf_gl_create(&gl, rooms.map, load_nothing, &error), ENF_ERROR_CONTEXT);
    assert_null(gl);
    assert_non_null(strstr(error.message, "is missing"));
    Stage stage;
    open_stage(&stage, rooms.map, ENF_CONTEXT_ANY);
    EnfGlTarget *target;
    assert_int_equal(enf_gl_target_create(stage.gl, &target, 0, 1, &error), ENF_ERROR_RANGE);
    assert_int_equal(enf_gl_target_create(stage.gl, &target, 1u << 20, 1, &error), ENF_ERROR_RANGE);
    assert_null(target);
    close_stage(&stage);
    enf_rooms_destroy(&rooms);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(culled_equals_unculled_with_egl), cmocka_unit_test(culled_equals_unculled_with_osmesa),
    cmocka_unit_test(both_contexts_draw_the_same),     cmocka_unit_test(ids_name_what_rays_hit),
    cmocka_unit_test(unlit_texels_come_out_unchanged), cmocka_unit_test(blending_is_linear_and_ids_take_the_front),
    cmocka_unit_test(masks_cut_colour_and_ids_alike),  cmocka_unit_test(lights_are_listed_where_they_reach),
    cmocka_unit_test(references_of_a_light_are_one),   cmocka_unit_test(lines_and_wireframe_draw_over_the_picture),
    cmocka_unit_test(failures_are_reported),           cmocka_unit_test(pictures_are_shown_in_windows),
};

ENF_TEST_MAIN(tests)

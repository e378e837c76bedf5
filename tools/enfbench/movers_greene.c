/* The rivals of figure 6 of Sudarsky & Gotsman 1996. `hierarchical-z`: Greene's hierarchical Z-buffer over an octree of the whole
 * building; every moving object is evaluated, taken off and hung again from the root in every frame. `tbv`: the same with temporal
 * bounding volumes: an object that was not seen is left alone until its volume is seen or is over; periods are adaptive. From near to
 * far, a cube is passed over if what was drawn hides it; else its polygons are drawn into the depth pyramid, and so is each moving
 * object that is not hidden. What is drawn is the picture's own geometry, at the picture's own samples: no object that shows a pixel
 * can be missing. */
#include "enfbench/depth.h"
#include "enfbench/movers.h"
#include "enfbench/octree.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Expiries are hung on a ring by their tick; what is over in another of its rounds is passed by once a round. */
enum { RING = 2048 };
/* Beyond a thousand million ticks nothing is gained, and twice that is still a number. */
#define PERIOD_MAX (UINT32_C(1) << 30)

typedef struct Face {
    uint32_t first, count;
} Face;

struct Greene {
    const MoversScene *scene;
    bool volumes;
    Octree tree;
    DepthPyramid *depth;
    EnfBox3 bounds; /* of the building */
    EnfVec3f *points;
    Face *faces;
    uint32_t *drawn; /* of a polygon: the frame in which it was drawn */
    uint32_t point_count, face_count, frame;
    EnfBox3f *boxes; /* of an object: its own, or its volume */
    EnfPose *poses;
    uint32_t *asked, *found, *touched; /* the frame in which an object was asked about; the answer; evaluated in this frame */
    uint32_t found_count, touched_count;
    /* Of volumes: the tick at which one is over; the ring of these; when it was evaluated last, and seen last (plus one). */
    uint32_t *next, *before, *evaluated_at, *seen_at;
    uint32_t *periods;
    int64_t *due;
    uint32_t ring[RING];
    int64_t tick;
    const EnfCamera *camera;
    EnfPyramid picture;
    GreeneCounters counters;
};

void bench_greene_destroy(Greene *greene) {
    if (greene != NULL) {
        void *arrays[] = {greene->points,       greene->faces,   greene->drawn,   greene->boxes,  greene->poses,
                          greene->asked,        greene->found,   greene->touched, greene->next,   greene->before,
                          greene->evaluated_at, greene->seen_at, greene->due,     greene->periods};
        for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
            free(arrays[i]);
        }
        bench_octree_close(&greene->tree);
        bench_depth_destroy(greene->depth);
        free(greene);
    }
}

/* ---- the building ------------------------------------------------------------------------------------------------ */

static EnfVec3 corner_of(const EnfMap *map, uint32_t cell, uint32_t index) {
    const float *p = map->vertices[map->indices[index]].position;
    const double *o = map->cells[cell].origin;
    return enf_v3(o[0] + (double)p[0], o[1] + (double)p[1], o[2] + (double)p[2]);
}

static bool same(EnfVec3 a, EnfVec3f b) {
    return a.x == (double)b.x && a.y == (double)b.y && a.z == (double)b.z;
}

/* Adds a triangle, or lets the fan grow that was begun by the one before: one polygon is drawn faster than two. */
static void add_triangle(Greene *greene, const EnfVec3 v[3], bool begin) {
    Face *face = &greene->faces[greene->face_count - (begin ? 0U : 1U)];
    bool grows = !begin && face->count < DEPTH_POLYGON_MAX;
    if (grows) {
        const EnfVec3f *p = &greene->points[face->first];
        EnfVec3 a = enf_v3_from_f(p[0]), b = enf_v3_from_f(p[1]), last = enf_v3_from_f(p[face->count - 1]);
        EnfVec3 normal = enf_cross(enf_sub(b, a), enf_sub(enf_v3_from_f(p[2]), a));
        /* Whole numbers of 2^-8 m: these products are exact. */
        grows = same(v[0], p[0]) && same(v[1], p[face->count - 1]) && enf_dot(normal, enf_sub(v[2], a)) == 0.0 &&
                enf_dot(enf_cross(enf_sub(v[2], last), enf_sub(a, v[2])), normal) > 0.0 &&
                enf_dot(enf_cross(enf_sub(last, enf_v3_from_f(p[face->count - 2])), enf_sub(v[2], last)), normal) > 0.0 &&
                enf_dot(enf_cross(enf_sub(a, v[2]), enf_sub(b, a)), normal) > 0.0;
    }
    if (grows) {
        greene->points[greene->point_count++] = enf_v3f(v[2]);
        face->count++;
        return;
    }
    Face *new = &greene->faces[greene->face_count++];
    new->first = greene->point_count;
    new->count = 3;
    for (int k = 0; k < 3; k++) {
        greene->points[greene->point_count++] = enf_v3f(v[k]);
    }
}

static bool load_building(Greene *greene) {
    const EnfMap *map = greene->scene->rooms.map;
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *cluster = &map->clusters[c];
        for (uint32_t i = 0; i < cluster->index_count; i += 3) {
            EnfVec3 v[3];
            for (uint32_t k = 0; k < 3; k++) {
                v[k] = corner_of(map, cluster->cell, cluster->index_first + i + k);
            }
            add_triangle(greene, v, i == 0);
        }
    }
    bool ok = true;
    for (uint32_t f = 0; f < greene->face_count && ok; f++) {
        EnfBox3 box = enf_box3_empty();
        for (uint32_t k = 0; k < greene->faces[f].count; k++) {
            box = enf_box3_add(box, enf_v3_from_f(greene->points[greene->faces[f].first + k]));
        }
        ok = bench_octree_add_polygon(&greene->tree, f, box);
    }
    return ok;
}

/* Arrays of numbers, one an object. */
enum { NUMBERS = 8 };

static bool allocate(Greene *greene) {
    const EnfMap *map = greene->scene->rooms.map;
    size_t objects = greene->scene->def.movers + 1U;
    uint32_t **numbers[NUMBERS] = {&greene->asked,  &greene->found,        &greene->touched, &greene->next,
                                   &greene->before, &greene->evaluated_at, &greene->seen_at, &greene->periods};
    bool ok = true;
    for (size_t i = 0; i < NUMBERS; i++) {
        *numbers[i] = calloc(objects, sizeof(uint32_t));
        ok = ok && *numbers[i] != NULL;
    }
    greene->boxes = calloc(objects, sizeof *greene->boxes);
    greene->poses = calloc(objects, sizeof *greene->poses);
    greene->due = calloc(objects, sizeof *greene->due);
    greene->points = calloc(map->indices_count + 1U, sizeof *greene->points);
    greene->faces = calloc(map->indices_count / 3U + 1U, sizeof *greene->faces);
    greene->drawn = calloc(map->indices_count / 3U + 1U, sizeof *greene->drawn);
    return ok && greene->boxes && greene->poses && greene->due && greene->points && greene->faces && greene->drawn;
}

Greene *bench_greene_create(const MoversScene *scene, bool volumes) {
    Greene *greene = calloc(1, sizeof *greene);
    if (greene == NULL) {
        return NULL;
    }
    const EnfCamera *camera = &scene->views[0].camera;
    greene->scene = scene;
    greene->volumes = volumes;
    greene->bounds = enf_box3_union(enf_rooms_box(&scene->rooms, 0),
                                    enf_rooms_box(&scene->rooms, scene->rooms.map->cells_count - 1));
    memset(greene->ring, 0xff, sizeof greene->ring); /* ENF_NONE */
    greene->depth = bench_depth_create(camera->width_px, camera->height_px);
    if (greene->depth == NULL || !bench_octree_open(&greene->tree, greene->bounds, scene->def.leaf, scene->def.movers) ||
        !allocate(greene) || !load_building(greene)) {
        bench_greene_destroy(greene);
        return NULL;
    }
    return greene;
}

size_t bench_greene_bytes(const Greene *greene) {
    size_t object = OCTREE_FANOUT * sizeof(OctreeLink) + sizeof *greene->boxes + sizeof *greene->poses +
                    NUMBERS * sizeof(uint32_t) + sizeof *greene->due;
    return object * greene->scene->def.movers + greene->tree.node_capacity * sizeof *greene->tree.nodes + sizeof greene->ring;
}

GreeneCounters bench_greene_counters(const Greene *greene) {
    return greene->counters;
}

/* ---- where things are -------------------------------------------------------------------------------------------- */

static void evaluate(Greene *greene, uint32_t object, int64_t tick) {
    greene->poses[object] = bench_mover_state(&greene->scene->movers[object], tick);
    greene->boxes[object] = bench_mover_box(&greene->poses[object]);
    greene->evaluated_at[object] = greene->frame;
    greene->counters.evaluated++;
}

static void hang(Greene *greene, uint32_t object) {
    bench_octree_move(&greene->tree, object, enf_box3_from_f(greene->boxes[object]));
    greene->counters.reinserted++;
}

static void leave_ring(Greene *greene, uint32_t object) {
    uint32_t *head = &greene->ring[greene->due[object] % RING];
    uint32_t next = greene->next[object];
    uint32_t before = greene->before[object];
    if (before != ENF_NONE) {
        greene->next[before] = next;
    } else {
        *head = next;
    }
    if (next != ENF_NONE) {
        greene->before[next] = before;
    }
}

static void enter_ring(Greene *greene, uint32_t object, int64_t due) {
    uint32_t *head = &greene->ring[due % RING];
    greene->due[object] = due;
    greene->before[object] = ENF_NONE;
    greene->next[object] = *head;
    if (*head != ENF_NONE) {
        greene->before[*head] = object;
    }
    *head = object;
}

/* A volume from now until `due`: of what is only known by its speed, a box about where it is; else of its path. What lies outside the
 * building holds no object. */
static void make_volume(Greene *greene, uint32_t object, int64_t tick, int64_t due) {
    const Mover *mover = &greene->scene->movers[object];
    EnfBox3 box;
    if (mover->motion == MOVERS_FREE) {
        double r = (double)mover->speed * (double)(due - tick) + 1e-6;
        if (greene->evaluated_at[object] != greene->frame) {
            evaluate(greene, object, tick);
        }
        greene->evaluated_at[object] = 0; /* its box is not what was evaluated */
        EnfBox3 own = enf_box3_from_f(greene->boxes[object]);
        box.min = enf_sub(own.min, enf_v3(r, r, r));
        box.max = enf_add(own.max, enf_v3(r, r, r));
    } else {
        box = bench_mover_bound(mover, NULL, tick, due);
    }
    EnfBox3 in = greene->bounds;
    box.min = enf_v3(box.min.x > in.min.x ? box.min.x : in.min.x, box.min.y > in.min.y ? box.min.y : in.min.y,
                     box.min.z > in.min.z ? box.min.z : in.min.z);
    box.max = enf_v3(box.max.x < in.max.x ? box.max.x : in.max.x, box.max.y < in.max.y ? box.max.y : in.max.y,
                     box.max.z < in.max.z ? box.max.z : in.max.z);
    greene->boxes[object] = enf_box3f_outward(box);
    hang(greene, object);
}

static void begin_volumes(Greene *greene, int64_t tick) {
    uint32_t period = greene->scene->def.period;
    for (uint32_t i = 0; i < greene->scene->def.movers; i++) {
        greene->periods[i] = period;
        int64_t due = tick + 1 + (int64_t)(i % period); /* so that they are not all over at once */
        make_volume(greene, i, tick, due);
        enter_ring(greene, i, due);
    }
}

/* What is over: who was seen in the last frame is evaluated, who was not gets a volume for twice as long. */
static void renew_volumes(Greene *greene, int64_t tick) {
    uint32_t next = ENF_NONE;
    for (uint32_t object = greene->ring[tick % RING]; object != ENF_NONE; object = next) {
        next = greene->next[object];
        if (greene->due[object] != tick) {
            continue;
        }
        leave_ring(greene, object);
        if (greene->seen_at[object] + 1U == greene->frame) {
            evaluate(greene, object, tick);
            hang(greene, object);
            greene->touched[greene->touched_count++] = object;
        } else {
            uint32_t period = 2U * greene->periods[object];
            greene->periods[object] = period > PERIOD_MAX ? PERIOD_MAX : period;
            make_volume(greene, object, tick, tick + greene->periods[object]);
            enter_ring(greene, object, tick + greene->periods[object]);
            greene->counters.expired++;
        }
    }
}

void bench_greene_move(Greene *greene, int64_t tick) {
    greene->frame++;
    greene->touched_count = 0;
    greene->tick = tick;
    if (greene->volumes) {
        if (greene->frame == 1) {
            begin_volumes(greene, tick);
        } else {
            renew_volumes(greene, tick);
        }
        return;
    }
    for (uint32_t i = 0; i < greene->scene->def.movers; i++) {
        evaluate(greene, i, tick);
        hang(greene, i);
    }
}

/* ---- what is seen ------------------------------------------------------------------------------------------------ */

/* Is it in the picture, and not hidden by what was drawn? */
static bool shows(const Greene *greene, EnfBox3f box, DepthRect *rect) {
    static const DepthRect everything = {0, 0, INT32_MAX, INT32_MAX, FLT_MAX};
    if (!enf_pyramid_box(&greene->picture, box)) {
        return false;
    }
    DepthPlace place = bench_depth_place(greene->camera, enf_box3_from_f(box), rect);
    if (place == DEPTH_AROUND) {
        *rect = everything;
        return true;
    }
    return place == DEPTH_RECT && !bench_depth_hides(greene->depth, rect);
}

static void draw_faces(Greene *greene, uint32_t head) {
    for (uint32_t h = head; h != ENF_NONE; h = greene->tree.hooks[h].next) {
        uint32_t f = greene->tree.hooks[h].polygon;
        if (greene->drawn[f] == greene->frame) {
            continue;
        }
        greene->drawn[f] = greene->frame;
        const Face *face = &greene->faces[f];
        EnfVec3 points[DEPTH_POLYGON_MAX];
        for (uint32_t k = 0; k < face->count; k++) {
            points[k] = bench_depth_point(greene->camera, enf_v3_from_f(greene->points[face->first + k]));
        }
        bench_depth_polygon(greene->depth, greene->camera, points, face->count);
    }
}

/* The six sides of an object's box, turned as it is. */
static void draw_object(Greene *greene, uint32_t object) {
    static const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    EnfVec3 corners[8];
    for (int c = 0; c < 8; c++) {
        EnfVec3 p = enf_v3(c & 1 ? MOVER_WIDTH : -MOVER_WIDTH, c & 2 ? MOVER_HEIGHT : -MOVER_HEIGHT,
                           c & 4 ? MOVER_WIDTH : -MOVER_WIDTH);
        corners[c] = bench_depth_point(greene->camera, enf_pose_point(&greene->poses[object], p));
    }
    for (int s = 0; s < 6; s++) {
        EnfVec3 points[4];
        for (int k = 0; k < 4; k++) {
            points[k] = corners[sides[s][k]];
        }
        bench_depth_polygon(greene->depth, greene->camera, points, 4);
    }
}

/* What is hidden once is hidden for the rest of the frame: depths only grow nearer. */
static void look_at(Greene *greene, uint32_t object) {
    DepthRect rect;
    if (greene->asked[object] == greene->frame) {
        return;
    }
    greene->asked[object] = greene->frame;
    greene->counters.boxes++;
    if (!shows(greene, greene->boxes[object], &rect)) {
        return;
    }
    if (greene->volumes && greene->evaluated_at[object] != greene->frame) {
        greene->counters.exposed++;
        leave_ring(greene, object);
        greene->touched[greene->touched_count++] = object;
        evaluate(greene, object, greene->tick);
        if (!shows(greene, greene->boxes[object], &rect)) {
            return;
        }
    }
    greene->seen_at[object] = greene->frame;
    greene->found[greene->found_count++] = object;
    /* Less than a tile fills none. */
    if (greene->scene->def.occluders && rect.x1 - rect.x0 >= 8 && rect.y1 - rect.y0 >= 8) {
        draw_object(greene, object);
    }
}

static void visit(Greene *greene, uint32_t number, EnfVec3 low, double side) {
    EnfBox3 box = {low, enf_add(low, enf_v3(side, side, side))};
    DepthRect rect;
    box.max.y = box.max.y < greene->bounds.max.y ? box.max.y : greene->bounds.max.y; /* there is nothing above the building */
    greene->counters.nodes++;
    if (!shows(greene, enf_box3f_outward(box), &rect)) {
        return;
    }
    const OctreeNode *node = &greene->tree.nodes[number];
    draw_faces(greene, node->polygons);
    for (uint32_t i = node->objects; i != ENF_NONE; i = greene->tree.links[i].next) {
        look_at(greene, i / OCTREE_FANOUT);
    }
    double half = 0.5 * side;
    EnfVec3 eye = enf_sub(greene->camera->eye_ws, low);
    uint32_t nearest = (eye.x > half ? 1U : 0U) | (eye.y > half ? 2U : 0U) | (eye.z > half ? 4U : 0U);
    static const uint8_t order[8] = {0, 1, 2, 4, 3, 5, 6, 7}; /* across no side, one, two, three */
    for (int i = 0; i < 8; i++) {
        uint32_t k = nearest ^ order[i];
        if (node->child[k] != 0) {
            EnfVec3 at = enf_v3(k & 1U ? half : 0.0, k & 2U ? half : 0.0, k & 4U ? half : 0.0);
            visit(greene, node->child[k], enf_add(low, at), half);
        }
    }
}

/* Who was evaluated: seen, it is so again in the next tick; else it gets a volume, for half as long as the last. */
static void settle(Greene *greene) {
    for (uint32_t i = 0; i < greene->touched_count; i++) {
        uint32_t object = greene->touched[i];
        if (greene->seen_at[object] == greene->frame) {
            enter_ring(greene, object, greene->tick + 1);
            continue;
        }
        uint32_t period = greene->periods[object] / 2U;
        greene->periods[object] = period < 2U ? 2U : period;
        int64_t due = greene->tick + greene->periods[object];
        make_volume(greene, object, greene->tick, due);
        enter_ring(greene, object, due);
    }
}

static int ascending(const void *a, const void *b) {
    uint32_t x = *(const uint32_t *)a;
    uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

const uint32_t *bench_greene_look(Greene *greene, const EnfView *view, uint32_t *count) {
    greene->camera = &view->camera;
    greene->found_count = 0;
    bench_depth_clear(greene->depth);
    EnfBox3 cube = {greene->tree.low, greene->tree.low};
    double side = bench_octree_side(&greene->tree, 0);
    cube.max = enf_add(cube.max, enf_v3(side, side, side));
    enf_pyramid(greene->camera, enf_window_full(greene->camera), NULL, enf_v3(0.0, 0.0, 0.0), enf_box3f_outward(cube),
                &greene->picture);
    visit(greene, 0, greene->tree.low, side);
    if (greene->volumes) {
        settle(greene);
        greene->counters.avoided += greene->scene->def.movers - greene->touched_count;
    }
    if (greene->found_count > 1) {
        qsort(greene->found, greene->found_count, sizeof *greene->found, ascending);
    }
    *count = greene->found_count;
    return greene->found;
}

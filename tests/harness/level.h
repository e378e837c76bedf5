/* Small levels by hand, for tests of the compiler: an EnfSource made of rooms that are boxes with rectangular holes.
 *
 * Everything is of fixed size and mostly untouched, so a Level lives on the heap (level_new, level_free). Coordinates
 * are the world's; nodes have the identity transform unless level_move was called. */
#ifndef ENF_TESTS_LEVEL_H
#define ENF_TESTS_LEVEL_H

#include "compile/source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVEL_NODES = 1024, LEVEL_HOLES = 1024, LEVEL_NAME = 48 };

typedef struct LevelMesh {
    float *positions; /* nine a triangle: nothing is shared */
    uint32_t *indices;
    float *normals;
    uint32_t count, capacity; /* vertices */
} LevelMesh;

typedef struct Level {
    EnfSource source;
    EnfSourceNode nodes[LEVEL_NODES];
    char names[LEVEL_NODES][LEVEL_NAME];
    char extras[LEVEL_NODES][160];
    LevelMesh data[LEVEL_NODES];
    EnfSourceMesh meshes[LEVEL_NODES];
    EnfSourcePrimitive primitives[LEVEL_NODES];
    EnfMaterial materials[4];
    const char *material_names[4];
    EnfBox3 holes[LEVEL_HOLES];
    uint32_t hole_count;
    EnfAffine placed; /* applied to every point that is added */
} Level;

/* Material 0 is plain, 1 `visportal`, 2 two-sided, 3 a grating. */
static inline Level *level_new(void) {
    Level *level = calloc(1, sizeof *level);
    static const char *const names[4] = {"plaster", "visportal", "sheet", "grate"};
    for (int i = 0; i < 4; i++) {
        level->material_names[i] = names[i];
        level->materials[i].texture = level->materials[i].emissive_texture = ENF_NONE;
    }
    level->materials[1].flags = ENF_MATERIAL_NODRAW;
    level->materials[2].flags = ENF_MATERIAL_DOUBLE_SIDED;
    level->materials[3].alpha_mode = ENF_ALPHA_MASK;
    level->placed = (EnfAffine){{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    EnfSource *s = &level->source;
    s->nodes = level->nodes;
    s->meshes = level->meshes;
    s->primitives = level->primitives;
    s->materials = level->materials;
    s->material_names = level->material_names;
    s->material_count = 4;
    s->generator = "test";
    s->has_extras = s->has_lights = true;
    return level;
}

static inline void level_free(Level *level) {
    for (uint32_t i = 0; i < level->source.node_count; i++) {
        free(level->data[i].positions);
        free(level->data[i].normals);
        free(level->data[i].indices);
    }
    free(level);
}

static inline uint32_t level_node(Level *level, const char *name, uint32_t parent) {
    uint32_t i = level->source.node_count++;
    snprintf(level->names[i], LEVEL_NAME, "%s", name);
    level->nodes[i] = (EnfSourceNode){.name = level->names[i], .index = i, .parent = parent};
    level->nodes[i].world = (EnfAffine){{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    level->nodes[i].mesh = level->nodes[i].camera = level->nodes[i].light = ENF_NONE;
    level->nodes[i].extras = level->extras[i];
    level->nodes[i].scale = (EnfVec3){1, 1, 1};
    level->nodes[i].rotation.w = 1;
    return i;
}

static inline void level_extras(Level *level, uint32_t node, const char *json) {
    snprintf(level->extras[node], sizeof level->extras[node], "%s", json);
}

/* One mesh with one primitive a node, made at the first triangle. */
static inline void level_triangle(Level *level, uint32_t node, EnfVec3 a, EnfVec3 b, EnfVec3 c, uint32_t material) {
    LevelMesh *data = &level->data[node];
    EnfVec3 p[3] = {a, b, c};
    if (data->count + 3 > data->capacity) {
        data->capacity = data->capacity ? data->capacity * 2 : 96;
        data->positions = realloc(data->positions, data->capacity * 3 * sizeof(float));
        data->normals = realloc(data->normals, data->capacity * 3 * sizeof(float));
        data->indices = realloc(data->indices, data->capacity * sizeof(uint32_t));
    }
    EnfVec3 n = enf_normalize(enf_cross(enf_sub(b, a), enf_sub(c, a)));
    for (uint32_t k = 0; k < 3; k++) {
        EnfVec3f q = enf_v3f(enf_affine_point(&level->placed, p[k]));
        EnfVec3f m = enf_v3f(enf_affine_vector(&level->placed, n));
        memcpy(&data->positions[3 * (data->count + k)], &q, sizeof q);
        memcpy(&data->normals[3 * (data->count + k)], &m, sizeof m);
        data->indices[data->count + k] = data->count + k;
    }
    data->count += 3;
    level->nodes[node].mesh = node;
    level->meshes[node] = (EnfSourceMesh){level->names[node], node, 1};
    level->primitives[node] = (EnfSourcePrimitive){data->count, data->count, data->positions, data->normals,
                                                   NULL,        NULL,        data->indices,   material};
    level->source.mesh_count = level->source.primitive_count = level->source.node_count;
    level->source.triangle_count++;
}

/* Counter-clockwise from its front. */
static inline void level_quad(Level *level, uint32_t node, const EnfVec3 p[4], uint32_t material) {
    level_triangle(level, node, p[0], p[1], p[2], material);
    level_triangle(level, node, p[0], p[2], p[3], material);
}

static inline double level_axis(EnfVec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static inline EnfVec3 level_on_face(int axis, double at, double u, double v) {
    double p[3];
    p[axis] = at, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
    return enf_v3(p[0], p[1], p[2]);
}

static inline int level_flat_axis(EnfBox3 flat) {
    EnfVec3 size = enf_sub(flat.max, flat.min);
    return size.x <= 0.0 ? 0 : size.y <= 0.0 ? 1 : 2;
}

/* A box flat along one axis, as a rectangle; its front looks up that axis if `up`. */
static inline void level_rectangle(Level *level, uint32_t node, EnfBox3 flat, bool up, uint32_t material) {
    int axis = level_flat_axis(flat), ua = (axis + 1) % 3, va = (axis + 2) % 3;
    double at = level_axis(flat.min, axis);
    EnfVec3 p[4], q[4];
    for (int k = 0; k < 4; k++) {
        bool high_u = k == 1 || k == 2, high_v = k >= 2;
        p[k] = level_on_face(axis, at, level_axis(high_u ? flat.max : flat.min, ua),
                             level_axis(high_v ? flat.max : flat.min, va));
        q[(4 - k) % 4] = p[k];
    }
    level_quad(level, node, up ? p : q, material);
}

static inline int level_compare(const void *pa, const void *pb) {
    const double *a = pa, *b = pb;
    return (*a > *b) - (*a < *b);
}

/* One inner face of a room, without the holes that lie in it. */
static inline void level_face(Level *level, uint32_t node, EnfBox3 room, int axis, bool high, uint32_t material) {
    int ua = (axis + 1) % 3, va = (axis + 2) % 3;
    double at = level_axis(high ? room.max : room.min, axis), us[64], vs[64];
    uint32_t found[24], count = 0, un = 0, vn = 0;
    us[un++] = level_axis(room.min, ua), us[un++] = level_axis(room.max, ua);
    vs[vn++] = level_axis(room.min, va), vs[vn++] = level_axis(room.max, va);
    for (uint32_t i = 0; i < level->hole_count && count < 24; i++) {
        EnfBox3 hole = level->holes[i];
        bool flat = level_axis(hole.min, axis) >= at && level_axis(hole.max, axis) <= at;
        if (flat && enf_box3_overlaps(hole, room)) {
            found[count++] = i;
            us[un++] = level_axis(hole.min, ua), us[un++] = level_axis(hole.max, ua);
            vs[vn++] = level_axis(hole.min, va), vs[vn++] = level_axis(hole.max, va);
        }
    }
    qsort(us, un, sizeof *us, level_compare);
    qsort(vs, vn, sizeof *vs, level_compare);
    for (uint32_t i = 0; i + 1 < un; i++) {
        for (uint32_t k = 0; k + 1 < vn; k++) {
            EnfVec3 middle = level_on_face(axis, at, (us[i] + us[i + 1]) / 2, (vs[k] + vs[k + 1]) / 2);
            bool open = !(us[i + 1] > us[i]) || !(vs[k + 1] > vs[k]) || !enf_box3_contains(room, middle);
            for (uint32_t h = 0; h < count && !open; h++) {
                open = enf_box3_contains(level->holes[found[h]], middle);
            }
            if (!open) {
                EnfBox3 part = {level_on_face(axis, at, us[i], vs[k]), level_on_face(axis, at, us[i + 1], vs[k + 1])};
                level_rectangle(level, node, part, !high, material);
            }
        }
    }
}

static inline EnfBox3 level_box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return (EnfBox3){{x0, y0, z0}, {x1, y1, z1}};
}

/* A hole in every room whose face holds it: a box flat along one axis. Before the rooms. */
static inline void level_hole(Level *level, EnfBox3 hole) {
    level->holes[level->hole_count++] = hole;
}

/* Six faces looking inward, with their holes, at a node of their own under `parent`. */
static inline uint32_t level_faces(Level *level, const char *name, uint32_t parent, EnfBox3 room, uint32_t material) {
    uint32_t node = level_node(level, name, parent);
    for (int axis = 0; axis < 3; axis++) {
        level_face(level, node, room, axis, false, material);
        level_face(level, node, room, axis, true, material);
    }
    return node;
}

/* A room node with its faces below it. */
static inline uint32_t level_room(Level *level, const char *name, EnfBox3 room) {
    uint32_t node = level_node(level, name, ENF_NONE);
    level_faces(level, "walls", node, room, 0);
    return node;
}

/* A closed box with faces outward: furniture. */
static inline uint32_t level_block(Level *level, const char *name, uint32_t parent, EnfBox3 box) {
    uint32_t node = level_node(level, name, parent);
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, ua = (axis + 1) % 3, va = (axis + 2) % 3;
        double at = level_axis(face % 2 ? box.max : box.min, axis);
        EnfBox3 flat = {level_on_face(axis, at, level_axis(box.min, ua), level_axis(box.min, va)),
                        level_on_face(axis, at, level_axis(box.max, ua), level_axis(box.max, va))};
        level_rectangle(level, node, flat, face % 2, 0);
    }
    return node;
}

/* A portal over a hole; its front looks up the axis along which the hole is flat, if `up`. */
static inline uint32_t level_portal(Level *level, const char *name, uint32_t parent, EnfBox3 hole, bool up) {
    uint32_t node = level_node(level, name, parent);
    level_rectangle(level, node, hole, up, 0);
    return node;
}

#endif

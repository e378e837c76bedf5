/* Makes what a moving object is lit by. Baked surfaces have all their lights; an object has the brightest, so that its shader ends;
 * they fade by the same range, cone, windows and exposure, and a mover by a wall looks like the wall. */
#include "gl/mover_lights.h"

#include <math.h>
#include <string.h>

/* Outside its cell a light fades out within so many metres, where an object is in several cells at once. */
static const float CELL_SOFT = 0.02f;

/* A light that reaches the object, and its brightness there. */
typedef struct Candidate {
    float brightness;
    uint32_t number;
} Candidate;

typedef struct Packer {
    EnfGlMoverLights *out;
    const EnfGlLights *lights;
    const EnfMap *map;
    const EnfDrawMover *mover;
    Candidate chosen[ENF_GL_MOVER_LIGHTS];
    uint32_t chosen_count, plane_count;
} Packer;

/* ---- which ------------------------------------------------------------------------------------------------------ */

/* The model's origin relative to a cell's. */
static void place_in_cell(const Packer *packer, uint32_t cell, float at[3]) {
    const double *o = packer->map->cells[cell].origin;
    EnfVec3 p = packer->mover->position_ws;
    at[0] = (float)(p.x - o[0]);
    at[1] = (float)(p.y - o[1]);
    at[2] = (float)(p.z - o[2]);
}

static void box_in_cell(const Packer *packer, const float at[3], float min[3], float max[3]) {
    EnfBox3f box = packer->mover->box;
    const float low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
    for (int i = 0; i < 3; i++) {
        min[i] = low[i] + at[i];
        max[i] = high[i] + at[i];
    }
}

static float dot3(const float *a, const float *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The most of a spot's cone that any point of the box can have, 0 to 1: its value at the middle, and what the direction may turn by
 * towards a corner (|u' - u| <= 2 r / d). Lamps that are no spots have an aim of 0 and an offset of 1. */
static float cone_at(const EnfGlLight *light, const float min[3], const float max[3]) {
    float to[3], radius2 = 0.0f;
    for (int i = 0; i < 3; i++) {
        float half = 0.5f * (max[i] - min[i]);
        to[i] = min[i] + half - light->position[i];
        radius2 += half * half;
    }
    float distance = sqrtf(dot3(to, to)), radius = sqrtf(radius2);
    if (radius >= distance) {
        return 1.0f;
    }
    float slack = sqrtf(dot3(light->aim, light->aim)) * 2.0f * radius / distance;
    float cone = light->aim_offset + dot3(light->aim, to) / distance + slack;
    return cone < 0.0f ? 0.0f : cone > 1.0f ? 1.0f : cone;
}

static bool is_before(Candidate a, Candidate b) {
    return a.brightness > b.brightness || (a.brightness == b.brightness && a.number < b.number);
}

/* Keeps the list ascending in is_before, each light once: with its greatest brightness, as cells round its place differently. */
static void consider(Packer *packer, Candidate candidate) {
    uint32_t count = packer->chosen_count;
    for (uint32_t i = 0; i < count; i++) {
        if (packer->chosen[i].number == candidate.number) {
            if (!is_before(candidate, packer->chosen[i])) {
                return;
            }
            memmove(&packer->chosen[i], &packer->chosen[i + 1], (count - i - 1) * sizeof *packer->chosen);
            count--;
            break;
        }
    }
    uint32_t at = count;
    while (at > 0 && is_before(candidate, packer->chosen[at - 1])) {
        at--;
    }
    if (at == ENF_GL_MOVER_LIGHTS) {
        return;
    }
    uint32_t moved = count < ENF_GL_MOVER_LIGHTS ? count - at : count - at - 1;
    memmove(&packer->chosen[at + 1], &packer->chosen[at], moved * sizeof *packer->chosen);
    packer->chosen[at] = candidate;
    packer->chosen_count = count < ENF_GL_MOVER_LIGHTS ? count + 1 : count;
}

static void choose(Packer *packer) {
    for (uint32_t c = 0; c < packer->mover->cell_count; c++) {
        uint32_t cell = packer->mover->cells[c];
        float at[3], min[3], max[3];
        place_in_cell(packer, cell, at);
        box_in_cell(packer, at, min, max);
        for (uint32_t i = packer->lights->cell_firsts[cell]; i < packer->lights->cell_firsts[cell + 1]; i++) {
            const EnfGlCellLight *kept = &packer->lights->cell_lights[i];
            if (enf_gl_light_touches(packer->lights, &kept->light, min, max)) {
                float distance2 = enf_gl_light_distance2(&kept->light, min, max) + 0.25f;
                float cone = cone_at(&kept->light, min, max);
                Candidate candidate = {enf_gl_light_brightness(&kept->light, distance2) * cone * cone, kept->number};
                if (candidate.brightness > 0.0f) {
                    consider(packer, candidate);
                }
            }
        }
    }
}

/* ---- how -------------------------------------------------------------------------------------------------------- */

static float *plane_at(const Packer *packer, uint32_t plane) {
    uint32_t first = ENF_GL_MOVER_HEAD + packer->chosen_count * ENF_GL_MOVER_LIGHT_VECTORS;
    return packer->out->vectors[first + plane];
}

static bool push_plane(Packer *packer, const float n[3], float d) {
    if (packer->plane_count == ENF_GL_MOVER_PLANES) {
        return false;
    }
    float *plane = plane_at(packer, packer->plane_count++);
    memcpy(plane, n, 3 * sizeof *plane);
    plane[3] = d;
    return true;
}

/* The faces of a cell that the object's box sticks out of: 1 up to the face, 0 from CELL_SOFT beyond it. */
static bool push_cell(Packer *packer, uint32_t cell, const float at[3], bool *any) {
    const EnfCell *c = &packer->map->cells[cell];
    float min[3], max[3];
    box_in_cell(packer, at, min, max);
    bool ok = true;
    for (int i = 0; i < 3 && packer->mover->cell_count > 1; i++) {
        float n[3] = {0.0f, 0.0f, 0.0f};
        if (max[i] > c->max[i]) {
            n[i] = -1.0f / CELL_SOFT;
            ok = ok && push_plane(packer, n, 1.0f + (c->max[i] - at[i]) / CELL_SOFT);
            *any = true;
        }
        if (min[i] < c->min[i]) {
            n[i] = 1.0f / CELL_SOFT;
            ok = ok && push_plane(packer, n, 1.0f + (at[i] - c->min[i]) / CELL_SOFT);
            *any = true;
        }
    }
    return ok;
}

/* One window: its planes moved to the model's origin, the cell's faces, an end. */
static bool push_window(Packer *packer, uint32_t cell, const float at[3], uint32_t first, uint32_t count) {
    static const float none[3] = {0.0f, 0.0f, 0.0f};
    bool any = count > 0, ok = true;
    for (uint32_t i = first; i < first + count && ok; i++) {
        const float *plane = packer->lights->planes[i];
        ok = push_plane(packer, plane, plane[3] + plane[0] * at[0] + plane[1] * at[1] + plane[2] * at[2]);
    }
    ok = ok && push_cell(packer, cell, at, &any) && push_plane(packer, none, 0.0f);
    return ok && any;
}

static bool is_end(const float plane[4]) {
    return plane[0] == 0.0f && plane[1] == 0.0f && plane[2] == 0.0f;
}

/* The windows of a light in one cell. False if all is lit, or the planes do not fit. */
static bool push_windows(Packer *packer, uint32_t cell, const float at[3], uint32_t windows) {
    uint32_t first = windows >> 6, last = first + (windows & 63u);
    for (uint32_t i = first; i <= last; i++) {
        if (is_end(packer->lights->planes[i])) {
            if (!push_window(packer, cell, at, first, i - first)) {
                return false;
            }
            first = i + 1;
        }
    }
    return true;
}

/* Adds what the light shows of itself in a cell. False: no window is needed there. */
static bool add_reference(Packer *packer, uint32_t cell, const EnfGlCellLight *kept, float *light) {
    float at[3];
    place_in_cell(packer, cell, at);
    for (int i = 0; i < 3; i++) {
        light[i] = kept->light.position[i] - at[i];
        light[4 + i] = kept->light.color[i];
        light[8 + i] = kept->light.aim[i];
    }
    light[3] = kept->light.inverse_range2;
    light[11] = kept->light.aim_offset;
    return push_windows(packer, cell, at, kept->light.windows);
}

static void pack_light(Packer *packer, uint32_t slot) {
    float *light = packer->out->vectors[ENF_GL_MOVER_HEAD + slot * ENF_GL_MOVER_LIGHT_VECTORS];
    uint32_t first = packer->plane_count, number = packer->chosen[slot].number;
    bool windowed = true;
    for (uint32_t c = 0; c < packer->mover->cell_count && windowed; c++) {
        uint32_t cell = packer->mover->cells[c];
        for (uint32_t i = packer->lights->cell_firsts[cell]; i < packer->lights->cell_firsts[cell + 1] && windowed; i++) {
            if (packer->lights->cell_lights[i].number == number) {
                windowed = add_reference(packer, cell, &packer->lights->cell_lights[i], light);
            }
        }
    }
    packer->plane_count = windowed ? packer->plane_count : first;
    light[7] = windowed ? (float)(128 * first + (packer->plane_count - first)) : 0.0f;
    packer->out->numbers[slot] = number;
}

void enf_gl_mover_lights(EnfGlMoverLights *out, const EnfGlLights *lights, const EnfMap *map, const EnfDrawMover *mover) {
    Packer packer = {.out = out, .lights = lights, .map = map, .mover = mover};
    const float *m = mover->eye_from_model;
    choose(&packer);
    for (int i = 0; i < 3; i++) {
        const float column[4] = {m[3 * i], m[3 * i + 1], m[3 * i + 2], m[9 + i]};
        memcpy(out->vectors[i], column, sizeof column);
    }
    const float counts[4] = {(float)packer.chosen_count, 0.0f, 0.0f, 0.0f};
    memcpy(out->vectors[3], counts, sizeof counts);
    for (uint32_t slot = 0; slot < packer.chosen_count; slot++) {
        pack_light(&packer, slot);
    }
    out->light_count = packer.chosen_count;
    out->count = ENF_GL_MOVER_HEAD + packer.chosen_count * ENF_GL_MOVER_LIGHT_VECTORS + packer.plane_count;
}

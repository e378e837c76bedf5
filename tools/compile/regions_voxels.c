/* Conservative voxels. Input: triangles; output: what a flood from inside reaches. Marking goes column by column along the direction
 * that the triangle faces most, where it is at most a few voxels thick. */
#include "compile/regions_voxels.h"

#include <math.h>
#include <string.h>

enum { RIM = 2 };

bool enf_voxels_reset(EnfVoxels *voxels, EnfBox3 box, double size, uint32_t limit) {
    EnfVec3 extent = enf_sub(box.max, box.min);
    double count;
    for (;; size *= 1.1) {
        count = (floor(extent.x / size) + 1 + 2 * RIM) * (floor(extent.y / size) + 1 + 2 * RIM) *
                (floor(extent.z / size) + 1 + 2 * RIM);
        if (count <= (double)limit) {
            break;
        }
    }
    uint32_t needed = (uint32_t)count;
    if (needed > voxels->capacity) {
        enf_voxels_free(voxels);
        voxels->solid = enf_alloc(NULL, needed, sizeof *voxels->solid);
        voxels->queue = enf_alloc(NULL, needed, sizeof *voxels->queue);
        voxels->from = enf_alloc(NULL, needed, sizeof *voxels->from);
        voxels->capacity = needed;
        if (!voxels->solid || !voxels->queue || !voxels->from) {
            enf_voxels_free(voxels);
            return false;
        }
    }
    memset(voxels->solid, 0, needed);
    voxels->size = size;
    voxels->min = enf_sub(box.min, enf_v3(RIM * size, RIM * size, RIM * size));
    voxels->n[0] = (int)floor(extent.x / size) + 1 + 2 * RIM;
    voxels->n[1] = (int)floor(extent.y / size) + 1 + 2 * RIM;
    voxels->n[2] = (int)floor(extent.z / size) + 1 + 2 * RIM;
    return true;
}

void enf_voxels_free(EnfVoxels *voxels) {
    enf_free(NULL, voxels->solid, voxels->capacity, sizeof *voxels->solid);
    enf_free(NULL, voxels->queue, voxels->capacity, sizeof *voxels->queue);
    enf_free(NULL, voxels->from, voxels->capacity, sizeof *voxels->from);
    memset(voxels, 0, sizeof *voxels);
}

static uint32_t index_of(const EnfVoxels *voxels, const int c[3]) {
    return ((uint32_t)c[2] * (uint32_t)voxels->n[1] + (uint32_t)c[1]) * (uint32_t)voxels->n[0] + (uint32_t)c[0];
}

/* A triangle in voxel units, with its axes in order: two across, one along the way that it faces. */
typedef struct Flat {
    int axis[3];
    double p[3][3];          /* corner, axis */
    double a[3], b[3], c[3]; /* edges: a u + b v + c >= 0 inside */
    double slope_u, slope_v;
    double low, high; /* along the third axis */
} Flat;

static void set_edges(Flat *flat) {
    double area = (flat->p[1][0] - flat->p[0][0]) * (flat->p[2][1] - flat->p[0][1]) -
                  (flat->p[1][1] - flat->p[0][1]) * (flat->p[2][0] - flat->p[0][0]);
    double sign = area < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        const double *p = flat->p[i], *q = flat->p[(i + 1) % 3];
        flat->a[i] = sign * (p[1] - q[1]);
        flat->b[i] = sign * (q[0] - p[0]);
        flat->c[i] = -(flat->a[i] * p[0] + flat->b[i] * p[1]);
    }
}

/* False for a triangle without area. */
static bool make_flat(const EnfVoxels *voxels, const EnfVec3 triangle[3], Flat *flat) {
    double q[3][3];
    for (int k = 0; k < 3; k++) {
        EnfVec3 p = enf_scale(enf_sub(triangle[k], voxels->min), 1.0 / voxels->size);
        q[k][0] = p.x, q[k][1] = p.y, q[k][2] = p.z;
    }
    EnfVec3 u = enf_v3(q[1][0] - q[0][0], q[1][1] - q[0][1], q[1][2] - q[0][2]);
    EnfVec3 n = enf_cross(u, enf_v3(q[2][0] - q[0][0], q[2][1] - q[0][1], q[2][2] - q[0][2]));
    double normal[3] = {n.x, n.y, n.z};
    int main = fabs(n.x) >= fabs(n.y) && fabs(n.x) >= fabs(n.z) ? 0 : fabs(n.y) >= fabs(n.z) ? 1 : 2;
    if (!(fabs(normal[main]) > 0.0)) {
        return false;
    }
    flat->low = 1e300, flat->high = -1e300;
    for (int i = 0; i < 3; i++) {
        flat->axis[i] = (main + 1 + i) % 3;
        for (int k = 0; k < 3; k++) {
            flat->p[k][i] = q[k][flat->axis[i]];
        }
    }
    for (int k = 0; k < 3; k++) {
        flat->low = fmin(flat->low, flat->p[k][2]);
        flat->high = fmax(flat->high, flat->p[k][2]);
    }
    flat->slope_u = -normal[flat->axis[0]] / normal[main];
    flat->slope_v = -normal[flat->axis[1]] / normal[main];
    set_edges(flat);
    return true;
}

/* Surfaces on the border of two voxels mark both. */
static const double MARGIN = 1e-6;

/* Could the triangle touch the column [u, u+1] × [v, v+1]? */
static bool touches(const Flat *flat, double u, double v) {
    for (int i = 0; i < 3; i++) {
        double most = flat->c[i] + flat->a[i] * (flat->a[i] > 0.0 ? u + 1.0 + MARGIN : u - MARGIN) +
                      flat->b[i] * (flat->b[i] > 0.0 ? v + 1.0 + MARGIN : v - MARGIN);
        if (most < 0.0) {
            return false;
        }
    }
    return true;
}

static int clamped(double value, int n) {
    return value < 0.0 ? 0 : value > n - 1 ? n - 1 : (int)value;
}

/* What is done at each voxel of a triangle; true stops. */
typedef bool Visit(EnfVoxels *voxels, const int c[3]);

static bool mark(EnfVoxels *voxels, const int c[3]) {
    voxels->solid[index_of(voxels, c)] = 1;
    return false;
}

static bool is_beside_flood(EnfVoxels *voxels, const int c[3]) {
    for (int i = 0; i < 27; i++) {
        const int at[3] = {c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1};
        bool within = true;
        for (int axis = 0; axis < 3; axis++) {
            within = within && at[axis] >= 0 && at[axis] < voxels->n[axis];
        }
        if (within && voxels->solid[index_of(voxels, at)] == 2) {
            return true;
        }
    }
    return false;
}

static bool visit_column(EnfVoxels *voxels, const Flat *flat, int u, int v, Visit *visit) {
    double middle = flat->p[0][2] + flat->slope_u * (u + 0.5 - flat->p[0][0]) + flat->slope_v * (v + 0.5 - flat->p[0][1]);
    double spread = 0.5 * (fabs(flat->slope_u) + fabs(flat->slope_v)) + MARGIN;
    double low = fmax(middle - spread, flat->low - MARGIN), high = fmin(middle + spread, flat->high + MARGIN);
    int n = voxels->n[flat->axis[2]], c[3];
    c[flat->axis[0]] = u;
    c[flat->axis[1]] = v;
    if (high < 0.0 || low > n) {
        return false;
    }
    for (int w = clamped(floor(low), n); w <= clamped(floor(high), n); w++) {
        c[flat->axis[2]] = w;
        if (visit(voxels, c)) {
            return true;
        }
    }
    return false;
}

static bool visit_triangle(EnfVoxels *voxels, const EnfVec3 triangle[3], Visit *visit) {
    Flat flat;
    if (!make_flat(voxels, triangle, &flat)) {
        return false;
    }
    int first[2], last[2];
    for (int i = 0; i < 2; i++) {
        double low = fmin(flat.p[0][i], fmin(flat.p[1][i], flat.p[2][i])) - MARGIN;
        double high = fmax(flat.p[0][i], fmax(flat.p[1][i], flat.p[2][i])) + MARGIN;
        if (high < 0.0 || low > voxels->n[flat.axis[i]]) {
            return false;
        }
        first[i] = clamped(floor(low), voxels->n[flat.axis[i]]);
        last[i] = clamped(floor(high), voxels->n[flat.axis[i]]);
    }
    for (int v = first[1]; v <= last[1]; v++) {
        for (int u = first[0]; u <= last[0]; u++) {
            if (touches(&flat, u, v) && visit_column(voxels, &flat, u, v, visit)) {
                return true;
            }
        }
    }
    return false;
}

void enf_voxels_mark(EnfVoxels *voxels, const EnfVec3 triangle[3]) {
    visit_triangle(voxels, triangle, mark);
}

bool enf_voxels_meets_flood(EnfVoxels *voxels, const EnfVec3 triangle[3]) {
    return visit_triangle(voxels, triangle, is_beside_flood);
}

uint32_t enf_voxels_at(const EnfVoxels *voxels, EnfVec3 p) {
    EnfVec3 q = enf_scale(enf_sub(p, voxels->min), 1.0 / voxels->size);
    const double value[3] = {q.x, q.y, q.z};
    int c[3];
    for (int i = 0; i < 3; i++) {
        if (!(value[i] >= 0.0 && value[i] < voxels->n[i])) {
            return ENF_NONE;
        }
        c[i] = (int)value[i];
    }
    return index_of(voxels, c);
}

static void coordinates(const EnfVoxels *voxels, uint32_t voxel, int c[3]) {
    c[0] = (int)(voxel % (uint32_t)voxels->n[0]);
    c[1] = (int)(voxel / (uint32_t)voxels->n[0] % (uint32_t)voxels->n[1]);
    c[2] = (int)(voxel / (uint32_t)voxels->n[0] / (uint32_t)voxels->n[1]);
}

EnfVec3 enf_voxels_centre(const EnfVoxels *voxels, uint32_t voxel) {
    int c[3];
    coordinates(voxels, voxel, c);
    return enf_add(voxels->min, enf_scale(enf_v3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5), voxels->size));
}

uint32_t enf_voxels_flood(EnfVoxels *voxels, const uint32_t *seeds, uint32_t seed_count) {
    uint32_t count = (uint32_t)voxels->n[0] * (uint32_t)voxels->n[1] * (uint32_t)voxels->n[2], end = 0;
    const uint32_t stride[3] = {1, (uint32_t)voxels->n[0], (uint32_t)voxels->n[0] * (uint32_t)voxels->n[1]};
    for (uint32_t i = 0; i < count; i++) {
        voxels->solid[i] = voxels->solid[i] == 1;
    }
    for (uint32_t i = 0; i < seed_count; i++) {
        if (voxels->solid[seeds[i]] == 0) {
            voxels->solid[seeds[i]] = 2;
            voxels->from[seeds[i]] = seeds[i];
            voxels->queue[end++] = seeds[i];
        }
    }
    for (uint32_t at = 0; at < end; at++) {
        uint32_t voxel = voxels->queue[at];
        int c[3];
        coordinates(voxels, voxel, c);
        for (int axis = 0; axis < 3; axis++) {
            if (c[axis] == 0 || c[axis] == voxels->n[axis] - 1) {
                return voxel;
            }
        }
        for (int side = 0; side < 6; side++) {
            uint32_t next = side % 2 ? voxel + stride[side / 2] : voxel - stride[side / 2];
            if (voxels->solid[next] == 0) {
                voxels->solid[next] = 2;
                voxels->from[next] = voxel;
                voxels->queue[end++] = next;
            }
        }
    }
    return ENF_NONE;
}

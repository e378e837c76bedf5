/* The ray oracle of visibility: Möller & Trumbore 1997 in double over all triangles, with a margin of doubt at edges. */
#include "scenes/oracle.h"

#include <float.h>
#include <math.h>

/* Barycentric distance from an edge below which a ray is not used: far above rounding, far below a pixel. */
#define DOUBT 1e-7

static EnfVec3 vertex_eye(const EnfMap *map, uint32_t index, EnfVec3 offset) {
    const float *p = map->vertices[index].position;
    return enf_add(enf_v3((double)p[0], (double)p[1], (double)p[2]), offset);
}

typedef enum Meet { MEET_MISS, MEET_HIT, MEET_DOUBT } Meet;

static Meet meet(EnfVec3 direction, const EnfVec3 v[3], bool two_sided, double *t) {
    EnfVec3 e1 = enf_sub(v[1], v[0]);
    EnfVec3 e2 = enf_sub(v[2], v[0]);
    EnfVec3 p = enf_cross(direction, e2);
    double det = enf_dot(e1, p); /* > 0: the front is seen */
    if (det == 0.0 || (det < 0.0 && !two_sided)) {
        return MEET_MISS;
    }
    EnfVec3 s = enf_scale(v[0], -1.0); /* the eye is the origin */
    double u = enf_dot(s, p) / det;
    EnfVec3 q = enf_cross(s, e1);
    double w = enf_dot(direction, q) / det;
    *t = enf_dot(e2, q) / det;
    double inside = fmin(fmin(u, w), 1.0 - u - w);
    if (inside < -DOUBT || *t <= 0.0) {
        return MEET_MISS;
    }
    return inside > DOUBT ? MEET_HIT : MEET_DOUBT;
}

/* Can the ray meet the cluster's box at all? Generous by a millimetre. */
static bool near_box(const EnfCluster *cluster, EnfVec3 offset, EnfVec3 direction) {
    double near = 0.0;
    double far = DBL_MAX;
    const double o[3] = {offset.x, offset.y, offset.z};
    const double d[3] = {direction.x, direction.y, direction.z};
    for (int a = 0; a < 3; a++) {
        double low = (double)cluster->min[a] + o[a] - 1e-3;
        double high = (double)cluster->max[a] + o[a] + 1e-3;
        if (d[a] == 0.0) {
            if (low > 0.0 || high < 0.0) {
                return false;
            }
            continue;
        }
        double t0 = low / d[a];
        double t1 = high / d[a];
        near = fmax(near, fmin(t0, t1));
        far = fmin(far, fmax(t0, t1));
    }
    return near <= far;
}

bool enf_oracle_ray(const EnfMap *map, const EnfCamera *camera, double x_px, double y_px, uint32_t *cluster, double *t) {
    double x = (2.0 * x_px / (double)camera->width_px - 1.0) * camera->tan_x;
    double y = (2.0 * y_px / (double)camera->height_px - 1.0) * camera->tan_y;
    EnfVec3 direction = enf_add(camera->forward, enf_add(enf_scale(camera->right, x), enf_scale(camera->up, y)));
    double best = DBL_MAX;
    double doubtful = DBL_MAX;
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *record = &map->clusters[c];
        const double *origin = map->cells[record->cell].origin;
        EnfVec3 offset = enf_sub(enf_v3(origin[0], origin[1], origin[2]), camera->eye_ws);
        if ((map->materials[record->material].flags & ENF_MATERIAL_NODRAW) != 0 || !near_box(record, offset, direction)) {
            continue;
        }
        bool two_sided = (map->materials[record->material].flags & ENF_MATERIAL_DOUBLE_SIDED) != 0;
        for (uint32_t i = record->index_first; i < record->index_first + record->index_count; i += 3) {
            EnfVec3 v[3];
            for (uint32_t k = 0; k < 3; k++) {
                v[k] = vertex_eye(map, map->indices[i + k], offset);
            }
            double at = DBL_MAX;
            Meet met = meet(direction, v, two_sided, &at);
            if (met == MEET_HIT && at < best) {
                best = at;
                *cluster = c;
            }
            doubtful = met == MEET_DOUBT ? fmin(doubtful, at) : doubtful;
        }
    }
    *t = best;
    return best < DBL_MAX && best * (1.0 - DOUBT) < doubtful;
}

bool enf_oracle_listed(const EnfVisSet *set, uint32_t cluster) {
    for (uint32_t i = 0; i < set->entry_count; i++) {
        if (set->entries[i].space == 0 && set->entries[i].cluster == cluster) {
            return true;
        }
    }
    return false;
}

/* The nearest triangle of a cell that a ray meets. Not a test of visibility (PITFALLS 29): one cell, no portals. */
#include "map/map_internal.h"

#include <math.h>

/* ---- one triangle ----------------------------------------------------------------------------------------------- */

static inline double component(EnfVec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

bool enf_map_ray_make(EnfMapRay *ray, EnfVec3 direction) {
    double x = fabs(direction.x), y = fabs(direction.y), z = fabs(direction.z);
    ray->direction = direction;
    ray->kz = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
    ray->kx = (ray->kz + 1) % 3;
    ray->ky = (ray->kz + 2) % 3;
    double longest = component(direction, ray->kz);
    ray->sx = component(direction, ray->kx) / longest;
    ray->sy = component(direction, ray->ky) / longest;
    ray->sz = 1.0 / longest;
    return isfinite(ray->sx) && isfinite(ray->sy) && isfinite(ray->sz);
}

/* Sheared so that the ray runs along an axis, the triangle is a flat one about the origin; the sign of an edge is the same from both
 * triangles that share it, so no ray slips between them. */
bool enf_map_ray_triangle(const EnfMapRay *ray, EnfVec3 a, EnfVec3 b, EnfVec3 c, double *t) {
    const EnfVec3 corner[3] = {a, b, c};
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; i++) {
        double depth = component(corner[i], ray->kz);
        x[i] = component(corner[i], ray->kx) - ray->sx * depth;
        y[i] = component(corner[i], ray->ky) - ray->sy * depth;
        z[i] = ray->sz * depth;
    }
    double u = x[2] * y[1] - y[2] * x[1], v = x[0] * y[2] - y[0] * x[2], w = x[1] * y[0] - y[1] * x[0];
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) {
        return false;
    }
    double det = u + v + w;
    if (det == 0.0) {
        return false;
    }
    *t = (u * z[0] + v * z[1] + w * z[2]) / det;
    return true;
}

EnfVec3 enf_map_corner(const EnfMap *map, const EnfCluster *cluster, uint32_t triangle, uint32_t k) {
    const float *p = map->vertices[map->indices[cluster->index_first + 3 * triangle + k]].position;
    return enf_v3((double)p[0], (double)p[1], (double)p[2]);
}

/* ---- a cell ----------------------------------------------------------------------------------------------------- */

typedef struct Search {
    const EnfMap *map;
    const EnfMapQuery *query;
    EnfMapRay ray;
    EnfRayHit hit;
} Search;

static double search_cluster(void *user, uint32_t index, double t_max) {
    Search *s = user;
    const EnfCluster *cluster = &s->map->clusters[index];
    if (s->query->wanted && !s->query->wanted(s->map, index, s->query->user)) {
        return t_max;
    }
    EnfVec3 from = enf_sub(s->query->from_ws, enf_map_origin(s->map, cluster->cell));
    for (uint32_t i = 0; i < cluster->index_count / 3; i++) {
        EnfVec3 a = enf_sub(enf_map_corner(s->map, cluster, i, 0), from);
        EnfVec3 b = enf_sub(enf_map_corner(s->map, cluster, i, 1), from);
        EnfVec3 c = enf_sub(enf_map_corner(s->map, cluster, i, 2), from);
        double t;
        if (!enf_map_ray_triangle(&s->ray, a, b, c, &t) || t < 0.0 || t > t_max) {
            continue;
        }
        /* Equally near: the lower number, so that the answer does not depend on the order of the tree. */
        if (t < t_max || s->hit.cluster == ENF_NONE || index < s->hit.cluster) {
            EnfVec3 normal = enf_cross(enf_sub(b, a), enf_sub(c, a));
            s->hit = (EnfRayHit){t, index, i, enf_dot(normal, s->ray.direction) < 0.0};
            t_max = t;
        }
    }
    return t_max;
}

bool enf_map_ray_query(const EnfMap *map, const EnfMapQuery *query, EnfRayHit *hit) {
    Search search = {map, query, {{0, 0, 0}, 0, 0, 0, 0, 0, 0}, {0, ENF_NONE, ENF_NONE, false}};
    if (query->cell >= map->cells_count || !enf_v3_finite(query->from_ws) || !enf_map_ray_make(&search.ray, query->direction)) {
        return false;
    }
    EnfKdTree tree = enf_map_cell_tree(map, query->cell);
    EnfVec3 from = enf_sub(query->from_ws, enf_map_origin(map, query->cell));
    enf_kd_ray(&tree, from, query->direction, query->t_max, search_cluster, &search);
    if (search.hit.cluster != ENF_NONE) {
        *hit = search.hit;
    }
    return search.hit.cluster != ENF_NONE;
}

bool enf_map_ray(const EnfMap *map, uint32_t cell, EnfVec3 from_ws, EnfVec3 direction, double t_max, EnfRayHit *hit) {
    EnfMapQuery query = {cell, from_ws, direction, t_max, NULL, NULL};
    return enf_map_ray_query(map, &query, hit);
}

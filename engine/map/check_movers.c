/* Meshes and movers: what moves can be drawn and set going without a look at its numbers. */
#include "map/map_internal.h"

#include <math.h>

/* A pass of a path, in ticks, is a 32-bit number (EnfPathMotion.period_ticks): a year and more. */
#define SECONDS_MAX 3.0e7f
/* An axis was rounded to floats. */
#define UNIT_SLACK 1e-5

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

static EnfResult check_part_indices(const EnfMapCheck *check, const EnfMesh *mesh, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfMeshPart *part = &map->mesh_parts[i];
    for (uint32_t k = part->index_first; k < part->index_first + part->index_count; k++) {
        uint32_t index = map->indices[k];
        if (index < part->vertex_first || index - part->vertex_first >= part->vertex_count) {
            return enf_map_bad(check, ENF_CHUNK_indices, &map->indices[k], "", ENF_ERROR_INDEX,
                               "%u is outside the vertex range of mesh part %u", index, i);
        }
        const EnfVertex *vertex = &map->vertices[index];
        if (vertex->cell != ENF_NONE) {
            return ENF_MAP_BAD(check, vertices, index, cell, ENF_ERROR_INDEX, "%u: a vertex of mesh part %u lies in no cell",
                               vertex->cell, i);
        }
        for (int axis = 0; axis < 3; axis++) {
            if (vertex->position[axis] < mesh->min[axis] || vertex->position[axis] > mesh->max[axis]) {
                return ENF_MAP_BAD(check, vertices, index, position[axis], ENF_ERROR_RANGE,
                                   "%g is outside the bounds of mesh %u", (double)vertex->position[axis], part->mesh);
            }
        }
    }
    return ENF_OK;
}

static EnfResult check_part(const EnfMapCheck *check, uint32_t mesh, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfMeshPart *part = &map->mesh_parts[i];
    if (part->mesh != mesh) {
        return ENF_MAP_BAD(check, mesh_parts, i, mesh, ENF_ERROR_INDEX, "%u, but mesh %u lists it", part->mesh, mesh);
    }
    if (part->index_count == 0 || part->index_count % 3) {
        return ENF_MAP_BAD(check, mesh_parts, i, index_count, ENF_ERROR_RANGE, "%u is not 3 times 1 or more",
                           part->index_count);
    }
    if (i > map->meshes[mesh].part_first && map->mesh_parts[i - 1].material >= part->material) {
        return ENF_MAP_BAD(check, mesh_parts, i, material, ENF_ERROR_FORMAT, "parts of a mesh are not ordered by material");
    }
    return check_part_indices(check, &map->meshes[mesh], i);
}

/* Meshes list their parts one after the other, so that nothing is left over and nothing stands twice. */
static EnfResult check_meshes(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    uint32_t next = 0;
    for (uint32_t i = 0; i < map->meshes_count; i++) {
        const EnfMesh *mesh = &map->meshes[i];
        for (int axis = 0; axis < 3; axis++) {
            if (mesh->min[axis] > mesh->max[axis]) {
                return ENF_MAP_BAD(check, meshes, i, min[axis], ENF_ERROR_RANGE, "%g is above max %g", (double)mesh->min[axis],
                                   (double)mesh->max[axis]);
            }
        }
        if (mesh->part_first != next || mesh->part_count == 0) {
            return ENF_MAP_BAD(check, meshes, i, part_first, ENF_ERROR_FORMAT,
                               "%u and %u parts: parts do not follow one another", mesh->part_first, mesh->part_count);
        }
        next += mesh->part_count;
        for (uint32_t part = mesh->part_first; part < next; part++) {
            EnfResult result = check_part(check, i, part);
            if (result != ENF_OK) {
                return result;
            }
        }
    }
    return next == map->mesh_parts_count
               ? ENF_OK
               : enf_error_set(check->error, ENF_ERROR_FORMAT, check->offsets[ENF_CHUNK_mesh_parts],
                               "chunk MPRT: mesh_parts: %u records, but meshes list %u", map->mesh_parts_count, next);
}

/* ---- movers ----------------------------------------------------------------------------------------------------- */

static EnfResult check_path_of(const EnfMapCheck *check, uint32_t i, uint32_t path, EnfPathTarget target) {
    if (path != ENF_NONE && check->map->paths[path].target != (uint32_t)target) {
        return ENF_MAP_BAD(check, movers, i, translation, ENF_ERROR_INDEX, "path %u moves something else than this field says",
                           path);
    }
    return ENF_OK;
}

static EnfResult check_swing(const EnfMapCheck *check, uint32_t i) {
    const EnfMover *mover = &check->map->movers[i];
    double x = (double)mover->axis[0], y = (double)mover->axis[1], z = (double)mover->axis[2];
    if (fabs(sqrt(x * x + y * y + z * z) - 1.0) > UNIT_SLACK) {
        return ENF_MAP_BAD(check, movers, i, axis, ENF_ERROR_RANGE, "is not of unit length");
    }
    if (mover->low > 0.0f || mover->high < 0.0f) {
        return ENF_MAP_BAD(check, movers, i, low, ENF_ERROR_RANGE, "low %g <= 0 <= high %g does not hold", (double)mover->low,
                           (double)mover->high);
    }
    if (!(mover->rate > 0.0f)) {
        return ENF_MAP_BAD(check, movers, i, rate, ENF_ERROR_RANGE, "%g is not positive", (double)mover->rate);
    }
    return ENF_OK;
}

static EnfResult check_mover(const EnfMapCheck *check, uint32_t i) {
    const EnfMover *mover = &check->map->movers[i];
    EnfResult result = check_path_of(check, i, mover->translation, ENF_PATH_TRANSLATION);
    result = result ? result : check_path_of(check, i, mover->rotation, ENF_PATH_ROTATION);
    result = result ? result : check_path_of(check, i, mover->scale, ENF_PATH_SCALE);
    if (result != ENF_OK) {
        return result;
    }
    if (mover->kind == ENF_MOVER_PATH && !(mover->seconds > 0.0f && mover->seconds <= SECONDS_MAX)) {
        return ENF_MAP_BAD(check, movers, i, seconds, ENF_ERROR_RANGE, "%g is not in 0..%g", (double)mover->seconds,
                           (double)SECONDS_MAX);
    }
    if (fabsf(mover->phase) > SECONDS_MAX) {
        return ENF_MAP_BAD(check, movers, i, phase, ENF_ERROR_RANGE, "%g is too large", (double)mover->phase);
    }
    if (mover->max_speed < 0.0f || (mover->kind == ENF_MOVER_FREE && mover->max_speed == 0.0f)) {
        return ENF_MAP_BAD(check, movers, i, max_speed, ENF_ERROR_RANGE, "%g is not positive", (double)mover->max_speed);
    }
    bool swings = mover->kind == ENF_MOVER_HINGE || mover->kind == ENF_MOVER_SLIDE;
    return swings ? check_swing(check, i) : ENF_OK;
}

EnfResult enf_map_check_movers(const EnfMapCheck *check) {
    EnfResult result = check_meshes(check);
    for (uint32_t i = 0; result == ENF_OK && i < check->map->movers_count; i++) {
        result = check_mover(check, i);
    }
    return result;
}

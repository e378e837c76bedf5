/* The movers of a map as solids: the triangles of their meshes that collide, and the box that holds each for all time. */
#include "world/collide_internal.h"

#include <math.h>

bool enf_material_collides(const EnfMaterial *material) {
    if (material->flags & ENF_MATERIAL_NOCOLLIDE) {
        return false;
    }
    bool drawn = (material->flags & ENF_MATERIAL_NODRAW) == 0 && material->alpha_mode != ENF_ALPHA_BLEND;
    return drawn || (material->flags & ENF_MATERIAL_CLIP) != 0;
}

/* Wherever it may ever be. Who is steered from outside may be anywhere: an empty box. */
static EnfBox3 all_time(const EnfObjectDef *def) {
    EnfMotion motion = def->motion;
    int64_t from = 0, to = 0;
    if (motion.kind == ENF_MOTION_PATH) { /* more than a pass, from its beginning */
        from = motion.as.path.start_tick;
        to = from + 2 * (int64_t)motion.as.path.period_ticks;
    } else if (motion.kind == ENF_MOTION_HINGE || motion.kind == ENF_MOTION_SLIDE) { /* from one end to the other */
        EnfSwingMotion *swing = &motion.as.swing;
        double ticks = ceil((swing->high - swing->low) / swing->rate * ENF_TICK_RATE) + 2.0;
        swing->from = swing->low;
        swing->target = swing->high;
        swing->event_tick = 0;
        to = ticks < 1e15 ? (int64_t)ticks : (int64_t)1e15;
    } else if (motion.kind != ENF_MOTION_STILL) {
        return enf_box3_empty();
    }
    return enf_motion_bound(&motion, &def->local, from, to);
}

static uint32_t mesh_triangles(const EnfCollider *collider, const EnfMesh *mesh, EnfVec3f *corners) {
    const EnfMap *map = collider->map;
    uint32_t count = 0;
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &map->mesh_parts[p];
        if (!collider->collides[part->material]) {
            continue;
        }
        for (uint32_t i = 0; i < part->index_count / 3 * 3; i++) {
            if (count / 3 == ENF_SOLID_TRIANGLES_MAX) {
                return ENF_SOLID_TRIANGLES_MAX + 1;
            }
            const float *v = map->vertices[map->indices[part->index_first + i]].position;
            corners[count++] = (EnfVec3f){v[0], v[1], v[2]};
        }
    }
    return count / 3;
}

/* A mesh of many triangles, or of something that walks by itself, is its box. */
static EnfResult add_mover(EnfCollider *collider, uint32_t mover, EnfVec3f *corners, EnfError *error) {
    const EnfMover *m = &collider->map->movers[mover];
    EnfObjectDef object = enf_mover_def(collider->map, mover);
    uint32_t count = mesh_triangles(collider, &collider->map->meshes[m->mesh], corners);
    if (count == 0) {
        return ENF_OK;
    }
    if (count > ENF_SOLID_TRIANGLES_MAX || m->kind == ENF_MOVER_FREE) {
        enf_solid_box(object.local, corners);
        count = 12;
    }
    EnfSolidDef def = {mover, corners, count, all_time(&object)};
    uint32_t number;
    return enf_collide_add_solid(collider, &def, &number, error);
}

EnfResult enf_collide_add_movers(EnfCollider *collider, EnfError *error) {
    size_t count = 3 * ENF_SOLID_TRIANGLES_MAX;
    EnfVec3f *corners = enf_alloc(collider->allocator, count, sizeof *corners);
    if (corners == NULL) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "the solids of a collider");
    }
    EnfResult result = ENF_OK;
    for (uint32_t i = 0; result == ENF_OK && i < collider->map->movers_count; i++) {
        const EnfMover *mover = &collider->map->movers[i];
        if ((mover->flags & ENF_MOVER_SOLID) && mover->mesh != ENF_NONE) {
            result = add_mover(collider, i, corners, error);
        }
    }
    enf_free(collider->allocator, corners, count, sizeof *corners);
    return result;
}

/* Makes the movers of a list: matrix, box and cells of every object drawn, and its parts in the canonical order. What is made of an
 * object depends on the map, its motion and the eye, never on what else is drawn (PITFALLS 33). */
#include <math.h>
#include <string.h>

#include "draw/draw_internal.h"

/* Cells that a box may touch before its tree is asked no further: a rule of map and box alone, like all here. */
enum { CELLS_FOUND = 64 };

/* ---- memory ----------------------------------------------------------------------------------------------------- */

/* The arrays that hold movers or parts, and how many elements each may need: X(array, elements). */
#define ENF_DRAW_MOVER_ARRAYS(X)                                                                                               \
    X(movers, movers)                                                                                                          \
    X(parts, parts)                                                                                                            \
    X(part_order, parts)                                                                                                       \
    X(batches, (size_t)map->clusters_count + map->materials_count + parts)                                                     \
    X(ranges, (size_t)map->clusters_count + parts)                                                                             \
    X(blends, (size_t)map->clusters_count + parts)

static void free_arrays(EnfDraw *draw, size_t movers, size_t parts) {
    const EnfMap *map = draw->map;
#define ENF_DRAW_FREE(array, count) enf_free(&draw->allocator, draw->array, (count) + 1, sizeof *draw->array);
    ENF_DRAW_MOVER_ARRAYS(ENF_DRAW_FREE)
#undef ENF_DRAW_FREE
}

bool enf_draw_reserve_movers(EnfDraw *draw, uint32_t movers, uint32_t parts) {
    const EnfMap *map = draw->map;
    EnfDraw grown = *draw;
    bool complete = true;
#define ENF_DRAW_MAKE(array, count)                                                                                            \
    grown.array = enf_alloc(&draw->allocator, (size_t)(count) + 1, sizeof *grown.array);                                       \
    complete = complete && grown.array;
    ENF_DRAW_MOVER_ARRAYS(ENF_DRAW_MAKE)
#undef ENF_DRAW_MAKE
    if (!complete) {
        free_arrays(&grown, movers, parts);
        return false;
    }
    if (draw->movers) {
        free_arrays(draw, draw->mover_capacity, draw->part_capacity);
    }
    grown.mover_capacity = movers;
    grown.part_capacity = parts;
    *draw = grown;
    return true;
}

void enf_draw_free_movers(EnfDraw *draw) {
    if (draw->movers) {
        free_arrays(draw, draw->mover_capacity, draw->part_capacity);
    }
}

/* ---- which ------------------------------------------------------------------------------------------------------ */

/* The objects that a set shows: those it lists, else all of the world that live. */
typedef struct Objects {
    const EnfVisSet *set;
    const EnfWorld *world;
    uint32_t count;
} Objects;

static Objects objects_of(const EnfVisSet *set, const EnfWorld *world) {
    Objects objects = {set, world, 0};
    if (world) {
        objects.count = set->objects_listed ? set->object_count : enf_world_object_limit(world);
    }
    return objects;
}

/* The mesh of the i-th object, if it lives and the map has one for it. */
static const EnfMesh *mesh_of(const Objects *objects, const EnfMap *map, uint32_t i, uint32_t *object) {
    *object = objects->set->objects_listed ? objects->set->objects[i] : i;
    if (enf_world_object(objects->world, *object).generation == 0) {
        return NULL;
    }
    uint32_t mesh = enf_world_mesh(objects->world, *object);
    return mesh < map->meshes_count ? &map->meshes[mesh] : NULL;
}

/* More room than asked for, so that a frame that shows a few objects more finds it. */
static uint32_t roomy(uint64_t wanted, uint32_t capacity) {
    uint64_t more = wanted + wanted / 2;
    return wanted <= capacity ? capacity : more < UINT32_MAX / 4 ? (uint32_t)more : UINT32_MAX / 4;
}

static void make_room(EnfDraw *draw, const Objects *objects) {
    uint64_t movers = 0, parts = 0;
    for (uint32_t i = 0; i < objects->count; i++) {
        uint32_t object;
        const EnfMesh *mesh = mesh_of(objects, draw->map, i, &object);
        movers += mesh ? 1U : 0U;
        parts += mesh ? mesh->part_count : 0U;
    }
    if (movers > draw->mover_capacity || parts > draw->part_capacity) {
        (void)enf_draw_reserve_movers(draw, roomy(movers, draw->mover_capacity), roomy(parts, draw->part_capacity));
    }
}

/* ---- where ------------------------------------------------------------------------------------------------------ */

static EnfAffine blend(const EnfAffine *from, const EnfAffine *to, double alpha) {
    EnfAffine out;
    for (int i = 0; i < 9; i++) {
        out.m[i] = from->m[i] + (to->m[i] - from->m[i]) * alpha;
    }
    out.t = enf_add(from->t, enf_scale(enf_sub(to->t, from->t), alpha));
    return out;
}

/* Matrices are blended, not poses: a point then lies on the chord between its two places, inside what enf_world_seen_box holds. */
static EnfAffine model_at(EnfWorld *world, uint32_t object, double alpha) {
    EnfPose pose = enf_world_pose(world, object), last;
    EnfAffine now = enf_affine_trs(pose.position, pose.rotation, pose.scale);
    if (alpha < 1.0 && enf_world_last_pose(world, object, &last)) {
        EnfAffine before = enf_affine_trs(last.position, last.rotation, last.scale);
        return blend(&before, &now, alpha);
    }
    return now;
}

/* Relative to the eye in double, then rounded once. */
static void set_matrix(EnfDrawMover *mover, const EnfAffine *model, EnfVec3 eye_ws) {
    for (int i = 0; i < 9; i++) {
        mover->eye_from_model[i] = (float)model->m[i];
    }
    EnfVec3f t = enf_v3f(enf_sub(model->t, eye_ws));
    mover->eye_from_model[9] = t.x;
    mover->eye_from_model[10] = t.y;
    mover->eye_from_model[11] = t.z;
}

/* The box of the mesh where it is, relative to the model's origin. */
static EnfBox3 box_of(const EnfMesh *mesh, const EnfAffine *model) {
    EnfVec3 low = enf_v3((double)mesh->min[0], (double)mesh->min[1], (double)mesh->min[2]);
    EnfVec3 high = enf_v3((double)mesh->max[0], (double)mesh->max[1], (double)mesh->max[2]);
    EnfVec3 middle = enf_affine_vector(model, enf_scale(enf_add(low, high), 0.5));
    EnfVec3 half = enf_scale(enf_sub(high, low), 0.5);
    const double *m = model->m;
    EnfVec3 reach = enf_v3(fabs(m[0]) * half.x + fabs(m[3]) * half.y + fabs(m[6]) * half.z,
                           fabs(m[1]) * half.x + fabs(m[4]) * half.y + fabs(m[7]) * half.z,
                           fabs(m[2]) * half.x + fabs(m[5]) * half.y + fabs(m[8]) * half.z);
    EnfBox3 box = {enf_sub(middle, reach), enf_add(middle, reach)};
    return box;
}

static void add_cell(EnfDrawMover *mover, uint32_t cell) {
    uint32_t at = mover->cell_count;
    if (at == ENF_DRAW_MOVER_CELLS && mover->cells[at - 1] < cell) {
        return;
    }
    at = at == ENF_DRAW_MOVER_CELLS ? at - 1 : at;
    for (; at > 0 && mover->cells[at - 1] > cell; at--) {
        mover->cells[at] = mover->cells[at - 1];
    }
    mover->cells[at] = cell;
    mover->cell_count += mover->cell_count < ENF_DRAW_MOVER_CELLS ? 1U : 0U;
}

/* The cells that the box touches, ascending; the first of them if they are many. */
static void set_cells(EnfDrawMover *mover, const EnfMap *map, EnfBox3 box_ws) {
    EnfVec3 origin = enf_v3(map->tree_origin[0], map->tree_origin[1], map->tree_origin[2]);
    EnfBox3 in_tree = {enf_sub(box_ws.min, origin), enf_sub(box_ws.max, origin)};
    EnfKdTree tree = {map->cell_nodes, map->cell_blocks, map->cell_nodes_count, map->cell_blocks_count};
    EnfBox3f box = enf_box3f_outward(box_ws);
    uint32_t found[CELLS_FOUND];
    uint32_t count = tree.node_count ? enf_kd_overlap(&tree, enf_box3f_outward(in_tree), found, CELLS_FOUND) : 0;
    mover->cell_count = 0;
    for (uint32_t i = 0; i < count && i < CELLS_FOUND; i++) {
        if (enf_world_touches(map, found[i], box)) {
            add_cell(mover, found[i]);
        }
    }
    uint32_t last = map->cells_count - 1U; /* what lies in no room is in no tree of cells */
    if (map->cells_count > 0 && (map->cells[last].flags & ENF_CELL_OUTSIDE) && enf_world_touches(map, last, box)) {
        add_cell(mover, last);
    }
}

/* ---- parts ------------------------------------------------------------------------------------------------------ */

/* Opaque before masked, then by material; parts stand in the order of (object, part), which breaks ties. */
static uint64_t solid_key(const EnfMap *map, uint32_t material) {
    return (uint64_t)(map->materials[material].alpha_mode == ENF_ALPHA_MASK ? 1U : 0U) << 32 | material;
}

static void add_parts(EnfDraw *draw, const EnfMesh *mesh, double distance2) {
    const EnfMap *map = draw->map;
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &map->mesh_parts[p];
        const EnfMaterial *material = &map->materials[part->material];
        if (material->flags & ENF_MATERIAL_NODRAW) {
            continue;
        }
        bool blended = material->alpha_mode == ENF_ALPHA_BLEND;
        EnfDrawKey *key = blended ? &draw->blends[draw->blend_count++] : &draw->part_order[draw->part_order_count++];
        key->key = blended ? enf_draw_far_first(distance2) : solid_key(map, part->material);
        key->index = blended ? map->clusters_count + draw->part_count : draw->part_count;
        EnfDrawPart entry = {draw->list.mover_count - 1, p};
        draw->parts[draw->part_count++] = entry;
        draw->list.triangle_count += part->index_count / 3;
    }
}

static void add_mover(EnfDraw *draw, const EnfMesh *mesh, uint32_t object, const EnfAffine *model, EnfVec3 eye_ws) {
    EnfDrawMover *mover = &draw->movers[draw->list.mover_count++];
    EnfBox3 box = box_of(mesh, model);
    mover->object = object;
    mover->mesh = (uint32_t)(mesh - draw->map->meshes);
    set_matrix(mover, model, eye_ws);
    mover->position_ws = model->t;
    mover->box = enf_box3f_outward(box);
    EnfBox3 box_ws = {enf_add(box.min, model->t), enf_add(box.max, model->t)};
    set_cells(mover, draw->map, box_ws);
    EnfVec3 to = enf_sub(enf_scale(enf_add(box_ws.min, box_ws.max), 0.5), eye_ws);
    add_parts(draw, mesh, enf_dot(to, to));
}

void enf_draw_collect_movers(EnfDraw *draw, const EnfVisSet *set, EnfWorld *world, double alpha) {
    Objects objects = objects_of(set, world);
    for (uint32_t i = 0; i < objects.count; i++) {
        uint32_t object;
        const EnfMesh *mesh = mesh_of(&objects, draw->map, i, &object);
        if (!mesh) {
            continue;
        }
        if (draw->list.mover_count == draw->mover_capacity || draw->part_count + mesh->part_count > draw->part_capacity) {
            draw->list.movers_failed = true;
            return;
        }
        EnfAffine model = model_at(world, object, alpha);
        add_mover(draw, mesh, object, &model, set->cameras[0].eye_ws);
    }
}

void enf_draw_make_room(EnfDraw *draw, const EnfVisSet *set, const EnfWorld *world) {
    Objects objects = objects_of(set, world);
    make_room(draw, &objects);
}

/* ---- listing ---------------------------------------------------------------------------------------------------- */

void enf_draw_list_part(EnfDraw *draw, uint32_t place) {
    const EnfDrawPart *entry = &draw->parts[place];
    const EnfMeshPart *part = &draw->map->mesh_parts[entry->part];
    EnfDrawBatch *batch = enf_draw_open_batch(draw, part->material, entry->mover);
    EnfDrawRange *range = &draw->ranges[draw->list.range_count++];
    range->index_first = part->index_first;
    range->index_count = part->index_count;
    range->vertex_first = part->vertex_first;
    range->cluster = ENF_NONE;
    batch->range_count = 1;
}

void enf_draw_list_parts(EnfDraw *draw) {
    enf_draw_sort(draw->part_order, draw->part_order_count);
    for (uint32_t i = 0; i < draw->part_order_count; i++) {
        enf_draw_list_part(draw, draw->part_order[i].index);
    }
}

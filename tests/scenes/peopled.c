/* Copies of the arrays that grow, the rest borrowed from the map. */
#include "scenes/peopled.h"

#include <stdlib.h>
#include <string.h>

#include <enfilade/world.h>

enum { MESHES = 2, KEYS = 5, BOX_VERTICES = 24, BOX_INDICES = 36, FLOATS = KEYS + 9 * KEYS };

/* splitmix64 (Steele, Lea & Flood 2014). */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * ((double)(next_random(state) >> 11) * 0x1p-53);
}

/* A copy of an array with room for more; a scene without memory is no result. */
static void *grown(const void *array, size_t count, size_t more, size_t size) {
    void *copy = calloc(count + more + 1, size);
    if (!copy) {
        abort();
    }
    if (count) {
        memcpy(copy, array, count * size);
    }
    return copy;
}

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

static void put_side(EnfVertex *v, const float low[3], const float high[3], int axis, bool up) {
    static const uint32_t normals[3][2] = {{0x201u, 0x1ffu}, {0x201u << 10, 0x1ffu << 10}, {0x201u << 20, 0x1ffu << 20}};
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int k = 0; k < 4; k++) {
        int turn = up ? k : 3 - k;
        v[k].position[axis] = up ? high[axis] : low[axis];
        v[k].position[a] = turn == 1 || turn == 2 ? high[a] : low[a];
        v[k].position[b] = turn >= 2 ? high[b] : low[b];
        v[k].normal = normals[axis][up];
        v[k].uv[0] = v[k].position[a];
        v[k].uv[1] = v[k].position[b];
        v[k].color = UINT32_MAX;
        v[k].cell = ENF_NONE;
    }
}

/* A box, with the first material of a kind that is drawn. */
static void put_mesh(EnfMap *map, EnfVertex *vertices, uint32_t *indices, EnfMesh *mesh, EnfMeshPart *part) {
    /* Odd numbers: a face in the plane of a floor would tie with it in depth, seen from the room beyond. */
    static const float low[3] = {-0.2471f, 0.0113f, -0.2483f}, high[3] = {0.2479f, 1.7317f, 0.2467f};
    memcpy(mesh->min, low, sizeof low);
    memcpy(mesh->max, high, sizeof high);
    mesh->part_count = 1;
    part->vertex_first = map->vertices_count;
    part->vertex_count = BOX_VERTICES;
    part->index_first = map->indices_count;
    part->index_count = BOX_INDICES;
    for (uint32_t side = 0; side < 6; side++) {
        const uint32_t base = map->vertices_count + 4 * side;
        const uint32_t triangles[6] = {base, base + 1, base + 2, base, base + 2, base + 3};
        put_side(&vertices[base], low, high, (int)(side / 2), side % 2 != 0);
        memcpy(&indices[map->indices_count + 6 * side], triangles, sizeof triangles);
    }
    map->vertices_count += BOX_VERTICES;
    map->indices_count += BOX_INDICES;
}

static uint32_t find_material(const EnfMap *map, EnfAlphaMode mode) {
    for (uint32_t i = 0; i < map->materials_count; i++) {
        if (map->materials[i].alpha_mode == (uint32_t)mode && !(map->materials[i].flags & ENF_MATERIAL_NODRAW)) {
            return i;
        }
    }
    return mode == ENF_ALPHA_OPAQUE ? 0 : find_material(map, ENF_ALPHA_OPAQUE);
}

/* ---- movers ----------------------------------------------------------------------------------------------------- */

/* A point of the middle of a cell's bounds, `share` of each axis. */
static EnfVec3 place_in(const EnfMap *map, uint32_t cell, double share, uint64_t *random) {
    const EnfCell *c = &map->cells[cell];
    double p[3];
    for (int i = 0; i < 3; i++) {
        double middle = 0.5 * ((double)c->min[i] + (double)c->max[i]), half = 0.5 * share * (double)(c->max[i] - c->min[i]);
        p[i] = c->origin[i] + middle + between(random, -half, half);
    }
    return enf_v3(p[0], p[1], p[2]);
}

static EnfVec3 middle_of(const EnfMap *map, const EnfPortal *portal) {
    const double *o = map->cells[portal->source].origin;
    EnfBox3 box = enf_box3_empty();
    for (uint32_t v = 0; v < portal->vertex_count; v++) {
        box = enf_box3_add(box, enf_v3_from_f(map->portal_vertices[portal->vertex_first + v]));
    }
    return enf_add(enf_v3(o[0], o[1], o[2]), enf_scale(enf_add(box.min, box.max), 0.5));
}

/* There and back at 2 m/s: by a cubic in one cell, or straight through the middle of a portal into the next. Either way it stays within
 * the bounds of these cells: what is in no cell is seen by nobody (engine/draw/README.md). Returns the seconds. */
static float put_path(const EnfMap *map, uint32_t cell, bool cubic, float *floats, uint64_t *random) {
    float points[3 * KEYS];
    EnfVec3 way[KEYS];
    const EnfCell *c = &map->cells[cell];
    for (uint32_t k = 0; k < KEYS; k++) {
        way[k] = place_in(map, cell, cubic ? 0.5 : 0.9, random);
    }
    const EnfPortal *portal = c->portal_count ? &map->portals[c->portal_first + next_random(random) % c->portal_count] : NULL;
    if (!cubic && portal && portal->vertex_count > 0 && portal->transform == ENF_NONE) {
        way[1] = way[3] = middle_of(map, portal);
        way[2] = place_in(map, portal->target, 0.9, random);
    }
    way[KEYS - 1] = way[0];
    for (uint32_t k = 0; k < KEYS; k++) {
        points[3 * k] = (float)way[k].x;
        points[3 * k + 1] = (float)way[k].y;
        points[3 * k + 2] = (float)way[k].z;
        double length = k > 0 ? enf_length(enf_sub(way[k], way[k - 1])) : 0.0;
        floats[k] = k > 0 ? floats[k - 1] + (float)(0.1 + 0.5 * length) : 0.0f;
    }
    if (cubic) {
        enf_catmull_rom(floats, points, KEYS, floats + KEYS);
    } else {
        memcpy(floats + KEYS, points, sizeof points);
    }
    return floats[KEYS - 1];
}

static void put_mover(EnfMap *map, uint32_t number, uint64_t *random, EnfEntity *entities, EnfMover *movers) {
    EnfEntity *entity = &entities[map->entities_count];
    EnfMover *mover = &movers[map->movers_count];
    entity->rotation[3] = 1.0f;
    entity->scale[0] = entity->scale[1] = entity->scale[2] = 1.0f;
    entity->parent = entity->cell = entity->camera = entity->light = ENF_NONE;
    mover->entity = map->entities_count++;
    mover->mesh = map->meshes_count - MESHES + number % 4 / 3; /* one in four is of glass */
    mover->kind = ENF_MOVER_PATH;
    mover->wrap = number % 2 ? ENF_WRAP_LOOP : ENF_WRAP_PING_PONG;
    mover->rotation = mover->scale = mover->portal = ENF_NONE;
    mover->axis[1] = mover->rate = 1.0f;
    mover->phase = (float)between(random, 0.0, 100.0);
    map->movers_count++;
}

static void put_movers(EnfMap *map, uint32_t count, uint64_t seed) {
    EnfEntity *entities = grown(map->entities, map->entities_count, count, sizeof *entities);
    EnfMover *movers = grown(map->movers, map->movers_count, count, sizeof *movers);
    EnfPath *paths = grown(map->paths, map->paths_count, count, sizeof *paths);
    float *floats = grown(map->path_floats, map->path_floats_count, (size_t)count * FLOATS, sizeof *floats);
    uint64_t random = seed;
    for (uint32_t i = 0; i < count; i++) {
        bool cubic = next_random(&random) % 2 != 0;
        EnfPath *path = &paths[map->paths_count];
        movers[map->movers_count].translation = map->paths_count++;
        path->entity = map->entities_count;
        path->target = ENF_PATH_TRANSLATION;
        path->kind = cubic ? ENF_PATH_CUBIC : ENF_PATH_LINEAR;
        path->key_count = KEYS;
        path->float_first = map->path_floats_count;
        movers[map->movers_count].seconds = put_path(map, (uint32_t)(next_random(&random) % map->cells_count), cubic,
                                                     &floats[path->float_first], &random);
        map->path_floats_count += KEYS + (cubic ? 9U : 3U) * KEYS;
        put_mover(map, i, &random, entities, movers);
    }
    map->entities = entities;
    map->movers = movers;
    map->paths = paths;
    map->path_floats = floats;
}

EnfResult enf_peopled_write(const EnfMap *from, uint32_t movers, uint64_t seed, const char *path, EnfError *error) {
    EnfMap map = *from;
    EnfVertex *vertices = grown(from->vertices, from->vertices_count, (size_t)MESHES * BOX_VERTICES, sizeof *vertices);
    uint32_t *indices = grown(from->indices, from->indices_count, (size_t)MESHES * BOX_INDICES, sizeof *indices);
    EnfMesh *meshes = grown(from->meshes, from->meshes_count, MESHES, sizeof *meshes);
    EnfMeshPart *parts = grown(from->mesh_parts, from->mesh_parts_count, MESHES, sizeof *parts);
    for (uint32_t i = 0; i < MESHES; i++) {
        EnfMesh *mesh = &meshes[map.meshes_count];
        EnfMeshPart *part = &parts[map.mesh_parts_count];
        mesh->part_first = map.mesh_parts_count++;
        part->mesh = map.meshes_count++;
        part->material = find_material(from, i ? ENF_ALPHA_BLEND : ENF_ALPHA_OPAQUE);
        put_mesh(&map, vertices, indices, mesh, part);
    }
    map.vertices = vertices;
    map.indices = indices;
    map.meshes = meshes;
    map.mesh_parts = parts;
    put_movers(&map, movers, seed);
    EnfResult result = enf_map_check(&map, error);
    result = result == ENF_OK ? enf_map_write(&map, path, error) : result;
    const void *copies[] = {vertices, indices, meshes, parts, map.entities, map.movers, map.paths, map.path_floats};
    for (int i = 0; i < 8; i++) {
        free((void *)(uintptr_t)copies[i]);
    }
    return result;
}

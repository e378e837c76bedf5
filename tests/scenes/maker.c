/* EnfMaker: collects, then sorts and cuts as the format wants it: clusters by cell and material, portals by source, a tree a cell. */
#include "scenes/maker.h"

#include <enfilade/tolerances.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES_MAX = 128 };

/* A growing array behind one array of the map. */
typedef struct List {
    void *data;
    uint32_t count, capacity;
} List;

typedef struct Polygon {
    uint32_t cell, material, group, order, node;
    uint32_t first, count; /* in points */
} Polygon;

typedef struct Half {
    EnfPortal portal; /* vertex_first in portal_points */
    uint32_t number;  /* before sorting: pair number × 2 + way */
} Half;

/* A group, all of one cell and material, that is listed in another cell too. */
typedef struct Reach {
    uint32_t group, cell;
} Reach;

typedef struct MeshBox {
    uint32_t mesh, material;
    EnfBox3 box;
} MeshBox;

struct EnfMaker {
#define MAKER_LIST(type, array, fourcc) List array;
    ENF_MAP_CHUNKS(MAKER_LIST)
#undef MAKER_LIST
    List polygons, points, halves, portal_points, reaches, cluster_groups, mesh_boxes;
    uint32_t *half_index;  /* number → map index */
    uint32_t *group_first; /* group → its first cluster */
    uint32_t group, node;
    bool failed;
    EnfMap map;
};

/* ---- lists ------------------------------------------------------------------------------------------------------ */

static void *list_add(List *list, const void *records, uint32_t count, size_t size) {
    if (list->capacity - list->count < count) {
        uint32_t capacity = 2 * list->capacity + count + 16;
        void *data = realloc(list->data, capacity * size);
        if (!data) {
            abort(); /* a test's scene: no memory is no result */
        }
        list->data = data;
        list->capacity = capacity;
    }
    char *to = (char *)list->data + list->count * size;
    if (count) {
        memcpy(to, records, count * size);
    }
    list->count += count;
    return to;
}

#define ADD(m, list, pointer, count) list_add(&(m)->list, (pointer), (count), sizeof *(pointer))

EnfMaker *enf_maker_create(void) {
    EnfMaker *m = calloc(1, sizeof *m);
    if (m) {
        ADD(m, strings, "", 1);
        enf_maker_material(m, "plaster", 0.8f, 0.78f, 0.74f);
    }
    return m;
}

void enf_maker_destroy(EnfMaker *m) {
    if (m) {
#define MAKER_FREE(type, array, fourcc) free(m->array.data);
        ENF_MAP_CHUNKS(MAKER_FREE)
#undef MAKER_FREE
        free(m->polygons.data);
        free(m->points.data);
        free(m->halves.data);
        free(m->portal_points.data);
        free(m->reaches.data);
        free(m->cluster_groups.data);
        free(m->mesh_boxes.data);
        free(m->half_index);
        free(m->group_first);
        free(m);
    }
}

/* ---- records ---------------------------------------------------------------------------------------------------- */

uint32_t enf_maker_string(EnfMaker *m, const char *text) {
    const char *strings = m->strings.data;
    for (uint32_t at = 0; at < m->strings.count; at += (uint32_t)strlen(strings + at) + 1) {
        if (strcmp(strings + at, text) == 0) {
            return at;
        }
    }
    uint32_t at = m->strings.count;
    ADD(m, strings, text, (uint32_t)strlen(text) + 1);
    return at;
}

EnfMaterial *enf_maker_material(EnfMaker *m, const char *name, float r, float g, float b) {
    EnfMaterial material;
    memset(&material, 0, sizeof material);
    material.name = enf_maker_string(m, name);
    material.texture = material.emissive_texture = ENF_NONE;
    material.base_color[0] = r, material.base_color[1] = g, material.base_color[2] = b, material.base_color[3] = 1.0f;
    material.alpha_cutoff = 0.5f;
    material.roughness = 1.0f;
    material.uv_transform[0] = material.uv_transform[4] = 1.0f;
    return ADD(m, materials, &material, 1);
}

EnfCell *enf_maker_cell(EnfMaker *m, const char *name, EnfVec3 origin_ws, uint32_t *index) {
    EnfCell cell;
    memset(&cell, 0, sizeof cell);
    cell.origin[0] = floor(origin_ws.x / ENF_ORIGIN_STEP) * ENF_ORIGIN_STEP;
    cell.origin[1] = floor(origin_ws.y / ENF_ORIGIN_STEP) * ENF_ORIGIN_STEP;
    cell.origin[2] = floor(origin_ws.z / ENF_ORIGIN_STEP) * ENF_ORIGIN_STEP;
    cell.name = enf_maker_string(m, name);
    cell.bound_first = m->bound_planes.count;
    *index = m->cells.count;
    return ADD(m, cells, &cell, 1);
}

static EnfCell *cell_at(const EnfMaker *m, uint32_t cell) {
    return (EnfCell *)m->cells.data + cell;
}

static EnfVec3 cell_origin(const EnfMaker *m, uint32_t cell) {
    const double *o = cell_at(m, cell)->origin;
    return enf_v3(o[0], o[1], o[2]);
}

void enf_maker_light(EnfMaker *m, uint32_t cell, EnfVec3 p, EnfVec3f color, float range) {
    EnfLight light;
    memset(&light, 0, sizeof light);
    light.position[0] = p.x, light.position[1] = p.y, light.position[2] = p.z;
    light.direction[1] = -1.0f;
    light.color[0] = color.x, light.color[1] = color.y, light.color[2] = color.z;
    light.range = range;
    light.inner_cos = 1.0f;
    light.kind = ENF_LIGHT_POINT;
    light.cell = cell;
    light.name = enf_maker_string(m, "lamp");
    EnfLightRef ref = {m->lights.count, 0, 0};
    EnfCell *home = cell_at(m, cell);
    home->light_first = home->light_count++ ? home->light_first : m->light_refs.count;
    ADD(m, lights, &light, 1);
    ADD(m, light_refs, &ref, 1);
}

void enf_maker_light_window(EnfMaker *m, const EnfPlane4f *planes, uint32_t count) {
    EnfLightRef *ref = (EnfLightRef *)m->light_refs.data + m->light_refs.count - 1;
    ref->plane_first = m->light_planes.count;
    ref->plane_count = count;
    ADD(m, light_planes, planes, count);
}

void enf_maker_bound(EnfMaker *m, EnfVec3 normal, EnfVec3 point_ws) {
    uint32_t cell = m->cells.count - 1;
    EnfVec3 local = enf_sub(point_ws, cell_origin(m, cell));
    EnfPlane4f plane = {{(float)normal.x, (float)normal.y, (float)normal.z}, (float)-enf_dot(normal, local)};
    ADD(m, bound_planes, &plane, 1);
    cell_at(m, cell)->bound_count++;
}

uint32_t enf_maker_entity(EnfMaker *m, const EnfEntity *entity) {
    ADD(m, entities, entity, 1);
    return m->entities.count - 1;
}

uint32_t enf_maker_path(EnfMaker *m, const EnfPath *path, const float *floats, uint32_t float_count) {
    EnfPath placed = *path;
    placed.float_first = m->path_floats.count;
    ADD(m, path_floats, floats, float_count);
    ADD(m, paths, &placed, 1);
    return m->paths.count - 1;
}

uint32_t enf_maker_image(EnfMaker *m, uint32_t width, uint32_t height, const uint8_t *rgba) {
    EnfImage image = {width, height, m->pixels.count, enf_maker_string(m, "image")};
    ADD(m, pixels, rgba, 4 * width * height);
    ADD(m, images, &image, 1);
    return m->images.count - 1;
}

uint32_t enf_maker_texture(EnfMaker *m, uint32_t image) {
    EnfTexture texture = {image, 9729, 9987, 10497, 10497};
    ADD(m, textures, &texture, 1);
    return m->textures.count - 1;
}

uint32_t enf_maker_camera(EnfMaker *m, const EnfMapCamera *camera) {
    ADD(m, cameras, camera, 1);
    return m->cameras.count - 1;
}

/* ---- geometry --------------------------------------------------------------------------------------------------- */

uint32_t enf_maker_group(EnfMaker *m) {
    return ++m->group;
}

void enf_maker_node(EnfMaker *m, const char *name) {
    enf_maker_group(m);
    m->node = enf_maker_string(m, name);
}

void enf_maker_polygon(EnfMaker *m, uint32_t cell, uint32_t material, const EnfVec3 *points, uint32_t count) {
    Polygon polygon = {cell, material, m->group, m->polygons.count, m->node, m->points.count, count};
    ADD(m, points, points, count);
    ADD(m, polygons, &polygon, 1);
}

void enf_maker_box(EnfMaker *m, uint32_t cell, uint32_t material, EnfBox3 box, bool inward) {
    /* Corner bits: 1 x, 2 y, 4 z. Each side counter-clockwise seen from outside. */
    static const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int side = 0; side < 6; side++) {
        EnfVec3 points[4];
        for (int i = 0; i < 4; i++) {
            int corner = sides[side][inward ? 3 - i : i];
            points[i] = enf_v3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                               corner & 4 ? box.max.z : box.min.z);
        }
        enf_maker_polygon(m, cell, material, points, 4);
    }
}

void enf_maker_reach(EnfMaker *m, uint32_t cell) {
    Reach reach = {m->group, cell};
    ADD(m, reaches, &reach, 1);
}

/* ---- portals ---------------------------------------------------------------------------------------------------- */

static void add_half(EnfMaker *m, EnfPortal portal, const EnfVec3 *points, uint32_t count, bool reversed) {
    Half half = {portal, m->halves.count};
    half.portal.vertex_first = m->portal_points.count;
    half.portal.vertex_count = count;
    for (uint32_t i = 0; i < count; i++) {
        ADD(m, portal_points, &points[reversed ? count - 1 - i : i], 1);
    }
    ADD(m, halves, &half, 1);
}

uint32_t enf_maker_add_portal(EnfMaker *m, const EnfMakerPortal *p) {
    uint32_t number = m->halves.count;
    EnfPortal portal = {p->source, p->target, number + 1, 0, 0, ENF_NONE, p->flags, enf_maker_string(m, p->name)};
    add_half(m, portal, p->points, p->count, false);
    portal.source = p->target, portal.target = p->source, portal.twin = number;
    add_half(m, portal, p->points, p->count, true);
    return number;
}

uint32_t enf_maker_add_teleport(EnfMaker *m, const EnfMakerPortal *p, const EnfAffine *transform, uint32_t twin) {
    EnfTransform record;
    memcpy(record.m, transform->m, sizeof record.m);
    record.t[0] = transform->t.x, record.t[1] = transform->t.y, record.t[2] = transform->t.z;
    uint32_t flags = p->flags | (enf_affine_det(transform) < 0.0 ? ENF_PORTAL_MIRROR : 0);
    EnfPortal portal = {p->source, p->target, twin, 0, 0, m->transforms.count, flags, enf_maker_string(m, p->name)};
    ADD(m, transforms, &record, 1);
    if (twin != ENF_NONE) {
        ((Half *)m->halves.data)[twin].portal.twin = m->halves.count;
    }
    add_half(m, portal, p->points, p->count, false);
    return m->halves.count - 1;
}

uint32_t enf_maker_half(const EnfMaker *m, uint32_t number, uint32_t way) {
    return m->half_index[number + way];
}

static int compare_halves(const void *a, const void *b) {
    const Half *p = a, *q = b;
    if (p->portal.source != q->portal.source) {
        return p->portal.source < q->portal.source ? -1 : 1;
    }
    return p->number < q->number ? -1 : p->number > q->number;
}

static void cell_grow(EnfCell *cell, EnfVec3f p) {
    const float v[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++) {
        cell->min[axis] = v[axis] < cell->min[axis] ? v[axis] : cell->min[axis];
        cell->max[axis] = v[axis] > cell->max[axis] ? v[axis] : cell->max[axis];
    }
}

static void finish_portals(EnfMaker *m) {
    Half *halves = m->halves.data;
    const EnfVec3 *points = m->portal_points.data;
    m->half_index = calloc(m->halves.count + 1, sizeof *m->half_index);
    if (m->halves.count) {
        qsort(halves, m->halves.count, sizeof *halves, compare_halves);
    }
    for (uint32_t i = 0; i < m->halves.count; i++) {
        m->half_index[halves[i].number] = i;
    }
    for (uint32_t i = 0; i < m->halves.count; i++) {
        EnfPortal portal = halves[i].portal;
        EnfCell *cell = cell_at(m, portal.source);
        portal.twin = portal.twin == ENF_NONE ? ENF_NONE : m->half_index[portal.twin];
        portal.vertex_first = m->portal_vertices.count;
        for (uint32_t k = 0; k < portal.vertex_count; k++) {
            EnfVec3f p = enf_v3f(enf_sub(points[halves[i].portal.vertex_first + k], cell_origin(m, portal.source)));
            ADD(m, portal_vertices, &p, 1);
            cell_grow(cell, p);
        }
        cell->portal_first = cell->portal_count++ ? cell->portal_first : i;
        ADD(m, portals, &portal, 1);
    }
}

/* ---- clusters --------------------------------------------------------------------------------------------------- */

static int compare_polygons(const void *a, const void *b) {
    const Polygon *p = a, *q = b;
    const uint32_t keys[4][2] = {{p->cell, q->cell}, {p->material, q->material}, {p->group, q->group}, {p->order, q->order}};
    for (int i = 0; i < 4; i++) {
        if (keys[i][0] != keys[i][1]) {
            return keys[i][0] < keys[i][1] ? -1 : 1;
        }
    }
    return 0;
}

static uint32_t pack_normal(EnfVec3 n) {
    const double v[3] = {n.x, n.y, n.z};
    uint32_t packed = 0;
    for (int i = 0; i < 3; i++) {
        packed |= ((uint32_t)(int32_t)floor(v[i] * 511.0 + 0.5) & 0x3ff) << (10 * i);
    }
    return packed;
}

/* Texture coordinates in metres along the two axes that the polygon faces least. */
static void put_uv(EnfVertex *vertex, EnfVec3 n, EnfVec3 p) {
    bool along_x = fabs(n.x) > fabs(n.y) && fabs(n.x) > fabs(n.z), along_y = !along_x && fabs(n.y) > fabs(n.z);
    vertex->uv[0] = (float)(along_x ? p.z : p.x);
    vertex->uv[1] = (float)(along_y ? p.z : -p.y);
}

static void add_polygon(EnfMaker *m, EnfCluster *cluster, const Polygon *polygon) {
    const EnfVec3 *points = (const EnfVec3 *)m->points.data + polygon->first;
    EnfVec3 normal = enf_plane_from_polygon(points, polygon->count).n;
    uint32_t base = m->vertices.count;
    for (uint32_t i = 0; i < polygon->count; i++) {
        EnfVec3 local = enf_sub(points[i], cell_origin(m, polygon->cell));
        EnfVec3f p = enf_v3f(local);
        EnfVertex vertex = {{p.x, p.y, p.z}, pack_normal(normal), {0, 0}, 0xffffffffu, polygon->cell};
        put_uv(&vertex, normal, local);
        ADD(m, vertices, &vertex, 1);
        cell_grow(cell_at(m, polygon->cell), p);
        for (int axis = 0; axis < 3; axis++) {
            float v = vertex.position[axis];
            cluster->min[axis] = v < cluster->min[axis] ? v : cluster->min[axis];
            cluster->max[axis] = v > cluster->max[axis] ? v : cluster->max[axis];
        }
    }
    for (uint32_t i = 2; i < polygon->count; i++) {
        uint32_t triangle[3] = {base, base + i - 1, base + i};
        ADD(m, indices, triangle, 3);
    }
    cluster->vertex_count += polygon->count;
    cluster->index_count += 3 * (polygon->count - 2);
}

static void finish_clusters(EnfMaker *m) {
    Polygon *polygons = m->polygons.data;
    EnfCluster *cluster = NULL;
    if (m->polygons.count) {
        qsort(polygons, m->polygons.count, sizeof *polygons, compare_polygons);
    }
    for (uint32_t i = 0; i < m->polygons.count; i++) {
        const Polygon *p = &polygons[i];
        if (!cluster || p->cell != p[-1].cell || p->material != p[-1].material || p->group != p[-1].group ||
            cluster->index_count + 3 * (p->count - 2) > 3 * TRIANGLES_MAX) {
            EnfCluster fresh = {{FLT_MAX, FLT_MAX, FLT_MAX},
                                {-FLT_MAX, -FLT_MAX, -FLT_MAX},
                                p->cell,
                                p->material,
                                m->indices.count,
                                0,
                                m->vertices.count,
                                0,
                                p->node,
                                0};
            EnfCell *cell = cell_at(m, p->cell);
            cell->cluster_first = cell->cluster_count++ ? cell->cluster_first : m->clusters.count;
            cluster = ADD(m, clusters, &fresh, 1);
            ADD(m, cluster_groups, &p->group, 1);
        }
        add_polygon(m, cluster, p);
    }
}

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

uint32_t enf_maker_mesh(EnfMaker *m, const char *name, uint32_t material, EnfBox3 box) {
    EnfBox3f f = enf_box3f_outward(box);
    MeshBox pending = {m->meshes.count, material, box};
    EnfMesh mesh = {
        {f.min.x, f.min.y, f.min.z}, {f.max.x, f.max.y, f.max.z}, m->mesh_boxes.count, 1, enf_maker_string(m, name), 0};
    ADD(m, mesh_boxes, &pending, 1);
    ADD(m, meshes, &mesh, 1);
    return m->meshes.count - 1;
}

void enf_maker_mesh_part(EnfMaker *m, uint32_t material, EnfBox3 box) {
    EnfMesh *mesh = (EnfMesh *)m->meshes.data + m->meshes.count - 1;
    EnfBox3f whole = {{mesh->min[0], mesh->min[1], mesh->min[2]}, {mesh->max[0], mesh->max[1], mesh->max[2]}};
    EnfBox3f f = enf_box3f_outward(enf_box3_union(enf_box3_from_f(whole), box));
    EnfMesh grown = {
        {f.min.x, f.min.y, f.min.z}, {f.max.x, f.max.y, f.max.z}, mesh->part_first, mesh->part_count + 1, mesh->name, 0};
    MeshBox pending = {m->meshes.count - 1, material, box};
    *mesh = grown;
    ADD(m, mesh_boxes, &pending, 1);
}

EnfMover enf_maker_mover_default(void) {
    EnfMover mover;
    memset(&mover, 0, sizeof mover);
    mover.mesh = mover.translation = mover.rotation = mover.scale = mover.portal = ENF_NONE;
    mover.axis[1] = mover.rate = mover.seconds = mover.max_speed = 1.0f;
    return mover;
}

uint32_t enf_maker_mover(EnfMaker *m, const EnfMover *mover) {
    ADD(m, movers, mover, 1);
    return m->movers.count - 1;
}

/* The side of a box that faces along `axis` (up or down it): four vertices, two triangles. */
static void add_side(EnfMaker *m, EnfBox3 box, int axis, bool up) {
    uint32_t base = m->vertices.count;
    double n[3] = {0, 0, 0};
    n[axis] = up ? 1.0 : -1.0;
    for (int k = 0; k < 4; k++) {
        int turn = up ? k : 3 - k; /* counter-clockwise from outside */
        double p[3];
        const double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z};
        p[axis] = up ? high[axis] : low[axis];
        p[(axis + 1) % 3] = turn == 1 || turn == 2 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
        p[(axis + 2) % 3] = turn >= 2 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
        EnfVertex vertex = {
            {(float)p[0], (float)p[1], (float)p[2]}, pack_normal(enf_v3(n[0], n[1], n[2])), {0, 0}, UINT32_MAX, ENF_NONE};
        put_uv(&vertex, enf_v3(n[0], n[1], n[2]), enf_v3(p[0], p[1], p[2]));
        ADD(m, vertices, &vertex, 1);
    }
    const uint32_t indices[6] = {base, base + 1, base + 2, base, base + 2, base + 3};
    list_add(&m->indices, indices, 6, sizeof *indices);
}

static void finish_meshes(EnfMaker *m) {
    const MeshBox *boxes = m->mesh_boxes.data;
    for (uint32_t i = 0; i < m->mesh_boxes.count; i++) {
        EnfMeshPart part = {boxes[i].mesh, boxes[i].material, m->indices.count, 36, m->vertices.count, 24};
        for (int axis = 0; axis < 3; axis++) {
            add_side(m, boxes[i].box, axis, false);
            add_side(m, boxes[i].box, axis, true);
        }
        ADD(m, mesh_parts, &part, 1);
    }
}

/* ---- trees ------------------------------------------------------------------------------------------------------ */

static EnfBox3 cluster_box(const EnfMaker *m, uint32_t index) {
    const EnfCluster *c = (const EnfCluster *)m->clusters.data + index;
    EnfVec3 o = cell_origin(m, c->cell);
    EnfBox3 box = {enf_add(o, enf_v3((double)c->min[0], (double)c->min[1], (double)c->min[2])),
                   enf_add(o, enf_v3((double)c->max[0], (double)c->max[1], (double)c->max[2]))};
    return box;
}

static void list_item(EnfMaker *m, List *boxes, List *items, uint32_t cluster, uint32_t cell) {
    EnfBox3 box = cluster_box(m, cluster);
    EnfVec3 o = cell_origin(m, cell);
    EnfBox3 local = {enf_sub(box.min, o), enf_sub(box.max, o)};
    EnfBox3f stored = enf_box3f_outward(local);
    list_add(boxes, &stored, 1, sizeof stored);
    list_add(items, &cluster, 1, sizeof cluster);
}

static void add_tree(EnfMaker *m, List *nodes, List *blocks, const List *boxes, const uint32_t *items) {
    EnfKdBuilt built;
    m->failed |= enf_kd_build(&built, boxes->data, items, boxes->count, NULL, NULL) != ENF_OK;
    list_add(nodes, built.nodes, built.node_count, sizeof *built.nodes);
    list_add(blocks, built.blocks, built.block_count, sizeof *built.blocks);
    enf_kd_built_free(&built);
}

static int compare_reaches(const void *a, const void *b) {
    const Reach *p = a, *q = b;
    if (p->cell != q->cell) {
        return p->cell < q->cell ? -1 : 1;
    }
    return p->group < q->group ? -1 : p->group > q->group;
}

/* Where the clusters of each group begin. */
static uint32_t *first_of_group(const EnfMaker *m) {
    const uint32_t *groups = m->cluster_groups.data;
    uint32_t *first = calloc(m->group + 1, sizeof *first);
    for (uint32_t c = m->clusters.count; first && c-- > 0;) {
        first[groups[c]] = c;
    }
    return first;
}

/* `*reach` walks over the reaches, which are sorted by cell. */
static void finish_cell_tree(EnfMaker *m, uint32_t index, List *boxes, List *items, uint32_t *reach) {
    EnfCell *cell = cell_at(m, index);
    const Reach *reaches = m->reaches.data;
    const uint32_t *groups = m->cluster_groups.data;
    boxes->count = items->count = 0;
    for (uint32_t i = 0; i < cell->cluster_count; i++) {
        list_item(m, boxes, items, cell->cluster_first + i, index);
    }
    for (; *reach < m->reaches.count && reaches[*reach].cell == index; ++*reach) {
        uint32_t group = reaches[*reach].group;
        for (uint32_t c = m->group_first[group]; c < m->clusters.count && groups[c] == group; c++) {
            list_item(m, boxes, items, c, index);
        }
    }
    cell->node_first = m->kd_nodes.count;
    cell->block_first = m->kd_blocks.count;
    add_tree(m, &m->kd_nodes, &m->kd_blocks, boxes, items->data);
    cell->node_count = m->kd_nodes.count - cell->node_first;
    cell->block_count = m->kd_blocks.count - cell->block_first;
}

static void finish_trees(EnfMaker *m) {
    List boxes = {NULL, 0, 0}, items = {NULL, 0, 0};
    uint32_t reach = 0;
    m->group_first = first_of_group(m);
    if (m->reaches.count) {
        qsort(m->reaches.data, m->reaches.count, sizeof(Reach), compare_reaches);
    }
    for (uint32_t i = 0; i < m->cells.count; i++) {
        finish_cell_tree(m, i, &boxes, &items, &reach);
    }
    boxes.count = items.count = 0;
    memcpy(m->map.tree_origin, cell_at(m, 0)->origin, sizeof m->map.tree_origin);
    EnfVec3 o = cell_origin(m, 0);
    for (uint32_t i = 0; i < m->cells.count; i++) {
        const EnfCell *c = cell_at(m, i);
        EnfVec3 shift = enf_sub(cell_origin(m, i), o);
        EnfBox3 box = {enf_add(shift, enf_v3((double)c->min[0], (double)c->min[1], (double)c->min[2])),
                       enf_add(shift, enf_v3((double)c->max[0], (double)c->max[1], (double)c->max[2]))};
        EnfBox3f stored = enf_box3f_outward(box);
        if (!(c->flags & ENF_CELL_OUTSIDE)) {
            list_add(&boxes, &stored, 1, sizeof stored);
            list_add(&items, &i, 1, sizeof i);
        }
    }
    add_tree(m, &m->cell_nodes, &m->cell_blocks, &boxes, items.data);
    free(boxes.data);
    free(items.data);
}

const EnfMap *enf_maker_finish(EnfMaker *m, EnfError *error) {
    for (uint32_t i = 0; i < m->cells.count; i++) {
        EnfCell *cell = cell_at(m, i);
        for (int axis = 0; axis < 3; axis++) {
            cell->min[axis] = FLT_MAX;
            cell->max[axis] = -FLT_MAX;
        }
    }
    finish_clusters(m);
    finish_meshes(m);
    finish_portals(m);
    finish_trees(m);
#define MAKER_POINT(type, array, fourcc)                                                                                       \
    m->map.array = m->array.data;                                                                                              \
    m->map.array##_count = m->array.count;
    ENF_MAP_CHUNKS(MAKER_POINT)
#undef MAKER_POINT
    m->map.source_hash = 0;
    m->map.hash = enf_map_content_hash(&m->map);
    return !m->failed && enf_map_check(&m->map, error) == ENF_OK ? &m->map : NULL;
}

const EnfMap *enf_maker_map(const EnfMaker *m) {
    return &m->map;
}

/* EnfSoup from EnfSource: every drawable triangle in the world, snapped once to the grid, windings and normals right. */
#include "compile/soup.h"

#include "compile/exact.h"
#include "compile/layout_work.h"
#include "compile/weld.h"

#include <stdlib.h>
#include <string.h>

/* Vertices and triangles are numbered with 32 bits, and the welder packs a triangle's edge into one. */
#define SOUP_VERTICES_MAX UINT64_C(0x7fffffff)
#define SOUP_TRIANGLES_MAX UINT64_C(0x1fffffff)

/* What one node needs while its mesh is baked. */
typedef struct Baker {
    EnfSoup *soup;
    const EnfSource *source;
    uint32_t node, cell;
    EnfAffine world;
    double cofactor[9]; /* column-major, times the determinant's sign: the inverse transpose but for its length */
    bool mirrored;
    uint32_t dropped;
} Baker;

/* A room's own mesh is its shell, so it is drawn like any geometry in it. */
static bool is_drawn(const EnfSource *source, const EnfLayout *layout, uint32_t node) {
    EnfRole role = layout->roles[node];
    return source->nodes[node].mesh != ENF_NONE && (role == ENF_ROLE_GEOMETRY || role == ENF_ROLE_ROOM);
}

static void set_cofactors(Baker *baker) {
    const double *m = baker->world.m;
    double *c = baker->cofactor;
    for (int column = 0; column < 3; column++) {
        int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
        for (int row = 0; row < 3; row++) {
            int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
            c[3 * column + row] = m[3 * c1 + r1] * m[3 * c2 + r2] - m[3 * c2 + r1] * m[3 * c1 + r2];
        }
    }
    baker->mirrored = enf_affine_det(&baker->world) < 0;
    for (int i = 0; i < 9 && baker->mirrored; i++) {
        c[i] = -c[i];
    }
}

static void bake_normal(const Baker *baker, const float *from, float to[3]) {
    const double *c = baker->cofactor;
    double x = (double)from[0], y = (double)from[1], z = (double)from[2];
    EnfVec3 n = enf_normalize(
        enf_v3(c[0] * x + c[3] * y + c[6] * z, c[1] * x + c[4] * y + c[7] * z, c[2] * x + c[5] * y + c[8] * z));
    to[0] = (float)n.x;
    to[1] = (float)n.y;
    to[2] = (float)n.z;
}

static void bake_vertex(const Baker *baker, const EnfSourcePrimitive *primitive, uint32_t index, EnfSoupVertex *out) {
    const float *p = primitive->positions + 3 * (size_t)index;
    out->p = enf_grid_snap(enf_affine_point(&baker->world, enf_v3((double)p[0], (double)p[1], (double)p[2])));
    bake_normal(baker, primitive->normals + 3 * (size_t)index, out->normal);
    out->uv[0] = primitive->uvs ? primitive->uvs[2 * (size_t)index] : 0;
    out->uv[1] = primitive->uvs ? primitive->uvs[2 * (size_t)index + 1] : 0;
    for (int channel = 0; channel < 4; channel++) {
        out->color[channel] = primitive->colors ? primitive->colors[4 * (size_t)index + (size_t)channel] : 1;
    }
}

/* A scale of zero leaves vertices without a normal: they take their face's. */
static void mend_normals(EnfSoupVertex *vertices, const uint32_t v[3]) {
    for (int corner = 0; corner < 3; corner++) {
        float *n = vertices[v[corner]].normal;
        if (n[0] != 0 || n[1] != 0 || n[2] != 0) {
            continue;
        }
        EnfVec3 a = enf_grid_point(vertices[v[0]].p);
        EnfVec3 u = enf_sub(enf_grid_point(vertices[v[1]].p), a), w = enf_sub(enf_grid_point(vertices[v[2]].p), a);
        EnfVec3 face = enf_normalize(enf_cross(u, w));
        n[0] = (float)face.x;
        n[1] = (float)face.y;
        n[2] = (float)face.z;
    }
}

static void bake_primitive(Baker *baker, const EnfSourcePrimitive *primitive) {
    EnfSoup *soup = baker->soup;
    uint32_t base = soup->vertex_count;
    for (uint32_t i = 0; i < primitive->vertex_count; i++) {
        bake_vertex(baker, primitive, i, &soup->vertices[base + i]);
    }
    soup->vertex_count += primitive->vertex_count;
    for (uint32_t i = 0; i + 2 < primitive->index_count; i += 3) {
        const uint32_t *index = primitive->indices + i;
        uint32_t second = baker->mirrored ? 2 : 1;
        uint32_t v[3] = {base + index[0], base + index[second], base + index[3 - second]};
        if (enf_grid_collinear(soup->vertices[v[0]].p, soup->vertices[v[1]].p, soup->vertices[v[2]].p)) {
            baker->dropped++;
            continue;
        }
        mend_normals(soup->vertices, v);
        soup->triangles[soup->triangle_count++] = (EnfSoupTriangle){
            {v[0], v[1], v[2]}, primitive->material, baker->node, baker->cell};
    }
}

static void bake_node(EnfSoup *soup, const EnfSource *source, const EnfLayout *layout, uint32_t node, EnfDiagnosis *diagnosis) {
    Baker baker = {soup, source, node, layout->node_cells[node], source->nodes[node].world, {0}, false, 0};
    const EnfSourceMesh *mesh = &source->meshes[source->nodes[node].mesh];
    set_cofactors(&baker);
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &source->primitives[mesh->primitive_first + i];
        if (!enf_material_is_open(source, primitive->material)) {
            bake_primitive(&baker, primitive);
        }
    }
    soup->degenerate_count += baker.dropped;
    if (baker.dropped > 0) {
        enf_diagnose(diagnosis, ENF_DIAGNOSIS_DEGENERATE_TRIANGLES, source->nodes[node].name,
                     "%u triangles without area were left out", baker.dropped);
    }
}

/* Counts what will be baked, so that the arrays are allocated once. */
static EnfResult allocate(EnfSoup *soup, const EnfSource *source, const EnfLayout *layout, EnfError *error) {
    uint64_t vertices = 0, triangles = 0, drawn_triangles = 0;
    for (uint32_t node = 0; node < source->node_count; node++) {
        if (!is_drawn(source, layout, node)) {
            continue;
        }
        const EnfSourceMesh *mesh = &source->meshes[source->nodes[node].mesh];
        for (uint32_t i = 0; i < mesh->primitive_count; i++) {
            const EnfSourcePrimitive *primitive = &source->primitives[mesh->primitive_first + i];
            bool drawn = !(source->materials[primitive->material].flags & ENF_MATERIAL_NODRAW);
            vertices += primitive->vertex_count;
            triangles += primitive->index_count / 3;
            drawn_triangles += drawn ? primitive->index_count / 3 : 0;
        }
    }
    if (vertices > SOUP_VERTICES_MAX || triangles > SOUP_TRIANGLES_MAX) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "the level has %llu triangles: more than %llu",
                             (unsigned long long)triangles, (unsigned long long)SOUP_TRIANGLES_MAX);
    }
    soup->source_triangle_count = (uint32_t)drawn_triangles;
    soup->vertices = malloc((size_t)(vertices + 1) * sizeof *soup->vertices);
    soup->triangles = malloc((size_t)(triangles + 1) * sizeof *soup->triangles);
    if (!soup->vertices || !soup->triangles) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for %llu triangles",
                             (unsigned long long)triangles);
    }
    return ENF_OK;
}

EnfResult enf_soup_build(EnfSoup *soup, const EnfSource *source, const EnfLayout *layout, const EnfCompileSettings *settings,
                         EnfDiagnosis *diagnosis, EnfError *error) {
    memset(soup, 0, sizeof *soup);
    EnfResult result = allocate(soup, source, layout, error);
    for (uint32_t node = 0; node < source->node_count && result == ENF_OK; node++) {
        if (is_drawn(source, layout, node)) {
            bake_node(soup, source, layout, node, diagnosis);
        }
    }
    if (result == ENF_OK && settings->weld_tjunctions) {
        result = enf_weld(soup, error);
    }
    if (result != ENF_OK) {
        enf_soup_free(soup);
    }
    return result;
}

void enf_soup_free(EnfSoup *soup) {
    free(soup->vertices);
    free(soup->triangles);
    memset(soup, 0, sizeof *soup);
}

/* Normals made from triangles. See import_normals.h. */
#include "compile/import_normals.h"

#include <math.h>
#include <string.h>

static EnfVec3 position(const EnfSourcePrimitive *primitive, uint32_t v) {
    const float *p = primitive->positions + 3 * (size_t)v;
    return enf_v3((double)p[0], (double)p[1], (double)p[2]);
}

/* Twice the area, along the right-hand normal. */
static EnfVec3 face_vector(const EnfSourcePrimitive *primitive, const uint32_t *triangle) {
    EnfVec3 a = position(primitive, triangle[0]);
    return enf_cross(enf_sub(position(primitive, triangle[1]), a), enf_sub(position(primitive, triangle[2]), a));
}

static void store(EnfVec3 n, float *out) {
    bool usable = enf_v3_finite(n) && enf_dot(n, n) > 0.0;
    EnfVec3f f = enf_v3f(usable ? n : enf_v3(0.0, 1.0, 0.0));
    out[0] = f.x, out[1] = f.y, out[2] = f.z;
}

/* ---- flat ------------------------------------------------------------------------------------------------------- */

/* Faces whose normals differ by less than a tenth of a degree share vertices: their 10-bit stored normals are the same. */
#define SAME_FACE_COSINE 0.9999985

typedef struct Splitter {
    const EnfSourcePrimitive *from;
    uint32_t *heads;   /* a source vertex's first copy, or ENF_NONE */
    uint32_t *nexts;   /* a copy's next sibling */
    uint32_t *origins; /* a copy's source vertex */
    EnfVec3 *normals;  /* a copy's */
    uint32_t count;
} Splitter;

static uint32_t copy_for(Splitter *splitter, uint32_t vertex, EnfVec3 normal) {
    for (uint32_t c = splitter->heads[vertex]; c != ENF_NONE; c = splitter->nexts[c]) {
        if (enf_dot(splitter->normals[c], normal) >= SAME_FACE_COSINE) {
            return c;
        }
    }
    uint32_t copy = splitter->count++;
    splitter->origins[copy] = vertex;
    splitter->normals[copy] = normal;
    splitter->nexts[copy] = splitter->heads[vertex];
    splitter->heads[vertex] = copy;
    return copy;
}

static bool allocate(Splitter *splitter, const EnfSourcePrimitive *primitive) {
    splitter->from = primitive;
    splitter->heads = enf_alloc(NULL, primitive->vertex_count + (size_t)1, sizeof(uint32_t));
    splitter->nexts = enf_alloc(NULL, primitive->index_count + (size_t)1, sizeof(uint32_t));
    splitter->origins = enf_alloc(NULL, primitive->index_count + (size_t)1, sizeof(uint32_t));
    splitter->normals = enf_alloc(NULL, primitive->index_count + (size_t)1, sizeof(EnfVec3));
    return splitter->heads && splitter->nexts && splitter->origins && splitter->normals;
}

static void release(Splitter *splitter) {
    enf_free(NULL, splitter->heads, splitter->from->vertex_count + (size_t)1, sizeof(uint32_t));
    enf_free(NULL, splitter->nexts, splitter->from->index_count + (size_t)1, sizeof(uint32_t));
    enf_free(NULL, splitter->origins, splitter->from->index_count + (size_t)1, sizeof(uint32_t));
    enf_free(NULL, splitter->normals, splitter->from->index_count + (size_t)1, sizeof(EnfVec3));
}

static void split(Splitter *splitter, uint32_t *indices) {
    const EnfSourcePrimitive *from = splitter->from;
    memset(splitter->heads, 0xFF, from->vertex_count * sizeof *splitter->heads);
    for (uint32_t i = 0; i < from->index_count; i += 3) {
        EnfVec3 normal = enf_normalize(face_vector(from, from->indices + i));
        if (enf_dot(normal, normal) == 0.0 || !enf_v3_finite(normal)) {
            normal = enf_v3(0.0, 1.0, 0.0); /* a degenerate triangle: dropped later */
        }
        for (uint32_t k = 0; k < 3; k++) {
            indices[i + k] = copy_for(splitter, from->indices[i + k], normal);
        }
    }
}

/* A kept array in which each copy has its origin's values; `*out` stays NULL where there is none. */
static bool gather(EnfImport *import, const Splitter *splitter, const float *values, size_t components, const float **out) {
    if (!values) {
        return true;
    }
    float *copies = enf_import_keep(import, splitter->count, components * sizeof *copies);
    for (uint32_t i = 0; copies && i < splitter->count; i++) {
        memcpy(copies + i * components, values + splitter->origins[i] * components, components * sizeof *copies);
    }
    *out = copies;
    return copies != NULL;
}

static EnfResult replace(EnfImport *import, const Splitter *splitter, EnfSourcePrimitive *to) {
    float *normals = enf_import_keep(import, splitter->count, 3 * sizeof *normals);
    const EnfSourcePrimitive *from = splitter->from;
    EnfSourcePrimitive made = *from;
    if (!normals || !gather(import, splitter, from->positions, 3, &made.positions) ||
        !gather(import, splitter, from->uvs, 2, &made.uvs) || !gather(import, splitter, from->colors, 4, &made.colors)) {
        return import->failure;
    }
    for (uint32_t i = 0; i < splitter->count; i++) {
        store(splitter->normals[i], normals + 3 * (size_t)i);
    }
    made.normals = normals;
    made.vertex_count = splitter->count;
    *to = made;
    return ENF_OK;
}

EnfResult enf_import_flat_normals(EnfImport *import, EnfSourcePrimitive *primitive) {
    EnfSourcePrimitive from = *primitive;
    Splitter splitter = {0};
    uint32_t *indices = enf_import_keep(import, from.index_count, sizeof *indices);
    EnfResult result = indices ? ENF_OK : import->failure;
    if (!allocate(&splitter, &from) && result == ENF_OK) {
        result = enf_error_set(import->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for normals");
    }
    if (result == ENF_OK) {
        split(&splitter, indices);
        result = replace(import, &splitter, primitive);
    }
    release(&splitter);
    if (result == ENF_OK) {
        primitive->indices = indices;
    }
    return result;
}

/* ---- mended ----------------------------------------------------------------------------------------------------- */

static EnfVec3 read_normal(const float *n) {
    return enf_normalize(enf_v3((double)n[0], (double)n[1], (double)n[2]));
}

static bool is_unit(EnfVec3 n) {
    return enf_v3_finite(n) && enf_dot(n, n) > 0.5;
}

/* The area-weighted mean of the faces around each vertex, for the vertices whose own normal is no direction. */
static EnfResult replace_bad(EnfImport *import, const EnfSourcePrimitive *primitive, float *normals) {
    EnfVec3 *sums = enf_alloc(NULL, primitive->vertex_count, sizeof *sums);
    if (!sums) {
        return enf_error_set(import->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for normals");
    }
    for (uint32_t i = 0; i < primitive->index_count; i += 3) {
        EnfVec3 face = face_vector(primitive, primitive->indices + i);
        for (uint32_t k = 0; k < 3 && enf_v3_finite(face); k++) {
            EnfVec3 *sum = &sums[primitive->indices[i + k]];
            *sum = enf_add(*sum, face);
        }
    }
    for (uint32_t v = 0; v < primitive->vertex_count; v++) {
        if (!is_unit(read_normal(normals + 3 * (size_t)v))) {
            store(enf_normalize(sums[v]), normals + 3 * (size_t)v);
        }
    }
    enf_free(NULL, sums, primitive->vertex_count, sizeof *sums);
    return ENF_OK;
}

EnfResult enf_import_mend_normals(EnfImport *import, const EnfSourcePrimitive *primitive, float *normals) {
    bool bad = false;
    for (uint32_t v = 0; v < primitive->vertex_count; v++) {
        EnfVec3 n = read_normal(normals + 3 * (size_t)v);
        if (is_unit(n)) {
            store(n, normals + 3 * (size_t)v);
        } else {
            bad = true;
        }
    }
    return bad ? replace_bad(import, primitive, normals) : ENF_OK;
}

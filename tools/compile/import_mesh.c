/* Meshes: every primitive as a triangle list with float attributes. Only meshes that a node uses are decoded. */
#include "compile/import.h"
#include "compile/import_normals.h"

#include <math.h>
#include <string.h>

enum { POINTS = 0, TRIANGLES = 4, TRIANGLE_STRIP = 5, TRIANGLE_FAN = 6 };

typedef struct MeshReader {
    EnfImport *import;
    uint32_t mesh, part; /* for messages: meshes[mesh].primitives[part] */
    uint32_t *order;     /* the indices as the file gives them; grows */
    size_t order_capacity;
} MeshReader;

static EnfResult refuse(MeshReader *reader, EnfResult code, const char *what) {
    return enf_error_set(reader->import->error, code, UINT64_MAX, "meshes[%u].primitives[%u]: %s", reader->mesh, reader->part,
                         what);
}

static void lose(MeshReader *reader, const char *what) {
    const EnfImport *import = reader->import;
    const char *node = import->source->nodes[import->mesh_nodes[reader->mesh]].name;
    enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, node, "mesh '%s', primitive %u: %s",
                 import->gltf.meshes[reader->mesh].name, reader->part, what);
}

/* ---- triangles -------------------------------------------------------------------------------------------------- */

/* The vertices in drawing order, into reader->order: the index accessor, or 0, 1, 2 … */
static EnfResult read_order(MeshReader *reader, const EnfGltfPrimitive *from, uint32_t *count) {
    EnfImport *import = reader->import;
    const EnfGltfAccessor *accessors = import->gltf.accessors;
    *count = (uint32_t)accessors[from->indices != ENF_NONE ? from->indices : from->position].count;
    if (*count > ENF_IMPORT_MAX_ELEMENTS || accessors[from->position].count > ENF_IMPORT_MAX_ELEMENTS) {
        return refuse(reader, ENF_ERROR_SIZE, "too many vertices or indices");
    }
    if (*count > reader->order_capacity) {
        uint32_t *grown = enf_realloc(NULL, reader->order, reader->order_capacity, *count, sizeof *grown);
        if (!grown) {
            return refuse(reader, ENF_ERROR_MEMORY, "no memory for its indices");
        }
        reader->order = grown;
        reader->order_capacity = *count;
    }
    if (from->indices != ENF_NONE) {
        return enf_import_indices(import, from->indices, reader->order);
    }
    for (uint32_t i = 0; i < *count; i++) {
        reader->order[i] = i;
    }
    return ENF_OK;
}

static uint32_t triangle_count(uint32_t mode, uint32_t count) {
    return mode == TRIANGLES ? count / 3 : count < 3 ? 0 : count - 2;
}

/* Triangle `i` of a list, strip or fan, in the order of glTF 2.0, section 3.7.2.1: all wind the same way. */
static void triangle_at(const uint32_t *order, uint32_t mode, uint32_t i, uint32_t *out) {
    if (mode == TRIANGLES) {
        memcpy(out, order + 3 * (size_t)i, 3 * sizeof *out);
    } else if (mode == TRIANGLE_STRIP) {
        out[0] = order[i];
        out[1] = order[i + 1 + i % 2];
        out[2] = order[i + 2 - i % 2];
    } else {
        out[0] = order[i + 1];
        out[1] = order[i + 2];
        out[2] = order[0];
    }
}

/* The range of vertices that the indices use; exporters share one long vertex buffer between many primitives. */
static EnfResult find_range(MeshReader *reader, uint32_t count, uint64_t vertex_count, EnfImportRange *out) {
    uint32_t low = UINT32_MAX, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t v = reader->order[i];
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    if (count > 0 && high >= vertex_count) {
        return enf_error_set(reader->import->error, ENF_ERROR_INDEX, UINT64_MAX,
                             "meshes[%u].primitives[%u].indices: vertex %u of %llu", reader->mesh, reader->part, high,
                             (unsigned long long)vertex_count);
    }
    bool mostly_used = count == 0 || high - low >= vertex_count / 2;
    *out = mostly_used ? (EnfImportRange){0, (uint32_t)vertex_count} : (EnfImportRange){low, high - low + 1};
    return ENF_OK;
}

static EnfResult read_triangles(MeshReader *reader, const EnfGltfPrimitive *from, EnfSourcePrimitive *to,
                                EnfImportRange *range) {
    EnfImport *import = reader->import;
    uint32_t count;
    EnfResult result = read_order(reader, from, &count);
    if (result == ENF_OK) {
        result = find_range(reader, count, import->gltf.accessors[from->position].count, range);
    }
    if (result != ENF_OK) {
        return result;
    }
    uint32_t triangles = triangle_count(from->mode, count);
    if (from->mode == TRIANGLES ? count % 3 != 0 : count < 3) {
        lose(reader, "its last indices make no triangle");
    }
    uint32_t *indices = enf_import_keep(import, triangles, 3 * sizeof *indices);
    if (!indices) {
        return import->failure;
    }
    for (uint32_t i = 0; i < triangles; i++) {
        triangle_at(reader->order, from->mode, i, indices + 3 * (size_t)i);
    }
    for (size_t i = 0; i < 3 * (size_t)triangles; i++) {
        indices[i] -= range->first;
    }
    to->indices = indices;
    to->index_count = 3 * triangles;
    return ENF_OK;
}

/* ---- attributes ------------------------------------------------------------------------------------------------- */

/* A kept array of `components` floats a vertex, `fill` where the file gives none. */
static EnfResult read_attribute(MeshReader *reader, uint32_t accessor, EnfImportRange range, uint32_t components, float **out) {
    EnfImport *import = reader->import;
    *out = enf_import_keep(import, range.count, components * sizeof **out);
    if (!*out) {
        return import->failure;
    }
    if (import->gltf.accessors[accessor].components < (components == 4 ? 3 : components)) {
        return refuse(reader, ENF_ERROR_FORMAT, "an attribute has too few components");
    }
    for (size_t i = 0; components == 4 && i < range.count; i++) {
        (*out)[4 * i + 3] = 1.0f; /* a colour without alpha */
    }
    return enf_import_floats(import, accessor, range, components, *out);
}

static EnfResult read_positions(MeshReader *reader, uint32_t accessor, EnfImportRange range, EnfSourcePrimitive *to) {
    float *positions;
    EnfResult result = read_attribute(reader, accessor, range, 3, &positions);
    if (result != ENF_OK) {
        return result;
    }
    for (size_t i = 0; i < 3 * (size_t)range.count; i++) {
        if (!isfinite(positions[i])) {
            return enf_error_set(reader->import->error, ENF_ERROR_RANGE, UINT64_MAX,
                                 "accessors[%u]: position %llu is not a finite number", accessor,
                                 (unsigned long long)range.first + i / 3);
        }
    }
    to->positions = positions;
    to->vertex_count = range.count;
    return ENF_OK;
}

/* What is not a number would spread over the picture. */
static void make_finite(float *values, size_t count, float otherwise) {
    for (size_t i = 0; i < count; i++) {
        values[i] = isfinite(values[i]) ? values[i] : otherwise;
    }
}

static EnfResult read_looks(MeshReader *reader, const EnfGltfPrimitive *from, EnfImportRange range, EnfSourcePrimitive *to) {
    uint32_t set = to->material < reader->import->gltf.material_count ? reader->import->uv_sets[to->material] : 0;
    uint32_t uv = set < ENF_GLTF_UV_SETS ? from->uv[set] : ENF_NONE;
    float *values;
    if (uv != ENF_NONE) {
        EnfResult result = read_attribute(reader, uv, range, 2, &values);
        if (result != ENF_OK) {
            return result;
        }
        make_finite(values, 2 * (size_t)range.count, 0.0f);
        to->uvs = values;
    }
    if (from->color != ENF_NONE) {
        EnfResult result = read_attribute(reader, from->color, range, 4, &values);
        if (result != ENF_OK) {
            return result;
        }
        make_finite(values, 4 * (size_t)range.count, 1.0f);
        to->colors = values;
    }
    return ENF_OK;
}

static EnfResult read_normals(MeshReader *reader, const EnfGltfPrimitive *from, EnfImportRange range, EnfSourcePrimitive *to) {
    if (from->normal == ENF_NONE) {
        return enf_import_flat_normals(reader->import, to);
    }
    float *normals;
    EnfResult result = read_attribute(reader, from->normal, range, 3, &normals);
    if (result == ENF_OK) {
        to->normals = normals;
        result = enf_import_mend_normals(reader->import, to, normals);
    }
    return result;
}

/* ---- primitives ------------------------------------------------------------------------------------------------- */

static bool is_drawable(MeshReader *reader, const EnfGltfPrimitive *from) {
    if (from->mode < TRIANGLES || from->mode > TRIANGLE_FAN) {
        lose(reader, from->mode == POINTS     ? "points are not drawn"
                     : from->mode < TRIANGLES ? "lines are not drawn"
                                              : "unknown mode");
        return false;
    }
    if (from->position == ENF_NONE) {
        lose(reader, "it has no positions");
        return false;
    }
    if (from->morphed) {
        lose(reader, "morph targets are not supported; drawn as modelled");
    }
    return true;
}

static EnfResult read_primitive(MeshReader *reader, const EnfGltfPrimitive *from, EnfSourcePrimitive *to) {
    EnfImportRange range = {0, 0}; /* filled by read_indices; said here for compilers that cannot see it */
    to->material = from->material == ENF_NONE ? reader->import->default_material : from->material;
    EnfResult result = read_triangles(reader, from, to, &range);
    if (result == ENF_OK) {
        result = read_positions(reader, from->position, range, to);
    }
    if (result == ENF_OK) {
        result = read_looks(reader, from, range, to);
    }
    return result == ENF_OK ? read_normals(reader, from, range, to) : result;
}

static EnfResult read_mesh(MeshReader *reader, EnfSourceMesh *mesh, EnfSourcePrimitive *primitives) {
    EnfImport *import = reader->import;
    const EnfGltfMesh *from = &import->gltf.meshes[reader->mesh];
    *mesh = (EnfSourceMesh){enf_import_text(import, from->name), import->source->primitive_count, 0};
    if (!mesh->name) {
        return import->failure;
    }
    if (import->mesh_nodes[reader->mesh] == ENF_NONE) {
        return ENF_OK;
    }
    for (uint32_t i = 0; i < from->primitive_count; i++) {
        const EnfGltfPrimitive *primitive = &import->gltf.primitives[from->primitive_first + i];
        reader->part = i;
        if (!is_drawable(reader, primitive)) {
            continue;
        }
        EnfResult result = read_primitive(reader, primitive, &primitives[import->source->primitive_count]);
        if (result != ENF_OK) {
            return result;
        }
        import->source->primitive_count++;
        mesh->primitive_count++;
    }
    return ENF_OK;
}

/* Triangles as the nodes place them, bounded: one mesh of a million triangles may hang on a million nodes. */
static EnfResult count_triangles(EnfImport *import, const EnfSourceMesh *meshes, const EnfSourcePrimitive *primitives) {
    EnfSource *source = import->source;
    uint64_t *per_mesh = enf_import_scratch(import, import->gltf.mesh_count, sizeof *per_mesh);
    if (!per_mesh) {
        return import->failure;
    }
    for (uint32_t m = 0; m < import->gltf.mesh_count; m++) {
        for (uint32_t i = 0; i < meshes[m].primitive_count; i++) {
            per_mesh[m] += primitives[meshes[m].primitive_first + i].index_count / 3;
        }
    }
    for (uint32_t i = 0; i < source->node_count; i++) {
        source->triangle_count += source->nodes[i].mesh == ENF_NONE ? 0 : per_mesh[source->nodes[i].mesh];
        if (source->triangle_count > ENF_IMPORT_MAX_TRIANGLES) {
            return enf_error_set(import->error, ENF_ERROR_SIZE, UINT64_MAX, "the level has more than %llu triangles",
                                 (unsigned long long)ENF_IMPORT_MAX_TRIANGLES);
        }
    }
    return ENF_OK;
}

EnfResult enf_import_meshes(EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    EnfSourceMesh *meshes = enf_import_keep(import, gltf->mesh_count, sizeof *meshes);
    EnfSourcePrimitive *primitives = enf_import_keep(import, gltf->primitive_count, sizeof *primitives);
    if (!meshes || !primitives) {
        return import->failure;
    }
    MeshReader reader = {.import = import};
    EnfResult result = ENF_OK;
    for (reader.mesh = 0; reader.mesh < gltf->mesh_count && result == ENF_OK; reader.mesh++) {
        result = read_mesh(&reader, &meshes[reader.mesh], primitives);
    }
    enf_free(NULL, reader.order, reader.order_capacity, sizeof *reader.order);
    if (result != ENF_OK) {
        return result;
    }
    import->source->meshes = meshes;
    import->source->mesh_count = gltf->mesh_count;
    import->source->primitives = primitives;
    return count_triangles(import, meshes, primitives);
}

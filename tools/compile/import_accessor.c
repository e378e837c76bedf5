/* Numbers out of accessors: every component type, normalised or not, strided, sparse, or all zeros. The ranges are checked here, in
 * 64 bits, against the view as it really is. */
#include "compile/import.h"

#include <inttypes.h>
#include <string.h>

enum { BYTE = 5120, UNSIGNED_BYTE = 5121, SHORT = 5122, UNSIGNED_SHORT = 5123, UNSIGNED_INT = 5125, FLOAT = 5126 };

static uint32_t component_size(uint32_t type) {
    switch (type) {
    case BYTE:
    case UNSIGNED_BYTE:
        return 1;
    case SHORT:
    case UNSIGNED_SHORT:
        return 2;
    case UNSIGNED_INT:
    case FLOAT:
        return 4;
    default:
        return 0;
    }
}

/* Elements in memory. `data` NULL: zeros. */
typedef struct Elements {
    const uint8_t *data;
    size_t stride;
    uint32_t type, components;
    bool normalized;
} Elements;

static float component_value(const uint8_t *p, uint32_t type, bool normalized) {
    union {
        int16_t i16;
        uint16_t u16;
        uint32_t u32;
        float f32;
    } v;
    memcpy(&v, p, component_size(type));
    float value;
    switch (type) {
    case BYTE:
        value = (float)(int8_t)p[0];
        return !normalized ? value : value < -127.0f ? -1.0f : value / 127.0f;
    case UNSIGNED_BYTE:
        value = (float)p[0];
        return normalized ? value / 255.0f : value;
    case SHORT:
        value = (float)v.i16;
        return !normalized ? value : value < -32767.0f ? -1.0f : value / 32767.0f;
    case UNSIGNED_SHORT:
        value = (float)v.u16;
        return normalized ? value / 65535.0f : value;
    case UNSIGNED_INT:
        return (float)v.u32;
    default:
        return v.f32;
    }
}

static void read_element(const Elements *from, uint64_t index, uint32_t components, float *out) {
    uint32_t shared = from->components < components ? from->components : components;
    if (!from->data) {
        memset(out, 0, shared * sizeof *out);
        return;
    }
    const uint8_t *p = from->data + index * from->stride;
    if (from->type == FLOAT) {
        memcpy(out, p, shared * sizeof *out);
        return;
    }
    uint32_t size = component_size(from->type);
    for (uint32_t c = 0; c < shared; c++) {
        out[c] = component_value(p + c * size, from->type, from->normalized);
    }
}

/* ---- ranges ----------------------------------------------------------------------------------------------------- */

static EnfResult refuse(EnfImport *import, EnfResult code, uint32_t accessor, const char *what) {
    return enf_error_set(import->error, code, UINT64_MAX, "accessors[%u]: %s", accessor, what);
}

/* `count` elements of `size` bytes at `offset` in a view, `stride` apart. All products stay below 2^63: each factor is at most
 * 2^31 (gltf_check.c). */
static EnfResult locate(EnfImport *import, uint32_t accessor, EnfImportBytes view, uint64_t offset, uint64_t extent) {
    if (offset > view.size || extent > view.size - offset) {
        return enf_error_set(import->error, ENF_ERROR_RANGE, UINT64_MAX,
                             "accessors[%u]: needs bytes %" PRIu64 " to %" PRIu64 " of a buffer view of %zu", accessor, offset,
                             offset + extent, view.size);
    }
    return ENF_OK;
}

static EnfResult locate_elements(EnfImport *import, uint32_t index, Elements *out) {
    const EnfGltfAccessor *a = &import->gltf.accessors[index];
    uint32_t size = component_size(a->component_type) * a->components;
    if (component_size(a->component_type) == 0) {
        return refuse(import, ENF_ERROR_FORMAT, index, "unknown componentType");
    }
    *out = (Elements){NULL, size, a->component_type, a->components, a->normalized};
    if (a->view == ENF_NONE || a->count == 0) {
        return ENF_OK;
    }
    EnfImportBytes view;
    EnfResult result = enf_import_view(import, a->view, &view);
    if (result != ENF_OK) {
        return result;
    }
    const EnfGltfView *v = &import->gltf.views[a->view];
    uint32_t stride = v->meshopt.count ? v->meshopt.stride : v->stride;
    /* A packed view of indices has the index size as its stride, which is tight as well. */
    out->stride = stride ? stride : size;
    result = locate(import, index, view, a->offset, (a->count - 1) * out->stride + size);
    if (result == ENF_OK) {
        out->data = view.data + a->offset;
    }
    return result;
}

/* The substitutes of a sparse accessor, and where they go. */
typedef struct Sparse {
    Elements values;
    const uint8_t *places;
    uint32_t place_type;
    uint64_t count;
} Sparse;

static EnfResult locate_sparse(EnfImport *import, uint32_t index, Sparse *out) {
    const EnfGltfAccessor *a = &import->gltf.accessors[index];
    const EnfGltfSparse *s = &a->sparse;
    *out = (Sparse){{NULL, 0, a->component_type, a->components, a->normalized}, NULL, s->index_type, s->count};
    if (s->count == 0) {
        return ENF_OK;
    }
    bool unsigned_type = s->index_type == UNSIGNED_BYTE || s->index_type == UNSIGNED_SHORT || s->index_type == UNSIGNED_INT;
    if (!unsigned_type || s->count > a->count) {
        return refuse(import, ENF_ERROR_FORMAT, index, "sparse: too many elements, or indices of a wrong componentType");
    }
    EnfImportBytes places, values;
    EnfResult result = enf_import_view(import, s->index_view, &places);
    if (result == ENF_OK) {
        result = enf_import_view(import, s->value_view, &values);
    }
    if (result == ENF_OK) {
        result = locate(import, index, places, s->index_offset, s->count * component_size(s->index_type));
    }
    out->values.stride = component_size(a->component_type) * a->components;
    if (result == ENF_OK) {
        result = locate(import, index, values, s->value_offset, s->count * out->values.stride);
    }
    if (result == ENF_OK) {
        out->places = places.data + s->index_offset;
        out->values.data = values.data + s->value_offset;
    }
    return result;
}

static uint32_t read_index(const uint8_t *p, uint32_t type) {
    if (type == UNSIGNED_BYTE) {
        return p[0];
    }
    return type == UNSIGNED_SHORT ? (uint32_t)(p[0] | p[1] << 8)
                                  : (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static EnfResult sparse_place(EnfImport *import, uint32_t accessor, const Sparse *sparse, uint64_t i, uint32_t *out) {
    *out = read_index(sparse->places + i * component_size(sparse->place_type), sparse->place_type);
    return *out < import->gltf.accessors[accessor].count
               ? ENF_OK
               : refuse(import, ENF_ERROR_INDEX, accessor, "a sparse index lies behind the end");
}

/* ---- offered ---------------------------------------------------------------------------------------------------- */

EnfResult enf_import_floats(EnfImport *import, uint32_t accessor, EnfImportRange range, uint32_t components, float *out) {
    Elements elements;
    Sparse sparse;
    EnfResult result = locate_elements(import, accessor, &elements);
    if (result == ENF_OK) {
        result = locate_sparse(import, accessor, &sparse);
    }
    if (result == ENF_OK && (uint64_t)range.first + range.count > import->gltf.accessors[accessor].count) {
        result = refuse(import, ENF_ERROR_RANGE, accessor, "has fewer elements than are asked of it");
    }
    if (result != ENF_OK) {
        return result;
    }
    for (uint32_t i = 0; i < range.count; i++) {
        read_element(&elements, (uint64_t)range.first + i, components, out + (size_t)i * components);
    }
    for (uint64_t i = 0; i < sparse.count; i++) {
        uint32_t place;
        result = sparse_place(import, accessor, &sparse, i, &place);
        if (result != ENF_OK) {
            return result;
        }
        if (place >= range.first && place - range.first < range.count) {
            read_element(&sparse.values, i, components, out + (size_t)(place - range.first) * components);
        }
    }
    return ENF_OK;
}

EnfResult enf_import_indices(EnfImport *import, uint32_t accessor, uint32_t *out) {
    const EnfGltfAccessor *a = &import->gltf.accessors[accessor];
    uint32_t type = a->component_type;
    if (a->components != 1 || (type != UNSIGNED_BYTE && type != UNSIGNED_SHORT && type != UNSIGNED_INT)) {
        return refuse(import, ENF_ERROR_FORMAT, accessor, "indices must be unsigned scalars");
    }
    Elements elements;
    Sparse sparse;
    EnfResult result = locate_elements(import, accessor, &elements);
    if (result == ENF_OK) {
        result = locate_sparse(import, accessor, &sparse);
    }
    if (result != ENF_OK) {
        return result;
    }
    for (uint64_t i = 0; i < a->count; i++) {
        out[i] = elements.data ? read_index(elements.data + i * elements.stride, type) : 0;
    }
    for (uint64_t i = 0; i < sparse.count; i++) {
        uint32_t place;
        result = sparse_place(import, accessor, &sparse, i, &place);
        if (result != ENF_OK) {
            return result;
        }
        out[place] = read_index(sparse.values.data + i * sparse.values.stride, type);
    }
    return ENF_OK;
}

/* Bytes: the container of a level (GLB or plain JSON), its buffers, its buffer views, and EXT_meshopt_compression. Buffers and
 * views are read when first asked for, so that a defect in what nobody needs is no defect. */
#include "compile/import.h"

#include <meshoptimizer.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- container -------------------------------------------------------------------------------------------------- */

enum { GLB_HEADER = 12, GLB_CHUNK_HEADER = 8 };
#define GLB_JSON UINT32_C(0x4E4F534A)
#define GLB_BIN UINT32_C(0x004E4942)

static EnfResult refuse_glb(EnfImport *import, EnfResult code, size_t offset, const char *what) {
    return enf_error_set(import->error, code, offset, "GLB: %s", what);
}

/* One chunk at the cursor: JSON comes first, the first BIN is kept, others are skipped (glTF 2.0, section 4.4). */
static EnfResult read_chunk(EnfImport *import, EnfCursor *cursor) {
    size_t start = cursor->offset;
    uint32_t length = enf_cursor_u32(cursor);
    uint32_t type = enf_cursor_u32(cursor);
    const uint8_t *data = length ? enf_cursor_bytes(cursor, length) : cursor->data + cursor->offset;
    if (cursor->failed) {
        return refuse_glb(import, ENF_ERROR_TRUNCATED, start, "a chunk ends behind the file");
    }
    if (!import->text.data) {
        if (type != GLB_JSON) {
            return refuse_glb(import, ENF_ERROR_FORMAT, start, "the first chunk is not JSON");
        }
        import->text = (EnfImportBytes){data, length};
    } else if (type == GLB_BIN && !import->binary.data) {
        import->binary = (EnfImportBytes){data, length};
    }
    return ENF_OK;
}

static EnfResult open_glb(EnfImport *import) {
    EnfCursor cursor = enf_cursor(import->file.data, import->file.size);
    enf_cursor_u32(&cursor); /* the magic */
    uint32_t version = enf_cursor_u32(&cursor);
    uint32_t length = enf_cursor_u32(&cursor);
    if (cursor.failed) {
        return refuse_glb(import, ENF_ERROR_TRUNCATED, 0, "the header ends behind the file");
    }
    if (version != 2) {
        return refuse_glb(import, ENF_ERROR_VERSION, 4, "version 2 is read");
    }
    if (length > import->file.size) {
        return refuse_glb(import, ENF_ERROR_TRUNCATED, 8, "the file is shorter than its header says");
    }
    if (length < GLB_HEADER + GLB_CHUNK_HEADER) {
        return refuse_glb(import, ENF_ERROR_FORMAT, 8, "there is no chunk");
    }
    cursor.size = length;
    while (cursor.offset < length) {
        EnfResult result = read_chunk(import, &cursor);
        if (result != ENF_OK) {
            return result;
        }
    }
    return ENF_OK;
}

EnfResult enf_import_open(EnfImport *import) {
    EnfResult result = enf_file_read(&import->file, import->path, ENF_IMPORT_MAX_FILE, NULL, import->error);
    if (result != ENF_OK) {
        return result;
    }
    const EnfFile *file = &import->file;
    if (file->size >= 4 && memcmp(file->data, "glTF", 4) == 0) {
        return open_glb(import);
    }
    if (file->size == 0) {
        return enf_error_set(import->error, ENF_ERROR_TRUNCATED, 0, "the file is empty");
    }
    size_t mark = file->size >= 3 && memcmp(file->data, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0; /* some editors leave one */
    import->text = (EnfImportBytes){file->data + mark, file->size - mark};
    return ENF_OK;
}

/* ---- buffers ---------------------------------------------------------------------------------------------------- */

static EnfResult load_buffer(EnfImport *import, uint32_t index, EnfImportBytes *out) {
    const EnfJson *json = &import->json;
    uint32_t object = import->buffer_values[index];
    uint32_t uri = enf_json_member(json, object, "uri");
    uint64_t length = 0;
    enf_json_uint(json, enf_json_member(json, object, "byteLength"), INT32_MAX, &length);
    EnfResult result = ENF_OK;
    *out = import->binary;
    if (uri != ENF_NONE) {
        char where[32];
        snprintf(where, sizeof where, "buffers[%u].uri", index);
        result = enf_import_uri(import, uri, where, out);
    } else if (index != 0 || !import->binary.data) {
        result = enf_error_set(import->error, ENF_ERROR_FORMAT, json->base + json->values[object].start,
                               "buffers[%u]: has no uri, and the file has no BIN chunk for it", index);
    }
    if (result == ENF_OK && out->size < length) {
        result = enf_error_set(import->error, ENF_ERROR_TRUNCATED, json->base + json->values[object].start,
                               "buffers[%u].byteLength: is %llu, but there are %zu bytes", index, (unsigned long long)length,
                               out->size);
    }
    out->size = (size_t)length;
    return result;
}

static EnfResult find_buffer(EnfImport *import, uint32_t index, EnfImportBytes *out) {
    EnfImportLazy *buffer = &import->buffers[index];
    if (!buffer->ready) {
        EnfResult result = load_buffer(import, index, &buffer->bytes);
        if (result != ENF_OK) {
            return result;
        }
        buffer->ready = true;
    }
    *out = buffer->bytes;
    return ENF_OK;
}

/* ---- views ------------------------------------------------------------------------------------------------------ */

static EnfResult cut(EnfImport *import, uint32_t view, uint32_t buffer, uint64_t offset, uint64_t length, EnfImportBytes *out) {
    EnfImportBytes whole;
    EnfResult result = find_buffer(import, buffer, &whole);
    if (result != ENF_OK) {
        return result;
    }
    if (offset > whole.size || length > whole.size - offset) {
        return enf_error_set(import->error, ENF_ERROR_RANGE, UINT64_MAX,
                             "bufferViews[%u]: bytes %" PRIu64 " to %" PRIu64 " of a buffer of %zu", view, offset,
                             offset + length, whole.size);
    }
    *out = (EnfImportBytes){whole.data + offset, (size_t)length};
    return ENF_OK;
}

static EnfResult refuse_packed(EnfImport *import, uint32_t view, const char *what) {
    return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "bufferViews[%u].extensions.EXT_meshopt_compression: %s",
                         view, what);
}

/* What the decoders take for granted (they assert on it), after the extension's text. */
static bool packed_is_sane(const EnfGltfMeshopt *packed, bool attributes, bool triangles) {
    uint32_t stride = packed->stride;
    if (packed->count > ENF_IMPORT_MAX_MEMORY) {
        return false;
    }
    if (attributes) {
        return stride >= 4 && stride <= 256 && stride % 4 == 0;
    }
    return (stride == 2 || stride == 4) && (!triangles || packed->count % 3 == 0);
}

static bool apply_filter(const EnfGltfMeshopt *packed, void *data) {
    size_t count = (size_t)packed->count;
    if (strcmp(packed->filter, "OCTAHEDRAL") == 0 && (packed->stride == 4 || packed->stride == 8)) {
        meshopt_decodeFilterOct(data, count, packed->stride);
    } else if (strcmp(packed->filter, "QUATERNION") == 0 && packed->stride == 8) {
        meshopt_decodeFilterQuat(data, count, packed->stride);
    } else if (strcmp(packed->filter, "EXPONENTIAL") == 0) {
        meshopt_decodeFilterExp(data, count, packed->stride);
    } else {
        return strcmp(packed->filter, "NONE") == 0;
    }
    return true;
}

static EnfResult unpack(EnfImport *import, uint32_t index, EnfImportBytes *out) {
    const EnfGltfMeshopt *packed = &import->gltf.views[index].meshopt;
    bool attributes = strcmp(packed->mode, "ATTRIBUTES") == 0;
    bool triangles = strcmp(packed->mode, "TRIANGLES") == 0;
    if (!attributes && !triangles && strcmp(packed->mode, "INDICES") != 0) {
        return refuse_packed(import, index, "unknown mode");
    }
    if (!packed_is_sane(packed, attributes, triangles)) {
        return refuse_packed(import, index, "count or byteStride does not fit the mode");
    }
    EnfImportBytes bytes;
    EnfResult result = cut(import, index, packed->buffer, packed->offset, packed->length, &bytes);
    if (result != ENF_OK) {
        return result;
    }
    size_t count = (size_t)packed->count, stride = packed->stride;
    uint8_t *data = enf_import_scratch(import, count, stride);
    if (!data) {
        return import->failure;
    }
    int status = attributes  ? meshopt_decodeVertexBuffer(data, count, stride, bytes.data, bytes.size)
                 : triangles ? meshopt_decodeIndexBuffer(data, count, stride, bytes.data, bytes.size)
                             : meshopt_decodeIndexSequence(data, count, stride, bytes.data, bytes.size);
    if (status != 0) {
        return refuse_packed(import, index, "malformed data");
    }
    if (attributes && !apply_filter(packed, data)) {
        return refuse_packed(import, index, "unknown filter, or one that does not fit byteStride");
    }
    *out = (EnfImportBytes){data, count * stride};
    return ENF_OK;
}

EnfResult enf_import_view(EnfImport *import, uint32_t view, EnfImportBytes *out) {
    EnfImportLazy *lazy = &import->views[view];
    if (!lazy->ready) {
        const EnfGltfView *v = &import->gltf.views[view];
        EnfResult result = v->meshopt.count ? unpack(import, view, &lazy->bytes)
                                            : cut(import, view, v->buffer, v->offset, v->length, &lazy->bytes);
        if (result != ENF_OK) {
            return result;
        }
        lazy->ready = true;
    }
    *out = lazy->bytes;
    return ENF_OK;
}

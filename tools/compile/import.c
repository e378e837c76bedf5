/* EnfSource from a glTF file: the order of the stages, the memory, and the end. The stages are in import_*.c.
 *
 * A hostile file meets, in this order: the container (import_buffer.c), the JSON grammar (json.c), the schema with every index
 * (gltf_check.c), tinygltf (gltf_wrap.cpp), and range checks at each accessor (import_accessor.c). */
#include "compile/import.h"

#include "compile/gltf_check.h"

#include <string.h>

/* ---- memory ----------------------------------------------------------------------------------------------------- */

enum { BLOCK_HEADER = 32 }; /* keeps the data aligned to 16 */

static void *take(EnfImport *import, EnfImportPool *pool, size_t count, size_t size) {
    size_t bytes;
    bool fits = enf_size_mul(count, size, &bytes) && enf_size_add(bytes, BLOCK_HEADER, &bytes);
    if (!fits || bytes > ENF_IMPORT_MAX_MEMORY - import->bytes) {
        import->failure = enf_error_set(import->error, ENF_ERROR_SIZE, UINT64_MAX, "the level decodes to more than %llu MiB",
                                        (unsigned long long)(ENF_IMPORT_MAX_MEMORY >> 20));
        return NULL;
    }
    uint8_t *block = enf_alloc(NULL, bytes, 1);
    if (!block) {
        import->failure = enf_error_set(import->error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for %zu bytes", bytes);
        return NULL;
    }
    EnfImportBlock header = {pool->blocks, bytes};
    memcpy(block, &header, sizeof header);
    pool->blocks = (EnfImportBlock *)(void *)block;
    import->bytes += bytes;
    return block + BLOCK_HEADER;
}

void *enf_import_keep(EnfImport *import, size_t count, size_t size) {
    return take(import, import->kept, count, size);
}

void *enf_import_scratch(EnfImport *import, size_t count, size_t size) {
    return take(import, &import->scratch, count, size);
}

void enf_import_pool_free(EnfImportPool *pool) {
    while (pool->blocks) {
        EnfImportBlock *next = pool->blocks->next;
        enf_free(NULL, pool->blocks, pool->blocks->size, 1);
        pool->blocks = next;
    }
}

const char *enf_import_text(EnfImport *import, const char *text) {
    size_t length = strlen(text) + 1;
    char *copy = enf_import_keep(import, length, 1);
    if (copy) {
        memcpy(copy, text, length);
    }
    return copy;
}

uint32_t *enf_import_json_array(EnfImport *import, const char *key, uint32_t *count) {
    const EnfJson *json = &import->json;
    uint32_t array = enf_json_member(json, 0, key);
    *count = array == ENF_NONE ? 0 : json->values[array].count;
    uint32_t *values = enf_import_scratch(import, *count, sizeof *values);
    uint32_t value = array + 1;
    for (uint32_t i = 0; values && i < *count; i++) {
        values[i] = value;
        value = json->values[value].next;
    }
    return values;
}

/* ---- the document ----------------------------------------------------------------------------------------------- */

static EnfResult read_document(EnfImport *import) {
    const char *text = (const char *)import->text.data;
    uint64_t base = (uint64_t)(import->text.data - import->file.data);
    EnfResult result = enf_json_parse(&import->json, text, import->text.size, base, import->error);
    if (result == ENF_OK) {
        result = enf_gltf_check(&import->json, import->diagnosis, import->error);
    }
    char *fenced = NULL;
    size_t size = 0;
    uint32_t view_count = 0;
    if (result == ENF_OK) {
        result = enf_gltf_fence(&import->json, &fenced, &size, &view_count, import->error);
    }
    if (result == ENF_OK) {
        result = enf_gltf_parse(&import->gltf, fenced, size, view_count, import->error);
    }
    enf_free(NULL, fenced, size, 1);
    return result;
}

/* tinygltf drops what it cannot read without saying so; the check has left nothing that it should drop. */
static EnfResult compare_counts(EnfImport *import) {
    const struct {
        const char *key;
        uint32_t count;
    } expected[] = {
        {"accessors", import->gltf.accessor_count}, {"bufferViews", import->gltf.view_count},
        {"meshes", import->gltf.mesh_count},        {"nodes", import->gltf.node_count},
        {"materials", import->gltf.material_count}, {"textures", import->gltf.texture_count},
        {"cameras", import->gltf.camera_count},     {"scenes", import->gltf.scene_count},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        uint32_t array = enf_json_member(&import->json, 0, expected[i].key);
        uint32_t count = array == ENF_NONE ? 0 : import->json.values[array].count;
        if (count != expected[i].count) {
            return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: %u given, %u readable", expected[i].key,
                                 count, expected[i].count);
        }
    }
    return ENF_OK;
}

/* Is there an object with this member, anywhere? */
static bool mentions(const EnfJson *json, const char *key) {
    for (uint32_t v = 0; v < json->count; v++) {
        if (json->values[v].type == ENF_JSON_OBJECT && enf_json_member(json, v, key) != ENF_NONE) {
            return true;
        }
    }
    return false;
}

static EnfResult prepare(EnfImport *import) {
    import->buffer_values = enf_import_json_array(import, "buffers", &import->buffer_count);
    import->image_values = enf_import_json_array(import, "images", &import->image_count);
    import->node_values = enf_import_json_array(import, "nodes", &import->node_count);
    if (!import->buffer_values || !import->image_values || !import->node_values) {
        return import->failure;
    }
    import->buffers = enf_import_scratch(import, import->buffer_count, sizeof *import->buffers);
    import->views = enf_import_scratch(import, import->gltf.view_count, sizeof *import->views);
    import->mesh_nodes = enf_import_scratch(import, import->gltf.mesh_count, sizeof *import->mesh_nodes);
    if (!import->buffers || !import->views || !import->mesh_nodes) {
        return import->failure;
    }
    memset(import->mesh_nodes, 0xFF, import->gltf.mesh_count * sizeof *import->mesh_nodes);
    import->default_material = ENF_NONE;
    EnfSource *source = import->source;
    source->has_extras = mentions(&import->json, "extras");
    source->has_lights = import->gltf.light_count > 0;
    source->generator = enf_import_text(import, import->gltf.generator);
    source->hash = enf_hash64(ENF_HASH_START, import->file.data, import->file.size);
    return source->generator ? ENF_OK : import->failure;
}

static EnfResult run_stages(EnfImport *import) {
    static EnfResult (*const stages[])(EnfImport *) = {
        enf_import_open,      read_document,     compare_counts,    prepare,          enf_import_nodes,
        enf_import_materials, enf_import_meshes, enf_import_lights, enf_import_paths,
    };
    EnfResult result = ENF_OK;
    for (size_t i = 0; i < sizeof stages / sizeof *stages && result == ENF_OK; i++) {
        result = stages[i](import);
    }
    return result;
}

/* ---- offered ---------------------------------------------------------------------------------------------------- */

EnfResult enf_source_import(EnfSource *source, const char *path, EnfDiagnosis *diagnosis, EnfError *error) {
    *source = (EnfSource){0};
    EnfImportPool *kept = enf_alloc(NULL, 1, sizeof *kept);
    if (!kept) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory");
    }
    source->owner = kept;
    EnfImport import = {.path = path, .diagnosis = diagnosis, .error = error, .source = source, .kept = kept};
    EnfResult result = run_stages(&import);
    enf_gltf_free(&import.gltf);
    enf_json_free(&import.json);
    enf_file_free(&import.file);
    enf_import_pool_free(&import.scratch);
    if (result != ENF_OK) {
        enf_source_free(source);
        return enf_error_file(error, result, path);
    }
    return ENF_OK;
}

void enf_source_free(EnfSource *source) {
    if (source->owner) {
        enf_import_pool_free(source->owner);
        enf_free(NULL, source->owner, 1, sizeof(EnfImportPool));
    }
    *source = (EnfSource){0};
}

/* The schema of glTF 2.0 as far as the importer reads it, as tables, and the walk that holds a document against them.
 * After the specification (Khronos, glTF 2.0, chapter 5) and the extensions named in the tables. */
#include "compile/gltf_check.h"

#include <stdio.h>
#include <string.h>

/* ---- tables ----------------------------------------------------------------------------------------------------- */

/* Arrays that indices point into: the index of a table entry in `collections`. */
typedef enum Collection {
    BUFFERS,
    VIEWS,
    ACCESSORS,
    MESHES,
    NODES,
    SCENES,
    MATERIALS,
    TEXTURES,
    IMAGES,
    SAMPLERS,
    CAMERAS,
    LIGHTS,
    COLLECTION_COUNT
} Collection;

static const char *const collection_names[COLLECTION_COUNT] = {
    "buffers",   "bufferViews", "accessors", "meshes",   "nodes",   "scenes",
    "materials", "textures",    "images",    "samplers", "cameras", "lights",
};

typedef enum Kind {
    OBJECT,  /* of `table` */
    OBJECTS, /* an array of them */
    STRING,
    STRINGS,
    BOOLEAN,
    NUMBER,
    NUMBERS, /* an array of `argument` numbers */
    COUNT,   /* an integer >= 0 */
    INDEX,   /* into collection `argument` */
    INDICES, /* an array of them */
    MAPPED   /* an object whose members are indices */
} Kind;

typedef struct Rule {
    const char *key; /* NULL ends the table */
    Kind kind;
    bool required;
    int argument;
    const struct Rule *table;
} Rule;

static const Rule meshopt_table[] = {
    {"buffer", INDEX, true, BUFFERS, NULL}, {"byteOffset", COUNT, false, 0, NULL},
    {"byteLength", COUNT, true, 0, NULL},   {"byteStride", COUNT, true, 0, NULL},
    {"count", COUNT, true, 0, NULL},        {"mode", STRING, true, 0, NULL},
    {"filter", STRING, false, 0, NULL},     {0},
};
static const Rule view_extension_table[] = {{"EXT_meshopt_compression", OBJECT, false, 0, meshopt_table}, {0}};
static const Rule view_table[] = {
    {"buffer", INDEX, true, BUFFERS, NULL},
    {"byteOffset", COUNT, false, 0, NULL},
    {"byteLength", COUNT, true, 0, NULL},
    {"byteStride", COUNT, false, 0, NULL},
    {"extensions", OBJECT, false, 0, view_extension_table},
    {0},
};
static const Rule buffer_table[] = {{"byteLength", COUNT, true, 0, NULL}, {"uri", STRING, false, 0, NULL}, {0}};

static const Rule sparse_indices_table[] = {
    {"bufferView", INDEX, true, VIEWS, NULL},
    {"byteOffset", COUNT, false, 0, NULL},
    {"componentType", COUNT, true, 0, NULL},
    {0},
};
static const Rule sparse_values_table[] = {
    {"bufferView", INDEX, true, VIEWS, NULL}, {"byteOffset", COUNT, false, 0, NULL}, {0}};
static const Rule sparse_table[] = {
    {"count", COUNT, true, 0, NULL},
    {"indices", OBJECT, true, 0, sparse_indices_table},
    {"values", OBJECT, true, 0, sparse_values_table},
    {0},
};
static const Rule accessor_table[] = {
    {"bufferView", INDEX, false, VIEWS, NULL},
    {"byteOffset", COUNT, false, 0, NULL},
    {"componentType", COUNT, true, 0, NULL},
    {"normalized", BOOLEAN, false, 0, NULL},
    {"count", COUNT, true, 0, NULL},
    {"type", STRING, true, 0, NULL},
    {"sparse", OBJECT, false, 0, sparse_table},
    {0},
};

static const Rule primitive_table[] = {
    {"attributes", MAPPED, true, ACCESSORS, NULL},
    {"indices", INDEX, false, ACCESSORS, NULL},
    {"material", INDEX, false, MATERIALS, NULL},
    {"mode", COUNT, false, 0, NULL},
    {0},
};
static const Rule mesh_table[] = {{"name", STRING, false, 0, NULL}, {"primitives", OBJECTS, true, 0, primitive_table}, {0}};

static const Rule light_reference_table[] = {{"light", INDEX, true, LIGHTS, NULL}, {0}};
static const Rule instancing_table[] = {{"attributes", MAPPED, true, ACCESSORS, NULL}, {0}};
static const Rule node_extension_table[] = {
    {"KHR_lights_punctual", OBJECT, false, 0, light_reference_table},
    {"EXT_mesh_gpu_instancing", OBJECT, false, 0, instancing_table},
    {0},
};
static const Rule node_table[] = {
    {"name", STRING, false, 0, NULL},
    {"children", INDICES, false, NODES, NULL},
    {"mesh", INDEX, false, MESHES, NULL},
    {"camera", INDEX, false, CAMERAS, NULL},
    {"matrix", NUMBERS, false, 16, NULL},
    {"translation", NUMBERS, false, 3, NULL},
    {"rotation", NUMBERS, false, 4, NULL},
    {"scale", NUMBERS, false, 3, NULL},
    {"extensions", OBJECT, false, 0, node_extension_table},
    {0},
};
static const Rule scene_table[] = {{"nodes", INDICES, false, NODES, NULL}, {0}};

static const Rule transform_table[] = {
    {"offset", NUMBERS, false, 2, NULL},
    {"rotation", NUMBER, false, 0, NULL},
    {"scale", NUMBERS, false, 2, NULL},
    {"texCoord", COUNT, false, 0, NULL},
    {0},
};
static const Rule texture_info_extension_table[] = {{"KHR_texture_transform", OBJECT, false, 0, transform_table}, {0}};
static const Rule texture_info_table[] = {
    {"index", INDEX, true, TEXTURES, NULL},
    {"texCoord", COUNT, false, 0, NULL},
    {"extensions", OBJECT, false, 0, texture_info_extension_table},
    {0},
};
static const Rule roughness_table[] = {
    {"baseColorFactor", NUMBERS, false, 4, NULL},
    {"baseColorTexture", OBJECT, false, 0, texture_info_table},
    {"metallicFactor", NUMBER, false, 0, NULL},
    {"roughnessFactor", NUMBER, false, 0, NULL},
    {0},
};
static const Rule strength_table[] = {{"emissiveStrength", NUMBER, false, 0, NULL}, {0}};
static const Rule material_extension_table[] = {{"KHR_materials_emissive_strength", OBJECT, false, 0, strength_table}, {0}};
static const Rule material_table[] = {
    {"name", STRING, false, 0, NULL},
    {"pbrMetallicRoughness", OBJECT, false, 0, roughness_table},
    {"emissiveFactor", NUMBERS, false, 3, NULL},
    {"emissiveTexture", OBJECT, false, 0, texture_info_table},
    {"alphaMode", STRING, false, 0, NULL},
    {"alphaCutoff", NUMBER, false, 0, NULL},
    {"doubleSided", BOOLEAN, false, 0, NULL},
    {"extensions", OBJECT, false, 0, material_extension_table},
    {0},
};
static const Rule texture_table[] = {{"source", INDEX, false, IMAGES, NULL}, {"sampler", INDEX, false, SAMPLERS, NULL}, {0}};
static const Rule sampler_table[] = {
    {"magFilter", COUNT, false, 0, NULL},
    {"minFilter", COUNT, false, 0, NULL},
    {"wrapS", COUNT, false, 0, NULL},
    {"wrapT", COUNT, false, 0, NULL},
    {0},
};
static const Rule image_table[] = {
    {"uri", STRING, false, 0, NULL},
    {"bufferView", INDEX, false, VIEWS, NULL},
    {"name", STRING, false, 0, NULL},
    {0},
};

static const Rule perspective_table[] = {
    {"yfov", NUMBER, true, 0, NULL},
    {"znear", NUMBER, true, 0, NULL},
    {"aspectRatio", NUMBER, false, 0, NULL},
    {"zfar", NUMBER, false, 0, NULL},
    {0},
};
static const Rule orthographic_table[] = {
    {"xmag", NUMBER, true, 0, NULL},
    {"ymag", NUMBER, true, 0, NULL},
    {"znear", NUMBER, true, 0, NULL},
    {"zfar", NUMBER, true, 0, NULL},
    {0},
};
static const Rule camera_table[] = {
    {"type", STRING, true, 0, NULL},
    {"perspective", OBJECT, false, 0, perspective_table},
    {"orthographic", OBJECT, false, 0, orthographic_table},
    {0},
};

static const Rule target_table[] = {{"node", INDEX, false, NODES, NULL}, {"path", STRING, true, 0, NULL}, {0}};
static const Rule channel_table[] = {{"sampler", COUNT, true, 0, NULL}, {"target", OBJECT, true, 0, target_table}, {0}};
static const Rule animation_sampler_table[] = {
    {"input", INDEX, true, ACCESSORS, NULL},
    {"output", INDEX, true, ACCESSORS, NULL},
    {"interpolation", STRING, false, 0, NULL},
    {0},
};
static const Rule animation_table[] = {
    {"name", STRING, false, 0, NULL},
    {"channels", OBJECTS, true, 0, channel_table},
    {"samplers", OBJECTS, true, 0, animation_sampler_table},
    {0},
};

static const Rule spot_table[] = {{"innerConeAngle", NUMBER, false, 0, NULL}, {"outerConeAngle", NUMBER, false, 0, NULL}, {0}};
static const Rule light_table[] = {
    {"name", STRING, false, 0, NULL},
    {"type", STRING, true, 0, NULL},
    {"color", NUMBERS, false, 3, NULL},
    {"intensity", NUMBER, false, 0, NULL},
    {"range", NUMBER, false, 0, NULL},
    {"spot", OBJECT, false, 0, spot_table},
    {0},
};
static const Rule lights_table[] = {{"lights", OBJECTS, false, 0, light_table}, {0}};
static const Rule root_extension_table[] = {{"KHR_lights_punctual", OBJECT, false, 0, lights_table}, {0}};
static const Rule asset_table[] = {
    {"version", STRING, true, 0, NULL},
    {"minVersion", STRING, false, 0, NULL},
    {"generator", STRING, false, 0, NULL},
    {0},
};
static const Rule root_table[] = {
    {"asset", OBJECT, true, 0, asset_table},
    {"extensionsUsed", STRINGS, false, 0, NULL},
    {"extensionsRequired", STRINGS, false, 0, NULL},
    {"buffers", OBJECTS, false, 0, buffer_table},
    {"bufferViews", OBJECTS, false, 0, view_table},
    {"accessors", OBJECTS, false, 0, accessor_table},
    {"meshes", OBJECTS, false, 0, mesh_table},
    {"nodes", OBJECTS, false, 0, node_table},
    {"scenes", OBJECTS, false, 0, scene_table},
    {"scene", INDEX, false, SCENES, NULL},
    {"materials", OBJECTS, false, 0, material_table},
    {"textures", OBJECTS, false, 0, texture_table},
    {"images", OBJECTS, false, 0, image_table},
    {"samplers", OBJECTS, false, 0, sampler_table},
    {"cameras", OBJECTS, false, 0, camera_table},
    {"animations", OBJECTS, false, 0, animation_table},
    {"extensions", OBJECT, false, 0, root_extension_table},
    {0},
};

/* What the importer understands (DESIGN section 6); a level may require these and no others. */
static const char *const supported_extensions[] = {
    "KHR_lights_punctual",   "KHR_texture_transform",   "KHR_materials_unlit",     "KHR_materials_emissive_strength",
    "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "OMI_spawn_point",
};

/* ---- the walk --------------------------------------------------------------------------------------------------- */

typedef struct Checker {
    const EnfJson *json;
    EnfError *error;
    uint32_t counts[COLLECTION_COUNT];
    char path[256]; /* of the value under the eye */
    size_t length;
} Checker;

static EnfResult refuse(const Checker *checker, EnfResult code, uint32_t value, const char *what) {
    uint64_t offset = checker->json->base + checker->json->values[value].start;
    return enf_error_set(checker->error, code, offset, "%s: %s", checker->length ? checker->path : "document", what);
}

/* Appends ".key" or "[index]" to the path; returns the old length for `leave`. */
static size_t enter_key(Checker *checker, const char *key) {
    size_t old = checker->length;
    int added = snprintf(checker->path + old, sizeof checker->path - old, old ? ".%s" : "%s", key);
    checker->length = old + (size_t)added < sizeof checker->path ? old + (size_t)added : sizeof checker->path - 1;
    return old;
}

static size_t enter_index(Checker *checker, uint32_t index) {
    size_t old = checker->length;
    int added = snprintf(checker->path + old, sizeof checker->path - old, "[%u]", index);
    checker->length = old + (size_t)added < sizeof checker->path ? old + (size_t)added : sizeof checker->path - 1;
    return old;
}

static void leave(Checker *checker, size_t old) {
    checker->length = old;
    checker->path[old] = '\0';
}

static EnfJsonType type_of(const Checker *checker, uint32_t value) {
    return (EnfJsonType)checker->json->values[value].type;
}

static EnfResult check_index(Checker *checker, uint32_t value, int collection) {
    uint64_t index;
    if (!enf_json_uint(checker->json, value, INT32_MAX, &index)) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an index");
    }
    if (index >= checker->counts[collection]) {
        char what[96];
        snprintf(what, sizeof what, "is %u, but there are %u %s", (unsigned)index, checker->counts[collection],
                 collection_names[collection]);
        return refuse(checker, ENF_ERROR_INDEX, value, what);
    }
    return ENF_OK;
}

static EnfResult check_number(Checker *checker, uint32_t value) {
    double number;
    return enf_json_number(checker->json, value, &number) ? ENF_OK
                                                          : refuse(checker, ENF_ERROR_FORMAT, value, "must be a number");
}

static EnfResult check_object(Checker *checker, uint32_t value, const Rule *table);

/* One element of an array: of a rule's kind, or of the kind behind its plural. */
static EnfResult check_element(Checker *checker, uint32_t value, const Rule *rule) {
    switch (rule->kind) {
    case OBJECTS:
        return check_object(checker, value, rule->table);
    case NUMBERS:
        return check_number(checker, value);
    case STRINGS:
        return type_of(checker, value) == ENF_JSON_STRING ? ENF_OK
                                                          : refuse(checker, ENF_ERROR_FORMAT, value, "must be a string");
    default:
        return check_index(checker, value, rule->argument);
    }
}

static EnfResult check_array(Checker *checker, uint32_t value, const Rule *rule) {
    const EnfJsonValue *array = &checker->json->values[value];
    if (array->type != ENF_JSON_ARRAY) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an array");
    }
    if (rule->kind == NUMBERS && array->count != (uint32_t)rule->argument) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "has the wrong number of elements");
    }
    uint32_t index = 0;
    for (uint32_t v = value + 1; v < array->next; v = checker->json->values[v].next) {
        size_t old = enter_index(checker, index++);
        EnfResult result = check_element(checker, v, rule);
        if (result != ENF_OK) {
            return result;
        }
        leave(checker, old);
    }
    return ENF_OK;
}

static EnfResult check_mapped(Checker *checker, uint32_t value, int collection) {
    if (type_of(checker, value) != ENF_JSON_OBJECT) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an object");
    }
    uint32_t end = checker->json->values[value].next;
    for (uint32_t name = value + 1; name < end; name = checker->json->values[name + 1].next) {
        char key[64];
        if (enf_json_string(checker->json, name, key, sizeof key) == SIZE_MAX) {
            return refuse(checker, ENF_ERROR_FORMAT, name, "name too long");
        }
        size_t old = enter_key(checker, key);
        EnfResult result = check_index(checker, name + 1, collection);
        if (result != ENF_OK) {
            return result;
        }
        leave(checker, old);
    }
    return ENF_OK;
}

static EnfResult check_value(Checker *checker, uint32_t value, const Rule *rule) {
    EnfJsonType type = type_of(checker, value);
    uint64_t integer;
    switch (rule->kind) {
    case OBJECT:
        return check_object(checker, value, rule->table);
    case STRING:
        return type == ENF_JSON_STRING ? ENF_OK : refuse(checker, ENF_ERROR_FORMAT, value, "must be a string");
    case BOOLEAN:
        return type == ENF_JSON_TRUE || type == ENF_JSON_FALSE
                   ? ENF_OK
                   : refuse(checker, ENF_ERROR_FORMAT, value, "must be true or false");
    case NUMBER:
        return check_number(checker, value);
    case COUNT:
        return enf_json_uint(checker->json, value, INT32_MAX, &integer)
                   ? ENF_OK
                   : refuse(checker, ENF_ERROR_FORMAT, value, "must be an integer from 0 to 2147483647");
    case INDEX:
        return check_index(checker, value, rule->argument);
    case MAPPED:
        return check_mapped(checker, value, rule->argument);
    default:
        return check_array(checker, value, rule);
    }
}

/* A name given twice is refused (readers differ in which one they take). */
static EnfResult check_members(Checker *checker, uint32_t object, const Rule *rule) {
    uint32_t end = checker->json->values[object].next;
    bool found = false;
    for (uint32_t name = object + 1; name < end; name = checker->json->values[name + 1].next) {
        if (!enf_json_equals(checker->json, name, rule->key)) {
            continue;
        }
        size_t old = enter_key(checker, rule->key);
        if (found) {
            return refuse(checker, ENF_ERROR_FORMAT, name, "is given twice");
        }
        found = true;
        EnfResult result = check_value(checker, name + 1, rule);
        if (result != ENF_OK) {
            return result;
        }
        leave(checker, old);
    }
    if (!found && rule->required) {
        enter_key(checker, rule->key);
        return refuse(checker, ENF_ERROR_FORMAT, object, "is missing");
    }
    return ENF_OK;
}

static EnfResult check_object(Checker *checker, uint32_t value, const Rule *table) {
    if (type_of(checker, value) != ENF_JSON_OBJECT) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an object");
    }
    for (const Rule *rule = table; rule->key; rule++) {
        EnfResult result = check_members(checker, value, rule);
        if (result != ENF_OK) {
            return result;
        }
    }
    return ENF_OK;
}

/* ---- version and extensions ------------------------------------------------------------------------------------- */

static EnfResult check_version(Checker *checker) {
    const EnfJson *json = checker->json;
    uint32_t asset = enf_json_member(json, 0, "asset");
    uint32_t minimum = enf_json_member(json, asset, "minVersion");
    uint32_t value = minimum != ENF_NONE ? minimum : enf_json_member(json, asset, "version");
    char version[32];
    bool read = enf_json_string(json, value, version, sizeof version) != SIZE_MAX;
    bool good = read && (minimum != ENF_NONE ? strcmp(version, "2.0") == 0 : strncmp(version, "2.", 2) == 0);
    if (good) {
        return ENF_OK;
    }
    enter_key(checker, minimum != ENF_NONE ? "asset.minVersion" : "asset.version");
    return refuse(checker, ENF_ERROR_VERSION, value, "glTF 2.0 is read");
}

static bool is_supported(const char *name) {
    for (size_t i = 0; i < sizeof supported_extensions / sizeof *supported_extensions; i++) {
        if (strcmp(name, supported_extensions[i]) == 0) {
            return true;
        }
    }
    return false;
}

static EnfResult check_extensions(Checker *checker, EnfDiagnosis *diagnosis, bool required) {
    const EnfJson *json = checker->json;
    const char *key = required ? "extensionsRequired" : "extensionsUsed";
    uint32_t array = enf_json_member(json, 0, key);
    uint32_t end = array == ENF_NONE ? 0 : json->values[array].next;
    for (uint32_t v = array == ENF_NONE ? 0 : array + 1; v < end; v = json->values[v].next) {
        char name[128];
        if (enf_json_string(json, v, name, sizeof name) == SIZE_MAX) {
            snprintf(name, sizeof name, "(name too long)");
        }
        if (is_supported(name)) {
            continue;
        }
        if (required) {
            return enf_error_set(checker->error, ENF_ERROR_UNSUPPORTED, json->base + json->values[v].start,
                                 "extensionsRequired: %s is not supported", name);
        }
        enf_diagnose(diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, "", "extension %s is not read; what it adds is lost", name);
    }
    return ENF_OK;
}

static void count_collections(Checker *checker) {
    const EnfJson *json = checker->json;
    for (int i = 0; i < COLLECTION_COUNT; i++) {
        uint32_t holder = 0;
        if (i == LIGHTS) {
            holder = enf_json_member(json, enf_json_member(json, 0, "extensions"), "KHR_lights_punctual");
        }
        uint32_t array = enf_json_member(json, holder, collection_names[i]);
        bool usable = array != ENF_NONE && json->values[array].type == ENF_JSON_ARRAY;
        checker->counts[i] = usable ? json->values[array].count : 0;
    }
}

EnfResult enf_gltf_check(const EnfJson *json, EnfDiagnosis *diagnosis, EnfError *error) {
    Checker checker = {.json = json, .error = error};
    static const Rule asset_rule[] = {{"asset", OBJECT, true, 0, asset_table}, {0}};
    EnfResult result = check_object(&checker, 0, asset_rule);
    if (result == ENF_OK) {
        result = check_version(&checker);
    }
    static const Rule extension_rules[] = {
        {"extensionsUsed", STRINGS, false, 0, NULL}, {"extensionsRequired", STRINGS, false, 0, NULL}, {0}};
    if (result == ENF_OK) {
        result = check_object(&checker, 0, extension_rules);
    }
    if (result == ENF_OK) {
        result = check_extensions(&checker, diagnosis, true);
    }
    if (result == ENF_OK) {
        count_collections(&checker);
        result = check_object(&checker, 0, root_table);
    }
    if (result == ENF_OK) {
        result = check_extensions(&checker, diagnosis, false);
    }
    return result;
}

/* ---- the fence -------------------------------------------------------------------------------------------------- */

/* A growing text, as parts of the original and insertions. Sized by the caller: see enf_gltf_fence. */
typedef struct Writer {
    const EnfJson *json;
    char *out;
    size_t length;
    uint32_t copied; /* the original is copied up to here */
} Writer;

static void copy_until(Writer *writer, uint32_t at) {
    memcpy(writer->out + writer->length, writer->json->text + writer->copied, at - writer->copied);
    writer->length += at - writer->copied;
    writer->copied = at;
}

static void insert(Writer *writer, const char *text) {
    size_t length = strlen(text);
    memcpy(writer->out + writer->length, text, length);
    writer->length += length;
}

static void empty_array(Writer *writer, uint32_t value) {
    copy_until(writer, writer->json->values[value].start);
    insert(writer, "[]");
    writer->copied = writer->json->values[value].end;
}

enum { INSERTION = 64 }; /* the longest insertion into an accessor, in bytes */

static void mend_accessors(Writer *writer, uint32_t array, uint32_t view_count) {
    const EnfJson *json = writer->json;
    for (uint32_t v = array + 1; v < json->values[array].next; v = json->values[v].next) {
        if (enf_json_member(json, v, "bufferView") == ENF_NONE) {
            char member[INSERTION];
            copy_until(writer, json->values[v].start + 1);
            snprintf(member, sizeof member, "\"bufferView\":%u,", view_count);
            insert(writer, member);
        }
    }
}

/* The view that stands for none, behind the file's own. */
static void append_view(Writer *writer, uint32_t array) {
    const EnfJsonValue *v = &writer->json->values[array];
    copy_until(writer, v->end - 1);
    insert(writer, v->count ? ",{\"buffer\":0,\"byteLength\":1}" : "{\"buffer\":0,\"byteLength\":1}");
}

static void write_fenced(Writer *writer, uint32_t view_count) {
    const EnfJson *json = writer->json;
    static const char *const emptied[] = {"buffers", "images", "skins"};
    uint32_t views = enf_json_member(json, 0, "bufferViews");
    if (views == ENF_NONE) {
        copy_until(writer, json->values[0].start + 1);
        insert(writer, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":1}],");
    }
    for (uint32_t name = 1; name < json->values[0].next; name = json->values[name + 1].next) {
        uint32_t value = name + 1;
        for (size_t i = 0; i < sizeof emptied / sizeof *emptied; i++) {
            if (enf_json_equals(json, name, emptied[i])) {
                empty_array(writer, value);
            }
        }
        if (enf_json_equals(json, name, "accessors")) {
            mend_accessors(writer, value, view_count);
        } else if (enf_json_equals(json, name, "bufferViews")) {
            append_view(writer, value);
        }
    }
    copy_until(writer, json->size);
}

EnfResult enf_gltf_fence(const EnfJson *json, char **text, size_t *size, uint32_t *view_count, EnfError *error) {
    uint32_t views = enf_json_member(json, 0, "bufferViews");
    uint32_t accessors = enf_json_member(json, 0, "accessors");
    size_t insertions = 4 + (accessors == ENF_NONE ? 0 : json->values[accessors].count);
    *view_count = views == ENF_NONE ? 0 : json->values[views].count;
    *size = json->size + insertions * INSERTION;
    *text = enf_alloc(NULL, *size, 1);
    if (!*text) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the JSON text");
    }
    Writer writer = {.json = json, .out = *text};
    write_fenced(&writer, *view_count);
    memset(*text + writer.length, ' ', *size - writer.length);
    return ENF_OK;
}

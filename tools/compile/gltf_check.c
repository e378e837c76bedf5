/* The walk that holds a document against the tables of gltf_schema.c, and what no table says: version, extensions. */
#include "compile/gltf_check.h"

#include "compile/gltf_schema.h"

#include <stdio.h>
#include <string.h>

static const char *const collection_names[ENF_GLTF_COLLECTION_COUNT] = {
#define COLLECTION_NAME(name, key) key,
    ENF_GLTF_COLLECTIONS(COLLECTION_NAME)
#undef COLLECTION_NAME
};

/* ---- the walk --------------------------------------------------------------------------------------------------- */

typedef struct Checker {
    const EnfJson *json;
    EnfError *error;
    uint32_t counts[ENF_GLTF_COLLECTION_COUNT];
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

static EnfResult check_object(Checker *checker, uint32_t value, const EnfGltfRule *table);

/* One element of an array: of a rule's kind, or of the kind behind its plural. */
static EnfResult check_element(Checker *checker, uint32_t value, const EnfGltfRule *rule) {
    switch (rule->kind) {
    case ENF_GLTF_OBJECT_LIST:
        return check_object(checker, value, rule->table);
    case ENF_GLTF_NUMBER_LIST:
        return check_number(checker, value);
    case ENF_GLTF_STRING_LIST:
        return type_of(checker, value) == ENF_JSON_STRING ? ENF_OK
                                                          : refuse(checker, ENF_ERROR_FORMAT, value, "must be a string");
    default:
        return check_index(checker, value, rule->argument);
    }
}

static EnfResult check_array(Checker *checker, uint32_t value, const EnfGltfRule *rule) {
    const EnfJsonValue *array = &checker->json->values[value];
    if (array->type != ENF_JSON_ARRAY) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an array");
    }
    if (rule->kind == ENF_GLTF_NUMBER_LIST && array->count != (uint32_t)rule->argument) {
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

static EnfResult check_word(Checker *checker, uint32_t value, const char *const *words) {
    for (; *words; words++) {
        if (enf_json_equals(checker->json, value, *words)) {
            return ENF_OK;
        }
    }
    return refuse(checker, ENF_ERROR_FORMAT, value, "is none of the words that the specification knows");
}

static EnfResult check_stride(Checker *checker, uint32_t value) {
    uint64_t stride;
    bool good = enf_json_uint(checker->json, value, 252, &stride) && stride % 4 == 0;
    return good ? ENF_OK : refuse(checker, ENF_ERROR_FORMAT, value, "must be a multiple of 4 up to 252");
}

static EnfResult check_value(Checker *checker, uint32_t value, const EnfGltfRule *rule) {
    EnfJsonType type = type_of(checker, value);
    uint64_t integer;
    switch (rule->kind) {
    case ENF_GLTF_OBJECT:
        return check_object(checker, value, rule->table);
    case ENF_GLTF_STRING:
        return type == ENF_JSON_STRING ? ENF_OK : refuse(checker, ENF_ERROR_FORMAT, value, "must be a string");
    case ENF_GLTF_WORD:
        return check_word(checker, value, rule->words);
    case ENF_GLTF_STRIDE:
        return check_stride(checker, value);
    case ENF_GLTF_BOOLEAN:
        return type == ENF_JSON_TRUE || type == ENF_JSON_FALSE
                   ? ENF_OK
                   : refuse(checker, ENF_ERROR_FORMAT, value, "must be true or false");
    case ENF_GLTF_NUMBER:
        return check_number(checker, value);
    case ENF_GLTF_COUNT:
        return enf_json_uint(checker->json, value, INT32_MAX, &integer)
                   ? ENF_OK
                   : refuse(checker, ENF_ERROR_FORMAT, value, "must be an integer from 0 to 2147483647");
    case ENF_GLTF_INDEX:
        return check_index(checker, value, rule->argument);
    case ENF_GLTF_INDEX_MAP:
        return check_mapped(checker, value, rule->argument);
    default:
        return check_array(checker, value, rule);
    }
}

/* A name given twice is refused (readers differ in which one they take). */
static EnfResult check_members(Checker *checker, uint32_t object, const EnfGltfRule *rule) {
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

static EnfResult check_object(Checker *checker, uint32_t value, const EnfGltfRule *table) {
    if (type_of(checker, value) != ENF_JSON_OBJECT) {
        return refuse(checker, ENF_ERROR_FORMAT, value, "must be an object");
    }
    for (const EnfGltfRule *rule = table; rule->key; rule++) {
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
    char what[64];
    snprintf(what, sizeof what, "is %s, but glTF 2.0 is read", read ? version : "no version");
    return refuse(checker, ENF_ERROR_VERSION, value, what);
}

static bool is_supported(const char *name) {
    for (const char *const *known = enf_gltf_extensions; *known; known++) {
        if (strcmp(name, *known) == 0) {
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
    for (int i = 0; i < ENF_GLTF_COLLECTION_COUNT; i++) {
        uint32_t holder = 0;
        if (i == ENF_GLTF_LIGHTS) {
            holder = enf_json_member(json, enf_json_member(json, 0, "extensions"), "KHR_lights_punctual");
        }
        uint32_t array = enf_json_member(json, holder, collection_names[i]);
        bool usable = array != ENF_NONE && json->values[array].type == ENF_JSON_ARRAY;
        checker->counts[i] = usable ? json->values[array].count : 0;
    }
}

/* A spot light needs its cone, and a camera its numbers: tinygltf refuses the file without them. `part` of an element of `array` is
 * named by the element's type. */
static EnfResult check_parts(Checker *checker, uint32_t array, const char *where, const char *const *parts) {
    const EnfJson *json = checker->json;
    uint32_t index = 0, end = array == ENF_NONE ? 0 : json->values[array].next;
    for (uint32_t v = array == ENF_NONE ? 0 : array + 1; v < end; v = json->values[v].next, index++) {
        for (const char *const *part = parts; *part; part++) {
            uint32_t type = enf_json_member(json, v, "type");
            if (enf_json_equals(json, type, *part) && enf_json_member(json, v, *part) == ENF_NONE) {
                enter_key(checker, where);
                enter_index(checker, index);
                enter_key(checker, *part);
                return refuse(checker, ENF_ERROR_FORMAT, v, "is missing");
            }
        }
    }
    return ENF_OK;
}

static EnfResult check_all_parts(Checker *checker) {
    static const char *const light_parts[] = {"spot", NULL};
    const EnfJson *json = checker->json;
    uint32_t lights = enf_json_member(json, enf_json_member(json, 0, "extensions"), "KHR_lights_punctual");
    EnfResult result = check_parts(checker, enf_json_member(json, 0, "cameras"), "cameras", enf_gltf_camera_types);
    return result != ENF_OK ? result
                            : check_parts(checker, enf_json_member(json, lights, "lights"),
                                          "extensions.KHR_lights_punctual.lights", light_parts);
}

/* The first three members of the root: what they say explains the faults of the rest, so it is judged first. */
static EnfResult check_head(Checker *checker, EnfDiagnosis *diagnosis) {
    EnfResult result = type_of(checker, 0) == ENF_JSON_OBJECT ? ENF_OK
                                                              : refuse(checker, ENF_ERROR_FORMAT, 0, "must be an object");
    for (int i = 0; i < 3 && result == ENF_OK; i++) {
        result = check_members(checker, 0, &enf_gltf_root_table[i]);
    }
    if (result == ENF_OK) {
        result = check_version(checker);
    }
    return result == ENF_OK ? check_extensions(checker, diagnosis, true) : result;
}

EnfResult enf_gltf_check(const EnfJson *json, EnfDiagnosis *diagnosis, EnfError *error) {
    Checker checker = {.json = json, .error = error};
    EnfResult result = check_head(&checker, diagnosis);
    if (result == ENF_OK) {
        count_collections(&checker);
        result = check_object(&checker, 0, enf_gltf_root_table);
    }
    if (result == ENF_OK) {
        result = check_all_parts(&checker);
    }
    return result == ENF_OK ? check_extensions(&checker, diagnosis, false) : result;
}

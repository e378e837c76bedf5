/* The text that tinygltf gets: the file's own, with parts taken out and stand-ins put in. See gltf_check.h. */
#include "compile/gltf_check.h"

#include <stdio.h>
#include <string.h>

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

/* A zero in place of a value, never longer than what it replaces (a name may be given a million times). */
static void zero(Writer *writer, uint32_t value) {
    copy_until(writer, writer->json->values[value].start);
    insert(writer, "0");
    writer->copied = writer->json->values[value].end;
}

/* tinygltf would build numbers and maps out of what nobody asks it for: zeros in their place cost nothing. */
static void zero_members(Writer *writer, uint32_t object, const char *const *keys) {
    const EnfJson *json = writer->json;
    for (uint32_t name = object + 1; name < json->values[object].next; name = json->values[name + 1].next) {
        for (const char *const *key = keys; *key; key++) {
            if (enf_json_equals(json, name, *key)) {
                zero(writer, name + 1);
            }
        }
    }
}

static void trim_nodes(Writer *writer, uint32_t array) {
    static const char *const keys[] = {"extras", NULL};
    for (uint32_t v = array + 1; v < writer->json->values[array].next; v = writer->json->values[v].next) {
        zero_members(writer, v, keys);
    }
}

enum { INSERTION = 64 }; /* the longest insertion into an accessor, in bytes */

static void mend_accessors(Writer *writer, uint32_t array, uint32_t view_count) {
    static const char *const keys[] = {"min", "max", "name", NULL};
    const EnfJson *json = writer->json;
    for (uint32_t v = array + 1; v < json->values[array].next; v = json->values[v].next) {
        if (enf_json_member(json, v, "bufferView") == ENF_NONE) {
            char member[INSERTION];
            copy_until(writer, json->values[v].start + 1);
            snprintf(member, sizeof member, "\"bufferView\":%u,", view_count);
            insert(writer, member);
        }
        zero_members(writer, v, keys);
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
    static const char *const hidden[] = {"buffers", "images", "skins"};
    uint32_t views = enf_json_member(json, 0, "bufferViews");
    if (views == ENF_NONE) {
        copy_until(writer, json->values[0].start + 1);
        insert(writer, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":1}],");
    }
    for (uint32_t name = 1; name < json->values[0].next; name = json->values[name + 1].next) {
        uint32_t value = name + 1;
        for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++) {
            if (enf_json_equals(json, name, hidden[i])) {
                zero(writer, value);
            }
        }
        if (enf_json_equals(json, name, "accessors")) {
            mend_accessors(writer, value, view_count);
        } else if (enf_json_equals(json, name, "nodes")) {
            trim_nodes(writer, value);
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
    char *fitting = enf_realloc(NULL, *text, *size, writer.length, 1);
    if (fitting) {
        *text = fitting;
        *size = writer.length;
    } else {
        memset(*text + writer.length, ' ', *size - writer.length);
    }
    return ENF_OK;
}

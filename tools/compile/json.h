/* EnfJson: a strict, bounded reading of a JSON text (RFC 8259) as a flat list of values with byte spans.
 *
 * It stands in front of tinygltf: grammar, UTF-8, nesting and size are settled here, so that no hostile text reaches a parser
 * that recurses, asserts or tolerates; and every complaint can name a byte offset and a JSON path. */
#ifndef ENFILADE_COMPILE_JSON_H
#define ENFILADE_COMPILE_JSON_H

#include <enfilade/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ENF_JSON_MAX_DEPTH 128
#define ENF_JSON_MAX_VALUES (UINT32_C(1) << 23)

typedef enum EnfJsonType {
    ENF_JSON_NULL,
    ENF_JSON_FALSE,
    ENF_JSON_TRUE,
    ENF_JSON_NUMBER,
    ENF_JSON_STRING,
    ENF_JSON_ARRAY,
    ENF_JSON_OBJECT
} EnfJsonType;

/** A value and everything inside it. An object's children alternate: key (a string), value, key, value … */
typedef struct EnfJsonValue {
    uint32_t start, end; /**< bytes of the text; strings with their quotes */
    uint32_t next;       /**< the value after this one and its contents */
    uint32_t count : 24; /**< elements of an array, members of an object; strings: 1 if it has escapes */
    uint32_t type : 8;   /**< EnfJsonType */
} EnfJsonValue;

typedef struct EnfJson {
    const char *text; /**< the caller's */
    uint32_t size;
    uint64_t base; /**< offset of the text in its file: errors name file offsets */
    EnfJsonValue *values;
    uint32_t count, capacity;
} EnfJson;

/** Reads `size` bytes at file offset `base`; value 0 is the root. Errors: ENF_ERROR_FORMAT with the offset, ENF_ERROR_SIZE
 *  beyond the limits above, ENF_ERROR_MEMORY. Time is linear, memory 16 bytes a value. Free with enf_json_free.
 *  @guarantee tests/property/test_import_hostile (JSONTestSuite) */
EnfResult enf_json_parse(EnfJson *json, const char *text, size_t size, uint64_t base, EnfError *error);
void enf_json_free(EnfJson *json);

/** The member `key` of `object` (the last of that name, as most readers do), or ENF_NONE, also if `object` is none. */
uint32_t enf_json_member(const EnfJson *json, uint32_t object, const char *key);
/** Is the string `value` equal to `text`, escapes decoded? */
bool enf_json_equals(const EnfJson *json, uint32_t value, const char *text);
/** The string `value`, escapes decoded, with a NUL after it, in `out` of `size` bytes (never more than its span); returns its
 *  length, or SIZE_MAX if it does not fit. */
size_t enf_json_string(const EnfJson *json, uint32_t value, char *out, size_t size);
/** A number; false if `value` is none or is not finite as a double. */
bool enf_json_number(const EnfJson *json, uint32_t value, double *out);
/** An integer in [0, max], written without fraction and exponent. */
bool enf_json_uint(const EnfJson *json, uint32_t value, uint64_t max, uint64_t *out);
/** `value` as text without white space outside strings, with a NUL, in `out` of at least its span + 1 bytes. */
size_t enf_json_compact(const EnfJson *json, uint32_t value, char *out);

#ifdef __cplusplus
}
#endif
#endif

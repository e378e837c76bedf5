/* Writing JSON into memory: reports and statistics. Numbers are printed so that they read back as the same double, with the
 * fewest digits that do. */
#ifndef ENFILADE_COMMON_JSON_H
#define ENFILADE_COMMON_JSON_H

#include <enfilade/base.h>

#define ENF_JSON_DEPTH 32

/** A growing text. After running out of memory it stays empty and `failed`; so errors are checked once, at the end. */
typedef struct EnfJson {
    char *text; /**< zero-terminated, owned; NULL while empty */
    size_t size, capacity;
    bool failed;
    bool pretty; /**< a line a member of the outer two levels */
    uint32_t depth;
    bool filled[ENF_JSON_DEPTH]; /**< has this level a member already? */
} EnfJson;

/** Zero-initialise, write, take `text`, free. Keys are NULL inside arrays and at the top. */
void enf_json_object(EnfJson *json, const char *key);
void enf_json_array(EnfJson *json, const char *key);
void enf_json_end_object(EnfJson *json);
void enf_json_end_array(EnfJson *json);
void enf_json_text(EnfJson *json, const char *key, const char *value); /**< UTF-8; broken bytes become U+FFFD */
void enf_json_number(EnfJson *json, const char *key, double value);    /**< not finite: null */
void enf_json_count(EnfJson *json, const char *key, uint64_t value);
void enf_json_bool(EnfJson *json, const char *key, bool value);
void enf_json_null(EnfJson *json, const char *key);
void enf_json_free(EnfJson *json);

/** The shortest of %.15g, %.16g, %.17g that reads back as `value` ("null" if not finite). Returns `out`. */
const char *enf_json_print_number(double value, char out[32]);

/** Writes the finished text and a line feed to `path` atomically; "-" is stdout. */
EnfResult enf_json_save(const EnfJson *json, const char *path, EnfError *error);

#endif

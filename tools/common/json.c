/* Writing JSON; see json.h. */
#include "common/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put(EnfJson *json, const char *bytes, size_t size) {
    if (json->failed) {
        return;
    }
    if (json->size + size + 1 > json->capacity) {
        size_t capacity = (json->size + size + 1) * 2;
        char *grown = realloc(json->text, capacity);
        if (!grown) {
            json->failed = true;
            return;
        }
        json->text = grown;
        json->capacity = capacity;
    }
    memcpy(json->text + json->size, bytes, size);
    json->size += size;
    json->text[json->size] = '\0';
}

static void put_text(EnfJson *json, const char *text) {
    put(json, text, strlen(text));
}

static void new_line(EnfJson *json) {
    put_text(json, "\n");
    for (uint32_t i = 0; i < json->depth; i++) {
        put_text(json, "  ");
    }
}

/* Length of the well-formed UTF-8 sequence at `s`, 0 if it is broken (RFC 3629: no overlong forms, no surrogates). */
static size_t utf8_length(const unsigned char *s) {
    size_t length = s[0] < 0x80                   ? 1
                    : s[0] >= 0xc2 && s[0] < 0xe0 ? 2
                    : s[0] >= 0xe0 && s[0] < 0xf0 ? 3
                    : s[0] >= 0xf0 && s[0] < 0xf5 ? 4
                                                  : 0;
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    bool overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    bool outside = (s[0] == 0xed && s[1] >= 0xa0) || (s[0] == 0xf4 && s[1] >= 0x90);
    return overlong || outside ? 0 : length;
}

static void put_string(EnfJson *json, const char *value) {
    const unsigned char *s = (const unsigned char *)value;
    put_text(json, "\"");
    while (*s) {
        size_t length = utf8_length(s);
        char escape[8];
        if (length == 0) {
            put_text(json, "\xef\xbf\xbd");
            length = 1;
        } else if (*s == '"' || *s == '\\') {
            escape[0] = '\\';
            escape[1] = (char)*s;
            put(json, escape, 2);
        } else if (*s < 0x20) {
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*s);
            put_text(json, escape);
        } else {
            put(json, (const char *)s, length);
        }
        s += length;
    }
    put_text(json, "\"");
}

/* Comma, line and key before a value. */
static void begin_value(EnfJson *json, const char *key) {
    if (json->depth > 0) {
        if (json->filled[json->depth - 1]) {
            put_text(json, ",");
        }
        json->filled[json->depth - 1] = true;
        if (json->pretty && json->depth <= 2) {
            new_line(json);
        } else if (json->size > 0 && json->text[json->size - 1] == ',') {
            put_text(json, " ");
        }
    }
    if (key) {
        put_string(json, key);
        put_text(json, ": ");
    }
}

static void open_level(EnfJson *json, const char *key, const char *bracket) {
    begin_value(json, key);
    put_text(json, bracket);
    if (json->depth == ENF_JSON_DEPTH) {
        json->failed = true;
        return;
    }
    json->filled[json->depth++] = false;
}

static void close_level(EnfJson *json, const char *bracket) {
    if (json->depth == 0) {
        json->failed = true;
        return;
    }
    bool filled = json->filled[--json->depth];
    if (json->pretty && json->depth < 2 && filled) {
        new_line(json);
    }
    put_text(json, bracket);
}

void enf_json_object(EnfJson *json, const char *key) {
    open_level(json, key, "{");
}

void enf_json_array(EnfJson *json, const char *key) {
    open_level(json, key, "[");
}

void enf_json_end_object(EnfJson *json) {
    close_level(json, "}");
}

void enf_json_end_array(EnfJson *json) {
    close_level(json, "]");
}

void enf_json_text(EnfJson *json, const char *key, const char *value) {
    begin_value(json, key);
    put_string(json, value);
}

const char *enf_json_print_number(double value, char out[32]) {
    if (!isfinite(value)) {
        return strcpy(out, "null");
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(out, 32, "%.*g", digits, value);
        if (strtod(out, NULL) == value) {
            break;
        }
    }
    return out;
}

void enf_json_number(EnfJson *json, const char *key, double value) {
    char text[32];
    begin_value(json, key);
    put_text(json, enf_json_print_number(value, text));
}

void enf_json_count(EnfJson *json, const char *key, uint64_t value) {
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    begin_value(json, key);
    put_text(json, text);
}

void enf_json_bool(EnfJson *json, const char *key, bool value) {
    begin_value(json, key);
    put_text(json, value ? "true" : "false");
}

void enf_json_null(EnfJson *json, const char *key) {
    begin_value(json, key);
    put_text(json, "null");
}

void enf_json_free(EnfJson *json) {
    free(json->text);
    memset(json, 0, sizeof *json);
}

EnfResult enf_json_save(const EnfJson *json, const char *path, EnfError *error) {
    if (json->failed || !json->text) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory while writing %s", path);
    }
    if (strcmp(path, "-") == 0) {
        bool written = fwrite(json->text, 1, json->size, stdout) == json->size && putchar('\n') != EOF;
        return written && fflush(stdout) == 0 ? ENF_OK : enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot write stdout");
    }
    EnfSpan spans[2] = {{json->text, json->size}, {"\n", 1}};
    return enf_file_write(path, spans, 2, error);
}

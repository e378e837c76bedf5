/* EnfJson from text: one pass, an explicit stack, no recursion. See json.h. */
#include "compile/json.h"

#include <stdlib.h>
#include <string.h>

typedef struct Scanner {
    EnfJson *json;
    const char *text;
    uint32_t at, size;
    uint32_t stack[ENF_JSON_MAX_DEPTH]; /* open containers */
    uint32_t depth;
    EnfError *error;
} Scanner;

static EnfResult complain(Scanner *scanner, EnfResult code, const char *what) {
    return enf_error_set(scanner->error, code, scanner->json->base + scanner->at, "JSON: %s", what);
}

static EnfResult syntax(Scanner *scanner, const char *what) {
    return complain(scanner, ENF_ERROR_FORMAT, what);
}

static int peek(const Scanner *scanner) {
    return scanner->at < scanner->size ? (unsigned char)scanner->text[scanner->at] : -1;
}

static void skip_space(Scanner *scanner) {
    for (int c = peek(scanner); c == ' ' || c == '\t' || c == '\n' || c == '\r'; c = peek(scanner)) {
        scanner->at++;
    }
}

static EnfResult push_value(Scanner *scanner, EnfJsonType type, uint32_t *index) {
    EnfJson *json = scanner->json;
    if (json->count == ENF_JSON_MAX_VALUES) {
        return complain(scanner, ENF_ERROR_SIZE, "too many values");
    }
    if (json->count == json->capacity) {
        uint32_t capacity = json->capacity ? json->capacity * 2 : 256;
        EnfJsonValue *grown = enf_realloc(NULL, json->values, json->capacity, capacity, sizeof *grown);
        if (!grown) {
            return complain(scanner, ENF_ERROR_MEMORY, "out of memory");
        }
        json->values = grown;
        json->capacity = capacity;
    }
    *index = json->count++;
    json->values[*index] = (EnfJsonValue){scanner->at, scanner->at, *index + 1, 0, (uint32_t)type & 0xFFu};
    return ENF_OK;
}

/* ---- scalars ---------------------------------------------------------------------------------------------------- */

static int hex_digit(int c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* Four hexadecimal digits at `at`, or -1. */
static int32_t hex4(const char *text, uint32_t at, uint32_t end) {
    if (end - at < 4) {
        return -1;
    }
    int32_t code = 0;
    for (uint32_t i = 0; i < 4; i++) {
        int digit = hex_digit((unsigned char)text[at + i]);
        if (digit < 0) {
            return -1;
        }
        code = code * 16 + digit;
    }
    return code;
}

/* The code point of \uXXXX (or a surrogate pair of them) at `at` (behind the u); -1 if malformed or a lone surrogate.
 * `length` receives the bytes used, from behind the first u. */
static int32_t escape_code(const char *text, uint32_t at, uint32_t end, uint32_t *length) {
    int32_t code = hex4(text, at, end);
    *length = 4;
    if (code < 0xD800 || code > 0xDFFF) {
        return code;
    }
    if (code > 0xDBFF || end - at < 10 || text[at + 4] != '\\' || text[at + 5] != 'u') {
        return -1;
    }
    int32_t low = hex4(text, at + 6, end);
    *length = 10;
    return low >= 0xDC00 && low <= 0xDFFF ? 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00) : -1;
}

/* Length of the well-formed UTF-8 sequence at `at` (Unicode 15, table 3-7), or 0. */
static uint32_t utf8_length(const char *text, uint32_t at, uint32_t size) {
    const unsigned char *s = (const unsigned char *)text + at;
    uint32_t left = size - at;
    uint32_t length = s[0] >= 0xC2 && s[0] < 0xE0 ? 2 : s[0] >= 0xE0 && s[0] < 0xF0 ? 3 : s[0] >= 0xF0 && s[0] < 0xF5 ? 4 : 0;
    if (length == 0 || left < length) {
        return 0;
    }
    unsigned low = s[0] == 0xE0 ? 0xA0u : s[0] == 0xF0 ? 0x90u : 0x80u;
    unsigned high = s[0] == 0xED ? 0x9Fu : s[0] == 0xF4 ? 0x8Fu : 0xBFu;
    if (s[1] < low || s[1] > high) {
        return 0;
    }
    for (uint32_t i = 2; i < length; i++) {
        if ((s[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    return length;
}

static EnfResult scan_escape(Scanner *scanner) {
    scanner->at++; /* the backslash */
    int c = peek(scanner);
    if (c == 'u') {
        uint32_t length;
        if (escape_code(scanner->text, scanner->at + 1, scanner->size, &length) < 0) {
            return syntax(scanner, "malformed \\u escape");
        }
        scanner->at += 1 + length;
        return ENF_OK;
    }
    if (c < 0 || !strchr("\"\\/bfnrt", c) || c == 0) {
        return syntax(scanner, "malformed escape");
    }
    scanner->at++;
    return ENF_OK;
}

static EnfResult scan_string(Scanner *scanner, uint32_t *index) {
    EnfResult result = push_value(scanner, ENF_JSON_STRING, index);
    scanner->at++;
    while (result == ENF_OK) {
        int c = peek(scanner);
        if (c == '"') {
            scanner->json->values[*index].end = ++scanner->at;
            return ENF_OK;
        }
        if (c < 0x20) {
            return syntax(scanner, c < 0 ? "string without an end" : "control character in a string");
        }
        if (c == '\\') {
            scanner->json->values[*index].count = 1;
            result = scan_escape(scanner);
        } else if (c < 0x80) {
            scanner->at++;
        } else {
            uint32_t length = utf8_length(scanner->text, scanner->at, scanner->size);
            if (length == 0) {
                return syntax(scanner, "malformed UTF-8");
            }
            scanner->at += length;
        }
    }
    return result;
}

static uint32_t skip_digits(Scanner *scanner) {
    uint32_t first = scanner->at;
    while (peek(scanner) >= '0' && peek(scanner) <= '9') {
        scanner->at++;
    }
    return scanner->at - first;
}

static EnfResult scan_number(Scanner *scanner) {
    uint32_t index;
    EnfResult result = push_value(scanner, ENF_JSON_NUMBER, &index);
    if (result != ENF_OK) {
        return result;
    }
    scanner->at += peek(scanner) == '-';
    bool zero = peek(scanner) == '0';
    uint32_t digits = skip_digits(scanner);
    if (digits == 0 || (zero && digits > 1)) {
        return syntax(scanner, "malformed number");
    }
    if (peek(scanner) == '.') {
        scanner->at++;
        if (skip_digits(scanner) == 0) {
            return syntax(scanner, "malformed number");
        }
    }
    if (peek(scanner) == 'e' || peek(scanner) == 'E') {
        scanner->at++;
        scanner->at += peek(scanner) == '-' || peek(scanner) == '+';
        if (skip_digits(scanner) == 0) {
            return syntax(scanner, "malformed number");
        }
    }
    scanner->json->values[index].end = scanner->at;
    return ENF_OK;
}

static EnfResult scan_word(Scanner *scanner, const char *word, EnfJsonType type) {
    uint32_t length = (uint32_t)strlen(word);
    uint32_t index;
    if (scanner->size - scanner->at < length || memcmp(scanner->text + scanner->at, word, length) != 0) {
        return syntax(scanner, "a value is expected");
    }
    EnfResult result = push_value(scanner, type, &index);
    if (result == ENF_OK) {
        scanner->at += length;
        scanner->json->values[index].end = scanner->at;
    }
    return result;
}

/* ---- containers ------------------------------------------------------------------------------------------------- */

static EnfResult open_container(Scanner *scanner, EnfJsonType type) {
    if (scanner->depth == ENF_JSON_MAX_DEPTH) {
        return complain(scanner, ENF_ERROR_SIZE, "nested too deeply");
    }
    EnfResult result = push_value(scanner, type, &scanner->stack[scanner->depth]);
    scanner->depth += result == ENF_OK;
    scanner->at++;
    return result;
}

static void close_container(Scanner *scanner) {
    EnfJsonValue *value = &scanner->json->values[scanner->stack[--scanner->depth]];
    value->end = ++scanner->at;
    value->next = scanner->json->count;
}

/* A key and its colon. */
static EnfResult scan_key(Scanner *scanner) {
    uint32_t key;
    if (peek(scanner) != '"') {
        return syntax(scanner, "a member's name is expected");
    }
    EnfResult result = scan_string(scanner, &key);
    if (result != ENF_OK) {
        return result;
    }
    skip_space(scanner);
    if (peek(scanner) != ':') {
        return syntax(scanner, "':' is expected");
    }
    scanner->at++;
    skip_space(scanner);
    return ENF_OK;
}

/* Before an element: counts it in its container, and reads its key if it is a member. */
static EnfResult begin_element(Scanner *scanner) {
    if (scanner->depth == 0) {
        return ENF_OK;
    }
    EnfJsonValue *container = &scanner->json->values[scanner->stack[scanner->depth - 1]];
    container->count = (container->count + 1) & 0xFFFFFFu;
    return container->type == ENF_JSON_OBJECT ? scan_key(scanner) : ENF_OK;
}

/* After an element: closes what ends here. `more` tells whether an element follows. */
static EnfResult end_element(Scanner *scanner, bool *more) {
    while (scanner->depth > 0) {
        skip_space(scanner);
        bool object = scanner->json->values[scanner->stack[scanner->depth - 1]].type == ENF_JSON_OBJECT;
        int c = peek(scanner);
        if (c == ',') {
            scanner->at++;
            skip_space(scanner);
            *more = true;
            return ENF_OK;
        }
        if (c != (object ? '}' : ']')) {
            return syntax(scanner, object ? "',' or '}' is expected" : "',' or ']' is expected");
        }
        close_container(scanner);
    }
    *more = false;
    return ENF_OK;
}

/* One value; a container is only opened (`opened`), unless it is empty. */
static EnfResult scan_value(Scanner *scanner, bool *opened) {
    int c = peek(scanner);
    uint32_t index;
    *opened = false;
    if (c == '{' || c == '[') {
        EnfResult result = open_container(scanner, c == '{' ? ENF_JSON_OBJECT : ENF_JSON_ARRAY);
        if (result != ENF_OK) {
            return result;
        }
        skip_space(scanner);
        *opened = peek(scanner) != (c == '{' ? '}' : ']');
        if (!*opened) {
            close_container(scanner);
        }
        return ENF_OK;
    }
    switch (c) {
    case '"':
        return scan_string(scanner, &index);
    case 't':
        return scan_word(scanner, "true", ENF_JSON_TRUE);
    case 'f':
        return scan_word(scanner, "false", ENF_JSON_FALSE);
    case 'n':
        return scan_word(scanner, "null", ENF_JSON_NULL);
    default:
        return c == '-' || (c >= '0' && c <= '9') ? scan_number(scanner) : syntax(scanner, "a value is expected");
    }
}

static EnfResult scan_document(Scanner *scanner) {
    bool more = true;
    skip_space(scanner);
    while (more) {
        bool opened;
        EnfResult result = begin_element(scanner);
        if (result == ENF_OK) {
            result = scan_value(scanner, &opened);
        }
        if (result == ENF_OK && !opened) {
            result = end_element(scanner, &more);
        }
        if (result != ENF_OK) {
            return result;
        }
    }
    skip_space(scanner);
    return scanner->at == scanner->size ? ENF_OK : syntax(scanner, "text after the end");
}

EnfResult enf_json_parse(EnfJson *json, const char *text, size_t size, uint64_t base, EnfError *error) {
    *json = (EnfJson){.text = text, .size = (uint32_t)size, .base = base};
    if (size >= UINT32_MAX) {
        return enf_error_set(error, ENF_ERROR_SIZE, base, "JSON: the text is too long");
    }
    Scanner scanner = {.json = json, .text = text, .size = (uint32_t)size, .error = error};
    EnfResult result = scan_document(&scanner);
    if (result != ENF_OK) {
        enf_json_free(json);
    }
    return result;
}

void enf_json_free(EnfJson *json) {
    enf_free(NULL, json->values, json->capacity, sizeof *json->values);
    *json = (EnfJson){0};
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

uint32_t enf_json_member(const EnfJson *json, uint32_t object, const char *key) {
    uint32_t found = ENF_NONE;
    if (object == ENF_NONE || json->values[object].type != ENF_JSON_OBJECT) {
        return found;
    }
    uint32_t end = json->values[object].next;
    for (uint32_t name = object + 1; name < end; name = json->values[name + 1].next) {
        if (enf_json_equals(json, name, key)) {
            found = name + 1;
        }
    }
    return found;
}

static size_t put_utf8(uint32_t code, char *out) {
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    size_t length = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned lead[5] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (size_t i = length - 1; i > 0; i--) {
        out[i] = (char)(0x80u | (code & 0x3Fu));
        code >>= 6;
    }
    out[0] = (char)(lead[length] | code);
    return length;
}

/* Decodes the escape at `*at` (a backslash); moves `*at` behind it. The text has been scanned: the escape is well formed. */
static uint32_t decode_escape(const char *text, uint32_t *at, uint32_t end) {
    static const char from[] = "bfnrt", to[] = "\b\f\n\r\t";
    char c = text[*at + 1];
    *at += 2;
    if (c == 'u') {
        uint32_t length;
        int32_t code = escape_code(text, *at, end, &length);
        *at += length;
        return (uint32_t)code;
    }
    const char *match = strchr(from, c);
    return match ? (uint32_t)to[match - from] : (uint32_t)(unsigned char)c;
}

size_t enf_json_string(const EnfJson *json, uint32_t value, char *out, size_t size) {
    const EnfJsonValue *v = &json->values[value];
    uint32_t end = v->end - 1;
    size_t length = 0;
    for (uint32_t at = v->start + 1; at < end;) {
        char bytes[4];
        size_t count = 1;
        if (json->text[at] == '\\') {
            count = put_utf8(decode_escape(json->text, &at, end), bytes);
        } else {
            bytes[0] = json->text[at++];
        }
        if (size <= count || length >= size - count) {
            return SIZE_MAX;
        }
        memcpy(out + length, bytes, count);
        length += count;
    }
    out[length] = '\0';
    return length;
}

bool enf_json_equals(const EnfJson *json, uint32_t value, const char *text) {
    const EnfJsonValue *v = &json->values[value];
    size_t length = strlen(text);
    if (v->type != ENF_JSON_STRING) {
        return false;
    }
    if (v->count == 0) {
        return v->end - v->start == length + 2 && memcmp(json->text + v->start + 1, text, length) == 0;
    }
    char decoded[64];
    return enf_json_string(json, value, decoded, sizeof decoded) == length && memcmp(decoded, text, length) == 0;
}

/* The number's text with a NUL; false if it is no number or absurdly long. */
static bool number_text(const EnfJson *json, uint32_t value, char *out, size_t size) {
    if (value == ENF_NONE || json->values[value].type != ENF_JSON_NUMBER) {
        return false;
    }
    const EnfJsonValue *v = &json->values[value];
    size_t length = v->end - v->start;
    if (length >= size) {
        return false;
    }
    memcpy(out, json->text + v->start, length);
    out[length] = '\0';
    return true;
}

bool enf_json_number(const EnfJson *json, uint32_t value, double *out) {
    char text[512];
    if (!number_text(json, value, text, sizeof text)) {
        return false;
    }
    *out = strtod(text, NULL);
    return *out - *out == 0.0; /* neither infinite nor NaN */
}

bool enf_json_uint(const EnfJson *json, uint32_t value, uint64_t max, uint64_t *out) {
    char text[24];
    if (!number_text(json, value, text, sizeof text) || strlen(text) > 19) {
        return false;
    }
    uint64_t sum = 0;
    for (const char *c = text; *c; c++) {
        if (*c < '0' || *c > '9') {
            return false;
        }
        sum = sum * 10 + (uint64_t)(*c - '0');
    }
    *out = sum;
    return sum <= max;
}

size_t enf_json_compact(const EnfJson *json, uint32_t value, char *out) {
    const EnfJsonValue *v = &json->values[value];
    size_t length = 0;
    bool quoted = false;
    for (uint32_t at = v->start; at < v->end; at++) {
        char c = json->text[at];
        if (!quoted && (c == ' ' || c == '\t' || c == '\n' || c == '\r')) {
            continue;
        }
        if (quoted && c == '\\') {
            out[length++] = c;
            c = json->text[++at];
        } else if (c == '"') {
            quoted = !quoted;
        }
        out[length++] = c;
    }
    out[length] = '\0';
    return length;
}

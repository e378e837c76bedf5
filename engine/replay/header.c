/* The text header of a recording. It is written from one table and parsed against the same, line by line, so that a header
 * has one spelling; the checksum of its last line makes a changed byte an error. */
#include "replay/replay_internal.h"

#include <stdio.h>
#include <string.h>

const char *enf_replay_engine(void) {
    return ENF_VERSION;
}

EnfReplayHeader enf_replay_header_default(void) {
    EnfReplayHeader header;
    memset(&header, 0, sizeof header);
    header.tick_rate = 60;
    header.field_every = 1;
    return header;
}

/* ---- check ------------------------------------------------------------------------------------------------------ */

enum { TICK_RATE_MAX = 1000, FIELD_EVERY_MAX = 65536 };

static bool is_text(const char *text, size_t size) {
    size_t length = 0;
    while (length < size && text[length]) {
        unsigned char c = (unsigned char)text[length++];
        if (c < 32 || c == 127) {
            return false;
        }
    }
    return length < size;
}

static bool is_name(const char *name) {
    size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_-.");
    return length > 0 && length < ENF_REPLAY_NAME_SIZE && name[length] == '\0';
}

static EnfResult bad(EnfError *error, const char *what) {
    return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "header of a recording: %s", what);
}

static EnfResult check_fields(const EnfReplayHeader *header, EnfError *error) {
    if (header->field_count > ENF_REPLAY_FIELDS_MAX) {
        return bad(error, "more than 32 fields");
    }
    for (uint32_t i = 0; i < header->field_count; i++) {
        if (!memchr(header->fields[i], 0, ENF_REPLAY_NAME_SIZE) || !is_name(header->fields[i])) {
            return bad(error, "a field's name is not of 1 to 31 of a-z, 0-9, '_', '-' and '.'");
        }
        for (uint32_t k = 0; k < i; k++) {
            if (strcmp(header->fields[i], header->fields[k]) == 0) {
                return bad(error, "two fields have one name");
            }
        }
    }
    return ENF_OK;
}

EnfResult enf_replay_check_header(const EnfReplayHeader *header, EnfError *error) {
    if (!is_text(header->engine, sizeof header->engine)) {
        return bad(error, "'engine' is not a line of text");
    }
    const char *const texts[5] = {header->game, header->map, header->start, header->title, header->script};
    const char *const names[5] = {"game", "map", "start", "title", "script"};
    for (int i = 0; i < 5; i++) {
        if (!is_text(texts[i], ENF_REPLAY_TEXT_SIZE)) {
            return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "header of a recording: '%s' is not a line of text",
                                 names[i]);
        }
    }
    if (header->tick_rate < 1 || header->tick_rate > TICK_RATE_MAX) {
        return bad(error, "'tick_rate' is outside 1..1000");
    }
    if (header->field_every < 1 || header->field_every > FIELD_EVERY_MAX) {
        return bad(error, "'field_every' is outside 1..65536");
    }
    return check_fields(header, error);
}

/* ---- write ------------------------------------------------------------------------------------------------------ */

typedef struct Text {
    char *bytes;
    size_t length;
} Text;

static void put(Text *text, const char *key, const char *value) {
    int length = snprintf(text->bytes + text->length, ENF_REPLAY_HEADER_MAX - text->length, "%s %s\n", key, value);
    ENF_ASSERT(length > 0 && (size_t)length < ENF_REPLAY_HEADER_MAX - text->length);
    text->length += (size_t)length;
}

static void put_text(Text *text, const char *key, const char *value) {
    if (value[0]) {
        put(text, key, value);
    }
}

static void put_hash(Text *text, const char *key, uint64_t hash) {
    char digits[24];
    snprintf(digits, sizeof digits, "%08lx%08lx", (unsigned long)(hash >> 32), (unsigned long)(hash & UINT32_MAX));
    put(text, key, digits);
}

static void put_count(Text *text, const char *key, uint32_t count) {
    char digits[24];
    snprintf(digits, sizeof digits, "%lu", (unsigned long)count);
    put(text, key, digits);
}

size_t enf_replay_write_header(char bytes[ENF_REPLAY_HEADER_MAX], const EnfReplayHeader *header) {
    Text text = {bytes, 0};
    put_count(&text, "enfreplay", ENF_REPLAY_VERSION);
    put(&text, "engine", header->engine);
    put_text(&text, "game", header->game);
    put_text(&text, "map", header->map);
    put_text(&text, "start", header->start);
    put_text(&text, "title", header->title);
    put_text(&text, "script", header->script);
    put_hash(&text, "map-hash", header->map_hash);
    put_hash(&text, "seed", header->seed);
    put_hash(&text, "start-hash", header->start_hash);
    put_count(&text, "tick-rate", header->tick_rate);
    put_count(&text, "field-every", header->field_every);
    for (uint32_t i = 0; i < header->field_count; i++) {
        put(&text, "field", header->fields[i]);
    }
    memcpy(bytes + text.length, (const char[4]){'e', 'n', 'd', ' '}, 4);
    text.length += 4;
    char digits[24];
    snprintf(digits, sizeof digits, "%08lx", (unsigned long)enf_crc32c(0, bytes, text.length));
    text.length -= 4;
    put(&text, "end", digits);
    return text.length;
}

/* ---- parse ------------------------------------------------------------------------------------------------------ */

/* Lines of a header. After the first failure every take fails, and `line` is where the line at fault begins. */
typedef struct Lines {
    const uint8_t *data;
    size_t size, at, line;
    bool failed;
} Lines;

/* The value of the line at hand if its key is `key`: copied with its 0. False, and nothing taken, if it is another line. */
static bool take(Lines *lines, const char *key, char *value, size_t value_size) {
    size_t key_length = strlen(key), left = lines->size - lines->at;
    const uint8_t *start = lines->data + lines->at;
    if (lines->failed || left < key_length + 1 || memcmp(start, key, key_length) != 0 || start[key_length] != ' ') {
        return false;
    }
    const uint8_t *end = memchr(start, '\n', left);
    const uint8_t *text = start + key_length + 1;
    lines->line = lines->at;
    if (!end || (size_t)(end - text) >= value_size || end == text) {
        lines->failed = true;
        return false;
    }
    memcpy(value, text, (size_t)(end - text));
    value[end - text] = '\0';
    lines->failed = !is_text(value, (size_t)(end - text) + 1) || strlen(value) != (size_t)(end - text);
    lines->at += (size_t)(end - start) + 1;
    return !lines->failed;
}

static void need(Lines *lines, const char *key, char *value, size_t value_size) {
    if (!take(lines, key, value, value_size) && !lines->failed) {
        lines->failed = true;
        lines->line = lines->at;
    }
}

/* `digits` lower-case hexadecimal ones. */
static uint64_t need_hex(Lines *lines, const char *key, size_t digits) {
    char text[24] = "";
    need(lines, key, text, sizeof text);
    uint64_t value = 0;
    for (const char *c = text; *c; c++) {
        static const char alphabet[] = "0123456789abcdef";
        const char *found = strchr(alphabet, *c);
        lines->failed |= !found;
        value = value << 4 | (found ? (uint64_t)(found - alphabet) : 0);
    }
    lines->failed |= strlen(text) != digits;
    return lines->failed ? 0 : value;
}

static uint32_t need_count(Lines *lines, const char *key, uint32_t low, uint32_t high) {
    char text[11] = "";
    need(lines, key, text, sizeof text);
    uint64_t value = 0;
    for (const char *c = text; *c; c++) {
        lines->failed |= *c < '0' || *c > '9' || (*c == '0' && c == text);
        value = value * 10 + (uint64_t)(*c - '0');
    }
    lines->failed |= value < low || value > high;
    return lines->failed ? low : (uint32_t)value;
}

static void parse_lines(EnfReplayHeader *header, Lines *lines) {
    need(lines, "engine", header->engine, sizeof header->engine);
    take(lines, "game", header->game, sizeof header->game);
    take(lines, "map", header->map, sizeof header->map);
    take(lines, "start", header->start, sizeof header->start);
    take(lines, "title", header->title, sizeof header->title);
    take(lines, "script", header->script, sizeof header->script);
    header->map_hash = need_hex(lines, "map-hash", 16);
    header->seed = need_hex(lines, "seed", 16);
    header->start_hash = need_hex(lines, "start-hash", 16);
    header->tick_rate = need_count(lines, "tick-rate", 1, TICK_RATE_MAX);
    header->field_every = need_count(lines, "field-every", 1, FIELD_EVERY_MAX);
    while (header->field_count < ENF_REPLAY_FIELDS_MAX &&
           take(lines, "field", header->fields[header->field_count], ENF_REPLAY_NAME_SIZE)) {
        header->field_count++;
    }
}

static EnfResult parse_end(const EnfReplayHeader *header, Lines *lines, EnfError *error) {
    size_t covered = lines->at + 4;
    uint32_t crc = (uint32_t)need_hex(lines, "end", 8);
    if (lines->failed) {
        return enf_error_set(error, ENF_ERROR_FORMAT, lines->line,
                             "the header of the recording has a line that is not expected");
    }
    if (crc != enf_crc32c(0, lines->data, covered)) {
        return enf_error_set(error, ENF_ERROR_CHECKSUM, lines->line, "the header of the recording is damaged");
    }
    EnfResult result = check_fields(header, error);
    if (result != ENF_OK) {
        return enf_error_set(error, ENF_ERROR_FORMAT, lines->line,
                             "the header of the recording names a field wrongly or twice");
    }
    return ENF_OK;
}

EnfResult enf_replay_parse_header(EnfReplayHeader *header, size_t *length, const uint8_t *data, size_t size, EnfError *error) {
    static const char magic[] = "enfreplay ";
    memset(header, 0, sizeof *header);
    size_t known = sizeof magic - 1;
    if (size < known || memcmp(data, magic, known) != 0) {
        return enf_error_set(error, ENF_ERROR_MAGIC, 0, "not a recording: it does not begin with 'enfreplay'");
    }
    Lines lines = {data, size < ENF_REPLAY_HEADER_MAX ? size : ENF_REPLAY_HEADER_MAX, 0, 0, false};
    uint32_t version = need_count(&lines, "enfreplay", 1, UINT32_MAX);
    if (!lines.failed && version != ENF_REPLAY_VERSION) {
        return enf_error_set(error, ENF_ERROR_VERSION, 0, "a recording of format %lu; this engine reads format %d",
                             (unsigned long)version, ENF_REPLAY_VERSION);
    }
    parse_lines(header, &lines);
    EnfResult result = parse_end(header, &lines, error);
    if (result != ENF_OK && !memchr(data + lines.line, '\n', size - lines.line) && size < ENF_REPLAY_HEADER_MAX) {
        result = enf_error_set(error, ENF_ERROR_TRUNCATED, size, "the recording ends within its header");
    }
    *length = lines.at;
    return result;
}

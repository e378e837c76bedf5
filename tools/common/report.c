/* Writing JSON; see report.h. */
#include "common/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put(EnfReport *report, const char *bytes, size_t size) {
    if (report->failed) {
        return;
    }
    if (report->size + size + 1 > report->capacity) {
        size_t capacity = (report->size + size + 1) * 2;
        char *grown = realloc(report->text, capacity);
        if (!grown) {
            report->failed = true;
            return;
        }
        report->text = grown;
        report->capacity = capacity;
    }
    memcpy(report->text + report->size, bytes, size);
    report->size += size;
    report->text[report->size] = '\0';
}

static void put_text(EnfReport *report, const char *text) {
    put(report, text, strlen(text));
}

static void new_line(EnfReport *report) {
    put_text(report, "\n");
    for (uint32_t i = 0; i < report->depth; i++) {
        put_text(report, "  ");
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

static void put_string(EnfReport *report, const char *value) {
    const unsigned char *s = (const unsigned char *)value;
    put_text(report, "\"");
    while (*s) {
        size_t length = utf8_length(s);
        char escape[8];
        if (length == 0) {
            put_text(report, "\xef\xbf\xbd");
            length = 1;
        } else if (*s == '"' || *s == '\\') {
            escape[0] = '\\';
            escape[1] = (char)*s;
            put(report, escape, 2);
        } else if (*s < 0x20) {
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned)*s);
            put_text(report, escape);
        } else {
            put(report, (const char *)s, length);
        }
        s += length;
    }
    put_text(report, "\"");
}

/* Comma, line and key before a value. */
static void begin_value(EnfReport *report, const char *key) {
    if (report->depth > 0) {
        if (report->filled[report->depth - 1]) {
            put_text(report, ",");
        }
        report->filled[report->depth - 1] = true;
        if (report->pretty && report->depth <= 2) {
            new_line(report);
        } else if (report->size > 0 && report->text[report->size - 1] == ',') {
            put_text(report, " ");
        }
    }
    if (key) {
        put_string(report, key);
        put_text(report, ": ");
    }
}

static void open_level(EnfReport *report, const char *key, const char *bracket) {
    begin_value(report, key);
    put_text(report, bracket);
    if (report->depth == ENF_REPORT_DEPTH) {
        report->failed = true;
        return;
    }
    report->filled[report->depth++] = false;
}

static void close_level(EnfReport *report, const char *bracket) {
    if (report->depth == 0) {
        report->failed = true;
        return;
    }
    bool filled = report->filled[--report->depth];
    if (report->pretty && report->depth < 2 && filled) {
        new_line(report);
    }
    put_text(report, bracket);
}

void enf_report_object(EnfReport *report, const char *key) {
    open_level(report, key, "{");
}

void enf_report_array(EnfReport *report, const char *key) {
    open_level(report, key, "[");
}

void enf_report_end_object(EnfReport *report) {
    close_level(report, "}");
}

void enf_report_end_array(EnfReport *report) {
    close_level(report, "]");
}

void enf_report_text(EnfReport *report, const char *key, const char *value) {
    begin_value(report, key);
    put_string(report, value);
}

const char *enf_report_print_number(double value, char out[32]) {
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

void enf_report_number(EnfReport *report, const char *key, double value) {
    char text[32];
    begin_value(report, key);
    put_text(report, enf_report_print_number(value, text));
}

void enf_report_count(EnfReport *report, const char *key, uint64_t value) {
    char text[32];
    snprintf(text, sizeof text, "%llu", (unsigned long long)value);
    begin_value(report, key);
    put_text(report, text);
}

void enf_report_bool(EnfReport *report, const char *key, bool value) {
    begin_value(report, key);
    put_text(report, value ? "true" : "false");
}

void enf_report_null(EnfReport *report, const char *key) {
    begin_value(report, key);
    put_text(report, "null");
}

void enf_report_free(EnfReport *report) {
    free(report->text);
    memset(report, 0, sizeof *report);
}

EnfResult enf_report_save(const EnfReport *report, const char *path, EnfError *error) {
    if (report->failed || !report->text) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory while writing %s", path);
    }
    if (strcmp(path, "-") == 0) {
        bool written = fwrite(report->text, 1, report->size, stdout) == report->size && putchar('\n') != EOF;
        return written && fflush(stdout) == 0 ? ENF_OK : enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot write stdout");
    }
    EnfSpan spans[2] = {{report->text, report->size}, {"\n", 1}};
    return enf_file_write(path, spans, 2, error);
}

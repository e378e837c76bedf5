/* What a uri in a level stands for: bytes inside the text (data:), or a file in the level's folder or below it, never outside.
 * A uri is hostile until shown otherwise: it is decoded once, then judged by its parts, then by where the file really lies. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "compile/import.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { PATH_SIZE = 4096 };

/* ---- data: ------------------------------------------------------------------------------------------------------ */

static int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* Decodes `length` characters in place of `out`, which may be where they stand. SIZE_MAX if malformed. */
static size_t base64_decode(const char *text, size_t length, uint8_t *out) {
    while (length > 0 && text[length - 1] == '=') {
        length--;
    }
    size_t size = 0;
    uint32_t bits = 0, bit_count = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit(text[i]);
        if (digit < 0) {
            return SIZE_MAX;
        }
        bits = bits << 6 | (uint32_t)digit;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            out[size++] = (uint8_t)(bits >> bit_count);
        }
    }
    return bit_count < 6 ? size : SIZE_MAX;
}

static EnfResult read_data_uri(EnfImport *import, char *uri, const char *where, EnfImportBytes *out) {
    static const char marker[] = ";base64,";
    char *comma = strchr(uri, ',');
    size_t head = comma ? (size_t)(comma + 1 - uri) : 0;
    if (head < sizeof marker - 1 || strncasecmp(comma + 1 - (sizeof marker - 1), marker, sizeof marker - 1) != 0) {
        return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: a data URI that is not base64", where);
    }
    uint8_t *bytes = (uint8_t *)uri;
    size_t size = base64_decode(comma + 1, strlen(comma + 1), bytes);
    if (size == SIZE_MAX) {
        return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: malformed base64", where);
    }
    *out = (EnfImportBytes){bytes, size};
    return ENF_OK;
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

static int hex_digit(char c) {
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = c ? strchr(digits, c) : NULL;
    return found ? (int)((found - digits) & 15) : -1;
}

static bool percent_decode(const char *uri, char *out, size_t size) {
    size_t length = 0;
    for (const char *c = uri; *c; c++) {
        int code = (unsigned char)*c;
        if (*c == '%') {
            int high = hex_digit(c[1]), low = high < 0 ? -1 : hex_digit(c[2]);
            if (low < 0) {
                return false;
            }
            code = high * 16 + low;
            c += 2;
        }
        if (length + 1 >= size || code < 0x20 || code == 0x7F) {
            return false;
        }
        out[length++] = (char)code;
    }
    out[length] = '\0';
    return length > 0;
}

/* Every part between slashes must be a plain name: not empty, not "..". */
static bool parts_are_plain(const char *path) {
    for (const char *part = path;; part++) {
        size_t length = strcspn(part, "/");
        if (length == 0 || (length == 2 && part[0] == '.' && part[1] == '.')) {
            return false;
        }
        part += length;
        if (*part == '\0') {
            return true;
        }
    }
}

bool enf_import_uri_path(const char *uri, char *out, size_t size) {
    /* A colon would begin a scheme or a drive, a backslash is a slash elsewhere; decoded twice they must still be plain. */
    return percent_decode(uri, out, size) && !strpbrk(out, ":\\?*\"<>|") && parts_are_plain(out);
}

static EnfResult refuse_path(EnfImport *import, const char *where, const char *uri, const char *what) {
    return enf_error_set(import->error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: '%.200s' %s", where, uri, what);
}

/* The folder of the level, "." if its path names none. */
static bool folder_of(const char *path, char *out, size_t size) {
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) : 0;
    int printed = slash ? snprintf(out, size, "%.*s", (int)(length ? length : 1), path) : snprintf(out, size, ".");
    return printed > 0 && (size_t)printed < size;
}

/* Does `path` lie in `folder`, once links are followed? */
static bool lies_inside(const char *folder, const char *path) {
    size_t length = strlen(folder);
    length -= length == 1; /* "/" */
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

static EnfResult read_beside(EnfImport *import, const char *path, EnfImportBytes *out) {
    EnfFile file;
    EnfResult result = enf_file_read(&file, path, ENF_IMPORT_MAX_FILE, NULL, import->error);
    if (result != ENF_OK) {
        return result;
    }
    uint8_t *copy = enf_import_scratch(import, file.size, 1);
    if (copy && file.size) {
        memcpy(copy, file.data, file.size);
    }
    *out = (EnfImportBytes){copy, file.size};
    import->source->hash = enf_hash64(import->source->hash, file.data, file.size);
    enf_file_free(&file);
    return copy ? ENF_OK : import->failure;
}

static EnfResult read_file_uri(EnfImport *import, const char *uri, const char *where, EnfImportBytes *out) {
    char relative[PATH_SIZE], folder[PATH_SIZE], joined[2 * PATH_SIZE];
    if (!enf_import_uri_path(uri, relative, sizeof relative) || !folder_of(import->path, folder, sizeof folder)) {
        return refuse_path(import, where, uri, "is not a plain path in the level's folder");
    }
    snprintf(joined, sizeof joined, "%s/%s", folder, relative);
    char *real_folder = realpath(folder, NULL), *real_file = realpath(joined, NULL);
    struct stat status;
    EnfResult result = ENF_OK;
    if (!real_folder || !real_file || stat(real_file, &status) != 0) {
        result = enf_error_set(import->error, ENF_ERROR_IO, UINT64_MAX, "%s: '%.200s' is not there", where, uri);
    } else if (!lies_inside(real_folder, real_file)) {
        result = refuse_path(import, where, uri, "leads outside the level's folder");
    } else if (!S_ISREG(status.st_mode)) { /* a pipe would block */
        result = refuse_path(import, where, uri, "is not a regular file");
    } else {
        result = read_beside(import, real_file, out);
    }
    free(real_folder);
    free(real_file);
    return result;
}

EnfResult enf_import_uri(EnfImport *import, uint32_t value, const char *where, EnfImportBytes *out) {
    const EnfJsonValue *v = &import->json.values[value];
    size_t size = v->end - v->start;
    char *uri = enf_import_scratch(import, size, 1);
    if (!uri) {
        return import->failure;
    }
    size_t length = enf_json_string(&import->json, value, uri, size);
    if (length == SIZE_MAX || strlen(uri) != length) {
        return refuse_path(import, where, uri, "holds a zero");
    }
    return strncasecmp(uri, "data:", 5) == 0 ? read_data_uri(import, uri, where, out) : read_file_uri(import, uri, where, out);
}

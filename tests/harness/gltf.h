/* Small glTF documents made by code, for tests of the importer and the compiler. Header only: a suite that includes it uses it all
 * or says (void). */
#ifndef ENF_TESTS_GLTF_H
#define ENF_TESTS_GLTF_H

#include "compile/diagnosis.h"
#include "compile/source.h"
#include "harness/harness.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** A growing text. */
typedef struct EnfTestText {
    char *text;
    size_t length, capacity;
} EnfTestText;

static inline void enf_test_reserve(EnfTestText *out, size_t more) {
    if (out->length + more + 1 > out->capacity) {
        out->capacity = 2 * (out->length + more + 64);
        out->text = realloc(out->text, out->capacity);
        assert_non_null(out->text);
    }
}

static inline void enf_test_put(EnfTestText *out, const char *text) {
    size_t length = strlen(text);
    enf_test_reserve(out, length);
    memcpy(out->text + out->length, text, length + 1);
    out->length += length;
}

static inline void enf_test_put_number(EnfTestText *out, double value) {
    char text[40];
    snprintf(text, sizeof text, "%.9g", value);
    enf_test_put(out, text);
}

/** Bytes as a data URI. */
static inline void enf_test_put_data(EnfTestText *out, const void *data, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *bytes = data;
    enf_test_put(out, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < size; i += 3) {
        uint32_t left = size - i < 3 ? (uint32_t)(size - i) : 3;
        uint32_t bits = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
        char group[5] = {digits[bits >> 18], digits[bits >> 12 & 63], '=', '=', 0};
        group[2] = left > 1 ? digits[bits >> 6 & 63] : '=';
        group[3] = left > 2 ? digits[bits & 63] : '=';
        enf_test_put(out, group);
    }
}

/** "buffers":[…] with the bytes inside. */
static inline void enf_test_put_buffer(EnfTestText *out, const void *data, size_t size) {
    char head[64];
    snprintf(head, sizeof head, "\"buffers\":[{\"byteLength\":%zu,\"uri\":\"", size);
    enf_test_put(out, head);
    enf_test_put_data(out, data, size);
    enf_test_put(out, "\"}]");
}

/** A cube from -0.5 to 0.5, as the bytes behind accessors: corners and two index lists, whose fronts show outward and inward. */
typedef struct EnfTestCube {
    float corners[8][3];
    uint16_t outward[36], inward[36];
} EnfTestCube;

static inline void enf_test_cube(EnfTestCube *cube) {
    static const uint16_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++) {
        for (int axis = 0; axis < 3; axis++) {
            cube->corners[i][axis] = i >> axis & 1 ? 0.5F : -0.5F;
        }
    }
    for (int f = 0; f < 6; f++) {
        const uint16_t *c = faces[f];
        const uint16_t out[6] = {c[0], c[1], c[2], c[0], c[2], c[3]}, in[6] = {c[0], c[2], c[1], c[0], c[3], c[2]};
        memcpy(cube->outward + 6 * f, out, sizeof out);
        memcpy(cube->inward + 6 * f, in, sizeof in);
    }
}

/** What an import gave. Free with enf_test_import_free. */
typedef struct EnfTestImport {
    EnfResult result;
    EnfSource source;
    EnfDiagnosis diagnosis;
    EnfError error;
} EnfTestImport;

static inline EnfTestImport enf_test_import_file(const char *path) {
    EnfTestImport out = {0};
    out.result = enf_source_import(&out.source, path, &out.diagnosis, &out.error);
    return out;
}

/** Imports `text` as level.gltf in the temporary folder. */
static inline EnfTestImport enf_test_import_text(const char *text) {
    const char *path = enf_test_temp_path("level.gltf");
    enf_test_write_file(path, text, strlen(text));
    return enf_test_import_file(path);
}

static inline void enf_test_import_free(EnfTestImport *import) {
    enf_source_free(&import->source);
    enf_diagnosis_free(&import->diagnosis);
}

/** How often `code` was found. */
static inline uint32_t enf_test_found(const EnfTestImport *import, EnfDiagnosisCode code) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < import->diagnosis.count; i++) {
        count += import->diagnosis.findings[i].code == code;
    }
    return count;
}

#endif

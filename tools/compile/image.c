/* RGBA8 pixels from PNG or JPEG bytes, by stb_image; nothing else of it is compiled in. */
#include <stdlib.h>
#include <string.h>

/* Zeroed memory: the JPEG reader of 2.27 uses Huffman tables that the file never gave. */
#define STBI_MALLOC(size) calloc(1, size)
#define STBI_REALLOC(block, size) realloc(block, size)
#define STBI_FREE(block) free(block)
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 16384
/* It shifts and adds past what C defines, harmlessly; the sanitizers of our own code should not stop there. */
#if defined(__clang__)
#pragma clang attribute push(__attribute__((no_sanitize("undefined"))), apply_to = function)
#endif
#include <stb_image.h>
#if defined(__clang__)
#pragma clang attribute pop
#endif

#include "compile/import.h"

static const char *why(void) {
    const char *reason = stbi_failure_reason();
    return reason ? reason : "neither PNG nor JPEG";
}

/* May stb_image see these bytes at all? */
static bool is_safe(EnfImportBytes bytes, const char **reason) {
    bool png = bytes.size >= 4 && memcmp(bytes.data, "\x89PNG", 4) == 0;
    *reason = bytes.size > INT32_MAX ? "too large" : !png && !enf_jpeg_is_safe(bytes) ? "a JPEG with malformed tables" : NULL;
    return !*reason;
}

bool enf_image_size(EnfImportBytes bytes, uint32_t *width, uint32_t *height, const char **reason) {
    int w = 0, h = 0, channels = 0;
    if (!is_safe(bytes, reason)) {
        return false;
    }
    if (!stbi_info_from_memory(bytes.data, (int)bytes.size, &w, &h, &channels)) {
        *reason = why();
        return false;
    }
    if (w <= 0 || h <= 0 || w > ENF_IMPORT_MAX_IMAGE || h > ENF_IMPORT_MAX_IMAGE) {
        *reason = "too large";
        return false;
    }
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return true;
}

uint8_t *enf_image_decode(EnfImportBytes bytes, uint32_t *width, uint32_t *height, const char **reason) {
    int w = 0, h = 0, channels = 0;
    uint8_t *pixels = NULL;
    if (is_safe(bytes, reason)) {
        pixels = stbi_load_from_memory(bytes.data, (int)bytes.size, &w, &h, &channels, 4);
    }
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    if (!pixels && !*reason) {
        *reason = why();
    }
    return pixels;
}

void enf_image_free(uint8_t *pixels) {
    stbi_image_free(pixels);
}

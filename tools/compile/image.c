/* RGBA8 pixels from PNG or JPEG bytes, by stb_image; nothing else of it is compiled in. */
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 16384
#include <stb_image.h>

#include "compile/import.h"

static const char *why(void) {
    const char *reason = stbi_failure_reason();
    return reason ? reason : "neither PNG nor JPEG";
}

bool enf_image_size(EnfImportBytes bytes, uint32_t *width, uint32_t *height, const char **reason) {
    int w = 0, h = 0, channels = 0;
    if (bytes.size > INT32_MAX || !stbi_info_from_memory(bytes.data, (int)bytes.size, &w, &h, &channels)) {
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
    if (bytes.size <= INT32_MAX) {
        pixels = stbi_load_from_memory(bytes.data, (int)bytes.size, &w, &h, &channels, 4);
    }
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    *reason = pixels ? NULL : why();
    return pixels;
}

void enf_image_free(uint8_t *pixels) {
    stbi_image_free(pixels);
}

/* PNG files through libpng's simplified interface, which reports errors by return value instead of longjmp. */
#include "common/png_file.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

enum { PNG_SIDE_MAX = 32768, PNG_FILE_MAX = 1 << 30 };

EnfResult enf_png_write(const char *path, const uint8_t *rgba, uint32_t width, uint32_t height, bool opaque, EnfError *error) {
    if (width < 1 || height < 1 || width > PNG_SIDE_MAX || height > PNG_SIDE_MAX) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "%s: a picture of %u x %u", path, width, height);
    }
    size_t pixels = (size_t)width * height;
    size_t channels = opaque ? 3 : 4;
    uint8_t *packed = malloc(pixels * channels);
    if (!packed) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for %s", path);
    }
    for (size_t i = 0; i < pixels; i++) {
        memcpy(packed + i * channels, rgba + i * 4, channels);
    }
    png_image image = {
        .version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA};
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    void *file = malloc(size);
    EnfResult result = ENF_OK;
    if (!file || !png_image_write_to_memory(&image, file, &size, 0, packed, 0, NULL)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "%s: %s", path, file ? image.message : "no memory");
    } else {
        result = enf_file_write(path, &(EnfSpan){file, size}, 1, error);
    }
    free(file);
    free(packed);
    return result;
}

/* Decodes an opened image; frees its state. */
static EnfResult decode(png_image *image, const char *path, uint8_t **rgba, EnfError *error) {
    if (image->width > PNG_SIDE_MAX || image->height > PNG_SIDE_MAX) {
        png_image_free(image);
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "%s: picture too large", path);
    }
    size_t pixels = (size_t)image->width * image->height;
    uint8_t *bytes = enf_alloc(NULL, pixels, 4);
    if (!bytes) {
        png_image_free(image);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for %s", path);
    }
    image->format = PNG_FORMAT_RGBA;
    if (!png_image_finish_read(image, NULL, bytes, 0, NULL)) {
        enf_free(NULL, bytes, pixels, 4);
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: %s", path, image->message);
    }
    *rgba = bytes;
    return ENF_OK;
}

EnfResult enf_png_read(const char *path, uint8_t **rgba, uint32_t *width, uint32_t *height, EnfError *error) {
    EnfFile file;
    EnfResult result = enf_file_read(&file, path, PNG_FILE_MAX, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(&image, file.data, file.size)) {
        result = enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "%s: %s", path, image.message);
    } else {
        result = decode(&image, path, rgba, error);
        *width = image.width;
        *height = image.height;
    }
    enf_file_free(&file);
    return result;
}

/* Images, textures and materials of a map. */
#include "compile/assemble.h"

#include <string.h>

/* glTF 2.0 §3.8.4: what an absent sampler means. */
enum { FILTER_LINEAR = 9729, FILTER_TRILINEAR = 9987, WRAP_REPEAT = 10497 };

/* ---- images ----------------------------------------------------------------------------------------------------- */

/* The integer square root, rounded to nearest. */
static uint32_t root(uint32_t square) {
    uint32_t low = 0, high = 256;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (middle * middle <= square) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return square - low * low > low && low < 255 ? low + 1 : low;
}

/* The mean of up to four pixels. Colours are averaged as squares (near enough to linear light, and exact in integers) and by
 * their alpha, so that what is transparent does not bleed. */
static void mean_pixel(const uint8_t *const pixels[4], uint8_t out[4]) {
    uint32_t alpha = 0;
    for (int i = 0; i < 4; i++) {
        alpha += pixels[i][3];
    }
    for (int channel = 0; channel < 3; channel++) {
        uint32_t sum = 0, weight = alpha ? alpha : 4;
        for (int i = 0; i < 4; i++) {
            uint32_t c = pixels[i][channel];
            sum += c * c * (alpha ? pixels[i][3] : 1u);
        }
        out[channel] = (uint8_t)root((sum + weight / 2) / weight);
    }
    out[3] = (uint8_t)((alpha + 2) / 4);
}

/* Halves an image in place; an odd last row or column is counted twice. */
static void halve_image(uint8_t *rgba, uint32_t *width, uint32_t *height) {
    uint32_t w = *width, h = *height, half_w = w > 1 ? w / 2 : 1, half_h = h > 1 ? h / 2 : 1;
    for (uint32_t y = 0; y < half_h; y++) {
        for (uint32_t x = 0; x < half_w; x++) {
            uint32_t x1 = 2 * x + 1 < w ? 2 * x + 1 : w - 1, y1 = 2 * y + 1 < h ? 2 * y + 1 : h - 1;
            uint32_t x0 = 2 * x < w ? 2 * x : w - 1, y0 = 2 * y < h ? 2 * y : h - 1;
            const uint8_t *pixels[4] = {rgba + 4 * ((size_t)y0 * w + x0), rgba + 4 * ((size_t)y0 * w + x1),
                                        rgba + 4 * ((size_t)y1 * w + x0), rgba + 4 * ((size_t)y1 * w + x1)};
            uint8_t mean[4];
            mean_pixel(pixels, mean);
            memcpy(rgba + 4 * ((size_t)y * half_w + x), mean, 4);
        }
    }
    *width = half_w;
    *height = half_h;
}

static EnfResult add_image(EnfAssembly *assembly, const EnfSourceImage *from, uint32_t side_max, EnfError *error) {
    static const uint8_t white[4] = {255, 255, 255, 255};
    bool empty = from->width == 0 || from->height == 0 || !from->rgba;
    EnfImage image = {empty ? 1 : from->width, empty ? 1 : from->height, assembly->pixels.count,
                      enf_strings_add(&assembly->texts, from->name)};
    uint64_t size = UINT64_C(4) * image.width * image.height;
    if (assembly->pixels.count + size >= UINT32_C(1) << 31) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX,
                             "the textures need more than 2 GiB at image \"%s\": lower the setting max_image", from->name);
    }
    if (!ENF_ARRAY_ROOM(&assembly->images, 1) || !ENF_ARRAY_ROOM(&assembly->pixels, size)) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for image \"%s\"", from->name);
    }
    uint8_t *pixels = assembly->pixels.data + assembly->pixels.count;
    memcpy(pixels, empty ? white : from->rgba, (size_t)size);
    while (image.width > side_max || image.height > side_max) {
        halve_image(pixels, &image.width, &image.height);
    }
    assembly->pixels.count += 4 * image.width * image.height;
    assembly->images.data[assembly->images.count++] = image;
    return ENF_OK;
}

/* ---- textures and materials ------------------------------------------------------------------------------------- */

static bool add_texture(EnfAssembly *assembly, const EnfTexture *from) {
    EnfTexture texture = *from;
    texture.mag_filter = texture.mag_filter ? texture.mag_filter : FILTER_LINEAR;
    texture.min_filter = texture.min_filter ? texture.min_filter : FILTER_TRILINEAR;
    texture.wrap_s = texture.wrap_s ? texture.wrap_s : WRAP_REPEAT;
    texture.wrap_t = texture.wrap_t ? texture.wrap_t : WRAP_REPEAT;
    if (!ENF_ARRAY_ROOM(&assembly->textures, 1)) {
        return false;
    }
    assembly->textures.data[assembly->textures.count++] = texture;
    return true;
}

/* A texture whose image could not be had is none. */
static uint32_t usable_texture(const EnfSource *source, uint32_t texture) {
    bool usable = texture < source->texture_count && source->textures[texture].image < source->image_count;
    return usable ? texture : ENF_NONE;
}

static bool add_material(EnfAssembly *assembly, const EnfSource *source, uint32_t index) {
    EnfMaterial material = source->materials[index];
    material.name = enf_strings_add(&assembly->texts, source->material_names[index]);
    material.texture = usable_texture(source, material.texture);
    material.emissive_texture = usable_texture(source, material.emissive_texture);
    material.reserved = 0;
    if (!ENF_ARRAY_ROOM(&assembly->materials, 1)) {
        return false;
    }
    assembly->materials.data[assembly->materials.count++] = material;
    return true;
}

EnfResult enf_assemble_materials(EnfAssembly *assembly, const EnfAssemblyParts *parts, EnfError *error) {
    const EnfSource *source = parts->source;
    uint32_t side_max = parts->settings->max_image ? parts->settings->max_image : 1;
    for (uint32_t i = 0; i < source->image_count; i++) {
        EnfResult result = add_image(assembly, &source->images[i], side_max, error);
        if (result != ENF_OK) {
            return result;
        }
    }
    bool ok = true;
    for (uint32_t i = 0; i < source->texture_count && ok; i++) {
        EnfTexture texture = source->textures[i];
        texture.image = texture.image < source->image_count ? texture.image : 0;
        ok = source->image_count == 0 || add_texture(assembly, &texture);
    }
    for (uint32_t i = 0; i < source->material_count && ok; i++) {
        ok = add_material(assembly, source, i);
    }
    return ok ? ENF_OK : enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the materials");
}

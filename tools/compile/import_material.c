/* Materials, textures and images: what a surface looks like. Only images that a material uses are decoded. */
#include "compile/import.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* glTF (OpenGL) sampler enumerants. */
enum {
    NEAREST = 9728,
    LINEAR = 9729,
    NEAREST_MIPMAP_NEAREST = 9984,
    LINEAR_MIPMAP_LINEAR = 9987,
    REPEAT = 10497,
    CLAMP_TO_EDGE = 33071,
    MIRRORED_REPEAT = 33648
};

typedef struct Looks {
    EnfImport *import;
    EnfSourceImage *images;
    uint32_t *source_images; /* a file image's place, or ENF_NONE */
    EnfTexture *textures;
    uint64_t pixel_bytes;
} Looks;

/* ---- images ----------------------------------------------------------------------------------------------------- */

static EnfResult read_image_bytes(EnfImport *import, uint32_t index, EnfImportBytes *out, const char **reason) {
    const EnfJson *json = &import->json;
    uint32_t object = import->image_values[index];
    uint32_t uri = enf_json_member(json, object, "uri");
    uint64_t view = 0;
    *reason = NULL;
    if (enf_json_uint(json, enf_json_member(json, object, "bufferView"), INT32_MAX, &view)) {
        return enf_import_view(import, (uint32_t)view, out);
    }
    if (uri == ENF_NONE) {
        *reason = "it has neither uri nor bufferView";
        return ENF_OK;
    }
    char where[32];
    snprintf(where, sizeof where, "images[%u].uri", index);
    EnfResult result = enf_import_uri(import, uri, where, out);
    if (result == ENF_ERROR_IO) {
        *reason = "the file is not there";
        return ENF_OK;
    }
    return result;
}

static const uint8_t *decode(Looks *looks, EnfImportBytes bytes, EnfSourceImage *image, const char **reason) {
    EnfImport *import = looks->import;
    uint32_t width, height;
    if (!enf_image_size(bytes, &width, &height, reason)) {
        return NULL;
    }
    uint64_t size = UINT64_C(4) * width * height;
    if (size > ENF_IMPORT_MAX_PIXELS - looks->pixel_bytes) {
        *reason = "all images together are too large";
        return NULL;
    }
    uint8_t *pixels = enf_image_decode(bytes, &image->width, &image->height, reason);
    if (!pixels) {
        return NULL;
    }
    uint64_t counted = import->bytes; /* pixels have a limit of their own */
    import->bytes = 0;
    uint8_t *kept = image->width == width && image->height == height ? enf_import_keep(import, (size_t)size, 1) : NULL;
    import->bytes = counted;
    if (kept) {
        memcpy(kept, pixels, (size_t)size);
        looks->pixel_bytes += size;
    }
    enf_image_free(pixels);
    *reason = kept ? NULL : "no memory for it";
    return kept;
}

static const char *image_name(EnfImport *import, uint32_t index) {
    const EnfJson *json = &import->json;
    uint32_t object = import->image_values[index];
    uint32_t name = enf_json_member(json, object, "name");
    char text[256];
    if (name == ENF_NONE || enf_json_string(json, name, text, sizeof text) == SIZE_MAX || !text[0]) {
        snprintf(text, sizeof text, "image %u", index);
    }
    return enf_import_text(import, text);
}

/* An unreadable image becomes one white pixel: the surface keeps its base colour. A uri that leads outside is refused. */
static EnfResult add_image(Looks *looks, uint32_t index) {
    EnfImport *import = looks->import;
    static const uint8_t white[4] = {255, 255, 255, 255};
    EnfSourceImage *image = &looks->images[import->source->image_count];
    EnfImportBytes bytes = {NULL, 0};
    const char *reason;
    image->name = image_name(import, index);
    if (!image->name) {
        return import->failure;
    }
    EnfResult result = read_image_bytes(import, index, &bytes, &reason);
    if (result != ENF_OK) {
        return result;
    }
    image->rgba = reason ? NULL : decode(looks, bytes, image, &reason);
    if (!image->rgba) {
        enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_IMAGE, "", "image %u '%s' is left white: %s", index, image->name, reason);
        image->rgba = white;
        image->width = image->height = 1;
    }
    looks->source_images[index] = import->source->image_count++;
    return ENF_OK;
}

/* ---- textures --------------------------------------------------------------------------------------------------- */

static uint32_t wrap_of(uint32_t wrap) {
    return wrap == CLAMP_TO_EDGE || wrap == MIRRORED_REPEAT ? wrap : REPEAT;
}

/* The texture's place in the source, made when first used; ENF_NONE where the file names no image we could read. */
static EnfResult use_texture(Looks *looks, uint32_t file_texture, uint32_t *out) {
    EnfImport *import = looks->import;
    *out = ENF_NONE;
    if (file_texture == ENF_NONE || import->gltf.textures[file_texture].image == ENF_NONE) {
        return ENF_OK;
    }
    const EnfGltfTexture *from = &import->gltf.textures[file_texture];
    if (import->source_textures[file_texture] == ENF_NONE) {
        if (looks->source_images[from->image] == ENF_NONE) {
            EnfResult result = add_image(looks, from->image);
            if (result != ENF_OK) {
                return result;
            }
        }
        bool nearest = from->mag_filter == NEAREST;
        bool known = from->min_filter == NEAREST || from->min_filter == LINEAR ||
                     (from->min_filter >= NEAREST_MIPMAP_NEAREST && from->min_filter <= LINEAR_MIPMAP_LINEAR);
        looks->textures[import->source->texture_count] = (EnfTexture){
            looks->source_images[from->image], nearest ? NEAREST : LINEAR, known ? from->min_filter : LINEAR_MIPMAP_LINEAR,
            wrap_of(from->wrap_s), wrap_of(from->wrap_t)};
        import->source_textures[file_texture] = import->source->texture_count++;
    }
    *out = import->source_textures[file_texture];
    return ENF_OK;
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

static bool is_word(const char *name, const char *word) {
    size_t length = strlen(word);
    return strncasecmp(name, word, length) == 0 && (name[length] == '\0' || name[length] == '.' || name[length] == '_');
}

/* What a material's name says (DESIGN section 6). */
static uint32_t flags_of_name(const char *name) {
    static const char *const hidden[] = {"caulk", "nodraw", "visportal", "areaportal", "clip"};
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++) {
        if (is_word(name, hidden[i])) {
            return ENF_MATERIAL_NODRAW;
        }
    }
    return strncasecmp(name, "mirror", 6) == 0 ? ENF_MATERIAL_MIRROR : 0;
}

static float clamped(double value, double low, double high) {
    return (float)(value < low ? low : value > high ? high : value);
}

/* KHR_texture_transform as a 2 × 3 matrix: scale, then rotate counter-clockwise as seen (v points down), then move. */
static void transform_rows(const EnfGltfTextureRef *ref, float *out) {
    double s = enf_sin(ref->rotation), c = enf_cos(ref->rotation);
    out[0] = (float)(c * ref->scale[0]);
    out[1] = (float)(s * ref->scale[1]);
    out[2] = (float)ref->offset[0];
    out[3] = (float)(-s * ref->scale[0]);
    out[4] = (float)(c * ref->scale[1]);
    out[5] = (float)ref->offset[1];
}

static uint32_t alpha_mode_of(const char *text) {
    return strcmp(text, "MASK") == 0 ? ENF_ALPHA_MASK : strcmp(text, "BLEND") == 0 ? ENF_ALPHA_BLEND : ENF_ALPHA_OPAQUE;
}

static EnfMaterial default_material(void) {
    EnfMaterial material = {.texture = ENF_NONE,
                            .emissive_texture = ENF_NONE,
                            .alpha_cutoff = 0.5f,
                            .roughness = 1.0f,
                            .metallic = 1.0f,
                            .base_color = {1.0f, 1.0f, 1.0f, 1.0f},
                            .uv_transform = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}};
    return material;
}

static bool same_coordinates(const EnfGltfTextureRef *a, const EnfGltfTextureRef *b) {
    return a->uv_set == b->uv_set && a->rotation == b->rotation && a->offset[0] == b->offset[0] &&
           a->offset[1] == b->offset[1] && a->scale[0] == b->scale[0] && a->scale[1] == b->scale[1];
}

/* One set of coordinates and one transform serve both textures: those of the base colour, if it has one. */
static const EnfGltfTextureRef *leading_texture(EnfImport *import, const EnfGltfMaterial *from) {
    const EnfGltfTextureRef *base = &from->base, *glow = &from->emissive_texture;
    if (base->texture == ENF_NONE) {
        return glow;
    }
    if (glow->texture != ENF_NONE && !same_coordinates(base, glow)) {
        enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, "",
                     "material '%s': its emissive texture takes the coordinates of the base colour texture", from->name);
    }
    return base;
}

static EnfResult fill_material(Looks *looks, const EnfGltfMaterial *from, EnfMaterial *to, uint32_t *uv_set) {
    const EnfGltfTextureRef *lead = leading_texture(looks->import, from);
    *to = default_material();
    to->alpha_mode = alpha_mode_of(from->alpha_mode);
    to->flags = flags_of_name(from->name) | (from->double_sided ? (uint32_t)ENF_MATERIAL_DOUBLE_SIDED : 0u) |
                (from->unlit ? (uint32_t)ENF_MATERIAL_UNLIT : 0u);
    for (int i = 0; i < 4; i++) {
        to->base_color[i] = clamped(from->base_color[i], 0.0, 1.0);
    }
    for (int i = 0; i < 3; i++) {
        to->emissive[i] = clamped(from->emissive[i] * from->emissive_strength, 0.0, 65504.0);
    }
    to->alpha_cutoff = clamped(from->alpha_cutoff, 0.0, 1e6);
    to->roughness = clamped(from->roughness, 0.0, 1.0);
    to->metallic = clamped(from->metallic, 0.0, 1.0);
    *uv_set = lead->uv_set;
    if (lead->texture != ENF_NONE) {
        transform_rows(lead, to->uv_transform);
    }
    EnfResult result = use_texture(looks, from->base.texture, &to->texture);
    return result == ENF_OK ? use_texture(looks, from->emissive_texture.texture, &to->emissive_texture) : result;
}

static bool needs_default_material(const EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    for (uint32_t i = 0; i < gltf->primitive_count; i++) {
        if (gltf->primitives[i].material == ENF_NONE) {
            return true;
        }
    }
    return false;
}

static EnfResult allocate(Looks *looks, EnfMaterial **materials, const char ***names) {
    EnfImport *import = looks->import;
    const EnfGltf *gltf = &import->gltf;
    *materials = enf_import_keep(import, (size_t)gltf->material_count + 1, sizeof **materials);
    *names = enf_import_keep(import, (size_t)gltf->material_count + 1, sizeof **names);
    import->uv_sets = enf_import_scratch(import, (size_t)gltf->material_count + 1, sizeof *import->uv_sets);
    import->source_textures = enf_import_scratch(import, gltf->texture_count, sizeof *import->source_textures);
    looks->textures = enf_import_keep(import, gltf->texture_count, sizeof *looks->textures);
    looks->images = enf_import_keep(import, import->image_count, sizeof *looks->images);
    looks->source_images = enf_import_scratch(import, import->image_count, sizeof *looks->source_images);
    if (!*materials || !*names || !import->uv_sets || !import->source_textures || !looks->textures || !looks->images ||
        !looks->source_images) {
        return import->failure;
    }
    memset(import->source_textures, 0xFF, gltf->texture_count * sizeof *import->source_textures);
    memset(looks->source_images, 0xFF, import->image_count * sizeof *looks->source_images);
    return ENF_OK;
}

EnfResult enf_import_materials(EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    EnfSource *source = import->source;
    Looks looks = {.import = import};
    EnfMaterial *materials;
    const char **names;
    EnfResult result = allocate(&looks, &materials, &names);
    for (uint32_t i = 0; i < gltf->material_count && result == ENF_OK; i++) {
        names[i] = enf_import_text(import, gltf->materials[i].name);
        result = names[i] ? fill_material(&looks, &gltf->materials[i], &materials[i], &import->uv_sets[i]) : import->failure;
    }
    if (result != ENF_OK) {
        return result;
    }
    source->material_count = gltf->material_count;
    if (needs_default_material(import)) {
        import->default_material = source->material_count++;
        materials[import->default_material] = default_material();
        names[import->default_material] = "";
    }
    source->materials = materials;
    source->material_names = names;
    source->textures = looks.textures;
    source->images = looks.images;
    return ENF_OK;
}

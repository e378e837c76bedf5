/* Makes GL textures and samplers from the images and textures of a map: sRGB texels, mipmaps where a sampler wants them. */
#include "gl/gl_internal.h"

/* glTF leaves filters open (0): smooth, with mipmaps. */
static GLint mag_filter(const EnfTexture *texture) {
    return texture->mag_filter ? (GLint)texture->mag_filter : GL_LINEAR;
}

static GLint min_filter(const EnfTexture *texture) {
    return texture->min_filter ? (GLint)texture->min_filter : GL_LINEAR_MIPMAP_LINEAR;
}

static GLint wrap(uint32_t mode) {
    return mode ? (GLint)mode : GL_REPEAT;
}

static bool wants_mipmaps(const EnfMap *map, uint32_t image) {
    for (uint32_t i = 0; i < map->textures_count; i++) {
        GLint filter = min_filter(&map->textures[i]);
        if (map->textures[i].image == image && filter != GL_NEAREST && filter != GL_LINEAR) {
            return true;
        }
    }
    return false;
}

static GLuint create_texture(EnfGl *gl, uint32_t width, uint32_t height, const uint8_t *rgba, bool mipmaps) {
    const EnfGlFunctions *f = &gl->f;
    GLuint name = 0;
    f->GenTextures(1, &name);
    f->BindTexture(GL_TEXTURE_2D, name);
    f->TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, (GLsizei)width, (GLsizei)height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    if (mipmaps) {
        f->GenerateMipmap(GL_TEXTURE_2D);
    } else {
        f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    }
    return name;
}

static EnfResult upload_image(EnfGl *gl, uint32_t i, EnfError *error) {
    const EnfImage *image = &gl->map->images[i];
    if (image->width > (uint32_t)gl->max_texture || image->height > (uint32_t)gl->max_texture) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "image %s is %u × %u; this OpenGL allows %d",
                             enf_map_string(gl->map, image->name), image->width, image->height, (int)gl->max_texture);
    }
    gl->images[i] = create_texture(gl, image->width, image->height, gl->map->pixels + image->byte_first,
                                   wants_mipmaps(gl->map, i));
    return enf_gl_check(gl, enf_map_string(gl->map, image->name), error);
}

static void create_sampler(EnfGl *gl, uint32_t i) {
    const EnfTexture *texture = &gl->map->textures[i];
    gl->f.GenSamplers(1, &gl->samplers[i]);
    gl->f.SamplerParameteri(gl->samplers[i], GL_TEXTURE_MAG_FILTER, mag_filter(texture));
    gl->f.SamplerParameteri(gl->samplers[i], GL_TEXTURE_MIN_FILTER, min_filter(texture));
    gl->f.SamplerParameteri(gl->samplers[i], GL_TEXTURE_WRAP_S, wrap(texture->wrap_s));
    gl->f.SamplerParameteri(gl->samplers[i], GL_TEXTURE_WRAP_T, wrap(texture->wrap_t));
}

EnfResult enf_gl_upload_textures(EnfGl *gl, EnfError *error) {
    static const uint8_t white[4] = {255, 255, 255, 255};
    const EnfMap *map = gl->map;
    gl->images = enf_alloc(NULL, (size_t)map->images_count + 1, sizeof *gl->images);
    gl->samplers = enf_alloc(NULL, (size_t)map->textures_count + 1, sizeof *gl->samplers);
    if (!gl->images || !gl->samplers) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for textures");
    }
    gl->f.ActiveTexture(GL_TEXTURE0);
    gl->f.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->white = create_texture(gl, 1, 1, white, false);
    gl->f.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    EnfResult result = ENF_OK;
    for (uint32_t i = 0; i < map->images_count && result == ENF_OK; i++) {
        result = upload_image(gl, i, error);
    }
    for (uint32_t i = 0; i < map->textures_count; i++) {
        create_sampler(gl, i);
    }
    gl->f.BindTexture(GL_TEXTURE_2D, 0);
    return result == ENF_OK ? enf_gl_check(gl, "the samplers of this map", error) : result;
}

void enf_gl_free_textures(EnfGl *gl) {
    const EnfMap *map = gl->map;
    if (gl->images && gl->samplers) {
        gl->f.DeleteTextures((GLsizei)map->images_count, gl->images);
        gl->f.DeleteSamplers((GLsizei)map->textures_count, gl->samplers);
    }
    gl->f.DeleteTextures(1, &gl->white);
    enf_free(NULL, gl->images, (size_t)map->images_count + 1, sizeof *gl->images);
    enf_free(NULL, gl->samplers, (size_t)map->textures_count + 1, sizeof *gl->samplers);
}

/* Makes an EnfGl: everything that drawing a map needs on the GL side, uploaded once. */
#include <string.h>

#include "gl/gl_internal.h"

EnfResult enf_gl_check(const EnfGl *gl, const char *what, EnfError *error) {
    GLenum code = gl->f.GetError();
    if (code == GL_NO_ERROR) {
        return ENF_OK;
    }
    EnfResult result = code == GL_OUT_OF_MEMORY ? ENF_ERROR_MEMORY : ENF_ERROR_SIZE;
    return enf_error_set(error, result, UINT64_MAX, "OpenGL refuses %s (error 0x%x)", what, code);
}

static EnfResult check_version(EnfGl *gl, EnfError *error) {
    GLint major = 0, minor = 0;
    gl->f.GetIntegerv(GL_MAJOR_VERSION, &major);
    gl->f.GetIntegerv(GL_MINOR_VERSION, &minor);
    if (major < 3 || (major == 3 && minor < 3)) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OpenGL %d.%d: 3.3 core is needed", major, minor);
    }
    gl->f.GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &gl->max_table);
    gl->f.GetIntegerv(GL_MAX_TEXTURE_SIZE, &gl->max_texture);
    return ENF_OK;
}

static uint64_t bit(EnfGlProgramKind kind) {
    return UINT64_C(1) << kind;
}

/* Surfaces that the map has, ids for them, wireframe and lines. */
static uint64_t needed_programs(const EnfMap *map) {
    uint64_t needed = bit(ENF_GL_PROGRAM_FLAT) | bit(ENF_GL_PROGRAM_LINES);
    for (uint32_t i = 0; i < map->materials_count; i++) {
        needed |= bit(enf_gl_program_kind(&map->materials[i], ENF_RENDER_COLOR, false));
        needed |= bit(enf_gl_program_kind(&map->materials[i], ENF_RENDER_IDS, false));
    }
    for (uint32_t i = 0; i < map->mesh_parts_count; i++) {
        const EnfMaterial *material = &map->materials[map->mesh_parts[i].material];
        needed |= bit(enf_gl_program_kind(material, ENF_RENDER_COLOR, true)) | bit(ENF_GL_PROGRAM_MOVER_FLAT);
        needed |= bit(enf_gl_program_kind(material, ENF_RENDER_IDS, true));
    }
    return needed;
}

EnfResult enf_gl_create(EnfGl **gl, const EnfMap *map, EnfGlLoadFn *load, EnfError *error) {
    ENF_ASSERT(gl && map && load);
    *gl = NULL;
    EnfGl *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the renderer");
    }
    made->map = map;
    EnfResult result = enf_gl_functions_load(&made->f, load, error);
    if (result != ENF_OK) {
        enf_free(NULL, made, 1, sizeof *made);
        return result;
    }
    if ((result = check_version(made, error)) != ENF_OK || (result = enf_gl_upload_geometry(made, error)) != ENF_OK ||
        (result = enf_gl_programs_create(&made->f, made->programs, needed_programs(map), made->light_map != 0, error)) !=
            ENF_OK ||
        (result = enf_gl_upload_textures(made, error)) != ENF_OK) {
        enf_gl_destroy(made);
        return result;
    }
    *gl = made;
    return ENF_OK;
}

void enf_gl_destroy(EnfGl *gl) {
    if (!gl) {
        return;
    }
    enf_gl_free_textures(gl);
    enf_gl_free_geometry(gl);
    enf_gl_programs_destroy(&gl->f, gl->programs);
    enf_free(NULL, gl, 1, sizeof *gl);
}

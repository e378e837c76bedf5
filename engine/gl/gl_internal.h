/* What the files of this room share: the GL objects of one map. */
#ifndef ENFILADE_GL_INTERNAL_H
#define ENFILADE_GL_INTERNAL_H

#include "gl/bake.h"
#include "gl/gl_functions.h"
#include "gl/mover_lights.h"
#include "gl/shader.h"

/** A buffer read by texelFetch. */
typedef struct EnfGlTable {
    GLuint buffer, texture;
} EnfGlTable;

struct EnfGl {
    EnfGlFunctions f;
    const EnfMap *map;
    GLint max_table, max_texture; /**< limits of the driver */
    GLuint vertex_array, vertex_buffer, light_buffer, light_uv_buffer, index_buffer;
    GLuint line_array, line_buffer;
    GLuint mover_array; /**< the same vertices with normals; 0: the map has no meshes */
    EnfGlTable offsets, clusters;
    EnfGlLights lights; /**< for moving objects: of the cells */
    EnfGlAmbient ambient;
    bool lamps;
    EnfGlMoverLights mover_lights; /**< of the object drawn last */
    GLuint light_map;              /**< 0: all light is at the vertices */
    float light_map_scale[2];      /**< 1/32 texel → texture coordinates */
    float (*offset_staging)[4];    /**< a cell; only those of the list drawn are current */
    GLsizei *counts;               /**< a cluster: arguments of a multi-draw */
    const void **starts;
    GLuint *images;   /**< a texture for each image of the map */
    GLuint *samplers; /**< a sampler for each texture of the map */
    GLuint white;     /**< one white texel, for materials without texture */
    EnfGlProgram programs[ENF_GL_PROGRAM_COUNT];
};

/** upload.c: buffers and tables. */
EnfResult enf_gl_upload_geometry(EnfGl *gl, EnfError *error);
void enf_gl_free_geometry(EnfGl *gl);
/** textures.c: images, mipmaps and samplers. */
EnfResult enf_gl_upload_textures(EnfGl *gl, EnfError *error);
void enf_gl_free_textures(EnfGl *gl);

/** render.c: the program that draws a material. */
EnfGlProgramKind enf_gl_program_kind(const EnfMaterial *material, EnfRenderMode mode, bool mover);
/** render.c: prepares programs for the camera of `list` and uploads the offsets of its cells. */
void enf_gl_set_view(EnfGl *gl, const EnfDrawList *list);
/** render.c: the vertices of a batch, and, if it is a mover's, its matrix (and light, if lit) for `program`. */
void enf_gl_set_batch(EnfGl *gl, const EnfGlProgram *program, const EnfDrawList *list, const EnfDrawBatch *batch);
/** render.c: the ranges of a batch with whatever program and state are set. */
void enf_gl_draw_batch(EnfGl *gl, const EnfDrawList *list, const EnfDrawBatch *batch);

/** Reports the first GL error of an upload as SIZE or MEMORY. */
EnfResult enf_gl_check(const EnfGl *gl, const char *what, EnfError *error);

#endif

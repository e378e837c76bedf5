/* Makes the buffers of a map: vertices and indices as the file has them, their light, and the tables that shaders read by
 * texelFetch. */
#include <string.h>

#include "gl/bake.h"
#include "gl/gl_internal.h"

enum { LIGHT_MAP_MAX = 2048 }; /* texels a side: coordinates are 16 bits of 1/32 texel */

/* ---- tables ----------------------------------------------------------------------------------------------------- */

typedef struct TableData {
    const char *name;
    GLenum format;
    const void *texels;
    size_t count, texel_size;
} TableData;

static EnfResult create_table(EnfGl *gl, EnfGlTable *table, const TableData *data, EnfError *error) {
    static const float none[4];
    if (data->count > (size_t)gl->max_table) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "the table of %s has %zu texels; this OpenGL allows %d",
                             data->name, data->count, (int)gl->max_table);
    }
    size_t size = data->count * data->texel_size;
    gl->f.GenBuffers(1, &table->buffer);
    gl->f.BindBuffer(GL_TEXTURE_BUFFER, table->buffer);
    gl->f.BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(size ? size : sizeof none), size ? data->texels : none, GL_STATIC_DRAW);
    gl->f.GenTextures(1, &table->texture);
    gl->f.BindTexture(GL_TEXTURE_BUFFER, table->texture);
    gl->f.TexBuffer(GL_TEXTURE_BUFFER, data->format, table->buffer);
    gl->f.BindTexture(GL_TEXTURE_BUFFER, 0);
    return enf_gl_check(gl, data->name, error);
}

static void free_table(EnfGl *gl, EnfGlTable *table) {
    gl->f.DeleteTextures(1, &table->texture);
    gl->f.DeleteBuffers(1, &table->buffer);
}

/* The cluster of every triangle: the id-buffer looks it up by the triangle's number. */
static EnfResult create_cluster_table(EnfGl *gl, EnfError *error) {
    const EnfMap *map = gl->map;
    size_t triangles = map->indices_count / 3;
    uint32_t *owners = enf_alloc(NULL, triangles + 1, sizeof *owners);
    if (!owners) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the table of triangles");
    }
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        uint32_t first = map->clusters[c].index_first / 3;
        for (uint32_t i = 0; i < map->clusters[c].index_count / 3; i++) {
            owners[first + i] = c;
        }
    }
    TableData data = {"triangles", GL_R32UI, owners, triangles, sizeof *owners};
    EnfResult result = create_table(gl, &gl->clusters, &data, error);
    enf_free(NULL, owners, triangles + 1, sizeof *owners);
    return result;
}

/* ---- light ------------------------------------------------------------------------------------------------------ */

static void create_light_map(EnfGl *gl, const EnfGlBake *bake) {
    const EnfGlFunctions *f = &gl->f;
    f->ActiveTexture(GL_TEXTURE0);
    f->GenTextures(1, &gl->light_map);
    f->BindTexture(GL_TEXTURE_2D, gl->light_map);
    f->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, (GLsizei)bake->width, (GLsizei)bake->height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  bake->texels);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    f->BindTexture(GL_TEXTURE_2D, 0);
    gl->light_map_scale[0] = 1.0f / (32.0f * (float)bake->width);
    gl->light_map_scale[1] = 1.0f / (32.0f * (float)bake->height);
}

static void create_array_buffer(EnfGl *gl, GLuint *name, const void *data, size_t size) {
    gl->f.GenBuffers(1, name);
    gl->f.BindBuffer(GL_ARRAY_BUFFER, *name);
    gl->f.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)size, data, GL_STATIC_DRAW);
}

static EnfResult upload_light(EnfGl *gl, EnfError *error) {
    EnfGlBake bake;
    uint32_t max_size = gl->max_texture < LIGHT_MAP_MAX ? (uint32_t)gl->max_texture : (uint32_t)LIGHT_MAP_MAX;
    EnfResult result = enf_gl_bake_build(&bake, gl->map, max_size, error);
    if (result == ENF_OK) {
        size_t vertices = (size_t)bake.vertex_count + 1;
        create_array_buffer(gl, &gl->light_buffer, bake.vertex_light, vertices * sizeof *bake.vertex_light);
        create_array_buffer(gl, &gl->light_uv_buffer, bake.vertex_uv, vertices * sizeof *bake.vertex_uv);
        if (bake.has_charts) {
            create_light_map(gl, &bake);
        }
        result = enf_gl_check(gl, "the light of this map", error);
        gl->lights = bake.lights; /* kept for what moves */
        memset(&bake.lights, 0, sizeof bake.lights);
        gl->ambient = bake.ambient;
        gl->lamps = bake.lamps;
    }
    enf_gl_bake_free(&bake);
    return result;
}

/* ---- vertices --------------------------------------------------------------------------------------------------- */

static const void *at(size_t offset) {
    return (const void *)(uintptr_t)offset; /* GL's way of saying: so many bytes into the bound buffer */
}

static void set_attributes(EnfGl *gl) {
    const EnfGlFunctions *f = &gl->f;
    const GLsizei stride = sizeof(EnfVertex);
    f->BindBuffer(GL_ARRAY_BUFFER, gl->vertex_buffer);
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, stride, at(offsetof(EnfVertex, position)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_UV, 2, GL_FLOAT, GL_FALSE, stride, at(offsetof(EnfVertex, uv)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, at(offsetof(EnfVertex, color)));
    f->VertexAttribIPointer(ENF_GL_ATTRIBUTE_CELL, 1, GL_UNSIGNED_INT, stride, at(offsetof(EnfVertex, cell)));
    f->BindBuffer(GL_ARRAY_BUFFER, gl->light_buffer);
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_LIGHT, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(uint32_t), at(0));
    f->BindBuffer(GL_ARRAY_BUFFER, gl->light_uv_buffer);
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_LIGHT_UV, 2, GL_UNSIGNED_SHORT, GL_FALSE, 2 * sizeof(uint16_t), at(0));
    for (GLuint i = ENF_GL_ATTRIBUTE_POSITION; i <= ENF_GL_ATTRIBUTE_LIGHT_UV; i++) {
        f->EnableVertexAttribArray(i);
    }
}

/* A mover's vertices: normals instead of light. */
static void create_mover_array(EnfGl *gl) {
    const EnfGlFunctions *f = &gl->f;
    const GLsizei stride = sizeof(EnfVertex);
    f->GenVertexArrays(1, &gl->mover_array);
    f->BindVertexArray(gl->mover_array);
    f->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl->index_buffer);
    f->BindBuffer(GL_ARRAY_BUFFER, gl->vertex_buffer);
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, stride, at(offsetof(EnfVertex, position)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_UV, 2, GL_FLOAT, GL_FALSE, stride, at(offsetof(EnfVertex, uv)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, at(offsetof(EnfVertex, color)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_NORMAL, 4, GL_INT_2_10_10_10_REV, GL_TRUE, stride, at(offsetof(EnfVertex, normal)));
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_POSITION);
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_UV);
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_COLOR);
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_NORMAL);
    f->BindVertexArray(0);
}

static EnfResult upload_vertices(EnfGl *gl, EnfError *error) {
    const EnfGlFunctions *f = &gl->f;
    const EnfMap *map = gl->map;
    f->GenVertexArrays(1, &gl->vertex_array);
    f->BindVertexArray(gl->vertex_array);
    f->GenBuffers(1, &gl->vertex_buffer);
    f->BindBuffer(GL_ARRAY_BUFFER, gl->vertex_buffer);
    f->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(map->vertices_count * sizeof *map->vertices), map->vertices, GL_STATIC_DRAW);
    f->GenBuffers(1, &gl->index_buffer);
    f->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, gl->index_buffer);
    f->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(map->indices_count * sizeof *map->indices), map->indices,
                  GL_STATIC_DRAW);
    set_attributes(gl);
    f->BindVertexArray(0);
    if (map->meshes_count > 0) {
        create_mover_array(gl);
    }
    return enf_gl_check(gl, "the vertices of this map", error);
}

static void create_lines(EnfGl *gl) {
    const EnfGlFunctions *f = &gl->f;
    const GLsizei stride = sizeof(EnfDebugVertex);
    f->GenVertexArrays(1, &gl->line_array);
    f->GenBuffers(1, &gl->line_buffer);
    f->BindVertexArray(gl->line_array);
    f->BindBuffer(GL_ARRAY_BUFFER, gl->line_buffer);
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_POSITION, 3, GL_FLOAT, GL_FALSE, stride,
                           at(offsetof(EnfDebugVertex, position_eye)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, at(offsetof(EnfDebugVertex, rgba)));
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_POSITION);
    f->EnableVertexAttribArray(ENF_GL_ATTRIBUTE_COLOR);
    f->BindVertexArray(0);
}

EnfResult enf_gl_upload_geometry(EnfGl *gl, EnfError *error) {
    const EnfMap *map = gl->map;
    gl->offset_staging = enf_alloc(NULL, (size_t)map->cells_count + 1, sizeof *gl->offset_staging);
    gl->counts = enf_alloc(NULL, (size_t)map->clusters_count + 1, sizeof *gl->counts);
    gl->starts = enf_alloc(NULL, (size_t)map->clusters_count + 1, sizeof *gl->starts);
    if (!gl->offset_staging || !gl->counts || !gl->starts) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the renderer");
    }
    TableData offsets = {"cells", GL_RGBA32F, gl->offset_staging, map->cells_count, sizeof *gl->offset_staging};
    EnfResult result;
    if ((result = create_table(gl, &gl->offsets, &offsets, error)) != ENF_OK ||
        (result = create_cluster_table(gl, error)) != ENF_OK || (result = upload_light(gl, error)) != ENF_OK ||
        (result = upload_vertices(gl, error)) != ENF_OK) {
        return result;
    }
    create_lines(gl);
    return ENF_OK;
}

void enf_gl_free_geometry(EnfGl *gl) {
    const EnfMap *map = gl->map;
    const GLuint buffers[] = {gl->vertex_buffer, gl->light_buffer, gl->light_uv_buffer, gl->index_buffer, gl->line_buffer};
    const GLuint arrays[] = {gl->vertex_array, gl->line_array, gl->mover_array};
    gl->f.DeleteVertexArrays(3, arrays);
    gl->f.DeleteBuffers(5, buffers);
    free_table(gl, &gl->offsets);
    gl->f.DeleteTextures(1, &gl->light_map);
    free_table(gl, &gl->clusters);
    enf_gl_lights_free(&gl->lights);
    enf_free(NULL, gl->offset_staging, (size_t)map->cells_count + 1, sizeof *gl->offset_staging);
    enf_free(NULL, gl->counts, (size_t)map->clusters_count + 1, sizeof *gl->counts);
    enf_free(NULL, gl->starts, (size_t)map->clusters_count + 1, sizeof *gl->starts);
}

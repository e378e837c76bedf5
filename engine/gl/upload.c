/* Makes the buffers of a map: vertices and indices as the file has them, each vertex's list of lights, and the tables
 * that shaders read by texelFetch. */
#include <string.h>

#include "gl/gl_internal.h"

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

/* ---- lights ----------------------------------------------------------------------------------------------------- */

/* Gives each vertex the list of its cluster. A vertex that two clusters share takes the last one's list if the lists
 * differ: `flat` inputs come from one vertex of a triangle, so the choice is the same whatever is culled. */
static EnfResult upload_light_lists(EnfGl *gl, const EnfGlLights *lights, EnfError *error) {
    const EnfMap *map = gl->map;
    uint32_t *lists = enf_alloc(NULL, (size_t)map->vertices_count + 1, sizeof *lists);
    if (!lists) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the lights of vertices");
    }
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *cluster = &map->clusters[c];
        for (uint32_t i = 0; i < cluster->vertex_count; i++) {
            lists[cluster->vertex_first + i] = lights->cluster_lists[c];
        }
    }
    gl->f.GenBuffers(1, &gl->light_list_buffer);
    gl->f.BindBuffer(GL_ARRAY_BUFFER, gl->light_list_buffer);
    gl->f.BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((map->vertices_count + 1) * sizeof *lists), lists, GL_STATIC_DRAW);
    enf_free(NULL, lists, (size_t)map->vertices_count + 1, sizeof *lists);
    return enf_gl_check(gl, "the lights of vertices", error);
}

static EnfResult upload_lights(EnfGl *gl, EnfError *error) {
    EnfGlLights lights;
    EnfResult result = enf_gl_lights_build(&lights, gl->map, error);
    TableData records = {"lights", GL_RGBA32UI, lights.lights, (size_t)lights.light_count * 3, 16};
    TableData planes = {"light windows", GL_RGBA32F, lights.planes, lights.plane_count, 16};
    gl->light_features = (gl->map->lights_count ? ENF_GL_LIGHTS : 0u) | (lights.has_windows ? ENF_GL_WINDOWS : 0u) |
                         (lights.has_spots ? ENF_GL_SPOTS : 0u);
    if (result == ENF_OK && (result = create_table(gl, &gl->lights, &records, error)) == ENF_OK &&
        (result = create_table(gl, &gl->light_planes, &planes, error)) == ENF_OK) {
        result = upload_light_lists(gl, &lights, error);
    }
    enf_gl_lights_free(&lights);
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
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_NORMAL, 4, GL_INT_2_10_10_10_REV, GL_TRUE, stride, at(offsetof(EnfVertex, normal)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_UV, 2, GL_FLOAT, GL_FALSE, stride, at(offsetof(EnfVertex, uv)));
    f->VertexAttribPointer(ENF_GL_ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, at(offsetof(EnfVertex, color)));
    f->VertexAttribIPointer(ENF_GL_ATTRIBUTE_CELL, 1, GL_UNSIGNED_INT, stride, at(offsetof(EnfVertex, cell)));
    f->BindBuffer(GL_ARRAY_BUFFER, gl->light_list_buffer);
    f->VertexAttribIPointer(ENF_GL_ATTRIBUTE_LIGHT_LIST, 1, GL_UNSIGNED_INT, sizeof(uint32_t), at(0));
    for (GLuint i = ENF_GL_ATTRIBUTE_POSITION; i <= ENF_GL_ATTRIBUTE_LIGHT_LIST; i++) {
        f->EnableVertexAttribArray(i);
    }
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
        (result = create_cluster_table(gl, error)) != ENF_OK || (result = upload_lights(gl, error)) != ENF_OK ||
        (result = upload_vertices(gl, error)) != ENF_OK) {
        return result;
    }
    create_lines(gl);
    return ENF_OK;
}

void enf_gl_free_geometry(EnfGl *gl) {
    const EnfMap *map = gl->map;
    const GLuint buffers[] = {gl->vertex_buffer, gl->light_list_buffer, gl->index_buffer, gl->line_buffer};
    const GLuint arrays[] = {gl->vertex_array, gl->line_array};
    gl->f.DeleteVertexArrays(2, arrays);
    gl->f.DeleteBuffers(4, buffers);
    free_table(gl, &gl->offsets);
    free_table(gl, &gl->lights);
    free_table(gl, &gl->light_planes);
    free_table(gl, &gl->clusters);
    enf_free(NULL, gl->offset_staging, (size_t)map->cells_count + 1, sizeof *gl->offset_staging);
    enf_free(NULL, gl->counts, (size_t)map->clusters_count + 1, sizeof *gl->counts);
    enf_free(NULL, gl->starts, (size_t)map->clusters_count + 1, sizeof *gl->starts);
}

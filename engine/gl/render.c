/* Makes a picture, or its id-buffer, from an EnfDrawList: one program and one multi-draw a batch, in the list's order. */
#include <string.h>

#include "gl/gl_internal.h"

/* Visible cells whose numbers differ by at most this much are uploaded in one call: a call costs more than the cells
 * between, whose stale offsets nobody reads. */
enum { OFFSET_GAP = 64 };

/* ---- the view --------------------------------------------------------------------------------------------------- */

/* The cells of a list ascend. */
static void upload_offsets(EnfGl *gl, const EnfDrawList *list) {
    for (uint32_t i = 0; i < list->cell_count; i++) {
        memcpy(gl->offset_staging[list->cells[i].cell], list->cells[i].offset, sizeof list->cells[i].offset);
    }
    gl->f.BindBuffer(GL_TEXTURE_BUFFER, gl->offsets.buffer);
    for (uint32_t i = 0; i < list->cell_count;) {
        uint32_t first = list->cells[i].cell, last = first;
        while (++i < list->cell_count && list->cells[i].cell - last <= OFFSET_GAP) {
            ENF_ASSERT(list->cells[i].cell > last);
            last = list->cells[i].cell;
        }
        gl->f.BufferSubData(GL_TEXTURE_BUFFER, (GLintptr)(first * sizeof *gl->offset_staging),
                            (GLsizeiptr)((last - first + 1) * sizeof *gl->offset_staging), gl->offset_staging[first]);
    }
}

static void bind_table(EnfGl *gl, GLenum unit, const EnfGlTable *table) {
    gl->f.ActiveTexture(GL_TEXTURE0 + unit);
    gl->f.BindTexture(GL_TEXTURE_BUFFER, table->texture);
}

static void set_program_view(EnfGl *gl, const EnfGlProgram *program, const EnfDrawList *list) {
    gl->f.UseProgram(program->name);
    gl->f.UniformMatrix4fv(program->clip_from_eye, 1, GL_FALSE, list->clip_from_eye);
    gl->f.Uniform3fv(program->eye_fraction, 1, list->eye_fraction);
    gl->f.Uniform2fv(program->light_map_scale, 1, gl->light_map_scale);
    gl->f.Uniform3fv(program->ambient, 3, gl->ambient.ground);
    gl->f.Uniform1i(program->lamps, gl->lamps ? 1 : 0);
}

void enf_gl_set_view(EnfGl *gl, const EnfDrawList *list) {
    upload_offsets(gl, list);
    bind_table(gl, ENF_GL_UNIT_OFFSETS, &gl->offsets);
    bind_table(gl, ENF_GL_UNIT_CLUSTERS, &gl->clusters);
    gl->f.ActiveTexture(GL_TEXTURE0 + ENF_GL_UNIT_LIGHT_MAP);
    gl->f.BindTexture(GL_TEXTURE_2D, gl->light_map);
    for (int i = 0; i < ENF_GL_PROGRAM_LINES; i++) {
        if (gl->programs[i].name) {
            set_program_view(gl, &gl->programs[i], list);
        }
    }
    gl->f.BindVertexArray(gl->vertex_array);
}

/* ---- materials -------------------------------------------------------------------------------------------------- */

EnfGlProgramKind enf_gl_program_kind(const EnfMaterial *material, EnfRenderMode mode, bool mover) {
    bool masked = material->alpha_mode == ENF_ALPHA_MASK;
    if (mode == ENF_RENDER_IDS && mover) {
        return masked ? ENF_GL_PROGRAM_MOVER_IDS_MASK : ENF_GL_PROGRAM_MOVER_IDS;
    }
    if (mode == ENF_RENDER_IDS) {
        return masked ? ENF_GL_PROGRAM_IDS_MASK : ENF_GL_PROGRAM_IDS;
    }
    return (EnfGlProgramKind)((mover ? ENF_GL_MOVER : 0) + ENF_GL_PROGRAM_SURFACE +
                              (material->flags & ENF_MATERIAL_UNLIT ? 0 : ENF_GL_LIT) + (masked ? ENF_GL_MASK : 0) +
                              (material->texture != ENF_NONE ? ENF_GL_TEXTURE : 0) +
                              (material->emissive_texture != ENF_NONE ? ENF_GL_GLOW : 0));
}

static void bind_texture(EnfGl *gl, GLenum unit, uint32_t texture) {
    bool has = texture != ENF_NONE;
    gl->f.ActiveTexture(GL_TEXTURE0 + unit);
    gl->f.BindTexture(GL_TEXTURE_2D, has ? gl->images[gl->map->textures[texture].image] : gl->white);
    gl->f.BindSampler(unit, has ? gl->samplers[texture] : 0);
}

static const EnfGlProgram *use_material(EnfGl *gl, const EnfMaterial *material, EnfRenderMode mode, bool mover) {
    const EnfGlFunctions *f = &gl->f;
    const EnfGlProgram *program = &gl->programs[enf_gl_program_kind(material, mode, mover)];
    f->UseProgram(program->name);
    bind_texture(gl, ENF_GL_UNIT_BASE, material->texture);
    bind_texture(gl, ENF_GL_UNIT_EMISSIVE, material->emissive_texture);
    f->Uniform3fv(program->uv_rows, 2, material->uv_transform);
    f->Uniform4fv(program->base_color, 1, material->base_color);
    f->Uniform3fv(program->emissive, 1, material->emissive);
    f->Uniform1f(program->cutoff, material->alpha_cutoff);
    f->Uniform1i(program->two_sided, material->flags & ENF_MATERIAL_DOUBLE_SIDED ? 1 : 0);
    (material->flags & ENF_MATERIAL_DOUBLE_SIDED ? f->Disable : f->Enable)(GL_CULL_FACE);
    return program;
}

/* ---- movers ----------------------------------------------------------------------------------------------------- */

/* A scale of odd sign turns triangles around. */
static bool is_reflected(const float *m) {
    float x = m[4] * m[8] - m[5] * m[7], y = m[5] * m[6] - m[3] * m[8], z = m[3] * m[7] - m[4] * m[6];
    return m[0] * x + m[1] * y + m[2] * z < 0.0f;
}

void enf_gl_set_batch(EnfGl *gl, const EnfGlProgram *program, const EnfDrawList *list, const EnfDrawBatch *batch) {
    const EnfGlFunctions *f = &gl->f;
    bool mover = batch->mover != ENF_NONE;
    f->BindVertexArray(mover ? gl->mover_array : gl->vertex_array);
    f->FrontFace(mover && is_reflected(list->movers[batch->mover].eye_from_model) ? GL_CW : GL_CCW);
    if (mover) {
        const EnfDrawMover *m = &list->movers[batch->mover];
        enf_gl_mover_lights(&gl->mover_lights, &gl->lights, gl->map, m);
        f->Uniform4fv(program->mover, (GLsizei)gl->mover_lights.count, gl->mover_lights.vectors[0]);
        f->Uniform1i(program->object_id, (GLint)(gl->map->clusters_count + m->object + 1));
    }
}

/* ---- batches ---------------------------------------------------------------------------------------------------- */

static const void *index_at(uint32_t index) {
    return (const void *)(uintptr_t)((size_t)index * sizeof(uint32_t));
}

void enf_gl_draw_batch(EnfGl *gl, const EnfDrawList *list, const EnfDrawBatch *batch) {
    const EnfDrawRange *ranges = list->ranges + batch->range_first;
    for (uint32_t i = 0; i < batch->range_count; i++) {
        gl->counts[i] = (GLsizei)ranges[i].index_count;
        gl->starts[i] = index_at(ranges[i].index_first);
    }
    gl->f.MultiDrawElements(GL_TRIANGLES, gl->counts, GL_UNSIGNED_INT, gl->starts, (GLsizei)batch->range_count);
}

/* gl_PrimitiveID begins at 0 in each range, so each must say which triangle of the map its first is. */
static void draw_batch_ids(EnfGl *gl, const EnfGlProgram *program, const EnfDrawList *list, const EnfDrawBatch *batch) {
    for (uint32_t i = 0; i < batch->range_count; i++) {
        const EnfDrawRange *range = &list->ranges[batch->range_first + i];
        gl->f.Uniform1i(program->primitive_first, (GLint)(range->index_first / 3));
        gl->f.DrawElements(GL_TRIANGLES, (GLsizei)range->index_count, GL_UNSIGNED_INT, index_at(range->index_first));
    }
}

static void draw_batches(EnfGl *gl, const EnfDrawList *list, uint32_t first, uint32_t end, EnfRenderMode mode) {
    for (uint32_t i = first; i < end; i++) {
        const EnfDrawBatch *batch = &list->batches[i];
        const EnfMaterial *material = &gl->map->materials[batch->material];
        const EnfGlProgram *program = use_material(gl, material, mode, batch->mover != ENF_NONE);
        enf_gl_set_batch(gl, program, list, batch);
        if (mode == ENF_RENDER_IDS) {
            draw_batch_ids(gl, program, list, batch);
        } else {
            enf_gl_draw_batch(gl, list, batch);
        }
    }
}

static void begin(EnfGl *gl, EnfRenderMode mode) {
    const EnfGlFunctions *f = &gl->f;
    bool color = mode == ENF_RENDER_COLOR;
    (color ? f->Enable : f->Disable)(GL_FRAMEBUFFER_SRGB);
    f->Disable(GL_BLEND);
    f->Enable(GL_DEPTH_TEST);
    f->DepthFunc(GL_LESS); /* of surfaces at one depth the first in the list stays (PITFALLS 33) */
    f->DepthMask(GL_TRUE);
    f->CullFace(GL_BACK);
    f->FrontFace(GL_CCW);
    f->ClearColor(color ? 0.012f : 0.0f, color ? 0.014f : 0.0f, color ? 0.018f : 0.0f, color ? 1.0f : 0.0f);
    f->Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

static void end(EnfGl *gl) {
    const EnfGlFunctions *f = &gl->f;
    f->Disable(GL_CULL_FACE);
    f->FrontFace(GL_CCW);
    f->Disable(GL_BLEND);
    f->DepthMask(GL_TRUE);
    f->BindSampler(ENF_GL_UNIT_BASE, 0);
    f->BindSampler(ENF_GL_UNIT_EMISSIVE, 0);
    f->ActiveTexture(GL_TEXTURE0);
    f->BindVertexArray(0);
    f->UseProgram(0);
}

void enf_gl_draw(EnfGl *gl, const EnfDrawList *list, EnfRenderMode mode) {
    ENF_ASSERT(gl && list);
    begin(gl, mode);
    enf_gl_set_view(gl, list);
    draw_batches(gl, list, 0, list->opaque_batch_count, mode);
    if (mode == ENF_RENDER_COLOR) {
        gl->f.Enable(GL_BLEND);
        gl->f.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        gl->f.DepthMask(GL_FALSE);
    }
    draw_batches(gl, list, list->opaque_batch_count, list->batch_count, mode);
    end(gl);
}

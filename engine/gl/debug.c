/* Draws over a picture what an engineer wants to see: lines, and the clusters and movers of a list as wireframe. */
#include "gl/gl_internal.h"

void enf_gl_draw_lines(EnfGl *gl, const float clip_from_eye[16], const EnfDebugVertex *vertices, uint32_t count, bool through) {
    ENF_ASSERT(gl && (vertices || count == 0));
    if (count == 0) {
        return;
    }
    const EnfGlFunctions *f = &gl->f;
    const EnfGlProgram *program = &gl->programs[ENF_GL_PROGRAM_LINES];
    f->Disable(GL_FRAMEBUFFER_SRGB); /* colours are meant as they look */
    (through ? f->Disable : f->Enable)(GL_DEPTH_TEST);
    f->UseProgram(program->name);
    f->UniformMatrix4fv(program->clip_from_eye, 1, GL_FALSE, clip_from_eye);
    f->BindVertexArray(gl->line_array);
    f->BindBuffer(GL_ARRAY_BUFFER, gl->line_buffer);
    f->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *vertices), vertices, GL_STREAM_DRAW);
    f->DrawArrays(GL_LINES, 0, (GLsizei)count);
    f->BindVertexArray(0);
    f->UseProgram(0);
    f->Enable(GL_DEPTH_TEST);
}

void enf_gl_draw_wireframe(EnfGl *gl, const EnfDrawList *list, uint32_t rgba) {
    ENF_ASSERT(gl && list);
    const EnfGlFunctions *f = &gl->f;
    float color[4];
    for (int i = 0; i < 4; i++) {
        color[i] = (float)(rgba >> (8 * i) & 255u) / 255.0f;
    }
    enf_gl_set_view(gl, list);
    f->Disable(GL_FRAMEBUFFER_SRGB);
    f->Disable(GL_CULL_FACE);
    f->Enable(GL_BLEND); /* thousands of clusters: lines add up to a haze, through which what is drawn stays visible */
    f->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    f->DepthMask(GL_FALSE);
    f->PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (uint32_t i = 0; i < list->batch_count; i++) {
        bool mover = list->batches[i].mover != ENF_NONE;
        const EnfGlProgram *program = &gl->programs[mover ? ENF_GL_PROGRAM_MOVER_FLAT : ENF_GL_PROGRAM_FLAT];
        f->UseProgram(program->name);
        f->Uniform4fv(program->flat_color, 1, color);
        enf_gl_set_batch(gl, program, list, &list->batches[i]);
        enf_gl_draw_batch(gl, list, &list->batches[i]);
    }
    f->PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    f->FrontFace(GL_CCW);
    f->DepthMask(GL_TRUE);
    f->Disable(GL_BLEND);
    f->BindVertexArray(0);
    f->UseProgram(0);
}

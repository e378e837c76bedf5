/* Makes offscreen targets, one frame buffer for each render mode over one depth buffer, and reads them back. */
#include "gl/gl_internal.h"

enum { MODES = 2 };

struct EnfGlTarget {
    EnfGl *gl;
    uint32_t width_px, height_px;
    GLuint frames[MODES], pixels[MODES], depth;
};

static void create_frame(EnfGlTarget *target, EnfRenderMode mode) {
    const EnfGlFunctions *f = &target->gl->f;
    const GLsizei width = (GLsizei)target->width_px, height = (GLsizei)target->height_px;
    f->GenRenderbuffers(1, &target->pixels[mode]);
    f->BindRenderbuffer(GL_RENDERBUFFER, target->pixels[mode]);
    f->RenderbufferStorage(GL_RENDERBUFFER, mode == ENF_RENDER_COLOR ? GL_SRGB8_ALPHA8 : GL_RGBA8, width, height);
    f->GenFramebuffers(1, &target->frames[mode]);
    f->BindFramebuffer(GL_FRAMEBUFFER, target->frames[mode]);
    f->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target->pixels[mode]);
    f->FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target->depth);
}

EnfResult enf_gl_target_create(EnfGl *gl, EnfGlTarget **target, uint32_t width_px, uint32_t height_px, EnfError *error) {
    ENF_ASSERT(gl && target);
    *target = NULL;
    if (width_px == 0 || height_px == 0 || width_px > (uint32_t)gl->max_texture || height_px > (uint32_t)gl->max_texture) {
        return enf_error_set(error, ENF_ERROR_RANGE, UINT64_MAX, "a picture of %u × %u px: 1 to %d are possible", width_px,
                             height_px, (int)gl->max_texture);
    }
    EnfGlTarget *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a target");
    }
    made->gl = gl;
    made->width_px = width_px;
    made->height_px = height_px;
    gl->f.GenRenderbuffers(1, &made->depth);
    gl->f.BindRenderbuffer(GL_RENDERBUFFER, made->depth);
    gl->f.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, (GLsizei)width_px, (GLsizei)height_px);
    bool complete = true;
    for (int mode = 0; mode < MODES; mode++) {
        create_frame(made, (EnfRenderMode)mode);
        complete = complete && gl->f.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }
    if (!complete || enf_gl_check(gl, "an offscreen target", error) != ENF_OK) {
        enf_gl_target_destroy(made);
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OpenGL makes no offscreen target of %u × %u px", width_px,
                             height_px);
    }
    *target = made;
    return ENF_OK;
}

void enf_gl_target_destroy(EnfGlTarget *target) {
    if (!target) {
        return;
    }
    const EnfGlFunctions *f = &target->gl->f;
    f->BindFramebuffer(GL_FRAMEBUFFER, 0);
    f->DeleteFramebuffers(MODES, target->frames);
    f->DeleteRenderbuffers(MODES, target->pixels);
    f->DeleteRenderbuffers(1, &target->depth);
    enf_free(NULL, target, 1, sizeof *target);
}

void enf_gl_target_bind(EnfGlTarget *target, EnfRenderMode mode) {
    target->gl->f.BindFramebuffer(GL_FRAMEBUFFER, target->frames[mode]);
    target->gl->f.Viewport(0, 0, (GLsizei)target->width_px, (GLsizei)target->height_px);
}

/* Without GL_FRAMEBUFFER_SRGB a blit converts nothing, whatever the two sides are (OpenGL 4.4, 18.3.1). */
void enf_gl_target_show(EnfGlTarget *target, uint32_t width_px, uint32_t height_px) {
    const EnfGlFunctions *f = &target->gl->f;
    const GLint width = (GLint)width_px, height = (GLint)height_px;
    bool scaled = width_px != target->width_px || height_px != target->height_px;
    f->Disable(GL_FRAMEBUFFER_SRGB);
    f->BindFramebuffer(GL_READ_FRAMEBUFFER, target->frames[ENF_RENDER_COLOR]);
    f->BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    f->ReadBuffer(GL_COLOR_ATTACHMENT0);
    f->BlitFramebuffer(0, 0, (GLint)target->width_px, (GLint)target->height_px, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                       scaled ? GL_LINEAR : GL_NEAREST);
    f->BindFramebuffer(GL_FRAMEBUFFER, 0);
    f->Viewport(0, 0, width, height);
}

void enf_gl_target_read(EnfGlTarget *target, EnfRenderMode mode, uint8_t *rgba) {
    const EnfGlFunctions *f = &target->gl->f;
    f->BindFramebuffer(GL_FRAMEBUFFER, target->frames[mode]);
    f->ReadBuffer(GL_COLOR_ATTACHMENT0);
    f->PixelStorei(GL_PACK_ALIGNMENT, 1);
    f->ReadPixels(0, 0, (GLsizei)target->width_px, (GLsizei)target->height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

/* Draws a user interface: triangles in pixels, flat or stroked from an atlas of distances. It has a program and buffers of its
 * own and needs no map. */
#include <stddef.h>

#include "gl/gl_functions.h"

struct EnfGlUi {
    EnfGlFunctions f;
    GLuint program, array, buffer, atlas;
    GLint size_px; /* uniform */
};

static const char *const vertex_source = "#version 330 core\n"
                                         "uniform vec2 size_px;\n"
                                         "layout(location = 0) in vec2 place;\n"
                                         "layout(location = 1) in vec2 uv;\n"
                                         "layout(location = 2) in float weight;\n"
                                         "layout(location = 3) in vec4 color;\n"
                                         "out vec2 f_uv;\n"
                                         "out vec4 f_color;\n"
                                         "flat out float f_weight;\n"
                                         "void main() {\n"
                                         "    f_uv = uv;\n"
                                         "    f_weight = weight;\n"
                                         "    f_color = color;\n"
                                         "    gl_Position = vec4(2.0 * place / size_px - 1.0, 0.0, 1.0) * vec4(1, -1, 1, 1);\n"
                                         "}\n";

/* The atlas holds 16 steps a texel; a pixel's share of a texel makes an edge one pixel soft at every size. */
static const char *const fragment_source =
    "#version 330 core\n"
    "uniform sampler2D atlas;\n"
    "in vec2 f_uv;\n"
    "in vec4 f_color;\n"
    "flat in float f_weight;\n"
    "out vec4 pixel;\n"
    "void main() {\n"
    "    float cover = 1.0;\n"
    "    if (f_weight >= 0.0) {\n"
    "        float distance = texture(atlas, f_uv / vec2(textureSize(atlas, 0))).r * (255.0 / 16.0);\n"
    "        float texels = max(max(fwidth(f_uv.x), fwidth(f_uv.y)), 1e-4);\n"
    "        cover = clamp((f_weight - distance) / texels + 0.5, 0.0, 1.0);\n"
    "    }\n"
    "    pixel = vec4(f_color.rgb, f_color.a * cover);\n"
    "}\n";

static GLuint compile(const EnfGlFunctions *f, GLenum stage, const char *source, EnfError *error) {
    GLuint shader = f->CreateShader(stage);
    GLint good = 0;
    f->ShaderSource(shader, 1, &source, NULL);
    f->CompileShader(shader);
    f->GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) {
        return shader;
    }
    char log[400] = "";
    f->GetShaderInfoLog(shader, sizeof log, NULL, log);
    enf_error_set(error, ENF_ERROR_SHADER, UINT64_MAX, "shader of the user interface: %s", log);
    f->DeleteShader(shader);
    return 0;
}

static EnfResult create_program(EnfGlUi *ui, EnfError *error) {
    const EnfGlFunctions *f = &ui->f;
    GLuint vertex = compile(f, GL_VERTEX_SHADER, vertex_source, error);
    GLuint fragment = vertex ? compile(f, GL_FRAGMENT_SHADER, fragment_source, error) : 0;
    GLint good = 0;
    if (fragment) {
        ui->program = f->CreateProgram();
        f->AttachShader(ui->program, vertex);
        f->AttachShader(ui->program, fragment);
        f->LinkProgram(ui->program);
        f->GetProgramiv(ui->program, GL_LINK_STATUS, &good);
        if (!good) {
            char log[400] = "";
            f->GetProgramInfoLog(ui->program, sizeof log, NULL, log);
            enf_error_set(error, ENF_ERROR_SHADER, UINT64_MAX, "program of the user interface: %s", log);
        }
    }
    f->DeleteShader(vertex);
    f->DeleteShader(fragment);
    if (!good) {
        return ENF_ERROR_SHADER;
    }
    ui->size_px = f->GetUniformLocation(ui->program, "size_px");
    f->UseProgram(ui->program);
    f->Uniform1i(f->GetUniformLocation(ui->program, "atlas"), 0);
    f->UseProgram(0);
    return ENF_OK;
}

static void create_array(EnfGlUi *ui) {
    const EnfGlFunctions *f = &ui->f;
    const GLsizei stride = sizeof(EnfUiVertex);
    f->GenVertexArrays(1, &ui->array);
    f->GenBuffers(1, &ui->buffer);
    f->BindVertexArray(ui->array);
    f->BindBuffer(GL_ARRAY_BUFFER, ui->buffer);
    f->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(EnfUiVertex, x_px));
    f->VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(EnfUiVertex, u));
    f->VertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, stride, (const void *)offsetof(EnfUiVertex, weight));
    f->VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, (const void *)offsetof(EnfUiVertex, rgba));
    for (GLuint i = 0; i < 4; i++) {
        f->EnableVertexAttribArray(i);
    }
    f->BindVertexArray(0);
    f->BindBuffer(GL_ARRAY_BUFFER, 0);
}

static void create_atlas(EnfGlUi *ui, const uint8_t *atlas, uint32_t width, uint32_t height) {
    const EnfGlFunctions *f = &ui->f;
    f->GenTextures(1, &ui->atlas);
    f->ActiveTexture(GL_TEXTURE0);
    f->BindTexture(GL_TEXTURE_2D, ui->atlas);
    f->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    f->TexImage2D(GL_TEXTURE_2D, 0, GL_R8, (GLsizei)width, (GLsizei)height, 0, GL_RED, GL_UNSIGNED_BYTE, atlas);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    f->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    f->BindTexture(GL_TEXTURE_2D, 0);
}

EnfResult enf_gl_ui_create(EnfGlUi **ui, EnfGlLoadFn *load, const uint8_t *atlas, uint32_t width, uint32_t height,
                           EnfError *error) {
    ENF_ASSERT(ui && load && atlas && width > 0 && height > 0);
    *ui = NULL;
    EnfGlUi *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the user interface");
    }
    EnfResult result = enf_gl_functions_load(&made->f, load, error);
    if (result != ENF_OK) {
        enf_free(NULL, made, 1, sizeof *made);
        return result;
    }
    if ((result = create_program(made, error)) != ENF_OK) {
        enf_gl_ui_destroy(made);
        return result;
    }
    create_array(made);
    create_atlas(made, atlas, width, height);
    *ui = made;
    return ENF_OK;
}

void enf_gl_ui_destroy(EnfGlUi *ui) {
    if (!ui) {
        return;
    }
    const EnfGlFunctions *f = &ui->f;
    f->DeleteTextures(1, &ui->atlas);
    f->DeleteBuffers(1, &ui->buffer);
    f->DeleteVertexArrays(1, &ui->array);
    f->DeleteProgram(ui->program);
    enf_free(NULL, ui, 1, sizeof *ui);
}

void enf_gl_ui_draw(EnfGlUi *ui, const EnfUiVertex *vertices, uint32_t count, uint32_t width_px, uint32_t height_px) {
    ENF_ASSERT(ui && (vertices || count == 0));
    if (count == 0) {
        return;
    }
    const EnfGlFunctions *f = &ui->f;
    const float size_px[2] = {(float)width_px, (float)height_px};
    f->Disable(GL_FRAMEBUFFER_SRGB); /* colours are meant as they look */
    f->Disable(GL_DEPTH_TEST);
    f->Disable(GL_CULL_FACE);
    f->Enable(GL_BLEND);
    f->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    f->UseProgram(ui->program);
    f->Uniform2fv(ui->size_px, 1, size_px);
    f->ActiveTexture(GL_TEXTURE0);
    f->BindSampler(0, 0);
    f->BindTexture(GL_TEXTURE_2D, ui->atlas);
    f->BindVertexArray(ui->array);
    f->BindBuffer(GL_ARRAY_BUFFER, ui->buffer);
    f->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof *vertices), vertices, GL_STREAM_DRAW);
    f->DrawArrays(GL_TRIANGLES, 0, (GLsizei)count);
    f->BindVertexArray(0);
    f->BindTexture(GL_TEXTURE_2D, 0);
    f->UseProgram(0);
    f->Disable(GL_BLEND);
    f->Enable(GL_DEPTH_TEST);
}

void enf_gl_ui_clear(EnfGlUi *ui, uint32_t width_px, uint32_t height_px, uint32_t rgba) {
    const EnfGlFunctions *f = &ui->f;
    f->Disable(GL_FRAMEBUFFER_SRGB);
    f->Viewport(0, 0, (GLsizei)width_px, (GLsizei)height_px);
    f->ClearColor((float)(rgba & 255u) / 255.0f, (float)(rgba >> 8 & 255u) / 255.0f, (float)(rgba >> 16 & 255u) / 255.0f, 1.0f);
    f->Clear(GL_COLOR_BUFFER_BIT);
}

void enf_gl_ui_read(EnfGlUi *ui, uint32_t width_px, uint32_t height_px, uint8_t *rgba) {
    const EnfGlFunctions *f = &ui->f;
    f->BindFramebuffer(GL_FRAMEBUFFER, 0);
    f->ReadBuffer(GL_BACK);
    f->PixelStorei(GL_PACK_ALIGNMENT, 1);
    f->ReadPixels(0, 0, (GLsizei)width_px, (GLsizei)height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

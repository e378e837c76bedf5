/* The OpenGL 3.3 functions used here, X(name without gl, type): one table makes the struct and the loader. */
#ifndef ENFILADE_GL_FUNCTIONS_H
#define ENFILADE_GL_FUNCTIONS_H

#include <GL/glcorearb.h>

#include <enfilade/gl.h>

#define ENF_GL_FUNCTIONS(X)                                                                                                    \
    X(ActiveTexture, PFNGLACTIVETEXTUREPROC)                                                                                   \
    X(AttachShader, PFNGLATTACHSHADERPROC)                                                                                     \
    X(BindBuffer, PFNGLBINDBUFFERPROC)                                                                                         \
    X(BindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                                                                               \
    X(BindRenderbuffer, PFNGLBINDRENDERBUFFERPROC)                                                                             \
    X(BindSampler, PFNGLBINDSAMPLERPROC)                                                                                       \
    X(BindTexture, PFNGLBINDTEXTUREPROC)                                                                                       \
    X(BindVertexArray, PFNGLBINDVERTEXARRAYPROC)                                                                               \
    X(BlendFuncSeparate, PFNGLBLENDFUNCSEPARATEPROC)                                                                           \
    X(BlitFramebuffer, PFNGLBLITFRAMEBUFFERPROC)                                                                               \
    X(BufferData, PFNGLBUFFERDATAPROC)                                                                                         \
    X(BufferSubData, PFNGLBUFFERSUBDATAPROC)                                                                                   \
    X(CheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)                                                                 \
    X(Clear, PFNGLCLEARPROC)                                                                                                   \
    X(ClearColor, PFNGLCLEARCOLORPROC)                                                                                         \
    X(CompileShader, PFNGLCOMPILESHADERPROC)                                                                                   \
    X(CreateProgram, PFNGLCREATEPROGRAMPROC)                                                                                   \
    X(CreateShader, PFNGLCREATESHADERPROC)                                                                                     \
    X(CullFace, PFNGLCULLFACEPROC)                                                                                             \
    X(DeleteBuffers, PFNGLDELETEBUFFERSPROC)                                                                                   \
    X(DeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)                                                                         \
    X(DeleteProgram, PFNGLDELETEPROGRAMPROC)                                                                                   \
    X(DeleteRenderbuffers, PFNGLDELETERENDERBUFFERSPROC)                                                                       \
    X(DeleteSamplers, PFNGLDELETESAMPLERSPROC)                                                                                 \
    X(DeleteShader, PFNGLDELETESHADERPROC)                                                                                     \
    X(DeleteTextures, PFNGLDELETETEXTURESPROC)                                                                                 \
    X(DeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)                                                                         \
    X(DepthFunc, PFNGLDEPTHFUNCPROC)                                                                                           \
    X(DepthMask, PFNGLDEPTHMASKPROC)                                                                                           \
    X(Disable, PFNGLDISABLEPROC)                                                                                               \
    X(DrawArrays, PFNGLDRAWARRAYSPROC)                                                                                         \
    X(DrawElements, PFNGLDRAWELEMENTSPROC)                                                                                     \
    X(Enable, PFNGLENABLEPROC)                                                                                                 \
    X(EnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC)                                                               \
    X(Finish, PFNGLFINISHPROC)                                                                                                 \
    X(FramebufferRenderbuffer, PFNGLFRAMEBUFFERRENDERBUFFERPROC)                                                               \
    X(FrontFace, PFNGLFRONTFACEPROC)                                                                                           \
    X(GenBuffers, PFNGLGENBUFFERSPROC)                                                                                         \
    X(GenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                                                                               \
    X(GenRenderbuffers, PFNGLGENRENDERBUFFERSPROC)                                                                             \
    X(GenSamplers, PFNGLGENSAMPLERSPROC)                                                                                       \
    X(GenTextures, PFNGLGENTEXTURESPROC)                                                                                       \
    X(GenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                                                                               \
    X(GenerateMipmap, PFNGLGENERATEMIPMAPPROC)                                                                                 \
    X(GetError, PFNGLGETERRORPROC)                                                                                             \
    X(GetIntegerv, PFNGLGETINTEGERVPROC)                                                                                       \
    X(GetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)                                                                           \
    X(GetProgramiv, PFNGLGETPROGRAMIVPROC)                                                                                     \
    X(GetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)                                                                             \
    X(GetShaderiv, PFNGLGETSHADERIVPROC)                                                                                       \
    X(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)                                                                         \
    X(LinkProgram, PFNGLLINKPROGRAMPROC)                                                                                       \
    X(MultiDrawElements, PFNGLMULTIDRAWELEMENTSPROC)                                                                           \
    X(PixelStorei, PFNGLPIXELSTOREIPROC)                                                                                       \
    X(PolygonMode, PFNGLPOLYGONMODEPROC)                                                                                       \
    X(ReadBuffer, PFNGLREADBUFFERPROC)                                                                                         \
    X(ReadPixels, PFNGLREADPIXELSPROC)                                                                                         \
    X(RenderbufferStorage, PFNGLRENDERBUFFERSTORAGEPROC)                                                                       \
    X(SamplerParameteri, PFNGLSAMPLERPARAMETERIPROC)                                                                           \
    X(ShaderSource, PFNGLSHADERSOURCEPROC)                                                                                     \
    X(TexBuffer, PFNGLTEXBUFFERPROC)                                                                                           \
    X(TexImage2D, PFNGLTEXIMAGE2DPROC)                                                                                         \
    X(TexParameteri, PFNGLTEXPARAMETERIPROC)                                                                                   \
    X(Uniform1f, PFNGLUNIFORM1FPROC)                                                                                           \
    X(Uniform1i, PFNGLUNIFORM1IPROC)                                                                                           \
    X(Uniform2fv, PFNGLUNIFORM2FVPROC)                                                                                         \
    X(Uniform3fv, PFNGLUNIFORM3FVPROC)                                                                                         \
    X(Uniform4fv, PFNGLUNIFORM4FVPROC)                                                                                         \
    X(UniformMatrix4fv, PFNGLUNIFORMMATRIX4FVPROC)                                                                             \
    X(UseProgram, PFNGLUSEPROGRAMPROC)                                                                                         \
    X(VertexAttribIPointer, PFNGLVERTEXATTRIBIPOINTERPROC)                                                                     \
    X(VertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC)                                                                       \
    X(Viewport, PFNGLVIEWPORTPROC)

typedef struct EnfGlFunctions {
#define ENF_GL_MEMBER(name, type) type name;
    ENF_GL_FUNCTIONS(ENF_GL_MEMBER)
#undef ENF_GL_MEMBER
} EnfGlFunctions;

/** Loads every function; CONTEXT names the first that is missing. */
EnfResult enf_gl_functions_load(EnfGlFunctions *functions, EnfGlLoadFn *load, EnfError *error);

#endif

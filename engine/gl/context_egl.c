/* A context through EGL without any surface: EGL_MESA_platform_surfaceless, then framebuffer objects only. */
#ifdef ENF_HAVE_EGL

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <string.h>

#include "gl/context_internal.h"

/* X(name, type): the entry points used, from libEGL itself. */
#define ENF_EGL_FUNCTIONS(X)                                                                                                   \
    X(GetProcAddress, PFNEGLGETPROCADDRESSPROC)                                                                                \
    X(Initialize, PFNEGLINITIALIZEPROC)                                                                                        \
    X(BindAPI, PFNEGLBINDAPIPROC)                                                                                              \
    X(ChooseConfig, PFNEGLCHOOSECONFIGPROC)                                                                                    \
    X(CreateContext, PFNEGLCREATECONTEXTPROC)                                                                                  \
    X(DestroyContext, PFNEGLDESTROYCONTEXTPROC)                                                                                \
    X(MakeCurrent, PFNEGLMAKECURRENTPROC)                                                                                      \
    X(GetError, PFNEGLGETERRORPROC)

static struct {
#define ENF_EGL_MEMBER(name, type) type name;
    ENF_EGL_FUNCTIONS(ENF_EGL_MEMBER)
#undef ENF_EGL_MEMBER
    bool loaded;
} egl;

static bool load_library(void) {
    static const char *const names[] = {"libEGL.so.1", "libEGL.so", NULL};
    if (!egl.loaded) {
        void *library = enf_context_library(names);
        egl.loaded = library != NULL;
#define ENF_EGL_LOAD(name, type) egl.loaded = egl.loaded && enf_context_symbol(library, "egl" #name, &egl.name);
        ENF_EGL_FUNCTIONS(ENF_EGL_LOAD)
#undef ENF_EGL_LOAD
    }
    return egl.loaded;
}

static void *load_function(const char *name) {
    void (*function)(void) = egl.GetProcAddress(name);
    void *address;
    memcpy(&address, &function, sizeof address);
    return address;
}

static EGLDisplay open_display(void) {
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display;
    void *address = load_function("eglGetPlatformDisplayEXT");
    memcpy(&get_display, &address, sizeof address);
    EGLDisplay display = get_display ? get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    if (display == EGL_NO_DISPLAY || !egl.Initialize(display, NULL, NULL)) {
        return EGL_NO_DISPLAY;
    }
    return display;
}

static EGLContext open_context(EGLDisplay display) {
    static const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    if (!egl.BindAPI(EGL_OPENGL_API) || !egl.ChooseConfig(display, wanted, &config, 1, &count) || count == 0) {
        return EGL_NO_CONTEXT;
    }
    EGLContext handle = egl.CreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (handle != EGL_NO_CONTEXT && !egl.MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, handle)) {
        egl.DestroyContext(display, handle);
        return EGL_NO_CONTEXT;
    }
    return handle;
}

/* The display stays open: it is the process's, and terminating it would end it for everyone. */
static void destroy(EnfContext *context) {
    egl.MakeCurrent(context->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.DestroyContext(context->display, context->handle);
}

EnfResult enf_context_open_egl(EnfContext *context, EnfError *error) {
    if (!load_library()) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "libEGL is not installed");
    }
    context->display = open_display();
    if (context->display == EGL_NO_DISPLAY) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "EGL has no surfaceless display (error 0x%x)",
                             (unsigned)egl.GetError());
    }
    context->handle = open_context(context->display);
    if (context->handle == EGL_NO_CONTEXT) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "EGL has no OpenGL 3.3 core context (error 0x%x)",
                             (unsigned)egl.GetError());
    }
    context->name = "egl";
    context->load = load_function;
    context->destroy = destroy;
    return ENF_OK;
}

#else
typedef int EnfNoEgl; /* ISO C wants a declaration in every file */
#endif

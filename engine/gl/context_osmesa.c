/* A context through OSMesa: Mesa's software renderer into plain memory, without any window system or driver. */
#ifdef ENF_HAVE_OSMESA

#include <GL/osmesa.h>
#include <string.h>

#include "gl/context_internal.h"

enum { WINDOW_PX = 16 }; /* OSMesa wants a window; pictures are drawn into framebuffer objects */

/* X(name, result, parameters): the entry points used. */
#define ENF_OSMESA_FUNCTIONS(X)                                                                                                \
    X(CreateContextAttribs, OSMesaContext, (const int *, OSMesaContext))                                                       \
    X(DestroyContext, void, (OSMesaContext))                                                                                   \
    X(MakeCurrent, GLboolean, (OSMesaContext, void *, GLenum, GLsizei, GLsizei))                                               \
    X(GetProcAddress, OSMESAproc, (const char *))

static struct {
#define ENF_OSMESA_MEMBER(name, type, parameters) type(*name) parameters;
    ENF_OSMESA_FUNCTIONS(ENF_OSMESA_MEMBER)
#undef ENF_OSMESA_MEMBER
    bool loaded;
} osmesa;

static bool load_library(void) {
    static const char *const names[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", NULL};
    if (!osmesa.loaded) {
        void *library = enf_context_library(names);
        osmesa.loaded = library != NULL;
#define ENF_OSMESA_LOAD(name, type, parameters)                                                                                \
    osmesa.loaded = osmesa.loaded && enf_context_symbol(library, "OSMesa" #name, &osmesa.name);
        ENF_OSMESA_FUNCTIONS(ENF_OSMESA_LOAD)
#undef ENF_OSMESA_LOAD
    }
    return osmesa.loaded;
}

static void *load_function(const char *name) {
    OSMESAproc function = osmesa.GetProcAddress(name);
    void *address;
    memcpy(&address, &function, sizeof address);
    return address;
}

static void destroy(EnfContext *context) {
    osmesa.MakeCurrent(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
    osmesa.DestroyContext(context->handle);
    enf_free(NULL, context->pixels, WINDOW_PX * WINDOW_PX, 4);
}

EnfResult enf_context_open_osmesa(EnfContext *context, EnfError *error) {
    static const int attributes[] = {OSMESA_FORMAT,
                                     OSMESA_RGBA,
                                     OSMESA_DEPTH_BITS,
                                     24,
                                     OSMESA_PROFILE,
                                     OSMESA_CORE_PROFILE,
                                     OSMESA_CONTEXT_MAJOR_VERSION,
                                     3,
                                     OSMESA_CONTEXT_MINOR_VERSION,
                                     3,
                                     0};
    if (!load_library()) {
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "libOSMesa is not installed");
    }
    context->pixels = enf_alloc(NULL, WINDOW_PX * WINDOW_PX, 4);
    context->handle = context->pixels ? osmesa.CreateContextAttribs(attributes, NULL) : NULL;
    if (!context->handle || !osmesa.MakeCurrent(context->handle, context->pixels, GL_UNSIGNED_BYTE, WINDOW_PX, WINDOW_PX)) {
        if (context->handle) {
            osmesa.DestroyContext(context->handle);
        }
        enf_free(NULL, context->pixels, WINDOW_PX * WINDOW_PX, 4);
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OSMesa has no OpenGL 3.3 core context");
    }
    context->name = "osmesa";
    context->load = load_function;
    context->destroy = destroy;
    return ENF_OK;
}

#else
typedef int EnfNoOsmesa; /* ISO C wants a declaration in every file */
#endif

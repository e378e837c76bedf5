/* Makes a current headless context: EGL surfaceless, else OSMesa. The libraries are opened at run time: where one is
 * missing the other still works, and both define the gl functions, so linking both would mix them. */
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "gl/context_internal.h"

#if defined(__SANITIZE_ADDRESS__)
#define ENF_LEAKS_ARE_LOOKED_FOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ENF_LEAKS_ARE_LOOKED_FOR
#endif
#endif
#ifdef ENF_LEAKS_ARE_LOOKED_FOR
/* Mesa keeps some blocks for ever (22.3: OSMesa's window, what LLVM's drivers register); they are not ours to free. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libOSMesa\nleak:libEGL\nleak:libGLX\nleak:_dri.so\nleak:libgallium\nleak:libLLVM\n";
}
#endif

/* llvmpipe with vectors of 512 bits crashes in LLVM 15 (PITFALLS 32). */
static void avoid_wide_vectors(void) {
    const char *width = getenv("LP_NATIVE_VECTOR_WIDTH");
    if (width && strtol(width, NULL, 10) > 256) {
        enf_log(ENF_LOG_WARNING, "LP_NATIVE_VECTOR_WIDTH=%s crashes llvmpipe: 256 is used", width);
        setenv("LP_NATIVE_VECTOR_WIDTH", "256", 1);
    }
}

void *enf_context_library(const char *const *names) {
    for (; *names; names++) {
        void *library = dlopen(*names, RTLD_NOW | RTLD_LOCAL);
        if (library) {
            return library;
        }
    }
    return NULL;
}

bool enf_context_symbol(void *library, const char *symbol, void *out) {
    void *address = dlsym(library, symbol);
    memcpy(out, &address, sizeof address);
    return address != NULL;
}

#ifndef ENF_HAVE_EGL
EnfResult enf_context_open_egl(EnfContext *context, EnfError *error) {
    (void)context;
    return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "built without EGL");
}
#endif

#ifndef ENF_HAVE_OSMESA
EnfResult enf_context_open_osmesa(EnfContext *context, EnfError *error) {
    (void)context;
    return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "built without OSMesa");
}
#endif

static EnfResult open_any(EnfContext *context, EnfError *error) {
    EnfError egl_error = {0}, osmesa_error = {0};
    if (enf_context_open_egl(context, &egl_error) == ENF_OK) {
        return ENF_OK;
    }
    if (enf_context_open_osmesa(context, &osmesa_error) == ENF_OK) {
        return ENF_OK;
    }
    return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "no headless OpenGL: %.200s; %.200s", egl_error.message,
                         osmesa_error.message);
}

EnfResult enf_context_create(EnfContext **context, EnfContextKind kind, EnfError *error) {
    ENF_ASSERT(context);
    *context = NULL;
    avoid_wide_vectors();
    EnfContext *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a context");
    }
    EnfResult result = kind == ENF_CONTEXT_EGL      ? enf_context_open_egl(made, error)
                       : kind == ENF_CONTEXT_OSMESA ? enf_context_open_osmesa(made, error)
                                                    : open_any(made, error);
    if (result != ENF_OK) {
        enf_free(NULL, made, 1, sizeof *made);
        return result;
    }
    *context = made;
    return ENF_OK;
}

void enf_context_destroy(EnfContext *context) {
    if (context) {
        context->destroy(context);
        enf_free(NULL, context, 1, sizeof *context);
    }
}

const char *enf_context_name(const EnfContext *context) {
    return context->name;
}

EnfGlLoadFn *enf_context_loader(const EnfContext *context) {
    return context->load;
}

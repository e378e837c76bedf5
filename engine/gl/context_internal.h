/* What the kinds of headless context have in common. */
#ifndef ENFILADE_GL_CONTEXT_INTERNAL_H
#define ENFILADE_GL_CONTEXT_INTERNAL_H

#include <enfilade/gl.h>

struct EnfContext {
    const char *name;
    EnfGlLoadFn *load;
    void (*destroy)(EnfContext *context);
    void *display, *handle; /**< EGL: display and context; OSMesa: unused and context */
    void *pixels;           /**< OSMesa: the window that nobody sees */
};

/** Each fills `context` and makes it current, or says in `error` why not. */
EnfResult enf_context_open_egl(EnfContext *context, EnfError *error);
EnfResult enf_context_open_osmesa(EnfContext *context, EnfError *error);

/** Opens the first library of `names` (NULL-terminated), or NULL. */
void *enf_context_library(const char *const *names);
/** Copies the address of `symbol` into the function pointer at `out`; false if it is missing. */
bool enf_context_symbol(void *library, const char *symbol, void *out);

#endif

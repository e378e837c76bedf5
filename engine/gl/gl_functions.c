/* Makes the table of GL functions from a context's loader. */
#include "gl/gl_functions.h"

#include <string.h>

EnfResult enf_gl_functions_load(EnfGlFunctions *functions, EnfGlLoadFn *load, EnfError *error) {
    ENF_ASSERT(functions && load);
    void *address;
    /* Copied as bytes: ISO C has no conversion between object and function pointers. */
    _Static_assert(sizeof address == sizeof functions->Clear, "POSIX: both kinds of pointer have one size");
#define ENF_GL_LOAD(name, type)                                                                                                \
    address = load("gl" #name);                                                                                                \
    if (!address) {                                                                                                            \
        return enf_error_set(error, ENF_ERROR_CONTEXT, UINT64_MAX, "OpenGL 3.3 function gl%s is missing", #name);              \
    }                                                                                                                          \
    memcpy(&functions->name, &address, sizeof address);
    ENF_GL_FUNCTIONS(ENF_GL_LOAD)
#undef ENF_GL_LOAD
    return ENF_OK;
}

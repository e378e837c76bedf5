/* A growing text. */
#ifndef ENFILADE_COMPILE_TEXT_H
#define ENFILADE_COMPILE_TEXT_H

#include "compile/array.h"

/** Zero-initialise; free(text.data). After running out of memory it stays as it is and `failed`. */
typedef struct EnfText {
    char *data;
    uint32_t count, capacity; /**< bytes, without the zero after them */
    bool failed;
} EnfText;

/** Appends as printf. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void enf_text_put(EnfText *text, const char *format, ...);

/** Appends bytes as XML character data: markup escaped, control characters dropped. */
void enf_text_put_xml(EnfText *text, const char *bytes, size_t length);

#endif

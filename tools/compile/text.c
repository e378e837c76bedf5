/* A growing text; see text.h. */
#include "compile/text.h"

#include <stdio.h>

void enf_text_put(EnfText *text, const char *format, ...) {
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    bool fits = length >= 0 && !text->failed &&
                enf_array_reserve(&text->data, &text->capacity, (uint64_t)text->count + (uint64_t)length + 1, 1);
    if (fits) {
        vsnprintf(text->data + text->count, (size_t)length + 1, format, again);
        text->count += (uint32_t)length;
    } else {
        text->failed = true;
    }
    va_end(again);
}

void enf_text_put_xml(EnfText *text, const char *bytes, size_t length) {
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)bytes[i];
        switch (c) {
        case '<':
            enf_text_put(text, "&lt;");
            break;
        case '>':
            enf_text_put(text, "&gt;");
            break;
        case '&':
            enf_text_put(text, "&amp;");
            break;
        case '"':
            enf_text_put(text, "&quot;");
            break;
        default:
            if (c >= 0x20 && c != 0x7f) {
                enf_text_put(text, "%c", c);
            }
        }
    }
}

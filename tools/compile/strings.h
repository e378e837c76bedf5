/* The string table of a map: every text once, in the order of first use; offset 0 is "". */
#ifndef ENFILADE_COMPILE_STRINGS_H
#define ENFILADE_COMPILE_STRINGS_H

#include <enfilade/base.h>

typedef struct EnfStrings {
    char *bytes;
    uint32_t count, capacity;
    uint32_t *slots; /* offset + 1, 0 is free */
    uint32_t slot_count, used;
    bool failed; /**< out of memory, or more than 2^31 bytes; every later text is "" */
} EnfStrings;

/** Zero-initialise. The offset of `text` (NULL is ""). Texts longer than 1 MiB are cut at it. */
uint32_t enf_strings_add(EnfStrings *strings, const char *text);
void enf_strings_free(EnfStrings *strings);

#endif

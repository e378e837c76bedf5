/* Taking node names apart. Input: the name as an artist typed it, perhaps made unique by Blender; output: spans of it. */
#include "compile/names.h"

#include <string.h>

static const struct {
    const char *text;
    unsigned near;
} suffixes[ENF_SUFFIX_COUNT] = {{"", 0},
#define ENF_SUFFIX_ROW(name, text, near) {text, near},
                                ENF_SUFFIXES(ENF_SUFFIX_ROW)
#undef ENF_SUFFIX_ROW
};

/* Words that end many node names and are no misspelling of a suffix, though they are near one. */
static const char *const ordinary_words[] = {"roof",  "root",  "door",   "boom",   "broom", "groom", "loom",
                                             "zoom",  "doom",  "roam",   "round",  "sound", "found", "mound",
                                             "hound", "pound", "wound",  "ground", "bond",  "port",  "total",
                                             "metal", "petal", "postal", "mortal", "norma", "parts", "part"};

const char *enf_suffix_text(EnfSuffix suffix) {
    ENF_ASSERT(suffix < ENF_SUFFIX_COUNT);
    return suffixes[suffix].text;
}

static char lower(char c) {
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

int enf_name_compare(const char *a, size_t a_length, const char *b, size_t b_length, bool ignore_case) {
    size_t shorter = a_length < b_length ? a_length : b_length;
    for (size_t i = 0; i < shorter; i++) {
        unsigned char ca = (unsigned char)(ignore_case ? lower(a[i]) : a[i]);
        unsigned char cb = (unsigned char)(ignore_case ? lower(b[i]) : b[i]);
        if (ca != cb) {
            return ca < cb ? -1 : 1;
        }
    }
    return a_length < b_length ? -1 : a_length > b_length;
}

static bool same_word(const char *a, size_t length, const char *word) {
    return enf_name_compare(a, length, word, strlen(word), true) == 0;
}

enum { WORD_MAX = 24 }; /* longer words are no suffix, however spelled */

static unsigned least(unsigned a, unsigned b) {
    return a < b ? a : b;
}

unsigned enf_edit_distance(const char *a, size_t a_length, const char *b, size_t b_length, unsigned limit) {
    size_t gap = a_length > b_length ? a_length - b_length : b_length - a_length;
    if (gap > limit || a_length > WORD_MAX || b_length > WORD_MAX) {
        return limit + 1;
    }
    unsigned d[WORD_MAX + 1][WORD_MAX + 1];
    for (size_t i = 0; i <= a_length; i++) {
        d[i][0] = (unsigned)i;
    }
    for (size_t j = 0; j <= b_length; j++) {
        d[0][j] = (unsigned)j;
    }
    for (size_t i = 1; i <= a_length; i++) {
        for (size_t j = 1; j <= b_length; j++) {
            unsigned change = lower(a[i - 1]) != lower(b[j - 1]);
            d[i][j] = least(d[i - 1][j - 1] + change, least(d[i - 1][j], d[i][j - 1]) + 1);
            bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) {
                d[i][j] = least(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return least(d[a_length][b_length], limit + 1);
}

/* The length of `name` without Blender's ".001", which it appends to make a name unique (three digits or more). */
static size_t length_without_number(const char *name) {
    size_t length = strlen(name), digits = 0;
    while (digits < length && name[length - 1 - digits] >= '0' && name[length - 1 - digits] <= '9') {
        digits++;
    }
    bool numbered = digits >= 3 && digits < length && name[length - 1 - digits] == '.';
    return numbered ? length - digits - 1 : length;
}

static bool is_ordinary(const char *word, size_t length) {
    for (size_t i = 0; i < sizeof ordinary_words / sizeof ordinary_words[0]; i++) {
        if (same_word(word, length, ordinary_words[i])) {
            return true;
        }
    }
    return false;
}

/* The suffix that `word` misspells, or NONE. */
static EnfSuffix nearest_suffix(const char *word, size_t length) {
    EnfSuffix best = ENF_SUFFIX_NONE;
    unsigned best_distance = UINT32_MAX;
    if (is_ordinary(word, length)) {
        return best;
    }
    for (unsigned s = 1; s < ENF_SUFFIX_COUNT; s++) {
        unsigned near = suffixes[s].near;
        unsigned distance = enf_edit_distance(word, length, suffixes[s].text, strlen(suffixes[s].text), near);
        if (near > 0 && distance <= near && distance < best_distance) {
            best = (EnfSuffix)s;
            best_distance = distance;
        }
    }
    return best;
}

EnfNodeName enf_node_name(const char *name) {
    EnfNodeName result = {.text = name, .whole = length_without_number(name)};
    size_t at = result.whole;
    while (at > 0 && name[at - 1] != '-' && name[at - 1] != '_') {
        at--;
    }
    result.base = result.whole;
    if (at > 0) {
        for (unsigned s = 1; s < ENF_SUFFIX_COUNT && result.suffix == ENF_SUFFIX_NONE; s++) {
            if (same_word(name + at, result.whole - at, suffixes[s].text)) {
                result.suffix = (EnfSuffix)s;
                result.base = at - 1;
            }
        }
        if (result.suffix == ENF_SUFFIX_NONE) {
            result.suspect = nearest_suffix(name + at, result.whole - at);
        }
    }
    const char *star = memchr(name, '*', result.base);
    result.starred = star != NULL;
    result.target = star != NULL ? (size_t)(star - name) : result.base;
    return result;
}

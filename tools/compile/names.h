/* Node names by the conventions of DESIGN §6: what a name's suffix makes of its node, and which room it names. */
#ifndef ENFILADE_COMPILE_NAMES_H
#define ENFILADE_COMPILE_NAMES_H

#include <enfilade/base.h>

/** X(NAME, "suffix", near): the suffixes; `near` is the edit distance up to which a misspelling is suspected (0: never, the word
 *  is too short or too common). Those after NOIMP are Godot's others: known, so that nobody is warned of them. */
#define ENF_SUFFIXES(X)                                                                                                        \
    X(ROOM, "room", 1)                                                                                                         \
    X(ROOMGROUP, "roomgroup", 2)                                                                                               \
    X(PORTAL, "portal", 2)                                                                                                     \
    X(BOUND, "bound", 1)                                                                                                       \
    X(COL, "col", 0)                                                                                                           \
    X(COLONLY, "colonly", 2)                                                                                                   \
    X(NOIMP, "noimp", 1)                                                                                                       \
    X(CONVCOL, "convcol", 0)                                                                                                   \
    X(CONVCOLONLY, "convcolonly", 0)                                                                                           \
    X(NAVMESH, "navmesh", 0)                                                                                                   \
    X(OCC, "occ", 0)                                                                                                           \
    X(OCCONLY, "occonly", 0)

typedef enum EnfSuffix {
    ENF_SUFFIX_NONE,
#define ENF_SUFFIX_ENUM(name, text, near) ENF_SUFFIX_##name,
    ENF_SUFFIXES(ENF_SUFFIX_ENUM)
#undef ENF_SUFFIX_ENUM
        ENF_SUFFIX_COUNT
} EnfSuffix;

/** The suffix without its hyphen; "" for NONE. */
const char *enf_suffix_text(EnfSuffix suffix);

/** A name taken apart; the lengths count from its start. `hall*2-portal.001`: whole 13, base 6, target 4, starred. */
typedef struct EnfNodeName {
    const char *text;
    size_t whole;      /**< without Blender's ".001" */
    size_t base;       /**< without the suffix as well */
    size_t target;     /**< of a portal: the part of base before the first '*' */
    bool starred;      /**< base has a '*': the part before it certainly means a room */
    EnfSuffix suffix;  /**< recognised, or NONE */
    EnfSuffix suspect; /**< with NONE: the suffix that this one looks like a misspelling of */
} EnfNodeName;
EnfNodeName enf_node_name(const char *name);

/** Letters to add, drop, change or swap with their neighbour to turn a into b, at most `limit` + 1; ASCII case ignored.
 *  Source: Damerau 1964, in the restricted form (no substring is edited twice). */
unsigned enf_edit_distance(const char *a, size_t a_length, const char *b, size_t b_length, unsigned limit);

/** The order of two names, ASCII case ignored or not; negative, 0 or positive. */
int enf_name_compare(const char *a, size_t a_length, const char *b, size_t b_length, bool ignore_case);

#endif

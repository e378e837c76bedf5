/* What a node's extras say about cells and portals (DESIGN §6: flat keys, as Blender's custom properties export them). */
#ifndef ENFILADE_COMPILE_EXTRAS_H
#define ENFILADE_COMPILE_EXTRAS_H

#include <enfilade/math.h>

enum { ENF_EXTRAS_NAME = 128 }; /**< longest name of a node in extras, with its zero; longer ones name nothing */

typedef struct EnfExtras {
    bool has_priority;
    int32_t priority;                /**< `priority` of a room */
    char portal_to[ENF_EXTRAS_NAME]; /**< `portal_to` (makes a mesh a portal) or `to`: the target room; "" if absent */
    bool makes_portal;               /**< `portal_to` is there */
    char from[ENF_EXTRAS_NAME];      /**< `from`: the source room of a portal that is no child of one */
    char teleport[ENF_EXTRAS_NAME];  /**< `teleport_to`, `portal_to_portal` or `target`: another portal's node or targetname */
    char targetname[ENF_EXTRAS_NAME];
    bool two_way; /**< default true */
    bool active;  /**< default true; false: the portal starts closed */
    bool mirror;
    bool has_transform;
    EnfAffine transform; /**< `transform`: 16 numbers, column-major as glTF's matrices */
} EnfExtras;

/** Reads the keys above out of `json` (an object as text, or ""); what is not there, or of another type, keeps its default. Numbers
 *  count as booleans, as do the strings "true" and "false": Blender has had both. */
EnfExtras enf_extras_read(const char *json);

#endif

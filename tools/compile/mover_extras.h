/* What a node's extras say about how it moves (DESIGN §6; assets/README.md lists the keys). */
#ifndef ENFILADE_COMPILE_MOVER_EXTRAS_H
#define ENFILADE_COMPILE_MOVER_EXTRAS_H

#include "compile/diagnosis.h"

#include <enfilade/map.h>

enum { ENF_MOVER_NAME = 128, ENF_MOVER_STOPS = 32 };

typedef struct EnfMoverExtras {
    char classname[ENF_MOVER_NAME];
    char portal[ENF_MOVER_NAME]; /**< node name of the portal that a door closes, or "" */
    EnfWrap wrap;                /**< default LOOP */
    double phase, validity;      /**< seconds; 0 */
    bool has_axis, has_move;
    EnfVec3 axis, move;             /**< world; of a hinge: default +Y; of a slide: from shut to open */
    double angle, swing_low, speed; /**< degrees, degrees, degrees or metres a second; 0 where absent */
    double stops[ENF_MOVER_STOPS];  /**< of an elevator, metres above rest */
    uint32_t stop_count;
    double max_speed; /**< 0: absent */
    bool solid, locked, dynamic;
} EnfMoverExtras;

/** Reads the keys out of `json` (an object as text, or ""). What is there and makes no sense is told to `diagnosis` (may be NULL)
 *  under the node's name, and keeps its default. */
EnfMoverExtras enf_mover_extras(const char *json, const char *node, EnfDiagnosis *diagnosis);

/** Does the class make its node's mesh something that moves? (`func_`, `prop_`, `item_`, `npc_`) */
bool enf_mover_class(const char *classname);

#endif

/* What the parts of the layout share while it is made: layout_cells.c (roles and cells), layout_openings.c (portal meshes),
 * layout_rooms.c (rooms by name), layout_sides.c (rooms by geometry), layout_link.c (source, target, twin), layout.c (the rest). */
#ifndef ENFILADE_COMPILE_LAYOUT_WORK_H
#define ENFILADE_COMPILE_LAYOUT_WORK_H

#include "compile/extras.h"
#include "compile/layout.h"
#include "compile/layout_patch.h"
#include "compile/names.h"
#include "compile/shell.h"

/** One opening as authored: a planar island of a portal's mesh. */
typedef struct EnfOpening {
    uint32_t node;
    uint32_t extras; /**< in EnfLayoutWork.extras, or ENF_NONE */
    EnfPatch patch;
    uint32_t source, target; /**< cells, ENF_NONE while unknown */
    uint32_t twin;           /**< the opening given on the other side, or ENF_NONE; the lower of the two gives the polygon */
    uint32_t exit;           /**< a teleport's other portal, or ENF_NONE */
    bool flipped;            /**< the polygon is to be reversed, so that its front is out of source */
    bool dropped;
    bool one_way;
    bool closed;
    bool mirror;
    bool has_transform;
    EnfAffine transform;
} EnfOpening;

typedef struct EnfRoomKey {
    const char *text;
    size_t length;
    uint32_t cell;
    uint32_t rank; /**< 0: the node's whole name; 1: without its number or suffix */
} EnfRoomKey;

typedef struct EnfLayoutWork {
    const EnfSource *source;
    const EnfCompileSettings *settings;
    EnfDiagnosis *diagnosis;
    EnfLayout *layout;
    ENF_ARRAY(EnfLayoutCell) cells;
    ENF_ARRAY(EnfPlane) planes;
    ENF_ARRAY(EnfOpening) openings;
    ENF_ARRAY(EnfExtras) extras;
    ENF_ARRAY(EnfLayoutPortal) portals;
    ENF_ARRAY(EnfGrid3) points;
    EnfPatches patches;
    EnfRoomKey *rooms, *rooms_folded; /**< sorted with case, and without */
    uint32_t room_key_count;
    EnfShells shells;
    EnfKdBuilt cell_tree; /**< over the boxes of the cells, grown by ENF_ROOM_REACH */
} EnfLayoutWork;

/** A portal farther than this (metres) from the surfaces of a room does not belong to it: more than a wall's thickness. */
#define ENF_ROOM_REACH 0.5

/** layout_cells.c: roles, node_cells, cells (named, nested, with bounds of their contents); portals' nodes are marked only. */
bool enf_layout_roles(EnfLayoutWork *work);
bool enf_layout_bounds(EnfLayoutWork *work);
/** Is material `material` one whose faces are portals (`visportal`, `areaportal`)? */
bool enf_material_is_portal(const EnfSource *source, uint32_t material);
/** Are its faces no surfaces at all: portals, and `clip`, which stops bodies only? They are not drawn and close nothing off. */
bool enf_material_is_open(const EnfSource *source, uint32_t material);
/** Can nobody see through its faces (gratings and panes do not seal)? */
bool enf_material_seals(const EnfSource *source, uint32_t material);
/** A primitive's triangle in the world, its winding right for mirrored nodes. */
void enf_source_triangle(const EnfSourceNode *node, const EnfSourcePrimitive *primitive, uint32_t triangle, bool mirrored,
                         EnfVec3 corners[3]);

/** layout_openings.c: openings of portal nodes and portal materials, with what extras say. */
bool enf_layout_openings(EnfLayoutWork *work);

/** layout_rooms.c: cells by name. Warns of two with the same. */
bool enf_layout_index_rooms(EnfLayoutWork *work);
/** Cells that `text` means, best match only, ascending; at most `capacity`. Exact before ASCII case-folded. */
uint32_t enf_layout_find_rooms(const EnfLayoutWork *work, const char *text, size_t length, uint32_t *out, uint32_t capacity);

/** layout_sides.c: which cell lies on a side. Makes shells and cell_tree. */
bool enf_layout_shells(EnfLayoutWork *work);
/** −13..13: of rays from the opening into the half-space along `normal`, those that first see a front of the cell minus those that
 *  see a back, near ones twice. 13 or −13 by the bound, where there is one. */
int enf_layout_side(EnfLayoutWork *work, uint32_t cell, EnfVec3 from, EnfVec3 normal);
/** Does the opening's front look into the cell, as far as seams, or else rays, tell? */
bool enf_layout_looks_into(EnfLayoutWork *work, const EnfPatch *patch, uint32_t cell);
/** The cell that lies on that side of the opening, other than `except`; ENF_NONE if none does. */
uint32_t enf_layout_cell_on_side(EnfLayoutWork *work, const EnfPatch *patch, EnfVec3 normal, uint32_t except);

/** layout_seams.c: metres of the opening's edges at which surfaces of the cell end and run the same way round, minus those where
 *  they run the other way. Positive if the polygon's front is out of the cell, negative if it is into it, near 0 if unknown. */
double enf_layout_seams(EnfLayoutWork *work, uint32_t cell, const EnfPatch *patch);

/** layout_link.c: source, target, orientation and twin of every opening. */
void enf_layout_link(EnfLayoutWork *work);
/** layout_twins.c: which openings are one and the same. */
void enf_layout_twins(EnfLayoutWork *work);
/** layout_teleport.c: openings that lead to other openings, mirrors, and given transforms. */
void enf_layout_teleports(EnfLayoutWork *work);

/** The opening's normal out of its source cell. */
static inline EnfVec3 enf_opening_normal(const EnfOpening *opening) {
    return opening->flipped ? enf_scale(opening->patch.normal, -1.0) : opening->patch.normal;
}
static inline const char *enf_opening_name(const EnfLayoutWork *work, const EnfOpening *opening) {
    return work->source->nodes[opening->node].name;
}
/** layout.c: orders half-portals by source cell, stably, and renumbers twins. @return false if memory is out. */
bool enf_layout_sort_portals(EnfLayoutPortal *portals, uint32_t count, uint32_t cell_count);
const char *enf_layout_cell_name(const EnfLayoutWork *work, uint32_t cell);
/** Attaches the opening's polygon to the finding added last. */
void enf_opening_show(EnfLayoutWork *work, const EnfOpening *opening);

#endif

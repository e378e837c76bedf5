/* What an engineer wants to see over a picture, for every program that shows one. */
#ifndef ENFILADE_INSPECT_H
#define ENFILADE_INSPECT_H

#include <enfilade/gl.h>

/** Lines, or-ed. PYRAMID: of a culling eye that is not the observer's. */
enum { INSPECT_PORTALS = 1, INSPECT_WINDOWS = 4, INSPECT_KD = 8, INSPECT_DBV = 16, INSPECT_PYRAMID = 32 };

/** What is drawn over: the eye that the picture is taken from, and what the culling eye sees (the same one, unless frozen). */
typedef struct Inspect {
    const EnfMap *map;
    const EnfPortals *portals;
    EnfWorld *world;
    const EnfDbvIndex *dbv; /**< or NULL */
    EnfGl *gl;
    const EnfVisSet *set; /**< of the culling eye; its cameras[0] is that eye */
    EnfCamera observer;
    const float *clip_from_eye; /**< of the observer */
    uint32_t what;              /**< INSPECT_* */
} Inspect;

/** Grows with the most ever drawn at once, so that a warm frame calls no heap. Zero at first; free with inspect_free. For one map. */
typedef struct InspectMemory {
    EnfDebugVertex *vertices;
    uint32_t capacity;
    EnfVisEntry *entries;
    uint32_t *objects;
    uint32_t entry_room, object_room;
} InspectMemory;
void inspect_free(InspectMemory *memory);

/** The lines of `what`; into the bound target. ERROR_MEMORY: some are missing. */
EnfResult inspect_draw_lines(const Inspect *inspect, InspectMemory *memory, EnfError *error);
/** Clusters and objects that are not in the set, as wireframe; into the bound target. `draw`: its list is made anew. */
EnfResult inspect_draw_culled(const Inspect *inspect, InspectMemory *memory, EnfDraw *draw, EnfError *error);

/** A colour for a number, far from those of its neighbours; R in the low byte. */
uint32_t inspect_color(uint32_t number);

#endif

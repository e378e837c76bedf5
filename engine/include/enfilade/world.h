/* The state of the running world that visibility depends on. At this stage: portals that open, close and move.
 *
 * A map is immutable; what changes at run time lives here. */
#ifndef ENFILADE_WORLD_H
#define ENFILADE_WORLD_H

#include <enfilade/map.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A half-portal as the traversal uses it: 64 bytes, one cache line; the plane is derived from the points (PITFALLS 15). */
typedef struct EnfPortalState {
    EnfVec3 normal;        /**< unit, out of the source cell; zero for overlap links */
    double d;              /**< normal·p + d = 0, relative to the source cell's origin */
    float slab;            /**< metres: no vertex strays farther from the plane; sides are three-valued */
    uint32_t vertex_first; /**< in EnfPortals.vertices */
    uint16_t vertex_count;
    uint16_t flags; /**< ENF_PORTAL_* ; CLOSED is the current state */
    uint32_t source, target, twin, transform;
} EnfPortalState;

typedef struct EnfPortals {
    const EnfMap *map;
    EnfPortalState *states; /**< one a half-portal of the map, same indices */
    EnfVec3f *vertices;     /**< a copy of map->portal_vertices that may be moved */
    uint32_t count, vertex_count;
    const EnfAllocator *allocator;
} EnfPortals;

EnfResult enf_portals_create(EnfPortals *portals, const EnfMap *map, const EnfAllocator *allocator, EnfError *error);
void enf_portals_destroy(EnfPortals *portals);

/** Opens or closes a half-portal and its twin. Closing stops traversal only; geometry is still drawn (PITFALLS 10). */
void enf_portals_set_open(EnfPortals *portals, uint32_t portal, bool open);
bool enf_portals_is_open(const EnfPortals *portals, uint32_t portal);

/** Moves a half-portal and its twin: `points_ws`, as many as the portal has vertices, front out of `portal`'s source. Rounded to
 *  the cells' storage; planes derived anew. The caller keeps the opening and the geometry in step. */
void enf_portals_move(EnfPortals *portals, uint32_t portal, const EnfVec3 *points_ws);

#ifdef __cplusplus
}
#endif
#endif

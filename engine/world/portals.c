/* Portal state of the running world: copies of the map's half-portals with planes derived from their points (never stored,
 * PITFALLS 15), which may be opened, closed and moved. Source: DESIGN §3. */
#include <enfilade/tolerances.h>
#include <enfilade/world.h>

#include <math.h>
#include <string.h>

static EnfVec3 cell_origin(const EnfMap *map, uint32_t cell) {
    const double *o = map->cells[cell].origin;
    return enf_v3(o[0], o[1], o[2]);
}

/* The plane of the polygon and how far its own vertices stray from it. One grid step is added: an author's vertex was moved by
 * up to that much when it was snapped, so an eye within it is on neither side. */
static void derive_plane(EnfPortals *portals, EnfPortalState *state) {
    state->normal = enf_v3(0.0, 0.0, 0.0);
    state->d = 0.0;
    state->slab = 0.0F;
    if (state->vertex_count == 0) {
        return;
    }
    EnfVec3 points[ENF_POLYGON_MAX];
    for (uint32_t i = 0; i < state->vertex_count; i++) {
        points[i] = enf_v3_from_f(portals->vertices[state->vertex_first + i]);
    }
    EnfPlane plane = enf_plane_from_polygon(points, state->vertex_count);
    double stray = 0.0;
    for (uint32_t i = 0; i < state->vertex_count; i++) {
        stray = fmax(stray, fabs(enf_dot(plane.n, points[i]) + plane.d));
    }
    state->normal = plane.n;
    state->d = plane.d;
    state->slab = (float)(stray + ENF_GRID_STEP) * 1.0001F;
    bool flat = enf_dot(plane.n, plane.n) > 0.5 && stray <= ENF_TOL_PORTAL_FLAT;
    if (!flat) {
        state->flags |= ENF_PORTAL_NONPLANAR;
    }
}

static void derive_state(EnfPortals *portals, uint32_t index) {
    const EnfPortal *record = &portals->map->portals[index];
    EnfPortalState *state = &portals->states[index];
    state->vertex_first = record->vertex_first;
    state->vertex_count = (uint16_t)record->vertex_count;
    state->flags = (uint16_t)record->flags;
    state->source = record->source;
    state->target = record->target;
    state->twin = record->twin;
    state->transform = record->transform;
    derive_plane(portals, state);
}

EnfResult enf_portals_create(EnfPortals *portals, const EnfMap *map, const EnfAllocator *allocator, EnfError *error) {
    memset(portals, 0, sizeof *portals);
    portals->map = map;
    portals->allocator = allocator;
    portals->count = map->portals_count;
    portals->vertex_count = map->portal_vertices_count;
    portals->states = enf_alloc(allocator, portals->count, sizeof *portals->states);
    portals->vertices = enf_alloc(allocator, portals->vertex_count, sizeof *portals->vertices);
    bool missing = (portals->count > 0 && portals->states == NULL) || (portals->vertex_count > 0 && portals->vertices == NULL);
    if (missing) {
        enf_portals_destroy(portals);
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "portal state of %u half-portals", map->portals_count);
    }
    if (portals->vertex_count > 0) {
        memcpy(portals->vertices, map->portal_vertices, portals->vertex_count * sizeof *portals->vertices);
    }
    for (uint32_t i = 0; i < portals->count; i++) {
        derive_state(portals, i);
    }
    return ENF_OK;
}

void enf_portals_destroy(EnfPortals *portals) {
    enf_free(portals->allocator, portals->states, portals->count, sizeof *portals->states);
    enf_free(portals->allocator, portals->vertices, portals->vertex_count, sizeof *portals->vertices);
    memset(portals, 0, sizeof *portals);
}

static void set_closed(EnfPortalState *state, bool closed) {
    uint16_t others = (uint16_t)(state->flags & ~ENF_PORTAL_CLOSED);
    state->flags = closed ? (uint16_t)(others | ENF_PORTAL_CLOSED) : others;
}

void enf_portals_set_open(EnfPortals *portals, uint32_t portal, bool open) {
    ENF_ASSERT(portal < portals->count);
    EnfPortalState *state = &portals->states[portal];
    set_closed(state, !open);
    if (state->twin != ENF_NONE) {
        set_closed(&portals->states[state->twin], !open);
    }
}

bool enf_portals_is_open(const EnfPortals *portals, uint32_t portal) {
    ENF_ASSERT(portal < portals->count);
    return (portals->states[portal].flags & ENF_PORTAL_CLOSED) == 0;
}

/* Stores `points_ws`, optionally in reverse order (a twin's front faces the other way) and mapped by `transform`. */
static void place(EnfPortals *portals, EnfPortalState *state, const EnfVec3 *points_ws, const EnfAffine *transform,
                  bool reverse) {
    EnfVec3 origin = cell_origin(portals->map, state->source);
    for (uint32_t i = 0; i < state->vertex_count; i++) {
        EnfVec3 p = points_ws[reverse ? state->vertex_count - 1U - i : i];
        if (transform != NULL) {
            p = enf_affine_point(transform, p);
        }
        portals->vertices[state->vertex_first + i] = enf_v3f(enf_sub(p, origin));
    }
    uint32_t authored = portals->map->portals[state - portals->states].flags & ENF_PORTAL_NONPLANAR;
    state->flags = (uint16_t)((state->flags & ~ENF_PORTAL_NONPLANAR) | (uint16_t)authored);
    derive_plane(portals, state);
}

void enf_portals_move(EnfPortals *portals, uint32_t portal, const EnfVec3 *points_ws) {
    ENF_ASSERT(portal < portals->count);
    EnfPortalState *state = &portals->states[portal];
    place(portals, state, points_ws, NULL, false);
    if (state->twin == ENF_NONE || portals->states[state->twin].vertex_count != state->vertex_count) {
        return;
    }
    EnfAffine transform = enf_affine_identity();
    if (state->transform != ENF_NONE) {
        const EnfTransform *record = &portals->map->transforms[state->transform];
        memcpy(transform.m, record->m, sizeof transform.m);
        transform.t = enf_v3(record->t[0], record->t[1], record->t[2]);
    }
    place(portals, &portals->states[state->twin], points_ws, &transform, true);
}

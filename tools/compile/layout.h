/* EnfLayout: which cells and portals a level has, and which cell each node belongs to. Made from an EnfSource by the conventions of
 * DESIGN §6 (layout.c and its neighbours); completed after the soup exists (regions.c: loose nodes, reach, overlaps, leaks). */
#ifndef ENFILADE_COMPILE_LAYOUT_H
#define ENFILADE_COMPILE_LAYOUT_H

#include "compile/diagnosis.h"
#include "compile/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Settings of a level project (JSON); every one has a default. */
typedef struct EnfCompileSettings {
    double leak_gap;      /**< metres: openings narrower than this are not looked for (default 0.25) */
    double portal_snap;   /**< metres: half-portals given on both sides are one if their vertices agree within it (0.05) */
    double crease_deg;    /**< reserved for computed normals */
    uint32_t max_image;   /**< larger images are halved until they fit (2048) */
    bool weld_tjunctions; /**< default true */
    bool detect_leaks;    /**< default true */
} EnfCompileSettings;
EnfCompileSettings enf_compile_settings_default(void);

/** What a node is to the compiler. */
typedef enum EnfRole {
    ENF_ROLE_GEOMETRY, /**< its mesh is drawn */
    ENF_ROLE_ROOM,
    ENF_ROLE_PORTAL,
    ENF_ROLE_BOUND,
    ENF_ROLE_COLLISION, /**< -colonly: not drawn */
    ENF_ROLE_IGNORED,   /**< -noimp and its children */
    ENF_ROLE_MARKER,    /**< no mesh */
    ENF_ROLE_MOVER      /**< its mesh moves */
} EnfRole;

typedef struct EnfLayoutCell {
    const char *name; /**< the room node's name as in the file */
    uint32_t node;    /**< in source nodes; ENF_NONE for the one cell of an un-annotated level and for OUTSIDE */
    int32_t priority;
    uint32_t parent;                   /**< the cell it is nested in, or ENF_NONE */
    uint32_t flags;                    /**< ENF_CELL_* */
    EnfGrid3 origin;                   /**< multiple of 16 grid steps (2^-8 m) */
    EnfGrid3 min, max;                 /**< of shell and portals, in the world grid */
    uint32_t bound_first, bound_count; /**< in bound_planes: outward normals, world */
} EnfLayoutCell;

/** A half-portal, sorted by source cell. Front normal out of source. */
typedef struct EnfLayoutPortal {
    const char *name;
    uint32_t node;
    uint32_t source, target, twin;
    uint32_t point_first, point_count; /**< in points, world grid */
    uint32_t flags;                    /**< ENF_PORTAL_* */
    bool has_transform;
    EnfAffine transform;
} EnfLayoutPortal;

/** A soup triangle of another cell, or of none, that closes this one: the cell's own surfaces do not, so it must show this one too. */
typedef struct EnfLayoutGuest {
    uint32_t triangle, cell;
} EnfLayoutGuest;

/** A cluster-to-be's extra cell is found per node or per triangle group in regions.c. */
typedef struct EnfLayout {
    const EnfSource *source; /**< what it was made from; must outlive it */
    EnfLayoutCell *cells;
    uint32_t cell_count; /**< OUTSIDE last, only if needed */
    EnfLayoutPortal *portals;
    uint32_t portal_count;
    EnfGrid3 *points;
    uint32_t point_count;
    EnfPlane *bound_planes;
    uint32_t bound_plane_count;
    EnfRole *roles;       /**< a source node */
    uint32_t *node_cells; /**< a source node's cell, or ENF_NONE: loose */
    uint32_t *
        node_movers; /**< a source node: the node with which it moves (itself, or above it), or ENF_NONE; NULL: nothing moves */
    EnfLayoutGuest *guests; /**< ascending */
    uint32_t guest_count;
} EnfLayout;

EnfResult enf_layout_build(EnfLayout *layout, const EnfSource *source, const EnfCompileSettings *settings,
                           EnfDiagnosis *diagnosis, EnfError *error);
void enf_layout_free(EnfLayout *layout);

struct EnfSoup;
/** After the soup: gives loose triangles a home, appends OUTSIDE if needed, overlap links, OPEN flags; extends cell bounds. Writes
 *  soup->triangles[i].cell for loose ones. */
EnfResult enf_regions_assign(EnfLayout *layout, struct EnfSoup *soup, const EnfSource *source,
                             const EnfCompileSettings *settings, EnfDiagnosis *diagnosis);

/** A set of triangles (a cluster) of home cell `cell`: the other cells it must also be listed in because it reaches into them
 *  (through a portal, or through a wall), ascending, into out[0..capacity). Returns the count (≤ capacity). */
typedef struct EnfReach EnfReach; /**< acceleration over cell shells; made once */
EnfReach *enf_reach_create(const EnfLayout *layout, const struct EnfSoup *soup);
uint32_t enf_reach_query(const EnfReach *reach, const uint32_t *triangles, uint32_t triangle_count, uint32_t cell,
                         uint32_t *out, uint32_t capacity);
/** Warns of every node that the queries so far found deep inside a room that is not its own, once a pair. */
void enf_reach_report(EnfReach *reach, EnfDiagnosis *diagnosis);
void enf_reach_destroy(EnfReach *reach);

#ifdef __cplusplus
}
#endif
#endif

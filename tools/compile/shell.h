/* The surfaces of each cell, to be asked from a point: is it inside, what does a ray meet.
 *
 * A cell's shell is every triangle that belongs to it, furniture too, and (once they are known) its portals, seen from inside. Whoever
 * sees only fronts is inside; the back of a wall is seen from outside only. A shell whose normals all point outward (a cube with a
 * double-sided material) is noticed by its volume and read inside out. */
#ifndef ENFILADE_COMPILE_SHELL_H
#define ENFILADE_COMPILE_SHELL_H

#include <enfilade/kd.h>

enum { ENF_SHELL_AXES = 8, ENF_SHELL_RAYS = 6 };

typedef struct EnfShell {
    EnfVec3 origin;        /**< triangles are relative to it */
    EnfBox3 box;           /**< world; of the triangles, or of the bound */
    uint32_t first, count; /**< in triangles */
    bool inverted;
    const EnfPlane *bound; /**< the convex region that decides instead of rays, if bound_count > 0; not owned */
    uint32_t bound_count;
    uint32_t axis_count; /**< a slab for each of the main directions that its surfaces face */
    EnfVec3 axes[ENF_SHELL_AXES];
    double low[ENF_SHELL_AXES], high[ENF_SHELL_AXES];
    EnfKdBuilt tree; /**< made at the first ray, for large shells only */
    bool has_tree;
} EnfShell;

typedef struct EnfShells {
    EnfShell *cells;
    uint32_t cell_count;
    EnfVec3f (*triangles)[3];
    uint32_t triangle_count;
} EnfShells;

/** The corners of triangle i (world), counter-clockwise from its front; returns its cell, ENF_NONE to leave it out. */
typedef uint32_t EnfShellTriangleFn(const void *user, uint32_t i, EnfVec3 corners[3]);

/** Makes the shells of `cell_count` cells from `triangle_count` triangles, asked for twice. Free with enf_shells_free. One thread at
 *  a time may use them: trees are made when needed. @return false if memory is out. */
bool enf_shells_create(EnfShells *shells, uint32_t cell_count, uint32_t triangle_count, EnfShellTriangleFn *triangle,
                       const void *user);
/** Finds the slabs of every shell, so that enf_shell_near tells more than boxes do. */
void enf_shells_find_slabs(EnfShells *shells);
void enf_shells_free(EnfShells *shells);

/** A cell's convex region, which then decides what is inside; `planes` with outward normals, kept by the caller. */
void enf_shell_set_bound(EnfShell *shell, const EnfPlane *planes, uint32_t count, EnfBox3 box);

typedef struct EnfShellRay {
    EnfVec3 from, direction; /**< world; metres are counted if `direction` is unit */
    double t_min, t_max;
} EnfShellRay;
typedef struct EnfShellHit {
    double t;
    bool front;
} EnfShellHit;
/** The first surface of a cell met between t_min and t_max. A front counts before a back at the same place: the two faces of a sheet. */
bool enf_shell_ray(EnfShells *shells, uint32_t cell, EnfShellRay ray, EnfShellHit *hit);

/** Triangles of a cell (counted from its first) whose boxes may overlap `box`, which is relative to the shell's origin; at most
 *  `capacity`. */
uint32_t enf_shell_overlap(EnfShells *shells, uint32_t cell, EnfBox3 box, uint32_t *out, uint32_t capacity);

/** May a surface of the cell come into `box` (world)? By boxes; never false wrongly. */
bool enf_shell_touches(EnfShells *shells, uint32_t cell, EnfBox3 box);

/** Could a point of `points` lie deeper than `depth` inside the cell? False is certain; cheap. */
bool enf_shell_near_box(const EnfShell *shell, EnfBox3 box, double depth); /**< of points with this box; cheaper still */
bool enf_shell_near(const EnfShell *shell, const EnfVec3 *points, uint32_t count, double depth);

/** Is p inside the cell, and farther than `depth` from its surfaces? Most of six fixed rays must see fronts; `sure`: none may see
 *  a back, and at most one nothing. */
bool enf_shell_inside(EnfShells *shells, uint32_t cell, EnfVec3 p, double depth, bool sure);

/** Do rays from p into the half-space along `normal` see fronts of the cell: two of three at least, and no back? By the bound where
 *  there is one. For the neighbourhood of a surface that itself closes the other half. */
bool enf_shell_open_to(EnfShells *shells, uint32_t cell, EnfVec3 p, EnfVec3 normal);

#endif

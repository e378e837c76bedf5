/* Which openings the doors close. A portal is closed by its doors only if together, at rest, they cover it whole; a door that leaves a
 * gap is a door, and its portal stays open (PITFALLS 10). */
#include "compile/movers.h"

#include <math.h>

enum {
    PROBES = 24,             /* straight lines a side of the opening, by which the leaves are searched for holes */
    EDGE_PROBES = 6,         /* points beside each edge of the opening, from which slanting lines look past the leaves */
    AZIMUTHS = 12,           /* slanting lines around, at each slant */
    TRIANGLES_MAX = 1 << 13, /* of all leaves of one opening: finer ones are not probed, and close nothing */
};
/* Lines times triangles of a level: a hostile one would have more than there is time for, and closes nothing further. */
#define TESTS_MAX (UINT64_C(1) << 32)
/* Tangents of the slants: 45, 76 and 87 degrees from straight through. */
static const double slants[] = {1.0, 4.0, 20.0};
/* Of the way from an edge to the opening's middle: where those points are. */
#define INSET 2e-3
/* Metres: what floats may leave between leaves, or a leaf and its frame, that touch. */
#define SEAM 1e-5
/* Metres: a leaf in front of its opening stands at most this far from it. */
#define DEPTH 0.5
/* Square metres of an opening that its leaves may leave free: rounding. */
#define FREE_AREA 1e-6

/* ---- what is left of an opening --------------------------------------------------------------------------------- */

enum { CORNERS_MAX = 64, PIECES_MAX = 256 };

typedef struct Piece {
    EnfVec3 corners[CORNERS_MAX];
    uint32_t count;
} Piece;

typedef struct Rest {
    Piece pieces[PIECES_MAX];
    uint32_t count;
    bool full; /* too many pieces: taken as not covered */
} Rest;

static double axis_of(EnfVec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* The part of a convex piece on one side of an axis plane: below `at`, or above. */
static Piece cut(const Piece *piece, int axis, double at, bool below) {
    Piece out = {.count = 0};
    for (uint32_t i = 0; i < piece->count; i++) {
        EnfVec3 a = piece->corners[i], b = piece->corners[(i + 1) % piece->count];
        double da = below ? at - axis_of(a, axis) : axis_of(a, axis) - at,
               db = below ? at - axis_of(b, axis) : axis_of(b, axis) - at;
        if (da >= 0.0 && out.count < CORNERS_MAX) {
            out.corners[out.count++] = a;
        }
        if ((da < 0.0) != (db < 0.0) && out.count < CORNERS_MAX) {
            out.corners[out.count++] = enf_add(a, enf_scale(enf_sub(b, a), da / (da - db)));
        }
    }
    return out;
}

static double area(const Piece *piece) {
    EnfVec3 sum = enf_v3(0.0, 0.0, 0.0);
    for (uint32_t i = 1; i + 1 < piece->count; i++) {
        EnfVec3 a = enf_sub(piece->corners[i], piece->corners[0]), b = enf_sub(piece->corners[i + 1], piece->corners[0]);
        sum = enf_add(sum, enf_cross(a, b));
    }
    return 0.5 * enf_length(sum);
}

/* What a box leaves of a piece: on each side of it a piece, and within it nothing. */
static void take_box(Rest *out, Piece piece, EnfBox3 box) {
    for (int side = 0; side < 6 && piece.count >= 3; side++) {
        int axis = side / 2;
        bool high = side % 2;
        double at = high ? axis_of(box.max, axis) : axis_of(box.min, axis);
        Piece outside = cut(&piece, axis, at, !high);
        if (outside.count >= 3 && area(&outside) > FREE_AREA * 1e-3) {
            out->full = out->full || out->count == PIECES_MAX;
            out->pieces[out->count < PIECES_MAX ? out->count++ : 0] = outside;
        }
        piece = cut(&piece, axis, at, high);
    }
}

static void take_boxes(Rest *rest, EnfBox3 box) {
    Rest *next = calloc(1, sizeof *next);
    if (!next) {
        rest->full = true;
        return;
    }
    next->full = rest->full;
    for (uint32_t i = 0; i < rest->count; i++) {
        take_box(next, rest->pieces[i], box);
    }
    *rest = *next;
    free(next);
}

/* ---- the leaves of an opening ----------------------------------------------------------------------------------- */

/* A triangle of a leaf that nothing is seen through. */
typedef struct Pane {
    EnfVec3 a, u, v; /* a corner and the edges from it */
    bool both;       /* seen from behind, too */
} Pane;

/* The doors that are said to close one portal. */
typedef struct Leaves {
    const EnfAssembly *assembly;
    EnfMap map; /* the same: what stands */
    uint32_t portal;
    const uint32_t *movers;
    uint32_t count;
    ENF_ARRAY(Pane) panes;
} Leaves;

static EnfVec3 corner_of(const EnfAssembly *assembly, const EnfAffine *rest, uint32_t index) {
    const float *p = assembly->vertices.data[assembly->indices.data[index]].position;
    return enf_affine_point(rest, enf_v3((double)p[0], (double)p[1], (double)p[2]));
}

/* Of what is drawn and hides what is behind: glass and collision hulls close nothing. */
static bool hides(const EnfAssembly *assembly, const EnfMeshPart *part) {
    const EnfMaterial *material = &assembly->materials.data[part->material];
    return material->alpha_mode == ENF_ALPHA_OPAQUE && !(material->flags & ENF_MATERIAL_NODRAW);
}

/* The box at rest of what hides; `drawn`: of panes of glass, too. */
static EnfBox3 mover_box(const EnfAssembly *assembly, uint32_t mover, bool drawn) {
    EnfBox3 box = enf_box3_empty();
    EnfAffine rest = enf_mover_rest(&assembly->entities.data[assembly->movers.data[mover].entity]);
    const EnfMesh *mesh = &assembly->meshes.data[assembly->movers.data[mover].mesh];
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &assembly->mesh_parts.data[p];
        bool counts = hides(assembly, part) ||
                      (drawn && !(assembly->materials.data[part->material].flags & ENF_MATERIAL_NODRAW));
        for (uint32_t i = 0; i < part->index_count && counts; i++) {
            box = enf_box3_add(box, corner_of(assembly, &rest, part->index_first + i));
        }
    }
    return box;
}

/* The panes of a leaf; false if there are too many or memory is out. */
static bool add_panes(Leaves *leaves, uint32_t mover) {
    const EnfAssembly *assembly = leaves->assembly;
    EnfAffine rest = enf_mover_rest(&assembly->entities.data[assembly->movers.data[mover].entity]);
    const EnfMesh *mesh = &assembly->meshes.data[assembly->movers.data[mover].mesh];
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &assembly->mesh_parts.data[p];
        if (!hides(assembly, part)) {
            continue;
        }
        bool both = (assembly->materials.data[part->material].flags & ENF_MATERIAL_DOUBLE_SIDED) != 0;
        if (part->index_count / 3 > TRIANGLES_MAX - leaves->panes.count ||
            !ENF_ARRAY_ROOM(&leaves->panes, part->index_count / 3)) {
            return false;
        }
        for (uint32_t i = part->index_first; i < part->index_first + part->index_count; i += 3) {
            EnfVec3 a = corner_of(assembly, &rest, i), b = corner_of(assembly, &rest, i + 1);
            EnfVec3 c = corner_of(assembly, &rest, i + 2);
            leaves->panes.data[leaves->panes.count++] = (Pane){a, enf_sub(b, a), enf_sub(c, a), both};
        }
    }
    return true;
}

/* Does the line from `at` along `way` meet the pane between `t_min` and `t_max`, from a side on which whoever looks along `way` sees it?
 * Moller & Trumbore 1997. */
static bool line_meets(const Pane *pane, EnfVec3 at, EnfVec3 way, double t_min, double t_max) {
    EnfVec3 h = enf_cross(way, pane->v), s = enf_sub(at, pane->a), q = enf_cross(s, pane->u);
    double det = enf_dot(pane->u, h); /* positive where the line comes from the front */
    if ((det < 1e-14 && !pane->both) || fabs(det) < 1e-14) {
        return false;
    }
    double x = enf_dot(s, h) / det, y = enf_dot(way, q) / det, t = enf_dot(pane->v, q) / det;
    return x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9 && t >= t_min && t <= t_max;
}

static bool leaves_meet(const Leaves *leaves, EnfVec3 at, EnfVec3 way, double t_min, double t_max) {
    bool met = false;
    for (uint32_t i = 0; i < leaves->panes.count && !met; i++) {
        met = line_meets(&leaves->panes.data[i], at, way, t_min, t_max);
    }
    return met;
}

/* Does what stands before the opening hide it from whoever looks along `way`? What he meets last before it must face him. */
static bool wall_hides(const Leaves *leaves, uint32_t cell, EnfVec3 at, EnfVec3 way, double t_max) {
    EnfRayHit hit;
    if (!enf_map_ray(&leaves->map, cell, at, enf_scale(way, -1.0), t_max, &hit)) {
        return false;
    }
    const EnfMaterial *material = &leaves->map.materials[leaves->map.clusters[hit.cluster].material];
    bool faces = !hit.front || (material->flags & ENF_MATERIAL_DOUBLE_SIDED);
    return faces && material->alpha_mode == ENF_ALPHA_OPAQUE && !(material->flags & ENF_MATERIAL_NODRAW);
}

/* Does somebody in the cell `near` who looks along `way` through the point `at` of the opening meet a leaf before he sees anything that
 * stands beyond it? `way` goes 1 metre through the opening for each of its units. */
static bool line_is_shut(const Leaves *leaves, uint32_t near, uint32_t beyond, EnfVec3 at, EnfVec3 way) {
    if (leaves_meet(leaves, at, way, -DEPTH, SEAM)) {
        return true;
    }
    EnfRayHit hit = {DEPTH, ENF_NONE, ENF_NONE, false};
    enf_map_ray(&leaves->map, beyond, at, way, DEPTH, &hit);
    return leaves_meet(leaves, at, way, -DEPTH, hit.t + SEAM) || wall_hides(leaves, near, at, way, DEPTH);
}

static Piece portal_polygon(const EnfAssembly *assembly, uint32_t portal) {
    const EnfPortal *p = &assembly->portals.data[portal];
    const double *o = assembly->cells.data[p->source].origin;
    Piece piece = {.count = p->vertex_count < CORNERS_MAX ? p->vertex_count : CORNERS_MAX};
    for (uint32_t i = 0; i < piece.count; i++) {
        EnfVec3 v = enf_v3_from_f(assembly->portal_vertices.data[p->vertex_first + i]);
        piece.corners[i] = enf_add(v, enf_v3(o[0], o[1], o[2]));
    }
    return piece;
}

/* A leaf stands before or behind its opening as well as in it: along the opening's normal its box counts as deep. */
static EnfBox3 deepened(EnfBox3 box, EnfVec3 n) {
    EnfVec3 grow = enf_v3(SEAM + DEPTH * fabs(n.x), SEAM + DEPTH * fabs(n.y), SEAM + DEPTH * fabs(n.z));
    return (EnfBox3){enf_sub(box.min, grow), enf_add(box.max, grow)};
}

/* A point of the opening: of a grid over the triangles of its fan. */
static EnfVec3 grid_point(const Piece *polygon, uint32_t probe) {
    uint32_t column = probe % PROBES, row = probe / PROBES;
    double x = ((double)column + 0.5) / PROBES, y = ((double)row + 0.5) / PROBES; /* two numbers in (0, 1) */
    uint32_t triangle = 1 + probe % (polygon->count - 2);
    EnfVec3 a = polygon->corners[0], b = polygon->corners[triangle], c = polygon->corners[triangle + 1];
    double s = sqrt(x);
    return enf_add(enf_add(enf_scale(a, 1.0 - s), enf_scale(b, s * (1.0 - y))), enf_scale(c, s * y));
}

/* Is a line through the opening shut from both sides? */
static bool is_shut(const Leaves *leaves, EnfVec3 at, EnfVec3 way) {
    const EnfPortal *portal = &leaves->assembly->portals.data[leaves->portal];
    return line_is_shut(leaves, portal->source, portal->target, at, way) &&
           line_is_shut(leaves, portal->target, portal->source, at, enf_scale(way, -1.0));
}

/* How many of the slanting lines through a point are free. */
static uint32_t free_slants(const Leaves *leaves, EnfVec3 at, EnfVec3 n, EnfVec3 along) {
    EnfVec3 across = enf_cross(n, along);
    uint32_t count = 0;
    for (uint32_t i = 0; i < AZIMUTHS * (sizeof slants / sizeof *slants); i++) {
        double angle = 2.0 * ENF_PI * (double)(i % AZIMUTHS) / AZIMUTHS, slant = slants[i / AZIMUTHS];
        EnfVec3 aside = enf_add(enf_scale(along, slant * enf_cos(angle)), enf_scale(across, slant * enf_sin(angle)));
        count += !is_shut(leaves, at, enf_add(n, aside));
    }
    return count;
}

/* The share of free lines: straight ones all over the opening, slanting ones beside its edges, where a leaf that stands before it, not
 * in it, would be looked past. `n`: from the source to the target. */
static double free_lines(const Leaves *leaves, const Piece *polygon, EnfVec3 n) {
    uint32_t count = PROBES * PROBES, open = 0;
    EnfVec3 middle = enf_v3(0.0, 0.0, 0.0);
    for (uint32_t probe = 0; probe < PROBES * PROBES; probe++) {
        open += !is_shut(leaves, grid_point(polygon, probe), n);
    }
    for (uint32_t i = 0; i < polygon->count; i++) {
        middle = enf_add(middle, enf_scale(polygon->corners[i], 1.0 / polygon->count));
    }
    for (uint32_t i = 0; i < polygon->count * EDGE_PROBES; i++) {
        EnfVec3 a = polygon->corners[i / EDGE_PROBES], b = polygon->corners[(i / EDGE_PROBES + 1) % polygon->count];
        EnfVec3 edge = enf_sub(b, a), at = enf_add(a, enf_scale(edge, ((double)(i % EDGE_PROBES) + 0.5) / EDGE_PROBES));
        at = enf_add(at, enf_scale(enf_sub(middle, at), INSET));
        open += free_slants(leaves, at, n, enf_normalize(edge));
        count += AZIMUTHS * (uint32_t)(sizeof slants / sizeof *slants);
    }
    return (double)open / count;
}

/* The share of the opening that the leaves' boxes leave free. */
static double outside_boxes(const Leaves *leaves, const Piece *polygon, EnfVec3 n) {
    Rest *rest = calloc(1, sizeof *rest);
    double left = 0.0, whole = area(polygon);
    if (!rest || !(whole > 0.0)) {
        free(rest);
        return 1.0;
    }
    rest->pieces[rest->count++] = *polygon;
    for (uint32_t i = 0; i < leaves->count; i++) {
        take_boxes(rest, deepened(mover_box(leaves->assembly, leaves->movers[i], false), n));
    }
    for (uint32_t i = 0; i < rest->count; i++) {
        left += area(&rest->pieces[i]);
    }
    left = rest->full ? whole : left;
    free(rest);
    return left <= FREE_AREA ? 0.0 : left / whole;
}

/* The share of the opening that the leaves leave free: by their boxes, then by lines through and past them. `tests`: of the level. */
static double free_share(Leaves *leaves, uint64_t *tests) {
    Piece polygon = portal_polygon(leaves->assembly, leaves->portal);
    if (polygon.count < 3 || leaves->assembly->portals.data[leaves->portal].transform != ENF_NONE) {
        return 1.0;
    }
    EnfVec3 n = enf_plane_from_polygon(polygon.corners, polygon.count).n;
    double share = outside_boxes(leaves, &polygon, n);
    bool probed = share <= 0.0;
    for (uint32_t i = 0; i < leaves->count && probed; i++) {
        probed = add_panes(leaves, leaves->movers[i]);
    }
    if (share <= 0.0) {
        uint64_t lines = PROBES * PROBES + (uint64_t)polygon.count * EDGE_PROBES * AZIMUTHS * (sizeof slants / sizeof *slants);
        *tests += 2 * lines * leaves->panes.count;
        share = probed && *tests <= TESTS_MAX ? free_lines(leaves, &polygon, n) : 1.0;
    }
    free(leaves->panes.data);
    return share;
}

/* ---- which portal ----------------------------------------------------------------------------------------------- */

static uint32_t named_portal(const EnfAssembly *assembly, const EnfAssemblyParts *parts, const char *name) {
    EnfNodeName wanted = enf_node_name(name);
    for (uint32_t i = 0; i < assembly->portals.count; i++) {
        EnfNodeName there = enf_node_name(parts->layout->portals[i].name);
        if (enf_name_compare(there.text, there.whole, wanted.text, wanted.whole, true) == 0 ||
            enf_name_compare(there.text, there.base, wanted.text, wanted.whole, true) == 0) {
            return i;
        }
    }
    return ENF_NONE;
}

static EnfBox3 box_of(const Piece *polygon) {
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = 0; i < polygon->count; i++) {
        box = enf_box3_add(box, polygon->corners[i]);
    }
    return box;
}

/* The share of a portal that lies in the box of a door at rest, or in front of it. */
static double covered_share(const EnfAssembly *assembly, uint32_t portal, EnfBox3 box) {
    Piece polygon = portal_polygon(assembly, portal);
    double whole = area(&polygon);
    if (polygon.count < 3 || !(whole > 0.0)) {
        return 0.0;
    }
    EnfBox3 deep = deepened(box, enf_plane_from_polygon(polygon.corners, polygon.count).n);
    for (int side = 0; side < 6 && polygon.count >= 3; side++) {
        int axis = side / 2;
        double at = side % 2 ? axis_of(deep.max, axis) : axis_of(deep.min, axis);
        polygon = cut(&polygon, axis, at, side % 2);
    }
    return polygon.count >= 3 ? area(&polygon) / whole : 0.0;
}

/* The portal of which the door's box at rest covers most, at least a quarter. */
static uint32_t covered_portal(const EnfAssembly *assembly, const EnfBox3 *portal_boxes, uint32_t mover) {
    uint32_t best = ENF_NONE;
    double most = 0.25;
    EnfBox3 box = mover_box(assembly, mover, true), near = deepened(box, enf_v3(1.0, 1.0, 1.0));
    for (uint32_t i = 0; i < assembly->portals.count && !enf_box3_is_empty(box); i++) {
        uint32_t twin = assembly->portals.data[i].twin;
        if ((twin != ENF_NONE && twin < i) || !enf_box3_overlaps(near, portal_boxes[i])) {
            continue;
        }
        double share = covered_share(assembly, i, box);
        if (share > most) {
            most = share;
            best = i;
        }
    }
    return best;
}

static uint32_t portal_of(const EnfMovers *movers, const EnfBox3 *portal_boxes, uint32_t mover) {
    const EnfAssembly *assembly = movers->assembly;
    const EnfSourceNode *source = &movers->parts->source->nodes[movers->nodes.data[mover]];
    EnfMoverExtras extras = enf_mover_extras(source->extras, source->name, NULL);
    bool door = strncmp(extras.classname, "func_door", strlen("func_door")) == 0;
    const EnfMover *m = &assembly->movers.data[mover];
    if (!door || m->mesh == ENF_NONE || (m->kind != ENF_MOVER_HINGE && m->kind != ENF_MOVER_SLIDE)) {
        return ENF_NONE;
    }
    uint32_t portal = extras.portal[0] ? named_portal(assembly, movers->parts, extras.portal)
                                       : covered_portal(assembly, portal_boxes, mover);
    if (extras.portal[0] && portal == ENF_NONE) {
        enf_diagnose(movers->parts->diagnosis, ENF_DIAGNOSIS_DOOR_PORTAL, source->name,
                     "there is no portal '%s' for it to close", extras.portal);
    }
    uint32_t twin = portal == ENF_NONE ? ENF_NONE : assembly->portals.data[portal].twin;
    return twin != ENF_NONE && twin < portal ? twin : portal;
}

/* ---- offered ---------------------------------------------------------------------------------------------------- */

/* A door and the portal that it is said to close. */
typedef struct Claim {
    uint32_t portal, mover;
} Claim;

static int by_portal(const void *a, const void *b) {
    const Claim *p = a, *q = b;
    if (p->portal != q->portal) {
        return p->portal < q->portal ? -1 : 1;
    }
    return p->mover < q->mover ? -1 : p->mover > q->mover;
}

/* The doors of one portal close it, or are told why not. `leaves`: scratch for their movers. */
static void settle(EnfMovers *movers, const Claim *claims, uint32_t count, uint32_t *numbers, uint64_t *tests) {
    EnfAssembly *assembly = movers->assembly;
    for (uint32_t i = 0; i < count; i++) {
        numbers[i] = claims[i].mover;
    }
    Leaves leaves = {assembly, enf_assembly_map(assembly, 0), claims[0].portal, numbers, count, {NULL, 0, 0}};
    double share = free_share(&leaves, tests);
    for (uint32_t i = 0; i < count; i++) {
        if (share <= 0.0) {
            assembly->movers.data[numbers[i]].portal = claims[0].portal;
        } else {
            enf_diagnose(movers->parts->diagnosis, ENF_DIAGNOSIS_DOOR_PORTAL,
                         movers->parts->source->nodes[movers->nodes.data[numbers[i]]].name,
                         "shut, it leaves %.2g %% of portal '%s' free: the portal stays open for sight", 100.0 * share,
                         movers->parts->layout->portals[claims[0].portal].name);
        }
    }
}

bool enf_movers_close_portals(EnfMovers *movers) {
    EnfAssembly *assembly = movers->assembly;
    uint32_t count = 0, mover_count = assembly->movers.count;
    uint64_t tests = 0;
    EnfBox3 *boxes = malloc(((size_t)assembly->portals.count + 1) * sizeof *boxes);
    Claim *claims = malloc(((size_t)mover_count + 1) * sizeof *claims);
    uint32_t *numbers = malloc(((size_t)mover_count + 1) * sizeof *numbers);
    bool ok = boxes && claims && numbers;
    for (uint32_t i = 0; i < assembly->portals.count && ok; i++) {
        Piece polygon = portal_polygon(assembly, i);
        boxes[i] = box_of(&polygon);
    }
    for (uint32_t m = 0; m < mover_count && ok; m++) {
        Claim claim = {portal_of(movers, boxes, m), m};
        claims[count] = claim;
        count += claim.portal != ENF_NONE;
    }
    if (ok) {
        qsort(claims, count, sizeof *claims, by_portal);
    }
    for (uint32_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && claims[end].portal == claims[first].portal; end++) {
        }
        settle(movers, claims + first, end - first, numbers, &tests);
    }
    free(boxes);
    free(claims);
    free(numbers);
    return ok;
}

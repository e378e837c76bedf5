/* Doors: how they swing or slide, and which openings they close. A portal is closed by its doors only if together, at rest, they
 * cover it whole; a door that leaves a gap is a door, and its portal stays open (PITFALLS 10). */
#include "compile/movers.h"

#include <math.h>

/* Rays a side of the opening's box by which the leaves are probed for holes. */
enum { PROBES = 24 };
/* Metres: leaves whose boxes come this near to each other or to the frame leave no gap that a pixel could look through. */
#define SEAM 1e-3
/* Metres: a leaf in front of its opening stands at most this far from it. */
#define DEPTH 0.5
/* Square metres of an opening that its leaves may leave free: rounding. */
#define FREE_AREA 1e-6

/* ---- how it moves ----------------------------------------------------------------------------------------------- */

static void swing(EnfMoverWork *work) {
    EnfMover *mover = &work->mover;
    const EnfMoverExtras *extras = &work->extras;
    const double radians = ENF_PI / 180.0;
    EnfVec3 axis = enf_normalize(extras->axis);
    double angle = extras->angle < 0.0 || extras->angle > 0.0 ? extras->angle : 90.0;
    double other = fabs(extras->swing_low);
    mover->kind = ENF_MOVER_HINGE;
    mover->low = (float)(radians * (angle < 0.0 ? angle : -other));
    mover->high = (float)(radians * (angle < 0.0 ? other : angle));
    mover->rate = (float)(radians * (extras->speed > 0.0 ? extras->speed : 90.0));
    mover->axis[0] = (float)axis.x, mover->axis[1] = (float)axis.y, mover->axis[2] = (float)axis.z;
}

static void slide(EnfMoverWork *work, EnfVec3 move) {
    EnfMover *mover = &work->mover;
    EnfVec3 axis = enf_normalize(move);
    mover->kind = ENF_MOVER_SLIDE;
    mover->high = (float)enf_length(move);
    mover->rate = (float)(work->extras.speed > 0.0 ? work->extras.speed : 1.0);
    mover->axis[0] = (float)axis.x, mover->axis[1] = (float)axis.y, mover->axis[2] = (float)axis.z;
}

static void lift(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    slide(work, enf_v3(0.0, 1.0, 0.0));
    work->mover.high = 0.0f;
    for (uint32_t i = 0; i < extras->stop_count; i++) {
        work->mover.low = fminf(work->mover.low, (float)extras->stops[i]);
        work->mover.high = fmaxf(work->mover.high, (float)extras->stops[i]);
    }
}

void enf_mover_swing(EnfMoverWork *work) {
    const EnfMoverExtras *extras = &work->extras;
    const char *name = work->parts->source->nodes[work->node].name;
    EnfVec3 pivot = work->rest.t;
    work->mover.pivot[0] = pivot.x, work->mover.pivot[1] = pivot.y, work->mover.pivot[2] = pivot.z;
    if (strcmp(extras->classname, "func_door_rotating") == 0) {
        swing(work);
    } else if (strcmp(extras->classname, "func_door") == 0 && extras->has_move) {
        slide(work, extras->move);
    } else if (strcmp(extras->classname, "func_plat") == 0 && extras->stop_count > 0) {
        lift(work);
    } else if (strcmp(extras->classname, "func_door") == 0 || strcmp(extras->classname, "func_plat") == 0) {
        enf_diagnose(work->parts->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, name, "a %s needs '%s': it stands still",
                     extras->classname, strcmp(extras->classname, "func_door") == 0 ? "move" : "stops");
    }
}

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

/* The doors of a portal, found through movers that name it. */
typedef struct Leaves {
    const EnfAssembly *assembly;
    const EnfAssemblyParts *parts;
    const uint32_t *portals; /* by mover: the half-portal that it is said to close, or ENF_NONE */
    uint32_t portal;
} Leaves;

static EnfAffine rest_of(const EnfAssembly *assembly, uint32_t mover) {
    const EnfEntity *e = &assembly->entities.data[assembly->movers.data[mover].entity];
    EnfQuat q = {(double)e->rotation[0], (double)e->rotation[1], (double)e->rotation[2], (double)e->rotation[3]};
    return enf_affine_trs(enf_v3(e->translation[0], e->translation[1], e->translation[2]), q,
                          enf_v3((double)e->scale[0], (double)e->scale[1], (double)e->scale[2]));
}

static EnfVec3 corner_of(const EnfAssembly *assembly, const EnfAffine *rest, uint32_t index) {
    const float *p = assembly->vertices.data[assembly->indices.data[index]].position;
    return enf_affine_point(rest, enf_v3((double)p[0], (double)p[1], (double)p[2]));
}

static EnfBox3 mover_box(const EnfAssembly *assembly, uint32_t mover) {
    EnfBox3 box = enf_box3_empty();
    EnfAffine rest = rest_of(assembly, mover);
    const EnfMesh *mesh = &assembly->meshes.data[assembly->movers.data[mover].mesh];
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &assembly->mesh_parts.data[p];
        for (uint32_t i = 0; i < part->index_count; i++) {
            box = enf_box3_add(box, corner_of(assembly, &rest, part->index_first + i));
        }
    }
    return box;
}

/* Does the line through `at` along `n` meet an opaque triangle of the mover within DEPTH? Moller & Trumbore 1997. */
static bool line_meets(const EnfAssembly *assembly, uint32_t mover, EnfVec3 at, EnfVec3 n) {
    EnfAffine rest = rest_of(assembly, mover);
    const EnfMesh *mesh = &assembly->meshes.data[assembly->movers.data[mover].mesh];
    for (uint32_t p = mesh->part_first; p < mesh->part_first + mesh->part_count; p++) {
        const EnfMeshPart *part = &assembly->mesh_parts.data[p];
        const EnfMaterial *material = &assembly->materials.data[part->material];
        if (material->alpha_mode != ENF_ALPHA_OPAQUE || (material->flags & ENF_MATERIAL_NODRAW)) {
            continue;
        }
        for (uint32_t i = part->index_first; i < part->index_first + part->index_count; i += 3) {
            EnfVec3 a = corner_of(assembly, &rest, i);
            EnfVec3 u = enf_sub(corner_of(assembly, &rest, i + 1), a), v = enf_sub(corner_of(assembly, &rest, i + 2), a);
            EnfVec3 h = enf_cross(n, v), s = enf_sub(at, a), q = enf_cross(s, u);
            double det = enf_dot(u, h);
            if (fabs(det) < 1e-14) {
                continue;
            }
            double x = enf_dot(s, h) / det, y = enf_dot(n, q) / det, t = enf_dot(v, q) / det;
            if (x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9 && fabs(t) <= DEPTH) {
                return true;
            }
        }
    }
    return false;
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

/* Is the sample of a grid over the opening's polygon met by no leaf? */
static bool probe_is_free(const Leaves *leaves, const Piece *polygon, EnfVec3 n, uint32_t probe) {
    /* A point of the fan's triangles, by two numbers in (0, 1). */
    double x = ((double)(probe % PROBES) + 0.5) / PROBES, y = ((double)(probe / PROBES) + 0.5) / PROBES;
    uint32_t triangle = 1 + probe % (polygon->count - 2);
    EnfVec3 a = polygon->corners[0], b = polygon->corners[triangle], c = polygon->corners[triangle + 1];
    double s = sqrt(x);
    EnfVec3 at = enf_add(enf_add(enf_scale(a, 1.0 - s), enf_scale(b, s * (1.0 - y))), enf_scale(c, s * y));
    for (uint32_t m = 0; m < leaves->assembly->movers.count; m++) {
        if (leaves->portals[m] == leaves->portal && line_meets(leaves->assembly, m, at, n)) {
            return false;
        }
    }
    return true;
}

/* Does a gap remain, and how much of the opening is it? */
static bool leaves_cover(const Leaves *leaves, double *free_share) {
    Piece polygon = portal_polygon(leaves->assembly, leaves->portal);
    *free_share = 1.0;
    if (polygon.count < 3) {
        return false;
    }
    EnfVec3 n = enf_plane_from_polygon(polygon.corners, polygon.count).n;
    Rest *rest = calloc(1, sizeof *rest);
    if (!rest) {
        return false;
    }
    rest->pieces[rest->count++] = polygon;
    for (uint32_t m = 0; m < leaves->assembly->movers.count; m++) {
        if (leaves->portals[m] == leaves->portal) {
            take_boxes(rest, deepened(mover_box(leaves->assembly, m), n));
        }
    }
    double left = 0.0, whole = area(&polygon);
    for (uint32_t i = 0; i < rest->count; i++) {
        left += area(&rest->pieces[i]);
    }
    bool covered = !rest->full && left <= FREE_AREA;
    free(rest);
    *free_share = whole > 0.0 ? left / whole : 1.0;
    uint32_t holes = 0;
    for (uint32_t probe = 0; probe < PROBES * PROBES && covered; probe++) {
        holes += probe_is_free(leaves, &polygon, n, probe);
    }
    *free_share = covered ? (double)holes / (PROBES * PROBES) : *free_share;
    return covered && holes == 0;
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

/* The portal of which the door's box at rest covers most, at least a quarter. */
static uint32_t covered_portal(const EnfAssembly *assembly, uint32_t mover) {
    uint32_t best = ENF_NONE;
    double most = 0.25;
    EnfBox3 box = mover_box(assembly, mover);
    for (uint32_t i = 0; i < assembly->portals.count; i++) {
        Piece polygon = portal_polygon(assembly, i);
        if (polygon.count < 3 || (assembly->portals.data[i].twin != ENF_NONE && assembly->portals.data[i].twin < i)) {
            continue;
        }
        EnfVec3 n = enf_plane_from_polygon(polygon.corners, polygon.count).n;
        EnfBox3 deep = deepened(box, n);
        double whole = area(&polygon);
        for (int side = 0; side < 6 && polygon.count >= 3; side++) {
            int axis = side / 2;
            double at = side % 2 ? axis_of(deep.max, axis) : axis_of(deep.min, axis);
            polygon = cut(&polygon, axis, at, side % 2);
        }
        double share = whole > 0.0 && polygon.count >= 3 ? area(&polygon) / whole : 0.0;
        if (share > most) {
            most = share;
            best = i;
        }
    }
    return best;
}

static uint32_t portal_of(const EnfAssembly *assembly, const EnfAssemblyParts *parts, uint32_t mover, uint32_t node) {
    const EnfSourceNode *source = &parts->source->nodes[node];
    EnfMoverExtras extras = enf_mover_extras(source->extras, source->name, NULL);
    bool door = strncmp(extras.classname, "func_door", strlen("func_door")) == 0;
    if (!door || assembly->movers.data[mover].mesh == ENF_NONE) {
        return ENF_NONE;
    }
    uint32_t portal = extras.portal[0] ? named_portal(assembly, parts, extras.portal) : covered_portal(assembly, mover);
    if (extras.portal[0] && portal == ENF_NONE) {
        enf_diagnose(parts->diagnosis, ENF_DIAGNOSIS_DOOR_PORTAL, source->name, "there is no portal '%s' for it to close",
                     extras.portal);
    }
    uint32_t twin = portal == ENF_NONE ? ENF_NONE : assembly->portals.data[portal].twin;
    return twin != ENF_NONE && twin < portal ? twin : portal;
}

bool enf_movers_close_portals(EnfAssembly *assembly, const EnfAssemblyParts *parts, const uint32_t *nodes) {
    uint32_t *portals = malloc(((size_t)assembly->movers.count + 1) * sizeof *portals);
    if (!portals) {
        return false;
    }
    for (uint32_t m = 0; m < assembly->movers.count; m++) {
        portals[m] = portal_of(assembly, parts, m, nodes[m]);
    }
    for (uint32_t m = 0; m < assembly->movers.count; m++) {
        Leaves leaves = {assembly, parts, portals, portals[m]};
        double free_share;
        if (portals[m] == ENF_NONE) {
            continue;
        }
        if (leaves_cover(&leaves, &free_share)) {
            assembly->movers.data[m].portal = portals[m];
        } else {
            enf_diagnose(parts->diagnosis, ENF_DIAGNOSIS_DOOR_PORTAL, parts->source->nodes[nodes[m]].name,
                         "shut, it leaves %.2g %% of portal '%s' free: the portal stays open for sight", 100.0 * free_share,
                         parts->layout->portals[portals[m]].name);
        }
    }
    free(portals);
    return true;
}

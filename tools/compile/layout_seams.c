/* How an opening is sewn into a room. Input: an opening's polygon and a cell's triangles; output: on which side the triangles' fronts
 * run along its edges.
 *
 * A room's surfaces and its openings, seen from inside, are one closed surface, so where a surface ends at an opening the two run
 * along the common edge in opposite directions. This is local and does not care what lies behind; rays (layout_sides.c) are asked
 * only where surfaces do not end at the opening's edges. */
#include "compile/layout_work.h"

/* How far apart (metres) two edges may be and still be one: authors' vertices agree to millimetres. */
static const double SEAM_GAP = 0.004;

typedef struct Seams {
    EnfVec3 from, along;    /* an edge of the polygon: start, unit direction */
    EnfVec3 normal, inward; /* of the polygon; across the edge into it */
    double length;
    double sum;
} Seams;

/* A shut door lies in the opening, with the same edges, and its front may look anywhere: it is no border of the room. */
static bool shuts(const Seams *seams, const EnfVec3 p[3]) {
    EnfVec3 n = enf_normalize(enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0])));
    double cosine = enf_dot(n, seams->normal);
    EnfVec3 centre = enf_scale(enf_add(p[0], enf_add(p[1], p[2])), 1.0 / 3.0);
    return (cosine > 0.99 || cosine < -0.99) && enf_dot(enf_sub(centre, seams->from), seams->inward) > SEAM_GAP;
}

/* Adds the common length of the edge p → q, with its sign. */
static void add_edge(Seams *seams, EnfVec3 p, EnfVec3 q) {
    EnfVec3 u = enf_sub(p, seams->from), v = enf_sub(q, seams->from);
    double a = enf_dot(u, seams->along), b = enf_dot(v, seams->along);
    double off_u = enf_length(enf_sub(u, enf_scale(seams->along, a))),
           off_v = enf_length(enf_sub(v, enf_scale(seams->along, b)));
    if (off_u > SEAM_GAP || off_v > SEAM_GAP) {
        return;
    }
    double low = a < b ? a : b, high = a < b ? b : a;
    low = low > 0.0 ? low : 0.0;
    high = high < seams->length ? high : seams->length;
    if (high > low) {
        seams->sum += a < b ? high - low : low - high;
    }
}

static void add_triangle(Seams *seams, const EnfShells *shells, const EnfShell *shell, uint32_t item) {
    EnfVec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = enf_v3_from_f(shells->triangles[shell->first + item][k]);
    }
    for (int k = 0; k < 3 && !shuts(seams, p); k++) {
        add_edge(seams, p[k], p[(k + 1) % 3]);
    }
}

double enf_layout_seams(EnfLayoutWork *work, uint32_t cell, const EnfPatch *patch) {
    enum { FOUND = 512 };
    EnfShells *shells = &work->shells;
    EnfShell *shell = &shells->cells[cell];
    uint32_t found[FOUND];
    double sum = 0.0;
    for (uint32_t i = 0; i < patch->piece_count; i++) {
        EnfPiece piece = work->patches.pieces.data[patch->piece_first + i];
        const EnfGrid3 *points = &work->patches.points.data[piece.point_first];
        for (uint32_t k = 0; k < piece.point_count; k++) {
            EnfVec3 a = enf_sub(enf_grid_point(points[k]), shell->origin);
            EnfVec3 b = enf_sub(enf_grid_point(points[(k + 1) % piece.point_count]), shell->origin);
            EnfVec3 along = enf_normalize(enf_sub(b, a));
            Seams seams = {a, along, patch->normal, enf_cross(patch->normal, along), enf_length(enf_sub(b, a)), 0.0};
            EnfVec3 gap = enf_v3(SEAM_GAP, SEAM_GAP, SEAM_GAP);
            EnfBox3 box = enf_box3_add(enf_box3_add(enf_box3_empty(), a), b);
            box = (EnfBox3){enf_sub(box.min, gap), enf_add(box.max, gap)};
            uint32_t count = enf_shell_overlap(shells, cell, box, found, FOUND);
            for (uint32_t t = 0; t < count; t++) {
                add_triangle(&seams, shells, shell, found[t]);
            }
            sum += seams.sum;
        }
    }
    return shell->inverted ? -sum : sum;
}

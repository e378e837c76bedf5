/* Openings given more than once. Input: linked openings; output: pairs that are the two sides of one, and repetitions left out. */
#include "compile/layout_work.h"

typedef struct Pair {
    uint32_t low, high; /* cells */
    uint32_t opening;
} Pair;

static int compare_pairs(const void *pa, const void *pb) {
    const Pair *a = pa, *b = pb;
    if (a->low != b->low) {
        return a->low < b->low ? -1 : 1;
    }
    if (a->high != b->high) {
        return a->high < b->high ? -1 : 1;
    }
    return (a->opening > b->opening) - (a->opening < b->opening);
}

static bool within(double a, double b, double margin) {
    return a - b <= margin && b - a <= margin;
}

static bool boxes_agree(EnfBox3 a, EnfBox3 b, double snap) {
    return within(a.min.x, b.min.x, snap) && within(a.min.y, b.min.y, snap) && within(a.min.z, b.min.z, snap) &&
           within(a.max.x, b.max.x, snap) && within(a.max.y, b.max.y, snap) && within(a.max.z, b.max.z, snap);
}

/* Has every vertex of a one of b within `snap`? */
static bool vertices_agree(const EnfLayoutWork *work, const EnfPatch *a, const EnfPatch *b, double snap) {
    const EnfPiece *pieces = work->patches.pieces.data;
    uint32_t a_first = pieces[a->piece_first].point_first, b_first = pieces[b->piece_first].point_first;
    const EnfPiece *a_last = &pieces[a->piece_first + a->piece_count - 1],
                   *b_last = &pieces[b->piece_first + b->piece_count - 1];
    uint32_t a_end = a_last->point_first + a_last->point_count, b_end = b_last->point_first + b_last->point_count;
    for (uint32_t i = a_first; i < a_end; i++) {
        bool found = false;
        EnfVec3 p = enf_grid_point(work->patches.points.data[i]);
        for (uint32_t k = b_first; k < b_end && !found; k++) {
            found = enf_length(enf_sub(enf_grid_point(work->patches.points.data[k]), p)) <= snap;
        }
        if (!found) {
            return false;
        }
    }
    return true;
}

/* One opening, given twice: same plane and place, and the same corners or (where an edge has one more) the same size. */
static bool agree(const EnfLayoutWork *work, const EnfOpening *a, const EnfOpening *b) {
    double snap = work->settings->portal_snap;
    double cosine = enf_dot(a->patch.normal, b->patch.normal);
    if (!boxes_agree(a->patch.box, b->patch.box, snap) || (cosine < 0.9 && cosine > -0.9)) {
        return false;
    }
    EnfVec3 size = enf_sub(a->patch.box.max, a->patch.box.min);
    double slack = 2.0 * snap * enf_length(size);
    bool corners = vertices_agree(work, &a->patch, &b->patch, snap) && vertices_agree(work, &b->patch, &a->patch, snap);
    return corners || within(a->patch.area, b->patch.area, slack < 0.02 * a->patch.area ? slack : 0.02 * a->patch.area);
}

static void drop_double(EnfLayoutWork *work, EnfOpening *opening, const EnfOpening *first) {
    opening->dropped = true;
    enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_DOUBLED, enf_opening_name(work, opening),
                 "'%s' is the same opening from '%s' to '%s'; this one was left out", enf_opening_name(work, first),
                 enf_layout_cell_name(work, opening->source), enf_layout_cell_name(work, opening->target));
    enf_opening_show(work, opening);
}

/* Compares two openings between the same cells. */
static void settle(EnfLayoutWork *work, uint32_t first, uint32_t second) {
    EnfOpening *a = &work->openings.data[first], *b = &work->openings.data[second];
    if (a->dropped || b->dropped || !agree(work, a, b)) {
        return;
    }
    if (a->source == b->source || a->twin != ENF_NONE) {
        drop_double(work, b, a);
    } else if (b->twin == ENF_NONE) {
        a->twin = second;
        b->twin = first;
    }
}

void enf_layout_twins(EnfLayoutWork *work) {
    uint32_t count = 0;
    Pair *pairs = enf_alloc(NULL, work->openings.count, sizeof *pairs);
    if (pairs == NULL) {
        return; /* no twins: each side is then made both ways, which shows the same */
    }
    for (uint32_t i = 0; i < work->openings.count; i++) {
        const EnfOpening *opening = &work->openings.data[i];
        if (!opening->dropped && !opening->has_transform) {
            bool ordered = opening->source < opening->target;
            pairs[count++] = (Pair){ordered ? opening->source : opening->target, ordered ? opening->target : opening->source,
                                    i};
        }
    }
    qsort(pairs, count, sizeof *pairs, compare_pairs);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = i + 1; k < count && pairs[k].low == pairs[i].low && pairs[k].high == pairs[i].high; k++) {
            settle(work, pairs[i].opening, pairs[k].opening);
        }
    }
    enf_free(NULL, pairs, work->openings.count, sizeof *pairs);
}

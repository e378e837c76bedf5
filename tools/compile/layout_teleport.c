/* Openings that lead elsewhere. Input: openings whose extras ask for a mirror, for another portal, or give a transform; output: their
 * targets and transforms (DESIGN §3: source space → target space). */
#include "compile/layout_work.h"

#include <math.h>

/* Columns: right, up, out of the source; and the middle. `up` is the world's as far as the opening stands upright, and its first edge
 * where it lies flat. */
static EnfAffine frame_of(const EnfLayoutWork *work, const EnfOpening *opening) {
    EnfVec3 n = enf_opening_normal(opening), hint = enf_v3(0, 1, 0);
    if (n.y > 0.9 || n.y < -0.9) {
        const EnfGrid3 *p = &work->patches.points.data[work->patches.pieces.data[opening->patch.piece_first].point_first];
        hint = enf_sub(enf_grid_point(p[1]), enf_grid_point(p[0]));
    }
    EnfVec3 right = enf_normalize(enf_cross(hint, n)), up = enf_cross(n, right);
    return (EnfAffine){{right.x, right.y, right.z, up.x, up.y, up.z, n.x, n.y, n.z}, opening->patch.centre};
}

/* The motion that takes what enters `in` out of the back of `out`, upright: right becomes left, out of the source becomes into the
 * target. */
static EnfAffine passage(const EnfLayoutWork *work, const EnfOpening *in, const EnfOpening *out) {
    EnfAffine from = frame_of(work, in), to = frame_of(work, out), result;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            result.m[3 * c + r] = -to.m[r] * from.m[c] + to.m[3 + r] * from.m[3 + c] - to.m[6 + r] * from.m[6 + c];
        }
    }
    result.t = enf_sub(to.t, enf_affine_vector(&result, from.t));
    return result;
}

/* Reflection in the opening's plane. */
static EnfAffine reflection(const EnfOpening *opening) {
    EnfVec3 n = opening->patch.normal;
    EnfAffine result = {{1 - 2 * n.x * n.x, -2 * n.x * n.y, -2 * n.x * n.z, -2 * n.y * n.x, 1 - 2 * n.y * n.y, -2 * n.y * n.z,
                         -2 * n.z * n.x, -2 * n.z * n.y, 1 - 2 * n.z * n.z},
                        enf_scale(n, 2.0 * enf_dot(n, opening->patch.centre))};
    return result;
}

/* Makes a given matrix exactly rigid (Gram–Schmidt); false if it is far from that. */
static bool make_rigid(EnfAffine *a) {
    EnfVec3 x = enf_v3(a->m[0], a->m[1], a->m[2]), y = enf_v3(a->m[3], a->m[4], a->m[5]), z = enf_v3(a->m[6], a->m[7], a->m[8]);
    double stray = fabs(enf_dot(x, y)) + fabs(enf_dot(y, z)) + fabs(enf_dot(z, x)) + fabs(enf_dot(x, x) - 1.0) +
                   fabs(enf_dot(y, y) - 1.0) + fabs(enf_dot(z, z) - 1.0);
    if (!(stray < 1e-3) || !enf_v3_finite(a->t)) {
        return false;
    }
    double sign = enf_affine_det(a) < 0.0 ? -1.0 : 1.0;
    x = enf_normalize(x);
    y = enf_normalize(enf_sub(y, enf_scale(x, enf_dot(x, y))));
    z = enf_scale(enf_cross(x, y), sign);
    *a = (EnfAffine){{x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z}, a->t};
    return true;
}

/* The first opening of the portal that `name` means: its node's name, with or without suffix, or its targetname. */
static uint32_t find_portal(const EnfLayoutWork *work, const char *name, uint32_t except) {
    for (uint32_t i = 0; i < work->openings.count; i++) {
        const EnfOpening *opening = &work->openings.data[i];
        if (i == except || opening->extras == ENF_NONE) {
            continue;
        }
        EnfNodeName node = enf_node_name(enf_opening_name(work, opening));
        bool same = strcmp(node.text, name) == 0 || strcmp(work->extras.data[opening->extras].targetname, name) == 0 ||
                    enf_name_compare(node.text, node.base, name, strlen(name), false) == 0;
        if (same) {
            return i;
        }
    }
    return ENF_NONE;
}

/* Turns the polygon so that its room lies behind it; there is no other side to ask. */
static void orient(EnfLayoutWork *work, EnfOpening *opening) {
    opening->flipped = enf_layout_looks_into(work, &opening->patch, opening->source);
    if (opening->flipped && !opening->mirror) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_FLIPPED, enf_opening_name(work, opening),
                     "its front looks into its own room '%s'; it was turned around",
                     enf_layout_cell_name(work, opening->source));
    }
}

/* A portal's own room, or the one that lies at it. */
static bool find_source(EnfLayoutWork *work, EnfOpening *opening) {
    if (opening->source == ENF_NONE) {
        opening->source = enf_layout_cell_on_side(work, &opening->patch, enf_scale(opening->patch.normal, -1.0), ENF_NONE);
    }
    if (opening->source == ENF_NONE) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_OUTSIDE_ROOM, enf_opening_name(work, opening),
                     "it is in no room, and none lies behind it; it was left out");
        opening->dropped = true;
        return false;
    }
    orient(work, opening);
    return true;
}

static void link_teleport(EnfLayoutWork *work, uint32_t index) {
    EnfOpening *opening = &work->openings.data[index];
    const char *asked = work->extras.data[opening->extras].teleport;
    uint32_t exit = find_portal(work, asked, index);
    if (exit == ENF_NONE) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_NO_TARGET, enf_opening_name(work, opening),
                     "there is no portal '%s' for it to lead to; it was left out", asked);
        opening->dropped = true;
        return;
    }
    EnfOpening *other = &work->openings.data[exit];
    const EnfExtras *back = &work->extras.data[other->extras];
    EnfNodeName name = enf_node_name(enf_opening_name(work, other));
    bool leads_elsewhere = back->teleport[0] != '\0' || back->portal_to[0] != '\0' || name.starred || other->mirror;
    opening->exit = exit;
    opening->has_transform = true;
    if (!leads_elsewhere && other->exit == ENF_NONE) { /* a mere exit leads back, or nowhere */
        other->has_transform = true;
        other->exit = index;
        other->dropped = opening->one_way;
    }
}

static void link_given(EnfLayoutWork *work, EnfOpening *opening) {
    const EnfExtras *extras = &work->extras.data[opening->extras];
    uint32_t cells[2];
    opening->transform = extras->transform;
    bool found = enf_layout_find_rooms(work, extras->portal_to, strlen(extras->portal_to), cells, 2) > 0;
    if (!found || !make_rigid(&opening->transform)) {
        enf_diagnose(work->diagnosis, ENF_DIAGNOSIS_PORTAL_NO_TARGET, enf_opening_name(work, opening),
                     found ? "its transform is no rigid motion; it was left out"
                           : "it has a transform, but names no room; it was left out");
        opening->dropped = true;
        return;
    }
    opening->target = cells[0];
    opening->has_transform = true;
    opening->one_way = true;
    opening->mirror = enf_affine_det(&opening->transform) < 0.0;
}

void enf_layout_teleports(EnfLayoutWork *work) {
    for (uint32_t i = 0; i < work->openings.count; i++) {
        EnfOpening *opening = &work->openings.data[i];
        const EnfExtras *extras = opening->extras != ENF_NONE ? &work->extras.data[opening->extras] : NULL;
        if (extras == NULL || opening->dropped) {
            continue;
        }
        if (opening->mirror) {
            opening->has_transform = true;
            opening->one_way = true;
            opening->transform = reflection(opening);
        } else if (extras->has_transform) {
            link_given(work, opening);
        } else if (extras->teleport[0] != '\0') {
            link_teleport(work, i);
        }
    }
    for (uint32_t i = 0; i < work->openings.count; i++) {
        EnfOpening *opening = &work->openings.data[i];
        bool exit = opening->dropped && opening->exit != ENF_NONE;
        if (opening->has_transform && (!opening->dropped || exit)) {
            find_source(work, opening);
        }
    }
    for (uint32_t i = 0; i < work->openings.count; i++) {
        EnfOpening *opening = &work->openings.data[i];
        if (!opening->has_transform || opening->dropped) {
            continue;
        }
        if (opening->exit != ENF_NONE) {
            const EnfOpening *other = &work->openings.data[opening->exit];
            opening->target = other->source;
            opening->transform = passage(work, opening, other);
            opening->dropped = opening->target == ENF_NONE;
        } else if (opening->mirror && opening->target == ENF_NONE) {
            opening->target = opening->source;
        }
    }
}

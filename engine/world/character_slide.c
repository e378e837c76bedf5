/* Sliding: a move against what is in its way, along planes and the creases between two of them, never back.
 *
 * In the air all three dimensions are clipped. On the ground a body moves in two: its height follows the ground, so a ramp takes
 * no speed and gives none, and a wall w with normal n acts as the line that keeps it clear of n while it follows the ground g:
 * m = (n.x − n.y g.x / g.y, n.z − n.y g.z / g.y). After Quake's PM_SlideMove in spirit. */
#include "world/character_internal.h"

#include <math.h>

enum { SLIDES_MAX = 8 };

/* What is left of a way is nothing: metres. A body at 1 mm/s moves 16 µm a tick. */
#define WAY_MIN 0x1p-24
/* Two planes this near to one are one: cosine. */
#define SAME_PLANE 0.9999

EnfTrial enf_trial_make(const EnfWalk *walk) {
    EnfTrial trial;
    trial.at = walk->body->position;
    trial.velocity = walk->body->velocity;
    trial.path_count = trial.plane_count = 0;
    trial.ground = walk->body->ground_normal;
    trial.blocked = trial.landed = false;
    trial.landing = (EnfSweepHit){1.0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, ENF_NONE, ENF_NONE, ENF_NONE};
    return trial;
}

bool enf_walk_supports(const EnfWalk *walk, const EnfSweepHit *hit, double least_y) {
    double slope = walk->body->def.slope_cos;
    return hit->normal.y >= slope || (hit->face.y >= slope && hit->normal.y >= least_y);
}

bool enf_trial_sweep(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta, EnfSweepHit *hit) {
    bool met = enf_collide_sweep(walk->collider, &walk->capsule, trial->at, delta, hit);
    if (hit->t > 0.0) {
        trial->at = enf_add(trial->at, enf_scale(delta, hit->t));
        uint32_t last = ENF_TRIAL_PATH_MAX - 1;
        ENF_ASSERT(trial->path_count <= last);
        trial->path[trial->path_count <= last ? trial->path_count++ : last] = trial->at;
    }
    return met;
}

static bool is_nothing(EnfVec3 v) {
    return enf_dot(v, v) < WAY_MIN * WAY_MIN;
}

static bool keeps_clear(EnfVec3 v, const EnfVec3 *planes, uint32_t count) {
    double slack = -0x1p-36 * sqrt(enf_dot(v, v));
    for (uint32_t i = 0; i < count; i++) {
        if (enf_dot(v, planes[i]) < slack) {
            return false;
        }
    }
    return true;
}

static EnfVec3 along(EnfVec3 v, EnfVec3 n) {
    return enf_sub(v, enf_scale(n, enf_dot(v, n)));
}

/* What of `v` goes into no plane: itself, along one, along the crease of two, or nothing. */
static EnfVec3 clip(EnfVec3 v, const EnfVec3 *planes, uint32_t count) {
    if (keeps_clear(v, planes, count)) {
        return v;
    }
    for (uint32_t i = count; i-- > 0;) { /* the newest first: it is the one in the way */
        EnfVec3 one = along(v, planes[i]);
        if (enf_dot(v, planes[i]) < 0.0 && keeps_clear(one, planes, count)) {
            return one;
        }
    }
    for (uint32_t i = count; i-- > 0;) {
        for (uint32_t j = i; j-- > 0;) {
            EnfVec3 crease = enf_normalize(enf_cross(planes[i], planes[j]));
            EnfVec3 two = enf_scale(crease, enf_dot(v, crease));
            if (!is_nothing(two) && keeps_clear(two, planes, count)) {
                return two;
            }
        }
    }
    return enf_v3(0.0, 0.0, 0.0);
}

/* Remembers a plane; one that is known already is replaced. */
static void add_plane(EnfTrial *trial, EnfVec3 n) {
    for (uint32_t i = 0; i < trial->plane_count; i++) {
        if (enf_dot(trial->planes[i], n) > SAME_PLANE) {
            trial->planes[i] = n;
            return;
        }
    }
    if (trial->plane_count < ENF_TRIAL_PLANES_MAX) {
        trial->planes[trial->plane_count++] = n;
    }
}

/* ---- in the air ------------------------------------------------------------------------------------------------- */

void enf_trial_slide(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta) {
    EnfVec3 wish = delta;
    for (int i = 0; i < SLIDES_MAX && !is_nothing(delta); i++) {
        EnfSweepHit hit;
        if (!enf_trial_sweep(walk, trial, delta, &hit)) {
            return;
        }
        if (!trial->landed && enf_walk_supports(walk, &hit, 0.5)) {
            trial->landed = true;
            trial->landing = hit;
        }
        trial->blocked = trial->blocked || fabs(hit.normal.y) < walk->body->def.slope_cos;
        add_plane(trial, hit.normal);
        delta = clip(enf_scale(delta, 1.0 - hit.t), trial->planes, trial->plane_count);
        trial->velocity = clip(trial->velocity, trial->planes, trial->plane_count);
        if (enf_dot(delta, wish) <= 0.0) { /* it would only swing to and fro in a corner */
            return;
        }
    }
}

/* ---- on the ground ---------------------------------------------------------------------------------------------- */

static EnfVec3 flat(EnfVec3 v) {
    return enf_v3(v.x, 0.0, v.z);
}

/* The line, horizontal and unit, that keeps clear of `n` who follows the ground; zero if the ground alone decides. */
static EnfVec3 wall_line(EnfVec3 n, EnfVec3 ground) {
    EnfVec3 m = enf_v3(n.x - n.y * ground.x / ground.y, 0.0, n.z - n.y * ground.z / ground.y);
    double length = sqrt(enf_dot(m, m));
    return length > 0x1p-10 ? enf_scale(m, 1.0 / length) : enf_v3(0.0, 0.0, 0.0);
}

static EnfVec3 clip_walls(const EnfTrial *trial, EnfVec3 v) {
    EnfVec3 lines[ENF_TRIAL_PLANES_MAX];
    uint32_t count = 0;
    for (uint32_t i = 0; i < trial->plane_count; i++) {
        EnfVec3 line = wall_line(trial->planes[i], trial->ground);
        if (line.x != 0.0 || line.z != 0.0) {
            lines[count++] = line;
        }
    }
    return flat(clip(v, lines, count)); /* the crease of two lines is upright: nothing */
}

void enf_trial_walk(const EnfWalk *walk, EnfTrial *trial, EnfVec3 delta) {
    EnfVec3 wish = flat(delta), rest = wish;
    for (int i = 0; i < SLIDES_MAX && !is_nothing(rest); i++) {
        EnfVec3 g = trial->ground;
        EnfVec3 way = enf_v3(rest.x, -(g.x * rest.x + g.z * rest.z) / g.y, rest.z);
        EnfSweepHit hit;
        bool lift = false;
        if (!enf_trial_sweep(walk, trial, way, &hit)) {
            return;
        }
        rest = enf_scale(rest, 1.0 - hit.t);
        if (hit.normal.y >= walk->body->def.slope_cos) { /* from floor to ramp; or floor again: then a little off it */
            lift = enf_dot(hit.normal, g) >= 1.0 - 0x1p-40 && hit.t == 0.0;
            trial->ground = hit.normal;
        } else {
            EnfVec3 line = wall_line(hit.normal, g);
            trial->blocked = true;
            if (line.x == 0.0 && line.z == 0.0) { /* a ceiling over the ramp */
                trial->velocity = enf_v3(0.0, 0.0, 0.0);
                return;
            }
            add_plane(trial, hit.normal);
        }
        if (lift && enf_trial_sweep(walk, trial, enf_v3(0.0, 0.5 * ENF_TOL_SKIN, 0.0), &hit)) {
            return;
        }
        rest = clip_walls(trial, rest);
        trial->velocity = clip_walls(trial, flat(trial->velocity));
        if (enf_dot(rest, wish) <= 0.0) {
            return;
        }
    }
}

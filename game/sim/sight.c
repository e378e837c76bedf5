/* Does a guard see the player? Three questions of the engine's own, the cheap ones first: does any window of the guard's view show the
 * player's box (the traversal, through doorways and past shut doors)? Is a line from eye to body free of walls (a query of its own:
 * what culling lets through is no line of sight, PITFALLS 29)? Does light fall on him? */
#include "sim/sim.h"

#include <math.h>

#define SIGHT_FAR 17.0
#define SIGHT_FOV 100.0
#define FELT 0.9 /* metres in the plan */
enum { SIGHT_WIDTH = 160, SIGHT_HEIGHT = 120 };

/* ---- light ---------------------------------------------------------------------------------------------------------- */

static bool through_window(const EnfMap *map, const EnfLightRef *ref, EnfVec3 from_light) {
    for (uint32_t i = 0; i < ref->plane_count; i++) {
        const float *n = map->light_planes[ref->plane_first + i].n;
        if ((double)n[0] * from_light.x + (double)n[1] * from_light.y + (double)n[2] * from_light.z < 0.0) {
            return false;
        }
    }
    return true;
}

/* Candela over metres squared, faded towards the light's range. */
static double shine(const EnfLight *light, EnfVec3 at) {
    EnfVec3 way = enf_sub(at, enf_v3(light->position[0], light->position[1], light->position[2]));
    double color = 0.2126 * (double)light->color[0] + 0.7152 * (double)light->color[1] + 0.0722 * (double)light->color[2];
    if (light->kind == ENF_LIGHT_DIRECTIONAL) {
        return color;
    }
    double square = fmax(enf_dot(way, way), 0.25), range = (double)light->range;
    double fade = range > 0.0 ? fmax(0.0, 1.0 - square / (range * range)) : 1.0;
    if (light->kind == ENF_LIGHT_SPOT) {
        EnfVec3 axis = enf_v3((double)light->direction[0], (double)light->direction[1], (double)light->direction[2]);
        fade = enf_dot(way, axis) < (double)light->outer_cos * sqrt(square) ? 0.0 : fade;
    }
    return color / square * fade;
}

static double illumination(const EnfMap *map, uint32_t cell, EnfVec3 at) {
    const EnfCell *c = &map->cells[cell];
    double sum = 0.0;
    for (uint32_t i = c->light_first; i < c->light_first + c->light_count; i++) {
        const EnfLightRef *ref = &map->light_refs[i];
        const EnfLight *light = &map->lights[ref->light];
        bool again = i > c->light_first && map->light_refs[i - 1].light == ref->light; /* another window of the same light */
        EnfVec3 way = enf_sub(at, enf_v3(light->position[0], light->position[1], light->position[2]));
        sum += !again && (ref->plane_count == 0 || through_window(map, ref, way)) ? shine(light, at) : 0.0;
    }
    return sum;
}

double sim_usual_light(const Game *game) {
    const EnfMap *map = game->map;
    double sum = 0.0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *c = &map->cells[i];
        EnfVec3 at = enf_v3(c->origin[0] + 0.5 * (double)(c->min[0] + c->max[0]), c->origin[1] + (double)c->min[1] + 1.0,
                            c->origin[2] + 0.5 * (double)(c->min[2] + c->max[2]));
        sum += c->flags & ENF_CELL_OUTSIDE ? 0.0 : illumination(map, i, at);
    }
    return map->cells_count > 0 && map->lights_count > 0 ? sum / (double)map->cells_count : 0.0;
}

double sim_light(const Game *game, uint32_t cell, EnfVec3 at) {
    if (!(game->usual_light > 0.0) || cell >= game->map->cells_count) {
        return 1.0; /* a map without lights is lit evenly */
    }
    double light = illumination(game->map, cell, at);
    return light / (light + 0.5 * game->usual_light);
}

/* ---- sight ------------------------------------------------------------------------------------------------------------ */

/* Is the segment free of surfaces in every cell that the guard sees into, and of leaves that stand half open? */
static bool line_is_free(const Game *game, const EnfVisSet *seen, EnfVec3 eye, EnfVec3 to) {
    const EnfCapsule thread = {0.01, 0.02};
    EnfVec3 way = enf_sub(to, eye);
    EnfSweepHit met;
    if (enf_collide_sweep(game->collider, &thread, eye, way, &met) && met.t < 0.98) {
        return false;
    }
    for (uint32_t i = 0; i < seen->cell_count; i++) {
        EnfRayHit hit;
        if (enf_map_ray(game->map, seen->cells[i], eye, way, 0.98, &hit)) {
            return false;
        }
    }
    return true;
}

static bool window_shows(const Game *game, const EnfVisSet *seen, EnfBox3f box) {
    for (uint32_t i = 0; i < seen->visit_count; i++) {
        const EnfVisit *visit = &seen->visits[i];
        if (visit->space != 0 || !enf_world_touches(game->map, visit->cell, box)) {
            continue;
        }
        const EnfCell *c = &game->map->cells[visit->cell];
        EnfBox3f bounds = {{c->min[0], c->min[1], c->min[2]}, {c->max[0], c->max[1], c->max[2]}};
        EnfPyramid pyramid;
        enf_pyramid(&seen->cameras[0], visit->window, NULL, enf_v3(c->origin[0], c->origin[1], c->origin[2]), bounds, &pyramid);
        if (enf_pyramid_box(&pyramid, enf_world_box_in_cell(game->map, visit->cell, box))) {
            return true;
        }
    }
    return false;
}

/* So near that he is felt, whichever way the guard looks and however dark it is, if there is no wall between. */
static bool is_felt(const Game *game, EnfVec3 eye, const EnfCharacter *body) {
    EnfVec3 way = enf_sub(body->position, eye);
    const EnfCapsule thread = {0.01, 0.02};
    EnfSweepHit met;
    if (way.x * way.x + way.z * way.z > FELT * FELT || way.y > 0.0 || way.y < -2.5) {
        return false;
    }
    EnfVec3 waist = enf_sub(enf_add(body->position, enf_v3(0.0, 0.5 * body->height, 0.0)), eye);
    return !enf_collide_sweep(game->collider, &thread, eye, waist, &met) || met.t > 0.95;
}

double sim_sight(Game *game, const SimEye *of, const EnfCharacter *body) {
    if (is_felt(game, of->at, body)) {
        return 1.0;
    }
    EnfVec3 eye = of->at, look = sim_look(of->yaw_deg, 0.0);
    EnfVec3 feet = body->position, way = enf_sub(enf_add(feet, enf_v3(0.0, 0.6 * body->height, 0.0)), eye);
    double away = enf_length(way);
    if (away > SIGHT_FAR || enf_dot(way, look) < 0.5 * away) {
        return 0.0;
    }
    EnfView view = enf_view_default();
    view.camera = enf_camera(eye, enf_turn(of->yaw_deg, 0.0, 0.0), SIGHT_FOV, SIGHT_WIDTH, SIGHT_HEIGHT);
    view.cell = of->cell;
    const EnfVisSet *seen = enf_vis_run(game->eyes, &game->portals, &view);
    double r = body->def.radius;
    EnfBox3 box = {enf_sub(feet, enf_v3(r, 0.0, r)), enf_add(feet, enf_v3(r, body->height, r))};
    if (!window_shows(game, seen, enf_box3f_outward(box))) {
        return 0.0;
    }
    double shows = 0.0; /* head, chest, knees */
    const double parts[3] = {0.92, 0.65, 0.25};
    for (int i = 0; i < 3; i++) {
        shows += line_is_free(game, seen, eye, enf_add(feet, enf_v3(0.0, parts[i] * body->height, 0.0))) ? 1.0 / 3.0 : 0.0;
    }
    double light = sim_light(game, body->cell, enf_add(feet, enf_v3(0.0, 1.0, 0.0)));
    double near = 1.0 - away / SIGHT_FAR;
    double ahead = enf_dot(way, look) > 0.75 * away ? 1.0 : 0.5;
    return shows * ahead * near * near * (away < 2.5 ? fmax(light, 0.5) : light);
}

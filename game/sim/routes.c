/* The portal graph: shortest ways from doorway to doorway (Dijkstra 1959, with a binary heap), for ears and for feet. */
#include "sim/sim.h"

#include <math.h>

/* Metres that a shut door adds to a sound's way. */
#define SHUT_DOOR 6.0
/* A doorway is walked through if it is this high and wide, with a floor before and behind it. */
#define WALK_HEIGHT 1.6
#define WALK_WIDTH 0.6
/* Metres before and behind a doorway at which a way on foot passes. */
#define BESIDE_GATE 0.55

/* ---- doorways ------------------------------------------------------------------------------------------------------ */

static SimGate make_gate(const EnfMap *map, uint32_t index) {
    const EnfPortal *portal = &map->portals[index];
    const double *o = map->cells[portal->source].origin;
    EnfVec3 sum = enf_v3(0.0, 0.0, 0.0);
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = 0; i < portal->vertex_count; i++) {
        EnfVec3 p = enf_add(enf_v3_from_f(map->portal_vertices[portal->vertex_first + i]), enf_v3(o[0], o[1], o[2]));
        sum = enf_add(sum, p);
        box = enf_box3_add(box, p);
    }
    SimGate gate = {enf_v3(o[0], o[1], o[2]), enf_v3(o[0], o[1], o[2]), false};
    if (portal->vertex_count == 0) {
        return gate; /* an overlap: nowhere in particular */
    }
    gate.middle = enf_scale(sum, 1.0 / (double)portal->vertex_count);
    gate.foot = enf_v3(gate.middle.x, box.min.y, gate.middle.z);
    EnfVec3 size = enf_sub(box.max, box.min);
    bool upright = size.y >= WALK_HEIGHT && sqrt(size.x * size.x + size.z * size.z) >= WALK_WIDTH;
    gate.walkable = upright;
    return gate;
}

/* Is there a floor to stand on? An opening above the floor of a hall is looked through, not walked through. */
static bool has_floor(const Game *game, EnfVec3 at) {
    const EnfCapsule legs = {0.2, 1.0};
    EnfSweepHit hit;
    return enf_collide_sweep(game->collider, &legs, enf_add(at, enf_v3(0.0, 0.5, 0.0)), enf_v3(0.0, -1.1, 0.0), &hit) &&
           hit.face.y > 0.7;
}

/* Does a mover that never rests stand in this doorway at every moment, as a revolving door does? Nobody is sent through. */
static bool is_barred(const Game *game, EnfVec3 foot) {
    enum { MOMENTS = 8 };
    EnfVec3 waist = enf_add(foot, enf_v3(0.0, 1.0, 0.0));
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        const EnfMover *mover = &game->map->movers[i];
        if (mover->kind != ENF_MOVER_PATH || !(mover->flags & ENF_MOVER_SOLID)) {
            continue;
        }
        EnfObjectDef def = enf_mover_def(game->map, i);
        bool always = true;
        for (int64_t k = 0; k < MOMENTS && always; k++) {
            int64_t tick = k * (int64_t)def.motion.as.path.period_ticks / MOMENTS;
            always = enf_box3_contains(enf_motion_bound(&def.motion, &def.local, tick, tick), waist);
        }
        if (always) {
            return true;
        }
    }
    return false;
}

/* Is (x, z) within the outline of a portal, seen from above? (Even and odd crossings.) */
static bool within(const EnfMap *map, const EnfPortal *portal, double x, double z) {
    const EnfVec3f *p = &map->portal_vertices[portal->vertex_first];
    const double *o = map->cells[portal->source].origin;
    bool in = false;
    for (uint32_t i = 0, j = portal->vertex_count - 1; i < portal->vertex_count; j = i++) {
        double xi = o[0] + (double)p[i].x, zi = o[2] + (double)p[i].z, xj = o[0] + (double)p[j].x, zj = o[2] + (double)p[j].z;
        in = (zi > z) != (zj > z) && x < xi + (xj - xi) * (z - zi) / (zj - zi) ? !in : in;
    }
    return in;
}

/* An opening in a floor is walked through where stairs come up in it: the highest place to stand in its outline, below its plane. */
static bool find_stair(const Game *game, uint32_t index, SimGate *gate) {
    enum { PLACES = 24 };
    const EnfPortal *portal = &game->map->portals[index];
    const EnfCapsule legs = {0.2, 1.0};
    EnfBox3 box = enf_box3_empty();
    for (uint32_t i = 0; i < portal->vertex_count; i++) {
        box = enf_box3_add(box, enf_v3_from_f(game->map->portal_vertices[portal->vertex_first + i]));
    }
    const double *o = game->map->cells[portal->source].origin;
    double best = -HUGE_VAL, y = gate->middle.y;
    bool low = false, lower = false; /* a step below the plane, and one below that: a rim alone is no stair */
    for (uint32_t k = 0; k < PLACES * PLACES; k++) {
        uint32_t column = k % PLACES, row = k / PLACES;
        double s = ((double)column + 0.5) / PLACES, t = ((double)row + 0.5) / PLACES;
        EnfVec3 at = enf_v3(o[0] + box.min.x + s * (box.max.x - box.min.x), y + 0.3,
                            o[2] + box.min.z + t * (box.max.z - box.min.z));
        EnfSweepHit hit;
        if (!within(game->map, portal, at.x, at.z) ||
            !enf_collide_sweep(game->collider, &legs, at, enf_v3(0.0, -1.4, 0.0), &hit) || hit.face.y <= 0.7) {
            continue;
        }
        double rise = at.y - 1.4 * hit.t - y;
        low = low || (rise < -0.1 && rise >= -0.45);
        lower = lower || (rise < -0.45 && rise >= -0.9);
        if (rise > best + 1e-3 && rise < 0.1 && hit.t > 0.0) {
            best = rise;
            gate->foot = enf_v3(at.x, y + rise, at.z);
        }
    }
    return low && lower;
}

/* Does a body get through, on foot? Settles where its feet pass. */
static bool is_walkable(const Game *game, uint32_t index, SimGate *gate) {
    const EnfPortalState *state = &game->portals.states[index];
    if (game->map->portals[index].transform != ENF_NONE) {
        return false;
    }
    if (fabs(state->normal.y) > 0.7) {
        return find_stair(game, index, gate);
    }
    EnfVec3 step = enf_scale(enf_normalize(enf_v3(state->normal.x, 0.0, state->normal.z)), BESIDE_GATE);
    return gate->walkable && has_floor(game, enf_add(gate->foot, step)) && has_floor(game, enf_sub(gate->foot, step)) &&
           !is_barred(game, gate->foot);
}

void sim_gates_find(Game *game) {
    for (uint32_t i = 0; i < game->map->portals_count; i++) {
        game->gates[i] = make_gate(game->map, i);
        game->gates[i].walkable = is_walkable(game, i, &game->gates[i]);
    }
}

/* ---- a heap of half-portals by distance ----------------------------------------------------------------------------- */

static bool nearer(const SimWays *ways, uint32_t a, uint32_t b) {
    return ways->distance[a] < ways->distance[b] || (!(ways->distance[b] < ways->distance[a]) && a < b);
}

static void put(SimWays *ways, uint32_t at, uint32_t portal) {
    ways->heap[at] = portal;
    ways->place[portal] = at + 1;
}

static void rise(SimWays *ways, uint32_t at) {
    uint32_t portal = ways->heap[at];
    while (at > 0 && nearer(ways, portal, ways->heap[(at - 1) / 2])) {
        put(ways, at, ways->heap[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
    put(ways, at, portal);
}

static void sink(SimWays *ways, uint32_t at) {
    uint32_t portal = ways->heap[at];
    for (uint32_t child = 2 * at + 1; child < ways->heap_count; child = 2 * at + 1) {
        child += child + 1 < ways->heap_count && nearer(ways, ways->heap[child + 1], ways->heap[child]);
        if (!nearer(ways, ways->heap[child], portal)) {
            break;
        }
        put(ways, at, ways->heap[child]);
        at = child;
    }
    put(ways, at, portal);
}

static uint32_t pop(SimWays *ways) {
    uint32_t first = ways->heap[0];
    ways->place[first] = 0;
    if (--ways->heap_count > 0) {
        put(ways, 0, ways->heap[ways->heap_count]);
        sink(ways, 0);
    }
    return first;
}

/* ---- ways ------------------------------------------------------------------------------------------------------------ */

static void reach(SimWays *ways, uint32_t portal, double distance, uint32_t before) {
    if (!(distance < ways->distance[portal])) {
        return;
    }
    ways->distance[portal] = distance;
    ways->before[portal] = before;
    if (ways->place[portal] == 0) {
        put(ways, ways->heap_count++, portal);
    }
    rise(ways, ways->place[portal] - 1);
}

/* From a place in a cell, `run` metres on the way, through each of its portals; `before`: the portal by which it was entered. */
static void leave_cell(const Game *game, SimWays *ways, uint32_t cell, EnfVec3 at, uint32_t before) {
    const EnfCell *c = &game->map->cells[cell];
    double run = before == ENF_NONE ? 0.0 : ways->distance[before];
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        double shut = enf_portals_is_open(&game->portals, p) ? 0.0 : SHUT_DOOR;
        reach(ways, p, run + enf_length(enf_sub(game->gates[p].middle, at)) + shut, before);
    }
}

/* Nothing is reached yet. */
static void clear(const Game *game, SimWays *ways) {
    for (uint32_t i = 0; i < game->map->portals_count; i++) {
        ways->distance[i] = HUGE_VAL;
        ways->before[i] = ENF_NONE;
        ways->place[i] = 0;
    }
    ways->heap_count = 0;
}

void sim_ways_find(Game *game, SimWays *ways, EnfVec3 from, uint32_t cell, double most) {
    const EnfMap *map = game->map;
    clear(game, ways);
    ways->from = from;
    ways->cell = cell;
    if (cell >= map->cells_count) {
        return;
    }
    leave_cell(game, ways, cell, from, ENF_NONE);
    while (ways->heap_count > 0) {
        uint32_t portal = pop(ways);
        if (ways->distance[portal] > most) {
            break;
        }
        leave_cell(game, ways, map->portals[portal].target, game->gates[portal].middle, portal);
    }
}

double sim_ways_to(const Game *game, const SimWays *ways, EnfVec3 to, uint32_t cell, uint32_t *last) {
    *last = ENF_NONE;
    if (cell == ways->cell) {
        return enf_length(enf_sub(to, ways->from));
    }
    double best = HUGE_VAL;
    if (cell >= game->map->cells_count) {
        return best;
    }
    const EnfCell *c = &game->map->cells[cell];
    for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
        uint32_t twin = game->map->portals[p].twin;
        if (twin == ENF_NONE) {
            continue;
        }
        double way = ways->distance[twin] + enf_length(enf_sub(to, game->gates[twin].middle));
        if (way < best) {
            best = way;
            *last = twin;
        }
    }
    return best;
}

/* ---- on foot ----------------------------------------------------------------------------------------------------------- */

/* The half-portals of the way, last first, into its stops. */
static bool lay_stops(const Game *game, uint32_t passed, SimWay *way) {
    uint32_t gates[SIM_ROUTE_MAX], count = 0;
    for (; passed != ENF_NONE; passed = game->ways.before[passed]) {
        if (count == SIM_ROUTE_MAX / 2 - 1) {
            return false; /* farther than anybody chases */
        }
        gates[count++] = passed;
    }
    while (count-- > 0) {
        const EnfPortalState *state = &game->portals.states[gates[count]];
        EnfVec3 flat = enf_v3(state->normal.x, 0.0, state->normal.z), foot = game->gates[gates[count]].foot;
        EnfVec3 step = enf_scale(enf_normalize(flat), fabs(state->normal.y) > 0.7 ? 0.0 : BESIDE_GATE);
        for (int side = enf_dot(step, step) > 0.0 ? 0 : 1; side < 2;
             side++) { /* on stairs through a floor, one point is enough */
            way->at[way->count] = side ? enf_add(foot, step) : enf_sub(foot, step);
            way->gate[way->count++] = gates[count];
        }
    }
    return true;
}

/* Shortest on foot: doorways that can be walked through alone, shut ones too (they can be opened). Points before and behind each, so
 * that nobody cuts its corners. */
bool sim_route(Game *game, const SimErrand *errand, SimWay *way) {
    const EnfMap *map = game->map;
    SimWays *ways = &game->ways;
    way->count = way->next = 0;
    if (errand->from_cell >= map->cells_count || errand->to_cell >= map->cells_count) {
        return false;
    }
    clear(game, ways);
    uint32_t cell = errand->from_cell, passed = ENF_NONE;
    uint32_t shun = errand->shun, twin = shun == ENF_NONE ? ENF_NONE : map->portals[shun].twin;
    while (cell != errand->to_cell) {
        EnfVec3 at = passed == ENF_NONE ? errand->from : game->gates[passed].foot;
        double run = passed == ENF_NONE ? 0.0 : ways->distance[passed];
        const EnfCell *c = &map->cells[cell];
        for (uint32_t p = c->portal_first; p < c->portal_first + c->portal_count; p++) {
            if (game->gates[p].walkable && p != shun && p != twin) {
                reach(ways, p, run + enf_length(enf_sub(game->gates[p].foot, at)), passed);
            }
        }
        if (ways->heap_count == 0) {
            return false;
        }
        passed = pop(ways);
        cell = map->portals[passed].target;
    }
    if (!lay_stops(game, passed, way)) {
        way->count = 0;
        return false;
    }
    way->at[way->count] = errand->to;
    way->gate[way->count++] = ENF_NONE;
    return true;
}

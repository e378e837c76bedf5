/* Feet, a goal, a collider → places to walk (foot.h). */
#include "sim/foot.h"

#include <math.h>
#include <string.h>

/* Metres: of the lattice; a fall that is no stumble; the height within which a place is on the goal's storey. */
#define PACE 0.25
#define STEP_DOWN 0.5
#define STOREY 1.2
#define UPSTAIRS 1.3 /* a goal so much higher is searched from */
#define BESIDE 0.6   /* near enough to the feet that walk there */
/* More than 1, ways become up to so much longer than the shortest, and the search many times shorter (weighted A*, Pohl 1970). */
#define EAGER 1.25

static const int32_t WAYS[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

static double flat(EnfVec3 a, EnfVec3 b) {
    double x = a.x - b.x, z = a.z - b.z;
    return sqrt(x * x + z * z);
}

/* ---- open nodes, nearest first ------------------------------------------------------------------------------------------- */

static bool before(const SimFoot *foot, uint32_t a, uint32_t b) {
    const SimFootNode *n = foot->nodes;
    return n[a].total < n[b].total || (!(n[b].total < n[a].total) && a < b);
}

static void put(SimFoot *foot, uint32_t at, uint32_t node) {
    foot->heap[at] = node;
    foot->nodes[node].place = at + 1;
}

static void rise(SimFoot *foot, uint32_t at) {
    uint32_t node = foot->heap[at];
    for (; at > 0 && before(foot, node, foot->heap[(at - 1) / 2]); at = (at - 1) / 2) {
        put(foot, at, foot->heap[(at - 1) / 2]);
    }
    put(foot, at, node);
}

static uint32_t pop(SimFoot *foot) {
    uint32_t first = foot->heap[0], last = foot->heap[--foot->heap_count], at = 0;
    foot->nodes[first].place = 0;
    for (uint32_t child = 1; foot->heap_count > 0 && child < foot->heap_count; child = 2 * at + 1) {
        child += child + 1 < foot->heap_count && before(foot, foot->heap[child + 1], foot->heap[child]);
        if (!before(foot, foot->heap[child], last)) {
            break;
        }
        put(foot, at, foot->heap[child]);
        at = child;
    }
    if (foot->heap_count > 0) {
        put(foot, at, last);
    }
    return first;
}

/* ---- footholds -------------------------------------------------------------------------------------------------------------- */

/* The slot of a foothold: storeys of stairs lie over one another. */
static uint32_t *slot_of(SimFoot *foot, int32_t x, int32_t z, double y) {
    uint32_t hash = ((uint32_t)x * 73856093u) ^ ((uint32_t)z * 19349663u);
    for (uint32_t i = hash % SIM_FOOT_TABLE;; i = (i + 1) % SIM_FOOT_TABLE) {
        uint32_t node = foot->table[i];
        const SimFootNode *n = node ? &foot->nodes[node - 1] : NULL;
        if (!n || (n->x == x && n->z == z && fabs(n->at.y - y) < STOREY)) {
            return &foot->table[i];
        }
    }
}

typedef struct Stand {
    EnfVec3 at;
    double ground; /* see foot.h */
} Stand;

/* Where a body comes to stand that goes `way` from `from`; false if it does not get there. */
static bool walk(EnfCollider *collider, const EnfCharacterDef *def, const Stand *from, EnfVec3 way, Stand *to) {
    EnfCapsule capsule = {def->radius, def->height};
    EnfSweepHit hit;
    EnfVec3 up = from->at;
    if (enf_collide_sweep(collider, &capsule, up, way, &hit)) { /* level first: under a low arch there is no room for a step */
        enf_collide_sweep(collider, &capsule, up, enf_v3(0.0, def->step, 0.0), &hit);
        up.y += def->step * hit.t;
        if (enf_collide_sweep(collider, &capsule, up, way, &hit)) {
            return false;
        }
    }
    EnfVec3 over = enf_add(up, way), down = enf_v3(0.0, from->at.y - up.y - STEP_DOWN, 0.0);
    if (!enf_collide_sweep(collider, &capsule, over, down, &hit) || hit.face.y < def->slope_cos) {
        return false;
    }
    to->at = enf_add(over, enf_scale(down, hit.t));
    to->ground = hit.normal.y >= def->slope_cos ? to->at.y : fmin(from->ground, to->at.y);
    return to->at.y - from->ground <= def->step + 0.01;
}

static void reach(SimFoot *foot, int32_t x, int32_t z, const Stand *stand, uint32_t parent) {
    EnfVec3 at = stand->at;
    uint32_t *slot = slot_of(foot, x, z, at.y);
    double cost = parent == ENF_NONE ? 0.0 : foot->nodes[parent].cost + enf_length(enf_sub(at, foot->nodes[parent].at));
    double total = cost + EAGER * flat(at, foot->to);
    if (*slot) {
        SimFootNode *node = &foot->nodes[*slot - 1];
        if (node->place && cost < node->cost) {
            *node = (SimFootNode){at, stand->ground, cost, total, x, z, parent, node->place};
            rise(foot, node->place - 1);
        }
    } else if (foot->node_count < foot->place_max && cost + flat(at, foot->to) <= foot->farthest) {
        uint32_t number = foot->node_count++;
        *slot = number + 1;
        foot->nodes[number] = (SimFootNode){at, stand->ground, cost, total, x, z, parent, 0};
        put(foot, foot->heap_count, number);
        rise(foot, foot->heap_count++);
    }
}

/* Too long, it is its first part. */
static void lay_path(SimFoot *foot, uint32_t last) {
    uint32_t count = 0, over = 0;
    for (uint32_t n = last; n != ENF_NONE; n = foot->nodes[n].parent) {
        count++;
    }
    foot->path_count = count < SIM_FOOT_PATH ? count : SIM_FOOT_PATH;
    over = count - foot->path_count;
    for (uint32_t n = last, i = 0; n != ENF_NONE; n = foot->nodes[n].parent, i++) {
        if (foot->up && i < foot->path_count) {
            foot->path[i] = foot->nodes[n].at;
        } else if (!foot->up && i >= over) {
            foot->path[count - 1 - i] = foot->nodes[n].at;
        }
    }
}

void sim_foot_begin(SimFoot *foot, EnfCollider *collider, const EnfCharacterDef *def, const SimFootAsk *ask) {
    EnfVec3 from = ask->from;
    memset(foot->table, 0, sizeof foot->table);
    foot->node_count = foot->heap_count = foot->path_count = 0;
    foot->def = *def;
    foot->to = ask->to;
    foot->near = ask->near;
    foot->up = ask->to.y > ask->from.y + UPSTAIRS;
    if (foot->up) {
        EnfCapsule capsule = {def->radius, def->height};
        enf_collide_way_out(collider, &capsule, enf_add(ask->to, enf_v3(0.0, 0.02, 0.0)), 0.5, &from);
        foot->to = ask->from;
        foot->near = fmax(ask->near, BESIDE);
    }
    foot->farthest = ask->farthest;
    foot->nearest = HUGE_VAL;
    foot->best = 0;
    foot->place_max = ask->places < SIM_FOOT_NODES ? ask->places : SIM_FOOT_NODES;
    reach(foot, 0, 0, &(Stand){from, from.y}, ENF_NONE);
}

/* A foothold becomes one that is done with; true if it is where the search was to lead. */
static bool settle(SimFoot *foot, EnfCollider *collider) {
    uint32_t number = pop(foot);
    SimFootNode node = foot->nodes[number];
    double away = flat(node.at, foot->to), above = fabs(node.at.y - foot->to.y);
    double miss = away + (above < STOREY ? 0.0 : above);
    if (miss < foot->nearest) {
        foot->nearest = miss;
        foot->best = number;
    }
    if (away <= foot->near && above < STOREY) {
        return true;
    }
    for (int i = 0; i < 8; i++) {
        EnfVec3 way = enf_v3(PACE * WAYS[i][0], 0.0, PACE * WAYS[i][1]);
        Stand stand;
        const uint32_t *slot = slot_of(foot, node.x + WAYS[i][0], node.z + WAYS[i][1], node.at.y);
        const SimFootNode *known = *slot ? &foot->nodes[*slot - 1] : NULL;
        bool done = known && (known->place == 0 || known->cost <= node.cost + PACE * (i < 4 ? 1.0 : 1.41421));
        if (!done && walk(collider, &foot->def, &(Stand){node.at, node.ground}, way, &stand)) {
            reach(foot, node.x + WAYS[i][0], node.z + WAYS[i][1], &stand, number);
        }
    }
    return false;
}

SimFootNews sim_foot_more(SimFoot *foot, EnfCollider *collider, uint32_t places) {
    for (; foot->heap_count > 0; places--) {
        if (places == 0) {
            return SIM_FOOT_GOES_ON;
        }
        if (settle(foot, collider)) {
            break;
        }
    }
    bool leads = foot->nearest <= foot->near;
    if (leads || !foot->up) {
        lay_path(foot, foot->best);
    }
    return leads ? SIM_FOOT_LEADS : SIM_FOOT_NEARS;
}

bool sim_foot_find(SimFoot *foot, EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double near) {
    sim_foot_begin(foot, collider, &body->def, &(SimFootAsk){body->position, to, near, HUGE_VAL, SIM_FOOT_NODES});
    return sim_foot_more(foot, collider, UINT32_MAX) == SIM_FOOT_LEADS;
}

bool sim_foot_straight(EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double most) {
    Stand stand = {body->position, body->position.y}, next;
    double gone = 0.0;
    while (gone < most) {
        double away = flat(stand.at, to);
        if (away < PACE) {
            return fabs(stand.at.y - to.y) < STOREY;
        }
        EnfVec3 way = enf_scale(enf_v3(to.x - stand.at.x, 0.0, to.z - stand.at.z), PACE / away);
        if (!walk(collider, &body->def, &stand, way, &next)) {
            return false;
        }
        stand = next;
        gone += PACE;
    }
    return true;
}

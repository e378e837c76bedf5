/* Feet, a goal, a collider → places to walk (foot.h). */
#include "sim/foot.h"

#include <math.h>
#include <string.h>

/* Metres: of the lattice; a fall that is no stumble; the height within which a place is on the goal's storey. */
#define PACE 0.25
#define STEP_DOWN 0.5
#define STOREY 1.2

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

/* Where a body comes to stand that goes `way` from `from`; false if it does not get there. */
static bool walk(EnfCollider *collider, const EnfCharacterDef *def, EnfVec3 from, EnfVec3 way, EnfVec3 *to) {
    EnfCapsule capsule = {def->radius, def->height};
    EnfSweepHit hit;
    EnfVec3 up = from;
    if (enf_collide_sweep(collider, &capsule, from, way,
                          &hit)) { /* level first: under a low arch there is no room for a step */
        enf_collide_sweep(collider, &capsule, from, enf_v3(0.0, def->step, 0.0), &hit);
        up = enf_add(from, enf_v3(0.0, def->step * hit.t, 0.0));
        if (enf_collide_sweep(collider, &capsule, up, way, &hit)) {
            return false;
        }
    }
    EnfVec3 over = enf_add(up, way), down = enf_v3(0.0, from.y - up.y - STEP_DOWN, 0.0);
    if (!enf_collide_sweep(collider, &capsule, over, down, &hit) || hit.face.y < def->slope_cos) {
        return false;
    }
    *to = enf_add(over, enf_scale(down, hit.t));
    return true;
}

static void reach(SimFoot *foot, int32_t x, int32_t z, EnfVec3 at, uint32_t parent, EnfVec3 goal) {
    uint32_t *slot = slot_of(foot, x, z, at.y);
    double cost = parent == ENF_NONE ? 0.0 : foot->nodes[parent].cost + enf_length(enf_sub(at, foot->nodes[parent].at));
    if (*slot) {
        SimFootNode *node = &foot->nodes[*slot - 1];
        if (node->place && cost < node->cost) {
            *node = (SimFootNode){at, cost, cost + flat(at, goal), x, z, parent, node->place};
            rise(foot, node->place - 1);
        }
    } else if (foot->node_count < SIM_FOOT_NODES) {
        uint32_t number = foot->node_count++;
        *slot = number + 1;
        foot->nodes[number] = (SimFootNode){at, cost, cost + flat(at, goal), x, z, parent, 0};
        put(foot, foot->heap_count, number);
        rise(foot, foot->heap_count++);
    }
}

static void lay_path(SimFoot *foot, uint32_t last) {
    uint32_t count = 0, over = 0;
    for (uint32_t n = last; n != ENF_NONE; n = foot->nodes[n].parent) {
        count++;
    }
    over = count > SIM_FOOT_PATH ? count - SIM_FOOT_PATH : 0; /* too long: its first part */
    foot->path_count = count - over;
    for (uint32_t n = last; count-- > 0; n = foot->nodes[n].parent) {
        if (count < foot->path_count) {
            foot->path[count] = foot->nodes[n].at;
        }
    }
}

bool sim_foot_find(SimFoot *foot, EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double near) {
    memset(foot->table, 0, sizeof foot->table);
    foot->node_count = foot->heap_count = foot->path_count = 0;
    reach(foot, 0, 0, body->position, ENF_NONE, to);
    uint32_t best = 0;
    double nearest = HUGE_VAL;
    while (foot->heap_count > 0) {
        uint32_t number = pop(foot);
        SimFootNode node = foot->nodes[number];
        double away = flat(node.at, to), above = fabs(node.at.y - to.y);
        double miss = away + (above < STOREY ? 0.0 : above);
        if (miss < nearest) {
            nearest = miss;
            best = number;
        }
        if (away <= near && above < STOREY) {
            break;
        }
        for (int i = 0; i < 8; i++) {
            EnfVec3 at, way = enf_v3(PACE * WAYS[i][0], 0.0, PACE * WAYS[i][1]);
            const uint32_t *slot = slot_of(foot, node.x + WAYS[i][0], node.z + WAYS[i][1], node.at.y);
            bool done = *slot && foot->nodes[*slot - 1].place == 0;
            if (!done && walk(collider, &body->def, node.at, way, &at)) {
                reach(foot, node.x + WAYS[i][0], node.z + WAYS[i][1], at, number, to);
            }
        }
    }
    lay_path(foot, best);
    return nearest <= near;
}

/* Ways on foot through a room full of furniture: footholds on a lattice, each reached from one beside it by what a walking body does
 * (up a step, across, down), found nearest first (A*, Hart, Nilsson & Raphael 1968). For bots; no part of the game's state. */
#ifndef ENF_GAME_SIM_FOOT_H
#define ENF_GAME_SIM_FOOT_H

#include <enfilade/collide.h>

enum { SIM_FOOT_NODES = 6000, SIM_FOOT_TABLE = 16384, SIM_FOOT_PATH = 512 };

typedef struct SimFootNode {
    EnfVec3 at;
    double cost, total;     /**< metres from the start; and, at least, on to the goal */
    int32_t x, z;           /**< lattice */
    uint32_t parent, place; /**< place in the heap + 1; 0: done with */
} SimFootNode;

/** Working memory of a search, and what it found. */
typedef struct SimFoot {
    SimFootNode nodes[SIM_FOOT_NODES];
    uint32_t table[SIM_FOOT_TABLE]; /**< node + 1 */
    uint32_t heap[SIM_FOOT_NODES];
    uint32_t node_count, heap_count;
    EnfVec3 path[SIM_FOOT_PATH];
    uint32_t path_count;
} SimFoot;

/** Fills path with places of the feet from beside `from` to within `near` metres of `to` in the plan and a storey of it in height; true
 *  if it leads there, else it leads to the foothold nearest to it. Costs up to 10^5 sweeps. */
bool sim_foot_find(SimFoot *foot, EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double near);

#endif

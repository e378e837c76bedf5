/* Ways on foot through a room full of furniture: footholds on a lattice, each reached from one beside it by what a walking body does
 * (up a step, across, down), found nearest first (A*, Hart, Nilsson & Raphael 1968). For bots at once, for guards a few footholds a tick. */
#ifndef ENF_GAME_SIM_FOOT_H
#define ENF_GAME_SIM_FOOT_H

#include <enfilade/collide.h>

enum { SIM_FOOT_NODES = 6000, SIM_FOOT_TABLE = 16384, SIM_FOOT_PATH = 512 };

typedef struct SimFootNode {
    EnfVec3 at;
    double ground;      /**< height of the last firm ground on the way here: on an edge nobody stands, nor steps up from it */
    double cost, total; /**< metres from the start; and, at least, on to the goal */
    int32_t x, z;       /**< lattice */
    uint32_t parent, place; /**< place in the heap + 1; 0: done with */
} SimFootNode;

/** Working memory of a search, and what it found. */
typedef struct SimFoot {
    SimFootNode nodes[SIM_FOOT_NODES];
    uint32_t table[SIM_FOOT_TABLE]; /**< node + 1 */
    uint32_t heap[SIM_FOOT_NODES];
    uint32_t node_count, heap_count;
    EnfCharacterDef def; /**< of who walks */
    EnfVec3 to;
    double near, nearest; /**< metres wanted; come to so far, by node `best` */
    double farthest;      /**< metres of way at most */
    uint32_t up;          /**< 1: searched from above */
    uint32_t best, place_max;
    EnfVec3 path[SIM_FOOT_PATH];
    uint32_t path_count;
} SimFoot;

typedef enum SimFootNews { SIM_FOOT_GOES_ON, SIM_FOOT_LEADS, SIM_FOOT_NEARS } SimFootNews;

/** What is searched: from a free place of the feet to within `near` metres of another in the plan and a storey of it in height, over
 *  at most `places` footholds (SIM_FOOT_NODES). */
typedef struct SimFootAsk {
    EnfVec3 from, to;
    double near, farthest; /**< farthest: longer ways are none */
    uint32_t places;
} SimFootAsk;

/** Begins a search for a body like this. To a place upstairs it goes from above: a stair leads down to a floor, but a floor not
 *  everywhere to a stair. */
void sim_foot_begin(SimFoot *foot, EnfCollider *collider, const EnfCharacterDef *def, const SimFootAsk *ask);
/** Goes on with it from so many footholds more, each some 20 sweeps. LEADS: path is a way from `from` there;
 *  NEARS: there is none, path leads to the foothold nearest to it, or, upstairs, nowhere (path_count is 0). */
SimFootNews sim_foot_more(SimFoot *foot, EnfCollider *collider, uint32_t places);
/** Both at once, to the end: up to 10^5 sweeps. True if it leads there. */
bool sim_foot_find(SimFoot *foot, EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double near);
/** Can the body simply walk straight to `to`, or for the first `most` metres of the way? Some 10 sweeps a metre. */
bool sim_foot_straight(EnfCollider *collider, const EnfCharacter *body, EnfVec3 to, double most);

#endif

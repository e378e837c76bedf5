/* What the files of this room share. Everything hashed is plain data without padding. */
#ifndef ENF_GAME_SIM_SIM_H
#define ENF_GAME_SIM_SIM_H

#include "sim/foot.h"
#include "sim/game.h"

enum {
    SIM_SOUNDS_MAX = 64,
    SIM_SPOKEN_MAX = 32,
    SIM_KEY_SIZE = 32,
    SIM_STOPS_MAX = 32,
    SIM_ROUTE_MAX = 64,
    SIM_TRACK_MAX = 64
};

/** Metres along the ways beyond which the player hears nothing. */
#define SIM_HEARD_MOST 45.0
/** Metres: how far a hand reaches. */
#define SIM_REACH 2.0

/** Metres along the ways at which a step is heard. */
#define SIM_HEARD_WALK 6.0
#define SIM_HEARD_RUN 16.0
#define SIM_HEARD_CROUCH 1.5
/** What a guard notices, of 1 that makes it chase: a second of somebody fully seen nearby adds the rate; a step heard nearby adds
 *  HEARD, up to HEARD_MOST; from WONDERS on it stops and looks; unseen, it fades by so much a second. */
#define SIM_NOTICE_RATE 0.6
#define SIM_NOTICE_CROUCHED 0.6 /* of it, who crouches */
#define SIM_NOTICE_HEARD 0.3
#define SIM_NOTICE_HEARD_MOST 0.6
#define SIM_NOTICE_WONDERS 0.4
#define SIM_NOTICE_FADES 0.15

/* ---- the state --------------------------------------------------------------------------------------------------- */

typedef struct SimPlayer {
    EnfCharacter body;
    int32_t yaw, pitch; /**< 1/65536 degree */
    uint32_t buttons;   /**< of the tick before */
    uint32_t steps;     /**< footsteps made */
    double stride;      /**< metres since the last */
} SimPlayer;

typedef struct SimDoor {
    EnfObjectId object;
    uint32_t mover, portal;
    uint64_t key;    /**< hash of the key's name; 0: none */
    uint64_t name;   /**< hash of targetname; leaves with one name open together */
    double wanted;   /**< radians or metres */
    double open;     /**< the far end of its range: where opening leads */
    int64_t shut_at; /**< tick at which it begins to close, or INT64_MAX */
    int64_t stays;   /**< ticks that it stays open; 0: for ever */
    int64_t turned;  /**< tick at which it turned back last, for somebody in its way */
    uint32_t locked, moving;
    uint32_t cell, pad; /**< of its middle when shut: where it is heard from */
} SimDoor;

typedef struct SimLift {
    EnfObjectId object;
    uint32_t mover, stop, stop_count, moving;
    uint32_t from, cell; /**< the stop that it left; the cell of its place at the start */
    uint64_t name;
    int64_t turned; /**< as a door's */
    EnfVec3 start;
    double stops[SIM_STOPS_MAX];
} SimLift;

typedef struct SimButton {
    uint32_t object, stop; /**< ENF_NONE: the next stop */
    uint64_t target;
} SimButton;

typedef enum SimItemState { SIM_ITEM_LIES, SIM_ITEM_CARRIED, SIM_ITEM_OUT } SimItemState;
typedef struct SimItem {
    uint32_t mover, state, value, is_key;
    uint64_t key; /**< hash of the name of what it opens; of a key */
    EnfVec3 at;   /**< where it lies */
} SimItem;

/** A way on foot: its stops in order, and the half-portal that each belongs to (ENF_NONE: the end). */
typedef struct SimWay {
    EnfVec3 at[SIM_ROUTE_MAX];
    uint32_t gate[SIM_ROUTE_MAX];
    uint32_t count, next;
} SimWay;

/** Where a guard off its round walks (walks.c). */
typedef struct SimWalk {
    EnfVec3 to;
    SimWay way;
    EnfVec3 track[SIM_TRACK_MAX],
        track_to;   /**< footholds to a stop of the way, where there is more to it than going straight */
    double nearest; /**< metres that it has come near to what it heads for */
    int64_t way_at; /**< tick at which the way was found */
    uint32_t to_cell, track_count, track_next;
    uint32_t still;       /**< ticks without coming nearer */
    uint32_t tries;       /**< of this stop that led nowhere */
    uint32_t shun, shuns; /**< a half-portal not to be gone through, for it led nowhere; how many there were */
    uint32_t wants;       /**< 1: a track is to be searched */
    uint32_t door;        /**< ticks before a door that opens */
    uint32_t lost;        /**< 1: no way leads there */
} SimWalk;

typedef struct SimGuard {
    EnfObjectId object;
    uint32_t mover, mood;
    EnfCharacter body;
    double yaw_deg, notice;
    EnfVec3 last_seen; /**< where the player was when seen or heard last, or where he is looked for */
    EnfVec3 home;      /**< the place of its round to which it returns */
    int64_t home_at;   /**< the tick of the round there */
    int64_t seen_at;   /**< tick at which it saw him last */
    int64_t until;     /**< tick at which the mood ends */
    int64_t start;     /**< tick at which its round's path began: time 0 */
    double stride;
    uint32_t sees, last_cell, home_cell, start_cell;
    uint32_t turned, pad; /**< turned: ticks of looking round */
    SimWalk walk;
} SimGuard;

typedef struct SimScore {
    uint64_t tick;
    uint32_t phase, delivered, value, wanted;
} SimScore;

/* ---- the portal graph (routes.c) ----------------------------------------------------------------------------------- */

/** A doorway: the middle of a portal, the place where feet pass it, and whether they can. */
typedef struct SimGate {
    EnfVec3 middle, foot;
    bool walkable;
} SimGate;

/** From where to where. */
typedef struct SimErrand {
    EnfVec3 from, to;
    uint32_t from_cell, to_cell;
    uint32_t shun; /**< a half-portal that is as good as walled up, both ways, or ENF_NONE */
} SimErrand;

/** Shortest ways from a point through portals. */
typedef struct SimWays {
    EnfVec3 from;
    uint32_t cell;
    double *distance; /**< a half-portal: metres to its middle, or HUGE_VAL */
    uint32_t *before; /**< the half-portal passed before, or ENF_NONE */
    uint32_t *heap, *place, heap_count;
} SimWays;

/** Something that sounds by itself (speakers.c). Not hashed: of the map alone. */
typedef struct SimSpeaker {
    EnfVec3 at;                       /**< where it stands; of what moves: from its mover's place */
    uint32_t id, voice, mover, cell;  /**< mover ENF_NONE: it stands still */
    int64_t phase_ticks, every_ticks; /**< of `phase`, `sound_every` */
} SimSpeaker;

struct Game {
    GameDef def;
    EnfAllocator allocator;
    const EnfMap *map;
    EnfWorld *world;
    EnfPortals portals;
    EnfVis *eyes; /**< the guards' */
    EnfCollider *collider;
    SimGate *gates; /**< a half-portal */
    SimWays ways, ears;
    SimFoot foot;        /**< the guards' search for footholds, one at a time */
    EnfVec3 foot_to;     /**< the stop that is searched */
    uint32_t foot_guard; /**< whose it is, or ENF_NONE */
    double usual_light;
    EnfVec3 spawn;
    int32_t spawn_yaw;
    EnfBox3 exit_ws; /**< empty: there is none */

    SimPlayer player;
    SimDoor *doors;
    SimLift *lifts;
    SimButton *buttons;
    SimItem *items;
    SimGuard *guards;
    uint32_t door_count, lift_count, button_count, item_count, guard_count;
    EnfObjectId
        *item_objects; /**< one an item: what it is in the world while it lies. Not hashed: ids are of this run of the world */
    int64_t begin;     /**< the world's tick at the start of this game */
    uint32_t mover_room; /**< allocated of each of the five above */
    SimScore score;
    uint64_t random;

    GameState shown;
    GameGuardView *guard_views;
    GameExhibitView *exhibit_views;
    GameSound sounds[SIM_SOUNDS_MAX];
    uint32_t sound_cells[SIM_SOUNDS_MAX];
    uint32_t sound_count;
    SimSpeaker *speakers;
    uint32_t speaker_count, speaker_room;
    GameSpeaker spoken[SIM_SPOKEN_MAX];
    uint32_t spoken_count;
    int64_t message_until;
    bool ears_ready;
};

/* ---- extras.c ------------------------------------------------------------------------------------------------------ */

/** The value of `key` in a flat JSON object as text (strings without quotes, escapes left as they are), cut to `size`; false if absent. */
bool sim_extra(const char *extras, const char *key, char *out, size_t size);
/** The same as a number; `standard` if absent or none. Accepts what a person writes: sign, digits, point, exponent. */
double sim_extra_number(const char *extras, const char *key, double standard);
/** A hash of a name; 0 for "". */
uint64_t sim_name(const char *text);

/* ---- game.c --------------------------------------------------------------------------------------------------------- */

uint64_t sim_random(Game *game);
/** Ticks since the start of this game: what every time in the state counts, so that a game started anew is bit for bit the first. */
int64_t sim_tick(const Game *game);
/** The same moment as motions and the world count it. */
int64_t sim_world_tick(const Game *game);
/** The cell of a body's feet, which on stairs is not that of its eye. */
uint32_t sim_feet_cell(const Game *game, const EnfCharacter *body);
void sim_say(Game *game, const char *text);
/** `cell`: of the place, which whoever makes the sound knows (to locate it costs a hundred times what the sound does). */
void sim_sound(Game *game, GameSoundKind kind, EnfVec3 at_ws, uint32_t cell, double loudness);
/** Degrees as the player looks: a unit vector. */
EnfVec3 sim_look(double yaw_deg, double pitch_deg);
/** Degrees: where something turned so looks with its own -z, level. */
double sim_yaw(EnfQuat turn);

/* ---- the parts ------------------------------------------------------------------------------------------------------- */

void sim_player_start(Game *game);
void sim_player_step(Game *game, const EnfInput *input);

void sim_doors_start(Game *game);
void sim_doors_step(Game *game);
/** Opens the door (and the leaves of its name) if it may: `keys` true for who has a key to everything. Leaves that can go both ways go
 *  away from `from` (NULL: as they went last). False if it is locked. */
bool sim_door_open(Game *game, uint32_t door, bool keys, const EnfVec3 *from);
/** The nearest door within `reach` of a point, towards `look` (zero: any side); ENF_NONE. */
uint32_t sim_door_near(const Game *game, EnfVec3 at, EnfVec3 look, double reach);
/** The first door that a body's straight way between two places meets; ENF_NONE. */
uint32_t sim_door_between(const Game *game, EnfVec3 from, EnfVec3 to);
/** Somebody is squeezed by this object of the world: if it is a door or an elevator, it goes back where it came from. */
void sim_turn_back(Game *game, uint32_t object);

void sim_lifts_start(Game *game);
void sim_lifts_step(Game *game);
void sim_lift_call(Game *game, uint64_t name, uint32_t stop);

void sim_items_start(Game *game);
void sim_items_step(Game *game);
/** What `use` means where the player stands; does it if `now`. Fills the prompt. */
void sim_use(Game *game, bool now);
void sim_drop(Game *game);
bool sim_has_key(const Game *game, uint64_t key);

void sim_guards_start(Game *game);
void sim_guards_step(Game *game);
/** Something of the player's was heard at a place, `metres` far. */
void sim_guards_hear(Game *game, EnfVec3 at, double metres);

typedef enum SimGoNews { SIM_GO_ON, SIM_GO_THERE, SIM_GO_NOWHERE } SimGoNews;
/** The guard is after the player from now on: off its round if it was on it, and heard to say so; longer, if it already was. */
void sim_guard_chase(Game *game, SimGuard *guard);
/** A guard sets out anew. */
void sim_walk_start(SimGuard *guard);
/** One tick on foot: along portals, up and down stairs, round furniture, through doors, to within `near` metres. NOWHERE: every way it
 *  tried ends at something; it may go on trying. */
SimGoNews sim_walk(Game *game, SimGuard *guard, const SimErrand *errand, double speed, double near);
/** One tick of the search for footholds, for whichever guard wants one. */
void sim_walk_search(Game *game);
/** Towards a place, as fast as a guard turns. */
void sim_turn_to(SimGuard *guard, EnfVec3 to);

/** A guard's round: its path of the map, from when it began it. */
EnfMotion sim_round(const Game *game, const SimGuard *guard);
/** Settles where the guard comes back to its round: home, home_at, home_cell. */
void sim_round_find(Game *game, SimGuard *guard);
/** Back on its path, which goes on from there. */
void sim_round_resume(Game *game, SimGuard *guard);
/** The object is where the body is, from this tick on. */
void sim_guard_push(Game *game, SimGuard *guard);
/** The body is where the path has it. */
void sim_guard_follow(Game *game, SimGuard *guard);
EnfVec3 sim_guard_eye(const SimGuard *guard);

/** An eye: where it is and how it is turned. */
typedef struct SimEye {
    EnfVec3 at;
    double yaw_deg;
    uint32_t cell;
} SimEye;

/** How much of a body an eye sees, 0..1: 0 without a window onto it, a free line, or light (sight.c). */
double sim_sight(Game *game, const SimEye *eye, const EnfCharacter *body);
/** The light at a point of a cell, 0..1, against what is usual in this map. */
double sim_light(const Game *game, uint32_t cell, EnfVec3 at);
double sim_usual_light(const Game *game);

/** Finds of every half-portal where it is and whether somebody gets through on foot. */
void sim_gates_find(Game *game);
void sim_ways_find(Game *game, SimWays *ways, EnfVec3 from, uint32_t cell, double most);
/** Metres along the ways to a point of a cell; `last` the half-portal by which it is entered (ENF_NONE: same cell). HUGE_VAL if none. */
double sim_ways_to(const Game *game, const SimWays *ways, EnfVec3 to, uint32_t cell, uint32_t *last);
/** The way on foot from one place to another; false if there is none. */
bool sim_route(Game *game, const SimErrand *errand, SimWay *way);

/** Fills in how the player hears a sound of that cell. */
void sim_hear(Game *game, GameSound *sound, uint32_t cell);

/** Finds what sounds by itself; false: no memory. */
bool sim_speakers_create(Game *game);

void sim_show(Game *game);

#endif

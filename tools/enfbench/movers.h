/* Moving objects in a grid of rooms: the scene of every experiment on dynamic bounding volumes, and the plain ways to do without
 * them. All techniques ask the same functions where an object is, so that they can be compared bit by bit. */
#ifndef ENFBENCH_MOVERS_H
#define ENFBENCH_MOVERS_H

#include "enfbench/bench.h"
#include "scenes/rooms.h"

#include <enfilade/vis.h>

/** LINEAR and FREE walk there and back on four points through a door; of a FREE one only the speed is told. SPLINE does so on a
 *  smooth curve, turning; CHARACTER evaluates thirty joints besides. */
typedef enum MoversMotion { MOVERS_FREE, MOVERS_LINEAR, MOVERS_SPLINE, MOVERS_CHARACTER } MoversMotion;
typedef enum MoversEye { MOVERS_STILL, MOVERS_WALK, MOVERS_JUMP } MoversEye;

typedef struct MoversDef {
    uint32_t rooms, movers, frames, seed;
    uint32_t
        visible;    /**< objects that stay in rooms seen on the eye's way (of a still eye, in its room); the rest stay in rooms
                             never seen. 0: all walk anywhere */
    uint32_t check; /**< every check-th frame is compared with brute force */
    uint32_t polygons;  /**< vertices of an object that are moved on the processor when it is evaluated */
    uint32_t furniture; /**< boxes a room */
    uint32_t period;    /**< ticks, of `constant`; the first of `adaptive`, `optimal` and `tbv` */
    double speed;       /**< metres a second, at most */
    double doors;       /**< percent of the inner walls */
    double door_width;
    double leaf;     /**< `hierarchical-z`, `tbv`: side of the octree's leaves, metres */
    bool occluders;  /**< of these two: moving objects hide others too */
    uint32_t rounds; /**< so often the same frames are run; a frame's time is its least */
    double budget;   /**< seconds that one technique may take; then it takes no more turns */
    MoversMotion motion;
    MoversEye eye;
    char techniques[BENCH_TEXT]; /**< names, separated by commas */
} MoversDef;

/** An object's motion: everything that it needs, in one place. */
typedef struct Mover {
    float points[4][3];
    float speed;            /**< metres a tick, at most */
    uint32_t phase, period; /**< ticks; there and back takes twice the period */
    uint32_t polygons;
    uint8_t motion;
} Mover;

/** Half the size of an object, metres. */
#define MOVER_WIDTH 0.3
#define MOVER_HEIGHT 0.9
/** It may be turned: half the width of what holds it then. */
#define MOVER_REACH 0.4375

EnfVec3 bench_mover_at(const Mover *mover, int64_t tick);
/** Of a straight way: the step from `tick` to the next, and how many ticks it is that long. */
EnfVec3 bench_mover_step(const Mover *mover, int64_t tick, double *ticks);
/** Position and turn, and the joints of a character; `user` is the Mover. */
EnfPose bench_mover_state(const void *mover, int64_t tick);
/** Its position and turn alone, bit by bit the same: polygons and joints, which are the cost of a frame, are left out. For checks, and
 *  for who moved these before in the same frame. */
EnfPose bench_mover_pose(const Mover *mover, int64_t tick);
EnfBox3 bench_mover_bound(const void *user, const EnfBox3 *local, int64_t tick0, int64_t tick1);
/** `evaluated`: its bounds are made from its whole state, as by those who move every object in every tick; then what is seen of it in
 *  that tick costs its pose alone. */
EnfObjectDef bench_mover_object(const Mover *mover, bool evaluated);
/** The object's own box at a pose: what EnfWorld answers, bit by bit. */
EnfBox3f bench_mover_box(const EnfPose *pose);

typedef struct MoversScene {
    MoversDef def;
    EnfRooms rooms;
    EnfPortals portals;
    EnfVis *vis;
    Mover *movers;
    EnfView *views; /**< one a frame */
} MoversScene;

bool bench_movers_open(MoversScene *scene, const MoversDef *def);
void bench_movers_close(MoversScene *scene);

/** A cell and what is seen of it; pyramids are relative to the cell. */
typedef struct MoversWindow {
    uint32_t cell;
    EnfPyramid pyramid;
} MoversWindow;

typedef struct MoversWindows {
    MoversWindow *items;
    uint32_t count, capacity;
} MoversWindows;

/** The windows of a set's visits. False without memory. */
bool bench_movers_windows(const MoversScene *scene, const EnfVisSet *set, MoversWindows *windows);
/** Does an object with this box touch a window's cell and pass its pyramid? */
bool bench_movers_shown(const MoversScene *scene, const MoversWindows *windows, EnfBox3f box);

/* ---- rivals.c: without volumes ---- */
typedef struct Rival Rival;
Rival *bench_rival_create(const MoversScene *scene, bool sweep);
void bench_rival_destroy(Rival *rival);
/** Every motion evaluated; the objects that the windows show, ascending. `flat` keeps a list a cell and looks into those of seen cells;
 *  `sweep` tests all boxes against the picture, eight at a time, and what is left against the windows. */
const uint32_t *bench_rival_frame(Rival *rival, const EnfView *view, const MoversWindows *windows, int64_t tick,
                                  uint32_t *count);

/** What `flat` knows after it has moved everything: positions, and the list of each room (ENF_NONE ends it). */
typedef struct RivalLists {
    const float *x, *y, *z;
    const uint32_t *heads, *next;
} RivalLists;
RivalLists bench_rival_lists(Rival *rival, int64_t tick);

/* ---- greene.c: the hierarchical Z-buffer, and temporal bounding volumes in its octree ---- */
typedef struct Greene Greene;
typedef struct GreeneCounters {
    uint64_t nodes, boxes, evaluated, exposed, expired, reinserted, avoided;
} GreeneCounters;
Greene *bench_greene_create(const MoversScene *scene, bool volumes);
void bench_greene_destroy(Greene *greene);
/** Brings the octree to `tick`; ticks come one by one. */
void bench_greene_move(Greene *greene, int64_t tick);
/** The objects that are not hidden there, ascending: all that show a pixel are among them. */
const uint32_t *bench_greene_look(Greene *greene, const EnfView *view, uint32_t *count);
GreeneCounters bench_greene_counters(const Greene *greene);
/** Of what it keeps for objects, and of the octree's nodes, which hold the building too. */
size_t bench_greene_bytes(const Greene *greene);

/* ---- truth.c: the picture itself ---- */
typedef struct Truth Truth;
Truth *bench_truth_create(const MoversScene *scene);
void bench_truth_destroy(Truth *truth);
/** Which objects show a pixel in a frame: valid until the next call. */
const bool *bench_truth_shown(Truth *truth, uint32_t frame);

/* ---- plain.c: the least that finding can cost ---- */
typedef struct Plain Plain;
Plain *bench_plain_create(const MoversScene *scene);
void bench_plain_destroy(Plain *plain);
/** The objects that it thinks are shown, in no order. */
const uint32_t *bench_plain_frame(Plain *plain, const EnfView *view, int64_t tick, uint32_t *count);

/** What a frame took and what an index did in it. */
typedef struct MoversFrame {
    double us;
    uint32_t exposed, appeared, expired, reinserted;
} MoversFrame;
void bench_frame_counters(MoversFrame *frame, const EnfDbvIndex *index);
/** The same frames once more: the lesser time of each is kept. */
void bench_frames_merge(MoversFrame *frames, const MoversFrame *others, uint32_t count);
/** Fills in the columns on time; sorts `frames`. `volumes`: those on what the slowest frame did, too. */
void bench_frames_row(MoversFrame *frames, uint32_t count, bool volumes, BenchRow *row);

/* ---- movers_lists.c: do the techniques list what they must? ---- */
typedef struct MoversLists {
    const char *technique;
    const uint64_t *hashes; /**< one a frame: of what was listed in it and in all before it */
    uint32_t frames;
    bool by_walls; /**< portals and the picture's edges alone decide: all such techniques list the same objects */
} MoversLists;
/** The first of the frames that both have in which they listed different objects; ENF_NONE without one. */
uint32_t bench_lists_part(const MoversLists *a, const MoversLists *b);
/** Did each technique list the same in this round as in the first? Else false, after a message for each that did not. */
bool bench_lists_repeat(const char *experiment, const char *scene, uint32_t round, const MoversLists *first,
                        const MoversLists *again, uint32_t count);
/** Did all that go by walls list the same? Else false, after a message for each that did not. */
bool bench_lists_agree(const char *experiment, const char *scene, const MoversLists *lists, uint32_t count);

/** What --set motion= and --set eye= take, by MoversMotion and MoversEye. */
extern const char *const bench_movers_motions[4], *const bench_movers_eyes[3];
/** Knobs that every experiment on movers has, over what `def` says. */
void bench_movers_knobs(BenchRun *run, MoversDef *def);
MoversDef bench_movers_default(void);
/** Are these, separated by commas, names of techniques, each once? */
bool bench_movers_known(const char *list);
/** Runs the techniques of `def` side by side and adds a row each. */
bool bench_movers_case(BenchRun *run, const char *experiment, const char *scene_name, const MoversDef *def);

#endif

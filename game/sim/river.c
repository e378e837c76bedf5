/* A path as text → an eye that floats along it (river.h). */
#include "sim/river.h"

#include "sim/text.h"

#include <math.h>
#include <string.h>

#define TICK (1.0 / ENF_TICK_RATE)
/* Metres between end and beginning of a path that closes: it then goes round, else it jumps back. */
#define CLOSED_WITHIN 3.0
/* Of the look: 1/s² and 1/s of the spring that turns it to where the path says (critically damped), and the share of the visitor's
 * own turn that is forgotten in a second without any. */
#define LOOK_SPRING 2.25
#define LOOK_DAMPING 3.0
#define TURN_FORGOTTEN 0.6
#define REST_TICKS (2 * ENF_TICK_RATE)
/* Metres beyond what its thrust holds it at, from which an eye that a wall keeps back slows the anchor, over how many it stops, and the
 * ticks at a stop after which the eye is put where the anchor is. */
#define WAITS_BEYOND 0.75
#define WAITS_OVER 1.5
#define GIVES_UP_TICKS 120
#define STANDS_BELOW 0.05 /* share of its speed: the anchor only nears the place where it would stop */
#define PASSES_BY 1.0     /* metres on, so that the eye is put behind what stopped it */
/* The eye as a thing: metres. */
#define EYE_RADIUS 0.15

enum { X, Y, Z, SPEED, SPRING, DAMPING, THRUST, LOOK_X, LOOK_Y, LOOK_Z, COLUMNS };

typedef struct Point {
    double value[COLUMNS];
    double along; /* metres from the beginning */
} Point;

struct GameRiver {
    EnfAllocator allocator;
    const EnfMap *map;
    EnfCollider *collider;
    Point *points;
    uint32_t count, capacity;
    double length;
    bool closed;

    uint32_t leg; /* the anchor is between this point and the next */
    double along;
    EnfVec3 velocity;
    double yaw, pitch, yaw_rate, pitch_rate; /* degrees, of the look that the path leads */
    double own_yaw, own_pitch;               /* what the visitor added */
    uint32_t still;                          /* ticks without a turn of his */
    uint32_t stopped;                        /* ticks that the anchor has waited */
    GameRiverView view;
};

/* ---- reading ------------------------------------------------------------------------------------------------------------ */

static EnfVec3 place(const Point *point) {
    return enf_v3(point->value[X], point->value[Y], point->value[Z]);
}

static EnfResult read_point(SimText line, uint32_t number, Point *point, EnfError *error) {
    static const char *const names[COLUMNS] = {"x",       "y",      "z",      "speed",  "spring",
                                               "damping", "thrust", "look_x", "look_y", "look_z"};
    static const double least[COLUMNS] = {-1e6, -1e6, -1e6, 0.01, 0.1, 0.1, 0.0, -1e6, -1e6, -1e6};
    /* A tick of Euler's method stays stable: damping < 1 / tick, spring < 1 / tick². */
    static const double most[COLUMNS] = {1e6, 1e6, 1e6, 100.0, 400.0, 40.0, 1000.0, 1e6, 1e6, 1e6};
    for (int i = 0; i < COLUMNS; i++) {
        char word[32];
        bool found = sim_text_word(&line, ',', word, sizeof word);
        if (!found || !sim_text_number(word, &point->value[i])) {
            return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u of the river: %s is no number", number,
                                 names[i]);
        }
        if (point->value[i] < least[i] || point->value[i] > most[i]) {
            return enf_error_set(error, ENF_ERROR_RANGE, UINT64_MAX, "line %u of the river: %s is not between %g and %g",
                                 number, names[i], least[i], most[i]);
        }
    }
    if (line.at < line.end) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "line %u of the river: more than %d numbers", number,
                             COLUMNS);
    }
    return ENF_OK;
}

static EnfResult add_point(GameRiver *river, SimText line, uint32_t number, EnfError *error) {
    if (river->count == GAME_RIVER_POINTS_MAX) {
        return enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "a river of more than %d points", GAME_RIVER_POINTS_MAX);
    }
    if (river->count == river->capacity) {
        uint32_t more = river->capacity ? 2 * river->capacity : 256;
        Point *grown = enf_realloc(&river->allocator, river->points, river->capacity, more, sizeof *grown);
        if (!grown) {
            return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a river");
        }
        river->points = grown;
        river->capacity = more;
    }
    Point point;
    EnfResult result = read_point(line, number, &point, error);
    if (result != ENF_OK) {
        return result;
    }
    point.along = 0.0;
    if (river->count > 0) {
        const Point *last = &river->points[river->count - 1];
        double step = enf_length(enf_sub(place(&point), place(last)));
        if (step < 1e-6) { /* a leg of no length has no direction */
            return ENF_OK;
        }
        point.along = last->along + step;
    }
    river->points[river->count++] = point;
    return ENF_OK;
}

static EnfResult read_path(GameRiver *river, SimText text, EnfError *error) {
    SimText line;
    for (uint32_t number = 1; sim_text_line(&text, &line); number++) {
        bool passed_over = line.at == line.end || *line.at == '#' || number == 1;
        EnfResult result = passed_over ? ENF_OK : add_point(river, line, number, error);
        if (result != ENF_OK) {
            return result;
        }
    }
    if (river->count < 2) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "a river of fewer than two points");
    }
    river->length = river->points[river->count - 1].along;
    river->closed = enf_length(enf_sub(place(&river->points[0]), place(&river->points[river->count - 1]))) <= CLOSED_WITHIN;
    return ENF_OK;
}

EnfResult game_river_create(GameRiver **out, const GameRiverDef *def, const EnfAllocator *allocator, EnfError *error) {
    ENF_ASSERT(out && def && def->map && (def->text || def->size == 0));
    *out = NULL;
    GameRiver *river = enf_alloc(allocator, 1, sizeof *river);
    if (!river) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a river");
    }
    river->allocator = *(allocator ? allocator : enf_default_allocator());
    river->map = def->map;
    river->collider = def->collider;
    EnfResult result = read_path(river, (SimText){def->text, def->text + def->size}, error);
    if (result != ENF_OK) {
        game_river_destroy(river);
        return result;
    }
    game_river_start(river, NULL);
    *out = river;
    return ENF_OK;
}

void game_river_destroy(GameRiver *river) {
    if (river) {
        EnfAllocator allocator = river->allocator;
        enf_free(&allocator, river->points, river->capacity, sizeof *river->points);
        enf_free(&allocator, river, 1, sizeof *river);
    }
}

/* ---- the anchor ----------------------------------------------------------------------------------------------------------- */

/* All columns where the anchor is. */
static Point anchor(const GameRiver *river) {
    const Point *a = &river->points[river->leg], *b = a + 1;
    double t = (river->along - a->along) / (b->along - a->along);
    Point here;
    for (int i = 0; i < COLUMNS; i++) {
        here.value[i] = a->value[i] + t * (b->value[i] - a->value[i]);
    }
    here.along = river->along;
    return here;
}

static void angles_to(EnfVec3 way, double *yaw, double *pitch) {
    double flat = sqrt(way.x * way.x + way.z * way.z);
    *yaw = flat > 1e-3 ? enf_atan2(-way.x, -way.z) * (180.0 / ENF_PI) : *yaw;
    *pitch = enf_atan2(way.y, flat) * (180.0 / ENF_PI);
}

/* The eye is at the anchor, at rest, looking where the path says. */
static void put(GameRiver *river) {
    Point here = anchor(river);
    river->velocity = enf_v3(0.0, 0.0, 0.0);
    river->yaw_rate = river->pitch_rate = river->own_yaw = river->own_pitch = 0.0;
    river->still = river->stopped = 0;
    GameRiverView *view = &river->view;
    view->eye_ws = view->eye_before_ws = place(&here);
    angles_to(enf_sub(enf_v3(here.value[LOOK_X], here.value[LOOK_Y], here.value[LOOK_Z]), view->eye_ws), &river->yaw,
              &river->pitch);
    view->yaw_deg = view->yaw_before_deg = river->yaw;
    view->pitch_deg = view->pitch_before_deg = river->pitch;
    view->cell = enf_map_locate(river->map, view->eye_ws);
}

void game_river_start(GameRiver *river, const EnfVec3 *at_ws) {
    double nearest = HUGE_VAL;
    river->leg = 0;
    river->along = 0.0;
    river->view.rounds = 0;
    for (uint32_t i = 0; at_ws && i + 1 < river->count; i++) {
        double away = enf_length(enf_sub(place(&river->points[i]), *at_ws));
        if (away < nearest) {
            nearest = away;
            river->leg = i;
            river->along = river->points[i].along;
        }
    }
    put(river);
}

/* Moves the anchor; true if it came to the end of an open path and jumped back. */
static bool drift(GameRiver *river, double metres) {
    bool jumped = false;
    river->along += metres;
    if (river->along >= river->length) {
        river->along = fmin(river->along - river->length, 0.5 * river->length);
        river->leg = 0;
        river->view.rounds++;
        jumped = !river->closed;
    }
    while (river->leg + 2 < river->count && river->along >= river->points[river->leg + 1].along) {
        river->leg++;
    }
    return jumped;
}

/* ---- the eye ---------------------------------------------------------------------------------------------------------------- */

static double unwound(double from, double to) {
    double turn = to - from;
    return turn - 360.0 * floor(turn / 360.0 + 0.5);
}

static void look(GameRiver *river, const Point *here, const EnfInput *input) {
    double yaw = river->yaw, pitch = river->pitch;
    angles_to(enf_sub(enf_v3(here->value[LOOK_X], here->value[LOOK_Y], here->value[LOOK_Z]), river->view.eye_ws), &yaw, &pitch);
    river->yaw_rate += (LOOK_SPRING * unwound(river->yaw, yaw) - LOOK_DAMPING * river->yaw_rate) * TICK;
    river->pitch_rate += (LOOK_SPRING * (pitch - river->pitch) - LOOK_DAMPING * river->pitch_rate) * TICK;
    river->yaw += river->yaw_rate * TICK;
    river->pitch += river->pitch_rate * TICK;
    bool turns = input->yaw != 0 || input->pitch != 0;
    river->still = turns ? 0 : river->still < REST_TICKS ? river->still + 1 : REST_TICKS;
    river->own_yaw += (double)input->yaw / ENF_INPUT_DEGREE;
    river->own_pitch += (double)input->pitch / ENF_INPUT_DEGREE;
    if (river->still == REST_TICKS) {
        /* Back by the short way, so that whole turns of the visitor's are not turned back. */
        river->own_yaw -= TURN_FORGOTTEN * TICK * unwound(0.0, river->own_yaw);
        river->own_pitch -= TURN_FORGOTTEN * TICK * river->own_pitch;
    }
    river->own_pitch = fmin(fmax(river->own_pitch, -89.0 - river->pitch), 89.0 - river->pitch);
    river->view.yaw_deg = river->yaw + river->own_yaw;
    river->view.pitch_deg = river->pitch + river->own_pitch;
}

static EnfVec3 push_of(const GameRiverView *view, const EnfInput *input) {
    double yaw = view->yaw_deg * (ENF_PI / 180.0), pitch = view->pitch_deg * (ENF_PI / 180.0);
    EnfVec3 ahead = enf_v3(-enf_sin(yaw) * enf_cos(pitch), enf_sin(pitch), -enf_cos(yaw) * enf_cos(pitch));
    EnfVec3 right = enf_v3(enf_cos(yaw), 0.0, -enf_sin(yaw));
    EnfVec3 push = enf_add(enf_scale(ahead, (double)input->forward / 32767.0),
                           enf_scale(right, (double)input->right / 32767.0));
    double size = enf_length(push);
    return size > 1.0 ? enf_scale(push, 1.0 / size) : push;
}

/* Moves the eye, along walls where there is a collider. */
static void float_by(GameRiver *river, EnfVec3 way) {
    EnfCapsule capsule = {EYE_RADIUS, 2.0 * EYE_RADIUS};
    EnfVec3 foot = enf_v3(0.0, -EYE_RADIUS, 0.0), from = enf_add(river->view.eye_ws, foot);
    for (int i = 0; river->collider && i < 3; i++) {
        EnfSweepHit hit;
        bool stopped = enf_collide_sweep(river->collider, &capsule, from, way, &hit);
        from = enf_add(from, enf_scale(way, hit.t));
        if (!stopped || hit.t <= 0.0) {
            way = enf_v3(0.0, 0.0, 0.0);
            break;
        }
        way = enf_scale(way, 1.0 - hit.t);
        way = enf_sub(way, enf_scale(hit.normal, fmin(enf_dot(way, hit.normal), 0.0)));
        river->velocity = enf_sub(river->velocity, enf_scale(hit.normal, fmin(enf_dot(river->velocity, hit.normal), 0.0)));
    }
    EnfVec3 to = river->collider ? enf_sub(from, foot) : enf_add(river->view.eye_ws, way);
    /* An eye that may pass walls is no walker, to be followed through doorways. */
    bool walks = river->collider && river->view.cell != ENF_NONE;
    river->view.cell = walks ? enf_map_track(river->map, river->view.cell, river->view.eye_ws, to)
                             : enf_map_locate(river->map, to);
    river->view.eye_ws = to;
}

/* The share of the current's speed at which the anchor goes: less, the farther the eye is behind a corner. */
static double pace(GameRiver *river, const Point *here) {
    double away = enf_length(enf_sub(place(here), river->view.eye_ws));
    double beyond = away - here->value[THRUST] / here->value[SPRING] - WAITS_BEYOND;
    double share = fmin(fmax(1.0 - beyond / WAITS_OVER, 0.0), 1.0);
    river->stopped = share > STANDS_BELOW ? 0 : river->stopped + 1;
    return share;
}

void game_river_step(GameRiver *river, const EnfInput *input) {
    static const EnfInput nobody;
    input = input ? input : &nobody;
    GameRiverView *view = &river->view;
    view->eye_before_ws = view->eye_ws;
    view->yaw_before_deg = view->yaw_deg;
    view->pitch_before_deg = view->pitch_deg;
    const Point *a = &river->points[river->leg];
    Point here = anchor(river);
    double speed = here.value[SPEED] * pace(river, &here);
    EnfVec3 current = enf_scale(enf_normalize(enf_sub(place(a + 1), place(a))), speed);
    /* What stands in the way for so long is gone round: put where the anchor waited, the eye would be stopped there again. */
    bool gives_up = river->stopped >= GIVES_UP_TICKS;
    if (drift(river, gives_up ? PASSES_BY : speed * TICK) || gives_up) {
        put(river);
        return;
    }
    look(river, &here, input);
    here = anchor(river);
    /* The damper works against the motion relative to the current: an eye left alone does not lag behind. */
    EnfVec3 force = enf_scale(enf_sub(place(&here), view->eye_ws), here.value[SPRING]);
    force = enf_sub(force, enf_scale(enf_sub(river->velocity, current), here.value[DAMPING]));
    force = enf_add(force, enf_scale(push_of(view, input), here.value[THRUST]));
    river->velocity = enf_add(river->velocity, enf_scale(force, TICK));
    float_by(river, enf_scale(river->velocity, TICK));
}

GameRiverView game_river_view(const GameRiver *river) {
    GameRiverView view = river->view;
    view.along = river->along;
    view.length = river->length;
    return view;
}

/* Makes the eye of a guided tour, tick by tick. */
#include "front/river.h"

#include <enfilade/world.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TICK (1.0 / ENF_TICK_RATE)
enum { FIELDS = 10, POINTS_MAX = 100000, LINE_MAX_SIZE = 512 };
/* How fast the guide turns his head: share of what is left, a second; and what the visitor turned comes back. */
#define HEAD_RATE 1.1
#define BACK_RATE 0.25

static bool parse_line(char *line, double values[FIELDS]) {
    char *at = line;
    for (int i = 0; i < FIELDS; i++) {
        int used = 0;
        if (sscanf(at, "%lf%n", &values[i], &used) != 1 || !isfinite(values[i]) || fabs(values[i]) > 1e6) {
            return false;
        }
        at += used;
        if (i + 1 < FIELDS && *at++ != ',') {
            return false;
        }
    }
    return *at == '\0' || *at == '\n' || *at == '\r';
}

static bool take(RiverPoint *point, char *line) {
    double v[FIELDS];
    if (!parse_line(line, v) || v[3] <= 0.0 || v[4] <= 0.0 || v[5] < 0.0) {
        return false;
    }
    RiverPoint made = {{v[0], v[1], v[2]}, v[3], v[4], v[5], v[6], {v[7], v[8], v[9]}};
    *point = made;
    return true;
}

static EnfResult add(River *river, char *line, EnfError *error) {
    if (river->count == river->capacity) {
        uint32_t wanted = river->capacity ? 2 * river->capacity : 256;
        RiverPoint *grown = wanted > POINTS_MAX
                                ? NULL
                                : enf_realloc(NULL, river->points, river->capacity, wanted, sizeof *river->points);
        if (!grown) {
            return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a path of %u points", wanted);
        }
        river->points = grown;
        river->capacity = wanted;
    }
    if (!take(&river->points[river->count], line)) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "point %u: ten numbers are wanted (speed and spring above 0)",
                             river->count + 1);
    }
    river->count++;
    return ENF_OK;
}

EnfResult river_read(River *river, const char *path, EnfError *error) {
    memset(river, 0, sizeof *river);
    FILE *file = fopen(path, "r");
    if (!file) {
        return enf_error_file(error, enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "no guided tour"), path);
    }
    char line[LINE_MAX_SIZE];
    EnfResult result = ENF_OK;
    bool header = true;
    while (result == ENF_OK && fgets(line, sizeof line, file)) {
        if (!header && line[0] != '\n' && line[0] != '#') {
            result = add(river, line, error);
        }
        header = false;
    }
    fclose(file);
    if (result == ENF_OK && river->count < 2) {
        result = enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "a guided tour has at least two points");
    }
    if (result != ENF_OK) {
        river_free(river);
        return enf_error_file(error, result, path);
    }
    river_start(river);
    return ENF_OK;
}

void river_free(River *river) {
    enf_free(NULL, river->points, river->capacity, sizeof *river->points);
    memset(river, 0, sizeof *river);
}

static EnfVec3 vector(const double v[3]) {
    return enf_v3(v[0], v[1], v[2]);
}

static EnfVec3 mix(EnfVec3 a, EnfVec3 b, double t) {
    return enf_add(a, enf_scale(enf_sub(b, a), t));
}

static double mix1(double a, double b, double t) {
    return a + (b - a) * t;
}

static double segment_length(const River *river) {
    return enf_length(enf_sub(vector(river->points[river->segment + 1].at), vector(river->points[river->segment].at)));
}

/* The way from the eye to a point, degrees. */
static void aim(EnfVec3 from, EnfVec3 to, double *yaw_deg, double *pitch_deg) {
    EnfVec3 d = enf_sub(to, from);
    double flat = enf_length(enf_v3(d.x, 0.0, d.z));
    if (flat > 0.2) {
        *yaw_deg = enf_atan2(-d.x, -d.z) * (180.0 / ENF_PI);
        *pitch_deg = enf_atan2(d.y, flat) * (180.0 / ENF_PI);
    }
}

void river_start(River *river) {
    river->segment = 0;
    river->along = 0.0;
    river->eye = river->eye_before = vector(river->points[0].at);
    river->velocity = enf_v3(0.0, 0.0, 0.0);
    river->yaw_deg = river->pitch_deg = 0.0;
    aim(river->eye, vector(river->points[0].look), &river->yaw_deg, &river->pitch_deg);
    river->yaw_before_deg = river->yaw_deg;
    river->pitch_before_deg = river->pitch_deg;
    river->turned_deg = river->raised_deg = 0.0;
    river->ended = false;
}

static double turned_back(double deg) {
    double turns = floor((deg + 180.0) / 360.0);
    return deg - 360.0 * turns;
}

/* Moves the anchor; returns the river's parameters there. */
static RiverPoint flow(River *river) {
    double length = segment_length(river), t = length > 0.0 ? river->along / length : 1.0;
    const RiverPoint *a = &river->points[river->segment], *b = a + 1;
    river->along += mix1(a->speed, b->speed, t) * TICK;
    while (river->along >= (length = segment_length(river)) && !river->ended) {
        river->along -= length;
        river->ended = ++river->segment + 1 >= river->count;
        if (river->ended) {
            river->segment = river->count - 2;
            river->along = segment_length(river);
        }
    }
    a = &river->points[river->segment];
    b = a + 1;
    length = segment_length(river);
    t = length > 0.0 ? river->along / length : 1.0;
    RiverPoint here = {{mix1(a->at[0], b->at[0], t), mix1(a->at[1], b->at[1], t), mix1(a->at[2], b->at[2], t)},
                       mix1(a->speed, b->speed, t),
                       mix1(a->spring, b->spring, t),
                       mix1(a->damping, b->damping, t),
                       mix1(a->thrust, b->thrust, t),
                       {mix1(a->look[0], b->look[0], t), mix1(a->look[1], b->look[1], t), mix1(a->look[2], b->look[2], t)}};
    return here;
}

static void turn_head(River *river, EnfVec3 look) {
    double yaw = river->yaw_deg, pitch = river->pitch_deg;
    aim(river->eye, look, &yaw, &pitch);
    double share = HEAD_RATE * TICK, back = 1.0 - BACK_RATE * TICK;
    river->yaw_before_deg = river->yaw_deg;
    river->pitch_before_deg = river->pitch_deg;
    river->yaw_deg += turned_back(yaw - river->yaw_deg) * share;
    river->pitch_deg += (pitch - river->pitch_deg) * share;
    river->turned_deg = turned_back(river->turned_deg) * back;
    river->raised_deg *= back;
}

void river_step(River *river) {
    if (river->ended) {
        river_start(river);
    }
    RiverPoint here = flow(river);
    double yaw = (river->yaw_deg + river->turned_deg) * (ENF_PI / 180.0);
    EnfVec3 look = enf_v3(-enf_sin(yaw), 0.0, -enf_cos(yaw));
    EnfVec3 pull = enf_scale(enf_sub(vector(here.at), river->eye), here.spring);
    EnfVec3 force = enf_add(enf_sub(pull, enf_scale(river->velocity, here.damping)), enf_scale(look, here.thrust));
    river->velocity = enf_add(river->velocity, enf_scale(force, TICK));
    river->eye_before = river->eye;
    river->eye = mix(river->eye, enf_add(river->eye, river->velocity), TICK);
    turn_head(river, vector(here.look));
}

/* Walks to one row of a path after another: turns towards it, goes ahead when it looks there. */
#include "enfreplay/steer.h"

#include <math.h>
#include <string.h>

/* Metres: a row nearer than ARRIVED is behind; STRIDE of the path are skipped where there is no way on. Degrees: TURN a tick at
 * most; ahead only if the row lies within CONE. Ticks without coming nearer: then it uses what is there, goes about it, jumps, gives up. */
static const double ARRIVED = 0.7, FLOOR = 2.2, STRIDE = 1.5, TURN_DEG = 9.0, CONE_DEG = 50.0, NEARER = 0.02;
enum { USE_AFTER = 15, SIDESTEP_AFTER = 45, SIDESTEP_TICKS = 30, JUMP_AFTER = 170, GIVE_UP_AFTER = 260, STOP_AFTER = 24 };

EnfResult steer_open(Steer *steer, const char *path, EnfError *error) {
    memset(steer, 0, sizeof *steer);
    steer->nearest = HUGE_VAL;
    return enf_path_csv_read(&steer->path, path, error);
}

void steer_close(Steer *steer) {
    enf_path_csv_free(&steer->path);
}

static EnfVec3 row_at(const Steer *steer, uint32_t row) {
    const EnfPathRow *r = &steer->path.rows[row];
    return enf_v3(r->x, r->y, r->z);
}

static double across(EnfVec3 way) {
    return sqrt(way.x * way.x + way.z * way.z);
}

static void aim_at(Steer *steer, uint32_t row) {
    steer->next = row;
    steer->nearest = HUGE_VAL;
    steer->vain = 0;
}

/* It begins with the row that is nearest. */
static void begin(Steer *steer, EnfVec3 eye_ws) {
    double nearest = HUGE_VAL;
    for (uint32_t row = 0; row < steer->path.count; row++) {
        double distance = enf_length(enf_sub(row_at(steer, row), eye_ws));
        if (distance < nearest) {
            nearest = distance;
            steer->next = row;
        }
    }
    steer->begun = true;
}

/* Rows that are reached are done with; one that cannot be reached is given up for one a stride farther on. */
static void advance(Steer *steer, EnfVec3 eye_ws) {
    uint32_t row = steer->next;
    while (row < steer->path.count) {
        EnfVec3 way = enf_sub(row_at(steer, row), eye_ws);
        if (across(way) > ARRIVED || fabs(way.y) > FLOOR) {
            break;
        }
        row++;
    }
    if (row != steer->next) {
        steer->in_a_row = 0;
        aim_at(steer, row);
    } else if (steer->vain >= GIVE_UP_AFTER) {
        double walked = 0.0;
        while (row + 1 < steer->path.count && walked < STRIDE) {
            walked += enf_length(enf_sub(row_at(steer, row + 1), row_at(steer, row)));
            row++;
        }
        steer->given_up += row - steer->next;
        steer->in_a_row++;
        aim_at(steer, walked < STRIDE || steer->in_a_row >= STOP_AFTER ? steer->path.count : row);
    }
}

/* Degrees from where the eye looks to where the way leads, in -180..180. */
static double turn_to(const SimEye *eye, EnfVec3 way) {
    double wanted = enf_atan2(-way.x, -way.z) * (180.0 / 3.14159265358979323846);
    return remainder(wanted - eye->yaw_deg, 360.0);
}

static int32_t turn_by(double degrees) {
    double step = degrees > TURN_DEG ? TURN_DEG : degrees < -TURN_DEG ? -TURN_DEG : degrees;
    return (int32_t)lround(step * ENF_INPUT_DEGREE);
}

/* At a row: looks where it says and presses `use` once. True when that is done. */
static bool use_there(const Steer *steer, const SimEye *eye, EnfInput *input) {
    const EnfPathRow *row = &steer->path.rows[steer->next];
    double yaw = remainder(row->yaw_deg - eye->yaw_deg, 360.0), pitch = row->pitch_deg - eye->pitch_deg;
    input->yaw = turn_by(yaw);
    input->pitch = turn_by(pitch);
    if (fabs(yaw) < 0.5 && fabs(pitch) < 0.5) {
        input->buttons = ENF_BUTTON_USE;
        return true;
    }
    return false;
}

/* Straight at one row after another, through walls. */
static bool fly_next(Steer *steer, const SimEye *eye, EnfInput *input) {
    if (!steer->begun) {
        steer->begun = true;
        input->buttons = ENF_BUTTON_NOCLIP;
        return true;
    }
    while (steer->next < steer->path.count && enf_length(enf_sub(row_at(steer, steer->next), eye->eye_ws)) < ARRIVED / 2.0) {
        if (steer->use && !use_there(steer, eye, input)) {
            return true;
        }
        steer->next++;
        if (steer->use) {
            return true;
        }
    }
    if (steer->next >= steer->path.count) {
        return false;
    }
    EnfVec3 way = enf_sub(row_at(steer, steer->next), eye->eye_ws);
    double yaw = across(way) > 0.01 ? turn_to(eye, way) : 0.0;
    double pitch = enf_atan2(way.y, across(way)) * (180.0 / 3.14159265358979323846) - eye->pitch_deg;
    bool aimed = fabs(yaw) < 8.0 && fabs(pitch) < 8.0;
    input->yaw = turn_by(yaw);
    input->pitch = turn_by(pitch);
    input->forward = !aimed ? 0 : enf_length(way) > 3.0 * ARRIVED ? 32767 : 9000;
    return true;
}

bool steer_next(Steer *steer, const SimEye *eye, EnfInput *input) {
    memset(input, 0, sizeof *input);
    if (steer->fly) {
        return fly_next(steer, eye, input);
    }
    if (!steer->begun) {
        begin(steer, eye->eye_ws);
    }
    advance(steer, eye->eye_ws);
    if (steer->next >= steer->path.count) {
        return false;
    }
    EnfVec3 way = enf_sub(row_at(steer, steer->next), eye->eye_ws);
    double distance = across(way), turn = turn_to(eye, way);
    if (distance < steer->nearest - NEARER) {
        steer->nearest = distance;
        steer->vain = 0;
    } else {
        steer->vain++;
    }
    input->yaw = turn_by(turn);
    input->pitch = -(int32_t)lround(remainder(eye->pitch_deg, 360.0) * 0.1 * ENF_INPUT_DEGREE);
    input->forward = fabs(turn) < CONE_DEG ? 32767 : 0;
    input->buttons = steer->run && fabs(turn) < CONE_DEG / 3.0 && distance > 2.0 * ARRIVED ? ENF_BUTTON_RUN : 0;
    if (steer->vain >=
        SIDESTEP_AFTER) { /* about what is in the way: ever wider, to one side and the other, backing off at first */
        uint32_t turn_of = (steer->vain - SIDESTEP_AFTER) / SIDESTEP_TICKS;
        input->right = turn_of % 3 == 0 ? 32767 : -32767;
        input->forward = turn_of % 3 == 1 ? -16384 : input->forward;
    }
    if (steer->vain > JUMP_AFTER && steer->vain % 60 < 10) {
        input->buttons |= ENF_BUTTON_JUMP;
    }
    if (steer->vain % 140 == USE_AFTER) {
        input->buttons |= ENF_BUTTON_USE;
    }
    return true;
}

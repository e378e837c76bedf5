/* Input that walks along a camera path, as a person would who follows a line on the floor. */
#ifndef ENFREPLAY_STEER_H
#define ENFREPLAY_STEER_H

#include "common/path_csv.h"
#include "enfreplay/sim.h"

typedef struct Steer {
    EnfPathCsv path;
    uint32_t next;     /**< row that is walked to */
    double nearest;    /**< metres that it has been approached to */
    uint32_t vain;     /**< ticks since it came nearer */
    uint32_t given_up; /**< rows that were skipped */
    uint32_t in_a_row; /**< times that one was, since one was reached */
    uint32_t buttons;  /**< of the last tick */
    bool run, fly, use, begun;
} Steer;

/** Reads the path; then set `run`, or `fly` to go straight through everything (it begins with noclip and the first row),
 *  and with that `use` to look as each row says and use what is there.
 *  The path: a CSV file: time,x,y,z,yaw,pitch, of the eye. Free with steer_close. */
EnfResult steer_open(Steer *steer, const char *path, EnfError *error);
void steer_close(Steer *steer);

/** The input of the next tick; false at the end of the path. Where there is no way on, it jumps, uses what is in front of it, and
 *  after some seconds takes a point of the path farther on; after many of them it stops. */
bool steer_next(Steer *steer, const SimEye *eye, EnfInput *input);

#endif

/* A guided tour: an anchor moves along an authored path; the visitor hangs on it by a spring, with damping, and thrusts where
 * he looks. All three vary along the path. Source: Galyean, Guided Navigation of Virtual Environments, I3D 1995. */
#ifndef GAME_FRONT_RIVER_H
#define GAME_FRONT_RIVER_H

#include <enfilade/math.h>

typedef struct RiverPoint {
    double at[3];
    double speed, spring, damping, thrust; /**< m/s; 1/s²; 1/s; m/s² */
    double look[3];                        /**< what there is to see */
} RiverPoint;

typedef struct River {
    RiverPoint *points;
    uint32_t count, capacity;
    uint32_t segment; /**< the anchor is between points[segment] and the next */
    double along;     /**< metres from the first of them */
    EnfVec3 eye, eye_before, velocity;
    double yaw_deg, pitch_deg, yaw_before_deg, pitch_before_deg; /**< the way the guide shows */
    double turned_deg, raised_deg;                               /**< the visitor's own look, relative to it */
    bool ended;                                                  /**< and begins anew with the next step */
} River;

/** Reads "x,y,z,speed,spring,damping,thrust,look_x,look_y,look_z". Errors name the line. */
EnfResult river_read(River *river, const char *path, EnfError *error);
void river_free(River *river);
void river_start(River *river);
/** One tick. */
void river_step(River *river);

#endif

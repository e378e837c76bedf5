/* The oracle of motion bounds: where a mover's box can be over a range of ticks, at every moment and not at ticks alone, by interval
 * arithmetic (interval.h) and subdivision of time. It takes the definitions of glTF 2.0 (appendix C) and of world.h, and no code of the
 * engine: rotations are matrices of quaternions that were not normalised, cubic curves are Bernstein polynomials, slerp turns in the
 * plane of its two ends, hinges turn by Rodrigues' formula.
 *
 * Nothing escapes `outer`: for each piece of time either the interval of the box lies within it, or the piece is halved. `inner` was
 * attained. Where both are as near as was asked, the truth is known that well. */
#ifndef ENF_SCENES_MOTION_ORACLE_H
#define ENF_SCENES_MOTION_ORACLE_H

#include <enfilade/world.h>

typedef struct EnfSweep {
    EnfBox3 inner;   /**< lies within the hull of all the box's places */
    EnfBox3 outer;   /**< holds that hull */
    bool known;      /**< no piece of time was given up: outer is inner, widened by what was asked */
    uint32_t pieces; /**< intervals looked at */
} EnfSweep;

/** Of a motion that is no callback and is not asked. `error`: metres, how near outer shall come to inner. A FREE object may have gone
 *  anywhere that its speed allows since its push, until tick1. */
EnfSweep enf_motion_oracle(const EnfMotion *motion, const EnfBox3 *local, int64_t tick0, int64_t tick1, double error);

#endif

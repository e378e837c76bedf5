/* Normals and colours as a vertex of the map stores them. */
#ifndef ENFILADE_COMPILE_PACK_H
#define ENFILADE_COMPILE_PACK_H

#include <stdint.h>

/** Three signed 10-bit fields, as EnfVertex.normal has them; `n` is unit. */
static inline uint32_t enf_pack_normal(const float n[3]) {
    uint32_t packed = 0;
    for (int axis = 0; axis < 3; axis++) {
        double scaled = (double)n[axis] * 511.0;
        int32_t rounded = (int32_t)(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
        rounded = rounded > 511 ? 511 : rounded < -511 ? -511 : rounded;
        packed |= ((uint32_t)rounded & 0x3ffu) << (10 * axis);
    }
    return packed;
}

/** RGBA8, R in the low byte, as EnfVertex.color has it. */
static inline uint32_t enf_pack_color(const float color[4]) {
    uint32_t packed = 0;
    for (int channel = 0; channel < 4; channel++) {
        double c = (double)color[channel];
        c = c > 0 ? (c < 1 ? c : 1) : 0;
        packed |= (uint32_t)(c * 255.0 + 0.5) << (8 * channel);
    }
    return packed;
}

#endif

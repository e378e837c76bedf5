/* The only intrinsics of the house: boxes against planes, one box or eight at a time.
 *
 * Plain arrays in, masks out; no type of another room but EnfPyramid. Every variant gives the same bits: each lane computes
 * ((nx*x + ny*y) + nz*z) + d in float32, one rounding an operation, and rejects on `< 0` (so a NaN keeps the box). */
#ifndef ENF_SIMD_SIMD_H
#define ENF_SIMD_SIMD_H

#include <enfilade/geom.h>

/** Planes padded to a whole number of AVX registers. */
#define ENF_SIMD_PLANES 40
/** Floats of eight boxes: min x, y, z and max x, y, z, eight lanes each; behind them eight u32 (an EnfKdBlock). */
#define ENF_SIMD_BOX8 48

/** A pyramid ready for testing. Bit i of an `active` mask is plane i. */
typedef struct EnfSimdPlanes {
    float nx[ENF_SIMD_PLANES], ny[ENF_SIMD_PLANES], nz[ENF_SIMD_PLANES], d[ENF_SIMD_PLANES];
    /** Where in eight boxes the corners farthest along a plane's normal lie: a compare for each plane and block saved. */
    uint8_t far_x[ENF_SIMD_PLANES], far_y[ENF_SIMD_PLANES], far_z[ENF_SIMD_PLANES];
    uint32_t count;
    uint64_t all; /**< the mask with every plane active */
} EnfSimdPlanes;

typedef enum EnfSimdKind { ENF_SIMD_SCALAR, ENF_SIMD_SSE2, ENF_SIMD_AVX2, ENF_SIMD_KIND_COUNT } EnfSimdKind;

/** One variant. */
typedef struct EnfSimd {
    const char *name;
    /** One box of eight floats: min x, y, z, unused, max x, y, z, unused (an EnfKdNode). False if it is outside an active plane;
     *  else clears in *active the planes that contain it wholly. Rounding is monotone, so a box within this one would have
     *  passed the cleared planes too: skipping them below changes no result. */
    bool (*node)(const EnfSimdPlanes *planes, const float *box, uint64_t *active);
    /** Eight boxes. Bit 8 + i is set if lane i is in use (its u32 is not ENF_NONE); bit i if it is, and box i is not outside an
     *  active plane. */
    uint32_t (*boxes)(const EnfSimdPlanes *planes, const float *boxes, uint64_t active);
} EnfSimd;

/** The variant in use: the best that this processor has, asked once. Thread-safe. */
const EnfSimd *enf_simd(void);
/** Uses `kind` from now on, for tests and measurements; false, and no change, if this processor or build lacks it. */
bool enf_simd_force(EnfSimdKind kind);
/** Back to the best one. */
void enf_simd_automatic(void);

/** Copies and pads. The pad planes contain everything. */
void enf_simd_planes(EnfSimdPlanes *out, const EnfPyramid *pyramid);

/* The variants, or NULL where the build or the processor has none. */
const EnfSimd *enf_simd_scalar(void);
const EnfSimd *enf_simd_sse2(void);
const EnfSimd *enf_simd_avx2(void);

/** Index of the lowest set bit of a mask that is not 0. */
static inline uint32_t enf_simd_lowest(uint64_t mask) {
#if defined(__GNUC__)
    return (uint32_t)__builtin_ctzll(mask);
#else
    uint32_t i = 0;
    while (!(mask >> i & 1)) {
        i++;
    }
    return i;
#endif
}

/** Number of set bits of an eight-bit mask; SSE2 has no instruction for it. */
static inline uint32_t enf_simd_bits(uint32_t mask) {
    mask -= mask >> 1 & 0x55;
    mask = (mask & 0x33) + (mask >> 2 & 0x33);
    return (mask + (mask >> 4)) & 0xf;
}

#endif

/* 113-bit arithmetic for oracles: products and differences of doubles with room to spare. x86-64 has it as __float128,
 * aarch64 as long double; both compute the same bits, in software or not. */
#ifndef ENF_TESTS_QUAD_H
#define ENF_TESTS_QUAD_H

#include <float.h>

#if LDBL_MANT_DIG == 113
typedef long double Quad;
#elif defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;
#else
#error "the oracles need a 113-bit type"
#endif

/* A double in 113 bits: exact. The cast is explicit, as every widening here is meant. */
static inline Quad quad(double x) {
    return (Quad)x;
}

static inline Quad quad_abs(Quad x) {
    return x < quad(0.0) ? -x : x;
}

static inline Quad quad_min(Quad a, Quad b) {
    return a < b ? a : b;
}

static inline Quad quad_max(Quad a, Quad b) {
    return a > b ? a : b;
}

#endif

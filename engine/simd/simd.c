/* The choice of a variant, and the scalar twin that the others are tested against. */
#include "simd/simd.h"

#include <stdatomic.h>
#include <string.h>

/* ---- scalar twin ------------------------------------------------------------------------------------------------ */

/* The plane at the corner where its normal points to `high`: the farthest one; with `low` and `high` swapped, the nearest. */
static float corner(const EnfSimdPlanes *p, uint32_t i, const float *low, const float *high) {
    float x = p->nx[i] >= 0.0f ? high[0] : low[0];
    float y = p->ny[i] >= 0.0f ? high[1] : low[1];
    float z = p->nz[i] >= 0.0f ? high[2] : low[2];
    return ((p->nx[i] * x + p->ny[i] * y) + p->nz[i] * z) + p->d[i];
}

static bool scalar_node(const EnfSimdPlanes *planes, const float *box, uint64_t *active) {
    uint64_t left = *active;
    for (uint64_t rest = left; rest; rest &= rest - 1) {
        uint32_t i = enf_simd_lowest(rest);
        if (corner(planes, i, box, box + 4) < 0.0f) {
            return false;
        }
        if (corner(planes, i, box + 4, box) >= 0.0f) {
            left &= ~(UINT64_C(1) << i);
        }
    }
    *active = left;
    return true;
}

static uint32_t scalar_boxes(const EnfSimdPlanes *planes, const float *boxes, uint64_t active) {
    uint32_t mask = 0xff;
    for (uint64_t rest = active; rest && mask; rest &= rest - 1) {
        uint32_t i = enf_simd_lowest(rest);
        const float *x = boxes + planes->far_x[i];
        const float *y = boxes + planes->far_y[i];
        const float *z = boxes + planes->far_z[i];
        for (uint32_t lane = 0; lane < 8; lane++) {
            float v = ((planes->nx[i] * x[lane] + planes->ny[i] * y[lane]) + planes->nz[i] * z[lane]) + planes->d[i];
            mask &= ~((uint32_t)(v < 0.0f) << lane);
        }
    }
    uint32_t used = 0;
    for (uint32_t lane = 0; lane < 8; lane++) {
        uint32_t item;
        memcpy(&item, boxes + ENF_SIMD_BOX8 + lane, sizeof item);
        used |= (uint32_t)(item != ENF_NONE) << lane;
    }
    return (mask & used) | used << 8;
}

const EnfSimd *enf_simd_scalar(void) {
    static const EnfSimd simd = {"scalar", scalar_node, scalar_boxes};
    return &simd;
}

/* ---- choice ----------------------------------------------------------------------------------------------------- */

static _Atomic(const EnfSimd *) chosen;

static const EnfSimd *best(void) {
    const EnfSimd *simd = enf_simd_avx2();
    simd = simd ? simd : enf_simd_sse2();
    return simd ? simd : enf_simd_scalar();
}

const EnfSimd *enf_simd(void) {
    const EnfSimd *simd = atomic_load_explicit(&chosen, memory_order_relaxed);
    if (!simd) { /* two threads may both ask: they get the same answer */
        simd = best();
        atomic_store_explicit(&chosen, simd, memory_order_relaxed);
    }
    return simd;
}

bool enf_simd_force(EnfSimdKind kind) {
    const EnfSimd *simd = kind == ENF_SIMD_AVX2 ? enf_simd_avx2() : kind == ENF_SIMD_SSE2 ? enf_simd_sse2() : enf_simd_scalar();
    if (simd) {
        atomic_store_explicit(&chosen, simd, memory_order_relaxed);
    }
    return simd != NULL;
}

void enf_simd_automatic(void) {
    atomic_store_explicit(&chosen, best(), memory_order_relaxed);
}

/* ---- planes ----------------------------------------------------------------------------------------------------- */

/* `count` floats, then zeros up to a whole register. The first eight, all there are for a box window, without a loop. */
static inline void copy_padded(float *to, const float *from, uint32_t count) {
    uint32_t padded = (count + 7) & ~7u;
    memcpy(to, from, 8 * sizeof *to);
    if (count > 8) {
        memcpy(to, from, count * sizeof *to);
    }
    for (uint32_t i = count; i < padded; i++) {
        to[i] = 0.0f;
    }
}

void enf_simd_planes(EnfSimdPlanes *out, const EnfPyramid *pyramid) {
    ENF_ASSERT(pyramid->count <= ENF_PYRAMID_PLANES);
    copy_padded(out->nx, pyramid->nx, pyramid->count);
    copy_padded(out->ny, pyramid->ny, pyramid->count);
    copy_padded(out->nz, pyramid->nz, pyramid->count);
    copy_padded(out->d, pyramid->d, pyramid->count);
    for (uint32_t i = 0; i < pyramid->count; i++) {
        out->far_x[i] = pyramid->nx[i] >= 0.0f ? 24 : 0;
        out->far_y[i] = pyramid->ny[i] >= 0.0f ? 32 : 8;
        out->far_z[i] = pyramid->nz[i] >= 0.0f ? 40 : 16;
    }
    out->count = pyramid->count;
    out->all = (UINT64_C(1) << pyramid->count) - 1;
}

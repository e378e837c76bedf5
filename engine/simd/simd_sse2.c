/* The SSE2 variant: four lanes, the base of x86-64. */
#include "simd/simd.h"

#if defined(__SSE2__) && !defined(ENF_NOSIMD)

#include <emmintrin.h>

/* ((nx*x + ny*y) + nz*z) + d, as every variant has it. */
static inline __m128 dot4(__m128 n[4], __m128 x, __m128 y, __m128 z) {
    __m128 xy = _mm_add_ps(_mm_mul_ps(n[0], x), _mm_mul_ps(n[1], y));
    return _mm_add_ps(_mm_add_ps(xy, _mm_mul_ps(n[2], z)), n[3]);
}

/* a where the mask is set, else b. */
static inline __m128 choose(__m128 mask, __m128 a, __m128 b) {
    return _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b));
}

/* Four planes a step against one box. */
static bool sse2_node(const EnfSimdPlanes *planes, const float *box, uint64_t *active) {
    const __m128 zero = _mm_setzero_ps();
    __m128 low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = _mm_set1_ps(box[axis]);
        high[axis] = _mm_set1_ps(box[axis + 4]);
    }
    uint64_t left = *active;
    for (uint32_t i = 0; i < planes->count; i += 4) {
        uint64_t here = left >> i & 0xf;
        if (!here) {
            continue;
        }
        __m128 n[4] = {_mm_loadu_ps(planes->nx + i), _mm_loadu_ps(planes->ny + i), _mm_loadu_ps(planes->nz + i),
                       _mm_loadu_ps(planes->d + i)};
        __m128 px = _mm_cmpge_ps(n[0], zero), py = _mm_cmpge_ps(n[1], zero), pz = _mm_cmpge_ps(n[2], zero);
        __m128 out = dot4(n, choose(px, high[0], low[0]), choose(py, high[1], low[1]), choose(pz, high[2], low[2]));
        if ((uint64_t)(uint32_t)_mm_movemask_ps(_mm_cmplt_ps(out, zero)) & here) {
            return false;
        }
        __m128 in = dot4(n, choose(px, low[0], high[0]), choose(py, low[1], high[1]), choose(pz, low[2], high[2]));
        uint64_t inside = (uint64_t)(uint32_t)_mm_movemask_ps(_mm_cmpge_ps(in, zero));
        left &= ~(inside << i);
    }
    *active = left;
    return true;
}

static uint32_t sse2_boxes(const EnfSimdPlanes *planes, const float *boxes, uint64_t active) {
    const __m128 zero = _mm_setzero_ps();
    __m128 out_low = zero, out_high = zero;
    for (uint64_t rest = active; rest; rest &= rest - 1) {
        uint32_t i = enf_simd_lowest(rest);
        const float *x = boxes + planes->far_x[i];
        const float *y = boxes + planes->far_y[i];
        const float *z = boxes + planes->far_z[i];
        __m128 n[4] = {_mm_set1_ps(planes->nx[i]), _mm_set1_ps(planes->ny[i]), _mm_set1_ps(planes->nz[i]),
                       _mm_set1_ps(planes->d[i])};
        __m128 a = dot4(n, _mm_loadu_ps(x), _mm_loadu_ps(y), _mm_loadu_ps(z));
        __m128 b = dot4(n, _mm_loadu_ps(x + 4), _mm_loadu_ps(y + 4), _mm_loadu_ps(z + 4));
        out_low = _mm_or_ps(out_low, _mm_cmplt_ps(a, zero));
        out_high = _mm_or_ps(out_high, _mm_cmplt_ps(b, zero));
    }
    uint32_t out = (uint32_t)_mm_movemask_ps(out_low) | (uint32_t)_mm_movemask_ps(out_high) << 4;
    const __m128i none = _mm_set1_epi32(-1);
    const __m128i *items = (const __m128i *)(const void *)(boxes + ENF_SIMD_BOX8);
    __m128i free_low = _mm_cmpeq_epi32(_mm_loadu_si128(items), none);
    __m128i free_high = _mm_cmpeq_epi32(_mm_loadu_si128(items + 1), none);
    uint32_t used = ~((uint32_t)_mm_movemask_ps(_mm_castsi128_ps(free_low)) |
                      (uint32_t)_mm_movemask_ps(_mm_castsi128_ps(free_high)) << 4) &
                    0xff;
    return (~out & used) | used << 8;
}

const EnfSimd *enf_simd_sse2(void) {
    static const EnfSimd simd = {"sse2", sse2_node, sse2_boxes};
    return &simd;
}

#else

const EnfSimd *enf_simd_sse2(void) {
    return NULL;
}

#endif

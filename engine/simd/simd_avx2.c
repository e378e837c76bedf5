/* The AVX2 variant: eight lanes. Compiled with -mavx2 (and no -mfma: a fused multiply-add would change the bits); called only
 * where the processor has it. */
#include "simd/simd.h"

#if defined(__AVX2__) && !defined(ENF_NOSIMD)

#include <immintrin.h>

/* ((nx*x + ny*y) + nz*z) + d, as every variant has it. */
static inline __m256 dot8(__m256 n[4], __m256 x, __m256 y, __m256 z) {
    __m256 xy = _mm256_add_ps(_mm256_mul_ps(n[0], x), _mm256_mul_ps(n[1], y));
    return _mm256_add_ps(_mm256_add_ps(xy, _mm256_mul_ps(n[2], z)), n[3]);
}

/* Eight planes a step against one box: the planes of a box window are one step. */
static bool avx2_node(const EnfSimdPlanes *planes, const float *box, uint64_t *active) {
    const __m256 zero = _mm256_setzero_ps();
    __m256 low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = _mm256_broadcast_ss(box + axis);
        high[axis] = _mm256_broadcast_ss(box + axis + 4);
    }
    uint64_t left = *active;
    for (uint32_t i = 0; i < planes->count; i += 8) {
        uint64_t here = left >> i & 0xff;
        if (!here) {
            continue;
        }
        __m256 n[4] = {_mm256_loadu_ps(planes->nx + i), _mm256_loadu_ps(planes->ny + i), _mm256_loadu_ps(planes->nz + i),
                       _mm256_loadu_ps(planes->d + i)};
        __m256 px = _mm256_cmp_ps(n[0], zero, _CMP_GE_OQ), py = _mm256_cmp_ps(n[1], zero, _CMP_GE_OQ),
               pz = _mm256_cmp_ps(n[2], zero, _CMP_GE_OQ);
        __m256 out = dot8(n, _mm256_blendv_ps(low[0], high[0], px), _mm256_blendv_ps(low[1], high[1], py),
                          _mm256_blendv_ps(low[2], high[2], pz));
        if ((uint64_t)(uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(out, zero, _CMP_LT_OQ)) & here) {
            return false;
        }
        __m256 in = dot8(n, _mm256_blendv_ps(high[0], low[0], px), _mm256_blendv_ps(high[1], low[1], py),
                         _mm256_blendv_ps(high[2], low[2], pz));
        uint64_t inside = (uint64_t)(uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(in, zero, _CMP_GE_OQ));
        left &= ~(inside << i);
    }
    *active = left;
    return true;
}

static uint32_t avx2_boxes(const EnfSimdPlanes *planes, const float *boxes, uint64_t active) {
    const __m256 zero = _mm256_setzero_ps();
    __m256 out = zero;
    for (uint64_t rest = active; rest; rest &= rest - 1) {
        uint32_t i = enf_simd_lowest(rest);
        const float *x = boxes + planes->far_x[i];
        const float *y = boxes + planes->far_y[i];
        const float *z = boxes + planes->far_z[i];
        __m256 n[4] = {_mm256_broadcast_ss(planes->nx + i), _mm256_broadcast_ss(planes->ny + i),
                       _mm256_broadcast_ss(planes->nz + i), _mm256_broadcast_ss(planes->d + i)};
        __m256 v = dot8(n, _mm256_loadu_ps(x), _mm256_loadu_ps(y), _mm256_loadu_ps(z));
        out = _mm256_or_ps(out, _mm256_cmp_ps(v, zero, _CMP_LT_OQ));
    }
    __m256i items = _mm256_loadu_si256((const __m256i *)(const void *)(boxes + ENF_SIMD_BOX8));
    __m256i unused = _mm256_cmpeq_epi32(items, _mm256_set1_epi32(-1));
    uint32_t used = ~(uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(unused)) & 0xff;
    return (~(uint32_t)_mm256_movemask_ps(out) & used) | used << 8;
}

const EnfSimd *enf_simd_avx2(void) {
    static const EnfSimd simd = {"avx2", avx2_node, avx2_boxes};
    return __builtin_cpu_supports("avx2") ? &simd : NULL;
}

#else

const EnfSimd *enf_simd_avx2(void) {
    return NULL;
}

#endif

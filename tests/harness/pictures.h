/* Pictures of everything and of what was not culled, compared: four of RGBA bytes, colours and ids of each. */
#ifndef ENF_TESTS_PICTURES_H
#define ENF_TESTS_PICTURES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/** Everything: colours, ids; culled: colours, ids. */
typedef struct EnfTestPictures {
    const uint8_t *of[4];
    size_t pixels; /**< of each */
} EnfTestPictures;

static inline uint32_t enf_test_id_at(const uint8_t *ids, size_t pixel) {
    const uint8_t *p = ids + pixel * 4;
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline bool enf_test_same_pixel(const EnfTestPictures *pictures, size_t pixel) {
    size_t at = pixel * 4;
    return memcmp(pictures->of[0] + at, pictures->of[2] + at, 4) == 0 &&
           memcmp(pictures->of[1] + at, pictures->of[3] + at, 4) == 0;
}

/** Is what the picture of everything shows in a pixel really there? */
typedef bool (*EnfTestIsReal)(const void *user, size_t pixel);

/** Pixels that differ, and of which `is_real` says that the picture of everything is right. */
static inline uint32_t enf_test_count_lost(const EnfTestPictures *pictures, EnfTestIsReal is_real, const void *user) {
    uint32_t count = 0;
    for (size_t i = 0; i < pictures->pixels; i++) {
        count += !enf_test_same_pixel(pictures, i) && is_real(user, i) ? 1U : 0U;
    }
    return count;
}

/** Where in a pixel rays are sent that ask what is there, in pixels: its middle and eight places close to it. */
enum { ENF_TEST_RAYS = 9 };
static inline void enf_test_ray_of(size_t pixel, uint32_t width, int ray, double uv[2]) {
    uv[0] = (double)(pixel % width) + 0.5 + 0.02 * (ray % 3 - 1);
    uv[1] = (double)(pixel / width) + 0.5 + 0.02 * (ray / 3 - 1);
}

static inline uint32_t enf_test_differing(const uint8_t *a, const uint8_t *b, size_t pixels) {
    uint32_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        count += memcmp(a + 4 * i, b + 4 * i, 4) != 0;
    }
    return count;
}

#endif

/* EnfGlBake: the light of a map, computed once. Pure data, no GL call. */
#ifndef ENFILADE_GL_BAKE_H
#define ENFILADE_GL_BAKE_H

#include "gl/charts.h"
#include "gl/lights.h"

/** Light from nowhere: from below, from above (R, G, B), and a slanting key (X, Y, Z) that tells walls apart. */
typedef struct EnfGlAmbient {
    float ground[3], sky[3], key[3];
} EnfGlAmbient;

/** Light is stored as the square root of half of it, in bytes: 0 to 2, finer in the dark. */
typedef struct EnfGlBake {
    uint32_t *vertex_light;   /**< a vertex: RGBA8, R in the low byte; full where the light map has it */
    uint16_t (*vertex_uv)[2]; /**< a vertex: its place in the light map, 1/32 texel */
    uint8_t *texels;          /**< RGBA8, width × height; the block at the corner is full */
    uint32_t width, height;
    uint32_t vertex_count;
    bool has_charts;    /**< without any, the texels are the full block alone */
    EnfGlLights lights; /**< what it was made from, for what moves */
    EnfGlAmbient ambient;
    bool lamps; /**< the map has lights: the brightest are dimmed (enf_gl_bake_build) */
} EnfGlBake;

/** Free with enf_gl_bake_free, also after a failure. @cost vertices and texels times the lights near them. */
EnfResult enf_gl_bake_build(EnfGlBake *bake, const EnfMap *map, uint32_t max_size, EnfError *error);
void enf_gl_bake_free(EnfGlBake *bake);

#endif

/* EnfGlLights: which lights may reach each cluster, as the fragment shader reads it. Pure data, no GL call. */
#ifndef ENFILADE_GL_LIGHTS_H
#define ENFILADE_GL_LIGHTS_H

#include <enfilade/map.h>

/** Floats of a light as one cell sees it, four texels: position relative to the cell's origin, 1/range² (0: none) ·
 *  colour × exposure, kind · direction, spot scale · spot offset, first plane, plane count, 0. */
#define ENF_GL_LIGHT_FLOATS 16
/** Lights that one cluster can have. */
#define ENF_GL_LIGHTS_MAX 255

typedef struct EnfGlLights {
    float *records;          /**< ENF_GL_LIGHT_FLOATS each: one for each (cell, light) */
    float *planes;           /**< four floats each; a plane with n = 0 ends a window */
    uint32_t *items;         /**< record numbers, the lists one after the other */
    uint32_t *cluster_lists; /**< a cluster's list: first << 8 | count */
    uint32_t record_count, record_capacity, plane_count, plane_capacity, item_count, item_capacity;
    uint32_t cluster_count;
} EnfGlLights;

/** SIZE if the map has more lights than the encoding can number. Free with enf_gl_lights_free, also after a failure. */
EnfResult enf_gl_lights_build(EnfGlLights *lights, const EnfMap *map, EnfError *error);
void enf_gl_lights_free(EnfGlLights *lights);

#endif

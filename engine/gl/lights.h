/* EnfGlLights: which lights may reach each cluster, as bake.c evaluates them. Pure data, no GL call. */
#ifndef ENFILADE_GL_LIGHTS_H
#define ENFILADE_GL_LIGHTS_H

#include <enfilade/map.h>

/** Lights that one cluster can have; planes of all windows through which one of them comes. */
enum { ENF_GL_LIGHTS_MAX = 256, ENF_GL_LIGHT_PLANES_MAX = 64 };

/** A light on a cluster's list. Positions are relative to the home cell's origin. A directional light stands
 *  very far away; a light that is no spot has an aim of 0 and an offset of 1. */
typedef struct EnfGlLight {
    float position[3];
    float inverse_range2; /**< 1 / range², 0 for no range */
    float color[3];       /**< times exposure */
    uint32_t windows;     /**< first plane << 6 | planes - 1 */
    float aim[3];         /**< direction × spot scale */
    float aim_offset;
} EnfGlLight; /* 48 bytes */

/** A light as a cell sees it, for what moves there. */
typedef struct EnfGlCellLight {
    EnfGlLight light; /**< relative to the cell's origin, as its windows are */
    uint32_t number;  /**< in EnfMap.lights */
} EnfGlCellLight;

typedef struct EnfGlLights {
    EnfGlLight *lights;          /**< the lists, one after the other; [0] is dark, the list of whoever has none */
    float (*planes)[4];          /**< n·p + d: 0 at the outer border of a window's soft edge, 1 at the inner; n = 0 ends a
                                   window; [0] is such an end: all is lit */
    uint32_t *cluster_lists;     /**< a cluster's list: first light << 8 | lights - 1; never empty */
    EnfGlCellLight *cell_lights; /**< of all cells, one cell's after the other's */
    uint32_t *cell_firsts;       /**< cells + 1: where a cell's begin */
    uint32_t light_count, light_capacity, plane_count, plane_capacity, cluster_count;
    uint32_t cell_light_count, cell_light_capacity, cell_count;
} EnfGlLights;

/** SIZE if the map has more lights than the encoding can number. Free with enf_gl_lights_free, also after a failure. */
EnfResult enf_gl_lights_build(EnfGlLights *lights, const EnfMap *map, EnfError *error);
/** Squared distance of a light to a box (relative to the same origin). */
float enf_gl_light_distance2(const EnfGlLight *light, const float min[3], const float max[3]);
/** May a light reach into a box, by its range and windows? */
bool enf_gl_light_touches(const EnfGlLights *lights, const EnfGlLight *light, const float min[3], const float max[3]);
/** How bright it is, facing it, at a squared distance: for ranking. */
float enf_gl_light_brightness(const EnfGlLight *light, float distance2);
void enf_gl_lights_free(EnfGlLights *lights);

#endif

/* EnfGlMoverLights: where a moving object is and what lights it, as the vertex shader reads it. Pure data, no GL call. */
#ifndef ENFILADE_GL_MOVER_LIGHTS_H
#define ENFILADE_GL_MOVER_LIGHTS_H

#include <enfilade/draw.h>

#include "gl/lights.h"

/** Lights that one object gets at most; planes of all windows through which they come, ends of windows included. */
enum {
    ENF_GL_MOVER_LIGHTS = 8,
    ENF_GL_MOVER_PLANES = 88,
    ENF_GL_MOVER_HEAD = 4,         /**< the matrix and the counts */
    ENF_GL_MOVER_LIGHT_VECTORS = 3 /**< a light */
};
#define ENF_GL_MOVER_VECTORS (ENF_GL_MOVER_HEAD + ENF_GL_MOVER_LIGHTS * ENF_GL_MOVER_LIGHT_VECTORS + ENF_GL_MOVER_PLANES)

/** The uniform `mover`: the columns of the matrix, each with a component of the translation; (lights, 0, 0, 0); then a light each:
 *  (position, 1 / range²), (colour, windows), (aim, aim offset); then planes. Positions are relative to the model's origin, axes are
 *  the world's. Windows are first plane × 128 + planes, planes as in EnfGlLights; 0: all is lit. 116 vectors: OpenGL 3.3 allows 256. */
typedef struct EnfGlMoverLights {
    float vectors[ENF_GL_MOVER_VECTORS][4];
    uint32_t count; /**< vectors used */
    uint32_t light_count;
    uint32_t numbers[ENF_GL_MOVER_LIGHTS]; /**< in EnfMap.lights, brightest first */
} EnfGlMoverLights;

/** The brightest lights that reach the object's box, by the references of the cells that it touches; ties by number. Depends on the
 *  map, the pose and (the matrix alone) on the eye. Within a cell a light's references of that cell count: what stands in a doorway is
 *  lit on either side as the walls there are. */
void enf_gl_mover_lights(EnfGlMoverLights *out, const EnfGlLights *lights, const EnfMap *map, const EnfDrawMover *mover);

#endif

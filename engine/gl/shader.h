/* The one shader family: two sources, variants by #define. */
#ifndef ENFILADE_GL_SHADER_H
#define ENFILADE_GL_SHADER_H

#include "gl/gl_functions.h"

/** A surface's variant is a sum of these: what its material lacks costs nothing. MOVER: of a moving object. */
enum { ENF_GL_LIT = 1, ENF_GL_MASK = 2, ENF_GL_TEXTURE = 4, ENF_GL_GLOW = 8, ENF_GL_MOVER = 16 };

/** Programs: the variants of surfaces by number, then those for other purposes. */
typedef enum EnfGlProgramKind {
    ENF_GL_PROGRAM_SURFACE = 0,
    ENF_GL_PROGRAM_IDS = 32,
    ENF_GL_PROGRAM_IDS_MASK,
    ENF_GL_PROGRAM_FLAT,      /**< one colour, for wireframe */
    ENF_GL_PROGRAM_MOVER_IDS, /**< the same three for moving objects */
    ENF_GL_PROGRAM_MOVER_IDS_MASK,
    ENF_GL_PROGRAM_MOVER_FLAT,
    ENF_GL_PROGRAM_LINES, /**< vertices of their own */
    ENF_GL_PROGRAM_COUNT
} EnfGlProgramKind;

/** Uniforms that change, X(name): locations by name. */
#define ENF_GL_UNIFORMS(X)                                                                                                     \
    X(clip_from_eye)                                                                                                           \
    X(eye_fraction)                                                                                                            \
    X(uv_rows)                                                                                                                 \
    X(base_color)                                                                                                              \
    X(emissive)                                                                                                                \
    X(cutoff)                                                                                                                  \
    X(light_map_scale)                                                                                                         \
    X(mover)                                                                                                                   \
    X(ambient)                                                                                                                 \
    X(two_sided)                                                                                                               \
    X(lamps)                                                                                                                   \
    X(object_id)                                                                                                               \
    X(primitive_first)                                                                                                         \
    X(flat_color)

typedef struct EnfGlProgram {
    GLuint name;
#define ENF_GL_UNIFORM_MEMBER(uniform) GLint uniform;
    ENF_GL_UNIFORMS(ENF_GL_UNIFORM_MEMBER)
#undef ENF_GL_UNIFORM_MEMBER
} EnfGlProgram;

/** Texture units, fixed for all programs: X(name, unit, sampler uniform). */
#define ENF_GL_UNITS(X)                                                                                                        \
    X(BASE, 0, "base_texture")                                                                                                 \
    X(EMISSIVE, 1, "emissive_texture")                                                                                         \
    X(LIGHT_MAP, 2, "light_map")                                                                                               \
    X(OFFSETS, 3, "cell_offsets")                                                                                              \
    X(CLUSTERS, 4, "clusters")

enum {
#define ENF_GL_UNIT_ENUM(name, unit, sampler) ENF_GL_UNIT_##name = unit,
    ENF_GL_UNITS(ENF_GL_UNIT_ENUM)
#undef ENF_GL_UNIT_ENUM
};

/** Vertex attributes; LINES uses POSITION and COLOR. */
enum {
    ENF_GL_ATTRIBUTE_POSITION,
    ENF_GL_ATTRIBUTE_UV,
    ENF_GL_ATTRIBUTE_COLOR,
    ENF_GL_ATTRIBUTE_CELL,
    ENF_GL_ATTRIBUTE_LIGHT,
    ENF_GL_ATTRIBUTE_LIGHT_UV,
    ENF_GL_ATTRIBUTE_NORMAL /**< of moving objects, in place of baked light */
};

/** Compiles and links the programs whose bits are set in `needed`; the others stay 0. SHADER with the driver's log. */
EnfResult enf_gl_programs_create(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT], uint64_t needed,
                                 bool light_map, EnfError *error);
void enf_gl_programs_destroy(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT]);

#endif

/* The one shader family: two sources, variants by #define. */
#ifndef ENFILADE_GL_SHADER_H
#define ENFILADE_GL_SHADER_H

#include "gl/gl_functions.h"

/** The variants: X(name, defines). */
#define ENF_GL_PROGRAMS(X)                                                                                                     \
    X(LIT, "#define LIT\n")                                                                                                    \
    X(LIT_MASK, "#define LIT\n#define MASK\n")                                                                                 \
    X(UNLIT, "#define UNLIT\n")                                                                                                \
    X(UNLIT_MASK, "#define UNLIT\n#define MASK\n")                                                                             \
    X(IDS, "#define IDS\n")                                                                                                    \
    X(IDS_MASK, "#define IDS\n#define MASK\n")                                                                                 \
    X(FLAT, "#define FLAT\n")                                                                                                  \
    X(LINES, "#define LINES\n")

typedef enum EnfGlProgramKind {
#define ENF_GL_PROGRAM_ENUM(name, defines) ENF_GL_PROGRAM_##name,
    ENF_GL_PROGRAMS(ENF_GL_PROGRAM_ENUM)
#undef ENF_GL_PROGRAM_ENUM
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
    X(has_emissive_texture)                                                                                                    \
    X(ground)                                                                                                                  \
    X(sky)                                                                                                                     \
    X(key)                                                                                                                     \
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
    X(OFFSETS, 2, "cell_offsets")                                                                                              \
    X(LIGHTS, 3, "lights")                                                                                                     \
    X(ITEMS, 4, "light_items")                                                                                                 \
    X(PLANES, 5, "light_planes")                                                                                               \
    X(CLUSTERS, 6, "clusters")

enum {
#define ENF_GL_UNIT_ENUM(name, unit, sampler) ENF_GL_UNIT_##name = unit,
    ENF_GL_UNITS(ENF_GL_UNIT_ENUM)
#undef ENF_GL_UNIT_ENUM
};

/** Vertex attributes; LINES uses POSITION and COLOR. */
enum {
    ENF_GL_ATTRIBUTE_POSITION,
    ENF_GL_ATTRIBUTE_NORMAL,
    ENF_GL_ATTRIBUTE_UV,
    ENF_GL_ATTRIBUTE_COLOR,
    ENF_GL_ATTRIBUTE_CELL,
    ENF_GL_ATTRIBUTE_LIGHT_LIST
};

/** Compiles and links all variants. SHADER with the driver's log. */
EnfResult enf_gl_programs_create(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT], EnfError *error);
void enf_gl_programs_destroy(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT]);

#endif

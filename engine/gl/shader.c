/* Makes the programs from one vertex and one fragment source. Every variant computes gl_Position by the same expression,
 * declared invariant: the id-buffer, the wireframe and the picture cover the same pixels (engine/draw/README.md). */
#include "gl/shader.h"

#include <stdio.h>
#include <string.h>

#include "gl/mover_lights.h"

static const char vertex_source[] = "uniform mat4 clip_from_eye;\n"
                                    "uniform vec3 eye_fraction;\n"
                                    "uniform samplerBuffer cell_offsets;\n"
                                    "uniform vec3 uv_rows[2];\n"
                                    "uniform vec2 light_map_scale;\n"
                                    "layout(location = 0) in vec3 position;\n"
                                    "layout(location = 1) in vec2 uv;\n"
                                    "layout(location = 2) in vec4 color;\n"
                                    "layout(location = 3) in uint cell;\n"
                                    "#ifndef MOVER\n"
                                    "layout(location = 4) in vec3 light;\n"
                                    "layout(location = 5) in vec2 light_uv;\n"
                                    "#else\n"
                                    "layout(location = 6) in vec3 normal;\n"
                                    "#endif\n"
                                    "out vec4 f_color;\n"
                                    "#if defined(TEXTURE) || defined(GLOW)\n"
                                    "out vec2 f_uv;\n"
                                    "#endif\n"
                                    "#ifdef LIT\n"
                                    "out vec3 f_light;\n"
                                    "#ifdef LIGHT_MAP\n"
                                    "out vec2 f_light_uv;\n"
                                    "#endif\n"
                                    "#endif\n"
                                    "invariant gl_Position;\n"
                                    "\n";

/* What lights a moving object (mover_lights.h), by the formulas of bake.c: what is at rest and what moves look alike. */
static const char mover_source[] =
    "#ifdef MOVER\n"
    "uniform vec4 mover[MOVER_VECTORS];\n"
    "uniform vec3 ambient[3];\n"
    "uniform bool two_sided, lamps;\n"
    "\n"
    "// p: relative to the model's origin. Where two windows of a light overlap, it counts once.\n"
    "float through(int windows, vec3 p, int planes) {\n"
    "    int first = planes + windows / 128, last = first + windows % 128;\n"
    "    float lit = windows == 0 ? 1.0 : 0.0, window = 1.0;\n"
    "    for (int i = first; i < last; i++) {\n"
    "        vec4 plane = mover[i];\n"
    "        if (plane.xyz == vec3(0.0)) {\n"
    "            lit = max(lit, window);\n"
    "            window = 1.0;\n"
    "        } else {\n"
    "            window = min(window, clamp(dot(plane.xyz, p) + plane.w, 0.0, 1.0));\n"
    "        }\n"
    "    }\n"
    "    return lit;\n"
    "}\n"
    "\n"
    "vec3 shine(int slot, vec3 p, vec3 n, int planes) {\n"
    "    vec4 at = mover[4 + 3 * slot], color = mover[5 + 3 * slot], aim = mover[6 + 3 * slot];\n"
    "    vec3 to = at.xyz - p;\n"
    "    float d2 = dot(to, to), in_range = d2 * at.w, cosine = dot(n, to);\n"
    "    cosine = two_sided ? abs(cosine) : cosine;\n"
    "    if (cosine <= 0.0 || in_range >= 1.0) return vec3(0.0);\n"
    "    float nearness = inversesqrt(max(d2, 0.1));\n"
    "    float cone = clamp(aim.w - dot(aim.xyz, to) * nearness, 0.0, 1.0);\n"
    "    float k = cosine * nearness * (1.0 - in_range * in_range) * nearness * nearness * cone * cone;\n"
    "    return k > 0.0 ? color.rgb * (k * through(int(color.w), p, planes)) : vec3(0.0);\n"
    "}\n"
    "\n"
    "vec3 light_at(vec3 p, vec3 n) {\n"
    "    int lights = int(mover[3].x);\n"
    "    vec3 sum = mix(ambient[0], ambient[1], n.y * 0.5 + 0.5) + dot(n, ambient[2]);\n"
    "    for (int i = 0; i < lights; i++) sum += shine(i, p, n, 4 + 3 * lights);\n"
    "    vec3 shown = lamps ? sum * (1.0 + 0.1 * sum) / (1.0 + 0.35 * sum) : sum;\n"
    "    return sqrt(clamp(0.5 * shown, 0.0, 1.0));\n"
    "}\n"
    "\n"
    "// Cofactors turn a normal as the matrix turns its surface, whatever its scale.\n"
    "vec3 turned(vec3 n) {\n"
    "    vec3 a = mover[0].xyz, b = mover[1].xyz, c = mover[2].xyz, bc = cross(b, c);\n"
    "    vec3 out_of = bc * n.x + cross(c, a) * n.y + cross(a, b) * n.z;\n"
    "    out_of = dot(a, bc) < 0.0 ? -out_of : out_of;\n"
    "    float length2 = dot(out_of, out_of);\n"
    "    return length2 > 0.0 ? out_of * inversesqrt(length2) : vec3(0.0);\n"
    "}\n"
    "#endif\n"
    "\n";

static const char vertex_main[] =
    "void main() {\n"
    "#ifdef LINES\n"
    "    vec3 p = position;\n"
    "#elif defined(MOVER)\n"
    "    vec3 from_origin = mover[0].xyz * position.x + mover[1].xyz * position.y + mover[2].xyz * position.z;\n"
    "    vec3 p = from_origin + vec3(mover[0].w, mover[1].w, mover[2].w);\n"
    "#else\n"
    "    // Exact sum first, then the eye's fraction: one number for a vertex that cells share.\n"
    "    vec3 p = (position + texelFetch(cell_offsets, int(cell)).xyz) - eye_fraction;\n"
    "#endif\n"
    "    gl_Position = clip_from_eye * vec4(p, 1.0);\n"
    "    f_color = color;\n"
    "#if defined(TEXTURE) || defined(GLOW)\n"
    "    f_uv = vec2(dot(uv_rows[0], vec3(uv, 1.0)), dot(uv_rows[1], vec3(uv, 1.0)));\n"
    "#endif\n"
    "#if defined(LIT) && defined(MOVER)\n"
    "    f_light = light_at(from_origin, turned(normal));\n"
    "#elif defined(LIT)\n"
    "    f_light = light;\n"
    "#ifdef LIGHT_MAP\n"
    "    f_light_uv = light_uv * light_map_scale;\n"
    "#endif\n"
    "#endif\n"
    "}\n";

static const char fragment_inputs[] = "uniform sampler2D base_texture, emissive_texture, light_map;\n"
                                      "uniform vec4 base_color, flat_color;\n"
                                      "uniform vec3 emissive;\n"
                                      "uniform float cutoff;\n"
                                      "uniform int primitive_first, object_id;\n"
                                      "uniform usamplerBuffer clusters;\n"
                                      "in vec4 f_color;\n"
                                      "#if defined(TEXTURE) || defined(GLOW)\n"
                                      "in vec2 f_uv;\n"
                                      "#endif\n"
                                      "#ifdef LIT\n"
                                      "in vec3 f_light;\n"
                                      "#ifdef LIGHT_MAP\n"
                                      "in vec2 f_light_uv;\n"
                                      "#endif\n"
                                      "#endif\n"
                                      "out vec4 pixel;\n";

static const char fragment_main[] = "void main() {\n"
                                    "#if defined(LINES)\n"
                                    "    pixel = f_color;\n"
                                    "#elif defined(FLAT)\n"
                                    "    pixel = flat_color;\n"
                                    "#else\n"
                                    "    vec4 base = base_color * f_color;\n"
                                    "#ifdef TEXTURE\n"
                                    "    base *= texture(base_texture, f_uv);\n"
                                    "#endif\n"
                                    "#ifdef MASK\n"
                                    "    if (base.a < cutoff) discard;\n"
                                    "    base.a = 1.0;\n"
                                    "#endif\n"
                                    "#ifdef IDS\n"
                                    "#ifdef MOVER\n"
                                    "    uint id = uint(object_id);\n"
                                    "#else\n"
                                    "    uint id = texelFetch(clusters, primitive_first + gl_PrimitiveID).r + 1u;\n"
                                    "#endif\n"
                                    "    pixel = vec4(id & 255u, (id >> 8u) & 255u, (id >> 16u) & 255u, id >> 24u) / 255.0;\n"
                                    "#else\n"
                                    "#ifdef LIT\n"
                                    "    vec3 light = f_light;\n"
                                    "#ifdef LIGHT_MAP\n"
                                    "    light *= texture(light_map, f_light_uv).rgb;\n"
                                    "#endif\n"
                                    "    base.rgb *= 2.0 * light * light; // bake.c stores roots of halves\n"
                                    "#endif\n"
                                    "#ifdef GLOW\n"
                                    "    base.rgb += emissive * texture(emissive_texture, f_uv).rgb;\n"
                                    "#else\n"
                                    "    base.rgb += emissive;\n"
                                    "#endif\n"
                                    "    pixel = base;\n"
                                    "#endif\n"
                                    "#endif\n"
                                    "}\n";

/* ---- variants --------------------------------------------------------------------------------------------------- */

enum { DEFINES_SIZE = 256 };

static void add_define(char defines[DEFINES_SIZE], bool wanted, const char *name) {
    if (wanted) {
        size_t used = strlen(defines);
        snprintf(defines + used, DEFINES_SIZE - used, "#define %s\n", name);
    }
}

static void write_defines(char defines[DEFINES_SIZE], int kind, bool light_map) {
    bool surface = kind < ENF_GL_PROGRAM_IDS;
    bool masked_ids = kind == ENF_GL_PROGRAM_IDS_MASK || kind == ENF_GL_PROGRAM_MOVER_IDS_MASK;
    bool ids = masked_ids || kind == ENF_GL_PROGRAM_IDS || kind == ENF_GL_PROGRAM_MOVER_IDS;
    bool mover = surface ? (kind & ENF_GL_MOVER) != 0 : kind >= ENF_GL_PROGRAM_MOVER_IDS && kind < ENF_GL_PROGRAM_LINES;
    bool lit = surface && (kind & ENF_GL_LIT);
    snprintf(defines, DEFINES_SIZE, "#define MOVER_VECTORS %d\n", ENF_GL_MOVER_VECTORS);
    add_define(defines, mover, "MOVER");
    add_define(defines, lit, "LIT");
    add_define(defines, lit && light_map && !mover, "LIGHT_MAP");
    add_define(defines, (surface && (kind & ENF_GL_MASK)) || masked_ids, "MASK");
    add_define(defines, (surface && (kind & ENF_GL_TEXTURE)) || masked_ids, "TEXTURE");
    add_define(defines, surface && (kind & ENF_GL_GLOW), "GLOW");
    add_define(defines, ids, "IDS");
    add_define(defines, kind == ENF_GL_PROGRAM_FLAT || kind == ENF_GL_PROGRAM_MOVER_FLAT, "FLAT");
    add_define(defines, kind == ENF_GL_PROGRAM_LINES, "LINES");
}

/* ---- programs --------------------------------------------------------------------------------------------------- */

static const char version[] = "#version 330 core\n";

static GLuint compile(const EnfGlFunctions *gl, GLenum stage, const char *const *sources, GLsizei count, EnfError *error) {
    GLuint shader = gl->CreateShader(stage);
    GLint good = 0;
    gl->ShaderSource(shader, count, sources, NULL);
    gl->CompileShader(shader);
    gl->GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        char log[400] = "";
        gl->GetShaderInfoLog(shader, sizeof log, NULL, log);
        enf_error_set(error, ENF_ERROR_SHADER, UINT64_MAX, "%s shader: %s", stage == GL_VERTEX_SHADER ? "vertex" : "fragment",
                      log);
        gl->DeleteShader(shader);
        return 0;
    }
    return shader;
}

static bool link(const EnfGlFunctions *gl, GLuint program, GLuint vertex, GLuint fragment, EnfError *error) {
    GLint good = 0;
    gl->AttachShader(program, vertex);
    gl->AttachShader(program, fragment);
    gl->LinkProgram(program);
    gl->GetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) {
        char log[400] = "";
        gl->GetProgramInfoLog(program, sizeof log, NULL, log);
        enf_error_set(error, ENF_ERROR_SHADER, UINT64_MAX, "program: %s", log);
    }
    return good != 0;
}

static void find_uniforms(const EnfGlFunctions *gl, EnfGlProgram *program) {
#define ENF_GL_UNIFORM_FIND(uniform) program->uniform = gl->GetUniformLocation(program->name, #uniform);
    ENF_GL_UNIFORMS(ENF_GL_UNIFORM_FIND)
#undef ENF_GL_UNIFORM_FIND
    gl->UseProgram(program->name);
#define ENF_GL_UNIT_SET(unit, number, sampler)                                                                                 \
    gl->Uniform1i(gl->GetUniformLocation(program->name, sampler), ENF_GL_UNIT_##unit);
    ENF_GL_UNITS(ENF_GL_UNIT_SET)
#undef ENF_GL_UNIT_SET
}

static EnfResult create_program(const EnfGlFunctions *gl, EnfGlProgram *program, const char *variant, EnfError *error) {
    const char *const vertex_parts[] = {version, variant, vertex_source, mover_source, vertex_main};
    const char *const fragment_parts[] = {version, variant, fragment_inputs, fragment_main};
    GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_parts, 5, error);
    GLuint fragment = vertex ? compile(gl, GL_FRAGMENT_SHADER, fragment_parts, 4, error) : 0;
    bool good = false;
    if (fragment) {
        program->name = gl->CreateProgram();
        good = link(gl, program->name, vertex, fragment, error);
    }
    gl->DeleteShader(vertex); /* 0 is ignored; others live on in the program */
    gl->DeleteShader(fragment);
    if (good) {
        find_uniforms(gl, program);
    }
    return good ? ENF_OK : ENF_ERROR_SHADER;
}

EnfResult enf_gl_programs_create(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT], uint64_t needed,
                                 bool light_map, EnfError *error) {
    for (int i = 0; i < ENF_GL_PROGRAM_COUNT; i++) {
        char defines[DEFINES_SIZE];
        write_defines(defines, i, light_map);
        EnfResult result = needed >> i & 1u ? create_program(gl, &programs[i], defines, error) : ENF_OK;
        if (result != ENF_OK) {
            return result;
        }
    }
    gl->UseProgram(0);
    return ENF_OK;
}

void enf_gl_programs_destroy(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT]) {
    for (int i = 0; i < ENF_GL_PROGRAM_COUNT; i++) {
        gl->DeleteProgram(programs[i].name);
        memset(&programs[i], 0, sizeof programs[i]);
    }
}

/* Makes the programs from one vertex and one fragment source. Every variant computes gl_Position by the same expression,
 * declared invariant: the id-buffer, the wireframe and the picture cover the same pixels (engine/draw/README.md). */
#include "gl/shader.h"

#include <stdio.h>
#include <string.h>

static const char vertex_source[] =
    "uniform mat4 clip_from_eye;\n"
    "uniform vec3 eye_fraction;\n"
    "uniform samplerBuffer cell_offsets;\n"
    "uniform vec3 uv_rows[2];\n"
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec4 normal;\n"
    "layout(location = 2) in vec2 uv;\n"
    "layout(location = 3) in vec4 color;\n"
    "layout(location = 4) in uint cell;\n"
    "layout(location = 5) in uint light_list;\n"
    "out vec4 f_color;\n"
    "#if defined(TEXTURE) || defined(GLOW)\n"
    "out vec2 f_uv;\n"
    "#endif\n"
    "#ifdef LIT\n"
    "out vec3 f_normal;\n"
    "#ifdef LIGHTS\n"
    "out vec3 f_position;\n"
    "flat out uint f_light_list;\n"
    "#endif\n"
    "#endif\n"
    "invariant gl_Position;\n"
    "\n"
    "void main() {\n"
    "#ifdef LINES\n"
    "    vec3 p = position;\n"
    "#else\n"
    "    // Exact sum first, then the eye's fraction: one number for a vertex that cells share.\n"
    "    vec3 p = (position + texelFetch(cell_offsets, int(cell)).xyz) - eye_fraction;\n"
    "#endif\n"
    "    gl_Position = clip_from_eye * vec4(p, 1.0);\n"
    "    f_color = color;\n"
    "#if defined(TEXTURE) || defined(GLOW)\n"
    "    f_uv = vec2(dot(uv_rows[0], vec3(uv, 1.0)), dot(uv_rows[1], vec3(uv, 1.0)));\n"
    "#endif\n"
    "#ifdef LIT\n"
    "    f_normal = normal.xyz;\n"
    "#ifdef LIGHTS\n"
    "    f_position = position;\n"
    "    f_light_list = light_list;\n"
    "#endif\n"
    "#endif\n"
    "}\n";

static const char fragment_inputs[] = "uniform sampler2D base_texture, emissive_texture;\n"
                                      "uniform vec4 base_color, flat_color;\n"
                                      "uniform vec3 emissive, ground, sky, key;\n"
                                      "uniform float cutoff;\n"
                                      "uniform int primitive_first;\n"
                                      "uniform samplerBuffer light_planes;\n"
                                      "uniform usamplerBuffer lights, clusters;\n"
                                      "in vec4 f_color;\n"
                                      "#if defined(TEXTURE) || defined(GLOW)\n"
                                      "in vec2 f_uv;\n"
                                      "#endif\n"
                                      "#ifdef LIT\n"
                                      "in vec3 f_normal;\n"
                                      "#ifdef LIGHTS\n"
                                      "in vec3 f_position;\n"
                                      "flat in uint f_light_list;\n"
                                      "#endif\n"
                                      "#endif\n"
                                      "out vec4 pixel;\n";

/* Inverse square with glTF's range window; a light's windows are planes, and several windows count once. The loops test at
 * their ends, and lists are never empty: a software renderer runs a loop's body once in any case, and branches not at all. */
static const char fragment_lights[] =
    "#ifdef LIT\n"
    "#ifdef LIGHTS\n"
    "float through(uint windows) {\n"
    "    int i = int(windows >> 6u), last = i + int(windows & 63u);\n"
    "    float lit = 0.0, window = 1.0;\n"
    "    do {\n"
    "        vec4 plane = texelFetch(light_planes, i);\n"
    "        bool end = dot(plane.xyz, plane.xyz) == 0.0;\n"
    "        float inside = clamp(dot(plane.xyz, f_position) + plane.w, 0.0, 1.0);\n"
    "        lit = end ? max(lit, window) : lit;\n"
    "        window = end ? 1.0 : min(window, inside);\n"
    "    } while (++i <= last);\n"
    "    return lit;\n"
    "}\n"
    "\n"
    "vec3 shine(int light, vec3 n) {\n"
    "    vec4 place = uintBitsToFloat(texelFetch(lights, light));\n"
    "    uvec4 more = texelFetch(lights, light + 1);\n"
    "    vec3 to = place.xyz - f_position;\n"
    "    float d2 = max(dot(to, to), 0.01);\n"
    "    float nearness = inversesqrt(d2), in_range = d2 * place.w;\n"
    "    float k = max(dot(n, to) * nearness, 0.0) * max(1.0 - in_range * in_range, 0.0) * (nearness * nearness);\n"
    "#ifdef SPOTS\n"
    "    vec4 aim = uintBitsToFloat(texelFetch(lights, light + 2));\n"
    "    float cone = clamp(aim.w - dot(aim.xyz, to) * nearness, 0.0, 1.0);\n"
    "    k *= cone * cone;\n"
    "#endif\n"
    "#ifdef WINDOWS\n"
    "    k *= through(more.w);\n"
    "#endif\n"
    "    return uintBitsToFloat(more.xyz) * k;\n"
    "}\n"
    "#endif\n"
    "\n"
    "vec3 irradiance() {\n"
    "    vec3 n = normalize(gl_FrontFacing ? f_normal : -f_normal);\n"
    "    vec3 sum = mix(ground, sky, n.y * 0.5 + 0.5) + vec3(dot(n, key));\n"
    "#ifdef LIGHTS\n"
    "    int i = int(f_light_list >> 8u) * 3, last = i + int(f_light_list & 255u) * 3;\n"
    "    do {\n"
    "        sum += shine(i, n);\n"
    "        i += 3;\n"
    "    } while (i <= last);\n"
    "    // A soft shoulder: linear in the dark, and no lamp burns its wall white.\n"
    "    sum *= (1.0 + 0.1 * sum) / (1.0 + 0.35 * sum);\n"
    "#endif\n"
    "    return sum;\n"
    "}\n"
    "#endif\n";

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
                                    "    uint id = texelFetch(clusters, primitive_first + gl_PrimitiveID).r + 1u;\n"
                                    "    pixel = vec4(id & 255u, (id >> 8u) & 255u, (id >> 16u) & 255u, id >> 24u) / 255.0;\n"
                                    "#else\n"
                                    "#ifdef LIT\n"
                                    "    base.rgb *= irradiance();\n"
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

static void write_defines(char defines[DEFINES_SIZE], int kind, uint32_t light_features) {
    bool surface = kind < ENF_GL_PROGRAM_IDS, masked_ids = kind == ENF_GL_PROGRAM_IDS_MASK;
    bool lit = surface && (kind & ENF_GL_LIT);
    defines[0] = '\0';
    add_define(defines, lit, "LIT");
    add_define(defines, lit && (light_features & ENF_GL_LIGHTS), "LIGHTS");
    add_define(defines, lit && (light_features & ENF_GL_WINDOWS), "WINDOWS");
    add_define(defines, lit && (light_features & ENF_GL_SPOTS), "SPOTS");
    add_define(defines, (surface && (kind & ENF_GL_MASK)) || masked_ids, "MASK");
    add_define(defines, (surface && (kind & ENF_GL_TEXTURE)) || masked_ids, "TEXTURE");
    add_define(defines, surface && (kind & ENF_GL_GLOW), "GLOW");
    add_define(defines, kind == ENF_GL_PROGRAM_IDS || masked_ids, "IDS");
    add_define(defines, kind == ENF_GL_PROGRAM_FLAT, "FLAT");
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
    const char *const vertex_parts[] = {version, variant, vertex_source};
    const char *const fragment_parts[] = {version, variant, fragment_inputs, fragment_lights, fragment_main};
    GLuint vertex = compile(gl, GL_VERTEX_SHADER, vertex_parts, 3, error);
    GLuint fragment = vertex ? compile(gl, GL_FRAGMENT_SHADER, fragment_parts, 5, error) : 0;
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

EnfResult enf_gl_programs_create(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT], uint32_t needed,
                                 uint32_t light_features, EnfError *error) {
    for (int i = 0; i < ENF_GL_PROGRAM_COUNT; i++) {
        char defines[DEFINES_SIZE];
        write_defines(defines, i, light_features);
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

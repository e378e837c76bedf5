/* Makes the programs from one vertex and one fragment source. Every variant computes gl_Position by the same expression,
 * declared invariant: the id-buffer, the wireframe and the picture cover the same pixels (engine/draw/README.md). */
#include "gl/shader.h"

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
    "#ifndef LINES\n"
    "out vec2 f_uv;\n"
    "#endif\n"
    "#ifdef LIT\n"
    "out vec3 f_position;\n"
    "out vec3 f_normal;\n"
    "flat out uint f_light_list;\n"
    "#endif\n"
    "invariant gl_Position;\n"
    "\n"
    "void main() {\n"
    "#ifdef LINES\n"
    "    vec3 p = position;\n"
    "#else\n"
    "    // Exact sum first, then the eye's fraction: one number for a vertex that cells share.\n"
    "    vec3 p = (position + texelFetch(cell_offsets, int(cell)).xyz) - eye_fraction;\n"
    "    f_uv = vec2(dot(uv_rows[0], vec3(uv, 1.0)), dot(uv_rows[1], vec3(uv, 1.0)));\n"
    "#endif\n"
    "    gl_Position = clip_from_eye * vec4(p, 1.0);\n"
    "    f_color = color;\n"
    "#ifdef LIT\n"
    "    f_position = position;\n"
    "    f_normal = normal.xyz;\n"
    "    f_light_list = light_list;\n"
    "#endif\n"
    "}\n";

static const char fragment_inputs[] = "uniform sampler2D base_texture, emissive_texture;\n"
                                      "uniform vec4 base_color, flat_color;\n"
                                      "uniform vec3 emissive, ground, sky, key;\n"
                                      "uniform float cutoff;\n"
                                      "uniform int has_emissive_texture, primitive_first;\n"
                                      "uniform samplerBuffer lights, light_planes;\n"
                                      "uniform usamplerBuffer light_items, clusters;\n"
                                      "in vec4 f_color;\n"
                                      "#ifndef LINES\n"
                                      "in vec2 f_uv;\n"
                                      "#endif\n"
                                      "#ifdef LIT\n"
                                      "in vec3 f_position;\n"
                                      "in vec3 f_normal;\n"
                                      "flat in uint f_light_list;\n"
                                      "#endif\n"
                                      "out vec4 pixel;\n";

/* Inverse square with glTF's range window; a light's windows are planes through it, several windows count once. */
static const char fragment_lights[] =
    "#ifdef LIT\n"
    "float through_windows(vec3 from_light, int first, int count) {\n"
    "    float lit = count == 0 ? 1.0 : 0.0, window = 1.0;\n"
    "    for (int i = first; i < first + count; i++) {\n"
    "        vec4 plane = texelFetch(light_planes, i);\n"
    "        if (dot(plane.xyz, plane.xyz) == 0.0) {\n"
    "            lit = max(lit, window);\n"
    "            window = 1.0;\n"
    "        } else {\n"
    "            window = min(window, clamp((dot(plane.xyz, from_light) + plane.w) * 10.0 + 0.5, 0.0, 1.0));\n"
    "        }\n"
    "    }\n"
    "    return lit;\n"
    "}\n"
    "\n"
    "vec3 shine(int record, vec3 n) {\n"
    "    vec4 place = texelFetch(lights, record), color = texelFetch(lights, record + 1);\n"
    "    vec4 aim = texelFetch(lights, record + 2), more = texelFetch(lights, record + 3);\n"
    "    vec3 to = place.xyz - f_position;\n"
    "    float d2 = max(dot(to, to), 0.01);\n"
    "    float in_range = d2 * place.w;\n"
    "    vec3 l = to * inversesqrt(d2);\n"
    "    float k = max(1.0 - in_range * in_range, 0.0) / d2;\n"
    "    float cone = clamp(dot(aim.xyz, -l) * aim.w + more.x, 0.0, 1.0);\n"
    "    if (color.w == 1.0) k *= cone * cone;\n"
    "    if (color.w == 2.0) { l = -aim.xyz; k = 1.0; }\n"
    "    k *= max(dot(n, l), 0.0);\n"
    "    if (more.z > 0.0) k *= through_windows(-to, int(more.y), int(more.z));\n"
    "    return color.rgb * k;\n"
    "}\n"
    "\n"
    "vec3 irradiance() {\n"
    "    vec3 n = normalize(gl_FrontFacing ? f_normal : -f_normal);\n"
    "    vec3 sum = mix(ground, sky, n.y * 0.5 + 0.5) + vec3(dot(n, key));\n"
    "    int first = int(f_light_list >> 8u), last = first + int(f_light_list & 255u);\n"
    "    for (int i = first; i < last; i++) sum += shine(int(texelFetch(light_items, i).r) * 4, n);\n"
    "    return sum;\n"
    "}\n"
    "#endif\n";

static const char fragment_main[] = "void main() {\n"
                                    "#if defined(LINES)\n"
                                    "    pixel = f_color;\n"
                                    "#elif defined(FLAT)\n"
                                    "    pixel = flat_color;\n"
                                    "#else\n"
                                    "#if !defined(IDS) || defined(MASK)\n"
                                    "    vec4 base = texture(base_texture, f_uv) * base_color * f_color;\n"
                                    "#endif\n"
                                    "#ifdef MASK\n"
                                    "    if (base.a < cutoff) discard;\n"
                                    "#endif\n"
                                    "#ifdef IDS\n"
                                    "    uint id = texelFetch(clusters, primitive_first + gl_PrimitiveID).r + 1u;\n"
                                    "    pixel = vec4(id & 255u, (id >> 8u) & 255u, (id >> 16u) & 255u, id >> 24u) / 255.0;\n"
                                    "#else\n"
                                    "    vec3 glow = emissive;\n"
                                    "    if (has_emissive_texture != 0) glow *= texture(emissive_texture, f_uv).rgb;\n"
                                    "#ifdef LIT\n"
                                    "    vec3 e = irradiance();\n"
                                    "    // A soft shoulder: linear in the dark, 2 at most.\n"
                                    "    base.rgb *= e * (1.0 + 0.1 * e) / (1.0 + 0.35 * e);\n"
                                    "#endif\n"
                                    "    pixel = vec4(base.rgb + glow, base.a);\n"
                                    "#ifdef MASK\n"
                                    "    pixel.a = 1.0;\n"
                                    "#endif\n"
                                    "#endif\n"
                                    "#endif\n"
                                    "}\n";

static const char *const defines[ENF_GL_PROGRAM_COUNT] = {
#define ENF_GL_PROGRAM_DEFINES(name, text) text,
    ENF_GL_PROGRAMS(ENF_GL_PROGRAM_DEFINES)
#undef ENF_GL_PROGRAM_DEFINES
};

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

EnfResult enf_gl_programs_create(const EnfGlFunctions *gl, EnfGlProgram programs[ENF_GL_PROGRAM_COUNT], EnfError *error) {
    for (int i = 0; i < ENF_GL_PROGRAM_COUNT; i++) {
        EnfResult result = create_program(gl, &programs[i], defines[i], error);
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

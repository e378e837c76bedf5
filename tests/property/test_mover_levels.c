/* Random levels of things that move and hang on one another. Sane ones: at every tick each is where the glTF hierarchy, evaluated here
 * from scratch, puts it. Hostile ones: whatever comes in, the compiler refuses or makes a sound map, the same twice, whose movers have
 * finite poses within their bounds. */
#include "compile/compile.h"
#include "harness/gltf.h"

#include <enfilade/collide.h>

#include <math.h>

enum { NODES_MAX = 12, KEYS_MAX = 5, POOL = 8192 };

typedef struct Curve {
    bool given;
    EnfPathKind kind;
    uint32_t count;
    float times[KEYS_MAX], values[KEYS_MAX][3][4]; /* in-tangent, value, out-tangent; of others the value alone */
} Curve;

typedef struct Node {
    int parent; /* or -1 */
    float t[3], r[4], s[3];
    int mesh; /* or -1 */
    char name[48];
    const char *keys; /* extras without wrap and phase, or "" */
    int wrap;         /* EnfWrap */
    double phase;
    Curve curves[3]; /* by target */
} Node;

typedef struct Made {
    Node nodes[NODES_MAX];
    int count;
    bool jumps;
} Made;

/* ---- written ---------------------------------------------------------------------------------------------------- */

typedef struct Pool {
    float floats[POOL];
    uint32_t count;
    EnfTestText accessors, channels, samplers;
    uint32_t accessor_count, sampler_count;
} Pool;

static uint32_t add_accessor(Pool *pool, const float *values, uint32_t count, uint32_t width) {
    static const char *const types[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    char text[200];
    assert_true(pool->count + count * width <= POOL);
    snprintf(text, sizeof text, ",{\"bufferView\":1,\"byteOffset\":%u,\"componentType\":5126,\"count\":%u,\"type\":\"%s\"",
             pool->count * 4, count, types[width]);
    enf_test_put(&pool->accessors, text);
    if (width == 1) {
        snprintf(text, sizeof text, ",\"min\":[%.9g],\"max\":[%.9g]", (double)values[0], (double)values[count - 1]);
        enf_test_put(&pool->accessors, text);
    }
    enf_test_put(&pool->accessors, "}");
    memcpy(pool->floats + pool->count, values, count * width * sizeof *values);
    pool->count += count * width;
    return pool->accessor_count++;
}

static void add_curve(Pool *pool, const Curve *curve, int node, int target) {
    static const char *const kinds[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    static const char *const names[] = {"translation", "rotation", "scale"};
    uint32_t width = target == ENF_PATH_ROTATION ? 4 : 3, rows = 0;
    float values[KEYS_MAX * 12];
    char text[200];
    for (uint32_t key = 0; key < curve->count; key++) {
        for (uint32_t row = 0; row < 3; row++) {
            if (curve->kind == ENF_PATH_CUBIC || row == 1) {
                memcpy(values + rows++ * width, curve->values[key][row], width * sizeof *values);
            }
        }
    }
    uint32_t input = add_accessor(pool, curve->times, curve->count, 1), output = add_accessor(pool, values, rows, width);
    snprintf(text, sizeof text, "%s{\"input\":%u,\"output\":%u,\"interpolation\":\"%s\"}", pool->sampler_count ? "," : "",
             input, output, kinds[curve->kind]);
    enf_test_put(&pool->samplers, text);
    snprintf(text, sizeof text, "%s{\"sampler\":%u,\"target\":{\"node\":%d,\"path\":\"%s\"}}", pool->sampler_count ? "," : "",
             pool->sampler_count, node + 1, names[target]);
    enf_test_put(&pool->channels, text);
    pool->sampler_count++;
}

static void put_floats(EnfTestText *out, const char *key, const float *values, uint32_t count) {
    enf_test_put(out, key);
    for (uint32_t i = 0; i < count; i++) {
        enf_test_put(out, i ? "," : "[");
        enf_test_put_number(out, (double)values[i]);
    }
    enf_test_put(out, "]");
}

static void put_children(EnfTestText *out, const Made *made, int parent) {
    char text[32];
    bool any = false;
    for (int i = 0; i < made->count; i++) {
        if (made->nodes[i].parent == parent) {
            snprintf(text, sizeof text, "%s%d", any ? "," : parent < 0 ? "" : ",\"children\":[", i + 1);
            enf_test_put(out, text);
            any = true;
        }
    }
    enf_test_put(out, any && parent >= 0 ? "]" : "");
}

static void put_node(EnfTestText *out, const Made *made, int index) {
    static const char *const wraps[] = {"once", "loop", "pingpong"};
    const Node *node = &made->nodes[index];
    char text[128];
    snprintf(text, sizeof text, ",{\"name\":\"%s\"", node->name);
    enf_test_put(out, text);
    put_floats(out, ",\"translation\":", node->t, 3);
    put_floats(out, ",\"rotation\":", node->r, 4);
    put_floats(out, ",\"scale\":", node->s, 3);
    if (node->mesh >= 0) {
        snprintf(text, sizeof text, ",\"mesh\":%d", node->mesh);
        enf_test_put(out, text);
    }
    snprintf(text, sizeof text, ",\"extras\":{\"wrap\":\"%s\",\"phase\":%.17g", wraps[node->wrap], node->phase);
    enf_test_put(out, text);
    enf_test_put(out, node->keys);
    enf_test_put(out, "}");
    put_children(out, made, index);
    enf_test_put(out, "}");
}

/* Mesh 0: a crate; 1: a room; 2: a crate of material `clip`; 3: of glass. Node 0 is the room. */
static const char head[] =
    "{\"asset\":{\"version\":\"2.0\"},"
    "\"materials\":[{\"name\":\"wood\"},{\"name\":\"clip\"},{\"name\":\"glass\",\"alphaMode\":\"BLEND\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":1}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":2}]}],"
    "\"scene\":0,\"scenes\":[{\"nodes\":[0,";

static void put_buffers(EnfTestText *out, const Pool *pool) {
    EnfTestCube cube;
    char text[256];
    uint8_t *bytes = malloc(sizeof cube + sizeof pool->floats);
    assert_non_null(bytes);
    enf_test_cube(&cube);
    memcpy(bytes, &cube, sizeof cube);
    memcpy(bytes + sizeof cube, pool->floats, pool->count * sizeof(float));
    snprintf(text, sizeof text,
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],",
             sizeof cube, sizeof cube, pool->count * sizeof(float));
    enf_test_put(out, text);
    enf_test_put(out, "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\","
                      "\"min\":[-0.5,-0.5,-0.5],\"max\":[0.5,0.5,0.5]},"
                      "{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"},"
                      "{\"bufferView\":0,\"byteOffset\":168,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"}");
    enf_test_put(out, pool->accessors.text);
    enf_test_put(out, "],");
    enf_test_put_buffer(out, bytes, sizeof cube + pool->count * sizeof(float));
    free(bytes);
}

static void write_level(const Made *made, const char *path) {
    Pool *pool = calloc(1, sizeof *pool);
    EnfTestText out = {NULL, 0, 0};
    assert_non_null(pool);
    pool->accessor_count = 3;
    pool->floats[pool->count++] = 0.0F; /* no view is empty */
    for (int i = 0; i < made->count; i++) {
        for (int target = 0; target < 3; target++) {
            if (made->nodes[i].curves[target].given) {
                add_curve(pool, &made->nodes[i].curves[target], i, target);
            }
        }
    }
    enf_test_put(&pool->accessors, "");
    enf_test_put(&out, head);
    put_children(&out, made, -1);
    enf_test_put(&out, "]}],\"nodes\":[{\"name\":\"hall-room\",\"mesh\":1,\"scale\":[60,60,60]}");
    for (int i = 0; i < made->count; i++) {
        put_node(&out, made, i);
    }
    enf_test_put(&out, "],");
    if (pool->sampler_count) {
        enf_test_put(&out, "\"animations\":[{\"name\":\"all\",\"samplers\":[");
        enf_test_put(&out, pool->samplers.text);
        enf_test_put(&out, "],\"channels\":[");
        enf_test_put(&out, pool->channels.text);
        enf_test_put(&out, "]}],");
    }
    put_buffers(&out, pool);
    enf_test_put(&out, "}");
    enf_test_write_file(path, out.text, out.length);
    free(out.text);
    free(pool->accessors.text);
    free(pool->channels.text);
    free(pool->samplers.text);
    free(pool);
}

/* ---- made up ---------------------------------------------------------------------------------------------------- */

static void unit_quaternion(EnfTestRng *rng, float *q) {
    double v[4], size = 0.0;
    for (int i = 0; i < 4; i++) {
        v[i] = enf_test_double(rng, -1, 1);
        size += v[i] * v[i];
    }
    for (int i = 0; i < 4; i++) {
        q[i] = size > 1e-3 ? (float)(v[i] / sqrt(size)) : i == 3 ? 1.0F : 0.0F;
    }
}

static void sane_value(EnfTestRng *rng, int target, float *v) {
    if (target == ENF_PATH_ROTATION) {
        unit_quaternion(rng, v);
    } else if (target == ENF_PATH_SCALE) {
        v[0] = v[1] = v[2] = enf_test_float(rng, 0.5F, 1.5F);
    } else {
        for (int i = 0; i < 3; i++) {
            v[i] = enf_test_float(rng, -3, 3);
        }
    }
}

/* Keys at quarters of the node's duration; translations from its beginning to its end. */
static void sane_curve(EnfTestRng *rng, Made *made, Node *node, int target, double first, double duration) {
    Curve *curve = &node->curves[target];
    bool whole = target == ENF_PATH_TRANSLATION;
    curve->given = true;
    curve->kind = (EnfPathKind)enf_test_below(rng, 3);
    for (int quarter = 0; quarter <= 4; quarter++) {
        bool there = (whole && quarter % 4 == 0) || enf_test_chance(rng, 2) || (quarter == 4 && curve->count == 0);
        if (there) {
            curve->times[curve->count] = (float)(first + duration * quarter / 4);
            sane_value(rng, target, curve->values[curve->count][1]);
            for (int i = 0; i < (target == ENF_PATH_ROTATION ? 4 : 3); i++) {
                float *keys[2] = {curve->values[curve->count][0], curve->values[curve->count][2]};
                keys[0][i] = target == ENF_PATH_SCALE && i ? keys[0][0] : enf_test_float(rng, -0.2F, 0.2F);
                keys[1][i] = target == ENF_PATH_SCALE && i ? keys[1][0] : enf_test_float(rng, -0.2F, 0.2F);
            }
            curve->count++;
        }
    }
    if (enf_test_chance(rng, 2)) {
        memcpy(curve->values[curve->count - 1], curve->values[0], sizeof curve->values[0]);
    } else {
        made->jumps = true;
    }
    made->jumps = made->jumps || curve->kind == ENF_PATH_STEP;
}

static Made sane_level(EnfTestRng *rng) {
    static const double durations[] = {0.5, 1.0, 1.5, 3.0};
    static const char *const extras[] = {"", "", "", ",\"classname\":\"prop_exhibit\"", ",\"solid\":0"};
    Made made;
    memset(&made, 0, sizeof made);
    bool once = enf_test_chance(rng, 4);
    made.count = 2 + (int)enf_test_below(rng, NODES_MAX - 2);
    for (int i = 0; i < made.count; i++) {
        Node *node = &made.nodes[i];
        double first = 0.25 * enf_test_below(rng, 4), duration = durations[enf_test_below(rng, 4)];
        node->parent = i == 0 || enf_test_chance(rng, 4) ? -1 : (int)enf_test_below(rng, (uint32_t)i);
        snprintf(node->name, sizeof node->name, "n%d", i);
        sane_value(rng, ENF_PATH_TRANSLATION, node->t);
        sane_value(rng, ENF_PATH_ROTATION, node->r);
        sane_value(rng, ENF_PATH_SCALE, node->s);
        node->mesh = enf_test_chance(rng, 4) ? -1 : 0;
        node->keys = extras[enf_test_below(rng, 5)];
        node->wrap = once ? ENF_WRAP_ONCE : 1 + (int)enf_test_below(rng, 2);
        node->phase = enf_test_chance(rng, 2) ? 0.0 : enf_test_double(rng, -2, 2);
        for (int target = 0; target < 3 && enf_test_chance(rng, 2) == (i % 2 == 0); target++) {
            sane_curve(rng, &made, node, target, first, duration);
        }
    }
    return made;
}

/* ---- the hierarchy, from scratch -------------------------------------------------------------------------------- */

static void curve_value(const Curve *curve, int target, double seconds, double *out) {
    int n = target == ENF_PATH_ROTATION ? 4 : 3;
    uint32_t key = 0;
    while (key + 1 < curve->count && (double)curve->times[key + 1] <= seconds) {
        key++;
    }
    bool held = key + 1 == curve->count || seconds < (double)curve->times[0] || curve->kind == ENF_PATH_STEP;
    uint32_t next = held ? key : key + 1;
    double span = held ? 1.0 : (double)curve->times[next] - (double)curve->times[key];
    double s = held ? 0.0 : (seconds - (double)curve->times[key]) / span, p[4], q[4], dot = 0.0;
    for (int i = 0; i < n; i++) {
        p[i] = (double)curve->values[key][1][i];
        q[i] = (double)curve->values[next][1][i];
        dot += p[i] * q[i];
    }
    double angle = acos(fmin(fabs(dot), 1.0)), sign = dot < 0.0 ? -1.0 : 1.0, size = 0.0;
    bool around = n == 4 && curve->kind == ENF_PATH_LINEAR && angle > 1e-4;
    for (int i = 0; i < n; i++) {
        double m0 = span * (double)curve->values[key][2][i], m1 = span * (double)curve->values[next][0][i];
        double a = around ? sin((1.0 - s) * angle) / sin(angle) : 1.0 - s, b = around ? sin(s * angle) / sin(angle) : s;
        out[i] = held                            ? p[i]
                 : curve->kind == ENF_PATH_CUBIC ? (1 + 2 * s) * (1 - s) * (1 - s) * p[i] + s * (1 - s) * (1 - s) * m0 +
                                                       s * s * (3 - 2 * s) * q[i] + s * s * (s - 1) * m1
                                                 : a * p[i] + b * (n == 4 ? sign : 1.0) * q[i];
        size += out[i] * out[i];
    }
    for (int i = 0; i < 4 && n == 4; i++) {
        out[i] /= sqrt(size);
    }
}

/* The node's transform relative to its parent; at rest for tick < 0. */
static EnfAffine local_at(const Node *node, int64_t tick) {
    double v[3][4] = {{(double)node->t[0], (double)node->t[1], (double)node->t[2], 0},
                      {(double)node->r[0], (double)node->r[1], (double)node->r[2], (double)node->r[3]},
                      {(double)node->s[0], (double)node->s[1], (double)node->s[2], 0}};
    double first = HUGE_VAL, last = 0.0;
    for (int t = 0; t < 3; t++) {
        const Curve *c = &node->curves[t];
        first = c->given ? fmin(first, (double)c->times[0]) : first;
        last = c->given ? fmax(last, (double)c->times[c->count - 1]) : last;
    }
    double seconds = last > first ? last - first : 1.0 / 60.0;
    int64_t period = llrint(seconds * 60.0), at = tick + llrint(node->phase * 60.0);
    int64_t cycle = node->wrap == ENF_WRAP_PING_PONG ? 2 * period : period;
    at = node->wrap == ENF_WRAP_ONCE ? (at < 0 ? 0 : at > period ? period : at) : (at % cycle + cycle) % cycle;
    at = at > period ? 2 * period - at : at;
    for (int t = 0; t < 3 && tick >= 0; t++) {
        if (node->curves[t].given) {
            curve_value(&node->curves[t], t, first + seconds * ((double)at / (double)period), v[t]);
        }
    }
    double size = sqrt(v[1][0] * v[1][0] + v[1][1] * v[1][1] + v[1][2] * v[1][2] + v[1][3] * v[1][3]);
    EnfQuat q = {v[1][0] / size, v[1][1] / size, v[1][2] / size, v[1][3] / size};
    return enf_affine_trs(enf_v3(v[0][0], v[0][1], v[0][2]), q, enf_v3(v[2][0], v[2][1], v[2][2]));
}

static EnfAffine world_at(const Made *made, int node, int64_t tick) {
    EnfAffine world = local_at(&made->nodes[node], tick);
    for (int n = made->nodes[node].parent; n >= 0; n = made->nodes[n].parent) {
        world = enf_affine_mul(local_at(&made->nodes[n], tick), world);
    }
    return world;
}

static EnfVec3 box_corner(EnfBox3 box, int i) {
    return enf_v3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
}

/* Where is a point of the mover that at rest lies where its mesh and entity put it? */
static void check_mover(const Made *made, const EnfMap *map, uint32_t mover, EnfTestRng *rng) {
    const EnfEntity *e = &map->entities[map->movers[mover].entity];
    int node = atoi(enf_map_string(map, e->name) + 1);
    EnfObjectDef def = enf_mover_def(map, mover);
    EnfQuat q = {(double)e->rotation[0], (double)e->rotation[1], (double)e->rotation[2], (double)e->rotation[3]};
    EnfAffine rest = enf_affine_trs(enf_v3(e->translation[0], e->translation[1], e->translation[2]), q,
                                    enf_v3((double)e->scale[0], (double)e->scale[1], (double)e->scale[2]));
    EnfAffine back;
    EnfVec3 last[8];
    EnfAffine authored = world_at(made, node, -1);
    assert_true(enf_affine_inverse(&authored, &back));
    int64_t begin = enf_test_below(rng, 2000);
    for (int64_t tick = begin; tick < begin + 60; tick++) {
        EnfPose pose = enf_motion_state(&def.motion, tick);
        EnfAffine moved = enf_affine_mul(world_at(made, node, tick), back);
        for (int i = 0; i < 8; i++) {
            EnfVec3 corner = box_corner(def.local, i), got = enf_pose_point(&pose, corner);
            EnfVec3 wanted = enf_affine_point(&moved, enf_affine_point(&rest, corner));
            double apart = enf_length(enf_sub(got, wanted));
            if (apart > (made->jumps ? 0.02 : 1e-3)) {
                fail_msg("%s, tick %lld: %g m from (%g, %g, %g)", enf_map_string(map, e->name), (long long)tick, apart,
                         wanted.x, wanted.y, wanted.z);
            }
            double way = tick > begin ? enf_length(enf_sub(got, last[i])) * 60.0 : 0.0;
            if (map->movers[mover].max_speed > 0.0F && way > (double)map->movers[mover].max_speed * 1.001 + 1e-6) {
                fail_msg("%s, tick %lld: %g m/s of at most %g", enf_map_string(map, e->name), (long long)tick, way,
                         (double)map->movers[mover].max_speed);
            }
            last[i] = got;
        }
    }
}

/* What the importer lets through, the compiler makes a sound map of, or says what kind of level it is not. */
static EnfResult compile(const char *level, const char *output, EnfMap *map) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfCompileReport report;
    EnfCompileDef def = enf_compile_def_default();
    def.level = level;
    def.output = output;
    EnfResult result = enf_compile(&def, &report, &error);
    enf_compile_report_free(&report);
    if (result == ENF_OK && enf_map_read(map, output, NULL, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    if (result != ENF_OK && result != ENF_ERROR_LEVEL) {
        EnfTestImport import = enf_test_import_file(level);
        if (import.result == ENF_OK) {
            fail_msg("%s: %s", enf_result_text(result), error.message);
        }
        enf_test_import_free(&import);
    }
    return result;
}

static void movers_go_where_the_hierarchy_does(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    uint32_t rounds = enf_test_rounds(60, 2000), checked = 0;
    for (uint32_t round = 0; round < rounds; round++) {
        Made made = sane_level(&rng);
        EnfMap map;
        const char *path = enf_test_temp_path("sane.gltf");
        write_level(&made, path);
        assert_int_equal(compile(path, enf_test_temp_path("sane.enfmap"), &map), ENF_OK);
        for (uint32_t m = 0; m < map.movers_count; m++) {
            check_mover(&made, &map, m, &rng);
            checked++;
        }
        enf_map_free(&map);
    }
    assert_true(checked > rounds);
}

/* ---- hostile ---------------------------------------------------------------------------------------------------- */

static float hostile_float(EnfTestRng *rng) {
    static const float floats[] = {0.0F,     -0.0F, 1.0F,  -1.0F,   1e-38F, 1e-45F, 1e30F, 3.4e38F,
                                   -3.4e38F, 1e6F,  1e-6F, 1000.1F, 0.5F,   -7.5F,  1e12F, 16777217.0F};
    return floats[enf_test_below(rng, sizeof floats / sizeof *floats)];
}

static void hostile_curve(EnfTestRng *rng, Curve *curve) {
    curve->given = true;
    curve->kind = (EnfPathKind)enf_test_below(rng, 3);
    curve->count = 1 + enf_test_below(rng, KEYS_MAX);
    float at = enf_test_chance(rng, 3) ? fabsf(hostile_float(rng)) : 0.0F;
    for (uint32_t key = 0; key < curve->count; key++) {
        curve->times[key] = at;
        at = enf_test_chance(rng, 8)   ? fabsf(hostile_float(rng))
             : enf_test_chance(rng, 4) ? nextafterf(at, 1e38F)
                                       : at + enf_test_float(rng, 0, 4);
        for (int row = 0; row < 3; row++) {
            for (int i = 0; i < 4; i++) {
                bool odd = enf_test_chance(rng, 12);
                curve->values[key][row][i] = odd ? hostile_float(rng) : enf_test_float(rng, -1, 1);
            }
        }
    }
}

static Made hostile_level(EnfTestRng *rng) {
    static const char *const endings[] = {"", "", "", "", "-colonly", "-col", "-navmesh", "-portal", "-room", "-noimp"};
    static const char *const extras[] = {
        "",
        "",
        "",
        ",\"classname\":\"func_door\"",
        ",\"classname\":\"func_door\",\"move\":\"0,3,0\",\"speed\":1e-300",
        ",\"classname\":\"func_door_rotating\",\"axis\":\"0,0,1e-9\",\"angle\":1e308,\"speed\":\"nan\"",
        ",\"classname\":\"func_door_rotating\",\"axis\":[1e6,-1e6,1e-7],\"angle\":-1e-300,\"swing_low\":1e6",
        ",\"classname\":\"func_plat\",\"stops\":\"0,inf,2\"",
        ",\"classname\":\"func_plat\",\"stops\":[1e6,-1e6,1e-30]",
        ",\"classname\":\"npc_guard\",\"speed\":-4,\"max_speed\":1e-44",
        ",\"dynamic\":true,\"max_speed\":1e6,\"validity\":1e6",
        ",\"classname\":\"prop_float\",\"classname\":\"npc_guard\"",
        ",\"wrap\":7,\"validity\":1e-9,\"portal\":{\"a\":[]}",
        ",\"max_speed\":1e999",
        ",\"phase\":1e6,\"solid\":\"false\"",
        ",\"classname\":\"func_\",\"locked\":[[[]]]"};
    Made made;
    memset(&made, 0, sizeof made);
    made.count = 1 + (int)enf_test_below(rng, NODES_MAX - 1);
    for (int i = 0; i < made.count; i++) {
        Node *node = &made.nodes[i];
        node->parent = i == 0 || enf_test_chance(rng, 3) ? -1 : (int)enf_test_below(rng, (uint32_t)i);
        snprintf(node->name, sizeof node->name, "n%d%s", i, endings[enf_test_below(rng, 10)]);
        node->mesh = enf_test_chance(rng, 4) ? -1 : enf_test_chance(rng, 3) ? 2 + (int)enf_test_below(rng, 2) : 0;
        node->keys = extras[enf_test_below(rng, sizeof extras / sizeof *extras)];
        node->wrap = (int)enf_test_below(rng, 3);
        node->phase = enf_test_chance(rng, 3) ? (double)hostile_float(rng) : 0.0;
        unit_quaternion(rng, node->r);
        for (int k = 0; k < 3; k++) {
            node->t[k] = enf_test_chance(rng, 40) ? hostile_float(rng) : enf_test_float(rng, -9, 9);
            node->s[k] = enf_test_chance(rng, 20) ? hostile_float(rng) : enf_test_float(rng, -2, 2);
            if (enf_test_chance(rng, 4)) {
                hostile_curve(rng, &node->curves[k]);
            }
        }
    }
    return made;
}

static bool is_finite(EnfVec3 v) {
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

/* Poses at odd ticks are finite and within the bound that is asked for before. */
static void check_poses(const EnfMap *map, EnfTestRng *rng) {
    for (uint32_t m = 0; m < map->movers_count; m++) {
        EnfObjectDef def = enf_mover_def(map, m);
        for (int round = 0; round < 8; round++) {
            int64_t tick = enf_test_chance(rng, 4) ? (int64_t)(enf_test_u64(rng) >> 24) : enf_test_below(rng, 5000);
            EnfPose pose = enf_motion_state(&def.motion, tick);
            EnfBox3 bound = enf_motion_bound(&def.motion, &def.local, tick, tick + enf_test_below(rng, 100));
            for (int i = 0; i < 8; i++) {
                EnfVec3 p = enf_pose_point(&pose, box_corner(def.local, i));
                if (!is_finite(p) || !enf_box3_contains(bound, p)) {
                    fail_msg("mover %u, tick %lld: (%g, %g, %g)", m, (long long)tick, p.x, p.y, p.z);
                }
            }
        }
    }
}

/* The movers as objects of a world, and as solids. */
static void check_world(const EnfMap *map) {
    EnfWorld *world;
    EnfCollider *collider;
    assert_int_equal(enf_world_create(&world, map, 1, NULL, NULL), ENF_OK);
    assert_int_equal(enf_world_populate(world, NULL), ENF_OK);
    assert_int_equal(enf_world_object_limit(world), map->movers_count);
    assert_int_equal(enf_collider_create(&collider, map, world, NULL, NULL), ENF_OK);
    enf_collider_destroy(collider);
    enf_world_destroy(world);
}

static void hostile_levels_are_refused_or_sound(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    uint32_t rounds = enf_test_rounds(400, 5000), sound = 0;
    for (uint32_t round = 0; round < rounds; round++) {
        Made made = hostile_level(&rng);
        EnfMap map, again;
        const char *path = enf_test_temp_path("hostile.gltf");
        write_level(&made, path);
        EnfResult result = compile(path, enf_test_temp_path("hostile.enfmap"), &map);
        assert_int_equal(compile(path, enf_test_temp_path("again.enfmap"), &again), result);
        if (result != ENF_OK) {
            continue;
        }
        sound++;
        assert_int_equal(map.file.size, again.file.size);
        assert_memory_equal(map.file.data, again.file.data, map.file.size);
        check_poses(&map, &rng);
        check_world(&map);
        enf_map_free(&map);
        enf_map_free(&again);
    }
    assert_true(sound > rounds / 4);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(movers_go_where_the_hierarchy_does),
    cmocka_unit_test(hostile_levels_are_refused_or_sound),
};

ENF_TEST_MAIN(tests)

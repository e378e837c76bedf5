/* The importer, feature by feature, on documents made by hand: geometry, accessors, nodes. Looks are in test_import_looks. */
#include "harness/gltf.h"

#include <math.h>

#include <meshoptimizer.h>

#define ASSET "\"asset\":{\"version\":\"2.0\"}"
#define ONE_NODE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]"

static EnfTestImport import_ok(const char *text) {
    EnfTestImport import = enf_test_import_text(text);
    if (import.result != ENF_OK) {
        fail_msg("%s: %s", enf_result_text(import.result), import.error.message);
    }
    return import;
}

/* A document with `data` as its buffer 0 and `rest` behind. */
static EnfTestImport import_data(const void *data, size_t size, const char *rest) {
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",");
    enf_test_put_buffer(&text, data, size);
    enf_test_put(&text, ",");
    enf_test_put(&text, rest);
    enf_test_put(&text, "}");
    EnfTestImport import = import_ok(text.text);
    free(text.text);
    return import;
}

static void assert_floats(const float *values, const float *expected, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (fabsf(values[i] - expected[i]) > 1e-6f) {
            fail_msg("float %zu is %.9g, not %.9g", i, (double)values[i], (double)expected[i]);
        }
    }
}

static void assert_indices(const EnfSourcePrimitive *primitive, const uint32_t *expected, uint32_t count) {
    assert_int_equal(primitive->index_count, count);
    assert_memory_equal(primitive->indices, expected, count * sizeof *expected);
}

/* ---- primitive modes -------------------------------------------------------------------------------------------- */

static const float zigzag[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}};

static EnfTestImport import_mode(const char *mode) {
    char rest[1024];
    snprintf(rest, sizeof rest,
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":120}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":60,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"mode\":%s}]}]," ONE_NODE,
             mode);
    float data[10][3];
    memcpy(data, zigzag, sizeof zigzag);
    for (int i = 5; i < 10; i++) {
        data[i][0] = data[i][1] = 0.0f;
        data[i][2] = 2.0f; /* normals are made unit */
    }
    return import_data(data, sizeof data, rest);
}

static void strips_and_fans_wind_alike(void **state) {
    (void)state;
    static const uint32_t list[3] = {0, 1, 2}, strip[9] = {0, 1, 2, 1, 3, 2, 2, 3, 4}, fan[9] = {1, 2, 0, 2, 3, 0, 3, 4, 0};
    EnfTestImport import = import_mode("4");
    assert_indices(&import.source.primitives[0], list, 3);
    assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 1); /* two vertices left over */
    enf_test_import_free(&import);
    import = import_mode("5");
    assert_indices(&import.source.primitives[0], strip, 9);
    assert_floats(import.source.primitives[0].normals, (const float[]){0, 0, 1}, 3);
    assert_int_equal(import.source.triangle_count, 3);
    enf_test_import_free(&import);
    import = import_mode("6");
    assert_indices(&import.source.primitives[0], fan, 9);
    enf_test_import_free(&import);
}

static void points_and_lines_are_skipped(void **state) {
    (void)state;
    static const char *const modes[] = {"0", "1", "2", "3", "7"};
    for (size_t i = 0; i < 5; i++) {
        EnfTestImport import = import_mode(modes[i]);
        assert_int_equal(import.source.primitive_count, 0);
        assert_int_equal(import.source.triangle_count, 0);
        assert_int_equal(enf_test_found(&import, ENF_DIAGNOSIS_UNSUPPORTED), 1);
        enf_test_import_free(&import);
    }
}

/* ---- accessors -------------------------------------------------------------------------------------------------- */

static void sparse_accessors_without_view_are_zeros(void **state) {
    (void)state;
    struct {
        uint32_t places[2];
        float values[2][3];
        uint8_t index_places[2], indices[2];
    } data = {{1, 2}, {{1, 0, 0}, {0, 1, 0}}, {1, 2}, {1, 2}};
    EnfTestImport import = import_data(
        &data, sizeof data,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":8},{\"buffer\":0,\"byteOffset\":8,\"byteLength\":24},"
        "{\"buffer\":0,\"byteOffset\":32,\"byteLength\":2},{\"buffer\":0,\"byteOffset\":34,\"byteLength\":2}],"
        "\"accessors\":[{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
        "\"indices\":{\"bufferView\":0,\"componentType\":5125},\"values\":{\"bufferView\":1}}},"
        "{\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\",\"sparse\":{\"count\":2,"
        "\"indices\":{\"bufferView\":2,\"componentType\":5121},\"values\":{\"bufferView\":3}}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]," ONE_NODE);
    const EnfSourcePrimitive *primitive = &import.source.primitives[0];
    assert_indices(primitive, (const uint32_t[]){0, 1, 2}, 3);
    assert_floats(primitive->positions, (const float[]){0, 0, 0, 1, 0, 0, 0, 1, 0}, 9);
    assert_floats(primitive->normals, (const float[]){0, 0, 1, 0, 0, 1, 0, 0, 1}, 9);
    enf_test_import_free(&import);
}

/* KHR_mesh_quantization: interleaved, 12 bytes a vertex, 4-byte gaps included. */
static void quantised_and_interleaved_attributes(void **state) {
    (void)state;
    struct {
        int16_t position[4];
        uint16_t uv[2];
        int8_t normal[4];
        uint8_t color[4];
    } data[3] = {
        {{-32768, 0, 0, 9}, {0, 65535}, {0, 0, 127, 9}, {255, 0, 0, 255}},
        {{32767, 0, 0, 9}, {65535, 0}, {0, 0, -128, 9}, {0, 255, 0, 51}},
        {{0, 32767, -32767, 9}, {32768, 0}, {127, 0, 0, 9}, {0, 0, 255, 0}},
    };
    EnfTestImport import = import_data(
        data, sizeof data,
        "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"extensionsUsed\":[\"KHR_mesh_quantization\"],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":60,\"byteStride\":20}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5122,\"normalized\":true,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":8,\"componentType\":5123,\"normalized\":true,\"count\":3,\"type\":\"VEC2\"},"
        "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5120,\"normalized\":true,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"byteOffset\":16,\"componentType\":5121,\"normalized\":true,\"count\":3,\"type\":\"VEC4\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"NORMAL\":2,\"COLOR_0\":3}}]}]"
        "," ONE_NODE);
    const EnfSourcePrimitive *primitive = &import.source.primitives[0];
    assert_floats(primitive->positions, (const float[]){-1, 0, 0, 1, 0, 0, 0, 1, -1}, 9);
    assert_floats(primitive->uvs, (const float[]){0, 1, 1, 0, 32768.0f / 65535.0f, 0}, 6);
    assert_floats(primitive->normals, (const float[]){0, 0, 1, 0, 0, -1, 1, 0, 0}, 9);
    assert_floats(primitive->colors, (const float[]){1, 0, 0, 1, 0, 1, 0, 0.2f, 0, 0, 1, 0}, 12);
    enf_test_import_free(&import);
}

/* Unnormalised integers are plain numbers; a vertex buffer that is mostly another primitive's is cut to what is used. */
static void plain_integers_and_shared_buffers(void **state) {
    (void)state;
    uint16_t data[100][4];
    for (uint16_t i = 0; i < 100; i++) {
        data[i][0] = i;
        data[i][1] = (uint16_t)(i * i);
        data[i][2] = data[i][3] = 0;
    }
    static const uint16_t indices[3] = {40, 41, 42};
    memcpy(data[99], indices, sizeof indices);
    EnfTestImport import = import_data(
        data, sizeof data,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":792,\"byteStride\":8},{\"buffer\":0,\"byteOffset\":792,\"byteLength\":6}"
        "],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5123,\"count\":99,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]," ONE_NODE);
    const EnfSourcePrimitive *primitive = &import.source.primitives[0];
    assert_int_equal(primitive->vertex_count, 3);
    assert_floats(primitive->positions, (const float[]){40, 1600, 0, 41, 1681, 0, 42, 1764, 0}, 9);
    enf_test_import_free(&import);
}

/* ---- normals ---------------------------------------------------------------------------------------------------- */

/* A folded strip: the flat half shares its two vertices, the fold splits them. */
static void missing_normals_are_flat(void **state) {
    (void)state;
    static const float positions[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
    static const uint16_t indices[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    uint8_t data[sizeof positions + sizeof indices];
    memcpy(data, positions, sizeof positions);
    memcpy(data + sizeof positions, indices, sizeof indices);
    EnfTestImport import = import_data(
        data, sizeof data,
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":24}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":6,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]," ONE_NODE);
    const EnfSourcePrimitive *primitive = &import.source.primitives[0];
    assert_int_equal(primitive->vertex_count, 8);
    for (uint32_t i = 0; i < 12; i++) {
        const float *n = primitive->normals + 3 * (size_t)primitive->indices[i];
        assert_floats(n, i < 6 ? (const float[]){0, 0, 1} : (const float[]){1, 0, 0}, 3);
        assert_floats(primitive->positions + 3 * (size_t)primitive->indices[i], positions[indices[i]], 3);
    }
    enf_test_import_free(&import);
}

static void bad_normals_are_mended_and_bad_positions_refused(void **state) {
    (void)state;
    static const char rest[] = "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72}],"
                               "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
                               "{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                               "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}]," ONE_NODE "}";
    float data[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {NAN, 0, 1}, {0, 3, 4}};
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",");
    enf_test_put_buffer(&text, data, sizeof data);
    enf_test_put(&text, ",");
    enf_test_put(&text, rest);
    EnfTestImport import = import_ok(text.text);
    assert_floats(import.source.primitives[0].normals, (const float[]){0, 0, 1, 0, 0, 1, 0, 0.6f, 0.8f}, 9);
    enf_test_import_free(&import);
    data[1][2] = INFINITY;
    text.length = 0;
    enf_test_put(&text, "{" ASSET ",");
    enf_test_put_buffer(&text, data, sizeof data);
    enf_test_put(&text, ",");
    enf_test_put(&text, rest);
    import = enf_test_import_text(text.text);
    assert_int_equal(import.result, ENF_ERROR_RANGE);
    assert_string_equal(import.error.message, "accessors[0]: position 1 is not a finite number");
    assert_non_null(strstr(import.error.file, "level.gltf"));
    enf_test_import_free(&import);
    free(text.text);
}

/* ---- nodes ------------------------------------------------------------------------------------------------------ */

#define TRIANGLE                                                                                                               \
    "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"                                                  \
    "\"meshes\":[{\"name\":\"m\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"

static void matrices_and_trs_agree(void **state) {
    (void)state;
    EnfTestImport import = import_ok(
        "{" ASSET "," TRIANGLE "\"scenes\":[{\"nodes\":[0,2]}],\"nodes\":["
        "{\"name\":\"a\",\"translation\":[1,2,3],\"rotation\":[0,0.7071067811865476,0,0.7071067811865476],\"scale\":[2,-3,4],"
        "\"children\":[1]},{\"translation\":[1,1,1],\"mesh\":0},"
        "{\"name\":\"b\",\"matrix\":[0,0,-2,0, 0,-3,0,0, 4,0,0,0, 1,2,3,1],\"children\":[3]},"
        "{\"name\":\"leaf\",\"translation\":[1,1,1],\"mesh\":0}]}");
    const EnfSourceNode *nodes = import.source.nodes;
    assert_int_equal(import.source.node_count, 4);
    assert_int_equal(import.source.triangle_count, 2);
    assert_string_equal(nodes[1].name, "node 1");
    assert_string_equal(nodes[3].name, "leaf");
    assert_int_equal(nodes[1].parent, 0);
    assert_int_equal(nodes[3].parent, 2);
    assert_int_equal(nodes[2].parent, ENF_NONE);
    for (int i = 0; i < 9; i++) {
        assert_true(fabs(nodes[0].world.m[i] - nodes[2].world.m[i]) < 1e-12);
    }
    EnfVec3 at = enf_affine_point(&nodes[1].world, enf_v3(0, 0, 0));
    assert_true(enf_length(enf_sub(at, enf_v3(5, -1, 1))) < 1e-12);
    assert_true(enf_affine_det(&nodes[0].world) < 0.0);
    EnfAffine again = enf_affine_trs(nodes[0].translation, nodes[0].rotation, nodes[0].scale);
    for (int i = 0; i < 9; i++) {
        assert_true(fabs(again.m[i] - nodes[0].world.m[i]) < 1e-12);
    }
    enf_test_import_free(&import);
}

/* Every rotation survives being taken apart, whichever component is the largest. */
static void decomposition_keeps_rotations(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(3);
    for (int round = 0; round < 50; round++) {
        double q[4], s[3];
        EnfTestText text = {0};
        enf_test_put(&text, "{" ASSET ",\"nodes\":[{\"rotation\":[");
        for (int i = 0; i < 4; i++) {
            q[i] = enf_test_double(&rng, -1.0, 1.0) * (enf_test_chance(&rng, 3) ? 0.01 : 1.0);
            enf_test_put_number(&text, q[i]);
            enf_test_put(&text, i < 3 ? "," : "],\"scale\":[");
        }
        for (int i = 0; i < 3; i++) {
            s[i] = enf_test_double(&rng, 0.1, 3.0) * (enf_test_chance(&rng, 4) ? -1.0 : 1.0);
            enf_test_put_number(&text, s[i]);
            enf_test_put(&text, i < 2 ? "," : "]}]}");
        }
        EnfTestImport import = import_ok(text.text);
        const EnfSourceNode *node = &import.source.nodes[0];
        EnfAffine again = enf_affine_trs(node->translation, node->rotation, node->scale);
        for (int i = 0; i < 9; i++) {
            assert_true(fabs(again.m[i] - node->world.m[i]) < 1e-9);
        }
        enf_test_import_free(&import);
        free(text.text);
    }
}

static void scenes_are_chosen(void **state) {
    (void)state;
    EnfTestImport import = import_ok("{" ASSET ",\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],"
                                     "\"nodes\":[{\"name\":\"a\"},{\"name\":\"b\"}]}");
    assert_int_equal(import.source.node_count, 1);
    assert_string_equal(import.source.nodes[0].name, "b");
    enf_test_import_free(&import);
    import = import_ok("{" ASSET
                       ",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1]}],\"nodes\":[{\"name\":\"a\"},{\"name\":\"b\"}]}");
    assert_string_equal(import.source.nodes[0].name, "a");
    enf_test_import_free(&import);
    import = import_ok("{" ASSET ",\"nodes\":[{\"name\":\"a\"},{\"name\":\"b\",\"children\":[0]},{\"name\":\"c\"}]}");
    assert_int_equal(import.source.node_count, 3);
    assert_string_equal(import.source.nodes[0].name, "b");
    assert_string_equal(import.source.nodes[1].name, "a");
    assert_string_equal(import.source.nodes[2].name, "c");
    enf_test_import_free(&import);
}

static void loops_and_shared_children_are_refused(void **state) {
    (void)state;
    static const char *const texts[] = {
        "{" ASSET ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}",
        "{" ASSET ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[0]}]}",
        "{" ASSET ",\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"children\":[2]},{\"children\":[2]},{}]}",
    };
    for (size_t i = 0; i < 3; i++) {
        EnfTestImport import = enf_test_import_text(texts[i]);
        assert_int_equal(import.result, ENF_ERROR_FORMAT);
        assert_non_null(strstr(import.error.message, "is its own ancestor, or has two parents"));
        assert_null(import.source.owner);
        enf_test_import_free(&import);
    }
}

static void deep_hierarchies_need_no_stack(void **state) {
    (void)state;
    enum { DEPTH = 100000 };
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",\"nodes\":[");
    for (int i = 1; i < DEPTH; i++) {
        char node[64];
        snprintf(node, sizeof node, "{\"children\":[%d],\"translation\":[0.5,0,0]},", i);
        enf_test_put(&text, node);
    }
    enf_test_put(&text, "{\"name\":\"last\"}]}");
    EnfTestImport import = import_ok(text.text);
    assert_int_equal(import.source.node_count, DEPTH);
    assert_true(import.source.nodes[DEPTH - 1].translation.x == 0.5 * (DEPTH - 1));
    enf_test_import_free(&import);
    free(text.text);
}

static void instances_become_nodes(void **state) {
    (void)state;
    static const float translations[2][3] = {{10, 0, 0}, {0, 20, 0}};
    EnfTestImport import = import_data(
        translations, sizeof translations,
        "\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],\"bufferViews\":[{\"buffer\":0,\"byteLength\":24}],"
        "\"accessors\":[{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"name\":\"trees\",\"mesh\":0,\"scale\":[2,2,2],\"children\":[1],\"extras\":{\"a\":1},\"extensions\":{"
        "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1}}}},{\"name\":\"child\"}]");
    const EnfSourceNode *nodes = import.source.nodes;
    assert_int_equal(import.source.node_count, 4);
    assert_int_equal(import.source.triangle_count, 2);
    assert_int_equal(nodes[0].mesh, ENF_NONE);
    for (int i = 1; i <= 2; i++) {
        assert_string_equal(nodes[i].name, "trees");
        assert_string_equal(nodes[i].extras, "");
        assert_int_equal(nodes[i].index, 0);
        assert_int_equal(nodes[i].parent, 0);
        assert_int_equal(nodes[i].mesh, 0);
    }
    assert_true(nodes[1].translation.x == 20.0 && nodes[2].translation.y == 40.0 && nodes[2].scale.z == 2.0);
    assert_string_equal(nodes[3].name, "child");
    enf_test_import_free(&import);
}

/* ---- EXT_meshopt_compression ------------------------------------------------------------------------------------ */

static size_t put_view(EnfTestText *out, size_t offset, size_t size, const char *rest) {
    char view[512];
    snprintf(view, sizeof view,
             "\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,%s}}}", offset,
             size, rest);
    enf_test_put(out, view);
    return offset + size;
}

static void packed_buffers_are_decoded(void **state) {
    (void)state;
    static const float positions[4][4] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}, {0, 1, 0, 0}};
    static const float normal[16] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const unsigned indices[6] = {0, 1, 2, 0, 2, 3};
    int8_t packed_normals[4][4];
    meshopt_encodeFilterOct(packed_normals, 4, 4, 8, normal);
    uint8_t data[1024];
    size_t vertex_size = meshopt_encodeVertexBuffer(data, 400, positions, 4, 16);
    size_t normal_size = meshopt_encodeVertexBuffer(data + vertex_size, 300, packed_normals, 4, 4);
    size_t index_at = vertex_size + normal_size;
    size_t index_size = meshopt_encodeIndexBuffer(data + index_at, 300, indices, 6);
    EnfTestText rest = {0};
    enf_test_put(&rest, "\"bufferViews\":[{\"buffer\":1,\"byteLength\":64,\"byteStride\":16,");
    size_t at = put_view(&rest, 0, vertex_size, "\"byteStride\":16,\"count\":4,\"mode\":\"ATTRIBUTES\"");
    enf_test_put(&rest, ",{\"buffer\":1,\"byteLength\":16,\"byteStride\":4,");
    at = put_view(&rest, at, normal_size, "\"byteStride\":4,\"count\":4,\"mode\":\"ATTRIBUTES\",\"filter\":\"OCTAHEDRAL\"");
    enf_test_put(&rest, ",{\"buffer\":1,\"byteLength\":12,");
    put_view(&rest, at, index_size, "\"byteStride\":2,\"count\":6,\"mode\":\"TRIANGLES\"");
    enf_test_put(&rest,
                 "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                 "{\"bufferView\":1,\"componentType\":5120,\"normalized\":true,\"count\":4,\"type\":\"VEC3\"},"
                 "{\"bufferView\":2,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2}]}]," ONE_NODE "}");
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",\"extensionsRequired\":[\"EXT_meshopt_compression\"],");
    enf_test_put_buffer(&text, data, index_at + index_size);
    text.length--; /* the second buffer stands for the unpacked bytes, and has none */
    enf_test_put(&text, ",{\"byteLength\":92,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}],");
    enf_test_put(&text, rest.text);
    EnfTestImport import = import_ok(text.text);
    const EnfSourcePrimitive *primitive = &import.source.primitives[0];
    assert_indices(primitive, (const uint32_t[]){0, 1, 2, 0, 2, 3}, 6);
    assert_floats(primitive->positions, (const float[]){0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 12);
    assert_floats(primitive->normals, (const float[]){0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 12);
    enf_test_import_free(&import);
    free(text.text);
    free(rest.text);
}

/* ---- diagnosis -------------------------------------------------------------------------------------------------- */

static void findings_are_kept(void **state) {
    (void)state;
    EnfDiagnosis diagnosis = {0};
    for (int i = 0; i < 100; i++) {
        enf_diagnose(&diagnosis, ENF_DIAGNOSIS_PORTAL_SELF, i % 2 ? "door" : NULL, "number %d", i);
    }
    EnfVec3 points[2] = {{1, 2, 3}, {4, 5, 6}};
    enf_diagnose_points(&diagnosis, points, 2);
    enf_diagnose_points(&diagnosis, points + 1, 1);
    assert_int_equal(diagnosis.count, 100);
    assert_string_equal(diagnosis.findings[0].node, "");
    assert_string_equal(diagnosis.findings[99].node, "door");
    assert_string_equal(diagnosis.findings[99].message, "number 99");
    assert_int_equal(diagnosis.findings[99].point_count, 1);
    assert_true(diagnosis.findings[99].points[0].z == 6.0);
    assert_string_equal(enf_diagnosis_text(ENF_DIAGNOSIS_PORTAL_SELF), "portal-to-itself");
    assert_true(enf_diagnosis_is_error(ENF_DIAGNOSIS_NO_GEOMETRY));
    assert_false(enf_diagnosis_is_error(ENF_DIAGNOSIS_NO_ROOMS));
    enf_diagnosis_free(&diagnosis);
    assert_int_equal(diagnosis.count, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(strips_and_fans_wind_alike),
    cmocka_unit_test(points_and_lines_are_skipped),
    cmocka_unit_test(sparse_accessors_without_view_are_zeros),
    cmocka_unit_test(quantised_and_interleaved_attributes),
    cmocka_unit_test(plain_integers_and_shared_buffers),
    cmocka_unit_test(missing_normals_are_flat),
    cmocka_unit_test(bad_normals_are_mended_and_bad_positions_refused),
    cmocka_unit_test(matrices_and_trs_agree),
    cmocka_unit_test(decomposition_keeps_rotations),
    cmocka_unit_test(scenes_are_chosen),
    cmocka_unit_test(loops_and_shared_children_are_refused),
    cmocka_unit_test(deep_hierarchies_need_no_stack),
    cmocka_unit_test(instances_become_nodes),
    cmocka_unit_test(packed_buffers_are_decoded),
    cmocka_unit_test(findings_are_kept),
};

ENF_TEST_MAIN(tests)

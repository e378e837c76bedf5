/* The importer against files made to break it: the 372 of glTF-Validator, JSONTestSuite, every truncation of a small GLB, flipped
 * bits, deep nesting, sizes that overflow. It may refuse or accept; it must end, say why, and leave no memory (ASan). */
#define _XOPEN_SOURCE 700 /* nftw */
#include "harness/gltf.h"

#include <dirent.h>
#include <ftw.h>

#include "compile/json.h"

/* What holds of every import, however it ended. */
static void check_sound(const EnfTestImport *import, const char *what) {
    const EnfSource *source = &import->source;
    if (import->result != ENF_OK) {
        if (!import->error.message[0] || !import->error.file[0] || source->owner || source->node_count) {
            fail_msg("%s: refused without a word, or something is left", what);
        }
        return;
    }
    for (uint32_t i = 0; i < source->node_count; i++) {
        const EnfSourceNode *node = &source->nodes[i];
        assert_non_null(node->name);
        assert_non_null(node->extras);
        assert_true(node->parent == ENF_NONE || node->parent < i);
        assert_true(node->mesh == ENF_NONE || node->mesh < source->mesh_count);
        assert_true(node->camera == ENF_NONE || node->camera < source->camera_count);
        assert_true(node->light == ENF_NONE || node->light < source->light_count);
        assert_true(enf_v3_finite(node->translation) && enf_v3_finite(node->scale));
    }
    for (uint32_t i = 0; i < source->primitive_count; i++) {
        const EnfSourcePrimitive *primitive = &source->primitives[i];
        assert_true(primitive->material < source->material_count);
        assert_int_equal(primitive->index_count % 3, 0);
        for (uint32_t k = 0; k < primitive->index_count; k++) {
            assert_true(primitive->indices[k] < primitive->vertex_count);
        }
        for (size_t k = 0; k < 3 * (size_t)primitive->vertex_count; k++) {
            float p = primitive->positions[k], n = primitive->normals[k];
            assert_true(p - p == 0.0f && n >= -1.001f && n <= 1.001f);
        }
    }
    for (uint32_t i = 0; i < source->material_count; i++) {
        assert_true(source->materials[i].texture == ENF_NONE || source->materials[i].texture < source->texture_count);
    }
    for (uint32_t i = 0; i < source->texture_count; i++) {
        assert_true(source->textures[i].image < source->image_count);
    }
    for (uint32_t i = 0; i < source->path_count; i++) {
        assert_true(source->paths[i].node < source->node_count && source->paths[i].key_count > 0);
    }
}

static EnfResult import_file(const char *path) {
    EnfTestImport import = enf_test_import_file(path);
    check_sound(&import, path);
    EnfResult result = import.result;
    enf_test_import_free(&import);
    return result;
}

static EnfResult import_bytes(const void *data, size_t size, const char *name) {
    const char *path = enf_test_temp_path(name);
    remove(path); /* some file systems flush a file that is cut to nothing and written again */
    enf_test_write_file(path, data, size);
    return import_file(path);
}

/* ---- files of others -------------------------------------------------------------------------------------------- */

static uint32_t file_count, refused_count;

static int visit(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)walk;
    const char *dot = strrchr(path, '.');
    if (kind == FTW_F && dot && (strcmp(dot, ".gltf") == 0 || strcmp(dot, ".glb") == 0)) {
        file_count++;
        refused_count += import_file(path) != ENF_OK;
    }
    return 0;
}

static void validator_files_do_no_harm(void **state) {
    (void)state;
    char root[1024];
    snprintf(root, sizeof root, "%s", enf_test_data("conformance/gltf-validator/test"));
    file_count = refused_count = 0;
    assert_int_equal(nftw(root, visit, 16, FTW_PHYS), 0);
    printf("glTF-Validator: %u files, %u refused\n", file_count, refused_count);
    assert_true(file_count >= 372);
    assert_in_range(refused_count, 50, 120); /* most defects touch nothing that a level needs */
}

static void json_suite_is_decided(void **state) {
    (void)state;
    char folder[1024];
    snprintf(folder, sizeof folder, "%s", enf_test_data("conformance/JSONTestSuite/test_parsing"));
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    uint32_t counts[3] = {0};
    for (struct dirent *entry = readdir(listing); entry; entry = readdir(listing)) {
        const char *kind = strchr("yni", entry->d_name[0]) ? entry->d_name : NULL;
        char path[1400];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (!kind || kind[1] != '_') {
            continue;
        }
        size_t size;
        uint8_t *data = enf_test_read_file(path, &size);
        EnfJson json;
        EnfError error = {0};
        EnfResult result = enf_json_parse(&json, (const char *)data, size, 0, &error);
        if ((kind[0] == 'y' && result != ENF_OK) || (kind[0] == 'n' && result == ENF_OK)) {
            fail_msg("%s: %s at %llu", entry->d_name, result ? error.message : "accepted", (unsigned long long)error.offset);
        }
        enf_json_free(&json);
        assert_int_not_equal(import_bytes(data, size, "suite.gltf"), ENF_OK); /* none of them is a glTF */
        counts[kind[0] == 'y' ? 0 : kind[0] == 'n' ? 1 : 2]++;
        free(data);
    }
    closedir(listing);
    printf("JSONTestSuite: %u valid, %u malformed, %u either\n", counts[0], counts[1], counts[2]);
    assert_true(counts[0] >= 95 && counts[1] >= 180);
}

/* ---- damaged files ---------------------------------------------------------------------------------------------- */

static const uint8_t *small_glb(size_t *size) {
    return enf_test_read_file(enf_test_source_path("tests/fuzz/seeds/fuzz_import/two_rooms.glb"), size);
}

static void truncations_are_refused(void **state) {
    (void)state;
    size_t size;
    const uint8_t *data = small_glb(&size);
    assert_int_equal(import_bytes(data, size, "cut.glb"), ENF_OK);
    for (size_t cut = 0; cut < size; cut++) {
        if (import_bytes(data, cut, "cut.glb") == ENF_OK) {
            fail_msg("a file cut to %zu of %zu bytes was accepted", cut, size);
        }
    }
    free((void *)(uintptr_t)data);
}

/* The header's length follows the cut, so that the chunks are what is short. */
static void truncations_of_chunks_are_refused(void **state) {
    (void)state;
    size_t size;
    const uint8_t *data = small_glb(&size);
    uint8_t *copy = malloc(size);
    assert_non_null(copy);
    for (size_t cut = 12; cut < size; cut++) {
        memcpy(copy, data, cut);
        for (int i = 0; i < 4; i++) {
            copy[8 + i] = (uint8_t)(cut >> (8 * i));
        }
        assert_int_not_equal(import_bytes(copy, cut, "cut.glb"), ENF_OK);
    }
    free(copy);
    free((void *)(uintptr_t)data);
}

static void flipped_bits_do_no_harm(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    size_t size;
    const uint8_t *data = small_glb(&size);
    uint8_t *copy = malloc(size);
    assert_non_null(copy);
    uint32_t rounds = enf_test_rounds(2000, 100000), accepted = 0;
    for (uint32_t round = 0; round < rounds; round++) {
        memcpy(copy, data, size);
        uint32_t flips = 1 + enf_test_below(&rng, 4);
        for (uint32_t i = 0; i < flips; i++) {
            copy[enf_test_below(&rng, (uint32_t)size)] ^= (uint8_t)(1u << enf_test_below(&rng, 8));
        }
        accepted += import_bytes(copy, size, "flip.glb") == ENF_OK;
    }
    printf("flipped bits: %u of %u files still import\n", accepted, rounds);
    free(copy);
    free((void *)(uintptr_t)data);
}

/* One character of the JSON becomes another: digits, brackets and quotes hurt most. */
static void changed_characters_do_no_harm(void **state) {
    (void)state;
    static const char pool[] = "0123456789-.eE,:[]{}\"\\ntf \x7f\xC3";
    EnfTestRng rng = enf_test_rng(2);
    size_t size;
    char *text = (char *)enf_test_read_file(enf_test_source_path("tests/fuzz/seeds/fuzz_import/two_rooms.gltf"), &size);
    assert_int_equal(import_bytes(text, size, "change.gltf"), ENF_OK);
    uint32_t rounds = enf_test_rounds(2000, 100000);
    for (uint32_t round = 0; round < rounds; round++) {
        uint32_t at = enf_test_below(&rng, (uint32_t)size);
        char old = text[at];
        text[at] = pool[enf_test_below(&rng, sizeof pool - 1)];
        import_bytes(text, size, "change.gltf");
        text[at] = old;
    }
    free(text);
}

/* ---- sizes ------------------------------------------------------------------------------------------------------ */

#define ASSET "\"asset\":{\"version\":\"2.0\"}"

static void nesting_is_bounded(void **state) {
    (void)state;
    static const char *const opens[] = {"[", "{\"a\":", "[{\"a\":"};
    for (size_t i = 0; i < 3; i++) {
        EnfTestText text = {0};
        enf_test_put(&text, "{" ASSET ",\"extras\":");
        for (int k = 0; k < 200000; k++) {
            enf_test_put(&text, opens[i]);
        }
        EnfTestImport import = enf_test_import_text(text.text);
        assert_int_equal(import.result, ENF_ERROR_SIZE);
        assert_non_null(strstr(import.error.message, "nested too deeply"));
        enf_test_import_free(&import);
        free(text.text);
    }
}

static void nesting_below_the_bound_is_read(void **state) {
    (void)state;
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",\"nodes\":[{\"extras\":{\"a\":");
    for (int k = 0; k < 124; k++) {
        enf_test_put(&text, "[");
    }
    for (int k = 0; k < 124; k++) {
        enf_test_put(&text, "]");
    }
    enf_test_put(&text, "}}]}");
    EnfTestImport import = enf_test_import_text(text.text);
    assert_int_equal(import.result, ENF_OK);
    assert_int_equal(strlen(import.source.nodes[0].extras), 254);
    enf_test_import_free(&import);
    free(text.text);
}

typedef struct Refusal {
    const char *text; /* behind the asset */
    EnfResult result;
    const char *message;
} Refusal;

#define POINTS_OF(accessor)                                                                                                    \
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"}],"             \
    "\"accessors\":[" accessor "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]"

static const Refusal refusals[] = {
    {POINTS_OF("{\"componentType\":5126,\"count\":2147483647,\"type\":\"VEC3\"}"), ENF_ERROR_SIZE, "meshes[0].primitives[0]"},
    {POINTS_OF("{\"componentType\":5126,\"count\":67108865,\"type\":\"VEC3\"}"), ENF_ERROR_SIZE, "too many vertices"},
    {POINTS_OF("{\"componentType\":5126,\"count\":2147483648,\"type\":\"VEC3\"}"), ENF_ERROR_FORMAT, "accessors[0].count"},
    {POINTS_OF("{\"componentType\":5126,\"count\":-1,\"type\":\"VEC3\"}"), ENF_ERROR_FORMAT, "accessors[0].count"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3.0,\"type\":\"VEC3\"}"), ENF_ERROR_FORMAT, "accessors[0].count"},
    {POINTS_OF("{\"componentType\":5127,\"count\":3,\"type\":\"VEC3\"}"), ENF_ERROR_FORMAT, "componentType"},
    {POINTS_OF("{\"componentType\":5130,\"count\":3,\"type\":\"VEC3\"}"), ENF_ERROR_FORMAT, "componentType"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}"), ENF_ERROR_FORMAT, "too few components"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3,\"type\":\"VEC9\"}"), ENF_ERROR_FORMAT, "accessors[0].type"},
    {POINTS_OF("{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"bufferViews\":[{\"buffer\":0,"
                                                                                          "\"byteOffset\":2147483647,"
                                                                                          "\"byteLength\":2147483647}]",
     ENF_ERROR_RANGE, "bufferViews[0]"},
    {POINTS_OF(
         "{\"bufferView\":0,\"byteOffset\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"bufferViews\":[{"
                                                                                                     "\"buffer\":0,"
                                                                                                     "\"byteLength\":36}]",
     ENF_ERROR_RANGE, "accessors[0]: needs bytes 1 to 37"},
    {POINTS_OF(
         "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"bufferViews\":[{\"buffer\":0,"
                                                                                    "\"byteLength\":36,\"byteStride\":16}]",
     ENF_ERROR_RANGE, "accessors[0]: needs bytes 0 to 44"},
    {POINTS_OF(
         "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"bufferViews\":[{\"buffer\":0,"
                                                                                    "\"byteLength\":36,\"byteStride\":13}]",
     ENF_ERROR_FORMAT, "bufferViews[0].byteStride"},
    {POINTS_OF("{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"bufferViews\":[{\"buffer\":0,"
                                                                                          "\"byteLength\":36}]",
     ENF_ERROR_INDEX, "accessors[0].bufferView: is 1, but there are 1"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":4,\"indices\":{\"bufferView\":0,"
               "\"componentType\":5121},\"values\":{\"bufferView\":0}}}") ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]",
     ENF_ERROR_FORMAT, "sparse"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":3,\"indices\":{\"bufferView\":0,"
               "\"componentType\":5121},\"values\":{\"bufferView\":0,\"byteOffset\":4}}}") ",\"bufferViews\":[{\"buffer\":0,"
                                                                                           "\"byteLength\":36}]",
     ENF_ERROR_RANGE, "accessors[0]: needs bytes 4 to 40"},
    {POINTS_OF("{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}") ",\"accessors\":[]", ENF_ERROR_FORMAT,
     "accessors: is given twice"},
    {"\"nodes\":[{\"translation\":[1e300,0,0]}]", ENF_ERROR_RANGE, "nodes[0]: 'node 0' lies more than 2^28 m away"},
    {"\"nodes\":[{\"scale\":[1e300,1,1],\"children\":[1]},{\"scale\":[1e300,1,1]}]", ENF_ERROR_RANGE, "nodes[1]"},
    {"\"nodes\":[{\"translation\":[1e400,0,0]}]", ENF_ERROR_FORMAT, "nodes[0].translation[0]: must be a number"},
    {"\"nodes\":[{\"translation\":[0,0]}]", ENF_ERROR_FORMAT, "nodes[0].translation: has the wrong number"},
    {"\"nodes\":[{\"mesh\":\"\"}]", ENF_ERROR_FORMAT, "nodes[0].mesh: must be an index"},
    {"\"nodes\":[{\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]", ENF_ERROR_INDEX, "there are 0 lights"},
    {"\"buffers\":[{\"byteLength\":4,\"uri\":\"data:;base64,AAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":4}],"
     "\"images\":[{\"bufferView\":0}],\"textures\":[{\"source\":0}],\"materials\":[{\"emissiveTexture\":{\"index\":0}}]",
     ENF_ERROR_TRUNCATED, "buffers[0].byteLength: is 4, but there are 3"},
};

static void refusals_name_the_place(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        EnfTestText text = {0};
        enf_test_put(&text, "{" ASSET ",");
        enf_test_put(&text, refusals[i].text);
        enf_test_put(&text, "}");
        EnfTestImport import = enf_test_import_text(text.text);
        if (import.result != refusals[i].result || !strstr(import.error.message, refusals[i].message)) {
            fail_msg("case %zu: %s; %s", i, enf_result_text(import.result), import.error.message);
        }
        check_sound(&import, text.text);
        enf_test_import_free(&import);
        free(text.text);
    }
}

/* A little text must not become a lot of memory: a million instances of nothing, a long list of nothing. */
static void amplification_is_bounded(void **state) {
    (void)state;
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET ",\"accessors\":[{\"componentType\":5126,\"count\":3000000,\"type\":\"VEC3\"}],"
                        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":["
                        "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}}]}");
    EnfTestImport import = enf_test_import_text(text.text);
    assert_int_equal(import.result, ENF_ERROR_SIZE);
    assert_non_null(strstr(import.error.message, "nodes: 3000001 with their instances"));
    enf_test_import_free(&import);
    text.length = 0;
    enf_test_put(&text, "{" ASSET ",\"accessors\":[{\"componentType\":5126,\"count\":300000,\"type\":\"VEC3\"}],"
                        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}");
    for (int i = 0; i < 1000; i++) {
        enf_test_put(&text, ",{\"mesh\":0}");
    }
    enf_test_put(&text, "]}");
    import = enf_test_import_text(text.text);
    assert_int_equal(import.result, ENF_ERROR_SIZE);
    assert_non_null(strstr(import.error.message, "triangles"));
    enf_test_import_free(&import);
    free(text.text);
}

/* Names that no rule looks at may be given again and again; the rewriting must not grow by them. */
static void repeated_names_do_no_harm(void **state) {
    (void)state;
    EnfTestText text = {0};
    enf_test_put(&text, "{" ASSET);
    for (int i = 0; i < 20000; i++) {
        enf_test_put(&text, i % 2 ? ",\"skins\":0" : ",\"extras\":1");
    }
    enf_test_put(&text, ",\"nodes\":[{\"extras\":1,\"extras\":2,\"extras\":{}}]}");
    EnfTestImport import = enf_test_import_text(text.text);
    assert_int_equal(import.result, ENF_OK);
    assert_string_equal(import.source.nodes[0].extras, "{}");
    enf_test_import_free(&import);
    free(text.text);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(validator_files_do_no_harm), cmocka_unit_test(json_suite_is_decided),
    cmocka_unit_test(truncations_are_refused),    cmocka_unit_test(truncations_of_chunks_are_refused),
    cmocka_unit_test(flipped_bits_do_no_harm),    cmocka_unit_test(changed_characters_do_no_harm),
    cmocka_unit_test(nesting_is_bounded),         cmocka_unit_test(nesting_below_the_bound_is_read),
    cmocka_unit_test(refusals_name_the_place),    cmocka_unit_test(amplification_is_bounded),
    cmocka_unit_test(repeated_names_do_no_harm),
};

ENF_TEST_MAIN(tests)

/* The importer against models made by others: every Khronos sample, every file of the asset generator, kits and levels. The oracle
 * reads the JSON itself (cJSON) and knows only counts, modes, minima and maxima. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "harness/gltf.h"

#include <ftw.h>
#include <inttypes.h>
#include <math.h>

#include <cjson/cJSON.h>

/* ---- a tiny reading of glTF ------------------------------------------------------------------------------------- */

static cJSON *read_json(const char *path) {
    size_t size;
    uint8_t *data = enf_test_read_file(path, &size);
    bool binary = size > 20 && memcmp(data, "glTF", 4) == 0;
    uint32_t length = 0;
    memcpy(&length, data + (binary ? 12 : 0), 4);
    cJSON *json = cJSON_ParseWithLength((const char *)data + (binary ? 20 : 0), binary ? length : size);
    assert_non_null(json);
    free(data);
    return json;
}

static const cJSON *at(const cJSON *object, const char *key) {
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

static int number(const cJSON *object, const char *key, int missing) {
    const cJSON *value = at(object, key);
    return value ? value->valueint : missing;
}

static const cJSON *element(const cJSON *json, const char *array, int index) {
    return cJSON_GetArrayItem(at(json, array), index);
}

static int primitive_triangles(const cJSON *json, const cJSON *primitive) {
    const cJSON *attributes = at(primitive, "attributes");
    int indices = number(primitive, "indices", -1), positions = number(attributes, "POSITION", -1);
    int mode = number(primitive, "mode", 4);
    if (positions < 0 || mode < 4) {
        return 0;
    }
    int count = number(element(json, "accessors", indices >= 0 ? indices : positions), "count", 0);
    return mode == 4 ? count / 3 : count < 3 ? 0 : count - 2;
}

/* ---- comparison ------------------------------------------------------------------------------------------------- */

typedef struct Model {
    const char *path;
    const cJSON *json;
    const EnfSource *source;
    uint32_t nodes, primitives;
    uint64_t triangles;
    bool *meshes_seen;
} Model;

/* Where an accessor gives the bounds as plain numbers, and all of its vertices are used, they are those of what we decoded. */
static void compare_bounds(const Model *model, const cJSON *primitive, const EnfSourcePrimitive *decoded) {
    const cJSON *accessor = element(model->json, "accessors", number(at(primitive, "attributes"), "POSITION", -1));
    const cJSON *low = at(accessor, "min"), *high = at(accessor, "max");
    if (!low || !high || cJSON_IsTrue(at(accessor, "normalized"))) {
        return;
    }
    bool whole = decoded->vertex_count == (uint32_t)number(accessor, "count", 0);
    for (int axis = 0; axis < 3; axis++) {
        double given_low = cJSON_GetArrayItem(low, axis)->valuedouble, given_high = cJSON_GetArrayItem(high, axis)->valuedouble;
        double found_low = (double)INFINITY, found_high = -(double)INFINITY,
               slack = 1e-5 * (1.0 + fabs(given_low) + fabs(given_high));
        for (uint32_t v = 0; v < decoded->vertex_count; v++) {
            double p = (double)decoded->positions[3 * (size_t)v + (size_t)axis];
            found_low = fmin(found_low, p);
            found_high = fmax(found_high, p);
        }
        bool inside = found_low >= given_low - slack && found_high <= given_high + slack;
        bool equal = fabs(found_low - given_low) <= slack && fabs(found_high - given_high) <= slack;
        if (!inside || (whole && !equal)) {
            fail_msg("%s: axis %d is %g to %g, its accessor says %g to %g", model->path, axis, found_low, found_high, given_low,
                     given_high);
        }
    }
}

static void compare_primitive(Model *model, const cJSON *primitive, const EnfSourcePrimitive *decoded) {
    const cJSON *attributes = at(primitive, "attributes");
    uint32_t count = (uint32_t)number(element(model->json, "accessors", number(attributes, "POSITION", 0)), "count", 0);
    assert_int_equal(decoded->index_count, 3 * primitive_triangles(model->json, primitive));
    if (at(attributes, "NORMAL")) {
        assert_true(decoded->vertex_count <= count);
    }
    assert_true(decoded->material < model->source->material_count);
    assert_int_equal(decoded->colors != NULL, at(attributes, "COLOR_0") != NULL);
    for (uint32_t i = 0; i < decoded->index_count; i++) {
        assert_true(decoded->indices[i] < decoded->vertex_count);
    }
    for (uint32_t v = 0; v < decoded->vertex_count; v++) {
        const float *n = decoded->normals + 3 * (size_t)v;
        double length = sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
        assert_true(fabs(length - 1.0) < 1e-4);
    }
    compare_bounds(model, primitive, decoded);
}

static void compare_mesh(Model *model, int index) {
    const cJSON *primitive;
    const EnfSourceMesh *mesh = &model->source->meshes[index];
    uint32_t decoded = 0;
    cJSON_ArrayForEach(primitive, at(element(model->json, "meshes", index), "primitives")) {
        model->triangles += (uint64_t)primitive_triangles(model->json, primitive);
        if (number(primitive, "mode", 4) < 4 || !at(at(primitive, "attributes"), "POSITION")) {
            continue;
        }
        assert_true(decoded < mesh->primitive_count);
        if (!model->meshes_seen[index]) {
            compare_primitive(model, primitive, &model->source->primitives[mesh->primitive_first + decoded]);
        }
        decoded++;
    }
    assert_int_equal(decoded, mesh->primitive_count);
    model->meshes_seen[index] = true;
}

static void compare_node(Model *model, int index) {
    const cJSON *node = element(model->json, "nodes", index), *child;
    assert_true(model->nodes < model->source->node_count);
    const EnfSourceNode *decoded = &model->source->nodes[model->nodes++];
    assert_int_equal(decoded->index, index);
    const char *name = cJSON_GetStringValue(at(node, "name"));
    if (name && *name) {
        assert_string_equal(decoded->name, name);
    }
    int mesh = number(node, "mesh", -1);
    assert_int_equal(decoded->mesh, mesh < 0 ? ENF_NONE : (uint32_t)mesh);
    if (mesh >= 0) {
        compare_mesh(model, mesh);
    }
    cJSON_ArrayForEach(child, at(node, "children")) {
        compare_node(model, child->valueint);
    }
}

static void compare(const char *path, const EnfTestImport *import) {
    cJSON *json = read_json(path);
    Model model = {.path = path, .json = json, .source = &import->source};
    model.meshes_seen = calloc((size_t)cJSON_GetArraySize(at(json, "meshes")) + 1, sizeof(bool));
    const cJSON *root;
    cJSON_ArrayForEach(root, at(element(json, "scenes", number(json, "scene", 0)), "nodes")) {
        compare_node(&model, root->valueint);
    }
    if (at(json, "scenes")) {
        assert_int_equal(model.nodes, import->source.node_count);
        assert_int_equal(model.triangles, import->source.triangle_count);
    }
    uint32_t materials = (uint32_t)cJSON_GetArraySize(at(json, "materials"));
    assert_in_range(import->source.material_count, materials, materials + 1);
    assert_int_equal(enf_test_found(import, ENF_DIAGNOSIS_IMAGE), 0);
    free(model.meshes_seen);
    cJSON_Delete(json);
}

/* ---- folders ---------------------------------------------------------------------------------------------------- */

static uint32_t file_count, stride; /* every stride-th file is imported */
static uint64_t triangle_count;

/* The generator's two files that a reader of 2.0 must refuse: a later version, an extension that does not exist. */
static bool must_be_refused(const char *path) {
    return strstr(path, "Compatibility_04.") || strstr(path, "Compatibility_05.");
}

static int visit(const char *path, const struct stat *status, int kind, struct FTW *walk) {
    (void)status, (void)walk;
    const char *dot = strrchr(path, '.');
    if (kind != FTW_F || !dot || (strcmp(dot, ".gltf") != 0 && strcmp(dot, ".glb") != 0)) {
        return 0;
    }
    if (file_count++ % stride != 0) {
        return 0;
    }
    EnfTestImport import = enf_test_import_file(path);
    if ((import.result != ENF_OK) != must_be_refused(path)) {
        fail_msg("%s: %s", path, import.error.message);
    }
    if (import.result == ENF_OK) {
        compare(path, &import);
        triangle_count += import.source.triangle_count;
    }
    enf_test_import_free(&import);
    return 0;
}

static void visit_folder(const char *relative, uint32_t at_least, uint32_t every) {
    char root[1024];
    snprintf(root, sizeof root, "%s", enf_test_data(relative));
    file_count = 0;
    stride = every;
    triangle_count = 0;
    assert_int_equal(nftw(root, visit, 16, FTW_PHYS), 0);
    printf("%s: %u files, %" PRIu64 " triangles\n", relative, file_count, triangle_count);
    assert_true(file_count >= at_least);
}

static void samples_import(void **state) {
    (void)state;
    visit_folder("sample-models", 25, 1);
}

static void generated_assets_import(void **state) {
    (void)state;
    visit_folder("conformance/gltf-asset-generator-positive", 150, 1);
}

static void kits_and_scenes_import(void **state) {
    (void)state;
    visit_folder("kits", 200, enf_test_rounds(8, 1));
    visit_folder("unstructured", 1, 1);
    visit_folder("godot", 1, 1);
}

/* ---- levels ----------------------------------------------------------------------------------------------------- */

static uint64_t triangles_of(const EnfSource *source, uint32_t node) {
    uint64_t count = 0;
    uint32_t mesh = source->nodes[node].mesh;
    for (uint32_t i = 0; mesh != ENF_NONE && i < source->meshes[mesh].primitive_count; i++) {
        count += source->primitives[source->meshes[mesh].primitive_first + i].index_count / 3;
    }
    return count;
}

/* Does this node's geometry count as the cell's own? Props stand in a cell; portals are no geometry. */
static bool is_shell(const EnfSourceNode *node, const char *cell, bool props) {
    size_t length = strlen(cell);
    bool own = strncmp(node->name, cell, length) == 0 &&
               (strcmp(node->name + length, "_geo") == 0 || strcmp(node->name + length, "_grate") == 0);
    return own || (props && strncmp(node->name, "prop_", 5) == 0);
}

/* A cell's triangles: in Freedoom without props, in the duplex with them. */
static uint64_t cell_triangles(const EnfSource *source, const char *cell, bool props) {
    char room[64];
    snprintf(room, sizeof room, "%s-room", cell);
    uint64_t count = 0;
    for (uint32_t i = 0; i < source->node_count; i++) {
        const EnfSourceNode *node = &source->nodes[i];
        bool inside = node->parent != ENF_NONE && strcmp(source->nodes[node->parent].name, room) == 0;
        count += inside && is_shell(node, cell, props) ? triangles_of(source, i) : 0;
    }
    return count;
}

/* Each cell's triangles, as the maker of the level counted them. */
static void compare_cells(const char *level, const char *truth_path, bool props) {
    EnfTestImport import = enf_test_import_file(level);
    if (import.result != ENF_OK) {
        fail_msg("%s: %s", level, import.error.message);
    }
    cJSON *truth = read_json(truth_path);
    const cJSON *cell;
    int64_t sum = 0;
    cJSON_ArrayForEach(cell, at(truth, "cells")) {
        const char *name = cJSON_GetStringValue(at(cell, "name"));
        uint64_t found = cell_triangles(&import.source, name, props);
        if (found != (uint64_t)number(cell, "tris", -1)) {
            fail_msg("%s: %s has %" PRIu64 " triangles, not %d", level, name, found, number(cell, "tris", -1));
        }
        sum += (int64_t)found;
    }
    assert_int_equal(sum, number(at(truth, "stats"), "triangles", -1));
    assert_true(import.source.has_extras);
    cJSON_Delete(truth);
    enf_test_import_free(&import);
}

static void levels_have_their_triangles(void **state) {
    (void)state;
    static const char *const levels[] = {"freedoom/E1M1_rooms",  "freedoom/E1M1_sector", "freedoom/E3M8_rooms",
                                         "freedoom/MAP01_rooms", "freedoom/MAP26_rooms", "buildings/duplex"};
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
        char level[256], truth[256];
        snprintf(level, sizeof level, "%s.glb", levels[i]);
        snprintf(truth, sizeof truth, "%s.truth.json", levels[i]);
        compare_cells(enf_test_data(level), enf_test_data(truth), strstr(level, "duplex") != NULL);
    }
}

/* The same bytes give the same source. */
static void imports_repeat(void **state) {
    (void)state;
    EnfTestImport one = enf_test_import_file(enf_test_data("freedoom/E1M1_rooms.glb"));
    EnfTestImport two = enf_test_import_file(enf_test_data("freedoom/E1M1_rooms.glb"));
    assert_true(one.source.hash == two.source.hash && one.source.hash != 0);
    for (uint32_t i = 0; i < one.source.primitive_count; i++) {
        const EnfSourcePrimitive *a = &one.source.primitives[i], *b = &two.source.primitives[i];
        assert_memory_equal(a->positions, b->positions, 12 * (size_t)a->vertex_count);
        assert_memory_equal(a->indices, b->indices, 4 * (size_t)a->index_count);
    }
    enf_test_import_free(&one);
    enf_test_import_free(&two);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(samples_import),         cmocka_unit_test(generated_assets_import),
    cmocka_unit_test(kits_and_scenes_import), cmocka_unit_test(levels_have_their_triangles),
    cmocka_unit_test(imports_repeat),
};

ENF_TEST_MAIN(tests)

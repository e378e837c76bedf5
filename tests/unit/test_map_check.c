/* enf_map_check against one corruption of each field: refused, with the chunk, the record and the field in the message. */
#include "harness/harness.h"
#include "map/map_internal.h"
#include "scenes/everything.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint8_t *everything_file(size_t *size) {
    const char *path = enf_test_temp_path("map.enfmap");
    EnfError error = {0};
    EnfMaker *maker = enf_everything_create(&error);
    if (!maker || enf_map_write(enf_maker_map(maker), path, &error)) {
        fail_msg("%s", error.message);
    }
    enf_maker_destroy(maker);
    return enf_test_read_file(path, size);
}

/* A map whose records can be changed. */
typedef struct Draft {
#define DRAFT_FIELD(type, array, fourcc) type *array;
    ENF_MAP_CHUNKS(DRAFT_FIELD)
#undef DRAFT_FIELD
    EnfMap map;
    uint8_t *bytes;
} Draft;

static Draft draft_of(const uint8_t *file, size_t size) {
    Draft draft;
    draft.bytes = malloc(size);
    memcpy(draft.bytes, file, size);
    EnfError error = {0};
    if (enf_map_view(&draft.map, draft.bytes, size, &error)) {
        fail_msg("%s", error.message);
    }
#define DRAFT_POINT(type, array, fourcc)                                                                                       \
    draft.array = (type *)(void *)(draft.bytes + ((const uint8_t *)draft.map.array - draft.bytes));
    ENF_MAP_CHUNKS(DRAFT_POINT)
#undef DRAFT_POINT
    return draft;
}

static void expect_refused(Draft *draft, const char *field, EnfResult code) {
    EnfError error = {0};
    EnfResult result = enf_map_check(&draft->map, &error);
    if (result == ENF_OK) {
        fail_msg("%s: accepted", field);
    }
    if (!strstr(error.message, field) || !strstr(error.message, "chunk ")) {
        fail_msg("%s: not named in: %s", field, error.message);
    }
    if (result != code) {
        fail_msg("%s: %s instead of %s", field, enf_result_text(result), enf_result_text(code));
    }
    free(draft->bytes);
}

#define HUGE_INDEX 0x7fffffffu
/* clang-format off */
#define CORRUPTIONS(X)                                                          \
    X("strings", FORMAT, strings[0] = 'x')                                      \
    X("strings", FORMAT, strings[d.map.strings_count - 1] = 'x')                \
    X("images[0].width", RANGE, images[0].width = 0)                            \
    X("images[0].height", RANGE, images[0].height = 16385)                      \
    X("images[0].byte_first", INDEX, images[0].byte_first = 4)                  \
    X("images[0].name", INDEX, images[0].name = HUGE_INDEX)                     \
    X("textures[0].image", INDEX, textures[0].image = 1)                        \
    X("textures[0].mag_filter", RANGE, textures[0].mag_filter = 0)              \
    X("textures[0].min_filter", RANGE, textures[0].min_filter = 9988)           \
    X("textures[0].wrap_s", RANGE, textures[0].wrap_s = 1)                      \
    X("textures[0].wrap_t", RANGE, textures[0].wrap_t = 1)                      \
    X("materials[1].name", INDEX, materials[1].name = HUGE_INDEX)               \
    X("materials[1].texture", INDEX, materials[1].texture = 1)                  \
    X("materials[1].emissive_texture", INDEX, materials[1].emissive_texture = 7)\
    X("materials[1].alpha_mode", RANGE, materials[1].alpha_mode = 3)            \
    X("materials[1].flags", RANGE, materials[1].flags = 64)                     \
    X("materials[0].base_color", RANGE, materials[0].base_color[3] = NAN)       \
    X("materials[0].emissive", RANGE, materials[0].emissive[2] = INFINITY)      \
    X("materials[0].alpha_cutoff", RANGE, materials[0].alpha_cutoff = NAN)      \
    X("materials[0].roughness", RANGE, materials[0].roughness = NAN)            \
    X("materials[0].metallic", RANGE, materials[0].metallic = NAN)              \
    X("materials[0].uv_transform", RANGE, materials[0].uv_transform[5] = NAN)   \
    X("materials[0].reserved", RANGE, materials[0].reserved = 1)                \
    X("cells[0].origin", RANGE, cells[0].origin[1] = (double)NAN)               \
    X("cells[0].origin", RANGE, cells[0].origin[1] = 1.0 / 512.0)               \
    X("cells[0].origin", RANGE, cells[0].origin[1] = 1e9)                       \
    X("cells[0].min", RANGE, cells[0].min[0] = NAN)                             \
    X("cells[0].min", RANGE, cells[0].min[0] = 100)                             \
    X("cells[0].max", RANGE, cells[0].max[2] = INFINITY)                        \
    X("cells[1].name", INDEX, cells[1].name = HUGE_INDEX)                       \
    X("cells[1].flags", RANGE, cells[1].flags = 4)                              \
    X("flags", FORMAT, cells[1].flags = d.cells[0].flags = ENF_CELL_OUTSIDE)    \
    X("cells[1].portal_first", INDEX, cells[1].portal_first = HUGE_INDEX)       \
    X("cells[1].portal_first", INDEX, cells[1].portal_count = HUGE_INDEX)       \
    X("cells[1].portal_first", INDEX, cells[1].portal_first = 3)                \
    X("portals[6].source", INDEX, cells[2].portal_count = 0)                    \
    X("cells[1].node_first", INDEX, cells[1].node_first = HUGE_INDEX)           \
    X("cells[1].block_first", INDEX, cells[1].block_count = HUGE_INDEX)         \
    X("kd_nodes", FORMAT, cells[2].node_count = 0)                              \
    X("cells[1].cluster_first", INDEX, cells[1].cluster_first = HUGE_INDEX)     \
    X("cells[1].cluster_first", INDEX, cells[1].cluster_first = 0)              \
    X("cells[1].light_first", INDEX, cells[1].light_first = HUGE_INDEX)         \
    X("cells[2].bound_first", INDEX, cells[2].bound_count = 7)                  \
    X("cells[2].reserved", RANGE, cells[2].reserved = 1)                        \
    X("transforms[0].m", RANGE, transforms[0].m[4] = (double)NAN)               \
    X("transforms[0].m", RANGE, transforms[0].m[4] = 1.0000000001)              \
    X("transforms[1].m", RANGE, transforms[1].m[1] = 1e-9)                      \
    X("transforms[1].t", RANGE, transforms[1].t[0] = 1e300)                     \
    X("portals[0].source", INDEX, portals[0].source = 3)                        \
    X("cells[0].portal_first", INDEX, portals[0].source = 1)                    \
    X("portals[0].target", INDEX, portals[0].target = HUGE_INDEX)               \
    X("portals[0].target", INDEX, portals[0].target = 0)                        \
    X("portals[0].twin", INDEX, portals[0].twin = 7)                            \
    X("portals[0].twin", INDEX, portals[0].twin = 0)                            \
    X("portals[0].twin", INDEX, portals[0].twin = 5)                            \
    X("portals[0].twin", INDEX, portals[0].target = 2)                          \
    X("portals[0].twin", FORMAT, portals[0].transform = 1)                      \
    X("portals[0].vertex_first", INDEX, portals[0].vertex_first = HUGE_INDEX)   \
    X("portals[0].vertex_count", RANGE, portals[0].vertex_count = 2)            \
    X("portals[1].vertex_count", RANGE, portals[1].vertex_count = 3)            \
    X("portals[1].transform", FORMAT, portals[1].transform = 1)                 \
    X("portals[0].transform", INDEX, portals[0].transform = 3)                  \
    X("portals[0].flags", RANGE, portals[0].flags = 16)                         \
    X("portals[0].flags", FORMAT, portals[0].flags = ENF_PORTAL_MIRROR)         \
    X("portals[2].flags", FORMAT, portals[2].flags = 0)                         \
    X("portals[0].name", INDEX, portals[0].name = HUGE_INDEX)                   \
    X("portal_vertices[2]", RANGE, portal_vertices[2].y = NAN)                  \
    X("bound_planes[1]", RANGE, bound_planes[1].d = INFINITY)                   \
    X("bound_planes[0].n", RANGE, bound_planes[0].n[0] = 0)                     \
    X("vertices[3].position", RANGE, vertices[3].position[2] = NAN)             \
    X("vertices[3].position", RANGE, vertices[3].position[2] = 100)             \
    X("vertices[3].uv", RANGE, vertices[3].uv[1] = NAN)                         \
    X("vertices[3].cell", INDEX, vertices[3].cell = 3)                          \
    X("vertices[3].cell", INDEX, vertices[3].cell = 1)                          \
    X("indices[5]", INDEX, indices[5] = HUGE_INDEX)                             \
    X("indices[5]", INDEX, indices[5] = 30)                                     \
    X("clusters[0].min", RANGE, clusters[0].min[0] = NAN)                       \
    X("clusters[0].min", RANGE, clusters[0].min[0] = 50)                        \
    X("clusters[0].max", RANGE, clusters[0].max[0] = INFINITY)                  \
    X("clusters[0].cell", INDEX, clusters[0].cell = 3)                          \
    X("cells[0].cluster_first", INDEX, clusters[0].cell = 1)                    \
    X("clusters[0].material", INDEX, clusters[0].material = 2)                  \
    X("clusters[0].index_first", INDEX, clusters[0].index_first = HUGE_INDEX)   \
    X("clusters[0].index_count", RANGE, clusters[0].index_count = 4)            \
    X("clusters[0].index_count", RANGE, clusters[0].index_count = 0)            \
    X("clusters[0].vertex_first", INDEX, clusters[0].vertex_count = HUGE_INDEX) \
    X("indices", INDEX, clusters[0].vertex_count = 20)                          \
    X("clusters[2].node", INDEX, clusters[2].node = HUGE_INDEX)                 \
    X("clusters[2].reserved", RANGE, clusters[2].reserved = 1)                  \
    X("kd_nodes[0]", INDEX, kd_nodes[0].block_count = 2)                        \
    X("kd_nodes[1]", RANGE, kd_nodes[1].min[0] = NAN)                           \
    X("the tree of cell 1", FORMAT, kd_nodes[1].link = 1)                       \
    X("the tree of cell 1", RANGE, kd_nodes[1].max[0] = 1)                      \
    X("the tree of cell 0", INDEX, kd_blocks[0].item[0] = 3)                    \
    X("the tree of cell 0", FORMAT, kd_blocks[0].item[0] = ENF_NONE)            \
    X("kd_blocks[0].item", INDEX, kd_blocks[0].item[1] = 0)                     \
    X("kd_blocks[0].min_x", RANGE, kd_blocks[0].min_x[0] = 1)                   \
    X("lights[0].position", RANGE, lights[0].position[0] = (double)NAN)         \
    X("lights[0].direction", RANGE, lights[0].direction[0] = NAN)               \
    X("lights[0].direction", RANGE, lights[0].direction[1] = (float)(d.lights[0].kind = ENF_LIGHT_SPOT) - 1) \
    X("lights[0].color", RANGE, lights[0].color[0] = NAN)                       \
    X("lights[0].range", RANGE, lights[0].range = -1)                           \
    X("lights[0].inner_cos", RANGE, lights[0].inner_cos = NAN)                  \
    X("lights[0].outer_cos", RANGE, lights[0].outer_cos = NAN)                  \
    X("lights[0].outer_cos", RANGE, lights[0].outer_cos = 1.0f + (float)(d.lights[0].kind = ENF_LIGHT_SPOT)) \
    X("lights[0].kind", RANGE, lights[0].kind = 3)                              \
    X("lights[0].cell", INDEX, lights[0].cell = 3)                              \
    X("lights[0].name", INDEX, lights[0].name = HUGE_INDEX)                     \
    X("light_refs[1].light", INDEX, light_refs[1].light = 2)                    \
    X("light_refs[1].plane_first", INDEX, light_refs[1].plane_count = 3)        \
    X("light_planes[1]", RANGE, light_planes[1].d = NAN)                        \
    X("light_planes[1].n", RANGE, light_planes[1].n[1] = 0)                     \
    X("cameras[0]", RANGE, cameras[0].far_plane = INFINITY)                     \
    X("cameras[0].fov_y", RANGE, cameras[0].fov_y = -1)                         \
    X("entities[0].translation", RANGE, entities[0].translation[0] = (double)NAN) \
    X("entities[0].rotation", RANGE, entities[0].rotation[0] = NAN)             \
    X("entities[0].rotation", RANGE, entities[0].rotation[3] = 0)               \
    X("entities[0].scale", RANGE, entities[0].scale[2] = NAN)                   \
    X("entities[0].name", INDEX, entities[0].name = HUGE_INDEX)                 \
    X("entities[0].classname", INDEX, entities[0].classname = HUGE_INDEX)       \
    X("entities[0].extras", INDEX, entities[0].extras = HUGE_INDEX)             \
    X("entities[0].parent", INDEX, entities[0].parent = HUGE_INDEX)             \
    X("entities[0].parent", INDEX, entities[0].parent = 0)                      \
    X("entities[0].parent", INDEX, entities[0].parent = 1)                      \
    X("entities[0].cell", INDEX, entities[0].cell = 3)                          \
    X("entities[0].camera", INDEX, entities[0].camera = 1)                      \
    X("entities[0].light", INDEX, entities[0].light = 2)                        \
    X("paths[0].name", INDEX, paths[0].name = HUGE_INDEX)                       \
    X("paths[0].entity", INDEX, paths[0].entity = 2)                            \
    X("paths[0].target", RANGE, paths[0].target = 3)                            \
    X("paths[0].kind", RANGE, paths[0].kind = 3)                                \
    X("paths[0].key_count", RANGE, paths[0].key_count = 0)                      \
    X("paths[0].float_first", INDEX, paths[0].key_count = HUGE_INDEX)           \
    X("paths[1].float_first", INDEX, paths[1].float_first = 9)                  \
    X("path_floats[3]", RANGE, path_floats[3] = NAN)                            \
    X("path_floats[1]", RANGE, path_floats[1] = 0)                              \
    X("meshes[0].min", RANGE, meshes[0].min[0] = NAN)                           \
    X("meshes[0].min", RANGE, meshes[0].min[0] = 50)                            \
    X("meshes[1].max", RANGE, meshes[1].max[2] = INFINITY)                      \
    X("meshes[0].part_first", INDEX, meshes[0].part_first = HUGE_INDEX)         \
    X("meshes[1].part_first", FORMAT, meshes[1].part_first = 0)                 \
    X("meshes[1].part_first", FORMAT, meshes[1].part_count = 0)                 \
    X("meshes[0].name", INDEX, meshes[0].name = HUGE_INDEX)                     \
    X("meshes[0].reserved", RANGE, meshes[0].reserved = 1)                      \
    X("mesh_parts[0].mesh", INDEX, mesh_parts[0].mesh = 2)                      \
    X("mesh_parts[0].mesh", INDEX, mesh_parts[0].mesh = 1)                      \
    X("mesh_parts[0].material", INDEX, mesh_parts[0].material = HUGE_INDEX)     \
    X("mesh_parts[0].index_first", INDEX, mesh_parts[0].index_first = HUGE_INDEX) \
    X("mesh_parts[0].index_count", RANGE, mesh_parts[0].index_count = 4)        \
    X("mesh_parts[0].vertex_first", INDEX, mesh_parts[0].vertex_count = HUGE_INDEX) \
    X("indices", INDEX, mesh_parts[0].vertex_count = 3)                         \
    X(".cell", INDEX, vertices[d.mesh_parts[0].vertex_first].cell = 0)          \
    X(".position", RANGE, vertices[d.mesh_parts[1].vertex_first].position[1] = 50) \
    X("movers[0].pivot", RANGE, movers[0].pivot[1] = (double)NAN)               \
    X("movers[0].entity", INDEX, movers[0].entity = HUGE_INDEX)                 \
    X("movers[0].mesh", INDEX, movers[0].mesh = 2)                              \
    X("movers[0].kind", RANGE, movers[0].kind = 5)                              \
    X("movers[1].wrap", RANGE, movers[1].wrap = 3)                              \
    X("movers[1].translation", INDEX, movers[1].translation = 2)                \
    X("movers[1].translation", INDEX, movers[1].translation = 1)                \
    X("movers[2].rotation", INDEX, movers[2].rotation = HUGE_INDEX)             \
    X("movers[1].scale", INDEX, movers[1].scale = 2)                            \
    X("movers[3].portal", INDEX, movers[3].portal = 7)                          \
    X("movers[3].flags", RANGE, movers[3].flags = 8)                            \
    X("movers[3].axis", RANGE, movers[3].axis[0] = NAN)                         \
    X("movers[3].axis", RANGE, movers[3].axis[0] = 1)                           \
    X("movers[3].low", RANGE, movers[3].low = 0.5f)                             \
    X("movers[4].high", RANGE, movers[4].high = NAN)                            \
    X("movers[4].low", RANGE, movers[4].high = -0.5f)                           \
    X("movers[4].rate", RANGE, movers[4].rate = 0)                              \
    X("movers[1].seconds", RANGE, movers[1].seconds = 0)                        \
    X("movers[1].seconds", RANGE, movers[1].seconds = 1e9f)                     \
    X("movers[1].phase", RANGE, movers[1].phase = -1e9f)                        \
    X("movers[5].max_speed", RANGE, movers[5].max_speed = 0)                    \
    X("movers[0].max_speed", RANGE, movers[0].max_speed = -1)                   \
    X("movers[0].reserved", RANGE, movers[0].reserved = 1)                      \
    X("the tree of all cells", INDEX, cell_blocks[0].item[0] = 3)               \
    X("cell_blocks[0].item", INDEX, cell_blocks[0].item[1] = 0)                 \
    X("cell_blocks[0].min_x", RANGE, cell_blocks[0].min_x[0] = 1)               \
    X("cell_blocks", FORMAT, map.cell_nodes_count = d.map.cell_blocks_count = 0)\
    X("tree_origin[0]", RANGE, map.tree_origin[1] = (double)NAN)
/* clang-format on */

static void test_corruptions(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
#define CORRUPT(field, code, statement)                                                                                        \
    {                                                                                                                          \
        Draft d = draft_of(file, size);                                                                                        \
        d.statement;                                                                                                           \
        expect_refused(&d, field, ENF_ERROR_##code);                                                                           \
    }
    CORRUPTIONS(CORRUPT)
#undef CORRUPT
    free(file);
}

/* The offset is that of the field in the file. */
static void test_error_offset(void **state) {
    (void)state;
    size_t size;
    uint8_t *file = everything_file(&size);
    Draft d = draft_of(file, size);
    d.portals[4].name = HUGE_INDEX;
    EnfError error = {0};
    assert_int_equal(enf_map_check(&d.map, &error), ENF_ERROR_INDEX);
    uint32_t there;
    memcpy(&there, d.bytes + error.offset, sizeof there);
    assert_int_equal(there, HUGE_INDEX);
    assert_non_null(strstr(error.message, "chunk PORT: portals[4].name"));
    free(d.bytes);
    free(file);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_corruptions),
    cmocka_unit_test(test_error_offset),
};

ENF_TEST_MAIN(tests)

/* From nodes to movers: what moves leaves the static geometry, keeps its place, goes where its animation goes, and closes the portals
 * that it covers. Two rooms in a row, a portal between them, and things in them. */
#include "compile/compile.h"
#include "harness/gltf.h"

#include <enfilade/collide.h>

#include <math.h>

enum { KEYS = 3, ROCKS = 60 };

/* The bytes behind the accessors of `head`. */
typedef struct Bytes {
    EnfTestCube cube;
    float door[4][3]; /* a quad 1 wide (z), 2 high (y), front to +x, origin at its foot */
    uint16_t quad[6];
    float times[KEYS], places[KEYS][3], turns[KEYS][4], tangents[3 * KEYS][3];
} Bytes;

static void fill_bytes(Bytes *b) {
    memset(b, 0, sizeof *b);
    enf_test_cube(&b->cube);
    const float door[4][3] = {{0, 0, 0.5F}, {0, 0, -0.5F}, {0, 2, -0.5F}, {0, 2, 0.5F}};
    const uint16_t quad[6] = {0, 1, 2, 0, 2, 3};
    memcpy(b->door, door, sizeof door);
    memcpy(b->quad, quad, sizeof quad);
    const double half = sqrt(0.5);
    for (int k = 0; k < KEYS; k++) {
        b->times[k] = 0.5F + (float)k; /* Blender's first frame is not 0 */
        b->places[k][0] = (float)k;
        b->turns[k][1] = k == 1 ? (float)half : 0.0F;
        b->turns[k][3] = k == 1 ? (float)half : 1.0F;
        b->tangents[3 * k + 1][0] = (float)k;
        b->tangents[3 * k][0] = b->tangents[3 * k + 2][0] = 1.0F;
    }
}

static const char accessors[] =
    "\"accessors\":["
    "{\"bufferView\":0,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\",\"min\":[-0.5,-0.5,-0.5],\"max\":[0.5,0.5,0.5]},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,-0.5],\"max\":[0,2,0.5]},"
    "{\"bufferView\":2,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"},"
    "{\"bufferView\":3,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"},"
    "{\"bufferView\":4,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":5,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\",\"min\":[0.5],\"max\":[2.5]},"
    "{\"bufferView\":6,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"bufferView\":7,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
    "{\"bufferView\":8,\"componentType\":5126,\"count\":9,\"type\":\"VEC3\"},"
    "{\"bufferView\":3,\"componentType\":5123,\"count\":30,\"type\":\"SCALAR\"}],";

/* Meshes: 0 a crate (outward), 1 a room (inward), 2 a door or portal quad, 3 a crate of material `clip`. */
static const char meshes[] =
    "\"materials\":[{\"name\":\"wood\"},{\"name\":\"clip\"},{\"name\":\"glass\",\"alphaMode\":\"BLEND\"}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":3,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":1},\"indices\":4,\"material\":0}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":1}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":2}]},";

/* Mesh 5: a crate many times; 6: a room without its wall to +x. */
static void put_rocks(EnfTestText *out) {
    for (int i = 0; i < ROCKS; i++) {
        enf_test_put(out, i ? "," : "{\"primitives\":[");
        enf_test_put(out, "{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":0}");
    }
    enf_test_put(out, "]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":9,\"material\":0}]}],");
}

/* Does the west room lack its wall to the east? */
static bool west_is_open;

/* A level: two rooms and their portal, then `nodes` (objects with a comma before each), numbered from 4 on and all roots but those in
 * `children_from`; `animations` as JSON, or "". */
static const char *write_level(const char *nodes, const char *roots, const char *animations) {
    Bytes bytes;
    fill_bytes(&bytes);
    const struct {
        const void *at;
        size_t size;
    } views[] = {{bytes.cube.corners, sizeof bytes.cube.corners},
                 {bytes.door, sizeof bytes.door},
                 {bytes.cube.outward, sizeof bytes.cube.outward},
                 {bytes.cube.inward, sizeof bytes.cube.inward},
                 {bytes.quad, sizeof bytes.quad},
                 {bytes.times, sizeof bytes.times},
                 {bytes.places, sizeof bytes.places},
                 {bytes.turns, sizeof bytes.turns},
                 {bytes.tangents, sizeof bytes.tangents}};
    EnfTestText out = {NULL, 0, 0};
    enf_test_put(&out, "{\"asset\":{\"version\":\"2.0\"},\"bufferViews\":[");
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        char text[96];
        snprintf(text, sizeof text, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", i ? "," : "",
                 (size_t)((const char *)views[i].at - (const char *)&bytes), views[i].size);
        enf_test_put(&out, text);
    }
    enf_test_put(&out, "],");
    enf_test_put(&out, accessors);
    enf_test_put(&out, meshes);
    put_rocks(&out);
    enf_test_put(&out, animations);
    enf_test_put(&out, "\"nodes\":[{\"name\":\"west-room\",\"children\":[2,3]},"
                       "{\"name\":\"east-room\",\"mesh\":1,\"scale\":[4,4,4],\"translation\":[6,2,2]},"
                       "{\"name\":\"west\",\"scale\":[4,4,4],\"translation\":[2,2,2],\"mesh\":");
    enf_test_put(&out, west_is_open ? "6}," : "1},");
    enf_test_put(&out, "{\"name\":\"east*1-portal\",\"mesh\":2,\"translation\":[4,0,2]}");
    enf_test_put(&out, nodes);
    enf_test_put(&out, "],\"scenes\":[{\"nodes\":[0,1");
    enf_test_put(&out, roots);
    enf_test_put(&out, "]}],\"scene\":0,");
    enf_test_put_buffer(&out, &bytes, sizeof bytes);
    enf_test_put(&out, "}");
    const char *path = enf_test_temp_path("movers.gltf");
    enf_test_write_file(path, out.text, out.length);
    free(out.text);
    return path;
}

typedef struct Compiled {
    EnfMap map;
    EnfWorld *world;
    EnfCompileReport report;
} Compiled;

static void compile_level(Compiled *out, const char *nodes, const char *roots, const char *animations) {
    EnfError error = {ENF_OK, 0, "", ""};
    EnfCompileDef def = enf_compile_def_default();
    def.level = write_level(nodes, roots, animations);
    def.output = enf_test_temp_path("movers.enfmap");
    if (enf_compile(&def, &out->report, &error) || enf_map_read(&out->map, def.output, NULL, &error)) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_world_create(&out->world, &out->map, 1, NULL, NULL), ENF_OK);
    assert_int_equal(enf_world_populate(out->world, NULL), ENF_OK);
}

static void release(Compiled *level) {
    enf_world_destroy(level->world);
    enf_map_free(&level->map);
    enf_compile_report_free(&level->report);
}

static uint32_t found(const Compiled *level, EnfDiagnosisCode code, const char *node) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < level->report.diagnosis.count; i++) {
        const EnfFinding *finding = &level->report.diagnosis.findings[i];
        count += finding->code == code && strcmp(finding->node, node) == 0;
    }
    return count;
}

static uint32_t triangles_of(const EnfMap *map) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->clusters_count; i++) {
        count += map->clusters[i].index_count / 3;
    }
    return count;
}

static void assert_near(EnfVec3 a, EnfVec3 b) {
    if (enf_length(enf_sub(a, b)) > 1e-5) {
        fail_msg("(%g, %g, %g) instead of (%g, %g, %g)", a.x, a.y, a.z, b.x, b.y, b.z);
    }
}

/* Where the point of mover `index` is that lies at `local` in the node's own mesh (a cube: corners are shared by all movers here). */
static EnfVec3 point_at(Compiled *level, uint32_t index, int64_t tick, EnfVec3 local) {
    EnfObjectDef def = enf_mover_def(&level->map, index);
    EnfPose pose = enf_motion_state(&def.motion, tick);
    return enf_pose_point(&pose, local);
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

/* An animated crate leaves the static geometry and goes where its keys say, from its first key on; its parent stands turned, scaled
 * and moved. */
static void an_animated_node(void **state) {
    (void)state;
    Compiled plain, level;
    compile_level(&plain, "", "", "");
    compile_level(
        &level,
        ",{\"name\":\"stand\",\"children\":[5],\"translation\":[1,1,1],\"rotation\":[0,0.70710678,0,0.70710678],"
        "\"scale\":[0.5,0.5,0.5]},"
        "{\"name\":\"crate\",\"mesh\":0,\"translation\":[9,9,9],\"extras\":{\"wrap\":\"pingpong\",\"phase\":1,\"solid\":0}}",
        ",4",
        "\"animations\":[{\"name\":\"go\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":5,\"path\":\"translation\"}},"
        "{\"sampler\":1,\"target\":{\"node\":5,\"path\":\"rotation\"}}],"
        "\"samplers\":[{\"input\":5,\"output\":6},{\"input\":5,\"output\":7}]}],");
    assert_int_equal(triangles_of(&level.map), triangles_of(&plain.map));
    assert_int_equal(level.map.movers_count, 1);
    const EnfMover *mover = &level.map.movers[0];
    assert_int_equal(mover->kind, ENF_MOVER_PATH);
    assert_int_equal(mover->wrap, ENF_WRAP_PING_PONG);
    assert_int_equal(mover->flags, 0);
    assert_true(mover->seconds == 2.0F && mover->phase == 1.0F);
    /* Key k stands at (k, 0, 0) of a stand that halves, turns x to -z, and stands at (1, 1, 1). */
    assert_near(point_at(&level, 0, -60, enf_v3(0, 0, 0)), enf_v3(1, 1, 1));
    assert_near(point_at(&level, 0, 0, enf_v3(0, 0, 0)), enf_v3(1, 1, 0.5));
    assert_near(point_at(&level, 0, 60, enf_v3(0, 0, 0)), enf_v3(1, 1, 0));
    assert_near(point_at(&level, 0, 90, enf_v3(0, 0, 0)), enf_v3(1, 1, 0.25));
    /* The second key turns it once more by 90 degrees: its own x is then the world's -x. */
    assert_near(point_at(&level, 0, 0, enf_v3(1, 0, 0)), enf_v3(0.5, 1, 0.5));
    release(&plain);
    release(&level);
}

/* A crate on an animated tray, itself animated with another period: at every tick it is where the two together put it. */
static void what_hangs_on_what_moves(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level,
                  ",{\"name\":\"tray\",\"mesh\":0,\"children\":[5,6],\"translation\":[0,0,0]},"
                  "{\"name\":\"cup\",\"mesh\":0,\"translation\":[0,1,0]},"
                  "{\"name\":\"saucer\",\"mesh\":0,\"translation\":[0,3,0],\"scale\":[0.5,0.5,0.5]}",
                  ",4",
                  "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":4,\"path\":\"translation\"}},"
                  "{\"sampler\":1,\"target\":{\"node\":5,\"path\":\"translation\"}}],"
                  "\"samplers\":[{\"input\":5,\"output\":6},{\"input\":5,\"output\":8,\"interpolation\":\"CUBICSPLINE\"}]}],");
    assert_int_equal(level.map.movers_count, 2);
    EnfObjectDef tray = enf_mover_def(&level.map, 0);
    for (int64_t tick = 0; tick < 400; tick++) {
        EnfPose pose = enf_motion_state(&tray.motion, tick);
        double own = (double)(tick % 120) / 60.0;
        assert_true(fabs(pose.position.x - own) < 1e-5);
        /* The cup's cubic has the same keys with a slope of 1: the same line. Its y comes from its keys, too. */
        assert_near(point_at(&level, 1, tick, enf_v3(0, 0, 0)), enf_v3(2.0 * own, 0, 0));
    }
    /* The saucer is a piece of the tray: eight corners more, three metres up. */
    const EnfMesh *mesh = &level.map.meshes[level.map.movers[0].mesh];
    assert_true(mesh->max[1] == 3.25F && mesh->min[1] == -0.5F);
    assert_int_equal(level.map.mesh_parts[mesh->part_first].index_count, 72);
    release(&level);
}

/* Movers of one source mesh share one mesh, wherever they stand; a mirrored one has its own, wound the right way. */
static void shared_and_mirrored(void **state) {
    (void)state;
    Compiled level;
    compile_level(
        &level,
        ",{\"name\":\"a\",\"mesh\":0,\"translation\":[1,1,1],\"extras\":{\"classname\":\"prop_exhibit\",\"value\":3}},"
        "{\"name\":\"b\",\"mesh\":0,\"translation\":[3,1,1],\"rotation\":[0.5,0.5,0.5,0.5],\"extras\":{\"max_speed\":2}},"
        "{\"name\":\"c\",\"mesh\":0,\"translation\":[2,1,2],\"scale\":[-1,1,1],\"extras\":{\"dynamic\":true}}",
        ",4,5,6", "");
    assert_int_equal(level.map.movers_count, 3);
    assert_int_equal(level.map.meshes_count, 2);
    assert_int_equal(level.map.movers[0].mesh, level.map.movers[1].mesh);
    assert_int_equal(level.map.movers[0].flags, ENF_MOVER_SOLID | ENF_MOVER_CARRY);
    assert_int_equal(level.map.movers[1].kind, ENF_MOVER_FREE);
    assert_true(level.map.movers[1].max_speed == 2.0F);
    for (uint32_t m = 0; m < 3; m++) {
        EnfObjectDef def = enf_mover_def(&level.map, m);
        EnfPose pose = enf_motion_state(&def.motion, 0);
        const EnfMeshPart *part = &level.map.mesh_parts[level.map.meshes[level.map.movers[m].mesh].part_first];
        for (uint32_t i = part->index_first; i < part->index_first + part->index_count; i += 3) {
            EnfVec3 p[3];
            for (uint32_t k = 0; k < 3; k++) {
                const float *v = level.map.vertices[level.map.indices[i + k]].position;
                p[k] = enf_pose_point(&pose, enf_v3((double)v[0], (double)v[1], (double)v[2]));
            }
            EnfVec3 n = enf_cross(enf_sub(p[1], p[0]), enf_sub(p[2], p[0]));
            assert_true(enf_dot(n, enf_sub(p[0], pose.position)) > 0.0); /* out of the cube */
        }
    }
    release(&level);
}

#define DOOR(name, extras, z, scale)                                                                                           \
    ",{\"name\":\"" name "\",\"mesh\":0,\"translation\":[4,1," z "],\"scale\":[0.1,2," scale "],\"extras\":{" extras "}}"
#define HINGED "\"classname\":\"func_door_rotating\""

/* A door closes the portal that it covers; two leaves close theirs together; a door that leaves a gap, or is of glass, does not. */
static void doors_and_portals(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level, DOOR("door", HINGED ",\"angle\":-100,\"swing_low\":30,\"speed\":45,\"locked\":\"red\"", "2", "1"),
                  ",4", "");
    const EnfMover *door = &level.map.movers[0];
    assert_int_equal(door->kind, ENF_MOVER_HINGE);
    assert_int_equal(door->flags, ENF_MOVER_SOLID | ENF_MOVER_LOCKED);
    assert_true(door->portal != ENF_NONE && level.map.portals[door->portal].twin != ENF_NONE);
    assert_true(fabs((double)door->low + 100.0 * ENF_PI / 180.0) < 1e-6 && fabs((double)door->high - ENF_PI / 6.0) < 1e-6);
    assert_true(fabs((double)door->rate - ENF_PI / 4.0) < 1e-6);
    release(&level);
    compile_level(&level,
                  DOOR("left", HINGED, "1.75", "0.5")
                      DOOR("right", "\"classname\":\"func_door\",\"move\":[0,0,0.5]", "2.25", "0.5"),
                  ",4,5", "");
    assert_int_equal(level.map.movers[1].kind, ENF_MOVER_SLIDE);
    assert_true(level.map.movers[1].high == 0.5F && level.map.movers[1].axis[2] == 1.0F);
    assert_true(level.map.movers[0].portal != ENF_NONE && level.map.movers[0].portal == level.map.movers[1].portal);
    release(&level);
    compile_level(&level, DOOR("gap", HINGED, "2", "0.9"), ",4", "");
    assert_int_equal(level.map.movers[0].portal, ENF_NONE);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_DOOR_PORTAL, "gap"), 1);
    release(&level);
    compile_level(&level,
                  ",{\"name\":\"pane\",\"mesh\":4,\"translation\":[4,1,2],\"scale\":[0.1,2,1],\"extras\":{" HINGED
                  ",\"portal\":\"east*1-portal\"}}"
                  ",{\"name\":\"lost\",\"mesh\":0,\"translation\":[1,1,1],\"extras\":{" HINGED ",\"portal\":\"nowhere\"}}",
                  ",4,5", "");
    assert_int_equal(level.map.movers[0].portal, ENF_NONE);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_DOOR_PORTAL, "pane"), 1);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_DOOR_PORTAL, "lost"), 1);
    release(&level);
}

/* A leaf that stands before its opening closes it only if nobody can look past it, however aslant. */
static void doors_before_openings(void **state) {
    (void)state;
    static const struct {
        const char *name, *x, *size;
        bool closes;
    } doors[] = {{"within", "4", "[0.1,2,1]", true},
                 {"thin", "4", "[0.001,2,1]", true},
                 {"before", "3.7", "[0.1,2,1]", false},
                 {"behind", "4.3", "[0.1,2,1]", false},
                 {"close", "3.94", "[0.1,2,1]", false}};
    west_is_open = true;
    for (size_t i = 0; i < sizeof doors / sizeof *doors; i++) {
        Compiled level;
        char nodes[512];
        snprintf(nodes, sizeof nodes,
                 ",{\"name\":\"%s\",\"mesh\":0,\"translation\":[%s,1,2],\"scale\":%s,\"extras\":{" HINGED "}}", doors[i].name,
                 doors[i].x, doors[i].size);
        compile_level(&level, nodes, ",4", "");
        if ((level.map.movers[0].portal != ENF_NONE) != doors[i].closes) {
            fail_msg("the door '%s' %s", doors[i].name, doors[i].closes ? "closes nothing" : "closes its portal");
        }
        release(&level);
    }
    west_is_open = false;
}

static void lifts_and_slips_of_the_pen(void **state) {
    (void)state;
    Compiled level;
    compile_level(
        &level,
        ",{\"name\":\"lift\",\"mesh\":0,\"translation\":[1,1,1],\"extras\":{\"classname\":\"func_plat\",\"stops\":"
        "\"-1, 0,2.5\",\"speed\":\"0.5\",\"validity\":2}}"
        ",{\"name\":\"stuck\",\"mesh\":0,\"translation\":[1,1,1],\"extras\":{\"classname\":\"func_plat\"}}"
        ",{\"name\":\"odd\",\"mesh\":0,\"translation\":[1,1,1],\"extras\":{\"classname\":\"func_door\",\"move\":\"up\","
        "\"speed\":-1,\"wrap\":\"twice\",\"phase\":1e300,\"axis\":[0,0,0]}}",
        ",4,5,6", "");
    const EnfMover *lift = &level.map.movers[0];
    assert_int_equal(lift->kind, ENF_MOVER_SLIDE);
    assert_true(lift->low == -1.0F && lift->high == 2.5F && lift->rate == 0.5F && lift->axis[1] == 1.0F);
    assert_int_equal(lift->validity_ticks, 120);
    assert_int_equal(level.map.movers[1].kind, ENF_MOVER_STILL);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_KEY, "stuck"), 1);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_KEY, "odd"), 6); /* five keys, and no way to slide */
    release(&level);
}

/* What only collides is a mover that stands, is not drawn, and leaves the static geometry as it is. */
static void what_only_collides(void **state) {
    (void)state;
    Compiled plain, level;
    compile_level(&plain, "", "", "");
    compile_level(&level,
                  ",{\"name\":\"fence-colonly\",\"mesh\":0,\"translation\":[1,1,1]}"
                  ",{\"name\":\"box\",\"mesh\":3,\"translation\":[2,1,1]}"
                  ",{\"name\":\"net-navmesh\",\"mesh\":0,\"translation\":[1,1,1]}",
                  ",4,5,6", "");
    assert_int_equal(triangles_of(&level.map), triangles_of(&plain.map));
    assert_int_equal(level.map.movers_count, 2);
    for (uint32_t m = 0; m < 2; m++) {
        const EnfMesh *mesh = &level.map.meshes[level.map.movers[m].mesh];
        const EnfMaterial *material = &level.map.materials[level.map.mesh_parts[mesh->part_first].material];
        assert_int_equal(level.map.movers[m].flags, ENF_MOVER_SOLID);
        assert_int_equal(material->flags, ENF_MATERIAL_NODRAW | ENF_MATERIAL_CLIP);
        assert_int_equal(level.map.mesh_parts[mesh->part_first].index_count, 36);
    }
    release(&plain);
    release(&level);
}

/* A hull below a door, and faces of material `clip`, go with what they hang on. */
static void hulls_that_move(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level,
                  ",{\"name\":\"door\",\"mesh\":0,\"children\":[5,6,7],\"translation\":[4,1,2],\"extras\":{" HINGED "}}"
                  ",{\"name\":\"hull-colonly\",\"mesh\":0,\"scale\":[2,2,2]}"
                  ",{\"name\":\"guard\",\"mesh\":3,\"translation\":[0,5,0]}"
                  ",{\"name\":\"net-navmesh\",\"mesh\":0}",
                  ",4", "");
    assert_int_equal(level.map.movers_count, 1);
    const EnfMesh *mesh = &level.map.meshes[level.map.movers[0].mesh];
    assert_int_equal(mesh->part_count, 2);
    const EnfMeshPart *parts = level.map.mesh_parts + mesh->part_first;
    assert_int_equal(parts[0].index_count, 36);
    assert_int_equal(parts[1].index_count, 72);
    assert_int_equal(level.map.materials[parts[1].material].flags, ENF_MATERIAL_NODRAW | ENF_MATERIAL_CLIP);
    assert_true(mesh->min[0] == -1.0F && mesh->max[1] == 5.5F);
    release(&level);
}

/* An obstacle of more triangles than a solid may have is several; each triangle is in one of them. */
static void large_obstacles(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level, ",{\"name\":\"rocks-colonly\",\"mesh\":5,\"translation\":[2,2,2]}", ",4", "");
    uint32_t triangles = 0;
    for (uint32_t m = 0; m < level.map.movers_count; m++) {
        const EnfMesh *mesh = &level.map.meshes[level.map.movers[m].mesh];
        assert_int_equal(mesh->part_count, 1);
        assert_in_range(level.map.mesh_parts[mesh->part_first].index_count / 3, 1, ENF_SOLID_TRIANGLES_MAX);
        assert_int_equal(level.map.movers[m].kind, ENF_MOVER_STILL);
        triangles += level.map.mesh_parts[mesh->part_first].index_count / 3;
    }
    assert_int_equal(level.map.movers_count, 2);
    assert_int_equal(triangles, 12 * ROCKS);
    release(&level);
}

#define SAME_TABLE(a, b, table)                                                                                                \
    do {                                                                                                                       \
        assert_int_equal((a).table##_count, (b).table##_count);                                                                \
        assert_memory_equal((a).table, (b).table, (a).table##_count * sizeof *(a).table);                                      \
    } while (0)

/* What moves leaves no trace in what stands: all that is drawn, searched and looked through is, byte for byte, that of the level
 * without. */
static void what_stands_is_untouched(void **state) {
    (void)state;
    Compiled plain, level;
    compile_level(&plain, ",{\"name\":\"stone\",\"mesh\":0,\"translation\":[1,0.5,1]}", ",4", "");
    compile_level(&level,
                  ",{\"name\":\"stone\",\"mesh\":0,\"translation\":[1,0.5,1]}" DOOR("door", HINGED, "2", "1")
                      DOOR("glass", "\"dynamic\":1", "3", "1") ",{\"name\":\"wall-colonly\",\"mesh\":0,\"translation\":[4,2,2]}"
                                                               ",{\"name\":\"far\",\"mesh\":0,\"translation\":[900,2,2]}",
                  ",4,5,6,7,8",
                  "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":8,\"path\":\"scale\"}}],"
                  "\"samplers\":[{\"input\":5,\"output\":6}]}],");
    assert_int_equal(level.map.movers_count, 4);
    SAME_TABLE(plain.map, level.map, cells);
    SAME_TABLE(plain.map, level.map, portals);
    SAME_TABLE(plain.map, level.map, portal_vertices);
    SAME_TABLE(plain.map, level.map, clusters);
    SAME_TABLE(plain.map, level.map, kd_nodes);
    SAME_TABLE(plain.map, level.map, kd_blocks);
    SAME_TABLE(plain.map, level.map, light_refs);
    SAME_TABLE(plain.map, level.map, cell_nodes);
    assert_memory_equal(plain.map.vertices, level.map.vertices, plain.map.vertices_count * sizeof *plain.map.vertices);
    assert_memory_equal(plain.map.indices, level.map.indices, plain.map.indices_count * sizeof *plain.map.indices);
    release(&plain);
    release(&level);
}

/* The largest speed follows from the motion where that has one; what stands on the floor is in its room. */
static void speeds_and_cells(void **state) {
    (void)state;
    Compiled level;
    compile_level(
        &level,
        ",{\"name\":\"door\",\"mesh\":2,\"translation\":[1,0,2.5],\"extras\":{" HINGED ",\"speed\":90}}"
        ",{\"name\":\"slow\",\"mesh\":0,\"extras\":{\"wrap\":\"pingpong\"}}"
        ",{\"name\":\"jumps\",\"mesh\":0}"
        ",{\"name\":\"guard\",\"mesh\":2,\"translation\":[6,0,2],\"extras\":{\"classname\":\"npc_guard\",\"speed\":7}}"
        ",{\"name\":\"lift\",\"mesh\":0,\"translation\":[6,0,2],\"extras\":{\"dynamic\":true}}",
        ",4,5,6,7,8",
        "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":5,\"path\":\"translation\"}},"
        "{\"sampler\":0,\"target\":{\"node\":6,\"path\":\"translation\"}}],"
        "\"samplers\":[{\"input\":5,\"output\":6}]}],");
    const EnfMover *movers = level.map.movers;
    assert_true(fabs((double)movers[0].max_speed - 0.5 * 0.5 * ENF_PI) < 1e-3); /* half a metre from its hinge */
    assert_true(fabs((double)movers[1].max_speed - 1.0) < 1e-3);
    assert_true(movers[2].max_speed == 0.0F); /* a loop that does not close */
    assert_true(movers[3].max_speed == 7.0F);
    for (uint32_t m = 3; m < 5; m++) { /* on the floor, and let into it */
        const EnfEntity *entity = &level.map.entities[movers[m].entity];
        assert_true(entity->cell != ENF_NONE);
        assert_string_equal(enf_map_string(&level.map, level.map.cells[entity->cell].name), "east-room");
    }
    release(&level);
}

/* What is likely a slip is told under the node's name. */
static void told_by_name(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level,
                  ",{\"name\":\"twice\",\"mesh\":0,\"extras\":{\"classname\":\"prop_a\",\"classname\":\"prop_b\"}}"
                  ",{\"name\":\"both\",\"mesh\":0,\"extras\":{\"classname\":\"func_door\",\"move\":\"0,1,0\"}}"
                  ",{\"name\":\"typo\",\"mesh\":0,\"extras\":{\"classname\":\"func_dor\"}}"
                  ",{\"name\":\"moon\",\"mesh\":0,\"translation\":[0,2e6,0],\"extras\":{\"dynamic\":true}}",
                  ",4,5,6,7",
                  "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":5,\"path\":\"translation\"}}],"
                  "\"samplers\":[{\"input\":5,\"output\":6}]}],");
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_KEY, "twice"), 1);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_KEY, "both"), 1);
    assert_int_equal(level.map.movers[1].kind, ENF_MOVER_PATH);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_KEY, "typo"), 1);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_STATIC, "moon"), 1);
    assert_int_equal(level.map.movers[3].mesh, ENF_NONE);
    release(&level);
}

/* Rooms do not move; a level that would have nothing left to stand on stays as it is. */
static void what_cannot_move(void **state) {
    (void)state;
    Compiled level;
    compile_level(&level, ",{\"name\":\"cabin-room\",\"mesh\":1,\"translation\":[2,2,2]}", ",4",
                  "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":4,\"path\":\"translation\"}}],"
                  "\"samplers\":[{\"input\":5,\"output\":6}]}],");
    assert_int_equal(level.map.movers_count, 0);
    assert_int_equal(found(&level, ENF_DIAGNOSIS_MOVER_STATIC, "cabin-room"), 1);
    release(&level);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(an_animated_node),
    cmocka_unit_test(what_hangs_on_what_moves),
    cmocka_unit_test(shared_and_mirrored),
    cmocka_unit_test(doors_and_portals),
    cmocka_unit_test(lifts_and_slips_of_the_pen),
    cmocka_unit_test(what_only_collides),
    cmocka_unit_test(what_cannot_move),
    cmocka_unit_test(hulls_that_move),
    cmocka_unit_test(large_obstacles),
    cmocka_unit_test(what_stands_is_untouched),
    cmocka_unit_test(speeds_and_cells),
    cmocka_unit_test(told_by_name),
    cmocka_unit_test(doors_before_openings),
};

ENF_TEST_MAIN(tests)

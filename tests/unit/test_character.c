/* A body in a gym: steps, slopes, ceilings, crouching, jumping, wedges, platforms, doors, and rest. */
#include "harness/harness.h"
#include "scenes/maker.h"

#include <enfilade/collide.h>
#include <enfilade/tolerances.h>

#include <math.h>
#include <string.h>

#define assert_near(a, b, most) assert_true(fabs((a) - (b)) <= (most))

/* A room of 40 × 8 × 40 m about the origin, floor at 0, with things in it; and a world in it. */
typedef struct Gym {
    EnfMaker *maker;
    const EnfMap *map;
    EnfWorld *world;
    EnfCollider *collider;
    EnfCharacter body;
    EnfCharacterReport report;
    uint32_t cell;
} Gym;

static void gym_open(Gym *gym) {
    memset(gym, 0, sizeof *gym);
    gym->maker = enf_maker_create();
    assert_non_null(gym->maker);
    assert_non_null(enf_maker_cell(gym->maker, "gym-room", enf_v3(0.0, 0.0, 0.0), &gym->cell));
    enf_maker_box(gym->maker, gym->cell, 0, (EnfBox3){{-20, 0, -20}, {20, 8, 20}}, true);
}

static void gym_box(Gym *gym, EnfVec3 min, EnfVec3 max) {
    enf_maker_group(gym->maker);
    enf_maker_box(gym->maker, gym->cell, 0, (EnfBox3){min, max}, false);
}

/* A ramp along +x from (x, 0) to (x + length, height), 4 m wide, with its sides open. */
static void gym_ramp(Gym *gym, double x, double length, double height) {
    const EnfVec3 top[4] = {{x, 0, -2}, {x, 0, 2}, {x + length, height, 2}, {x + length, height, -2}};
    enf_maker_group(gym->maker);
    enf_maker_polygon(gym->maker, gym->cell, 0, top, 4);
}

static void gym_ready(Gym *gym) {
    EnfError error = {ENF_OK, 0, "", ""};
    gym->map = enf_maker_finish(gym->maker, &error);
    if (gym->map == NULL) {
        fail_msg("%s", error.message);
    }
    assert_int_equal(enf_world_create(&gym->world, gym->map, 16, NULL, &error), ENF_OK);
    assert_int_equal(enf_collider_create(&gym->collider, gym->map, gym->world, NULL, &error), ENF_OK);
}

static void gym_spawn(Gym *gym, EnfVec3 feet) {
    EnfCharacterDef def = enf_character_def_default();
    assert_true(enf_character_spawn(&gym->body, gym->collider, &def, feet));
}

static void gym_close(Gym *gym) {
    enf_collider_destroy(gym->collider);
    enf_world_destroy(gym->world);
    enf_maker_destroy(gym->maker);
}

/* Some ticks of one wish; every place must be free of the level. */
static void gym_go(Gym *gym, EnfCharacterInput input, int ticks) {
    for (int i = 0; i < ticks; i++) {
        enf_world_advance(gym->world, 1);
        enf_character_move(&gym->body, gym->collider, &input, &gym->report);
        EnfCapsule capsule = enf_character_capsule(&gym->body);
        EnfOverlap overlap;
        if (enf_collide_overlap(gym->collider, &capsule, gym->body.position, &overlap) && overlap.object == ENF_NONE) {
            fail_msg("tick %d: inside the level by %g m at %g %g %g", i, overlap.depth, gym->body.position.x,
                     gym->body.position.y, gym->body.position.z);
        }
        assert_false(gym->report.moved & ENF_MOVED_RELOCATED);
    }
}

static EnfCharacterInput wish(double x, double z) {
    EnfCharacterInput input = {{x, 0.0, z}, false, false, false, ENF_CHARACTER_WALK};
    return input;
}

static bool grounded(const Gym *gym) {
    return (gym->body.flags & ENF_CHARACTER_GROUNDED) != 0;
}

static void test_walks_and_stops(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    assert_true(grounded(&gym));
    assert_int_equal(gym.body.cell, gym.cell);
    assert_near(gym.body.position.y, ENF_TOL_SKIN, 1e-6);
    gym_go(&gym, wish(1.0, 0.0), 60);
    double speed = gym.body.velocity.x;
    assert_near(speed, gym.body.def.walk_speed, 0.01);
    assert_true(gym.body.position.x > 2.0 && gym.body.position.x < 2.7);
    gym_go(&gym, wish(0.0, 0.0), 60);
    assert_true(gym.body.velocity.x == 0.0 && gym.body.velocity.y == 0.0 && gym.body.velocity.z == 0.0);
    EnfCharacter before = gym.body;
    gym_go(&gym, wish(0.0, 0.0), 1000); /* at rest not a bit changes */
    assert_memory_equal(&before, &gym.body, sizeof before);
    gym_close(&gym);
}

/* Highest step passed, walking at a box of that height. */
static double climbs(double height, double speed) {
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(2.0, 0.0, -3.0), enf_v3(12.0, height, 3.0));
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    gym_go(&gym, wish(speed, 0.0), (int)(150.0 / speed));
    double y = gym.body.position.y;
    assert_true(grounded(&gym));
    gym_close(&gym);
    return y;
}

static void test_steps(void **state) {
    (void)state;
    static const double speeds[] = {1.0, 0.5, 0.2};
    for (int i = 0; i < 3; i++) {
        assert_near(climbs(0.125, speeds[i]), 0.125 + ENF_TOL_SKIN, 1e-6);
        assert_near(climbs(0.3984375, speeds[i]), 0.3984375 + ENF_TOL_SKIN, 1e-6);
        assert_near(climbs(0.421875, speeds[i]), ENF_TOL_SKIN, 1e-6);
        assert_near(climbs(0.625, speeds[i]), ENF_TOL_SKIN, 1e-6);
    }
}

/* Up a flight of stairs and down the other side, never in the air. */
static void test_stairs(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    for (int i = 0; i < 10; i++) {
        double x = 2.0 + 0.25 * i, height = 0.1875 * (i + 1);
        gym_box(&gym, enf_v3(x, 0.0, -1.0), enf_v3(9.0 - 0.25 * i, height, 1.0));
    }
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    double highest = 0.0, speed = 0.0;
    EnfCharacterInput input = wish(1.0, 0.0);
    input.run = true;
    for (int i = 0; i < 150; i++) {
        gym_go(&gym, input, 1);
        assert_true(grounded(&gym));
        highest = gym.body.position.y > highest ? gym.body.position.y : highest;
        speed = i == 40 ? gym.body.velocity.x : speed;
        EnfVec3 eye = enf_character_eye(&gym.body);
        assert_true(eye.y > gym.body.position.y && eye.y < gym.body.position.y + gym.body.height);
    }
    assert_near(highest, 1.875 + ENF_TOL_SKIN, 1e-6);
    assert_near(gym.body.position.y, ENF_TOL_SKIN, 1e-6);
    assert_true(gym.body.position.x > 10.0);
    assert_near(speed, gym.body.def.run_speed, 0.05); /* stairs do not brake */
    gym_close(&gym);
}

static void test_slopes(void **state) {
    (void)state;
    static const struct {
        double height;
        bool walked;
    } ramps[] = {{1.0, true}, {2.0, true}, {3.9375, true}, {4.25, false}, {6.0, false}}; /* over 4 m */
    for (int i = 0; i < 5; i++) {
        Gym gym;
        gym_open(&gym);
        gym_ramp(&gym, 2.0, 4.0, ramps[i].height);
        gym_ready(&gym);
        gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
        gym_go(&gym, wish(1.0, 0.0), 110);
        bool walked = gym.body.position.y > 0.5;
        if (walked != ramps[i].walked) {
            fail_msg("a ramp of %g in 4: walked %d, at %g %g", ramps[i].height, walked, gym.body.position.x,
                     gym.body.position.y);
        }
        if (walked) { /* still upon it: stands, and does not creep */
            gym_go(&gym, wish(0.0, 0.0), 60);
            EnfCharacter before = gym.body;
            gym_go(&gym, wish(0.0, 0.0), 1000);
            assert_memory_equal(&before, &gym.body, sizeof before);
            gym_go(&gym, wish(-1.0, 0.0), 30); /* and walks down without hopping */
            assert_true(grounded(&gym));
        }
        gym_close(&gym);
    }
}

/* Slides down what is too steep, and is then at rest. */
static void test_steep_slope_is_slid_down(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_ramp(&gym, 2.0, 3.0, 6.0);
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(3.5, 4.0, 0.0));
    gym_go(&gym, wish(0.0, 0.0), 400);
    assert_true(grounded(&gym));
    assert_near(gym.body.position.y, ENF_TOL_SKIN, 1e-3);
    gym_close(&gym);
}

static void test_jump(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(6.0, 2.5, -2.0), enf_v3(10.0, 3.0, 2.0)); /* a low ceiling */
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    EnfCharacterInput input = wish(0.0, 0.0);
    input.jump = true;
    double highest = 0.0;
    gym_go(&gym, input, 1);
    assert_true(gym.report.moved & ENF_MOVED_JUMPED);
    for (int i = 0; i < 80; i++) { /* the key held down is one jump */
        gym_go(&gym, input, 1);
        highest = gym.body.position.y > highest ? gym.body.position.y : highest;
    }
    assert_true(grounded(&gym));
    assert_near(highest - ENF_TOL_SKIN, gym.body.def.jump_height, 0.005);
    gym_go(&gym, wish(0.0, 0.0), 1);
    gym_spawn(&gym, enf_v3(8.0, 0.0, 0.0));
    gym_go(&gym, input, 1);
    highest = 0.0;
    for (int i = 0; i < 60; i++) {
        gym_go(&gym, wish(0.0, 0.0), 1);
        highest = gym.body.position.y > highest ? gym.body.position.y : highest;
    }
    assert_true(highest < 0.75);
    assert_true(grounded(&gym));
    gym_close(&gym);
}

static void test_crouch(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(2.0, 1.25, -3.0), enf_v3(6.0, 3.0, 3.0));
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    gym_go(&gym, wish(1.0, 0.0), 120);
    assert_true(gym.body.position.x < 1.75); /* standing, it is too low */
    EnfCharacterInput input = wish(1.0, 0.0);
    input.crouch = true;
    gym_go(&gym, input, 120);
    assert_near(gym.body.height, gym.body.def.crouch_height, 0.0);
    assert_true(gym.body.position.x > 2.5 && gym.body.position.x < 6.0);
    double x = gym.body.position.x;
    gym_go(&gym, wish(0.0, 0.0), 60); /* cannot stand up here */
    assert_true(gym.body.flags & ENF_CHARACTER_CROUCHED);
    assert_true(gym.body.height < 1.25 && gym.body.position.x < x + 0.5);
    gym_go(&gym, wish(1.0, 0.0), 400);
    assert_true(gym.body.position.x > 6.3);
    assert_near(gym.body.height, gym.body.def.height, 0.0);
    gym_close(&gym);
}

/* Into corners of every angle between two walls, running; and out again. */
static void test_corners(void **state) {
    (void)state;
    for (int i = 1; i < 12; i++) {
        double angle = 0.125 * i, far = 6.0;
        Gym gym;
        gym_open(&gym);
        EnfVec3 tip = enf_v3(8.0, 0.0, 0.0);
        for (int side = -1; side <= 1; side += 2) {
            double z = (double)side * enf_sin(angle) * far, x = tip.x - enf_cos(angle) * far;
            EnfVec3 end = enf_grid_point(enf_grid_snap(enf_v3(x, 0.0, z)));
            const EnfVec3 wall[4] = {tip, {tip.x, 4.0, tip.z}, {end.x, 4.0, end.z}, end};
            enf_maker_group(gym.maker);
            enf_maker_polygon(gym.maker, gym.cell, 0, wall, 4);
        }
        gym_ready(&gym);
        gym_spawn(&gym, enf_v3(3.0, 0.0, 0.125));
        EnfCharacterInput input = wish(1.0, 0.05);
        input.run = true;
        gym_go(&gym, input, 200);
        gym_go(&gym, wish(0.0, 0.0), 60);
        EnfCharacter before = gym.body;
        gym_go(&gym, wish(0.0, 0.0), 100);
        assert_memory_equal(&before, &gym.body, sizeof before);
        gym_go(&gym, wish(-1.0, 0.0), 60);
        assert_true(gym.body.position.x < before.position.x - 2.0);
        gym_close(&gym);
    }
}

/* Dropped between two slopes too steep to stand on: comes to rest, may jump, gets out. */
static void test_wedge_between_slopes(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    const EnfVec3 left[4] = {{-4, 5, -4}, {-4, 5, 4}, {0, 0, 4}, {0, 0, -4}};
    const EnfVec3 right[4] = {{0, 0, -4}, {0, 0, 4}, {4, 5, 4}, {4, 5, -4}};
    enf_maker_group(gym.maker);
    enf_maker_polygon(gym.maker, gym.cell, 0, left, 4);
    enf_maker_polygon(gym.maker, gym.cell, 0, right, 4);
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(1.0, 4.0, 0.0));
    gym_go(&gym, wish(0.0, 0.0), 200);
    EnfCharacterInput input = wish(0.0, 0.0);
    assert_true(grounded(&gym));
    EnfCharacter before = gym.body;
    gym_go(&gym, input, 1000);
    assert_true(memcmp(&before.position, &gym.body.position, sizeof before.position) == 0);
    input.jump = true;
    gym_go(&gym, input, 1);
    assert_true(gym.report.moved & ENF_MOVED_JUMPED);
    gym_go(&gym, wish(0.0, 1.0), 300); /* along the valley, and out of it */
    assert_true(gym.body.position.z > 4.0);
    gym_close(&gym);
}

/* ---- solids ----------------------------------------------------------------------------------------------------- */

/* A box that moves by `motion`, about its own origin. */
static EnfObjectId gym_solid(Gym *gym, EnfBox3 box, const EnfMotion *motion, EnfBox3 bounds) {
    EnfObjectDef def = enf_object_def_default();
    EnfError error = {ENF_OK, 0, "", ""};
    EnfVec3f corners[36];
    uint32_t number;
    def.motion = *motion;
    def.local = box;
    EnfObjectId id = enf_world_add(gym->world, &def, &error);
    assert_int_not_equal(id.generation, 0);
    enf_solid_box(box, corners);
    EnfSolidDef solid = {id.index, corners, 12, bounds};
    assert_int_equal(enf_collider_add(gym->collider, &solid, &number, &error), ENF_OK);
    return id;
}

static EnfMotion swing(EnfMotionKind kind, EnfVec3 at, EnfVec3 axis, const double range[2], double rate) {
    EnfMotion motion;
    memset(&motion, 0, sizeof motion);
    motion.kind = kind;
    motion.as.swing.rest = enf_pose_identity();
    motion.as.swing.rest.position = motion.as.swing.pivot = at;
    motion.as.swing.axis = axis;
    motion.as.swing.low = range[0];
    motion.as.swing.high = range[1];
    motion.as.swing.rate = rate;
    return motion;
}

static const EnfBox3 everywhere = {{-20, -20, -20}, {20, 20, 20}};

/* Up and down again: carried without a jump or a gap, and still on it. */
static void test_elevator(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_ready(&gym);
    EnfMotion lift = swing(ENF_MOTION_SLIDE, enf_v3(3.0, 0.125, 0.0), enf_v3(0, 1, 0), (double[]){0.0, 4.0}, 1.5);
    EnfObjectId id = gym_solid(&gym, (EnfBox3){{-1.5, -0.125, -1.5}, {1.5, 0.125, 1.5}}, &lift, everywhere);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    gym_go(&gym, wish(1.0, 0.0), 70);
    gym_go(&gym, wish(0.0, 0.0), 30);
    assert_int_equal(gym.body.ground_object, id.index);
    assert_true(enf_world_swing(gym.world, id, 4.0));
    for (int way = 0; way < 2; way++) {
        for (int i = 0; i < 180; i++) {
            gym_go(&gym, wish(0.0, 0.0), 1);
            double floor = enf_world_pose(gym.world, id.index).position.y + 0.125;
            assert_near(gym.body.position.y - floor, ENF_TOL_SKIN, 1e-5);
            assert_true(grounded(&gym));
            assert_false(gym.report.moved & (ENF_MOVED_SQUEEZED | ENF_MOVED_PUSHED));
        }
        assert_true(enf_world_swing(gym.world, id, 0.0));
    }
    gym_close(&gym);
}

/* Under a ceiling that is too low the lift squeezes, and says so; when it turns back all is well. */
static void test_elevator_squeezes(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(-2.0, 3.0, -2.0), enf_v3(2.0, 3.5, 2.0));
    gym_ready(&gym);
    EnfMotion lift = swing(ENF_MOTION_SLIDE, enf_v3(0.0, 0.125, 0.0), enf_v3(0, 1, 0), (double[]){0.0, 4.0}, 1.5);
    EnfObjectId id = gym_solid(&gym, (EnfBox3){{-1.5, -0.125, -1.5}, {1.5, 0.125, 1.5}}, &lift, everywhere);
    gym_spawn(&gym, enf_v3(0.0, 0.25, 0.0));
    assert_true(enf_world_swing(gym.world, id, 4.0));
    bool squeezed = false;
    for (int i = 0; i < 90 && !squeezed; i++) {
        gym_go(&gym, wish(0.0, 0.0), 1);
        squeezed = (gym.report.moved & ENF_MOVED_SQUEEZED) != 0;
    }
    assert_true(squeezed);
    assert_int_equal(gym.report.squeezed_by, id.index);
    assert_true(enf_world_swing(gym.world, id, 0.0));
    gym_go(&gym, wish(0.0, 0.0), 120);
    assert_int_equal(gym.report.moved & ENF_MOVED_SQUEEZED, 0);
    gym_go(&gym, wish(1.0, 0.0), 90);
    assert_true(gym.body.position.x > 2.0);
    gym_close(&gym);
}

/* A wing turning at any speed pushes whoever stands in its way, and passes nobody. */
static void test_door_pushes(void **state) {
    (void)state;
    static const double rates[] = {1.0, 4.0, 30.0, 90.0};
    for (int i = 0; i < 4; i++) {
        Gym gym;
        gym_open(&gym);
        gym_ready(&gym);
        EnfMotion wing = swing(ENF_MOTION_HINGE, enf_v3(0, 0, 0), enf_v3(0, 1, 0), (double[]){0.0, 1.5}, rates[i]);
        EnfObjectId id = gym_solid(&gym, (EnfBox3){{0.0, 0.0, -0.03125}, {1.25, 2.0, 0.03125}}, &wing, everywhere);
        gym_spawn(&gym, enf_v3(0.75, 0.0, -0.5)); /* a positive turn takes +x to -z */
        assert_true(enf_world_swing(gym.world, id, 1.5));
        for (int t = 0; t < 120; t++) {
            gym_go(&gym, wish(0.0, 0.0), 1);
            assert_int_equal(gym.report.moved & ENF_MOVED_SQUEEZED, 0);
            EnfCapsule capsule = enf_character_capsule(&gym.body);
            assert_false(enf_collide_overlap(gym.collider, &capsule, gym.body.position, NULL));
        }
        assert_true(gym.body.position.x < 0.0); /* before the wing, on the far side */
        assert_true(grounded(&gym));
        gym_close(&gym);
    }
}

/* Between a door and a wall: told who squeezes, never in the wall, and free to leave. */
static void test_squeezed_at_a_wall(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(3.0, 0.0, -4.0), enf_v3(4.0, 4.0, 4.0));
    gym_ready(&gym);
    EnfMotion slab = swing(ENF_MOTION_SLIDE, enf_v3(0, 0, 0), enf_v3(1, 0, 0), (double[]){0.0, 2.75}, 2.0);
    EnfObjectId id = gym_solid(&gym, (EnfBox3){{-0.125, 0.0, -1.0}, {0.125, 2.0, 1.0}}, &slab, everywhere);
    gym_spawn(&gym, enf_v3(2.0, 0.0, 0.0));
    assert_true(enf_world_swing(gym.world, id, 2.75));
    gym_go(&gym, wish(0.0, 0.0), 120);
    assert_true(gym.report.moved & ENF_MOVED_SQUEEZED);
    assert_int_equal(gym.report.squeezed_by, id.index);
    gym_go(&gym, wish(0.0, 1.0), 120); /* along the wall, out */
    assert_true(gym.body.position.z > 1.3);
    assert_int_equal(gym.report.moved & ENF_MOVED_SQUEEZED, 0);
    gym_close(&gym);
}

/* On a train: rides with it, jumps and lands on it again; nothing of the ride is left when it stops. */
static void test_train(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_ready(&gym);
    EnfMotion train = swing(ENF_MOTION_SLIDE, enf_v3(-15, 0.25, 0), enf_v3(1, 0, 0), (double[]){0.0, 25.0}, 6.0);
    EnfObjectId id = gym_solid(&gym, (EnfBox3){{-2, -0.25, -2}, {2, 0.25, 2}}, &train, everywhere);
    gym_spawn(&gym, enf_v3(-15.0, 0.5, 0.0));
    assert_true(enf_world_swing(gym.world, id, 25.0));
    gym_go(&gym, wish(0.0, 0.0), 60);
    double seat = gym.body.position.x - enf_world_pose(gym.world, id.index).position.x;
    assert_near(seat, 0.0, 1e-6);
    EnfCharacterInput input = wish(0.0, 0.0);
    input.jump = true;
    gym_go(&gym, input, 1);
    gym_go(&gym, wish(0.0, 0.0), 59);
    assert_int_equal(gym.body.ground_object, id.index);
    assert_near(gym.body.position.x - enf_world_pose(gym.world, id.index).position.x, 0.0, 0.2);
    gym_go(&gym, wish(0.0, 0.0), 300);
    assert_near(gym.body.position.x - enf_world_pose(gym.world, id.index).position.x, 0.0, 0.3);
    EnfCharacter before = gym.body;
    gym_go(&gym, wish(0.0, 0.0), 1000);
    assert_memory_equal(&before, &gym.body, sizeof before);
    gym_close(&gym);
}

/* Put into a thing, or left in one by noclip: a way out is found. */
static void test_way_out(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_box(&gym, enf_v3(-3.0, 0.0, -3.0), enf_v3(3.0, 3.0, 3.0));
    gym_ready(&gym);
    EnfTestRng rng = enf_test_rng(1);
    for (int i = 0; i < 200; i++) {
        gym_spawn(&gym, enf_v3(8.0, 0.0, 8.0));
        EnfCharacterInput input = {{0.0, 0.0, 0.0}, false, false, false, ENF_CHARACTER_NOCLIP};
        enf_character_move(&gym.body, gym.collider, &input, NULL);
        double x = enf_test_double(&rng, -3.2, 3.2), y = enf_test_double(&rng, -1.0, 3.2), z = enf_test_double(&rng, -3.2, 3.2);
        gym.body.position = enf_v3(x, y, z);
        input.mode = ENF_CHARACTER_WALK;
        for (int t = 0; t < 3; t++) {
            enf_character_move(&gym.body, gym.collider, &input, &gym.report);
        }
        EnfCapsule capsule = enf_character_capsule(&gym.body);
        assert_false(enf_collide_overlap(gym.collider, &capsule, gym.body.position, NULL));
    }
    gym_close(&gym);
}

/* Numbers that are none never get in. */
static void test_hostile_numbers(void **state) {
    (void)state;
    Gym gym;
    gym_open(&gym);
    gym_ready(&gym);
    gym_spawn(&gym, enf_v3(0.0, 0.0, 0.0));
    EnfCapsule capsule = enf_character_capsule(&gym.body);
    EnfSweepHit hit;
    const double bad[] = {(double)NAN, HUGE_VAL, -HUGE_VAL, 1e300};
    for (int i = 0; i < 4; i++) {
        assert_true(enf_collide_sweep(gym.collider, &capsule, gym.body.position, enf_v3(0.0, bad[i], 0.0), &hit));
        assert_true(hit.t == 0.0);
        EnfCharacterInput input = wish(bad[i], 0.0);
        enf_character_move(&gym.body, gym.collider, &input, &gym.report);
        gym.body.velocity.z = bad[i];
        enf_character_move(&gym.body, gym.collider, &input, &gym.report);
        assert_true(enf_v3_finite(gym.body.position) && enf_v3_finite(gym.body.velocity));
    }
    gym_close(&gym);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_walks_and_stops),
    cmocka_unit_test(test_steps),
    cmocka_unit_test(test_stairs),
    cmocka_unit_test(test_slopes),
    cmocka_unit_test(test_steep_slope_is_slid_down),
    cmocka_unit_test(test_jump),
    cmocka_unit_test(test_crouch),
    cmocka_unit_test(test_corners),
    cmocka_unit_test(test_wedge_between_slopes),
    cmocka_unit_test(test_elevator),
    cmocka_unit_test(test_elevator_squeezes),
    cmocka_unit_test(test_door_pushes),
    cmocka_unit_test(test_squeezed_at_a_wall),
    cmocka_unit_test(test_train),
    cmocka_unit_test(test_way_out),
    cmocka_unit_test(test_hostile_numbers),
};

ENF_TEST_MAIN(tests)

/* The river: what it reads and refuses; where it carries; how far a visitor gets; that it repeats. */
#include "harness/harness.h"
#include "scenes/night.h"

#include "sim/river.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Round the west room and back to the beginning, at 1 m/s; thrust over spring: half a metre. */
static const char PATH[] = "x,y,z,speed,spring,damping,thrust,look_x,look_y,look_z\n"
                           "2,1.7,2,1,4,4,2,4,1.7,4\n6,1.7,2,1,4,4,2,4,1.7,4\n"
                           "# half way\n\n6,1.7,6,1,4,4,2,4,1.7,4\r\n2,1.7,6,1,4,4,2,4,1.7,4\n2,1.7,2.25,1,4,4,2,4,1.7,4\n";

typedef struct Stage {
    EnfNight night;
    EnfCollider *collider;
    GameRiver *river;
} Stage;

static EnfResult read_tight(Stage *stage, const char *text, size_t size, EnfError *error) {
    char *tight = malloc(size ? size : 1);
    assert_non_null(tight);
    memcpy(tight, text, size);
    GameRiverDef def = {tight, size, stage->night.map, NULL};
    GameRiver *river;
    EnfResult result = game_river_create(&river, &def, NULL, error);
    assert_true((result == ENF_OK) == (river != NULL));
    free(tight);
    game_river_destroy(river);
    return result;
}

static void open_stage(Stage *stage, bool walls) {
    memset(stage, 0, sizeof *stage);
    EnfError error = {ENF_OK, 0, "", ""};
    EnfNightDef night = {.door = false};
    assert_true(enf_night_create(&stage->night, &night, &error));
    assert_int_equal(enf_collider_create(&stage->collider, stage->night.map, NULL, NULL, &error), ENF_OK);
    GameRiverDef def = {PATH, sizeof PATH - 1, stage->night.map, walls ? stage->collider : NULL};
    if (game_river_create(&stage->river, &def, NULL, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
}

static void close_stage(Stage *stage) {
    game_river_destroy(stage->river);
    enf_collider_destroy(stage->collider);
    enf_night_destroy(&stage->night);
}

/* Metres from the path's square, in the plan. */
static double off_path(EnfVec3 p) {
    double x = fabs(p.x - 4.0), z = fabs(p.z - 4.0);
    return fabs(fmax(x, z) - 2.0);
}

static void test_left_alone_it_goes_its_way(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, true);
    GameRiverView view = game_river_view(stage.river);
    assert_true(fabs(view.length - 15.75) < 1e-9);
    assert_int_equal(view.cell, stage.night.west);
    for (int tick = 0; tick < 4000; tick++) {
        game_river_step(stage.river, NULL);
        view = game_river_view(stage.river);
        EnfVec3 step = enf_sub(view.eye_ws, view.eye_before_ws);
        assert_true(off_path(view.eye_ws) < 0.3); /* corners are cut a little */
        assert_true(enf_length(step) * ENF_TICK_RATE < 1.6);
        assert_true(fabs(view.yaw_deg - view.yaw_before_deg) < 3.0);
        /* It looks at the middle, which is to its left and right by turns. */
        EnfVec3 way = enf_sub(enf_v3(4, 1.7, 4), view.eye_ws);
        double wanted = enf_atan2(-way.x, -way.z) * (180.0 / ENF_PI), turn = view.yaw_deg - wanted;
        assert_true(fabs(turn - 360.0 * floor(turn / 360.0 + 0.5)) < 50.0);
        assert_int_equal(view.cell, stage.night.west);
    }
    assert_int_equal(view.rounds, 4);
    close_stage(&stage);
}

static void test_a_visitor_gets_as_far_as_thrust_and_spring_allow(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, false);
    const EnfInput ahead = {32767, 0, 0, 0, 0};
    double most = 0.0;
    for (int tick = 0; tick < 200; tick++) { /* along the first side, looking at the middle */
        game_river_step(stage.river, &ahead);
        most = fmax(most, game_river_view(stage.river).eye_ws.z - 2.0);
    }
    assert_true(most > 0.3 && most < 0.62);
    close_stage(&stage);
}

static void test_a_turn_is_forgotten(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, true);
    const EnfInput turn = {0, 0, 2 * ENF_INPUT_DEGREE, 20 * ENF_INPUT_DEGREE, 0};
    GameRiver *river = stage.river;
    for (int tick = 0; tick < 30; tick++) {
        game_river_step(river, &turn);
    }
    assert_true(game_river_view(river).pitch_deg <= 89.0);
    double turned = game_river_view(river).yaw_deg;
    game_river_start(river, NULL);
    for (int tick = 0; tick < 30; tick++) {
        game_river_step(river, NULL);
    }
    assert_true(fabs(turned - game_river_view(river).yaw_deg - 60.0) < 1e-6);
    game_river_start(river, NULL);
    for (int tick = 0; tick < 1200; tick++) {
        game_river_step(river, tick < 30 ? &turn : NULL);
    }
    double back = game_river_view(river).yaw_deg;
    game_river_start(river, NULL);
    for (int tick = 0; tick < 1200; tick++) {
        game_river_step(river, NULL);
    }
    assert_true(fabs(back - game_river_view(river).yaw_deg) < 1.0);
    close_stage(&stage);
}

/* Random steering against the walls: in the room, finite, and the same twice. */
static void test_walls_hold_and_it_repeats(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, true);
    GameRiverView views[2];
    for (int again = 0; again < 2; again++) {
        EnfTestRng rng = enf_test_rng(2);
        game_river_start(stage.river, NULL);
        for (int tick = 0; tick < 3000; tick++) {
            EnfInput input = {(int16_t)(enf_test_below(&rng, 65535) - 32767), 32767, 0, 0, 0};
            input.yaw = (int32_t)enf_test_below(&rng, 10 * ENF_INPUT_DEGREE) - 5 * ENF_INPUT_DEGREE;
            game_river_step(stage.river, &input);
            EnfVec3 eye = game_river_view(stage.river).eye_ws;
            assert_true(eye.x > 0.14 && eye.x < 7.86 && eye.y > 0.14 && eye.z > 0.14 && eye.z < 7.86);
        }
        views[again] = game_river_view(stage.river);
    }
    assert_true(memcmp(&views[0].eye_ws, &views[1].eye_ws, sizeof(EnfVec3)) == 0);
    assert_true(views[0].yaw_deg == views[1].yaw_deg && views[0].along == views[1].along);
    close_stage(&stage);
}

static void test_it_begins_where_one_is(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, true);
    EnfVec3 at = enf_v3(6.5, 1.7, 6.2);
    game_river_start(stage.river, &at);
    EnfVec3 eye = game_river_view(stage.river).eye_ws;
    assert_true(eye.x == 6.0 && eye.z == 6.0);
    close_stage(&stage);
}

static void test_what_is_wrong_is_named(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, false);
    EnfError error = {ENF_OK, 0, "", ""};
    assert_int_equal(read_tight(&stage, "", 0, &error), ENF_ERROR_FORMAT);
    const char few[] = "x\n1,2,3,1,4,4,2,0,0\n", many[] = "x\n1,2,3,1,4,4,2,0,0,0,9\n",
               fast[] = "x\n\n1,2,3,1000,4,4,2,0,0,0\n";
    const char one[] = "x\n1,2,3,1,4,4,2,0,0,0\n1,2,3,1,4,4,2,0,0,0\n";
    assert_int_equal(read_tight(&stage, few, sizeof few - 1, &error), ENF_ERROR_FORMAT);
    assert_non_null(strstr(error.message, "look_z"));
    assert_int_equal(read_tight(&stage, many, sizeof many - 1, &error), ENF_ERROR_FORMAT);
    assert_int_equal(read_tight(&stage, fast, sizeof fast - 1, &error), ENF_ERROR_RANGE);
    assert_non_null(strstr(error.message, "line 3"));
    assert_non_null(strstr(error.message, "speed"));
    assert_int_equal(read_tight(&stage, one, sizeof one - 1, &error), ENF_ERROR_FORMAT);
    EnfTestRng rng = enf_test_rng(3);
    char text[sizeof PATH];
    for (size_t size = 0; size < sizeof PATH; size++) {
        read_tight(&stage, PATH, size, NULL);
    }
    for (uint32_t i = 0, rounds = enf_test_rounds(2000, 50000); i < rounds; i++) {
        memcpy(text, PATH, sizeof text);
        for (uint32_t k = 1 + enf_test_below(&rng, 4); k > 0; k--) {
            text[enf_test_below(&rng, sizeof PATH - 1)] = (char)enf_test_below(&rng, 256);
        }
        read_tight(&stage, text, sizeof PATH - 1, NULL);
    }
    close_stage(&stage);
}

/* The palace's own, once round: it has a beginning and an end, and the eye stays near its anchor. */
static void test_the_palace_has_one(void **state) {
    (void)state;
    Stage stage;
    open_stage(&stage, false);
    size_t size;
    uint8_t *text = enf_test_read_file(enf_test_source_path("maps/palace/river.csv"), &size);
    GameRiverDef def = {(const char *)text, size, stage.night.map, NULL};
    GameRiver *river;
    EnfError error = {ENF_OK, 0, "", ""};
    if (game_river_create(&river, &def, NULL, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
    int tick = 0;
    while (tick < 120000 && game_river_view(river).rounds == 0) {
        GameRiverView view = game_river_view(river);
        assert_true(enf_length(enf_sub(view.eye_ws, view.eye_before_ws)) < 0.1);
        game_river_step(river, NULL);
        tick++;
    }
    assert_true(tick > 18000 && tick < 120000); /* more than five minutes */
    game_river_destroy(river);
    free(text);
    close_stage(&stage);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_left_alone_it_goes_its_way), cmocka_unit_test(test_a_visitor_gets_as_far_as_thrust_and_spring_allow),
    cmocka_unit_test(test_a_turn_is_forgotten),        cmocka_unit_test(test_walls_hold_and_it_repeats),
    cmocka_unit_test(test_it_begins_where_one_is),     cmocka_unit_test(test_what_is_wrong_is_named),
    cmocka_unit_test(test_the_palace_has_one),
};

ENF_TEST_MAIN(tests)

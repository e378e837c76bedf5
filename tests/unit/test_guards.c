/* Guards off their rounds: they follow through doors, round what stands in the way and up steps, look for whom they have lost, and come
 * back. Doors and elevators do not crush. */
#include "unit/night_play.h"

#include "sim/sim.h"

#include <math.h>
#include <string.h>

/* The guard has seen the player, wherever he is. */
static void tell(Game *game) {
    SimGuard *guard = &game->guards[0];
    game->random = 1;
    guard->notice = 1.0;
    guard->seen_at = sim_tick(game);
    sim_guard_chase(game, guard);
    guard->until = sim_tick(game) + 600;
    guard->last_seen = game->player.body.position;
    guard->last_cell = game->player.body.cell;
}

/* On the stage, behind a shut door and a screen: the guard opens the one, goes round the other, climbs the steps. */
static void test_a_chase_goes_through_doors_round_things_and_up(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true, .stage = true}, false);
    run(&play, "enfbot 1\ngoto point 1.2 1.5 6.8\n");
    assert_true(play.game->player.body.position.y > 1.4);
    tell(play.game);
    int ticks = 0;
    for (; ticks < 60 * 30 && play.game->score.phase == GAME_PLAYING; ticks++) {
        wait(&play, 1);
    }
    assert_int_equal(play.game->score.phase, GAME_LOST);
    assert_int_equal(play.heard[GAME_SOUND_DOOR_OPEN], 1);
    assert_true(play.game->guards[0].body.position.y > 1.0);
    close_play(&play);
}

/* Out of sight and silent, the player is lost; the guard looks for him, gives up, and walks its round again. */
static void test_who_is_lost_is_looked_for_and_let_go(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true, .stage = true}, true); /* it sees nobody */
    run(&play, "enfbot 1\ngoto point 5 0 1\n");
    tell(play.game);
    const SimGuard *guard = &play.game->guards[0];
    bool searched = false, came = false;
    int ticks = 0;
    for (; ticks < 60 * 90 && guard->mood != GAME_GUARD_ROUND; ticks++) {
        wait(&play, 1);
        searched = searched || guard->mood == GAME_GUARD_SEARCHES;
        came = came || (guard->body.position.x < 8.0 && guard->body.cell == play.night.west);
    }
    assert_true(searched);
    assert_true(came);
    assert_int_equal(guard->mood, GAME_GUARD_ROUND);
    assert_int_equal(guard->body.cell, play.night.east);
    assert_true(fabs(guard->body.position.x - 13.0) < 0.2);
    EnfVec3 before = guard->body.position;
    wait(&play, 30);
    assert_true(enf_length(enf_sub(before, guard->body.position)) > 0.2);
    close_play(&play);
}

/* Where no way leads, it says so, and gives up: the player stands on the plate of an elevator two metres up. */
static void test_where_no_way_leads_it_gives_up(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true, .guard = true, .lift = true}, true);
    run(&play, "enfbot 1\ngoto point 6 0 7\nlook by 0 -80\nuse\nwait 4\n");
    assert_true(play.game->player.body.position.y > 1.9);
    tell(play.game);
    const SimGuard *guard = &play.game->guards[0];
    int ticks = 0;
    for (; ticks < 60 * 120 && guard->mood != GAME_GUARD_ROUND; ticks++) {
        wait(&play, 1);
    }
    assert_int_equal(guard->mood, GAME_GUARD_ROUND);
    close_play(&play);
}

static double lift_height(const Game *game) {
    return enf_world_pose(game->world, game->lifts[0].object.index).position.y;
}

/* Under the plate as it comes down: it goes up again, and nobody is hurt or inside it. */
static void test_an_elevator_turns_back(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.lift = true}, true);
    Game *game = play.game;
    sim_lift_call(game, game->lifts[0].name, 1);
    run(&play, "enfbot 1\nwait 4\ngoto point 6 0 7\n");
    assert_true(lift_height(game) > 1.99);
    assert_true(game->player.body.position.y < 0.1);
    sim_lift_call(game, game->lifts[0].name, 0);
    double lowest = lift_height(game);
    for (int i = 0; i < 60 * 8; i++) {
        wait(&play, 1);
        lowest = fmin(lowest, lift_height(game));
        EnfCapsule body = enf_character_capsule(&game->player.body);
        EnfOverlap overlap;
        bool inside = enf_collide_overlap(game->collider, &body, game->player.body.position, &overlap);
        assert_true(!inside || overlap.depth < 0.06);
    }
    assert_true(lowest > 1.6 && lowest < 1.99);
    assert_true(lift_height(game) > 1.99);
    run(&play, "enfbot 1\ngoto point 2 0 4\n");
    sim_lift_call(game, game->lifts[0].name, 0);
    wait(&play, 60 * 4);
    assert_true(lift_height(game) < 0.01);
    close_play(&play);
}

/* A leaf that shuts on somebody opens again. */
static void test_a_door_turns_back(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.door = true}, true);
    run(&play, "enfbot 1\ngoto point 6.5 0 4\npress door\nwait 1.5\ngoto point 8 0 4\n");
    Game *game = play.game;
    SimDoor *door = &game->doors[0];
    assert_true(door->wanted == door->open && !door->moving);
    door->shut_at = sim_tick(game);
    wait(&play, 10);
    assert_true(door->wanted == door->open); /* somebody is near: it waits */
    door->wanted = 0.0;
    door->moving = 1;
    enf_world_swing(game->world, door->object, 0.0);
    sim_turn_back(game, game->player.body.object);
    assert_true(door->wanted == 0.0); /* not its fault */
    sim_turn_back(game, door->object.index);
    assert_true(door->wanted == door->open && door->moving);
    sim_turn_back(game, door->object.index);
    assert_true(door->wanted == door->open); /* not again at once */
    wait(&play, 120);
    assert_true(!door->moving);
    assert_true(enf_portals_is_open(game_portals(game), play.night.portal));
    sim_turn_back(game, door->object.index); /* at rest it does nothing */
    assert_true(door->wanted == door->open);
    close_play(&play);
}

/* What carelessness loses, care wins: past a guard who walks up and down before the vase, in a lit room. */
static void test_care_wins(void **state) {
    (void)state;
    Play play;
    open_play(&play, (EnfNightDef){.guard = true, .lamps = true}, false);
    run(&play, "enfbot 1\nwait 6\ngoto point 11.5 0 4\nexpect lost 40\n");
    close_play(&play);
    open_play(&play, (EnfNightDef){.guard = true, .lamps = true}, false);
    run(&play, "enfbot 1\nwait 6\nsneak on\ntake vase\ngoto exit\nexpect won 1\n");
    assert_int_equal(play.heard[GAME_SOUND_GUARD_SEES], 0);
    close_play(&play);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_chase_goes_through_doors_round_things_and_up),
    cmocka_unit_test(test_who_is_lost_is_looked_for_and_let_go),
    cmocka_unit_test(test_where_no_way_leads_it_gives_up),
    cmocka_unit_test(test_an_elevator_turns_back),
    cmocka_unit_test(test_a_door_turns_back),
    cmocka_unit_test(test_care_wins),
};

ENF_TEST_MAIN(tests)

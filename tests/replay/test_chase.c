/* The palace, chased through: a runner from room to room, upstairs and down again, and a guard after him; and guards sent from their
 * rounds to places all over it. */
#include "harness/program.h"

#include "sim/bot.h"
#include "sim/sim.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The hunter is told where the runner is within these ticks: he has a start, and it comes near enough to see and hear for itself. */
enum { TOLD_FROM = 3 * ENF_TICK_RATE, TOLD_TO = 20 * ENF_TICK_RATE };

static EnfMap map;
static Game *game;

/* What a tick costs at most, in sweeps of the collider: the same number on every machine, some 5 us each. */
enum { SWEEPS_A_TICK = 250 };
static uint64_t most_sweeps;

static void step(const EnfInput *input) {
    uint64_t before = enf_collider_counters(game->collider).sweeps;
    game_step(game, input);
    uint64_t sweeps = enf_collider_counters(game->collider).sweeps - before;
    most_sweeps = sweeps > most_sweeps ? sweeps : most_sweeps;
}

static int open_palace(void **state) {
    (void)state;
    EnfError error = {ENF_OK, 0, "", ""};
    const char *path = enf_test_temp_path("palace.enfmap");
    GameDef def = game_def_default();
    return enf_test_compile_palace(path) != 0 || enf_map_read(&map, path, NULL, &error) != ENF_OK ||
           game_create(&game, &map, &def, NULL, &error) != ENF_OK;
}

static int close_palace(void **state) {
    (void)state;
    game_destroy(game);
    enf_map_free(&map);
    return 0;
}

/* Off its round and after the player, who may be anywhere. */
static void send_after(SimGuard *guard) {
    sim_guard_chase(game, guard);
    guard->until = sim_tick(game) + 600;
    guard->last_seen = game->player.body.position;
    guard->last_cell = sim_feet_cell(game, &game->player.body);
}

/* Metres on foot, or HUGE_VAL. */
static double way_to_player(const SimGuard *guard) {
    SimErrand errand = {guard->body.position, game->player.body.position, sim_feet_cell(game, &guard->body),
                        sim_feet_cell(game, &game->player.body), ENF_NONE};
    SimWay way;
    double metres = 0.0;
    EnfVec3 at = errand.from;
    if (!sim_route(game, &errand, &way)) {
        return HUGE_VAL;
    }
    for (uint32_t i = 0; i < way.count; i++) {
        metres += enf_length(enf_sub(way.at[i], at));
        at = way.at[i];
    }
    return metres;
}

static SimGuard *nearest_guard(void) {
    SimGuard *best = &game->guards[0];
    for (uint32_t i = 1; i < game->guard_count; i++) {
        best = way_to_player(&game->guards[i]) < way_to_player(best) ? &game->guards[i] : best;
    }
    return best;
}

/* The other guards are blind and deaf here: this is about one. */
static void silence_others(const SimGuard *hunter) {
    for (uint32_t i = 0; i < game->guard_count; i++) {
        SimGuard *guard = &game->guards[i];
        if (guard != hunter && guard->mood != GAME_GUARD_ROUND) {
            sim_round_find(game, guard);
            sim_round_resume(game, guard);
        }
        guard->notice = guard == hunter ? guard->notice : 0.0;
    }
}

/* Through the hall and two rooms, up the grand staircase, through a room above and back to the hall, up again, and there he stands. */
static void test_a_runner_is_followed_upstairs(void **state) {
    (void)state;
    static const char script[] = "enfbot 1\nrun on\ngoto cell EntranceHall-room\ngoto cell GrandStaircase-room\n"
                                 "goto cell UpperStaircase-room\ngoto cell GrandStaircase-room\ngoto cell EntranceHall-room\n"
                                 "goto cell UpperStaircase-room\nwait 60\n";
    EnfError error = {ENF_OK, 0, "", ""};
    EnfInput input = {0, 0, 0, 0, 0};
    GameBot *bot;
    if (game_bot_create(&bot, game, script, sizeof script - 1, NULL, &error) != ENF_OK) {
        print_message("the palace has other rooms now: %s\n", error.message);
        skip();
    }
    SimGuard *hunter = nearest_guard();
    double begun = game->player.body.position.y;
    uint32_t ticks = 0;
    GameBotNews news = GAME_BOT_GOES_ON;
    while (game->score.phase == GAME_PLAYING && (news = game_bot_next(bot, &input, &error)) == GAME_BOT_GOES_ON) {
        if (ticks > TOLD_FROM && ticks < TOLD_TO) { /* from then on it has its eyes and ears */
            send_after(hunter);
        }
        silence_others(hunter);
        step(&input);
        ticks++;
    }
    game_bot_destroy(bot);
    if (news == GAME_BOT_FAILED) {
        fail_msg("%s", error.message);
    }
    print_message("at most %llu sweeps a tick\n", (unsigned long long)most_sweeps);
    assert_true(most_sweeps < SWEEPS_A_TICK);
    print_message("caught after %u ticks, at a height of %.1f m\n", ticks, game->player.body.position.y);
    assert_int_equal(game->score.phase, GAME_LOST);
    assert_true(ticks > 60 * 15 && ticks < 60 * 90);
    assert_true(game->player.body.position.y > begun + 3.0);
}

/* Somewhere in the cell, on its floor or what stands there; false if there is no room. */
static bool put_player(uint32_t cell, EnfTestRng *rng) {
    const EnfCell *c = &map.cells[cell];
    double s = enf_test_double(rng, 0.2, 0.8), t = enf_test_double(rng, 0.2, 0.8);
    EnfVec3 at = enf_v3(c->origin[0] + (1.0 - s) * (double)c->min[0] + s * (double)c->max[0],
                        c->origin[1] + (double)c->min[1] + 0.1,
                        c->origin[2] + (1.0 - t) * (double)c->min[2] + t * (double)c->max[2]);
    EnfCharacterDef def = enf_character_def_default();
    static const EnfInput nothing;
    bool put = enf_character_spawn(&game->player.body, game->collider, &def, at);
    for (int i = 0; i < 60; i++) {
        step(&nothing);
    }
    return put && game->player.body.cell == cell && (game->player.body.flags & ENF_CHARACTER_GROUNDED);
}

/* Walks after him to within arm's length, in a chaser's time for the way and as much again; true if it comes there. */
static bool reaches(SimGuard *guard, double metres) {
    static const EnfInput nothing;
    int most = (int)(60.0 * (2.0 * metres / 3.6 + 10.0));
    for (int i = 0; i < most; i++) {
        send_after(guard);
        step(&nothing);
        EnfVec3 way = enf_sub(guard->body.position, game->player.body.position);
        if (sqrt(way.x * way.x + way.z * way.z) < 0.95 && fabs(way.y) < 1.2) {
            return true;
        }
    }
    return false;
}

/* Nine of ten: the rest are nooks behind furniture and tops of things, to which a body is put but no way leads. A rate wants a large
 * sample: dice throw the long label's; a dozen are always the same. */
static void test_guards_get_everywhere(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_long() ? enf_test_rng(3) : enf_test_rng_fixed(2, 3);
    uint32_t rounds = enf_test_rounds(12, 150), tried = 0, come = 0;
    for (uint32_t i = 0; i < rounds; i++) {
        game_restart(game);
        game->def.peaceful = true;
        SimGuard *guard = &game->guards[enf_test_below(&rng, game->guard_count)];
        uint32_t cell = enf_test_below(&rng, map.cells_count);
        bool stands = !(map.cells[cell].flags & ENF_CELL_OUTSIDE) && put_player(cell, &rng);
        double metres = stands ? way_to_player(guard) : HUGE_VAL;
        if (metres < HUGE_VAL) {
            tried++;
            come += reaches(guard, metres);
        }
    }
    print_message("%u of %u places reached; at most %llu sweeps a tick\n", come, tried, (unsigned long long)most_sweeps);
    assert_true(most_sweeps < SWEEPS_A_TICK);
    assert_true(tried > rounds / 3);
    assert_true(10 * (tried - come) <= 2 * tried);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_a_runner_is_followed_upstairs),
    cmocka_unit_test(test_guards_get_everywhere),
};

int main(int argc, char **argv) {
    enf_test_begin(argc, argv);
    return enf_test_end(cmocka_run_group_tests(tests, open_palace, close_palace));
}

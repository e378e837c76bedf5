/* Recordings of the palace, walked again while they are drawn: with pictures and without, with volumes and without, at any frame rate:
 * none for a while, one every few ticks, one a tick, several between two ticks. Every tick's state is the recorded one. */
#include "harness/onlooker.h"

#include <enfilade/gl.h>

enum { WIDTH = 160, HEIGHT = 90, FAST_TICKS = 60, PACES = 11, PACE_TICKS = 15 };

static EnfWalkMaps maps;

static int open_maps(void **state) {
    (void)state;
    return enf_walk_maps(&maps);
}

static int close_maps(void **state) {
    (void)state;
    enf_walk_forget(&maps);
    return 0;
}

/* Who draws what the player sees. */
typedef struct Painter {
    EnfOnlooker onlooker;
    EnfContext *context;
    EnfDraw *draw;
    EnfGl *gl;
    EnfGlTarget *target;
    uint32_t pictures, blank;
    uint8_t rgba[WIDTH * HEIGHT * 4];
} Painter;

static void painter_begin(Painter *painter, EnfWalk *walk, int policy) {
    EnfError error = {0};
    memset(painter, 0, sizeof *painter);
    if (enf_context_create(&painter->context, ENF_CONTEXT_ANY, &error) != ENF_OK) {
        enf_walk_close(walk);
        printf("skipped: %s\n", error.message);
        skip();
    }
    enf_world_set_trail(sim_world(walk->sim), true);
    painter->onlooker = enf_onlooker_begin(walk->sim, walk->map, policy);
    if (enf_draw_create(&painter->draw, walk->map, NULL, &error) != ENF_OK ||
        enf_gl_create(&painter->gl, walk->map, enf_context_loader(painter->context), &error) != ENF_OK ||
        enf_gl_target_create(painter->gl, &painter->target, WIDTH, HEIGHT, &error) != ENF_OK) {
        fail_msg("%s", error.message);
    }
}

static void painter_end(Painter *painter) {
    enf_gl_target_destroy(painter->target);
    enf_gl_destroy(painter->gl);
    enf_context_destroy(painter->context);
    enf_draw_destroy(painter->draw);
    enf_onlooker_end(&painter->onlooker);
}

/* A picture of the moment `alpha` between the last tick and this. */
static void paint(Painter *painter, EnfWalk *walk, double alpha) {
    EnfView view = enf_onlooker_view(&painter->onlooker, walk->sim, WIDTH, HEIGHT);
    const EnfVisSet *set = enf_vis_run(painter->onlooker.vis, sim_portals(walk->sim), &view);
    enf_gl_target_bind(painter->target, ENF_RENDER_COLOR);
    enf_gl_draw(painter->gl, enf_draw_build(painter->draw, set, ENF_DRAW_NEAR, sim_world(walk->sim), alpha), ENF_RENDER_COLOR);
    enf_gl_target_read(painter->target, ENF_RENDER_COLOR, painter->rgba);
    painter->pictures++;
    painter->blank += memcmp(painter->rgba, painter->rgba + 4, sizeof painter->rgba - 4) == 0;
}

/* How many pictures there are of a tick: paces take turns; most of the time nobody draws, as it takes long. */
static uint32_t pictures_of(uint64_t tick) {
    switch (tick / PACE_TICKS % PACES) {
    case 0:
        return 1;
    case 1:
        return tick % 5 == 0;
    case 2:
        return tick % PACE_TICKS < 3 ? 4 : 0;
    default:
        return 0;
    }
}

static void walk_drawn(const char *name, int policy) {
    EnfWalk walk;
    static Painter painter;
    if (!enf_walk_open(&walk, &maps, name)) {
        return;
    }
    painter_begin(&painter, &walk, policy);
    uint64_t left = enf_walk_ticks(FAST_TICKS, UINT64_MAX);
    EnfReplayCursor cursor = enf_replay_begin(&walk.replay);
    for (const EnfReplayTick *tick; left > 0 && (tick = enf_replay_next(&cursor)) != NULL; left--) {
        enf_walk_step(&walk, tick);
        uint32_t count = pictures_of(tick->tick);
        for (uint32_t i = 1; i <= count; i++) {
            paint(&painter, &walk, (double)i / count);
        }
    }
    printf("%s: %u pictures\n", name, painter.pictures);
    assert_true(painter.pictures > 0 && painter.blank < painter.pictures);
    painter_end(&painter);
    enf_walk_close(&walk);
}

/* In the fast label a stretch of the first; else all, each without volumes or with those of one policy, the first with both. */
static void drawing_changes_nothing(void **state) {
    (void)state;
    static const char *const recordings[] = {"palace_bold.enfreplay", "palace_won.enfreplay",   "palace_lift.enfreplay",
                                             "palace_lost.enfreplay", "palace_body.enfreplay",  "palace_stairs.enfreplay",
                                             "palace_fly.enfreplay",  "palace_doors.enfreplay", "palace_rooms.enfreplay",
                                             "palace_tour.enfreplay", "mash_01.enfreplay"};
    walk_drawn(recordings[0], -1);
    for (size_t i = 0; i < (enf_test_long() ? sizeof recordings / sizeof *recordings : 1); i++) {
        walk_drawn(recordings[i], i == 0 ? ENF_DBV_REACH : (int)(i % (ENF_DBV_REACH + 2)) - 1);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(drawing_changes_nothing),
};

int main(int argc, char **argv) {
    enf_test_begin(argc, argv);
    return enf_test_end(cmocka_run_group_tests(tests, open_maps, close_maps));
}

/* Swept capsules against every triangle: none ends inside a surface, none passes one, none stops short, at up to 300 m/s; in the
 * palace, in real levels, in rooms, and in soups of random polygons. */
#include "harness/program.h"
#include "harness/purse.h"
#include "scenes/maker.h"
#include "scenes/rooms.h"
#include "scenes/solid_oracle.h"
#include "world/collide_internal.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <stdio.h>

/* Metres that rounding may take: positions of 10 km round by 2^-39, the search ends at 2^-24. */
#define ROUNDING 0x1p-22
/* Inside is what overlaps by more than enf_collide_overlap calls rounding: dice do throw a body in that near to a wall. A sweep is
 * held to ROUNDING nearer than where it began (check_sweep). */
#define INSIDE (0x1p-20 + ROUNDING)
#define SPEED_MAX 300.0

/* A door, as the dice know it. */
typedef struct Swing {
    uint32_t object;
    double low, high;
} Swing;

enum { SWINGS_MAX = 512 };

/* A level under test and what has been seen in it. */
typedef struct Ground {
    const char *name;
    const EnfMap *map;
    EnfWorld *world; /* NULL: nothing moves */
    Swing swings[SWINGS_MAX];
    uint32_t swing_count;
    EnfCollider *collider;
    EnfOracle oracle;
    EnfBox3 box; /* to throw bodies into */
    EnfTestRng rng;
    uint64_t moves, hits, ended_inside, tunnels, not_finite, too_near, stopped_short, asked, stuck, squeezed, pushed;
    double travelled;
} Ground;

static void ground_open(Ground *g, const char *name, const EnfMap *map, uint64_t stream, bool moving) {
    memset(g, 0, sizeof *g);
    g->name = name;
    g->map = map;
    g->rng = enf_test_rng(stream);
    if (moving) {
        assert_int_equal(enf_world_create(&g->world, map, map->movers_count, NULL, NULL), ENF_OK);
        assert_int_equal(enf_world_populate(g->world, NULL), ENF_OK);
        for (uint32_t i = 0; i < map->movers_count && g->swing_count < SWINGS_MAX; i++) {
            const EnfMover *m = &map->movers[i];
            if (m->kind == ENF_MOVER_HINGE || m->kind == ENF_MOVER_SLIDE) {
                g->swings[g->swing_count++] = (Swing){i, (double)m->low, (double)m->high};
            }
        }
    }
    assert_int_equal(enf_collider_create(&g->collider, map, g->world, NULL, NULL), ENF_OK);
    assert_true(enf_oracle_build(&g->oracle, map));
    g->box = g->oracle.bounds;
}

static void ground_close(Ground *g) {
    printf("%s: %llu moves, %.0f m, %llu hits; %llu ended inside, %llu tunnels, %llu not finite, %llu too near, %llu stopped "
           "short\n",
           g->name, (unsigned long long)g->moves, g->travelled, (unsigned long long)g->hits,
           (unsigned long long)g->ended_inside, (unsigned long long)g->tunnels, (unsigned long long)g->not_finite,
           (unsigned long long)g->too_near, (unsigned long long)g->stopped_short);
    printf("    pushed %llu times, squeezed %llu; ", (unsigned long long)g->pushed, (unsigned long long)g->squeezed);
    printf("asked for a way on %llu times, stuck %llu\n", (unsigned long long)g->asked, (unsigned long long)g->stuck);
    assert_true(g->moves > 0);
    assert_int_equal(g->ended_inside + g->tunnels + g->not_finite + g->too_near + g->stopped_short + g->stuck, 0);
    enf_collider_destroy(g->collider);
    enf_world_destroy(g->world);
    enf_oracle_free(&g->oracle);
}

/* One number after the other: the order of a call's arguments is the compiler's. */
static EnfVec3 random_point(EnfTestRng *rng, EnfVec3 low, EnfVec3 high) {
    double x = enf_test_double(rng, low.x, high.x);
    double y = enf_test_double(rng, low.y, high.y);
    double z = enf_test_double(rng, low.z, high.z);
    return enf_v3(x, y, z);
}

static EnfVec3 random_way(EnfTestRng *rng) {
    for (;;) {
        EnfVec3 v = random_point(rng, enf_v3(-1, -1, -1), enf_v3(1, 1, 1));
        double square = enf_dot(v, v);
        if (square > 0.01 && square < 1.0) {
            return enf_scale(v, 1.0 / sqrt(square));
        }
    }
}

static EnfVec3 random_blow(EnfTestRng *rng) {
    double speed = enf_test_double(rng, 0.0, SPEED_MAX);
    return enf_scale(random_way(rng), speed);
}

/* A place where the capsule touches nothing; false if a hundred throws found none. */
static bool throw_in(Ground *g, const EnfCapsule *capsule, EnfVec3 *at) {
    for (int i = 0; i < 100; i++) {
        *at = random_point(&g->rng, g->box.min, g->box.max);
        if (!enf_collide_overlap(g->collider, capsule, *at, NULL) && enf_map_locate(g->map, *at) != ENF_NONE) {
            return true;
        }
    }
    return false;
}

/* ---- one sweep, in full ----------------------------------------------------------------------------------------- */

/* Every triangle near: how near the free part of the way comes; and whether the whole way would have been stopped at all. */
static void check_sweep(Ground *g, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta, const EnfSweepHit *hit) {
    const EnfOracle *o = &g->oracle;
    EnfVec3 way = enf_scale(delta, hit->t);
    EnfOracleMove free = {*capsule, from, way}, asked = {*capsule, from, delta};
    double contact = capsule->radius + 0.5 * ENF_TOL_SKIN;
    bool stopped = false, at_hit = false;
    for (uint32_t i = 0; i < o->near_count; i++) {
        const EnfOracleTriangle *t = &o->triangles[o->near[i]];
        double where, start = enf_oracle_distance(t, capsule, from), least = enf_oracle_least(t, &free, &where);
        if (least < fmin(start, contact) - ROUNDING) {
            g->too_near++;
        }
        double whole = enf_oracle_least(t, &asked, &where);
        stopped = stopped || (whole < contact - ROUNDING && where > 0.0 && whole < start - ROUNDING);
        if (t->cluster == hit->cluster && t->triangle == hit->triangle) {
            double end = enf_oracle_distance(t, capsule, enf_add(from, way));
            at_hit = end <= capsule->radius + ENF_TOL_SKIN + ROUNDING && whole <= contact + ROUNDING;
        }
    }
    bool met = hit->cluster != ENF_NONE;
    g->stopped_short += met && !at_hit;
    g->tunnels += stopped && !met;
}

/* What is checked of each move, of some, and of a few: the ends; the whole way; the same with every triangle of the map. */
static void check_move(Ground *g, const EnfCapsule *capsule, EnfVec3 from, EnfVec3 delta, const EnfSweepHit *hit) {
    EnfVec3 to = enf_add(from, enf_scale(delta, hit->t));
    bool full = g->moves % 32 == 0, every = g->moves % 4096 == 0;
    g->moves++;
    g->hits += hit->t < 1.0;
    g->travelled += enf_length(enf_sub(to, from));
    if (!enf_v3_finite(to) || !(hit->t >= 0.0 && hit->t <= 1.0) || !enf_v3_finite(hit->normal)) {
        g->not_finite++;
        return;
    }
    enf_oracle_near(&g->oracle, full ? enf_oracle_box(capsule, from, delta) : enf_oracle_box(capsule, from, enf_sub(to, from)),
                    every);
    g->ended_inside += enf_oracle_depth(&g->oracle, capsule, to) > INSIDE;
    g->tunnels += enf_oracle_tunnels(&g->oracle, capsule, from, to);
    if (full) {
        check_sweep(g, capsule, from, delta, hit);
    }
}

/* On and on from where it was stopped, mostly at surfaces; thrown in anew now and then. */
static void fly_about(Ground *g, uint32_t moves) {
    EnfCapsule capsule = {0.3, 1.75};
    EnfVec3 at = enf_v3(0.0, 0.0, 0.0);
    bool in = false;
    for (uint32_t i = 0; i < moves; i++) {
        if (!in || enf_test_chance(&g->rng, 50)) {
            capsule.radius = enf_test_double(&g->rng, 0.1, 0.5);
            capsule.height = capsule.radius * 2.0 + (enf_test_chance(&g->rng, 8) ? 0.0 : enf_test_double(&g->rng, 0.0, 1.5));
            in = throw_in(g, &capsule, &at);
            if (!in) {
                continue;
            }
        }
        double speed = SPEED_MAX * (enf_test_chance(&g->rng, 2) ? 1.0 : 0.02) * enf_test_double(&g->rng, 0.0, 1.0);
        EnfVec3 way = random_way(&g->rng);
        way = enf_test_chance(&g->rng, 6) ? enf_v3(way.x, 0.0, way.z) : way;
        EnfVec3 delta = enf_scale(way, speed / ENF_TICK_RATE);
        EnfSweepHit hit;
        (void)enf_collide_sweep(g->collider, &capsule, at, delta, &hit);
        check_move(g, &capsule, at, delta, &hit);
        at = enf_add(at, enf_scale(delta, hit.t));
    }
}

/* ---- bodies ----------------------------------------------------------------------------------------------------- */

static void check_body(Ground *g, const EnfCharacter *body, const EnfCharacterReport *report) {
    EnfCapsule capsule = enf_character_capsule(body);
    g->moves++;
    if (!enf_v3_finite(body->position) || !enf_v3_finite(body->velocity)) {
        g->not_finite++;
        return;
    }
    EnfCapsule low = {capsule.radius, body->def.crouch_height}; /* it may have grown since */
    for (uint32_t i = 0; i + 1 < report->path_count; i++) {
        EnfVec3 from = report->path[i], to = report->path[i + 1];
        g->travelled += enf_length(enf_sub(to, from));
        enf_oracle_near(&g->oracle, enf_oracle_box(&low, from, enf_sub(to, from)), false);
        g->tunnels += enf_oracle_tunnels(&g->oracle, &low, from, to);
        g->ended_inside += enf_oracle_depth(&g->oracle, &low, to) > INSIDE;
    }
    enf_oracle_near(&g->oracle, enf_oracle_box(&capsule, body->position, enf_v3(0.0, 0.0, 0.0)), g->moves % 4096 == 0);
    g->ended_inside += enf_oracle_depth(&g->oracle, &capsule, body->position) > INSIDE;
}

/* A body at the mercy of dice: keys, and blows that throw it at up to 300 m/s. */
static EnfCharacterInput random_input(EnfTestRng *rng, const EnfCharacterInput *before) {
    if (!enf_test_chance(rng, 10)) {
        return *before;
    }
    EnfCharacterInput input = {random_way(rng), false, false, false, ENF_CHARACTER_WALK};
    input.jump = enf_test_chance(rng, 3);
    input.crouch = enf_test_chance(rng, 4);
    input.run = enf_test_chance(rng, 2);
    input.mode = enf_test_chance(rng, 6) ? ENF_CHARACTER_FLY : ENF_CHARACTER_WALK;
    return input;
}

/* Wherever dice have brought it, a body can go on: some way of nine, jumping, gets it somewhere within a second; or crouching. */
static void check_way_on(Ground *g, const EnfCharacter *body) {
    double farthest = 0.0;
    for (int way = 0; way < 18 && farthest < 0.25; way++) {
        EnfCharacter copy = *body;
        double turn = (double)(way % 9) * (ENF_PI / 4.0), length = way % 9 == 8 ? 0.0 : 1.0;
        EnfCharacterInput input = {
            {length * enf_cos(turn), 0.0, length * enf_sin(turn)}, false, false, false, ENF_CHARACTER_WALK};
        copy.velocity = enf_v3(0.0, 0.0, 0.0);
        input.crouch = way >= 9;
        for (int t = 0; t < 60; t++) {
            input.jump = t % 20 == 19;
            if (g->world != NULL) {
                enf_world_advance(g->world, 1);
            }
            enf_character_move(&copy, g->collider, &input, NULL);
            farthest = fmax(farthest, enf_length(enf_sub(copy.position, body->position)));
        }
    }
    g->asked++;
    if (farthest < 0.25) {
        printf("stuck at %.17g %.17g %.17g, height %g, flags %u: %g m\n", body->position.x, body->position.y, body->position.z,
               body->height, body->flags, farthest);
        g->stuck++;
    }
}

/* Doors and lifts that dice send to and fro. A body may be inside a solid only where it said that it is squeezed. */
static void stir(Ground *g) {
    for (uint32_t i = 0; i < g->swing_count; i += 40) {
        uint32_t index = enf_test_below(&g->rng, g->swing_count);
        const Swing *swing = &g->swings[index];
        double target = enf_test_chance(&g->rng, 2) ? swing->low : swing->high;
        assert_true(enf_world_swing(g->world, enf_world_object(g->world, swing->object), target));
    }
    enf_world_advance(g->world, 1);
}

static void check_solids(Ground *g, const EnfCharacter *body, const EnfCharacterReport *report) {
    EnfCapsule capsule = enf_character_capsule(body);
    EnfOverlap overlap;
    bool inside = enf_collide_overlap(g->collider, &capsule, body->position, &overlap) && overlap.object != ENF_NONE;
    bool squeezed = (report->moved & ENF_MOVED_SQUEEZED) != 0;
    g->ended_inside += inside && !squeezed;
    g->squeezed += squeezed;
    g->pushed += (report->moved & ENF_MOVED_PUSHED) != 0;
}

static void walk_about(Ground *g, uint32_t ticks) {
    EnfCharacterDef def = enf_character_def_default();
    EnfCharacter body;
    EnfCharacterReport report;
    EnfCapsule capsule = {def.radius, def.height};
    EnfCharacterInput input = {{0.0, 0.0, 0.0}, false, false, false, ENF_CHARACTER_WALK};
    bool in = false;
    for (uint32_t i = 0; i < ticks; i++) {
        if (!in || enf_test_chance(&g->rng, 200)) {
            EnfVec3 at;
            in = throw_in(g, &capsule, &at) && enf_character_spawn(&body, g->collider, &def, at);
            if (!in) {
                continue;
            }
        }
        input = random_input(&g->rng, &input);
        if (enf_test_chance(&g->rng, 5)) {
            body.velocity = random_blow(&g->rng);
            body.flags &= ~(uint32_t)ENF_CHARACTER_GROUNDED;
        }
        if (g->world != NULL) {
            stir(g);
        }
        enf_character_move(&body, g->collider, &input, &report);
        g->hits += (report.moved & ENF_MOVED_BLOCKED) != 0;
        /* who never is inside needs no way out; but a level may leak */
        g->ended_inside += (report.moved & ENF_MOVED_RELOCATED) && !(report.moved & ENF_MOVED_RETURNED);
        check_body(g, &body, &report);
        if (g->world != NULL) {
            check_solids(g, &body, &report);
        }
        if (i % 32 == 31) {
            check_way_on(g, &body);
        }
    }
}

/* ---- levels ----------------------------------------------------------------------------------------------------- */

static void try_level(const char *name, const char *path, uint32_t moves, uint64_t stream) {
    EnfMap map;
    enf_test_compile_map(&map, path);
    Ground g;
    ground_open(&g, name, &map, stream, false);
    fly_about(&g, moves);
    walk_about(&g, moves / 4);
    ground_close(&g);
    if (map.movers_count > 0) {
        ground_open(&g, "the same, moving", &map, stream + 100, true);
        walk_about(&g, moves / 4);
        ground_close(&g);
    }
    enf_map_free(&map);
}

static void test_palace(void **state) {
    (void)state;
    try_level("palace", enf_test_source_path("assets/palace/palace.glb"), enf_test_rounds(120000, 1500000), 1);
}

static void test_freedoom(void **state) {
    (void)state;
    static const char *const names[] = {"MAP01_rooms", "E1M1_rooms", "E1M1_sector", "E3M8_rooms", "MAP26_rooms"};
    for (int i = 0; i < 5; i++) {
        char relative[64];
        snprintf(relative, sizeof relative, "freedoom/%s.glb", names[i]);
        try_level(names[i], enf_test_data(relative), enf_test_rounds(60000, 600000), 10 + (uint64_t)i);
    }
}

/* ---- made levels ------------------------------------------------------------------------------------------------ */

static void test_rooms(void **state) {
    (void)state;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfRooms rooms;
    EnfError error = {0};
    def.origin = enf_v3(10000.0, -500.0, 3000.0);
    def.seed = enf_test_seed();
    assert_true(enf_rooms_create(&rooms, &def, &error));
    Ground g;
    ground_open(&g, "rooms", rooms.map, 20, false);
    fly_about(&g, enf_test_rounds(200000, 2000000));
    walk_about(&g, enf_test_rounds(50000, 500000));
    ground_close(&g);
    enf_rooms_destroy(&rooms);
}

static EnfVec3 on_grid(EnfVec3 p) {
    return enf_grid_point(enf_grid_snap(p));
}

/* A closed box full of triangles of all sizes, slivers and needles among them, owned by cells with origins of their own. */
static EnfMaker *make_soup(EnfTestRng *rng, uint32_t count, EnfVec3 origin) {
    EnfMaker *maker = enf_maker_create();
    uint32_t cells[3];
    assert_non_null(maker);
    for (int i = 0; i < 3; i++) {
        EnfVec3 at = enf_add(origin, enf_v3((double)i * 7.0, 0.0, 0.0));
        assert_non_null(enf_maker_cell(maker, i == 0 ? "soup-room" : "bowl-room", at, &cells[i]));
        enf_maker_box(maker, cells[i], 0, (EnfBox3){at, enf_add(at, enf_v3(7.0, 8.0, 10.0))}, true);
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t owner = enf_test_below(rng, 3);
        EnfVec3 low = enf_add(origin, enf_v3((double)owner * 7.0, 0.0, 0.0)), corner[3];
        EnfVec3 middle = enf_add(low, random_point(rng, enf_v3(0, 0, 0), enf_v3(7, 8, 10)));
        double size = enf_test_chance(rng, 3) ? 3.0 : 0.5, thin = enf_test_chance(rng, 4) ? 0.001 : 1.0;
        EnfVec3 a = enf_scale(random_way(rng), size), b = enf_scale(random_way(rng), size * thin);
        corner[0] = on_grid(middle);
        corner[1] = on_grid(enf_add(middle, a));
        corner[2] = on_grid(enf_add(middle, enf_add(b, enf_scale(a, enf_test_double(rng, 0, 1)))));
        enf_maker_group(maker);
        enf_maker_polygon(maker, cells[owner], 0, corner, 3);
    }
    return maker;
}

static void test_soups(void **state) {
    (void)state;
    static const uint32_t counts[] = {20, 100, 300};
    for (int i = 0; i < 6; i++) {
        EnfTestRng rng = enf_test_rng(30 + (uint64_t)i);
        EnfMaker *maker = make_soup(&rng, counts[i % 3], i < 3 ? enf_v3(0, 0, 0) : enf_v3(-65536.0, 0.0, 9000.5));
        EnfError error = {0};
        const EnfMap *map = enf_maker_finish(maker, &error);
        if (map == NULL) {
            fail_msg("%s", error.message);
        }
        Ground g;
        ground_open(&g, "soup", map, 40 + (uint64_t)i, false);
        fly_about(&g, enf_test_rounds(60000, 600000));
        walk_about(&g, enf_test_rounds(10000, 100000));
        ground_close(&g);
        enf_maker_destroy(maker);
    }
}

/* A box that turns or slides somewhere in the soup, slowly or at a speed at which no door should. */
static void add_swing(Ground *g) {
    EnfTestRng *rng = &g->rng;
    EnfObjectDef def = enf_object_def_default();
    EnfVec3 half = random_point(rng, enf_v3(0.05, 0.05, 0.05), enf_v3(1.0, 1.0, 1.0));
    EnfVec3f corners[36];
    def.motion.kind = enf_test_chance(rng, 2) ? ENF_MOTION_HINGE : ENF_MOTION_SLIDE;
    EnfSwingMotion *swing = &def.motion.as.swing;
    memset(swing, 0, sizeof *swing);
    swing->rest = enf_pose_identity();
    swing->rest.position = random_point(rng, g->box.min, g->box.max);
    swing->pivot = enf_add(swing->rest.position, half);
    swing->axis = enf_test_chance(rng, 3) ? random_way(rng) : enf_v3(0.0, 1.0, 0.0);
    swing->high = enf_test_double(rng, 0.5, 3.0);
    swing->rate = enf_test_chance(rng, 4) ? 60.0 : enf_test_double(rng, 0.2, 4.0);
    def.local = (EnfBox3){enf_scale(half, -1.0), half};
    EnfObjectId id = enf_world_add(g->world, &def, NULL);
    enf_solid_box(def.local, corners);
    uint32_t number;
    EnfSolidDef solid = {id.index, corners, 12, {{-100, -100, -100}, {100, 100, 100}}};
    solid.bounds_ws = enf_test_chance(rng, 4) ? enf_box3_empty() : solid.bounds_ws; /* some roam */
    assert_int_equal(enf_collider_add(g->collider, &solid, &number, NULL), ENF_OK);
    g->swings[g->swing_count++] = (Swing){id.index, 0.0, swing->high};
}

static void test_moving_soup(void **state) {
    (void)state;
    for (int i = 0; i < 3; i++) {
        EnfTestRng rng = enf_test_rng(60 + (uint64_t)i);
        EnfMaker *maker = make_soup(&rng, 30, enf_v3(0, 0, 0));
        EnfError error = {0};
        const EnfMap *map = enf_maker_finish(maker, &error);
        assert_non_null(map);
        Ground g;
        ground_open(&g, "moving soup", map, 70 + (uint64_t)i, true);
        for (int k = 0; k < 60; k++) {
            add_swing(&g);
        }
        walk_about(&g, enf_test_rounds(10000, 200000));
        ground_close(&g);
        enf_maker_destroy(maker);
    }
}

/* ---- distance --------------------------------------------------------------------------------------------------- */

/* The distance that all rests on, against the general formulas; and its normal, by moving a little. */
static void test_distance(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(50);
    for (uint32_t i = 0; i < enf_test_rounds(200000, 2000000); i++) {
        EnfNearTriangle t;
        EnfOracleTriangle o;
        double size = enf_test_chance(&rng, 4) ? 0.01 : 2.0;
        double far = enf_test_double(&rng, 0, 3);
        EnfVec3 middle = enf_scale(random_way(&rng), far);
        memset(&t, 0, sizeof t);
        for (int k = 0; k < 3; k++) {
            EnfVec3 p = enf_add(middle, enf_scale(random_way(&rng), size));
            t.corner[k] = o.corner[k] = on_grid(k == 2 && enf_test_chance(&rng, 20) ? middle : p);
        }
        t.normal = enf_normalize(enf_cross(enf_sub(t.corner[1], t.corner[0]), enf_sub(t.corner[2], t.corner[0])));
        EnfCapsule capsule = {0.25, 0.5 + (enf_test_chance(&rng, 3) ? 0.0 : enf_test_double(&rng, 0, 2))};
        EnfNearest nearest;
        EnfVec3 zero = enf_v3(0.0, 0.0, 0.0);
        enf_nearest(&t, &capsule, zero, zero, &nearest);
        double expected = enf_oracle_distance(&o, &capsule, zero);
        if (!(fabs(nearest.distance - expected) < 1e-9)) {
            fail_msg("triangle %u: %.12g, but %.12g", i, nearest.distance, expected);
        }
        if (nearest.distance > 0.01) { /* a step along the normal leaves by its length: the gradient of a distance */
            double step = 1e-6, after = enf_oracle_distance(&o, &capsule, enf_scale(nearest.normal, step));
            assert_true(fabs(after - expected - step) < 1e-9);
        }
    }
}

/* ---- bits and memory -------------------------------------------------------------------------------------------- */

static uint64_t dice_walk(EnfCollider *collider, const EnfMap *map, EnfTestRng rng, uint32_t ticks) {
    EnfCharacterDef def = enf_character_def_default();
    EnfCharacter body;
    EnfCharacterInput input = {{0.0, 0.0, 0.0}, false, false, false, ENF_CHARACTER_WALK};
    uint64_t hash = ENF_HASH_START;
    (void)map;
    enf_collider_reset(collider);
    (void)enf_character_spawn(&body, collider, &def, enf_v3(3.0, 3.0, 5.0));
    for (uint32_t i = 0; i < ticks; i++) {
        input = random_input(&rng, &input);
        if (enf_test_chance(&rng, 60)) {
            body.velocity = random_blow(&rng);
        }
        enf_character_move(&body, collider, &input, NULL);
        hash = enf_hash64(hash, &body, sizeof body);
    }
    return hash;
}

/* The same dice give the same bits on every compiler and machine, whatever was gathered before; and when warm, no memory. */
static void test_same_bits_and_no_heap(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(1, 1);
    EnfMaker *maker = make_soup(&rng, 60, enf_v3(0, 0, 0));
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(maker, &error);
    assert_non_null(map);
    Purse purse = purse_with(PURSE_FULL);
    EnfAllocator allocator = purse_allocator(&purse);
    EnfCollider *collider, *other;
    assert_int_equal(enf_collider_create(&collider, map, NULL, &allocator, &error), ENF_OK);
    assert_int_equal(enf_collider_create(&other, map, NULL, NULL, &error), ENF_OK);
    uint64_t hash = dice_walk(collider, map, rng, 36000);
    purse.budget = 0; /* a call to the heap would fail now, and the sweep be refused: other bits */
    assert_true(dice_walk(collider, map, rng, 36000) == hash);
    assert_int_equal(purse.refused, 0);
    EnfCapsule capsule = {0.2, 1.0};
    EnfSweepHit hit;
    (void)enf_collide_sweep(other, &capsule, enf_v3(1, 1, 1), enf_v3(19, 6, 8), &hit);
    assert_true(dice_walk(other, map, rng, 36000) == hash);
    printf("hash of 36000 ticks: %016llx\n", (unsigned long long)hash);
    assert_true(hash == UINT64_C(0xe246389548ce4c9d)); /* of every compiler; new where walking is changed on purpose */
    enf_collider_destroy(collider);
    purse_assert_whole(&purse);
    enf_collider_destroy(other);
    enf_maker_destroy(maker);
}

/* Out of memory at every call: refused, and nothing is lost or leaks. */
static void test_without_memory(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng_fixed(2, 2);
    EnfMaker *maker = make_soup(&rng, 10, enf_v3(0, 0, 0));
    EnfError error = {0};
    const EnfMap *map = enf_maker_finish(maker, &error);
    assert_non_null(map);
    EnfWorld *world;
    EnfVec3f corners[36];
    uint32_t number;
    EnfCapsule capsule = {0.2, 1.0};
    EnfObjectDef def = enf_object_def_default();
    assert_int_equal(enf_world_create(&world, map, 1, NULL, &error), ENF_OK);
    enf_solid_box(def.local, corners);
    uint32_t not_made = 0, not_added = 0;
    EnfSolidDef solid = {enf_world_add(world, &def, &error).index, corners, 12, {{-1, -1, -1}, {1, 1, 1}}};
    for (uint32_t budget = 0; budget < 120; budget++) {
        Purse purse = purse_with(budget);
        EnfAllocator allocator = purse_allocator(&purse);
        EnfCollider *collider;
        EnfResult result = enf_collider_create(&collider, map, world, &allocator, &error);
        assert_int_equal(result, purse.refused ? ENF_ERROR_MEMORY : ENF_OK);
        assert_int_equal(collider != NULL, result == ENF_OK);
        not_made += result != ENF_OK;
        for (int i = 0; i < 20 && result == ENF_OK; i++) { /* as many as lists grow for */
            EnfResult added = enf_collider_add(collider, &solid, &number, &error);
            EnfSweepHit hit;
            assert_true(added == ENF_OK || (added == ENF_ERROR_MEMORY && purse.refused > 0));
            not_added += added != ENF_OK;
            (void)enf_collide_sweep(collider, &capsule, enf_v3(3.0, 3.0, 5.0), enf_v3(1.0, 0.0, 0.0), &hit);
            assert_true(hit.t >= 0.0 && hit.t <= 1.0);
        }
        enf_collider_destroy(collider);
        purse_assert_whole(&purse);
    }
    assert_true(not_made > 0 && not_made < 120 && not_added > 0);
    enf_world_destroy(world);
    enf_maker_destroy(maker);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_distance),
    cmocka_unit_test(test_soups),
    cmocka_unit_test(test_moving_soup),
    cmocka_unit_test(test_rooms),
    cmocka_unit_test(test_freedoom),
    cmocka_unit_test(test_palace),
    cmocka_unit_test(test_same_bits_and_no_heap),
    cmocka_unit_test(test_without_memory),
};

ENF_TEST_MAIN(tests)

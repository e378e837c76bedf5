/* Light through portals: what a straight ray reaches is lit, what no window shows is not. */
#include "compile/light_flow.h"
#include "harness/harness.h"

#include <enfilade/tolerances.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 4, CELLS = SIDE * SIDE, PORTALS_MAX = 4 * CELLS };

/* SIDE × SIDE rooms of 4 × 3 × 4 m in the plane, doors of random places and widths in every inner wall. */
typedef struct Rooms {
    EnfLayout layout;
    EnfLayoutCell cells[CELLS];
    EnfLayoutPortal portals[PORTALS_MAX];
    EnfGrid3 points[4 * PORTALS_MAX];
    double door[CELLS][2][3]; /* of the walls to the east and to the south: from, to, top; metres */
} Rooms;

static EnfGrid3 grid_of(double x, double y, double z) {
    return enf_grid_snap(enf_v3(x, y, z));
}

/* A half-portal through wall `axis` (0 east, 1 south) of room (x, z); `back` for the one that leads back. */
static void add_portal(Rooms *rooms, uint32_t x, uint32_t z, int axis, bool back) {
    EnfLayout *layout = &rooms->layout;
    EnfLayoutPortal *portal = &rooms->portals[layout->portal_count++];
    const double *door = rooms->door[z * SIDE + x][axis];
    double wall = 4.0 * ((axis == 0 ? x : z) + 1), start = 4.0 * (axis == 0 ? z : x);
    EnfGrid3 corners[4];
    for (int i = 0; i < 4; i++) {
        double along = start + (i == 1 || i == 2 ? door[1] : door[0]), y = i >= 2 ? door[2] : 0;
        corners[i] = axis == 0 ? grid_of(wall, y, along) : grid_of(along, y, wall);
    }
    uint32_t here = z * SIDE + x, there = axis == 0 ? here + 1 : here + SIDE;
    portal->source = back ? there : here;
    portal->target = back ? here : there;
    portal->name = "door";
    portal->twin = ENF_NONE;
    portal->point_first = layout->point_count;
    portal->point_count = 4;
    /* For a door in the east wall the corners, seen from the west, run clockwise: front to the west. */
    bool reverse = (axis == 0) != back;
    for (int i = 0; i < 4; i++) {
        layout->points[layout->point_count++] = corners[reverse ? 3 - i : i];
    }
}

static int compare_portals(const void *left, const void *right) {
    const EnfLayoutPortal *a = left, *b = right;
    return (a->source > b->source) - (a->source < b->source);
}

static void make_rooms(Rooms *rooms, EnfTestRng *rng) {
    memset(rooms, 0, sizeof *rooms);
    rooms->layout.cells = rooms->cells;
    rooms->layout.cell_count = CELLS;
    rooms->layout.portals = rooms->portals;
    rooms->layout.points = rooms->points;
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        for (int axis = 0; axis < 2; axis++) {
            double *door = rooms->door[cell][axis];
            door[0] = (double)enf_test_below(rng, 12) / 4.0 + 0.25;
            door[1] = door[0] + 0.5 + (double)enf_test_below(rng, 2) / 4.0;
            door[2] = 1.0 + (double)enf_test_below(rng, 8) / 4.0;
            uint32_t x = cell % SIDE, z = cell / SIDE;
            if (axis == 0 ? x + 1 < SIDE : z + 1 < SIDE) {
                add_portal(rooms, x, z, axis, false);
                add_portal(rooms, x, z, axis, true);
            }
        }
    }
    qsort(rooms->portals, rooms->layout.portal_count, sizeof *rooms->portals, compare_portals);
}

/* Can a straight line from `a` in its room get to `b` through the doors? */
static bool sees(const Rooms *rooms, EnfVec3 a, EnfVec3 b) {
    for (int axis = 0; axis < 2; axis++) {
        double from = axis == 0 ? a.x : a.z, to = axis == 0 ? b.x : b.z;
        int first = (int)floor(fmin(from, to) / 4.0) + 1, last = (int)floor(fmax(from, to) / 4.0);
        for (int wall = first; wall <= last; wall++) {
            double t = (4.0 * wall - from) / (to - from), y = a.y + t * (b.y - a.y);
            double along = axis == 0 ? a.z + t * (b.z - a.z) : a.x + t * (b.x - a.x);
            int other = (int)floor(along / 4.0);
            uint32_t room = axis == 0 ? (uint32_t)(other * SIDE + wall - 1) : (uint32_t)((wall - 1) * SIDE + other);
            const double *door = rooms->door[room][axis];
            double within = along - 4.0 * other;
            if (within < door[0] || within > door[1] || y > door[2]) {
                return false;
            }
        }
    }
    return true;
}

static uint32_t room_of(EnfVec3 p) {
    return (uint32_t)(p.z / 4.0) * SIDE + (uint32_t)(p.x / 4.0);
}

/* Is `p` lit, as the windows found say? */
static bool is_lit(const EnfLightFlow *flow, uint32_t cell, EnfVec3 light, EnfVec3 p) {
    EnfVec3 d = enf_sub(p, light);
    for (uint32_t i = 0; i < flow->windows.count; i++) {
        const EnfLightWindow *window = &flow->windows.data[i];
        bool inside = window->cell == cell;
        for (uint32_t k = 0; k < window->plane_count && inside; k++) {
            inside = enf_dot(window->planes[k], d) >= -ENF_TOL_LIGHT * enf_length(d);
        }
        if (inside) {
            return true;
        }
    }
    return false;
}

static EnfVec3 random_point(EnfTestRng *rng) {
    return enf_v3(enf_test_double(rng, 0.01, 4.0 * SIDE - 0.01), enf_test_double(rng, 0.01, 2.99),
                  enf_test_double(rng, 0.01, 4.0 * SIDE - 0.01));
}

/* ---- cases ------------------------------------------------------------------------------------------------------ */

static void what_is_seen_is_lit(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(1);
    uint32_t lit = 0, wrong = 0, seen = 0;
    for (uint32_t round = 0; round < enf_test_rounds(60, 2000); round++) {
        Rooms *rooms = malloc(sizeof *rooms);
        EnfLightFlow flow;
        make_rooms(rooms, &rng);
        assert_true(enf_light_flow_create(&flow, &rooms->layout));
        for (int k = 0; k < 5; k++) {
            EnfVec3 light = random_point(&rng);
            assert_true(enf_light_flow_run(&flow, room_of(light), light, 100));
            for (int i = 0; i < 400; i++) {
                EnfVec3 p = random_point(&rng);
                bool visible = sees(rooms, light, p), found = is_lit(&flow, room_of(p), light, p);
                if (visible && !found) {
                    fail_msg("light (%g %g %g) does not reach (%g %g %g)", light.x, light.y, light.z, p.x, p.y, p.z);
                }
                seen += visible;
                lit += found;
                wrong += found && !visible;
            }
        }
        enf_light_flow_free(&flow);
        free(rooms);
    }
    printf("%u points seen, %u lit, %u of these unseen\n", seen, lit, wrong);
    assert_true(seen > 0);
    assert_true(wrong * 10 < lit); /* windows merged and lamps in doorways light a little more, not much */
}

/* Beyond its range a light does not pass; a closed portal, it does; a mirror, it does not. */
static void limits(void **state) {
    (void)state;
    EnfTestRng rng = enf_test_rng(2);
    Rooms *rooms = malloc(sizeof *rooms);
    EnfLightFlow flow;
    make_rooms(rooms, &rng);
    assert_true(enf_light_flow_create(&flow, &rooms->layout));
    EnfVec3 light = {2, 1.5, 2};
    assert_true(enf_light_flow_run(&flow, 0, light, 1.0));
    assert_int_equal(flow.windows.count, 1);
    for (uint32_t i = 0; i < rooms->layout.portal_count; i++) {
        rooms->portals[i].flags |= ENF_PORTAL_CLOSED;
    }
    assert_true(enf_light_flow_run(&flow, 0, light, 20.0));
    assert_true(flow.windows.count > 2);
    for (uint32_t i = 0; i < rooms->layout.portal_count; i++) {
        rooms->portals[i].has_transform = true;
    }
    assert_true(enf_light_flow_run(&flow, 0, light, 20.0));
    assert_int_equal(flow.windows.count, 1);
    enf_light_flow_free(&flow);
    free(rooms);
}

/* Openings without polygon in a ring: the flow ends, and lights all of it whole. */
static void links_light_whole(void **state) {
    (void)state;
    enum { RING = 300 };
    EnfLayout layout = {0};
    layout.cells = calloc(RING, sizeof *layout.cells);
    layout.portals = calloc(2 * RING, sizeof *layout.portals);
    layout.cell_count = RING;
    for (uint32_t i = 0; i < RING; i++) {
        layout.portals[2 * i] = (EnfLayoutPortal){.source = i, .target = (i + 1) % RING, .flags = ENF_PORTAL_OVERLAP};
        layout.portals[2 * i + 1] = (EnfLayoutPortal){
            .source = i, .target = (i + RING - 1) % RING, .flags = ENF_PORTAL_OVERLAP};
    }
    layout.portal_count = 2 * RING;
    EnfLightFlow flow;
    assert_true(enf_light_flow_create(&flow, &layout));
    assert_true(enf_light_flow_run(&flow, 7, enf_v3(0, 0, 0), 5.0));
    assert_int_equal(flow.windows.count, RING);
    for (uint32_t i = 0; i < RING; i++) {
        assert_int_equal(flow.windows.data[i].plane_count, 0);
    }
    enf_light_flow_free(&flow);
    free(layout.cells);
    free(layout.portals);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_is_seen_is_lit),
    cmocka_unit_test(limits),
    cmocka_unit_test(links_light_whole),
};
ENF_TEST_MAIN(tests)

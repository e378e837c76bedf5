/* The scene of the experiments on moving objects: motions, and an eye that stands, walks through doors or jumps. */
#include "enfbench/movers.h"

#include <enfilade/tolerances.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- motions ---------------------------------------------------------------------------------------------------- */

/* Ticks since it set out there and back. */
static uint32_t on_cycle(const Mover *mover, int64_t tick) {
    uint32_t cycle = 2 * mover->period;
    uint64_t since = (uint64_t)tick + mover->phase;
    return since <= UINT32_MAX ? (uint32_t)since % cycle : (uint32_t)(since % cycle); /* the short division is fast */
}

/* Where on the way there and back, 0 to 3, a unit between two points. */
static double way(const Mover *mover, int64_t tick) {
    uint32_t at = on_cycle(mover, tick);
    at = at > mover->period ? 2 * mover->period - at : at;
    return 3.0 * ((double)at / (double)mover->period);
}

/* Catmull-Rom through the points, ends doubled; `slope` gets its derivative. */
static EnfVec3 smooth_at(const Mover *mover, double s, EnfVec3 *slope) {
    int k = s >= 2.0 ? 2 : (int)s;
    double t = s - (double)k;
    const float *p[4];
    for (int i = 0; i < 4; i++) {
        int n = k + i - 1;
        p[i] = mover->points[n < 0 ? 0 : n > 3 ? 3 : n];
    }
    double v[3];
    double d[3];
    for (int a = 0; a < 3; a++) {
        double p0 = (double)p[0][a], p1 = (double)p[1][a], p2 = (double)p[2][a], p3 = (double)p[3][a];
        double c3 = 0.5 * (3.0 * (p1 - p2) + p3 - p0);
        double c2 = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3;
        double c1 = 0.5 * (p2 - p0);
        v[a] = ((c3 * t + c2) * t + c1) * t + p1;
        d[a] = (3.0 * c3 * t + 2.0 * c2) * t + c1;
    }
    *slope = enf_v3(d[0], d[1], d[2]);
    return enf_v3(v[0], v[1], v[2]);
}

static EnfVec3 straight_at(const Mover *mover, double s) {
    int k = s >= 2.0 ? 2 : (int)s;
    double t = s - (double)k;
    const float *a = mover->points[k];
    const float *b = mover->points[k + 1];
    return enf_v3((double)a[0] + ((double)b[0] - (double)a[0]) * t, (double)a[1] + ((double)b[1] - (double)a[1]) * t,
                  (double)a[2] + ((double)b[2] - (double)a[2]) * t);
}

static bool is_smooth(const Mover *mover) {
    return mover->motion == MOVERS_SPLINE || mover->motion == MOVERS_CHARACTER;
}

EnfVec3 bench_mover_at(const Mover *mover, int64_t tick) {
    EnfVec3 slope;
    double s = way(mover, tick);
    return is_smooth(mover) ? smooth_at(mover, s, &slope) : straight_at(mover, s);
}

EnfVec3 bench_mover_step(const Mover *mover, int64_t tick, double *ticks) {
    uint32_t at = on_cycle(mover, tick);
    bool back = at >= mover->period;
    double leg = (double)mover->period / 3.0;
    double gone = (double)(back ? at - mover->period : at) / leg; /* from this end, 0 to 3 */
    int k = gone >= 2.0 ? 2 : (int)gone;
    *ticks = floor(((double)(k + 1) - gone) * leg);
    const float *a = mover->points[back ? 3 - k : k];
    const float *b = mover->points[back ? 2 - k : k + 1];
    return enf_v3(((double)b[0] - (double)a[0]) / leg, ((double)b[1] - (double)a[1]) / leg,
                  ((double)b[2] - (double)a[2]) / leg);
}

/* Thirty joints in a chain, each swinging: what a walking character costs. Answers a length, so that it must be worked out. */
static double skeleton(double s) {
    EnfQuat turn = {0.0, 0.0, 0.0, 1.0};
    double reach = 0.0;
    for (int joint = 0; joint < 30; joint++) {
        double swing = 0.1 * enf_sin(6.0 * s + 0.2 * (double)joint);
        EnfQuat local = enf_quat_axis_angle(enf_v3(1.0, 0.0, 0.0), swing);
        turn = enf_quat_mul(turn, local);
        reach += turn.w;
    }
    return reach;
}

/* A mesh whose vertices are turned one by one. Answers a length, so that it must be worked out. */
static double skin(uint32_t polygons, double s) {
    EnfQuat turn = enf_quat_axis_angle(enf_v3(0.0, 1.0, 0.0), s);
    EnfPose pose = enf_pose_identity();
    pose.rotation = turn;
    double least = 0.0;
    for (uint32_t i = 0; i < polygons; i++) {
        EnfVec3 p = enf_pose_point(&pose, enf_v3(0.1, (double)(i % 16) / 16.0, 0.2));
        least = p.y < least ? p.y : least;
    }
    return least;
}

EnfPose bench_mover_state(const void *user, int64_t tick) {
    const Mover *mover = user;
    EnfPose pose = enf_pose_identity();
    EnfVec3 slope = enf_v3(0.0, 0.0, 0.0);
    double s = way(mover, tick);
    if (is_smooth(mover)) {
        pose.position = smooth_at(mover, s, &slope);
        pose.rotation = enf_quat_axis_angle(enf_v3(0.0, 1.0, 0.0), enf_atan2(slope.x, slope.z));
    } else {
        pose.position = straight_at(mover, s);
    }
    if (mover->motion == MOVERS_CHARACTER) {
        double reach = skeleton(s);
        pose.position.y += reach > 30.5 ? reach : 0.0; /* never: cosines are not above 1 */
    }
    if (mover->polygons > 0) {
        double least = skin(mover->polygons, s);
        pose.position.y += least < -1.0 ? least : 0.0; /* never */
    }
    return pose;
}

EnfPose bench_mover_pose(const Mover *mover, int64_t tick) {
    Mover bare = *mover;
    bare.polygons = 0;
    bare.motion = bare.motion == MOVERS_CHARACTER ? MOVERS_SPLINE : bare.motion;
    return bench_mover_state(&bare, tick);
}

static EnfBox3 about(EnfVec3 p, double x, double y, double z) {
    EnfBox3 box = {enf_v3(p.x - x, p.y - y, p.z - z), enf_v3(p.x + x, p.y + y, p.z + z)};
    return box;
}

/* The hull of the points (of a curve's Bezier points: a third of a tangent about each), and no farther from where it is than its
 * speed allows. */
EnfBox3 bench_mover_bound(const void *user, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    (void)local;
    const Mover *mover = user;
    EnfBox3 whole = enf_box3_empty();
    for (int i = 0; i < 4; i++) {
        const float *p = mover->points[i];
        EnfVec3 at = enf_v3((double)p[0], (double)p[1], (double)p[2]);
        const float *before = mover->points[i > 0 ? i - 1 : 0];
        const float *after = mover->points[i < 3 ? i + 1 : 3];
        double k = is_smooth(mover) ? 1.0 / 6.0 : 0.0;
        whole = enf_box3_union(whole, about(at, k * fabs((double)after[0] - (double)before[0]),
                                            k * fabs((double)after[1] - (double)before[1]),
                                            k * fabs((double)after[2] - (double)before[2])));
    }
    double r = (double)mover->speed * (double)(tick1 - tick0) + 1e-6;
    EnfBox3 near = about(bench_mover_at(mover, tick0), r, r, r);
    EnfVec3 size = enf_v3(MOVER_REACH, MOVER_HEIGHT + 1e-6, MOVER_REACH);
    EnfBox3 out = {enf_v3(fmax(near.min.x, whole.min.x), fmax(near.min.y, whole.min.y), fmax(near.min.z, whole.min.z)),
                   enf_v3(fmin(near.max.x, whole.max.x), fmin(near.max.y, whole.max.y), fmin(near.max.z, whole.max.z))};
    out.min = enf_sub(out.min, size);
    out.max = enf_add(out.max, size);
    return out;
}

static EnfBox3 local_box(void) {
    EnfBox3 box = {{-MOVER_WIDTH, -MOVER_HEIGHT, -MOVER_WIDTH}, {MOVER_WIDTH, MOVER_HEIGHT, MOVER_WIDTH}};
    return box;
}

EnfBox3f bench_mover_box(const EnfPose *pose) {
    EnfMotion still;
    still.kind = ENF_MOTION_STILL;
    still.as.still = *pose;
    EnfBox3 local = local_box();
    return enf_box3f_outward(enf_motion_bound(&still, &local, 0, 0));
}

/* Evaluates the whole state first. */
static EnfBox3 evaluated_bound(const void *user, const EnfBox3 *local, int64_t tick0, int64_t tick1) {
    (void)local;
    const Mover *mover = user;
    EnfPose pose = bench_mover_state(mover, tick0);
    double r = (double)mover->speed * (double)(tick1 - tick0) + 1e-6;
    return about(pose.position, r + MOVER_REACH, r + MOVER_HEIGHT, r + MOVER_REACH);
}

/* What is seen of those whose bounds were made so in the same tick: nobody pays for polygons twice. */
static EnfPose evaluated_state(const void *user, int64_t tick) {
    return bench_mover_pose(user, tick);
}

EnfObjectDef bench_mover_object(const Mover *mover, bool evaluated) {
    EnfObjectDef def = enf_object_def_default();
    def.local = local_box();
    def.max_speed = (double)mover->speed * ENF_TICK_RATE;
    if (mover->motion == MOVERS_FREE) {
        def.motion.kind = ENF_MOTION_FREE;
        memset(&def.motion.as.free, 0, sizeof def.motion.as.free);
        def.motion.as.free.max_speed = def.max_speed;
        def.motion.as.free.ask = bench_mover_state;
        def.motion.as.free.user = mover;
        def.motion.as.free.confined = true; /* through doors alone */
    } else {
        def.motion.kind = ENF_MOTION_CALLBACK;
        def.motion.as.callback.state = evaluated ? evaluated_state : bench_mover_state;
        def.motion.as.callback.bound = evaluated ? evaluated_bound : bench_mover_bound;
        def.motion.as.callback.user = mover;
    }
    return def;
}

/* ---- placing ---------------------------------------------------------------------------------------------------- */

static double random_unit(uint64_t *state) {
    *state += UINT64_C(0x9e3779b97f4a7c15);
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static EnfVec3 place_in(const MoversScene *scene, uint32_t cell, uint64_t *seed) {
    EnfBox3 box = enf_rooms_box(&scene->rooms, cell);
    double x = box.min.x + 1.0 + (box.max.x - box.min.x - 2.0) * random_unit(seed);
    double z = box.min.z + 1.0 + (box.max.z - box.min.z - 2.0) * random_unit(seed);
    return enf_v3(x, box.min.y + 1.0, z);
}

/* The middle of a portal, at a height. */
static EnfVec3 door(const MoversScene *scene, uint32_t portal, double y) {
    const EnfMap *map = scene->rooms.map;
    const EnfPortal *p = &map->portals[portal];
    const double *o = map->cells[p->source].origin;
    EnfVec3 sum = enf_v3(0.0, 0.0, 0.0);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        sum = enf_add(sum, enf_v3_from_f(map->portal_vertices[p->vertex_first + v]));
    }
    sum = enf_scale(sum, 1.0 / (double)p->vertex_count);
    return enf_v3(sum.x + o[0], y, sum.z + o[2]);
}

static void set_point(Mover *mover, int i, EnfVec3 p) {
    mover->points[i][0] = (float)p.x;
    mover->points[i][1] = (float)p.y;
    mover->points[i][2] = (float)p.z;
}

/* The longest way between two points; of a curve, three times the longest step between its Bezier points is not longer. */
static double longest(const Mover *mover) {
    double most = 0.1;
    for (int i = 0; i < 3; i++) {
        double d2 = 0.0;
        for (int a = 0; a < 3; a++) {
            double d = (double)mover->points[i + 1][a] - (double)mover->points[i][a];
            d2 += d * d;
        }
        most = fmax(most, sqrt(d2));
    }
    /* Bezier steps: a tangent's third (at most a third of the longest way), or what is left between two of them. */
    return is_smooth(mover) ? 3.0 * (most + 2.0 * most / 3.0) : most;
}

/* `avoid`: rooms that it may not walk into, or NULL. */
static void make_mover(MoversScene *scene, Mover *mover, uint32_t cell, const bool *avoid, uint64_t *seed) {
    const EnfMap *map = scene->rooms.map;
    const EnfCell *c = &map->cells[cell];
    EnfVec3 a = place_in(scene, cell, seed);
    EnfVec3 b = place_in(scene, cell, seed);
    EnfVec3 way_in = enf_scale(enf_add(enf_scale(a, 2.0), b), 1.0 / 3.0);
    EnfVec3 way_out = enf_scale(enf_add(enf_scale(b, 2.0), a), 1.0 / 3.0);
    uint32_t portal = c->portal_first + (uint32_t)(random_unit(seed) * (double)c->portal_count);
    if (c->portal_count > 0 && (avoid == NULL || !avoid[map->portals[portal].target])) {
        EnfVec3 through = door(scene, portal, a.y);
        EnfBox3 box = enf_rooms_box(&scene->rooms, cell);
        EnfVec3 middle = enf_scale(enf_add(box.min, box.max), 0.5);
        bool along_x = fabs(through.x - middle.x) * (box.max.z - box.min.z) >
                       fabs(through.z - middle.z) * (box.max.x - box.min.x);
        double side = along_x ? (through.x > middle.x ? 0.5 : -0.5) : (through.z > middle.z ? 0.5 : -0.5);
        EnfVec3 out = along_x ? enf_v3(side, 0.0, 0.0) : enf_v3(0.0, 0.0, side);
        way_in = enf_sub(through, out);
        way_out = enf_add(through, out);
        b = place_in(scene, map->portals[portal].target, seed);
    }
    set_point(mover, 0, a);
    set_point(mover, 1, way_in);
    set_point(mover, 2, way_out);
    set_point(mover, 3, b);
    mover->motion = (uint8_t)scene->def.motion;
    mover->polygons = scene->def.polygons;
    double most = longest(mover);
    double ticks = ceil(3.0 * most / scene->def.speed * ENF_TICK_RATE);
    mover->period = ticks < 1.0 ? 1U : ticks > 1e9 ? 1000000000U : (uint32_t)ticks;
    mover->speed = (float)(1.001 * 3.0 * most / (double)mover->period + 1e-9);
    mover->phase = (uint32_t)(random_unit(seed) * 2.0 * (double)mover->period);
}

/* The rooms, those first that the eye sees on its way; how many these are. */
typedef struct Sides {
    bool *seen;      /* a cell */
    uint32_t *rooms; /* in two rows, each ascending */
    uint32_t seen_count, count;
} Sides;

/* False without memory. */
static bool make_sides(MoversScene *scene, uint32_t eye_cell, Sides *sides) {
    uint32_t cells = scene->rooms.map->cells_count;
    sides->count = cells < scene->def.rooms ? cells : scene->def.rooms;
    sides->seen_count = 0;
    sides->seen = calloc(cells + 1U, sizeof *sides->seen);
    sides->rooms = calloc(sides->count + 1U, sizeof *sides->rooms);
    if (sides->seen == NULL || sides->rooms == NULL) {
        return false;
    }
    sides->seen[eye_cell] = true;
    for (uint32_t f = 0; f < scene->def.frames; f++) {
        const EnfVisSet *set = enf_vis_run(scene->vis, &scene->portals, &scene->views[f]);
        for (uint32_t i = 0; i < set->visit_count; i++) {
            sides->seen[set->visits[i].cell] = true;
        }
    }
    uint32_t at = 0;
    for (uint32_t pass = 0; pass < 2; pass++) {
        for (uint32_t room = 0; room < sides->count; room++) {
            if (sides->seen[room] == (pass == 0)) {
                sides->rooms[at++] = room;
            }
        }
        sides->seen_count = pass == 0 ? at : sides->seen_count;
    }
    return true;
}

/* A room that is not seen; any, where all are. */
static uint32_t hidden_room(const Sides *sides, double random) {
    uint32_t first = sides->seen_count < sides->count ? sides->seen_count : 0;
    return sides->rooms[first + (uint32_t)(random * (double)(sides->count - first))];
}

/* Without a number of visible ones, everywhere alike. Else these stay in rooms that the eye sees on its way, as many in each, and the
 * others in rooms that it never sees: so the visible ones are the same however many are hidden. */
static bool make_movers(MoversScene *scene, uint32_t eye_cell) {
    const MoversDef *def = &scene->def;
    uint64_t seed = (uint64_t)def->seed * 1000003U + 17U;
    Sides sides = {NULL, NULL, 0, 0};
    bool *all = calloc(scene->rooms.map->cells_count + 1U, sizeof *all);
    bool ok = make_sides(scene, eye_cell, &sides) && all != NULL;
    if (ok && def->visible > 0 && def->visible < def->movers && sides.seen_count == sides.count) {
        fputs("enfbench: the eye sees every room on its way: there is none to hide movers in, and all walk in its sight\n",
              stderr);
    }
    for (uint32_t c = 0; c < scene->rooms.map->cells_count && ok; c++) {
        all[c] = true;
    }
    for (uint32_t i = 0; i < def->movers && ok; i++) {
        double random = random_unit(&seed);
        if (def->visible == 0) {
            make_mover(scene, &scene->movers[i], (uint32_t)(random * (double)sides.count), NULL, &seed);
        } else if (i < def->visible && sides.seen_count > 0) {
            uint32_t cell = def->eye == MOVERS_STILL ? eye_cell : sides.rooms[i % sides.seen_count];
            make_mover(scene, &scene->movers[i], cell, all, &seed);
        } else {
            make_mover(scene, &scene->movers[i], hidden_room(&sides, random), sides.seen, &seed);
        }
    }
    free(sides.seen);
    free(sides.rooms);
    free(all);
    return ok;
}

/* ---- the eye ---------------------------------------------------------------------------------------------------- */

static void look(MoversScene *scene, uint32_t frame, EnfVec3 eye, double yaw) {
    EnfView *view = &scene->views[frame];
    *view = enf_view_default();
    double t = (double)frame / ENF_TICK_RATE;
    /* Roll and pitch: an upright eye in a grid hides how loose boxes are. */
    EnfTurn turn = enf_turn(yaw + 40.0 * enf_sin(0.7 * t), 8.0 * enf_sin(0.9 * t), 10.0 * enf_sin(1.1 * t));
    view->camera = enf_camera(eye, turn, 60.0, 1280, 720);
    view->cell = enf_rooms_cell_at(&scene->rooms, eye);
}

/* From door to door, 1.5 m/s. */
static void walk(MoversScene *scene, uint32_t cell, uint64_t *seed) {
    const EnfMap *map = scene->rooms.map;
    EnfBox3 box = enf_rooms_box(&scene->rooms, cell);
    double height = box.min.y + 1.7;
    EnfVec3 eye = enf_v3(0.5 * (box.min.x + box.max.x), height, 0.5 * (box.min.z + box.max.z));
    EnfVec3 goal = eye;
    bool at_door = true;
    uint32_t portal = ENF_NONE;
    for (uint32_t f = 0; f < scene->def.frames; f++) {
        EnfVec3 to = enf_sub(goal, eye);
        double left = enf_length(to);
        if (left < 0.03) {
            const EnfCell *c = &map->cells[cell];
            if (at_door && c->portal_count > 0) {
                uint32_t next = c->portal_first + (uint32_t)(random_unit(seed) * (double)c->portal_count);
                bool back = portal != ENF_NONE && map->portals[portal].twin == next && c->portal_count > 1;
                portal = back ? (next + 1 < c->portal_first + c->portal_count ? next + 1 : c->portal_first) : next;
                goal = door(scene, portal, height);
                cell = map->portals[portal].target;
            } else {
                EnfBox3 room = enf_rooms_box(&scene->rooms, cell);
                goal = enf_v3(0.5 * (room.min.x + room.max.x), height, 0.5 * (room.min.z + room.max.z));
            }
            at_door = !at_door;
            to = enf_sub(goal, eye);
            left = enf_length(to);
        }
        if (left > 0.0) {
            eye = enf_add(eye, enf_scale(to, fmin(0.025, left) / left));
        }
        look(scene, f, eye, enf_atan2(-to.x, -to.z) * 180.0 / ENF_PI);
    }
}

static void make_views(MoversScene *scene, uint32_t cell) {
    uint64_t seed = (uint64_t)scene->def.seed * 77U + 5U;
    if (scene->def.eye == MOVERS_WALK) {
        walk(scene, cell, &seed);
        return;
    }
    EnfVec3 eye = place_in(scene, cell, &seed);
    double yaw = 360.0 * random_unit(&seed);
    for (uint32_t f = 0; f < scene->def.frames; f++) {
        if (scene->def.eye == MOVERS_JUMP && f % 60 == 59) {
            eye = place_in(scene, (uint32_t)(random_unit(&seed) * (double)scene->def.rooms), &seed);
            yaw = 360.0 * random_unit(&seed);
        }
        eye.y = 1.7;
        look(scene, f, eye, yaw);
    }
}

/* ---- scenes ----------------------------------------------------------------------------------------------------- */

void bench_movers_close(MoversScene *scene) {
    enf_free(NULL, scene->movers, scene->def.movers, sizeof *scene->movers);
    free(scene->views);
    enf_vis_destroy(scene->vis);
    enf_portals_destroy(&scene->portals);
    if (scene->rooms.maker != NULL) {
        enf_rooms_destroy(&scene->rooms);
    }
}

bool bench_movers_open(MoversScene *scene, const MoversDef *def) {
    memset(scene, 0, sizeof *scene);
    scene->def = *def;
    EnfRoomsDef rooms = enf_rooms_def_default();
    for (rooms.nx = 1; rooms.nx * rooms.nx < def->rooms; rooms.nx++) {
    }
    rooms.nz = (def->rooms + rooms.nx - 1) / rooms.nx;
    scene->def.rooms = rooms.nx * rooms.nz;
    rooms.room = enf_v3(8.0, 3.0, 8.0);
    rooms.door_width = def->door_width;
    rooms.door_height = 2.25;
    rooms.door_percent = (uint32_t)def->doors;
    rooms.furniture = def->furniture;
    rooms.lights = false;
    rooms.seed = def->seed;
    EnfError error = {ENF_OK, 0, "", ""};
    bool ok = enf_rooms_create(&scene->rooms, &rooms, &error);
    ok = ok && enf_portals_create(&scene->portals, scene->rooms.map, NULL, &error) == ENF_OK;
    ok = ok && enf_vis_create(&scene->vis, scene->rooms.map, NULL, &error) == ENF_OK;
    scene->movers = enf_alloc(NULL, def->movers, sizeof *scene->movers);
    scene->views = calloc(def->frames, sizeof *scene->views);
    if (!ok || !scene->movers || !scene->views) {
        fprintf(stderr, "enfbench: %s\n", ok ? "out of memory" : error.message);
        bench_movers_close(scene);
        return false;
    }
    uint32_t cell = (rooms.nz / 2) * rooms.nx + rooms.nx / 2;
    make_views(scene, cell);
    if (!make_movers(scene, cell)) {
        fputs("enfbench: out of memory\n", stderr);
        bench_movers_close(scene);
        return false;
    }
    return true;
}

/* ---- windows ---------------------------------------------------------------------------------------------------- */

bool bench_movers_windows(const MoversScene *scene, const EnfVisSet *set, MoversWindows *windows) {
    const EnfMap *map = scene->rooms.map;
    if (set->visit_count > windows->capacity) {
        MoversWindow *items = realloc(windows->items, set->visit_count * 2U * sizeof *items);
        if (items == NULL) {
            return false;
        }
        windows->items = items;
        windows->capacity = set->visit_count * 2U;
    }
    windows->count = set->visit_count;
    for (uint32_t i = 0; i < set->visit_count; i++) {
        const EnfVisit *visit = &set->visits[i];
        const EnfCell *c = &map->cells[visit->cell];
        EnfBox3f bounds = {{c->min[0], c->min[1], c->min[2]}, {c->max[0], c->max[1], c->max[2]}};
        windows->items[i].cell = visit->cell;
        enf_pyramid(&set->cameras[visit->space], visit->window, NULL, enf_v3(c->origin[0], c->origin[1], c->origin[2]), bounds,
                    &windows->items[i].pyramid);
    }
    return true;
}

bool bench_movers_shown(const MoversScene *scene, const MoversWindows *windows, EnfBox3f box) {
    const EnfMap *map = scene->rooms.map;
    for (uint32_t i = 0; i < windows->count; i++) {
        const MoversWindow *window = &windows->items[i];
        if (enf_world_touches(map, window->cell, box) &&
            enf_pyramid_box(&window->pyramid, enf_world_box_in_cell(map, window->cell, box))) {
            return true;
        }
    }
    return false;
}

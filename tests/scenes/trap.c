/* Three rooms that mean harm (trap.h). */
#include "scenes/trap.h"

#include <string.h>

typedef struct Trap {
    EnfMaker *maker;
    uint32_t pit, mill, press;
    uint32_t doorway, gate; /* half-portals out of the pit, out of the mill */
} Trap;

static void quad(EnfMaker *m, uint32_t cell, EnfVec3 a, EnfVec3 b, EnfVec3 c, EnfVec3 d) {
    const EnfVec3 points[4] = {a, b, c, d};
    enf_maker_polygon(m, cell, 0, points, 4);
}

/* A floor over x0..x1, z0..z1. */
static void floor_of(EnfMaker *m, uint32_t cell, const double x[2], const double z[2]) {
    quad(m, cell, enf_v3(x[0], 0, z[0]), enf_v3(x[0], 0, z[1]), enf_v3(x[1], 0, z[1]), enf_v3(x[1], 0, z[0]));
}

static void ceiling_of(EnfMaker *m, uint32_t cell, EnfVec3 low, EnfVec3 high) {
    quad(m, cell, enf_v3(low.x, high.y, low.z), enf_v3(high.x, high.y, low.z), enf_v3(high.x, high.y, high.z),
         enf_v3(low.x, high.y, high.z));
}

/* A floor that lies lower, and what leads down to it. */
static void sunken(EnfMaker *m, uint32_t cell, EnfBox3 box) {
    const EnfVec3 a = box.min, b = box.max;
    quad(m, cell, enf_v3(a.x, a.y, a.z), enf_v3(a.x, a.y, b.z), enf_v3(b.x, a.y, b.z), enf_v3(b.x, a.y, a.z));
    quad(m, cell, enf_v3(a.x, a.y, a.z), enf_v3(b.x, a.y, a.z), enf_v3(b.x, b.y, a.z), enf_v3(a.x, b.y, a.z));
    quad(m, cell, enf_v3(b.x, a.y, a.z), enf_v3(b.x, a.y, b.z), enf_v3(b.x, b.y, b.z), enf_v3(b.x, b.y, a.z));
    quad(m, cell, enf_v3(b.x, a.y, b.z), enf_v3(a.x, a.y, b.z), enf_v3(a.x, b.y, b.z), enf_v3(b.x, b.y, b.z));
    quad(m, cell, enf_v3(a.x, a.y, b.z), enf_v3(a.x, a.y, a.z), enf_v3(a.x, b.y, a.z), enf_v3(a.x, b.y, b.z));
}

/* An upright wall from a to b, `high` high, the room to the left of the way; with a hole of 1 m by 2 m from `hole` on, or none (< 0). */
static void wall(EnfMaker *m, uint32_t cell, const EnfVec3 ends[2], double high, double hole) {
    EnfVec3 way = enf_sub(ends[1], ends[0]);
    double length = enf_length(way);
    EnfVec3 along = enf_scale(way, 1.0 / length);
    const double from[3] = {0.0, hole, hole + 1.0}, low[3] = {0.0, 2.0, 0.0};
    const double to[3] = {hole < 0.0 ? length : hole, hole + 1.0, length};
    for (int i = 0; i < (hole < 0.0 ? 1 : 3); i++) {
        EnfVec3 p = enf_add(ends[0], enf_scale(along, from[i])), q = enf_add(ends[0], enf_scale(along, to[i]));
        if (high > low[i]) {
            quad(m, cell, enf_v3(p.x, low[i], p.z), enf_v3(q.x, low[i], q.z), enf_v3(q.x, high, q.z), enf_v3(p.x, high, p.z));
        }
    }
}

/* Walls of a room in the order of its corners: -z, +x, +z, -x; holes from the wall's beginning, or -1. */
static void walls(EnfMaker *m, uint32_t cell, EnfVec3 low, EnfVec3 high, const double holes[4]) {
    const EnfVec3 corners[4] = {{low.x, 0, low.z}, {high.x, 0, low.z}, {high.x, 0, high.z}, {low.x, 0, high.z}};
    for (int i = 0; i < 4; i++) {
        const EnfVec3 ends[2] = {corners[i], corners[(i + 1) % 4]};
        wall(m, cell, ends, high.y, holes[i]);
    }
}

static void make_rooms(Trap *trap) {
    EnfMaker *m = trap->maker;
    enf_maker_cell(m, "pit-room", enf_v3(0, 0, 0), &trap->pit);
    enf_maker_group(m);
    floor_of(m, trap->pit, (const double[2]){0, 3}, (const double[2]){0, 6});
    floor_of(m, trap->pit, (const double[2]){3, 6}, (const double[2]){0, 3});
    sunken(m, trap->pit, (EnfBox3){{3, -0.5, 3}, {6, 0, 6}});
    ceiling_of(m, trap->pit, enf_v3(0, 0, 0), enf_v3(6, 3, 6));
    walls(m, trap->pit, enf_v3(0, 0, 0), enf_v3(6, 3, 6), (const double[4]){-1, 1, -1, 4});
    enf_maker_cell(m, "mill-room", enf_v3(6, 0, 0), &trap->mill);
    enf_maker_group(m);
    floor_of(m, trap->mill, (const double[2]){6, 12}, (const double[2]){0, 6});
    ceiling_of(m, trap->mill, enf_v3(6, 0, 0), enf_v3(12, 3, 6));
    walls(m, trap->mill, enf_v3(6, 0, 0), enf_v3(12, 3, 6), (const double[4]){-1, -1, 3, 4});
    enf_maker_cell(m, "press-room", enf_v3(6, 0, 6), &trap->press);
    enf_maker_group(m);
    floor_of(m, trap->press, (const double[2]){6, 12}, (const double[2]){6, 12});
    ceiling_of(m, trap->press, enf_v3(6, 0, 6), enf_v3(12, 2, 12));
    walls(m, trap->press, enf_v3(6, 0, 6), enf_v3(12, 2, 12), (const double[4]){2, 2, -1, -1});
}

/* Portals' numbers; the map's half-portals by cell: the pit's own first. */
static void make_portals(Trap *trap) {
    EnfMaker *m = trap->maker;
    const EnfVec3 doorway[4] = {{6, 0, 1}, {6, 2, 1}, {6, 2, 2}, {6, 0, 2}};
    const EnfVec3 gate[4] = {{8, 0, 6}, {9, 0, 6}, {9, 2, 6}, {8, 2, 6}};
    enf_maker_portal(m, "doorway", trap->pit, trap->mill, doorway, 4, 0);
    enf_maker_portal(m, "gate", trap->mill, trap->press, gate, 4, 0);
    const EnfVec3 away[4] = {{12, 0, 8}, {12, 2, 8}, {12, 2, 9}, {12, 0, 9}};
    const EnfVec3 home[4] = {{0, 0, 2}, {0, 2, 2}, {0, 2, 1}, {0, 0, 1}};
    EnfAffine shift = enf_affine_identity(), back = enf_affine_identity();
    shift.t = enf_v3(-12, 0, -7);
    back.t = enf_v3(12, 0, 7);
    uint32_t one = enf_maker_teleport(m, trap->press, trap->pit, away, 4, &shift, ENF_NONE);
    enf_maker_teleport(m, trap->pit, trap->press, home, 4, &back, one);
    trap->doorway = 0; /* half-portals stand by their source, and those with a transform behind: the pit's */
    trap->gate = 2;    /* the mill's, behind its twin of the doorway */
}

/* ---- what moves ------------------------------------------------------------------------------------------------- */

static uint32_t entity(EnfMaker *m, const char *classname, EnfVec3 at, uint32_t cell, const char *extras) {
    EnfEntity e;
    memset(&e, 0, sizeof e);
    e.translation[0] = at.x, e.translation[1] = at.y, e.translation[2] = at.z;
    e.rotation[3] = e.scale[0] = e.scale[1] = e.scale[2] = 1.0f;
    e.name = e.classname = enf_maker_string(m, classname);
    e.extras = enf_maker_string(m, extras);
    e.parent = e.camera = e.light = ENF_NONE;
    e.cell = cell;
    return enf_maker_entity(m, &e);
}

static EnfMover mover(EnfMaker *m, EnfMoverKind kind, uint32_t of, EnfBox3 box) {
    EnfMover made = enf_maker_mover_default();
    made.kind = kind;
    made.entity = of;
    made.mesh = enf_maker_mesh(m, "iron", 0, box);
    made.flags = ENF_MOVER_SOLID;
    return made;
}

/* A track of `keys` keys: times, then values. */
static uint32_t track(EnfMaker *m, const EnfMover *of, EnfPath path, const float *floats, uint32_t components) {
    path.name = enf_maker_string(m, "round");
    path.entity = of->entity;
    return enf_maker_path(m, &path, floats, path.key_count * (1 + components * (path.kind == ENF_PATH_CUBIC ? 3u : 1u)));
}

static EnfPath path_of(EnfPathTarget target, EnfPathKind kind, uint32_t keys) {
    EnfPath path;
    memset(&path, 0, sizeof path);
    path.target = target;
    path.kind = kind;
    path.key_count = keys;
    return path;
}

static void add_ram(Trap *trap) {
    EnfMaker *m = trap->maker;
    uint32_t e = entity(m, "func_train", enf_v3(3, 1, 2), trap->pit, "");
    EnfMover ram = mover(m, ENF_MOVER_PATH, e, (EnfBox3){{-0.75, -0.75, -0.75}, {0.75, 0.75, 0.75}});
    const float way[] = {0.0f, 0.5f, -2, 0.875f, 2, 8, 0.875f, 2};
    ram.translation = track(m, &ram, path_of(ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 2), way, 3);
    ram.seconds = 0.5f;
    ram.wrap = ENF_WRAP_PING_PONG;
    enf_maker_mover(m, &ram);
}

/* Half a turn in a quarter of a second, and the one that breathes. */
static void add_beams(Trap *trap) {
    EnfMaker *m = trap->maker;
    const float turn[] = {0, 0.25f, 0.5f, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, -1};
    for (int i = 0; i < 2; i++) {
        uint32_t e = entity(m, "func_rotating", enf_v3(9, 0.75 + 1.25 * i, 3), trap->mill, "");
        EnfMover beam = mover(m, ENF_MOVER_PATH, e, (EnfBox3){{-2.5, -0.125, -0.25}, {2.5, 0.125, 0.25}});
        beam.rotation = track(m, &beam, path_of(ENF_PATH_ROTATION, i ? ENF_PATH_STEP : ENF_PATH_LINEAR, 3), turn, 4);
        beam.seconds = 0.5f;
        beam.wrap = ENF_WRAP_LOOP;
        beam.phase = i ? 0.125f : 0.0f;
        if (i) {
            const float breath[] = {0, 0.5f, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0.25f, 4, 1, 0, 0, 0};
            beam.scale = track(m, &beam, path_of(ENF_PATH_SCALE, ENF_PATH_CUBIC, 2), breath, 3);
        }
        enf_maker_mover(m, &beam);
    }
}

static void add_press(Trap *trap) {
    EnfMaker *m = trap->maker;
    uint32_t e = entity(m, "func_train", enf_v3(9, 2, 9), trap->press, "");
    EnfMover press = mover(m, ENF_MOVER_PATH, e, (EnfBox3){{-2, -0.25, -2}, {2, 0.25, 2}});
    const float way[] = {0.0f, 0.25f, 0.5f, 9, 2, 9, 9, 0.25f, 9, 9, 2, 9};
    press.translation = track(m, &press, path_of(ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 3), way, 3);
    press.seconds = 0.5f;
    press.wrap = ENF_WRAP_LOOP;
    enf_maker_mover(m, &press);
    e = entity(m, "func_plat", enf_v3(11, 0, 11), trap->press, "{\"targetname\":\"lift\",\"stops\":\"0,1.5\"}");
    EnfMover lift = mover(m, ENF_MOVER_SLIDE, e, (EnfBox3){{-0.75, -0.125, -0.75}, {0.75, 0.125, 0.75}});
    lift.high = 1.5f;
    lift.rate = 8.0f;
    enf_maker_mover(m, &lift);
    e = entity(m, "func_button", enf_v3(10.5, 1.25, 11.875), trap->press, "{\"target\":\"lift\",\"stop\":1}");
    EnfMover button = mover(m, ENF_MOVER_STILL, e, (EnfBox3){{-0.0625, -0.0625, -0.0625}, {0.0625, 0.0625, 0.0625}});
    enf_maker_mover(m, &button);
}

static void add_doors(Trap *trap) {
    EnfMaker *m = trap->maker;
    uint32_t e = entity(m, "func_door_rotating", enf_v3(6, 0, 1), trap->pit, "{\"targetname\":\"leaf\"}");
    EnfMover leaf = mover(m, ENF_MOVER_HINGE, e, (EnfBox3){{-0.03125, 0, 0}, {0.03125, 2, 1}});
    leaf.pivot[0] = 6, leaf.pivot[2] = 1;
    leaf.low = -1.5f, leaf.high = 1.5f, leaf.rate = 20.0f;
    leaf.portal = trap->doorway;
    enf_maker_mover(m, &leaf);
    e = entity(m, "func_door", enf_v3(8, 0, 6), trap->mill, "{\"targetname\":\"gate\",\"locked\":\"iron\"}");
    EnfMover gate = mover(m, ENF_MOVER_SLIDE, e, (EnfBox3){{0, 0, -0.0625}, {1, 2, 0.0625}});
    gate.axis[0] = 1.0f, gate.axis[1] = 0.0f;
    gate.high = 1.0f, gate.rate = 10.0f;
    gate.portal = trap->gate;
    gate.flags |= ENF_MOVER_LOCKED;
    enf_maker_mover(m, &gate);
}

static void add_things(Trap *trap) {
    EnfMaker *m = trap->maker;
    const EnfBox3 small = {{-0.125, 0, -0.125}, {0.125, 0.25, 0.125}};
    entity(m, "info_player_start", enf_v3(1, 0, 1), trap->pit, "");
    entity(m, "trigger_exit", enf_v3(1, 0, 5), trap->pit, "");
    uint32_t e = entity(m, "item_key", enf_v3(4, 0.5, 1), trap->pit, "{\"targetname\":\"key\",\"key\":\"iron\"}");
    EnfMover key = mover(m, ENF_MOVER_STILL, e, small);
    key.flags = ENF_MOVER_CARRY;
    enf_maker_mover(m, &key);
    e = entity(m, "prop_exhibit", enf_v3(11, 0.5, 1), trap->mill, "{\"targetname\":\"vase\",\"value\":3}");
    EnfMover vase = mover(m, ENF_MOVER_STILL, e, small);
    vase.flags = ENF_MOVER_CARRY;
    enf_maker_mover(m, &vase);
    e = entity(m, "npc_guard", enf_v3(7, 0, 5), trap->mill, "{\"targetname\":\"guard\"}");
    EnfMover guard = mover(m, ENF_MOVER_PATH, e, (EnfBox3){{-0.25, 0, -0.25}, {0.25, 1.75, 0.25}});
    const float way[] = {0, 3, 7, 0, 5, 2, 0, 5};
    guard.translation = track(m, &guard, path_of(ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 2), way, 3);
    guard.seconds = 3.0f;
    guard.wrap = ENF_WRAP_PING_PONG;
    guard.max_speed = 4.5f;
    enf_maker_mover(m, &guard);
}

EnfMaker *enf_trap_create(EnfError *error) {
    Trap trap;
    memset(&trap, 0, sizeof trap);
    trap.maker = enf_maker_create();
    if (!trap.maker) {
        enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a trap");
        return NULL;
    }
    make_rooms(&trap);
    make_portals(&trap);
    add_ram(&trap);
    add_beams(&trap);
    add_press(&trap);
    add_doors(&trap);
    add_things(&trap);
    if (!enf_maker_finish(trap.maker, error)) {
        enf_maker_destroy(trap.maker);
        return NULL;
    }
    return trap.maker;
}

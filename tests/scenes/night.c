/* Two rooms, a door, a vase, a guard (night.h). */
#include "scenes/night.h"

#include <stdio.h>
#include <string.h>

static void quad(EnfMaker *m, uint32_t cell, EnfVec3 a, EnfVec3 b, EnfVec3 c, EnfVec3 d) {
    const EnfVec3 points[4] = {a, b, c, d};
    enf_maker_polygon(m, cell, 0, points, 4);
}

/* A wall in the plane x = 8 between z0 and z1, y0 and y1, seen from the room that lies on `side` of it. */
static void wall(EnfMaker *m, uint32_t cell, double side, const double z[2], const double y[2]) {
    EnfVec3 a = enf_v3(8, y[0], z[0]), b = enf_v3(8, y[1], z[0]), c = enf_v3(8, y[1], z[1]), d = enf_v3(8, y[0], z[1]);
    side > 0.0 ? quad(m, cell, a, b, c, d) : quad(m, cell, d, c, b, a);
}

static uint32_t room(EnfMaker *m, const char *name, double x, double door_side) {
    uint32_t cell = 0;
    enf_maker_cell(m, name, enf_v3(x, 0, 0), &cell);
    enf_maker_group(m);
    const double x0 = x, x1 = x + 8, h = 6, l = 8;
    quad(m, cell, enf_v3(x0, 0, 0), enf_v3(x0, 0, l), enf_v3(x1, 0, l), enf_v3(x1, 0, 0));
    quad(m, cell, enf_v3(x0, h, 0), enf_v3(x1, h, 0), enf_v3(x1, h, l), enf_v3(x0, h, l));
    quad(m, cell, enf_v3(x0, 0, 0), enf_v3(x1, 0, 0), enf_v3(x1, h, 0), enf_v3(x0, h, 0));
    quad(m, cell, enf_v3(x0, 0, l), enf_v3(x0, h, l), enf_v3(x1, h, l), enf_v3(x1, 0, l));
    if (door_side < 0.0) {
        quad(m, cell, enf_v3(x0, 0, 0), enf_v3(x0, h, 0), enf_v3(x0, h, l), enf_v3(x0, 0, l));
    } else {
        quad(m, cell, enf_v3(x1, 0, 0), enf_v3(x1, 0, l), enf_v3(x1, h, l), enf_v3(x1, h, 0));
    }
    wall(m, cell, door_side, (const double[2]){0, 3.5}, (const double[2]){0, 6});
    wall(m, cell, door_side, (const double[2]){4.5, 8}, (const double[2]){0, 6});
    wall(m, cell, door_side, (const double[2]){3.5, 4.5}, (const double[2]){2.25, 6});
    return cell;
}

static uint32_t entity(EnfMaker *m, const char *classname, EnfVec3 at, uint32_t cell, const char *extras) {
    EnfEntity e;
    memset(&e, 0, sizeof e);
    e.translation[0] = at.x, e.translation[1] = at.y, e.translation[2] = at.z;
    e.rotation[3] = e.scale[0] = e.scale[1] = e.scale[2] = 1.0f;
    e.name = enf_maker_string(m, classname);
    e.classname = enf_maker_string(m, classname);
    e.extras = enf_maker_string(m, extras);
    e.parent = e.camera = e.light = ENF_NONE;
    e.cell = cell;
    return enf_maker_entity(m, &e);
}

static EnfMover mover(EnfMaker *m, EnfMoverKind kind, uint32_t of, EnfBox3 box, const char *mesh) {
    EnfMover made = enf_maker_mover_default();
    made.kind = kind;
    made.entity = of;
    made.mesh = enf_maker_mesh(m, mesh, 0, box);
    return made;
}

static void add_door(EnfNight *night, bool locked, bool swings) {
    EnfMaker *m = night->maker;
    const char *extras = locked ? "{\"targetname\":\"door\",\"locked\":\"brass\"}" : "{\"targetname\":\"door\"}";
    uint32_t e = entity(m, "func_door_rotating", enf_v3(8, 0, 3.5), night->west, extras);
    EnfMover door = mover(m, ENF_MOVER_HINGE, e, (EnfBox3){{-0.03125, 0, 0}, {0.03125, 2.25, 1}}, "leaf");
    door.pivot[0] = 8, door.pivot[2] = 3.5;
    door.high = 1.5f;
    door.low = swings ? -1.5f : 0.0f;
    door.rate = 2.0f;
    door.portal = night->portal;
    door.flags = ENF_MOVER_SOLID | (locked ? (uint32_t)ENF_MOVER_LOCKED : 0u);
    enf_maker_mover(m, &door);
    if (locked) {
        e = entity(m, "item_key", enf_v3(2, 0.8, 6.5), night->west, "{\"targetname\":\"key\",\"key\":\"brass\"}");
        EnfMover key = mover(m, ENF_MOVER_STILL, e, (EnfBox3){{-0.125, 0, -0.125}, {0.125, 0.125, 0.125}}, "key");
        key.flags = ENF_MOVER_CARRY;
        enf_maker_mover(m, &key);
    }
}

/* There and back, turned to where it walks: the turns are the path's too. */
static void add_guard(EnfNight *night) {
    EnfMaker *m = night->maker;
    uint32_t e = entity(m, "npc_guard", enf_v3(13, 0, 1), night->east, "{\"targetname\":\"guard\",\"max_speed\":\"4.5\"}");
    EnfMover guard = mover(m, ENF_MOVER_PATH, e, (EnfBox3){{-0.25, 0, -0.25}, {0.25, 1.75, 0.25}}, "guard");
    const float way[] = {0, 8, 16, 13, 0, 1, 13, 0, 7, 13, 0, 1};
    const float turn[] = {0, 8, 16, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0};
    EnfPath path = {enf_maker_string(m, "round"), e, ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 3, 0};
    guard.translation = enf_maker_path(m, &path, way, 12);
    path.target = ENF_PATH_ROTATION;
    path.kind = ENF_PATH_STEP;
    guard.rotation = enf_maker_path(m, &path, turn, 15);
    guard.seconds = 16.0f;
    guard.wrap = ENF_WRAP_LOOP;
    guard.max_speed = 4.5f;
    guard.flags = ENF_MOVER_SOLID;
    enf_maker_mover(m, &guard);
}

static void add_lift(EnfNight *night) {
    EnfMaker *m = night->maker;
    uint32_t e = entity(m, "func_plat", enf_v3(6, 0, 7), night->west, "{\"targetname\":\"lift\",\"stops\":\"0,2\"}");
    EnfMover lift = mover(m, ENF_MOVER_SLIDE, e, (EnfBox3){{-0.75, -0.125, -0.75}, {0.75, 0.125, 0.75}}, "plate");
    lift.high = 2.0f;
    lift.flags = ENF_MOVER_SOLID;
    enf_maker_mover(m, &lift);
    e = entity(m, "func_button", enf_v3(7.9, 1.2, 7.9), night->west,
               "{\"targetname\":\"button\",\"target\":\"lift\",\"stop\":1}");
    EnfMover button = mover(m, ENF_MOVER_STILL, e, (EnfBox3){{-0.0625, -0.0625, -0.0625}, {0.0625, 0.0625, 0.0625}}, "button");
    enf_maker_mover(m, &button);
}

static void add_stage(EnfNight *night) {
    EnfMaker *m = night->maker;
    enf_maker_group(m);
    enf_maker_box(m, night->west, 0, (EnfBox3){{0, 0, 5.5}, {2.5, 1.5, 8}}, false);
    for (int i = 0; i < 4; i++) {
        double x = 4.1 - 0.4 * i;
        enf_maker_box(m, night->west, 0, (EnfBox3){{x - 0.4, 0, 5.5}, {x, 0.3 * (i + 1), 8}}, false);
    }
    enf_maker_box(m, night->west, 0, (EnfBox3){{6, 0, 2}, {6.1, 1.5, 6}}, false);
}

bool enf_night_create(EnfNight *night, const EnfNightDef *def, EnfError *error) {
    memset(night, 0, sizeof *night);
    EnfMaker *m = night->maker = enf_maker_create();
    if (!m) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a night") == ENF_OK;
    }
    night->west = room(m, "west-room", 0, -1.0);
    if (def->stage) {
        add_stage(night);
    }
    if (def->lamps) {
        enf_maker_light(m, night->west, enf_v3(4, 2.75, 4), (EnfVec3f){20, 20, 20}, 20.0f);
    }
    night->east = room(m, "east-room", 8, 1.0);
    if (def->lamps) {
        enf_maker_light(m, night->east, enf_v3(12, 2.75, 4), (EnfVec3f){20, 20, 20}, 20.0f);
    }
    const EnfVec3 points[4] = {{8, 0, 3.5}, {8, 2.25, 3.5}, {8, 2.25, 4.5}, {8, 0, 4.5}};
    enf_maker_portal(m, "doorway", night->west, night->east, points, 4, 0);
    night->portal = 0; /* half-portals stand by their source: the west's only one comes first */
    entity(m, "info_player_start", enf_v3(2, 0, 4), night->west, "");
    entity(m, "trigger_exit", enf_v3(1, 0, 1), night->west, "");
    if (def->sounds) {
        entity(m, "fountain", enf_v3(4, 0, 7), night->west, "{\"sound\":\"fountain\"}");
        entity(m, "clock", enf_v3(14, 2, 6), night->east, "{\"sound\":\"clock\",\"phase\":3598}");
        entity(m, "unknown", enf_v3(14, 2, 6), night->east, "{\"sound\":\"no such sound\"}");
    }
    uint32_t vase = entity(m, "prop_exhibit", enf_v3(14, 0.8, 4), night->east,
                           "{\"targetname\":\"vase\",\"title\":\"the vase\",\"value\":3}");
    EnfMover exhibit = mover(m, ENF_MOVER_STILL, vase, (EnfBox3){{-0.125, 0, -0.125}, {0.125, 0.25, 0.125}}, "vase");
    exhibit.flags = ENF_MOVER_CARRY;
    enf_maker_mover(m, &exhibit);
    if (def->door) {
        add_door(night, def->locked, def->swings);
    }
    if (def->guard) {
        add_guard(night);
    }
    if (def->lift) {
        add_lift(night);
    }
    night->map = enf_maker_finish(m, error);
    return night->map != NULL;
}

void enf_night_destroy(EnfNight *night) {
    enf_maker_destroy(night->maker);
}

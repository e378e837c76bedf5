/* Objects by the dozen from the bits of one number each, so that a scene of any size is the same everywhere. */
#include "scenes/moving_rooms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MESH_CRATE, MESH_LEAF, MESH_LAMP, MESH_GLASS, MESH_LATTICE, MESH_FIGURE, MESH_COUNT };
enum { KEYS = 5, EVENT_EVERY = 7 };

struct EnfMovingThing {
    EnfObjectId id;
    EnfObjectDef def;
    uint32_t portal; /* of a door, or ENF_NONE */
    float times[KEYS], places[9 * KEYS], turns[4 * KEYS], sizes[3 * KEYS];
    EnfVec3 centre; /* of a free one's circle */
    double radius, turn;
};

/* splitmix64, as in rooms.c. */
static uint64_t mix(uint64_t z) {
    z += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static uint64_t next_random(uint64_t *state) {
    *state += UINT64_C(0x9e3779b97f4a7c15);
    return mix(*state);
}

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * ((double)(next_random(state) >> 11) * 0x1p-53);
}

EnfMovingRoomsDef enf_moving_rooms_def_default(void) {
    EnfMovingRoomsDef def = {enf_rooms_def_default(), 8, true, false};
    return def;
}

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

static EnfBox3 box(double x0, double y0, double z0, double x1, double y1, double z1) {
    EnfBox3 b = {{x0, y0, z0}, {x1, y1, z1}};
    return b;
}

/* Materials 4 to 9, after the rooms' own four. */
static void add_materials(EnfMaker *m) {
    uint8_t lattice[4 * 4 * 4];
    for (int i = 0; i < 16; i++) {
        bool hole = i % 4 % 2 == 0 && i / 4 % 2 == 0;
        const uint8_t texel[4] = {220, 200, 120, hole ? 0 : 255};
        memcpy(&lattice[4 * i], texel, 4);
    }
    uint32_t texture = enf_maker_texture(m, enf_maker_image(m, 4, 4, lattice));
    enf_maker_material(m, "crate", 0.75f, 0.45f, 0.2f);
    enf_maker_material(m, "leaf", 0.25f, 0.35f, 0.6f);
    EnfMaterial *lamp = enf_maker_material(m, "glow", 1.0f, 0.9f, 0.6f);
    lamp->emissive[0] = lamp->emissive[1] = 0.6f;
    EnfMaterial *glass = enf_maker_material(m, "glass", 0.5f, 0.8f, 0.9f);
    glass->alpha_mode = ENF_ALPHA_BLEND;
    glass->base_color[3] = 0.4f;
    EnfMaterial *mesh = enf_maker_material(m, "lattice", 1.0f, 1.0f, 1.0f);
    mesh->alpha_mode = ENF_ALPHA_MASK;
    mesh->texture = texture;
    mesh->flags = ENF_MATERIAL_DOUBLE_SIDED;
    enf_maker_material(m, "coat", 0.7f, 0.15f, 0.2f);
}

/* A figure has three parts, one of each kind that is drawn apart. */
static void add_meshes(EnfMaker *m) {
    add_materials(m);
    enf_maker_mesh(m, "crate", 4, box(-0.25, -0.25, -0.25, 0.25, 0.25, 0.25));
    enf_maker_mesh(m, "leaf", 5, box(-0.03125, -0.03125, -0.03125, 1.03125, 2.03125, 0.03125)); /* no gap about it */
    enf_maker_mesh(m, "lamp", 6, box(-0.125, -0.125, -0.125, 0.125, 0.125, 0.125));
    enf_maker_mesh(m, "pane", 7, box(-0.5, -0.5, -0.03125, 0.5, 0.5, 0.03125));
    enf_maker_mesh(m, "lattice", 8, box(-0.5, -0.5, -0.0625, 0.5, 0.5, 0.0625));
    enf_maker_mesh(m, "figure", 4, box(-0.25, 0.0, -0.125, 0.25, 1.25, 0.125));
    enf_maker_mesh_part(m, 7, box(-0.1875, 1.25, -0.1875, 0.1875, 1.625, 0.1875));
    enf_maker_mesh_part(m, 8, box(-0.375, 0.375, -0.25, 0.375, 0.5, 0.25));
    enf_maker_mesh_part(m, 9, box(-0.3125, 0.625, -0.1875, 0.3125, 1.125, 0.1875));
}

/* ---- doors ------------------------------------------------------------------------------------------------------ */

static EnfVec3 portal_point(const EnfMap *map, uint32_t portal, uint32_t i) {
    const double *o = map->cells[map->portals[portal].source].origin;
    return enf_add(enf_v3(o[0], o[1], o[2]), enf_v3_from_f(map->portal_vertices[map->portals[portal].vertex_first + i]));
}

/* A leaf in each doorway, hung at its first corner. */
static void make_door(const EnfMovingRooms *moving, EnfMovingThing *thing, uint32_t portal, uint64_t *random) {
    EnfVec3 hinge = portal_point(moving->rooms.map, portal, 0), far = portal_point(moving->rooms.map, portal, 3);
    EnfVec3 along = enf_sub(far, hinge);
    EnfSwingMotion *swing = &thing->def.motion.as.swing;
    thing->portal = portal;
    thing->def.motion.kind = next_random(random) % 4 ? ENF_MOTION_HINGE : ENF_MOTION_SLIDE;
    bool turns = thing->def.motion.kind == ENF_MOTION_HINGE;
    swing->rest = enf_pose_identity();
    swing->rest.position = hinge;
    swing->rest.rotation = enf_quat_axis_angle(enf_v3(0, 1, 0), enf_atan2(-along.z, along.x));
    swing->rest.scale = enf_v3(enf_length(along), 1.0, 1.0);
    swing->pivot = hinge;
    swing->axis = turns ? enf_v3(0, 1, 0) : enf_normalize(along);
    swing->low = turns ? -1.5 : 0.0;
    swing->high = turns ? 1.5 : 0.9;
    swing->rate = between(random, 0.5, 4.0);
    thing->def.mesh = MESH_LEAF;
    thing->def.max_speed = 8.0;
}

/* ---- what moves in a room --------------------------------------------------------------------------------------- */

static EnfVec3 place_in(EnfBox3 room, uint64_t *random) {
    return enf_v3(between(random, room.min.x + 0.5, room.max.x - 0.5), between(random, room.min.y + 0.3, room.max.y - 0.6),
                  between(random, room.min.z + 0.5, room.max.z - 0.5));
}

static void put(float *to, EnfVec3 p) {
    to[0] = (float)p.x, to[1] = (float)p.y, to[2] = (float)p.z;
}

/* Places in this room and, for every third, in the next one, through whatever is between. */
static void make_path(const EnfMovingRooms *moving, EnfMovingThing *thing, uint32_t cell, uint64_t *random) {
    EnfPathMotion *path = &thing->def.motion.as.path;
    EnfVec3 points[KEYS];
    float flat[3 * KEYS];
    bool travels = next_random(random) % 3 == 0, cubic = next_random(random) % 2 == 0;
    for (uint32_t k = 0; k < KEYS; k++) {
        uint32_t at = travels && k % 2 ? (cell + 1) % moving->rooms.map->cells_count : cell;
        points[k] = k + 1 == KEYS ? points[0] : place_in(enf_rooms_box(&moving->rooms, at), random);
        thing->times[k] = (float)k;
        put(flat + 3 * k, points[k]);
        EnfQuat q = enf_quat_axis_angle(enf_v3(between(random, -1, 1), 1.0, between(random, -1, 1)), between(random, -3, 3));
        const float turn[4] = {(float)q.x, (float)q.y, (float)q.z, (float)q.w};
        memcpy(&thing->turns[4 * k], turn, sizeof turn);
        double size = between(random, 0.5, 1.5);
        put(&thing->sizes[3 * k], enf_v3(size, size, size));
    }
    enf_catmull_rom(thing->times, flat, KEYS, thing->places);
    if (!cubic) {
        memcpy(thing->places, flat, sizeof flat);
    }
    thing->def.motion.kind = ENF_MOTION_PATH;
    path->rest = enf_pose_identity();
    path->rest.scale = enf_v3(next_random(random) % 4 ? 1.0 : -1.0, 1.0, 1.0); /* one in four is mirrored */
    path->translation = (EnfTrack){cubic ? ENF_PATH_CUBIC : ENF_PATH_LINEAR, KEYS, thing->times, thing->places};
    path->rotation = (EnfTrack){ENF_PATH_LINEAR, next_random(random) % 2 ? KEYS : 0, thing->times, thing->turns};
    path->scale = (EnfTrack){ENF_PATH_LINEAR, next_random(random) % 4 ? 0 : KEYS, thing->times, thing->sizes};
    path->wrap = next_random(random) % 2 ? ENF_WRAP_LOOP : ENF_WRAP_PING_PONG;
    path->seconds = KEYS - 1;
    path->period_ticks = 60 + (uint32_t)(next_random(random) % 1000);
}

/* Up and down, like a lift. */
static void make_slide(const EnfMovingRooms *moving, EnfMovingThing *thing, uint32_t cell, uint64_t *random) {
    EnfSwingMotion *swing = &thing->def.motion.as.swing;
    thing->def.motion.kind = ENF_MOTION_SLIDE;
    swing->rest = enf_pose_identity();
    swing->rest.position = place_in(enf_rooms_box(&moving->rooms, cell), random);
    swing->axis = enf_v3(0, 1, 0);
    swing->low = -0.5;
    swing->high = 0.5;
    swing->rate = between(random, 0.2, 1.0);
}

static EnfPose on_circle(const void *user, int64_t tick) {
    const EnfMovingThing *thing = user;
    double angle = thing->turn + (double)(tick % 628) * 0.01; /* jumps by 0.003 radian once a round: within its speed */
    EnfPose pose = enf_pose_identity();
    pose.position = enf_add(thing->centre, enf_v3(thing->radius * enf_cos(angle), 0.0, thing->radius * enf_sin(angle)));
    pose.rotation = enf_quat_axis_angle(enf_v3(0, 1, 0), -angle);
    return pose;
}

static void make_walker(const EnfMovingRooms *moving, EnfMovingThing *thing, uint32_t cell, uint64_t *random) {
    EnfBox3 room = enf_rooms_box(&moving->rooms, cell);
    EnfFreeMotion *walk = &thing->def.motion.as.free;
    thing->centre = enf_scale(enf_add(room.min, room.max), 0.5);
    thing->centre.y = room.min.y + 0.0625;
    thing->radius = between(random, 0.2, 1.8);
    thing->turn = between(random, 0.0, 6.0);
    thing->def.motion.kind = ENF_MOTION_FREE;
    walk->pose = on_circle(thing, 0);
    walk->ask = on_circle;
    walk->user = thing;
    walk->max_speed = 3.0; /* 1.1 of the pivot, and what turns about it */
    walk->confined = true; /* it stays half a metre off the walls, but for its corners */
    thing->def.mesh = MESH_FIGURE;
}

static void make_thing(const EnfMovingRooms *moving, EnfMovingThing *thing, uint32_t cell, uint64_t *random) {
    static const uint32_t meshes[] = {MESH_CRATE, MESH_LAMP, MESH_GLASS, MESH_LATTICE, MESH_FIGURE, MESH_GLASS};
    thing->def.mesh = meshes[next_random(random) % 6];
    switch (next_random(random) % 5) {
    case 0:
        thing->def.motion.as.still = enf_pose_identity();
        thing->def.motion.as.still.position = place_in(enf_rooms_box(&moving->rooms, cell), random);
        break;
    case 1:
        make_slide(moving, thing, cell, random);
        break;
    case 2:
        make_walker(moving, thing, cell, random);
        break;
    default:
        make_path(moving, thing, cell, random);
        break;
    }
}

/* ---- life ------------------------------------------------------------------------------------------------------- */

static EnfMovingThing *new_thing(EnfMovingRooms *moving) {
    EnfMovingThing *thing = &moving->things[moving->thing_count++];
    thing->def = enf_object_def_default();
    thing->portal = ENF_NONE;
    return thing;
}

static bool add_thing(EnfMovingRooms *moving, EnfMovingThing *thing, EnfError *error) {
    const EnfMesh *mesh = &moving->rooms.map->meshes[thing->def.mesh];
    thing->def.local.min = enf_v3((double)mesh->min[0], (double)mesh->min[1], (double)mesh->min[2]);
    thing->def.local.max = enf_v3((double)mesh->max[0], (double)mesh->max[1], (double)mesh->max[2]);
    thing->def.user = (uint64_t)(thing - moving->things);
    thing->id = enf_world_add(moving->world, &thing->def, error);
    return thing->id.generation != 0;
}

static bool fill(EnfMovingRooms *moving, EnfError *error) {
    const EnfMap *map = moving->rooms.map;
    uint64_t random = moving->def.rooms.seed + 1000;
    for (uint32_t p = 0; p < map->portals_count; p++) {
        if (p < map->portals[p].twin) {
            make_door(moving, new_thing(moving), p, &random);
        }
    }
    moving->door_count = moving->thing_count;
    for (uint32_t i = 0; i < map->cells_count * moving->def.movers; i++) {
        make_thing(moving, new_thing(moving), i % map->cells_count, &random);
    }
    for (uint32_t i = 0; i < moving->thing_count; i++) {
        if (!add_thing(moving, &moving->things[i], error)) {
            return false;
        }
    }
    return true;
}

static bool same_pose(const EnfPose *a, const EnfPose *b) {
    EnfVec3 way = enf_sub(a->position, b->position);
    double turn = fabs(a->rotation.x * b->rotation.x + a->rotation.y * b->rotation.y + a->rotation.z * b->rotation.z +
                       a->rotation.w * b->rotation.w);
    return enf_dot(way, way) < 1e-24 && turn > 1.0 - 1e-12;
}

/* A door at rest fills its opening: the portal is closed. Between two ticks it is not, if it came to rest only now. */
static void set_portals(EnfMovingRooms *moving) {
    for (uint32_t i = 0; i < moving->door_count; i++) {
        const EnfMovingThing *thing = &moving->things[i];
        EnfPose pose = enf_world_pose(moving->world, thing->id.index), last;
        (void)enf_world_last_pose(moving->world, thing->id.index, &last);
        const EnfPose *rest = &thing->def.motion.as.swing.rest;
        enf_portals_set_open(&moving->portals, thing->portal, !(same_pose(&pose, rest) && same_pose(&last, rest)));
    }
}

bool enf_moving_rooms_create(EnfMovingRooms *moving, const EnfMovingRoomsDef *def, EnfError *error) {
    memset(moving, 0, sizeof *moving);
    moving->def = *def;
    moving->def.rooms.extend = add_meshes;
    if (!enf_rooms_create(&moving->rooms, &moving->def.rooms, error)) {
        return false;
    }
    const EnfMap *map = moving->rooms.map;
    uint32_t most = map->portals_count + map->cells_count * def->movers;
    moving->things = calloc(most + 1, sizeof *moving->things);
    bool ok = moving->things && enf_portals_create(&moving->portals, map, NULL, error) == ENF_OK &&
              enf_world_create(&moving->world, map, most + 1, NULL, error) == ENF_OK;
    if (ok) {
        enf_world_set_trail(moving->world, def->trail);
        ok = fill(moving, error);
    }
    if (ok) {
        set_portals(moving);
    } else {
        enf_moving_rooms_destroy(moving);
    }
    return ok;
}

void enf_moving_rooms_destroy(EnfMovingRooms *moving) {
    enf_world_destroy(moving->world);
    if (moving->portals.map) {
        enf_portals_destroy(&moving->portals);
    }
    free(moving->things);
    enf_rooms_destroy(&moving->rooms);
    memset(moving, 0, sizeof *moving);
}

/* ---- events ----------------------------------------------------------------------------------------------------- */

static void send_door(EnfMovingRooms *moving, uint64_t event) {
    const EnfMovingThing *door = &moving->things[event % moving->door_count];
    const EnfSwingMotion *swing = &door->def.motion.as.swing;
    const double targets[3] = {0.0, swing->high, swing->low};
    enf_world_swing(moving->world, door->id, targets[event / 8 % 3]);
}

/* Dies, is born, is set elsewhere, or sent. */
static void change_thing(EnfMovingRooms *moving, uint64_t event) {
    uint32_t count = moving->thing_count - moving->door_count;
    EnfMovingThing *thing = &moving->things[moving->door_count + event % count];
    uint64_t random = event;
    if (!enf_world_alive(moving->world, thing->id)) {
        (void)add_thing(moving, thing, NULL);
    } else if (event >> 40 & 1) {
        enf_world_remove(moving->world, thing->id);
    } else if (thing->def.motion.kind == ENF_MOTION_SLIDE) {
        enf_world_swing(moving->world, thing->id, event >> 41 & 1 ? 0.5 : -0.5);
    } else if (thing->def.motion.kind == ENF_MOTION_STILL) {
        uint32_t cell = (uint32_t)(event >> 42) % moving->rooms.map->cells_count;
        EnfMotion motion = thing->def.motion;
        motion.as.still.position = place_in(enf_rooms_box(&moving->rooms, cell), &random);
        enf_world_set_motion(moving->world, thing->id, &motion);
    }
}

void enf_moving_rooms_step(EnfMovingRooms *moving) {
    enf_world_advance(moving->world, 1);
    uint64_t tick = (uint64_t)enf_world_tick(moving->world);
    if (moving->def.events && tick % EVENT_EVERY == 0) {
        uint64_t event = mix(moving->def.rooms.seed ^ tick);
        if (moving->door_count > 0) {
            send_door(moving, event);
        }
        if (moving->thing_count > moving->door_count) {
            change_thing(moving, event >> 3);
        }
    }
    set_portals(moving);
}

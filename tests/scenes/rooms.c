/* The grid of rooms. A room's walls are its own: two faces of one wall, each seen from its side. */
#include "scenes/rooms.h"

#include <math.h>
#include <stdio.h>

enum { WALL, FLOOR, CEILING, WOOD };

/* A wall in the plane of a room's side: u runs along it, the normal points into the room. */
typedef struct Wall {
    EnfVec3 corner, along, up;
    double length, height;
} Wall;

/* splitmix64 (Steele, Lea & Flood 2014): the scene's own, so that a benchmark needs no test harness. */
static uint64_t next_random(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* A multiple of 2^-8. */
static double round_grid(double x) {
    return floor(x * 256.0 + 0.5) / 256.0;
}

static double random_between(uint64_t *state, double low, double high) {
    return round_grid(low + (high - low) * (double)(next_random(state) >> 11) * 0x1p-53);
}

EnfRoomsDef enf_rooms_def_default(void) {
    EnfRoomsDef def = {4, 4, {0, 0, 0}, {5, 3, 5}, 1, 2, 100, 4, false, true, 1, NULL};
    return def;
}

EnfBox3 enf_rooms_box(const EnfRooms *rooms, uint32_t cell) {
    const EnfRoomsDef *d = &rooms->def;
    EnfVec3 low = enf_v3(d->origin.x + d->room.x * (cell % d->nx), d->origin.y, d->origin.z + d->room.z * (cell / d->nx));
    EnfBox3 box = {low, enf_add(low, d->room)};
    return box;
}

uint32_t enf_rooms_cell_at(const EnfRooms *rooms, EnfVec3 p) {
    const EnfRoomsDef *d = &rooms->def;
    double x = floor((p.x - d->origin.x) / d->room.x), z = floor((p.z - d->origin.z) / d->room.z);
    bool inside = p.y >= d->origin.y && p.y <= d->origin.y + d->room.y && x >= 0 && x < d->nx && z >= 0 && z < d->nz;
    return inside ? (uint32_t)z * d->nx + (uint32_t)x : ENF_NONE;
}

bool enf_rooms_in_furniture(const EnfRooms *rooms, EnfVec3 p, double margin) {
    const EnfMap *map = rooms->map;
    for (uint32_t i = 0; i < map->clusters_count; i++) {
        const EnfCluster *c = &map->clusters[i];
        const double *o = map->cells[c->cell].origin;
        const double v[3] = {p.x, p.y, p.z};
        bool in = c->material == WOOD;
        for (int axis = 0; in && axis < 3; axis++) {
            in = v[axis] >= o[axis] + (double)c->min[axis] - margin && v[axis] <= o[axis] + (double)c->max[axis] + margin;
        }
        if (in) {
            return true;
        }
    }
    return false;
}

/* ---- walls and doors -------------------------------------------------------------------------------------------- */

static EnfVec3 wall_point(const Wall *w, double u, double v) {
    return enf_add(w->corner, enf_add(enf_scale(w->along, u), enf_scale(w->up, v)));
}

static void wall_rectangle(EnfMaker *m, uint32_t cell, const Wall *w, const double u[2], const double v[2]) {
    if (u[0] < u[1] && v[0] < v[1]) {
        EnfVec3 points[4] = {wall_point(w, u[0], v[0]), wall_point(w, u[1], v[0]), wall_point(w, u[1], v[1]),
                             wall_point(w, u[0], v[1])};
        enf_maker_polygon(m, cell, WALL, points, 4);
    }
}

/* `door`: where it begins along the wall, or less than 0 for none. */
static void add_wall(EnfMaker *m, const EnfRoomsDef *d, uint32_t cell, const Wall *w, double door) {
    if (door < 0.0) {
        wall_rectangle(m, cell, w, (double[]){0, w->length}, (double[]){0, w->height});
        return;
    }
    wall_rectangle(m, cell, w, (double[]){0, door}, (double[]){0, w->height});
    wall_rectangle(m, cell, w, (double[]){door + d->door_width, w->length}, (double[]){0, w->height});
    wall_rectangle(m, cell, w, (double[]){door, door + d->door_width}, (double[]){d->door_height, w->height});
}

/* The wall between `cell` and its neighbour towards +x (axis 0) or +z (axis 1), seen from `cell`. */
static Wall wall_between(const EnfRooms *rooms, uint32_t cell, int axis) {
    EnfBox3 box = enf_rooms_box(rooms, cell);
    const EnfVec3 *size = &rooms->def.room;
    Wall east = {enf_v3(box.max.x, box.min.y, box.min.z), {0, 0, 1}, {0, 1, 0}, size->z, size->y};
    Wall south = {enf_v3(box.max.x, box.min.y, box.max.z), {-1, 0, 0}, {0, 1, 0}, size->x, size->y};
    return axis ? south : east;
}

/* The same wall seen from the other side. */
static Wall wall_turned(const Wall *w) {
    Wall turned = {wall_point(w, w->length, 0), enf_scale(w->along, -1), w->up, w->length, w->height};
    return turned;
}

static void add_threshold(EnfMaker *m, const Wall *w, double door, const EnfRoomsDef *d, const uint32_t cells[2]) {
    const double depth = 0.25, height = 0.0625;
    EnfVec3 normal = enf_cross(w->along, w->up);
    EnfVec3 a = enf_add(wall_point(w, door + 0.0625, 0), enf_scale(normal, -depth));
    EnfVec3 b = enf_add(wall_point(w, door + d->door_width - 0.0625, height), enf_scale(normal, depth));
    enf_maker_node(m, "threshold");
    enf_maker_box(m, cells[0], WOOD, enf_box3_add(enf_box3_add(enf_box3_empty(), a), b), false);
    enf_maker_reach(m, cells[1]);
}

/* One inner or outer wall of the grid with both its faces and its door. */
static void add_wall_pair(EnfRooms *rooms, uint32_t cell, int axis, bool inner, uint64_t *random) {
    const EnfRoomsDef *d = &rooms->def;
    Wall wall = wall_between(rooms, cell, axis), turned = wall_turned(&wall);
    const uint32_t cells[2] = {cell, axis ? cell + d->nx : cell + 1};
    double door = random_between(random, 0.25, wall.length - d->door_width - 0.25);
    bool has_door = inner && d->door_width > 0.0 && next_random(random) % 100 < d->door_percent;
    add_wall(rooms->maker, d, cells[0], &wall, has_door ? door : -1.0);
    if (inner) {
        add_wall(rooms->maker, d, cells[1], &turned, has_door ? wall.length - d->door_width - door : -1.0);
    }
    if (has_door) {
        EnfVec3 points[4] = {wall_point(&wall, door, 0), wall_point(&wall, door, d->door_height),
                             wall_point(&wall, door + d->door_width, d->door_height),
                             wall_point(&wall, door + d->door_width, 0)};
        enf_maker_portal(rooms->maker, "door-portal", cells[0], cells[1], points, 4, 0);
        if (d->thresholds) {
            add_threshold(rooms->maker, &wall, door, d, cells);
            enf_maker_node(rooms->maker, "walls");
        }
    }
}

/* ---- rooms ------------------------------------------------------------------------------------------------------ */

static void add_flat(EnfMaker *m, uint32_t cell, uint32_t material, EnfBox3 box, bool floor) {
    double y = floor ? box.min.y : box.max.y;
    EnfVec3 points[4] = {
        {box.min.x, y, box.min.z}, {box.min.x, y, box.max.z}, {box.max.x, y, box.max.z}, {box.max.x, y, box.min.z}};
    if (!floor) {
        EnfVec3 swap = points[1];
        points[1] = points[3];
        points[3] = swap;
    }
    enf_maker_polygon(m, cell, material, points, 4);
}

/* Boxes on a grid of places, so that none touches another. */
static void add_furniture(EnfRooms *rooms, uint32_t cell, uint64_t *random) {
    const EnfRoomsDef *d = &rooms->def;
    EnfBox3 box = enf_rooms_box(rooms, cell);
    uint32_t side = 1;
    while (side * side < d->furniture) {
        side++;
    }
    double px = (d->room.x - 1.0) / side, pz = (d->room.z - 1.0) / side;
    for (uint32_t i = 0; i < d->furniture; i++) {
        double w = random_between(random, 0.3 * px, 0.8 * px), l = random_between(random, 0.3 * pz, 0.8 * pz);
        double x = round_grid(box.min.x + 0.5 + px * (i % side) + 0.1 * px);
        double z = round_grid(box.min.z + 0.5 + pz * (i / side) + 0.1 * pz);
        double h = random_between(random, 0.1 * d->room.y, 0.5 * d->room.y);
        EnfBox3 thing = {{x, box.min.y + 0.125, z}, {x + w, box.min.y + 0.125 + h, z + l}};
        char name[32];
        snprintf(name, sizeof name, "box_%u", i);
        enf_maker_node(rooms->maker, name);
        enf_maker_box(rooms->maker, cell, WOOD, thing, false);
    }
}

static void add_room(EnfRooms *rooms, uint32_t cell, uint64_t *random) {
    EnfMaker *m = rooms->maker;
    EnfBox3 box = enf_rooms_box(rooms, cell);
    enf_maker_node(m, "flats");
    add_flat(m, cell, FLOOR, box, true);
    add_flat(m, cell, CEILING, box, false);
    add_furniture(rooms, cell, random);
    if (rooms->def.lights) {
        EnfVec3 lamp = enf_v3(0.5 * (box.min.x + box.max.x), box.max.y - 0.25, 0.5 * (box.min.z + box.max.z));
        enf_maker_light(m, cell, lamp, (EnfVec3f){20.0f, 18.0f, 15.0f}, 12.0f);
    }
}

/* The face of an outer wall towards −x or −z belongs to the room alone. */
static void add_near_walls(EnfRooms *rooms, uint32_t cell, bool first_x, bool first_z) {
    EnfBox3 box = enf_rooms_box(rooms, cell);
    const EnfVec3 *size = &rooms->def.room;
    Wall west = {enf_v3(box.min.x, box.min.y, box.max.z), {0, 0, -1}, {0, 1, 0}, size->z, size->y};
    Wall north = {box.min, {1, 0, 0}, {0, 1, 0}, size->x, size->y};
    if (first_x) {
        add_wall(rooms->maker, &rooms->def, cell, &west, -1.0);
    }
    if (first_z) {
        add_wall(rooms->maker, &rooms->def, cell, &north, -1.0);
    }
}

static void add_cells(EnfRooms *rooms) {
    for (uint32_t i = 0; i < rooms->def.nx * rooms->def.nz; i++) {
        char name[64];
        uint32_t cell;
        snprintf(name, sizeof name, "room_%u_%u-room", i % rooms->def.nx, i / rooms->def.nx);
        enf_maker_cell(rooms->maker, name, enf_rooms_box(rooms, i).min, &cell);
    }
}

static void add_spawn(EnfRooms *rooms) {
    EnfBox3 box = enf_rooms_box(rooms, 0);
    EnfEntity spawn = {{box.min.x + 0.25, box.min.y + 1.5, box.min.z + 0.25},
                       {0, 0, 0, 1},
                       {1, 1, 1},
                       enf_maker_string(rooms->maker, "spawn"),
                       enf_maker_string(rooms->maker, "info_player_start"),
                       0,
                       ENF_NONE,
                       0,
                       ENF_NONE,
                       ENF_NONE};
    enf_maker_entity(rooms->maker, &spawn);
}

static void round_def(EnfRoomsDef *d) {
    d->origin = enf_v3(round_grid(d->origin.x), round_grid(d->origin.y), round_grid(d->origin.z));
    d->room = enf_v3(round_grid(d->room.x), round_grid(d->room.y), round_grid(d->room.z));
    d->door_width = round_grid(d->door_width);
    d->door_height = round_grid(d->door_height);
}

bool enf_rooms_create(EnfRooms *rooms, const EnfRoomsDef *def, EnfError *error) {
    *rooms = (EnfRooms){*def, NULL, enf_maker_create()};
    round_def(&rooms->def);
    const EnfRoomsDef *d = &rooms->def;
    uint64_t random = def->seed;
    enf_maker_material(rooms->maker, "floor", 0.45f, 0.4f, 0.35f);
    enf_maker_material(rooms->maker, "ceiling", 0.9f, 0.9f, 0.9f);
    enf_maker_material(rooms->maker, "wood", 0.5f, 0.3f, 0.15f);
    enf_maker_string(rooms->maker, "door-portal"); /* looked up for each door: early in the table */
    enf_maker_string(rooms->maker, "lamp");
    enf_maker_string(rooms->maker, "walls");
    enf_maker_string(rooms->maker, "flats");
    add_cells(rooms);
    /* Lights of a cell are contiguous, so rooms come one by one. */
    for (uint32_t cell = 0; cell < d->nx * d->nz; cell++) {
        enf_maker_node(rooms->maker, "walls");
        add_near_walls(rooms, cell, cell % d->nx == 0, cell / d->nx == 0);
        add_wall_pair(rooms, cell, 0, cell % d->nx + 1 < d->nx, &random);
        add_wall_pair(rooms, cell, 1, cell / d->nx + 1 < d->nz, &random);
        add_room(rooms, cell, &random);
    }
    add_spawn(rooms);
    if (d->extend) {
        d->extend(rooms->maker);
    }
    rooms->map = enf_maker_finish(rooms->maker, error);
    if (!rooms->map) {
        enf_rooms_destroy(rooms);
    }
    return rooms->map != NULL;
}

void enf_rooms_destroy(EnfRooms *rooms) {
    enf_maker_destroy(rooms->maker);
    rooms->maker = NULL;
    rooms->map = NULL;
}

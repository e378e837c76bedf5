/* enfinfo as it is called: what it prints about a map, its exit statuses, and its answers to "why". */
#include "harness/program.h"
#include "scenes/everything.h"
#include "scenes/rooms.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(arguments, status, ...) ENF_TEST_EXPECT("enfinfo", arguments, status, __VA_ARGS__)

/* @/rooms.enfmap: three rooms in a row along x, their doors in line; room 0 from 0 to 5. Returns its path. */
static const char *rooms_map(void) {
    static char path[1024];
    EnfRooms rooms;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfError error = {0};
    def.nx = 3;
    def.nz = 1;
    def.door_width = 4.5;
    snprintf(path, sizeof path, "%s", enf_test_temp_path("rooms.enfmap"));
    if (!enf_rooms_create(&rooms, &def, &error) || enf_map_write(rooms.map, path, &error)) {
        fail_msg("%s", error.message);
    }
    enf_rooms_destroy(&rooms);
    return path;
}

static void test_lists(void **state) {
    (void)state;
    rooms_map();
    EXPECT("@/rooms.enfmap", 0, "Enfilade map, version 2", "cells      3", "4 half-portals: 2 pairs", "room_2_0-room", "VERT");
    EXPECT("@/rooms.enfmap --cells", 0, "room_0_0-room", "5.0 × 3.0 × 5.0");
    EXPECT("@/rooms.enfmap --portals", 0, "door-portal", "room_1_0-room", "9.00");
    EXPECT("@/rooms.enfmap --materials --lights --entities", 0, "plaster", "lamp", "info_player_start");
    EXPECT("@/rooms.enfmap --json", 0, "\"cell_count\": 3", "\"portals\": [", "\"name\": \"room_1_0-room\"");
    EXPECT("@/rooms.enfmap --check", 0, "OK: 3 cells, 4 portals");
}

/* A map with a mover of each kind. */
static void test_movers(void **state) {
    (void)state;
    EnfError error = {0};
    EnfMaker *maker = enf_everything_create(&error);
    const char *map = enf_test_temp_path("everything.enfmap");
    if (!maker || enf_map_write(enf_maker_map(maker), map, &error)) {
        fail_msg("%s", error.message);
    }
    enf_maker_destroy(maker);
    EXPECT("@/everything.enfmap", 0, "movers     6: 2 along paths, 1 hinges, 1 slides, 1 free, 1 still; 3 close portals",
           "meshes     2");
    EXPECT("@/everything.enfmap --movers", 0, "ping-pong", "0°..85.9°", "solid locked", "solid carry", "free");
    EXPECT("@/everything.enfmap --meshes", 0, "crate", "leaf", "0.50 × 0.50 × 0.50");
    EXPECT("@/everything.enfmap --json --movers --meshes", 0, "\"mover_count\": 6", "\"kind\": \"hinge\"",
           "\"wrap\": \"ping-pong\"", "\"flags\": \"solid locked\"", "\"meshes\": [");
}

static void test_command_line(void **state) {
    (void)state;
    rooms_map();
    EXPECT("--help", 0, "usage: enfinfo", "--check");
    EXPECT("--version", 0, "enfinfo ");
    EXPECT("", 2, "which map?");
    EXPECT("a b", 2, "one map at a time");
    EXPECT("why @/rooms.enfmap", 2, "--eye X,Y,Z and --cell");
    EXPECT("@/rooms.enfmap --cell x", 2, "belong to 'why'");
    EXPECT("@/rooms.enfmap --nonsense", 2, "--nonsense");
    EXPECT("why @/rooms.enfmap --eye 1,1,1 --cell nowhere", 2, "no cell 'nowhere'");
}

static void test_unsound(void **state) {
    (void)state;
    const char *map = rooms_map();
    size_t size;
    uint8_t *bytes = enf_test_read_file(map, &size);
    const char *damaged = enf_test_temp_path("damaged.enfmap");
    bytes[size / 2] ^= 1;
    enf_test_write_file(damaged, bytes, size);
    EXPECT("@/damaged.enfmap --check", 1, "damaged.enfmap: at byte ", "chunk ", "checksum");
    enf_test_write_file(damaged, bytes, size / 2);
    EXPECT("@/damaged.enfmap", 1, "file_size");
    EXPECT("absent.enfmap", 1, "absent.enfmap");
    free(bytes);
}

static void test_why(void **state) {
    (void)state;
    rooms_map();
    EXPECT("why @/rooms.enfmap --eye 2.5,1.5,2.5 --yaw -90 --cell room_2_0", 0, "in \"room_0_0-room\"",
           "is seen, through 2 portals", "the eye is here", "100.0 %", "door-portal");
    EXPECT("@/rooms.enfmap why --eye 2.5,1.5,2.5 --yaw -90 --cell room_2_0 --window polygon", 0, "through 2 portals");
    EXPECT("why @/rooms.enfmap --eye 2.5,1.5,2.5 --yaw -90 --cell room_0_0", 0, "through 0 portals");
    EXPECT("why @/rooms.enfmap --eye 2.5,1.5,2.5 --yaw 90 --cell room_2_0", 1, "is hidden", "room_0_0-room → room_1_0-room",
           "behind the eye", "then 1 more");
    EXPECT("why @/rooms.enfmap --eye 2.5,1.5,2.5 --yaw 0 --cell room_1_0", 1, "outside the picture", "to the right");
    EXPECT("why @/rooms.enfmap --eye -50,1.5,2.5 --yaw 90 --cell room_1_0", 1, "in no cell", "frustum");
    EXPECT("why @/rooms.enfmap --eye 7.5,1.5,2.5 --yaw 90 --from room_1_0 --cell room_0_0", 0, "is seen");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_lists),   cmocka_unit_test(test_movers), cmocka_unit_test(test_command_line),
    cmocka_unit_test(test_unsound), cmocka_unit_test(test_why),
};

ENF_TEST_MAIN(tests)

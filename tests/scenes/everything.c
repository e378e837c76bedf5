/* A map with a record in every table; see everything.h. */
#include "scenes/everything.h"

/* A lift on its path, a thing that turns, a hinged door, a sliding one, a thing to carry, a guard. */
static void put_movers(EnfMaker *m) {
    uint32_t crate = enf_maker_mesh(m, "crate", 1, (EnfBox3){{-0.25, 0, -0.25}, {0.25, 0.5, 0.25}});
    uint32_t leaf = enf_maker_mesh(m, "leaf", 0, (EnfBox3){{0, 0, 0}, {0.0625, 2, 1}});
    EnfMover mover = enf_maker_mover_default();
    mover.mesh = crate;
    mover.flags = ENF_MOVER_SOLID | ENF_MOVER_CARRY;
    enf_maker_mover(m, &mover);
    mover.flags = ENF_MOVER_SOLID;
    mover.kind = ENF_MOVER_PATH;
    mover.translation = 0;
    mover.wrap = ENF_WRAP_PING_PONG;
    enf_maker_mover(m, &mover);
    mover.translation = ENF_NONE;
    mover.rotation = 1;
    mover.entity = 1;
    enf_maker_mover(m, &mover);
    mover.rotation = ENF_NONE;
    mover.mesh = leaf;
    mover.kind = ENF_MOVER_HINGE;
    mover.high = 1.5f;
    mover.portal = 0;
    mover.flags = ENF_MOVER_SOLID | ENF_MOVER_LOCKED;
    enf_maker_mover(m, &mover);
    mover.kind = ENF_MOVER_SLIDE;
    mover.low = -1.0f;
    enf_maker_mover(m, &mover);
    mover.kind = ENF_MOVER_FREE;
    enf_maker_mover(m, &mover);
}

static void put_tables(EnfMaker *m, uint32_t cell) {
    static const uint8_t rgba[2 * 2 * 4] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
    uint32_t texture = enf_maker_texture(m, enf_maker_image(m, 2, 2, rgba));
    EnfMaterial *material = enf_maker_material(m, "tiles", 1, 1, 1);
    material->texture = material->emissive_texture = texture;
    material->alpha_mode = ENF_ALPHA_MASK;
    EnfMapCamera camera = {1.0f, 1.5f, 0.1f, 100.0f};
    EnfEntity root = {{1, 1, 1},
                      {0, 0, 0, 1},
                      {1, 1, 1},
                      enf_maker_string(m, "lift"),
                      enf_maker_string(m, "func_lift"),
                      enf_maker_string(m, "{\"speed\":2}"),
                      ENF_NONE,
                      cell,
                      enf_maker_camera(m, &camera),
                      0};
    EnfEntity child = root;
    child.parent = enf_maker_entity(m, &root);
    enf_maker_entity(m, &child);
    EnfPath path = {enf_maker_string(m, "up"), 0, ENF_PATH_TRANSLATION, ENF_PATH_LINEAR, 2, 0};
    const float floats[] = {0.0f, 1.0f, 0, 0, 0, 0, 2, 0};
    enf_maker_path(m, &path, floats, 8);
    EnfPath turn = {path.name, 1, ENF_PATH_ROTATION, ENF_PATH_CUBIC, 1, 0};
    const float turn_floats[13] = {0.5f, [8] = 1.0f};
    enf_maker_path(m, &turn, turn_floats, 13);
    put_movers(m);
}

/* Two rooms in a row, a cupboard in one of them, a mirror, a pair of teleports, a light through a window. */
EnfMaker *enf_everything_create(EnfError *error) {
    EnfMaker *m = enf_maker_create();
    uint32_t a, b, cupboard;
    enf_maker_cell(m, "hall-room", enf_v3(0, 0, 0), &a);
    enf_maker_light(m, a, enf_v3(1, 2, 1), (EnfVec3f){1, 1, 1}, 10);
    enf_maker_cell(m, "study_Room", enf_v3(4, 0, 0), &b);
    enf_maker_light(m, b, enf_v3(6, 2, 1), (EnfVec3f){1, 1, 1}, 10);
    const EnfPlane4f window[2] = {{{1, 0, 0}, 0}, {{0, 1, 0}, 1}};
    enf_maker_light_window(m, window, 2);
    enf_maker_cell(m, "cupboard", enf_v3(1, 0, 1), &cupboard)->priority = 1;
    enf_maker_bound(m, enf_v3(1, 0, 0), enf_v3(2, 0, 1));
    enf_maker_bound(m, enf_v3(-1, 0, 0), enf_v3(1, 0, 1));
    enf_maker_bound(m, enf_v3(0, 1, 0), enf_v3(1, 1, 1));
    enf_maker_bound(m, enf_v3(0, -1, 0), enf_v3(1, 0, 1));
    enf_maker_bound(m, enf_v3(0, 0, 1), enf_v3(1, 0, 2));
    enf_maker_bound(m, enf_v3(0, 0, -1), enf_v3(1, 0, 1));
    put_tables(m, a);
    enf_maker_box(m, a, 0, (EnfBox3){{0, 0, 0}, {4, 3, 4}}, true);
    enf_maker_box(m, b, 0, (EnfBox3){{4, 0, 0}, {8, 3, 4}}, true);
    enf_maker_group(m);
    enf_maker_box(m, cupboard, 1, (EnfBox3){{1.25, 0.25, 1.25}, {1.75, 0.75, 1.75}}, false);
    enf_maker_reach(m, a);
    const EnfVec3 door[4] = {{4, 0, 1}, {4, 2, 1}, {4, 2, 2}, {4, 0, 2}};
    enf_maker_portal(m, "door-portal", a, b, door, 4, 0);
    enf_maker_portal(m, "link", a, cupboard, NULL, 0, ENF_PORTAL_OVERLAP);
    const EnfVec3 glass[3] = {{0, 1, 1}, {0, 2, 1}, {0, 1, 2}};
    EnfAffine flip = enf_affine_identity();
    flip.m[0] = -1;
    enf_maker_teleport(m, a, a, glass, 3, &flip, ENF_NONE);
    const EnfVec3 there[3] = {{8, 0, 1}, {8, 1, 1}, {8, 1, 2}}, back[3] = {{0, 1, 3}, {0, 1, 2}, {0, 0, 3}};
    EnfAffine shift = enf_affine_identity(), unshift = enf_affine_identity();
    shift.t = enf_v3(-8, 0, 0);
    unshift.t = enf_v3(8, 0, 0);
    uint32_t one = enf_maker_teleport(m, b, a, there, 3, &shift, ENF_NONE);
    enf_maker_teleport(m, a, b, back, 3, &unshift, one);
    if (!enf_maker_finish(m, error)) {
        enf_maker_destroy(m);
        return NULL;
    }
    return m;
}

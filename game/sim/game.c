/* Game: memory, start, the order of a tick, and the hash of it all. */
#include "sim/sim.h"

#include <string.h>

#define DEGREE ((double)ENF_INPUT_DEGREE)
enum { MESSAGE_TICKS = 240, EXHIBITS_WANTED = 6 };

GameDef game_def_default(void) {
    GameDef def;
    memset(&def, 0, sizeof def);
    def.seed = 1;
    return def;
}

const char *game_sound_file(GameSoundKind kind) {
    static const char *const files[GAME_SOUND_COUNT] = {
#define GAME_SOUND_FILE(name, file) file,
        GAME_SOUNDS(GAME_SOUND_FILE)
#undef GAME_SOUND_FILE
    };
    return kind < GAME_SOUND_COUNT ? files[kind] : "";
}

/* ---- small things ------------------------------------------------------------------------------------------------- */

int64_t sim_tick(const Game *game) {
    return enf_world_tick(game->world) - game->begin;
}

int64_t sim_world_tick(const Game *game) {
    return enf_world_tick(game->world);
}

uint32_t sim_feet_cell(const Game *game, const EnfCharacter *body) {
    EnfVec3 feet = enf_add(body->position, enf_v3(0.0, 0.35, 0.0));
    return body->cell == ENF_NONE ? enf_map_locate(game->map, feet)
                                  : enf_map_track(game->map, body->cell, enf_character_eye(body), feet);
}

/* xorshift64*, Vigna 2016. */
uint64_t sim_random(Game *game) {
    game->random ^= game->random >> 12;
    game->random ^= game->random << 25;
    game->random ^= game->random >> 27;
    return game->random * UINT64_C(2685821657736338717);
}

void sim_say(Game *game, const char *text) {
    size_t length = strlen(text);
    length = length < GAME_TEXT_SIZE ? length : GAME_TEXT_SIZE - 1;
    memcpy(game->shown.message, text, length);
    game->shown.message[length] = '\0';
    game->message_until = sim_tick(game) + MESSAGE_TICKS;
}

void sim_sound(Game *game, GameSoundKind kind, EnfVec3 at_ws, uint32_t cell, double loudness) {
    if (game->sound_count < SIM_SOUNDS_MAX) {
        game->sound_cells[game->sound_count] = cell;
        game->sounds[game->sound_count++] = (GameSound){kind, at_ws, loudness, 0.0, at_ws, 0.0};
    }
}

EnfVec3 sim_look(double yaw_deg, double pitch_deg) {
    double yaw = yaw_deg * (ENF_PI / 180.0), pitch = pitch_deg * (ENF_PI / 180.0);
    return enf_v3(-enf_sin(yaw) * enf_cos(pitch), enf_sin(pitch), -enf_cos(yaw) * enf_cos(pitch));
}

double sim_yaw(EnfQuat q) {
    double dx = -2.0 * (q.x * q.z + q.w * q.y), dz = -(1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return enf_atan2(-dx, -dz) * (180.0 / ENF_PI);
}

/* ---- where it begins ---------------------------------------------------------------------------------------------- */

static uint32_t largest_cell(const EnfMap *map) {
    uint32_t best = 0;
    double most = -1.0;
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *c = &map->cells[i];
        double size = (double)(c->max[0] - c->min[0]) * (double)(c->max[1] - c->min[1]) * (double)(c->max[2] - c->min[2]);
        if (!(c->flags & ENF_CELL_OUTSIDE) && size > most) {
            most = size;
            best = i;
        }
    }
    return best;
}

/* `info_player_start`, else the first camera (an eye: its feet are below), else the middle of the largest cell. */
static void find_spawn(Game *game) {
    const EnfMap *map = game->map;
    const EnfEntity *start = NULL, *camera = NULL;
    for (uint32_t i = 0; i < map->entities_count; i++) {
        const EnfEntity *e = &map->entities[i];
        const char *name = enf_map_string(map, e->classname);
        start = !start && strcmp(name, "info_player_start") == 0 ? e : start;
        camera = !camera && e->camera != ENF_NONE ? e : camera;
    }
    const EnfEntity *at = start ? start : camera;
    if (at) {
        double drop = start ? 0.0 : 1.6;
        game->spawn = enf_v3(at->translation[0], at->translation[1] - drop, at->translation[2]);
        const float *q = at->rotation;
        EnfQuat turn = {(double)q[0], (double)q[1], (double)q[2], (double)q[3]};
        game->spawn_yaw = (int32_t)(sim_yaw(turn) * DEGREE);
    } else if (map->cells_count > 0) {
        const EnfCell *c = &map->cells[largest_cell(map)];
        game->spawn = enf_v3(c->origin[0] + 0.5 * (double)(c->min[0] + c->max[0]), c->origin[1] + (double)c->min[1] + 0.1,
                             c->origin[2] + 0.5 * (double)(c->min[2] + c->max[2]));
    }
}

static void find_exit(Game *game) {
    game->exit_ws = enf_box3_empty();
    for (uint32_t i = 0; i < game->map->entities_count; i++) {
        const EnfEntity *e = &game->map->entities[i];
        if (strcmp(enf_map_string(game->map, e->classname), "trigger_exit") == 0) {
            EnfVec3 at = enf_v3(e->translation[0], e->translation[1], e->translation[2]);
            EnfVec3 half = enf_v3((double)e->scale[0], (double)e->scale[1], (double)e->scale[2]);
            game->exit_ws = (EnfBox3){enf_sub(at, half), enf_add(at, half)};
        }
    }
}

/* ---- life ----------------------------------------------------------------------------------------------------------- */

#define GAME_ARRAYS(X)                                                                                                         \
    X(doors, game->mover_room)                                                                                                 \
    X(lifts, game->mover_room)                                                                                                 \
    X(buttons, game->mover_room)                                                                                               \
    X(items, game->mover_room)                                                                                                 \
    X(item_objects, game->mover_room)                                                                                          \
    X(guards, game->mover_room)                                                                                                \
    X(guard_views, game->mover_room)                                                                                           \
    X(exhibit_views, game->mover_room)                                                                                         \
    X(gates, game->map->portals_count)                                                                                         \
    X(ways.distance, game->map->portals_count)                                                                                 \
    X(ways.before, game->map->portals_count)                                                                                   \
    X(ways.heap, game->map->portals_count)                                                                                     \
    X(ways.place, game->map->portals_count)                                                                                    \
    X(ears.distance, game->map->portals_count)                                                                                 \
    X(ears.before, game->map->portals_count)                                                                                   \
    X(ears.heap, game->map->portals_count)                                                                                     \
    X(ears.place, game->map->portals_count)

static EnfResult make(Game *game, EnfError *error) {
    bool ok = true;
#define GAME_MAKE(array, count)                                                                                                \
    game->array = enf_alloc(&game->allocator, (count), sizeof *game->array);                                                   \
    ok = ok && (game->array || (count) == 0);
    GAME_ARRAYS(GAME_MAKE)
#undef GAME_MAKE
    if (!ok) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a game of %u movers", game->mover_room);
    }
    const EnfAllocator *allocator = &game->allocator;
    EnfResult result = enf_world_create(&game->world, game->map, game->map->movers_count, allocator, error);
    result = result ? result : enf_world_populate(game->world, error);
    result = result ? result : enf_portals_create(&game->portals, game->map, allocator, error);
    result = result ? result : enf_vis_create(&game->eyes, game->map, allocator, error);
    return result ? result : enf_collider_create(&game->collider, game->map, game->world, allocator, error);
}

/* Everything as at tick 0, in the order in which things depend on one another. */
static void start(Game *game) {
    game->random = game->def.seed * UINT64_C(0x9e3779b97f4a7c15) + 1;
    game->random = game->random ? game->random : 1;
    memset(&game->score, 0, sizeof game->score);
    memset(&game->shown, 0, sizeof game->shown);
    game->sound_count = 0;
    game->message_until = 0;
    sim_doors_start(game);
    sim_lifts_start(game);
    sim_items_start(game);
    sim_guards_start(game);
    sim_player_start(game);
    uint32_t exhibits = 0;
    for (uint32_t i = 0; i < game->item_count; i++) {
        exhibits += !game->items[i].is_key;
    }
    uint32_t wanted = game->def.exhibits_wanted ? game->def.exhibits_wanted : EXHIBITS_WANTED;
    game->score.wanted = wanted < exhibits ? wanted : exhibits;
    sim_show(game);
}

EnfResult game_create(Game **out, const EnfMap *map, const GameDef *def, const EnfAllocator *allocator, EnfError *error) {
    ENF_ASSERT(out && map && def);
    *out = NULL;
    Game *game = enf_alloc(allocator, 1, sizeof *game);
    if (!game) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a game");
    }
    game->allocator = *(allocator ? allocator : enf_default_allocator());
    game->map = map;
    game->def = *def;
    game->mover_room = map->movers_count;
    EnfResult result = make(game, error);
    if (result == ENF_OK && !sim_speakers_create(game)) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for what sounds by itself");
    }
    if (result != ENF_OK) {
        game_destroy(game);
        return result;
    }
    sim_gates_find(game);
    find_spawn(game);
    find_exit(game);
    game->usual_light = sim_usual_light(game);
    start(game);
    *out = game;
    return ENF_OK;
}

void game_destroy(Game *game) {
    if (!game) {
        return;
    }
    EnfAllocator allocator = game->allocator;
    enf_collider_destroy(game->collider);
    enf_vis_destroy(game->eyes);
    enf_portals_destroy(&game->portals);
    enf_world_destroy(game->world);
#define GAME_FREE(array, count) enf_free(&allocator, game->array, (count), sizeof *game->array);
    GAME_ARRAYS(GAME_FREE)
#undef GAME_FREE
    enf_free(&allocator, game->speakers, game->speaker_room, sizeof *game->speakers);
    enf_free(&allocator, game, 1, sizeof *game);
}

/* Every mover as the map has it, its time 0 now. What was carried away is added anew. */
static void put_back(Game *game) {
    int64_t tick = sim_world_tick(game);
    for (uint32_t i = 0; i < game->item_count; i++) {
        SimItem *item = &game->items[i];
        if (item->state == SIM_ITEM_LIES) {
            enf_world_remove(game->world, game->item_objects[i]);
        }
        EnfObjectDef def = enf_mover_def(game->map, item->mover);
        game->item_objects[i] = enf_world_add(game->world, &def, NULL);
    }
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        if (game->map->movers[i].flags & ENF_MOVER_CARRY) {
            continue;
        }
        EnfMotion motion = enf_mover_def(game->map, i).motion;
        if (motion.kind == ENF_MOTION_PATH) {
            motion.as.path.start_tick += tick;
        }
        enf_world_set_motion(game->world, enf_world_object(game->world, i), &motion);
    }
}

void game_restart(Game *game) {
    enf_world_advance(game->world,
                      1); /* its list of changes is of one tick: restarts without end would lengthen it without end */
    put_back(game);
    game->begin = sim_world_tick(game);
    enf_collider_reset(game->collider);
    start(game);
}

/* ---- a tick ----------------------------------------------------------------------------------------------------------- */

static bool over(const Game *game) {
    return game->score.phase != GAME_PLAYING;
}

void game_step(Game *game, const EnfInput *input) {
    if (input->buttons & GAME_BUTTON_RESTART) {
        game_restart(game);
        return;
    }
    static const EnfInput nothing;
    game->sound_count = 0;
    game->ears_ready = false;
    game->shown.eye_before_ws = game->shown.eye_ws;
    game->shown.yaw_before_deg = game->shown.yaw_deg;
    game->shown.pitch_before_deg = game->shown.pitch_deg;
    enf_world_advance(game->world, 1);
    game->score.tick++;
    sim_lifts_step(game);
    sim_player_step(game, over(game) ? &nothing : input);
    sim_doors_step(game);
    sim_items_step(game);
    if (!over(game)) {
        sim_guards_step(game);
    }
    for (uint32_t i = 0; i < game->sound_count; i++) {
        sim_hear(game, &game->sounds[i], game->sound_cells[i]);
    }
    sim_show(game);
}

/* ---- hashes ------------------------------------------------------------------------------------------------------------ */

static uint64_t portals_hash(const Game *game) {
    uint64_t hash = ENF_HASH_START;
    for (uint32_t i = 0; i < game->portals.count; i++) {
        uint16_t flags = game->portals.states[i].flags;
        hash = enf_hash64(hash, &flags, sizeof flags);
    }
    return hash;
}

/* The places of everything in the world at this tick. Only items come and go, so all else has the index of its mover. */
static uint64_t objects_hash(const Game *game) {
    uint64_t hash = ENF_HASH_START;
    for (uint32_t i = 0; i < game->map->movers_count; i++) {
        if (!(game->map->movers[i].flags & ENF_MOVER_CARRY)) {
            EnfPose pose = enf_world_pose(game->world, i);
            hash = enf_hash64(hash, &pose, sizeof pose);
        }
    }
    for (uint32_t i = 0; i < game->item_count; i++) {
        if (game->items[i].state == SIM_ITEM_LIES) {
            EnfPose pose = enf_world_pose(game->world, game->item_objects[i].index);
            hash = enf_hash64(hash, &pose, sizeof pose);
        }
    }
    return hash;
}

#define HASH_OF(array, count) enf_hash64(ENF_HASH_START, (array), (count) * sizeof *(array))

/* The guards, and how far their search for footholds is. */
static uint64_t guards_hash(const Game *game) {
    const uint32_t search[] = {game->foot_guard, game->foot_guard == ENF_NONE ? 0 : game->foot.node_count};
    return enf_hash64(HASH_OF(game->guards, game->guard_count), search, sizeof search);
}

uint32_t game_fields(const Game *game, GameField out[GAME_FIELDS_MAX]) {
    const GameField fields[] = {
        {"tick", HASH_OF(&game->score.tick, 1)},
        {"player", HASH_OF(&game->player, 1)},
        {"guards", guards_hash(game)},
        {"doors", HASH_OF(game->doors, game->door_count)},
        {"portals", portals_hash(game)},
        {"lifts", HASH_OF(game->lifts, game->lift_count)},
        {"items", HASH_OF(game->items, game->item_count)},
        {"objects", objects_hash(game)},
        {"score", HASH_OF(&game->score, 1)},
        {"random", HASH_OF(&game->random, 1)},
    };
    memcpy(out, fields, sizeof fields);
    return sizeof fields / sizeof *fields;
}

uint64_t game_hash(const Game *game) {
    GameField fields[GAME_FIELDS_MAX];
    uint32_t count = game_fields(game, fields);
    uint64_t hash = ENF_HASH_START;
    for (uint32_t i = 0; i < count; i++) {
        hash = enf_hash64(hash, &fields[i].hash, sizeof fields[i].hash);
    }
    return hash;
}

EnfWorld *game_world(Game *game) {
    return game->world;
}

const EnfPortals *game_portals(const Game *game) {
    return &game->portals;
}

const GameState *game_state(const Game *game) {
    return &game->shown;
}

const GameSound *game_sounds(const Game *game, uint32_t *count) {
    *count = game->sound_count;
    return game->sounds;
}

/* A visitor as the simulation: the engine's own walking body in the level, doors and lifts that it uses, and all that moves by
 * itself. No rules, no aims. */
#include "enfreplay/sim.h"

#include <enfilade/collide.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "enfreplay/doors.h"

struct Sim {
    const EnfMap *map;
    EnfWorld *world;
    EnfCollider *collider;
    EnfPortals portals;
    Doors doors;
    EnfCharacter body;
    int64_t yaw, pitch; /* 1/65536 degree; yaw in [0, 360), pitch in [-89, 89] */
    uint32_t buttons;   /* of the last tick */
    uint32_t mode;      /* EnfCharacterMode */
    uint64_t tick;
};

struct SimBot {
    int unused;
};

static const int64_t TURN = INT64_C(360) * ENF_INPUT_DEGREE, STEEPEST = INT64_C(89) * ENF_INPUT_DEGREE;

const char *sim_game(void) {
    return "visitor 2";
}

/* ---- start ------------------------------------------------------------------------------------------------------ */

/* "at=X,Y,Z", finite. */
static bool parse_at(const char *start, double at[3]) {
    if (strncmp(start, "at=", 3) != 0) {
        return false;
    }
    const char *text = start + 3;
    for (int i = 0; i < 3; i++) {
        char *end;
        at[i] = strtod(text, &end);
        if (end == text || *end != (i < 2 ? ',' : '\0') || !isfinite(at[i])) {
            return false;
        }
        text = end + 1;
    }
    return true;
}

/* "at=X,Y,Z" of `start`; else the map's player start; else the middle of its first cell. */
static EnfVec3 place_of(const EnfMap *map, const char *start) {
    double at[3];
    if (parse_at(start, at)) {
        return enf_v3(at[0], at[1], at[2]);
    }
    for (uint32_t i = 0; i < map->entities_count; i++) {
        const double *t = map->entities[i].translation;
        if (strcmp(enf_map_string(map, map->entities[i].classname), "info_player_start") == 0) {
            return enf_v3(t[0], t[1], t[2]);
        }
    }
    const EnfCell *cell = &map->cells[0];
    double middle[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = cell->origin[i] + (double)(cell->min[i] + cell->max[i]) / 2.0;
    }
    return enf_v3(middle[0], middle[1], middle[2]);
}

EnfResult sim_create(Sim **sim, const EnfMap *map, const EnfReplayHeader *header, EnfError *error) {
    *sim = NULL;
    Sim *made = enf_alloc(NULL, 1, sizeof *made);
    if (!made) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for a simulation");
    }
    made->map = map;
    made->mode = ENF_CHARACTER_WALK;
    EnfResult result;
    if ((result = enf_portals_create(&made->portals, map, NULL, error)) != ENF_OK ||
        (result = enf_world_create(&made->world, map, map->movers_count, NULL, error)) != ENF_OK ||
        (result = enf_world_populate(made->world, error)) != ENF_OK ||
        (result = doors_create(&made->doors, made->world, &made->portals, error)) != ENF_OK ||
        (result = enf_collider_create(&made->collider, map, made->world, NULL, error)) != ENF_OK) {
        sim_destroy(made);
        return result;
    }
    EnfCharacterDef def = enf_character_def_default();
    enf_character_spawn(&made->body, made->collider, &def, place_of(map, header->start));
    *sim = made;
    return ENF_OK;
}

void sim_destroy(Sim *sim) {
    if (sim) {
        enf_collider_destroy(sim->collider);
        doors_destroy(&sim->doors);
        enf_world_destroy(sim->world);
        enf_portals_destroy(&sim->portals);
        enf_free(NULL, sim, 1, sizeof *sim);
    }
}

/* ---- ticks ------------------------------------------------------------------------------------------------------ */

static void turn(Sim *sim, const EnfInput *input) {
    int64_t yaw = (sim->yaw + input->yaw) % TURN, pitch = sim->pitch + input->pitch;
    sim->yaw = yaw < 0 ? yaw + TURN : yaw;
    sim->pitch = pitch > STEEPEST ? STEEPEST : pitch < -STEEPEST ? -STEEPEST : pitch;
}

static double radians(int64_t angle) {
    return (double)angle * (3.14159265358979323846 / 180.0 / ENF_INPUT_DEGREE);
}

static EnfVec3 wish_of(const Sim *sim, const EnfInput *input) {
    double ahead = (double)input->forward / 32768.0, aside = (double)input->right / 32768.0;
    double sine = enf_sin(radians(sim->yaw)), cosine = enf_cos(radians(sim->yaw));
    double level = sim->mode == ENF_CHARACTER_WALK ? 1.0 : enf_cos(radians(sim->pitch));
    double up = sim->mode == ENF_CHARACTER_WALK ? 0.0 : enf_sin(radians(sim->pitch)) * ahead;
    EnfVec3 wish = enf_v3(-sine * ahead * level + cosine * aside, up, -cosine * ahead * level - sine * aside);
    double length = enf_length(wish);
    return length > 1.0 ? enf_scale(wish, 1.0 / length) : wish;
}

static void use(Sim *sim) {
    double level = enf_cos(radians(sim->pitch));
    EnfVec3 forward = enf_v3(-enf_sin(radians(sim->yaw)) * level, enf_sin(radians(sim->pitch)),
                             -enf_cos(radians(sim->yaw)) * level);
    doors_use(&sim->doors, enf_character_eye(&sim->body), forward, sim->body.ground_object);
}

void sim_step(Sim *sim, const EnfInput *input) {
    uint32_t pressed = input->buttons & ~sim->buttons;
    if (pressed & (ENF_BUTTON_NOCLIP | ENF_BUTTON_FLY)) {
        uint32_t wanted = pressed & ENF_BUTTON_NOCLIP ? ENF_CHARACTER_NOCLIP : ENF_CHARACTER_FLY;
        sim->mode = sim->mode == wanted ? ENF_CHARACTER_WALK : wanted;
    }
    turn(sim, input);
    enf_world_advance(sim->world, 1);
    EnfCharacterInput told = {wish_of(sim, input), (input->buttons & ENF_BUTTON_JUMP) != 0,
                              (input->buttons & ENF_BUTTON_CROUCH) != 0, (input->buttons & ENF_BUTTON_RUN) != 0,
                              (EnfCharacterMode)sim->mode};
    EnfCharacterReport report;
    if (pressed & ENF_BUTTON_USE) {
        use(sim);
    }
    enf_character_move(&sim->body, sim->collider, &told, &report);
    doors_tick(&sim->doors, sim->body.position, report.moved & ENF_MOVED_SQUEEZED ? report.squeezed_by : ENF_NONE);
    sim->buttons = input->buttons;
    sim->tick++;
}

/* ---- what others see of it -------------------------------------------------------------------------------------- */

enum { FIELD_BODY, FIELD_EYE, FIELD_CELL, FIELD_DOORS, FIELD_TIME, FIELD_COUNT };

void sim_name_fields(const Sim *sim, EnfReplayHeader *header) {
    static const char *const names[FIELD_COUNT] = {"body", "eye", "cell", "doors", "time"};
    (void)sim;
    header->field_count = FIELD_COUNT;
    for (int i = 0; i < FIELD_COUNT; i++) {
        snprintf(header->fields[i], ENF_REPLAY_NAME_SIZE, "%s", names[i]);
    }
}

void sim_fields(const Sim *sim, uint64_t hashes[ENF_REPLAY_FIELDS_MAX]) {
    const EnfVec3 eye = enf_character_eye(&sim->body);
    const int64_t gaze[4] = {sim->yaw, sim->pitch, sim->buttons, sim->mode};
    hashes[FIELD_BODY] = enf_hash64(ENF_HASH_START, &sim->body, sizeof sim->body);
    hashes[FIELD_EYE] = enf_hash64(enf_hash64(ENF_HASH_START, &eye, sizeof eye), gaze, sizeof gaze);
    hashes[FIELD_CELL] = enf_hash64(ENF_HASH_START, &sim->body.cell, sizeof sim->body.cell);
    hashes[FIELD_DOORS] = doors_hash(&sim->doors);
    hashes[FIELD_TIME] = enf_hash64(ENF_HASH_START, &sim->tick, sizeof sim->tick);
}

uint64_t sim_hash(const Sim *sim) {
    uint64_t hashes[ENF_REPLAY_FIELDS_MAX];
    sim_fields(sim, hashes);
    return enf_hash64(ENF_HASH_START, hashes, FIELD_COUNT * sizeof *hashes);
}

SimEye sim_eye(const Sim *sim) {
    SimEye eye = {enf_character_eye(&sim->body), (double)sim->yaw / ENF_INPUT_DEGREE, (double)sim->pitch / ENF_INPUT_DEGREE,
                  sim->body.cell};
    return eye;
}

EnfWorld *sim_world(Sim *sim) {
    return sim->world;
}

const EnfPortals *sim_portals(const Sim *sim) {
    return &sim->portals;
}

const char *sim_phase(const Sim *sim) {
    return sim->body.cell == ENF_NONE ? "outside" : enf_map_string(sim->map, sim->map->cells[sim->body.cell].name);
}

/* ---- no bot ----------------------------------------------------------------------------------------------------- */

EnfResult sim_bot_create(SimBot **bot, Sim *sim, const char *script, size_t size, EnfError *error) {
    (void)sim;
    (void)script;
    (void)size;
    *bot = NULL;
    return enf_error_set(error, ENF_ERROR_UNSUPPORTED, UINT64_MAX,
                         "not a script of inputs: it does not begin with \"enfinput 1\"");
}

void sim_bot_destroy(SimBot *bot) {
    (void)bot;
}

bool sim_bot_next(SimBot *bot, EnfInput *input, EnfResult *result, EnfError *error) {
    (void)bot;
    (void)input;
    (void)result;
    (void)error;
    return false;
}

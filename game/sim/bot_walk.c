/* A bot on its way: the portal graph's route from doorway to doorway, footholds from one to the next, doors opened where they bar it. */
#include "sim/bot_internal.h"

#include <math.h>
#include <string.h>

enum { TRIP_TICKS = 240 * ENF_TICK_RATE, SNEAK_TICKS = 900 * ENF_TICK_RATE, STILL_TICKS = 45, REST_TICKS = 30, TRIES = 24 };
enum { LOCKED_TRIES = 3 };
/* Degrees that it turns in a tick, at most; and that count as looking there. */
#define TURN_RATE 7.0
#define TURN_NEAR 1.0
/* Metres: a foothold is passed; a point of the route is passed; how far ahead a door is opened. */
#define FOOT_NEAR 0.15
#define GATE_NEAR 0.4
#define DOOR_AHEAD 1.5
#define LEAF_BESIDE 1.0

static double flat(EnfVec3 a, EnfVec3 b) {
    double x = a.x - b.x, z = a.z - b.z;
    return sqrt(x * x + z * z);
}

static int32_t units(double degrees) {
    double most = fmin(fmax(degrees, -TURN_RATE), TURN_RATE);
    return (int32_t)floor(most * ENF_INPUT_DEGREE + 0.5);
}

bool bot_look(const GameBot *bot, EnfVec3 at, EnfInput *input) {
    const SimPlayer *player = &bot->game->player;
    EnfVec3 way = enf_sub(at, enf_character_eye(&player->body));
    double away = sqrt(way.x * way.x + way.z * way.z);
    double yaw = away > 0.05 ? enf_atan2(-way.x, -way.z) * (180.0 / ENF_PI) - (double)player->yaw / ENF_INPUT_DEGREE : 0.0;
    double pitch = enf_atan2(way.y, away) * (180.0 / ENF_PI) - (double)player->pitch / ENF_INPUT_DEGREE;
    yaw -= 360.0 * floor(yaw / 360.0 + 0.5);
    input->yaw = units(yaw);
    input->pitch = units(pitch);
    return fabs(yaw) < TURN_NEAR && fabs(pitch) < TURN_NEAR;
}

void bot_head_for(const GameBot *bot, EnfVec3 at, EnfInput *input) {
    const SimPlayer *player = &bot->game->player;
    EnfVec3 feet = player->body.position, way = enf_normalize(enf_v3(at.x - feet.x, 0.0, at.z - feet.z));
    double yaw = ((double)player->yaw + (double)input->yaw) / ENF_INPUT_DEGREE;
    input->forward = (int16_t)floor(enf_dot(way, sim_look(yaw, 0.0)) * 32767.0);
    input->right = (int16_t)floor(enf_dot(way, sim_look(yaw - 90.0, 0.0)) * 32767.0);
}

void bot_trip_start(GameBot *bot, EnfVec3 to, uint32_t cell, double near, bool enter) {
    memset(&bot->trip, 0, sizeof bot->trip);
    bot->trip.to = to;
    bot->trip.cell = cell;
    bot->trip.near = near;
    bot->trip.enter = enter;
    bot->trip.least = HUGE_VAL;
    bot->trip.shun = ENF_NONE;
    bot->sneak.waited = 0;
    bot->foot.path_count = 0;
}

/* ---- doors on the way ------------------------------------------------------------------------------------------------------ */

/* The door that stands shut between the feet and a place, near the feet; or one that is on its way. */
static uint32_t door_before(const GameBot *bot, EnfVec3 to) {
    Game *game = bot->game;
    EnfVec3 feet = game->player.body.position, way = enf_sub(to, feet);
    double away = enf_length(way);
    EnfVec3 end = away > DOOR_AHEAD ? enf_add(feet, enf_scale(way, DOOR_AHEAD / away)) : to;
    return sim_door_between(game, feet, end);
}

static EnfVec3 middle_of(const Game *game, uint32_t door) {
    EnfBox3 box = enf_box3_from_f(enf_world_box(game->world, game->doors[door].object.index));
    return enf_scale(enf_add(box.min, box.max), 0.5);
}

/* Stands, looks at the door and uses it if it is shut. False if it is locked. */
static bool open_door(GameBot *bot, uint32_t door, EnfInput *input) {
    BotTrip *trip = &bot->trip;
    const SimDoor *d = &bot->game->doors[door];
    bool aimed = bot_look(bot, middle_of(bot->game, door), input);
    if (d->wanted != 0.0) { /* opens already */
        trip->pressed = false;
        return true;
    }
    if (trip->pressed && d->locked && !d->moving &&
        ++trip->locked >= LOCKED_TRIES) { /* the first may have taken a thing beside it */
        return false;
    }
    trip->pressed = aimed && !trip->pressed;
    input->buttons |= trip->pressed ? ENF_BUTTON_USE : 0;
    return true;
}

bool bot_opens_door(GameBot *bot, EnfVec3 to, EnfInput *input) {
    uint32_t door = door_before(bot, to);
    return door != ENF_NONE && open_door(bot, door, input);
}

/* ---- the way ------------------------------------------------------------------------------------------------------------------ */

/* The next place of the route that is not reached yet; `*last` if it is the end. */
static EnfVec3 next_stop(GameBot *bot, bool *last) {
    Game *game = bot->game;
    BotTrip *trip = &bot->trip;
    const EnfCharacter *body = &game->player.body;
    SimErrand errand = {body->position, trip->to, sim_feet_cell(game, body), trip->cell, trip->shun};
    SimWay *way = &bot->way;
    uint32_t i = 0;
    bool leads = sim_route(game, &errand, way);
    if (!leads && trip->shun != ENF_NONE) { /* no other way */
        errand.shun = trip->shun = ENF_NONE;
        leads = sim_route(game, &errand, way);
    }
    while (i + 1 < way->count && flat(way->at[i], body->position) < GATE_NEAR) {
        i++;
    }
    way->next = i;
    *last = !leads || i + 1 == way->count;
    return leads ? way->at[i] : trip->to;
}

static bool arrived(const GameBot *bot) {
    const EnfCharacter *body = &bot->game->player.body;
    const BotTrip *trip = &bot->trip;
    if (trip->enter) {
        return body->cell == trip->cell;
    }
    return flat(body->position, trip->to) <= trip->near && fabs(body->position.y - trip->to.y) < 2.0;
}

/* Does a leaf swing or slide beside the feet? Where it is now, it will not be when one gets there. */
static bool leaf_moves_beside(const Game *game) {
    EnfVec3 feet = game->player.body.position, knee = enf_v3(feet.x, feet.y + 0.5, feet.z);
    for (uint32_t i = 0; i < game->door_count; i++) {
        EnfBox3 box = enf_box3_from_f(enf_world_box(game->world, game->doors[i].object.index));
        EnfVec3 at = enf_v3(fmin(fmax(knee.x, box.min.x), box.max.x), fmin(fmax(knee.y, box.min.y), box.max.y),
                            fmin(fmax(knee.z, box.min.z), box.max.z));
        if (game->doors[i].moving && enf_length(enf_sub(at, knee)) < LEAF_BESIDE) {
            return true;
        }
    }
    return false;
}

/* A new path of footholds; false if the bot gives up. */
static bool plan(GameBot *bot, EnfInput *input, const char **why) {
    BotTrip *trip = &bot->trip;
    bool last;
    EnfVec3 stop = next_stop(bot, &last);
    uint32_t door = door_before(bot, stop);
    if (door != ENF_NONE) {
        *why = "a door on the way is locked";
        return open_door(bot, door, input);
    }
    if (leaf_moves_beside(bot->game)) {
        trip->rest = REST_TICKS / 4;
        return true;
    }
    trip->at = trip->still = 0;
    bool leads = sim_foot_find(&bot->foot, bot->game->collider, &bot->game->player.body, stop, last ? 0.8 * trip->near : 0.2);
    bool moves = bot->foot.path_count > 2;
    trip->tries = leads || moves ? trip->tries : trip->tries + 1;
    trip->rest = leads ? 0 : REST_TICKS / 4;
    *why = "no way on foot leads there";
    return trip->tries < TRIES;
}

static void follow(GameBot *bot, EnfInput *input) {
    BotTrip *trip = &bot->trip;
    const SimFoot *foot = &bot->foot;
    EnfVec3 feet = bot->game->player.body.position;
    trip->still++;
    for (uint32_t i = trip->at; i < foot->path_count && i < trip->at + 4; i++) {
        if (flat(foot->path[i], feet) < FOOT_NEAR) {
            trip->at = i + 1;
            trip->still = 0;
        }
    }
    if (trip->at >= foot->path_count || trip->still > STILL_TICKS) {
        trip->tries += trip->still > STILL_TICKS;
        trip->rest = trip->still > STILL_TICKS ? REST_TICKS : trip->rest; /* somebody is in the way: let him pass */
        bot->foot.path_count = 0;
        return;
    }
    uint32_t ahead = trip->at + 5 < foot->path_count ? trip->at + 5 : foot->path_count - 1;
    EnfVec3 eye = enf_character_eye(&bot->game->player.body), at = foot->path[ahead];
    bot_look(bot, enf_v3(at.x, eye.y + (at.y - feet.y), at.z), input);
    bot_head_for(bot, foot->path[trip->at], input);
    if (trip->tries > 0 && trip->still == STILL_TICKS / 2 &&
        !bot->sneak.on) { /* footholds lead over a rim that feet catch on */
        input->buttons |= ENF_BUTTON_JUMP;
    }
}

GameBotNews bot_trip_step(GameBot *bot, EnfInput *input, const char **why) {
    BotTrip *trip = &bot->trip;
    if (arrived(bot)) {
        return GAME_BOT_DONE;
    }
    *why = "it takes too long";
    if (++trip->ticks > (bot->sneak.on ? SNEAK_TICKS : TRIP_TICKS)) {
        return GAME_BOT_FAILED;
    }
    if (bot->sneak.on) {
        bool last;
        if (bot_sneak_decides(bot)) {
            next_stop(bot, &last);
        }
        if (bot_sneak(bot, input) != BOT_GOES) {
            trip->rest = 0;
            return GAME_BOT_GOES_ON;
        }
    }
    if (trip->rest > 0) {
        trip->rest--;
        return GAME_BOT_GOES_ON;
    }
    if (bot->foot.path_count == 0 && !plan(bot, input, why)) {
        return GAME_BOT_FAILED;
    }
    if (bot->foot.path_count > 0) {
        follow(bot, input);
    }
    return GAME_BOT_GOES_ON;
}

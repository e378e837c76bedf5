/* A bot that keeps out of sight: it knows where each guard's round takes it in the next seconds, asks the game's own rule what that guard
 * would then see and hear, and goes on, waits, goes back or steps aside, whichever is noticed least. */
#include "sim/bot_internal.h"

#include <math.h>
#include <string.h>

enum { MOMENT_TICKS = 15, DECIDE_EVERY = 12, LINE_MAX = 160, ASIDES = 24 };
/* Moments that count for going somewhere; to stay in a place all do: until who walks by has walked by. */
enum { GO_MOMENTS = 36 };
/* Ticks of no way past the guards, until another way is tried. */
enum { BARRED_TICKS = 40 * ENF_TICK_RATE };
/* Decisions for which it flees one way. */
enum { FLEES = 12 };
/* What may be noticed on the way: at first, and after a long wait on it. */
#define SAFE 0.1
#define SAFE_MOST (SIM_NOTICE_WONDERS - 0.08)
#define PATIENCE (60.0 * ENF_TICK_RATE) /* ticks of waiting from the one to the other */
#define GUARD_NEAR 22.0
#define CRUMB 0.5
#define GUARD_EYE 1.65
#define SEARCH_PACE 2.5 /* m/s */
#define SUSPECTED 14.0  /* metres from one who wonders or searches */
#define SUM_SHARE 0.1   /* of all that all notice, beside the most that one does */

/* Places one after another, and how they are walked. */
typedef struct Line {
    EnfVec3 at[LINE_MAX];
    uint32_t count;
    uint32_t gait; /* ENF_BUTTON_CROUCH, ENF_BUTTON_RUN or 0 */
} Line;

static double flat(EnfVec3 a, EnfVec3 b) {
    double x = a.x - b.x, z = a.z - b.z;
    return sqrt(x * x + z * z);
}

/* ---- what will be ---------------------------------------------------------------------------------------------------- */

static uint32_t guards_of(const GameBot *bot) {
    return bot->game->guard_count < BOT_GUARDS_MAX ? bot->game->guard_count : BOT_GUARDS_MAX;
}

/* Who looks for the bot is taken to come straight to where it is now, and to look at it. */
static SimEye come(const GameBot *bot, const SimGuard *guard, SimEye eye, int64_t tick) {
    EnfVec3 way = enf_sub(bot->game->player.body.position, eye.at);
    double away = sqrt(way.x * way.x + way.z * way.z), pace = SEARCH_PACE * MOMENT_TICKS / ENF_TICK_RATE;
    bool waits = guard->mood == GAME_GUARD_RETURNS || (guard->mood == GAME_GUARD_WONDERS && tick < guard->until);
    if (!waits && away > pace) {
        eye.at = enf_add(eye.at, enf_scale(enf_v3(way.x, 0.0, way.z), pace / away));
    }
    return eye;
}

/* Where the guards' eyes will be: on their rounds for certain. */
static void foresee(GameBot *bot) {
    const Game *game = bot->game;
    BotSneak *sneak = &bot->sneak;
    for (uint32_t g = 0; g < guards_of(bot); g++) {
        const SimGuard *guard = &game->guards[g];
        const EnfMotion *motion = enf_world_motion(game->world, guard->object.index);
        SimEye eye = {sim_guard_eye(guard), guard->yaw_deg, guard->body.cell};
        sneak->looks[g] = guard->mood != GAME_GUARD_ROUND || motion->kind != ENF_MOTION_PATH;
        for (int k = 0; k < BOT_MOMENTS; k++) {
            SimEye next = eye;
            if (sneak->looks[g]) {
                next = come(bot, guard, eye, sim_tick(game) + (k + 1) * MOMENT_TICKS);
            } else {
                EnfPose pose = enf_motion_state(motion, sim_world_tick(game) + (k + 1) * MOMENT_TICKS);
                next.at = enf_add(pose.position, enf_v3(0.0, GUARD_EYE, 0.0));
                next.yaw_deg = sim_yaw(pose.rotation);
            }
            next.cell = enf_map_track(game->map, eye.cell, eye.at, next.at);
            eye = sneak->eyes[k][g] = next;
        }
    }
}

static double speed_of(const EnfCharacterDef *def, uint32_t gait) {
    return gait & ENF_BUTTON_CROUCH ? def->crouch_speed : gait & ENF_BUTTON_RUN ? def->run_speed : def->walk_speed;
}

/* On along the line by so many metres from its place `*at`, `*next` being ahead. True if it moved. */
static bool advance(const Line *line, uint32_t *next, EnfVec3 *at, double metres) {
    EnfVec3 from = *at;
    while (*next < line->count && metres > 0.0) {
        EnfVec3 way = enf_sub(line->at[*next], *at);
        double away = enf_length(way);
        if (away > metres) {
            *at = enf_add(*at, enf_scale(way, metres / away));
            break;
        }
        *at = line->at[(*next)++];
        metres -= away;
    }
    return enf_length(enf_sub(*at, from)) > 0.01;
}

/* What a guard notices of the body in one moment. */
static double noticed(GameBot *bot, const SimEye *eye, bool looks, const EnfCharacter *body, const Line *line, bool moves) {
    Game *game = bot->game;
    const double seconds = (double)MOMENT_TICKS / ENF_TICK_RATE;
    SimEye at = *eye;
    EnfVec3 way = enf_sub(body->position, eye->at);
    double away = enf_length(way);
    if (away > GUARD_NEAR) {
        return -SIM_NOTICE_FADES * seconds;
    }
    if (looks) {
        at.yaw_deg = enf_atan2(-way.x, -way.z) * (180.0 / ENF_PI);
    }
    bool crouched = (line->gait & ENF_BUTTON_CROUCH) != 0, runs = (line->gait & ENF_BUTTON_RUN) != 0;
    double sight = sim_sight(game, &at, body) * (crouched ? SIM_NOTICE_CROUCHED : 1.0);
    double more = sight > 0.01 ? SIM_NOTICE_RATE * sight * seconds : -SIM_NOTICE_FADES * seconds;
    double far = crouched ? SIM_HEARD_CROUCH : runs ? SIM_HEARD_RUN : SIM_HEARD_WALK;
    if (moves && away < far) {
        more += SIM_NOTICE_HEARD * (1.0 - away / far) * speed_of(&body->def, line->gait) * seconds / (runs ? 1.1 : 0.75);
    }
    return more;
}

/* Who wonders or searches will come nearer: it is well to be elsewhere. */
static double suspicion(const GameBot *bot, EnfVec3 at) {
    double worst = 0.0;
    for (uint32_t g = 0; g < guards_of(bot); g++) {
        const SimGuard *guard = &bot->game->guards[g];
        bool looks_for = guard->mood == GAME_GUARD_WONDERS || guard->mood == GAME_GUARD_SEARCHES;
        double near = 1.0 - enf_length(enf_sub(guard->body.position, at)) / SUSPECTED;
        worst = looks_for ? fmax(worst, 0.3 * near) : worst;
    }
    return worst;
}

/* How far ahead a way must be safe: who has waited long is content with less. */
static uint32_t far_ahead(const GameBot *bot) {
    return (double)bot->sneak.waited < PATIENCE ? GO_MOMENTS : 2 * GO_MOMENTS / 3;
}

/* The most that any guard will have noticed if the bot does so: what is far off counts less, for it can still be mended. */
static double risk(GameBot *bot, const Line *line, uint32_t moments) {
    const Game *game = bot->game;
    EnfCharacter body = game->player.body;
    double notice[BOT_GUARDS_MAX], worst = 0.0, sum = 0.0;
    uint32_t next = 0;
    body.height = line->gait & ENF_BUTTON_CROUCH ? body.def.crouch_height : body.def.height;
    for (uint32_t g = 0; g < guards_of(bot); g++) {
        notice[g] = game->guards[g].notice;
    }
    for (uint32_t k = 0; k < moments; k++) {
        EnfVec3 before = body.position, up = enf_v3(0.0, 0.8 * body.height, 0.0);
        bool moves = advance(line, &next, &body.position, speed_of(&body.def, line->gait) * MOMENT_TICKS / ENF_TICK_RATE);
        body.cell = enf_map_track(game->map, body.cell, enf_add(before, up), enf_add(body.position, up));
        for (uint32_t g = 0; g < guards_of(bot); g++) {
            double more = noticed(bot, &bot->sneak.eyes[k][g], bot->sneak.looks[g], &body, line, moves);
            notice[g] = fmax(0.0, notice[g] + more);
            if (more > 0.0) {
                sum += more;
                worst = fmax(worst, notice[g] * (1.0 - 0.4 * (double)k / moments * (moments <= GO_MOMENTS)));
            }
        }
    }
    return worst + SUM_SHARE * sum + suspicion(bot, body.position);
}

/* ---- what could be done ---------------------------------------------------------------------------------------------- */

static void line_on(const GameBot *bot, Line *line) {
    line->count = 0;
    for (uint32_t i = bot->trip.at; i < bot->foot.path_count && line->count < LINE_MAX; i++) {
        line->at[line->count++] = bot->foot.path[i];
    }
    uint32_t first = bot->foot.path_count > bot->trip.at ? bot->way.next + 1 : bot->way.next; /* foot leads to the next stop */
    for (uint32_t i = first; i < bot->way.count && line->count < LINE_MAX; i++) {
        line->at[line->count++] = bot->way.at[i];
    }
}

static void line_back(const GameBot *bot, Line *line) {
    line->count = 0;
    for (uint32_t i = bot->sneak.crumb_count; i-- > 0 && line->count < LINE_MAX;) {
        line->at[line->count++] = bot->sneak.crumbs[i];
    }
}

static double try_gait(GameBot *bot, Line *line, uint32_t gait) {
    line->gait = gait;
    return risk(bot, line, far_ahead(bot));
}

/* The best place a few steps aside, to stay there. */
static double try_asides(GameBot *bot, EnfVec3 *to) {
    const EnfCharacter *body = &bot->game->player.body;
    double best = HUGE_VAL;
    for (int i = 0; i < ASIDES; i++) {
        int ring = i / 8;
        double turn = 360.0 / 8 * (i % 8), far = 1.5 + 1.75 * ring;
        Line line = {.count = 1, .gait = ENF_BUTTON_CROUCH};
        line.at[0] = enf_add(body->position, enf_scale(sim_look(turn, 0.0), far));
        if (sim_foot_straight(bot->game->collider, body, line.at[0], far)) {
            double r = risk(bot, &line, BOT_MOMENTS);
            if (r < best - 0.01) {
                best = r;
                *to = line.at[0];
            }
        }
    }
    return best;
}

static void settle_on(BotSneak *sneak, BotCare care, uint32_t gait) {
    sneak->care = care;
    sneak->gait = gait;
}

/* On: as fast as is safe. Returns the risk of the slowest that was tried. */
static double decide_on(GameBot *bot, double safe) {
    const uint32_t gaits[3] = {ENF_BUTTON_RUN, 0, ENF_BUTTON_CROUCH};
    Line line;
    double r = HUGE_VAL;
    line_on(bot, &line);
    for (int i = bot->held & ENF_BUTTON_RUN ? 0 : 1; i < 3; i++) {
        r = try_gait(bot, &line, gaits[i]);
        settle_on(&bot->sneak, BOT_GOES, gaits[i]);
        if (r < safe) {
            break;
        }
    }
    return r;
}

/* Not on: wait, go back, step aside, or on all the same, whatever is noticed least. */
static void decide_else(GameBot *bot, double safe, double on) {
    BotSneak *sneak = &bot->sneak;
    const uint32_t gaits[3] = {ENF_BUTTON_CROUCH, 0, ENF_BUTTON_RUN};
    Line line = {.count = 0, .gait = ENF_BUTTON_CROUCH};
    double best = risk(bot, &line, far_ahead(bot));
    if (best < safe || best <= on) {
        settle_on(sneak, BOT_STANDS, ENF_BUTTON_CROUCH);
    } else {
        best = on;
    }
    if (best < safe) {
        return;
    }
    EnfVec3 to;
    double aside = try_asides(bot, &to);
    if (aside < fmax(safe, best - 0.03)) {
        best = aside;
        sneak->to = to;
        settle_on(sneak, BOT_STEPS_ASIDE, ENF_BUTTON_CROUCH);
    }
    line_back(bot, &line);
    for (int i = 0; i < 3 && line.count > 0 && best >= safe; i++) {
        double r = try_gait(bot, &line, gaits[i]);
        if (r < best - 0.03) {
            best = r;
            settle_on(sneak, BOT_BACKS, gaits[i]);
        }
    }
}

/* Is the way barred, by somebody who walks up and down on it? Then another, without the next doorway. */
static void look_for_another_way(GameBot *bot) {
    BotTrip *trip = &bot->trip;
    Line line;
    double left = 0.0;
    EnfVec3 at = bot->game->player.body.position;
    line_on(bot, &line);
    for (uint32_t i = 0; i < line.count; i++) {
        left += enf_length(enf_sub(line.at[i], at));
        at = line.at[i];
    }
    trip->barred = left < trip->least - 1.0 ? 0 : trip->barred + DECIDE_EVERY;
    trip->least = fmin(left, trip->least);
    if (trip->barred < BARRED_TICKS) {
        return;
    }
    uint32_t i = bot->way.next;
    while (i + 1 < bot->way.count && i < bot->way.next + 2) {
        i++;
    }
    trip->shun = bot->way.count > 0 ? bot->way.gate[i] : ENF_NONE;
    trip->barred = 0;
    trip->least = HUGE_VAL;
    bot->foot.path_count = 0;
}

/* How near anybody comes to the next dozen metres of a line, run along: the hunter runs too, the others walk their rounds. */
static double room_on(const GameBot *bot, const Line *line, const SimGuard *hunter) {
    EnfVec3 at = bot->game->player.body.position;
    uint32_t next = 0;
    double least = 0.0;
    for (uint32_t k = 1; k <= 12 && advance(line, &next, &at, 1.0); k++) {
        double room = enf_length(enf_sub(at, hunter->body.position)) - 0.7 * k;
        for (uint32_t g = 0; g < guards_of(bot); g++) {
            bool other = &bot->game->guards[g] != hunter;
            room = other ? fmin(room, enf_length(enf_sub(at, bot->sneak.eyes[k][g].at)) - 1.0) : room;
        }
        least = k == 1 ? room : fmin(least, room);
    }
    return least;
}

/* Metres from a guard of that mind within which there is nothing left but to run. */
static double hunted_within(GameGuardMood mood) {
    return mood == GAME_GUARD_CHASES ? 18.0 : mood == GAME_GUARD_SEARCHES ? 8.0 : mood == GAME_GUARD_WONDERS ? 4.0 : 0.0;
}

/* Somebody is after the bot: it runs, on or back, whichever leads away from him. False if nobody is. */
static bool flee(GameBot *bot) {
    const Game *game = bot->game;
    EnfVec3 feet = game->player.body.position;
    const SimGuard *hunter = NULL;
    for (uint32_t g = 0; g < game->guard_count; g++) {
        double away = enf_length(enf_sub(game->guards[g].body.position, feet));
        bool hunts = away < hunted_within((GameGuardMood)game->guards[g].mood);
        hunter = hunts && (!hunter || away < enf_length(enf_sub(hunter->body.position, feet))) ? &game->guards[g] : hunter;
    }
    if (!hunter) {
        bot->sneak.flees = 0;
        return false;
    }
    Line lines[2];
    double away[2];
    line_on(bot, &lines[0]);
    line_back(bot, &lines[1]);
    for (int i = 0; i < 2; i++) {
        away[i] = room_on(bot, &lines[i], hunter);
    }
    bool backs = bot->sneak.care == BOT_BACKS;
    bool keeps = bot->sneak.flees > 0 && away[backs ? 1 : 0] > 1.5; /* to and fro is to stand */
    bot->sneak.flees = keeps ? bot->sneak.flees - 1 : FLEES;
    settle_on(&bot->sneak,
              keeps                     ? (backs ? BOT_BACKS : BOT_GOES)
              : away[1] > away[0] + 0.5 ? BOT_BACKS
                                        : BOT_GOES,
              ENF_BUTTON_RUN);
    return true;
}

/* ---- doing it -------------------------------------------------------------------------------------------------------- */

static void drop_crumb(GameBot *bot) {
    BotSneak *sneak = &bot->sneak;
    EnfVec3 feet = bot->game->player.body.position;
    if (sneak->crumb_count > 0 && enf_length(enf_sub(sneak->crumbs[sneak->crumb_count - 1], feet)) < CRUMB) {
        return;
    }
    if (sneak->crumb_count == BOT_CRUMBS_MAX) {
        sneak->crumb_count = BOT_CRUMBS_MAX / 2;
        memmove(sneak->crumbs, sneak->crumbs + BOT_CRUMBS_MAX / 2, sneak->crumb_count * sizeof *sneak->crumbs);
    }
    sneak->crumbs[sneak->crumb_count++] = feet;
}

/* Back along the crumbs, which it picks up. */
static void go_back(GameBot *bot, EnfInput *input) {
    BotSneak *sneak = &bot->sneak;
    EnfVec3 feet = bot->game->player.body.position;
    while (sneak->crumb_count > 0 && flat(sneak->crumbs[sneak->crumb_count - 1], feet) < 0.3) {
        sneak->crumb_count--;
    }
    uint32_t ahead = sneak->crumb_count > 4 ? sneak->crumb_count - 4 : 0;
    if (sneak->crumb_count > 0 && !bot_opens_door(bot, sneak->crumbs[ahead], input)) {
        bot_head_for(bot, sneak->crumbs[sneak->crumb_count - 1], input);
    }
}

bool bot_sneak_decides(const GameBot *bot) {
    return bot->sneak.decided % DECIDE_EVERY == 0;
}

BotCare bot_sneak(GameBot *bot, EnfInput *input) {
    BotSneak *sneak = &bot->sneak;
    bool decides = bot_sneak_decides(bot);
    sneak->decided++;
    if (decides) {
        double safe = fmin(SAFE_MOST, SAFE + (SAFE_MOST - SAFE) * (double)sneak->waited / PATIENCE);
        foresee(bot);
        look_for_another_way(bot);
        if (!flee(bot)) {
            double on = decide_on(bot, safe);
            if (on >= safe) {
                decide_else(bot, safe, on);
            }
        }
    }
    BotCare care = (BotCare)sneak->care;
    if (care == BOT_GOES) {
        drop_crumb(bot);
        return care;
    }
    sneak->waited++;
    if (care == BOT_BACKS) {
        go_back(bot, input);
    } else if (care == BOT_STEPS_ASIDE && flat(sneak->to, bot->game->player.body.position) > 0.2) {
        bot_head_for(bot, sneak->to, input);
    }
    if (care != BOT_STANDS) {
        bot->foot.path_count = 0; /* a new way from there */
    }
    return care;
}

/* What a bot's files share. */
#ifndef ENF_GAME_SIM_BOT_INTERNAL_H
#define ENF_GAME_SIM_BOT_INTERNAL_H

#include "sim/bot.h"
#include "sim/foot.h"
#include "sim/sim.h"

/** X(NAME, "words of the script"). */
#define BOT_COMMANDS(X)                                                                                                        \
    X(GOTO_CELL, "goto cell")                                                                                                  \
    X(GOTO_POINT, "goto point")                                                                                                \
    X(GOTO_ENTITY, "goto entity")                                                                                              \
    X(GOTO_EXIT, "goto exit")                                                                                                  \
    X(TAKE, "take")                                                                                                            \
    X(PRESS, "press")                                                                                                          \
    X(LOOK_AT, "look at")                                                                                                      \
    X(LOOK_BY, "look by")                                                                                                      \
    X(USE, "use")                                                                                                              \
    X(DROP, "drop")                                                                                                            \
    X(JUMP, "jump")                                                                                                            \
    X(CROUCH, "crouch")                                                                                                        \
    X(RUN, "run")                                                                                                              \
    X(SNEAK, "sneak")                                                                                                          \
    X(WAIT, "wait")                                                                                                            \
    X(WALK, "walk")                                                                                                            \
    X(EXPECT, "expect")

typedef enum BotCommandKind {
#define BOT_ENUM(name, words) BOT_##name,
    BOT_COMMANDS(BOT_ENUM)
#undef BOT_ENUM
        BOT_COMMAND_COUNT
} BotCommandKind;

typedef struct BotCommand {
    BotCommandKind kind;
    uint32_t line;
    double number[3];
    uint32_t index; /**< of a cell, an entity; a GamePhase; 1 for on */
} BotCommand;

/** On its way to a place. */
typedef struct BotTrip {
    EnfVec3 to;
    uint32_t cell;  /**< of the place */
    double near;    /**< metres in the plan that are near enough */
    bool enter;     /**< to be in the cell is enough */
    uint32_t at;    /**< of foot.path; where there is none, path_count is 0 */
    uint32_t still; /**< ticks without getting on along it */
    uint32_t rest;  /**< ticks to stand and wait */
    uint32_t tries; /**< plans that led nowhere */
    uint32_t ticks;
    bool pressed;    /**< `use`, in the tick before */
    double least;    /**< metres of way that were left at best */
    uint32_t barred; /**< ticks without coming nearer, for the guards */
    uint32_t shun;   /**< a half-portal to be gone round, or ENF_NONE */
    uint32_t locked; /**< how often a door did not open */
} BotTrip;

enum { BOT_MOMENTS = 72, BOT_GUARDS_MAX = 48, BOT_CRUMBS_MAX = 512 };

/** Keeping out of guards' sight and hearing (bot_sneak.c). */
typedef struct BotSneak {
    bool on;
    bool looks[BOT_GUARDS_MAX];                /**< off its round: it may look anywhere */
    SimEye eyes[BOT_MOMENTS][BOT_GUARDS_MAX];  /**< the guards', in the moments to come */
    EnfVec3 crumbs[BOT_CRUMBS_MAX];            /**< where it came from, oldest first */
    EnfVec3 to;                                /**< where it goes instead */
    uint32_t crumb_count, care, gait, decided; /**< gait: ENF_BUTTON_*; decided: ticks ago */
    uint32_t flees;                            /**< ticks for which it goes on fleeing the same way */
    uint32_t waited;                           /**< ticks */
} BotSneak;

/** What to do in this tick. */
typedef enum BotCare { BOT_GOES, BOT_STANDS, BOT_BACKS, BOT_STEPS_ASIDE } BotCare;

struct GameBot {
    EnfAllocator allocator;
    Game *game;
    BotCommand *commands;
    uint32_t count, at; /**< commands; the one that is being done */
    uint32_t tick;      /**< of it */
    uint32_t phase;     /**< of it */
    uint32_t held;      /**< ENF_BUTTON_* */
    BotTrip trip;
    SimFoot foot;
    SimWay way; /**< on which foot leads to the next stop */
    BotSneak sneak;
};

/** Script → commands. */
EnfResult bot_parse(GameBot *bot, const char *script, size_t size, EnfError *error);
/** Where an entity is now: items lie where they were put, guards walk. */
EnfVec3 bot_place_of(const GameBot *bot, uint32_t entity);

void bot_trip_start(GameBot *bot, EnfVec3 to, uint32_t cell, double near, bool enter);
/** A tick of the trip: GOES_ON, DONE (it is there) or FAILED. */
GameBotNews bot_trip_step(GameBot *bot, EnfInput *input, const char **why);
/** Full speed towards a place, wherever it looks after this tick's turn. */
void bot_head_for(const GameBot *bot, EnfVec3 at, EnfInput *input);
/** Go on along foot.path and way, or keep away from guards; where it does not go on, `input` is filled in. */
BotCare bot_sneak(GameBot *bot, EnfInput *input);
/** Stands before a door that is shut, or opens, on the straight way to a place, and uses it; false if there is none. */
bool bot_opens_door(GameBot *bot, EnfVec3 to, EnfInput *input);
/** Will it decide anew in this tick? Then `way` is to be the way from here. */
bool bot_sneak_decides(const GameBot *bot);
/** Turns towards a place, at a person's speed; true once it looks there. */
bool bot_look(const GameBot *bot, EnfVec3 at, EnfInput *input);

#endif

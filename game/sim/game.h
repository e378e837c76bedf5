/* Night at the palace: the rules of the game, tick by tick, without a window, a picture or a sound card.
 *
 * A person carries exhibits past guards to the way out. Everything that decides is here and in the engine: integers and doubles of the
 * engine's own arithmetic, random numbers of a seed, ticks. So the same inputs give the same game on every machine, drawn or not.
 * Any map can be walked: one without guards and exhibits is a walk without an end.
 *
 * Memory is taken in game_create; game_step and game_restart call no heap. One thread a game. */
#ifndef ENF_GAME_SIM_GAME_H
#define ENF_GAME_SIM_GAME_H

#include <enfilade/collide.h>
#include <enfilade/replay.h>
#include <enfilade/vis.h>

typedef struct Game Game;

/** What a game begins with; start with game_def_default(). */
typedef struct GameDef {
    uint64_t seed;
    uint32_t exhibits_wanted; /**< to carry out to win; 0: six, or all where there are fewer */
    bool peaceful;            /**< guards walk their rounds and see nobody */
} GameDef;
GameDef game_def_default(void);

typedef enum GamePhase { GAME_PLAYING, GAME_WON, GAME_LOST } GamePhase;
typedef enum GameGuardMood {
    GAME_GUARD_ROUND,
    GAME_GUARD_WONDERS,
    GAME_GUARD_CHASES,
    GAME_GUARD_SEARCHES,
    GAME_GUARD_RETURNS
} GameGuardMood;

/** A game's own buttons beside ENF_BUTTON_*. */
enum { GAME_BUTTON_RESTART = 256 };

#define GAME_TEXT_SIZE 96

/** What a guard is like, for maps and overlays. */
typedef struct GameGuardView {
    EnfVec3 feet_ws;
    double yaw_deg;
    double notice; /**< 0 nothing .. 1 sees you */
    GameGuardMood mood;
} GameGuardView;

/** An exhibit, for maps. */
typedef struct GameExhibitView {
    EnfVec3 at_ws; /**< where it lies */
    bool lies;     /**< neither carried nor carried out */
} GameExhibitView;

/** What is to be shown of the game; valid until the next step. */
typedef struct GameState {
    GamePhase phase;
    uint64_t tick;                 /**< since the start */
    EnfVec3 eye_ws, eye_before_ws; /**< now, and one tick before (equal after a jump of place) */
    double yaw_deg, pitch_deg;     /**< now */
    double yaw_before_deg, pitch_before_deg;
    uint32_t cell; /**< of the eye, or ENF_NONE */
    bool crouched, flying;
    uint32_t carried, carried_value;  /**< exhibits in hand */
    uint32_t delivered, wanted;       /**< carried out; needed to win */
    uint32_t score;                   /**< value carried out */
    uint32_t exhibits, exhibits_left; /**< in the map; neither carried nor carried out */
    double light;                     /**< 0 dark .. 1 bright, where you stand */
    double noticed;                   /**< the most that any guard has noticed, 0..1 */
    const GameGuardView *guards;
    uint32_t guard_count;
    const GameExhibitView *exhibit_views; /**< `exhibits` of them */
    char prompt[GAME_TEXT_SIZE];          /**< what `use` would do here, or "" */
    char message[GAME_TEXT_SIZE];         /**< the newest message, or "" once it is old */
} GameState;

/** X(NAME, "file stem in assets/sounds"): what can be heard. Of a stem without a file of its own there are several, stem_1, stem_2 ... */
#define GAME_SOUNDS(X)                                                                                                         \
    X(STEP_STONE, "step_stone")                                                                                                \
    X(STEP_WOOD, "step_wood")                                                                                                  \
    X(STEP_CARPET, "step_carpet")                                                                                              \
    X(JUMP, "jump")                                                                                                            \
    X(LAND, "land")                                                                                                            \
    X(DOOR_OPEN, "door_open")                                                                                                  \
    X(DOOR_SHUT, "door_close")                                                                                                 \
    X(DOOR_SLIDES, "door_slide")                                                                                               \
    X(DOOR_LOCKED, "door_locked")                                                                                              \
    X(DOOR_UNLOCKED, "door_unlock")                                                                                            \
    X(LIFT, "lift_start")                                                                                                      \
    X(LIFT_STOPS, "lift_stop")                                                                                                 \
    X(LIFT_RINGS, "lift_ding")                                                                                                 \
    X(LIFT_HUMS, "lift_hum")                                                                                                   \
    X(SWITCH, "switch")                                                                                                        \
    X(TAKE, "pick_up")                                                                                                         \
    X(TAKE_KEY, "pick_up_key")                                                                                                 \
    X(DROP, "put_down")                                                                                                        \
    X(GUARD_STEP, "step_stone")                                                                                                \
    X(GUARD_WONDERS, "guard_hm")                                                                                               \
    X(GUARD_SEES, "guard_alert")                                                                                               \
    X(GUARD_WHISTLES, "guard_whistle")                                                                                         \
    X(GUARD_GIVES_UP, "guard_lost")                                                                                            \
    X(CAUGHT, "caught")                                                                                                        \
    X(DELIVERED, "delivered")                                                                                                  \
    X(WON, "win")                                                                                                              \
    X(LOST, "lose")                                                                                                            \
    X(CLOCK_TICKS, "clock_tick")                                                                                               \
    X(CLOCK_TOCKS, "clock_tock")                                                                                               \
    X(CLOCK_CHIMES, "clock_chime")                                                                                             \
    X(CLOCK_STRIKES, "clock_strike")                                                                                           \
    X(TRAIN, "train")                                                                                                          \
    X(TRAIN_WHISTLES, "train_whistle")                                                                                         \
    X(FOUNTAIN, "fountain")                                                                                                    \
    X(BIRD, "bird")                                                                                                            \
    X(WINGS, "wings")

typedef enum GameSoundKind {
#define GAME_SOUND_ENUM(name, file) GAME_SOUND_##name,
    GAME_SOUNDS(GAME_SOUND_ENUM)
#undef GAME_SOUND_ENUM
        GAME_SOUND_COUNT
} GameSoundKind;
const char *game_sound_file(GameSoundKind kind);

/** A sound that began in this tick, and how the player hears it: along the shortest way through doorways, from the first of them. */
typedef struct GameSound {
    GameSoundKind kind;
    EnfVec3 at_ws;       /**< where it is */
    double loudness;     /**< at one metre, 0..1 */
    double gain;         /**< at the player's ears, 0..1 */
    EnfVec3 apparent_ws; /**< where it seems to come from: itself in the same cell, else the first doorway towards it */
    double muffled;      /**< 0 clear .. 1 through shut doors and far around corners */
} GameSound;

/** What a place or a thing sounds like by itself, as the player hears it: a node says `sound` (clock, train, fountain, bird, wings), an
 *  elevator hums on its way. */
typedef struct GameSpeaker {
    GameSound sound;
    uint32_t id; /**< of the speaker */
    bool loops;  /**< goes on: told ten times a second while it can be heard. Else it begins in this tick */
} GameSpeaker;
#define GAME_GAIN_LEAST 0.002 /**< of what can be heard */

/** A part of the state, hashed. */
typedef struct GameField {
    const char *name;
    uint64_t hash;
} GameField;
#define GAME_FIELDS_MAX 16

/** A game at its start; `map` must outlive it. Errors: ENF_ERROR_MEMORY. `*game` is then NULL. */
EnfResult game_create(Game **game, const EnfMap *map, const GameDef *def, const EnfAllocator *allocator, EnfError *error);
void game_destroy(Game *game);
/** Back to the start, with the same seed. The world's time goes on, and with it whoever watches it (indices of volumes). No heap. */
void game_restart(Game *game);

/** One tick, 1 / ENF_TICK_RATE s. Ignored inputs once the game is won or lost, but for GAME_BUTTON_RESTART. */
void game_step(Game *game, const EnfInput *input);

/** The whole simulation in 64 bits: equal states, equal hashes; and its parts, by name. Returns how many. */
uint64_t game_hash(const Game *game);
uint32_t game_fields(const Game *game, GameField out[GAME_FIELDS_MAX]);

EnfWorld *game_world(Game *game);
const EnfPortals *game_portals(const Game *game);
const GameState *game_state(const Game *game);
/** Sounds that began in the last tick. */
const GameSound *game_sounds(const Game *game, uint32_t *count);
/** What sounds by itself and can be heard now: to be asked once a tick, or never: nothing of the state depends on it. Valid until the
 *  next call. No heap. */
const GameSpeaker *game_speakers(Game *game, uint32_t *count);

#endif

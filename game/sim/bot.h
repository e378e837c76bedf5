/* A player who does what a script says: for recordings and tests of whole games without hands. It sees the game as its files do and
 * gives what a person would: one EnfInput a tick. The script is text, a command a line:
 *
 *      enfbot 1
 *      # a remark
 *      goto cell NAME            on foot through doorways until the eye is in that cell; opens doors on its way
 *      goto point X Y Z          to within half a metre of it
 *      goto entity NAME          beside it: an entity of the map by its `targetname`, else its node's name
 *      goto exit                 into the box of trigger_exit
 *      take NAME                 goes to an exhibit or key and takes it
 *      press NAME                goes to a button or door and uses it
 *      look at X Y Z             turns there
 *      look by YAW PITCH         turns by so many degrees
 *      use | drop | jump         presses that once
 *      crouch on|off             held from here on; likewise `run`
 *      sneak on|off              on its ways it keeps out of guards' sight and hearing, whose rounds it knows: it waits, crouches, goes
 *                                back, steps aside; with `run on` it runs where nobody hears it
 *      wait SECONDS
 *      walk FORWARD RIGHT SECONDS    shares of full speed, -1 to 1, as the bot looks
 *      expect playing|won|lost SECONDS   waits until the game is so; fails if it is not within the time
 *
 * Names may hold blanks. Memory is taken in game_bot_create. */
#ifndef ENF_GAME_SIM_BOT_H
#define ENF_GAME_SIM_BOT_H

#include "sim/game.h"

typedef struct GameBot GameBot;

/** The first line of a bot's script. */
#define GAME_BOT_MAGIC "enfbot 1"
enum { GAME_BOT_COMMANDS_MAX = 4096 };

/** Reads a script for a game on this game's map. Errors, naming the line: ENF_ERROR_FORMAT (no such command, number or name),
 *  ENF_ERROR_SIZE (too many commands); ENF_ERROR_MEMORY. `*bot` is then NULL. `game` must outlive it. */
EnfResult game_bot_create(GameBot **bot, Game *game, const char *script, size_t size, const EnfAllocator *allocator,
                          EnfError *error);
void game_bot_destroy(GameBot *bot);

typedef enum GameBotNews { GAME_BOT_GOES_ON, GAME_BOT_DONE, GAME_BOT_FAILED } GameBotNews;

/** The input of the next tick, to be given to game_step of the same game. DONE: the script is at its end, and `input` is nothing.
 *  FAILED: it cannot do what its script says; `error` names the line and why. It changes nothing of the game's state. */
GameBotNews game_bot_next(GameBot *bot, EnfInput *input, EnfError *error);

#endif

/* A script of inputs: text that a person writes, ticks that a machine plays. */
#ifndef ENFREPLAY_SCRIPT_H
#define ENFREPLAY_SCRIPT_H

#include <enfilade/replay.h>

/** Ticks that a script may hold: half a day. */
#define SCRIPT_TICKS_MAX 3000000u

/** The first line of every script of inputs. */
#define SCRIPT_MAGIC "enfinput 1"

typedef struct Script {
    EnfInput *inputs; /**< one a tick; owned */
    uint32_t count, capacity;
} Script;

/** Parses `text`; errors name the line. Free with script_free, also after a failure.
 *
 *      enfinput 1
 *      # a remark
 *      30                          nothing for 30 ticks
 *      120 forward run             running ahead for two seconds
 *      60 forward=0.5 left yaw=90  half speed ahead and full speed left, turning 90 degrees in all over the second
 *      1 use                       buttons: jump crouch run use drop noclip fly; button=N is bit N
 *      repeat 4                    what stands before the matching "end", four times; may be nested
 *      40 back pitch=-10
 *      end
 */
EnfResult script_parse(Script *script, const char *text, size_t size, EnfError *error);
void script_free(Script *script);

/** True if the text begins as a script of inputs does. */
bool script_is_one(const char *text, size_t size);

#endif

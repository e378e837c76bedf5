/* What the files of enfreplay share: the options, and a recording (or the wish for one) with its map and its game. */
#ifndef ENFREPLAY_H
#define ENFREPLAY_H

#include <enfilade/map.h>
#include <enfilade/replay.h>

#include "common/cli.h"
#include "enfreplay/sim.h"

#define FILES_MAX 4096

typedef struct Options {
    const char *files[FILES_MAX];
    uint32_t file_count;
    const char *map, *maps;                      /* a map file; a folder of them */
    const char *script, *output, *title, *start; /* record */
    const char *path;                            /* record */
    const char *mash, *seed, *map_name;          /* record: numbers of 64 bits, as text; the map's name in the recording */
    uint32_t ticks, fields_every;                /* record; run: no more ticks than that, if not 0 */
    const char *frames, *video, *stats;          /* run */
    uint32_t every, size[2];                     /* run */
    double fov_y_deg, speed;                     /* run */
    int cull, dbv, context;                      /* run: EnfCull, DBV_..., EnfContextKind */
    bool builder, run, fly, use, salvage, force, quiet, json;
} Options;

/** --dbv: off, or 1 + EnfDbvPolicy. */
enum { DBV_OFF = 0 };

/** A map, and a game on it. */
typedef struct Session {
    EnfMap map;
    char map_path[1024], map_name[ENF_REPLAY_TEXT_SIZE];
    Sim *sim;
} Session;

/** Reads the map: `--map`, or the one of `--maps` (or of the recording's folder) that has the recording's name for it. */
EnfResult session_open_map(Session *session, const Options *options, const char *recording, const EnfReplayHeader *header,
                           EnfError *error);
/** Starts a game on the map as `header` says. */
EnfResult session_start(Session *session, const EnfReplayHeader *header, EnfError *error);
void session_close(Session *session);

/** Opens a recording with its map and its game; refuses one of another map, game or engine (unless `any`). */
EnfResult session_open(Session *session, EnfReplay *replay, const Options *options, const char *recording, bool any,
                       EnfError *error);

/** Steps the game and says whether the state is what was recorded. */
bool session_step(Session *session, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence);
/** Tells of a divergence on stderr: tick, time, hashes, fields. */
void session_tell(const char *recording, const EnfReplay *replay, const EnfReplayDivergence *divergence);

/** A whole number of 64 bits, decimal or 0x…; false if `text` is none. */
bool enfreplay_number(const char *text, uint64_t *value);

/** Says what went wrong on stderr; returns the exit status for it. */
int enfreplay_fail(const EnfError *error);

/** A line on a terminal that is overwritten; nothing where stderr is none. `total` may be 0 (unknown). */
typedef struct Progress {
    bool on;
    uint64_t next; /* tick at which it is written again */
} Progress;
Progress progress_begin(const Options *options);
void progress_tick(Progress *progress, const char *what, uint64_t tick, uint64_t total);
void progress_end(Progress *progress);

/* The commands: each returns an exit status. */
int cmd_run(const Options *options);
int cmd_record(const Options *options);
int cmd_verify(const Options *options);
int cmd_update(const Options *options);
int cmd_info(const Options *options);

#endif

/* What the player sees: visibility after every tick, and pictures. It looks at the game and changes nothing of its state. */
#ifndef ENFREPLAY_WATCH_H
#define ENFREPLAY_WATCH_H

#include "enfreplay/enfreplay.h"

typedef struct Watch Watch;

typedef struct WatchCounts {
    uint64_t views;                           /**< times that visibility ran */
    uint64_t cells, clusters, objects;        /**< seen, summed over them */
    uint64_t exposed, expired, late, avoided; /**< of the volumes (enf_dbv_total_counters) */
    uint64_t pictures;
} WatchCounts;

/** Watches the session's game as `--cull`, `--dbv`, `--size` and `--fov-y` say. */
EnfResult watch_create(Watch **watch, Session *session, const Options *options, EnfError *error);
/** NULL is allowed. */
void watch_destroy(Watch *watch);

/** After a tick: visibility, if `draw` or if volumes are kept; with `draw` the picture, too: RGBA of `--size`, rows top to bottom,
 *  valid until the next call. *picture is NULL without `draw`. */
EnfResult watch_tick(Watch *watch, bool draw, const uint8_t **picture, EnfError *error);
WatchCounts watch_counts(const Watch *watch);

#endif

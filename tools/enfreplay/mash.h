/* Input as from a keyboard that a child, or a cat, plays on: by seed, the same everywhere. */
#ifndef ENFREPLAY_MASH_H
#define ENFREPLAY_MASH_H

#include <enfilade/replay.h>

typedef struct Mash {
    uint64_t state;
    EnfInput input;   /**< held now */
    uint32_t hold;    /**< ticks until it changes */
    uint32_t allowed; /**< buttons that are pressed */
} Mash;

/** `builder`: noclip and fly are among the buttons. */
Mash mash_begin(uint64_t seed, bool builder);
EnfInput mash_next(Mash *mash);

#endif

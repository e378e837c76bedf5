/* A simulation as small as they come, for tests of recordings: somebody paces a floor as the input says, a coin is tossed each
 * tick. Its state is all integers, and its hash covers all of it. */
#ifndef ENF_TESTS_PACER_H
#define ENF_TESTS_PACER_H

#include <enfilade/replay.h>
#include <stdbool.h>
#include <string.h>

enum { PACER_FIELDS = 3 };

typedef struct Pacer {
    int64_t x, y, yaw, pitch;
    uint64_t coin;
    uint64_t used; /* times that the use button went down */
    uint64_t down; /* whether it is down */
} Pacer;

static inline Pacer pacer_start(uint64_t seed) {
    Pacer pacer = {0, 0, 0, 0, seed | 1, 0, 0};
    return pacer;
}

static inline void pacer_step(Pacer *pacer, const EnfInput *input) {
    bool down = (input->buttons & ENF_BUTTON_USE) != 0;
    pacer->x += input->right;
    pacer->y += input->forward;
    pacer->yaw += input->yaw;
    pacer->pitch += input->pitch;
    pacer->coin = pacer->coin * UINT64_C(6364136223846793005) + 1442695040888963407u;
    pacer->used += down && !pacer->down;
    pacer->down = down;
}

static inline uint64_t pacer_hash(const Pacer *pacer) {
    return enf_hash64(ENF_HASH_START, pacer, sizeof *pacer);
}

static inline void pacer_fields(const Pacer *pacer, uint64_t fields[PACER_FIELDS]) {
    fields[0] = enf_hash64(ENF_HASH_START, &pacer->x, 4 * sizeof pacer->x);
    fields[1] = enf_hash64(ENF_HASH_START, &pacer->coin, sizeof pacer->coin);
    fields[2] = enf_hash64(ENF_HASH_START, &pacer->used, 2 * sizeof pacer->used);
}

static inline EnfReplayHeader pacer_header(const Pacer *start) {
    static const char names[PACER_FIELDS][8] = {"walker", "coin", "button"};
    EnfReplayHeader header = enf_replay_header_default();
    strcpy(header.game, "pacer 1");
    strcpy(header.map, "floor");
    strcpy(header.title, "Up and down the floor \xe2\x80\x93 a test");
    header.map_hash = 0x0123456789abcdefu;
    header.seed = 7;
    header.start_hash = pacer_hash(start);
    header.field_count = PACER_FIELDS;
    for (int i = 0; i < PACER_FIELDS; i++) {
        strcpy(header.fields[i], names[i]);
    }
    return header;
}

#endif

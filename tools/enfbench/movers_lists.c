/* What techniques listed, frame by frame, so that a row of one cannot stand beside a row of another that found something else. */
#include "enfbench/movers.h"

#include <stdio.h>

uint32_t bench_lists_part(const MoversLists *a, const MoversLists *b) {
    uint32_t both = a->frames < b->frames ? a->frames : b->frames;
    for (uint32_t f = 0; f < both; f++) {
        if (a->hashes[f] != b->hashes[f]) {
            return f;
        }
    }
    return ENF_NONE;
}

bool bench_lists_repeat(const char *experiment, const char *scene, uint32_t round, const MoversLists *first,
                        const MoversLists *again, uint32_t count) {
    bool ok = true;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t frame = bench_lists_part(&first[i], &again[i]);
        if (frame != ENF_NONE) {
            fprintf(stderr, "enfbench: %s, %s: %s lists other objects in round %u than in the first, first in frame %u\n",
                    experiment, scene, first[i].technique, round, frame);
            ok = false;
        }
    }
    return ok;
}

bool bench_lists_agree(const char *experiment, const char *scene, const MoversLists *lists, uint32_t count) {
    const MoversLists *model = NULL; /* who went on longest, so that every frame of the others has one beside it */
    for (uint32_t i = 0; i < count; i++) {
        if (lists[i].by_walls && (model == NULL || lists[i].frames > model->frames)) {
            model = &lists[i];
        }
    }
    bool ok = true;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t frame = lists[i].by_walls ? bench_lists_part(model, &lists[i]) : ENF_NONE;
        if (frame != ENF_NONE) {
            fprintf(stderr, "enfbench: %s, %s: %s and %s list different objects, first in frame %u\n", experiment, scene,
                    model->technique, lists[i].technique, frame);
            ok = false;
        }
    }
    return ok;
}

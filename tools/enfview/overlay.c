/* Tints pictures by their id-buffer, and says what the colours of volumes mean. Lines are tools/inspect's. */
#include "enfview/overlay.h"

#include <stdio.h>
#include <string.h>

void overlay_print_legend(const Viewer *viewer) {
    uint32_t counts[5] = {0};
    for (uint32_t i = 0; i < enf_world_object_limit(viewer->world); i++) {
        counts[enf_dbv_state(viewer->dbv, i)]++;
    }
    fprintf(stderr,
            "volumes: %u asleep (blue, dimmer the sooner they end), %u expired in this frame (magenta), %u exposed in vain "
            "(orange), %u drawn (green); the white part of a volume's bar is its remaining validity, full at 2^20 ticks, "
            "half at 2^10\n",
            counts[ENF_DBV_STATE_ASLEEP], counts[ENF_DBV_STATE_EXPIRED], counts[ENF_DBV_STATE_EXPOSED],
            counts[ENF_DBV_STATE_DRAWN]);
}

static uint32_t take_id(const uint8_t *pixel) {
    return (uint32_t)pixel[0] | (uint32_t)pixel[1] << 8 | (uint32_t)pixel[2] << 16 | (uint32_t)pixel[3] << 24;
}

void overlay_tint_cells(const EnfMap *map, const uint8_t *ids, const uint8_t *plain, uint8_t *rgba, size_t size) {
    for (size_t i = 0; i < size; i += 4) {
        uint32_t id = take_id(ids + i);
        if (id && id <= map->clusters_count && memcmp(plain + i, rgba + i, 4) == 0) {
            uint32_t rgb = inspect_color(map->clusters[id - 1].cell);
            for (int k = 0; k < 3; k++) {
                rgba[i + (size_t)k] = (uint8_t)((rgba[i + (size_t)k] + (rgb >> (8 * k) & 255u)) / 2u);
            }
        }
    }
}

void overlay_color_ids(uint8_t *ids, size_t size) {
    for (size_t i = 0; i < size; i += 4) {
        uint32_t id = take_id(ids + i);
        uint32_t rgb = id ? inspect_color(id - 1) : 0;
        for (int k = 0; k < 3; k++) {
            ids[i + (size_t)k] = (uint8_t)(rgb >> (8 * k) & 255u);
        }
        ids[i + 3] = 255;
    }
}

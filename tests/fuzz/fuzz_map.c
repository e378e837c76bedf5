/* links: core */
/* Any bytes as a map file: refused with a message, or sound enough that a view of it ends. Checksums would refuse nearly
 * everything, so the chunks are also given to enf_map_check as they lie, past the reader. */
#define _XOPEN_SOURCE 700
#include <enfilade/vis.h>

#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "map/map_internal.h"

/* A sound map may be asked anything. */
static void look_around(const EnfMap *map) {
    EnfPortals portals;
    EnfVis *vis = NULL;
    if (enf_portals_create(&portals, map, NULL, NULL) != ENF_OK) {
        return;
    }
    if (enf_vis_create(&vis, map, NULL, NULL) == ENF_OK) {
        EnfView view = enf_view_default();
        view.camera = enf_camera(enf_v3(0.5, 1.7, 0.25), enf_turn(40, -5, 0), 70, 320, 240);
        view.cell = enf_map_locate(map, view.camera.eye_ws);
        enf_vis_run(vis, &portals, &view);
        enf_vis_destroy(vis);
    }
    enf_portals_destroy(&portals);
}

/* Points the map at the chunks of a file without a look at its checksums; false if one lies outside. */
static bool take_chunks(EnfMap *map, const uint8_t *data, size_t size) {
    if (size < ENF_MAP_FRONT_SIZE) {
        return false;
    }
    for (int id = 0; id < ENF_MAP_CHUNK_COUNT; id++) {
        EnfCursor entry = enf_cursor(data, size);
        enf_cursor_bytes(&entry, ENF_MAP_HEADER_SIZE + (size_t)id * ENF_MAP_ENTRY_SIZE + 8);
        uint64_t offset = enf_cursor_u64(&entry);
        uint32_t count = enf_cursor_u32(&entry);
        uint64_t bytes = (uint64_t)count * enf_map_chunk_info[id].record_size;
        if (offset % ENF_MAP_ALIGN != 0 || offset > size || bytes > size - offset || (id == ENF_CHUNK_origin && count != 1)) {
            return false;
        }
        enf_map_chunk_set(map, (EnfMapChunkId)id, data + offset, count);
    }
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    void *aligned = NULL;
    if (posix_memalign(&aligned, 16, size ? size : 1) != 0) {
        return 0;
    }
    if (size) {
        memcpy(aligned, data, size);
    }
    EnfMap map;
    EnfError error = {0};
    if (enf_map_view(&map, aligned, size, &error) == ENF_OK) {
        look_around(&map);
        enf_map_free(&map);
    } else if (!error.message[0]) {
        __builtin_trap(); /* refused without a word */
    }
    memset(&map, 0, sizeof map);
    if (take_chunks(&map, aligned, size) && enf_map_check(&map, &error) == ENF_OK) {
        look_around(&map);
    }
    free(aligned);
    return 0;
}

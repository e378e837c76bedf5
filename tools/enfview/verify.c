/* Makes the proof of a walk: each view drawn culled and unculled, every byte of colour and of the id-buffer compared.
 * Nothing is stored: both pictures come from one run, so the comparison is of culling alone (DESIGN §10). */
#include <stdlib.h>
#include <string.h>

#include "enfview/tally.h"

enum { REPORTED_LOSSES = 10 };

/* Pictures of one view, and the view in which a cluster was last seen. */
typedef struct Proof {
    Viewer *viewer;
    uint8_t *color_all, *color, *ids_all, *ids;
    uint32_t *seen; /* by cluster */
    uint32_t stamp, reported;
} Proof;

static EnfResult proof_open(Proof *proof, Viewer *viewer, EnfError *error) {
    memset(proof, 0, sizeof *proof);
    proof->viewer = viewer;
    uint8_t **pictures[] = {&proof->color_all, &proof->color, &proof->ids_all, &proof->ids};
    bool complete = true;
    for (int i = 0; i < 4; i++) {
        *pictures[i] = enf_alloc(NULL, viewer->picture_size, 1);
        complete = complete && *pictures[i];
    }
    proof->seen = enf_alloc(NULL, (size_t)viewer->map.clusters_count + 1, sizeof *proof->seen);
    if (!complete || !proof->seen) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for pictures");
    }
    return ENF_OK;
}

static void proof_close(Proof *proof) {
    uint8_t *pictures[] = {proof->color_all, proof->color, proof->ids_all, proof->ids};
    for (int i = 0; i < 4; i++) {
        enf_free(NULL, pictures[i], proof->viewer->picture_size, 1);
    }
    enf_free(NULL, proof->seen, (size_t)proof->viewer->map.clusters_count + 1, sizeof *proof->seen);
}

/* A whole frame in colour: visibility, draw list, drawing. Returns its milliseconds. */
static double draw_frame(Proof *proof, EnfVis *vis, EnfDraw *draw, const EnfView *view, const EnfDrawList **list) {
    Viewer *viewer = proof->viewer;
    enf_gl_target_bind(viewer->target, ENF_RENDER_COLOR);
    viewer->finish();
    double start = viewer_now_us();
    *list = enf_draw_build(draw, enf_vis_run(vis, &viewer->portals, view), ENFVIEW_NEAR, viewer->world, 1.0);
    enf_gl_draw(viewer->gl, *list, ENF_RENDER_COLOR);
    viewer->finish();
    return (viewer_now_us() - start) * 1e-3;
}

static void draw_ids(Proof *proof, const EnfDrawList *list, uint8_t *ids) {
    enf_gl_target_bind(proof->viewer->target, ENF_RENDER_IDS);
    enf_gl_draw(proof->viewer->gl, list, ENF_RENDER_IDS);
    enf_gl_target_read(proof->viewer->target, ENF_RENDER_IDS, ids);
}

static uint32_t id_at(const uint8_t *ids, size_t byte) {
    return (uint32_t)ids[byte] | (uint32_t)ids[byte + 1] << 8 | (uint32_t)ids[byte + 2] << 16 | (uint32_t)ids[byte + 3] << 24;
}

/* Clusters of the unculled picture that own a pixel. */
static uint32_t count_visible(Proof *proof) {
    uint32_t count = 0, last = 0;
    proof->stamp++;
    for (size_t i = 0; i < proof->viewer->picture_size; i += 4) {
        uint32_t id = id_at(proof->ids_all, i);
        if (id != last && id != 0 && id <= proof->viewer->map.clusters_count && proof->seen[id - 1] != proof->stamp) {
            proof->seen[id - 1] = proof->stamp;
            count++;
        }
        last = id;
    }
    return count;
}

/* Pixels that differ in colour or id; *first is the first one's byte. */
static uint32_t count_lost(const Proof *proof, size_t *first) {
    size_t size = proof->viewer->picture_size;
    if (memcmp(proof->color_all, proof->color, size) == 0 && memcmp(proof->ids_all, proof->ids, size) == 0) {
        return 0;
    }
    uint32_t count = 0;
    for (size_t i = 0; i < size; i += 4) {
        if (memcmp(proof->color_all + i, proof->color + i, 4) != 0 || memcmp(proof->ids_all + i, proof->ids + i, 4) != 0) {
            *first = count++ ? *first : i;
        }
    }
    return count;
}

/* Names the first pixel lost and whose it was. */
static void report_loss(Proof *proof, const Walk *walk, size_t first) {
    if (proof->reported++ >= REPORTED_LOSSES) {
        return;
    }
    const EnfMap *map = &proof->viewer->map;
    size_t pixel = first / 4, width = proof->viewer->options->size[0];
    uint32_t id = id_at(proof->ids_all, first);
    const char *node = "", *cell = "nothing";
    if (id > map->clusters_count) {
        uint32_t object = id - map->clusters_count - 1;
        fprintf(stderr, "enfview: row %u, tick %lld: what is lost is object %u\n", walk->row,
                (long long)enf_world_tick(proof->viewer->world), object);
        node = object < map->movers_count ? enf_map_string(map, map->entities[map->movers[object].entity].name) : "";
        cell = "what moves";
    } else if (id) {
        node = enf_map_string(map, map->clusters[id - 1].node);
        cell = viewer_cell_name(proof->viewer, map->clusters[id - 1].cell);
    }
    const Pose *pose = &walk->pose;
    fprintf(stderr,
            "enfview: row %u loses pixel (%zu, %zu) of cluster %d, node '%s', cell '%s': --eye %.17g,%.17g,%.17g --yaw %.17g "
            "--pitch %.17g --cell '%s'\n",
            walk->row, pixel % width, pixel / width, (int)id - 1, node, cell, pose->eye_ws.x, pose->eye_ws.y, pose->eye_ws.z,
            pose->yaw_deg, pose->pitch_deg, viewer_cell_name(proof->viewer, walk->cell));
}

/* Both frames, by turns the one or the other first, so that neither is always the one that finds warm caches. */
static void draw_both(Proof *proof, Walk *walk, const EnfView *view, Measure *measure) {
    Viewer *viewer = proof->viewer;
    EnfView everything = *view;
    everything.cull = ENF_CULL_NONE;
    everything.grain = ENF_GRAIN_OBJECTS;
    everything.dbv = NULL;
    const EnfDrawList *list_all = NULL, *list = NULL;
    for (uint32_t turn = 0; turn < 2; turn++) {
        bool culled = (turn + walk->row / viewer->options->every) % 2 == 0;
        double ms = culled ? draw_frame(proof, viewer->vis, viewer->draw, view, &list)
                           : draw_frame(proof, viewer->vis_all, viewer->draw_all, &everything, &list_all);
        *(culled ? &measure->ms_culled : &measure->ms_none) = ms;
        enf_gl_target_read(viewer->target, ENF_RENDER_COLOR, culled ? proof->color : proof->color_all);
    }
    draw_ids(proof, list, proof->ids);
    draw_ids(proof, list_all, proof->ids_all);
    measure->clusters = list->cluster_count;
    measure->movers = list->mover_count;
}

static double ratio_of(const Measure *measure) {
    return measure->ms_culled > 0.0 ? measure->ms_none / measure->ms_culled : 0.0;
}

/* The best ratio of all must be no accident of a busy machine or of a shader's first use: it is measured twice more, and
 * the quicker frames count. */
static void confirm_best(Proof *proof, Walk *walk, const EnfView *view, const Tally *tally, Measure *measure) {
    for (int i = 0; i < 2 && (tally->view_count == 0 || ratio_of(measure) > tally->ratio_best); i++) {
        Measure again = {0};
        draw_both(proof, walk, view, &again);
        measure->ms_none = again.ms_none < measure->ms_none ? again.ms_none : measure->ms_none;
        measure->ms_culled = again.ms_culled < measure->ms_culled ? again.ms_culled : measure->ms_culled;
    }
}

static void verify_view(Proof *proof, Walk *walk, Tally *tally) {
    Viewer *viewer = proof->viewer;
    life_run(viewer, walk_tick(walk));
    EnfView view = viewer_view(viewer, &walk->pose, walk->cell);
    Measure measure = {0};
    draw_both(proof, walk, &view, &measure);
    confirm_best(proof, walk, &view, tally, &measure);
    enf_vis_run(viewer->vis, &viewer->portals, &view); /* drawing emptied the caches: the second run is timed */
    double start = viewer_now_us();
    const EnfVisSet *set = enf_vis_run(viewer->vis, &viewer->portals, &view);
    measure.vis_us = viewer_now_us() - start;
    measure.cells = set->cell_count;
    measure.clusters_visible = count_visible(proof);
    walk_write_cells(walk, set);
    size_t first = 0;
    measure.lost_pixels = count_lost(proof, &first);
    if (measure.lost_pixels) {
        report_loss(proof, walk, first);
    }
    tally_add(tally, &measure);
    tally_print_row(tally, walk, &measure, true);
}

int run_verify(Viewer *viewer) {
    EnfError error = {0};
    Walk walk;
    Tally tally = {0};
    Proof proof;
    EnfResult result = walk_open(&walk, viewer, &error);
    EnfResult opened = proof_open(&proof, viewer, result == ENF_OK ? &error : NULL);
    result = result != ENF_OK ? result : opened;
    if (result == ENF_OK && (result = viewer_open_pictures(viewer, &error)) == ENF_OK &&
        (result = tally_open(&tally, walk_view_count(&walk), &error)) == ENF_OK) {
        while (walk_step(&walk)) {
            verify_view(&proof, &walk, &tally);
        }
        tally_print_summary(&tally, viewer, true);
    }
    bool lost = tally.lost_pixels > 0;
    tally_close(&tally);
    proof_close(&proof);
    EnfResult closed = walk_close(&walk, result == ENF_OK ? &error : NULL);
    if (result != ENF_OK || closed != ENF_OK) {
        return viewer_fail(&error);
    }
    return lost ? 1 : 0;
}

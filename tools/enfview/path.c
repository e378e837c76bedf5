/* Makes the visible cells along a path, without pictures. */
#include "enfview/tally.h"

static void look(Viewer *viewer, Walk *walk, Tally *tally) {
    life_run(viewer, walk_tick(walk));
    EnfView view = viewer_view(viewer, &walk->pose, walk->cell);
    enf_vis_run(viewer->vis, &viewer->portals, &view); /* warms the caches: the second run is timed */
    double start = viewer_now_us();
    const EnfVisSet *set = enf_vis_run(viewer->vis, &viewer->portals, &view);
    Measure measure = {.vis_us = viewer_now_us() - start, .cells = set->cell_count};
    const EnfDrawList *list = enf_draw_build(viewer->draw, set, ENFVIEW_NEAR, viewer->world, 1.0);
    measure.clusters = list->cluster_count;
    measure.movers = list->mover_count;
    walk_write_cells(walk, set);
    tally_add(tally, &measure);
    tally_print_row(tally, walk, &measure, false);
}

int run_path(Viewer *viewer) {
    EnfError error = {0};
    Walk walk;
    Tally tally = {0};
    EnfResult result = walk_open(&walk, viewer, &error);
    if (result == ENF_OK && (result = tally_open(&tally, walk_view_count(&walk), &error)) == ENF_OK) {
        while (walk_step(&walk)) {
            look(viewer, &walk, &tally);
        }
        tally_print_summary(&tally, viewer, false);
    }
    tally_close(&tally);
    EnfResult closed = walk_close(&walk, result == ENF_OK ? &error : NULL);
    return result == ENF_OK && closed == ENF_OK ? 0 : viewer_fail(&error);
}

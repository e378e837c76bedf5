/* Makes poses and cells from the rows of a path. */
#include "enfview/walk.h"

#include <math.h>
#include <string.h>

#include "common/report.h"

/* A longer step between two rows is a teleport: the eye is located anew. Metres, squared. */
static const double JUMP2 = 2.0 * 2.0;

EnfResult walk_open(Walk *walk, const Viewer *viewer, EnfError *error) {
    const Options *options = viewer->options;
    memset(walk, 0, sizeof *walk);
    walk->viewer = viewer;
    walk->cell = ENF_NONE;
    EnfResult result = enf_path_csv_read(&walk->path, options->path, error);
    if (result != ENF_OK) {
        return result;
    }
    if (walk->path.count == 0) {
        return enf_error_file(error, enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "the path has no rows"), options->path);
    }
    uint32_t unused;
    if (options->cell_name && (result = viewer_cell(viewer, enf_v3(0.0, 0.0, 0.0), &unused, error)) != ENF_OK) {
        return result;
    }
    if (options->cells) {
        walk->cells = fopen(options->cells, "wb");
        if (!walk->cells) {
            return enf_error_file(error, enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot be written"), options->cells);
        }
    }
    return ENF_OK;
}

/* The cell of the eye at `to_ws`. Tracking is exact along short ways; where it does not hold (a teleport, a wall passed
 * through, a start), location answers. */
static uint32_t follow(const Walk *walk, EnfVec3 to_ws) {
    const EnfMap *map = &walk->viewer->map;
    if (!walk->path.rows[walk->next].inside) {
        return ENF_NONE; /* the path says so: a lift had moved the eye into what is solid here */
    }
    EnfVec3 way = enf_sub(to_ws, walk->pose.eye_ws);
    if (walk->viewer->options->cell_name) {
        return enf_map_find_cell(map, walk->viewer->options->cell_name);
    }
    if (walk->next == 0 || walk->cell == ENF_NONE || enf_dot(way, way) > JUMP2) {
        return enf_map_locate(map, to_ws);
    }
    uint32_t tracked = enf_map_track(map, walk->cell, walk->pose.eye_ws, to_ws);
    if (tracked != ENF_NONE && enf_map_cell_contains(map, tracked, to_ws)) {
        return tracked;
    }
    uint32_t located = enf_map_locate(map, to_ws);
    return located != ENF_NONE ? located : tracked;
}

bool walk_step(Walk *walk) {
    while (walk->next < walk->path.count) {
        const EnfPathRow *row = &walk->path.rows[walk->next];
        EnfVec3 eye_ws = enf_v3(row->x, row->y, row->z);
        walk->cell = follow(walk, eye_ws);
        walk->time = row->time;
        walk->pose.eye_ws = eye_ws;
        walk->pose.yaw_deg = row->yaw_deg;
        walk->pose.pitch_deg = row->pitch_deg;
        walk->row = walk->next++;
        if (walk->row % walk->viewer->options->every == 0) {
            return true;
        }
    }
    return false;
}

int64_t walk_tick(const Walk *walk) {
    return llround(walk->viewer->options->tick + walk->time * ENF_TICK_RATE);
}

uint32_t walk_view_count(const Walk *walk) {
    uint32_t every = walk->viewer->options->every;
    return walk->path.count / every + (walk->path.count % every != 0);
}

/* The cells in view: those looked into, and those whose surfaces reach into one and are listed there. */
static void mark_cells(const EnfMap *map, const EnfVisSet *set, uint8_t *in_view) {
    for (uint32_t i = 0; in_view && i < set->cell_count; i++) {
        in_view[set->cells[i]] = 1;
    }
    for (uint32_t i = 0; in_view && i < set->entry_count; i++) {
        in_view[map->clusters[set->entries[i].cluster].cell] = 1;
    }
}

void walk_write_cells(Walk *walk, const EnfVisSet *set) {
    if (!walk->cells) {
        return;
    }
    const EnfMap *map = &walk->viewer->map;
    EnfReport line = {0};
    enf_report_object(&line, NULL);
    enf_report_number(&line, "time", walk->time);
    enf_report_array(&line, "cells");
    uint8_t *in_view = enf_alloc(NULL, map->cells_count, 1);
    mark_cells(map, set, in_view);
    for (uint32_t cell = 0; in_view && cell < map->cells_count; cell++) {
        if (in_view[cell] && !(map->cells[cell].flags & ENF_CELL_OUTSIDE)) {
            enf_report_text(&line, NULL, viewer_cell_name(walk->viewer, cell));
        }
    }
    walk->cells_failed = walk->cells_failed || !in_view;
    enf_free(NULL, in_view, map->cells_count, 1);
    enf_report_end_array(&line);
    enf_report_end_object(&line);
    if (line.failed || fprintf(walk->cells, "%s\n", line.text) < 0) {
        walk->cells_failed = true;
    }
    enf_report_free(&line);
}

EnfResult walk_close(Walk *walk, EnfError *error) {
    bool failed = walk->cells_failed;
    if (walk->cells) {
        failed = fclose(walk->cells) != 0 || failed;
    }
    enf_path_csv_free(&walk->path);
    if (failed) {
        return enf_error_file(error, enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "cannot be written"),
                              walk->viewer->options->cells);
    }
    return ENF_OK;
}

/* What the files of enfview share: the options, and a map with everything that looks at it. */
#ifndef ENFVIEW_VIEWER_H
#define ENFVIEW_VIEWER_H

#include <enfilade/gl.h>

#include "common/mover_csv.h"
#include "common/report.h"

/** Near plane of every picture, metres: nearer than any eye comes to a wall. Small, since what it cuts away in front would
 *  show what is behind (PITFALLS 2). */
#define ENFVIEW_NEAR 0.02

/** Where somebody stands and looks. */
typedef struct Pose {
    EnfVec3 eye_ws;
    double yaw_deg, pitch_deg;
} Pose;

/** Extra drawings, or-ed; CELLS beside the numbers of INSPECT_*. */
enum { DEBUG_PORTALS = 1, DEBUG_CELLS = 2, DEBUG_WINDOWS = 4, DEBUG_KD = 8, DEBUG_DBV = 16 };

/** --dbv: no index, or one of an EnfDbvPolicy (number - 1). */
enum { DBV_OFF };

/** --doors: they stay shut; they open and shut in turn; and close their portals while they are shut. */
enum { DOORS_REST, DOORS_SWING, DOORS_CLOSE };

typedef struct Options {
    const char *map, *output, *ids, *stats, *path, *cells, *cell_name, *movers;
    bool has_eye, has_freeze, verify, raw_ids, quiet;
    Pose pose, freeze;
    double roll_deg, fov_y_deg;
    uint32_t size[2];
    int cull, window, grain, context; /**< EnfCull, EnfWindowMode, EnfGrain, EnfContextKind */
    int dbv, doors;
    uint32_t every, debug;
    double tick; /**< of the world, in the one view or at the path's time 0 */
} Options;

typedef struct Viewer {
    const Options *options;
    EnfMap map;
    EnfPortals portals;
    EnfVis *vis, *vis_all; /**< of the chosen traversal, and of everything */
    EnfDraw *draw, *draw_all;
    EnfMoverCsv recorded;          /**< of --movers */
    EnfWorld *world;               /**< the map's movers, then those */
    EnfDbvIndex *dbv;              /**< over them, or NULL: --dbv off, or nothing moves */
    EnfDbvCounters frame_counters; /**< of the frame that --stats tells of */
    uint64_t frame_evaluated;      /**< motions evaluated in it; UINT64_MAX: none was counted */
    EnfContext *context;           /**< NULL until viewer_open_pictures */
    EnfGl *gl;
    EnfGlTarget *target;
    void (*finish)(void); /**< glFinish */
    size_t picture_size;  /**< bytes of one picture, RGBA */
} Viewer;

/** The map and its visibility. Free with viewer_close, also after a failure. */
EnfResult viewer_open(Viewer *viewer, const Options *options, EnfError *error);
/** The context and an offscreen target; after viewer_open. */
EnfResult viewer_open_pictures(Viewer *viewer, EnfError *error);
void viewer_close(Viewer *viewer);

/** The camera of a pose, with the field of view, roll and size of the options. */
EnfCamera viewer_camera(const Viewer *viewer, const Pose *pose);
/** The view of a pose in `cell`, with the cull, windows and grain of the options. */
EnfView viewer_view(const Viewer *viewer, const Pose *pose, uint32_t cell);
/** The cell of an eye: --cell, else by location. RANGE if --cell names none. */
EnfResult viewer_cell(const Viewer *viewer, EnfVec3 eye_ws, uint32_t *cell, EnfError *error);
/** life.c: the world with the map's movers in it, and the index over it. */
EnfResult life_open(Viewer *viewer, EnfError *error);
void life_close(Viewer *viewer);
/** Lets the world run to `tick`, if that is ahead, with doors as --doors says. */
void life_run(Viewer *viewer, int64_t tick);

/** The counters of volumes as an object named `key`: of one frame, if one was counted, and of all; nothing without an index. */
void viewer_report_dbv(const Viewer *viewer, EnfReport *report, const char *key);

/** A cell's name, "(outside)" for none. */
const char *viewer_cell_name(const Viewer *viewer, uint32_t cell);

double viewer_now_us(void); /**< of a clock that never goes back */
/** A sample's quantile in [0, 1]; sorts `values`; 0 for none. */
double viewer_quantile(double *values, uint32_t count, double quantile);

/** main's three ways: each returns an exit status. */
int run_picture(Viewer *viewer); /**< picture.c */
int run_path(Viewer *viewer);    /**< path.c: visibility along a path, no picture */
int run_verify(Viewer *viewer);  /**< verify.c: culled against unculled */

/** Says what went wrong on stderr; returns the exit status for it. */
int viewer_fail(const EnfError *error);

#endif

/* What is drawn: a world seen by an eye, culled by the engine, into a target. Knows neither the window nor the game's rules. */
#ifndef GAME_FRONT_SCENE_H
#define GAME_FRONT_SCENE_H

#include <enfilade/gl.h>

enum { SCENE_CULLS = 4 }; /**< EnfCull */

typedef struct Scene {
    const EnfMap *map;
    EnfGl *gl;
    EnfGlTarget *target;
    uint32_t width_px, height_px; /**< of the target */
    void (*finish)(void);         /**< glFinish */
    EnfVis *vis;
    EnfDraw *draw;
    EnfWorld *world; /**< borrowed, with its portals; or NULL */
    const EnfPortals *portals;
    EnfDbvIndex *dbv; /**< over the world, or NULL: memory ran out */
    EnfCull cull;
    bool frozen; /**< the culling eye stands still */
    EnfView frozen_view;
    /* Of the last frame: */
    EnfVec3 eye_ws;
    bool has_eye;
    uint32_t cell;
    EnfView view;     /**< of the culling eye */
    EnfCamera camera; /**< that takes the picture */
    EnfVisSet seen;   /**< cameras[0] is `camera` */
    const EnfVisSet *set;
    const EnfDrawList *list;
    double vis_ms, list_ms, gl_ms; /**< gl_ms: until the commands are given, not until they are done */
} Scene;

/** `gl` stays the caller's, and the map, which must both outlive the scene. */
EnfResult scene_create(Scene *scene, const EnfMap *map, EnfGl *gl, EnfGlLoadFn *load, EnfError *error);
void scene_destroy(Scene *scene);
/** Shows another world (with trails), or none. */
EnfResult scene_attach(Scene *scene, EnfWorld *world, const EnfPortals *portals, EnfError *error);
EnfResult scene_resize(Scene *scene, uint32_t width_px, uint32_t height_px, EnfError *error);
/** After each tick of the world. */
void scene_tick(Scene *scene);
/** Where the picture is taken from; the eye's cell follows by crossing portals. */
void scene_look(Scene *scene, EnfVec3 eye_ws, EnfTurn turn, double fov_y_deg);
/** Visibility and the list to draw. `alpha` as enf_draw_build. */
void scene_see(Scene *scene, double alpha);
/** Draws the list into the target, which stays bound. */
void scene_paint(Scene *scene);
/** One whole frame with a cull mode, drawn and finished: milliseconds. The picture in the target is then of this mode. */
double scene_measure(Scene *scene, EnfCull cull, double alpha);

double scene_now_ms(void); /**< of a clock that never goes back */
const char *scene_cull_name(EnfCull cull);
/** A cell's name; "(outside)" for none. */
const char *scene_cell_name(const Scene *scene);

#endif

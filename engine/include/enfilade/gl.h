/* Draws an EnfDrawList with OpenGL 3.3 core; headless contexts (EGL surfaceless, OSMesa); read-back. */
#ifndef ENFILADE_GL_H
#define ENFILADE_GL_H

#include <enfilade/draw.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum EnfContextKind { ENF_CONTEXT_ANY, ENF_CONTEXT_EGL, ENF_CONTEXT_OSMESA } EnfContextKind;
typedef struct EnfContext EnfContext;
/** A current headless context. ANY tries EGL surfaceless, then OSMesa. */
EnfResult enf_context_create(EnfContext **context, EnfContextKind kind, EnfError *error);
void enf_context_destroy(EnfContext *context);
const char *enf_context_name(const EnfContext *context); /**< "egl" or "osmesa" */

typedef enum EnfRenderMode { ENF_RENDER_COLOR, ENF_RENDER_IDS } EnfRenderMode;
typedef struct EnfGl EnfGl;
/** Uploads a map for drawing with the current context (the game passes its own loader: `load(name)` returns a GL function). */
typedef void *EnfGlLoadFn(const char *name);
EnfResult enf_gl_create(EnfGl **gl, const EnfMap *map, EnfGlLoadFn *load, EnfError *error);
/** The loader of a headless context. */
EnfGlLoadFn *enf_context_loader(const EnfContext *context);
void enf_gl_destroy(EnfGl *gl);
/** Draws into the bound framebuffer and its viewport: clears, opaque, then blended. IDS writes cluster + 1, or clusters_count + object
 *  + 1 for what moves, as RGBA8 little-endian with no blending, no multisampling, no sRGB; alpha mask as in colour; blended surfaces
 *  count as solid. A window draws into an EnfGlTarget and shows it, or straight into its framebuffer 0 if that is sRGB-capable. */
void enf_gl_draw(EnfGl *gl, const EnfDrawList *list, EnfRenderMode mode);

/** An offscreen sRGB colour + depth target and its read-back. */
typedef struct EnfGlTarget EnfGlTarget;
EnfResult enf_gl_target_create(EnfGl *gl, EnfGlTarget **target, uint32_t width_px, uint32_t height_px, EnfError *error);
void enf_gl_target_destroy(EnfGlTarget *target);
void enf_gl_target_bind(EnfGlTarget *target, EnfRenderMode mode);
/** Shows the picture in the current window: copies it into framebuffer 0, scaled to width_px × height_px, bytes as they are (a window
 *  need not be sRGB-capable). Leaves framebuffer 0 bound and its viewport set, GL_FRAMEBUFFER_SRGB off: what is drawn over it next
 *  (lines, a user interface) gives its colours as they look. */
void enf_gl_target_show(EnfGlTarget *target, uint32_t width_px, uint32_t height_px);
/** width × height × 4 bytes RGBA, rows bottom to top. */
void enf_gl_target_read(EnfGlTarget *target, EnfRenderMode mode, uint8_t *rgba);

/** Debug drawing: line list, eye-relative floats, colours RGBA8; `through`: not hidden by depth. */
typedef struct EnfDebugVertex {
    float position_eye[3];
    uint32_t rgba;
} EnfDebugVertex;
void enf_gl_draw_lines(EnfGl *gl, const float clip_from_eye[16], const EnfDebugVertex *vertices, uint32_t count, bool through);
/** The clusters and movers of `list` as wireframe in one colour over the picture (culled clusters of a frozen camera). */
void enf_gl_draw_wireframe(EnfGl *gl, const EnfDrawList *list, uint32_t rgba);

/* ---- user interface --------------------------------------------------------------------------------------------- */

/** A corner of a triangle over the picture. */
typedef struct EnfUiVertex {
    float x_px, y_px; /**< from the upper left corner, y down */
    float u, v;       /**< in the atlas, texels */
    float weight;     /**< half the width of a pen, texels: drawn where the atlas's distance is less; negative: drawn whole */
    uint32_t rgba;    /**< as it looks (sRGB), straight alpha; R in the low byte */
} EnfUiVertex;

/** Draws text and flat shapes; knows no map, so that it is there before one (a loading screen). */
typedef struct EnfGlUi EnfGlUi;
/** `atlas`: width × height bytes, rows top to bottom: the distance to the nearest pen stroke in 1/16 texel (255: far away). */
EnfResult enf_gl_ui_create(EnfGlUi **ui, EnfGlLoadFn *load, const uint8_t *atlas, uint32_t width, uint32_t height,
                           EnfError *error);
void enf_gl_ui_destroy(EnfGlUi *ui);
/** `count` vertices, three a triangle, in their order, into the bound framebuffer of width_px × height_px; edges of strokes are
 *  smooth. Leaves depth test on, blending and GL_FRAMEBUFFER_SRGB off. */
void enf_gl_ui_draw(EnfGlUi *ui, const EnfUiVertex *vertices, uint32_t count, uint32_t width_px, uint32_t height_px);
/** Fills the bound framebuffer's colour, RGBA as it looks. */
void enf_gl_ui_clear(EnfGlUi *ui, uint32_t width_px, uint32_t height_px, uint32_t rgba);
/** What the window (framebuffer 0) shows before it is swapped: width × height × 4 bytes RGBA, rows bottom to top. */
void enf_gl_ui_read(EnfGlUi *ui, uint32_t width_px, uint32_t height_px, uint8_t *rgba);

#ifdef __cplusplus
}
#endif
#endif

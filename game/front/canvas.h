/* Text and flat shapes, gathered into one list of triangles a frame. Pixels from the upper left corner. No heap after creation. */
#ifndef GAME_FRONT_CANVAS_H
#define GAME_FRONT_CANVAS_H

#include <enfilade/gl.h>

/** The atlas: 16 × 6 tiles, one a character from ' ' on; the last one is a long stroke for lines. */
enum { FONT_TILE_WIDTH = 48, FONT_TILE_HEIGHT = 56, FONT_COLUMNS = 16, FONT_ROWS = 6 };
enum { FONT_ATLAS_WIDTH = FONT_TILE_WIDTH * FONT_COLUMNS, FONT_ATLAS_HEIGHT = FONT_TILE_HEIGHT * FONT_ROWS };
/** Fills FONT_ATLAS_WIDTH × FONT_ATLAS_HEIGHT bytes for enf_gl_ui_create. */
void font_draw_atlas(uint8_t *atlas);
/** How far the pen goes on after a character, design units; a capital letter is FONT_CAPITAL units high. */
double font_advance(char letter);
#define FONT_CAPITAL 10.0
#define FONT_UNIT 3.0 /**< texels of a design unit */

typedef struct Canvas {
    EnfUiVertex *vertices;
    uint32_t count, capacity;
    double width, height; /**< of the window, pixels */
    double unit;          /**< pixels of a unit of layout: the window is 720 units high */
} Canvas;

EnfResult canvas_create(Canvas *canvas, EnfError *error);
void canvas_destroy(Canvas *canvas);
void canvas_begin(Canvas *canvas, uint32_t width_px, uint32_t height_px);

/** R in the low byte, as EnfUiVertex.rgba; `share` of its opacity. */
uint32_t canvas_fade(uint32_t rgba, double share);

void canvas_rectangle(Canvas *canvas, const double box[4], uint32_t rgba); /**< x, y, width, height */
void canvas_gradient(Canvas *canvas, const double box[4], uint32_t left, uint32_t right);
void canvas_frame(Canvas *canvas, const double box[4], double thickness, uint32_t rgba);
void canvas_triangle(Canvas *canvas, const double corners[6], uint32_t rgba);
/** From (x, y) to (x, y): ends[4]; smooth edges. */
void canvas_line(Canvas *canvas, const double ends[4], double thickness, uint32_t rgba);

typedef enum CanvasAlign { CANVAS_LEFT, CANVAS_CENTER, CANVAS_RIGHT } CanvasAlign;
typedef struct CanvasStyle {
    double size;   /**< of a capital letter, pixels */
    double pen;    /**< width of strokes, of a capital letter's height; 0.11 is plain */
    double spread; /**< further space between letters, design units */
    uint32_t rgba;
    CanvasAlign align;
    bool shadow;
} CanvasStyle;
CanvasStyle canvas_style(double size, uint32_t rgba);
/** The same, smaller where the text would be wider than `width`: narrow windows, keys of long names. */
CanvasStyle canvas_style_fitted(double size, uint32_t rgba, const char *text, double width);
/** `y` is the base line. Characters that the font lacks show as '?'. */
void canvas_text(Canvas *canvas, const CanvasStyle *style, double x, double y, const char *text);
double canvas_text_width(const CanvasStyle *style, const char *text);

#endif

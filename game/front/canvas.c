/* Makes the triangles of a user interface. */
#include "front/canvas.h"

#include <math.h>

enum { VERTICES_MAX = 240000, MARGIN = 4 };
#define BASE_LINE 4.0

EnfResult canvas_create(Canvas *canvas, EnfError *error) {
    canvas->vertices = enf_alloc(NULL, VERTICES_MAX, sizeof *canvas->vertices);
    if (!canvas->vertices) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for the user interface");
    }
    canvas->capacity = VERTICES_MAX;
    return ENF_OK;
}

void canvas_destroy(Canvas *canvas) {
    enf_free(NULL, canvas->vertices, canvas->capacity, sizeof *canvas->vertices);
    canvas->vertices = NULL;
}

void canvas_begin(Canvas *canvas, uint32_t width_px, uint32_t height_px) {
    canvas->count = 0;
    canvas->width = (double)width_px;
    canvas->height = (double)height_px;
    double by_width = canvas->width / 960.0, by_height = canvas->height / 720.0;
    canvas->unit = by_width < by_height ? by_width : by_height;
}

uint32_t canvas_fade(uint32_t rgba, double share) {
    share = share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
    return (rgba & 0xffffffu) | (uint32_t)((double)(rgba >> 24) * share + 0.5) << 24;
}

static EnfUiVertex corner(double x, double y, uint32_t rgba) {
    EnfUiVertex v = {(float)x, (float)y, 0.0f, 0.0f, -1.0f, rgba};
    return v;
}

/* Four corners in a ring as two triangles; what finds no room is not drawn. */
static void add_quad(Canvas *canvas, const EnfUiVertex ring[4]) {
    static const int order[6] = {0, 1, 2, 0, 2, 3};
    if (canvas->count + 6 > canvas->capacity) {
        return;
    }
    for (int i = 0; i < 6; i++) {
        canvas->vertices[canvas->count++] = ring[order[i]];
    }
}

void canvas_gradient(Canvas *canvas, const double box[4], uint32_t left, uint32_t right) {
    double x1 = box[0] + box[2], y1 = box[1] + box[3];
    const EnfUiVertex ring[4] = {corner(box[0], box[1], left), corner(x1, box[1], right), corner(x1, y1, right),
                                 corner(box[0], y1, left)};
    add_quad(canvas, ring);
}

void canvas_rectangle(Canvas *canvas, const double box[4], uint32_t rgba) {
    canvas_gradient(canvas, box, rgba, rgba);
}

/* On whole pixels: a side thinner than one, between two, would be missed by both. */
void canvas_frame(Canvas *canvas, const double box[4], double thickness, uint32_t rgba) {
    double t = thickness > 1.0 ? round(thickness) : 1.0, x = round(box[0]), y = round(box[1]);
    double width = round(box[2]), height = round(box[3]);
    const double sides[4][4] = {{x, y, width, t},
                                {x, y + height - t, width, t},
                                {x, y + t, t, height - 2.0 * t},
                                {x + width - t, y + t, t, height - 2.0 * t}};
    for (int i = 0; i < 4; i++) {
        canvas_rectangle(canvas, sides[i], rgba);
    }
}

void canvas_triangle(Canvas *canvas, const double c[6], uint32_t rgba) {
    if (canvas->count + 3 > canvas->capacity) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        canvas->vertices[canvas->count++] = corner(c[2 * i], c[2 * i + 1], rgba);
    }
}

/* The atlas's last tile is a stroke along its middle: across it, texels are pixels. */
void canvas_line(Canvas *canvas, const double e[4], double thickness, uint32_t rgba) {
    double dx = e[2] - e[0], dy = e[3] - e[1], length = sqrt(dx * dx + dy * dy);
    if (!(length > 0.0)) {
        return;
    }
    double half = 0.5 * thickness + 1.0, px = -dy / length * half, py = dx / length * half;
    double u = (FONT_COLUMNS - 1) * FONT_TILE_WIDTH + 0.5 * FONT_TILE_WIDTH;
    double v = (FONT_ROWS - 1) * FONT_TILE_HEIGHT + 0.5 * FONT_TILE_HEIGHT;
    const double signs[4] = {1.0, 1.0, -1.0, -1.0};
    EnfUiVertex ring[4];
    for (int i = 0; i < 4; i++) {
        bool end = i == 1 || i == 2;
        ring[i] = corner(e[end ? 2 : 0] + px * signs[i], e[end ? 3 : 1] + py * signs[i], rgba);
        ring[i].u = (float)u;
        ring[i].v = (float)(v + half * signs[i]);
        ring[i].weight = (float)(0.5 * thickness);
    }
    add_quad(canvas, ring);
}

CanvasStyle canvas_style(double size, uint32_t rgba) {
    CanvasStyle style = {size, 0.115, 0.0, rgba, CANVAS_LEFT, true};
    return style;
}

double canvas_text_width(const CanvasStyle *style, const char *text) {
    double units = 0.0;
    for (const char *c = text; *c; c++) {
        units += font_advance(*c) + style->spread;
    }
    return (units > 0.0 ? units - 3.0 - style->spread : 0.0) * style->size / FONT_CAPITAL;
}

CanvasStyle canvas_style_fitted(double size, uint32_t rgba, const char *text, double width) {
    CanvasStyle style = canvas_style(size, rgba);
    double needed = canvas_text_width(&style, text);
    return needed > width && width > 0.0 ? canvas_style(size * width / needed, rgba) : style;
}

static void add_letter(Canvas *canvas, const CanvasStyle *style, const double at[2], char letter) {
    unsigned char code = (unsigned char)letter;
    int tile = (code < 32 || code > 126 ? '?' : code) - 32;
    double per_unit = style->size / FONT_CAPITAL, per_texel = per_unit / FONT_UNIT;
    int column = tile % FONT_COLUMNS, row = tile / FONT_COLUMNS;
    double u = column * FONT_TILE_WIDTH, v = row * FONT_TILE_HEIGHT;
    double x = at[0] - MARGIN * per_texel;
    double y = at[1] - (FONT_TILE_HEIGHT - MARGIN) * per_texel + BASE_LINE * per_unit;
    double w = FONT_TILE_WIDTH * per_texel, h = FONT_TILE_HEIGHT * per_texel;
    EnfUiVertex ring[4];
    for (int i = 0; i < 4; i++) {
        int right = i == 1 || i == 2, low = i >= 2;
        ring[i] = corner(x + right * w, y + low * h, style->rgba);
        ring[i].u = (float)(u + right * FONT_TILE_WIDTH);
        ring[i].v = (float)(v + low * FONT_TILE_HEIGHT);
        ring[i].weight = (float)(0.5 * style->pen * FONT_CAPITAL * FONT_UNIT);
    }
    add_quad(canvas, ring);
}

static void add_text(Canvas *canvas, const CanvasStyle *style, const double from[2], const char *text) {
    double at[2] = {from[0], from[1]};
    for (const char *c = text; *c; c++) {
        if (*c != ' ') {
            add_letter(canvas, style, at, *c);
        }
        at[0] += (font_advance(*c) + style->spread) * style->size / FONT_CAPITAL;
    }
}

void canvas_text(Canvas *canvas, const CanvasStyle *style, double x, double y, const char *text) {
    double width = style->align == CANVAS_LEFT ? 0.0 : canvas_text_width(style, text);
    const double at[2] = {x - (style->align == CANVAS_CENTER ? 0.5 * width : width), y};
    if (style->shadow) {
        CanvasStyle under = *style;
        double down = style->size * 0.06 > 1.0 ? style->size * 0.06 : 1.0;
        const double below[2] = {at[0] + down, at[1] + down};
        under.rgba = (style->rgba >> 24) * 3 / 4 << 24;
        under.pen = style->pen * 1.5;
        add_text(canvas, &under, below, text);
    }
    add_text(canvas, style, at, text);
}

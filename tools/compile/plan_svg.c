/* The floor plan as SVG: storeys as panels side by side or one below the other, cells in soft colours that differ from their
 * neighbours', portals as bars, a scale bar and a legend. */
#include "compile/plan_svg.h"

#include "compile/exact.h"
#include "compile/names.h"
#include "compile/plan_outline.h"
#include "compile/plan_storeys.h"
#include "compile/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pixels of the picture. */
#define PAGE_WIDTH 1400.0
#define MARGIN 40.0
#define HEADER 96.0
#define PANEL_TITLE 34.0
#define LEGEND 64.0
#define FONT_MAX 15.0
#define FONT_MIN 1.5

static const char *const palette[] = {"#f3d9c6", "#d5e5d2", "#d3e1ee", "#efe3b8", "#e5d6e8", "#cfe6e3",
                                      "#f2d3d3", "#dfe3c3", "#dcdcf0", "#f0dcb9", "#d9e9c9", "#ead7d0"};
enum { COLORS = sizeof palette / sizeof *palette };

typedef struct Storey {
    double floor;                      /* metres: the lowest of its cells */
    double min_x, min_z, max_x, max_z; /* metres */
    double left, top;                  /* pixels: where (min_x, min_z) goes */
} Storey;

typedef struct Plan {
    const EnfLayout *layout;
    const EnfSoup *soup;
    EnfText svg;
    uint32_t *first, *triangles; /* triangles of cell c: triangles[first[c] .. first[c + 1]) */
    uint32_t *storey;            /* of a cell */
    uint32_t *order;             /* cells, the widest first: what hides in another's plan is drawn over it */
    uint8_t *color;
    ENF_ARRAY(Storey) storeys;
    double scale; /* pixels a metre */
    double height;
    bool failed;
} Plan;

static bool is_shown(const Plan *plan, uint32_t cell) {
    return !(plan->layout->cells[cell].flags & ENF_CELL_OUTSIDE);
}

static EnfVec3 low_corner(const EnfLayoutCell *cell) {
    return enf_grid_point(cell->min);
}

static EnfVec3 high_corner(const EnfLayoutCell *cell) {
    return enf_grid_point(cell->max);
}

/* ---- what goes where -------------------------------------------------------------------------------------------- */

static bool sort_triangles(Plan *plan) {
    uint32_t cell_count = plan->layout->cell_count;
    plan->first = calloc((size_t)cell_count + 2, sizeof *plan->first);
    plan->triangles = malloc(((size_t)plan->soup->triangle_count + 1) * sizeof *plan->triangles);
    if (!plan->first || !plan->triangles) {
        return false;
    }
    for (uint32_t i = 0; i < plan->soup->triangle_count; i++) {
        if (plan->soup->triangles[i].cell < cell_count) {
            plan->first[plan->soup->triangles[i].cell + 2]++;
        }
    }
    for (uint32_t c = 2; c < cell_count + 2; c++) {
        plan->first[c] += plan->first[c - 1];
    }
    for (uint32_t i = 0; i < plan->soup->triangle_count; i++) {
        if (plan->soup->triangles[i].cell < cell_count) {
            plan->triangles[plan->first[plan->soup->triangles[i].cell + 1]++] = i;
        }
    }
    return true;
}

static void extend(Storey *storey, const EnfLayoutCell *cell) {
    EnfVec3 low = low_corner(cell), high = high_corner(cell);
    storey->floor = fmin(storey->floor, low.y);
    storey->min_x = fmin(storey->min_x, low.x);
    storey->min_z = fmin(storey->min_z, low.z);
    storey->max_x = fmax(storey->max_x, high.x);
    storey->max_z = fmax(storey->max_z, high.z);
}

/* A panel for each storey. */
static bool find_storeys(Plan *plan) {
    plan->storey = calloc((size_t)plan->layout->cell_count + 1, sizeof *plan->storey);
    EnfPlanCells cells = {plan->layout, plan->soup, plan->first, plan->triangles};
    uint32_t count;
    if (!plan->storey || !enf_plan_storeys(&cells, plan->storey, &count) || !ENF_ARRAY_ROOM(&plan->storeys, count)) {
        return false;
    }
    for (uint32_t i = 0; i < count; i++) {
        plan->storeys.data[i] = (Storey){1e300, 1e300, 1e300, -1e300, -1e300, 0, 0};
    }
    plan->storeys.count = count;
    for (uint32_t i = 0; i < plan->layout->cell_count; i++) {
        if (is_shown(plan, i)) {
            extend(&plan->storeys.data[plan->storey[i]], &plan->layout->cells[i]);
        }
    }
    return true;
}

/* Scale and places of the panels: one column, or two where the storeys are narrow. */
static void place_panels(Plan *plan) {
    double widest = 1, tallest = 1;
    for (uint32_t i = 0; i < plan->storeys.count; i++) {
        widest = fmax(widest, plan->storeys.data[i].max_x - plan->storeys.data[i].min_x);
        tallest = fmax(tallest, plan->storeys.data[i].max_z - plan->storeys.data[i].min_z);
    }
    uint32_t columns = plan->storeys.count > 1 && tallest > 0.8 * widest ? 2 : 1;
    double panel_width = (PAGE_WIDTH - (columns + 1) * MARGIN) / columns;
    plan->scale = fmin(panel_width / widest, 1600.0 / tallest);
    double top = HEADER, row_height = 0;
    for (uint32_t i = 0; i < plan->storeys.count; i++) {
        /* The highest storey first, as one reads a section. */
        Storey *storey = &plan->storeys.data[plan->storeys.count - 1 - i];
        uint32_t column = i % columns;
        if (column == 0) {
            top += row_height;
            row_height = 0;
        }
        storey->left = MARGIN + column * (panel_width + MARGIN);
        storey->top = top + PANEL_TITLE;
        row_height = fmax(row_height, (storey->max_z - storey->min_z) * plan->scale + PANEL_TITLE + MARGIN);
    }
    plan->height = top + row_height + LEGEND;
}

/* The first colour that no neighbour has, counted from a place of the cell's own. */
static bool choose_colors(Plan *plan) {
    const EnfLayout *layout = plan->layout;
    plan->color = calloc((size_t)layout->cell_count + 1, 1);
    uint32_t portal = 0;
    for (uint32_t cell = 0; plan->color && cell < layout->cell_count; cell++) {
        bool taken[COLORS] = {false};
        for (; portal < layout->portal_count && layout->portals[portal].source <= cell; portal++) {
            uint32_t target = layout->portals[portal].target;
            if (layout->portals[portal].source == cell && target < cell) {
                taken[plan->color[target]] = true;
            }
        }
        uint32_t start = cell * 5 % COLORS, i = 0;
        while (i < COLORS - 1 && taken[(start + i) % COLORS]) {
            i++;
        }
        plan->color[cell] = (uint8_t)((start + i) % COLORS);
    }
    return plan->color != NULL;
}

typedef struct Extent {
    double area;
    uint32_t cell;
} Extent;

static int compare_extents(const void *left, const void *right) {
    const Extent *a = left, *b = right;
    if (a->area != b->area) {
        return a->area > b->area ? -1 : 1;
    }
    return (a->cell > b->cell) - (a->cell < b->cell);
}

static bool sort_cells(Plan *plan) {
    uint32_t count = plan->layout->cell_count;
    Extent *extents = malloc(((size_t)count + 1) * sizeof *extents);
    plan->order = malloc(((size_t)count + 1) * sizeof *plan->order);
    bool ok = extents && plan->order;
    for (uint32_t i = 0; i < count && ok; i++) {
        EnfVec3 low = low_corner(&plan->layout->cells[i]), high = high_corner(&plan->layout->cells[i]);
        extents[i] = (Extent){(high.x - low.x) * (high.z - low.z), i};
    }
    if (ok) {
        qsort(extents, count, sizeof *extents, compare_extents);
    }
    for (uint32_t i = 0; i < count && ok; i++) {
        plan->order[i] = extents[i].cell;
    }
    free(extents);
    return ok;
}

/* ---- cells ------------------------------------------------------------------------------------------------------ */

static double page_x(const Plan *plan, const Storey *storey, double x) {
    return storey->left + (x - storey->min_x) * plan->scale;
}

static double page_y(const Plan *plan, const Storey *storey, double z) {
    return storey->top + (z - storey->min_z) * plan->scale;
}

static void put_loop(Plan *plan, const Storey *storey, const EnfPlanOutline *outline, const EnfPlanLoop *loop) {
    for (uint32_t i = 0; i < loop->point_count; i++) {
        EnfPlanPoint p = outline->points.data[loop->point_first + i];
        enf_text_put(&plan->svg, "%s%.2f %.2f", i ? "L" : "M", page_x(plan, storey, p.x), page_y(plan, storey, p.z));
    }
    enf_text_put(&plan->svg, "Z");
}

/* The cell's name without its suffix, as large as its width allows. */
static void put_name(Plan *plan, const Storey *storey, const EnfLayoutCell *cell, EnfPlanPoint at, double clear) {
    EnfNodeName name = enf_node_name(cell->name);
    double width = (high_corner(cell).x - low_corner(cell).x) * plan->scale;
    double height = (high_corner(cell).z - low_corner(cell).z) * plan->scale;
    size_t letters = name.base > 0 ? name.base : 1;
    double fitting = clear > 0 ? fmin(width, 2.6 * clear * plan->scale) : width;
    double size = fmin(fmin(FONT_MAX, 0.9 * fitting / (0.56 * (double)letters)), 0.45 * height);
    if (size < FONT_MIN || name.base == 0) {
        return;
    }
    enf_text_put(&plan->svg, "<text class=\"name\" x=\"%.2f\" y=\"%.2f\" font-size=\"%.1f\">", page_x(plan, storey, at.x),
                 page_y(plan, storey, at.z) + 0.35 * size, size);
    enf_text_put_xml(&plan->svg, name.text, name.base);
    enf_text_put(&plan->svg, "</text>\n");
}

/* A cell of which nothing faces up: its box, dashed. */
static void put_box(Plan *plan, const Storey *storey, const EnfLayoutCell *cell) {
    EnfVec3 low = low_corner(cell), high = high_corner(cell);
    enf_text_put(&plan->svg, "<rect class=\"box\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                 page_x(plan, storey, low.x), page_y(plan, storey, low.z), (high.x - low.x) * plan->scale,
                 (high.z - low.z) * plan->scale);
}

typedef enum Which { WHICH_ALL, WHICH_THINGS, WHICH_WALLS } Which;

static void put_loops(Plan *plan, const Storey *storey, const EnfPlanOutline *outline, const char *attributes, Which which) {
    bool any = false;
    for (uint32_t i = 0; i < outline->loops.count; i++) {
        const EnfPlanLoop *loop = &outline->loops.data[i];
        if (which == WHICH_ALL || (which == WHICH_THINGS ? loop->thing : !loop->inner)) {
            if (!any) {
                enf_text_put(&plan->svg, "<path %s d=\"", attributes);
            }
            any = true;
            put_loop(plan, storey, outline, loop);
        }
    }
    if (any) {
        enf_text_put(&plan->svg, "\"/>\n");
    }
}

/* The floor, which every loop has a part in; things on it; walls. */
static void put_outline(Plan *plan, const Storey *storey, const EnfPlanOutline *outline, const char *color) {
    char fill[64];
    snprintf(fill, sizeof fill, "fill=\"%s\"", color);
    put_loops(plan, storey, outline, fill, WHICH_ALL);
    put_loops(plan, storey, outline, "class=\"thing\"", WHICH_THINGS);
    put_loops(plan, storey, outline, "class=\"wall\"", WHICH_WALLS);
}

static void put_cell(Plan *plan, uint32_t index, bool names) {
    const EnfLayoutCell *cell = &plan->layout->cells[index];
    const Storey *storey = &plan->storeys.data[plan->storey[index]];
    EnfPlanOutline outline;
    uint32_t first = plan->first[index];
    enf_plan_outline(&outline, plan->soup, plan->triangles + first, plan->first[index + 1] - first);
    plan->failed = plan->failed || outline.failed;
    EnfPlanPoint middle = {0.5 * (low_corner(cell).x + high_corner(cell).x), 0.5 * (low_corner(cell).z + high_corner(cell).z)};
    if (names) {
        bool known = outline.loops.count > 0;
        put_name(plan, storey, cell, known ? outline.label : middle, known ? outline.clearance : 0);
    } else if (outline.loops.count > 0) {
        put_outline(plan, storey, &outline, palette[plan->color[index]]);
    } else {
        put_box(plan, storey, cell);
    }
    enf_plan_outline_free(&outline);
}

/* ---- portals ---------------------------------------------------------------------------------------------------- */

/* What kinds of portal there are: a colour each. Attributes are written out, because not every viewer reads style sheets. */
typedef enum Kind { KIND_OPEN, KIND_SHUT, KIND_FAR, KIND_COUNT } Kind;
static const struct {
    const char *color, *text;
} kinds[KIND_COUNT] = {{"#1c8c83", "portal"}, {"#b3402f", "portal, closed at start"}, {"#5a4fa3", "mirror or teleport"}};

static Kind kind_of(const EnfLayoutPortal *portal) {
    return portal->has_transform ? KIND_FAR : portal->flags & ENF_PORTAL_CLOSED ? KIND_SHUT : KIND_OPEN;
}

/* Begins a path: a bar, or the area of an opening that is not upright. */
static void begin_path(Plan *plan, Kind kind, bool area) {
    if (area) {
        enf_text_put(&plan->svg,
                     "<path fill=\"%s\" fill-opacity=\"0.22\" stroke=\"%s\" stroke-width=\"1.2\" stroke-dasharray=\"4 2.5\"",
                     kinds[kind].color, kinds[kind].color);
    } else {
        enf_text_put(&plan->svg, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"4.5\" stroke-linecap=\"round\"",
                     kinds[kind].color);
    }
}

/* An upright portal is a bar between its two ends in the plan; others show their area. */
static void put_portal(Plan *plan, const Storey *storey, const EnfLayoutPortal *portal) {
    const EnfGrid3 *points = plan->layout->points + portal->point_first;
    uint32_t count = portal->point_count, from = 0, to = 0;
    double longest = -1, twice = 0;
    for (uint32_t i = 0; i < count; i++) {
        EnfVec3 a = enf_grid_point(points[i]), next = enf_grid_point(points[(i + 1) % count]);
        twice += next.x * a.z - a.x * next.z;
        for (uint32_t k = i + 1; k < count; k++) {
            EnfVec3 b = enf_grid_point(points[k]);
            double length2 = (b.x - a.x) * (b.x - a.x) + (b.z - a.z) * (b.z - a.z);
            if (length2 > longest) {
                longest = length2;
                from = i;
                to = k;
            }
        }
    }
    EnfVec3 a = enf_grid_point(points[from]), b = enf_grid_point(points[to]);
    if (fabs(0.5 * twice) > 0.1 * longest) {
        begin_path(plan, kind_of(portal), true);
        enf_text_put(&plan->svg, " d=\"");
        for (uint32_t i = 0; i < count; i++) {
            EnfVec3 p = enf_grid_point(points[i]);
            enf_text_put(&plan->svg, "%s%.2f %.2f", i ? "L" : "M", page_x(plan, storey, p.x), page_y(plan, storey, p.z));
        }
        enf_text_put(&plan->svg, "Z\"><title>");
    } else {
        begin_path(plan, kind_of(portal), false);
        enf_text_put(&plan->svg, " d=\"M%.2f %.2fL%.2f %.2f\"><title>", page_x(plan, storey, a.x), page_y(plan, storey, a.z),
                     page_x(plan, storey, b.x), page_y(plan, storey, b.z));
    }
    enf_text_put_xml(&plan->svg, portal->name, strlen(portal->name));
    enf_text_put(&plan->svg, "</title></path>\n");
}

static void put_portals(Plan *plan, uint32_t storey) {
    const EnfLayout *layout = plan->layout;
    for (uint32_t i = 0; i < layout->portal_count; i++) {
        const EnfLayoutPortal *portal = &layout->portals[i];
        bool here = is_shown(plan, portal->source) && plan->storey[portal->source] == storey;
        /* Of twins on one storey, one is enough. */
        bool twin_shown = portal->twin != ENF_NONE && portal->twin < i && is_shown(plan, portal->target) &&
                          plan->storey[portal->target] == storey && !portal->has_transform;
        if (here && portal->point_count >= 3 && !twin_shown) {
            put_portal(plan, &plan->storeys.data[storey], portal);
        }
    }
}

/* ---- the page --------------------------------------------------------------------------------------------------- */

static void put_head(Plan *plan, const char *title, uint32_t cells, uint32_t portals) {
    enf_text_put(&plan->svg,
                 "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\">\n"
                 "<style>\n"
                 "text{font-family:'Helvetica Neue',Helvetica,Arial,sans-serif;fill:#3a3833}\n"
                 ".wall{fill:none;stroke:#3a3833;stroke-width:1.6;stroke-linejoin:round}\n"
                 ".box{fill:#fff;fill-opacity:.3;stroke:#8a867c;stroke-width:1;stroke-dasharray:5 3}\n"
                 ".thing{fill:#fff;fill-opacity:.45;stroke:#8a867c;stroke-width:.6;stroke-linejoin:round}\n"
                 ".name{text-anchor:middle}\n"
                 ".small{font-size:13px;fill:#6d695f}\n"
                 "</style>\n<rect width=\"100%%\" height=\"100%%\" fill=\"#faf8f3\"/>\n"
                 "<text x=\"%.0f\" y=\"46\" font-size=\"26\" font-weight=\"600\">",
                 PAGE_WIDTH, plan->height, PAGE_WIDTH, plan->height, MARGIN);
    enf_text_put_xml(&plan->svg, title, strlen(title));
    enf_text_put(&plan->svg, "</text>\n<text class=\"small\" x=\"%.0f\" y=\"70\">%u cells, %u openings, %u %s</text>\n", MARGIN,
                 cells, portals, plan->storeys.count, plan->storeys.count == 1 ? "storey" : "storeys");
}

/* The longest of 1, 2, 5 × 10ⁿ metres that takes at most 220 pixels. */
static double scale_bar(double scale) {
    static const double steps[] = {1, 2, 5};
    double best = 0.1, power = 0.1;
    for (int digit = 0; digit < 6; digit++, power *= 10) {
        for (int i = 0; i < 3; i++) {
            best = steps[i] * power * scale <= 220 ? steps[i] * power : best;
        }
    }
    return best;
}

static void put_legend(Plan *plan) {
    double y = plan->height - LEGEND / 2, x = MARGIN, metres = scale_bar(plan->scale), length = metres * plan->scale;
    enf_text_put(&plan->svg, "<path d=\"M%.2f %.2fv6h%.2fv-6\" fill=\"none\" stroke=\"#3a3833\" stroke-width=\"1.5\"/>\n", x,
                 y - 6, length);
    enf_text_put(&plan->svg, "<text class=\"small\" x=\"%.2f\" y=\"%.2f\">%g m</text>\n", x + length + 8, y + 1, metres);
    x += length + 90;
    for (int i = 0; i < KIND_COUNT; i++) {
        begin_path(plan, (Kind)i, false);
        enf_text_put(&plan->svg, " d=\"M%.2f %.2fh26\"/>\n", x, y - 3);
        enf_text_put(&plan->svg, "<text class=\"small\" x=\"%.2f\" y=\"%.2f\">%s</text>\n", x + 36, y + 1, kinds[i].text);
        x += 76 + 7.0 * (double)strlen(kinds[i].text);
    }
    begin_path(plan, KIND_OPEN, true);
    enf_text_put(&plan->svg, " d=\"M%.2f %.2fh26v12h-26Z\"/>\n", x, y - 9);
    enf_text_put(&plan->svg, "<text class=\"small\" x=\"%.2f\" y=\"%.2f\">opening in a floor or ceiling</text>\n", x + 36,
                 y + 1);
    enf_text_put(&plan->svg, "<text class=\"small\" x=\"%.0f\" y=\"%.2f\" text-anchor=\"end\">north is −Z</text>\n</svg>\n",
                 PAGE_WIDTH - MARGIN, y + 1);
}

static void put_storey(Plan *plan, uint32_t index) {
    const Storey *storey = &plan->storeys.data[index];
    enf_text_put(&plan->svg, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"15\" font-weight=\"600\">Storey %u</text>\n",
                 storey->left, storey->top - 12, index + 1);
    enf_text_put(&plan->svg, "<text class=\"small\" x=\"%.2f\" y=\"%.2f\">floor from %.2f m</text>\n", storey->left + 86,
                 storey->top - 12, storey->floor);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < plan->layout->cell_count; i++) {
            uint32_t cell = plan->order[i];
            if (is_shown(plan, cell) && plan->storey[cell] == index) {
                put_cell(plan, cell, pass == 1);
            }
        }
        if (pass == 0) {
            put_portals(plan, index);
        }
    }
}

static void put_page(Plan *plan, const char *title) {
    uint32_t cells = 0, portals = 0;
    for (uint32_t i = 0; i < plan->layout->cell_count; i++) {
        cells += is_shown(plan, i);
    }
    for (uint32_t i = 0; i < plan->layout->portal_count; i++) {
        const EnfLayoutPortal *portal = &plan->layout->portals[i];
        portals += portal->point_count > 0 && (portal->twin == ENF_NONE || portal->twin >= i);
    }
    place_panels(plan);
    put_head(plan, title, cells, portals);
    for (uint32_t i = plan->storeys.count; i > 0; i--) {
        put_storey(plan, i - 1);
    }
    put_legend(plan);
}

EnfResult enf_plan_write(const char *path, const char *title, const EnfLayout *layout, const EnfSoup *soup, EnfError *error) {
    Plan plan;
    memset(&plan, 0, sizeof plan);
    plan.layout = layout;
    plan.soup = soup;
    EnfResult result = ENF_OK;
    if (sort_triangles(&plan) && find_storeys(&plan) && sort_cells(&plan) && choose_colors(&plan)) {
        put_page(&plan, title);
    } else {
        plan.failed = true;
    }
    if (plan.failed || plan.svg.failed) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory while drawing the plan");
    } else {
        result = enf_file_write(path, &(EnfSpan){plan.svg.data, plan.svg.count}, 1, error);
    }
    free(plan.svg.data);
    free(plan.first);
    free(plan.triangles);
    free(plan.storey);
    free(plan.order);
    free(plan.color);
    free(plan.storeys.data);
    return result;
}

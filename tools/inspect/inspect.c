/* Makes lines from a visible set, and the wireframe of what it lacks. Portals are tested here once more, by the same functions as
 * the traversal, so that those it cut can be shown, too. */
#include "inspect/inspect.h"

#include <string.h>

enum { GREEN = 0x50ff50, RED = 0x4040ff, GREY = 0x808080, WHITE = 0xffffff }; /* R in the low byte */

/* Lines in the world, kept relative to the observer, in the memory of an Inspect. */
typedef struct Lines {
    InspectMemory *memory;
    uint32_t count;
    EnfVec3 eye_ws;
    bool failed;
} Lines;

static void add_point(Lines *lines, EnfVec3 p_ws, uint32_t rgb) {
    InspectMemory *memory = lines->memory;
    if (lines->count == memory->capacity) {
        uint32_t wanted = memory->capacity ? 2 * memory->capacity : 1024;
        EnfDebugVertex *grown = enf_realloc(NULL, memory->vertices, memory->capacity, wanted, sizeof *grown);
        if (!grown) {
            lines->failed = true;
            return;
        }
        memory->vertices = grown;
        memory->capacity = wanted;
    }
    EnfVec3f p = enf_v3f(enf_sub(p_ws, lines->eye_ws));
    EnfDebugVertex vertex = {{p.x, p.y, p.z}, rgb | 0xff000000u};
    memory->vertices[lines->count++] = vertex;
}

static void add_line(Lines *lines, EnfVec3 a_ws, EnfVec3 b_ws, uint32_t rgb) {
    if (!lines->failed) {
        add_point(lines, a_ws, rgb);
        add_point(lines, b_ws, rgb);
    }
}

static void add_loop(Lines *lines, const EnfVec3 *points_ws, uint32_t count, uint32_t rgb) {
    for (uint32_t i = 0; i < count; i++) {
        add_line(lines, points_ws[i], points_ws[(i + 1) % count], rgb);
    }
}

static EnfVec3 cell_origin(const EnfMap *map, uint32_t cell) {
    const double *o = map->cells[cell].origin;
    return enf_v3(o[0], o[1], o[2]);
}

/* ---- portals ---------------------------------------------------------------------------------------------------- */

static bool passes(const Inspect *inspect, const EnfPortalState *state, const EnfVec3 *points_ws, EnfWindow window) {
    const EnfCamera *camera = &inspect->set->cameras[0];
    EnfVec3 eye = enf_sub(camera->eye_ws, cell_origin(inspect->map, state->source));
    if (!(state->flags & ENF_PORTAL_NONPLANAR) && enf_dot(state->normal, eye) + (double)state->d > (double)state->slab) {
        return false;
    }
    EnfVec3 points_eye[ENF_POLYGON_MAX];
    for (uint32_t i = 0; i < state->vertex_count; i++) {
        points_eye[i] = enf_sub(points_ws[i], camera->eye_ws);
    }
    EnfWindow seen;
    return enf_project_box(camera, points_eye, state->vertex_count, window, &seen) != ENF_PROJECT_EMPTY;
}

/* The outlines of a visit's portals: those that pass if `passed`, else the others. */
static void add_portals(const Inspect *inspect, Lines *lines, const EnfVisit *visit, bool passed) {
    const EnfMap *map = inspect->map;
    const EnfCell *cell = &map->cells[visit->cell];
    for (uint32_t p = cell->portal_first; p < cell->portal_first + cell->portal_count; p++) {
        const EnfPortalState *state = &inspect->portals->states[p];
        if (state->vertex_count < 3) {
            continue;
        }
        EnfVec3 points_ws[ENF_POLYGON_MAX];
        for (uint32_t i = 0; i < state->vertex_count; i++) {
            points_ws[i] = enf_add(enf_v3_from_f(inspect->portals->vertices[state->vertex_first + i]),
                                   cell_origin(map, state->source));
        }
        bool closed = (state->flags & ENF_PORTAL_CLOSED) != 0;
        if ((!closed && passes(inspect, state, points_ws, visit->window)) == passed) {
            add_loop(lines, points_ws, state->vertex_count, closed ? GREY : passed ? GREEN : RED);
        }
    }
}

/* Green over red: a portal that passes once is passed. */
static void add_all_portals(const Inspect *inspect, Lines *lines) {
    for (int passed = 0; passed < 2; passed++) {
        for (uint32_t i = 0; i < inspect->set->visit_count; i++) {
            if (inspect->set->visits[i].space == 0) {
                add_portals(inspect, lines, &inspect->set->visits[i], passed != 0);
            }
        }
    }
}

/* ---- windows ---------------------------------------------------------------------------------------------------- */

/* The point one metre in front of the culling eye that a place on its screen shows (steps of a window). */
static EnfVec3 on_screen(const EnfCamera *camera, int32_t x, int32_t y) {
    double u = ((double)x / (8.0 * (double)camera->width_px) - 1.0) * camera->tan_x;
    double v = ((double)y / (8.0 * (double)camera->height_px) - 1.0) * camera->tan_y;
    EnfVec3 across = enf_add(enf_scale(camera->right, u), enf_scale(camera->up, v));
    return enf_add(camera->eye_ws, enf_add(camera->forward, across));
}

static void add_window(const Inspect *inspect, Lines *lines, const EnfVisit *visit) {
    const EnfCamera *camera = &inspect->set->cameras[0];
    EnfWindowPolygon polygon = visit->polygon == ENF_NONE ? enf_window_polygon_from_box(visit->window)
                                                          : inspect->set->polygons[visit->polygon];
    EnfVec3 points_ws[ENF_WINDOW_POLYGON_MAX];
    for (uint32_t i = 0; i < polygon.count; i++) {
        points_ws[i] = on_screen(camera, polygon.x[i], polygon.y[i]);
    }
    add_loop(lines, points_ws, polygon.count, inspect_color(visit->cell));
}

/* The pyramid of a frozen eye, three metres long. */
static void add_pyramid(const Inspect *inspect, Lines *lines) {
    const EnfCamera *camera = &inspect->set->cameras[0];
    EnfWindowPolygon full = enf_window_polygon_from_box(enf_window_full(camera));
    EnfVec3 points_ws[4];
    for (uint32_t i = 0; i < 4; i++) {
        EnfVec3 ray = enf_sub(on_screen(camera, full.x[i], full.y[i]), camera->eye_ws);
        points_ws[i] = enf_add(camera->eye_ws, enf_scale(ray, 3.0));
        add_line(lines, camera->eye_ws, points_ws[i], WHITE);
    }
    add_loop(lines, points_ws, 4, WHITE);
}

/* ---- kd-trees --------------------------------------------------------------------------------------------------- */

static void add_box(Lines *lines, const EnfKdNode *node, EnfVec3 origin, uint32_t rgb) {
    EnfVec3 corners[8];
    for (int i = 0; i < 8; i++) {
        EnfVec3 corner = {(double)(i & 1 ? node->max[0] : node->min[0]), (double)(i & 2 ? node->max[1] : node->min[1]),
                          (double)(i & 4 ? node->max[2] : node->min[2])};
        corners[i] = enf_add(corner, origin);
    }
    for (int i = 0; i < 8; i++) {
        for (int axis = 1; axis < 8; axis <<= 1) {
            if (!(i & axis)) {
                add_line(lines, corners[i], corners[i | axis], rgb);
            }
        }
    }
}

/* Leaves in the colour of their cell; the nodes above them would hide everything. */
static void add_tree(const Inspect *inspect, Lines *lines, uint32_t cell) {
    EnfKdTree tree = enf_map_cell_tree(inspect->map, cell);
    for (uint32_t i = 0; i < tree.node_count; i++) {
        if (tree.nodes[i].block_count) {
            add_box(lines, &tree.nodes[i], cell_origin(inspect->map, cell), inspect_color(cell));
        }
    }
}

/* ---- volumes ---------------------------------------------------------------------------------------------------- */

/* Colours of states, R in the low byte; asleep is dimmer the sooner it ends. */
static const uint32_t state_colors[] = {0, 0xe0a060, 0xe040e0, 0x30a0ff, 0x40ff40};

/* How much of 2^20 ticks (five hours) is left, on a scale of doublings: 0 to 1. */
static double share_left(int64_t ticks) {
    double share = 0.0;
    for (int64_t t = ticks; t > 0 && share < 1.0; t /= 2) {
        share += 1.0 / 20.0;
    }
    return share;
}

static uint32_t dimmed(uint32_t rgb, double level) {
    uint32_t out = 0;
    for (int i = 0; i < 3; i++) {
        out |= (uint32_t)((double)(rgb >> (8 * i) & 255u) * level) << (8 * i);
    }
    return out;
}

/* The box of a volume, and on its middle a bar as long as what is left of its validity. */
static void add_volume(const Inspect *inspect, Lines *lines, uint32_t object) {
    const EnfDbvIndex *dbv = inspect->dbv;
    EnfDbvState state = enf_dbv_state(dbv, object);
    EnfBox3f box;
    int64_t expiry;
    if (state == ENF_DBV_STATE_NONE || !enf_dbv_volume(dbv, object, &box, &expiry)) {
        return;
    }
    double left = share_left(expiry - enf_world_tick(inspect->world));
    uint32_t rgb = dimmed(state_colors[state], state == ENF_DBV_STATE_ASLEEP ? 0.5 + 0.5 * left : 1.0);
    EnfKdNode node = {{box.min.x, box.min.y, box.min.z}, 0, {box.max.x, box.max.y, box.max.z}, 0};
    add_box(lines, &node, enf_v3(0.0, 0.0, 0.0), rgb);
    EnfVec3 low = enf_v3_from_f(box.min), high = enf_v3_from_f(box.max);
    EnfVec3 begin = enf_v3(low.x, 0.5 * (low.y + high.y), 0.5 * (low.z + high.z));
    EnfVec3 end = begin, full = begin;
    end.x += (high.x - low.x) * left;
    full.x = high.x;
    add_line(lines, begin, end, WHITE);
    add_line(lines, end, full, dimmed(rgb, 0.4));
}

/* ---- all lines -------------------------------------------------------------------------------------------------- */

static void flush(const Inspect *inspect, Lines *lines, bool through) {
    enf_gl_draw_lines(inspect->gl, inspect->clip_from_eye, lines->memory->vertices, lines->count, through);
    lines->count = 0;
}

EnfResult inspect_draw_lines(const Inspect *inspect, InspectMemory *memory, EnfError *error) {
    Lines lines = {.memory = memory, .eye_ws = inspect->observer.eye_ws};
    if (inspect->what & INSPECT_KD) {
        for (uint32_t i = 0; i < inspect->set->cell_count; i++) {
            add_tree(inspect, &lines, inspect->set->cells[i]);
        }
        flush(inspect, &lines, false);
    }
    if (inspect->what & INSPECT_PORTALS) {
        add_all_portals(inspect, &lines);
    }
    uint32_t objects = inspect->what & INSPECT_DBV && inspect->dbv ? enf_world_object_limit(inspect->world) : 0;
    for (uint32_t i = 0; i < objects; i++) {
        add_volume(inspect, &lines, i);
    }
    for (uint32_t i = 0; inspect->what & INSPECT_WINDOWS && i < inspect->set->visit_count; i++) {
        if (inspect->set->visits[i].space == 0) {
            add_window(inspect, &lines, &inspect->set->visits[i]);
        }
    }
    if (inspect->what & INSPECT_PYRAMID) {
        add_pyramid(inspect, &lines);
    }
    flush(inspect, &lines, true);
    return lines.failed ? enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for lines") : ENF_OK;
}

/* ---- what is culled --------------------------------------------------------------------------------------------- */

/* Entries ascend: a merge of all numbers with those seen. */
static void list_culled_clusters(const EnfVisSet *set, uint32_t clusters, EnfVisEntry *entries, EnfVisSet *culled) {
    uint32_t next = 0;
    for (uint32_t c = 0; c < clusters; c++) {
        while (next < set->entry_count && set->entries[next].space == 0 && set->entries[next].cluster < c) {
            next++;
        }
        bool seen = next < set->entry_count && set->entries[next].space == 0 && set->entries[next].cluster == c;
        if (!seen) {
            EnfVisEntry entry = {c, 0, 0};
            entries[culled->entry_count++] = entry;
        }
    }
}

static void list_culled_objects(const EnfVisSet *set, uint32_t count, uint32_t *objects, EnfVisSet *culled) {
    uint32_t next = 0;
    culled->objects_listed = true;
    for (uint32_t i = 0; i < count && set->objects_listed; i++) {
        next += next < set->object_count && set->objects[next] < i ? 1U : 0U;
        if (next >= set->object_count || set->objects[next] != i) {
            objects[culled->object_count++] = i;
        }
    }
}

static bool make_room(InspectMemory *memory, uint32_t clusters, uint32_t objects) {
    if (!memory->entries) {
        memory->entry_room = clusters + 1;
        memory->entries = enf_alloc(NULL, memory->entry_room, sizeof *memory->entries);
    }
    if (objects + 1 > memory->object_room) {
        enf_free(NULL, memory->objects, memory->object_room, sizeof *memory->objects);
        memory->object_room = objects + 1;
        memory->objects = enf_alloc(NULL, memory->object_room, sizeof *memory->objects);
        memory->object_room = memory->objects ? memory->object_room : 0;
    }
    return memory->entries && memory->objects;
}

EnfResult inspect_draw_culled(const Inspect *inspect, InspectMemory *memory, EnfDraw *draw, EnfError *error) {
    const EnfMap *map = inspect->map;
    uint32_t objects = enf_world_object_limit(inspect->world);
    if (!make_room(memory, map->clusters_count, objects)) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "no memory for what is culled");
    }
    EnfVisSet culled = {
        .entries = memory->entries, .objects = memory->objects, .cameras = &inspect->observer, .space_count = 1};
    list_culled_clusters(inspect->set, map->clusters_count, memory->entries, &culled);
    list_culled_objects(inspect->set, objects, memory->objects, &culled);
    const EnfDrawList *list = enf_draw_build(draw, &culled, ENF_DRAW_NEAR, inspect->world, 1.0);
    uint32_t faint = inspect->what & INSPECT_DBV ? 0x10a0a0a0u : 0x38a0a0a0u; /* volumes are lines, too */
    enf_gl_draw_wireframe(inspect->gl, list, faint);
    return ENF_OK;
}

void inspect_free(InspectMemory *memory) {
    enf_free(NULL, memory->vertices, memory->capacity, sizeof *memory->vertices);
    enf_free(NULL, memory->entries, memory->entry_room, sizeof *memory->entries);
    enf_free(NULL, memory->objects, memory->object_room, sizeof *memory->objects);
    memset(memory, 0, sizeof *memory);
}

/* ---- colours ---------------------------------------------------------------------------------------------------- */

uint32_t inspect_color(uint32_t number) {
    /* Hues by the golden angle, in 1/1536 of a turn; saturated enough to tell apart, bright enough for lines. */
    uint32_t hue = (number * 949u) % 1536u, rise = hue % 256u, fall = 255u - rise;
    static const uint32_t order[6][3] = {{0, 1, 2}, {3, 0, 2}, {2, 0, 1}, {2, 3, 0}, {1, 2, 0}, {0, 2, 3}};
    const uint32_t levels[4] = {255, rise, 0, fall};
    const uint32_t *pick = order[hue / 256u];
    uint32_t shade = 208u + number * 29u % 48u, rgb = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t level = (64u + levels[pick[i]] * 191u / 255u) * shade / 256u;
        rgb |= level << (8 * i);
    }
    return rgb;
}

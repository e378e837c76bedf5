/* `plain`: what someone would write in an afternoon where rooms are boxes and doors are upright rectangles. Arrays; a list of objects
 * a room; portals as rectangles on the screen, narrowed from room to room; an object as a rectangle too. No tree, no volume, no care
 * for rounding, for what stands in a doorway or for the near plane. A lower bound of what finding visible objects can cost, for the
 * comparison with other engines: what it lists is its own affair. */
#include "enfbench/movers.h"

#include <stdlib.h>

/** A door: an upright rectangle, two opposite corners, and where it leads. */
typedef struct Door {
    float a[3], b[3];
    uint32_t target;
} Door;

typedef struct Rect {
    float x0, y0, x1, y1;
} Rect;

struct Plain {
    Rival *rival;
    Door *doors;
    uint32_t *first; /* a room's doors begin here; room_count + 1 */
    uint32_t *asked; /* the frame in which an object was found */
    uint32_t *found;
    uint32_t room_count, frame, count;
    RivalLists lists;
    float eye[3], rows[3][3]; /* right, up, forward; right and up times the focal length */
};

void bench_plain_destroy(Plain *plain) {
    if (plain != NULL) {
        bench_rival_destroy(plain->rival);
        free(plain->doors);
        free(plain->first);
        free(plain->asked);
        free(plain->found);
        free(plain);
    }
}

static void make_doors(Plain *plain, const EnfMap *map) {
    for (uint32_t c = 0, d = 0; c < map->cells_count; c++) {
        const EnfCell *cell = &map->cells[c];
        plain->first[c] = d;
        for (uint32_t p = cell->portal_first; p < cell->portal_first + cell->portal_count; p++, d++) {
            const EnfPortal *portal = &map->portals[p];
            EnfBox3 box = enf_box3_empty();
            for (uint32_t v = 0; v < portal->vertex_count; v++) {
                EnfVec3 origin = enf_v3(cell->origin[0], cell->origin[1], cell->origin[2]);
                box = enf_box3_add(box, enf_add(origin, enf_v3_from_f(map->portal_vertices[portal->vertex_first + v])));
            }
            Door door = {{(float)box.min.x, (float)box.min.y, (float)box.min.z},
                         {(float)box.max.x, (float)box.max.y, (float)box.max.z},
                         portal->target};
            plain->doors[d] = door;
        }
        plain->first[c + 1] = d;
    }
}

Plain *bench_plain_create(const MoversScene *scene) {
    const EnfMap *map = scene->rooms.map;
    Plain *plain = calloc(1, sizeof *plain);
    if (plain == NULL) {
        return NULL;
    }
    plain->rival = bench_rival_create(scene, false);
    plain->doors = calloc(map->portals_count + 1U, sizeof *plain->doors);
    plain->first = calloc(map->cells_count + 1U, sizeof *plain->first);
    plain->asked = calloc(scene->def.movers + 1U, sizeof *plain->asked);
    plain->found = calloc(scene->def.movers + 1U, sizeof *plain->found);
    plain->room_count = map->cells_count;
    if (!plain->rival || !plain->doors || !plain->first || !plain->asked || !plain->found) {
        bench_plain_destroy(plain);
        return NULL;
    }
    make_doors(plain, map);
    return plain;
}

/* ---- a frame ---------------------------------------------------------------------------------------------------- */

static void to_eye(const Plain *plain, const float p[3], float out[3]) {
    float x = p[0] - plain->eye[0], y = p[1] - plain->eye[1], z = p[2] - plain->eye[2];
    for (int i = 0; i < 3; i++) {
        out[i] = plain->rows[i][0] * x + plain->rows[i][1] * y + plain->rows[i][2] * z;
    }
}

/* The rectangle of a door on the screen within `window`; false if nothing of it is to be seen. */
static bool through(const Plain *plain, const Door *door, const Rect *window, Rect *out) {
    Rect rect = {1e9F, 1e9F, -1e9F, -1e9F};
    int behind = 0;
    for (int i = 0; i < 4; i++) {
        const float corner[3] = {i & 1 ? door->b[0] : door->a[0], i & 2 ? door->b[1] : door->a[1],
                                 i & 1 ? door->b[2] : door->a[2]};
        float p[3];
        to_eye(plain, corner, p);
        if (p[2] < 0.01F) {
            behind++;
            continue;
        }
        float x = p[0] / p[2], y = p[1] / p[2];
        rect.x0 = x < rect.x0 ? x : rect.x0;
        rect.x1 = x > rect.x1 ? x : rect.x1;
        rect.y0 = y < rect.y0 ? y : rect.y0;
        rect.y1 = y > rect.y1 ? y : rect.y1;
    }
    if (behind == 4) {
        return false;
    }
    *out = *window;
    if (behind == 0) { /* else: the whole window */
        out->x0 = rect.x0 > out->x0 ? rect.x0 : out->x0;
        out->x1 = rect.x1 < out->x1 ? rect.x1 : out->x1;
        out->y0 = rect.y0 > out->y0 ? rect.y0 : out->y0;
        out->y1 = rect.y1 < out->y1 ? rect.y1 : out->y1;
    }
    return out->x0 < out->x1 && out->y0 < out->y1;
}

/* Is an object's upright box within the window? By the extents of its box along the axes of the eye. */
static bool shows(const Plain *plain, uint32_t object, const Rect *window) {
    const float half[3] = {(float)MOVER_REACH, (float)MOVER_HEIGHT, (float)MOVER_REACH};
    const float p[3] = {plain->lists.x[object], plain->lists.y[object], plain->lists.z[object]};
    float at[3], size[3];
    to_eye(plain, p, at);
    for (int i = 0; i < 3; i++) {
        float sum = 0.0F;
        for (int a = 0; a < 3; a++) {
            float k = plain->rows[i][a] * half[a];
            sum += k < 0.0F ? -k : k;
        }
        size[i] = sum;
    }
    float near = at[2] - size[2];
    if (at[2] + size[2] < 0.01F) {
        return false;
    }
    near = near < 0.01F ? 0.01F : near;
    float x0 = at[0] - size[0], x1 = at[0] + size[0], y0 = at[1] - size[1], y1 = at[1] + size[1];
    float far = at[2] + size[2];
    return x0 / (x0 < 0.0F ? near : far) < window->x1 && x1 / (x1 > 0.0F ? near : far) > window->x0 &&
           y0 / (y0 < 0.0F ? near : far) < window->y1 && y1 / (y1 > 0.0F ? near : far) > window->y0;
}

/* A room through a window, and the rooms beyond its doors; `from` is where one came from. */
static void enter(Plain *plain, uint32_t room, uint32_t from, Rect window, int depth) {
    for (uint32_t i = plain->lists.heads[room]; i != ENF_NONE; i = plain->lists.next[i]) {
        if (plain->asked[i] != plain->frame && shows(plain, i, &window)) {
            plain->asked[i] = plain->frame;
            plain->found[plain->count++] = i;
        }
    }
    for (uint32_t d = plain->first[room]; d < plain->first[room + 1] && depth < 64; d++) {
        Rect narrower;
        if (plain->doors[d].target != from && through(plain, &plain->doors[d], &window, &narrower)) {
            enter(plain, plain->doors[d].target, room, narrower, depth + 1);
        }
    }
}

static void set_row(float row[3], EnfVec3 v, double scale) {
    row[0] = (float)(v.x * scale);
    row[1] = (float)(v.y * scale);
    row[2] = (float)(v.z * scale);
}

const uint32_t *bench_plain_frame(Plain *plain, const EnfView *view, int64_t tick, uint32_t *count) {
    const EnfCamera *camera = &view->camera;
    const Rect screen = {-1.0F, -1.0F, 1.0F, 1.0F};
    plain->lists = bench_rival_lists(plain->rival, tick);
    plain->frame++;
    plain->count = 0;
    plain->eye[0] = (float)camera->eye_ws.x;
    plain->eye[1] = (float)camera->eye_ws.y;
    plain->eye[2] = (float)camera->eye_ws.z;
    set_row(plain->rows[0], camera->right, 1.0 / camera->tan_x);
    set_row(plain->rows[1], camera->up, 1.0 / camera->tan_y);
    set_row(plain->rows[2], camera->forward, 1.0);
    if (view->cell < plain->room_count) {
        enter(plain, view->cell, ENF_NONE, screen, 0);
    }
    *count = plain->count;
    return plain->found;
}

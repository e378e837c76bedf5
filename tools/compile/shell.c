/* Shells: triangles by cell, rays against them. Input: triangles with their cells; output: answers about points. */
#include "compile/shell.h"

#include <float.h>
#include <string.h>

enum {
    SMALL_SHELL = 24,    /* triangles up to which a ray tries each */
    AXIS_CANDIDATES = 32 /* directions remembered while the main ones are sought */
};

/* Two surfaces this near (metres) are one sheet: half a step of the grid. */
static const double SAME_PLACE = 1.0 / 8192.0;

/* Three directions at right angles, askew to everything that people build, and their opposites: a plane at distance d from a point is
 * met by at least one of the first four within d times the square root of 3, of the six by three. */
static const EnfVec3 rays[ENF_SHELL_RAYS] = {
    {0.78358555152015, 0.54882996185743, 0.29116894823528},  {-0.78358555152015, -0.54882996185743, -0.29116894823528},
    {-0.57955198891207, 0.47684293997059, 0.66086330110566}, {0.57955198891207, -0.47684293997059, -0.66086330110566},
    {0.22385972303414, -0.68659047733549, 0.69172273407435}, {-0.22385972303414, 0.68659047733549, -0.69172273407435}};

static double least(double a, double b) {
    return a < b ? a : b;
}

static double most(double a, double b) {
    return a > b ? a : b;
}

static void grow_box(EnfBox3 *box, EnfVec3 p) {
    box->min = enf_v3(least(box->min.x, p.x), least(box->min.y, p.y), least(box->min.z, p.z));
    box->max = enf_v3(most(box->max.x, p.x), most(box->max.y, p.y), most(box->max.z, p.z));
}

typedef struct AxisVotes {
    EnfVec3 axis[AXIS_CANDIDATES];
    double area[AXIS_CANDIDATES];
    uint32_t count;
} AxisVotes;

static EnfVec3 corner(const EnfShells *shells, uint32_t triangle, int k) {
    return enf_v3_from_f(shells->triangles[triangle][k]);
}

/* First pass: how many triangles each cell has, and their box. */
static void count_triangles(EnfShells *shells, uint32_t triangle_count, EnfShellTriangleFn *triangle, const void *user) {
    for (uint32_t c = 0; c < shells->cell_count; c++) {
        shells->cells[c].box = enf_box3_empty();
    }
    for (uint32_t i = 0; i < triangle_count; i++) {
        EnfVec3 p[3];
        uint32_t cell = triangle(user, i, p);
        if (cell == ENF_NONE) {
            continue;
        }
        EnfShell *shell = &shells->cells[cell];
        shell->count++;
        for (int k = 0; k < 3; k++) {
            grow_box(&shell->box, p[k]);
        }
    }
    for (uint32_t c = 0; c < shells->cell_count; c++) {
        EnfShell *shell = &shells->cells[c];
        shell->first = shells->triangle_count;
        shells->triangle_count += shell->count;
        if (shell->count > 0) {
            shell->origin = enf_scale(enf_add(shell->box.min, shell->box.max), 0.5);
        }
    }
}

static void fill_triangles(EnfShells *shells, uint32_t triangle_count, EnfShellTriangleFn *triangle, const void *user) {
    for (uint32_t c = 0; c < shells->cell_count; c++) {
        shells->cells[c].count = 0;
    }
    for (uint32_t i = 0; i < triangle_count; i++) {
        EnfVec3 p[3];
        uint32_t cell = triangle(user, i, p);
        if (cell != ENF_NONE) {
            EnfShell *shell = &shells->cells[cell];
            EnfVec3f *out = shells->triangles[shell->first + shell->count++];
            for (int k = 0; k < 3; k++) {
                out[k] = enf_v3f(enf_sub(p[k], shell->origin));
            }
        }
    }
}

/* Directions along the coordinates need no slab: the box has them. */
static void vote(AxisVotes *votes, EnfVec3 area) {
    double size = enf_length(area);
    EnfVec3 n = enf_scale(area, size > 0.0 ? 1.0 / size : 0.0);
    if (most(most(n.x * n.x, n.y * n.y), n.z * n.z) > 0.9999) {
        return;
    }
    for (uint32_t i = 0; i < votes->count; i++) {
        double cosine = enf_dot(n, votes->axis[i]);
        if (cosine > 0.9999 || cosine < -0.9999) {
            votes->area[i] += size;
            return;
        }
    }
    if (votes->count < AXIS_CANDIDATES && size > 0.0) {
        votes->axis[votes->count] = n;
        votes->area[votes->count++] = size;
    }
}

/* The directions that most of the surface faces, and the slab of the shell along each. */
static void choose_axes(EnfShells *shells, EnfShell *shell, AxisVotes *votes) {
    while (shell->axis_count < ENF_SHELL_AXES && shell->axis_count < votes->count) {
        uint32_t best = 0;
        for (uint32_t i = 1; i < votes->count; i++) {
            best = votes->area[i] > votes->area[best] ? i : best;
        }
        if (votes->area[best] <= 0.0) {
            break;
        }
        votes->area[best] = 0.0;
        shell->axes[shell->axis_count++] = votes->axis[best];
    }
    for (uint32_t a = 0; a < shell->axis_count; a++) {
        shell->low[a] = DBL_MAX;
        shell->high[a] = -DBL_MAX;
        for (uint32_t t = shell->first; t < shell->first + shell->count; t++) {
            for (int k = 0; k < 3; k++) {
                double d = enf_dot(shell->axes[a], corner(shells, t, k));
                shell->low[a] = d < shell->low[a] ? d : shell->low[a];
                shell->high[a] = d > shell->high[a] ? d : shell->high[a];
            }
        }
    }
}

/* Do the normals point outward? Then the signed volume is most of the box. Walls made as solids have a positive volume too, but a small
 * one. */
static bool is_inverted(const EnfShells *shells, const EnfShell *shell) {
    double volume = 0.0;
    for (uint32_t t = shell->first; t < shell->first + shell->count; t++) {
        volume += enf_dot(corner(shells, t, 0), enf_cross(corner(shells, t, 1), corner(shells, t, 2))) / 6.0;
    }
    EnfVec3 size = enf_sub(shell->box.max, shell->box.min);
    return shell->count > 0 && volume > 0.6 * size.x * size.y * size.z;
}

void enf_shells_find_slabs(EnfShells *shells) {
    for (uint32_t c = 0; c < shells->cell_count; c++) {
        EnfShell *shell = &shells->cells[c];
        AxisVotes votes = {.count = 0};
        for (uint32_t t = shell->first; t < shell->first + shell->count; t++) {
            EnfVec3 a = corner(shells, t, 0);
            vote(&votes, enf_cross(enf_sub(corner(shells, t, 1), a), enf_sub(corner(shells, t, 2), a)));
        }
        choose_axes(shells, shell, &votes);
    }
}

bool enf_shells_create(EnfShells *shells, uint32_t cell_count, uint32_t triangle_count, EnfShellTriangleFn *triangle,
                       const void *user) {
    *shells = (EnfShells){.cell_count = cell_count};
    shells->cells = enf_alloc(NULL, cell_count, sizeof *shells->cells);
    if (shells->cells == NULL && cell_count > 0) {
        return false;
    }
    count_triangles(shells, triangle_count, triangle, user);
    shells->triangles = enf_alloc(NULL, shells->triangle_count, sizeof *shells->triangles);
    if (shells->triangles == NULL && shells->triangle_count > 0) {
        shells->triangle_count = 0;
        enf_shells_free(shells);
        return false;
    }
    fill_triangles(shells, triangle_count, triangle, user);
    for (uint32_t c = 0; c < cell_count; c++) {
        shells->cells[c].inverted = is_inverted(shells, &shells->cells[c]);
    }
    return true;
}

void enf_shells_free(EnfShells *shells) {
    for (uint32_t c = 0; c < shells->cell_count; c++) {
        if (shells->cells[c].has_tree) {
            enf_kd_built_free(&shells->cells[c].tree);
        }
    }
    enf_free(NULL, shells->cells, shells->cell_count, sizeof *shells->cells);
    enf_free(NULL, shells->triangles, shells->triangle_count, sizeof *shells->triangles);
    memset(shells, 0, sizeof *shells);
}

void enf_shell_set_bound(EnfShell *shell, const EnfPlane *planes, uint32_t count, EnfBox3 box) {
    shell->bound = planes;
    shell->bound_count = count;
    shell->box = count > 0 ? box : shell->box;
}

/* ---- rays ------------------------------------------------------------------------------------------------------------------ */

typedef struct Cast {
    const EnfShells *shells;
    uint32_t first;
    EnfVec3 from, direction;
    double best;
    bool hit, front, inverted;
} Cast;

/* Both sides; edges count as hit. Source: Möller & Trumbore 1997. */
static double try_triangle(void *user, uint32_t item, double t_max) {
    Cast *cast = user;
    EnfVec3 a = corner(cast->shells, cast->first + item, 0);
    EnfVec3 u = enf_sub(corner(cast->shells, cast->first + item, 1), a);
    EnfVec3 v = enf_sub(corner(cast->shells, cast->first + item, 2), a);
    EnfVec3 pv = enf_cross(cast->direction, v);
    double det = enf_dot(u, pv), size = det < 0.0 ? -det : det;
    if (!(size > 1e-12)) {
        return t_max;
    }
    EnfVec3 s = enf_sub(cast->from, a), q = enf_cross(s, u);
    double sign = det < 0.0 ? -1.0 : 1.0;
    double x = enf_dot(s, pv) * sign, y = enf_dot(cast->direction, q) * sign, t = enf_dot(v, q) / det;
    double slack = 1e-9 * size;
    if (x < -slack || y < -slack || x + y > size + slack || t < 0.0) {
        return t_max;
    }
    bool front = (det > 0.0) != cast->inverted;
    bool nearer = t < cast->best - SAME_PLACE;
    bool tie = !nearer && t < cast->best + SAME_PLACE;
    if (nearer || (tie && front && !cast->front) || (tie && t < cast->best && front == cast->front)) {
        cast->best = t;
        cast->front = front;
        cast->hit = true;
    }
    return cast->hit && cast->best + SAME_PLACE < t_max ? cast->best + SAME_PLACE : t_max;
}

static EnfBox3 triangle_box(const EnfShells *shells, uint32_t triangle) {
    EnfBox3 box = enf_box3_empty();
    for (int k = 0; k < 3; k++) {
        grow_box(&box, corner(shells, triangle, k));
    }
    return box;
}

static void make_tree(EnfShells *shells, EnfShell *shell) {
    EnfBox3f *boxes = enf_alloc(NULL, shell->count, sizeof *boxes);
    if (boxes == NULL) {
        return;
    }
    for (uint32_t i = 0; i < shell->count; i++) {
        boxes[i] = enf_box3f_outward(triangle_box(shells, shell->first + i));
    }
    shell->has_tree = enf_kd_build(&shell->tree, boxes, NULL, shell->count, NULL, NULL) == ENF_OK;
    enf_free(NULL, boxes, shell->count, sizeof *boxes);
}

/* Small shells are searched whole. */
static bool needs_tree(EnfShells *shells, EnfShell *shell) {
    if (shell->count > SMALL_SHELL && !shell->has_tree) {
        make_tree(shells, shell);
    }
    return shell->has_tree;
}

uint32_t enf_shell_overlap(EnfShells *shells, uint32_t cell, EnfBox3 box, uint32_t *out, uint32_t capacity) {
    EnfShell *shell = &shells->cells[cell];
    if (needs_tree(shells, shell)) {
        EnfKdTree tree = enf_kd_tree(&shell->tree);
        uint32_t count = enf_kd_overlap(&tree, enf_box3f_outward(box), out, capacity);
        return count < capacity ? count : capacity;
    }
    uint32_t count = shell->count < capacity ? shell->count : capacity;
    for (uint32_t i = 0; i < count; i++) {
        out[i] = i;
    }
    return count;
}

bool enf_shell_touches(EnfShells *shells, uint32_t cell, EnfBox3 box) {
    EnfShell *shell = &shells->cells[cell];
    EnfBox3 local = {enf_sub(box.min, shell->origin), enf_sub(box.max, shell->origin)};
    if (needs_tree(shells, shell)) {
        EnfKdTree tree = enf_kd_tree(&shell->tree);
        uint32_t one;
        return enf_kd_overlap(&tree, enf_box3f_outward(local), &one, 1) > 0;
    }
    for (uint32_t i = 0; i < shell->count; i++) {
        if (enf_box3_overlaps(triangle_box(shells, shell->first + i), local)) {
            return true;
        }
    }
    return false;
}

bool enf_shell_ray(EnfShells *shells, uint32_t cell, EnfShellRay ray, EnfShellHit *hit) {
    EnfShell *shell = &shells->cells[cell];
    EnfVec3 start = enf_sub(enf_add(ray.from, enf_scale(ray.direction, ray.t_min)), shell->origin);
    double length = ray.t_max - ray.t_min;
    Cast cast = {shells, shell->first, start, ray.direction, length, false, false, shell->inverted};
    if (needs_tree(shells, shell)) {
        EnfKdTree tree = enf_kd_tree(&shell->tree);
        enf_kd_ray(&tree, start, ray.direction, length, try_triangle, &cast);
    } else {
        for (uint32_t i = 0; i < shell->count; i++) {
            try_triangle(&cast, i, length);
        }
    }
    *hit = (EnfShellHit){cast.best + ray.t_min, cast.front};
    return cast.hit;
}

/* ---- points ---------------------------------------------------------------------------------------------------------------- */

static bool in_bound(const EnfShell *shell, EnfVec3 p, double depth) {
    for (uint32_t i = 0; i < shell->bound_count; i++) {
        if (enf_dot(shell->bound[i].n, p) + shell->bound[i].d > -depth) {
            return false;
        }
    }
    return true;
}

bool enf_shell_near_box(const EnfShell *shell, EnfBox3 box, double depth) {
    return box.min.x <= shell->box.max.x - depth && box.max.x >= shell->box.min.x + depth &&
           box.min.y <= shell->box.max.y - depth && box.max.y >= shell->box.min.y + depth &&
           box.min.z <= shell->box.max.z - depth && box.max.z >= shell->box.min.z + depth;
}

bool enf_shell_near(const EnfShell *shell, const EnfVec3 *points, uint32_t count, double depth) {
    EnfBox3 box = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (uint32_t i = 0; i < count; i++) {
        grow_box(&box, points[i]);
    }
    if (!enf_shell_near_box(shell, box, depth)) {
        return false;
    }
    for (uint32_t a = 0; a < shell->axis_count && shell->bound_count == 0; a++) {
        double low = DBL_MAX, high = -DBL_MAX;
        for (uint32_t i = 0; i < count; i++) {
            double d = enf_dot(shell->axes[a], enf_sub(points[i], shell->origin));
            low = least(low, d);
            high = most(high, d);
        }
        if (low > shell->high[a] - depth || high < shell->low[a] + depth) {
            return false;
        }
    }
    return true;
}

bool enf_shell_inside(EnfShells *shells, uint32_t cell, EnfVec3 p, double depth, bool sure) {
    const EnfShell *shell = &shells->cells[cell];
    if (!enf_shell_near(shell, &p, 1, depth)) {
        return false;
    }
    if (shell->bound_count > 0) {
        return in_bound(shell, p, depth);
    }
    uint32_t front = 0, back = 0, miss = 0;
    double reach = 2.0 * depth; /* √3 depth and the rounding */
    for (int i = 0; i < ENF_SHELL_RAYS; i++) {
        EnfShellHit hit;
        if (!enf_shell_ray(shells, cell, (EnfShellRay){p, rays[i], -reach, DBL_MAX / 4}, &hit)) {
            miss++;
        } else if (hit.t <= reach && depth > 0.0) {
            return false;
        } else if (hit.front) {
            front++;
        } else {
            back++;
        }
        if (sure ? back > 0 || miss > 1 : back + miss > 2) {
            return false;
        }
        if (!sure && front >= 4) {
            return true;
        }
    }
    return true;
}

bool enf_shell_open_to(EnfShells *shells, uint32_t cell, EnfVec3 p, EnfVec3 normal) {
    const EnfShell *shell = &shells->cells[cell];
    uint32_t missed = 0;
    if (shell->bound_count > 0) {
        return in_bound(shell, p, 0.0);
    }
    for (int i = 0; i < ENF_SHELL_RAYS && missed < 2; i++) {
        EnfShellHit hit;
        if (enf_dot(rays[i], normal) <= 0.0) {
            continue;
        }
        if (!enf_shell_ray(shells, cell, (EnfShellRay){p, rays[i], 0.0, DBL_MAX / 4}, &hit)) {
            missed++;
        } else if (!hit.front) {
            return false;
        }
    }
    return missed < 2;
}

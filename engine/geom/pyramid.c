/* View pyramids as float planes for the kd-tree: conservative although the boxes are tested in float.
 *
 * The error bound. Let u = 2^-24, B_i the largest |x_i| within `bounds`, n the exact unit normal, o = origin - eye,
 * d = n·o, S = sum |n_i| B_i. A point x of a box has exactly n·x + d >= 0 if it is inside. The test evaluates
 * ((nx*x + ny*y) + nz*z) + d in float with rounded n and d:
 *
 *   rounding n to float        u S              (relative, component by component)
 *   the products and sums      4 u S + u |d|    (a product passes at most four roundings, d one)
 *   rounding d to float        u |d|
 *   n and d in double          2^-48 (|B| + |o|) (some ten roundings of 2^-53 on terms below |B|_1 + |o|_1; it also
 *                                                covers underflow, as |n_i| < 2^-126 times B_i)
 *
 * So d is raised by (5 u S + 2 u |d|)(1 + a little) + 2^-48 (|B| + |o|): below 7 u S + 4 u |d| + 2^-48 (...). Rounding
 * is monotone and a box's farthest corner is taken for each plane, so its value is at least that of any point in it. */
#include <enfilade/geom.h>
#include <enfilade/tolerances.h>

#include <math.h>

/* Beyond this a float sum might overflow on its way; the plane is dropped (it keeps everything). */
#define LARGEST_SUM 0x1p120

/* What is common to all planes of a pyramid. */
typedef struct Frame {
    const EnfCamera *camera;
    EnfVec3 offset;     /* origin - eye, in the camera's frame */
    EnfVec3 reach;      /* largest absolute coordinates within bounds */
    double fixed_error; /* 2^-48 (|B|_1 + |o|_1) */
} Frame;

static double larger(float a, float b) {
    double x = fabs((double)a), y = fabs((double)b);
    return x > y ? x : y;
}

static inline Frame make_frame(const EnfCamera *camera, EnfVec3 origin_ws, EnfBox3f bounds) {
    EnfVec3 o = enf_sub(origin_ws, camera->eye_ws);
    Frame f;
    f.camera = camera;
    f.offset = enf_v3(enf_dot(o, camera->right), enf_dot(o, camera->up), enf_dot(o, camera->forward));
    f.reach = enf_v3(larger(bounds.min.x, bounds.max.x), larger(bounds.min.y, bounds.max.y),
                     larger(bounds.min.z, bounds.max.z));
    f.fixed_error = 0x1p-48 * (f.reach.x + f.reach.y + f.reach.z + fabs(o.x) + fabs(o.y) + fabs(o.z));
    return f;
}

static inline void add_plane(EnfPyramid *out, const Frame *f, EnfVec3 n, double d) {
    double sum = fabs(n.x) * f->reach.x + fabs(n.y) * f->reach.y + fabs(n.z) * f->reach.z;
    double raised = d + (7.0 * 0x1p-24 * sum + 4.0 * 0x1p-24 * fabs(d) + f->fixed_error);
    if (!(sum + fabs(raised) < LARGEST_SUM)) {
        n = enf_v3(0.0, 0.0, 0.0); /* not finite: keeps every box */
        raised = 0.0;
    }
    uint32_t i = out->count++;
    out->nx[i] = (float)n.x;
    out->ny[i] = (float)n.y;
    out->nz[i] = (float)n.z;
    out->d[i] = (float)raised;
}

/* The side of a window: where sign * p·axis + k p·forward >= 0; `along` is the offset along that axis. */
static inline void add_side(EnfPyramid *out, const Frame *f, EnfVec3 axis, double along, double sign, double k) {
    double scale = 1.0 / sqrt(1.0 + k * k), a = sign * scale, c = k * scale;
    EnfVec3 n = enf_add(enf_scale(axis, a), enf_scale(f->camera->forward, c));
    add_plane(out, f, n, a * along + c * f->offset.z);
}

/* The plane whose inside is where v.x (p·right) + v.y (p·up) + v.z (p·forward) >= 0. */
static void add_oblique(EnfPyramid *out, const Frame *f, EnfVec3 v) {
    const EnfCamera *camera = f->camera;
    v = enf_scale(v, 1.0 / sqrt(enf_dot(v, v)));
    EnfVec3 n = enf_add(enf_add(enf_scale(camera->right, v.x), enf_scale(camera->up, v.y)), enf_scale(camera->forward, v.z));
    add_plane(out, f, n, enf_dot(v, f->offset));
}

/* A point is seen at X = cx + (p·right / p·forward) cx / tan_x, cx the middle of the picture, and likewise Y. */
static void add_edges(EnfPyramid *out, const Frame *f, const EnfWindowPolygon *p) {
    const EnfCamera *camera = f->camera;
    double cx = 0.5 * ENF_WINDOW_STEPS * (double)camera->width_px, cy = 0.5 * ENF_WINDOW_STEPS * (double)camera->height_px;
    double sx = cx / camera->tan_x, sy = cy / camera->tan_y;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t j = i + 1 < p->count ? i + 1 : 0;
        double dx = (double)p->x[j] - (double)p->x[i], dy = (double)p->y[j] - (double)p->y[i];
        if (dx == 0.0 || dy == 0.0) {
            continue; /* it lies on a side of the bounding box, which is a plane already */
        }
        /* Left of the edge: dx (Y - ay) - dy (X - ax) >= 0, times the depth. The products below are exact. */
        double depth = dy * ((double)p->x[i] - cx) - dx * ((double)p->y[i] - cy);
        add_oblique(out, f, enf_v3(-dy * sx, dx * sy, depth));
    }
}

void enf_pyramid(const EnfCamera *camera, EnfWindow window, const EnfWindowPolygon *polygon, EnfVec3 origin_ws, EnfBox3f bounds,
                 EnfPyramid *out) {
    Frame f = make_frame(camera, origin_ws, bounds);
    double cx = 0.5 * ENF_WINDOW_STEPS * (double)camera->width_px, cy = 0.5 * ENF_WINDOW_STEPS * (double)camera->height_px;
    double kx = camera->tan_x / cx, ky = camera->tan_y / cy;
    out->count = 0;
    add_side(out, &f, camera->right, f.offset.x, 1.0, (cx - (double)window.x0) * kx);
    add_side(out, &f, camera->right, f.offset.x, -1.0, ((double)window.x1 - cx) * kx);
    add_side(out, &f, camera->up, f.offset.y, 1.0, (cy - (double)window.y0) * ky);
    add_side(out, &f, camera->up, f.offset.y, -1.0, ((double)window.y1 - cy) * ky);
    add_plane(out, &f, camera->forward, f.offset.z);
    if (polygon) {
        add_edges(out, &f, polygon);
    }
}

bool enf_pyramid_box(const EnfPyramid *pyramid, EnfBox3f box) {
    for (uint32_t i = 0; i < pyramid->count; i++) {
        float nx = pyramid->nx[i], ny = pyramid->ny[i], nz = pyramid->nz[i];
        float x = nx >= 0.0f ? box.max.x : box.min.x;
        float y = ny >= 0.0f ? box.max.y : box.min.y;
        float z = nz >= 0.0f ? box.max.z : box.min.z;
        if (((nx * x + ny * y) + nz * z) + pyramid->d[i] < 0.0f) {
            return false; /* not `!(>= 0)`: what is not a number is kept */
        }
    }
    return true;
}

/* Which moving objects show a pixel: every triangle of the building and of every object drawn into a plain depth buffer, each sample
 * by itself, nothing passed over. It shares nothing with what it judges. */
#include "enfbench/movers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Metres before the eye where triangles are cut. */
#define CUT 0x1p-10
#define NOBODY ENF_NONE

struct Truth {
    const MoversScene *scene;
    const EnfCamera *camera;
    double *inverse; /* 1 / distance along the line of sight */
    uint32_t *who;
    bool *shown;
    uint32_t frame; /* that `shown` is of; ENF_NONE: none */
};

void bench_truth_destroy(Truth *truth) {
    if (truth != NULL) {
        free(truth->inverse);
        free(truth->who);
        free(truth->shown);
        free(truth);
    }
}

Truth *bench_truth_create(const MoversScene *scene) {
    Truth *truth = calloc(1, sizeof *truth);
    if (truth == NULL) {
        return NULL;
    }
    const EnfCamera *camera = &scene->views[0].camera;
    size_t samples = (size_t)camera->width_px * camera->height_px;
    truth->scene = scene;
    truth->frame = ENF_NONE;
    truth->inverse = calloc(samples, sizeof *truth->inverse);
    truth->who = calloc(samples, sizeof *truth->who);
    truth->shown = calloc(scene->def.movers + 1U, sizeof *truth->shown);
    if (!truth->inverse || !truth->who || !truth->shown) {
        bench_truth_destroy(truth);
        return NULL;
    }
    return truth;
}

/* Right, up and along the line of sight. */
static EnfVec3 to_eye(const EnfCamera *camera, EnfVec3 p_ws) {
    EnfVec3 p = enf_sub(p_ws, camera->eye_ws);
    return enf_v3(enf_dot(p, camera->right), enf_dot(p, camera->up), enf_dot(p, camera->forward));
}

/* A corner in the picture: pixels, and 1 / distance. */
static EnfVec3 project(const EnfCamera *camera, EnfVec3 p) {
    return enf_v3((p.x / (p.z * camera->tan_x) + 1.0) * 0.5 * (double)camera->width_px,
                  (p.y / (p.z * camera->tan_y) + 1.0) * 0.5 * (double)camera->height_px, 1.0 / p.z);
}

static double twice_area(EnfVec3 a, EnfVec3 b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static uint32_t limit(double x, uint32_t most) {
    return x <= 0.0 ? 0U : x >= (double)most ? most : (uint32_t)x;
}

/* Samples whose middle is in the triangle, its edges included. */
static void fill(Truth *truth, EnfVec3 a, EnfVec3 b, EnfVec3 c, uint32_t who) {
    double area = twice_area(a, b, c.x, c.y);
    if (!(area > 0.0)) {
        return; /* averted */
    }
    uint32_t width = truth->camera->width_px;
    uint32_t x0 = limit(floor(fmin(a.x, fmin(b.x, c.x))), width), x1 = limit(ceil(fmax(a.x, fmax(b.x, c.x))), width);
    uint32_t y0 = limit(floor(fmin(a.y, fmin(b.y, c.y))), truth->camera->height_px);
    uint32_t y1 = limit(ceil(fmax(a.y, fmax(b.y, c.y))), truth->camera->height_px);
    for (uint32_t y = y0; y < y1; y++) {
        double py = (double)y + 0.5;
        for (uint32_t x = x0; x < x1; x++) {
            double px = (double)x + 0.5;
            double u = twice_area(b, c, px, py), v = twice_area(c, a, px, py), w = twice_area(a, b, px, py);
            if (u < 0.0 || v < 0.0 || w < 0.0) {
                continue;
            }
            double inverse = (u * a.z + v * b.z + w * c.z) / area;
            size_t at = (size_t)y * width + x;
            if (inverse > truth->inverse[at]) {
                truth->inverse[at] = inverse;
                truth->who[at] = who;
            }
        }
    }
}

/* A triangle, cut before the eye: corners relative to it. */
static void triangle(Truth *truth, const EnfVec3 v[3], uint32_t who) {
    EnfVec3 kept[4];
    uint32_t count = 0;
    for (int i = 0; i < 3; i++) {
        EnfVec3 a = v[i];
        EnfVec3 b = v[(i + 1) % 3];
        if (a.z >= CUT) {
            kept[count++] = a;
        }
        if ((a.z >= CUT) != (b.z >= CUT)) {
            double t = (CUT - a.z) / (b.z - a.z);
            kept[count++] = enf_v3(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, CUT);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        kept[i] = project(truth->camera, kept[i]);
    }
    for (uint32_t i = 2; i < count; i++) {
        fill(truth, kept[0], kept[i - 1], kept[i], who);
    }
}

static void building(Truth *truth) {
    const EnfMap *map = truth->scene->rooms.map;
    for (uint32_t c = 0; c < map->clusters_count; c++) {
        const EnfCluster *cluster = &map->clusters[c];
        const double *o = map->cells[cluster->cell].origin;
        for (uint32_t i = cluster->index_first; i < cluster->index_first + cluster->index_count; i += 3) {
            EnfVec3 v[3];
            for (uint32_t k = 0; k < 3; k++) {
                const float *p = map->vertices[map->indices[i + k]].position;
                v[k] = to_eye(truth->camera, enf_v3(o[0] + (double)p[0], o[1] + (double)p[1], o[2] + (double)p[2]));
            }
            triangle(truth, v, NOBODY);
        }
    }
}

/* Two triangles a side of its box, counter-clockwise from outside; bits of a corner: 1 x, 2 y, 4 z. */
static void object(Truth *truth, uint32_t number, const EnfPose *pose) {
    static const int triangles[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                         {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    EnfVec3 corners[8];
    for (int c = 0; c < 8; c++) {
        EnfVec3 p = enf_v3(c & 1 ? MOVER_WIDTH : -MOVER_WIDTH, c & 2 ? MOVER_HEIGHT : -MOVER_HEIGHT,
                           c & 4 ? MOVER_WIDTH : -MOVER_WIDTH);
        corners[c] = to_eye(truth->camera, enf_pose_point(pose, p));
    }
    for (int t = 0; t < 12; t++) {
        EnfVec3 v[3] = {corners[triangles[t][0]], corners[triangles[t][1]], corners[triangles[t][2]]};
        triangle(truth, v, number);
    }
}

const bool *bench_truth_shown(Truth *truth, uint32_t frame) {
    if (truth->frame == frame) {
        return truth->shown;
    }
    const MoversScene *scene = truth->scene;
    size_t samples = (size_t)scene->views[0].camera.width_px * scene->views[0].camera.height_px;
    truth->frame = frame;
    truth->camera = &scene->views[frame].camera;
    memset(truth->shown, 0, scene->def.movers * sizeof *truth->shown);
    for (size_t i = 0; i < samples; i++) {
        truth->inverse[i] = 0.0;
        truth->who[i] = NOBODY;
    }
    building(truth);
    for (uint32_t i = 0; i < scene->def.movers; i++) {
        EnfPose pose = bench_mover_pose(&scene->movers[i], (int64_t)frame);
        object(truth, i, &pose);
    }
    for (size_t i = 0; i < samples; i++) {
        if (truth->who[i] != NOBODY) {
            truth->shown[truth->who[i]] = true;
        }
    }
    return truth->shown;
}

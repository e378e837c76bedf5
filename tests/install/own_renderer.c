/* Enfilade with a renderer of one's own, in sixty lines: reads a map, asks what the eye sees, and draws the edges of
 * the visible triangles into a PGM picture. No OpenGL: enf_core and the C library are all it links. */
#include <enfilade/vis.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 640, HEIGHT = 480 };
static unsigned char picture[HEIGHT][WIDTH];

/* Where a vertex shows, in pixels; false behind the eye. Eye-relative: subtract in double first, then project. */
static bool project(const EnfMap *map, const EnfCamera *camera, const EnfVertex *vertex, double out[2]) {
    const double *origin = map->cells[vertex->cell].origin;
    EnfVec3 p = enf_v3(origin[0] + (double)vertex->position[0], origin[1] + (double)vertex->position[1],
                       origin[2] + (double)vertex->position[2]);
    EnfVec3 to_point = enf_sub(p, camera->eye_ws);
    double depth = enf_dot(to_point, camera->forward);
    out[0] = (1 + enf_dot(to_point, camera->right) / depth / camera->tan_x) * WIDTH / 2;
    out[1] = (1 - enf_dot(to_point, camera->up) / depth / camera->tan_y) * HEIGHT / 2;
    return depth > 0.05;
}

static void draw_line(const double a[2], const double b[2]) {
    for (int i = 0; i <= 400; i++) {
        double x = a[0] + (b[0] - a[0]) * i / 400, y = a[1] + (b[1] - a[1]) * i / 400;
        if (x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT) {
            unsigned char *dot = &picture[(int)y][(int)x];
            *dot = (unsigned char)(*dot + (255 - *dot) / 8); /* the more lines, the brighter */
        }
    }
}

static void draw_cluster(const EnfMap *map, const EnfCamera *camera, const EnfCluster *cluster) {
    for (uint32_t i = 0; i < cluster->index_count; i += 3) {
        const uint32_t *corner = map->indices + cluster->index_first + i;
        for (int k = 0; k < 3; k++) {
            double a[2], b[2];
            if (project(map, camera, &map->vertices[corner[k]], a) &&
                project(map, camera, &map->vertices[corner[(k + 1) % 3]], b)) {
                draw_line(a, b);
            }
        }
    }
}

int main(int argc, char **argv) {
    EnfError error = {0};
    EnfMap map;
    EnfPortals portals;
    EnfVis *vis;
    if (argc != 6 || enf_map_read(&map, argv[1], NULL, &error) || enf_portals_create(&portals, &map, NULL, &error) ||
        enf_vis_create(&vis, &map, NULL, &error)) {
        fprintf(stderr, "usage: own_renderer MAP X Y Z YAW >PICTURE.pgm\n%s\n", error.message);
        return 1;
    }
    EnfView view = enf_view_default();
    EnfVec3 eye_ws = enf_v3(atof(argv[2]), atof(argv[3]), atof(argv[4]));
    view.camera = enf_camera(eye_ws, enf_turn(atof(argv[5]), 0, 0), 60, WIDTH, HEIGHT);
    view.cell = enf_map_locate(&map, eye_ws);
    const EnfVisSet *seen = enf_vis_run(vis, &portals, &view);
    for (uint32_t i = 0; i < seen->entry_count; i++) {
        draw_cluster(&map, &seen->cameras[seen->entries[i].space], &map.clusters[seen->entries[i].cluster]);
    }
    printf("P5 %d %d 255\n", WIDTH, HEIGHT);
    fwrite(picture, 1, sizeof picture, stdout);
    fprintf(stderr, "%u of %u cells, %u of %u clusters\n", seen->cell_count, map.cells_count, seen->entry_count,
            map.clusters_count);
    enf_vis_destroy(vis), enf_portals_destroy(&portals), enf_map_free(&map);
    return 0;
}

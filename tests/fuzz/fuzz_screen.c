/* links: core */
/* Portals of any bytes through windows of any bytes: the clipper must stay inside its arrays and give a window inside the
 * parent's, whatever the numbers (infinite, not a number, degenerate). */
#include <enfilade/geom.h>

#include <string.h>

#include "fuzz/fuzz.h"

static void require(bool holds) {
    if (!holds) {
        __builtin_trap();
    }
}

static EnfWindow window_from(const uint8_t *data, EnfWindow full) {
    int32_t sides[4];
    memcpy(sides, data, sizeof sides);
    EnfWindow window = {sides[0] % (full.x1 + 1), sides[1] % (full.y1 + 1), sides[2] % (full.x1 + 1), sides[3] % (full.y1 + 1)};
    window = enf_window_intersect(window, full);
    return enf_window_is_empty(window) ? full : window;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    EnfVec3 points[ENF_POLYGON_MAX];
    uint32_t count = size > 16 ? (uint32_t)((size - 16) / sizeof points[0]) : 0;
    if (count < 3) {
        return 0;
    }
    count = count > ENF_POLYGON_MAX ? ENF_POLYGON_MAX : count;
    memcpy(points, data + 16, count * sizeof points[0]);
    EnfCamera camera = enf_camera(enf_v3(0, 0, 0), enf_turn(30, 10, 0), 60, 640, 480);
    EnfWindow parent = window_from(data, enf_window_full(&camera)), box = parent;
    if (enf_project_box(&camera, points, count, parent, &box) == ENF_PROJECT_WINDOW) {
        require(enf_window_contains(parent, box));
    }
    EnfWindowPolygon outer = enf_window_polygon_from_box(parent), inner = outer;
    if (enf_project_polygon(&camera, points, count, &outer, &inner) == ENF_PROJECT_WINDOW) {
        require(inner.count >= 3 && inner.count <= ENF_WINDOW_POLYGON_MAX);
        require(enf_window_contains(parent, enf_window_polygon_bounds(&inner)));
    }
    return 0;
}

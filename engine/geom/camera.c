/* The camera's frame from angles, and the arithmetic of box windows. */
#include <enfilade/geom.h>
#include <enfilade/tolerances.h>

#include <math.h>

/* ---- camera ----------------------------------------------------------------------------------------------------- */

typedef struct SineCosine {
    double sin, cos;
} SineCosine;

/* Whole quarter turns are taken off in degrees, where they are exact: 90° has a cosine of 0, not of 6e-17, and a camera
 * that looks along an axis has an exact frame. */
static SineCosine turn_of(double degrees) {
    double rest = fmod(degrees, 360.0);
    double quarters = rint(rest / 90.0);
    double radians = (rest - 90.0 * quarters) * (ENF_PI / 180.0);
    double s = enf_sin(radians), c = enf_cos(radians);
    switch ((int)quarters & 3) {
    case 1:
        return (SineCosine){c, -s};
    case 2:
        return (SineCosine){-s, -c};
    case 3:
        return (SineCosine){-c, s};
    default:
        return (SineCosine){s, c};
    }
}

EnfTurn enf_turn(double yaw_deg, double pitch_deg, double roll_deg) {
    EnfTurn turn = {yaw_deg, pitch_deg, roll_deg};
    return turn;
}

EnfCamera enf_camera(EnfVec3 eye_ws, EnfTurn turn, double fov_y_deg, uint32_t width_px, uint32_t height_px) {
    ENF_ASSERT(fov_y_deg > 0.0 && fov_y_deg <= 170.0);
    ENF_ASSERT(width_px > 0 && height_px > 0);
    SineCosine yaw = turn_of(turn.yaw_deg), pitch = turn_of(turn.pitch_deg), roll = turn_of(turn.roll_deg);
    EnfVec3 right = enf_v3(yaw.cos, 0.0, -yaw.sin);
    EnfVec3 up = enf_v3(yaw.sin * pitch.sin, pitch.cos, yaw.cos * pitch.sin);
    EnfCamera camera;
    camera.eye_ws = eye_ws;
    camera.forward = enf_v3(-yaw.sin * pitch.cos, pitch.sin, -yaw.cos * pitch.cos);
    camera.right = enf_sub(enf_scale(right, roll.cos), enf_scale(up, roll.sin));
    camera.up = enf_add(enf_scale(up, roll.cos), enf_scale(right, roll.sin));
    camera.tan_y = enf_tan(fov_y_deg * (ENF_PI / 360.0));
    camera.tan_x = camera.tan_y * ((double)width_px / (double)height_px);
    camera.width_px = width_px;
    camera.height_px = height_px;
    return camera;
}

/* ---- box windows ------------------------------------------------------------------------------------------------ */

EnfWindow enf_window_full(const EnfCamera *camera) {
    EnfWindow w = {0, 0, (int32_t)(camera->width_px * ENF_WINDOW_STEPS), (int32_t)(camera->height_px * ENF_WINDOW_STEPS)};
    return w;
}

bool enf_window_is_empty(EnfWindow w) {
    return w.x0 >= w.x1 || w.y0 >= w.y1;
}

EnfWindow enf_window_intersect(EnfWindow a, EnfWindow b) {
    EnfWindow w = {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1, a.y1 < b.y1 ? a.y1 : b.y1};
    return w;
}

EnfWindow enf_window_union(EnfWindow a, EnfWindow b) {
    if (enf_window_is_empty(a)) {
        return b;
    }
    if (enf_window_is_empty(b)) {
        return a;
    }
    EnfWindow w = {a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0, a.x1 > b.x1 ? a.x1 : b.x1, a.y1 > b.y1 ? a.y1 : b.y1};
    return w;
}

bool enf_window_contains(EnfWindow outer, EnfWindow inner) {
    return enf_window_is_empty(inner) ||
           (outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && outer.x1 >= inner.x1 && outer.y1 >= inner.y1);
}

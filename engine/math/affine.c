/* Affine maps and quaternions: node transforms of a level, rigid motions and reflections of portals. */
#include <enfilade/math.h>

#include <math.h>

EnfAffine enf_affine_identity(void) {
    EnfAffine a = {{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};
    return a;
}

EnfVec3 enf_affine_vector(const EnfAffine *a, EnfVec3 v) {
    const double *m = a->m;
    return enf_v3(m[0] * v.x + m[3] * v.y + m[6] * v.z, m[1] * v.x + m[4] * v.y + m[7] * v.z,
                  m[2] * v.x + m[5] * v.y + m[8] * v.z);
}

EnfVec3 enf_affine_point(const EnfAffine *a, EnfVec3 p) {
    return enf_add(enf_affine_vector(a, p), a->t);
}

static EnfVec3 column(const EnfAffine *a, int c) {
    return enf_v3(a->m[3 * c], a->m[3 * c + 1], a->m[3 * c + 2]);
}

static void set_column(EnfAffine *a, int c, EnfVec3 v) {
    a->m[3 * c] = v.x;
    a->m[3 * c + 1] = v.y;
    a->m[3 * c + 2] = v.z;
}

EnfAffine enf_affine_mul(EnfAffine a, EnfAffine b) {
    EnfAffine product;
    for (int c = 0; c < 3; c++) {
        set_column(&product, c, enf_affine_vector(&a, column(&b, c)));
    }
    product.t = enf_affine_point(&a, b.t);
    return product;
}

EnfAffine enf_affine_trs(EnfVec3 t, EnfQuat r, EnfVec3 s) {
    double norm2 = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w;
    /* 2/|r|² makes a rotation of any quaternion but zero, so one that a file rounded needs no normalising. */
    double k = norm2 > 0.0 ? 2.0 / norm2 : 0.0;
    double xx = k * r.x * r.x, yy = k * r.y * r.y, zz = k * r.z * r.z;
    double xy = k * r.x * r.y, xz = k * r.x * r.z, yz = k * r.y * r.z;
    double wx = k * r.w * r.x, wy = k * r.w * r.y, wz = k * r.w * r.z;
    EnfAffine a;
    set_column(&a, 0, enf_scale(enf_v3(1.0 - (yy + zz), xy + wz, xz - wy), s.x));
    set_column(&a, 1, enf_scale(enf_v3(xy - wz, 1.0 - (xx + zz), yz + wx), s.y));
    set_column(&a, 2, enf_scale(enf_v3(xz + wy, yz - wx, 1.0 - (xx + yy)), s.z));
    a.t = t;
    return a;
}

double enf_affine_det(const EnfAffine *a) {
    return enf_dot(column(a, 0), enf_cross(column(a, 1), column(a, 2)));
}

/* The sum of the absolute values: the length that bounds every product in the determinant. */
static double column_size(const EnfAffine *a, int c) {
    EnfVec3 v = column(a, c);
    return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

bool enf_affine_inverse(const EnfAffine *a, EnfAffine *out) {
    EnfAffine from = *a; /* `out` may be `a` */
    *out = enf_affine_identity();
    double det = enf_affine_det(&from);
    /* Five roundings (u = 2^-53 each) act on terms whose absolute values sum to at most the product of the sizes: a
     * determinant of at most 8 u times that cannot be told from zero. */
    double noise = 0x1p-50 * column_size(&from, 0) * column_size(&from, 1) * column_size(&from, 2);
    if (!(fabs(det) > noise) || !isfinite(1.0 / det)) {
        return false;
    }
    EnfVec3 rows[3];
    for (int i = 0; i < 3; i++) {
        EnfVec3 cofactors = enf_cross(column(&from, (i + 1) % 3), column(&from, (i + 2) % 3));
        rows[i] = enf_v3(cofactors.x / det, cofactors.y / det, cofactors.z / det);
    }
    EnfAffine inverse;
    set_column(&inverse, 0, enf_v3(rows[0].x, rows[1].x, rows[2].x));
    set_column(&inverse, 1, enf_v3(rows[0].y, rows[1].y, rows[2].y));
    set_column(&inverse, 2, enf_v3(rows[0].z, rows[1].z, rows[2].z));
    inverse.t = enf_scale(enf_v3(enf_dot(rows[0], from.t), enf_dot(rows[1], from.t), enf_dot(rows[2], from.t)), -1.0);
    if (!enf_v3_finite(inverse.t) || !enf_v3_finite(rows[0]) || !enf_v3_finite(rows[1]) || !enf_v3_finite(rows[2])) {
        return false;
    }
    *out = inverse;
    return true;
}

EnfQuat enf_quat_axis_angle(EnfVec3 axis, double radians) {
    EnfVec3 v = enf_scale(enf_normalize(axis), enf_sin(0.5 * radians));
    EnfQuat q = {v.x, v.y, v.z, enf_cos(0.5 * radians)};
    return q;
}

EnfQuat enf_quat_mul(EnfQuat a, EnfQuat b) {
    EnfQuat q = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                 a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return q;
}

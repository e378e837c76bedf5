"""Plane and space geometry of the palace: snapping, polygons, frames.  Plain Python, no Blender.

Every vertex of a cell's shell is snapped to the compiler's own grid (1/4096 m), in world space, so that two faces that
share an edge share it bit for bit, and float32 holds it exactly.
"""

import math

GRID = 4096.0
TOUCH = 1.0 / 1024.0  # two ways to compute and snap one point differ by less than this


def snap(value):
    return round(value * GRID) / GRID


def snap_point(point):
    return tuple(snap(value) for value in point)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, factor):
    return tuple(x * factor for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return scale(a, 1.0 / length(a))


def lerp(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def newell(points):
    """Area vector (twice the area, along the normal) of a polygon in space."""
    total = (0.0, 0.0, 0.0)
    for p, q in zip(points, points[1:] + points[:1]):
        total = add(total, cross(p, q))
    return total


def left_normal(direction):
    """The inward normal of a wall that runs along `direction` around a counter-clockwise room."""
    return (-direction[1], direction[0])


def area2(polygon):
    """Twice the signed area of a polygon in the plane."""
    return sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(polygon, polygon[1:] + polygon[:1]))


def rectangle(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def regular(center, apothem, count):
    """Regular polygon of `count` sides whose first side faces south (its normal is -y)."""
    radius = apothem / math.cos(math.pi / count)
    first = -math.pi / 2 - math.pi / count
    angles = [first + 2 * math.pi * i / count for i in range(count)]
    return [snap_point((center[0] + radius * math.cos(a), center[1] + radius * math.sin(a))) for a in angles]


def bounds(polygon):
    xs, ys = [p[0] for p in polygon], [p[1] for p in polygon]
    return min(xs), min(ys), max(xs), max(ys)


def centroid(polygon):
    x0, y0, x1, y1 = bounds(polygon)
    if len(polygon) == 4 and area2(polygon) >= 1.999 * (x1 - x0) * (y1 - y0):
        return (x0 + x1) / 2, (y0 + y1) / 2
    total, sx, sy = 0.0, 0.0, 0.0
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        w = p[0] * q[1] - q[0] * p[1]
        total, sx, sy = total + w, sx + w * (p[0] + q[0]), sy + w * (p[1] + q[1])
    return sx / (3 * total), sy / (3 * total)


def inset(polygon, distance):
    """Moves every side inward by `distance`, mitring the corners."""
    result = []
    count = len(polygon)
    for i, corner in enumerate(polygon):
        before = unit(sub(corner, polygon[i - 1]))
        after = unit(sub(polygon[(i + 1) % count], corner))
        n0, n1 = left_normal(before), left_normal(after)
        result.append(add(corner, scale(add(n0, n1), distance / (1.0 + dot(n0, n1)))))
    return result


def depth_inside(polygon, point):
    """Distance from the nearest side line of a convex polygon; negative outside."""
    return min(dot(sub(point, p), left_normal(unit(sub(q, p)))) for p, q in zip(polygon, polygon[1:] + polygon[:1]))


def clip_half_plane(polygon, origin, normal):
    """The part of a polygon in the plane where (p - origin) . normal >= 0."""
    result = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        dp, dq = dot(sub(p, origin), normal), dot(sub(q, origin), normal)
        if dp >= 0:
            result.append(p)
        if (dp > 0 > dq) or (dp < 0 < dq):
            result.append(lerp(p, q, dp / (dp - dq)))
    return result


def clip_convex(polygon, clipper):
    for p, q in zip(clipper, clipper[1:] + clipper[:1]):
        if not polygon:
            break
        polygon = clip_half_plane(polygon, p, left_normal(unit(sub(q, p))))
    return polygon


def distinct(points, tolerance=TOUCH):
    """Drops consecutive points that coincide."""
    kept = []
    for point in points:
        if not kept or length(sub(point, kept[-1])) > tolerance:
            kept.append(point)
    while len(kept) > 1 and length(sub(kept[0], kept[-1])) <= tolerance:
        kept.pop()
    return kept


def grid_lines(fixed, step):
    """The fixed coordinates and, between them, the fewest equal steps no longer than `step`."""
    marks = []
    for value in sorted(fixed):
        if not marks or value - marks[-1] > TOUCH:
            marks.append(value)
    lines = [marks[0]]
    for start, end in zip(marks, marks[1:]):
        count = max(1, math.ceil((end - start) / step - 1e-6))
        lines += [start + (end - start) * (i + 1) / count for i in range(count)]
    return lines


def triangulate(points):
    """Ear clipping of a planar polygon that may carry vertices within its sides; best-shaped ear first."""
    normal = unit(newell(points))
    left = list(range(len(points)))
    triangles = []
    while len(left) > 3:
        best = max(range(len(left)), key=lambda i: (_ear_quality(points, left, i, normal), -i))
        triangles.append((left[best - 1], left[best], left[(best + 1) % len(left)]))
        left.pop(best)
    triangles.append(tuple(left))
    return triangles


def _ear_quality(points, left, i, normal):
    a, b, c = points[left[i - 1]], points[left[i]], points[left[(i + 1) % len(left)]]
    height = dot(cross(sub(b, a), sub(c, b)), normal)
    span = max(dot(sub(q, p), sub(q, p)) for p, q in ((a, b), (b, c), (c, a)))
    quality = height / span
    if quality < 1e-5:
        return quality - 2.0
    corners = {left[i - 1], left[i], left[(i + 1) % len(left)]}
    blocked = any(_within(points[j], (a, b, c), normal) for j in left if j not in corners)
    return -1.0 if blocked or _leaves_flat_rest(points, left, i) else quality


def _within(point, triangle, normal):
    return all(
        dot(cross(sub(q, p), sub(point, p)), normal) >= -1e-9 for p, q in zip(triangle, triangle[1:] + triangle[:1])
    )


def _leaves_flat_rest(points, left, i):
    rest = [points[j] for k, j in enumerate(left) if k != i]
    return length(newell(rest)) < 1e-6

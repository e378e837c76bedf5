"""The closed shell of one cell: walls with openings, floors, ceilings, vaults, domes.  Plain Python, no Blender.

A shell is a soup of planar polygons that face into the room.  `stitch` then gives every side the vertices that its
neighbours have on it, so the shell and its portals share whole edges and no T-junction is left.
"""

import math
from dataclasses import dataclass, field

from geometry import (
    TOUCH,
    add,
    bounds,
    clip_convex,
    cross,
    distinct,
    dot,
    grid_lines,
    inset,
    left_normal,
    length,
    lerp,
    newell,
    scale,
    snap_point,
    sub,
    triangulate,
    unit,
)

STEP = 1.25  # longest side of a wall or floor panel, metres


@dataclass
class Face:
    points: list
    material: str
    uv_axes: tuple = None  # two directions in space along which u and v grow, one unit a metre


@dataclass
class Hole:
    """One opening as one room sees it: `outline` on the portal's plane, `distance` from the wall's plane to it."""

    outline: list  # points of the portal in space, counter-clockwise seen from inside the room's *outside*
    distance: float
    material: str = "stone_trim"
    glazed: bool = False  # this room's side carries the glazing bars


@dataclass
class Wall:
    start: tuple
    end: tuple
    holes: list = field(default_factory=list)

    @property
    def direction(self):
        return unit(sub(self.end, self.start))

    @property
    def inward(self):
        return left_normal(self.direction)

    @property
    def length(self):
        return length(sub(self.end, self.start))

    def along(self, point):
        return dot(sub(point[:2], self.start), self.direction)

    def point(self, u, z):
        return (*add(self.start, scale(self.direction, u)), z)


class Shell:
    def __init__(self):
        self.faces = []

    def add(self, points, material, uv_axes=None):
        points = distinct([snap_point(p) for p in points])
        if len(points) >= 3 and length(newell(points)) > 1e-5:
            self.faces.append(Face(points, material, uv_axes))

    # ---- walls -----------------------------------------------------------------------------------------------------

    def wall(self, wall, bottom, top, bands, step=STEP):
        """A wall between two heights; `bands` lists (height above bottom, material) from the floor up."""
        boxes = [_hole_box(wall, hole) for hole in wall.holes]
        us = grid_lines([0.0, wall.length] + [u for box in boxes for u in (box[0], box[2])], step)
        levels = [bottom, top] + [z for box in boxes for z in (box[1], box[3])]
        levels += [bottom + height for height, _ in bands if 0 < height < top - bottom - TOUCH]
        zs = grid_lines(levels, step * 1.2)
        axes = ((*wall.direction, 0.0), (0.0, 0.0, 1.0))
        for u0, u1 in zip(us, us[1:]):
            for z0, z1 in zip(zs, zs[1:]):
                if not any(_box_holds(box, (u0 + u1) / 2, (z0 + z1) / 2) for box in boxes):
                    material = _band_at(bands, (z0 + z1) / 2 - bottom)
                    self.add(_upright(wall, u0, u1, z0, z1), material, axes)
        for hole, box in zip(wall.holes, boxes):
            self._spandrels(wall, hole, box, bands, bottom)
            self._tunnel(wall, hole)

    def _spandrels(self, wall, hole, box, bands, bottom):
        """Between the box cut from the wall and an outline that is not a box: a fan from each corner of the box."""
        ring = [(wall.along(p), p[2]) for p in hole.outline]
        corners = [(box[0], box[1]), (box[2], box[1]), (box[2], box[3]), (box[0], box[3])]
        axes = ((*wall.direction, 0.0), (0.0, 0.0, 1.0))
        for p, q in zip(ring, ring[1:] + ring[:1]):
            middle = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
            if (
                min(abs(middle[0] - box[0]), abs(middle[0] - box[2]), abs(middle[1] - box[1]), abs(middle[1] - box[3]))
                < TOUCH
            ):
                continue
            corner = min(corners, key=lambda c: math.dist(c, middle))
            triangle = [wall.point(*corner), wall.point(*q), wall.point(*p)]
            if dot(newell(triangle), (*wall.inward, 0.0)) < 0:
                triangle.reverse()
            self.add(triangle, _band_at(bands, middle[1] - bottom), axes)

    def _tunnel(self, wall, hole):
        """Jambs, lintel and threshold from the wall's plane out to the portal's plane."""
        if hole.distance < TOUCH:
            return
        inner = [wall.point(wall.along(p), p[2]) for p in hole.outline]
        for i, far in enumerate(hole.outline):
            j = (i + 1) % len(inner)
            self.add([inner[i], far, hole.outline[j], inner[j]], hole.material)
        self._face_towards(len(inner), centre_of(inner))

    def _face_towards(self, count, target):
        """Turns the last `count` faces to look at a point."""
        for face in self.faces[-count:]:
            if dot(newell(face.points), sub(target, face.points[0])) < 0:
                face.points.reverse()

    # ---- floors and ceilings ---------------------------------------------------------------------------------------

    def level(self, footprint, z, material, up, hole=None, step=STEP, axis=None):
        """A floor (`up`) or flat ceiling over a convex footprint, with one box-shaped hole (x0, y0, x1, y1) or none."""
        frame = _Frame(axis or sub(footprint[1], footprint[0]), footprint[0])
        local = [frame.to_local(p) for p in footprint]
        x0, y0, x1, y1 = bounds(local)
        fixed_x, fixed_y = [x0, x1], [y0, y1]
        if hole:
            corners = [frame.to_local(p) for p in ((hole[0], hole[1]), (hole[2], hole[3]))]
            hole = bounds(corners)
            fixed_x, fixed_y = fixed_x + [hole[0], hole[2]], fixed_y + [hole[1], hole[3]]
        xs, ys = grid_lines(fixed_x, step), grid_lines(fixed_y, step)
        for u0, u1 in zip(xs, xs[1:]):
            for v0, v1 in zip(ys, ys[1:]):
                if hole and _box_holds(hole, (u0 + u1) / 2, (v0 + v1) / 2):
                    continue
                cell = clip_convex([(u0, v0), (u1, v0), (u1, v1), (u0, v1)], local)
                self._flat([frame.to_world(p) for p in cell], z, material, up, frame.axes)

    def _flat(self, polygon, z, material, up, axes):
        if len(polygon) >= 3:
            points = [(*p, z) for p in polygon]
            self.add(points if up else points[::-1], material, axes)

    def ring(self, outer, outer_z, inner, inner_z, material, inward_hint, steps=1):
        """Panels between two closed chains with as many vertices each, facing the hint point."""
        first = len(self.faces)
        count = len(outer)
        for step in range(steps):
            s, t = step / steps, (step + 1) / steps
            for i in range(count):
                j = (i + 1) % count
                a, b = (*outer[i], outer_z), (*outer[j], outer_z)
                c, d = (*inner[j], inner_z), (*inner[i], inner_z)
                self.add([lerp(a, d, s), lerp(b, c, s), lerp(b, c, t), lerp(a, d, t)], material)
        self._face_towards(len(self.faces) - first, inward_hint)

    def cove(self, footprint, spring, rise, reach, material, ceiling_material, segments=4):
        """A coved ceiling: a quarter ellipse from the walls' top to a flat, inset ceiling."""
        chain = [(footprint, spring)]
        for k in range(1, segments + 1):
            angle = math.pi / 2 * k / segments
            polygon = [snap_point(p) for p in inset(footprint, reach * (1 - math.cos(angle)))]
            chain.append((polygon, spring + rise * math.sin(angle)))
        hint = (*centre_of(footprint), spring)
        for (low, z0), (high, z1) in zip(chain, chain[1:]):
            self.ring(low, z0, high, z1, material, hint)
        self.level(chain[-1][0], chain[-1][1], ceiling_material, up=False)

    def dome(self, footprint, spring, rise, material, rings=6, lantern=0.12):
        """A dome over a many-sided room, closed by a small flat eye."""
        centre = centre_of(footprint)
        chain = []
        for k in range(rings + 1):
            angle = math.acos(lantern) * k / rings
            polygon = [snap_point(lerp(centre, p, math.cos(angle))) for p in footprint]
            chain.append((polygon, spring + rise * math.sin(angle)))
        hint = (*centre, spring)
        for (low, z0), (high, z1) in zip(chain, chain[1:]):
            self.ring(low, z0, high, z1, material, hint)
        self._flat(chain[-1][0], chain[-1][1], material, False, None)

    def barrel(self, footprint, spring, rise, material, end_material, segments=8):
        """A barrel vault along the longer side of a four-sided room, with lunettes on its short walls."""
        a, b, c, d = footprint
        if length(sub(b, a)) < length(sub(c, b)):
            a, b, c, d = b, c, d, a
        steps = max(1, round(length(sub(b, a)) / 1.5))
        arcs = [(_arc(a, d, spring, rise, segments, s / steps, b, c)) for s in range(steps + 1)]
        first = len(self.faces)
        for near, far in zip(arcs, arcs[1:]):
            for i in range(segments):
                self.add([near[i], near[i + 1], far[i + 1], far[i]], material)
        for arc in (arcs[0], arcs[-1]):
            base = [lerp((*arc[0][:2], spring), (*arc[-1][:2], spring), _share(arc, i)) for i in range(segments + 1)]
            for i in range(segments):
                self.add([base[i], base[i + 1], arc[i + 1], arc[i]], end_material)
        self._face_towards(len(self.faces) - first, (*centre_of(footprint), spring + rise / 4))

    # ---- finishing -------------------------------------------------------------------------------------------------

    def stitch(self, fixed=()):
        """Welds vertices that differ by a rounding, then inserts into every side the vertices that lie on it.

        `fixed` are the corners of the room's portals, which win over every other vertex.
        """
        buckets = {}
        self._weld(fixed, buckets)
        for face in self.faces:
            points = []
            for p, q in zip(face.points, face.points[1:] + face.points[:1]):
                points += [p] + _vertices_on(p, q, buckets)
            face.points = points

    def _weld(self, fixed, buckets):
        for vertex in fixed:
            buckets.setdefault(_bucket(vertex), []).append(vertex)
        welded = {vertex: vertex for vertex in fixed}
        for vertex in sorted({p for face in self.faces for p in face.points}):
            if vertex not in welded:
                near = [v for v in _bucket_range(vertex, vertex, buckets) if math.dist(v, vertex) < TOUCH]
                welded[vertex] = near[0] if near else vertex
                if not near:
                    buckets.setdefault(_bucket(vertex), []).append(vertex)
        for face in self.faces:
            face.points = distinct([welded[p] for p in face.points])
        self.faces = [face for face in self.faces if len(face.points) >= 3]

    def triangles(self):
        """Yields (three points, three texture coordinates in metres, material)."""
        for face in self.faces:
            axes = face.uv_axes or default_axes(face.points)
            for corner in triangulate(face.points):
                points = [face.points[i] for i in corner]
                yield points, [
                    (dot(p, axes[0] + (0.0,) * (3 - len(axes[0]))), dot(p, axes[1] + (0.0,) * (3 - len(axes[1]))))
                    for p in points
                ], face.material


class _Frame:
    """A frame in the plane whose x axis runs along a given side."""

    def __init__(self, axis, origin):
        self.x = unit(axis)
        self.y = left_normal(self.x)
        self.origin = origin

    @property
    def axes(self):
        return (*self.x, 0.0), (*self.y, 0.0)

    def to_local(self, point):
        offset = sub(point, self.origin)
        return dot(offset, self.x), dot(offset, self.y)

    def to_world(self, point):
        return add(self.origin, add(scale(self.x, point[0]), scale(self.y, point[1])))


def centre_of(points):
    total = points[0]
    for point in points[1:]:
        total = add(total, point)
    return scale(total, 1.0 / len(points))


def default_axes(points):
    """Texture directions of a face without its own: level and upward along the face, or x and y where it is level."""
    normal = unit(newell(points))
    if abs(normal[2]) > 0.99:
        return (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    level = unit(cross((0.0, 0.0, 1.0), normal))
    return level, cross(normal, level)


def _upright(wall, u0, u1, z0, z1):
    """Panel of a wall, facing into the room (its normal is the wall's left side)."""
    return [wall.point(u0, z0), wall.point(u0, z1), wall.point(u1, z1), wall.point(u1, z0)]


def _hole_box(wall, hole):
    us, zs = [wall.along(p) for p in hole.outline], [p[2] for p in hole.outline]
    return min(us), min(zs), max(us), max(zs)


def _box_holds(box, x, y):
    return box[0] - TOUCH < x < box[2] + TOUCH and box[1] - TOUCH < y < box[3] + TOUCH


def _band_at(bands, height):
    material = bands[0][1]
    for start, name in bands:
        if height >= start:
            material = name
    return material


def _arc(a, d, spring, rise, segments, s, b, c):
    """Half an ellipse over the span from side a-b to side d-c at the share s of their length."""
    left, right = lerp(a, b, s), lerp(d, c, s)
    points = []
    for i in range(segments + 1):
        angle = math.pi * i / segments
        points.append((*lerp(left, right, (1 - math.cos(angle)) / 2), spring + rise * math.sin(angle)))
    points[-1] = (*right, spring)
    return points


def _share(arc, i):
    return (1 - math.cos(math.pi * i / (len(arc) - 1))) / 2


def _vertices_on(p, q, buckets):
    """Vertices strictly inside the side p-q, in order from p."""
    direction = sub(q, p)
    span = length(direction)
    direction = scale(direction, 1.0 / span)
    found = set()
    for vertex in _bucket_range(p, q, buckets):
        t = dot(sub(vertex, p), direction)
        if TOUCH < t < span - TOUCH and length(sub(sub(vertex, p), scale(direction, t))) < TOUCH:
            found.add((t, vertex))
    return [vertex for _, vertex in sorted(found)]


def _bucket(point):
    return tuple(math.floor(value) for value in point)


def _bucket_range(p, q, buckets):
    """Vertices in the unit boxes that the box of two points touches."""
    low = [math.floor(min(a, b) - TOUCH) for a, b in zip(p, q)]
    high = [math.floor(max(a, b) + TOUCH) for a, b in zip(p, q)]
    for x in range(low[0], high[0] + 1):
        for y in range(low[1], high[1] + 1):
            for z in range(low[2], high[2] + 1):
                yield from buckets.get((x, y, z), ())

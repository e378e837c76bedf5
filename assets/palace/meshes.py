"""Mesh data and the solids that furniture is made of: boxes, turned work, sweeps.  Plain Python, no Blender."""

import math

from geometry import add, cross, dot, length, newell, scale, sub, unit
from shell import default_axes


class Mesh:
    """Polygons with a material, texture coordinates in metres, and flat or smooth shading."""

    def __init__(self):
        self.points, self.faces, self.uvs, self.materials, self.smooth = [], [], [], [], []

    def face(self, points, material, uvs=None, smooth=False):
        first = len(self.points)
        self.points += points
        self._corner_face(list(range(first, first + len(points))), material, uvs or _projected(points), smooth)

    def _corner_face(self, indices, material, uvs, smooth):
        self.faces.append(indices)
        self.uvs.append(uvs)
        self.materials.append(material)
        self.smooth.append(smooth)

    def grid(self, rows, material, closed=False, smooth=True):
        """A sheet through rows of points; faces look to the left of a row when the next row lies above it."""
        first, width = len(self.points), len(rows[0])
        self.points += [point for row in rows for point in row]
        across = _running(rows[len(rows) // 2] + (rows[len(rows) // 2][:1] if closed else []))
        upward = _running([row[0] for row in rows])
        for r in range(len(rows) - 1):
            for c in range(width if closed else width - 1):
                d = (c + 1) % width
                a, b = first + r * width, first + (r + 1) * width
                corners = _without_doubles(
                    self.points, [(a + c, c, r), (a + d, c + 1, r), (b + d, c + 1, r + 1), (b + c, c, r + 1)]
                )
                if len(corners) >= 3:
                    uvs = [(across[u], upward[v]) for _, u, v in corners]
                    self._corner_face([i for i, _, _ in corners], material, uvs, smooth)

    def append(self, other, at=(0.0, 0.0, 0.0), turn=0.0, size=(1.0, 1.0, 1.0)):
        """Adds a copy of another mesh: sized, turned about z (radians), moved."""
        first = len(self.points)
        c, s = math.cos(turn), math.sin(turn)
        for point in other.points:
            x, y, z = (a * b for a, b in zip(point, size))
            self.points.append((at[0] + c * x - s * y, at[1] + s * x + c * y, at[2] + z))
        self.faces += [[first + i for i in face] for face in other.faces]
        self.uvs += other.uvs
        self.materials += other.materials
        self.smooth += other.smooth
        return self

    def map(self, function):
        """Moves every point by a function of the point."""
        self.points = [function(point) for point in self.points]
        return self

    def without(self, material):
        """A copy that lacks the faces of one material."""
        kept = [i for i, own in enumerate(self.materials) if own != material]
        used = {point: number for number, point in enumerate(sorted({p for i in kept for p in self.faces[i]}))}
        copy = Mesh()
        copy.points = [self.points[p] for p in used]
        for i in kept:
            copy._corner_face([used[p] for p in self.faces[i]], self.materials[i], self.uvs[i], self.smooth[i])
        return copy

    def weld(self):
        """Shares equal points, so that the exporter can share vertices; for flat-shaded meshes."""
        index, kept = {}, []
        for point in self.points:
            if point not in index:
                index[point] = len(kept)
                kept.append(point)
        self.faces = [[index[self.points[i]] for i in face] for face in self.faces]
        self.points = kept
        return self

    def triangle_count(self):
        return sum(len(face) - 2 for face in self.faces)


def _running(points):
    total, result = 0.0, [0.0]
    for p, q in zip(points, points[1:]):
        total += length(sub(q, p))
        result.append(total)
    return result


def _without_doubles(points, corners):
    kept = []
    for corner in corners:
        if not any(length(sub(points[corner[0]], points[k[0]])) < 1e-6 for k in kept):
            kept.append(corner)
    return kept


def _projected(points):
    axes = default_axes(points)
    return [(dot(p, axes[0]), dot(p, axes[1])) for p in points]


def box(low, high, material, skip=""):
    """An upright box; `skip` names sides left out: b(ottom) t(op) w e s n."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    sides = {
        "b": [(x0, y1, z0), (x1, y1, z0), (x1, y0, z0), (x0, y0, z0)],
        "t": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        "s": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        "n": [(x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1)],
        "w": [(x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1)],
        "e": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
    }
    mesh = Mesh()
    for name, points in sides.items():
        if name not in skip:
            mesh.face(points, material)
    return mesh


def block(size, material, at=(0.0, 0.0, 0.0), skip=""):
    """A box of the given size whose bottom's middle stands at a point."""
    x, y, z = size
    low = (at[0] - x / 2, at[1] - y / 2, at[2])
    return box(low, (at[0] + x / 2, at[1] + y / 2, at[2] + z), material, skip)


def lathe(profile, material, sides=12, smooth=True, turn=0.0):
    """Turned work: (radius, height) from the bottom up, spun about z.  A radius of 0 closes an end."""
    rows = []
    for radius, height in profile:
        rows.append(
            [
                (
                    radius * math.cos(turn + 2 * math.pi * i / sides),
                    radius * math.sin(turn + 2 * math.pi * i / sides),
                    height,
                )
                for i in range(sides)
            ]
        )
    mesh = Mesh()
    mesh.grid(rows, material, closed=True, smooth=smooth)
    return mesh


def prism(polygon, z0, z1, material, skip="b"):
    """A straight prism over a counter-clockwise convex polygon."""
    mesh = Mesh()
    count = len(polygon)
    for i in range(count):
        p, q = polygon[i], polygon[(i + 1) % count]
        mesh.face([(*p, z0), (*q, z0), (*q, z1), (*p, z1)], material)
    if "t" not in skip:
        mesh.face([(*p, z1) for p in polygon], material)
    if "b" not in skip:
        mesh.face([(*p, z0) for p in reversed(polygon)], material)
    return mesh


def tube(path, radius, material, sides=6, smooth=True):
    """A round bar along a path; `radius` a number or one a point."""
    radii = radius if isinstance(radius, (list, tuple)) else [radius] * len(path)
    rows = []
    for i, centre in enumerate(path):
        ahead = unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
        side = cross(ahead, (0.0, 0.0, 1.0) if abs(ahead[2]) < 0.9 else (1.0, 0.0, 0.0))
        side = unit(side)
        other = cross(side, ahead)
        rows.append(
            [
                add(centre, add(scale(side, radii[i] * math.cos(a)), scale(other, -radii[i] * math.sin(a))))
                for a in (2 * math.pi * k / sides for k in range(sides))
            ]
        )
    mesh = Mesh()
    mesh.grid(rows, material, closed=True, smooth=smooth)
    if dot(_outward(mesh), (1, 1, 1)) < 0:
        mesh.faces = [face[::-1] for face in mesh.faces]
        mesh.uvs = [uv[::-1] for uv in mesh.uvs]
    return mesh


def _outward(mesh):
    """Signed volume as a vector of equal parts: positive where faces look outward (open ends ignored)."""
    centre = scale(_sum(mesh.points), 1.0 / len(mesh.points))
    total = 0.0
    for face in mesh.faces:
        points = [mesh.points[i] for i in face]
        total += dot(newell(points), sub(points[0], centre))
    return (total, total, total)


def _sum(points):
    total = (0.0, 0.0, 0.0)
    for point in points:
        total = add(total, point)
    return total

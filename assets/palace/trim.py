"""Mouldings of a room: skirting, dado rail, cornice, frames about openings, bars of windows.

They stand before the walls and wholly inside the room.  A moulding is a profile of (out of the wall, up) points, from
its lower edge on the wall over its face to its upper edge on the wall.
"""

from geometry import add, distinct, dot, inset, lerp, newell, scale, sub
from meshes import Mesh, box

FRAME = [(0.0, 0.0), (0.0, 0.05), (0.1, 0.055), (0.11, 0.03), (0.14, 0.0)]  # (across, out)
STONE_FRAME = [(0.0, 0.0), (0.0, 0.07), (0.14, 0.075), (0.16, 0.04), (0.2, 0.0)]
SKIRTING = [(0.0, 0.0), (0.025, 0.0), (0.025, 0.13), (0.012, 0.16), (0.0, 0.17)]
PLINTH = [(0.0, 0.0), (0.08, 0.0), (0.08, 0.55), (0.03, 0.62), (0.0, 0.62)]
RAIL = [(0.0, -0.035), (0.02, -0.03), (0.035, -0.01), (0.035, 0.015), (0.015, 0.03), (0.0, 0.035)]
STRING = [(0.0, -0.15), (0.06, -0.1), (0.06, 0.0), (0.14, 0.04), (0.14, 0.12), (0.0, 0.16)]
CORNICE = [
    (0.0, -0.2),
    (0.025, -0.19),
    (0.03, -0.15),
    (0.06, -0.11),
    (0.11, -0.07),
    (0.12, -0.035),
    (0.16, -0.03),
    (0.16, 0.0),
]
SMALL_CORNICE = [(0.0, -0.1), (0.05, -0.08), (0.07, -0.03), (0.07, 0.0), (0.0, 0.015)]
EAVES = [(0.0, -0.5), (0.06, -0.46), (0.06, -0.34), (0.2, -0.2), (0.3, -0.16), (0.3, -0.04), (0.38, 0.0)]


def trim_mesh(room):
    """All mouldings of one room as one mesh, in the world."""
    mesh = Mesh()
    for index, wall in enumerate(room.walls):
        ends = _mitres(room, index)
        for profile, height, material, broken in _courses(room):
            stretches = _stretches(wall, room.floor + height, profile) if broken else [(0.0, wall.length)]
            for low, high in stretches:
                _moulding(mesh, wall, (low, high), ends, (profile, room.floor + height, material))
        for hole in wall.holes:
            _frame(mesh, room, wall, hole)
            if hole.glazed:
                _bars(mesh, wall, hole)
    return mesh


def _courses(room):
    """(profile, height above the floor, material, broken by openings) of every course that runs round the room."""
    if room.section:
        return []
    if room.theme == "court":
        return [
            (PLINTH, 0.0, "stone_trim", True),
            (STRING, 4.75, "stone_trim", True),
            (EAVES, room.ceiling - room.floor, "stone_trim", False),
        ]
    if room.floor < 0 or room.theme in ("guard", "kitchen", "treasury"):
        return (
            []
            if room.floor < 0
            else [(CORNICE if room.top != "barrel" else SMALL_CORNICE, room.spring - room.floor, "stone_trim", False)]
        )
    family = room.wall.split("_")[0]
    wood = {"paper": "wood_white", "wood": "wood_dark", "plaster": "wood_dark", "brick": "wood_dark"}.get(
        family, "stone_trim"
    )
    courses = [(SKIRTING, 0.0, wood, True)]
    if family in ("paper", "marble"):
        courses.append((RAIL, 1.0, "gold" if family == "paper" else "stone_trim", True))
    top = SMALL_CORNICE if room.top == "barrel" else CORNICE
    return courses + [(top, room.spring - room.floor, "wood_dark" if family == "wood" else "plaster", False)]


def _mitres(room, index):
    """How far along the wall a moulding's end moves for each metre it stands out, at both ends."""
    if room.section:
        return 0.0, 0.0
    corners = inset(room.footprint, 1.0)
    wall = room.walls[index]
    return wall.along(corners[index]), wall.length - wall.along(corners[(index + 1) % len(corners)])


def _stretches(wall, height, profile):
    """Parts of the wall, at a height, that no opening nor its frame takes."""
    low, high = height + profile[0][1], height + profile[-1][1]
    taken = []
    for hole in wall.holes:
        us, zs = [wall.along(p) for p in hole.outline], [p[2] for p in hole.outline]
        margin = _profile(hole)[-1][0]
        if min(zs) - margin < high and max(zs) + margin > low:
            taken.append((min(us) - margin, max(us) + margin))
    result, start = [], 0.0
    for u0, u1 in sorted(taken):
        if u0 > start + 0.02:
            result.append((start, u0))
        start = max(start, u1)
    if wall.length > start + 0.02:
        result.append((start, wall.length))
    return result


def _moulding(mesh, wall, stretch, mitres, course):
    profile, z, material = course
    start, end = stretch
    k0 = mitres[0] if start == 0.0 else 0.0
    k1 = mitres[1] if end == wall.length else 0.0
    out = wall.inward
    left = [(*add(wall.point(start + k0 * o, 0)[:2], scale(out, o)), z + u) for o, u in profile]
    right = [(*add(wall.point(end - k1 * o, 0)[:2], scale(out, o)), z + u) for o, u in profile]
    for j in range(len(profile) - 1):
        corners = distinct([left[j], left[j + 1], right[j + 1], right[j]], 1e-6)
        if len(corners) > 2:
            mesh.face(corners, material)
    if start != 0.0:
        mesh.face(left[::-1], material)
    if end != wall.length:
        mesh.face(right, material)


def _profile(hole):
    return STONE_FRAME if hole.material == "stone_trim" else FRAME


def _is_window(hole, room):
    return min(p[2] for p in hole.outline) > room.floor + 0.5


def _frame(mesh, room, wall, hole):
    """An architrave about an opening: down to the floor beside a door, all round a window."""
    ring = [(wall.along(p), p[2]) for p in hole.outline]
    standing = not _is_window(hole, room) and min(z for _, z in ring) < room.floor + 0.01
    if standing is False and min(z for _, z in ring) < room.floor + 0.4:
        return
    profile, base = _profile(hole), min(z for _, z in ring)
    rails = [[_frame_point(wall, p, base if standing else None, o) for p in _offset(ring, w)] for w, o in profile]
    core = [_frame_point(wall, p, None, profile[2][1] / 3) for p in _offset(ring, profile[-1][0] / 2)]
    for inner, outer in zip(rails, rails[1:]):
        for i in range(len(ring)):
            j = (i + 1) % len(ring)
            if standing and ring[i][1] == ring[j][1] == base:
                continue
            _face_away(mesh, [inner[i], inner[j], outer[j], outer[i]], lerp(core[i], core[j], 0.5), hole.material)


def _offset(ring, width):
    return inset(ring, -width) if width else ring


def _frame_point(wall, point, floor, out):
    u, z = point
    z = max(z, floor) if floor is not None else z
    return add(wall.point(u, z), (*scale(wall.inward, out), 0.0))


def _face_away(mesh, points, core, material):
    points = distinct(points, 1e-6)
    if len(points) < 3:
        return
    middle = scale(add(add(points[0], points[1]), points[2]), 1.0 / 3.0)
    away = dot(newell(points), sub(middle, core)) > 0
    mesh.face(points if away else points[::-1], material)


def _bars(mesh, wall, hole):
    """Glazing bars in the depth of the wall, on the room's side of the portal."""
    us, zs = [wall.along(p) for p in hole.outline], [p[2] for p in hole.outline]
    u0, u1, z0, z1 = min(us), max(us), min(zs), max(zs)
    if len(hole.outline) != 4:
        z1 = z1 - (u1 - u0) / 2 if len(hole.outline) < 16 else z1
    middle, depth, thick = (u0 + u1) / 2, -0.6 * hole.distance, 0.025
    for u in (middle,) if u1 - u0 < 1.4 else (lerp((u0,), (u1,), 1 / 3)[0], lerp((u0,), (u1,), 2 / 3)[0]):
        _bar(mesh, wall, (u - thick, z0), (u + thick, _top_at(wall, hole, u)), depth)
    if len(hole.outline) < 16:
        for share in (0.35, 0.7):
            z = z0 + share * (z1 - z0)
            _bar(mesh, wall, (u0, z - thick), (u1, z + thick), depth - 0.002)


def _top_at(wall, hole, u):
    """Height of the opening's upper edge over one place of the wall."""
    ring = [(wall.along(p), p[2]) for p in hole.outline]
    heights = [
        a[1] + (b[1] - a[1]) * (u - a[0]) / (b[0] - a[0])
        for a, b in zip(ring, ring[1:] + ring[:1])
        if abs(b[0] - a[0]) > 1e-6 and min(a[0], b[0]) <= u <= max(a[0], b[0])
    ]
    return max(heights)


def _bar(mesh, wall, low, high, depth):
    """A square bar between two corners (u, z) of the wall's plane, `depth` metres out of it (negative: into it)."""
    bar = box((low[0], depth - 0.025, low[1]), (high[0], depth + 0.025, high[1]), "wood_white")
    points = [(*add(wall.point(u, 0)[:2], scale(wall.inward, o)), z) for u, o, z in bar.points]
    bar.points = points
    mesh.append(bar)

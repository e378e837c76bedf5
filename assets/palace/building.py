"""From the plan to the closed shell of each room."""

import math

from geometry import bounds, inset, lerp, snap_point
from meshes import Mesh
from openings import LIP, WELLS
from shell import Shell, centre_of

DADO_HEIGHT = 1.0
DADOES = {"paper": "wainscot", "marble": "marble_dark", "wood": "wood_panel", "plaster": "plaster_warm"}
CEILINGS = {
    "barrel": "plaster_warm",
    "cove": "plaster",
    "dome": "dome_blue",
    "flat": "plaster",
    "coffer": "plaster",
    "oculus": "plaster",
}
ROOF_REACH, ROOF_TOP, SKY_TOP = 4.0, 12.5, 34.0


def build(room, portals):
    """The stitched shell of a room whose walls already carry their holes, and whose portals are given."""
    shell = Shell()
    if room.section:
        _ramp(shell, room)
    else:
        for wall in room.walls:
            shell.wall(wall, room.floor, room.spring, _bands(room))
        _floor(shell, room)
        _ceiling(shell, room)
    shell.stitch([p for portal in portals for p in portal.points])
    return shell


def ceiling_material(room):
    if room.theme in ("barrels", "store"):
        return "brick"
    if room.theme in ("dungeon", "undercroft", "passage", "crypt", "cistern", "treasury"):
        return "stone_wall"
    return "stars" if room.theme in ("chapel", "belvedere") else CEILINGS[room.top]


def _bands(room):
    if room.theme == "court":
        return [(0.0, "stone_block"), (4.75, "plaster_ochre")]
    dado = DADOES.get(room.wall.split("_")[0])
    return [(0.0, dado), (DADO_HEIGHT, room.wall)] if dado and dado != room.wall else [(0.0, room.wall)]


def _well_at(room, end):
    return next((well for well in WELLS if getattr(well, end) == room.name), None)


def _floor(shell, room):
    well = _well_at(room, "upper")
    if well is None:
        shell.level(room.footprint, room.floor, room.ground, up=True, axis=_texture_axis(room))
        return
    _holed(shell, room, well, room.floor, room.ground, up=True)
    _shaft(shell, well, room.floor - LIP, room.floor)


def _ceiling(shell, room):
    material, wall = ceiling_material(room) if room.top != "sky" else None, room.wall
    if room.top == "sky":
        _sky(shell, room)
    elif room.top == "cove":
        shell.cove(room.footprint, room.spring, room.rise, room.rise, material, material)
    elif room.top == "barrel":
        shell.barrel(room.footprint, room.spring, room.rise, material, wall)
    elif room.top == "dome":
        shell.dome(room.footprint, room.spring, room.rise, material)
    else:
        well = _well_at(room, "lower")
        if well is None:
            shell.level(room.footprint, room.ceiling, material, up=False, axis=_texture_axis(room))
        else:
            _holed(shell, room, well, room.ceiling, material, up=False)
            _shaft(shell, well, room.ceiling, _upper_floor(room) - LIP)


def _upper_floor(room):
    return room.ceiling + 0.5  # every floor between two storeys is half a metre thick


def _texture_axis(room):
    return None if len(room.footprint) == 4 else (1.0, 0.0)


def _holed(shell, room, well, z, material, up):
    if len(well.outline) == 4:
        shell.level(room.footprint, z, material, up, hole=bounds(well.outline))
        return
    hint = (*centre_of(room.footprint), z + (1.0 if up else -1.0))
    shell.ring(room.footprint, z, list(well.outline), z, material, hint, steps=3)


def _shaft(shell, well, bottom, top):
    outline = list(well.outline)
    shell.ring(outline, bottom, outline, top, "stone_trim", (*centre_of(outline), (bottom + top) / 2))


def _sky(shell, room):
    """Tiled roofs rise from the walls' top; over their ridge stands a box of sky."""
    hint = (*centre_of(room.footprint), room.ceiling + 5.0)
    ridge = [snap_point(p) for p in inset(room.footprint, -ROOF_REACH)]
    shell.ring(room.footprint, room.ceiling, ridge, ROOF_TOP, "roof_tiles", hint, steps=2)
    for i, corner in enumerate(ridge):
        _sky_wall(shell, corner, ridge[(i + 1) % len(ridge)])
    shell.level(ridge, SKY_TOP, "sky", up=False, step=4.0)


def _sky_wall(shell, start, end, columns=8, rows=6):
    for i in range(columns):
        for j in range(rows):
            p, q = lerp(start, end, i / columns), lerp(start, end, (i + 1) / columns)
            z0 = ROOF_TOP + (SKY_TOP - ROOF_TOP) * j / rows
            z1 = ROOF_TOP + (SKY_TOP - ROOF_TOP) * (j + 1) / rows
            shell.add([(*p, z0), (*p, z1), (*q, z1), (*q, z0)], "sky")


def _ramp(shell, room):
    """A passage of rectangular section along a bent floor: floor, ceiling, two sides; open at the leaning end."""
    x0, x1 = room.footprint[0][0], room.footprint[1][0]
    stations = _stations(room.section)
    for (low0, high0), (low1, high1) in zip(stations, stations[1:]):
        shell.add([(x0, *low1), (x1, *low1), (x1, *low0), (x0, *low0)], room.ground)
        shell.add([(x0, *high0), (x1, *high0), (x1, *high1), (x0, *high1)], room.wall)
        shell.add([(x1, *low0), (x1, *low1), (x1, *high1), (x1, *high0)], room.wall)
        if low0[1] != low1[1]:
            shell.add([(x0, *low0), (x0, *high0), (x0, *high1), (x0, *low1)], room.wall)
        else:
            shell.wall(room.walls[0], low0[1], high0[1], [(0.0, room.wall)])
    _ramp_end(shell, room, x0, x1)


def _stations(section, longest=1.5):
    """The section's stations with more between them where the floor slopes, for the sake of light at vertices."""
    result = [section[0]]
    for (low0, high0), (low1, high1) in zip(section, section[1:]):
        count = 1 if low0[1] == low1[1] else round(abs(low1[0] - low0[0]) / longest)
        result += [(lerp(low0, low1, k / count), lerp(high0, high1, k / count)) for k in range(1, count + 1)]
    return result


def _ramp_end(shell, room, x0, x1):
    """The closed end of the passage: the first station of the head, the last of the foot."""
    head = room.section[0][0][1] == room.section[1][0][1]
    low, high = room.section[0] if head else room.section[-1]
    points = [(x0, *low), (x1, *low), (x1, *high), (x0, *high)]
    shell.add(points if head else points[::-1], room.wall)


def shell_mesh(shell):
    """The shell's triangles as mesh data."""
    mesh = Mesh()
    for points, uvs, material in shell.triangles():
        mesh.face(points, material, [_sky_uv(p) for p in points] if material == "sky" else uvs)
    return mesh


def _sky_uv(point):
    """Height of the view over the courtyard's horizon up the picture, the (folded) compass across it."""
    x, y, z = point
    azimuth = abs(math.atan2(y, x)) / math.pi
    elevation = math.atan2(z - 1.7, math.hypot(x, y)) / (math.pi / 2)
    return azimuth, min(max(elevation, 0.0), 1.0)

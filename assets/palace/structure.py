"""What a room is built with beyond its shell: columns, coffers, stairs, balustrades, ceiling roses, pilasters."""

import math

from catalogue import coffer_name, column_name, pillar_name
from fittings import balustrade, flight
from life import LIFT_AT, LIFT_SIZE
from geometry import add, depth_inside, inset, length, lerp, rectangle, scale, sub
from meshes import Mesh, box
from openings import WELLS
from placing import LIFT, Well
from tour import STAIRS

COFFER_SIDE = 2.0
COLUMNS = {  # room: places of free columns, radius
    "GreatHall": ([(x, y) for x in (15.5, 22.5) for y in (-5.25, -1.75, 1.75, 5.25)], 0.42),
    "EntranceHall": ([(x, y) for x in (-2.75, 2.75) for y in (-14.75, -11.0)], 0.26),
    "UpperHall": ([(x, y) for x in (-2.75, 2.75) for y in (-14.75, -12.5)], 0.24),
    "MarbleSaloon": ([(x, y) for x in (-2.6, 2.6) for y in (13.25, 15.5)], 0.26),
    "BallRoom": ([(x, y) for x in (14.0, 24.0) for y in (-22.5, -20.0, -17.0, -14.5)], 0.26),
    "Chapel": ([(x, y) for x in (-17.0, -14.75, -12.0) for y in (18.6, 24.4)], 0.3),
    "Belvedere": ([], 0.25),
    "Rotunda": ([], 0.26),
}
VAULT_AT_PILLAR = 0.95  # how much higher than its spring the undercroft's vault is over a pillar
PILLARS = {
    "Undercroft": [(x, y) for x in (-2.25, 2.25) for y in (-22.0, -16.5, -11.5)],
    "Cistern": [(x, y) for x in (4.5, 7.0, 9.5) for y in (-3.5, 0.0, 3.5)],
}


def build(placer):
    room = placer.room
    _stairs_and_wells(placer)
    _columns(placer)
    if room.top == "coffer":
        _coffers(placer)
    if room.theme == "chapel":
        _entablature(placer)
    _opening_balustrades(placer)


def _columns(placer):
    room = placer.room
    drop = 0.25 if room.top == "coffer" else 0.0
    places, radius = COLUMNS.get(room.name, ([], 0.0))
    if room.name in ("Rotunda", "Belvedere"):
        # Beside the diagonals; the doors stand in the sides that face the four winds.
        places = [lerp(placer.centre, p, 0.9) for i, p in enumerate(room.footprint) if i % 4 in (2, 3)]
    for at in places:
        height = room.spring - room.floor - drop - LIFT - 0.002
        if room.top == "barrel":
            height = min(height, 5.0)
        stone = "marble_white" if room.theme in ("chapel", "ballroom") else "marble_rose_plain"
        _must(placer, column_name(height, radius, stone), at)
    for at in PILLARS.get(room.name, []):
        top = room.spring + VAULT_AT_PILLAR if room.top == "barrel" else room.ceiling
        _must(placer, pillar_name(top - room.floor - 0.005), at)


def _entablature(placer):
    """A beam on each row of the chapel's columns, from wall to wall."""
    (x0, y0), _, (x1, y1), _ = placer.room.footprint
    mesh = Mesh()
    for y in (y0 + 1.6, y1 - 1.6):
        for half, low, high in ((0.3, 5.004, 5.35), (0.34, 5.35, 5.42), (0.42, 5.42, 5.55)):
            mesh.append(
                box(
                    (x0 + 0.012, y - half, low),
                    (x1 - 0.012, y + half, high),
                    "marble_white",
                    "we" + ("b" if half == 0.34 else ""),
                )
            )
    placer.scene.local_mesh(placer.room.name, f"{placer.room.name}_entablature", mesh)


def _must(placer, name, at):
    """Columns stand where the plan says, unless that is in the walker's way."""
    if all(math.dist(at, p) > 0.75 for p in placer.walk):
        placer.add(name, at)


def _coffers(placer):
    """Equal coffers in rows along the first wall of a four-sided ceiling."""
    room = placer.room
    if (
        len(room.footprint) != 4
        or abs(length(sub(room.footprint[2], room.footprint[1])) - length(sub(room.footprint[3], room.footprint[0])))
        > 0.01
    ):
        return
    a, b, _, d = inset(room.footprint, 0.17)
    u, v = sub(b, a), sub(d, a)
    columns, rows = max(2, round(length(u) / COFFER_SIDE)), max(2, round(length(v) / COFFER_SIDE))
    material = (
        "wood_dark"
        if room.wall.startswith("wood")
        else "wood_light"
        if room.theme in ("guard", "billiard", "servants")
        else "plaster"
    )
    name = coffer_name(length(u) / columns, length(v) / rows, material)
    turn = math.atan2(u[1], u[0])
    for i in range(columns):
        for j in range(rows):
            at = add(a, add(scale(u, (i + 0.5) / columns), scale(v, (j + 0.5) / rows)))
            placer.add(name, at, turn, room.ceiling - room.floor - 0.002, solid=False)


# ---- stairs and wells ----------------------------------------------------------------------------------------------


def _stairs_and_wells(placer):
    room = placer.room
    for stair in STAIRS:
        if stair.lower == room.name:
            _stair(placer, stair)
    for well in WELLS:
        if well.upper == room.name:
            placer.solids.append(Well(_grown(well.outline, 0.3)))
            _well_rails(placer, well)


def _grown(outline, margin):
    return inset(list(outline), -margin)


def _stair(placer, stair):
    """Both flights and the landing as one mesh of the lower room."""
    x0, y0, x1, y1 = stair.box
    front, back = stair.lanes
    middle = (stair.bottom + stair.top) / 2
    width = (y1 - y0) / 2 - 0.01
    mesh = Mesh()
    mesh.append(flight(stair, front, width, stair.bottom + LIFT, middle, eastward=False))
    mesh.append(flight(stair, back, width, middle, stair.top, eastward=True))
    mesh.append(
        box((x0 - 0.2, y0 + 0.005, middle - 0.3), (stair.landing - 0.002, y1 - 0.005, middle - 0.04), "marble_white")
    )
    mesh.append(box((x0 - 0.2, y0 + 0.005, middle - 0.04), (stair.landing - 0.002, y1 - 0.005, middle), "marble_dark"))
    for x in (x0 - 0.05, stair.landing - 0.25):
        for y in (y0 + 0.2, y1 - 0.2):
            mesh.append(
                box((x - 0.12, y - 0.12, stair.bottom + LIFT), (x + 0.12, y + 0.12, middle - 0.3), "marble_cream", "bt")
            )
    name = placer.room.name
    placer.scene.local_mesh(name, f"{name}_stair", mesh)
    rise = (middle - stair.bottom) / (x1 - stair.landing)
    outer = y1 - 0.1 if stair.front_north else y0 + 0.1
    inner = (y0 + y1) / 2 + (-0.1 if stair.front_north else 0.1)
    under_ceiling = min(1.0, max(0.0, (placer.room.ceiling - 0.6 - middle) / (stair.top - middle)))
    end = stair.landing + under_ceiling * (x1 - stair.landing)
    placer.scene.local_mesh(name, f"{name}_stair_rail_0", _sloped_rail(stair.landing, x1, outer, middle, -rise))
    placer.scene.local_mesh(name, f"{name}_stair_rail_1", _sloped_rail(stair.landing, end, inner, middle, rise))
    placer.solids.append(Well(rectangle(x0 - 0.25, y0 - 0.25, x1 + 0.9, y1 + 0.2)))


def _sloped_rail(x0, x1, y, z_at_x0, slope):
    """A balustrade along a flight, sheared to its slope."""
    length_x = x1 - x0
    if length_x < 0.3:
        return Mesh()
    rail = balustrade(length_x)
    return rail.map(
        lambda p: (
            p[0] + (x0 + x1) / 2,
            p[1] + y,
            p[2] * 0.96 + 0.02 + z_at_x0 + slope * (p[0] + length_x / 2) - (0.0 if slope < 0 else -0.1),
        )
    )


def _well_rails(placer, well):
    """Balustrades about a well on the upper floor; where a stair arrives the side stays open."""
    stair = next((s for s in STAIRS if s.upper == well.upper), None)
    outline = _grown(well.outline, 0.14)
    sides = [(p, q) for p, q in zip(outline, outline[1:] + outline[:1])]
    if stair:
        x0, y0, x1, y1 = stair.box
        south, east, north, west = sides
        middle = (y0 + y1) / 2
        half = ((east[0][0], middle), east[1]) if stair.front_north else (east[0], (east[0][0], middle))
        sides = [north if stair.front_north else south, half]
    if well.upper == "UpperLibrary":  # the elevator's passengers step off here
        gate = LIFT_AT[0] + LIFT_SIZE / 2 + 0.15
        sides[2] = (sides[2][0], (gate, sides[2][1][1]))
    for p, q in sides:
        span = length(sub(q, p))
        at, turn = lerp(p, q, 0.5), math.atan2(q[1] - p[1], q[0] - p[0])
        placer.add(f"balustrade.{round((span - 0.2) * 1000)}", at, turn)
        for corner in (p, q) if len(sides) < 8 else ():
            if depth_inside(placer.room.footprint, corner) > 0.16:
                placer.add("newel", corner)


def _opening_balustrades(placer):
    """In an upper room's arches onto a hall: a balustrade in the depth of the wall."""
    room = placer.room
    if room.name not in ("HallGallery", "MinstrelsGallery"):
        return
    for wall in room.walls:
        for hole in wall.holes:
            if len(hole.outline) == 4 or hole.material != "stone_trim":
                continue
            us = [wall.along(p) for p in hole.outline]
            at = add(wall.point((min(us) + max(us)) / 2, 0)[:2], scale(wall.inward, -0.125))
            turn = math.atan2(wall.direction[1], wall.direction[0])
            placer.add(f"balustrade.{round((max(us) - min(us) - 0.02) * 1000)}", at, turn)

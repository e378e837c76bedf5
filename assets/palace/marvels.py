"""Pieces of the clockwork that stands about the palace: frames and stands, and what turns on them.  Mesh data, no Blender."""

import math

from meshes import Mesh, block, box, lathe, prism, tube
from moving import joined

GEARS = [  # of the great clock, each meshing with the next: middle x, z; radius; teeth
    (-0.2, 0.62, 0.28, 56),
    (0.2, 0.886, 0.2, 40),
    (-0.098, 1.051, 0.14, 28),
    (0.075, 1.203, 0.09, 18),
]
GREAT_DIAL = 1.62  # height of the dial's middle
PLANETS = [  # of the orrery: length of the arm, height, radius of the ball, seconds a turn, surface
    (0.2, 0.16, 0.03, 9.0, "steel"),
    (0.32, 0.13, 0.045, 15.0, "terracotta"),
    (0.46, 0.1, 0.05, 24.0, "cobalt"),
    (0.62, 0.07, 0.04, 45.0, "ember"),
    (0.8, 0.04, 0.085, 80.0, "old_map"),
]
ORRERY_TOP = 1.0
CAGE_FLOOR = 1.03


def ball(radius, material, at=(0.0, 0.0, 0.0), sides=10):
    steps = max(6, sides // 2 + 1)
    rows = [(radius * math.sin(math.pi * i / steps), -radius * math.cos(math.pi * i / steps)) for i in range(steps + 1)]
    return joined().append(lathe(rows, material, sides), at)


def ring(radius, thickness, material, z=0.0, sides=18):
    path = [(radius * math.cos(a), radius * math.sin(a), z) for a in (2 * math.pi * i / sides for i in range(sides + 1))]
    return tube(path, thickness, material, 5)


def upright(mesh):
    """What lies in the plan, stood up to face +y."""
    return mesh.map(lambda p: (-p[0], p[2], p[1]))


# ---- the great clock -------------------------------------------------------------------------------------------------


def great_clock():
    """The frame: four iron posts, beams, axles, a dial over them; it faces +y."""
    mesh = joined(block((1.0, 0.6, 0.1), "wood_dark"), block((0.9, 0.5, 0.06), "wood_light", (0, 0, 0.1)))
    for x in (-0.4, 0.4):
        for y in (-0.2, 0.2):
            mesh.append(block((0.05, 0.05, 1.25), "iron", (x, y, 0.16)))
            mesh.append(ball(0.045, "brass", (x, y, 1.44), 8))
    for y in (-0.2, 0.2):
        for z in (0.3, 0.8, 1.36):
            mesh.append(box((-0.4, y - 0.015, z - 0.02), (0.4, y + 0.015, z + 0.02), "iron"))
    for x, z, radius, _ in GEARS:
        mesh.append(tube([(x, -0.19, z), (x, 0.19, z)], 0.014, "steel", 6))
        mesh.append(box((x - 0.02, -0.215, min(z, 1.36)), (x + 0.02, -0.185, 1.36), "iron"))
    mesh.append(box((-0.05, -0.03, 1.36), (0.05, 0.03, GREAT_DIAL - 0.2), "iron"))
    dial = lathe([(0.26, 0.0), (0.26, 0.015), (0.0, 0.015)], "ivory", 28)
    dial.append(ring(0.26, 0.018, "brass", 0.01, 24))
    for k in range(12):
        a = 2 * math.pi * k / 12
        dial.append(prism([(x + 0.215 * math.cos(a), y + 0.215 * math.sin(a)) for x, y in ((-0.015, -0.015), (0.015, -0.015), (0.015, 0.015), (-0.015, 0.015))], 0.015, 0.02, "ebony"))
    back = lathe([(0.0, -0.02), (0.27, -0.01), (0.26, 0.0)], "wood_dark", 28)
    return mesh.append(upright(joined(dial, back)), (0, 0.05, GREAT_DIAL))


def gear(number):
    """A toothed wheel with five spokes about the y axis."""
    _, _, radius, teeth = GEARS[number]
    rim = [(radius * 0.8, -0.015), (radius * 0.97, -0.015), (radius * 0.97, 0.015), (radius * 0.8, 0.015), (radius * 0.8, -0.015)]
    mesh = lathe(rim, "brass", 20, smooth=False)
    mesh.append(lathe([(0.0, -0.025), (0.03, -0.025), (0.03, 0.025), (0.0, 0.025)], "brass", 8))
    half = math.pi * radius / teeth * 0.5
    for k in range(teeth // 2):  # every second tooth is drawn: enough to see it turn
        a = 4 * math.pi * k / teeth
        c, s = math.cos(a), math.sin(a)
        corners = [(radius * 0.96, -half), (radius * 1.03, -half * 0.6), (radius * 1.03, half * 0.6), (radius * 0.96, half)]
        mesh.append(prism([(x * c - y * s, x * s + y * c) for x, y in corners], -0.012, 0.012, "brass", ""))
    for k in range(5):
        a = 2 * math.pi * k / 5
        mesh.append(tube([(0, 0, 0), (0.82 * radius * math.cos(a), 0.82 * radius * math.sin(a), 0)], 0.012, "brass", 5))
    return upright(mesh)


# ---- heavens and toys ------------------------------------------------------------------------------------------------


def orrery_stand():
    stand = lathe([(0.3, 0.0), (0.3, 0.04), (0.08, 0.12), (0.06, 0.5), (0.1, 0.6), (0.04, 0.7), (0.04, 0.95), (0.02, 1.0)], "wood_dark", 14)
    return joined(stand, lathe([(0.0, 1.0), (0.02, 1.0), (0.02, 1.14), (0.0, 1.14)], "brass", 8), ball(0.1, "flame", (0, 0, 1.2), 14))


def planet(number):
    """An arm about the z axis and the ball at its end."""
    length, height, radius, _, surface = PLANETS[number]
    arm = tube([(0, 0, height - 0.1), (length, 0, height - 0.1), (length, 0, 0.2 - radius)], 0.008, "brass", 5)
    mesh = joined(arm, ball(radius, surface, (length, 0, 0.2), 12))
    if number == 4:
        mesh.append(ring(0.13, 0.012, "cloth_gold"), (length, 0, 0.2))
    return mesh.append(lathe([(0.03, height - 0.115), (0.03, height - 0.085), (0.0, height - 0.085)], "brass", 8))


def globe_stand():
    legs = joined(ring(0.3, 0.02, "wood_dark", 0.55), block((0.04, 0.04, 0.26), "wood_dark"))
    for k in range(3):
        a = 2 * math.pi * k / 3
        legs.append(tube([(0.28 * math.cos(a), 0.28 * math.sin(a), 0.55), (0.2 * math.cos(a), 0.2 * math.sin(a), 0.0)], 0.025, "wood_dark", 6))
    return legs


def globe():
    mesh = ball(0.25, "old_map", sides=20)
    return mesh.append(lathe([(0.012, -0.3), (0.012, 0.3), (0.0, 0.31)], "brass", 6))


def carousel_stand():
    return lathe([(0.5, 0.0), (0.5, 0.1), (0.46, 0.14), (0.0, 0.14)], "wood_dark", 16)


def horse(material):
    """A wooden horse of 0.22 m along +y, on its pole."""
    mesh = joined(box((-0.03, -0.08, 0.1), (0.03, 0.08, 0.18), material), box((-0.02, 0.06, 0.16), (0.02, 0.11, 0.27), material))
    mesh.append(box((-0.018, 0.08, 0.23), (0.018, 0.16, 0.28), material))
    mesh.append(box((-0.032, -0.03, 0.175), (0.032, 0.03, 0.195), "cloth_gold"))
    for x in (-0.02, 0.02):
        for y in (-0.065, 0.065):
            mesh.append(box((x - 0.01, y - 0.01, 0.0), (x + 0.01, y + 0.01, 0.1), material))
    mesh.append(box((-0.01, -0.12, 0.08), (0.01, -0.08, 0.17), "ebony"))
    return mesh.append(tube([(0, 0, -0.06), (0, 0, 0.42)], 0.008, "brass", 5))


def carousel():
    """Platform, pole and canopy that turn; the horses are movers of their own."""
    mesh = joined(lathe([(0.0, 0.0), (0.46, 0.0), (0.46, 0.03), (0.0, 0.03)], "wood_light", 16))
    mesh.append(lathe([(0.06, 0.03), (0.06, 0.62), (0.0, 0.62)], "cloth_gold", 10))
    for k in range(12):
        a, b = 2 * math.pi * k / 12, 2 * math.pi * (k + 1) / 12
        rim = [(0.5 * math.cos(a), 0.5 * math.sin(a), 0.6), (0.5 * math.cos(b), 0.5 * math.sin(b), 0.6)]
        cloth = "cloth_red" if k % 2 else "cloth_white"
        mesh.face([*rim, (0, 0, 0.82)], cloth)
        mesh.face([rim[1], rim[0], (0, 0, 0.6)], cloth)
        low = [(x, y, 0.53) for x, y, _ in rim]
        mesh.face([low[0], low[1], rim[1], rim[0]], "cloth_gold")
        mesh.face([rim[0], rim[1], low[1], low[0]], "cloth_gold")
    return mesh.append(ball(0.03, "gold", (0, 0, 0.84), 8))


def music_box():
    return joined(box((-0.22, -0.22, 0.0), (0.22, 0.22, 0.14), "wood_dark"), box((-0.2, -0.2, 0.14), (0.2, 0.2, 0.15), "mirror"))


def dancer(cloth):
    """A dancer of 0.3 m on her toes, one arm up."""
    mesh = lathe([(0.0, 0.0), (0.01, 0.02), (0.012, 0.1), (0.1, 0.11), (0.09, 0.125), (0.03, 0.155), (0.024, 0.17), (0.034, 0.21), (0.012, 0.225), (0.012, 0.235)], cloth, 12)
    mesh.append(ball(0.024, "wax", (0, 0, 0.255), 8))
    mesh.append(ball(0.014, "ebony", (0, -0.012, 0.28), 6))
    mesh.append(tube([(0.03, 0, 0.205), (0.07, 0.02, 0.25), (0.02, 0.02, 0.31)], 0.007, "wax", 5))
    return mesh.append(tube([(-0.03, 0, 0.205), (-0.08, 0.03, 0.2), (-0.12, 0.05, 0.215)], 0.007, "wax", 5))


def fan():
    """Four blades under the ceiling at z = 0."""
    mesh = joined(lathe([(0.0, -0.56), (0.07, -0.54), (0.08, -0.46), (0.02, -0.43), (0.02, 0.0)], "brass", 10))
    for k in range(4):
        c, s = math.cos(math.pi * k / 2), math.sin(math.pi * k / 2)
        blade = box((0.14, -0.07, -0.5), (0.75, 0.07, -0.485), "wood_dark")
        blade.append(box((0.05, -0.015, -0.505), (0.2, 0.015, -0.485), "brass"))
        mesh.append(blade.map(lambda p, c=c, s=s: (p[0] * c - p[1] * s, p[0] * s + p[1] * c, p[2])))
    return mesh


def mobile():
    """Two crossed bars with stars and moons on threads, hung from z = 0."""
    mesh = joined(tube([(0, 0, 0), (0, 0, -0.9)], 0.004, "steel", 4))
    for k in range(2):
        c, s = math.cos(math.pi * k / 2), math.sin(math.pi * k / 2)
        z = -0.9 - 0.02 * k
        mesh.append(tube([(-0.45 * c, -0.45 * s, z), (0.45 * c, 0.45 * s, z)], 0.008, "wood_light", 5))
        for side, drop in ((-1, 0.3 + 0.1 * k), (1, 0.45 - 0.1 * k)):
            x, y = 0.43 * c * side, 0.43 * s * side
            mesh.append(tube([(x, y, z), (x, y, z - drop)], 0.003, "steel", 4))
            shape = lathe([(0.0, -0.08), (0.06, 0.0), (0.0, 0.08)], ("gold", "cobalt", "ember", "crystal")[2 * k + (side > 0)], 5, smooth=False)
            mesh.append(shape, (x, y, z - drop - 0.08))
    return mesh


def ship_stand():
    stand = block((0.5, 0.24, 0.04), "wood_dark")
    for x in (-0.12, 0.12):
        stand.append(box((x - 0.015, -0.05, 0.04), (x + 0.015, 0.05, 0.2), "brass"))
    return stand


def ship():
    """A three-master of 0.7 m along +x; its keel at the origin."""
    hull = Mesh()
    stations = [(-0.3, 0.07, 0.15), (-0.2, 0.09, 0.12), (0.0, 0.1, 0.11), (0.18, 0.085, 0.12), (0.34, 0.0, 0.17)]
    for side in (-1, 1):
        for (x0, w0, h0), (x1, w1, h1) in zip(stations, stations[1:]):
            low = [(x0, 0.0, 0.0 if x0 > -0.29 else 0.02), (x1, 0.0, 0.0 if x1 < 0.3 else 0.1)]
            high = [(x1, w1 * side, h1), (x0, w0 * side, h0)]
            face = low + high if w1 > 0 else [low[0], low[1], (x1, 0.0, h1), high[1]]
            hull.face(face[::-1] if side > 0 else face, "wood_dark")
            deck = [(x0, 0.0, h0 - 0.015), (x1, 0.0, h1 - 0.015), high[0], high[1]]
            hull.face(deck if side > 0 else deck[::-1], "wood_light") if w1 > 0 else None
    hull.face([(-0.3, -0.07, 0.15), (-0.3, 0.0, 0.02), (-0.3, 0.07, 0.15)][::-1], "wood_dark")
    for x, top in ((-0.18, 0.5), (0.0, 0.62), (0.17, 0.52)):
        hull.append(tube([(x, 0, 0.1), (x, 0, top)], 0.007, "wood_light", 5))
        for low, high, half in ((0.2, 0.36, 0.13), (0.38, top - 0.04, 0.1)):
            sail = [(x + 0.01, -half, low), (x + 0.01, half, low), (x + 0.01, half * 0.8, high), (x + 0.01, -half * 0.8, high)]
            hull.face(sail, "cloth_white")
            hull.face(sail[::-1], "cloth_white")
    return hull.append(tube([(0.3, 0, 0.16), (0.45, 0, 0.22)], 0.006, "wood_light", 5))


def cage():
    """A cage of brass wires on a wooden foot."""
    mesh = joined(lathe([(0.0, 0.0), (0.34, 0.0), (0.34, 0.03), (0.0, 0.03)], "wood_dark", 16), ring(0.33, 0.01, "brass", 0.5))
    for k in range(12):
        a = 2 * math.pi * k / 12
        x, y = 0.33 * math.cos(a), 0.33 * math.sin(a)
        mesh.append(tube([(x, y, 0.03), (x, y, 0.5), (x * 0.7, y * 0.7, 0.64), (0, 0, 0.72)], 0.004, "brass", 4))
    return mesh.append(ball(0.025, "brass", (0, 0, 0.74), 8))

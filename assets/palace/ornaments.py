"""Ornaments: candles and chandeliers, vases, statues, pictures in frames, mirrors, carpets, instruments, plants.

The same conventions as furniture: wall pieces have their back at y = 0 and face +y; free pieces stand about the origin.
"""

import math

from furniture import block, joined, leg, octagon, plinth
from geometry import add, cross, scale, unit
from meshes import Mesh, box, lathe, prism, tube

CANDLE = [(0.014, 0.0), (0.013, 0.12)]
FLAME = [(0.0, 0.0), (0.012, 0.018), (0.0, 0.06)]


def candle(at=(0.0, 0.0, 0.0)):
    lit = joined(lathe(CANDLE, "wax", 4), Mesh().append(lathe(FLAME, "flame", 4), (0, 0, 0.13)))
    return Mesh().append(lit, at)


def candlestick():
    profile = [
        (0.09, 0.0),
        (0.05, 0.03),
        (0.02, 0.05),
        (0.03, 0.08),
        (0.014, 0.13),
        (0.016, 0.24),
        (0.045, 0.285),
        (0.0, 0.29),
    ]
    return lathe(profile, "brass", 6).append(candle((0, 0, 0.29)))


def candelabrum():
    """A standing candelabrum of five lights."""
    body = lathe(
        [
            (0.2, 0.0),
            (0.08, 0.09),
            (0.04, 0.16),
            (0.06, 0.3),
            (0.025, 0.4),
            (0.025, 1.1),
            (0.05, 1.16),
            (0.05, 1.4),
            (0.0, 1.43),
        ],
        "gold",
        7,
    )
    body.append(candle((0, 0, 1.43)))
    for k in range(4):
        turn = math.pi / 2 * k
        body.append(_arm(0.26, 1.1, 0.16), turn=turn)
    return body


def _arm(reach, z, rise, material="gold"):
    """A curved arm with a candle at its end."""
    path = [(0.0, 0.0, z), (reach * 0.4, 0, z - rise * 0.6), (reach * 0.8, 0, z - rise * 0.3), (reach, 0, z + rise)]
    cup = lathe([(0.012, 0.0), (0.045, 0.03), (0.0, 0.033)], material, 5)
    return joined(
        tube(path, [0.017, 0.015, 0.013, 0.01], material, 3),
        Mesh().append(cup, (reach, 0, z + rise)),
        candle((reach, 0, z + rise + 0.03)),
    )


def chandelier(arms=8, reach=0.55, tiers=1, drops=True):
    """Hangs from z = 0; brass body, candles on curved arms, strings of crystal."""
    body = lathe(
        [
            (0.0, -1.35),
            (0.05, -1.32),
            (0.03, -1.26),
            (0.13, -1.1),
            (0.04, -0.98),
            (0.03, -0.85),
            (0.07, -0.75),
            (0.012, -0.62),
            (0.012, -0.05),
            (0.1, 0.0),
        ],
        "brass",
        8,
    )
    for tier in range(tiers):
        size, z = reach * (1 - 0.42 * tier), -1.1 + 0.32 * tier
        for k in range(arms - 2 * tier):
            turn = 2 * math.pi * (k + 0.5 * tier) / (arms - 2 * tier)
            body.append(_arm(size, z, 0.14, "brass"), turn=turn)
            if drops:
                body.append(_pendant(), (size * math.cos(turn), size * math.sin(turn), z + 0.09))
    if drops:
        for k in range(arms):
            body.append(_string(reach * 0.95, -1.04, 0.05, -0.62), turn=2 * math.pi * k / arms)
        body.append(_pendant(), (0, 0, -1.35), 0, (1.6, 1.6, 1.6))
    return body


def _pendant():
    return lathe([(0.0, -0.11), (0.018, -0.07), (0.0, 0.0)], "crystal", 4, smooth=False)


def _string(reach, low, start, high):
    """A festoon of crystal beads from the stem out to an arm."""
    mesh = Mesh()
    for i in range(4):
        t = (i + 0.5) / 4
        x = start + (reach - start) * t
        z = high + (low - high) * t - 0.18 * math.sin(math.pi * t)
        mesh.append(lathe([(0.0, -0.03), (0.018, 0.0), (0.0, 0.03)], "crystal", 3, smooth=False), (x, 0, z))
    return mesh


def lantern():
    """An iron lantern that hangs from z = 0."""
    body = joined(
        tube([(0, 0, -0.5), (0, 0, 0)], 0.008, "iron", 5),
        lathe([(0.0, -0.9), (0.13, -0.88), (0.14, -0.86), (0.0, -0.86)], "iron", 6),
        lathe([(0.16, -0.58), (0.0, -0.46)], "iron", 6, smooth=False),
    )
    for k in range(6):
        a = math.pi / 3 * k
        body.append(
            tube(
                [(0.13 * math.cos(a), 0.13 * math.sin(a), -0.87), (0.14 * math.cos(a), 0.14 * math.sin(a), -0.57)],
                0.008,
                "iron",
                4,
            )
        )
    return body.append(candle((0, 0, -0.86)), size=(1, 1, 1))


def sconce():
    plate = lathe([(0.09, 0.0), (0.08, 0.015), (0.0, 0.025)], "gold", 6).map(
        lambda p: (p[0], p[2] + 0.004, -p[1] * 1.6)
    )
    body = Mesh().append(plate)
    for x in (-0.09, 0.09):
        path = [(0, 0.025, -0.03), (x * 0.5, 0.1, -0.1), (x, 0.14, -0.06), (x, 0.14, 0.02)]
        body.append(tube(path, 0.01, "gold", 3)).append(
            lathe([(0.01, 0.0), (0.038, 0.022), (0.0, 0.026)], "gold", 5), (x, 0.14, 0.02)
        ).append(candle((x, 0.14, 0.045)))
    return body


def torch():
    """An iron cresset on the wall."""
    body = joined(
        tube([(0, 0.004, -0.2), (0, 0.16, -0.05), (0, 0.18, 0.05)], 0.018, "iron", 6),
        box((-0.05, 0.003, -0.32), (0.05, 0.02, -0.08), "iron"),
    )
    body.append(lathe([(0.03, 0.0), (0.09, 0.06), (0.1, 0.16), (0.0, 0.1)], "iron", 6), (0, 0.18, 0.04))
    return body.append(lathe([(0.07, 0.0), (0.06, 0.1), (0.025, 0.2), (0.0, 0.3)], "flame", 5), (0, 0.18, 0.16))


def lamp_post():
    """A lamp of the courtyard: an iron post with a lantern of four panes."""
    foot = [(0.16, 0.0), (0.16, 0.08), (0.09, 0.14), (0.07, 0.5), (0.045, 0.6), (0.035, 2.3), (0.09, 2.4), (0.0, 2.42)]
    body = lathe(foot, "iron", 8)
    body.append(block((0.2, 0.2, 0.3), "flame", (0, 0, 2.45)))
    for x in (-0.11, 0.11):
        for y in (-0.11, 0.11):
            body.append(block((0.03, 0.03, 0.34), "iron", (x, y, 2.42)))
    body.append(block((0.27, 0.27, 0.02), "iron", (0, 0, 2.425)))
    return body.append(lathe([(0.22, 0.0), (0.1, 0.12), (0.03, 0.16), (0.03, 0.22), (0.0, 0.26)], "iron", 4), (0, 0, 2.76))


def moon(at, radius=1.05, sides=32):
    """The full moon: a disc that looks at the middle of the courtyard."""
    axis = unit(at)
    across = unit((-axis[1], axis[0], 0.0))
    upward = cross(axis, across)
    rim = [(math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)) for k in range(sides)]
    points = [add(at, add(scale(across, -radius * x), scale(upward, radius * y))) for x, y in rim]
    disc = Mesh()
    disc.face(points, "moon", [(0.5 + 0.5 * x, 0.5 + 0.5 * y) for x, y in rim])
    return disc


def vase(kind=0):
    shapes = (
        [
            (0.07, 0.0),
            (0.08, 0.02),
            (0.06, 0.04),
            (0.12, 0.14),
            (0.16, 0.27),
            (0.13, 0.4),
            (0.06, 0.48),
            (0.055, 0.54),
            (0.09, 0.58),
            (0.0, 0.52),
        ],
        [
            (0.06, 0.0),
            (0.07, 0.02),
            (0.03, 0.06),
            (0.04, 0.09),
            (0.13, 0.18),
            (0.15, 0.3),
            (0.12, 0.36),
            (0.16, 0.44),
            (0.0, 0.34),
        ],
    )
    body = lathe(shapes[kind % 2], ("porcelain", "cobalt", "terracotta")[kind % 3], 10)
    ring = (0.161, 0.27) if kind % 2 == 0 else (0.151, 0.3)
    return body.append(
        lathe(
            [(ring[0], ring[1] - 0.02), (ring[0] + 0.004, ring[1]), (ring[0], ring[1] + 0.02)],
            "gold" if kind else "cobalt",
            10,
        )
    )


def flowers():
    body = vase(0)
    for k in range(9):
        a, r = 2.4 * k, 0.05 + 0.016 * k
        x, y, z = r * math.cos(a), r * math.sin(a), 0.85 - 0.022 * k
        body.append(tube([(0.02 * math.cos(a), 0.02 * math.sin(a), 0.52), (x, y, z)], 0.005, "leaves", 3))
        body.append(
            lathe([(0.0, -0.03), (0.045, 0.015), (0.0, 0.03)], ("cloth_red", "cloth_white", "cloth_gold")[k % 3], 6),
            (x, y, z),
        )
    return body


def _figure(material, seed):
    """A draped figure: body and drapery as one turned, fluted and swayed sheet; head and arms."""
    profile = [
        (0.24, 0.0),
        (0.25, 0.05),
        (0.21, 0.3),
        (0.19, 0.6),
        (0.2, 0.8),
        (0.165, 1.0),
        (0.2, 1.2),
        (0.2, 1.32),
        (0.09, 1.42),
        (0.055, 1.46),
        (0.055, 1.52),
    ]
    body = lathe(profile, material, 18)

    def draped(point):
        x, y, z = point
        angle, fold = math.atan2(y, x), max(0.0, 1.0 - z / 1.1)
        ripple = 1 + 0.14 * fold * math.cos(9 * angle + 3 * z + seed) + 0.03 * math.cos(4 * angle + 9 * z)
        flat = 0.72 if z > 0.7 else 0.72 + 0.28 * (0.7 - z) / 0.7
        return (x * ripple + 0.05 * math.sin(2.2 * z + seed), y * ripple * flat, z)

    body.map(draped)
    neck = 0.05 * math.sin(2.2 * 1.5 + seed)
    head = lathe([(0.0, 0.0), (0.06, 0.03), (0.085, 0.1), (0.095, 0.17), (0.08, 0.24), (0.0, 0.28)], material, 10)
    body.append(head, (neck, 0.01, 1.48), 0, (0.92, 1.08, 1))
    body.append(lathe([(0.0, 0.0), (0.06, 0.02), (0.05, 0.07), (0.0, 0.09)], material, 10), (neck, -0.07, 1.63))
    for side in (-1, 1):
        up = (seed + side) % 3 == 0
        path = [
            (neck + side * 0.12, 0, 1.4),
            (neck + side * 0.2, 0, 1.35),
            (neck + side * 0.28, 0.04, 1.1),
            (neck + side * (0.24 if up else 0.14), 0.2, 1.32 if up else 0.98),
            (neck + side * (0.2 if up else 0.03), 0.24, 1.5 if up else 1.0),
            (neck + side * (0.2 if up else 0.0), 0.25, 1.57 if up else 1.02),
        ]
        body.append(tube(path, [0.0, 0.068, 0.055, 0.045, 0.034, 0.0], material, 6))
    return body


def statue(seed=0, material="marble_white"):
    base = joined(
        prism(octagon(0.42), 0.0, 0.1, "marble_dark"),
        prism(octagon(0.36), 0.1, 0.7, "marble_dark"),
        prism(octagon(0.41), 0.7, 0.8, "marble_dark", ""),
    )
    return base.append(_figure(material, seed), (0, 0, 0.8))


def bust(seed=0):
    body = plinth(1.15, 0.2, "marble_dark" if seed % 2 else "marble_cream")
    chest = lathe(
        [
            (0.07, 0.0),
            (0.08, 0.03),
            (0.04, 0.07),
            (0.05, 0.1),
            (0.2, 0.22),
            (0.23, 0.34),
            (0.18, 0.42),
            (0.07, 0.46),
            (0.06, 0.54),
        ],
        "marble_white",
        12,
    )
    body.append(chest.map(lambda p: (p[0], p[1] * 0.62, p[2])), (0, 0, 1.15))
    body.append(
        lathe([(0.0, 0.0), (0.065, 0.03), (0.09, 0.12), (0.1, 0.19), (0.085, 0.26), (0.0, 0.31)], "marble_white", 10),
        (0, 0.015, 1.65),
        0,
        (0.9, 1.08, 1),
    )
    return body.append(lathe([(0.0, -0.02), (0.016, 0.0), (0.0, 0.045)], "marble_white", 6), (0, 0.125, 1.77))


def frame(width, height, rim=0.09, material="gold"):
    """A moulded picture frame about z = 0 .. height, its inside left open."""
    mesh = Mesh()
    profile = [(rim, 0.004), (rim, 0.05), (rim * 0.6, 0.06), (rim * 0.3, 0.04), (0.0, 0.05), (0.0, 0.02)]
    rings = []
    for out, depth in profile:
        x, z0, z1 = width / 2 + out, -out, height + out
        rings.append([(-x, depth, z0), (x, depth, z0), (x, depth, z1), (-x, depth, z1)])
    for outer, inner in zip(rings, rings[1:]):
        for i in range(4):
            j = (i + 1) % 4
            mesh.face([outer[j], outer[i], inner[i], inner[j]], material)
    return mesh


def painting(number, width, height):
    """One of the sixteen pictures of the atlas in a gilded frame."""
    u, v = (number % 4) * 0.25, (number // 4) * 0.25
    e = 0.004
    body = frame(width, height)
    x = width / 2
    body.face(
        [(x, 0.02, 0), (-x, 0.02, 0), (-x, 0.02, height), (x, 0.02, height)],
        "paintings",
        [(u + e, v + e), (u + 0.25 - e, v + e), (u + 0.25 - e, v + 0.25 - e), (u + e, v + 0.25 - e)],
    )
    return body


def mirror(width=1.1, height=1.9):
    """The frame of a mirror; its panel is a piece of its own, so that it can be marked."""
    crest = lathe([(0.0, 0.0), (0.24, 0.02), (0.2, 0.12), (0.08, 0.2), (0.0, 0.26)], "gold", 14).map(
        lambda p: (p[0], p[1] * 0.12 + 0.032, p[2])
    )
    return frame(width, height, 0.11).append(crest, (0, 0, height + 0.1))


def mirror_panel(width=1.1, height=1.9):
    x = width / 2
    mesh = Mesh()
    mesh.face(
        [(x, 0.02, 0), (-x, 0.02, 0), (-x, 0.02, height), (x, 0.02, height)], "mirror", [(0, 0), (1, 0), (1, 1), (0, 1)]
    )
    return mesh


def hanging(material="tapestry", width=2.4, height=2.0):
    """A tapestry or map on a rod, its cloth a little waved."""
    mesh = tube([(-width / 2 - 0.08, 0.05, height), (width / 2 + 0.08, 0.05, height)], 0.02, "gold", 6)
    columns = 12
    for i in range(columns):
        x0, x1 = (width / 2 - width * k / columns for k in (i, i + 1))
        y0, y1 = (0.035 + 0.015 * math.sin(1.7 * k) for k in (i, i + 1))
        u0, u1 = i / columns, (i + 1) / columns
        mesh.face(
            [(x0, y0, 0), (x1, y1, 0), (x1, y1, height - 0.02), (x0, y0, height - 0.02)],
            material,
            [(u0, 0), (u1, 0), (u1, 1), (u0, 1)],
        )
    return mesh


def carpet(material, width, depth):
    """A rug a centimetre thick; its picture covers it once."""
    body = box((-width / 2, -depth / 2, 0), (width / 2, depth / 2, 0.011), material, "bt")
    x, y = width / 2, depth / 2
    body.face(
        [(-x, -y, 0.011), (x, -y, 0.011), (x, y, 0.011), (-x, y, 0.011)], material, [(0, 0), (1, 0), (1, 1), (0, 1)]
    )
    return body


def runner(material, width, repeats):
    """A long carpet: the same picture, end to end."""
    body = Mesh()
    for i in range(repeats):
        body.append(carpet(material, width, width * 1.5), (0, width * 1.5 * (i - (repeats - 1) / 2), 0))
    return body


def clock():
    body = joined(
        box((-0.26, 0.01, 0), (0.26, 0.3, 0.4), "wood_dark"),
        box((-0.18, 0.01, 0.4), (0.18, 0.25, 1.55), "wood_dark"),
        box((-0.26, 0.01, 1.55), (0.26, 0.3, 2.1), "wood_dark"),
        box((-0.12, 0.25, 0.55), (0.12, 0.258, 1.4), "wood_light"),
    )
    face = lathe([(0.2, 0.0), (0.2, 0.012), (0.0, 0.012)], "ivory", 20).map(lambda p: (p[0], p[2] + 0.3, -p[1]))
    body.append(face, (0, 0, 1.82)).append(box((-0.008, 0.314, 1.82), (0.008, 0.318, 1.98), "ebony")).append(
        box((0, 0.314, 1.812), (0.11, 0.317, 1.826), "ebony")
    )
    return body.append(lathe([(0.04, 0.0), (0.06, 0.05), (0.0, 0.16)], "brass", 8), (0, 0.15, 2.1))


def globe():
    stand = joined(
        *[
            tube(
                [
                    (0.3 * math.cos(a), 0.3 * math.sin(a), 0.0),
                    (0.08 * math.cos(a), 0.08 * math.sin(a), 0.35),
                    (0.42 * math.cos(a), 0.42 * math.sin(a), 0.75),
                ],
                0.022,
                "wood_dark",
                4,
            )
            for a in (0.5, 2.6, 4.7)
        ]
    )
    ball = lathe(
        [(0.34 * math.sin(math.pi * i / 7), 0.34 - 0.34 * math.cos(math.pi * i / 7)) for i in range(8)], "old_map", 12
    )
    return joined(
        stand,
        lathe([(0.4, 0.73), (0.46, 0.73), (0.46, 0.77), (0.4, 0.77), (0.4, 0.73)], "wood_dark", 14),
        Mesh().append(ball, (0, 0, 0.44)),
    )


def harpsichord():
    plan = [(-0.5, -0.4), (0.5, -0.4), (0.5, 0.3), (0.3, 0.7), (0.0, 1.3), (-0.25, 1.6), (-0.5, 1.6)]
    body = joined(
        prism(plan, 0.68, 0.93, "wood_dark", ""),
        block((0.9, 0.16, 0.02), "ivory", (0, -0.5, 0.76)),
        block((1.0, 0.24, 0.08), "wood_dark", (0, -0.5, 0.68)),
        block((0.7, 0.02, 0.3), "wood_light", (0, -0.1, 0.95)),
    )
    for k in range(14):
        body.append(block((0.02, 0.09, 0.012), "ebony", (-0.4 + 0.062 * k, -0.46, 0.78)))
    for x, y in ((-0.42, -0.35), (0.42, -0.35), (-0.4, 1.45)):
        body.append(leg(0.68, "gold", 1.8, 10), (x, y, 0))
    lid = [(-0.5, 1.6, 0.94), (-0.5, -0.1, 0.94), (-0.05, -0.1, 1.65), (-0.15, 1.3, 1.5)]
    body.face(lid, "wood_light")
    body.face([(x + 0.01, y, z - 0.02) for x, y, z in lid[::-1]], "cloth_gold")
    return body


def harp():
    post = lathe([(0.05, 0.1), (0.035, 0.2), (0.03, 1.6), (0.06, 1.7), (0.0, 1.78)], "gold", 10)
    body = joined(
        Mesh().append(post, (0.45, 0, 0)),
        tube([(0.45, 0, 1.68), (0.2, 0, 1.5), (-0.05, 0, 1.55), (-0.3, 0, 1.35)], 0.04, "gold", 8),
        tube([(-0.3, 0, 1.35), (0.35, 0, 0.12)], [0.05, 0.12], "wood_light", 8),
        block((0.5, 0.3, 0.1), "gold", (0.38, 0, 0)),
    )
    for k in range(14):
        t = (k + 1) / 15
        x = -0.3 + 0.65 * t
        body.append(tube([(x, 0, 1.35 - 1.2 * t), (x + 0.06, 0, 1.5 + 0.08 * math.sin(3 * t))], 0.003, "brass", 3))
    return body


def easel(number=1):
    body = joined(
        tube([(-0.4, -0.25, 0), (0, 0, 1.9)], 0.02, "wood_light", 5),
        tube([(0.4, -0.25, 0), (0, 0, 1.9)], 0.02, "wood_light", 5),
        tube([(0, 0.6, 0), (0, 0, 1.8)], 0.02, "wood_light", 5),
    )
    canvas = painting(number, 0.9, 0.8).map(lambda p: (p[0], p[1] - 0.02 * p[2], p[2]))
    return body.append(canvas, (0, -0.05, 0.85), math.pi)


def potted_tree(kind=0):
    pot = lathe(
        [(0.2, 0.0), (0.22, 0.04), (0.28, 0.4), (0.32, 0.42), (0.32, 0.48), (0.27, 0.48), (0.0, 0.42)], "terracotta", 10
    )
    trunk = tube([(0, 0, 0.4), (0.02, 0.01, 0.9), (0, 0, 1.4)], [0.035, 0.03, 0.025], "wood_dark", 6)
    crown = (
        _crown(0.5, seed=kind)
        if kind % 2 == 0
        else lathe([(0.0, 0.7), (0.38, 0.75), (0.3, 1.2), (0.16, 1.8), (0.0, 2.3)], "leaves", 14)
    )
    return joined(pot, trunk, Mesh().append(crown, (0, 0, 1.35 if kind % 2 == 0 else 0)))


def _crown(radius, seed=0):
    """A clipped ball of leaves, a little uneven."""
    ball = lathe(
        [(radius * math.sin(math.pi * i / 7), radius - radius * math.cos(math.pi * i / 7)) for i in range(8)],
        "leaves",
        12,
    )
    return ball.map(lambda p: tuple(c * (1 + 0.05 * math.sin(9 * p[0] + 7 * p[1] * p[2] + seed)) for c in p))


def hedge(length=3.0):
    return block((length, 0.6, 0.8), "leaves", (0, 0, 0), "b")


def armour():
    """A suit of plate on a stand."""
    body = joined(prism(octagon(0.35), 0, 0.12, "wood_dark"))
    for x in (-0.11, 0.11):
        body.append(lathe([(0.055, 0.0), (0.075, 0.35), (0.055, 0.5), (0.09, 0.85)], "steel", 8), (x, 0.02, 0.12))
        body.append(block((0.1, 0.26, 0.07), "steel", (x, 0.1, 0.12)))
    body.append(
        lathe([(0.19, 0.0), (0.16, 0.15), (0.2, 0.35), (0.22, 0.5), (0.15, 0.6), (0.07, 0.63)], "steel", 12).map(
            lambda p: (p[0], p[1] * 0.75, p[2])
        ),
        (0, 0, 0.9),
    )
    body.append(
        lathe([(0.24, 0.0), (0.2, 0.12), (0.16, 0.16)], "steel", 10).map(lambda p: (p[0], p[1] * 0.8, p[2])),
        (0, 0, 0.78),
    )
    body.append(lathe([(0.08, 0.0), (0.11, 0.06), (0.115, 0.16), (0.09, 0.26), (0.0, 0.31)], "steel", 10), (0, 0, 1.5))
    body.append(box((-0.09, 0.1, 1.62), (0.09, 0.125, 1.65), "soot")).append(
        tube([(0, 0, 1.8), (0, -0.08, 1.98), (0, -0.22, 1.9)], [0.01, 0.05, 0.03], "cloth_red", 6)
    )
    for side in (-1, 1):
        body.append(lathe([(0.0, -0.06), (0.1, -0.03), (0.09, 0.05), (0.0, 0.09)], "steel", 7), (side * 0.25, 0, 1.42))
        body.append(
            tube(
                [(side * 0.27, 0, 1.4), (side * 0.31, 0.02, 1.12), (side * 0.24, 0.2, 0.98)],
                [0.06, 0.055, 0.045],
                "steel",
                6,
            )
        )
    return body.append(tube([(0.24, 0.22, 0.12), (0.24, 0.22, 2.2)], 0.015, "wood_dark", 6)).append(
        lathe([(0.02, 2.15), (0.05, 2.25), (0.0, 2.5)], "steel", 6), (0.24, 0.22, 0)
    )


def weapon_rack():
    body = joined(
        box((-0.9, 0.005, 0.5), (0.9, 0.08, 0.58), "wood_dark"), box((-0.9, 0.005, 1.5), (0.9, 0.08, 1.58), "wood_dark")
    )
    for k in range(9):
        x = -0.8 + 0.2 * k
        body.append(tube([(x, 0.12, 0.02), (x, 0.12, 2.1)], 0.014, "wood_light", 5))
        body.append(lathe([(0.02, 0.0), (0.045, 0.1), (0.0, 0.38)], "steel", 4, smooth=False), (x, 0.12, 2.05))
    return body


def trophy():
    """A shield before two crossed swords."""
    shield = [(-0.28, 0.5), (-0.26, 0.15), (0.0, -0.15), (0.26, 0.15), (0.28, 0.5)]
    mesh = Mesh()
    for tone, size, y in (("gold", 1.0, 0.05), ("cloth_blue", 0.86, 0.058)):
        points = [(x * size, y, 0.2 + (z - 0.2) * size) for x, z in shield]
        mesh.face(points[::-1], tone)
    for side in (-1, 1):
        mesh.append(tube([(side * 0.55, 0.03, -0.35), (-side * 0.45, 0.03, 0.75)], [0.02, 0.008], "steel", 4)).append(
            tube([(side * 0.55, 0.03, -0.18), (side * 0.38, 0.03, -0.32)], 0.018, "brass", 4)
        )
    return mesh

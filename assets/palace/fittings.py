"""Fixed fittings: columns, pilasters, balustrades, stairs, fireplaces, coffers, fonts, fountain, organ, altar."""

import math

from furniture import block, joined, octagon
from meshes import Mesh, box, lathe, prism, tube
from ornaments import candlestick, statue

BALUSTER = [(0.055, 0.0), (0.055, 0.06), (0.035, 0.1), (0.068, 0.27), (0.026, 0.55), (0.045, 0.7), (0.055, 0.82)]
RAIL_HEIGHT = 0.95


def column(height=4.0, radius=0.28, stone="marble_rose_plain", flutes=12):
    """A fluted column with Attic base and a bell capital."""
    base = joined(
        prism(
            [
                (-1.35 * radius, -1.35 * radius),
                (1.35 * radius, -1.35 * radius),
                (1.35 * radius, 1.35 * radius),
                (-1.35 * radius, 1.35 * radius),
            ],
            0,
            0.12,
            stone,
        ),
        lathe(
            [(1.32 * radius, 0.12), (1.35 * radius, 0.17), (1.15 * radius, 0.25), (1.02 * radius, 0.34)], stone, flutes
        ),
    )
    rows = []
    for share in (0.0, 0.02, 0.5, 0.98, 1.0):
        taper = radius * (1.0 - 0.14 * share**1.8)
        groove = 0.0 if share in (0.0, 1.0) else 0.09
        z = 0.34 + (height - 0.34 - 0.5) * share
        ring = []
        for i in range(2 * flutes):
            r = taper * (1.0 - groove * (i % 2))
            ring.append((r * math.cos(math.pi * i / flutes), r * math.sin(math.pi * i / flutes), z))
        rows.append(ring)
    shaft = Mesh()
    shaft.grid(rows, stone, closed=True, smooth=False)
    top = height - 0.5
    cap = lathe(
        [
            (0.86 * radius, 0.0),
            (0.95 * radius, 0.03),
            (0.86 * radius, 0.06),
            (0.95 * radius, 0.22),
            (1.3 * radius, 0.38),
        ],
        stone,
        flutes,
    )
    for k in range(8):
        a = math.pi / 4 * k
        leaf = tube(
            [
                (0.9 * radius * math.cos(a), 0.9 * radius * math.sin(a), 0.07),
                (1.1 * radius * math.cos(a), 1.1 * radius * math.sin(a), 0.26),
                (1.35 * radius * math.cos(a), 1.35 * radius * math.sin(a), 0.24),
            ],
            [0.06, 0.05, 0.02],
            "gold",
            4,
        )
        cap.append(leaf)
    half = 1.42 * radius
    slab = box((-half, -half, 0.38), (half, half, 0.5), stone)
    return joined(base, shaft, Mesh().append(cap, (0, 0, top)), Mesh().append(slab, (0, 0, top)))


def pillar(height=3.4, half=0.3, stone="stone_wall"):
    """A stout square pier of the cellars."""
    return joined(
        block((2.5 * half, 2.5 * half, 0.25), "stone_trim"),
        block((2 * half, 2 * half, height - 0.55), stone, (0, 0, 0.25), "bt"),
        block((2.6 * half, 2.6 * half, 0.3), "stone_trim", (0, 0, height - 0.3)),
    )


def pilaster(height=4.2, width=0.5, stone="stone_trim"):
    """A flat column on a wall."""
    w = width / 2
    return joined(
        box((-w - 0.06, 0.01, 0), (w + 0.06, 0.2, 0.35), stone),
        box((-w, 0.01, 0.35), (w, 0.13, height - 0.3), stone),
        box((-w + 0.09, 0.13, 0.6), (w - 0.09, 0.142, height - 0.55), stone),
        box((-w - 0.05, 0.01, height - 0.3), (w + 0.05, 0.19, height - 0.12), stone),
        box((-w - 0.1, 0.01, height - 0.12), (w + 0.1, 0.24, height), stone),
    )


def balustrade(length, stone="marble_white"):
    """A stretch of balusters along x about the origin, with plinth and hand rail."""
    count = max(2, round(length / 0.28))
    body = joined(
        box((-length / 2, -0.09, 0), (length / 2, 0.09, 0.06), stone),
        box((-length / 2, -0.1, 0.88), (length / 2, 0.1, RAIL_HEIGHT), stone),
    )
    turned = lathe(BALUSTER, stone, 7)
    for i in range(count):
        body.append(turned, (-length / 2 + length * (i + 0.5) / count, 0, 0.06))
    return body


def newel(stone="marble_white"):
    return joined(
        block((0.26, 0.26, 0.1), stone),
        block((0.2, 0.2, 0.8), stone, (0, 0, 0.1)),
        block((0.28, 0.28, 0.08), stone, (0, 0, 0.9)),
        lathe([(0.05, 0.98), (0.11, 1.06), (0.1, 1.14), (0.0, 1.2)], stone, 12),
    )


def flight(stair, lane_y, width, low, high, eastward, stone="marble_white"):
    """One flight of steps between two heights, in the world; its last riser meets the landing or the floor."""
    x0, x1 = stair.landing, stair.box[2]
    treads = stair.risers - 1
    rise = (high - low) / stair.risers
    body = Mesh()
    for i in range(treads):
        share0, share1 = i / treads, (i + 1) / treads
        a, b = (
            (x0 + (x1 - x0) * share0, x0 + (x1 - x0) * share1)
            if eastward
            else (x1 - (x1 - x0) * share1, x1 - (x1 - x0) * share0)
        )
        top = low + rise * (i + 1)
        under = max(low, top - rise - 0.22)
        body.append(
            box(
                (a, lane_y - width / 2, under), (b, lane_y + width / 2, top - 0.035), stone, "b" if under == low else ""
            )
        )
        nose = -0.03 if eastward else 0.0
        body.append(
            box((a + nose, lane_y - width / 2, top - 0.035), (b + nose + 0.03, lane_y + width / 2, top), "marble_dark")
        )
    return body


def fireplace(stone="marble_white"):
    """A chimney piece: pilasters, frieze, shelf, a fire in its mouth.  It stands before the wall."""
    body = Mesh()
    for x in (-0.8, 0.8):
        body.append(box((x - 0.16, 0.008, 0), (x + 0.16, 0.32, 0.14), stone)).append(
            box((x - 0.13, 0.008, 0.14), (x + 0.13, 0.28, 1.05), stone)
        ).append(box((x - 0.08, 0.28, 0.22), (x + 0.08, 0.3, 0.97), "marble_dark"))
    body.append(box((-0.95, 0.008, 1.05), (0.95, 0.3, 1.28), stone)).append(
        box((-0.35, 0.3, 1.09), (0.35, 0.32, 1.24), "marble_dark")
    ).append(box((-1.03, 0.008, 1.28), (1.03, 0.38, 1.35), stone))
    body.append(box((-0.67, 0.012, 0), (0.67, 0.02, 1.05), "soot")).append(
        box((-1.0, 0.32, 0), (1.0, 0.8, 0.03), "marble_dark")
    ).append(box((-0.67, 0.02, 0), (0.67, 0.32, 0.04), "soot"))
    for k in range(4):
        body.append(
            tube(
                [
                    (-0.35 + 0.05 * k, 0.1 + 0.05 * k, 0.1 + 0.05 * (k % 2)),
                    (0.35 - 0.04 * k, 0.2 - 0.03 * k, 0.12 + 0.05 * (k % 2)),
                ],
                0.05,
                "wood_dark",
                4,
            )
        )
    for k in range(5):
        body.append(
            lathe([(0.06, 0.0), (0.06, 0.1), (0.0, 0.34)], "flame" if k % 2 else "ember", 5),
            (-0.24 + 0.12 * k, 0.15, 0.14),
            0,
            (1, 0.6, 0.8 + 0.25 * (k % 3)),
        )
    body.append(candlestick(), (-0.75, 0.2, 1.351)).append(candlestick(), (0.75, 0.2, 1.351))
    return body


def coffer(width, depth, wood="plaster", rosette=True):
    """One frame of a coffered ceiling, hanging from z = 0: stepped ribs about a sunk field with a rosette."""
    mesh = Mesh()
    steps = [(0.0, -0.24), (0.1, -0.24), (0.14, -0.18), (0.2, -0.1), (0.27, -0.012)]
    rings = [
        [
            (-width / 2 + i, -depth / 2 + i, z),
            (width / 2 - i, -depth / 2 + i, z),
            (width / 2 - i, depth / 2 - i, z),
            (-width / 2 + i, depth / 2 - i, z),
        ]
        for i, z in steps
    ]
    for outer, inner in zip(rings, rings[1:]):
        for i in range(4):
            j = (i + 1) % 4
            mesh.face([outer[j], outer[i], inner[i], inner[j]], wood)
    if rosette:
        flower = lathe([(0.0, -0.09), (0.1, -0.06), (0.22, -0.012)], "gold", 10, smooth=False)
        mesh.append(
            flower.map(
                lambda p: (
                    p[0] * (1 + 0.1 * math.cos(6 * math.atan2(p[1], p[0]))),
                    p[1] * (1 + 0.1 * math.cos(6 * math.atan2(p[1], p[0]))),
                    p[2],
                )
            )
        )
    return mesh


def rose():
    """A stuccoed ceiling rose about z = 0."""
    body = lathe(
        [(0.1, -0.06), (0.2, -0.05), (0.24, -0.07), (0.5, -0.025), (0.56, -0.06), (0.7, -0.006)],
        "plaster",
        16,
        smooth=False,
    )
    for k in range(8):
        a = math.pi / 4 * k
        body.append(
            tube(
                [
                    (0.3 * math.cos(a), 0.3 * math.sin(a), -0.035),
                    (0.42 * math.cos(a + 0.1), 0.42 * math.sin(a + 0.1), -0.06),
                    (0.52 * math.cos(a), 0.52 * math.sin(a), -0.03),
                ],
                [0.01, 0.03, 0.01],
                "gold",
                3,
            )
        )
    return body


def altar():
    body = joined(
        box((-1.8, 0.02, 0), (1.8, 1.9, 0.18), "marble_dark"),
        box((-1.2, 0.5, 0.18), (1.2, 1.3, 1.1), "marble_white"),
        box((-1.3, 0.45, 1.1), (1.3, 1.35, 1.18), "marble_cream"),
        box((-1.0, 1.3, 0.3), (1.0, 1.315, 1.0), "cloth_gold"),
    )
    body.append(box((-1.3, 0.06, 0.18), (1.3, 0.4, 2.9), "marble_cream")).append(
        box((-1.5, 0.04, 2.9), (1.5, 0.5, 3.1), "gold")
    ).append(box((-0.8, 0.4, 1.4), (0.8, 0.41, 2.7), "cloth_blue"))
    for x in (-1.15, 1.15):
        body.append(
            lathe([(0.12, 0.0), (0.09, 0.08), (0.08, 1.5), (0.13, 1.66)], "marble_rose_plain", 14), (x, 0.55, 1.19)
        )
    for x in (-0.9, -0.5, 0.5, 0.9):
        body.append(candlestick(), (x, 0.9, 1.181), 0, (1.3, 1.3, 1.6))
    return body.append(block((0.07, 0.05, 1.0), "gold", (0, 0.9, 1.181))).append(
        block((0.5, 0.05, 0.07), "gold", (0, 0.9, 1.85))
    )


def organ():
    body = joined(
        box((-1.7, 0.02, 0), (1.7, 0.9, 1.1), "wood_dark"),
        box((-0.8, 0.9, 0.7), (0.8, 1.2, 0.8), "wood_dark"),
        box((-0.7, 0.95, 0.8), (0.7, 1.15, 0.83), "ivory"),
        box((-1.7, 0.02, 1.1), (1.7, 0.3, 3.2), "wood_dark"),
        box((-1.8, 0.01, 3.2), (1.8, 0.6, 3.4), "gold"),
    )
    for k in range(17):
        x = -1.5 + 3.0 * k / 16
        tall = 1.15 + 0.75 * abs(math.cos(math.pi * k / 8))
        body.append(
            lathe([(0.02, 0.0), (0.075, 0.2), (0.075, tall), (0.07, tall), (0.0, tall - 0.05)], "steel", 10),
            (x, 0.5, 1.101),
        )
    return body


def fountain():
    body = joined(
        lathe(
            [(2.3, 0.0), (2.35, 0.1), (2.25, 0.18), (2.25, 0.5), (2.4, 0.56), (2.4, 0.66), (2.05, 0.66), (2.0, 0.4)],
            "stone_trim",
            24,
        ),
        lathe([(2.02, 0.5), (0.0, 0.5)], "water", 24),
    )
    body.append(
        lathe(
            [
                (0.5, 0.4),
                (0.35, 0.7),
                (0.2, 0.9),
                (0.25, 1.3),
                (0.9, 1.55),
                (1.0, 1.7),
                (0.95, 1.72),
                (0.85, 1.62),
                (0.0, 1.6),
            ],
            "marble_white",
            24,
        )
    ).append(lathe([(0.86, 1.66), (0.0, 1.66)], "water", 20))
    body.append(
        lathe(
            [(0.2, 1.6), (0.12, 1.9), (0.16, 2.1), (0.45, 2.3), (0.5, 2.4), (0.4, 2.36), (0.0, 2.34)],
            "marble_white",
            20,
        )
    )
    figure = statue(1)
    return body.append(figure, (0, 0, 1.95), 0, (0.6, 0.6, 0.6))


def font():
    return joined(
        prism(octagon(0.6), 0, 0.15, "marble_dark"),
        prism(octagon(0.25), 0.15, 0.8, "marble_cream"),
        lathe([(0.25, 0.8), (0.55, 0.95), (0.6, 1.1), (0.5, 1.1), (0.42, 1.0), (0.0, 0.98)], "marble_cream", 8, False),
    )


def bath():
    rows = []
    for r, z in ((0.7, 0.0), (0.8, 0.05), (1.0, 0.6), (1.1, 0.72), (0.98, 0.72), (0.85, 0.5)):
        rows.append((r, z))
    tub = lathe(rows, "marble_white", 24).map(lambda p: (p[0] * 1.25, p[1] * 0.75, p[2]))
    return tub.append(lathe([(0.88, 0.55), (0.0, 0.55)], "water", 24), size=(1.25, 0.75, 1))


def sarcophagus():
    body = joined(
        box((-1.1, -0.5, 0), (1.1, 0.5, 0.15), "stone_trim"),
        box((-1.0, -0.42, 0.15), (1.0, 0.42, 0.8), "marble_cream"),
        box((-1.1, -0.5, 0.8), (1.1, 0.5, 0.92), "marble_dark"),
    )
    figure = statue(2, "marble_cream")
    lying = Mesh()
    lying.append(figure)
    lying.points = [(1.75 - p[2], p[0] * 0.8, max(p[1], -0.09) * 0.8 + 1.0) for p in lying.points]
    keep = [i for i, face in enumerate(lying.faces) if all(figure.points[k][2] >= 0.8 for k in face)]
    for name in ("faces", "uvs", "materials", "smooth"):
        setattr(lying, name, [getattr(lying, name)[i] for i in keep])
    return body.append(lying, (-0.1, 0, 0.0))


def stove():
    body = joined(
        box((-1.2, 0.01, 0), (1.2, 0.9, 0.85), "brick"),
        box((-1.25, 0.008, 0.85), (1.25, 0.95, 0.92), "iron"),
        box((-0.35, 0.9, 0.2), (0.35, 0.91, 0.6), "ember"),
    )
    hood = [(-1.25, 0.02, 1.9), (1.25, 0.02, 1.9), (1.25, 1.0, 1.9), (-1.25, 1.0, 1.9)]
    top = [(-0.4, 0.02, 3.2), (0.4, 0.02, 3.2), (0.4, 0.5, 3.2), (-0.4, 0.5, 3.2)]
    body.grid([hood, top], "plaster_warm", closed=True, smooth=False)
    for x, r in ((-0.8, 0.2), (-0.25, 0.16), (0.4, 0.22), (0.9, 0.14)):
        body.append(
            lathe(
                [(r * 0.9, 0.0), (r, 0.05), (r, 0.22), (r * 0.92, 0.22), (r * 0.9, 0.06), (0.0, 0.04)],
                "brass" if r > 0.15 else "iron",
                14,
            ),
            (x, 0.45, 0.921),
        )
    return body


def hanging_pots():
    body = tube([(-1.0, 0, -0.7), (1.0, 0, -0.7)], 0.02, "iron", 6)
    for x in (-0.9, 0.9):
        body.append(tube([(x, 0, -0.7), (x, 0, 0)], 0.01, "iron", 4))
    for k in range(7):
        r = 0.1 + 0.02 * (k % 3)
        body.append(
            lathe([(0.0, -0.16), (r, -0.14), (r * 1.05, 0.0), (r * 0.95, 0.0), (0.0, -0.1)], "brass", 12),
            (-0.84 + 0.28 * k, 0, -0.86),
        )
    return body

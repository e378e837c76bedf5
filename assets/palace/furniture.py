"""Furniture: seats, tables, beds, shelves, chests.  Every builder makes one mesh about its own origin, on the floor.

A piece that stands against a wall has its back at y = 0 and reaches into the room along +y; a free piece has its
middle at the origin; whoever sits on a seat looks along +y.
"""

import math

from meshes import Mesh, block, box, lathe, prism, tube

LEG = [(0.022, 0.0), (0.035, 0.1), (0.018, 0.16), (0.032, 0.42)]


def joined(*parts):
    mesh = Mesh()
    for part in parts:
        mesh.append(part)
    return mesh


def four(part, x, y):
    """A copy of a part at each corner of a rectangle."""
    mesh = Mesh()
    for sx in (-1, 1):
        for sy in (-1, 1):
            mesh.append(part, (sx * x, sy * y, 0.0))
    return mesh


def leg(height, material, thick=1.0, sides=5):
    return lathe([(r * thick, z * height / 0.42) for r, z in LEG], material, sides)


def cushion(width, depth, low, high, material):
    """An upholstered block with a rounded upper edge."""
    rows = []
    for inset, z in ((0.0, low), (-0.01, low + 0.35 * (high - low)), (0.015, low + 0.8 * (high - low)), (0.06, high)):
        x, y = width / 2 - inset, depth / 2 - inset
        rows.append([(-x, -y, z), (x, -y, z), (x, y, z), (-x, y, z)])
    mesh = Mesh()
    mesh.grid(rows, material, closed=True, smooth=False)
    mesh.face(rows[-1], material)
    return mesh


def chair(cloth, wood="wood_dark"):
    back = Mesh()
    for x in (-0.2, 0.2):
        back.append(tube([(x, -0.2, 0.0), (x, -0.19, 0.44), (x, -0.27, 1.02)], [0.024, 0.026, 0.02], wood, 4))
    back.append(_leaning(0.36, 0.5, 0.95, cloth)).append(block((0.44, 0.035, 0.07), wood, (0.0, -0.262, 0.95)))
    legs = Mesh().append(leg(0.42, wood), (-0.2, 0.2, 0)).append(leg(0.42, wood), (0.2, 0.2, 0))
    rails = joined(
        block((0.4, 0.03, 0.05), wood, (0, 0.2, 0.37)),
        block((0.03, 0.4, 0.05), wood, (-0.2, 0, 0.37)),
        block((0.03, 0.4, 0.05), wood, (0.2, 0, 0.37)),
    )
    return joined(back, legs, rails, cushion(0.48, 0.46, 0.41, 0.49, cloth))


def _leaning(width, low, high, cloth):
    """An upholstered back that follows the lean of a chair's posts."""

    def y(z):
        return -0.19 - 0.08 * (z - 0.44) / 0.58

    rows = [[(-width / 2, y(z), z), (width / 2, y(z), z)] for z in (low, high)]
    mesh = Mesh()
    front = [
        (rows[0][1][0], rows[0][1][1] + 0.03, low),
        (rows[0][0][0], rows[0][0][1] + 0.03, low),
        (rows[1][0][0], rows[1][0][1] + 0.03, high),
        (rows[1][1][0], rows[1][1][1] + 0.03, high),
    ]
    behind = [(x, yy - 0.055, z) for x, yy, z in front]
    mesh.face(front, cloth)
    mesh.face(behind[::-1], cloth)
    for i in range(4):
        j = (i + 1) % 4
        mesh.face([front[j], front[i], behind[i], behind[j]], cloth)
    return mesh


def armchair(cloth, wood="gold"):
    arms = Mesh()
    for x in (-0.31, 0.31):
        arms.append(tube([(x, -0.28, 0.62), (x, 0.1, 0.66), (x, 0.25, 0.6), (x, 0.27, 0.4)], 0.028, wood, 3))
    back = joined(block((0.6, 0.1, 0.6), cloth, (0, -0.3, 0.42)), block((0.68, 0.06, 0.08), wood, (0, -0.3, 1.02)))
    for x in (-0.33, 0.33):
        back.append(block((0.05, 0.08, 0.62), wood, (x, -0.3, 0.4)))
    crest = lathe([(0.0, 0.0), (0.12, 0.01), (0.1, 0.05), (0.04, 0.09), (0.0, 0.1)], wood, 8)
    return joined(
        four(leg(0.34, wood, 1.2), 0.29, 0.27),
        block((0.66, 0.62, 0.06), wood, (0, 0, 0.33)),
        cushion(0.62, 0.58, 0.39, 0.5, cloth),
        back,
        arms,
        Mesh().append(crest, (0, -0.3, 1.1), 0, (1, 0.3, 1)),
    )


def sofa(cloth, wood="gold"):
    """A settee with its back to the wall."""
    body = joined(
        block((1.8, 0.7, 0.08), wood, (0, 0.4, 0.28)),
        Mesh().append(cushion(1.7, 0.64, 0.36, 0.48, cloth), (0, 0.41, 0)),
        block((1.8, 0.12, 0.6), cloth, (0, 0.1, 0.4)),
        block((1.9, 0.08, 0.08), wood, (0, 0.1, 1.0)),
    )
    for x in (-0.86, 0.86):
        body.append(block((0.14, 0.66, 0.3), cloth, (x, 0.42, 0.36)))
        body.append(
            lathe([(0.08, -0.34), (0.09, 0.0), (0.08, 0.34)], cloth, 10).map(lambda p: (p[0], p[2], -p[1])),
            (x, 0.42, 0.67),
        )
    return body.append(four(leg(0.28, wood, 1.2), 0.82, 0.27), (0, 0.4, 0))


def stool(cloth, wood="wood_dark"):
    return joined(
        four(leg(0.38, wood, 1.0, 6), 0.17, 0.17),
        block((0.42, 0.42, 0.04), wood, (0, 0, 0.37)),
        cushion(0.44, 0.44, 0.41, 0.48, cloth),
    )


def bench(wood="wood_dark"):
    ends = Mesh()
    for x in (-0.65, 0.65):
        ends.append(block((0.07, 0.34, 0.42), wood, (x, 0, 0)))
    return joined(ends, block((1.6, 0.38, 0.05), wood, (0, 0, 0.42)), block((1.25, 0.04, 0.08), wood, (0, 0, 0.2)))


def pew():
    body = joined(
        block((2.2, 0.4, 0.05), "wood_dark", (0, 0, 0.43)),
        block((2.2, 0.05, 0.95), "wood_dark", (0, -0.22, 0.06)),
        block((2.24, 0.08, 0.05), "wood_dark", (0, -0.22, 1.01)),
        block((2.2, 0.2, 0.04), "wood_dark", (0, -0.36, 0.8)),
    )
    for x in (-1.13, 1.13):
        body.append(block((0.07, 0.56, 0.95), "wood_dark", (x, -0.03, 0)))
        body.append(lathe([(0.05, 0.95), (0.03, 0.99), (0.06, 1.04), (0.0, 1.12)], "wood_dark", 8), (x, 0.15, 0))
    return body


def throne():
    body = armchair("cloth_red", "gold").append(block((0.72, 0.07, 0.7), "cloth_red", (0, -0.31, 1.08)))
    for x in (-0.36, 0.36):
        body.append(
            lathe([(0.04, 0.0), (0.04, 1.7), (0.06, 1.74), (0.07, 1.82), (0.0, 1.92)], "gold", 10), (x, -0.31, 0)
        )
    return body.append(
        lathe([(0.2, 0.0), (0.24, 0.06), (0.1, 0.14), (0.13, 0.2), (0.0, 0.3)], "gold", 12),
        (0, -0.31, 1.78),
        0,
        (1, 0.3, 1),
    )


def round_table(radius=0.6, wood="wood_dark", top=None):
    stem = lathe([(0.3, 0.0), (0.28, 0.05), (0.1, 0.12), (0.07, 0.25), (0.12, 0.4), (0.06, 0.55), (0.2, 0.7)], wood, 10)
    disc = lathe([(radius - 0.04, 0.7), (radius, 0.72), (radius, 0.76), (0.0, 0.76)], top or wood, 20)
    return joined(stem, disc)


def table(width, depth, wood="wood_dark", height=0.76, thick=1.6):
    legs = four(leg(height - 0.05, wood, thick, 8), width / 2 - 0.1, depth / 2 - 0.1)
    apron = joined(
        block((width - 0.16, 0.03, 0.1), wood, (0, depth / 2 - 0.09, height - 0.14)),
        block((width - 0.16, 0.03, 0.1), wood, (0, -depth / 2 + 0.09, height - 0.14)),
        block((0.03, depth - 0.16, 0.1), wood, (width / 2 - 0.09, 0, height - 0.14)),
        block((0.03, depth - 0.16, 0.1), wood, (-width / 2 + 0.09, 0, height - 0.14)),
    )
    return joined(legs, apron, block((width, depth, 0.045), wood, (0, 0, height - 0.045)))


def dining_table():
    table_top = table(3.0, 1.15)
    for x in (-1.1, -0.4, 0.4, 1.1):
        for y in (-0.38, 0.38):
            table_top.append(lathe([(0.06, 0.0), (0.12, 0.015), (0.0, 0.012)], "porcelain", 10), (x, y, 0.761))
            table_top.append(goblet(), (x + 0.17, y * 0.8, 0.761))
    return table_top


def goblet():
    return lathe([(0.03, 0.0), (0.006, 0.012), (0.006, 0.07), (0.034, 0.15)], "crystal", 6)


def console(wood="gold"):
    """A gilded side table for the wall, with a marble top."""
    legs = Mesh()
    for x in (-0.48, 0.48):
        legs.append(
            tube(
                [(x, 0.34, 0.0), (x * 0.9, 0.3, 0.2), (x * 1.02, 0.4, 0.6), (x, 0.36, 0.82)],
                [0.03, 0.02, 0.035, 0.04],
                wood,
                8,
            )
        )
        legs.append(block((0.05, 0.05, 0.82), wood, (x, 0.06, 0)))
    return joined(
        legs,
        box((-0.52, 0.02, 0.74), (0.52, 0.4, 0.83), wood),
        box((-0.57, 0.012, 0.83), (0.57, 0.45, 0.87), "marble_dark"),
    )


def desk():
    drawers = Mesh()
    for x in (-0.55, 0.55):
        drawers.append(block((0.42, 0.68, 0.7), "wood_dark", (x, 0, 0.02)))
        for z in (0.06, 0.28, 0.5):
            for y in (-0.345, 0.345):
                drawers.append(block((0.36, 0.016, 0.18), "wood_light", (x, y, z)))
                drawers.append(block((0.06, 0.04, 0.02), "brass", (x, y, z + 0.09)))
    top = joined(
        block((1.65, 0.8, 0.05), "wood_dark", (0, 0, 0.72)), block((1.4, 0.58, 0.006), "leather", (0, 0, 0.77))
    )
    papers = joined(
        block((0.3, 0.21, 0.01), "cloth_white", (0.1, -0.05, 0.777)),
        lathe([(0.035, 0.777), (0.03, 0.83), (0.0, 0.83)], "ebony", 10).map(lambda p: (p[0] + 0.4, p[1] + 0.1, p[2])),
    )
    return joined(drawers, top, papers)


def billiard_table():
    legs = Mesh()
    for x in (-1.15, 0.0, 1.15):
        for y in (-0.55, 0.55):
            legs.append(leg(0.7, "wood_dark", 2.6, 8), (x, y, 0))
    rails = joined(
        box((-1.4, -0.8, 0.7), (1.4, -0.66, 0.86), "wood_dark"),
        box((-1.4, 0.66, 0.7), (1.4, 0.8, 0.86), "wood_dark"),
        box((-1.4, -0.66, 0.7), (-1.26, 0.66, 0.86), "wood_dark"),
        box((1.26, -0.66, 0.7), (1.4, 0.66, 0.86), "wood_dark"),
    )
    balls = Mesh()
    for x, y, tone in (
        (0.6, 0.1, "cloth_red"),
        (-0.5, -0.2, "ivory"),
        (-0.7, 0.25, "ivory"),
        (0.2, -0.4, "cloth_gold"),
    ):
        balls.append(
            lathe([(0.0, 0.0), (0.025, 0.009), (0.031, 0.03), (0.025, 0.051), (0.0, 0.06)], tone, 10), (x, y, 0.821)
        )
    return joined(legs, box((-1.26, -0.66, 0.7), (1.26, 0.66, 0.82), "cloth_green"), rails, balls)


def bed(cloth):
    """A bed with four turned posts and a tester; its head stands at the wall."""
    posts = Mesh()
    for x in (-0.85, 0.85):
        for y in (0.1, 2.1):
            posts.append(
                lathe(
                    [(0.07, 0.0), (0.07, 0.5), (0.04, 0.56), (0.06, 0.9), (0.035, 1.4), (0.05, 1.8), (0.05, 2.35)],
                    "wood_dark",
                    8,
                ),
                (x, y, 0),
            )
    body = joined(
        posts,
        box((-0.82, 0.08, 0.3), (0.82, 2.1, 0.5), "wood_dark"),
        box((-0.85, 0.05, 0.5), (0.85, 0.1, 1.4), "wood_dark"),
    )
    mattress = Mesh().append(cushion(1.6, 1.9, 0.5, 0.72, cloth), (0, 1.1, 0))
    for x in (-0.4, 0.4):
        mattress.append(cushion(0.66, 0.42, 0.7, 0.86, "cloth_white"), (x, 0.4, 0))
    tester = joined(
        box((-0.95, 0.02, 2.35), (0.95, 2.2, 2.45), "wood_dark"), box((-0.9, 0.05, 2.33), (0.9, 2.15, 2.35), cloth)
    )
    for x in (-0.93, 0.93):
        tester.append(valance((x, 0.06), (x, 2.16), cloth))
        tester.append(drape(0.45, 1.85, cloth, 4), (x * 0.985, 0.32, 0.46), math.pi / 2)
    return joined(body, mattress, tester, valance((-0.93, 2.16), (0.93, 2.16), cloth))


def valance(start, end, cloth, count=8):
    """A scalloped hanging about a tester's edge; it has two sides."""
    mesh = Mesh()
    for i in range(count):
        x0, y0 = (a + (b - a) * i / count for a, b in zip(start, end))
        x1, y1 = (a + (b - a) * (i + 1) / count for a, b in zip(start, end))
        xm, ym = (x0 + x1) / 2, (y0 + y1) / 2
        points = [(x0, y0, 2.22), (xm, ym, 2.13), (x1, y1, 2.22), (x1, y1, 2.36), (x0, y0, 2.36)]
        mesh.face(points, cloth)
        mesh.face(points[::-1], cloth)
    return mesh


def drape(width, height, cloth, folds=4, depth=0.04):
    """A hanging in folds along x, two-sided."""
    steps = folds * 3
    line = [
        (-width / 2 + width * i / steps, depth * math.sin(2 * math.pi * folds * i / steps)) for i in range(steps + 1)
    ]
    mesh = Mesh()
    for side in (1, -1):
        rows = [[(x, y + side * 0.004, z) for x, y in line[::side]] for z in (0.0, height)]
        mesh.grid(rows, cloth, smooth=True)
    return mesh


def curtain(cloth):
    """One wing of a window's curtain, held back at the waist, standing before the wall."""
    mesh = drape(0.42, 2.9, cloth, 4, 0.045)

    def held(point):
        x, y, z = point
        waist = math.exp(-(((z - 1.2) / 0.5) ** 2))
        return (x * (1 - 0.45 * waist) - 0.09 * waist, y + 0.13, z)

    rows = (0.0, 0.7, 1.2, 1.7, 2.9)
    return _restacked(mesh, rows).map(held).append(block((0.3, 0.1, 0.04), "gold", (-0.09, 0.13, 1.18)))


def _restacked(sheet, heights):
    """The same hanging with more rows."""
    mesh, half = Mesh(), len(sheet.points) // 2
    for first in (0, half):
        line = [p[:2] for p in sheet.points[first : first + half // 2]]
        mesh.grid([[(*p, z) for p in line] for z in heights], sheet.materials[0], smooth=True)
    return mesh


def bookshelf(height=2.3, wood="wood_dark"):
    width, depth, shelves = 1.2, 0.36, 6
    body = joined(
        box((-width / 2, 0.01, 0), (-width / 2 + 0.04, depth, height), wood),
        box((width / 2 - 0.04, 0.01, 0), (width / 2, depth, height), wood),
        box((-width / 2 + 0.04, 0.01, 0), (width / 2 - 0.04, 0.03, height - 0.02), wood),
        box((-0.66, 0.008, height), (0.66, depth + 0.05, height + 0.08), wood),
        box((-0.63, 0.009, 0), (0.63, depth + 0.03, 0.1), wood),
    )
    step = (height - 0.14) / shelves
    for i in range(shelves):
        z = 0.1 + i * step
        body.append(box((-width / 2 + 0.04, 0.03, z), (width / 2 - 0.04, depth - 0.02, z + 0.025), wood))
        body.append(_books(z + 0.026, step - 0.09, i))
    return body


def _books(z, height, seed):
    """A shelf of volumes in runs of several heights; their backs wear the picture of backs of books."""
    mesh, x, i = Mesh(), -0.555, seed * 7
    while x < 0.44:
        wide, top, deep = (
            0.17 + 0.02 * (i * 5 % 4),
            z + height * (0.78 + 0.05 * (i * 3 % 5)),
            0.26 + 0.012 * (i * 7 % 4),
        )
        x1, u = min(x + wide, 0.555), (i * 0.137) % 0.8
        mesh.face(
            [(x1, deep, z), (x, deep, z), (x, deep, top), (x1, deep, top)],
            "books",
            [(u + x1 - x, 0.02), (u, 0.02), (u, 0.76), (u + x1 - x, 0.76)],
        )
        mesh.face([(x, 0.04, top), (x1, 0.04, top), (x1, deep, top), (x, deep, top)], "cloth_white")
        if i % 4 == 3:
            mesh.face([(x1, 0.04, z), (x1, deep, z), (x1, deep, top), (x1, 0.04, top)], "leather")
        x, i = x1 + (0.05 if i % 4 == 3 else 0.003), i + 1
    return mesh


def wardrobe():
    body = joined(
        box((-0.7, 0.01, 0.08), (0.7, 0.6, 2.1), "wood_light"),
        box((-0.75, 0.008, 2.1), (0.75, 0.65, 2.22), "wood_dark"),
        box((-0.74, 0.009, 0.0), (0.74, 0.63, 0.1), "wood_dark"),
    )
    for x in (-0.34, 0.34):
        for z0, z1 in ((0.2, 1.0), (1.1, 2.0)):
            body.append(box((x - 0.27, 0.6, z0), (x + 0.27, 0.62, z1), "wood_dark", "n"))
            body.append(box((x - 0.22, 0.62, z0 + 0.05), (x + 0.22, 0.635, z1 - 0.05), "wood_light"))
    return body.append(
        lathe([(0.0, 0.0), (0.02, 0.01), (0.025, 0.03), (0.0, 0.04)], "brass", 8).map(
            lambda p: (p[0], p[2] + 0.62, -p[1])
        ),
        (-0.04, 0, 1.05),
    )


def chest(wood="wood_dark"):
    lid = Mesh()
    arc = [(0.28 + 0.27 * math.cos(a), 0.45 + 0.2 * math.sin(a)) for a in (math.pi * i / 8 for i in range(9))]
    lid.grid([[(-0.5, y, z) for y, z in arc], [(0.5, y, z) for y, z in arc]][::-1], wood, smooth=True)
    for x, flip in ((-0.5, -1), (0.5, 1)):
        lid.face([(x, y, z) for y, z in arc][::-flip], wood)
    bands = joined(*[box((x - 0.03, 0.003, 0), (x + 0.03, 0.556, 0.452), "iron", "b") for x in (-0.35, 0.35)])
    return joined(
        box((-0.5, 0.01, 0.0), (0.5, 0.55, 0.45), wood), lid, bands, block((0.12, 0.02, 0.14), "brass", (0, 0.56, 0.34))
    )


def cabinet():
    """A porcelain cabinet: open shelves with bowls and jars in a gilded case."""
    body = joined(
        box((-0.6, 0.01, 0), (0.6, 0.45, 0.75), "wood_dark"),
        box((-0.6, 0.01, 0.75), (-0.56, 0.38, 2.1), "gold"),
        box((0.56, 0.01, 0.75), (0.6, 0.38, 2.1), "gold"),
        box((-0.56, 0.01, 0.75), (0.56, 0.03, 2.08), "cloth_red"),
        box((-0.65, 0.008, 2.1), (0.65, 0.45, 2.2), "gold"),
    )
    for k, z in enumerate((0.76, 1.21, 1.66)):
        if k:
            body.append(box((-0.56, 0.03, z - 0.02), (0.56, 0.34, z), "wood_dark"))
        for i, x in enumerate((-0.4, -0.13, 0.14, 0.41)):
            jar = (
                [(0.05, 0.0), (0.1, 0.14), (0.05, 0.24), (0.06, 0.28)]
                if (i + k) % 2
                else [(0.03, 0.0), (0.1, 0.11), (0.11, 0.13)]
            )
            body.append(lathe(jar, "porcelain" if (i + 2 * k) % 3 else "cobalt", 6), (x, 0.2, z + 0.001))
    return body


def shelves():
    """Plain shelves with jars, loaves and boxes."""
    body = joined(*[box((x - 0.03, 0.01, 0), (x + 0.03, 0.4, 1.95), "wood_light") for x in (-0.8, 0.8)])
    for k, z in enumerate((0.3, 1.0, 1.7)):
        body.append(box((-0.77, 0.01, z), (0.77, 0.42, z + 0.03), "wood_light"))
        for i in range(4):
            x, tone = -0.6 + 0.4 * i, ("terracotta", "porcelain", "brass", "terracotta")[(i + k) % 4]
            body.append(
                lathe([(0.07, 0.0), (0.1, 0.15), (0.05, 0.27), (0.06, 0.3)], tone, 6),
                (x, 0.2, z + 0.031),
                0,
                (1, 1, 0.7 + 0.1 * ((i * 3 + k) % 4)),
            )
    return body


def barrel():
    profile = [(0.31, 0.0), (0.36, 0.2), (0.38, 0.45), (0.36, 0.7), (0.31, 0.9), (0.3, 0.86), (0.0, 0.86)]
    body = lathe(profile, "wood_light", 12, smooth=False)
    for z, r in ((0.1, 0.343), (0.24, 0.372), (0.62, 0.376), (0.78, 0.349)):
        body.append(lathe([(r, z - 0.025), (r + 0.004, z + 0.025)], "iron", 12))
    return body


def cask():
    """A great barrel lying on trestles, its head to the room."""
    lying = barrel().map(lambda p: (p[0] * 1.5, (p[2]) * 1.5 + 0.06, p[1] * -1.5 + 0.85))
    return joined(
        lying,
        box((-0.5, 0.25, 0), (0.5, 0.37, 0.34), "wood_dark"),
        box((-0.5, 1.0, 0), (0.5, 1.12, 0.34), "wood_dark"),
        tube([(0, 1.33, 0.45), (0, 1.46, 0.45), (0, 1.47, 0.38)], 0.02, "brass", 6),
    )


def crate():
    body = block((0.7, 0.5, 0.5), "wood_light", (0, 0, 0.0))
    for y in (-0.255, 0.255):
        for z in (0.02, 0.4):
            body.append(block((0.72, 0.02, 0.09), "wood_dark", (0, y, z)))
    return body


def sack():
    return lathe(
        [(0.2, 0.0), (0.28, 0.08), (0.27, 0.3), (0.17, 0.5), (0.07, 0.56), (0.1, 0.64), (0.0, 0.6)], "cloth_white", 10
    )


def wine_rack():
    body = joined(box((-0.8, 0.01, 0), (0.8, 0.03, 1.9), "wood_dark"))
    for x in (-0.8, -0.4, 0.0, 0.4, 0.76):
        body.append(box((x, 0.03, 0), (x + 0.04, 0.4, 1.9), "wood_dark"))
    for k in range(6):
        z = 0.05 + 0.31 * k
        body.append(box((-0.78, 0.03, z), (0.78, 0.38, z + 0.02), "wood_light"))
        for i in range(7):
            x = -0.62 + 0.2 * i - (0.05 if i % 2 == 0 else 0.0)
            bottle = lathe([(0.04, 0.1), (0.04, 0.3), (0.015, 0.36), (0.0, 0.44)], "marble_dark", 5)
            body.append(bottle.map(lambda p: (p[0], p[2], -p[1])), (x, 0.0, z + 0.075))
    return body


def work_table():
    body = table(2.2, 0.9, "wood_light", 0.85, 2.2)
    for x, r in ((-0.8, 0.13), (-0.4, 0.1), (0.5, 0.15)):
        body.append(
            lathe([(r * 0.7, 0.0), (r, 0.05), (r, 0.16), (r * 0.95, 0.16), (r * 0.9, 0.05), (0.0, 0.03)], "brass", 12),
            (x, 0.1, 0.851),
        )
    return body.append(block((0.5, 0.3, 0.03), "wood_dark", (0.05, -0.2, 0.851)))


def folding_screen(cloth):
    body = Mesh()
    for i, turn in enumerate((0.5, -0.5, 0.5)):
        panel = joined(
            block((0.6, 0.03, 1.7), cloth, (0, 0, 0.08)),
            block((0.64, 0.045, 0.06), "gold", (0, 0, 1.78)),
            block((0.64, 0.045, 0.06), "gold", (0, 0, 0.03)),
        )
        body.append(panel, ((i - 1) * 0.54, 0, 0), turn)
    return body


def octagon(radius):
    return [(radius * math.cos(a), radius * math.sin(a)) for a in (math.pi / 8 + math.pi / 4 * i for i in range(8))]


def plinth(height=1.0, half=0.26, stone="marble_dark"):
    return joined(
        prism(octagon(half * 1.2), 0, 0.12, stone),
        prism(octagon(half), 0.12, height - 0.1, stone),
        prism(octagon(half * 1.15), height - 0.1, height, stone, ""),
    )

"""The pieces that move: door leaves, guards, clock hands, a train, birds, fish.  Mesh data; plain Python, no Blender."""

import math

from geometry import bounds, clip_half_plane, distinct
from meshes import Mesh, block, box, lathe, prism, tube

LEAF = 0.06  # thickness of a door's leaf
BEAD = 0.012


def joined(*parts):
    mesh = Mesh()
    for part in parts:
        mesh.append(part)
    return mesh


def rod(x0, x1, y, z, radius, material, sides=6):
    return tube([(x0, y, z), (x1, y, z)], radius, material, sides)


# ---- doors ---------------------------------------------------------------------------------------------------------


def leaf(outline, material):
    """One leaf: an outline (u from the hinge, height), LEAF thick behind its front; panels and a handle on both faces."""
    mesh = Mesh()
    front = [(u, 0.0, z) for u, z in outline]
    back = [(u, -LEAF, z) for u, z in outline]
    mesh.face(front[::-1], material)
    mesh.face(back, material)
    for i in range(len(outline)):
        j = (i + 1) % len(outline)
        mesh.face([front[i], front[j], back[j], back[i]], material)
    u0, z0, u1, z1 = bounds(outline)
    rim = 0.12
    for low, high in ((z0 + rim, z0 + 0.42 * (z1 - z0)), (z0 + 0.42 * (z1 - z0) + rim, z0 + 0.78 * (z1 - z0))):
        for y0, y1 in ((0.0, BEAD), (-LEAF - BEAD, -LEAF)):
            mesh.append(box((u0 + rim, y0, low), (u1 - rim, y1, high), "wood_light"))
    far = u1 - 0.07 if abs(u1) > abs(u0) else u0 + 0.07
    for y in (0.045, -LEAF - 0.045):
        mesh.append(tube([(far, y - 0.0451 if y > 0 else y + 0.0451, 1.05), (far, y, 1.05)], 0.012, "brass", 5))
        mesh.append(lathe([(0.0, -0.03), (0.028, -0.012), (0.028, 0.012), (0.0, 0.03)], "brass", 7), (far, y, 1.05))
    return mesh


def half_outline(points, left):
    """The part of an outline (u, height) on one side of its middle."""
    return distinct(clip_half_plane(list(points), (0.0, 0.0), (-1.0, 0.0) if left else (1.0, 0.0)))


def revolving(radius, height):
    """Four wings about an axle, glazed in brass frames."""
    mesh = lathe([(0.05, 0.0), (0.05, height), (0.0, height + 0.04)], "brass", 10)
    for k in range(4):
        wing = joined(
            box((0.05, -0.02, 0.0), (radius, 0.02, 0.5), "wood_dark"),
            box((0.05, -0.02, height - 0.12), (radius, 0.02, height), "wood_dark"),
            box((radius - 0.07, -0.02, 0.5), (radius, 0.02, height - 0.12), "wood_dark"),
            box((0.05, -0.015, 1.05), (radius - 0.07, 0.015, 1.15), "brass"),
        )
        mesh.append(wing, (0, 0, 0), k * math.pi / 2)
    return mesh


# ---- people --------------------------------------------------------------------------------------------------------


def guard(coat="cloth_blue"):
    """A guard of 1.8 m who looks along +y: boots, breeches, coat, belt, head, hat, and a lantern in his right hand."""
    body = Mesh()
    for side in (-1, 1):
        x = 0.1 * side
        body.append(tube([(x, 0.0, 0.0), (x, 0.0, 0.42)], [0.085, 0.07], "leather", 8))
        body.append(block((0.13, 0.26, 0.09), "leather", (x, 0.05, 0.0)))
        body.append(tube([(x, 0.0, 0.4), (x * 0.9, 0.0, 0.85)], [0.075, 0.1], "cloth_white", 8))
    coat_rows = [(0.25, 0.62), (0.23, 0.85), (0.19, 1.0), (0.22, 1.22), (0.24, 1.38), (0.13, 1.5), (0.07, 1.53)]
    body.append(lathe(coat_rows, coat, 14), (0, 0, 0), 0, (1.0, 0.72, 1.0))
    body.append(lathe([(0.205, 0.97), (0.215, 1.0), (0.205, 1.04)], "leather", 14), (0, 0, 0), 0, (1.0, 0.75, 1.0))
    body.append(block((0.07, 0.03, 0.07), "brass", (0, 0.155, 0.97)))
    for i in range(4):
        body.append(block((0.025, 0.02, 0.025), "brass", (0.0, 0.165, 1.1 + 0.08 * i)))
    for side in (-1, 1):
        hand = (0.27 * side, 0.3 if side > 0 else 0.04, 1.08 if side > 0 else 0.8)
        body.append(tube([(0.23 * side, 0, 1.4), (0.3 * side, 0.02, 1.12), hand], [0.075, 0.06, 0.045], coat, 8))
        body.append(lathe([(0.0, -0.05), (0.045, 0.0), (0.0, 0.06)], "wax", 7), hand)
        body.append(lathe([(0.09, -0.02), (0.1, 0.02), (0.0, 0.05)], "gold", 9), (0.22 * side, 0, 1.41), 0, (1, 0.8, 1))
    body.append(lathe([(0.055, 1.5), (0.055, 1.57)], "wax", 8))
    body.append(
        lathe([(0.0, 0.0), (0.07, 0.03), (0.095, 0.12), (0.09, 0.2), (0.0, 0.26)], "wax", 12), (0, 0.01, 1.53)
    )
    body.append(lathe([(0.2, 0.0), (0.2, 0.015), (0.11, 0.03), (0.1, 0.13), (0.0, 0.15)], "ebony", 12), (0, 0.0, 1.7))
    body.append(block((0.04, 0.06, 0.03), "wax", (0, 0.115, 1.63)))
    lantern = joined(
        block((0.13, 0.13, 0.02), "iron", (0, 0, 0.0)),
        block((0.1, 0.1, 0.14), "flame", (0, 0, 0.02)),
        block((0.13, 0.13, 0.02), "iron", (0, 0, 0.16)),
        lathe([(0.055, 0.18), (0.0, 0.22)], "iron", 6),
        tube([(0, 0, 0.21), (0, 0, 0.27)], 0.008, "iron", 4),
    )
    return body.append(lantern, (0.27, 0.33, 0.8))


# ---- clocks --------------------------------------------------------------------------------------------------------


def clock_case():
    """A wall clock: case, ivory dial with twelve marks; its back in the plane y = 0, dial at the origin, looking to +y."""
    dial = lathe([(0.21, 0.0), (0.21, 0.012), (0.0, 0.012)], "ivory", 24).map(lambda p: (p[0], p[2] + 0.09, -p[1]))
    case = joined(
        box((-0.27, 0.01, -0.27), (0.27, 0.09, 0.27), "wood_dark"),
        box((-0.16, 0.01, -0.95), (0.16, 0.03, -0.27), "wood_dark"),
    )
    case.append(lathe([(0.08, 0.0), (0.1, 0.04), (0.0, 0.18)], "gold", 8), (0, 0.05, 0.27), 0, (1, 0.4, 1))
    case.append(dial)
    for k in range(12):
        a = 2 * math.pi * k / 12
        case.append(block((0.014, 0.004, 0.03), "ebony", (0.175 * math.sin(a), 0.104, 0.175 * math.cos(a) - 0.015)))
    return case


def clock_hand(length, width):
    """A hand from the dial's middle upwards, with a short tail."""
    return joined(
        box((-width / 2, -0.002, -0.03), (width / 2, 0.002, length), "ebony"),
        lathe([(0.012, -0.004), (0.012, 0.006), (0.0, 0.008)], "brass", 8).map(lambda p: (p[0], p[2], -p[1])),
    )


def pendulum():
    """Hangs from the origin."""
    bob = lathe([(0.0, -0.012), (0.07, -0.006), (0.07, 0.006), (0.0, 0.012)], "brass", 14)
    return joined(box((-0.006, -0.004, -0.5), (0.006, 0.004, 0.0), "brass")).append(
        bob.map(lambda p: (p[0], p[2], -p[1])), (0, 0, -0.52)
    )


# ---- toys ----------------------------------------------------------------------------------------------------------


def engine():
    """A toy locomotive of 0.6 m that runs along +y."""
    mesh = joined(
        box((-0.11, -0.3, 0.07), (0.11, 0.3, 0.12), "iron"),
        box((-0.12, -0.28, 0.12), (0.12, -0.06, 0.36), "cloth_green"),
        box((-0.14, -0.3, 0.36), (0.14, -0.03, 0.39), "iron"),
    )
    boiler = lathe([(0.0, 0.0), (0.1, 0.0), (0.1, 0.33), (0.07, 0.36), (0.0, 0.36)], "steel", 12)
    mesh.append(boiler.map(lambda p: (p[0], p[2] - 0.07, p[1] + 0.22)))
    mesh.append(lathe([(0.03, 0.3), (0.03, 0.42), (0.055, 0.46), (0.0, 0.46)], "iron", 9), (0, 0.2, 0))
    mesh.append(lathe([(0.04, 0.3), (0.04, 0.35), (0.0, 0.38)], "brass", 9), (0, 0.05, 0))
    mesh.append(lathe([(0.0, 0.0), (0.035, 0.01), (0.0, 0.03)], "flame", 8), (0, 0.3, 0.3))
    return _wheels(mesh, (-0.2, 0.0, 0.2))


def wagon(material="cloth_red"):
    """A wagon of 0.45 m."""
    mesh = joined(
        box((-0.11, -0.22, 0.07), (0.11, 0.22, 0.11), "iron"),
        box((-0.12, -0.21, 0.11), (0.12, 0.21, 0.33), material),
        box((-0.135, -0.225, 0.33), (0.135, 0.225, 0.36), "wood_white"),
    )
    for y in (-0.12, 0.0, 0.12):
        for x in (-0.1205, 0.1205):
            mesh.append(box((x - 0.001, y - 0.04, 0.2), (x + 0.001, y + 0.04, 0.29), "flame"))
    return _wheels(mesh, (-0.14, 0.14))


def _wheels(mesh, places):
    wheel = lathe([(0.0, -0.015), (0.06, -0.015), (0.06, 0.015), (0.0, 0.015)], "iron", 12)
    wheel.map(lambda p: (p[2], p[0], p[1]))
    for y in places:
        for x in (-0.105, 0.105):
            mesh.append(wheel, (x, y, 0.06))
    return mesh


def bird():
    """A small bird that flies along +y, wings spread."""
    body = tube([(0, -0.12, 0), (0, -0.05, 0.01), (0, 0.05, 0.01), (0, 0.12, 0.0)], [0.005, 0.035, 0.035, 0.004], "porcelain", 7)
    for side in (-1, 1):
        for upward in (0, 1):
            wing = [(0.02 * side, 0.05, 0.012), (0.2 * side, 0.0, 0.05), (0.17 * side, -0.06, 0.045), (0.02 * side, -0.05, 0.012)]
            body.face(wing if (side > 0) == bool(upward) else wing[::-1], "cobalt")
    for flip in (0, 1):
        tail = [(-0.035, -0.19, 0.0), (0.035, -0.19, 0.0), (0.005, -0.1, 0.002), (-0.005, -0.1, 0.002)]
        body.face(tail[::-1] if flip else tail, "cobalt")
    return body


def fish():
    """A carp of 0.3 m along +y."""
    body = tube([(0, -0.13, 0), (0, -0.02, 0), (0, 0.08, 0), (0, 0.15, 0)], [0.012, 0.05, 0.045, 0.005], "terracotta", 8)
    for flip in (0, 1):
        tail = [(0, -0.2, 0.05), (0, -0.2, -0.05), (0, -0.12, 0.0)]
        body.face(tail[::-1] if flip else tail, "gold")
    return body


def wonder(kind):
    """What floats over a plinth: a crystal, a ring within a ring, a planet, a knot of bars."""
    if kind == 0:
        return joined(lathe([(0.0, -0.2), (0.12, -0.02), (0.12, 0.04), (0.0, 0.2)], "crystal", 6, smooth=False))
    if kind == 1:
        ring = tube([(0.17 * math.cos(a), 0.17 * math.sin(a), 0) for a in _turn(16)], 0.014, "gold", 5)
        upright = tube([(0.13 * math.cos(a), 0, 0.13 * math.sin(a)) for a in _turn(16)], 0.012, "steel", 5)
        return joined(ring, upright, lathe([(0.0, -0.05), (0.05, 0.0), (0.0, 0.05)], "ember", 8))
    if kind == 2:
        ball = [(0.12 * math.sin(math.pi * i / 8), -0.12 * math.cos(math.pi * i / 8)) for i in range(9)]
        return joined(lathe(ball, "old_map", 14), tube([(0.2 * math.cos(a), 0.2 * math.sin(a), 0.0) for a in _turn(16)], 0.01, "brass", 5))
    bars = [tube([(-0.16, y, z), (0.16, y, z)], 0.016, "cobalt", 6) for y, z in ((0.06, 0.06), (-0.06, -0.06))]
    bars += [tube([(x, y, -0.16), (x, y, 0.16)], 0.016, "gold", 6) for x, y in ((0.06, -0.06), (-0.06, 0.06))]
    return joined(*bars, lathe([(0.0, -0.07), (0.07, 0.0), (0.0, 0.07)], "porcelain", 8))


def _turn(count):
    return [2 * math.pi * i / count for i in range(count + 1)]


def plinth():
    return joined(
        block((0.5, 0.5, 0.1), "marble_dark"),
        block((0.4, 0.4, 0.82), "marble_white", (0, 0, 0.1)),
        block((0.48, 0.48, 0.08), "marble_dark", (0, 0, 0.92)),
    )


# ---- treasures -----------------------------------------------------------------------------------------------------


def crown():
    band = lathe([(0.12, 0.0), (0.125, 0.05), (0.115, 0.05), (0.11, 0.0)], "gold", 14)
    for k in range(7):
        a = 2 * math.pi * k / 7
        spike = lathe([(0.02, 0.0), (0.02, 0.05), (0.0, 0.1)], "gold", 5)
        band.append(spike, (0.115 * math.cos(a), 0.115 * math.sin(a), 0.045))
        band.append(lathe([(0.0, -0.015), (0.015, 0.0), (0.0, 0.015)], "ember", 5), (0.127 * math.cos(a), 0.127 * math.sin(a), 0.025))
    return band


def chalice():
    return lathe([(0.08, 0.0), (0.075, 0.02), (0.02, 0.05), (0.02, 0.14), (0.075, 0.18), (0.09, 0.28), (0.0, 0.2)], "gold", 14)


def sceptre():
    return joined(
        tube([(-0.3, 0, 0.05), (0.3, 0, 0.05)], 0.018, "gold", 8),
        lathe([(0.0, -0.05), (0.05, 0.0), (0.0, 0.05)], "cobalt", 8).map(lambda p: (p[2] + 0.33, p[1], p[0] + 0.05)),
    )


def figurine(material):
    return lathe([(0.09, 0.0), (0.08, 0.03), (0.04, 0.05), (0.06, 0.16), (0.075, 0.25), (0.03, 0.3), (0.05, 0.35), (0.0, 0.42)], material, 12)


def casket():
    return joined(
        box((-0.18, -0.12, 0.0), (0.18, 0.12, 0.16), "wood_dark"),
        prism([(-0.18, -0.12), (0.18, -0.12), (0.18, 0.12), (-0.18, 0.12)], 0.16, 0.22, "wood_light", ""),
        box((-0.02, -0.125, 0.1), (0.02, -0.12, 0.18), "brass"),
    )


def folio():
    return joined(
        box((-0.16, -0.22, 0.0), (0.16, 0.22, 0.06), "leather"),
        box((-0.15, -0.21, 0.012), (0.165, 0.21, 0.048), "ivory"),
    )


def key():
    ring = tube([(0.045 * math.cos(a) - 0.1, 0.045 * math.sin(a), 0.015) for a in _turn(12)], 0.011, "brass", 5)
    return joined(
        ring,
        tube([(-0.055, 0, 0.015), (0.1, 0, 0.015)], 0.011, "brass", 6),
        box((0.06, -0.05, 0.008), (0.075, 0.0, 0.022), "brass"),
        box((0.085, -0.06, 0.008), (0.1, 0.0, 0.022), "brass"),
    )


def switch():
    """A brass plate with a button, its back in the plane y = 0."""
    button = lathe([(0.03, 0.0), (0.028, 0.02), (0.0, 0.025)], "ember", 10).map(lambda p: (p[0], p[2] + 0.015, -p[1]))
    return joined(box((-0.06, 0.002, -0.1), (0.06, 0.015, 0.1), "brass")).append(button)


def platform(width, depth):
    return joined(
        box((-width / 2, -depth / 2, -0.12), (width / 2, depth / 2, 0.0), "planks"),
        box((-width / 2 - 0.03, -depth / 2 - 0.03, -0.14), (width / 2 + 0.03, -depth / 2, 0.02), "brass"),
        box((-width / 2 - 0.03, depth / 2, -0.14), (width / 2 + 0.03, depth / 2 + 0.03, 0.02), "brass"),
        box((-width / 2 - 0.03, -depth / 2, -0.14), (-width / 2, depth / 2, 0.02), "brass"),
        box((width / 2, -depth / 2, -0.14), (width / 2 + 0.03, depth / 2, 0.02), "brass"),
    )

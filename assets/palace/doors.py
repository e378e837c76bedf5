"""Doors: leaves that swing or slide and close their openings whole; which of them are locked, and by what."""

import math

import moving
from geometry import add, bounds, scale, snap_point
from openings import outline
from tour import ROUTE

GROWN = 0.02  # a leaf reaches this far into jamb and floor, so that no light falls past it
BUTTERY = "buttery_door"
LOCKED = {  # rooms whose doors want a key: room -> key; "1": only a button opens it
    "Treasury": "gold",
    "RelicRoom": "silver",
    "Dungeon": "iron",
    "Buttery": "1",
}
CELLAR_SPEED = 0.8  # metres a second of a door that slides


def gltf(x, y, z):
    """A vector of Blender's axes as text in glTF's."""
    return f"{x:g},{z:g},{-y:g}"


def tour_pairs():
    return {frozenset(pair) for pair in zip(ROUTE, ROUTE[1:])}


def has_doors(portal):
    """Doors hang in openings that the recorded walk does not take, and that are no arcade."""
    kind = portal.kind
    if not kind or kind.sill > 0.0 or kind.width > 2.01 or "Courtyard" in (portal.source, portal.target):
        return False
    return frozenset((portal.source, portal.target)) not in tour_pairs()


def leaf_outlines(kind):
    """(hinge u, outline from the hinge, angle) of each leaf: one for narrow openings, else two."""
    grown = grown_outline(kind)
    half = kind.width / 2
    if kind.width < 1.25:
        return [(-half, [(u + half, z) for u, z in grown], 92.0)]
    left, right = moving.half_outline(grown, True), moving.half_outline(grown, False)
    return [(-half, [(u + half, z) for u, z in left], 88.0), (half, [(u - half, z) for u, z in right], -88.0)]


def grown_outline(kind):
    """The outline of an opening, a little beyond jambs, floor and lintel."""
    return [
        (u + math.copysign(GROWN, u) if abs(u) > 1e-6 else u, z + (GROWN if z > 1e-6 else -GROWN)) for u, z in outline(kind)
    ]


def lock_of(portal):
    return next((LOCKED[room] for room in (portal.source, portal.target) if room in LOCKED), None)


def slides(portal):
    """Cellar doors run on rails into the thickness of the wall."""
    return portal.kind.frame == "stone_trim" and portal.centre[2] < 0.0


def extras_of(portal, number):
    lock = lock_of(portal)
    extras = {
        "auto_close": 0.0 if lock == "1" else 4.0,
        "targetname": BUTTERY if lock == "1" else f"door_{number}",
        "portal": f"{portal.target}*{number}-portal",
    }
    return extras | ({"locked": lock} if lock else {})


def place_leaf(scene, portal, name, mesh, hinge, extras):
    """A leaf whose origin lies `hinge` along its opening."""
    along = (portal.normal[1], -portal.normal[0])
    # Its middle lies in the opening's plane: what closes a portal stands before it on either side.
    at = add(add(portal.centre[:2], scale(along, hinge)), scale(portal.normal[:2], moving.LEAF / 2))
    turn = math.atan2(along[1], along[0])
    scene.child(portal.source, name, scene.mesh(name, mesh), snap_point((*at, portal.centre[2])), turn, extras)


def hang(scene, portals):
    """Every leaf as a mover; returns how many."""
    count = 0
    for number, portal in enumerate(portals):
        if has_doors(portal):
            count += slide(scene, portal, number) if slides(portal) else swing(scene, portal, number)
    return count


def slide(scene, portal, number):
    """One leaf of planks that runs sideways into the wall."""
    mesh = moving.leaf(grown_outline(portal.kind), "planks")
    u0, _, u1, _ = bounds(grown_outline(portal.kind))
    along = scale((portal.normal[1], -portal.normal[0]), u1 - u0)
    extras = {"classname": "func_door", "move": gltf(*along, 0.0), "speed": CELLAR_SPEED} | extras_of(portal, number)
    place_leaf(scene, portal, f"door_{number}_0", mesh, 0.0, extras)
    return 1


def swing(scene, portal, number):
    """One leaf or two on hinges; they swing both ways, away from who opens them."""
    stone = portal.kind.frame == "stone_trim"
    leaves = leaf_outlines(portal.kind)
    for side, (hinge, shape, angle) in enumerate(leaves):
        mesh = moving.leaf(shape, "planks" if stone else "wood_white")
        if len(leaves) == 2 and side == 0:
            astragal(mesh, portal.kind, shape)
        extras = {"classname": "func_door_rotating", "angle": angle, "swing_low": abs(angle), "speed": 100.0} | extras_of(portal, number)
        place_leaf(scene, portal, f"door_{number}_{side}", mesh, hinge, extras)
    return len(leaves)


def astragal(mesh, kind, shape):
    """A strip over the seam of two leaves, on both faces of the first."""
    half = kind.width / 2
    top = max(z for u, z in shape if u > half - 0.3)
    for y0, y1 in ((0.0, 0.014), (-moving.LEAF - 0.014, -moving.LEAF)):
        mesh.append(moving.box((half - 0.03, y0, -GROWN), (half + 0.03, y1, top - GROWN), "wood_light"))

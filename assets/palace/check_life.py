"""Checks what moves in the exported palace, and that the game in it can be played to its end.  Used by check.py.

Movers enough of each kind; leaves of doors cover their openings; guards and the guided tour keep to floors, rooms and doors and
touch nothing; every key, button, exhibit and the way out can be reached on foot, without a key that lies behind its own lock.
"""

import csv
import math
import re
from collections import Counter

import openings
import plan
from geometry import bounds, cross, depth_inside, dot, length, lerp, scale, sub, unit
from placing import distance
from tour import STAIRS

FEWEST_MOVERS = 200
LEAST = {
    "npc_guard": 14,
    "prop_exhibit": 8,
    "func_door_rotating": 40,
    "func_door": 4,
    "item_key": 3,
    "func_plat": 1,
    "func_button": 3,
    "trigger_exit": 1,
}
EYE = 1.7
SHOULDER = 0.2  # metres that a guard's path keeps from corners of pieces
SLACK = 0.001  # no piece is thinner
BODY = 0.36  # of a visitor, and what he must have beside him: half his width, and a little to spare
STEP = 0.25  # of the grid on which a room is walked
KNEE = 0.39  # what is lower is stepped on
ARM = 1.5  # how far a visitor takes things from
SEAM = 0.001  # metres between two leaves that nothing is seen through; the compiler's too
PROBES = 12  # a side, points of an opening at which a leaf must stand
ON_FOOT = {frozenset((s.lower, s.upper)) for s in STAIRS} | {frozenset(("BarrelRampFoot", "BarrelRampHead"))}
SLOPING = {room for pair in ON_FOOT for room in pair}


def check(glb, near, river):
    """Problems; `near` holds the corners of pieces by square metre, as check.py collects them; `river` is a file."""
    rooms = {room.name: room for room in plan.rooms()}
    portals = openings.resolve(rooms)
    problems = check_counts(glb) + check_doors(glb) + check_rounds(glb, rooms, portals, near)
    problems += check_river(river, rooms, portals, near)
    return problems + check_reach(glb, rooms, portals) + check_floors(glb, rooms, portals)


def extras(node):
    return node.get("extras", {})


def of_class(glb, name):
    return [(i, node) for i, node in enumerate(glb.nodes) if extras(node).get("classname") == name]


def room_of(glb, index):
    while index is not None and not glb.nodes[index]["name"].endswith("-room"):
        index = glb.parents.get(index)
    return glb.nodes[index]["name"][:-5] if index is not None else None


def plan_point(glb, index, point=(0.0, 0.0, 0.0)):
    """A node's point: x east, y north, z up."""
    x, y, z = glb.to_world(index, point)
    return (x, -z, y)


# ---- counts and doors --------------------------------------------------------------------------------------------------


def check_counts(glb):
    animated = {c["target"]["node"] for a in glb.json.get("animations", ()) for c in a["channels"]}
    classes = Counter(extras(node).get("classname", "") for node in glb.nodes)
    moving = sum(
        i in animated or re.match("(func|prop|item|npc)_", extras(node).get("classname", "")) is not None
        for i, node in enumerate(glb.nodes)
    )
    problems = [] if moving >= FEWEST_MOVERS else [f"only {moving} things move"]
    return problems + [f"{classes[kind]} of {kind}, at least {n} wanted" for kind, n in LEAST.items() if classes[kind] < n]


def check_doors(glb):
    """Every door names a portal, its leaves cover it, and something opens it if it is locked."""
    problems, leaves = [], {}
    portals = {node["name"]: i for i, node in enumerate(glb.nodes) if node["name"].endswith("-portal")}
    keys = {extras(node)["key"] for _, node in of_class(glb, "item_key")}
    pressed = {extras(node).get("target") for _, node in of_class(glb, "func_button")}
    for i, node in of_class(glb, "func_door_rotating") + of_class(glb, "func_door"):
        more = extras(node)
        if more.get("portal") not in portals:
            problems.append(f"{node['name']}: there is no portal {more.get('portal')}")
            continue
        leaves.setdefault(more["portal"], []).append(i)
        lock = more.get("locked")
        if lock and lock not in keys and not (lock == "1" and more.get("targetname") in pressed):
            problems.append(f"{node['name']}: nothing opens it")
    for name, doors in leaves.items():
        gap = uncovered(glb, portals[name], doors)
        if gap:
            problems.append(f"{name}: its leaves leave it open at {gap}")
    return problems


def uncovered(glb, portal, doors):
    """A point of a portal before which no leaf stands, in the portal's plane; None if all is covered."""
    triangles = [[glb.to_world(portal, p) for p in t] for t in glb.triangles(glb.nodes[portal]["mesh"])]
    origin, corner, third = triangles[0]
    across = unit(sub(corner, origin))
    normal = unit(cross(sub(corner, origin), sub(third, origin)))
    upward = cross(normal, across)

    def flat(p):
        return (dot(sub(p, origin), across), dot(sub(p, origin), upward))

    wood = [[flat(glb.to_world(i, p)) for p in t] for i in doors for t in glb.triangles(glb.nodes[i]["mesh"])]
    for t in triangles:
        a, b, c = map(flat, t)
        for i in range(PROBES + 1):
            for j in range(PROBES + 1 - i):
                p = lerp(lerp(a, b, i / PROBES), c, j / max(PROBES - i, 1) if i < PROBES else 0.0)
                if not any(inside(w, p) for w in wood):
                    return tuple(round(v, 3) for v in p)
    return None


def inside(triangle, p):
    sides = [
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
        for a, b in zip(triangle, triangle[1:] + triangle[:1])
    ]
    reach = SEAM * max(math.dist(a, b) for a, b in zip(triangle, triangle[1:] + triangle[:1]))
    return min(sides) >= -reach or max(sides) <= reach


# ---- rounds ------------------------------------------------------------------------------------------------------------


def places(glb, index):
    """The keys of a node's translation, in the plan."""
    for animation in glb.json.get("animations", ()):
        for channel in animation["channels"]:
            if channel["target"] == {"node": index, "path": "translation"}:
                rows = glb.accessor(animation["samplers"][channel["sampler"]]["output"])
                return [(x, -z, y) for x, y, z in rows]
    return []


def check_rounds(glb, rooms, portals, near):
    problems = []
    doors = [p for p in portals if p.kind and p.kind.sill == 0.0]
    start = rooms[room_of(glb, of_class(glb, "info_player_start")[0][0])]
    for index, node in of_class(glb, "npc_guard"):
        keys = places(glb, index)
        if len(keys) < 4:
            problems.append(f"{node['name']}: does not walk")
        if any(start.floor <= p[2] + 0.1 < start.ceiling and depth_inside(start.footprint, p[:2]) > 0 for p in keys):
            problems.append(f"{node['name']}: comes where the visitor begins")
        for p, q in zip(keys, keys[1:]):
            steps = max(1, round(length(sub(q, p)) / 0.1))
            trouble = next((t for t in (trouble_at(lerp(p, q, k / steps), rooms, doors, near) for k in range(steps + 1)) if t), None)
            if trouble:
                problems.append(f"{node['name']}: {trouble}")
                break
    return problems


def check_river(path, rooms, portals, near):
    """The guided tour closes, keeps to rooms and doors, and touches nothing."""
    doors = [p for p in portals if p.kind and p.kind.sill == 0.0]
    rows = [[float(v) for v in row.values()] for row in csv.DictReader(open(path, encoding="ascii"))]
    feet = [(x, -z, y - EYE) for x, y, z, *_ in rows]
    problems = [] if math.dist(feet[0], feet[-1]) < 3.0 else ["the river does not close"]
    for p, q in zip(feet, feet[1:]):
        trouble = next((t for t in (trouble_at(lerp(p, q, k / 4), rooms, doors, near) for k in range(4)) if t), None)
        if trouble:
            problems.append(f"the river: {trouble}")
    return problems


def trouble_at(foot, rooms, doors, near):
    """What is wrong with standing there, or None."""
    room = next((r for r in rooms.values() if r.floor - 0.6 <= foot[2] < r.ceiling and depth_inside(r.footprint, foot[:2]) > 0.15), None)
    spot = tuple(round(v, 2) for v in foot)
    if not room and not any(in_doorway(foot, door) for door in doors):
        return f"is in no room and in no door at {spot}"
    if room and room.name not in SLOPING and abs(foot[2] - room.floor) > 0.02:
        return f"does not stand on the floor at {spot}"
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            for x, y, z, name in near.get((math.floor(foot[0]) + i, math.floor(foot[1]) + j), ()):
                if foot[2] + 0.45 < z < foot[2] + 1.8 and math.hypot(x - foot[0], y - foot[1]) < SHOULDER:
                    return f"walks into {name} at {spot}"
    return None


def in_doorway(foot, door):
    away = sub(foot[:2], door.centre[:2])
    sideways = away[0] * door.normal[1] - away[1] * door.normal[0]
    level = abs(foot[2] - door.centre[2]) < 0.6
    return level and abs(dot(away, door.normal[:2])) < 0.75 and abs(sideways) < door.kind.width / 2 - 0.2


# ---- reach -------------------------------------------------------------------------------------------------------------


def check_reach(glb, rooms, portals):
    """The visitor goes from room to room, takes keys, presses buttons, until nothing more opens."""
    locks = {}
    for _, node in of_class(glb, "func_door_rotating") + of_class(glb, "func_door"):
        if "locked" in extras(node):
            locks[extras(node)["portal"]] = (extras(node)["locked"], extras(node).get("targetname"))
    ways = [(*pair, None) for pair in map(tuple, ON_FOOT)]
    for number, portal in enumerate(portals):
        if portal.kind and portal.kind.sill == 0.0:
            ways.append((portal.source, portal.target, locks.get(f"{portal.target}*{number}-portal")))
    start = room_of(glb, of_class(glb, "info_player_start")[0][0])
    things = [(room_of(glb, i), extras(node)) for kind in ("item_key", "func_button") for i, node in of_class(glb, kind)]
    reached, before = {start}, None
    while before != len(reached):
        before = len(reached)
        held = {more.get("key") or more.get("target") for room, more in things if room in reached}
        for a, b, lock in ways:
            if (a in reached or b in reached) and (lock is None or lock[0] in held or lock[1] in held):
                reached |= {a, b}
    problems = [f"{name}: cannot be reached" for name in rooms if name not in reached]
    for kind in ("prop_exhibit", "item_key", "func_button", "trigger_exit"):
        problems += [f"{n['name']}: out of reach" for i, n in of_class(glb, kind) if room_of(glb, i) not in reached]
    return problems


def check_floors(glb, rooms, portals):
    """In every room, its doors and what is to be taken there are joined by floor wide enough for a body."""
    standing = outlines(glb, rooms)
    problems = []
    for name, room in rooms.items():
        if name in SLOPING:
            continue
        goals = [(f"door to {there}", at, 0.75) for there, at in doors_of(name, portals)]
        for kind in ("prop_exhibit", "item_key", "func_button"):
            goals += [(n["name"], plan_point(glb, i)[:2], ARM) for i, n in of_class(glb, kind) if room_of(glb, i) == name]
        problems += [f"{name}: no way to {goal}" for goal in unreached(room, standing.get(name, []), goals)]
    return problems


def doors_of(name, portals):
    """The rooms behind the doors of a room, and a point of its own floor before each."""
    for portal in portals:
        if portal.kind and portal.kind.sill == 0.0 and name in (portal.source, portal.target):
            inward = scale(portal.normal, -0.8 if portal.source == name else 0.8)
            yield portal.target if portal.source == name else portal.source, (
                portal.centre[0] + inward[0],
                portal.centre[1] + inward[1],
            )


def outlines(glb, rooms):
    """Rectangles in the plan about all that stands at the height of a body, by room."""
    boxes, result = {}, {}
    for i, node in enumerate(glb.nodes):
        name = node["name"].split("_")[0]
        if "mesh" not in node or name not in rooms or re.search(r"(_shell|_trim|-portal)$", node["name"]):
            continue
        if node["mesh"] not in boxes:
            corners = [p for t in glb.triangles_of(node["mesh"]) for p in t]
            boxes[node["mesh"]] = [(min(axis) - SLACK, max(axis) + SLACK) for axis in zip(*corners)]
        (x0, x1), (y0, y1), (z0, z1) = boxes[node["mesh"]]
        ring = [plan_point(glb, i, (x, y0, z)) for x, z in ((x0, z1), (x1, z1), (x1, z0), (x0, z0))]
        bottom, top = ring[0][2], ring[0][2] + y1 - y0
        if bottom < rooms[name].floor + 1.6 and top > rooms[name].floor + KNEE:
            result.setdefault(name, []).append([p[:2] for p in ring])
    return result


def unreached(room, solids, goals):
    """Names of the goals (name, point, arm) that cannot be come near to from the first of them."""
    xs, ys = zip(*room.footprint)
    free, rings = set(), [(bounds(s), s) for s in solids]
    for i in range(math.floor(min(xs) / STEP), math.ceil(max(xs) / STEP) + 1):
        for j in range(math.floor(min(ys) / STEP), math.ceil(max(ys) / STEP) + 1):
            p = (i * STEP, j * STEP)
            if depth_inside(room.footprint, p) > BODY - 0.05 and not any(touches(box, ring, p) for box, ring in rings):
                free.add((i, j))
    near = [[c for c in free if math.dist((c[0] * STEP, c[1] * STEP), at) < arm] for _, at, arm in goals]
    todo = near[0][:] if near else []
    seen = set(todo)
    while todo:
        i, j = todo.pop()
        for cell in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            if cell in free and cell not in seen:
                seen.add(cell)
                todo.append(cell)
    return [name for (name, _, _), cells in zip(goals, near) if not seen & set(cells)]


def touches(box, ring, p):
    """Whether a body at p touches a convex outline; `box` is the outline's, for speed."""
    near = box[0] - BODY <= p[0] <= box[2] + BODY and box[1] - BODY <= p[1] <= box[3] + BODY
    return near and distance(ring, p) <= BODY

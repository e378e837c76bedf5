#!/usr/bin/env python3
"""Checks the exported palace: assets/palace/check.py [palace.glb] [tour.csv].  Plain Python, no Blender.

Rooms enough, triangles enough, a file small enough; every piece inside its room and off the walk; every portal planar,
convex and facing out of its room; every cell closed: each edge of shell and portals, on a grid of 1/4096 m, is run
through as often one way as the other.  What moves, check_life.py looks at; how dark the night is,
check_night.py.
"""

import csv
import math
import re
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import check_life  # noqa: E402
import check_night  # noqa: E402
import openings  # noqa: E402
import plan  # noqa: E402
from geometry import cross, depth_inside, dot, newell, scale, sub, unit  # noqa: E402
from glb import Glb  # noqa: E402
from openings import WELLS  # noqa: E402

GRID = 4096
PLANAR = 2.0 / GRID  # corners are snapped, so an oblique portal may leave its plane by about one step of the grid
SLACK = 0.001
SHOULDER = 0.25
MOST_BYTES, FEWEST_ROOMS, FEWEST_TRIANGLES = 12 * 1024 * 1024, 60, 300_000


def snapped(point):
    return tuple(round(value * GRID) for value in point)


def main():
    glb = Glb(sys.argv[1] if len(sys.argv) > 1 else HERE / "palace.glb")
    tour = Path(sys.argv[2] if len(sys.argv) > 2 else HERE.parents[1] / "maps" / "palace" / "tour.csv")
    rooms = {node["name"][:-5]: i for i, node in enumerate(glb.nodes) if node["name"].endswith("-room")}
    portals = read_portals(glb, rooms)
    problems = check_sizes(glb, rooms) + check_portals(glb, rooms, portals) + check_closed(glb, rooms, portals)
    trouble, near = check_pieces(glb)
    problems += trouble + check_way(tour, near) + check_life.check(glb, near, tour.with_name("river.csv"))
    problems += check_lights(glb, rooms) + check_spawn(glb) + check_tour(tour)
    problems += check_night.check(glb, openings.resolve({room.name: room for room in plan.rooms()}))
    for problem in problems:
        print("FAIL:", problem)
    print(
        f"{len(rooms)} rooms, {len(portals)} portals, {instanced_triangles(glb)} triangles, {glb.size} bytes, "
        f"{len(problems)} problems"
    )
    return 1 if problems else 0


def read_portals(glb, rooms):
    """(name, source, target, corners in the world in order)."""
    portals = []
    for i, node in enumerate(glb.nodes):
        match = re.fullmatch(r"(\w+)\*\d+-portal", node["name"])
        if match:
            source = glb.nodes[glb.parents[i]]["name"][:-5]
            corners = [glb.to_world(i, p) for p in outline(list(glb.triangles(node["mesh"])))]
            portals.append((node["name"], source, match.group(1), corners))
    return portals


def outline(triangles):
    """The boundary of a triangulated polygon, in order."""
    following = _border(triangles)
    start = min(following)
    ring = [start]
    while following[ring[-1]] != start:
        ring.append(following[ring[-1]])
    return ring


def _border(triangles):
    directed = {(p, q) for t in triangles for p, q in zip(t, t[1:] + t[:1])}
    return {p: q for p, q in directed if (q, p) not in directed}


def instanced_triangles(glb):
    return sum(
        glb.triangle_count(node["mesh"])
        for node in glb.nodes
        if "mesh" in node and not node["name"].endswith("-portal")
    )


def check_sizes(glb, rooms):
    problems = []
    if len(rooms) < FEWEST_ROOMS:
        problems.append(f"only {len(rooms)} rooms")
    if instanced_triangles(glb) < FEWEST_TRIANGLES:
        problems.append(f"only {instanced_triangles(glb)} triangles")
    if glb.size > MOST_BYTES:
        problems.append(f"{glb.size} bytes")
    return problems


def check_portals(glb, rooms, portals):
    problems = []
    middles = {name: shell_middle(glb, room) for name, room in rooms.items()}
    for name, source, target, corners in portals:
        if source not in rooms or target not in rooms or source == target:
            problems.append(f"{name}: joins {source} and {target}")
            continue
        if not 3 <= len(corners) <= 32:
            problems.append(f"{name}: {len(corners)} corners")
        normal = unit(newell([tuple(c) for c in corners]))
        if max(abs(dot(sub(c, corners[0]), normal)) for c in corners) > PLANAR:
            problems.append(f"{name}: not planar")
        if not convex(corners, normal):
            problems.append(f"{name}: not convex")
        middle = scale([sum(axis) for axis in zip(*corners)], 1.0 / len(corners))
        if dot(sub(middle, middles[source]), normal) <= 0:
            problems.append(f"{name}: does not face out of {source}")
    return problems


def convex(corners, normal):
    count = len(corners)
    return all(
        dot(cross(sub(corners[(i + 1) % count], corners[i]), sub(corners[(i + 2) % count], corners[i])), normal) > 1e-7
        for i in range(count)
    )


def shell_node(glb, room):
    return next(c for c in glb.nodes[room]["children"] if glb.nodes[c]["name"].endswith("_shell"))


def shell_middle(glb, room):
    """Middle of the box about a room's shell: every room here is convex in plan but for its tunnels."""
    node = shell_node(glb, room)
    points = [glb.to_world(node, p) for t in glb.triangles(glb.nodes[node]["mesh"]) for p in t]
    return [(min(axis) + max(axis)) / 2 for axis in zip(*points)]


def check_closed(glb, rooms, portals):
    problems = []
    for name, room in rooms.items():
        node = shell_node(glb, room)
        edges = Counter()
        for triangle in glb.triangles(glb.nodes[node]["mesh"]):
            count_edges(edges, [glb.to_world(node, p) for p in triangle])
        for _, source, target, corners in portals:
            if name == target:
                count_edges(edges, corners)
            elif name == source:
                count_edges(edges, corners[::-1])
        loose = [edge for edge, times in edges.items() if times]
        if loose:
            problems.append(f"{name}: {len(loose)} open edges, one at {[v / GRID for v in loose[0][0]]}")
    return problems


def count_edges(edges, points):
    corners = [snapped(p) for p in points]
    for p, q in zip(corners, corners[1:] + corners[:1]):
        if p < q:
            edges[p, q] += 1
        elif q < p:
            edges[q, p] -= 1


def check_pieces(glb):
    """Every piece stands inside its room. Also the corners of all pieces, by square metre of the plan."""
    problems, near = [], {}
    plans = {room.name: room for room in plan.rooms() if not room.section}
    wells = {end for well in WELLS for end in (well.lower, well.upper)}
    for name, corners in pieces(glb):
        room = plans.get(name.split("_")[0])
        if room is None:
            continue
        margin = -0.25 if "balustrade" in name or "stair" in name else 0.0
        top = room.ceiling + (0.5 if room.name in wells else 0.0)
        for x, y, z in corners:
            if depth_inside(room.footprint, (x, y)) < margin or not room.floor - SLACK <= z <= top + SLACK:
                problems.append(f"{name}: reaches out of its room at {(x, y, z)}")
                break
        for x, y, z in corners:
            near.setdefault((math.floor(x), math.floor(y)), []).append((x, y, z, name))
    return problems, near


def pieces(glb):
    """(name, corners: x east, y north, z up) of every mesh that is no shell, moulding or portal."""
    for i, node in enumerate(glb.nodes):
        if "mesh" in node and not re.search(r"(_shell|_trim|-portal)$", node["name"]):
            corners = {p for triangle in glb.triangles_of(node["mesh"]) for p in triangle}
            yield node["name"], [(x, -z, y) for x, y, z in (glb.to_world(i, p) for p in corners)]


def check_way(tour, near):
    """No corner of a piece between knee and eye comes nearer than a shoulder's width to the walker."""
    met = {}
    for row in csv.DictReader(open(tour, encoding="ascii")):
        x, y, eye = float(row["x"]), -float(row["z"]), float(row["y"])
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                for px, py, pz, name in near.get((math.floor(x) + i, math.floor(y) + j), ()):
                    if eye - 1.2 < pz < eye + 0.1 and math.hypot(px - x, py - y) < SHOULDER:
                        met.setdefault(name, (round(x, 2), round(y, 2)))
    return [f"{name}: in the walker's way at {at}" for name, at in sorted(met.items())]


def check_lights(glb, rooms):
    lit = {glb.parents[i] for i, node in enumerate(glb.nodes) if "KHR_lights_punctual" in node.get("extensions", {})}
    lit |= {glb.parents.get(i) for i in lit}
    return [f"{name}: no light" for name, room in rooms.items() if room not in lit]


def check_spawn(glb):
    starts = [n for n in glb.nodes if n.get("extras", {}).get("classname") == "info_player_start"]
    return [] if len(starts) == 1 else [f"{len(starts)} player starts"]


def check_tour(path):
    rows = [[float(v) for v in row.values()] for row in csv.DictReader(open(path, encoding="ascii"))]
    problems = [] if len(rows) >= 1800 else [f"tour of {len(rows)} rows"]
    for a, b in zip(rows, rows[1:]):
        if math.dist(a[1:4], b[1:4]) > 2.5 * (b[0] - a[0]) + 1e-3:
            problems.append(f"tour: faster than a walk at {a[0]} s")
    return problems


if __name__ == "__main__":
    sys.exit(main())

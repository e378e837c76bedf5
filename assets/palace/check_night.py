"""Checks the night of the exported palace: darkness enough to hide in, where guards walk and along every way.  Used by check.py.

Light is counted as the guards' eyes count it (game/sim/sight.c), from the lamps of a room alone: what comes through doors is more.
"""

import math

import plan
from check_life import ON_FOOT, extras, of_class, places, plan_point, room_of
from geometry import depth_inside

GRID = 0.5  # metres between the points of floor that are looked at
CHEST = 1.0  # over the floor
DARK = 0.3  # of the usual light: there a guard sees a quarter of what he would see by lamps
SHADY, GLOOMY = 0.15, 0.5  # shares of a floor in the dark
OPEN_ROOMS = 2  # a way leads through so many rooms without a dark corner at most
LEAST_SHADY = 60


def check(glb, portals):
    rooms = {room.name: room for room in plan.rooms()}
    lamps = lamps_of(glb)
    usual = sum(light_at(lamps[name], (*middle(room), room.floor + CHEST)) for name, room in rooms.items()) / len(rooms)
    share = {name: dark_share(room, lamps[name], DARK * usual) for name, room in rooms.items()}
    shady = sum(value > SHADY for value in share.values())
    print(f"{shady} rooms with dark corners, {sum(value > GLOOMY for value in share.values())} dark by half or more")
    problems = [] if shady >= LEAST_SHADY else [f"only {shady} rooms have dark corners"]
    return problems + check_rounds(glb, rooms, share) + check_ways(glb, rooms, portals, share)


def middle(room):
    xs, ys = zip(*room.footprint)
    return ((min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2)


def lamps_of(glb):
    """By room: (place in the plan, brightness, range) of every lamp."""
    kinds = glb.json["extensions"]["KHR_lights_punctual"]["lights"]
    lamps = {room.name: [] for room in plan.rooms()}
    for i, node in enumerate(glb.nodes):
        number = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if number is not None:
            kind = kinds[number]
            red, green, blue = kind.get("color", (1.0, 1.0, 1.0))
            bright = kind["intensity"] * (0.2126 * red + 0.7152 * green + 0.0722 * blue)
            lamps[room_of(glb, i)].append((plan_point(glb, i), bright, kind.get("range", math.inf)))
    return lamps


def light_at(lamps, at):
    total = 0.0
    for place, bright, reach in lamps:
        square = max(math.dist(place, at) ** 2, 0.25)
        total += bright / square * max(0.0, 1.0 - square / reach**2)
    return total


def dark_share(room, lamps, limit):
    """The share of a room's floor on which less light than the limit falls."""
    xs, ys = zip(*room.footprint)
    points = [
        (min(xs) + GRID * (i + 0.5), min(ys) + GRID * (j + 0.5))
        for i in range(int((max(xs) - min(xs)) / GRID))
        for j in range(int((max(ys) - min(ys)) / GRID))
    ]
    points = [p for p in points if depth_inside(room.footprint, p) > 0.25]
    return sum(light_at(lamps, (*p, room.floor + CHEST)) < limit for p in points) / len(points)


def check_rounds(glb, rooms, share):
    """On every guard's round lies a room that is dark by half or more."""
    problems = []
    for index, node in of_class(glb, "npc_guard"):
        met = {
            name
            for x, y, z in places(glb, index)
            for name, room in rooms.items()
            if room.floor - 0.1 <= z < room.ceiling and depth_inside(room.footprint, (x, y)) > 0
        }
        if not any(share[name] >= GLOOMY for name in met):
            problems.append(f"{node['name']}: no dark room on his round through {', '.join(sorted(met))}")
    return problems


def check_ways(glb, rooms, portals, share):
    """From the start to each exhibit leads a way without more than a few bright rooms in a row."""
    beside = {name: set() for name in rooms}
    walks = [(p.source, p.target) for p in portals if p.kind and p.kind.sill == 0.0] + [tuple(pair) for pair in ON_FOOT]
    for a, b in walks:
        beside[a].add(b)
        beside[b].add(a)
    start = room_of(glb, of_class(glb, "info_player_start")[0][0])
    todo, seen = [(start, 0)], {(start, 0)}
    while todo:
        name, bright = todo.pop()
        for there in beside[name]:
            state = (there, 0 if share[there] > SHADY else bright + 1)
            if state[1] <= OPEN_ROOMS and state not in seen:
                seen.add(state)
                todo.append(state)
    reached = {name for name, _ in seen}
    return [
        f"{node['name']}: every way to it leads through {OPEN_ROOMS + 1} bright rooms in a row"
        for i, node in of_class(glb, "prop_exhibit")
        if room_of(glb, i) not in reached
    ]

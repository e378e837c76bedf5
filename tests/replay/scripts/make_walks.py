#!/usr/bin/env python3
"""Writes rooms.bot and doors.bot: walks on foot through every room of the palace, and to every door in it, from its plan alone.

    tests/replay/scripts/make_walks.py        # after a change of the palace's rooms or doors; then tests/replay/record_all.sh

On to what is nearest by way of doorways that are not locked, the rooms in an order made shorter; keys are taken, and the button
pressed, as they are come by.
"""

import heapq
import itertools
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "assets" / "palace"))

import openings  # noqa: E402
import plan  # noqa: E402
from tour import STAIRS  # noqa: E402

START = "EntranceHall"
KEYS = {"gold": "KingsCloset", "silver": "Sacristy", "iron": "Kitchen"}
LOCKED = {"Treasury": "gold", "RelicRoom": "silver", "Dungeon": "iron", "Buttery": "WineCellar"}
STAIR_METRES = 9.0


class House:
    """The rooms, which doorways join them, and where one is."""

    def __init__(self):
        self.rooms = {room.name: room for room in plan.rooms()}
        self.portals = openings.resolve(self.rooms)
        self.ways = {name: [] for name in self.rooms}
        for number, portal in enumerate(self.portals):
            if portal.kind and portal.kind.sill == 0.0:
                self.join(portal.source, portal.target, portal.centre)
        for stair in STAIRS:
            self.join(stair.lower, stair.upper, None)
        self.join("BarrelRampFoot", "BarrelRampHead", None)
        self.here, self.at, self.held = START, self.middle(START), set()

    def join(self, a, b, at):
        self.ways[a].append((b, at))
        self.ways[b].append((a, at))

    def middle(self, name):
        xs, ys = zip(*self.rooms[name].footprint)
        return (sum(xs) / len(xs), sum(ys) / len(ys), self.rooms[name].floor)

    def opens(self, name):
        return name not in LOCKED or LOCKED[name] in self.held

    def distances(self):
        """Metres to every room that can be come to, to its middle or the doorway by which it is entered."""
        tie, best = itertools.count(), {}
        todo = [(0.0, next(tie), self.here, self.at)]
        while todo:
            metres, _, name, at = heapq.heappop(todo)
            if name in best:
                continue
            best[name] = (metres, at)
            for there, gate in self.ways[name]:
                if there not in best and self.opens(there) and self.opens(name):
                    run = math.dist(at, gate) if gate else math.dist(at, self.middle(there)) + STAIR_METRES
                    heapq.heappush(todo, (metres + run, next(tie), there, gate or self.middle(there)))
        return best

    def enter(self, name, at=None):
        """Goes to a room; yields what is done there that opens others."""
        self.here, self.at = name, at or self.middle(name)
        for key, room in KEYS.items():
            if room == name and key not in self.held:
                self.held.add(key)
                yield f"take {room}_key_exhibit"
        if name == "WineCellar" and name not in self.held:
            self.held.add(name)
            yield "press WineCellar_switch"


def rooms():
    house = House()
    lines = list(house.enter(START))
    for name in shortened(nearest_first()):
        lines.append(f"goto cell {name}-room")
        lines += house.enter(name)
    return lines


def nearest_first():
    """The rooms after the first, each the nearest of those left."""
    house, left, order = House(), set(plan_names()) - {START}, []
    while left:
        reach = house.distances()
        name = min((n for n in left if n in reach), key=lambda n: (reach[n][0], n))
        list(house.enter(name, reach[name][1]))
        order.append(name)
        left.discard(name)
    return order


def shortened(order):
    """The order with stretches of up to three rooms moved to where they cost least, until nothing gets shorter; no lock before its key."""
    metres = {}
    for name in plan_names():
        house = House()
        house.held = set(LOCKED.values())
        house.here, house.at = name, house.middle(name)
        metres[name] = {there: way for there, (way, _) in house.distances().items()}

    def whole(walk):
        return sum(metres[a][b] for a, b in zip([START, *walk], walk))

    def allowed(walk):
        return all(walk.index(KEYS.get(key, key)) < walk.index(room) for room, key in LOCKED.items())

    best, better = whole(order), True
    while better:
        better = False
        for size, first in itertools.product((1, 2, 3), range(len(order))):
            part, rest = order[first : first + size], order[:first] + order[first + size :]
            for at, turned in itertools.product(range(len(rest) + 1), (part, part[::-1])):
                walk = rest[:at] + turned + rest[at:]
                if whole(walk) < best - 1e-6 and allowed(walk):
                    order, best, better = walk, whole(walk), True
                    break
    return order


def plan_names():
    return [room.name for room in plan.rooms()]


def doors():
    """Every doorway that a door closes, opened from the side that is nearer."""
    house = House()
    lines = []
    for room in [*KEYS.values(), "WineCellar"]:
        reach = house.distances()
        lines.append(f"goto cell {room}-room")
        lines += house.enter(room, reach[room][1])
    left = {number: portal for number, portal in enumerate(house.portals) if has_doors(portal)}
    while left:
        reach = house.distances()
        _, number, side = min(
            (reach[side][0] + math.dist(reach[side][1], portal.centre), number, side)
            for number, portal in left.items()
            for side in (portal.source, portal.target)
            if side in reach and side not in LOCKED
        )
        lines.append(f"press door_{number}_0")
        house.here, house.at = side, left.pop(number).centre
    return lines


def has_doors(portal):
    sys.modules.setdefault("bpy", type(sys)("bpy"))
    import doors as hung

    return hung.has_doors(portal)


def write(name, remark, lines):
    text = "\n".join(["enfbot 1", f"# {remark} Written by make_walks.py.", "run on", *lines]) + "\n"
    (HERE / name).write_text(text, encoding="ascii")


if __name__ == "__main__":
    write("rooms.bot", "On foot into every room of the palace, each time the nearest of those left.", rooms())
    write("doors.bot", "Before every door of the palace, which is opened by hand.", doors())

"""Puts pieces into a room so that nothing touches walls, openings, the walker's way, or another piece."""

import math
import random
import zlib
from dataclasses import dataclass

import night
from geometry import add, bounds, centroid, depth_inside, dot, lerp, scale, sub
from shell import Wall

CLEAR_OF_WALK = 0.42
CLEAR_OF_DOOR = 0.9
LANE_STEP = 0.25
CLEAR_OF_WALL = 0.04
CLEAR_OF_PICTURE = 0.002
CLEAR_OF_FRAME = 0.22
LIFT = 0.003  # pieces stand this far over the floor, so that no two faces share a plane


@dataclass
class Shape:
    """The box about a piece, in its own frame."""

    low: tuple
    high: tuple

    @property
    def size(self):
        return sub(self.high, self.low)


class Placer:
    shapes = {}  # piece name -> Shape, shared by all rooms

    def __init__(self, scene, room, feet):
        self.scene, self.room = scene, room
        self.random = random.Random(zlib.crc32(room.name.encode()))
        self.centre = centroid(room.footprint)
        self.walls = [Wall(a, b) for a, b in zip(room.footprint, room.footprint[1:] + room.footprint[:1])]
        self.walk = [
            p[:2]
            for p in feet
            if room.floor - 0.1 <= p[2] < room.ceiling and depth_inside(room.footprint, p[:2]) > -0.3
        ][::4]
        self.solids = []  # convex polygons in the plan that pieces keep out of
        self.taken = {i: [] for i in range(len(self.walls))}  # per wall: (u0, u1, z0, z1) in use
        self.count = self.lights = 0  # pieces and lights put so far; they number the objects
        self.candles = night.Candles(room)
        self.doors = []  # points of the floor before doorways
        for wall, own in zip(room.walls, self.walls):
            self.doors += self._mark_openings(wall, own)

    def _mark_openings(self, wall, own):
        """Keeps openings clear; returns a point of the floor before each doorway."""
        doors = []
        index = self.walls.index(own)
        for hole in wall.holes:
            us, zs = [own.along(p) for p in hole.outline], [p[2] - self.room.floor for p in hole.outline]
            u0, u1 = min(us) - CLEAR_OF_FRAME, max(us) + CLEAR_OF_FRAME
            self.taken[index].append((u0, u1, min(zs) - CLEAR_OF_FRAME, max(zs) + CLEAR_OF_FRAME))
            if min(zs) < 0.5:
                self.solids.append(self._strip(own, u0, u1, CLEAR_OF_DOOR))
                doors.append(add(own.point((u0 + u1) / 2, 0)[:2], scale(own.inward, CLEAR_OF_DOOR)))
        return doors

    def keep_lanes(self):
        """From every doorway a straight lane stays free to the walker's way, or to the middle where he does not come."""
        ways = self.walk or [self.centre]
        for door in self.doors:
            goal = min(ways, key=lambda p: (math.dist(p, door), p))
            steps = int(math.dist(door, goal) / LANE_STEP) + 1
            self.walk += [lerp(door, goal, k / steps) for k in range(steps + 1)]

    @staticmethod
    def _strip(wall, u0, u1, depth):
        """A rectangle of floor along a wall."""
        a, b = wall.point(u0, 0)[:2], wall.point(u1, 0)[:2]
        out = scale(wall.inward, depth)
        return [a, b, add(b, out), add(a, out)]

    def keep_free(self, x, y, reach):
        """A square of floor that nothing stands on."""
        self.solids.append(Well([(x - reach, y - reach), (x + reach, y - reach), (x + reach, y + reach), (x - reach, y + reach)]))

    # ---- facts -----------------------------------------------------------------------------------------------------

    def shape(self, name):
        if name not in self.shapes:
            points = self.scene.piece_data(name).points
            axes = list(zip(*points))
            self.shapes[name] = Shape(tuple(min(a) for a in axes), tuple(max(a) for a in axes))
        return self.shapes[name]

    def outline(self, name, at, turn, margin=0.0):
        shape, c, s = self.shape(name), math.cos(turn), math.sin(turn)
        x0, y0 = shape.low[0] - margin, shape.low[1] - margin
        x1, y1 = shape.high[0] + margin, shape.high[1] + margin
        return [(at[0] + c * x - s * y, at[1] + s * x + c * y) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]

    def fits(self, polygon, walk=True, wall_margin=CLEAR_OF_WALL):
        if any(depth_inside(self.room.footprint, p) < wall_margin for p in polygon):
            return False
        if any(overlap(polygon, solid) for solid in self.solids):
            return False
        return not walk or all(distance(polygon, p) > CLEAR_OF_WALK for p in self.walk)

    # ---- free pieces -----------------------------------------------------------------------------------------------

    def add(self, name, at, turn=0.0, height=LIFT, solid=True, extras=None):
        """Puts a piece without asking; `height` over the floor, which no foot of it goes below."""
        self.count += 1
        if height == LIFT:
            height -= min(0.0, self.shape(name).low[2])
        number = f"{self.room.name}_{name.partition('.')[0]}_{self.count}"
        burning = self.candles.kindle(name, at, turn, height)
        self.scene.piece(self.room.name, number, burning, (*at[:2], self.room.floor + height), turn, extras)
        self.last = (at[:2], turn, height)  # of the piece put last
        if solid:
            self.solids.append(self.outline(name, at, turn))
        return at

    def put(self, name, at, turn=0.0, margin=0.05):
        """Puts a piece if it fits there; says whether it did."""
        if not self.fits(self.outline(name, at, turn, margin)):
            return False
        self.add(name, at, turn)
        return True

    def spot(self, width, depth, near=None, turn=0.0):
        """The free place for a rectangle nearest to a point, or None."""
        near = near or self.centre
        x0, y0, x1, y1 = bounds(self.room.footprint)
        steps = [
            (x0 + 0.25 * i, y0 + 0.25 * j) for i in range(int((x1 - x0) * 4) + 1) for j in range(int((y1 - y0) * 4) + 1)
        ]
        c, s = math.cos(turn), math.sin(turn)
        corners = [
            (c * x - s * y, s * x + c * y)
            for x, y in (
                (-width / 2, -depth / 2),
                (width / 2, -depth / 2),
                (width / 2, depth / 2),
                (-width / 2, depth / 2),
            )
        ]
        for at in sorted(steps, key=lambda p: (round(math.dist(p, near), 3), p)):
            if self.fits([add(at, corner) for corner in corners]):
                return at
        return None

    def place(self, name, near=None, turn=0.0, margin=0.15):
        """Puts a free piece as near as it fits to a point."""
        low, high = self.shape(name).low, self.shape(name).high
        at = self.spot(high[0] - low[0] + 2 * margin, high[1] - low[1] + 2 * margin, near, turn)
        return self.add(name, at, turn) if at else None

    def rug(self, name, at=None, turn=0.0):
        """A carpet: it may be walked on, and may lie under pieces."""
        at = at or self.centre
        outline = self.outline(name, at, turn, 0.1)
        inside = all(depth_inside(self.room.footprint, p) > 0.3 for p in outline)
        if not inside or any(overlap(outline, well) for well in self.solids if isinstance(well, Well)):
            return False
        self.add(name, at, turn, LIFT, solid=False)
        return True

    def around(self, name, centre, radius, count, first=0.0):
        """Seats about a round table, each facing its middle."""
        for k in range(count):
            angle = first + 2 * math.pi * k / count
            at = (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
            self.add(name, at, angle + math.pi / 2)

    def on_top(self, name, at, height):
        """A small thing on a table or shelf."""
        self.add(name, at, self.random.uniform(0, 6.28), height + 0.001, solid=False)

    # ---- pieces at walls -------------------------------------------------------------------------------------------

    def gaps(self, index, z0, z1):
        """Stretches of a wall that are free between two heights."""
        wall = self.walls[index]
        used = sorted((u0, u1) for u0, u1, low, high in self.taken[index] if low < z1 and high > z0)
        start, result = 0.08, []
        for u0, u1 in used + [(wall.length - 0.08, wall.length)]:
            if u0 > start:
                result.append((start, u0))
            start = max(start, u1)
        return result

    def at_wall(self, name, index, u, height, standing):
        """Puts a piece against a wall if its place is free."""
        wall, shape = self.walls[index], self.shape(name)
        turn = math.atan2(wall.direction[1], wall.direction[0])
        at = add(
            wall.point(u, 0)[:2],
            scale(wall.inward, CLEAR_OF_WALL - shape.low[1] if standing else CLEAR_OF_PICTURE - min(0.0, shape.low[1])),
        )
        outline = self.outline(name, at, turn, 0.0)
        if standing and not self.fits(outline, wall_margin=0.01):
            return False
        self.add(name, at, turn, height, solid=standing)
        low, high = height + shape.low[2], height + shape.high[2]
        self.taken[index].append((u + shape.low[0] - 0.08, u + shape.high[0] + 0.08, low, high + 0.05))
        return True

    def stand(self, name, count=1, walls=None):
        """Stands pieces in the middle of the longest free stretches of wall."""
        return self._along(name, count, LIFT, True, walls)

    def hang(self, name, height, count=1, walls=None):
        """Hangs pieces (names may be a list, taken in turn) with their origin at a height over the floor."""
        return self._along(name, count, height, False, walls)

    def _along(self, names, count, height, standing, walls):
        names = [names] if isinstance(names, str) else names
        done = 0
        for _ in range(count):
            name = names[done % len(names)]
            if not self._one_along(name, height, standing, walls):
                break
            done += 1
        return done

    def _one_along(self, name, height, standing, walls):
        shape = self.shape(name)
        width = shape.size[0] + 0.2
        choices = []
        for index in walls if walls is not None else range(len(self.walls)):
            for u0, u1 in self.gaps(index, height + shape.low[2], height + shape.high[2]):
                if u1 - u0 >= width:
                    choices.append((-(u1 - u0), index, u0, u1))
        for _, index, u0, u1 in sorted(choices):
            middle = (u0 + u1) / 2
            for shift in (0.0, -0.25, 0.25, -0.5, 0.5, -0.75, 0.75, -1.0, 1.0, -1.5, 1.5, -2.0, 2.0, -2.5, 2.5):
                fits = u0 + width / 2 <= middle + shift <= u1 - width / 2
                if fits and self.at_wall(name, index, middle + shift, height, standing):
                    return True
        return False

    def fill(self, name, height=None, spacing=0.0, walls=None, most=99):
        """As many pieces as fit, evenly, in every free stretch of wall."""
        standing, names = height is None, [name] if isinstance(name, str) else name
        height, shape, done = LIFT if standing else height, self.shape(names[0]), 0
        pitch = shape.size[0] + 0.04 + spacing
        for index in walls if walls is not None else range(len(self.walls)):
            for u0, u1 in self.gaps(index, height + shape.low[2], height + shape.high[2]):
                number = int((u1 - u0 + spacing) / pitch)
                first = (u0 + u1 - (number - 1) * pitch) / 2 - (shape.low[0] + shape.high[0]) / 2
                for k in range(number):
                    if done < most and self.at_wall(
                        names[done % len(names)], index, first + k * pitch, height, standing
                    ):
                        done += 1
        return done


class Well(list):
    """A polygon of floor that is not there, or that a fixture takes: carpets keep out of it too."""


def overlap(a, b):
    """Whether two convex polygons share area."""
    for polygon, other in ((a, b), (b, a)):
        for p, q in zip(polygon, polygon[1:] + polygon[:1]):
            side = sub(q, p)
            normal = (side[1], -side[0])
            if min(dot(sub(r, p), normal) for r in other) >= -1e-9:
                return False
    return True


def distance(polygon, point):
    """Distance from a point to a convex polygon; 0 inside."""
    inside, nearest = True, math.inf
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        side = sub(q, p)
        if side[0] * (point[1] - p[1]) - side[1] * (point[0] - p[0]) < 0:
            inside = False
        t = min(max(dot(sub(point, p), side) / dot(side, side), 0.0), 1.0)
        nearest = min(nearest, math.dist(point, add(p, scale(side, t))))
    return 0.0 if inside else nearest

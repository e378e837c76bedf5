"""The recorded walk through the palace: way-points from doors, a smoothed path, one row every thirtieth of a second."""

import math
from dataclasses import dataclass

from geometry import add, length, lerp, scale, sub, unit

SPEED = 2.25  # metres a second
RATE = 30
EYE = 1.7
CORNER = 0.75  # how far before a way-point the path starts to turn
LOOK_AHEAD = 1.5  # metres
TURN_SHARE = 0.08  # share of the remaining turn made in one row
TURN_MOST = 3.5  # degrees a row
DOOR_STEP = 0.875  # a way-point stands this far before and behind a door's plane

ROUTE = """
EntranceHall Courtyard MarbleSaloon MusicRoom BlueSalon DiningRoom HuntingRoom MapCabinet HuntingRoom DiningRoom
BlueSalon MusicRoom MarbleSaloon RedSalon GreenSalon AudienceChamber TapestryRoom PorcelainCabinet PortraitGallery
CornerCabinet GuardRoom Kitchen Scullery ServantsHall Vestibule EntranceHall GrandStaircase UpperStaircase
MinstrelsGallery UpperKneeRoom UpperWingLobby PictureGallery WinterGarden PictureGallery UpperWingLobby UpperKneeRoom
HallGallery KingsBedchamber PrivyDiningRoom BlueBedchamber RoseBedchamber UpperSaloon Belvedere UpperLibrary GlobeRoom
NorthLanding NorthStaircase ReadingCabinet Library Rotunda Chapel GreenSalon AudienceChamber TeaRoom WritingRoom
Courtyard EntranceHall GrandStaircase Antechamber GreatHall EastAisle KneeRoom WingLobby SculptureGallery Orangery
SculptureGallery WingLobby KneeRoom PetitionRoom Antechamber GrandStaircase EntranceHall Vestibule CellarLobby
CellarStair Undercroft WineCellar BarrelVault Undercroft CryptPassage Crypt CryptPassage Undercroft CellarStair
CheeseCellar BeerCellar BarrelRampFoot BarrelRampHead ClockRoom MunimentRoom CellarLobby Vestibule EntranceHall
""".split()

# Way-points inside a room, for the visits of the route to it in order; None stands for the straight way.
VIA = {
    "MapCabinet": [[(31.5, 11.5), (31.75, 13.5), (30.0, 13.5)]],
    "WinterGarden": [[(51.0, -24.5), (51.75, -22.5), (49.5, -21.5)]],
    "Orangery": [[(51.0, -24.5), (51.75, -22.5), (49.5, -21.5)]],
    "Crypt": [[(0.0, 20.5), (2.75, 22.5), (0.0, 26.0), (-2.75, 22.5)]],
    "UpperLibrary": [[(9.0, 24.75), (17.75, 24.75)]],
    "GreatHall": [[(19.0, -6.5), (19.0, 0.0)]],
    "Courtyard": [[(0.0, -5.5), (4.0, -2.5), (4.0, 2.5), (0.0, 5.5)], [(-8.0, 0.0), (-4.25, -2.5), (0.0, -5.5)]],
    "Chapel": [[(-9.0, 23.5), (-9.0, 18.25), (-12.0, 17.625)]],
}


@dataclass(frozen=True)
class Stair:
    """A stair of two flights beside each other: west up the front lane, about the landing, east up the back lane."""

    lower: str
    upper: str
    bottom: float
    top: float
    box: tuple  # of its well: x0, y0, x1, y1
    landing: float  # where the landing ends and both flights begin
    front_north: bool  # the front lane is the northern one
    risers: int  # of one flight

    @property
    def lanes(self):
        """The middle lines (y) of the front and the back lane."""
        quarter = (self.box[3] - self.box[1]) / 4
        north, south = self.box[3] - quarter, self.box[1] + quarter
        return (north, south) if self.front_north else (south, north)

    def way_up(self):
        front, back = self.lanes
        middle, x0, x1 = (self.bottom + self.top) / 2, self.landing, self.box[2]
        turn = (self.box[0] + self.landing) / 2
        clear = self.box[3] + 0.85 if self.front_north else self.box[1] - 0.85
        return [
            (x1 + 0.75, clear, self.bottom),
            (x1 + 0.75, front, self.bottom),
            (x1, front, self.bottom),
            (x0, front, middle),
            (turn, front, middle),
            (turn, back, middle),
            (x0, back, middle),
            (x1, back, self.top),
            (x1 + 0.75, back, self.top),
            (x1 + 0.75, clear, self.top),
        ]


STAIRS = [
    Stair("GrandStaircase", "UpperStaircase", 0.0, 5.0, (5.25, -16.25, 10.375, -12.75), 6.875, True, 14),
    Stair("NorthStaircase", "NorthLanding", 0.0, 5.0, (26.75, 20.25, 31.75, 23.75), 28.25, False, 14),
    Stair("CellarStair", "CellarLobby", -4.0, 0.0, (5.25, -23.75, 10.375, -20.25), 6.875, True, 12),
]


START, END = (0.0, -15.0, 0.0), (0.0, -13.0, 0.0)


def way_points(rooms, portals, route=None, via=None, start=START, end=END):
    """The corners of a walk along a route, by default the recorded one's, in space at floor level."""
    route, via = route or ROUTE, VIA if via is None else via
    doors = {}
    for portal in portals:
        if portal.kind and portal.kind.sill == 0.0:
            doors.setdefault(frozenset((portal.source, portal.target)), portal)
    points, visits = [start], {}
    for here, there in zip(route, route[1:]):
        visit = visits[here] = visits.get(here, -1) + 1
        points += [(*p, rooms[here].floor) for p in _via(here, visit, via)]
        points += _passage(here, there, doors, rooms)
    return points + [end]


def _via(name, visit, via=None):
    ways = (VIA if via is None else via).get(name, [])
    return ways[visit] if visit < len(ways) and ways[visit] else []


def _passage(here, there, doors, rooms):
    for stair in STAIRS:
        if (stair.lower, stair.upper) == (here, there):
            return stair.way_up()
        if (stair.upper, stair.lower) == (here, there):
            return stair.way_up()[::-1]
    if {here, there} == {"BarrelRampHead", "BarrelRampFoot"}:
        return [(27.0, -28.0, -4.0), (27.0, -27.0, -4.0), (27.0, -19.0, 0.0), (27.0, -18.0, 0.0)]
    portal = doors[frozenset((here, there))]
    forward = scale(portal.normal, 1.0 if portal.source == here else -1.0)
    x, y, z = portal.centre
    return [
        (x - forward[0] * DOOR_STEP, y - forward[1] * DOOR_STEP, z),
        (x + forward[0] * DOOR_STEP, y + forward[1] * DOOR_STEP, z),
    ]


def smooth_path(points):
    """Replaces every corner by a parabola that starts and ends up to CORNER before and behind it."""
    path = [points[0]]
    for before, corner, after in zip(points, points[1:], points[2:]):
        reach = min(CORNER, length(sub(corner, before)) / 2, length(sub(after, corner)) / 2)
        if reach < 1e-6:
            continue
        start = add(corner, scale(unit(sub(before, corner)), reach))
        end = add(corner, scale(unit(sub(after, corner)), reach))
        path += [lerp(lerp(start, corner, t), lerp(corner, end, t), t) for t in (i / 8 for i in range(9))]
    return path + [points[-1]]


def resample(path, step):
    """Points of the path, `step` metres apart."""
    result, left = [path[0]], step
    for p, q in zip(path, path[1:]):
        span = length(sub(q, p))
        while span - left > 1e-9:
            result.append(lerp(p, q, left / span))
            left += step
        left -= span
    return result


def walk(rooms, portals):
    """Feet of the walker, one point a row."""
    return resample(smooth_path(way_points(rooms, portals)), SPEED / RATE)


def write(path, feet):
    """The tour's file: glTF axes (x, z, -y), yaw counter-clockwise about +Y with 0 down -Z, all in degrees."""
    ahead = round(LOOK_AHEAD / (SPEED / RATE))
    yaw = pitch = None
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("time,x,y,z,yaw,pitch\n")
        for i, (x, y, z) in enumerate(feet):
            to = feet[min(i + ahead, len(feet) - 1)]
            if i + ahead // 2 < len(feet):
                heading, slope = _direction((x, y, z), to, yaw)
            yaw = heading if yaw is None else yaw + _turn(yaw, heading)
            glance = slope * 0.5 + 5.0 * math.sin(i / 97.0)
            pitch = glance if pitch is None else pitch + 0.05 * (glance - pitch)
            file.write(f"{i / RATE:.4f},{x:.5f},{z + EYE:.5f},{-y:.5f},{_wrapped(yaw):.3f},{pitch:.3f}\n")


def _direction(here, there, yaw):
    dx, dy, dz = sub(there, here)
    level = math.hypot(dx, dy)
    if level < 0.05:
        return yaw or 0.0, 0.0
    return math.degrees(math.atan2(-dx, dy)), math.degrees(math.atan2(dz, level))


def _turn(yaw, heading):
    """What one row turns towards the heading: a share of the way, no faster than a head turns."""
    turn = TURN_SHARE * ((heading - yaw + 180.0) % 360.0 - 180.0)
    return min(max(turn, -TURN_MOST), TURN_MOST)


def _wrapped(yaw):
    return (yaw + 180.0) % 360.0 - 180.0

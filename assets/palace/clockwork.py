"""Clockwork about the palace: a great clock with its wheels, an orrery, toys, fans, birds in cages; where, and how each turns."""

import math

import marvels
import moving
from placing import LIFT

WHEEL_SECONDS = 64.0  # a turn of the great clock's first wheel; the others follow from their teeth
CEILINGS = {"fan", "mobile"}
STANDS = {  # machine -> the piece of the catalogue that it stands on, and what it needs about it, metres
    "great_clock": ("great_clock", 0.35),
    "orrery": ("orrery_stand", 0.62),
    "globe": ("globe_stand", 0.15),
    "carousel": ("carousel_stand", 0.15),
    "dancers": ("plinth", 0.15),
    "ship": ("plinth", 0.15),
    "cage": ("plinth", 0.15),
}
MACHINES = {
    "ClockRoom": ["great_clock"],
    "GlobeRoom": ["orrery"],
    "Library": ["orrery", "globe"],
    "Nursery": ["carousel", "mobile"],
    "Schoolroom": ["globe", "mobile"],
    "MusicRoom": ["dancers"],
    "BallRoom": ["dancers", "carousel"],
    "DressingRoom": ["dancers"],
    "RoseBedchamber": ["dancers"],
    "MapCabinet": ["ship", "globe"],
    "CornerStudy": ["ship"],
    "PrivateStudy": ["ship", "globe"],
    "UpperSaloon": ["ship"],
    "Kitchen": ["fan"],
    "Scullery": ["fan"],
    "ServantsHall": ["fan"],
    "FootmensRoom": ["fan"],
    "SewingRoom": ["fan"],
    "Orangery": ["cage"],
    "WinterGarden": ["cage"],
    "QueensCloset": ["cage"],
    "SilkRoom": ["cage"],
}


def whole_turn(seconds, clockwise=False, steps=8):
    """Rows of a turn about the upright axis."""
    sign = -1.0 if clockwise else 1.0
    return [(seconds * k / steps, None, sign * 2 * math.pi * k / steps) for k in range(steps + 1)]


def wheel(turn, seconds, clockwise, steps=8):
    """Rows of a turn about the y axis of something that faces `turn`."""
    sign = 1.0 if clockwise else -1.0
    return [(seconds * k / steps, None, (turn, sign * 2 * math.pi * k / steps)) for k in range(steps + 1)]


def sway(turn, degrees, seconds, steps=16):
    """Rows of a pendulum's swing about the y axis."""
    return [(seconds * k / steps, None, (turn, math.radians(degrees) * math.sin(2 * math.pi * k / steps))) for k in range(steps + 1)]


class Works:
    """One machine: its middle on the floor, and what has been hung on it so far."""

    def __init__(self, placer, kind, number):
        self.placer, self.scene, self.room = placer, placer.scene, placer.room.name
        self.name, self.count = f"{self.room}_{kind}_{number}", 0
        self.at = None

    def stand(self, piece, margin):
        at = self.placer.place(piece, margin=margin)
        self.at = at and (*at[:2], self.placer.room.floor + LIFT)
        return self.at is not None

    def hang(self):
        """From a flat ceiling, beside its middle, where no lamp hangs."""
        x, y = self.placer.centre
        self.at = (x + 1.5, y + 0.25, self.placer.room.ceiling - 0.004)
        return True

    def part(self, mesh, build, offset, rows, phase=0.0, turn=0.0, **more):
        """A part that moves, its rest a vector from the middle; rows as for Scene.animate, places in the world; `more` its node says."""
        extras = {"wrap": "loop", "phase": phase, "solid": 0} | more
        where = tuple(a + b for a, b in zip(self.at, offset))
        data = self.scene.shared(f"marvel.{mesh}", build)
        item = self.scene.child(self.room, f"{self.name}_{self.count}", data, where, turn, extras)
        self.scene.animate(item, rows(where) if callable(rows) else rows, self.scene.origins[self.room])
        self.count += 1


def great_clock(works):
    hours = 9.0 * 3600
    for number, (x, z, _, teeth) in enumerate(marvels.GEARS):
        seconds = WHEEL_SECONDS * teeth / marvels.GEARS[0][3]
        rows = wheel(0.0, seconds, number % 2 == 0)
        works.part(f"gear{number}", lambda n=number: marvels.gear(n), (x, 0.0, z), rows)
    dial = (0.0, 0.08, marvels.GREAT_DIAL)
    works.part("hour", lambda: moving.clock_hand(0.14, 0.024), dial, wheel(0.0, 43200.0, True), hours, sound="clock")
    works.part("minute", lambda: moving.clock_hand(0.21, 0.016), (0.0, 0.086, dial[2]), wheel(0.0, 3600.0, True))
    works.part("second", lambda: moving.clock_hand(0.22, 0.008), (0.0, 0.092, dial[2]), wheel(0.0, 60.0, True))
    works.part("pendulum", moving.pendulum, (0.25, 0.24, 1.3), sway(0.0, 6.0, 2.0))


def orrery(works):
    for number, (_, _, _, seconds, _) in enumerate(marvels.PLANETS):
        rows = whole_turn(seconds)
        works.part(f"planet{number}", lambda n=number: marvels.planet(n), (0.0, 0.0, marvels.ORRERY_TOP), rows, 0.37 * number * seconds)


def globe(works):
    works.part("globe", marvels.globe, (0.0, 0.0, 0.56), whole_turn(20.0))


def carousel(works):
    seconds, steps, top = 12.0, 24, 0.145
    works.part("carousel", marvels.carousel, (0.0, 0.0, top), whole_turn(seconds))
    for number in range(6):
        colour = ("ivory", "terracotta", "ebony")[number % 3]

        def ride(where, number=number):
            rows = []
            for k in range(steps + 1):
                a = 2 * math.pi * (k / steps + number / 6)
                x, y = works.at[0] + 0.34 * math.cos(a), works.at[1] + 0.34 * math.sin(a)
                lift = 0.05 * math.sin(2 * math.pi * (4 * k / steps + number / 3))
                rows.append((seconds * k / steps, (x, y, where[2] + lift), a))
            return rows

        works.part(f"horse.{colour}", lambda c=colour: marvels.horse(c), (0.34, 0.0, top + 0.14), ride)


def dancers(works):
    """Two who turn about each other, and about themselves."""
    top, seconds, steps = 1.0 + 0.152, 8.0, 16
    works.scene.piece(works.room, f"{works.name}_box", "music_box", (*works.at[:2], works.at[2] + 1.0), 0.0)
    for number, cloth in enumerate(("cloth_white", "cloth_red")):

        def whirl(where, number=number):
            rows = []
            for k in range(steps + 1):
                a = 2 * math.pi * (k / steps + number / 2)
                at = (works.at[0] + 0.09 * math.cos(a), works.at[1] + 0.09 * math.sin(a), where[2])
                rows.append((seconds * k / steps, at, 4 * math.pi * k / steps + math.pi * number))
            return rows

        works.part(f"dancer.{cloth}", lambda c=cloth: marvels.dancer(c), (0.09, 0.0, top), whirl)


def ship(works):
    works.scene.piece(works.room, f"{works.name}_stand", "ship_stand", (*works.at[:2], works.at[2] + 1.0), 0.0)
    works.part("ship", marvels.ship, (0.0, 0.0, 1.21), sway(0.0, 5.0, 5.0))


def fan(works):
    works.part("fan", marvels.fan, (0.0, 0.0, 0.0), whole_turn(2.4))


def mobile(works):
    works.part("mobile", marvels.mobile, (0.0, 0.0, 0.0), whole_turn(26.0))


def cage(works):
    works.scene.piece(works.room, f"{works.name}_cage", "cage", (*works.at[:2], works.at[2] + 1.0), 0.0)
    for number in range(2):

        def flutter(_where, number=number):
            seconds, steps, rows = 1.7 + 0.6 * number, 12, []
            for k in range(steps + 1):
                a = 2 * math.pi * k / steps * (1 - 2 * number)
                height = works.at[2] + 1.2 + 0.2 * number + 0.05 * math.sin(2 * a)
                at = (works.at[0] + 0.05 * math.cos(a), works.at[1] + 0.05 * math.sin(a), height)
                rows.append((seconds * k / steps, at, a))
            return rows

        works.part("bird", moving.bird, (0.05, 0.0, 1.2 + 0.2 * number), flutter, sound="bird")


BUILD = {f.__name__: f for f in (great_clock, orrery, globe, carousel, dancers, ship, fan, mobile, cage)}


def wind_up(placer):
    """The machines of one room; returns how many things move in them."""
    count = 0
    for number, kind in enumerate(MACHINES.get(placer.room.name, ())):
        works = Works(placer, kind, number)
        if works.hang() if kind in CEILINGS else works.stand(*STANDS[kind]):
            BUILD[kind](works)
            count += works.count
        else:
            print(f"{placer.room.name}: no room for {kind}")
    return count

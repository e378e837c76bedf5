"""Every door, window, arcade and well of the palace, and where each one cuts the walls of its two rooms."""

import math
from dataclasses import dataclass

from geometry import TOUCH, add, dot, rectangle, regular, scale, snap_point, sub
from shell import Hole, Wall

WIDEST_WALL = 1.25  # two rooms farther apart than this share no opening


@dataclass(frozen=True)
class Kind:
    """The form of an opening: rect, arch or round; sizes in metres; `sill` above the higher floor."""

    shape: str
    width: float
    height: float
    sill: float = 0.0
    frame: str = "wood_white"
    tunnel: str = "wood_white"

    @property
    def glazed(self):
        return 0.0 < self.sill


DOOR = Kind("rect", 1.5, 2.75)
NARROW = Kind("rect", 1.125, 2.25)
GATE = Kind("arch", 2.0, 3.25, frame="stone_trim", tunnel="stone_trim")
ARCH = Kind("arch", 1.75, 2.875, frame="stone_trim", tunnel="stone_trim")
ARCADE = Kind("arch", 2.5, 3.75, frame="stone_trim", tunnel="stone_trim")
BALCONY = Kind("arch", 2.5, 3.25, frame="stone_trim", tunnel="stone_trim")
VAULT_ARCH = Kind("arch", 1.5, 2.125, frame="stone_trim", tunnel="stone_trim")
WINDOW = Kind("rect", 1.25, 2.5, 0.875)
UPPER_WINDOW = Kind("rect", 1.25, 2.0, 0.875)
TALL_WINDOW = Kind("arch", 1.5, 3.0, 0.875, frame="stone_trim", tunnel="stone_trim")
ROUND_WINDOW = Kind("round", 1.75, 1.75, 1.25, frame="stone_trim", tunnel="stone_trim")


@dataclass(frozen=True)
class Opening:
    source: str
    target: str
    at: float = None  # along the wall: x or y in the world; None for the middle of what the walls share
    kind: Kind = DOOR


@dataclass(frozen=True)
class Well:
    """A level opening: the ceiling of the lower room to the floor of the upper one."""

    lower: str
    upper: str
    outline: tuple  # counter-clockwise seen from above


@dataclass
class Portal:
    source: str
    target: str
    points: list  # front normal out of the source
    kind: Kind = None
    centre: tuple = None  # on the floor, in the plane of the portal
    normal: tuple = None  # out of the source, in the plan


def _chain(names, at, kind=DOOR):
    return [Opening(a, b, at, kind) for a, b in zip(names, names[1:])]


def _windows(names, places, kind=WINDOW):
    return [Opening(name, "Courtyard", at, kind) for name in names for at in places]


ENFILADE = [
    "PorcelainCabinet",
    "TapestryRoom",
    "AudienceChamber",
    "GreenSalon",
    "RedSalon",
    "MarbleSaloon",
    "MusicRoom",
    "BlueSalon",
    "DiningRoom",
    "HuntingRoom",
    "MapCabinet",
]
UPPER_ENFILADE = [
    "QueensCloset",
    "QueensBedchamber",
    "DressingRoom",
    "YellowBedchamber",
    "SilkRoom",
    "UpperSaloon",
    "RoseBedchamber",
    "BlueBedchamber",
    "PrivyDiningRoom",
    "KingsBedchamber",
    "KingsCloset",
]


def _ground():
    doors = _chain(ENFILADE, 11.5)
    doors += _chain(
        [
            "CornerCabinet",
            "GuardRoom",
            "Armoury",
            "CloakRoom",
            "EntranceHall",
            "GrandStaircase",
            "Antechamber",
            "PetitionRoom",
            "KneeRoom",
        ],
        -11.5,
    )
    doors += _chain(
        ["Kitchen", "Scullery", "ServantsHall", "Vestibule", "CellarLobby", "MunimentRoom", "ClockRoom"], -18.5
    )
    doors += _chain(["TeaRoom", "WritingRoom", "CardRoom"], -14.0)
    doors += _chain(["TapestryRoom", "BilliardRoom", "SmokingRoom", "GuardRoom", "Kitchen"], -24.0)
    doors += _chain(["PorcelainCabinet", "PortraitGallery", "CornerCabinet"], -30.75)
    doors += [
        Opening("AudienceChamber", "TeaRoom", -18.5),
        Opening("CardRoom", "Armoury", -18.5),
        Opening("TeaRoom", "BilliardRoom", 6.0),
        Opening("WritingRoom", "SmokingRoom", -1.5),
        Opening("PortraitGallery", "BilliardRoom", 3.0),
        Opening("PortraitGallery", "SmokingRoom", -5.0),
        Opening("EntranceHall", "Vestibule", 0.0, GATE),
        Opening("CloakRoom", "ServantsHall", -7.0, NARROW),
        Opening("PorcelainCabinet", "Treasury", -30.75),
        Opening("Treasury", "Sacristy", 20.5, NARROW),
        Opening("Sacristy", "Chapel", 19.0),
        Opening("AudienceChamber", "Sacristy", -21.5, NARROW),
        Opening("GreenSalon", "Chapel", -13.5),
        Opening("MarbleSaloon", "Rotunda", 0.0, GATE),
        Opening("Rotunda", "Chapel", 23.5),
        Opening("Rotunda", "Library", 23.5),
        Opening("BlueSalon", "Library", 13.5),
        Opening("Library", "ReadingCabinet", 20.5),
        Opening("ReadingCabinet", "NorthStaircase", 18.5),
        Opening("MapCabinet", "NorthStaircase", 30.75),
    ]
    doors += [
        Opening("BlueSalon", "GreatHall", 14.5),
        Opening("DiningRoom", "GreatHall", 20.0),
        Opening("Antechamber", "GreatHall", 15.75),
        Opening("PetitionRoom", "GreatHall", 22.5),
        Opening("HuntingRoom", "EastAisle", 27.0),
        Opening("EastAisle", "KneeRoom", 28.0),
    ]
    doors += [Opening("EastAisle", "GreatHall", y, ARCADE) for y in (-7.0, -3.5, 0.0, 3.5, 7.0)]
    doors += [
        Opening("KneeRoom", "WingLobby"),
        Opening("WingLobby", "SculptureGallery"),
        Opening("SculptureGallery", "Orangery", None, GATE),
        Opening("SculptureGallery", "PainterStudio"),
        Opening("SculptureGallery", "PlasterWorkshop"),
        Opening("PainterStudio", "PlasterWorkshop", None, NARROW),
        Opening("PlasterWorkshop", "BathHouse", None, NARROW),
        Opening("Orangery", "BathHouse"),
    ]
    return doors


def _first():
    doors = _chain(UPPER_ENFILADE, 11.5)
    doors += _chain(
        [
            "CornerStudy",
            "StateBedchamber",
            "PrivyChamber",
            "CouncilRoom",
            "UpperHall",
            "UpperStaircase",
            "MinstrelsGallery",
        ],
        -11.0,
    )
    doors += _chain(["MaidsRoom", "SewingRoom", "FootmensRoom", "FlagRoom", "PrivateStudy", "BallRoom"], -18.5)
    doors += _chain(["Schoolroom", "Nursery", "GovernessRoom"], -14.0)
    doors += _chain(["QueensBedchamber", "GuestChamber", "GreenChamber", "StateBedchamber", "MaidsRoom"], -24.0)
    doors += _chain(["QueensCloset", "LongGallery", "CornerStudy"], -30.75)
    doors += [
        Opening("DressingRoom", "Schoolroom", -18.5),
        Opening("GovernessRoom", "PrivyChamber", -18.5),
        Opening("Schoolroom", "GuestChamber", 6.0, NARROW),
        Opening("Nursery", "GreenChamber", -1.5, NARROW),
        Opening("LongGallery", "GuestChamber", 3.0),
        Opening("LongGallery", "GreenChamber", -5.0),
        Opening("UpperHall", "FlagRoom", 0.0),
        Opening("CouncilRoom", "FootmensRoom", -7.0, NARROW),
        Opening("QueensCloset", "RelicRoom", -30.75),
        Opening("RelicRoom", "Vestiary", 20.5, NARROW),
        Opening("DressingRoom", "Vestiary", -21.5, NARROW),
        Opening("UpperSaloon", "Belvedere", 0.0, GATE),
        Opening("YellowBedchamber", "Chapel", -13.5, UPPER_WINDOW),
        Opening("Belvedere", "Chapel", 23.5, ROUND_WINDOW),
        Opening("Belvedere", "UpperLibrary", 23.5),
        Opening("BlueBedchamber", "UpperLibrary", 13.5, NARROW),
        Opening("UpperLibrary", "GlobeRoom", 20.5),
        Opening("GlobeRoom", "NorthLanding", 18.5),
        Opening("KingsCloset", "NorthLanding", 30.75),
        Opening("KingsBedchamber", "HallGallery", 27.0),
        Opening("HallGallery", "UpperKneeRoom", 28.0),
        Opening("MinstrelsGallery", "BallRoom", 19.0),
        Opening("MinstrelsGallery", "UpperKneeRoom", -11.0),
        Opening("UpperStaircase", "PrivateStudy", 11.25, NARROW),
    ]
    doors += [Opening("HallGallery", "GreatHall", y, BALCONY) for y in (-7.0, -3.5, 0.0, 3.5, 7.0)]
    doors += [Opening("MinstrelsGallery", "GreatHall", x, BALCONY) for x in (15.5, 19.0, 22.5)]
    doors += [
        Opening("BlueBedchamber", "GreatHall", 14.5, UPPER_WINDOW),
        Opening("PrivyDiningRoom", "GreatHall", 20.0, UPPER_WINDOW),
    ]
    doors += [
        Opening("UpperKneeRoom", "UpperWingLobby"),
        Opening("UpperWingLobby", "PictureGallery"),
        Opening("PictureGallery", "WinterGarden", None, ARCH),
    ]
    return doors


def _cellar():
    doors = _chain(["Dungeon", "Granary", "BarrelVault"], -13.0, VAULT_ARCH)
    doors += _chain(
        ["CoalCellar", "ColdStore", "WineCellar", "Undercroft", "CellarStair", "CheeseCellar", "BeerCellar"],
        -18.5,
        VAULT_ARCH,
    )
    doors += [
        Opening("Dungeon", "CoalCellar", -24.0, VAULT_ARCH),
        Opening("BarrelVault", "WineCellar", -8.5, VAULT_ARCH),
        Opening("BarrelVault", "Undercroft", -13.0, VAULT_ARCH),
        Opening("Undercroft", "Buttery", -13.0, VAULT_ARCH),
        Opening("Undercroft", "CryptPassage", 0.0, VAULT_ARCH),
        Opening("CryptPassage", "Crypt", 0.0, VAULT_ARCH),
        Opening("CryptPassage", "Cistern", 0.0, VAULT_ARCH),
        Opening("ClockRoom", "BarrelRampHead", -18.0, NARROW),
        Opening("BeerCellar", "BarrelRampFoot", -28.0, VAULT_ARCH),
    ]
    return doors


def _courtyard():
    openings = [
        Opening("MarbleSaloon", "Courtyard", 0.0, GATE),
        Opening("EntranceHall", "Courtyard", 0.0, GATE),
        Opening("WritingRoom", "Courtyard", 0.0),
    ]
    for lower, upper, places in (
        ("RedSalon", "SilkRoom", (-8.5, -5.5)),
        ("MusicRoom", "RoseBedchamber", (5.5, 8.5)),
        ("MarbleSaloon", "UpperSaloon", (-2.5, 2.5)),
        ("EntranceHall", "UpperHall", (-3.0, 3.0)),
        ("CloakRoom", "CouncilRoom", (-10.5, -8.5, -6.5)),
        ("TeaRoom", "Schoolroom", (4.75, 7.5)),
        ("GrandStaircase", "UpperStaircase", (6.5, 8.5, 10.5)),
        ("CardRoom", "GovernessRoom", (-7.5, -4.75)),
    ):
        openings += _windows([lower], places) + _windows([upper], places, UPPER_WINDOW)
    openings += _windows(["UpperSaloon", "UpperHall"], (0.0,), UPPER_WINDOW)
    openings += _windows(["WritingRoom"], (-1.875, 1.875)) + _windows(["Nursery"], (-1.5, 1.5), UPPER_WINDOW)
    openings += _windows(["GreatHall"], (-7.0, -3.5, 0.0, 3.5, 7.0), TALL_WINDOW)
    openings += [Opening("GreatHall", "Courtyard", y, _raised(TALL_WINDOW, 5.375)) for y in (-7.0, -3.5, 0.0, 3.5, 7.0)]
    return openings


def _raised(kind, sill):
    return Kind(kind.shape, kind.width, kind.height, sill, kind.frame, kind.tunnel)


WELLS = [
    Well("GrandStaircase", "UpperStaircase", tuple(rectangle(5.25, -16.25, 10.375, -12.75))),
    Well("NorthStaircase", "NorthLanding", tuple(rectangle(26.75, 20.25, 31.75, 23.75))),
    Well("CellarStair", "CellarLobby", tuple(rectangle(5.25, -23.75, 10.375, -20.25))),
    Well("Library", "UpperLibrary", tuple(rectangle(11.0, 19.75, 16.0, 23.25))),
    Well("Rotunda", "Belvedere", tuple(regular((0.0, 23.5), 2.25, 16))),
]
LIP = 1.0 / 32.0  # a well's portal lies this far under the upper floor


def openings():
    return _ground() + _first() + _cellar() + _courtyard()


# ---- from the tables to holes and portals --------------------------------------------------------------------------


def outline(kind):
    """Outline of an opening in the plane of its wall: u from the middle, height above the sill; counter-clockwise."""
    half, height = kind.width / 2, kind.height
    if kind.shape == "rect":
        return [(-half, 0.0), (half, 0.0), (half, height), (-half, height)]
    if kind.shape == "round":
        angles = [2 * math.pi * i / 16 for i in range(16)]
        return [(half * math.cos(a), height / 2 + half * math.sin(a)) for a in angles]
    rise = min(half, height / 3)
    arc = [(half * math.cos(a), height - rise + rise * math.sin(a)) for a in (math.pi * i / 8 for i in range(9))]
    return [(-half, 0.0), (half, 0.0)] + arc


def walls_of(room):
    if room.section:  # a ramp has a door only in the west wall of its landing
        x = room.footprint[0][0]
        ends = [low[0] for low, _ in room.section]
        flat = ends[:2] if room.section[0][0][1] == room.section[1][0][1] else ends[1:]
        return [Wall((x, flat[0]), (x, flat[1]))]
    return [Wall(a, b) for a, b in zip(room.footprint, room.footprint[1:] + room.footprint[:1])]


def _facing_walls(source, target):
    """The pair of opposite walls of two rooms that share most length, with the shared stretch along the first."""
    best = None
    for wall in source.walls:
        for other in target.walls:
            gap = dot(sub(other.start, wall.start), wall.inward)
            if dot(wall.direction, other.direction) > -0.9999 or not -WIDEST_WALL < gap < -TOUCH:
                continue
            low = max(0.0, wall.along(other.end))
            high = min(wall.length, wall.along(other.start))
            if high - low > 0.5 and (best is None or high - low > best[4] - best[3]):
                best = (wall, other, -gap, low, high)
    if best is None:
        raise ValueError(f"{source.name} and {target.name} share no wall")
    return best


def _place(wall, low, high, at):
    """Where along the wall the opening's middle lies."""
    if at is None:
        return (low + high) / 2
    axis = 0 if abs(wall.direction[0]) > abs(wall.direction[1]) else 1
    return (at - wall.start[axis]) / wall.direction[axis]


def cut(opening, rooms):
    """Cuts one opening into both rooms' walls and returns its portal."""
    source, target = rooms[opening.source], rooms[opening.target]
    wall, other, gap, low, high = _facing_walls(source, target)
    kind = opening.kind
    middle = _place(wall, low, high, opening.at)
    if middle - kind.width / 2 < low - TOUCH or middle + kind.width / 2 > high + TOUCH:
        raise ValueError(f"{opening} is wider than its wall ({low}, {middle}, {high})")
    base = max(source.floor, target.floor) + kind.sill
    if base + kind.height > min(source.spring, target.spring) - TOUCH:
        raise ValueError(f"{opening} is higher than its walls")
    away = scale(wall.inward, -gap / 2)
    points = []
    for u, height in outline(kind):
        x, y = add(add(wall.start, scale(wall.direction, middle + u)), away)
        points.append(snap_point((x, y, base + height)))
    wall.holes.append(Hole(points, gap / 2, kind.tunnel, glazed=kind.glazed))
    other.holes.append(Hole(points, gap / 2, kind.tunnel))
    centre = add(add(wall.start, scale(wall.direction, middle)), away)
    return Portal(source.name, target.name, points, kind, (*centre, base), scale(wall.inward, -1.0))


def sink(well, rooms):
    """The level portal of a well, just under the upper floor."""
    z = rooms[well.upper].floor - LIP
    return Portal(well.lower, well.upper, [(*p, z) for p in well.outline])


def lean(rooms):
    """The leaning portal between the two halves of the barrel ramp."""
    head = rooms["BarrelRampHead"]
    (y0, z0), (y1, z1) = head.section[-1]
    x0, x1 = head.footprint[0][0], head.footprint[1][0]
    return Portal("BarrelRampHead", "BarrelRampFoot", [(x0, y0, z0), (x1, y0, z0), (x1, y1, z1), (x0, y1, z1)])


def resolve(rooms):
    """Gives every room its walls with their holes, and returns all portals.  `rooms` maps names to rooms."""
    for room in rooms.values():
        room.walls = walls_of(room)
    return [cut(o, rooms) for o in openings()] + [sink(w, rooms) for w in WELLS] + [lean(rooms)]

"""The plan of the palace: every room and every opening, as tables.  Metres, x east, y north, z up.

Three storeys stand over one another: the cellar, the ground floor, the first floor.  A room is a convex footprint
between two heights; half a metre of wall lies between neighbours.  The oblique wing is drawn in a frame of its own.
"""

import math
import re
from dataclasses import dataclass, field

from geometry import add, rectangle, regular, scale, snap_point

CELLAR, GROUND, FIRST = (-4.0, -0.5), (0.0, 4.5), (5.0, 9.0)
WING_ANGLE = math.radians(-30.0)
WING_ORIGIN = (30.0, -16.5)
RISES = {"Chapel": 2.5, "RelicRoom": 1.0, "Belvedere": 4.5}
ROTUNDA = regular((0.0, 23.5), 6.0, 16)


@dataclass
class Room:
    name: str
    footprint: list
    floor: float
    ceiling: float
    theme: str
    wall: str = "plaster_warm"
    ground: str = "parquet"
    top: str = "flat"  # flat, coffer, cove, barrel, dome, oculus, sky
    walls: list = field(default_factory=list)
    section: list = None  # of a ramp only

    @property
    def rise(self):
        """Height of what stands on the walls: a cove, a vault or a dome; `ceiling` is its crown."""
        return RISES.get(self.name, {"cove": 0.75, "barrel": 1.25, "dome": 1.25}.get(self.top, 0.0))

    @property
    def spring(self):
        return self.ceiling - self.rise

    @property
    def label(self):
        return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", self.name)


def _row(storey, y0, y1, rows):
    """Rooms of one row: (x0, x1, name, theme, wall, ground, top)."""
    return [
        Room(name, rectangle(x0, y0, x1, y1), *storey, theme, wall, ground, top)
        for x0, x1, name, theme, wall, ground, top in rows
    ]


def _wing(storey, rows):
    """Rooms of the oblique wing: (u0, v0, u1, v1, name, theme, wall, ground, top) in its own frame."""
    east = (math.cos(WING_ANGLE), math.sin(WING_ANGLE))
    north = (-east[1], east[0])
    rooms = []
    for u0, v0, u1, v1, *rest in rows:
        corners = [
            snap_point(add(WING_ORIGIN, add(scale(east, u + 0.5), scale(north, v))))
            for u, v in rectangle(u0, v0, u1, v1)
        ]
        name, theme, wall, ground, top = rest
        rooms.append(Room(name, corners, *storey, theme, wall, ground, top))
    return rooms


def _knee(storey, name, theme, wall, ground, top):
    """The room that turns from the square palace into the oblique wing: one wall stands at 60 degrees."""
    x = 30.0 + 7.0 * math.tan(-WING_ANGLE)
    return [
        Room(
            name, [(26.0, -16.5), (30.0, -16.5), snap_point((x, -9.5)), (26.0, -9.5)], *storey, theme, wall, ground, top
        )
    ]


def ground_rooms():
    north = _row(
        GROUND,
        9.5,
        16.5,
        [
            (-33.0, -28.5, "PorcelainCabinet", "cabinet", "paper_blue", "parquet", "cove"),
            (-28.0, -23.0, "TapestryRoom", "salon", "paper_gold", "parquet", "cove"),
            (-22.5, -17.0, "AudienceChamber", "throne", "paper_red", "parquet", "coffer"),
            (-16.5, -10.5, "GreenSalon", "salon", "paper_green", "parquet", "cove"),
            (-10.0, -4.0, "RedSalon", "salon", "paper_red", "parquet", "cove"),
            (-3.5, 3.5, "MarbleSaloon", "marble", "marble_cream", "marble_check", "coffer"),
            (4.0, 10.0, "MusicRoom", "music", "paper_ivory", "parquet", "cove"),
            (10.5, 16.5, "BlueSalon", "salon", "paper_blue", "parquet", "cove"),
            (17.0, 22.5, "DiningRoom", "dining", "paper_green", "parquet", "coffer"),
            (23.0, 28.0, "HuntingRoom", "salon", "wood_panel", "planks", "coffer"),
            (28.5, 33.0, "MapCabinet", "study", "paper_gold", "parquet", "cove"),
        ],
    )
    behind = _row(
        GROUND,
        17.0,
        24.0,
        [
            (-33.0, -26.5, "Treasury", "treasury", "stone_wall", "flagstone", "barrel"),
            (-26.0, -20.5, "Sacristy", "study", "plaster_warm", "flagstone", "cove"),
            (20.5, 26.0, "ReadingCabinet", "library", "wood_panel", "parquet", "cove"),
            (26.5, 33.0, "NorthStaircase", "stairs", "marble_cream", "marble_check", "flat"),
        ],
    )
    behind += [
        Room("Chapel", rectangle(-20.0, 17.0, -7.0, 26.0), 0.0, 11.0, "chapel", "stone_wall", "marble_check", "barrel"),
        Room("Rotunda", ROTUNDA, 0.0, 4.5, "rotunda", "marble_cream", "marble_rose", "oculus"),
        Room("Library", rectangle(7.0, 17.0, 20.0, 26.0), *GROUND, "library", "wood_panel", "parquet", "flat"),
    ]
    west = _row(GROUND, 3.25, 9.0, [(-20.0, -12.5, "TeaRoom", "salon", "paper_ivory", "parquet", "cove")])
    west += _row(GROUND, -2.75, 2.75, [(-20.0, -12.5, "WritingRoom", "study", "paper_green", "parquet", "coffer")])
    west += _row(GROUND, -9.0, -3.25, [(-20.0, -12.5, "CardRoom", "salon", "paper_rose", "parquet", "cove")])
    west += _row(GROUND, 0.25, 9.0, [(-28.0, -20.5, "BilliardRoom", "billiard", "wood_panel", "planks", "coffer")])
    west += _row(GROUND, -9.0, -0.25, [(-28.0, -20.5, "SmokingRoom", "salon", "paper_red", "planks", "coffer")])
    west += _row(GROUND, -9.0, 9.0, [(-33.0, -28.5, "PortraitGallery", "gallery", "paper_rose", "parquet", "cove")])
    east = [
        Room(
            "GreatHall",
            rectangle(12.5, -9.0, 25.5, 9.0),
            0.0,
            9.5,
            "great_hall",
            "stone_wall",
            "marble_check",
            "coffer",
        )
    ]
    east += _row(GROUND, -9.0, 9.0, [(26.0, 30.0, "EastAisle", "aisle", "stone_wall", "marble_rose", "flat")])
    return north + behind + west + east + _ground_south() + _ground_wing()


def _ground_south():
    south = _row(
        GROUND,
        -16.5,
        -9.5,
        [
            (-33.0, -28.5, "CornerCabinet", "cabinet", "paper_gold", "parquet", "cove"),
            (-28.0, -20.5, "GuardRoom", "guard", "stone_wall", "flagstone", "coffer"),
            (-20.0, -12.5, "Armoury", "guard", "brick", "flagstone", "coffer"),
            (-12.0, -5.0, "CloakRoom", "hall", "wood_panel", "planks", "flat"),
            (-4.5, 4.5, "EntranceHall", "entrance", "marble_cream", "marble_check", "coffer"),
            (5.0, 12.0, "GrandStaircase", "stairs", "marble_cream", "marble_check", "flat"),
            (12.5, 19.0, "Antechamber", "salon", "paper_ivory", "parquet", "coffer"),
            (19.5, 25.5, "PetitionRoom", "hall", "wood_panel", "parquet", "cove"),
        ],
    )
    back = _row(
        GROUND,
        -24.0,
        -17.0,
        [
            (-28.0, -20.5, "Kitchen", "kitchen", "plaster_warm", "flagstone", "flat"),
            (-20.0, -12.5, "Scullery", "kitchen", "brick", "flagstone", "flat"),
            (-12.0, -5.0, "ServantsHall", "servants", "plaster_warm", "planks", "coffer"),
            (-4.5, 4.5, "Vestibule", "entrance", "stone_wall", "marble_check", "cove"),
            (5.0, 12.0, "CellarLobby", "lobby", "plaster_warm", "flagstone", "flat"),
            (12.5, 19.0, "MunimentRoom", "library", "plaster_warm", "planks", "flat"),
            (19.5, 25.5, "ClockRoom", "study", "paper_green", "planks", "cove"),
        ],
    )
    return south + back + _knee(GROUND, "KneeRoom", "salon", "paper_rose", "parquet", "cove")


def _ground_wing():
    return _wing(
        GROUND,
        [
            (0.0, 0.0, 5.0, 8.0, "WingLobby", "hall", "marble_cream", "marble_rose", "cove"),
            (5.5, 0.0, 15.5, 8.0, "SculptureGallery", "sculpture", "marble_cream", "marble_check", "coffer"),
            (16.0, 0.0, 26.0, 8.0, "Orangery", "orangery", "brick", "flagstone", "flat"),
            (5.5, 8.5, 10.25, 14.0, "PainterStudio", "studio", "plaster_warm", "planks", "flat"),
            (10.75, 8.5, 15.5, 14.0, "PlasterWorkshop", "studio", "brick", "flagstone", "flat"),
            (16.0, 8.5, 21.0, 14.0, "BathHouse", "bath", "marble_cream", "marble_rose", "barrel"),
        ],
    )


def first_rooms():
    north = _row(
        FIRST,
        9.5,
        16.5,
        [
            (-33.0, -28.5, "QueensCloset", "cabinet", "paper_rose", "parquet", "cove"),
            (-28.0, -23.0, "QueensBedchamber", "bedroom", "paper_rose", "parquet", "cove"),
            (-22.5, -17.0, "DressingRoom", "cabinet", "paper_ivory", "parquet", "cove"),
            (-16.5, -10.5, "YellowBedchamber", "bedroom", "paper_gold", "parquet", "cove"),
            (-10.0, -4.0, "SilkRoom", "salon", "paper_ivory", "parquet", "cove"),
            (-3.5, 3.5, "UpperSaloon", "salon", "paper_red", "parquet", "coffer"),
            (4.0, 10.0, "RoseBedchamber", "bedroom", "paper_rose", "parquet", "cove"),
            (10.5, 16.5, "BlueBedchamber", "bedroom", "paper_blue", "parquet", "cove"),
            (17.0, 22.5, "PrivyDiningRoom", "dining", "paper_gold", "parquet", "cove"),
            (23.0, 28.0, "KingsBedchamber", "bedroom", "paper_red", "parquet", "coffer"),
            (28.5, 33.0, "KingsCloset", "study", "paper_green", "parquet", "cove"),
        ],
    )
    behind = _row(
        FIRST,
        17.0,
        24.0,
        [
            (-33.0, -26.5, "RelicRoom", "treasury", "stone_wall", "flagstone", "barrel"),
            (-26.0, -20.5, "Vestiary", "cabinet", "plaster_warm", "planks", "cove"),
            (20.5, 26.0, "GlobeRoom", "study", "paper_blue", "parquet", "cove"),
            (26.5, 33.0, "NorthLanding", "landing", "marble_cream", "parquet", "cove"),
        ],
    )
    behind += [
        Room("Belvedere", ROTUNDA, 5.0, 13.0, "belvedere", "marble_cream", "marble_rose", "dome"),
        Room(
            "UpperLibrary", rectangle(7.0, 17.0, 20.0, 26.0), *FIRST, "upper_library", "wood_panel", "planks", "coffer"
        ),
    ]
    west = _row(FIRST, 3.25, 9.0, [(-20.0, -12.5, "Schoolroom", "study", "plaster_warm", "planks", "flat")])
    west += _row(FIRST, -2.75, 2.75, [(-20.0, -12.5, "Nursery", "bedroom", "paper_ivory", "planks", "cove")])
    west += _row(FIRST, -9.0, -3.25, [(-20.0, -12.5, "GovernessRoom", "bedroom", "paper_green", "planks", "cove")])
    west += _row(FIRST, 0.25, 9.0, [(-28.0, -20.5, "GuestChamber", "bedroom", "paper_blue", "parquet", "cove")])
    west += _row(FIRST, -9.0, -0.25, [(-28.0, -20.5, "GreenChamber", "bedroom", "paper_green", "parquet", "cove")])
    west += _row(FIRST, -9.0, 9.0, [(-33.0, -28.5, "LongGallery", "gallery", "paper_red", "parquet", "coffer")])
    east = _row(FIRST, -9.0, 9.0, [(26.0, 30.0, "HallGallery", "gallery", "paper_gold", "parquet", "flat")])
    return north + behind + west + east + _first_south() + _first_wing()


def _first_south():
    south = _row(
        FIRST,
        -16.5,
        -9.5,
        [
            (-33.0, -28.5, "CornerStudy", "study", "paper_blue", "parquet", "cove"),
            (-28.0, -20.5, "StateBedchamber", "bedroom", "paper_red", "parquet", "coffer"),
            (-20.0, -12.5, "PrivyChamber", "salon", "paper_green", "parquet", "cove"),
            (-12.0, -5.0, "CouncilRoom", "dining", "wood_panel", "parquet", "coffer"),
            (-4.5, 4.5, "UpperHall", "hall", "paper_ivory", "parquet", "coffer"),
            (5.0, 12.0, "UpperStaircase", "landing", "marble_cream", "parquet", "cove"),
        ],
    )
    south += _row(FIRST, -12.5, -9.5, [(12.5, 25.5, "MinstrelsGallery", "gallery", "wood_panel", "planks", "flat")])
    back = _row(
        FIRST,
        -24.0,
        -17.0,
        [
            (-28.0, -20.5, "MaidsRoom", "bedroom", "plaster_warm", "planks", "flat"),
            (-20.0, -12.5, "SewingRoom", "study", "plaster_warm", "planks", "flat"),
            (-12.0, -5.0, "FootmensRoom", "servants", "plaster_warm", "planks", "flat"),
            (-4.5, 4.5, "FlagRoom", "hall", "paper_blue", "parquet", "cove"),
            (5.0, 12.0, "PrivateStudy", "library", "wood_panel", "parquet", "cove"),
        ],
    )
    back += _row(FIRST, -24.0, -13.0, [(12.5, 25.5, "BallRoom", "ballroom", "paper_ivory", "parquet", "coffer")])
    return south + back + _knee(FIRST, "UpperKneeRoom", "salon", "paper_gold", "parquet", "cove")


def _first_wing():
    return _wing(
        FIRST,
        [
            (0.0, 0.0, 5.0, 8.0, "UpperWingLobby", "hall", "paper_green", "parquet", "cove"),
            (5.5, 0.0, 15.5, 8.0, "PictureGallery", "gallery", "paper_red", "parquet", "coffer"),
            (16.0, 0.0, 26.0, 8.0, "WinterGarden", "orangery", "plaster_warm", "marble_rose", "cove"),
        ],
    )


def cellar_rooms():
    front = _row(
        CELLAR,
        -16.5,
        -9.5,
        [
            (-28.0, -20.5, "Dungeon", "dungeon", "stone_wall", "flagstone", "barrel"),
            (-20.0, -12.5, "Granary", "store", "brick", "flagstone", "barrel"),
            (-12.0, -5.0, "BarrelVault", "barrels", "brick", "flagstone", "barrel"),
            (5.0, 12.0, "Buttery", "store", "brick", "flagstone", "barrel"),
        ],
    )
    back = _row(
        CELLAR,
        -24.0,
        -17.0,
        [
            (-28.0, -20.5, "CoalCellar", "store", "brick", "flagstone", "barrel"),
            (-20.0, -12.5, "ColdStore", "store", "stone_wall", "flagstone", "barrel"),
            (-12.0, -5.0, "WineCellar", "barrels", "brick", "flagstone", "barrel"),
            (5.0, 12.0, "CellarStair", "stairs", "stone_wall", "flagstone", "flat"),
            (12.5, 19.0, "CheeseCellar", "store", "stone_wall", "flagstone", "barrel"),
        ],
    )
    deep = [
        Room(
            "Undercroft", rectangle(-4.5, -24.0, 4.5, -9.5), *CELLAR, "undercroft", "stone_wall", "flagstone", "barrel"
        ),
        Room("BeerCellar", rectangle(19.5, -29.0, 25.5, -17.0), *CELLAR, "barrels", "brick", "flagstone", "barrel"),
        Room("CryptPassage", rectangle(-1.5, -9.0, 1.5, 17.0), *CELLAR, "passage", "stone_wall", "flagstone", "barrel"),
        Room("Cistern", rectangle(2.0, -6.0, 12.0, 6.0), *CELLAR, "cistern", "stone_wall", "water", "flat"),
        Room("Crypt", ROTUNDA, *CELLAR, "crypt", "stone_wall", "flagstone", "dome"),
    ]
    return front + back + deep


def ramp_rooms():
    """A sloped passage from the ground floor down to the cellar, in two cells that meet in a leaning plane."""
    head = Room("BarrelRampHead", rectangle(26.0, -23.5, 28.0, -17.0), -1.75, 2.75, "ramp", "brick", "cobbles", "ramp")
    foot = Room("BarrelRampFoot", rectangle(26.0, -29.0, 28.0, -22.5), -4.0, 0.5, "ramp", "brick", "cobbles", "ramp")
    # Sections (y, z): pairs of a floor point and the ceiling point over it, from the head down to the foot.
    head.section = [((-17.0, 0.0), (-17.0, 2.75)), ((-19.0, 0.0), (-19.0, 2.75)), ((-22.5, -1.75), (-23.5, 0.5))]
    foot.section = [((-22.5, -1.75), (-23.5, 0.5)), ((-27.0, -4.0), (-27.0, -1.25)), ((-29.0, -4.0), (-29.0, -1.25))]
    return [head, foot]


def outdoors():
    return [Room("Courtyard", rectangle(-12.0, -9.0, 12.0, 9.0), 0.0, 9.75, "court", "stone_wall", "cobbles", "sky")]


def rooms():
    return ground_rooms() + first_rooms() + cellar_rooms() + ramp_rooms() + outdoors()

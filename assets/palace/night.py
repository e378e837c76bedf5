"""Which lamps burn in the night: rooms where they are lit, rooms of a few candles, rooms where nothing burns; and the moon.

A guard sees by light (game/sim/sight.c), so this is as much the game's as the eye's: along every way there is darkness to wait in,
which check_night.py counts, and in every room some light to walk by.
"""

import math
from dataclasses import dataclass

from geometry import area2

LIT = """
EntranceHall GrandStaircase KneeRoom RedSalon MusicRoom DiningRoom AudienceChamber TeaRoom GuardRoom Kitchen CellarLobby
WingLobby Rotunda NorthStaircase SmokingRoom
YellowBedchamber UpperSaloon PrivyDiningRoom GlobeRoom Belvedere GovernessRoom CornerStudy CouncilRoom UpperStaircase FootmensRoom
PrivateStudy UpperKneeRoom PictureGallery
WineCellar CellarStair BarrelRampHead
""".split()
DARK = """
PorcelainCabinet GreenSalon HuntingRoom ReadingCabinet WritingRoom CornerCabinet PetitionRoom Scullery MunimentRoom PainterStudio
PlasterWorkshop
QueensCloset DressingRoom SilkRoom BlueBedchamber KingsCloset Vestiary Schoolroom GuestChamber PrivyChamber HallGallery MaidsRoom
FlagRoom
Granary Buttery CoalCellar CheeseCellar BarrelRampFoot
""".split()
# All others are half dark: the chandelier is out, some candles burn.

MOON = (0.42, 0.58, 1.0)
MOON_AT, MOON_CANDELA, MOON_REACH = (15.2, -8.0, 22.5), 900.0, 90.0
SHIMMER = 3.2  # candelas of what comes into a dark room round its shutters
CANDLELIGHT = (1.0, 0.66, 0.34)
FLOOR_A_POOL, BETWEEN_POOLS = 13.0, 2.2  # square metres of floor to a burning candle at least, and metres between two


@dataclass(frozen=True)
class Flame:
    """A piece with a flame: where it burns in the piece's own frame, how brightly, and of how many one is lit in half-dark rooms."""

    forward: float
    height: float
    candela: float
    one_of: int


FLAMES = {
    "sconce": Flame(0.8, 0.25, 3.8, 2),
    "torch": Flame(1.0, 0.45, 5.0, 2),
    "candelabrum": Flame(0.0, 2.0, 4.0, 1),
    "candlestick": Flame(0.0, 0.7, 2.2, 2),
    "lamp_post": Flame(0.0, 2.75, 13.0, 1),
    "lantern": Flame(0.0, 0.0, 0.0, 0),
    "chandelier": Flame(0.0, 0.0, 0.0, 0),
    "chandelier_small": Flame(0.0, 0.0, 0.0, 0),
    "chandelier_grand": Flame(0.0, 0.0, 0.0, 0),
}


def lit(room):
    return room.name in LIT


def dark(room):
    return room.name in DARK


class Candles:
    """What burns in one room that is not lit as a whole."""

    def __init__(self, room):
        self.room, self.pools, self.met = room, [], {}
        self.most = max(2, area2(room.footprint) / 2 / FLOOR_A_POOL)

    def kindle(self, name, at, turn, height):
        """The name of the piece to put for `name`: itself, or that with its flames put out. What burns makes a pool of light."""
        kind = name.partition(".")[0]
        if kind == "fireplace" and dark(self.room):
            return "fireplace.out"
        if kind not in FLAMES or lit(self.room):
            return name
        flame = FLAMES[kind]
        count = self.met[kind] = self.met.get(kind, -1) + 1
        place = (at[0] - flame.forward * math.sin(turn), at[1] + flame.forward * math.cos(turn), height + flame.height)
        if dark(self.room) or flame.one_of == 0 or count % flame.one_of or len(self.pools) >= self.most:
            return f"{kind}.out"
        if any(math.dist(place, other) < BETWEEN_POOLS for other, _ in self.pools):
            return f"{kind}.out"
        self.pools.append((place, flame.candela))
        return name

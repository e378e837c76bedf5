"""Which theme furnishes which room, in what order: what is built in first, then what is put in."""

import math

import life
import structure
import themes
import themes_service as service
from geometry import lerp
from placing import Placer

THEMES = {
    "salon": themes.salon,
    "music": themes.music,
    "dining": themes.dining,
    "throne": themes.throne,
    "cabinet": themes.cabinet,
    "study": themes.study,
    "library": themes.library,
    "upper_library": themes.upper_library,
    "billiard": themes.billiard,
    "gallery": themes.gallery,
    "bedroom": themes.bedroom,
    "ballroom": themes.ballroom,
    "hall": themes.hall,
    "entrance": themes.entrance,
    "marble": themes.marble,
    "great_hall": themes.great_hall,
    "aisle": themes.aisle,
    "rotunda": themes.rotunda,
    "belvedere": themes.belvedere,
    "crypt": themes.crypt,
    "guard": themes.guard,
    "stairs": themes.stairs,
    "landing": themes.landing,
    "lobby": themes.lobby,
    "kitchen": service.kitchen,
    "servants": service.servants,
    "chapel": service.chapel,
    "treasury": service.treasury,
    "sculpture": service.sculpture,
    "orangery": service.orangery,
    "studio": service.studio,
    "bath": service.bath,
    "barrels": service.barrels,
    "store": service.store,
    "dungeon": service.dungeon,
    "undercroft": service.undercroft,
    "passage": service.passage,
    "cistern": service.cistern,
    "ramp": service.ramp,
    "court": service.court,
}


LANES = {  # ways between doors that the recorded walk does not take and that furniture would close: corners in the plan
    "BlueSalon": [(13.5, 15.75), (15.2, 15.5), (15.2, 11.5)],
    "BlueBedchamber": [(13.5, 15.75), (15.3, 15.5), (15.3, 11.5)],
    "QueensCloset": [(-29.25, 11.75), (-29.35, 13.5), (-30.75, 15.5)],
}


NARROW = {  # rooms in which furniture, put as it fits, would leave a body no way between two doors
    "PorcelainCabinet",
    "MapCabinet",
    "Library",
    "WritingRoom",
    "PainterStudio",
    "PlasterWorkshop",
    "KingsCloset",
    "PrivateStudy",
    "Nursery",
    "GovernessRoom",
    "WineCellar",
    "BarrelVault",
    "CoalCellar",
    "CornerStudy",
    "Vestiary",
}


def furnish(scene, room, feet):
    """Puts everything into one room; `feet` is the walker's way, which stays free. Returns how much of it moves."""
    placer = Placer(scene, room, feet)
    for a, b in zip(LANES.get(room.name, []), LANES.get(room.name, [])[1:]):
        steps = int(math.dist(a, b) / 0.25) + 1
        placer.walk += [lerp(a, b, k / steps) for k in range(steps + 1)]
    if room.name in NARROW:
        placer.keep_lanes()
    structure.build(placer)
    if room.name == "Library":
        placer.keep_free(*life.LIFT_AT, life.LIFT_SIZE / 2 + 0.9)
    THEMES[room.theme](placer)
    themes.by_night(placer)
    return life.enliven(placer)

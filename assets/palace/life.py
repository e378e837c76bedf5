"""What moves in the palace: doors, guards on their rounds, clocks, a train, birds and fish, floating wonders, an elevator, and what a
thief comes for.  Written as animations and custom properties; assets/README.md lists the keys."""

import math
import random

import clockwork
import doors
import moving
from geometry import add, centroid, length, scale, sub
from placing import LIFT
from tour import _passage, _via

HEIGHT_OF_SWITCH = 1.2

KEYS = {"gold": "KingsCloset", "silver": "Sacristy", "iron": "Kitchen"}
EXHIBITS = [  # room, what, title, value
    ("Treasury", "crown", "the crown of the founder", 5),
    ("RelicRoom", "chalice", "the reliquary chalice", 4),
    ("Dungeon", "casket", "the prisoner's casket", 4),
    ("Crypt", "sceptre", "the buried sceptre", 3),
    ("UpperLibrary", "folio", "the first folio", 3),
    ("PorcelainCabinet", "figurine.porcelain", "the white dancer", 2),
    ("PictureGallery", "figurine.gold", "the gilded muse", 2),
    ("WinterGarden", "figurine.cobalt", "the blue gardener", 2),
    ("MusicRoom", "figurine.ivory", "the ivory player", 1),
    ("ClockRoom", "casket", "the clockmaker's box", 1),
    ("Buttery", "chalice", "the butler's cup", 2),
]
SWITCHES = {"WineCellar": doors.BUTTERY}  # room -> the door that a button in it opens
# Nobody walks next to the rooms where the visitor begins: he has time to look about and to choose a way.
ROUNDS = """
MarbleSaloon MusicRoom BlueSalon DiningRoom
DiningRoom HuntingRoom MapCabinet
GreenSalon AudienceChamber TapestryRoom PorcelainCabinet PortraitGallery
CornerCabinet GuardRoom Kitchen Scullery
MinstrelsGallery UpperKneeRoom HallGallery
UpperKneeRoom UpperWingLobby PictureGallery WinterGarden
HallGallery KingsBedchamber PrivyDiningRoom BlueBedchamber
RoseBedchamber UpperSaloon Belvedere UpperLibrary
GlobeRoom NorthLanding NorthStaircase ReadingCabinet
Library Rotunda Chapel
GreatHall EastAisle KneeRoom
WingLobby SculptureGallery Orangery
Undercroft WineCellar BarrelVault
Undercroft CryptPassage Crypt
CheeseCellar BeerCellar BarrelRampFoot BarrelRampHead ClockRoom
""".strip().splitlines()
GUARD_SPEED, TURN_TIME, REST_TIME = 1.15, 0.6, 2.0

CLOCK_THEMES = {"salon", "study", "hall", "dining", "library", "bedroom", "gallery", "kitchen", "servants", "guard"}
WONDER_THEMES = {"gallery", "salon", "sculpture", "orangery", "music", "marble", "cabinet", "study", "ballroom", "hall", "library"}
TRAIN_X, TRAIN_Y, TRAIN_HALF, TRAIN_SPEED = (-8.5, 15.0), 11.5, 0.28, 0.9

LIFT_AT, LIFT_SIZE, LIFT_RISE, LIFT_REST = (11.95, 22.4), 1.5, 4.85, 0.15


# ---- guards --------------------------------------------------------------------------------------------------------


def round_points(rooms, portals, names):
    """Corners of a round at floor level, from its first door to its last."""
    doors = {}
    for portal in portals:
        if portal.kind and portal.kind.sill == 0.0:
            doors.setdefault(frozenset((portal.source, portal.target)), portal)
    points = []
    for here, there in zip(names, names[1:]):
        if here != names[0]:
            points += [(*p, rooms[here].floor) for p in _via(here, 0)]
        points += _passage(here, there, doors, rooms)
    return [p for p, q in zip(points, points[1:] + [None]) if q is None or length(sub(p, q)) > 0.05]


def facing(p, q):
    """The turn that makes +y look from p to q in the plan."""
    return math.atan2(-(q[0] - p[0]), q[1] - p[1])


def turned(a, b):
    """b, or b a whole turn on, so that it is at most half a turn from a."""
    return a + (b - a + math.pi) % (2 * math.pi) - math.pi


def walk_rows(points):
    """(seconds, place, turn): there and back, turning on the spot at corners."""
    legs = list(zip(points, points[1:])) + list(zip(points[::-1], points[-2::-1]))
    rows, time, turn = [], 0.0, facing(*legs[0])
    for i, (p, q) in enumerate(legs):
        towards = turned(turn, facing(p, q))
        if length(sub(q, p)[:2]) < 0.01:
            towards = turn
        pause = REST_TIME if i in (0, len(points) - 1) else 0.0
        rows.append((time, p, turn))
        time += pause + TURN_TIME * min(1.0, abs(towards - turn) / 1.0)
        turn = towards
        rows.append((time, p, turn))
        time += max(length(sub(q, p)) / GUARD_SPEED, 0.05)
    rows.append((time, points[0], turn))
    return [row for row, after in zip(rows, rows[1:] + [None]) if after is None or after[0] - row[0] > 1.0 / 60]


def post_guards(scene, rooms, portals):
    for number, line in enumerate(ROUNDS):
        points = round_points(rooms, portals, line.split())
        coat = ("cloth_blue", "cloth_red", "cloth_green")[number % 3]
        name = f"guard_{number}"
        data = scene.shared(f"guard.{coat}", lambda coat=coat: moving.guard(coat))
        extras = {"classname": "npc_guard", "targetname": name, "max_speed": 4.5, "speed": GUARD_SPEED, "wrap": "loop"}
        guard = scene.free(name, data, points[0], 0.0, extras)
        scene.animate(guard, walk_rows(points))
    return len(ROUNDS)


# ---- clocks and wonders, room by room ------------------------------------------------------------------------------


def spin_rows(axis_turn, angles, seconds):
    """Rows of a turn about the local y axis (a dial's), seen from its front: clockwise."""
    return [(seconds * i / (len(angles) - 1), None, (axis_turn, -a)) for i, a in enumerate(angles)]


def clock(placer, phase):
    """A clock on a wall: two hands and a pendulum that move."""
    if not placer.hang("clock_case", 2.1):
        return 0
    scene, room = placer.scene, placer.room.name
    at, turn, height = placer.last
    out = (-math.sin(turn), math.cos(turn))
    z = placer.room.floor + height

    def piece(name, build, forward, drop, angles, seconds, start, **more):
        item = scene.child(
            room,
            f"{room}_{name}",
            scene.shared(f"clock.{name}", build),
            (*add(at, scale(out, forward)), z - drop),
            turn,
            {"wrap": "loop", "phase": start, "solid": 0} | more,
        )
        scene.animate(item, spin_rows(turn, angles, seconds), scene.origins[room])

    whole = [2 * math.pi * k / 4 for k in range(5)]
    swing = [math.radians(7.0) * math.sin(2 * math.pi * k / 16) for k in range(17)]
    piece("hours", lambda: moving.clock_hand(0.11, 0.02), 0.112, 0.0, whole, 43200.0, phase, sound="clock")
    piece("minutes", lambda: moving.clock_hand(0.165, 0.014), 0.118, 0.0, whole, 3600.0, phase % 3600.0)
    piece("pendulum", moving.pendulum, 0.05, 0.3, swing, 2.0, phase % 2.0)
    return 3


def wonder(placer, kind, phase):
    """Something that turns and floats over a plinth."""
    at = placer.place("plinth")
    if not at:
        return 0
    scene, room = placer.scene, placer.room.name
    base = (*at[:2], placer.room.floor + 1.4)
    item = scene.child(
        room, f"{room}_wonder", scene.shared(f"wonder.{kind}", lambda: moving.wonder(kind)), base, 0.0, {"wrap": "loop", "phase": phase, "solid": 0}
    )
    steps, seconds = 16, 7.0 + kind
    rows = [
        (seconds * i / steps, add(base, (0.0, 0.0, 0.07 * math.sin(2 * math.pi * i / steps))), 2 * math.pi * i / steps)
        for i in range(steps + 1)
    ]
    scene.animate(item, rows, scene.origins[room])
    return 1


def enliven(placer):
    """Called for every room when it is furnished; returns how many movers it was given."""
    room, count = placer.room, 0
    dice = random.Random(room.name)
    for name, what, title, value in EXHIBITS:
        if name == room.name:
            count += exhibit(placer, what, {"classname": "prop_exhibit", "title": title, "value": value})
    for key, name in KEYS.items():
        if name == room.name:
            count += exhibit(placer, "key", {"classname": "item_key", "key": key, "title": f"the {key} key"})
    if room.name in SWITCHES:
        count += door_switch(placer, SWITCHES[room.name])
    count += clockwork.wind_up(placer)
    if room.theme in CLOCK_THEMES:
        count += clock(placer, dice.uniform(0.0, 43200.0))
    if room.theme in WONDER_THEMES and dice.random() < 0.75:
        count += wonder(placer, dice.randrange(4), dice.uniform(0.0, 7.0))
    return count


def exhibit(placer, what, extras):
    """Something to carry away, on a plinth."""
    at = placer.place("plinth")
    if not at:
        return 0
    scene, room = placer.scene, placer.room.name
    kind, _, material = what.partition(".")
    build = (lambda: moving.figurine(material)) if material else getattr(moving, kind)
    place = (*at[:2], placer.room.floor + 1.0 + LIFT)
    scene.child(room, f"{room}_{kind}_exhibit", scene.shared(f"treasure.{what}", build), place, 0.4, extras | {"solid": 0})
    return 1


def door_switch(placer, target):
    """A button on a post that opens a door elsewhere."""
    at = placer.place("post")
    if not at:
        return 0
    place = (at[0], at[1] + 0.061, placer.room.floor + HEIGHT_OF_SWITCH - 0.15)
    extras = {"classname": "func_button", "target": target, "solid": 0}
    placer.scene.child(placer.room.name, f"{placer.room.name}_switch", placer.scene.shared("switch", moving.switch), place, 0.0, extras)
    return 1


# ---- things that run, fly and swim -----------------------------------------------------------------------------------


def train_loop():
    """(distance, place, turn) about the train's loop, clockwise seen from above in the order of driving."""
    (x0, x1), r = TRAIN_X, TRAIN_HALF
    points = [((x0, TRAIN_Y - r), -math.pi / 2), ((x1, TRAIN_Y - r), -math.pi / 2)]
    points += [
        ((x1 + r * math.sin(a), TRAIN_Y - r * math.cos(a)), -math.pi / 2 + a) for a in (math.pi * k / 8 for k in range(1, 9))
    ]
    points += [((x0, TRAIN_Y + r), math.pi / 2)]
    points += [
        ((x0 - r * math.sin(a), TRAIN_Y + r * math.cos(a)), math.pi / 2 + a) for a in (math.pi * k / 8 for k in range(1, 9))
    ]
    rows, run = [], 0.0
    for i, (at, turn) in enumerate(points):
        run += math.dist(at, points[i - 1][0]) if i else 0.0
        rows.append((run, (*at, 0.012), turn))
    return rows


def lay_train(scene):
    rows = train_loop()
    whole = rows[-1][0]
    cars = [("engine", moving.engine, 0.0)]
    cars += [(f"wagon.{m}", lambda m=m: moving.wagon(m), 0.58 + 0.5 * i) for i, m in enumerate(("cloth_red", "cloth_gold", "cloth_blue", "cloth_red"))]
    for number, (name, build, behind) in enumerate(cars):
        extras = {"wrap": "loop", "phase": (whole - behind) / TRAIN_SPEED, "solid": 0}
        if number == 0:
            extras["sound"] = "train"
        car = scene.free(f"train_{number}", scene.shared(name, build), rows[0][1], rows[0][2], extras)
        scene.animate(car, [(run / TRAIN_SPEED, at, turn) for run, at, turn in rows])
    return len(cars)


def circle_rows(centre, radius, seconds, wave, steps=24):
    rows = []
    for i in range(steps + 1):
        a = 2 * math.pi * i / steps
        at = (centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a), centre[2] + wave * math.sin(3 * a))
        rows.append((seconds * i / steps, at, a))
    return rows


def release(scene, rooms, name, build, places, **more):
    """Animals that circle, `more` what else their nodes say: places are (room, how many, height over the floor, radius, seconds, wave)."""
    dice, count = random.Random(name), 0
    for room, number, height, radius, seconds, wave in places:
        middle = centroid(rooms[room].footprint)
        for k in range(number):
            r = radius * dice.uniform(0.45, 1.0)
            spread = max(0.0, radius - r)
            at = (middle[0] + dice.uniform(-spread, spread), middle[1] + dice.uniform(-spread, spread), rooms[room].floor + height + dice.uniform(-wave, wave))
            extras = {"wrap": "loop", "phase": dice.uniform(0.0, seconds), "solid": 0} | more
            item = scene.free(f"{name}_{room}_{k}", scene.shared(name, build), at, 0.0, extras)
            scene.animate(item, circle_rows(at, r, seconds * dice.uniform(0.8, 1.3), wave))
            count += 1
    return count


def revolving_doors(scene, portals):
    """Where the great hall meets its aisle, in the middle arch, a revolving door turns."""
    count = 0
    for number, portal in enumerate(portals):
        if {portal.source, portal.target} == {"EastAisle", "GreatHall"} and abs(portal.centre[1]) < 0.1:
            name = f"revolving_{number}"
            mesh = scene.mesh(name, moving.revolving(1.1, 2.2))
            item = scene.free(name, mesh, (*portal.centre[:2], portal.centre[2] + LIFT), 0.0, {"wrap": "loop", "sound": "wings", "sound_every": 4.0})
            scene.animate(item, [(16.0 * k / 8, None, 2 * math.pi * k / 8) for k in range(9)])
            count += 1
    return count


def lift(scene, rooms):
    """The elevator of the library, and the buttons that call it."""
    base = rooms["Library"].floor + LIFT_REST
    scene.free(
        "library_lift",
        scene.mesh("library_lift", moving.platform(LIFT_SIZE, LIFT_SIZE)),
        (*LIFT_AT, base),
        0.0,
        {"classname": "func_plat", "targetname": "library_lift", "stops": f"0,{LIFT_RISE}", "speed": 1.1},
    )
    posts = [("Library", (LIFT_AT[0] - 1.25, LIFT_AT[1] - 0.4)), ("UpperLibrary", (LIFT_AT[0] - 0.95, 23.75))]
    for stop, (room, at) in enumerate(posts):
        floor = rooms[room].floor
        scene.piece(room, f"{room}_post", "post", (*at, floor + LIFT), 0.0)
        scene.child(
            room,
            f"{room}_call",
            scene.shared("switch", moving.switch),
            (at[0], at[1] + 0.061, floor + HEIGHT_OF_SWITCH - 0.15),
            0.0,
            {"classname": "func_button", "target": "library_lift", "stop": stop, "solid": 0},
        )
    return 3


# ---- all -------------------------------------------------------------------------------------------------------------


def populate(scene, rooms, portals):
    """Everything that belongs to no single room; returns how many movers."""
    count = doors.hang(scene, portals) + post_guards(scene, rooms, portals) + lay_train(scene) + lift(scene, rooms)
    count += revolving_doors(scene, portals)
    count += release(
        scene,
        rooms,
        "bird",
        moving.bird,
        [("Courtyard", 9, 6.0, 6.0, 11.0, 0.6), ("Belvedere", 4, 4.5, 3.0, 7.0, 0.4), ("Orangery", 4, 2.9, 2.5, 6.0, 0.3), ("WinterGarden", 4, 2.5, 2.5, 6.0, 0.3), ("GreatHall", 4, 6.0, 4.5, 9.0, 0.5)],
        sound="bird",
    )
    count += release(scene, rooms, "fish", moving.fish, [("Cistern", 14, 0.14, 3.6, 16.0, 0.03)])
    exit_box = scene.child("Vestibule", "way_out", None, (0.0, -23.0, 1.2), 0.0, {"classname": "trigger_exit"})
    exit_box.scale = (2.0, 0.9, 1.2)
    return count

"""How the state rooms and halls are furnished and lit.  Every theme is a function of the room's placer."""

import math

import night
from geometry import add, lerp, scale
from meshes import tube
from openings import WELLS
from placing import CLEAR_OF_PICTURE

CLOTHS = {
    "paper_red": "cloth_red",
    "paper_green": "cloth_green",
    "paper_blue": "cloth_blue",
    "paper_gold": "cloth_red",
    "paper_rose": "cloth_white",
    "paper_ivory": "cloth_blue",
    "wood_panel": "cloth_green",
    "marble_cream": "cloth_red",
}
RUGS = {
    "cloth_red": "carpet_red",
    "cloth_green": "carpet_green",
    "cloth_blue": "carpet_blue",
    "cloth_white": "carpet_blue",
}
PORTRAITS, SCENES = (4, 5, 6, 7, 12, 14), (0, 1, 2, 3, 8, 9, 10, 11, 13, 15)
DARK_WALLS = {"wood_panel": 1.5, "brick": 1.9, "stone_wall": 1.35}  # what swallows light is given more of it
BRIGHTNESS = 1.8  # over the candelas below; one place to make the whole palace lighter
LAMPS = 0.46  # and over those of lamps that light a whole room: what is bright is judged by what is dark
WARM, CANDLE = (1.0, 0.85, 0.64), (1.0, 0.72, 0.42)


# ---- shared gestures -----------------------------------------------------------------------------------------------


def cloth(p):
    return CLOTHS.get(p.room.wall, "cloth_red")


def picture_names(p, kind, numbers):
    numbers = list(numbers)
    p.random.shuffle(numbers)
    return [f"{kind}.{n}" for n in numbers]


def light(p, at, height, candela, colour=WARM, reach=None):
    """The light of a lamp, where lamps burn (night.py)."""
    if night.lit(p.room):
        shine(p, at, height, LAMPS * candela, colour, reach)


def shine(p, at, height, candela, colour, reach=None):
    candela *= BRIGHTNESS * DARK_WALLS.get(p.room.wall, 1.0)
    p.scene.light(
        p.room.name, p.lights, (*at, p.room.floor + height), candela, colour, reach or 4.0 + candela**0.5 * 1.3
    )
    p.lights += 1


def chandeliers(p, name="chandelier", columns=1, rows=1, candela=38.0, drop=0.0, rose=True):
    """Chandeliers on an even net over a four-sided room, each with its light."""
    a, b, c, d = p.room.footprint[:4] if len(p.room.footprint) == 4 else [p.centre] * 4
    flat = 0.13 if p.room.top == "coffer" else 0.004
    for i in range(columns):
        for j in range(rows):
            s, t = (i + 0.5) / columns, (j + 0.5) / rows
            at = lerp(lerp(a, b, s), lerp(d, c, s), t)
            top = p.room.ceiling - p.room.floor - flat - drop
            p.add(name, at, 0.3 * i + 0.2 * j, top, solid=False)
            if drop:
                _cable(p, at, top, drop + flat)
            if rose and p.room.top != "coffer" and not drop:
                p.add("rose", at, 0.0, p.room.ceiling - p.room.floor - 0.003, solid=False)
            light(p, at, top - (1.45 if name == "chandelier_grand" else 1.25), candela)


def by_night(p):
    """The light of a room that is not lit as a whole: of its candles; where none burns, a shimmer in its middle."""
    for place, candela in p.candles.pools:
        shine(p, place[:2], place[2], candela, night.CANDLELIGHT)
    if not p.lights or night.dark(p.room):
        shine(p, p.centre, 0.75 * (p.room.spring - p.room.floor), night.SHIMMER, night.MOON)


def _cable(p, at, top, rise):
    z = p.room.floor + top
    p.scene.local_mesh(
        p.room.name, f"{p.room.name}_cable_{p.count}", tube([(*at, z), (*at, z + rise - 0.004)], 0.015, "brass", 5)
    )


def curtains(p, material=None):
    """A pair of curtains at every window."""
    for index, wall in enumerate(p.walls):
        for hole in p.room.walls[index].holes:
            us, low = [wall.along(q) for q in hole.outline], min(q[2] for q in hole.outline) - p.room.floor
            if low < 0.5 or len(hole.outline) != 4:
                continue
            for u, mirror in ((min(us) - 0.38, 1), (max(us) + 0.38, -1)):
                turn = math.atan2(wall.direction[1], wall.direction[0])
                at = add(wall.point(u, 0)[:2], scale(wall.inward, 0.06))
                name = f"curtain.{material or cloth(p)}"
                if p.fits(p.outline(name, at, turn), walk=True, wall_margin=0.02):
                    p.add(name, at, turn, 0.01)
                    p.taken[index].append((u - 0.3, u + 0.3, 0.0, 3.2))


def fire(p, walls=None):
    """A chimney piece with a mirror or picture over it, and its glow."""
    before = p.count
    if p.stand("fireplace", walls=walls) == 0:
        return False
    wall, (u0, u1, _, _) = next(
        (w, t[-1]) for w, t in p.taken.items() if t and abs(t[-1][1] - t[-1][0] - 2.22) < 0.01 and p.count > before
    )
    u = (u0 + u1) / 2
    own = p.walls[wall]
    embers = night.dark(p.room)
    glow = (1.5, (1.0, 0.28, 0.08), 3.0) if embers else (5.0, (1.0, 0.5, 0.2), 5.0)
    shine(p, add(own.point(u, 0)[:2], scale(own.inward, 0.9)), 0.7, *glow)
    if p.room.spring - p.room.floor > 3.6:
        mirror(p, wall, u, 1.5)
    return True


def mirror(p, wall, u, height):
    """A framed mirror; its panel is an object apart, marked for the renderer."""
    if p.at_wall("mirror_frame", wall, u, height, False):
        own = p.walls[wall]
        turn = math.atan2(own.direction[1], own.direction[0])
        at = add(own.point(u, 0)[:2], scale(own.inward, CLEAR_OF_PICTURE))
        p.add("mirror_panel", at, turn, height, solid=False, extras={"mirror": True})


def pictures(p, kind="portrait", height=1.45, spacing=0.9, numbers=PORTRAITS, most=8):
    p.fill(picture_names(p, kind, numbers), height, spacing, most=most)


def sconces(p, count=4, height=1.95):
    p.hang("sconce", height, max(2, count * 2 // 3))


def consoles(p, count=1):
    """Side tables with a vase or flowers between two candlesticks."""
    for _ in range(count):
        before = {w: len(t) for w, t in p.taken.items()}
        if not p.stand("console"):
            return
        wall = next(w for w, t in p.taken.items() if len(t) > before[w])
        u0, u1, _, _ = p.taken[wall][-1]
        for share, name in (
            (0.5, p.random.choice(["flowers", "vase.0", "vase.1"])),
            (0.22, "candlestick"),
            (0.78, "candlestick"),
        ):
            at = add(p.walls[wall].point(u0 + (u1 - u0) * share, 0)[:2], scale(p.walls[wall].inward, 0.25))
            p.on_top(name, at, 0.875)


def table_group(p, table, chair, seats, near=None, radius=None, rug=None):
    """A table with seats about it, where the whole group fits."""
    shape = p.shape(table)
    radius = radius or shape.size[0] / 2 + 0.3
    at = p.spot(2 * radius + 0.6, 2 * radius + 0.6, near)
    if at is None:
        return None
    if rug:
        p.rug(rug, at, p.random.choice([0.0, math.pi / 2]))
    p.add(table, at)
    p.around(chair, at, radius, seats, p.random.choice([0.4, 0.0, 0.8]))
    p.on_top("candlestick", (at[0] + 0.1, at[1]), shape.high[2])
    return at


def long_table_group(p, table, chair, seats_a_side, near=None):
    """A long table with seats along both sides and at its ends; turned to fit."""
    shape = p.shape(table)
    for turn in (0.0, math.pi / 2):
        at = p.spot(shape.size[0] + 1.3, shape.size[1] + 1.5, near, turn)
        if at is None:
            continue
        p.add(table, at, turn)
        c, s = math.cos(turn), math.sin(turn)
        for k in range(seats_a_side):
            x = shape.size[0] * ((k + 0.5) / seats_a_side - 0.5) * 0.94
            for side in (-1, 1):
                y = side * (shape.size[1] / 2 + 0.22)
                p.add(chair, (at[0] + c * x - s * y, at[1] + s * x + c * y), turn + (math.pi if side > 0 else 0.0))
        for k in (-1, 0, 1):
            p.on_top(
                "candlestick",
                (at[0] + c * k * 0.8, at[1] + s * k * 0.8),
                shape.high[2] if table != "dining_table" else 0.76,
            )
        return at
    return None


# ---- state rooms ---------------------------------------------------------------------------------------------------


def salon(p):
    tone = cloth(p)
    curtains(p)
    fire(p)
    p.stand(f"sofa.{tone}", 1)
    group = table_group(p, "tea_table", f"armchair.{tone}", 4, radius=0.95, rug=f"rug.{RUGS[tone]}")
    if group is None:
        p.rug(f"rug.{RUGS[tone]}")
    consoles(p, 1)
    p.fill(f"chair.{tone}", spacing=0.9, most=4)
    pictures(p, "picture", 1.6, 1.1, SCENES, 4)
    pictures(p, "portrait", 1.55, 0.7, PORTRAITS, 4)
    sconces(p, 2)
    for _ in range(2):
        p.place("candelabrum", near=p.random.choice(p.room.footprint))
    chandeliers(p)


def music(p):
    tone = cloth(p)
    curtains(p)
    fire(p)
    p.place("harpsichord", near=add(p.centre, (0.8, 1.0)))
    p.place("harp", near=add(p.centre, (-1.5, 1.5)))
    for k in range(8):
        p.place(f"chair.{tone}", near=add(p.centre, (-2.0 + 0.7 * (k % 4), 2.6 + 0.8 * (k // 4))), turn=math.pi)
    consoles(p, 1)
    pictures(p, "picture", 1.6, 1.0, SCENES, 4)
    sconces(p, 4)
    chandeliers(p)


def dining(p):
    tone = cloth(p)
    curtains(p)
    long_table_group(p, "dining_table", f"chair.{tone}", 5, near=p.centre)
    fire(p)
    consoles(p, 2)
    p.fill(f"chair.{tone}", spacing=0.9, most=3)
    pictures(p, "picture", 1.6, 0.8, SCENES, 6)
    sconces(p, 4)
    chandeliers(p)


def throne(p):
    p.stand("throne", 1, walls=[2, 3])
    p.rug("great_rug.carpet_red", p.centre)
    for _ in range(4):
        p.place("candelabrum", near=p.random.choice(p.room.footprint))
    p.hang("arms", 1.3, 2)
    p.fill("stool.cloth_red", spacing=0.6, most=8)
    p.hang("trophy", 2.6, 2)
    sconces(p, 4)
    consoles(p, 1)
    chandeliers(p, "chandelier", 1, 1, 42.0)


def cabinet(p):
    tone = cloth(p)
    curtains(p)
    p.stand("cabinet", 4)
    fire(p)
    table_group(p, "tea_table", f"chair.{tone}", 3, radius=0.85, rug=f"rug.{RUGS[tone]}")
    p.stand("wardrobe", 1)
    pictures(p, "portrait", 1.5, 0.6, PORTRAITS, 6)
    p.fill("vase.1", spacing=1.2, most=3)
    sconces(p, 2)
    chandeliers(p, "chandelier_small", candela=30.0)


def study(p):
    tone = cloth(p)
    curtains(p)
    fire(p)
    at = p.place("desk", margin=0.6)
    if at:
        p.put(f"armchair.{tone}", add(at, (0.0, 0.85)), math.pi, margin=-0.05)
        p.on_top("candlestick", add(at, (-0.6, 0.0)), 0.77)
    p.rug(f"rug.{RUGS[tone]}", at)
    p.stand("bookshelf", 2)
    p.stand("clock", 1)
    p.place("globe", near=p.room.footprint[2])
    p.hang("map", 1.3, 2)
    p.stand(f"chair.{tone}", 4)
    p.stand("low_bookshelf", 1)
    pictures(p, "portrait", 1.5, 0.8, PORTRAITS, 4)
    sconces(p, 2)
    chandeliers(p, "chandelier_small", candela=30.0)


def library(p):
    fire(p)
    p.fill("bookshelf", spacing=0.0, most=20)
    big = p.room.ceiling - p.room.floor and (p.room.footprint[1][0] - p.room.footprint[0][0]) > 9
    for _ in range(3 if big else 1):
        long_table_group(p, "long_table", "chair.leather", 3)
    for corner in p.room.footprint[:3]:
        p.place("globe", near=lerp(corner, p.centre, 0.3))
    p.place("armchair.leather")
    for _ in range(2):
        p.place("candelabrum", near=p.random.choice(p.room.footprint))
    sconces(p, 4, 2.6)
    if big:
        a, c = p.room.footprint[0], p.room.footprint[2]
        for at in (
            (a[0] + 2.0, a[1] + 1.8),
            (c[0] - 2.0, a[1] + 1.8),
            (a[0] + 2.0, c[1] - 1.8),
            (c[0] - 2.0, c[1] - 1.8),
        ):
            p.add("chandelier_small", at, 0, p.room.ceiling - p.room.floor - 0.004, solid=False)
            light(p, at, 3.2, 22.0)
    else:
        chandeliers(p, "chandelier_small", candela=30.0)


def upper_library(p):
    p.fill("bookshelf", spacing=0.0, most=18)
    p.fill("stool.leather", spacing=1.5, most=6)
    p.fill("chair.leather", spacing=1.5, most=6)
    for corner in p.room.footprint:
        p.place("globe", near=lerp(corner, p.centre, 0.2))
        p.place("bust.1", near=lerp(corner, p.centre, 0.4))
        at = lerp(corner, p.centre, 0.5)
        p.add("chandelier_small", at, 0, 4.0 - 0.26, solid=False)
        light(p, at, 2.6, 20.0)


def billiard(p):
    at = p.place("billiard_table", margin=0.6) or p.place("billiard_table", turn=math.pi / 2, margin=0.4)
    fire(p)
    p.stand("bench", 3)
    p.fill("chair.leather", spacing=0.8, most=4)
    p.hang("trophy", 2.2, 4)
    pictures(p, "picture", 1.6, 0.8, SCENES, 4)
    sconces(p, 4)
    chandeliers(p, "chandelier_small", 1, 2, 24.0, rose=False)
    return at


def gallery(p):
    """A long room of pictures."""
    curtains(p)
    tone = cloth(p)
    pictures(p, "great_picture", 1.35, 0.9, SCENES, 8)
    pictures(p, "portrait", 1.5, 0.6, PORTRAITS, 12)
    consoles(p, 2)
    p.fill("bust.0", spacing=1.6, most=3)
    p.fill("bench", spacing=1.0, most=6)
    p.fill(f"chair.{tone}", spacing=1.2, most=4)
    sconces(p, 6, 2.1)
    long_side = math.dist(p.room.footprint[0], p.room.footprint[1]) > math.dist(
        p.room.footprint[1], p.room.footprint[2]
    )
    number = max(
        2,
        round(
            max(
                math.dist(p.room.footprint[0], p.room.footprint[1]), math.dist(p.room.footprint[1], p.room.footprint[2])
            )
            / 5
        ),
    )
    turn = math.atan2(*(b - a for a, b in zip(p.room.footprint[0], p.room.footprint[1])))
    if number >= 3 and p.room.footprint[0][1] == p.room.footprint[1][1] and not long_side:
        p.rug(f"runner.{RUGS[tone]}", p.centre, 0.0 if turn else 0.0)
    chandeliers(p, "chandelier_small", number if long_side else 1, 1 if long_side else number, 24.0, rose=False)


def bedroom(p):
    tone = cloth(p)
    plain = p.room.wall.startswith("plaster")
    p.stand(f"bed.{tone}", 1)
    if plain:
        p.stand(f"bed.{tone}", 2)
    curtains(p)
    if not plain:
        fire(p)
    p.rug(f"rug.{RUGS[tone]}", p.centre, math.pi / 2)
    p.stand("wardrobe", 1)
    p.stand("chest", 1)
    table_group(p, "tea_table", f"armchair.{tone}", 2, radius=0.9)
    p.place(f"screen.{tone}", near=p.random.choice(p.room.footprint), margin=0.05)
    consoles(p, 1)
    p.stand(f"chair.{tone}", 2)
    p.stand("side_table", 1)
    pictures(p, "portrait", 1.55, 0.7, PORTRAITS, 4)
    sconces(p, 2)
    chandeliers(p, "chandelier_small" if plain else "chandelier", candela=30.0)


def ballroom(p):
    tone = cloth(p)
    fire(p)
    for wall in (0, 2):
        for share in (0.2, 0.8):
            mirror(p, wall, p.walls[wall].length * share, 0.6)
    p.fill(f"chair.{tone}", spacing=0.15, most=20)
    p.place("harpsichord", near=lerp(p.room.footprint[0], p.centre, 0.4))
    for k in range(5):
        p.place("candelabrum", near=p.room.footprint[k % 4])
    pictures(p, "great_picture", 1.5, 1.0, SCENES, 4)
    sconces(p, 8)
    chandeliers(p, "chandelier_grand", 2, 2, 40.0)


# ---- halls ---------------------------------------------------------------------------------------------------------


def hall(p):
    tone = cloth(p)
    curtains(p)
    fire(p)
    p.stand("bench", 3)
    consoles(p, 2)
    p.stand("clock", 1)
    p.fill(f"chair.{tone}", spacing=0.9, most=4)
    p.fill("bust.1", spacing=1.5, most=3)
    pictures(p, "portrait", 1.5, 0.7, PORTRAITS, 6)
    p.hang("tapestry", 1.2, 1)
    sconces(p, 4)
    chandeliers(p)


def entrance(p):
    p.stand("armour", 4)
    p.fill("bench", spacing=1.0, most=4)
    consoles(p, 2)
    for k, corner in enumerate(p.room.footprint):
        p.place(f"statue.{k}", near=lerp(corner, p.centre, 0.12))
    p.fill("tree.1", spacing=2.0, most=4)
    p.hang("trophy", 2.4, 4)
    p.hang(["arms", "tapestry"], 1.25, 2)
    sconces(p, 4)
    chandeliers(p, "chandelier", 1, 1, 46.0, rose=False)


def marble(p):
    tone = cloth(p)
    curtains(p, tone)
    for k, corner in enumerate(p.room.footprint):
        p.place(f"statue.{k + 1}", near=lerp(corner, p.centre, 0.1))
    for wall in (1, 3):
        mirror(p, wall, p.walls[wall].length * (0.75 if wall == 1 else 0.25), 0.7)
    consoles(p, 2)
    p.fill("vase.0", spacing=1.5, most=4)
    p.fill(f"stool.{tone}", spacing=0.8, most=6)
    sconces(p, 6)
    chandeliers(p, "chandelier_grand", 1, 1, 48.0, rose=False)


def great_hall(p):
    p.hang(["tapestry", "arms"], 1.5, 6)
    fire(p, walls=[0, 2])
    p.fill("armour", spacing=1.8, most=6)
    p.fill("bench", spacing=0.5, most=10)
    p.hang("trophy", 2.6, 6)
    for near in ((15.0, 0.0), (21.0, 5.0), (21.0, -5.0)):
        long_table_group(p, "long_table", "chair.cloth_red", 4, near)
    for k in range(6):
        p.place("candelabrum", near=(13.5 if k % 2 else 24.5, -7.5 + 3 * k))
    p.fill(picture_names(p, "great_picture", SCENES), 6.2, 0.8, most=8)
    p.hang("torch", 2.3, 10)
    chandeliers(p, "chandelier_grand", 2, 3, 60.0, drop=2.6)


def aisle(p):
    for k in range(4):
        p.place(f"statue.{k}", near=(29.3, -7.5 + 4.5 * k), turn=math.pi / 2)
    p.fill("bench", spacing=1.2, most=6)
    p.hang(["tapestry", "arms"], 1.3, 4)
    p.hang("torch", 2.0, 6)
    for y in (-6.0, 0.0, 6.0):
        p.add("lantern", (28.0, y), 0, 4.496, solid=False)
        light(p, (28.0, y), 3.4, 24.0)


def rotunda(p):
    _ring(p, "statue", 5.1)
    _ring_lights(p, 4, 3.1, 3.2, 17.0)
    p.hang("sconce", 2.0, 8)


def belvedere(p):
    _ring(p, "tree", 5.2)
    _ring(p, "bust", 5.2, 0.3)
    for k in range(8):
        angle = math.pi / 4 * k + 0.2
        p.put("bench", add(p.centre, (4.9 * math.cos(angle), 4.9 * math.sin(angle))), angle + math.pi / 2)
    at, top = p.centre, 8.0
    p.add("chandelier_grand", at, 0, top - 2.9, solid=False)
    _cable(p, at, top - 2.9, 2.85)
    light(p, at, 4.0, 60.0, reach=16.0)
    p.hang("sconce", 2.0, 8)


def crypt(p):
    _ring(p, "sarcophagus", 4.4)
    p.hang("torch", 1.3, 8)
    _ring_lights(p, 3, 3.4, 1.9, 14.0, CANDLE, lamp=None)


def _ring(p, kind, radius, first=0.0):
    """Pieces on the diagonals of a round room, facing its middle."""
    for k in range(8):
        angle = math.pi / 4 * k + math.pi / 8 + first
        at = add(p.centre, (radius * math.cos(angle), radius * math.sin(angle)))
        name = f"{kind}.{k % 4}" if kind != "sarcophagus" else kind
        p.put(name, at, angle + math.pi / 2, margin=0.02)


def _ring_lights(p, count, radius, height, candela, colour=WARM, lamp="lantern"):
    for k in range(count):
        angle = 2 * math.pi * (k + 0.5) / count
        at = add(p.centre, (radius * math.cos(angle), radius * math.sin(angle)))
        if lamp:
            p.add(lamp, at, angle, p.room.ceiling - p.room.floor - 0.004, solid=False)
        light(p, at, height, candela, colour)


def guard(p):
    p.fill("weapon_rack", spacing=1.0, most=4)
    long_table_group(p, "long_table", "stool.leather", 3)
    fire(p)
    p.fill("armour", spacing=0.8, most=4)
    p.stand("chest", 3)
    p.stand("bench", 2)
    p.hang("trophy", 2.2, 6)
    p.hang("torch", 1.9, 4)
    p.place("barrel", near=p.room.footprint[0])
    chandeliers(p, "chandelier_small", candela=34.0, rose=False)


def stairs(p):
    p.hang("arms" if p.room.floor >= 0 else "trophy", 1.3, 2)
    pictures(p, "portrait", 1.5, 0.8, PORTRAITS, 4)
    p.stand("bench", 2)
    if p.room.floor >= 0:
        consoles(p, 1)
        p.place("statue.2", near=p.room.footprint[2])
    p.hang("sconce" if p.room.floor >= 0 else "torch", 1.9, 4)
    _off_well_light(p, 20.0 if p.room.floor >= 0 else 18.0)


def landing(p):
    curtains(p)
    pictures(p, "portrait", 1.5, 0.6, PORTRAITS, 6)
    pictures(p, "picture", 1.5, 0.6, SCENES, 3)
    p.fill("bust.0", spacing=1.5, most=3)
    p.fill("chair.cloth_red", spacing=0.7, most=4)
    consoles(p, 1)
    sconces(p, 4)
    chandeliers(p, "chandelier", candela=44.0)


def lobby(p):
    p.stand("bench", 3)
    p.stand("chest", 1)
    p.stand("clock", 1)
    p.fill("chair.leather", spacing=0.8, most=4)
    pictures(p, "picture", 1.5, 0.8, SCENES, 3)
    sconces(p, 3)
    chandeliers(p, "chandelier_small", candela=30.0, rose=False)


def _off_well_light(p, candela):
    """A hanging lantern in the part of a stair hall that has a ceiling."""
    well = next(w for w in WELLS if w.lower == p.room.name)
    x0, y0, x1, y1 = (*p.room.footprint[0], *p.room.footprint[2])
    y = (well.outline[2][1] + y1) / 2 if well.outline[2][1] < y1 - 2 else (y0 + well.outline[0][1]) / 2
    for x in ((2 * x0 + x1) / 3, (x0 + 2 * x1) / 3):
        p.add("lantern", (x, y), 0, p.room.ceiling - p.room.floor - 0.004, solid=False)
        light(p, (x, y), p.room.ceiling - p.room.floor - 1.1, candela)

"""How the service rooms, the chapel, the wing, the cellar and the courtyard are furnished and lit."""

import math

import night
from geometry import add, lerp, scale
from meshes import tube
from ornaments import moon
from themes import (
    CANDLE,
    PORTRAITS,
    SCENES,
    chandeliers,
    fire,
    light,
    long_table_group,
    pictures,
    sconces,
    shine,
    table_group,
)


def kitchen(p):
    p.stand("stove", 1)
    p.place("work_table", margin=0.4)
    p.place("work_table", margin=0.3)
    p.fill("shelves", spacing=0.8, most=3)
    for k in range(5):
        p.place("barrel" if k % 2 else "sack", near=lerp(p.room.footprint[k % 4], p.centre, 0.1))
    p.stand("bench", 2)
    for k in (-1, 1):
        p.add("hanging_pots", add(p.centre, (1.6 * k, 0.8)), 0.0, p.room.ceiling - p.room.floor - 0.004, solid=False)
    for k in (-1, 1):
        at = add(p.centre, (2.0 * k, -1.2))
        p.add("lantern", at, 0, p.room.ceiling - p.room.floor - 0.004, solid=False)
        light(p, at, 3.3, 22.0)


def servants(p):
    long_table_group(p, "long_table", "stool.leather", 4)
    fire(p)
    p.fill("shelves", spacing=1.5, most=2)
    p.stand("wardrobe", 2)
    p.fill("bench", spacing=0.6, most=4)
    p.stand("chest", 2)
    p.place("barrel", near=p.room.footprint[1])
    pictures(p, "portrait", 1.6, 1.2, PORTRAITS, 2)
    sconces(p, 2)
    chandeliers(p, "chandelier_small", candela=32.0, rose=False)


def chapel(p):
    p.stand("altar", 1, walls=[3])
    p.stand("organ", 1, walls=[1, 0, 2])
    for row in range(5):
        for y in (-1.25, 1.25):
            p.put("pew", (-15.6 + 1.25 * row, 21.5 + y), math.pi / 2)
    p.place("font", near=(-9.0, 19.0))
    for k in range(4):
        p.place("candelabrum", near=(-18.0, 18.5 + 2 * k))
    p.fill("statue.3", spacing=2.0, most=4)
    p.hang("torch", 2.4, 4)
    pictures(p, "great_picture", 2.0, 1.0, SCENES, 4)
    for x in (-16.5, -13.5, -10.5):
        at = (x, 21.5)
        p.add("chandelier_small", at, 0, 6.0, solid=False)
        _chain(p, at, 6.0, 4.9)
        light(p, at, 4.8, 42.0, CANDLE, reach=13.0)


def _chain(p, at, low, rise):
    z = p.room.floor + low
    p.scene.local_mesh(
        p.room.name, f"{p.room.name}_chain_{p.count}", tube([(*at, z), (*at, z + rise)], 0.012, "iron", 4)
    )


def treasury(p):
    p.fill("chest", spacing=0.3, most=8)
    p.fill("cabinet", spacing=0.8, most=3)
    for k in range(3):
        p.place(("armour", "globe", "bust.1")[k], near=lerp(p.room.footprint[k], p.centre, 0.4))
    p.hang("trophy", 2.0, 4)
    p.hang("torch", 1.9, 4)
    _vault_lights(p, 22.0)


def sculpture(p):
    u, v = p.walls[0].direction, p.walls[0].inward
    for i in range(5):
        for j in (1.2, 6.8):
            at = add(p.walls[0].start, add(scale(u, 1.2 + 1.9 * i), scale(v, j)))
            p.put(f"statue.{(i + int(j)) % 4}", at, math.atan2(u[1], u[0]) + (0 if j < 4 else math.pi), margin=0.02)
    p.fill("bust.0", spacing=1.3, most=6)
    p.place("bench", turn=math.atan2(u[1], u[0]))
    p.fill("bench", spacing=1.6, most=4)
    pictures(p, "picture", 1.6, 1.4, SCENES, 4)
    sconces(p, 6)
    chandeliers(p, "chandelier", 2, 1, 40.0, rose=False)


def orangery(p):
    u, v = p.walls[0].direction, p.walls[0].inward
    for i in range(6):
        for j in (0.8, 2.4, 5.6, 7.2):
            p.put(f"tree.{(i + int(j)) % 2}", add(p.walls[0].start, add(scale(u, 0.9 + 1.6 * i), scale(v, j))), 0.7 * i)
    for _ in range(3):
        p.place("bench", turn=math.atan2(u[1], u[0]))
    table_group(p, "tea_table", "chair.cloth_green", 4, radius=0.85)
    p.fill("statue.1", spacing=2.0, most=2)
    sconces(p, 6)
    for share in (0.25, 0.75):
        at = lerp(
            lerp(p.room.footprint[0], p.room.footprint[1], share),
            lerp(p.room.footprint[3], p.room.footprint[2], share),
            0.5,
        )
        p.add("lantern", at, 0, p.room.ceiling - p.room.floor - 0.005, solid=False)
        light(p, at, 2.7, 30.0)


def studio(p):
    for k in range(4):
        p.place(f"easel.{(5 * k + 2) % 16}", near=lerp(p.room.footprint[k], p.centre, 0.5), turn=0.9 * k)
    p.place("bust.0")
    p.place("work_table")
    p.stand("shelves", 1)
    p.stand("chest", 1)
    p.fill("stool.leather", spacing=1.0, most=4)
    p.place("statue.0", near=p.room.footprint[1])
    pictures(p, "portrait", 1.6, 0.4, PORTRAITS + SCENES, 8)
    sconces(p, 2)
    chandeliers(p, "chandelier_small", candela=34.0, rose=False)


def bath(p):
    p.place("bath", margin=0.3)
    for k, corner in enumerate(p.room.footprint):
        p.place(f"vase.{k % 2}", near=lerp(corner, p.centre, 0.1))
    p.place("statue.2", near=p.room.footprint[2])
    p.place("screen.cloth_white")
    p.stand("bench", 2)
    p.hang("sconce", 1.8, 4)
    _vault_lights(p, 22.0)


# ---- cellar --------------------------------------------------------------------------------------------------------


def _vault_lights(p, candela, colour=CANDLE):
    """Lanterns under the crown of a vault, every five metres."""
    a, b, c, d = p.room.footprint
    if math.dist(a, b) < math.dist(b, c):
        a, b, c, d = b, c, d, a
    number = max(1, round(math.dist(a, b) / 5.0))
    for k in range(number):
        share = (k + 0.5) / number
        at = lerp(lerp(a, b, share), lerp(d, c, share), 0.5)
        p.add("lantern", at, 0, p.room.ceiling - p.room.floor - 0.005, solid=False)
        light(p, at, p.room.ceiling - p.room.floor - 1.15, candela, colour)


def barrels(p):
    long_walls = sorted(range(4), key=lambda i: -p.walls[i].length)[:2]
    p.fill("cask", spacing=0.35, walls=long_walls[:1], most=8)
    p.fill("wine_rack", spacing=0.4, walls=long_walls[1:], most=3)
    p.fill("barrel", spacing=0.1, most=14)
    for k in range(4):
        p.place("crate", near=lerp(p.room.footprint[k], p.centre, 0.2), turn=0.3 * k)
    table_group(p, "round_table", "stool.leather", 4)
    p.hang("torch", 1.25, 2)
    _vault_lights(p, 16.0)


def store(p):
    p.fill("shelves", spacing=0.6, most=2)
    for k in range(10):
        p.place(
            ("sack", "barrel", "crate")[k % 3],
            near=lerp(p.room.footprint[k % 4], p.centre, 0.1 + 0.05 * k),
            turn=0.4 * k,
        )
    p.stand("chest", 1)
    p.hang("torch", 1.25, 2)
    _vault_lights(p, 15.0)


def dungeon(p):
    p.fill("bench", spacing=1.0, most=4)
    p.stand("chest", 1)
    for k in range(3):
        p.place("barrel", near=p.room.footprint[k])
    p.stand("weapon_rack", 1)
    p.hang("torch", 1.3, 4)
    _vault_lights(p, 12.0)


def undercroft(p):
    p.fill("barrel", spacing=0.6, most=12)
    p.fill("bench", spacing=1.2, most=4)
    for k in range(6):
        p.place("crate", near=lerp(p.room.footprint[k % 4], p.centre, 0.25), turn=0.5 * k)
    p.hang("torch", 1.3, 8)
    _vault_lights(p, 18.0)


def passage(p):
    p.hang("torch", 1.25, 8)
    _vault_lights(p, 10.0)


def cistern(p):
    p.hang("torch", 1.4, 6)
    for x in (4.0, 10.0):
        for y in (-3.0, 3.0):
            light(p, (x + 1.7, y - 1.2), 2.2, 9.0, CANDLE)


def ramp(p):
    """Only lanterns: the passage is for rolling barrels."""
    for (low0, high0), (low1, high1) in zip(p.room.section, p.room.section[1:]):
        y, z = (high0[0] + high1[0]) / 2, (high0[1] + high1[1]) / 2
        light(p, (27.0, y), z - 0.6 - p.room.floor, 10.0, CANDLE)
        if low0[1] == low1[1]:
            p.add("lantern", (27.0, y), 0, z - p.room.floor - 0.004, solid=False)


# ---- courtyard -----------------------------------------------------------------------------------------------------


def court(p):
    at = p.place("fountain")
    if at:
        says = {"classname": "ambient_sound", "sound": "fountain"}
        p.scene.child(p.room.name, "fountain_water", None, (*at[:2], p.room.floor + 1.2), 0.0, says)
    for sx in (-1, 1):
        for sy in (-1, 1):
            for k in range(3):
                p.put("hedge", (sx * (4.6 + 3.2 * (k % 2)), sy * (3.6 + 2.4 * (k // 2))), 0.0)
            p.put(f"statue.{sx + sy + 2}", (sx * 8.5, sy * 4.9), math.pi / 2 * sx)
            for k in range(3):
                p.put(f"tree.{k % 2}", (sx * 10.9, sy * (2.4 + 2.2 * k)))
            p.put("bench", (sx * 6.2, sy * 2.7), 0.0 if sy > 0 else math.pi)
        for sy in (-1, 1):
            p.place("lamp_post", near=(3.4 * sx, 3.2 * sy))
    _pilasters(p)
    for wall in range(4):
        p.fill("tree.1", spacing=2.6, walls=[wall], most=5)
    p.hang("torch", 2.1, 8)
    p.scene.local_mesh(p.room.name, "moon", moon(night.MOON_AT))
    shine(p, night.MOON_AT[:2], night.MOON_AT[2], night.MOON_CANDELA, night.MOON, night.MOON_REACH)


def _pilasters(p):
    """Two orders on the façades, between the openings."""
    for index, wall in enumerate(p.walls):
        u = 0.5
        while u < wall.length - 0.4:
            for name, height in (("pilaster.4550", 0.003), ("pilaster.4300", 4.925)):
                p.at_wall(name, index, u, height, False) if _free(p, index, u, height) else None
            u += 0.5


def _free(p, index, u, height):
    """Whether a pilaster keeps half a metre from openings and two from its neighbours."""
    low, high = (height, height + 4.4)
    return all(u + 0.42 < u0 or u - 0.42 > u1 for u0, u1, z0, z1 in p.taken[index] if z0 < high and z1 > low) and all(
        abs(u - (u0 + u1) / 2) > 2.0
        for u0, u1, z0, z1 in p.taken[index]
        if abs((u1 - u0) - 0.86) < 0.02 and abs(z0 - height) < 0.1
    )

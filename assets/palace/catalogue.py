"""Names of all movable and fixed pieces, and how each is built.  A name may carry a variant after a full stop."""

import fittings
import furniture
import marvels
import moving
import ornaments
from meshes import block

PLAIN = {
    "bench": furniture.bench,
    "pew": furniture.pew,
    "throne": furniture.throne,
    "round_table": furniture.round_table,
    "tea_table": lambda: furniture.round_table(0.45, "wood_dark", "marble_white"),
    "card_table": lambda: furniture.round_table(0.5, "wood_dark", "cloth_green"),
    "side_table": lambda: furniture.table(0.7, 0.5),
    "long_table": lambda: furniture.table(2.6, 0.9, "wood_light", 0.76, 2.0),
    "dining_table": furniture.dining_table,
    "console": furniture.console,
    "desk": furniture.desk,
    "billiard_table": furniture.billiard_table,
    "bookshelf": furniture.bookshelf,
    "low_bookshelf": lambda: furniture.bookshelf(1.5),
    "wardrobe": furniture.wardrobe,
    "chest": furniture.chest,
    "cabinet": furniture.cabinet,
    "shelves": furniture.shelves,
    "barrel": furniture.barrel,
    "cask": furniture.cask,
    "crate": furniture.crate,
    "sack": furniture.sack,
    "wine_rack": furniture.wine_rack,
    "work_table": furniture.work_table,
    "candlestick": ornaments.candlestick,
    "candelabrum": ornaments.candelabrum,
    "chandelier_small": lambda: ornaments.chandelier(6, 0.45, 1, False),
    "chandelier": ornaments.chandelier,
    "chandelier_grand": lambda: ornaments.chandelier(9, 0.95, 2),
    "lantern": ornaments.lantern,
    "sconce": ornaments.sconce,
    "torch": ornaments.torch,
    "lamp_post": ornaments.lamp_post,
    "flowers": ornaments.flowers,
    "mirror_frame": ornaments.mirror,
    "mirror_panel": ornaments.mirror_panel,
    "tapestry": ornaments.hanging,
    "arms": lambda: ornaments.hanging("arms", 2.0, 2.2),
    "map": lambda: ornaments.hanging("old_map", 1.8, 1.3),
    "clock": ornaments.clock,
    "globe": ornaments.globe,
    "harpsichord": ornaments.harpsichord,
    "harp": ornaments.harp,
    "armour": ornaments.armour,
    "weapon_rack": ornaments.weapon_rack,
    "trophy": ornaments.trophy,
    "hedge": ornaments.hedge,
    "newel": fittings.newel,
    "fireplace": fittings.fireplace,
    "rose": fittings.rose,
    "altar": fittings.altar,
    "organ": fittings.organ,
    "fountain": fittings.fountain,
    "font": fittings.font,
    "bath": fittings.bath,
    "sarcophagus": fittings.sarcophagus,
    "stove": fittings.stove,
    "hanging_pots": fittings.hanging_pots,
    "clock_case": moving.clock_case,
    "plinth": moving.plinth,
    "great_clock": marvels.great_clock,
    "orrery_stand": marvels.orrery_stand,
    "globe_stand": marvels.globe_stand,
    "carousel_stand": marvels.carousel_stand,
    "music_box": marvels.music_box,
    "ship_stand": marvels.ship_stand,
    "cage": marvels.cage,
    "post": lambda: block((0.12, 0.12, 1.2), "wood_dark"),
}

VARIANTS = {
    "chair": furniture.chair,
    "armchair": furniture.armchair,
    "sofa": furniture.sofa,
    "stool": furniture.stool,
    "bed": furniture.bed,
    "curtain": furniture.curtain,
    "screen": furniture.folding_screen,
    "vase": lambda kind: ornaments.vase(int(kind)),
    "statue": lambda seed: ornaments.statue(int(seed)),
    "bust": lambda seed: ornaments.bust(int(seed)),
    "tree": lambda kind: ornaments.potted_tree(int(kind)),
    "easel": lambda number: ornaments.easel(int(number)),
    "portrait": lambda number: ornaments.painting(int(number), 0.85, 1.05),
    "picture": lambda number: ornaments.painting(int(number), 1.5, 1.05),
    "great_picture": lambda number: ornaments.painting(int(number), 2.3, 1.6),
    "rug": lambda material: ornaments.carpet(material, 2.0, 3.0),
    "great_rug": lambda material: ornaments.carpet(material, 3.5, 5.0),
    "runner": lambda material: ornaments.runner(material, 1.6, 5),
    "column": lambda size: fittings.column(*_column_size(size)),
    "pillar": lambda millimetres: fittings.pillar(int(millimetres) / 1000),
    "pilaster": lambda millimetres: fittings.pilaster(int(millimetres) / 1000),
    "balustrade": lambda millimetres: fittings.balustrade(int(millimetres) / 1000),
    "coffer": lambda size: fittings.coffer(*_coffer_size(size)),
}

OUT = ".out"


def build(name):
    """Mesh data of a piece: `chair.cloth_red`, `picture.7`, `column.4.500x0.280xmarble_white`; `sconce.out` burns no more."""
    if name.endswith(OUT):
        return build(name[: -len(OUT)]).without("flame")
    plain, _, variant = name.partition(".")
    return VARIANTS[plain](variant) if variant else PLAIN[plain]()


def pillar_name(height):
    return f"pillar.{round(height * 1000)}"


def column_name(height, radius, stone="marble_rose_plain"):
    return f"column.{height:.3f}x{radius:.3f}x{stone}"


def _column_size(text):
    height, radius, stone = text.split("x", 2)
    return float(height), float(radius), stone


def coffer_name(width, depth, material):
    return f"coffer.{round(width * 1e5)}x{round(depth * 1e5)}x{material}"


def _coffer_size(text):
    width, depth, material = text.split("x", 2)
    return int(width) / 1e5, int(depth) / 1e5, material

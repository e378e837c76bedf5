"""The materials of the palace: which texture each wears, how many metres one picture covers, its plain colour."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    colour: tuple  # linear; the whole look where there is no texture
    texture: str = None
    metres: float = 1.0
    rough: float = 0.8
    emission: float = 0.0
    unlit: bool = False


def _paper(name):
    return Material((0.5, 0.4, 0.3), "paper_" + name, 1.0)


MATERIALS = {
    "parquet": Material((0.35, 0.2, 0.1), "parquet", 2.0, 0.5),
    "planks": Material((0.3, 0.18, 0.09), "planks", 2.0, 0.7),
    "wood_panel": Material((0.22, 0.12, 0.06), "wood_panel", 1.0, 0.6),
    "wood_dark": Material((0.14, 0.07, 0.035), "wood_dark", 1.0, 0.5),
    "wood_light": Material((0.45, 0.28, 0.14), "wood_light", 1.0, 0.5),
    "wood_white": Material((0.78, 0.75, 0.68)),
    "wainscot": Material((0.7, 0.67, 0.6), "wainscot", 1.0),
    "marble_check": Material((0.5, 0.5, 0.5), "marble_check", 2.0, 0.3),
    "marble_rose": Material((0.6, 0.45, 0.4), "marble_rose", 2.0, 0.3),
    "marble_rose_plain": Material((0.4, 0.17, 0.14), "marble_rose_plain", 1.0, 0.3),
    "marble_cream": Material((0.7, 0.64, 0.54), "marble_cream", 2.0, 0.4),
    "marble_white": Material((0.8, 0.79, 0.77), "marble_white", 1.0, 0.4),
    "marble_dark": Material((0.14, 0.2, 0.16), "marble_dark", 1.0, 0.3),
    "stone_wall": Material((0.45, 0.41, 0.35), "stone_wall", 2.0, 0.9),
    "stone_block": Material((0.5, 0.46, 0.39), "stone_block", 2.0, 0.9),
    "stone_trim": Material((0.6, 0.56, 0.49), "stone_trim", 1.0, 0.9),
    "flagstone": Material((0.3, 0.28, 0.26), "flagstone", 2.0, 0.9),
    "cobbles": Material((0.3, 0.29, 0.27), "cobbles", 2.0, 0.9),
    "brick": Material((0.4, 0.2, 0.14), "brick", 1.5, 0.9),
    "plaster": Material((0.8, 0.78, 0.73), "plaster", 2.0, 0.9),
    "plaster_warm": Material((0.74, 0.66, 0.52), "plaster_warm", 2.0, 0.9),
    "plaster_ochre": Material((0.72, 0.55, 0.3), "plaster_ochre", 2.0, 0.9),
    "dome_blue": Material((0.5, 0.6, 0.72), "plaster", 2.0, 0.9),
    "stars": Material((0.05, 0.08, 0.25), "stars", 2.0, 0.9),
    "roof_tiles": Material((0.35, 0.16, 0.1), "roof_tiles", 2.0, 0.9),
    "water": Material((0.04, 0.12, 0.13), "water", 2.0, 0.1),
    "paper_red": _paper("red"),
    "paper_green": _paper("green"),
    "paper_blue": _paper("blue"),
    "paper_gold": _paper("gold"),
    "paper_rose": _paper("rose"),
    "paper_ivory": _paper("ivory"),
    "gold": Material((0.72, 0.5, 0.17), rough=0.35),
    "brass": Material((0.55, 0.4, 0.15), rough=0.35),
    "iron": Material((0.09, 0.09, 0.1), rough=0.5),
    "steel": Material((0.45, 0.47, 0.5), rough=0.35),
    "porcelain": Material((0.75, 0.8, 0.88), rough=0.2),
    "cobalt": Material((0.06, 0.12, 0.4), rough=0.2),
    "terracotta": Material((0.5, 0.24, 0.13), rough=0.9),
    "wax": Material((0.85, 0.8, 0.66)),
    "flame": Material((1.0, 0.72, 0.3), emission=2.0),
    "ember": Material((1.0, 0.3, 0.06), emission=1.5),
    "soot": Material((0.03, 0.027, 0.025)),
    "crystal": Material((0.82, 0.86, 0.9), rough=0.1),
    "ivory": Material((0.82, 0.77, 0.64), rough=0.4),
    "ebony": Material((0.035, 0.03, 0.028), rough=0.3),
    "earth": Material((0.09, 0.06, 0.04)),
    "mirror": Material((0.3, 0.35, 0.4), rough=0.05),
    "leaves": Material((0.1, 0.2, 0.05), "leaves", 1.0),
    "cloth_red": Material((0.3, 0.03, 0.04), "cloth_red", 0.5),
    "cloth_blue": Material((0.05, 0.12, 0.3), "cloth_blue", 0.5),
    "cloth_green": Material((0.05, 0.15, 0.06), "cloth_green", 0.5),
    "cloth_gold": Material((0.5, 0.33, 0.1), "cloth_gold", 0.5),
    "cloth_white": Material((0.75, 0.72, 0.65), "cloth_white", 0.5),
    "leather": Material((0.16, 0.07, 0.03), "leather", 0.5),
    "paintings": Material((0.3, 0.25, 0.2), "paintings"),
    "tapestry": Material((0.25, 0.25, 0.15), "tapestry"),
    "arms": Material((0.15, 0.16, 0.25), "arms"),
    "books": Material((0.25, 0.12, 0.08), "books"),
    "old_map": Material((0.6, 0.5, 0.3), "old_map"),
    "carpet_red": Material((0.3, 0.06, 0.06), "carpet_red"),
    "carpet_blue": Material((0.08, 0.12, 0.25), "carpet_blue"),
    "carpet_green": Material((0.07, 0.15, 0.08), "carpet_green"),
    "sky": Material((0.02, 0.03, 0.08), "sky", 1.0, unlit=True),
    "moon": Material((0.9, 0.9, 0.84), "moon", 1.0, unlit=True),
}

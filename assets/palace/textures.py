"""Surfaces painted with numpy: wood, stone, marble, brick, plaster, paper, cloth, tiles, sky.  All of them tile.

A texture is an array (height, width, 3) of sRGB values 0..1 whose first row is the bottom of the picture.
"""

import numpy as np


def rgb(text):
    """A colour from its hexadecimal name."""
    return np.array([int(text[i : i + 2], 16) for i in (0, 2, 4)]) / 255.0


def mix(a, b, share):
    return a + (b - a) * np.clip(share, 0.0, 1.0)[..., None]


def coordinates(size):
    """x and y of every pixel's middle, 0..1."""
    axis = (np.arange(size) + 0.5) / size
    return np.meshgrid(axis, axis)


def noise(size, seed, falloff=1.6, stretch=(1.0, 1.0)):
    """Periodic noise with spectrum 1/f^falloff, mean 0, deviation 1; `stretch` lengthens it along x and y."""
    rng = np.random.default_rng(seed)
    fy, fx = np.meshgrid(np.fft.fftfreq(size) * size, np.fft.fftfreq(size) * size, indexing="ij")
    radius = np.hypot(fx * stretch[0], fy * stretch[1])
    radius[0, 0] = 1.0
    spectrum = np.fft.fft2(rng.standard_normal((size, size))) / radius**falloff
    spectrum[0, 0] = 0.0
    field = np.fft.ifft2(spectrum).real
    return field / field.std()


def cell_values(index, seed, spread=1.0):
    """A repeatable random value, -spread..spread, for every number in an array of whole numbers."""
    table = np.random.default_rng(seed).uniform(-spread, spread, 4096)
    return table[np.asarray(index).astype(int) % 4096]


def grain(size, seed, dark, light, along="y"):
    """Wood: streaks along one axis."""
    stretch = (1.0, 14.0) if along == "y" else (14.0, 1.0)
    streaks = noise(size, seed, 1.3, stretch) + 0.35 * noise(size, seed + 1, 0.6, stretch)
    return mix(rgb(dark), rgb(light), 0.5 + 0.28 * streaks)


def planks():
    size, count = 512, 8
    x, y = coordinates(size)
    board = np.floor(x * count)
    end = (y + cell_values(board, 3) * 0.5) % 1.0
    wood = grain(size, 11, "4a2f1a", "8a6038")
    tone = 1.0 + 0.16 * cell_values(board + 50 * np.floor(end * 2), 5)
    gap = np.minimum.reduce([x * count % 1.0, 1 - x * count % 1.0, (end * 2 % 1.0) * 6, (1 - end * 2 % 1.0) * 6])
    return wood * (tone * np.where(gap < 0.035, 0.45, 1.0))[..., None]


def parquet():
    """Versailles squares: each of four panels of a picture laid in a basket weave with a frame."""
    size, panels = 512, 2
    x, y = coordinates(size)
    px, py = x * panels % 1.0, y * panels % 1.0
    turned = (np.floor(px * 4) + np.floor(py * 4)) % 2 == 0
    across = np.where(turned, px, py)
    wood = np.where(turned[..., None], grain(size, 21, "6b4322", "b07d48"), grain(size, 22, "5c381b", "9c6c3b", "x"))
    strip = np.floor(across * 16) + 64 * np.floor(px * 4) + 640 * np.floor(py * 4)
    tone = 1.0 + 0.14 * cell_values(strip, 7)
    edge = np.minimum.reduce([px, 1 - px, py, 1 - py])
    seam = np.minimum(across * 16 % 1.0, 1 - across * 16 % 1.0)
    result = wood * (tone * np.where(seam < 0.07, 0.72, 1.0))[..., None]
    frame = grain(size, 23, "3c2413", "6e4826")
    result = np.where((edge < 0.06)[..., None], frame, result)
    return result * np.where(np.abs(edge - 0.06) < 0.006, 0.5, 1.0)[..., None]


def raised_panel(base, low, high, size=256):
    """A framed panel a metre square, its bevel lit from above."""
    x, y = coordinates(size)
    edge = np.minimum.reduce([x, 1 - x, y - low, high - y])
    bevel = (edge > 0.09) & (edge < 0.13)
    lit = np.where((high - y < edge + 0.002) | (1 - x < edge + 0.002), 0.78, 1.14)
    shade = np.where(bevel, lit, np.where(edge > 0.13, 1.03, 1.0))
    shade = np.where(np.abs(edge - 0.09) < 0.008, 0.62, shade)
    return np.clip(base * shade[..., None], 0, 1)


def wood_panel():
    return raised_panel(grain(256, 31, "4d2d17", "895a2f"), 0.02, 0.98)


def wainscot():
    base = rgb("d9d2c0") * (1 + 0.02 * noise(256, 33, 1.0))[..., None]
    return raised_panel(base, 0.1, 0.94)


def marble(size, seed, ground, cloud, vein, sharp=9.0):
    """Clouds with thin veins where a warped noise crosses zero."""
    base = mix(rgb(ground), rgb(cloud), 0.5 + 0.3 * noise(size, seed, 1.7))
    line = np.exp(-sharp * np.abs(noise(size, seed + 1, 1.9)))
    fine = np.exp(-2.5 * sharp * np.abs(noise(size, seed + 2, 1.6)))
    return mix(base, rgb(vein), 0.55 * line + 0.3 * fine)


def marble_check():
    size = 512
    x, y = coordinates(size)
    white = marble(size, 41, "e6e0d4", "d2cabb", "9c9384")
    black = marble(size, 45, "23211f", "383531", "8d8577", 14.0)
    dark = (np.floor(x * 4) + np.floor(y * 4)) % 2 == 0
    joint = np.minimum.reduce([x * 4 % 1.0, 1 - x * 4 % 1.0, y * 4 % 1.0, 1 - y * 4 % 1.0]) < 0.012
    return np.where(joint[..., None], rgb("6d675e"), np.where(dark[..., None], black, white))


def marble_rose():
    """Cream squares with rose lozenges at their corners and a grey band."""
    size = 512
    x, y = coordinates(size)
    cream = marble(size, 51, "e3d6bf", "d3c3a6", "b09a7a")
    rose = marble(size, 55, "a35c50", "8c463d", "d8b0a0", 12.0)
    grey = marble(size, 59, "6f7570", "565d59", "aab0aa", 12.0)
    px, py = x * 2 % 1.0 - 0.5, y * 2 % 1.0 - 0.5
    corner = (0.5 - np.abs(px)) + (0.5 - np.abs(py))
    band = np.minimum(0.5 - np.abs(px), 0.5 - np.abs(py))
    result = np.where((band < 0.045)[..., None], grey, cream)
    result = np.where((corner < 0.24)[..., None], rose, result)
    result = np.where((np.abs(px) + np.abs(py) < 0.14)[..., None], rose, result)
    return result * np.where((np.abs(corner - 0.24) < 0.008) | (np.abs(band - 0.045) < 0.003), 0.7, 1.0)[..., None]


def courses(size, rows, columns, seed, joint, shift=0.5):
    """Masonry: number of every pixel's stone, and its distance from the nearest joint in stone heights."""
    x, y = coordinates(size)
    row = np.floor(y * rows)
    across = (x * columns + shift * (row % 2)) % columns
    stone = np.floor(across) + 37 * row + seed
    along = across % 1.0
    gap_x = np.minimum(along, 1 - along) * rows / columns
    gap_y = np.minimum(y * rows % 1.0, 1 - y * rows % 1.0)
    return stone, np.minimum(gap_x, gap_y) / joint


def masonry(size, rows, columns, seed, colours, mortar, joint, rough=0.1, spread=0.12):
    stone, gap = courses(size, rows, columns, seed, joint)
    base = mix(rgb(colours[0]), rgb(colours[1]), 0.5 + 0.5 * cell_values(stone, seed))
    base = base * (1 + spread * cell_values(stone, seed + 1) + rough * noise(size, seed, 1.0))[..., None]
    bevel = np.clip(gap - 1.0, 0.0, 1.0)
    return np.clip(
        mix(rgb(mortar) * (1 + 0.05 * noise(size, seed + 2, 0.8))[..., None], base, np.clip(gap * 1.5 - 0.5, 0, 1))
        * (0.86 + 0.14 * bevel)[..., None],
        0,
        1,
    )


def flagstone():
    return masonry(512, 4, 3, 71, ("837d72", "6a655c"), "3d3934", 0.025, 0.09)


def cobbles():
    return masonry(512, 14, 12, 73, ("7d776c", "5a564f"), "35322d", 0.12, 0.08, 0.2)


def brick():
    return masonry(512, 18, 6, 75, ("8d4a34", "6b3526"), "9a8f7f", 0.07, 0.1, 0.16)


def stone_wall():
    return masonry(512, 5, 3, 77, ("b3a78f", "9c9079"), "756b59", 0.022, 0.07, 0.07)


def stone_block():
    return masonry(512, 4, 2, 79, ("b8ab90", "a3967c"), "6a5f4e", 0.05, 0.06, 0.06)


def roof_tiles():
    size = 256
    x, y = coordinates(size)
    row = np.floor(y * 10)
    across = (x * 12 + 0.5 * (row % 2)) % 1.0
    curve = np.sin(np.pi * across)
    tone = 1 + 0.2 * cell_values(np.floor(x * 12 + 0.5 * (row % 2)) % 12 + 31 * row, 81)
    lip = 0.6 + 0.4 * np.clip((y * 10 % 1.0) * 4, 0, 1)
    return np.clip(rgb("8d4b32") * ((0.55 + 0.45 * curve) * tone * lip)[..., None], 0, 1)


def tinted(colour, seed, strength=0.035, falloff=1.2, size=256):
    return np.clip(rgb(colour) * (1 + strength * noise(size, seed, falloff))[..., None], 0, 1)


def paper(ground, figure, seed):
    """Damask: an ogee trellis with a palmette in every mesh, figure and ground of near tone."""
    size = 256
    x, y = coordinates(size)
    wave = 0.25 * np.sin(2 * np.pi * y * 2) / 2
    trellis = np.minimum(np.abs((x + wave) * 2 % 1.0 - 0.5), np.abs((x - wave) * 2 % 1.0 - 0.5)) < 0.045
    figure_mask = _palmette(x * 2 % 1.0, y * 2 % 1.0) | _palmette((x * 2 + 0.5) % 1.0, (y * 2 + 0.5) % 1.0)
    weave = 1 + 0.03 * np.sin(2 * np.pi * x * 64) * np.sin(2 * np.pi * y * 64) + 0.02 * noise(size, seed, 1.0)
    share = np.where(figure_mask, 1.0, np.where(trellis, 0.7, 0.0))
    return np.clip(mix(rgb(ground), rgb(figure), share) * weave[..., None], 0, 1)


def _palmette(px, py):
    """A leaf of seven lobes about the middle of a mesh."""
    dx, dy = (px - 0.5) * 1.3, py - 0.45
    radius, angle = np.hypot(dx, dy), np.arctan2(dx, dy)
    leaf = radius < 0.17 * (0.62 + 0.38 * np.abs(np.cos(3.5 * angle))) * (1 + 0.35 * np.cos(angle))
    heart = radius < 0.035
    stem = (np.abs(dx) < 0.012) & (dy < 0) & (dy > -0.2)
    return (leaf & ~heart) | stem


def stars():
    size = 256
    x, y = coordinates(size)
    px, py = x * 4 % 1.0 - 0.5, (y * 4 + 0.5 * (np.floor(x * 4) % 2)) % 1.0 - 0.5
    radius, angle = np.hypot(px, py), np.arctan2(py, px)
    star = radius < 0.09 + 0.07 * np.cos(5 * angle)
    return mix(tinted("27407a", 91, 0.06), rgb("e2c068"), star.astype(float))


def water():
    ripple = noise(256, 93, 1.6) + 0.5 * noise(256, 94, 1.1)
    return mix(rgb("123a3c"), rgb("3f7f7c"), 0.4 + 0.2 * ripple)


def sky():
    """The dome's picture by night: up is from the horizon to the zenith, across is the folded compass."""
    size = 1024
    x, y = coordinates(size)
    clear = mix(rgb("24365e"), rgb("0a1230"), np.sqrt(y) * 1.15)
    glow = sum(_starlight(size, seed, number, brightness) for seed, number, brightness in ((1, 600, 0.4), (2, 200, 0.7), (3, 60, 1.0)))
    cloud = noise(size, 95, 1.9, (2.4, 1.0)) + 0.3 * noise(size, 96, 1.3)
    cover = np.clip(cloud * 0.45 - 0.25, 0, 1) * np.clip(y * 6, 0, 1) * np.clip((1 - y) * 3, 0, 1)
    night = np.clip(clear + glow[..., None] * np.array([1.0, 0.97, 0.9]), 0, 1)
    return mix(night, rgb("3a4a70"), cover)


def _starlight(size, seed, number, brightness):
    """Stars strewn evenly over the dome: fewer towards the zenith, where the picture is gathered to a point."""
    rng = np.random.default_rng(700 + seed)
    field = np.zeros((size, size))
    across, high = rng.integers(1, size - 1, number), (np.arcsin(rng.uniform(0.0, 0.97, number)) / (np.pi / 2) * size).astype(int)
    for px, py, light in zip(across, np.clip(high, 1, size - 2), rng.uniform(0.3, 1.0, number) * brightness):
        field[py, px] += light
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            field[py + dy, px + dx] += 0.35 * light
    return field


def moon():
    """The full moon: bright, with seas, a little darker at its rim."""
    size = 64
    x, y = coordinates(size)
    seas = np.clip(noise(size, 98, 2.0) * 0.9 + 0.1, 0, 1)
    face = mix(rgb("f7f3e2"), rgb("b9bcc0"), seas * 0.75)
    return face * (1.0 - 0.25 * np.clip(np.hypot(x - 0.5, y - 0.5) * 2, 0, 1) ** 4)[..., None]


def cloth(colour, seed):
    size = 128
    x, y = coordinates(size)
    weave = 0.05 * np.sin(2 * np.pi * x * 32) + 0.05 * np.sin(2 * np.pi * y * 32)
    return np.clip(rgb(colour) * (1 + weave + 0.05 * noise(size, seed, 0.9))[..., None], 0, 1)


def leaves():
    size = 256
    field = noise(size, 97, 0.9)
    return mix(rgb("1c3314"), rgb("5d8a3a"), 0.45 + 0.25 * field)


PAPERS = {
    "red": ("7a1f24", "95383a"),
    "green": ("2f4f3a", "44694f"),
    "blue": ("34506f", "4d6c8d"),
    "gold": ("a5803c", "c29c55"),
    "rose": ("b27f78", "c69a90"),
    "ivory": ("cfc3a6", "ded4bb"),
}

SURFACES = {
    "parquet": parquet,
    "planks": planks,
    "wood_panel": wood_panel,
    "wainscot": wainscot,
    "wood_dark": lambda: grain(256, 25, "2a170c", "5a3519"),
    "wood_light": lambda: grain(256, 27, "8a5c2e", "bd8c53"),
    "marble_check": marble_check,
    "marble_rose": marble_rose,
    "marble_cream": lambda: marble(512, 61, "ddd0b6", "cdbd9d", "a8926c"),
    "marble_rose_plain": lambda: marble(256, 69, "a9685c", "8f4d44", "dcb8a8", 12.0),
    "marble_white": lambda: marble(256, 63, "eae7e1", "d8d4cc", "aaa59b"),
    "marble_dark": lambda: marble(256, 65, "26382f", "33493c", "8fa595", 12.0),
    "stone_wall": stone_wall,
    "stone_block": stone_block,
    "stone_trim": lambda: tinted("b9ae98", 67, 0.05, 0.9),
    "flagstone": flagstone,
    "cobbles": cobbles,
    "brick": brick,
    "plaster": lambda: tinted("e4dfd2", 83, 0.015),
    "plaster_warm": lambda: tinted("d6c6a2", 85, 0.03),
    "plaster_ochre": lambda: tinted("cfa65c", 87, 0.04),
    "stars": stars,
    "roof_tiles": roof_tiles,
    "water": water,
    "sky": sky,
    "moon": moon,
    "leaves": leaves,
    "cloth_red": lambda: cloth("8c1f26", 101),
    "cloth_blue": lambda: cloth("2c4a78", 102),
    "cloth_green": lambda: cloth("2f5a3c", 103),
    "cloth_gold": lambda: cloth("b48a3c", 104),
    "cloth_white": lambda: cloth("e6e0d2", 105),
    "leather": lambda: tinted("5b3018", 106, 0.1, 1.0),
}
SURFACES.update(
    {
        f"paper_{name}": (lambda pair=pair, seed=110 + i: paper(*pair, seed))
        for i, (name, pair) in enumerate(PAPERS.items())
    }
)

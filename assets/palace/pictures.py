"""Pictures painted with numpy: landscapes, seas, portraits, still lifes, tapestries, carpets, maps, backs of books.

Like textures, arrays (height, width, 3) of sRGB values 0..1 with the bottom row first; these do not tile.
"""

import numpy as np

from textures import cell_values, coordinates, mix, noise, rgb

PAINTINGS_ACROSS = 4  # the atlas of paintings is a square of 4 x 4


def _disc(x, y, cx, cy, rx, ry):
    """Soft-edged ellipse: 1 inside, 0 outside."""
    return np.clip((1 - np.hypot((x - cx) / rx, (y - cy) / ry)) * 12, 0, 1)


def _skyline(size, seed, base, height):
    """Height of a row of hills over every column."""
    return base + height * noise(size, seed, 1.8)[0]


def landscape(size, seed):
    rng = np.random.default_rng(seed)
    x, y = coordinates(size)
    dusk = rng.uniform(0, 1)
    low = mix(rgb("f0d9a0"), rgb("e7a86a"), np.full((1,), dusk))[0]
    image = mix(low + 0 * x[..., None], rgb("5f86a8"), (y - 0.35) * 1.6)
    clouds = noise(size, seed + 1, 1.7, (2.5, 1.0))
    image = mix(image, rgb("f4e6cf"), np.clip(clouds * 0.4, 0, 0.8) * (y > 0.45))
    image = mix(image, rgb("fff3cf"), _disc(x, y, rng.uniform(0.2, 0.8), 0.62, 0.07, 0.07))
    for k, (base, tone) in enumerate(((0.5, "6f8a8c"), (0.4, "57764f"), (0.28, "3d5a33"), (0.14, "2c3d22"))):
        hills = _skyline(size, seed + 10 + k, base, 0.035)
        image = np.where((y < hills[None, :])[..., None], rgb(tone) * (1 + 0.6 * (y - 0.2))[..., None], image)
    for _ in range(9):
        cx, cy, r = rng.uniform(0, 1), rng.uniform(0.1, 0.3), rng.uniform(0.03, 0.08)
        image = mix(image, rgb("1d2f17"), _disc(x, y, cx, cy + r, r, 1.3 * r) * 0.9)
        image = mix(image, rgb("241a10"), ((np.abs(x - cx) < 0.006) & (y < cy + r) & (y > cy - r)).astype(float))
    return _brushed(image, seed)


def seascape(size, seed):
    rng = np.random.default_rng(seed)
    x, y = coordinates(size)
    image = mix(rgb("d9c9a5") + 0 * x[..., None], rgb("54718c"), (y - 0.4) * 1.5)
    image = mix(image, rgb("eee3cf"), np.clip(noise(size, seed + 2, 1.6, (2.0, 1.0)) * 0.35, 0, 0.7) * (y > 0.45))
    waves = noise(size, seed + 3, 1.2, (5.0, 1.0))
    sea = mix(rgb("20404f"), rgb("7fa0a0"), 0.35 + 0.18 * waves)
    image = np.where((y < 0.4)[..., None], sea, image)
    for _ in range(3):
        cx, s = rng.uniform(0.15, 0.85), rng.uniform(0.07, 0.16)
        hull = (np.abs(x - cx) < s * (0.7 + (y - 0.38) * 2)) & (y > 0.38 - 0.1 * s) & (y < 0.38 + 0.28 * s)
        image = mix(image, rgb("2e1c10"), hull.astype(float))
        for k in (-0.4, 0.1, 0.5):
            sail = (np.abs(x - cx - k * s) < 0.25 * s) & (y > 0.38 + 0.4 * s) & (y < 0.38 + (1.9 - abs(k)) * s)
            image = mix(image, rgb("e8dcc0"), sail * (0.8 + 0.2 * np.sin(40 * x)))
    return _brushed(image, seed)


def portrait(size, seed):
    rng = np.random.default_rng(seed)
    x, y = coordinates(size)
    coat = rgb(rng.choice(["5a1a1e", "1e2f4a", "23402c", "3a2a1a", "4a2a4e", "1c1c20"]))
    image = mix(rgb("2e2418") + 0 * x[..., None], rgb("6a543a"), _disc(x, y, 0.4, 0.65, 0.9, 0.9) * 0.6 * (1 - y))
    shoulders = np.clip((0.42 - np.abs(x - 0.5) * (0.75 + 0.5 * np.abs(x - 0.5)) - y + 0.06) * 14, 0, 1)
    image = mix(image, coat, shoulders)
    hair = rgb(rng.choice(["d8d2c4", "3a2414", "1e1610", "8a5a2a"]))
    image = mix(image, hair, _disc(x, y, 0.5, 0.66, 0.17, 0.21))
    image = mix(image, rgb("caa07c"), _disc(x, y, 0.5, 0.43, 0.06, 0.13))
    image = mix(image, rgb("d9b08c"), _disc(x, y, 0.5, 0.62, 0.115, 0.16))
    image = mix(image, rgb("a87450"), _disc(x, y, 0.57, 0.6, 0.05, 0.13) * 0.5)
    for eye in (0.455, 0.545):
        image = mix(image, rgb("2a1a12"), _disc(x, y, eye, 0.645, 0.018, 0.011))
    image = mix(image, rgb("9a4a40"), _disc(x, y, 0.5, 0.545, 0.032, 0.012))
    image = mix(image, rgb("b98660"), _disc(x, y, 0.505, 0.595, 0.014, 0.03) * 0.7)
    collar = _disc(x, y, 0.5, 0.385, 0.12, 0.055)
    image = mix(image, rgb("ece6d8"), collar)
    if rng.uniform() < 0.5:
        image = mix(image, rgb("c9a24a"), ((np.abs(x - 0.5 - (0.4 - y) * 0.5) < 0.025) & (y < 0.36)).astype(float))
    return _brushed(image, seed, 0.04)


def still_life(size, seed):
    rng = np.random.default_rng(seed)
    x, y = coordinates(size)
    image = mix(rgb("241a12") + 0 * x[..., None], rgb("57432c"), y * 0.7)
    image = np.where((y < 0.28)[..., None], rgb("6b4a2a") * (0.6 + y[..., None]), image)
    image = mix(image, rgb("3f5f74"), _disc(x, y, 0.5, 0.38, 0.1, 0.16))
    for _ in range(26):
        angle, reach = rng.uniform(0, np.pi), rng.uniform(0.05, 0.28)
        cx, cy, r = 0.5 + reach * np.cos(angle), 0.56 + reach * np.sin(angle) * 0.9, rng.uniform(0.03, 0.065)
        tone = rgb(rng.choice(["b03a3a", "d98a4a", "e6cf7a", "e8e0d8", "8a4a7a", "3e6a34"]))
        image = mix(image, tone * 0.6, _disc(x, y, cx, cy, r, r))
        image = mix(image, tone, _disc(x, y, cx - r * 0.2, cy + r * 0.25, r * 0.65, r * 0.65))
    for k, tone in enumerate(("a83226", "c9a238", "7d9a3c", "a83226")):
        cx = 0.2 + 0.17 * k + (0.12 if k > 1 else 0)
        image = mix(image, rgb(tone), _disc(x, y, cx, 0.25, 0.07, 0.07))
        image = mix(image, rgb("fff0d0"), _disc(x, y, cx - 0.02, 0.28, 0.018, 0.018) * 0.7)
    return _brushed(image, seed)


def _brushed(image, seed, strength=0.01):
    """Strokes, and varnish that has darkened towards the frame."""
    size = image.shape[0]
    x, y = coordinates(size)
    strokes = 1 + strength * noise(size, seed + 77, 0.9, (2.5, 1.0))
    dark = 1 - 0.35 * np.clip(np.hypot(x - 0.5, y - 0.5) * 1.5 - 0.35, 0, 1)
    return np.clip(image * (strokes * dark)[..., None] * np.array([1.0, 0.97, 0.88]), 0, 1)


def paintings():
    """The atlas: rows of landscapes, portraits, seas with still lifes, portraits."""
    painters = [landscape] * 4 + [portrait] * 4 + [seascape, still_life] * 2 + [portrait, landscape] * 2
    tiles = [painter(256, 1000 + 31 * i) for i, painter in enumerate(painters)]
    rows = [np.concatenate(tiles[r * 4 : r * 4 + 4], axis=1) for r in range(4)]
    return np.concatenate(rows, axis=0)


def tapestry():
    """A verdure: leaves of many greens about a white hart, in a border of flowers."""
    size = 256
    x, y = coordinates(size)
    leaf = noise(size, 201, 0.8)
    image = mix(rgb("1f3a34"), rgb("6f8048"), 0.45 + 0.22 * leaf)
    image = mix(image, rgb("b8a45c"), (noise(size, 202, 1.0) > 1.9).astype(float) * 0.8)
    for cx, cy, rx, ry in ((0.5, 0.45, 0.15, 0.07), (0.63, 0.55, 0.04, 0.1), (0.67, 0.63, 0.06, 0.035)):
        image = mix(image, rgb("d9cfb4"), _disc(x, y, cx, cy, rx, ry))
    for leg in (0.39, 0.44, 0.57, 0.61):
        image = mix(image, rgb("cfc4a8"), ((np.abs(x - leg) < 0.012) & (y < 0.44) & (y > 0.24)).astype(float))
    edge = np.minimum.reduce([x, 1 - x, y, 1 - y])
    flowers = np.sin(2 * np.pi * x * 16) * np.sin(2 * np.pi * y * 16) > 0.35
    border = np.where(flowers[..., None], rgb("c98a5a"), rgb("6a1f22"))
    image = np.where((edge < 0.09)[..., None], border, image)
    image = np.where(((edge > 0.09) & (edge < 0.105))[..., None], rgb("c9a850"), image)
    weave = 1 + 0.05 * np.sin(2 * np.pi * y * 128)
    return np.clip(image * weave[..., None], 0, 1)


def arms():
    """A hanging with a coat of arms: quartered shield under a crown, on a blue ground sown with lozenges."""
    size = 256
    x, y = coordinates(size)
    fx, fy = np.abs(x - 0.5), y - 0.48
    sown = np.abs(x * 14 % 1.0 - 0.5) + np.abs((y * 14 + 0.5 * (np.floor(x * 14) % 2)) % 1.0 - 0.5) < 0.17
    image = mix(rgb("26365e") + 0 * x[..., None], rgb("b8964e"), sown.astype(float))
    shield = (fx < 0.24) & (fy < 0.22) & (fy > -0.28 + 1.1 * np.clip(fx - 0.02, 0, 1) ** 1.5)
    quarter = (x > 0.5) ^ (fy > 0.0)
    image = np.where(shield[..., None], np.where(quarter[..., None], rgb("8c2a2a"), rgb("d9c48a")), image)
    cross = shield & ((fx < 0.02) | (np.abs(fy) < 0.02))
    image = np.where(cross[..., None], rgb("e6dcc4"), image)
    for cx, cy, tone in (
        (0.39, 0.11, "8c2a2a"),
        (0.61, -0.1, "8c2a2a"),
        (0.61, 0.11, "e6dcc4"),
        (0.39, -0.1, "e6dcc4"),
    ):
        image = mix(image, rgb(tone), _disc(x, fy, cx, cy, 0.05, 0.06))
    crown = (fx < 0.16) & (fy > 0.25) & (fy < 0.3 + 0.06 * np.abs(np.cos(np.pi * (x - 0.5) / 0.08)))
    image = np.where(crown[..., None], rgb("d8ae4a"), image)
    edge = np.minimum.reduce([x, 1 - x, y, 1 - y])
    image = np.where((edge < 0.06)[..., None], rgb("7a2426"), image)
    image = np.where(((edge > 0.06) & (edge < 0.075))[..., None], rgb("c9a850"), image)
    return np.clip(image * (1 + 0.05 * np.sin(2 * np.pi * y * 128))[..., None], 0, 1)


def carpet(field, border, accent, seed):
    """A rug: medallion, quartered field of small flowers, two borders; the picture is the whole rug."""
    size = 512
    x, y = coordinates(size)
    fx, fy = np.abs(x - 0.5), np.abs(y - 0.5)
    lattice = np.cos(2 * np.pi * fx * 18) * np.cos(2 * np.pi * fy * 18)
    image = mix(rgb(field) + 0 * x[..., None], rgb(accent), (lattice > 0.62).astype(float))
    image = mix(image, rgb(border), (lattice < -0.72).astype(float))
    radius, angle = np.hypot(fx, fy * 1.0), np.arctan2(fy, fx)
    for reach, tone in ((0.27, border), (0.235, accent), (0.215, border), (0.12, field), (0.07, accent)):
        image = np.where((radius < reach * (1 + 0.1 * np.cos(8 * angle)))[..., None], rgb(tone), image)
    quarter = np.hypot(0.42 - fx, 0.42 - fy)
    image = np.where((quarter < 0.13)[..., None], rgb(border), image)
    image = np.where(((quarter > 0.105) & (quarter < 0.118))[..., None], rgb(accent), image)
    edge = np.minimum(0.5 - fx, 0.5 - fy)
    wave = np.sin(2 * np.pi * np.where(0.5 - fx < 0.5 - fy, y, x) * 24)
    image = np.where((edge < 0.085)[..., None], np.where((wave > 0)[..., None], rgb(border), rgb(field)), image)
    image = np.where(
        (np.abs(edge - 0.085) < 0.008)[..., None] | (np.abs(edge - 0.03) < 0.005)[..., None], rgb(accent), image
    )
    pile = 1 + 0.015 * noise(size, seed, 1.0)
    return np.clip(image * pile[..., None], 0, 1)


def books():
    """Backs of books on a shelf a metre long and a third of a metre high."""
    size = 256
    x, y = coordinates(size)
    edges = np.cumsum(np.random.default_rng(301).uniform(0.022, 0.045, 40))
    edges = np.concatenate([[0.0], edges[edges < 0.985], [1.0]])
    number = np.searchsorted(edges, x[0], side="right") - 1
    left, right = edges[number], edges[number + 1]
    place = np.tile((x[0] - left) / (right - left), (size, 1))
    number = np.tile(number, (size, 1))
    shades = np.array([rgb(c) for c in ("6a2420", "2c3f2c", "22304a", "7a5a2c", "4a2a18", "8a7a5a", "3a1c2c")])
    image = shades[(np.abs(cell_values(number, 303)) * 7).astype(int) % 7]
    top = 0.8 + 0.18 * np.abs(cell_values(number, 305))
    round_back = 0.55 + 0.45 * np.sin(np.pi * np.clip(place, 0.02, 0.98))
    bands = (
        (np.abs(y - 0.2) < 0.012)
        | (np.abs(y - 0.68) < 0.012)
        | ((np.abs(y - 0.55) < 0.05) & (np.abs(place - 0.5) < 0.3))
    )
    image = np.where(bands[..., None], rgb("b8944a"), image) * round_back[..., None]
    return np.where((y > top)[..., None], rgb("1a0f08"), image)


def old_map():
    """A chart of coasts on parchment, with a net of lines."""
    size = 256
    x, y = coordinates(size)
    height = noise(size, 401, 1.9)
    image = mix(rgb("c9d2c0"), rgb("d9c590"), (height > 0.3).astype(float))
    image = mix(image, rgb("5a3a20"), (np.abs(height - 0.3) < 0.04).astype(float))
    image = mix(image, rgb("8a9a5a"), (height > 1.2).astype(float) * 0.6)
    net = (np.abs(x * 8 % 1.0 - 0.5) < 0.02) | (np.abs(y * 8 % 1.0 - 0.5) < 0.02)
    return mix(image, rgb("7a5a3a"), net * 0.5)


PICTURES = {
    "paintings": paintings,
    "tapestry": tapestry,
    "arms": arms,
    "books": books,
    "old_map": old_map,
    "carpet_red": lambda: carpet("7a1c20", "1f2c4a", "d0a85a", 211),
    "carpet_blue": lambda: carpet("23406a", "6a1f22", "d9c48a", 213),
    "carpet_green": lambda: carpet("2f4f38", "5a2018", "d8bd78", 215),
}

#!/usr/bin/env python3
"""Writes what the scenes of panes need: environments/night.exr, scenes/panel.glb and scenes/leaf.glb, and their bump
maps, scenes/panel_bumps.png and scenes/leaf_bumps.png. Python 3 standard library only. The same source always gives
the same bytes.

The night is a street in rain, out of focus: a lens that focuses on a window shows lamps, signs and cars as discs. The
panel is 30 x 22 cm of car paint on sheet metal with shallow dents; its bump map is the height of the same surface. The
leaf is 18 x 13 cm of a broad leaf's upper side, its tip downwards: veins lie in furrows, and what is between them
bulges.
"""
import array
import math
import os
import random
import struct
import zlib

from gltf_writer import Group, Scene
from make_sky import attribute, cloud_noise

HERE = os.path.dirname(os.path.abspath(__file__))

# ---- the night

WIDTH, HEIGHT = 2048, 1024
DEGREES = 360.0 / WIDTH
WARM, WHITE, RED, GREEN = (1.0, 0.62, 0.28), (0.95, 0.95, 1.0), (1.0, 0.07, 0.03), (0.10, 0.95, 0.45)


def background(elevation):
    """Radiance by elevation only: sky over the town, wet ground, and a horizon as far out of focus as the lamps are."""
    glow, sheen = math.exp(-max(elevation, 0.0) / 12.0), math.exp(min(elevation, 0.0) / 9.0)
    above = (0.008 + 0.024 * glow, 0.010 + 0.018 * glow, 0.018 + 0.014 * glow)
    below = (0.005 + 0.014 * sheen, 0.005 + 0.011 * sheen, 0.007 + 0.009 * sheen)
    t = min(max((elevation + 1.6) / 3.2, 0.0), 1.0)
    t = t * t * (3 - 2 * t)
    return tuple(b + (a - b) * t for a, b in zip(above, below))


def add_spot(image, azimuth, elevation, width, height, colour, strength, edge):
    """A disc, or an ellipse, with half axes in degrees. Its rim is brighter, as lenses show it; `edge` is its width."""
    x0, x1 = int((azimuth - width + 180) / DEGREES) - 1, int((azimuth + width + 180) / DEGREES) + 2
    y0, y1 = int((90 - elevation - height) / DEGREES) - 1, int((90 - elevation + height) / DEGREES) + 2
    for y in range(max(y0, 0), min(y1, HEIGHT)):
        for x in range(x0, x1):
            du = ((x + 0.5) * DEGREES - 180 - azimuth) / width
            dv = (90 - (y + 0.5) * DEGREES - elevation) / height
            r = math.hypot(du, dv)
            inside = min(max((1.0 - r) / edge, 0.0), 1.0)
            if inside <= 0.0:
                continue
            light = strength * inside * inside * (3 - 2 * inside) * (0.8 + 0.35 * r * r)
            at = 3 * (y * WIDTH + x % WIDTH)
            for c in range(3):
                image[at + c] += light * colour[c]


def add_lamp(image, azimuth, elevation, colour, strength, size=1.5):
    """A light and its smear on the wet street, as far below the horizon as it is above."""
    add_spot(image, azimuth, elevation, size, size, colour, strength, 0.14)
    below = -0.5 * abs(elevation) - 4.0
    add_spot(image, azimuth, below, size * 1.1, 3.0 + 0.4 * abs(elevation), colour, 0.08 * strength, 1.0)


def make_night(path):
    rng = random.Random(7)
    image = array.array("f")
    for y in range(HEIGHT):
        image.extend(background(90 - (y + 0.5) * DEGREES) * WIDTH)
    for far in (7, 10.5, 15, 22, 32, 48, 75):  # the street's lamps, on both sides
        for side, height in ((-5.2, 3.4), (4.6, 3.4)):
            azimuth = math.degrees(math.atan2(side, far)) + 5.0
            add_lamp(image, azimuth, math.degrees(math.atan2(height, far)), WARM, 1.1, 1.5)
    for far, side, colour in ((12, 0.9, RED), (12, 2.3, RED), (26, 1.0, RED), (26, 2.1, RED), (18, -2.2, WHITE),
                              (18, -0.9, WHITE), (40, -1.8, WHITE), (40, -1.0, WHITE)):
        add_lamp(image, math.degrees(math.atan2(side, far)) + 5.0, -math.degrees(math.atan2(0.9, far)), colour,
                 1.3 if colour == WHITE else 1.0, 1.5)
    add_lamp(image, 14.0, 6.0, GREEN, 0.8)
    for _ in range(46):  # windows of houses, dimmer
        azimuth, colour = rng.uniform(-75, 75), rng.choice((WARM, WARM, (1.0, 0.78, 0.5), (0.6, 0.75, 1.0)))
        add_spot(image, azimuth, rng.uniform(1.0, 5.0 + 0.35 * abs(azimuth - 5)), 1.7, 1.7, colour,
                 rng.uniform(0.03, 0.2), 0.16)
    write_exr(path, image)


def pack(block):
    """OpenEXR's ZIP: even bytes first, then odd ones, each less the one before."""
    halves = block[0::2] + block[1::2]
    moved = bytes([halves[0]]) + bytes((halves[i] - halves[i - 1] + 128) & 255 for i in range(1, len(halves)))
    packed = zlib.compress(moved, 9)
    return packed if len(packed) < len(block) else block


def write_exr(path, image):
    channels = b"".join(n + b"\0" + struct.pack("<iBBBBii", 1, 0, 0, 0, 0, 1, 1) for n in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    head = (struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", b"\3") + attribute("dataWindow", "box2i", window)
            + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
            + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0")
    blocks = []
    for first in range(0, HEIGHT, 16):
        lines = b"".join(struct.pack("<%de" % WIDTH, *image[3 * y * WIDTH + c:3 * (y + 1) * WIDTH:3])
                         for y in range(first, first + 16) for c in (2, 1, 0))
        packed = pack(lines)
        blocks.append(struct.pack("<ii", first, len(packed)) + packed)
    at, offsets = len(head) + 8 * len(blocks), []
    for block in blocks:
        offsets.append(at)
        at += len(block)
    write(path, head + struct.pack("<%dQ" % len(offsets), *offsets) + b"".join(blocks))


# ---- the panel

PANEL = (0.30, 0.22)  # m
TILE = (0.075, 0.055)  # m of the bump map, repeated four times each way
DEPTH = 0.0005  # m from the lowest to the highest
BUMPS = (300, 220)  # pixels
FINEST = 3.0  # periods in a tile of the shortest wave


def waves():
    """Waves that repeat with the tile: periods along both sides, phase and height. Beaten sheet metal has no edges: its
    heights fall with the square of the frequency, so that no length stands out among its slopes."""
    rng, all_waves = random.Random(3), []
    for i in range(0, 4):
        for j in range(-3, 4):
            if (i, j) > (0, 0) and math.hypot(i, j) <= FINEST:
                all_waves.append((i, j, rng.random(), rng.uniform(0.5, 1.0) / (i * i + j * j)))
    return all_waves


WAVES = waves()


def sum_of_waves(u, v):
    x, y = u / TILE[0], v / TILE[1]
    return sum(size * math.cos(2 * math.pi * (i * x + j * y + phase)) for i, j, phase, size in WAVES)


SPAN = [sum_of_waves(TILE[0] * i / 75, TILE[1] * j / 55) for i in range(75) for j in range(55)]
LOWEST, HIGHEST = min(SPAN), max(SPAN)


def height_at(u, v):
    """Height in [0; 1] at a position in metres."""
    return min(max((sum_of_waves(u, v) - LOWEST) / (HIGHEST - LOWEST), 0.0), 1.0)


def write_png(path, width, height, pixel, colour_type):
    """`pixel` returns the bytes of a column and a row; row 0 is at the top."""
    raw = bytearray()
    for row in range(height):
        raw.append(0)
        for column in range(width):
            raw += pixel(column, row)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    data = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9))
            + chunk(b"IEND", b""))
    if path:
        write(path, data)
    return data


def make_bumps(path):
    write_png(path, BUMPS[0], BUMPS[1], lambda column, row: bytes([int(round(
        255 * height_at(TILE[0] * column / BUMPS[0], TILE[1] * (BUMPS[1] - 1 - row) / BUMPS[1])))]), 0)


def make_panel(path):
    """In its own frame: x to the right, y up, facing z, the middle of its lower edge at the origin."""
    g = Group("panel", {"metal_paint": 0.2})
    columns, rows = 180, 132
    g.surface("metal_paint", [[(PANEL[0] * (i / columns - 0.5), PANEL[1] * j / rows,
                                DEPTH * (height_at(PANEL[0] * i / columns, PANEL[1] * j / rows) - 1.0))
                               for i in range(columns + 1)] for j in range(rows + 1)], planar=True)
    scene = Scene([{"name": "metal_paint", "colour": (0.26, 0.02, 0.016), "rough": 0.1, "metal": 0.5}], {})
    scene.place(g)
    scene.write(path)


# ---- the leaf

LEAF = (0.18, 0.13)  # m
LEAF_DEPTH = 0.0011  # m from the lowest furrow to the highest bulge
LEAF_BUMPS = (360, 260)  # pixels
LEAF_COLOURS = (576, 416)  # pixels
SPACING = 0.0165  # m between side veins along the midrib


def furrow(distance, width):
    """0 in a vein's middle, 1 beside it."""
    return 1.0 - math.exp(-(distance / width) ** 2)


def leaf_veins(u, v):
    """Distances (m) to the midrib, the nearest side vein and the nearest of the fine ones that cross between them."""
    wobble = 0.0022 * (cloud_noise(40 * u, 40 * v, 3) - 0.5)
    across = u - 0.086 - 0.09 * (v - 0.05) - 0.25 * (v - 0.06) ** 2 + wobble
    side = abs(across)
    # Side veins leave the midrib towards the tip and bend on towards it; left and right ones alternate.
    along = (v + 0.62 * side + 1.9 * side * side + wobble) / SPACING + (0.5 if across > 0 else 0.0)
    to_side = abs(along - math.floor(along) - 0.5) * SPACING * 0.8
    ladder = (side + 0.16 * (v + wobble) + 0.0035 * (cloud_noise(90 * u + 7, 90 * v, 2) - 0.5)) / 0.0042
    to_fine = abs(ladder - math.floor(ladder) - 0.5) * 0.0042
    return side, to_side, to_fine


def leaf_height(u, v):
    """Height in [0; 1] at a position in metres."""
    side, to_side, to_fine = leaf_veins(u, v)
    between = 0.62 * furrow(to_side, 0.0034) + 0.23 * furrow(to_side, 0.0010) + 0.15 * furrow(to_fine, 0.0008)
    return max(between * (0.25 + 0.75 * furrow(side, 0.0042)) * (0.55 + 0.45 * furrow(side, 0.0011)), 0.0)


def leaf_colour(u, v):
    """In sRGB, bytes: veins are paler, thin ones less so, and the blade is uneven."""
    side, to_side, to_fine = leaf_veins(u, v)
    vein = max(1.0 - furrow(side, 0.0011), 0.75 * (1.0 - furrow(to_side, 0.0006)),
               0.30 * (1.0 - furrow(to_fine, 0.0004)))
    uneven = cloud_noise(35 * u + 3, 35 * v + 5, 5)
    fine = cloud_noise(400 * u, 400 * v, 3)
    warm = 0.5 + 0.9 * (uneven - 0.5)
    light = 0.72 + 0.40 * uneven + 0.16 * (fine - 0.5) + 0.10 * leaf_height(u, v)
    blade = (light * (0.016 + 0.030 * warm), light * (0.085 + 0.055 * warm), light * 0.012)
    pale = (0.17, 0.31, 0.065)
    linear = [b + (p - b) * vein for b, p in zip(blade, pale)]
    return bytes(int(round(255 * (1.055 * max(c, 0.0031) ** (1 / 2.4) - 0.055))) for c in linear)


def make_leaf_bumps(path):
    write_png(path, LEAF_BUMPS[0], LEAF_BUMPS[1], lambda column, row: bytes([int(round(255 * leaf_height(
        LEAF[0] * (column + 0.5) / LEAF_BUMPS[0], LEAF[1] * (LEAF_BUMPS[1] - 0.5 - row) / LEAF_BUMPS[1])))]), 0)


def make_leaf(path):
    """In the same frame as the panel."""
    colours = write_png(None, LEAF_COLOURS[0], LEAF_COLOURS[1], lambda column, row: leaf_colour(
        LEAF[0] * (column + 0.5) / LEAF_COLOURS[0], LEAF[1] * (LEAF_COLOURS[1] - 0.5 - row) / LEAF_COLOURS[1]), 2)
    g = Group("leaf", {})
    columns, rows = 180, 130
    g.surface("leaf_blade", [[(LEAF[0] * (i / columns - 0.5), LEAF[1] * j / rows, LEAF_DEPTH * (
        leaf_height(LEAF[0] * i / columns, LEAF[1] * j / rows) - 1.0)) for i in range(columns + 1)]
        for j in range(rows + 1)], uv_box=(0.0, 1.0, 1.0, 0.0))
    scene = Scene([{"name": "leaf_blade", "image": "colours", "rough": 0.42}], {"colours": colours})
    scene.place(g)
    scene.write(path)


def write(path, data):
    with open(path + ".tmp", "wb") as out:
        out.write(data)
    os.replace(path + ".tmp", path)
    print("%s: %d bytes" % (os.path.relpath(path), len(data)))


def main():
    make_night(os.path.join(HERE, "environments", "night.exr"))
    make_bumps(os.path.join(HERE, "scenes", "panel_bumps.png"))
    make_panel(os.path.join(HERE, "scenes", "panel.glb"))
    make_leaf_bumps(os.path.join(HERE, "scenes", "leaf_bumps.png"))
    make_leaf(os.path.join(HERE, "scenes", "leaf.glb"))


if __name__ == "__main__":
    main()

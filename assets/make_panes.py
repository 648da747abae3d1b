#!/usr/bin/env python3
"""Writes what the scenes of panes need: environments/night.exr, scenes/panel.glb and scenes/panel_bumps.png. Python 3
standard library only. The same source always gives the same bytes.

The night is a street in rain as a lens sees it that is focused on a window: lamps, signs and cars as discs of light.
The panel is 30 x 22 cm of car paint on hammered sheet metal; its bump map is the height of the same surface.
"""
import array
import math
import os
import random
import struct
import zlib

from gltf_writer import Group, Scene
from make_sky import attribute

HERE = os.path.dirname(os.path.abspath(__file__))

# ---- the night

WIDTH, HEIGHT = 2048, 1024
DEGREES = 360.0 / WIDTH
WARM, WHITE, RED, GREEN = (1.0, 0.62, 0.28), (0.95, 0.95, 1.0), (1.0, 0.07, 0.03), (0.10, 0.95, 0.45)


def background(elevation):
    """Radiance by height alone: sky over the town, wet ground, and a horizon as far out of focus as the lamps are."""
    glow, sheen = math.exp(-max(elevation, 0.0) / 12.0), math.exp(min(elevation, 0.0) / 9.0)
    above = (0.008 + 0.024 * glow, 0.010 + 0.018 * glow, 0.018 + 0.014 * glow)
    below = (0.005 + 0.014 * sheen, 0.005 + 0.011 * sheen, 0.007 + 0.009 * sheen)
    t = min(max((elevation + 1.6) / 3.2, 0.0), 1.0)
    t = t * t * (3 - 2 * t)
    return tuple(b + (a - b) * t for a, b in zip(above, below))


def add_spot(image, azimuth, elevation, width, height, colour, strength, edge):
    """A disc, or an ellipse, of half axes in degrees; its rim, `edge` of them wide, is brighter, as lenses have it."""
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
DEPTH = 0.0006  # m from the lowest to the highest
BUMPS = (300, 220)  # pixels


def dents():
    """Middles of hammer marks, a jittered grid that repeats, in tiles."""
    rng = random.Random(3)
    return [((i + 0.5 * (j % 2) + rng.uniform(0.2, 0.8)) / 8, (j + rng.uniform(0.2, 0.8)) / 6, rng.uniform(0.75, 1.0))
            for j in range(6) for i in range(8)]


MARKS = dents()


def height_at(u, v):
    """[0; 1] by place in metres: each mark is a round hollow, ridges stand where they meet."""
    x, y, low = u / TILE[0], v / TILE[1], 9.0
    for mx, my, size in MARKS:
        dx, dy = (x - mx + 0.5) % 1.0 - 0.5, (y - my + 0.5) % 1.0 - 0.5
        low = min(low, math.hypot(dx * TILE[0], dy * TILE[1]) / (0.0085 * size))
    return min(low * low, 1.0)


def make_bumps(path):
    raw = bytearray()
    for row in range(BUMPS[1]):
        raw.append(0)
        v = TILE[1] * (BUMPS[1] - 1 - row) / BUMPS[1]
        raw += bytes(int(round(255 * height_at(TILE[0] * column / BUMPS[0], v))) for column in range(BUMPS[0]))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", BUMPS[0], BUMPS[1], 8, 0, 0, 0, 0)
    write(path, b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(raw), 9))
          + chunk(b"IEND", b""))


def make_panel(path):
    """In its own frame: x to the right, y up, facing z, the middle of its lower edge at the origin."""
    g = Group("panel", {"metal_paint": 0.2})
    columns, rows = 120, 88
    g.surface("metal_paint", [[(PANEL[0] * (i / columns - 0.5), PANEL[1] * j / rows,
                                DEPTH * (height_at(PANEL[0] * i / columns, PANEL[1] * j / rows) - 1.0))
                               for i in range(columns + 1)] for j in range(rows + 1)], planar=True)
    scene = Scene([{"name": "metal_paint", "colour": (0.16, 0.012, 0.014), "rough": 0.3, "metal": 0.3}], {})
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


if __name__ == "__main__":
    main()

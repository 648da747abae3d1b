#!/usr/bin/env python3
"""Writes environments/dusk.exr: an overcast, rainy sky at dusk. Python 3 standard library only.

Equirectangular, 256 x 128, half-float RGB in linear light, uncompressed scanlines. Row 0 is up (+Y); the middle of the
image looks along -Z and u grows towards +X. The sun has set behind clouds at -Z: a paler band stands there over the
horizon. The lower half is dark wet ground. The same source always gives the same bytes.
"""
import math
import os
import random
import struct

WIDTH, HEIGHT = 256, 128
ZENITH, HORIZON = (0.150, 0.185, 0.240), (0.235, 0.262, 0.300)
BAND, GROUND = (0.70, 0.60, 0.50), (0.050, 0.052, 0.055)


def lattice(seed, size=64):
    rng = random.Random(seed)
    return [[rng.random() for _ in range(size)] for _ in range(size)]


LATTICES = [lattice(40 + k) for k in range(6)]


def smooth(t):
    return t * t * (3.0 - 2.0 * t)


def cloud_noise(x, y, octaves=6):
    """Value noise in [0; 1] over the plane, each octave on its own wrapped lattice."""
    total, weight, scale = 0.0, 0.0, 1.0
    for k in range(octaves):
        grid = LATTICES[k]
        ix, iy = math.floor(x), math.floor(y)
        tx, ty = smooth(x - ix), smooth(y - iy)
        a, b = grid[iy % 64], grid[(iy + 1) % 64]
        upper = a[ix % 64] + (a[(ix + 1) % 64] - a[ix % 64]) * tx
        lower = b[ix % 64] + (b[(ix + 1) % 64] - b[ix % 64]) * tx
        total += scale * (upper + (lower - upper) * ty)
        weight += scale
        scale *= 0.55
        x, y = 2.03 * x + 17.3, 2.03 * y + 5.1
    return total / weight


def mix(a, b, t):
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def sky(x, y, z):
    """Radiance from above, direction (x, y, z) with y > 0."""
    flat = math.exp(-y * 2.6)
    colour = mix(ZENITH, HORIZON, flat)
    # Clouds on a plane above: the divisor keeps them from shrinking to nothing at the horizon.
    px, pz = x / (y + 0.16), z / (y + 0.16)
    warp = cloud_noise(px * 0.5 + 9.0, pz * 0.5, 3) - 0.5
    cover = cloud_noise(px * 0.9 + 1.4 * warp + 30.0, pz * 1.3 + 1.4 * warp + 11.0)
    base = smooth(min(1.0, max(0.0, (cover - 0.28) / 0.44)))
    colour = tuple(c * (1.30 - 0.66 * base) for c in colour)
    azimuth = math.atan2(x, -z)
    height = math.degrees(math.asin(y))
    glow = math.exp(-(azimuth / 0.80) ** 2) * math.exp(-((height - 7.0) / (7.5 if height > 7.0 else 5.0)) ** 2)
    rim = math.exp(-(azimuth / 1.5) ** 2) * math.exp(-height / 22.0)
    tear = 0.45 + 0.75 * (1.0 - base)
    colour = tuple(c + b * (glow * tear * 0.86 + 0.16 * rim) for c, b in zip(colour, BAND))
    # A distant curtain of rain greys the lowest degrees.
    veil = 0.75 * math.exp(-height / 2.2)
    return mix(colour, (0.33, 0.34, 0.355), veil * math.exp(-(azimuth / 2.2) ** 2))


def radiance(column, row):
    azimuth = ((column + 0.5) / WIDTH - 0.5) * 2.0 * math.pi
    elevation = (0.5 - (row + 0.5) / HEIGHT) * math.pi
    flat = math.cos(elevation)
    x, y, z = math.sin(azimuth) * flat, math.sin(elevation), -math.cos(azimuth) * flat
    if y > 0.0:
        return sky(x, y, z)
    sheen = math.exp(y * 9.0) * (0.45 + 0.55 * math.exp(-(azimuth / 0.9) ** 2))
    return mix(GROUND, (0.16, 0.165, 0.17), sheen)


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def header():
    channels = b"".join(n + b"\0" + struct.pack("<iBBBBii", 1, 0, 0, 0, 0, 1, 1) for n in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    return (struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels)
            + attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
            + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
            + attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
            + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
            + attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0")


def main():
    head = header()
    line_size = WIDTH * 3 * 2
    first = len(head) + 8 * HEIGHT
    body = bytearray(head)
    body += struct.pack("<%dQ" % HEIGHT, *(first + y * (8 + line_size) for y in range(HEIGHT)))
    for y in range(HEIGHT):
        pixels = [radiance(x, y) for x in range(WIDTH)]
        body += struct.pack("<ii", y, line_size)
        for channel in (2, 1, 0):
            body += struct.pack("<%de" % WIDTH, *(p[channel] for p in pixels))
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "environments", "dusk.exr")
    with open(path + ".tmp", "wb") as out:
        out.write(body)
    os.replace(path + ".tmp", path)
    print("%s: %d bytes" % (os.path.relpath(path), len(body)))


if __name__ == "__main__":
    main()

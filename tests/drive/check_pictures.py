#!/usr/bin/env python3
"""Looks at PNG files of the sample game. Usage: check_pictures.py RAIN.png DRY.png LEAST_SHARE [walls]

Both must show something, and differ at so large a share of their pixels. With `walls`: the wind blows to the right, so
the brick on the right gets darker in rain beside that on the left. Python 3 standard library only.
"""
import struct
import sys
import zlib


def read(path):
    """Width, height, and rows of RGBA or RGB bytes."""
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and colour in (2, 6), path
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    channels = 3 if colour == 2 else 4
    raw, stride, rows, before = zlib.decompress(packed), width * channels, [], bytes(width * channels)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = line[x - channels] if x >= channels else 0
            up, corner = before[x], before[x - channels] if x >= channels else 0
            if kind == 4:  # Paeth: the neighbour nearest to left + up - corner
                guess = left + up - corner
                distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
                line[x] = (line[x] + (left, up, corner)[distances.index(min(distances))]) & 255
            else:
                line[x] = (line[x] + (0, left, up, (left + up) // 2)[kind]) & 255
        rows.append(bytes(line))
        before = rows[-1]
    return width, height, channels, rows


def brightness(picture):
    width, height, channels, rows = picture
    return [sum(row[x * channels:x * channels + 3]) for row in rows for x in range(width)]


rain, dry = (brightness(read(path)) for path in sys.argv[1:3])
for path, picture in zip(sys.argv[1:3], (rain, dry)):
    mean = sum(picture) / len(picture) / 3
    shown = sum(value > 24 for value in picture) / len(picture)
    assert 15 < mean < 240, f"{path}: mean {mean:.1f} of 255"
    assert shown > 0.4, f"{path}: {100 * shown:.0f} % of the pixels are not black"
other = sum(abs(a - b) > 18 for a, b in zip(rain, dry)) / len(rain)
assert other > float(sys.argv[3]), f"{sys.argv[1]} and {sys.argv[2]} differ at {100 * other:.2f} % of the pixels"
print(f"{100 * other:.1f} % of the pixels differ")


def walls_darken():
    """How bright brick is in rain, of how bright it is dry: on the left, and on the right."""
    pictures = [read(path) for path in sys.argv[1:3]]
    width, height = pictures[0][:2]
    shares = []
    for left, right, top, bottom in ((0.0, 0.14, 0.04, 0.18), (0.86, 1.0, 0.12, 0.24)):
        sums = [sum(brightness(picture)[y * width + x]
                    for y in range(int(top * height), int(bottom * height))
                    for x in range(int(left * width), int(right * width))) for picture in pictures]
        shares.append(sums[0] / sums[1])
    return shares


if len(sys.argv) > 4:
    lee, front = walls_darken()
    print(f"walls in rain: {lee:.2f} of what they are dry on the left, {front:.2f} on the right")
    assert front < lee - 0.05  # rain before them makes both brighter

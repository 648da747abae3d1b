#!/usr/bin/env python3
"""Compares the layer of foam with the points of its frame, for the camera of foam.sh.
Usage: check_foam.py ALPHA.txt FOAM.ply STATS.jsonl FRAME"""
import json
import math
import re
import struct
import sys

WIDTH, HEIGHT, EYE, SLOPE = 192, 108, (0, 0.4, 3), math.tan(math.radians(15))
alpha = {}
for line in open(sys.argv[1]):
    found = re.match(r"\s*Pixel \((\d+), (\d+)\): ([-+.\deE]+)", line)
    if found:
        alpha[int(found[1]), int(found[2])] = float(found[3])
if len(alpha) != WIDTH * HEIGHT:
    sys.exit(f"{len(alpha)} pixels")

head, _, body = open(sys.argv[2], "rb").read().partition(b"end_header\n")
properties = [line.split()[1:3] for line in head.split(b"\n") if line.startswith(b"property")]
names = [name.decode() for _, name in properties]
row = "<" + "".join({b"float": "f", b"uint": "I"}[kind] for kind, _ in properties)
count = int(head.split(b"element vertex ")[1].split()[0])
points = [dict(zip(names, struct.unpack_from(row, body, struct.calcsize(row) * i))) for i in range(count)]
stats = next(line for line in map(json.loads, open(sys.argv[3])) if line["frame"] == int(sys.argv[4]))["water"]
if count != stats["foam"]:
    sys.exit(f"{count} points of foam, and {stats['foam']} in the statistics")

# Discs in the picture (px). Foam appears over 0.08 s and dissolves over 0.5 s.
discs = []
for p in points:
    away = EYE[2] - p["z"]
    px = HEIGHT / 2 / SLOPE / away
    shown = min(p["age"] / 0.08 + 0.25, 1) * min(p["life"] / 0.5, 1)
    discs.append((WIDTH / 2 + px * p["x"], HEIGHT / 2 - px * (p["y"] - EYE[1]), px * p["radius"], shown))

beside = sum(value for (x, y), value in alpha.items()
             if value > 0 and not any(math.hypot(x + 0.5 - u, y + 0.5 - v) < r + 0.75 for u, v, r, _ in discs))
wrong, seen = [], 0
for u, v, r, shown in discs:
    middle = (math.floor(u), math.floor(v))
    if shown < 0.3 or r < 1.5 or middle not in alpha:
        continue
    seen += 1
    if not alpha[middle] > 0.02:
        wrong.append(f"foam at {u:.1f}, {v:.1f} of {r:.1f} px: the layer has {alpha[middle]}")
covered = sum(alpha.values())
print(f"frame {sys.argv[4]}: {count} particles of foam, {seen} looked at; the layer covers {covered:.1f} px, "
      f"{beside:.3f} px of them beside all foam")
if seen < 30 or beside > 0 or wrong:
    sys.exit("\n".join(wrong[:5]) or "too little foam, or foam beside it")

#!/usr/bin/env python3
"""Checks the surfels of the ball of make_particles.py. Usage: check_water.py FOLDER FRAME SECONDS"""
import json
import math
import struct
import sys

folder, frame, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
data = open(f"{folder}/water.{frame:04d}.ply", "rb").read()
head, _, body = data.partition(b"end_header\n")
names = [line.split()[2].decode() for line in head.split(b"\n") if line.startswith(b"property float")]
if names != "x y z vx vy vz radius nx ny nz".split():
    sys.exit(f"columns are {names}")
count = int(head.split(b"element vertex ")[1].split()[0])
rows = [struct.unpack_from("<10f", body, 40 * i) for i in range(count)]
line = [json.loads(text) for text in open(f"{folder}/stats.jsonl")]
water = next(entry for entry in line if entry["frame"] == frame)["water"]

# A particle without a position is never among them: the program leaves it out.
height, speed = 1.0 - 0.5 * 9.81 * seconds ** 2, -9.81 * seconds
wrong = []
if count != water["surfels"] or count < 500:
    wrong.append(f"{count} surfels, statistics have {water['surfels']}")
if water["particles"] != 515 or water["invalid"] != 0 or water["in_grid"] != 515:
    wrong.append(f"particles: {water}")
if abs(water["volume_l"] / (515 * 0.02 ** 3 * 1000) - 1) > 0.03:  # the spacing is a guess
    wrong.append(f"volume {water['volume_l']} l")
for x, y, z, vx, vy, vz, radius, nx, ny, nz in rows:
    length = math.sqrt(x * x + (y - height) ** 2 + z * z)
    if not 0.08 < length < 0.13:
        wrong.append(f"a surfel {length} m from the middle of the ball")
    if abs(vx) + abs(vy - speed) + abs(vz) > 0.01:
        wrong.append(f"a velocity of {vx} {vy} {vz}, expected 0 {speed} 0")
    if (nx * x + ny * (y - height) + nz * z) / length < 0.5:
        wrong.append("a normal that does not point out of the ball")
if wrong:
    sys.exit("\n".join(wrong[:5]))

#!/usr/bin/env python3
"""Checks the surfels and the mesh of the ball of make_particles.py. Usage: check_water.py FOLDER FRAME SECONDS"""
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

# The mesh, where there is one: the volume inside it is that of the particles.
try:
    data = open(f"{folder}/water_mesh.{frame:04d}.ply", "rb").read()
except FileNotFoundError:
    data = None
if data:
    head, _, body = data.partition(b"end_header\n")
    vertices = int(head.split(b"element vertex ")[1].split()[0])
    faces = int(head.split(b"element face ")[1].split()[0])
    at = [struct.unpack_from("<3f", body, 36 * i) for i in range(vertices)]
    volume = 0
    for i in range(faces):
        corners, a, b, c = struct.unpack_from("<B3I", body, 36 * vertices + 13 * i)
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = at[a], at[b], at[c]
        ay, by, cy = ay - height, by - height, cy - height
        volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6
    if len(body) != 36 * vertices + 13 * faces or vertices - faces / 2 != 2:
        wrong.append(f"a mesh of {vertices} vertices, {faces} triangles and {len(body)} bytes is no ball")
    # A surface bent as much as that of a ball of ten particles is inside of it.
    if abs(volume * 1000 / water["volume_l"] - 1) > 0.08:
        wrong.append(f"{volume * 1000} l inside the mesh, {water['volume_l']} l of particles")
if wrong:
    sys.exit("\n".join(wrong[:5]))

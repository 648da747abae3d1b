#!/usr/bin/env python3
"""Checks the bodies in the simulated water of solver.sh. Usage: check_bodies.py FOLDER FPS"""
import json
import math
import struct
import sys

folder, fps = sys.argv[1], float(sys.argv[2])
wrong = []


def compare(what, found, expected, tolerance):
    for i in range(3):
        if abs(found[i] - expected[i]) > tolerance:
            wrong.append(f"{what}: {found}, expected {expected}")
            break


for line in map(json.loads, open(f"{folder}/stats.jsonl")):
    frame, solver = line["frame"], line["water"]["solver"]
    time = (frame - 1) / fps
    stone, paddle = solver["bodies"]
    if stone["name"] != "stone" or paddle["name"] != "paddle":
        wrong.append(f"names are {stone['name']} and {paddle['name']}")
    # The stone falls freely. Its velocity at the end of a step is exact, its place is off by half a substep.
    compare(f"frame {frame}: the stone is at", stone["position_m"],
            (0.4, 0.6 + 0.5 * time - 0.5 * 9.81 * time ** 2, 0.1 * time), 0.012)
    compare(f"frame {frame}: the stone's speed", stone["velocity_m_s"], (0, 0.5 - 9.81 * time, 0.1), 0.001)
    compare(f"frame {frame}: the stone's spin", stone["spin_rad_s"], (0, math.pi / 2, 0), 0.001)
    part = min(time / 0.1, 1)
    compare(f"frame {frame}: the paddle is at", paddle["position_m"], (0.1 + 0.1 * part, 0.7 + 0.1 * part, 0), 1e-5)
    _, _, body = open(f"{folder}/water_particles.{frame:04d}.ply", "rb").read().partition(b"end_header\n")
    # Water is pushed out of the post, which stands from -0.4 to -0.3 m along x and from 0.25 to 0.35 m along z.
    inside = sum(-0.39 < x < -0.31 and 0.26 < z < 0.34 for x, y, z, *_ in struct.iter_unpack("<6fI", body))
    if frame == 5 and inside:
        wrong.append(f"frame {frame}: {inside} particles are in the post")
if wrong:
    sys.exit("\n".join(wrong[:5]))

#!/usr/bin/env python3
"""Checks the simulated water of solver.sh. Usage: check_solver.py FOLDER FPS FIRST[-LAST] [SECONDS_STILL]"""
import json
import struct
import sys

folder, fps = sys.argv[1], float(sys.argv[2])
frames = [int(number) for number in sys.argv[3].split("-")]
still = float(sys.argv[4]) if len(sys.argv) > 4 else 0
WHOLE, FALLING, SIDE = 704, 64, 0.05
wrong, energies = [], []

lines = {entry["frame"]: entry["water"] for entry in map(json.loads, open(f"{folder}/stats.jsonl"))}
for frame in range(frames[0], frames[-1] + 1):
    head, _, body = open(f"{folder}/water_particles.{frame:04d}.ply", "rb").read().partition(b"end_header\n")
    names = [line.split()[2].decode() for line in head.split(b"\n") if line.startswith(b"property")]
    if names != "x y z vx vy vz id".split():
        wrong.append(f"columns are {names}")
    rows = [struct.unpack_from("<6fI", body, at) for at in range(0, len(body), 28)]
    if sorted(row[6] for row in rows) != list(range(WHOLE)):
        wrong.append(f"frame {frame}: {len(rows)} particles, or ids that are not theirs")
    # The second box falls freely; its middle is half way between the corners, in the world.
    time = max((frame - 1) / fps - still, 0)
    height, speed = 0.2 + 0.5 + 0.2 * time - 0.5 * 9.81 * time ** 2, 0.2 - 9.81 * time
    fall = [row for row in rows if row[6] >= WHOLE - FALLING]
    mean = [sum(row[i] for row in fall) / FALLING for i in range(6)]
    for i, expected in enumerate((0.5, height, 0.3, 0, speed, 0)):
        if abs(mean[i] - expected) > 0.012:
            wrong.append(f"frame {frame}: the falling box has {mean[i]} for {names[i]}, expected {expected}")
    water = lines[frame]
    solver = water["solver"]
    if solver["particles"] != WHOLE or water["particles"] != WHOLE or (time > 0) != (solver["substeps"] > 0):
        wrong.append(f"frame {frame}: {solver}")
    if abs(water["volume_l"] / (WHOLE * SIDE ** 3 * 1000) - 1) > 1e-6:
        wrong.append(f"frame {frame}: {water['volume_l']} l")
    if not 0 <= solver["volume_error"] < 0.01:
        wrong.append(f"frame {frame}: the volume is wrong by {solver['volume_error']}")
    # The statistics against the particles: energy over the floor of the walls.
    mass = 1000 * SIDE ** 3
    kinetic = sum(0.5 * mass * (r[3] ** 2 + r[4] ** 2 + r[5] ** 2) for r in rows)
    potential = sum(mass * 9.81 * (r[1] - 0.2) for r in rows)
    if abs(kinetic - solver["kinetic_j"]) > 1e-4 * potential or abs(potential / solver["potential_j"] - 1) > 1e-4:
        wrong.append(f"frame {frame}: {kinetic} J and {potential} J, the statistics have {solver}")
    energies.append(kinetic + potential)
for before, after in zip(energies, energies[1:]):
    if after > before * 1.0005:
        wrong.append(f"the energy grows from {before} J to {after} J")
if wrong:
    sys.exit("\n".join(wrong[:5]))

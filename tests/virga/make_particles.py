#!/usr/bin/env python3
"""Writes frames of particles as PLY: a ball of water, 2 cm apart, that falls freely. Its files have numbers from 10 on,
10 a second, and particle 0 has no position. Usage: make_particles.py FOLDER FRAMES"""
import struct
import sys

folder, frames = sys.argv[1], int(sys.argv[2])
D, RADIUS, HEIGHT, G = 0.02, 0.1, 1.0, 9.81


def ball():
    steps = int(RADIUS / D) + 1
    cells = range(-steps, steps + 1)
    return [(x * D, y * D, z * D) for z in cells for y in cells for x in cells
            if (x * x + y * y + z * z) * D * D <= RADIUS * RADIUS]


for frame in range(frames):
    t = frame / 10
    rows = [(x, HEIGHT + y - 0.5 * G * t * t, z, 0, -G * t, 0, i + 1) for i, (x, y, z) in enumerate(ball())]
    rows = [(float("nan"), 0, 0, 0, 0, 0, 0)] + rows[frame % 7:] + rows[:frame % 7]
    with open(f"{folder}/ball_{10 + frame:04d}.ply", "wb") as out:
        out.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(rows))
        out.write(b"".join(b"property float %s\n" % name for name in (b"x", b"y", b"z", b"vx", b"vy", b"vz")))
        out.write(b"property uint id\nend_header\n")
        out.write(b"".join(struct.pack("<6fI", *row) for row in rows))

#!/usr/bin/env python3
"""Writes scenes/wheel.glb and scenes/ford.glb, for tyre.yaml. Python 3 standard library only.

Metres, Y up. The wheel has its axle along Z through the origin. It is a body of the solver: each of its parts is a
closed mesh, wound outwards. The ford is a road along X between two kerbs, before a wall. Its lowest part is
flat at y = 0; water stays on nothing else. The same source always gives the same bytes.
"""
import math
import os

from gltf_writer import Group, Scene
from street_textures import asphalt, brick, slabs

WHEEL = [{"name": "rubber", "colour": (0.022, 0.022, 0.023), "rough": 0.7},
         {"name": "wall", "colour": (0.03, 0.03, 0.031), "rough": 0.5},
         {"name": "rim", "colour": (0.55, 0.56, 0.57), "rough": 0.3, "metal": 0.9},
         {"name": "dark", "colour": (0.02, 0.02, 0.021), "rough": 0.6}]
ROAD = [{"name": "asphalt", "image": "asphalt", "rough": 0.85},
        {"name": "slabs", "image": "slabs", "colour": (0.55, 0.55, 0.55), "rough": 0.8},
        {"name": "brick", "image": "brick", "colour": (0.45, 0.45, 0.45), "rough": 0.85},
        {"name": "kerb", "colour": (0.24, 0.24, 0.23), "rough": 0.7}]

RADIUS, WIDE = 0.32, 0.105 # of the crown, and half the width of the tyre
SIDES = 96                 # of all circles: four for each block of the crown

# (radius, z) from the inner side to the outer one. Neighbouring parts share their ends, so the whole has no holes.
BACK = ("dark", [(0.0, -0.07), (0.17, -0.07), (0.2, -0.085), (0.208, -0.092)])
INNER = ("wall", [(0.208, -0.092), (0.235, -0.104), (0.262, -WIDE), (0.29, -0.102), (0.306, -0.092)])
CROWN = ("rubber", [(0.306, -0.092), (0.316, -0.078), (0.319, -0.06), (0.32, -0.034), (0.313, -0.031), (0.313, -0.024),
                    (0.32, -0.021), (0.32, 0.021), (0.313, 0.024), (0.313, 0.031), (0.32, 0.034), (0.319, 0.06),
                    (0.316, 0.078), (0.306, 0.092)])
OUTER = ("wall", [(0.306, 0.092), (0.29, 0.102), (0.262, WIDE), (0.235, 0.104), (0.208, 0.092)])
LIP = ("rim", [(0.208, 0.092), (0.204, 0.094), (0.198, 0.088), (0.192, 0.06)])
BOWL = ("dark", [(0.192, 0.06), (0.186, 0.02), (0.06, 0.02), (0.0, 0.02)])


def blocks(radius, z, column):
    """Radius of the crown in its blocks: every fourth column of the shoulders is a groove."""
    across = column + (2 if z > 0 else 0)
    return radius - (0.006 if across % 4 == 0 and 0.05 < abs(z) < 0.08 else 0.0)


def turned(group, material, profile):
    """A surface of revolution about Z."""
    rows = []
    for radius, z in profile:
        row = []
        for column in range(SIDES + 1):
            angle = 2 * math.pi * (column % SIDES) / SIDES
            r = blocks(radius, z, column % SIDES) if material == "rubber" else radius
            row.append((r * math.cos(angle), r * math.sin(angle), z))
        rows.append(row)
    group.surface(material, rows)


def bar(group, material, angle_deg, inner, outer):
    """A spoke: a closed hexahedron along a radius; inner and outer are (radius, half width, low z, high z)."""
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))

    def at(radius, across, z):
        return (c * radius - s * across, s * radius + c * across, z)

    corners = [at(r, side * half, z) for r, half, low, high in (inner, outer) for side in (-1, 1) for z in (low, high)]
    for face in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        group.poly(material, [corners[i] for i in face])


def knob(group, material, x, y, radius, low, high, sides):
    """A closed cylinder along Z."""
    ring = [(x + radius * math.cos(2 * math.pi * i / sides), y + radius * math.sin(2 * math.pi * i / sides))
            for i in range(sides)]
    for i, (px, py) in enumerate(ring):
        qx, qy = ring[(i + 1) % sides]
        group.poly(material, [(px, py, low), (qx, qy, low), (qx, qy, high), (px, py, high)])
    group.poly(material, [(px, py, high) for px, py in ring])
    group.poly(material, [(px, py, low) for px, py in reversed(ring)])


def make_wheel():
    scene = Scene(WHEEL, {}, name="wheel", generator="make_tyre.py")
    wheel = Group("wheel", {m["name"]: 1.0 for m in WHEEL})
    for material, profile in (BACK, INNER, CROWN, OUTER, LIP, BOWL):
        turned(wheel, material, profile)
    for spoke in range(5):
        for side in (-8.0, 8.0):
            bar(wheel, "rim", 72 * spoke + side, (0.03, 0.012, 0.012, 0.078), (0.196, 0.01, 0.05, 0.085))
        angle = math.radians(72 * spoke + 36)
        knob(wheel, "dark", 0.05 * math.cos(angle), 0.05 * math.sin(angle), 0.009, 0.012, 0.084, 6)
    knob(wheel, "rim", 0.0, 0.0, 0.066, 0.012, 0.076, 24)
    knob(wheel, "dark", 0.0, 0.0, 0.03, 0.07, 0.084, 16)
    scene.place(wheel)
    return scene


LONG, FLAT, WIDE_HALF = 14.0, (-1.5, 2.1), 0.6 # half the length of all, ends of the flat bottom, half its width
CAMBER, KERB = 0.08, (0.08, 0.16)              # slope of all else, and the heights of the kerbs in front and behind
WIDTHS, WALL = {1: 6.0, -1: 4.0}, (1.2, 6.0)   # of what is beyond the kerbs; where the wall is on it, and its height
EDGE = 0.14                                    # width of a kerb


def make_ford():
    images = {"asphalt": asphalt(256), "slabs": slabs(128), "brick": brick(256)}
    scene = Scene(ROAD, images, name="ford", generator="make_tyre.py")
    road = Group("road", {"asphalt": 2.0, "slabs": 1.2, "brick": 1.8, "kerb": 1.0})
    low, high, (first, last) = -WIDE_HALF, WIDE_HALF, FLAT
    for x0, y0, x1, y1 in ((-LONG, CAMBER * (LONG + first), first, 0.0), (first, 0.0, last, 0.0),
                           (last, 0.0, LONG, CAMBER * (LONG - last))):
        road.poly("asphalt", [(x0, y0, high), (x1, y1, high), (x1, y1, low), (x0, y0, low)])
    for side, height in ((1, KERB[0]), (-1, KERB[1])):
        edge, top, width = side * (WIDE_HALF + EDGE), height + CAMBER * EDGE, WIDTHS[side]
        front = side * WIDE_HALF
        strips = [("kerb", front, -0.1, front, height), ("kerb", front, height, edge, top),
                  ("slabs", edge, top, edge + side * width, top + CAMBER * width)]
        if side < 0:
            foot = edge - WALL[0]
            strips.append(("brick", foot, top, foot, top + WALL[1]))
        for material, z0, y0, z1, y1 in strips:
            a, b = (-LONG, LONG) if side < 0 else (LONG, -LONG)
            road.poly(material, [(a, y0, z0), (b, y0, z0), (b, y1, z1), (a, y1, z1)])
    scene.place(road)
    return scene


def main():
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes")
    make_wheel().write(os.path.join(folder, "wheel.glb"))
    make_ford().write(os.path.join(folder, "ford.glb"))


if __name__ == "__main__":
    main()

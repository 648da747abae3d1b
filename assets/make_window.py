#!/usr/bin/env python3
"""Writes scenes/window_lamps.glb: the lamps of a town at night, for window.yaml. Python 3 standard library only.

Metres, Y up; they stand on both sides of a street that runs along -Z, from 9 m to 90 m away. Each is a small bright
body, so that a lens out of focus makes a disc of it. The same source always gives the same bytes.
"""
import os
import random

from gltf_writer import Group, Scene

# Radiance is emit times strength. A disc shares the light of a lamp over its area, which is up to some ten times the
# lamp's: lamps are as bright as their discs need to show their color. Red is purer than that of paint, as real tail
# lamps are, and so stays red where it is too bright for the picture.
LAMPS = {
    "sodium": {"emit": (1.0, 0.55, 0.16), "strength": 20},
    "white": {"emit": (1.0, 0.86, 0.66), "strength": 16},
    "headlight": {"emit": (1.0, 0.95, 0.85), "strength": 40},
    "tail": {"emit": (1.0, 0.006, 0.003), "strength": 10},
    "brake": {"emit": (1.0, 0.006, 0.003), "strength": 24},
    "green": {"emit": (0.02, 1.0, 0.35), "strength": 10},
    "amber": {"emit": (1.0, 0.30, 0.01), "strength": 12},
    "window": {"emit": (1.0, 0.62, 0.28), "strength": 0.7},
    "shop": {"emit": (0.55, 0.75, 1.0), "strength": 1.0},
}
MATERIALS = [dict(name="lamp_" + name, colour=(0, 0, 0), rough=1.0, **lamp) for name, lamp in LAMPS.items()]
MATERIALS += [{"name": "facade", "colour": (0.05, 0.045, 0.042), "rough": 0.95},
              {"name": "asphalt", "colour": (0.035, 0.036, 0.04), "rough": 0.35},
              {"name": "steel", "colour": (0.02, 0.02, 0.022), "rough": 0.6},
              {"name": "car_dark", "colour": (0.012, 0.014, 0.02), "rough": 0.25, "metal": 0.3}]
TILES = {m["name"]: 1.0 for m in MATERIALS}


def body(group, material, x, y, z, wide, high, deep=0.1):
    group.box(material, (x - wide / 2, y - high / 2, z - deep / 2), (x + wide / 2, y + high / 2, z + deep / 2))


def street_lamps(group):
    """Pairs of lamps on poles, 16 m apart, sodium to the left and white to the right."""
    for k in range(6):
        z = -10.0 - 15.0 * k
        for side, material in ((-1, "lamp_sodium"), (1, "lamp_white")):
            x = side * 4.6
            body(group, "steel", x + side * 0.9, 2.6, z - 3 * (side > 0), 0.12, 5.2)
            body(group, material, x, 5.0, z - 3 * (side > 0), 0.34, 0.16, 0.3)


def cars(group, rng):
    """Headlights that come on the left, tail lamps that go on the right, and two that brake."""
    for z, x in ((-17, -1.9), (-31, -1.7), (-52, -2.0), (-74, -1.8)):
        body(group, "car_dark", x, 0.75, z - 2.2, 1.7, 1.3, 4.2)
        for side in (-0.62, 0.62):
            body(group, "lamp_headlight", x + side, 0.68, z, 0.17, 0.13)
    for z, x, lit in ((-13, 1.8, "brake"), (-22, 2.0, "tail"), (-36, 1.8, "brake"), (-58, 1.9, "tail")):
        body(group, "car_dark", x, 0.75, z - 2.2, 1.7, 1.3, 4.2)
        for side in (-0.66, 0.66):
            body(group, "lamp_" + lit, x + side, 0.86 + 0.02 * rng.random(), z, 0.22, 0.14)


def signals(group):
    for x, z, y, lit in ((3.6, -27, 3.1, "green"), (-3.7, -44, 3.0, "amber"), (3.4, -66, 3.2, "green")):
        body(group, "steel", x, 1.5, z - 0.3, 0.1, 3.0)
        body(group, "lamp_" + lit, x, y, z, 0.2, 0.2)


def houses(group, rng):
    """Dark fronts with windows, some of them lit, and shops below."""
    for side in (-1, 1):
        for k in range(9):
            near, far = -8.0 - 10.0 * k, -17.6 - 10.0 * k
            x, high = side * 7.5, 9.0 + 4.0 * rng.random()
            lo, hi = sorted((x, side * 12.0))
            group.box("facade", (lo, 0, far), (hi, high, near))
            for floor in range(1, 4):
                for column in range(4):
                    if rng.random() < 0.3:
                        body(group, "lamp_window", x - side * 0.02, 2.2 + 2.7 * floor, near - 1.6 - 2.2 * column, 0.1,
                             1.3, 0.9)
            if rng.random() < 0.5:
                body(group, "lamp_shop", x - side * 0.02, 1.5, near - 4.5, 0.1, 1.6, 3.4)


def main():
    rng = random.Random(5)
    scene = Scene(MATERIALS, {}, name="window_lamps", generator="make_window.py")
    parts = {"lamps": street_lamps, "signals": signals}
    for name, build in parts.items():
        group = Group(name, TILES)
        build(group)
        scene.place(group)
    for name, build in {"cars": cars, "houses": houses}.items():
        group = Group(name, TILES)
        build(group, rng)
        scene.place(group)
    road = Group("road", TILES)
    road.box("asphalt", (-30, -0.2, -110), (30, 0, 4))
    scene.place(road)
    scene.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", "window_lamps.glb"))


if __name__ == "__main__":
    main()

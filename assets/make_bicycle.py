#!/usr/bin/env python3
"""Writes scenes/bicycle.glb: a parked city bicycle. Python 3 standard library only.

Metres, Y up, its front at -Z, tyres on y = 0; the bottom bracket stands over z = 0. Wheels are those of ISO 622-37
tyres (0.35 m), the other sizes those of common city frames. The handlebar is turned a little, as on bicycles that
lean on something. The same source always gives the same bytes.
"""
import math
import os

from gltf_writer import Frame, Group, Scene

MATERIALS = [
    {"name": "steel_bicycle_paint", "colour": (0.045, 0.145, 0.135), "rough": 0.25},
    {"name": "steel_bicycle_chrome", "colour": (0.52, 0.53, 0.54), "rough": 0.25, "metal": 0.9},
    {"name": "steel_bicycle_black", "colour": (0.020, 0.020, 0.021), "rough": 0.5},
    {"name": "rubber_bicycle_tire", "colour": (0.022, 0.022, 0.022), "rough": 0.75},
    {"name": "plastic_bicycle_saddle", "colour": (0.075, 0.036, 0.018), "rough": 0.42},
    {"name": "glass_bicycle_red", "colour": (0.30, 0.008, 0.006), "rough": 0.12},
    {"name": "glass_bicycle_clear", "colour": (0.40, 0.42, 0.44), "rough": 0.08},
]
TILES = {m["name"]: 1.0 for m in MATERIALS}
PAINT, CHROME, BLACK, TIRE = (m["name"] for m in MATERIALS[:4])

WHEEL, TYRE, SPOKES = 0.35, 0.018, 28
REAR, FRONT = (0.0, WHEEL, 0.47), (0.0, WHEEL, -0.64)
BRACKET, SEAT = (0.0, 0.285, 0.0), (0.0, 0.80, 0.185)
HEAD_LOW, HEAD_HIGH = (0.0, 0.70, -0.475), (0.0, 0.90, -0.405)
STEER_DEG = 14.0


def ring(group, material, centre, radius, thick, around, across):
    """A tyre or a rim: a torus about X."""
    rows = []
    for j in range(across + 1):
        b = 2 * math.pi * j / across
        r, x = radius + thick * math.cos(b), thick * math.sin(b)
        rows.append([(centre[0] + x, centre[1] + r * math.sin(2 * math.pi * k / around),
                      centre[2] + r * math.cos(2 * math.pi * k / around)) for k in range(around + 1)])
    group.surface(material, rows)


def wheel(group, centre):
    ring(group, TIRE, centre, WHEEL - TYRE, TYRE, 40, 8)
    ring(group, CHROME, centre, WHEEL - 2 * TYRE - 0.006, 0.011, 40, 6)
    x, y, z = centre
    group.tube(CHROME, [(x - 0.05, y, z), (x + 0.05, y, z)], 0.017, 8)
    for k in range(SPOKES):
        side = 1 if k % 2 else -1
        a, b = 2 * math.pi * k / SPOKES, 2 * math.pi * (k + (2 if k % 4 < 2 else -2)) / SPOKES
        hub = (x + side * 0.03, y + 0.02 * math.sin(b), z + 0.02 * math.cos(b))
        rim = WHEEL - 2 * TYRE - 0.014
        group.tube(BLACK, [hub, (x, y + rim * math.sin(a), z + rim * math.cos(a))], 0.0012, 3)


def mudguard(group, centre, first_deg, last_deg):
    """A bent strip over a tyre, with its sides drawn down."""
    rows = []
    for x, radius in ((0.030, 0.362), (0.021, 0.372), (0.0, 0.377), (-0.021, 0.372), (-0.030, 0.362)):
        rows.append([(centre[0] + x, centre[1] + radius * math.sin(a), centre[2] + radius * math.cos(a))
                     for a in (math.radians(first_deg + (last_deg - first_deg) * k / 20) for k in range(21))])
    group.surface(PAINT, rows)
    group.surface(PAINT, [[(p[0], p[1] - 0.001, p[2]) for p in row] for row in rows[::-1]])


def frame_of(group):
    for a, b, radius in ((BRACKET, SEAT, 0.0145), (BRACKET, HEAD_LOW, 0.017), (HEAD_LOW, HEAD_HIGH, 0.018),
                         ((0.0, 0.76, 0.171), (0.0, 0.86, -0.42), 0.0145)):
        group.tube(PAINT, [a, b], radius, 10)
    for x in (-0.06, 0.06):
        group.tube(PAINT, [(x * 0.4, 0.285, 0.03), (x, 0.30, 0.25), (x, REAR[1], REAR[2])], 0.009, 8)
        group.tube(PAINT, [(x * 0.3, 0.755, 0.19), (x, 0.62, 0.27), (x, REAR[1], REAR[2])], 0.0075, 8)
    group.tube(CHROME, [SEAT, (0.0, 0.93, 0.232)], 0.0125, 8)


def saddle(group):
    rows = []
    for y, grow in ((0.925, 0.72), (0.945, 0.97), (0.965, 1.0), (0.978, 0.85), (0.982, 0.45)):
        row = []
        for k in range(21):
            a = -2 * math.pi * k / 20
            nose = 0.5 - 0.5 * math.sin(a) # 1 in front
            row.append((grow * (0.085 - 0.058 * nose) * math.cos(a), y + 0.012 * (1 - nose),
                        0.225 + grow * 0.135 * math.sin(a)))
        rows.append(row)
    group.surface("plastic_bicycle_saddle", rows)


def drive(group):
    for x, pitch in ((0.075, 0.9), (-0.075, 0.9 + math.pi)):
        end = (x, 0.285 + 0.17 * math.sin(pitch), 0.17 * math.cos(pitch))
        group.tube(CHROME, [(x * 0.7, 0.285, 0.0), end], 0.009, 6)
        outer = x * 1.9
        group.box(BLACK, (min(x, outer), end[1] - 0.012, end[2] - 0.045),
                  (max(x, outer), end[1] + 0.012, end[2] + 0.045))
    guard = [(0.36, 0.315), (0.46, 0.335), (0.50, 0.36), (0.46, 0.385), (0.05, 0.375), (-0.08, 0.34), (-0.11, 0.285),
             (-0.08, 0.22), (0.0, 0.195), (0.08, 0.215)]
    group.extrude(BLACK, [(z, y) for z, y in guard], 0.040, 0.058)


def rack(group):
    for x in (-0.05, 0.0, 0.05):
        group.tube(BLACK, [(x, 0.755, 0.20), (x, 0.757, 0.62)], 0.0055, 6)
    for z in (0.30, 0.46, 0.62):
        group.tube(BLACK, [(-0.055, 0.757, z), (0.055, 0.757, z)], 0.0055, 6)
    for x in (-0.068, 0.068):
        group.tube(BLACK, [(x * 0.8, 0.755, 0.42), (x, REAR[1], REAR[2])], 0.005, 6)
    group.box("glass_bicycle_red", (-0.035, 0.725, 0.625), (0.035, 0.765, 0.645))


def front_of(group):
    """Turns about the head tube, nearly."""
    group.frame = Frame(HEAD_LOW, STEER_DEG)

    def own(p):
        return tuple(p[i] - HEAD_LOW[i] for i in range(3))

    wheel(group, own(FRONT))
    mudguard(group, own(FRONT), 20, 168)
    for x in (-0.052, 0.052):
        group.tube(PAINT, [own((x * 0.5, 0.715, -0.48)), own((x, 0.68, -0.49)), own((x, 0.50, -0.565)),
                           own((x, FRONT[1], FRONT[2]))], [0.013, 0.0125, 0.011, 0.009], 8)
    group.tube(CHROME, [own(HEAD_HIGH), own((0.0, 0.985, -0.375))], 0.012, 8)
    bar = [(-0.29, 1.035, -0.155), (-0.285, 1.05, -0.25), (-0.22, 1.055, -0.36), (-0.09, 1.005, -0.40),
           (0.0, 0.99, -0.402)]
    bar += [(-x, y, z) for x, y, z in bar[-2::-1]]
    group.tube(CHROME, [own(p) for p in bar], 0.0115, 8)
    for side in (-1, 1):
        group.tube(BLACK, [own((side * 0.29, 1.034, -0.15)), own((side * 0.286, 1.049, -0.255))], 0.0165, 8)
    group.box("glass_bicycle_clear", own((-0.03, 0.86, -0.50)), own((0.03, 0.92, -0.455)))
    group.frame = Frame()


def main():
    g = Group("bicycle", TILES)
    wheel(g, REAR)
    mudguard(g, REAR, -25, 150)
    frame_of(g)
    saddle(g)
    drive(g)
    rack(g)
    front_of(g)
    scene = Scene(MATERIALS, {}, name="bicycle", generator="make_bicycle.py")
    scene.place(g)
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", "bicycle.glb")
    scene.write(path)
    print("%s: %d triangles, %d bytes" % (os.path.relpath(path), scene.triangles(), os.path.getsize(path)))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes scenes/facade.glb and scenes/facade.yaml: a house of a hundred windows. Python 3 standard library only.

Metres, Y up. The front is at z = 0 and faces +Z; it runs along +X from 0. Some rooms are lit, and are seen into; the
others are dark, and their glass mirrors the sky. The same source always gives the same bytes.
"""
import math
import os
import random

from gltf_writer import Group, Scene
from street_textures import asphalt, brick, png, slabs

HERE = os.path.dirname(os.path.abspath(__file__))
COLUMNS, FLOORS = 20, 5
PITCH, STOREY = 2.1, 3.0    # from window to window
WIDE, HIGH = 1.24, 1.68     # of the glass
BASE = 3.4                  # lower edge of the lowest windows
DEEP, INSET = 2.6, 0.16     # of a room, and of the glass behind the front
NEAR_M = 5.0                # panes up to here have drops with shapes
EYE = (-1.3, 7.6, 2.6)      # of the camera, at the start

LIGHT = {"warm": (1.0, 0.62, 0.30), "amber": (1.0, 0.48, 0.17), "white": (1.0, 0.86, 0.68), "cold": (0.55, 0.74, 1.0)}
MATERIALS = [{"name": "brick", "image": "brick", "colour": (0.5, 0.47, 0.46), "rough": 0.85},
             {"name": "stone", "colour": (0.34, 0.32, 0.29), "rough": 0.8},
             {"name": "slabs", "image": "slabs", "colour": (0.5, 0.5, 0.5), "rough": 0.6},
             {"name": "asphalt", "image": "asphalt", "rough": 0.35},
             {"name": "frame", "colour": (0.03, 0.032, 0.035), "rough": 0.4},
             {"name": "dark_glass", "colour": (0.012, 0.014, 0.016), "rough": 0.05},
             {"name": "dark", "colour": (0.045, 0.045, 0.05), "rough": 0.9},
             {"name": "wood", "colour": (0.10, 0.055, 0.03), "rough": 0.6},
             {"name": "far_window", "colour": (0, 0, 0), "rough": 0.5, "emit": (0.4, 0.26, 0.14)},
             {"name": "street_lamp", "colour": (0, 0, 0), "rough": 1.0, "emit": (1.0, 0.72, 0.40), "strength": 24}]
# A lit room: its walls glow with the light of its lamp, as there is no light that bounces.
for kind, tint in LIGHT.items():
    def glowing(name, share, **more):
        return dict(more, name=name + kind, colour=(0.3, 0.3, 0.3), rough=0.9, emit=[round(share * c, 4) for c in tint])
    MATERIALS += [glowing("wall_", 0.55, image="glow"), glowing("side_", 0.32, image="glow"),
                  glowing("curtain_", 0.085), glowing("dim_curtain_", 0.06),
                  {"name": "lamp_" + kind, "colour": (0, 0, 0), "rough": 1.0, "emit": tint, "strength": 12}]
TILES = {m["name"]: {"brick": 1.8, "slabs": 2.4, "asphalt": 4.0}.get(m["name"], 1.0) for m in MATERIALS}
STREET_LAMPS = [(6.0, 11.0), (24.0, 11.0), (42.0, 11.0)]


def glow(size=64):
    """The light of a lamp on a wall: brightest in the middle."""
    def at(x, y):
        far2 = ((x + 0.5) / size - 0.5) ** 2 + ((y + 0.5) / size - 0.42) ** 2
        v = int(255 * (0.06 + 0.94 / (1 + far2 / 0.03)) ** 0.6)
        return v, v, v
    return png(size, size, [at(x, y) for y in range(size) for x in range(size)], colours=32)


def corner(column, floor):
    """The lower left corner of a window's glass."""
    return 0.43 + PITCH * column, BASE + STOREY * floor


def front(group):
    """Bands of brick between and beside the windows, the reveals, and a ledge below each floor."""
    right, top = PITCH * COLUMNS, BASE + STOREY * FLOORS
    low = 0.0
    for floor in range(FLOORS):
        y = corner(0, floor)[1]
        group.box("brick", (0, low, -0.3), (right, y, 0), skip="zyY")
        group.box("stone", (0, y - 0.34, -0.02), (right, y - 0.16, 0.07), skip="z")
        left = 0.0
        for column in range(COLUMNS + 1):
            x = corner(column, 0)[0] if column < COLUMNS else right
            group.box("brick", (left, y, -0.3), (x, y + HIGH, 0), skip="zyY")
            left = x + WIDE
        low = y + HIGH
    group.box("brick", (0, low, -0.3), (right, top + 0.4, 0), skip="zy")
    group.box("stone", (-0.1, top + 0.4, -0.5), (right + 0.1, top + 0.62, 0.22))
    group.box("stone", (0, 0, -0.05), (right, 0.7, 0.05), skip="z")


def window(group, x, y):
    """Sill, lintel and a frame with a cross-bar."""
    z = -INSET
    group.box("stone", (x - 0.08, y - 0.1, -0.28), (x + WIDE + 0.08, y, 0.06))
    group.box("stone", (x - 0.1, y + HIGH, -0.28), (x + WIDE + 0.1, y + HIGH + 0.16, 0.02))
    for left in (x, x + WIDE - 0.05):
        group.box("frame", (left, y, z - 0.05), (left + 0.05, y + HIGH, z + 0.03), skip="yY")
    for low in (y, y + HIGH - 0.05):
        group.box("frame", (x, low, z - 0.05), (x + WIDE, low + 0.05, z + 0.03), skip="xX")
    group.box("frame", (x, y + 1.14, z - 0.05), (x + WIDE, y + 1.18, z - 0.01), skip="xX")


def books(group, rng, kind, left, low, back):
    for k in range(4):
        y = low + 0.5 + 0.42 * k
        group.box("wood", (left, y, back), (left + 0.8, y + 0.03, back + 0.25))
        book = left
        while k < 3 and book < left + 0.7:
            wide = rng.uniform(0.03, 0.08)
            if rng.random() < 0.75:
                group.box(rng.choice(("dark", "wood", "dim_curtain_" + kind)), (book, y + 0.03, back),
                          (book + wide, y + rng.uniform(0.23, 0.38), back + 0.2), skip="xyz")
            book += wide


def curtain(group, kind, left, right, low, high):
    """Folds, lighter and darker in turn."""
    count = max(2, int((right - left) / 0.06))
    for k in range(count):
        x0, x1 = left + (right - left) * k / count, left + (right - left) * (k + 1) / count
        group.box(("curtain_", "dim_curtain_")[k % 2] + kind, (x0, low, -0.34), (x1, high, -0.31), skip="xXyYz")


def room(group, rng, x, y, kind):
    left, right, low, high, back, near = x - 0.3, x + WIDE + 0.3, y - 0.8, y + HIGH + 0.35, -DEEP, -0.3
    wall, side, whole = "wall_" + kind, "side_" + kind, [(0, 1), (1, 1), (1, 0), (0, 0)]
    group.poly(wall, [(left, low, back), (right, low, back), (right, high, back), (left, high, back)], whole)
    group.poly(side, [(left, low, near), (left, low, back), (left, high, back), (left, high, near)], whole)
    group.poly(side, [(right, low, back), (right, low, near), (right, high, near), (right, high, back)], whole)
    group.poly(wall, [(left, high, back), (right, high, back), (right, high, near), (left, high, near)], whole)
    group.poly("wood", [(left, low, near), (right, low, near), (right, low, back), (left, low, back)])
    lamp_x, lamp_y = x + WIDE * rng.uniform(0.3, 0.7), y + rng.uniform(1.05, 1.4)
    group.lathe("lamp_" + kind, [(0, -0.09), (0.07, -0.07), (0.1, 0), (0.07, 0.07), (0, 0.09)], 8,
                (lamp_x, lamp_y, -1.45))
    group.box("frame", (lamp_x - 0.008, lamp_y + 0.09, -1.46), (lamp_x + 0.008, high, -1.44), skip="yY")
    if rng.random() < 0.7:
        books(group, rng, kind, left + rng.uniform(0.1, 0.8), low, back)
    drawn = WIDE * rng.choice((0.0, 0.14, 0.2, 0.3))
    if drawn:
        curtain(group, kind, x, x + drawn, y, y + HIGH)
        curtain(group, kind, x + WIDE - drawn, x + WIDE, y, y + HIGH)
    return lamp_x, lamp_y, -1.45


def opposite(scene):
    """The street, and dark houses with lit windows on its other side."""
    rng = random.Random(3)
    group = Group("street", TILES)
    group.box("slabs", (-20, -0.2, 0), (90, 0, 3), skip="xyzXZ")
    group.box("asphalt", (-20, -0.2, 3), (90, -0.1, 11), skip="xyzXZ")
    group.box("slabs", (-20, -0.2, 11), (90, 0, 14), skip="xyXZ")
    for x, z in STREET_LAMPS:
        group.box("frame", (x - 0.05, 0, z - 0.05), (x + 0.05, 4.6, z + 0.05), skip="yY")
        group.box("street_lamp", (x - 0.16, 4.6, z - 0.16), (x + 0.16, 4.95, z + 0.16))
    group.box("dark", (90, -0.2, -200), (400, -0.15, 300), skip="xyzXZ")
    group.box("dark", (92, 0, -60), (104, 11, 60), skip="yX")
    left = 0.0
    while left < 90:
        wide, high = rng.uniform(9, 14), rng.uniform(9, 17)
        group.box("dark", (left, 0, 14), (left + wide, high, 26), skip="yZ")
        for floor in range(int(high / 3) - 1):
            for column in range(int(wide / 2.4)):
                x, y = left + 1 + 2.4 * column, 3.6 + 3 * floor
                if rng.random() < 0.35:
                    group.box("far_window", (x, y, 13.96), (x + 1.1, y + 1.4, 14), skip="Z")
        left += wide
    scene.place(group)


def lit(column, floor, rng):
    """Whether a room has light. Two near ones always do."""
    return rng.random() < 0.5 or (column, floor) in ((0, 1), (2, 1), (1, 2))


def house(scene):
    """Returns the lamps of the rooms."""
    rng, lamps = random.Random(28), []
    group = Group("facade", TILES)
    front(group)
    for column in range(COLUMNS):
        for floor in range(FLOORS):
            x, y = corner(column, floor)
            window(group, x, y)
            if lit(column, floor, rng):
                kind = rng.choice(("warm", "warm", "warm", "amber", "white", "white", "cold")) if column else "warm"
                lamps.append((room(group, rng, x, y, kind), kind))
            else:
                z = -INSET - 0.06
                group.poly("dark_glass", [(x, y, z), (x + WIDE, y, z), (x + WIDE, y + HIGH, z), (x, y + HIGH, z)])
    scene.place(group)
    return lamps


HEAD = """\
# A house of a hundred windows at dusk, in rain that is blown against it; half of the rooms are lit. The drops on the
# near windows have shapes, those on all others are textures. Made by make_facade.py.
virga: 1

meshes: [{file: facade.glb}]

environment: {file: ../environments/dusk.exr, intensity: 0.4}

# The lamps of the nearest rooms, and those of the street.
lights:
%s
camera:
  fov_deg: 44
  near_m: 0.1
  keys: # along the front
    - {time_s: 0, position_m: [%g, %g, %g], look_at_m: [7.6, 8.8, -1.4]}
    - {time_s: 2, position_m: [-0.8, 7.6, 2.5], look_at_m: [8, 8.8, -1.4]}

frames: {fps: 24, first: 1, last: 48, shutter_deg: 180, size: [1280, 720], preroll_s: 4}

preview: {exposure_ev: 1.2}

rain:
  haze_sky_m: 0 # the sky is that of a rainy evening
  rate_mm_h: 60
  wind_m_s: [0.8, 0, -6] # against the front
  gust_m_s: 0.6
  near_fade_m: 1
  max_drops: 65536
  light_gain: 2
  occlusion_size: 0 # nothing here keeps rain off

glass:
"""
FAR = "style: textures, cell_m: 0.005, max_drops: 2048, max_texels: 64, texture_columns: 5, texture_rows: 5"
CLOSE = "textured_px: 8, cell_m: 0.003, max_drops: 8192, max_texels: 512"


def far_from_eye(column, floor):
    x, y = corner(column, floor)
    return math.dist(EYE, (x + WIDE / 2, y + HIGH / 2, -INSET))


def lights(lamps):
    rows = [((x, 4.7, z), "warm", 30) for x, z in STREET_LAMPS]
    rows += [(at, kind, 0.7) for at, kind in sorted(lamps, key=lambda lamp: math.dist(EYE, lamp[0]))[:12]]
    return "".join("  - {type: point, position_m: [%.2f, %.2f, %.2f], color: [%g, %g, %g], intensity_w_sr: %g, "
                   "range_m: %d}\n" % (at + LIGHT[kind] + (power, 30 if power > 9 else 5)) for at, kind, power in rows)


def write_scene(path, lamps):
    """Panes, the distant ones first."""
    text = HEAD % ((lights(lamps),) + EYE)
    windows = [(column, floor) for column in range(COLUMNS) for floor in range(FLOORS)]
    for column, floor in sorted(windows, key=lambda window: -far_from_eye(*window)):
        x, y = corner(column, floor)
        text += "  - {name: window_%d_%d, position_m: [%.2f, %.2f, %.2f], width_m: %g, height_m: %g, kind: dirty,\n" % (
            column, floor, x + WIDE / 2, y, -INSET, WIDE, HIGH)
        text += "     %s}\n" % (CLOSE if far_from_eye(column, floor) < NEAR_M else FAR)
    with open(path + ".tmp", "w") as out:
        out.write(text)
    os.replace(path + ".tmp", path)


def main():
    images = {"asphalt": asphalt(), "brick": brick(), "glow": glow(), "slabs": slabs()}
    scene = Scene(MATERIALS, images, name="facade", generator="make_facade.py")
    lamps = house(scene)
    opposite(scene)
    scene.write(os.path.join(HERE, "scenes", "facade.glb"))
    write_scene(os.path.join(HERE, "scenes", "facade.yaml"), lamps)


if __name__ == "__main__":
    main()

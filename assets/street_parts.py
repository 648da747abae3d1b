"""The street's furniture: every part is a Group modelled about its own origin, to be placed as often as needed.

Facade parts (windows, doors, balconies) are modelled looking along +Z, standing on the opening's lower edge at z = 0.
"""
import math
import random

from gltf_writer import Frame, Group


def curve(keys, x):
    """Smooth monotone interpolation of (x, y) keys: each span eased by half, so slopes vary gently."""
    if x <= keys[0][0]:
        return keys[0][1]
    for (x0, y0), (x1, y1) in zip(keys, keys[1:]):
        if x <= x1:
            t = (x - x0) / (x1 - x0)
            eased = t * t * (3 - 2 * t)
            return y0 + (y1 - y0) * (0.5 * t + 0.5 * eased)
    return keys[-1][1]


def frame_bars(group, material, width, height, bars_x, bars_y, depth, thick=0.07, thin=0.035):
    """A window frame with glazing bars in an opening of width x height, its front at z = -depth + 0.05."""
    half, back, front = width / 2, -depth, -depth + 0.06
    group.box(material, (-half, 0, back), (-half + thick, height, front), "zxyY")
    group.box(material, (half - thick, 0, back), (half, height, front), "zXyY")
    group.box(material, (-half + thick, 0, back), (half - thick, thick, front), "zxXy")
    group.box(material, (-half + thick, height - thick, back), (half - thick, height, front), "zxXY")
    for x, wide in bars_x:
        group.box(material, (x - wide / 2, thick, back), (x + wide / 2, height - thick, front - 0.012), "zyY")
    for y in bars_y:
        group.box(material, (-half + thick, y - thin / 2, back), (half - thick, y + thin / 2, front - 0.016), "zxX")


def sill(group, width, depth=0.16):
    """A stone sill, sloping outwards with a drip nose."""
    profile = [(-depth, -0.09), (0.08, -0.09), (0.10, -0.07), (0.10, -0.03), (-depth, 0.012)]
    group.extrude("stone_trim", [(z, y) for z, y in profile], -width / 2 - 0.09, width / 2 + 0.09)


def window_casement(tiles):
    """Two leaves under a fanlight, 1.1 x 1.75 m, with a moulded stone surround (plaster houses)."""
    g = Group("window_casement", tiles)
    w, h = 1.1, 1.75
    frame_bars(g, "wood_white", w, h, [(0.0, 0.09)], [0.5, 1.27], 0.16)
    sill(g, w)
    for x0, x1 in ((-w / 2 - 0.14, -w / 2), (w / 2, w / 2 + 0.14)):
        g.box("stone_trim", (x0, 0.0, -0.01), (x1, h, 0.035), "zyY")
    g.box("stone_trim", (-w / 2 - 0.14, h, -0.01), (w / 2 + 0.14, h + 0.16, 0.045), "zy")
    g.extrude("stone_trim", [(-0.01, h + 0.16), (0.05, h + 0.16), (0.11, h + 0.22), (0.11, h + 0.25),
                             (-0.01, h + 0.27)],
              -w / 2 - 0.2, w / 2 + 0.2)
    return g


def window_sash(tiles):
    """A sash of 2 x 4 panes, 1.0 x 1.7 m, under a stone lintel (brick houses)."""
    g = Group("window_sash", tiles)
    w, h = 1.0, 1.7
    frame_bars(g, "wood_white", w, h, [(0.0, 0.03)], [0.45, 0.86, 1.28], 0.16)
    g.box("wood_white", (-w / 2 + 0.07, 0.82, -0.13), (w / 2 - 0.07, 0.90, -0.085), "zxX")
    sill(g, w)
    flare = [(-w / 2, h), (w / 2, h), (w / 2 + 0.14, h + 0.26), (-w / 2 - 0.14, h + 0.26)]
    g.poly("stone_trim", [(x, y, 0.02) for x, y in flare])
    g.poly("stone_trim", [(-w / 2, h, -0.16), (w / 2, h, -0.16), (w / 2, h, 0.02), (-w / 2, h, 0.02)])
    g.poly("stone_trim", [(-w / 2 - 0.14, h + 0.26, 0.02), (w / 2 + 0.14, h + 0.26, 0.02),
                          (w / 2 + 0.14, h + 0.26, 0), (-w / 2 - 0.14, h + 0.26, 0)])
    g.box("stone_trim", (-0.09, h - 0.01, 0), (0.09, h + 0.31, 0.05), "z")
    return g


def window_french(tiles):
    """A glazed balcony door, 1.2 x 2.4 m."""
    g = Group("window_french", tiles)
    frame_bars(g, "wood_white", 1.2, 2.4, [(0.0, 0.10)], [0.62, 1.25, 1.9], 0.16)
    g.box("wood_white", (-0.53, 0.07, -0.15), (0.53, 0.55, -0.12), "zxXy")
    for x0, x1 in ((-0.74, -0.6), (0.6, 0.74)):
        g.box("stone_trim", (x0, 0.0, -0.01), (x1, 2.4, 0.035), "zyY")
    g.extrude("stone_trim", [(-0.01, 2.4), (0.05, 2.4), (0.05, 2.56), (0.13, 2.63), (0.13, 2.67), (-0.01, 2.70)], -0.8,
              0.8)
    return g


def shutters(tiles):
    """A pair of louvred shutters, open against the wall beside a 1.1 m casement."""
    g = Group("shutters", tiles)
    for side in (-1, 1):
        x0, x1 = sorted((side * 0.71, side * 1.24))
        for lo, hi in (((x0, 0, 0.04), (x0 + 0.07, 1.75, 0.085)), ((x1 - 0.07, 0, 0.04), (x1, 1.75, 0.085))):
            g.box("wood_green", lo, hi, "z")
        for y in (0.0, 0.83, 1.67):
            g.box("wood_green", (x0 + 0.07, y, 0.04), (x1 - 0.07, y + 0.08, 0.085), "zxX")
        for k in range(18):
            y = 0.08 + k * 0.088 + (0.04 if k > 8 else 0.0)
            g.poly("wood_green", [(x0 + 0.06, y, 0.075), (x1 - 0.06, y, 0.075), (x1 - 0.06, y + 0.09, 0.048),
                                  (x0 + 0.06, y + 0.09, 0.048)])
    return g


def door(tiles, material):
    """A panelled door, 1.2 x 2.5 m with a glazed fanlight in its top 0.5 m, stone jambs and two steps."""
    g = Group("door_" + material.split("_")[1], tiles)
    z = -0.2
    g.poly(material, [(-0.6, 0, z), (0.6, 0, z), (0.6, 1.98, z), (-0.6, 1.98, z)])
    for x0, x1, y0, y1 in ((-0.6, -0.5, 0, 1.98), (0.5, 0.6, 0, 1.98), (-0.05, 0.05, 0.2, 1.88), (-0.5, 0.5, 0, 0.2),
                           (-0.5, 0.5, 0.85, 1.0), (-0.5, 0.5, 1.88, 1.98)):
        g.box(material, (x0, y0, z), (x1, y1, z + 0.035), "z")
    g.box("wood_white", (-0.6, 1.98, z), (0.6, 2.06, z + 0.08), "z")
    for x in (-0.3, 0.0, 0.3):
        g.box("wood_white", (x - 0.02, 2.06, z), (x + 0.02, 2.5, z + 0.04), "zyY")
    g.lathe("brass", [(0.0, -0.035), (0.03, -0.02), (0.035, 0.0), (0.03, 0.02), (0.0, 0.035)], 8, (0.12, 1.0, z + 0.08))
    for x0, x1 in ((-0.82, -0.6), (0.6, 0.82)):
        g.box("stone_trim", (x0, -0.1, -0.01), (x1, 2.5, 0.06), "zyY")
    g.extrude("stone_trim", [(-0.01, 2.5), (0.06, 2.5), (0.06, 2.72), (0.22, 2.80), (0.22, 2.86), (-0.01, 2.92)],
              -0.95, 0.95)
    g.box("stone_trim", (-0.75, -0.22, -0.25), (0.75, 0.0, 0.28), "zy")
    return g


def balcony(tiles, width=3.0):
    """A stone balcony on brackets with a wrought-iron railing, its floor at y = 0."""
    g = Group("balcony", tiles)
    depth, half = 0.95, width / 2
    g.extrude("stone_trim", [(0, -0.22), (depth - 0.12, -0.22), (depth - 0.02, -0.12), (depth, -0.1), (depth, -0.02),
                             (0, 0.01)], -half, half)
    for x in (-half + 0.35, half - 0.35):
        g.extrude("stone_trim", [(0, -0.85), (0.12, -0.8), (0.2, -0.55), (0.42, -0.36), (0.7, -0.22), (0, -0.22)],
                  x - 0.1, x + 0.1)
    front, side = depth - 0.08, half - 0.07
    for y0, y1 in ((0.08, 0.11), (0.86, 0.88), (0.98, 1.02)):
        g.box("steel_black", (-side, y0, front - 0.015), (side, y1, front + 0.015), "xX")
        for x in (-side, side):
            g.box("steel_black", (x - 0.015, y0, 0), (x + 0.015, y1, front), "zZ")
    count = 24
    bars = [(-side + 2 * side * k / count, front) for k in range(count + 1)]
    bars += [(s * side, front * k / 7) for s in (-1, 1) for k in range(1, 7)]
    for x, z in bars:
        g.lathe("steel_black", [(0.009, 0.0), (0.009, 1.0)], 4, (x, 0.0, z), 45.0)
    for k in range(count):
        x = -side + 2 * side * (k + 0.5) / count
        g.lathe("steel_black", [(0.03, 0.90), (0.03, 0.96)], 6, (x, 0.0, front))
    return g


def flower_box(tiles, seed):
    """A planted trough to hang on a sill or railing."""
    g, rng = Group("flower_box", tiles), random.Random(seed)
    g.box("wood_brown", (-0.45, 0.0, -0.1), (0.45, 0.18, 0.1), "Y")
    g.poly("soil", [(-0.45, 0.16, 0.1), (0.45, 0.16, 0.1), (0.45, 0.16, -0.1), (-0.45, 0.16, -0.1)])
    for _ in range(46):
        leaf(g, (rng.uniform(-0.46, 0.46), rng.uniform(0.14, 0.42), rng.uniform(-0.14, 0.18)), rng, 0.12, (0, 0.2, 0))
    return g


def leaf(g, centre, rng, size, inner):
    """One folded leaf: two triangles; its normals lean away from inner, so clumps shade softly."""
    yaw, tilt = rng.uniform(0, 6.283), rng.uniform(-0.9, 0.9)
    along = (math.cos(yaw) * math.cos(tilt), math.sin(tilt), math.sin(yaw) * math.cos(tilt))
    side = (-math.sin(yaw), rng.uniform(-0.3, 0.3), math.cos(yaw))
    a = [centre[k] - along[k] * size for k in range(3)]
    b = [centre[k] + side[k] * size * 0.55 for k in range(3)]
    c = [centre[k] + along[k] * size for k in range(3)]
    d = [centre[k] - side[k] * size * 0.55 for k in range(3)]
    out = [centre[k] - inner[k] for k in range(3)]
    v0 = rng.random() * 0.7
    g.poly("leaves", [tuple(a), tuple(b), tuple(c), tuple(d)],
           [(0.5, v0), (0.95, v0 + 0.15), (0.5, v0 + 0.3), (0.05, v0 + 0.15)], (out[0], out[1] + 0.35, out[2]))


def leaf_clump(tiles, seed, leaves=78):
    """A clump of leaves about 0.6 m in radius, denser towards its outside."""
    g, rng = Group("clump_%d" % seed, tiles), random.Random(seed)
    for _ in range(leaves):
        while True:
            p = tuple(rng.uniform(-1, 1) for _ in range(3))
            r = math.sqrt(sum(x * x for x in p))
            if 0.25 < r < 1.0:
                break
        leaf(g, (p[0] * 0.66, p[1] * 0.5, p[2] * 0.66), rng, rng.uniform(0.085, 0.13), (0, -0.1, 0))
    return g


def tree_trunk(tiles, seed):
    """A young lime: a leaning trunk and nine boughs. Returns the group and the places for clumps."""
    g, rng = Group("tree", tiles), random.Random(seed)
    trunk = [(0.04 * math.sin(k * 1.3), -0.05 + k * 0.46, 0.05 * math.sin(k * 0.9)) for k in range(8)]
    g.tube("wood_bark", trunk, [0.16, 0.12, 0.105, 0.1, 0.095, 0.09, 0.085, 0.07], 9)
    places = []
    for k in range(10):
        angle, start = k * 2.4 + rng.uniform(-0.3, 0.3), trunk[5 + k % 3]
        reach, rise = rng.uniform(0.9, 1.5), rng.uniform(0.6, 2.4)
        path = [tuple((start[0] + math.cos(angle) * reach * t, start[1] + rise * t ** 0.8,
                       start[2] + math.sin(angle) * reach * t)) for t in (0.0, 0.35, 0.7, 1.0)]
        g.tube("wood_bark", path, [0.05, 0.038, 0.025, 0.012], 5)
        places += [path[-1], path[2]]
    for _ in range(36):
        angle, up = rng.uniform(0, 6.283), rng.uniform(-0.75, 1.0)
        wide = math.sqrt(max(0.0, 1.0 - up * up)) * rng.uniform(0.72, 1.0)
        places.append((math.cos(angle) * 1.75 * wide, 4.55 + 1.7 * up, math.sin(angle) * 1.75 * wide))
    return g, places


def tree_pit(tiles):
    """A square of soil with tufts of grass inside a cast-iron frame, 1.2 m wide."""
    g, rng = Group("tree_pit", tiles), random.Random(3)
    g.poly("soil", [(-0.55, 0.012, 0.55), (0.55, 0.012, 0.55), (0.55, 0.012, -0.55), (-0.55, 0.012, -0.55)])
    for lo, hi in (((-0.6, 0, 0.55), (0.6, 0.025, 0.6)), ((-0.6, 0, -0.6), (0.6, 0.025, -0.55)),
                   ((-0.6, 0, -0.55), (-0.55, 0.025, 0.55)), ((0.55, 0, -0.55), (0.6, 0.025, 0.55))):
        g.box("steel_black", lo, hi, "y")
    for _ in range(70):
        x, z, a = rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(0, 3.14)
        h, lean = rng.uniform(0.06, 0.2), rng.uniform(-0.06, 0.06)
        dx, dz = 0.012 * math.cos(a), 0.012 * math.sin(a)
        g.poly("grass", [(x - dx, 0.01, z - dz), (x + dx, 0.01, z + dz), (x + lean, h, z + lean)], None, (0, 1, 0.3))
    return g


def street_lamp(tiles):
    """A cast-iron lamp post, 4.6 m tall, with a four-sided lantern; its light sits at (0, 4.05, 0)."""
    g = Group("street_lamp", tiles)
    g.lathe("steel_cast_iron", [(0.20, 0.0), (0.20, 0.10), (0.17, 0.14), (0.155, 0.55), (0.17, 0.60), (0.17, 0.66),
                                (0.10, 0.76), (0.075, 0.95), (0.09, 1.0), (0.09, 1.05), (0.065, 1.12), (0.05, 2.9),
                                (0.075, 2.95), (0.075, 3.02), (0.045, 3.1), (0.04, 3.45), (0.09, 3.55), (0.1, 3.6)], 12)
    g.box("steel_cast_iron", (-0.32, 3.17, -0.018), (0.32, 3.205, 0.018))
    for x in (-0.32, 0.32):
        g.lathe("steel_cast_iron", [(0.0, -0.035), (0.03, -0.02), (0.035, 0), (0.03, 0.02), (0, 0.035)], 8,
                (x, 3.19, 0))
    r = math.sqrt(2.0)
    g.lathe("steel_cast_iron", [(0.12 * r, 3.58), (0.14 * r, 3.6), (0.14 * r, 3.64), (0.0, 3.64)], 4, start_deg=45)
    for k in range(4):
        g.frame = Frame((0, 0, 0), 90.0 * k)
        g.poly("glass_lamp_emissive", [(-0.115, 3.65, 0.115), (0.115, 3.65, 0.115), (0.195, 4.22, 0.195),
                                       (-0.195, 4.22, 0.195)])
        g.tube("steel_cast_iron", [(-0.125, 3.64, 0.125), (-0.205, 4.23, 0.205)], 0.014, 4)
        g.tube("steel_cast_iron", [(0.0, 3.64, 0.12), (0.0, 4.23, 0.2)], 0.008, 4)
    g.frame = Frame()
    for profile in ([(0.20 * r, 4.21), (0.235 * r, 4.22), (0.235 * r, 4.26), (0.16 * r, 4.36), (0.07 * r, 4.44),
                     (0.07 * r, 4.5), (0.09 * r, 4.51), (0.05 * r, 4.57), (0.0, 4.58)],):
        g.lathe("steel_cast_iron", profile, 4, start_deg=45)
    g.lathe("steel_cast_iron", [(0.0, 4.56), (0.035, 4.6), (0.0, 4.68)], 6)
    return g


def hanging_lantern(tiles):
    """A small lantern on a rod; its top at y = 0, the light at y = -0.62."""
    g = Group("hanging_lantern", tiles)
    g.lathe("steel_cast_iron", [(0.012, -0.4), (0.012, 0.0)], 5)
    g.lathe("steel_cast_iron", [(0.17, -0.45), (0.06, -0.37), (0.0, -0.36)], 6)
    g.lathe("steel_cast_iron", [(0.0, -0.82), (0.10, -0.80), (0.11, -0.78)], 6)
    g.lathe("glass_lamp_emissive", [(0.095, -0.78), (0.14, -0.45)], 6)
    return g


def bollard(tiles):
    g = Group("bollard", tiles)
    g.lathe("steel_cast_iron", [(0.11, 0.0), (0.11, 0.08), (0.085, 0.12), (0.07, 0.7), (0.085, 0.73), (0.085, 0.78),
                                (0.055, 0.82), (0.075, 0.88), (0.06, 0.95), (0.0, 0.98)], 10)
    return g


def litter_bin(tiles):
    """A slatted bin, 0.9 m tall, with a domed steel lid."""
    g = Group("litter_bin", tiles)
    for k in range(16):
        g.frame = Frame((0, 0, 0), 22.5 * k)
        g.box("wood_green", (-0.042, 0.12, 0.235), (0.042, 0.74, 0.26), "zyY")
    g.frame = Frame()
    g.lathe("steel_black", [(0.2, 0.0), (0.2, 0.06), (0.23, 0.1), (0.232, 0.8)], 14)
    g.lathe("steel_black", [(0.275, 0.74), (0.28, 0.78), (0.26, 0.80), (0.15, 0.80)], 14)
    g.lathe("steel_black", [(0.27, 0.98), (0.27, 1.0), (0.2, 1.06), (0.0, 1.09)], 14)
    for k in range(3):
        a = k * 2.094
        x, z = 0.22 * math.cos(a), 0.22 * math.sin(a)
        g.box("steel_black", (x - 0.015, 0.78, z - 0.015), (x + 0.015, 0.99, z + 0.015), "yY")
    return g


def bench(tiles):
    """A slatted bench along X, 1.7 m long, looking along +Z, on two cast-iron frames."""
    g = Group("bench", tiles)
    for k in range(5):
        z = 0.05 + k * 0.092
        g.box("wood_brown", (-0.85, 0.43, z), (0.85, 0.465, z + 0.072))
    for k in range(3):
        y, z = 0.56 + k * 0.12, 0.0 - k * 0.035
        g.box("wood_brown", (-0.85, y, z - 0.03), (0.85, y + 0.09, z + 0.003))
    for x in (-0.66, 0.66):
        g.tube("steel_cast_iron", [(x, 0.0, 0.5), (x, 0.2, 0.44), (x, 0.41, 0.47)], 0.022)
        g.tube("steel_cast_iron", [(x, 0.0, -0.08), (x, 0.25, 0.03), (x, 0.5, 0.0), (x, 0.92, -0.13)], 0.022)
        g.tube("steel_cast_iron", [(x, 0.4, 0.48), (x, 0.4, 0.02)], 0.02)
        g.tube("steel_cast_iron", [(x, 0.42, 0.49), (x, 0.62, 0.50), (x, 0.66, 0.42), (x, 0.66, -0.03)], 0.018)
    return g


def crate(tiles, fruit, seed):
    """A market crate of slats, 0.55 x 0.3 x 0.38 m, tilted by whoever places it; heaped with fruit if one is named."""
    g, rng = Group("crate_" + (fruit or "empty"), tiles), random.Random(seed)
    for k in range(3):
        y = 0.02 + k * 0.09
        for z0, z1 in ((-0.19, -0.178), (0.178, 0.19)):
            g.box("wood_pale", (-0.275, y, z0), (0.275, y + 0.075, z1))
        for x0, x1 in ((-0.275, -0.263), (0.263, 0.275)):
            g.box("wood_pale", (x0, y, -0.178), (x1, y + 0.075, 0.178), "zZ")
    for x in (-0.25, 0.235):
        for z in (-0.178, 0.163):
            g.box("wood_pale", (x, 0, z), (x + 0.015, 0.3, z + 0.015), "y")
    level = 0.17 if fruit else 0.02
    g.poly("wood_pale", [(-0.265, level, 0.18), (0.265, level, 0.18), (0.265, level, -0.18), (-0.265, level, -0.18)])
    for k in range(28 if fruit else 0):
        x, z = -0.225 + (k % 7) * 0.075 + rng.uniform(-0.01, 0.01), -0.135 + (k // 7) * 0.09 + rng.uniform(-0.01, 0.01)
        r = rng.uniform(0.04, 0.047)
        ring = [(0.0, -r), (0.8 * r, -0.55 * r), (r, 0.0), (0.8 * r, 0.6 * r), (0.0, 0.9 * r)]
        g.lathe("fruit_" + fruit, ring[1:], 6, (x, 0.2 + rng.uniform(0.0, 0.03), z), rng.uniform(0, 60))
    return g


def drain_grate(tiles):
    """A cast-iron gully grate, 0.38 x 0.5 m, slots over a dark pit; lies in the gutter, long side along Z."""
    g = Group("drain_grate", tiles)
    g.poly("steel_pit", [(-0.19, 0.002, 0.25), (0.19, 0.002, 0.25), (0.19, 0.002, -0.25), (-0.19, 0.002, -0.25)])
    for lo, hi in (((-0.19, 0, -0.25), (-0.15, 0.014, 0.25)), ((0.15, 0, -0.25), (0.19, 0.014, 0.25)),
                   ((-0.15, 0, -0.25), (0.15, 0.014, -0.21)), ((-0.15, 0, 0.21), (0.15, 0.014, 0.25)),
                   ((-0.02, 0, -0.21), (0.02, 0.014, 0.21))):
        g.box("steel_grate", lo, hi, "y")
    for k in range(8):
        z = -0.19 + k * 0.051
        g.box("steel_grate", (-0.15, 0, z), (0.15, 0.013, z + 0.024), "yxX")
    return g


def manhole(tiles):
    """A round cast-iron cover, 0.66 m across, with raised studs."""
    g = Group("manhole", tiles)
    g.lathe("steel_grate", [(0.36, -0.01), (0.36, 0.006), (0.33, 0.006), (0.325, 0.0), (0.315, 0.0), (0.31, 0.006),
                            (0.0, 0.006)], 24)
    for i in range(-4, 5):
        for j in range(-4, 5):
            if i * i + j * j < 16 and (i + j) % 2 == 0:
                x, z = i * 0.065, j * 0.065
                g.poly("steel_grate", [(x - 0.022, 0.012, z + 0.022), (x + 0.022, 0.012, z + 0.022),
                                       (x + 0.022, 0.012, z - 0.022), (x - 0.022, 0.012, z - 0.022)])
    return g


CAR_TOP = [(-1.98, 0.60), (-1.9, 0.74), (-1.6, 0.83), (-1.0, 0.93), (-0.85, 0.96), (-0.45, 1.18), (-0.05, 1.36),
           (0.45, 1.42), (1.0, 1.40), (1.45, 1.31), (1.72, 1.12), (1.9, 0.96), (1.98, 0.80)]
CAR_BELT = [(-1.98, 0.56), (-1.9, 0.68), (-1.5, 0.78), (-0.8, 0.86), (0.5, 0.90), (1.5, 0.93), (1.9, 0.90),
            (1.98, 0.76)]
CAR_WIDE = [(-1.98, 0.58), (-1.92, 0.68), (-1.7, 0.76), (-1.2, 0.81), (0.0, 0.83), (1.3, 0.82), (1.75, 0.78),
            (1.92, 0.70),
            (1.98, 0.62)]
CAR_ROOF = [(-0.9, 0.66), (-0.45, 0.63), (0.0, 0.585), (0.8, 0.585), (1.4, 0.57), (1.95, 0.64)]
CAR_WHEELS = (-1.24, 1.22)


def car_section(z):
    """Half a cross-section of the body at z: points from the lower edge up to the middle of the roof."""
    wide, top, belt = curve(CAR_WIDE, z), curve(CAR_TOP, z), curve(CAR_BELT, z)
    low = curve([(-1.98, 0.34), (-1.8, 0.24), (1.8, 0.25), (1.98, 0.38)], z)
    for wheel in CAR_WHEELS:
        if abs(z - wheel) < 0.36:
            low = max(low, 0.30 + math.sqrt(0.36 ** 2 - (z - wheel) ** 2))
    cabin = min(1.0, max(0.0, (top - belt - 0.08) / 0.3))
    roof = curve(CAR_ROOF, z) * cabin + wide * 0.86 * (1 - cabin)
    low = min(low, belt - 0.10)
    return [(wide * 0.955, low), (wide * 0.99, low + (belt - low) * 0.38), (wide, low + (belt - low) * 0.68),
            (wide * 0.985, belt - 0.035), (wide * 0.955, belt), (roof + 0.018 * cabin, top - 0.07 * cabin - 0.012),
            (roof * 0.94, top - 0.022), (roof * 0.5, top - 0.004), (0.0, top)]


def car_stations():
    stations = {-1.98, -1.95, -1.88, -1.76, -0.85, -0.62, -0.4, -0.15, 0.05, 0.25, 0.33, 0.6, 1.4, 1.62, 1.78, 1.88,
                1.94, 1.98}
    for wheel in CAR_WHEELS:
        stations |= {round(wheel + 0.36 * math.sin(math.radians(a)), 4)
                     for a in (-89.9, -65, -42, -20, 0, 20, 42, 65, 89.9)}
    return sorted(stations)


def car_material(z, j):
    """What a patch of the body is made of, by its middle z and by its row in the section."""
    if j == 4 and -0.42 < z < 1.36 and not 0.25 < z < 0.33:
        return "glass_car"
    if j >= 6 and (-0.85 < z < -0.10 or 1.44 < z < 1.80):
        return "glass_car"
    return "rubber_black" if j == 0 and abs(z) > 1.7 else "steel_car_paint"


def car_body(g):
    """The lofted shell; normals are smooth over the whole of it, whatever the material of a patch."""
    stations = car_stations()
    half = [[(x, y, z) for x, y in car_section(z)] for z in stations]
    rows = [[(-x, y, z) for x, y, z in s] + [(x, y, z) for x, y, z in reversed(s[:-1])] for s in half]
    normals = Group._grid_normals(rows)
    for i in range(len(rows) - 1):
        for j in range(len(rows[0]) - 1):
            material = car_material((stations[i] + stations[i + 1]) / 2, j if j < 8 else 15 - j)
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            mesh = g._mesh(material)
            base = len(mesh.positions)
            g.poly(material, [rows[a][b] for a, b in corners])
            for k, (a, b) in enumerate(corners):
                n = normals[a][b]
                length = math.sqrt(sum(c * c for c in n)) or 1.0
                mesh.normals[base + k] = tuple(-c / length for c in n)
    g.poly("steel_car_paint", rows[0])
    g.poly("steel_car_paint", list(reversed(rows[-1])))


def car(tiles):
    """A parked hatchback 4 m long, its front at -Z, wheels on y = 0."""
    g = Group("car", tiles)
    car_body(g)
    g.box("rubber_black", (-0.66, 0.22, -1.75), (0.66, 0.52, 1.75), "Y")
    for z in CAR_WHEELS:
        for side in (-1, 1):
            car_wheel(g, side, z)
    for side in (-1, 1):
        x0, x1 = sorted((side * 0.40, side * 0.62))
        g.box("glass_car_red", (x0, 0.72, 1.93), (x1, 0.86, 1.985), "z")
        g.box("glass_car_clear", (x0, 0.56, -1.985), (x1, 0.68, -1.9), "Z")
        x0, x1 = sorted((side * 0.83, side * 0.99))
        g.box("steel_car_paint", (x0, 0.93, -0.52), (x1, 1.06, -0.40))
    g.box("steel_car_plate", (-0.26, 0.60, 1.96), (0.26, 0.71, 1.992), "z")
    for z0, z1 in ((1.88, 2.03), (-2.03, -1.88)):
        g.box("rubber_black", (-0.68, 0.40, z0), (0.68, 0.53, z1))
    return g


def car_wheel(g, side, z):
    """Tyre and rim as rings about X."""
    rings = [("rubber_black", [(0.17, 0.30), (0.02, 0.30), (0.0, 0.285), (-0.005, 0.20)]),
             ("steel_rim", [(-0.005, 0.20), (0.03, 0.185), (0.03, 0.09), (0.0, 0.07), (-0.005, 0.0)])]
    for material, ring in rings:
        rows = []
        for depth, radius in ring:
            x = side * (0.825 - depth)
            points = [(x, 0.30 + radius * math.cos(a * math.pi / 9), z + radius * math.sin(a * math.pi / 9))
                      for a in range(19)]
            rows.append(points if side > 0 else points[::-1])
        g.surface(material, rows)

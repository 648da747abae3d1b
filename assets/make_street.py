#!/usr/bin/env python3
"""Writes scenes/street.glb: a small European street at dusk, made for rain. Python 3 standard library only.

Metres, Y up. The street runs along Z, from z = 20 behind the camera to a square with a church at z = -60. The road is
7 m wide (x from -3.5 to 3.5), the pavements 2.5 m; house fronts stand at x = -6 and x = 6. The same source always
gives the same bytes.
"""
import math
import os
import random

import street_parts as parts
import street_textures
from gltf_writer import Frame, Group, Scene

NEAR_Z, FAR_Z, END_Z = 20.0, -45.0, -59.0
HALF_ROAD, HALF_ASPHALT, HALF_STREET = 3.5, 3.1, 6.0
KERB = 0.12

# One entry per material: image (baseColor), colour (a tint), rough, metal, emit and strength (radiance is their
# product).
MATERIALS = [
    {"name": "asphalt", "image": "asphalt", "rough": 0.88},
    {"name": "asphalt_patch", "image": "asphalt", "colour": (0.52, 0.53, 0.56), "rough": 0.82},
    {"name": "asphalt_tar", "colour": (0.012, 0.012, 0.013), "rough": 0.45},
    {"name": "asphalt_paint", "image": "paint", "colour": (0.62, 0.62, 0.60), "rough": 0.6},
    {"name": "cobble_stone", "image": "setts", "joints": "setts_joints", "rough": 0.7},
    {"name": "kerb_stone", "image": "metal", "colour": (0.36, 0.36, 0.35), "rough": 0.75},
    {"name": "concrete_slabs", "image": "slabs", "joints": "slabs_joints", "rough": 0.85},
    {"name": "brick_red", "image": "brick", "rough": 0.9},
    {"name": "brick_brown", "image": "brick", "colour": (0.62, 0.66, 0.70), "rough": 0.9},
    {"name": "plaster_ochre", "image": "plaster", "colour": (0.78, 0.56, 0.30), "rough": 0.92},
    {"name": "plaster_cream", "image": "plaster", "colour": (0.86, 0.78, 0.62), "rough": 0.92},
    {"name": "plaster_rose", "image": "plaster", "colour": (0.74, 0.50, 0.42), "rough": 0.92},
    {"name": "plaster_grey", "image": "plaster", "colour": (0.50, 0.53, 0.55), "rough": 0.92},
    {"name": "stone_trim", "image": "metal", "colour": (0.62, 0.57, 0.48), "rough": 0.85},
    {"name": "stone_blocks", "image": "ashlar", "rough": 0.88},
    {"name": "tile_roof", "image": "roof_tiles", "rough": 0.75},
    {"name": "tile_slate", "image": "roof_tiles", "colour": (0.30, 0.46, 0.62), "rough": 0.6},
    {"name": "steel_black", "image": "metal", "colour": (0.03, 0.032, 0.035), "rough": 0.45},
    {"name": "steel_cast_iron", "image": "metal", "colour": (0.035, 0.042, 0.04), "rough": 0.5},
    {"name": "steel_zinc", "image": "metal", "colour": (0.42, 0.44, 0.46), "rough": 0.5, "metal": 0.6,
     "two_sided": True},
    {"name": "steel_grate", "image": "metal", "colour": (0.16, 0.15, 0.14), "rough": 0.55, "metal": 0.5},
    {"name": "steel_pit", "colour": (0.004, 0.004, 0.004), "rough": 1.0},
    {"name": "steel_rim", "colour": (0.45, 0.46, 0.47), "rough": 0.35, "metal": 0.8},
    {"name": "steel_car_paint", "colour": (0.025, 0.07, 0.10), "rough": 0.22, "metal": 0.25},
    {"name": "steel_car_plate", "colour": (0.75, 0.75, 0.70), "rough": 0.5},
    {"name": "rubber_black", "colour": (0.015, 0.015, 0.016), "rough": 0.8},
    {"name": "brass", "colour": (0.72, 0.52, 0.24), "rough": 0.3, "metal": 1.0},
    {"name": "glass_window", "image": "interiors", "colour": (0.10, 0.12, 0.14), "rough": 0.06},
    {"name": "glass_window_lit", "image": "interiors", "colour": (0.10, 0.10, 0.10), "rough": 0.06,
     "emit": (1.0, 0.66, 0.34), "strength": 1.0},
    {"name": "glass_shop_lit", "image": "shop_window", "colour": (0.10, 0.10, 0.10), "rough": 0.05,
     "emit": (1.0, 0.80, 0.55), "strength": 1.0},
    {"name": "glass_lamp_emissive", "colour": (0.8, 0.7, 0.5), "rough": 0.3, "emit": (1.0, 0.72, 0.38),
     "strength": 3.0},
    {"name": "glass_car", "colour": (0.012, 0.014, 0.016), "rough": 0.04},
    {"name": "glass_car_red", "colour": (0.22, 0.008, 0.008), "rough": 0.12},
    {"name": "glass_car_clear", "colour": (0.4, 0.42, 0.44), "rough": 0.08},
    {"name": "wood_white", "image": "wood", "colour": (0.82, 0.81, 0.77), "rough": 0.55},
    {"name": "wood_green", "image": "wood", "colour": (0.07, 0.17, 0.13), "rough": 0.5},
    {"name": "wood_blue", "image": "wood", "colour": (0.05, 0.10, 0.19), "rough": 0.45},
    {"name": "wood_brown", "image": "wood", "colour": (0.25, 0.13, 0.065), "rough": 0.6},
    {"name": "wood_pale", "image": "wood", "colour": (0.55, 0.40, 0.24), "rough": 0.8},
    {"name": "wood_bark", "image": "earth", "colour": (1.0, 1.0, 0.95), "rough": 0.95},
    {"name": "fabric_awning", "image": "stripes", "rough": 0.85, "two_sided": True, "passes": 0.2},
    {"name": "leaves", "image": "foliage", "rough": 0.55, "two_sided": True},
    {"name": "grass", "image": "foliage", "colour": (0.9, 1.0, 0.8), "rough": 0.7, "two_sided": True},
    {"name": "soil", "image": "earth", "rough": 0.98},
    {"name": "fruit_apple", "colour": (0.42, 0.035, 0.02), "rough": 0.35},
    {"name": "fruit_orange", "colour": (0.75, 0.25, 0.02), "rough": 0.45},
    {"name": "fruit_pear", "colour": (0.36, 0.42, 0.07), "rough": 0.4},
]

# Metres of one repeat, by image.
TILE_M = {"asphalt": 4.0, "brick": 1.8, "slabs": 2.4, "setts": 0.96, "ashlar": 2.4, "plaster": 4.0, "roof_tiles": 1.6,
          "wood": 1.0, "metal": 0.5, "stripes": 1.2, "foliage": 0.5, "earth": 1.0, "paint": 0.8}
TILES = {m["name"]: TILE_M.get(m.get("image"), 1.0) for m in MATERIALS}

# (x, z, depth m, radius m) of shallow hollows in the road: where puddles will stand.
HOLLOWS = [(-1.6, 2.6, 0.020, 1.2), (0.9, -1.5, 0.018, 1.0), (-0.4, -6.2, 0.022, 1.5), (2.2, 3.8, 0.014, 0.8),
           (1.9, -10.0, 0.018, 1.2), (-2.1, -12.5, 0.020, 1.1), (0.3, -23.5, 0.022, 1.6), (-2.4, -1.2, 0.016, 0.8),
           (-1.0, -30.0, 0.02, 1.5), (1.4, 9.5, 0.02, 1.2)]

# The same of the pavements, where slabs have settled.
SETTLED = [(5.12, -2.7, 0.026, 0.6), (4.6, -7.2, 0.022, 0.6), (-4.6, 1.6, 0.024, 0.6), (4.8, 3.9, 0.022, 0.55),
           (-4.5, -18.2, 0.024, 0.7), (4.7, -17.6, 0.024, 0.6)]

# Along the street, of gully grates on both sides. The channel before the kerb falls towards them, by 4 mm per metre.
GRATES = (4.6, -7.4, -20.8, -33.0)
CHANNEL_FALL, CHANNEL_RUN = 0.004, 6.6

# Street lamps, (x, z); see parts.street_lamp for where the light is.
LAMPS = [(-3.95, -1.2), (3.95, -13.2), (-3.95, -25.5), (3.95, -38.0)]


def road_height(x, z):
    """Camber, old settlement, hollows, and channels that fall to grates; about 0 at the kerb, far from a grate."""
    edge = max(0.0, 1.0 - (x / HALF_ROAD) ** 2)
    y = 0.075 * edge
    y += 0.005 * edge * (math.sin(1.1 * z + 1.7 * math.sin(0.9 * x)) + math.sin(0.53 * z - 1.3 * x))
    for hx, hz, depth, radius in HOLLOWS:
        y -= depth * edge * math.exp(-((x - hx) ** 2 + (z - hz) ** 2) / (radius * radius * 0.6))
    channel = min(max((abs(x) - HALF_ASPHALT) / 0.2, 0.0), 1.0)
    return y - channel * CHANNEL_FALL * max(CHANNEL_RUN - min(abs(z - grate) for grate in GRATES), 0.0)


def pavement_height(x, z=None):
    """Falls to the kerb; with the hollows of settled slabs at a z."""
    y = KERB + 0.02 * (abs(x) - 3.64)
    for hx, hz, depth, radius in SETTLED if z is not None else ():
        y -= depth * math.exp(-((x - hx) ** 2 + (z - hz) ** 2) / (radius * radius * 0.6))
    return y


def span(start, stop, steps):
    return [start + (stop - start) * k / steps for k in range(steps + 1)]


def sheet(group, material, xs, zs, height):
    """A ground surface over a grid of x (rising) and z (falling), facing up."""
    group.surface(material, [[(x, height(x, z), z) for x in xs] for z in zs], planar=True)


ROAD_XS, ROAD_ZS = span(-HALF_ASPHALT, HALF_ASPHALT, 20), span(NEAR_Z, FAR_Z, 108)


def make_ground(scene):
    g = Group("road", TILES)
    sheet(g, "asphalt", ROAD_XS, ROAD_ZS, road_height)
    for side in (-1, 1):
        xs = sorted((side * HALF_ASPHALT, side * 3.3, side * HALF_ROAD))
        sheet(g, "cobble_stone", xs, ROAD_ZS, road_height)
        zs = {NEAR_Z, FAR_Z} | {round(z + 0.16 * k, 3) for x, z, _, _ in SETTLED if x * side > 0 for k in range(-7, 8)}
        sheet(g, "concrete_slabs", span(*sorted((side * 3.64, side * HALF_STREET)), 12), sorted(zs, reverse=True),
              pavement_height)
    sheet(g, "cobble_stone", span(-32, 32, 4), span(FAR_Z, END_Z, 4), lambda x, z: 0.0)
    # Under church and houses, too: between them one sees to the ground behind.
    sheet(g, "cobble_stone", span(-32, 32, 4), [END_Z, END_Z - 24.0], lambda x, z: 0.0)
    for x0, x1 in ((-20.0, -9.0), (7.5, 20.0)):
        sheet(g, "grass", [x0, x1], [-52.0, END_Z + 0.6], lambda x, z: 0.06)
    sheet(g, "concrete_slabs", [-HALF_STREET, HALF_STREET], [NEAR_Z + 3, NEAR_Z], lambda x, z: 0.0)
    scene.place(g)


def road_surface(x, z):
    """Height of the road's own triangles, in the asphalt."""
    column = min(int((x - ROAD_XS[0]) / (ROAD_XS[1] - ROAD_XS[0])), len(ROAD_XS) - 2)
    row = min(int((z - ROAD_ZS[0]) / (ROAD_ZS[1] - ROAD_ZS[0])), len(ROAD_ZS) - 2)
    (x0, x1), (z0, z1) = ROAD_XS[column:column + 2], ROAD_ZS[row:row + 2]
    u, v = (x - x0) / (x1 - x0), (z - z0) / (z1 - z0)
    low, high = road_height(x0, z0), road_height(x1, z1)
    corner = road_height(x1, z0) if u > v else road_height(x0, z1)
    return low + min(u, v) * (high - low) + abs(u - v) * (corner - low)


def overlay(group, material, corners, lift):
    """A patch that lies on the road's triangles; corners: two opposite (x, z)."""
    (x0, z0), (x1, z1) = corners
    xs = [x0] + [x for x in ROAD_XS if x0 < x < x1] + [x1]
    zs = [z0] + [z for z in ROAD_ZS if z1 < z < z0] + [z1]
    sheet(group, material, xs, zs, lambda x, z: road_surface(x, z) + lift)


def paint(group, corners, rng):
    """A stripe of paint 3 mm thick, some years old: along its edges it is ragged, and pieces have come off."""
    (x0, z0), (x1, z1) = corners
    count, bites = round((z0 - z1) / 0.055), [0.0, 0.0]
    zs = {z0 + (z1 - z0) * k / count for k in range(count + 1)} | {z for z in ROAD_ZS if z1 < z < z0}
    zs = sorted(zs, reverse=True)
    inner = [x for x in ROAD_XS if x0 + 0.03 < x < x1 - 0.03] or [x0 + (x1 - x0) * k / 3 for k in (1, 2)]
    ends = [[rng.gauss(0.0, 0.004) for _ in range(len(inner) + 2)] for _ in range(2)]
    rows = []
    for k, z in enumerate(zs):
        for side in range(2):
            bites[side] = rng.uniform(0.006, 0.022) if rng.random() < 0.07 else 0.4 * bites[side]
        xs = [x0 + bites[0] + rng.gauss(0.0, 0.0018)] + inner + [x1 - bites[1] + rng.gauss(0.0, 0.0018)]
        off = ends[0] if k == 0 else ends[1] if k == len(zs) - 1 else [0.0] * len(xs)
        rows.append([(x, road_surface(x, z + d) + 0.003, z + d) for x, d in zip(xs, off)])
    group.surface("asphalt_paint", rows, planar=True)


def make_markings(scene):
    """Repaired trenches with tar-sealed joints, a zebra crossing and a worn centre line."""
    g, rng = Group("marking", TILES), random.Random(23)
    for x0, z0, x1, z1 in ((-2.9, 5.2, -1.7, -9.0), (0.2, -9.4, 3.05, -10.9), (0.4, 4.4, 2.4, 2.9),
                           (1.2, -20, 2.6, -33)):
        overlay(g, "asphalt_patch", ((x0, z0), (x1, z1)), 0.001)
        for x in (x0, x1):
            overlay(g, "asphalt_tar", ((x - 0.022, z0), (x + 0.022, z1)), 0.002)
        for z in (z0, z1):
            overlay(g, "asphalt_tar", ((x0, z + 0.022), (x1, z - 0.022)), 0.002)
    for k in range(6):
        x = -2.75 + k * 1.0
        paint(g, ((x, -11.6), (x + 0.5, -14.6)), rng)
    for z in (16.0, 11.5, 7.0, 2.5, -2.0, -6.5, -19.0, -23.5, -28.0, -32.5, -37.0):
        paint(g, ((-0.06, z), (0.06, z - 2.0)), rng)
    scene.place(g)


def make_kerbs(scene):
    """Bevelled edge stones 1.2 m long with open joints, each a little out of line."""
    rng = random.Random(5)
    g = Group("kerb", TILES)
    count = int((NEAR_Z - FAR_Z) / 1.2)
    for side in (-1, 1):
        for k in range(count):
            g.frame = Frame((side * 3.5, rng.uniform(-0.003, 0.003), NEAR_Z - 1.2 * (k + 0.5)), -90.0 * side)
            out = rng.uniform(-0.004, 0.004)
            # Local +Z is towards the road. Top, bevel and face; the bottom is buried.
            profile = [(-0.15, KERB), (-0.15, -0.05), (out, -0.05), (out, KERB - 0.03), (out - 0.03, KERB)]
            for (z0, y0), (z1, y1) in zip(profile[2:], profile[3:] + profile[:1]):
                g.poly("kerb_stone", [(-0.595, y0, z0), (0.595, y0, z0), (0.595, y1, z1), (-0.595, y1, z1)])
            if k % 2 == 0:
                g.poly("kerb_stone", [(0.595, y, z) for z, y in reversed(profile[1:])])
    g.frame = Frame()
    for side in (-1, 1):
        x0, x1 = sorted((side * 3.512, side * 3.66))
        g.box("soil", (x0, 0.0, FAR_Z), (x1, KERB - 0.008, NEAR_Z), "yzZ")
    scene.place(g)


def wall(group, material, box, openings):
    """A wall at z = 0 between (x0, y0) and (x1, y1), cut by openings (x0, y0, x1, y1), with 0.18 m reveals."""
    x0, y0, x1, y1 = box
    holes = [o for o in openings if o[0] < x1 and o[2] > x0 and o[1] < y1 and o[3] > y0]
    xs = sorted({x0, x1} | {v for o in holes for v in (o[0], o[2]) if x0 < v < x1})
    ys = sorted({y0, y1} | {v for o in holes for v in (o[1], o[3]) if y0 < v < y1})
    for ya, yb in zip(ys, ys[1:]):
        for xa, xb in zip(xs, xs[1:]):
            cx, cy = (xa + xb) / 2, (ya + yb) / 2
            if not any(o[0] < cx < o[2] and o[1] < cy < o[3] for o in holes):
                group.poly(material, [(xa, ya, 0), (xb, ya, 0), (xb, yb, 0), (xa, yb, 0)])
    for a, b, c, d in holes:
        z = -0.22
        group.poly(material, [(a, b, 0), (a, b, z), (a, d, z), (a, d, 0)])
        group.poly(material, [(c, b, z), (c, b, 0), (c, d, 0), (c, d, z)])
        group.poly(material, [(a, d, z), (c, d, z), (c, d, 0), (a, d, 0)])
        group.poly(material, [(a, b, 0), (c, b, 0), (c, b, z), (a, b, z)])


def pane(group, rng, lit, box, z=-0.15):
    """Window glass: one room of the interiors image, the normal a little off true as old panes are."""
    x0, y0, x1, y1 = box
    kind = rng.randrange(4)
    u, v = 0.5 * (kind % 2), 0.5 * (kind // 2)
    u0, u1 = (u + 0.02, u + 0.48) if rng.random() < 0.5 else (u + 0.48, u + 0.02)
    uvs = [(u0, v + 0.49), (u1, v + 0.49), (u1, v + 0.01), (u0, v + 0.01)]
    normal = (rng.gauss(0, 0.012), rng.gauss(0, 0.012), 1.0)
    group.poly("glass_window_lit" if lit else "glass_window", [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)],
               uvs, normal)


CORNICE = [(-0.01, -0.5), (0.05, -0.5), (0.07, -0.4), (0.16, -0.3), (0.2, -0.16), (0.32, -0.12), (0.32, -0.02),
           (-0.01, 0.0)]
STRING = [(-0.01, -0.08), (0.04, -0.08), (0.08, -0.03), (0.08, 0.06), (-0.01, 0.10)]
GROUND_M, STOREY_M, DEPTH_M = 3.7, 3.05, 9.0


class House:
    """One house, built in its own frame: x along the front, y up, z towards the street."""

    def __init__(self, scene, shared, spec, rng):
        self.scene, self.shared, self.spec, self.rng = scene, shared, spec, rng
        self.g = Group(spec["name"], TILES)
        side, z0, z1 = spec["side"], spec["z"][0], spec["z"][1]
        self.width = abs(z0 - z1)
        if side == "left":
            self.yaw, self.origin = 90.0, (-HALF_STREET, 0.0, max(z0, z1))
        elif side == "right":
            self.yaw, self.origin = -90.0, (HALF_STREET, 0.0, min(z0, z1))
        else:
            self.yaw, self.origin = 0.0, (min(z0, z1), 0.0, END_Z)
        self.g.frame = Frame(self.origin, self.yaw)
        self.eaves = GROUND_M + STOREY_M * spec["floors"] + 0.55
        self.openings = []

    def put(self, part, x, y, z=0.0, yaw=0.0):
        self.scene.place(part, self.g.frame.point((x, y, z)), self.yaw + yaw)

    def build(self):
        self.upper_windows()
        self.ground_floor()
        spec, g = self.spec, self.g
        wall(g, spec["wall"], (0, GROUND_M, self.width, self.eaves), self.openings)
        wall(g, spec.get("base", spec["wall"]), (0, 0.1, self.width, GROUND_M), self.openings)
        g.extrude("stone_trim", [(z, y + GROUND_M) for z, y in STRING], 0, self.width)
        g.extrude("stone_trim", [(z, y + self.eaves) for z, y in CORNICE], 0, self.width)
        self.plinth()
        self.shell()
        self.roof()
        self.gutter()
        self.scene.place(g)

    def bays(self):
        n = self.spec["bays"]
        return [self.width * (k + 0.5) / n for k in range(n)]

    def is_lit(self, floor, bay):
        return (floor, bay) in self.spec.get("lit", ())

    def upper_windows(self):
        kind = self.spec["window"]
        w, h = {"casement": (1.1, 1.75), "sash": (1.0, 1.7)}[kind]
        for floor in range(1, self.spec["floors"] + 1):
            for bay, x in enumerate(self.bays()):
                y = GROUND_M + STOREY_M * (floor - 1) + 0.78
                if (floor, bay) in self.spec.get("balconies", ()):
                    self.french_window(x, y - 0.72, self.is_lit(floor, bay))
                    continue
                self.openings.append((x - w / 2, y, x + w / 2, y + h))
                self.put(self.shared[kind], x, y)
                pane(self.g, self.rng, self.is_lit(floor, bay), (x - w / 2, y, x + w / 2, y + h))
                if self.spec.get("shutters"):
                    self.put(self.shared["shutters"], x, y)
                if (floor, bay) in self.spec.get("flowers", ()):
                    self.put(self.shared["flower_box"], x, y + 0.0, 0.12)

    def french_window(self, x, y, lit):
        self.openings.append((x - 0.6, y, x + 0.6, y + 2.4))
        self.put(self.shared["french"], x, y)
        self.put(self.shared["balcony"], x, y)
        pane(self.g, self.rng, lit, (x - 0.6, y + 0.5, x + 0.6, y + 2.4))

    def ground_floor(self):
        taken = []
        if "door" in self.spec:
            x = self.bays()[self.spec["door"]]
            self.openings.append((x - 0.6, 0.36, x + 0.6, 2.86))
            self.put(self.shared[self.spec.get("door_part", "door_green")], x, 0.36)
            pane(self.g, self.rng, True, (x - 0.6, 2.42, x + 0.6, 2.86), -0.19)
            taken.append(x)
        if "shop" in self.spec:
            self.shop(*self.spec["shop"])
            taken += [x for x in self.bays() if self.spec["shop"][0] - 0.6 < x < self.spec["shop"][1] + 0.6]
        for bay, x in enumerate(self.bays()):
            if x in taken:
                continue
            w, h = {"casement": (1.1, 1.75), "sash": (1.0, 1.7)}[self.spec["window"]]
            self.openings.append((x - w / 2, 1.12, x + w / 2, 1.12 + h))
            self.put(self.shared[self.spec["window"]], x, 1.12)
            pane(self.g, self.rng, self.is_lit(0, bay), (x - w / 2, 1.12, x + w / 2, 1.12 + h))

    def shop(self, x0, x1):
        """A painted wooden shop front: two display windows beside a glazed door, pilasters, a fascia board."""
        g, paint, z = self.g, self.spec.get("paint", "wood_blue"), -0.12
        self.openings.append((x0, 0.14, x1, 3.2))
        middle = (x0 + x1) / 2
        windows = [(x0 + 0.12, middle - 0.55), (middle + 0.55, x1 - 0.12)]
        for k, (a, b) in enumerate(windows):
            u = 0.0 if k == 0 else 0.5
            g.poly("glass_shop_lit", [(a, 0.75, z), (b, 0.75, z), (b, 2.75, z), (a, 2.75, z)],
                   [(u, 1), (u + 0.5, 1), (u + 0.5, 0), (u, 0)])
            g.box(paint, (a, 0.14, -0.2), (b, 0.75, 0.02), "zyxX")
            g.box(paint, (a - 0.02, 0.70, -0.2), (b + 0.02, 0.78, 0.07), "z")
            count = max(2, int((b - a) / 0.6))
            for i in range(count):
                pa, pb = a + (b - a) * i / count + 0.07, a + (b - a) * (i + 1) / count - 0.07
                g.box(paint, (pa, 0.24, 0.02), (pb, 0.62, 0.035), "z")
            g.box(paint, ((a + b) / 2 - 0.03, 0.78, z), ((a + b) / 2 + 0.03, 2.75, z + 0.05), "zyY")
            g.box(paint, (a, 2.25, z), (b, 2.30, z + 0.045), "zxX")
        g.box(paint, (x0, 2.75, -0.2), (x1, 3.25, 0.06), "z")
        g.extrude(paint, [(0, 3.25), (0.10, 3.25), (0.2, 3.35), (0.2, 3.4), (0, 3.46)], x0 - 0.12, x1 + 0.12)
        g.box("wood_white", (x0 + 0.5, 2.9, 0.06), (x1 - 0.5, 2.92, 0.066), "z")
        g.box("wood_white", (x0 + 0.5, 3.13, 0.06), (x1 - 0.5, 3.15, 0.066), "z")
        for x in (x0, middle - 0.55, middle + 0.43, x1 - 0.12):
            g.box(paint, (x, 0.14, -0.2), (x + 0.12, 2.75, 0.045), "zyY")
        g.box(paint, (middle - 0.43, 0.14, -0.2), (middle + 0.43, 0.95, z), "zxX")
        g.poly("glass_window_lit", [(middle - 0.43, 0.95, z - 0.02), (middle + 0.43, 0.95, z - 0.02),
                                    (middle + 0.43, 2.75, z - 0.02), (middle - 0.43, 2.75, z - 0.02)],
               [(0.12, 0.45), (0.38, 0.45), (0.38, 0.02), (0.12, 0.02)])
        for a, b in ((-0.43, -0.34), (0.34, 0.43)):
            g.box(paint, (middle + a, 0.95, -0.2), (middle + b, 2.75, z + 0.03), "zyY")
        g.box("brass", (middle + 0.36, 1.05, z + 0.03), (middle + 0.39, 1.4, z + 0.06))
        g.box("stone_trim", (middle - 0.5, 0.1, -0.2), (middle + 0.5, 0.24, 0.1), "zy")

    def plinth(self):
        """A stone base between the doors and shop front."""
        gaps = sorted((o[0] - 0.24, o[2] + 0.24) for o in self.openings if o[1] < 0.7)
        x = 0.0
        for a, b in gaps + [(self.width, self.width)]:
            if a - x > 0.05:
                self.g.extrude("stone_trim", [(-0.01, 0.1), (0.05, 0.1), (0.05, 0.66), (0.02, 0.7), (-0.01, 0.71)], x,
                               a)
            x = b

    def shell(self):
        """Party walls, back, and the boards that close the eaves; plain, since only their outline is ever seen."""
        g, w, e, d = self.g, self.width, self.eaves, -DEPTH_M
        side = self.spec.get("side_wall", "plaster_grey")
        ridge = e + self.spec["rise"]
        g.poly(side, [(0, 0, d), (0, 0, 0), (0, e, 0), (0, ridge, d / 2), (0, e, d)])
        g.poly(side, [(w, 0, 0), (w, 0, d), (w, e, d), (w, ridge, d / 2), (w, e, 0)])
        g.poly(side, [(w, 0, d), (0, 0, d), (0, e, d), (w, e, d)])

    def roof(self):
        spec, g, w, e = self.spec, self.g, self.width, self.eaves
        half, rise, tile = DEPTH_M / 2, spec["rise"], spec.get("roof", "tile_roof")
        slope = rise / half
        length = math.hypot(half + 0.42, slope * (half + 0.42))
        size = TILES[tile]
        for sign in (1, -1):
            z_ridge, z_low = -half, (0.42 if sign > 0 else -DEPTH_M - 0.42)
            y_low, y_top = e - slope * 0.42 + 0.16, e + rise + 0.16
            a, b = (0.0, w) if sign > 0 else (w, 0.0)
            uvs = [(a / size, length / size), (b / size, length / size), (b / size, 0), (a / size, 0)]
            g.poly(tile, [(a, y_low, z_low), (b, y_low, z_low), (b, y_top, z_ridge), (a, y_top, z_ridge)], uvs)
            g.poly("wood_brown", [(a, y_low - 0.08, z_low), (b, y_low - 0.08, z_low), (b, y_low, z_low),
                                  (a, y_low, z_low)])
            g.poly("wood_brown", [(b, y_low - 0.08, z_low), (a, y_low - 0.08, z_low), (a, y_top - 0.2, z_ridge),
                                  (b, y_top - 0.2, z_ridge)])
        for x, flip in ((0.0, False), (w, True)):
            edge = [(x, e - slope * 0.42 + 0.16, 0.42), (x, e + rise + 0.16, -half), (x, e + rise - 0.04, -half),
                    (x, e - slope * 0.42 - 0.04, 0.42)]
            g.poly("wood_brown", edge[::-1] if flip else edge)
        ridge_y = e + rise + 0.13
        rows = [[(x, ridge_y + 0.09 * math.cos(t), -half + 0.13 * math.sin(t)) for x in (0.0, w)]
                for t in (1.5, 0.75, 0.0, -0.75, -1.5)]
        g.surface(tile, rows)
        for x in spec.get("chimneys", ()):
            self.chimney(x, e + rise)
        for x in spec.get("dormers", ()):
            self.dormer(x, slope)

    def chimney(self, x, ridge):
        g = self.g
        g.box("brick_brown", (x - 0.6, ridge - 1.2, -DEPTH_M / 2 - 0.3), (x + 0.6, ridge + 1.2, -DEPTH_M / 2 + 0.3),
              "y")
        g.box("stone_trim", (x - 0.66, ridge + 1.2, -DEPTH_M / 2 - 0.36), (x + 0.66, ridge + 1.3, -DEPTH_M / 2 + 0.36))
        for dx in (-0.36, 0.0, 0.36):
            g.lathe("tile_roof", [(0.12, 1.3), (0.10, 1.75), (0.13, 1.78), (0.13, 1.84), (0.0, 1.84)], 8,
                    (x + dx, ridge, -DEPTH_M / 2))

    def dormer(self, x, slope):
        """A gabled dormer 1.5 m wide standing on the front slope."""
        g, z = self.g, -0.75
        y = self.eaves - slope * z + 0.05
        tile = self.spec.get("roof", "tile_roof")
        g.poly("wood_white", [(x - 0.75, y, z), (x + 0.75, y, z), (x + 0.75, y + 1.4, z), (x, y + 2.0, z),
                              (x - 0.75, y + 1.4, z)])
        pane(g, self.rng, False, (x - 0.42, y + 0.25, x + 0.42, y + 1.35), z + 0.02)
        for dx in (-0.45, -0.02, 0.41):
            g.box("wood_white", (x + dx, y + 0.2, z), (x + dx + 0.05, y + 1.4, z + 0.05), "z")
        back = (y + 2.0 - self.eaves) / -slope
        for sign in (-1, 1):
            cheek = [(x + sign * 0.75, y, z), (x + sign * 0.75, y + 1.4, z),
                     (x + sign * 0.75, y + 1.4, z - 1.4 / slope)]
            g.poly(tile, cheek if sign < 0 else cheek[::-1])
            plane = [(x + sign * 0.92, y + 1.27, z + 0.15), (x, y + 2.06, z + 0.15), (x, y + 2.06, back - 0.2),
                     (x + sign * 0.92, y + 1.27, back - 0.2)]
            g.poly(tile, plane if sign > 0 else plane[::-1])
            g.poly("wood_white", [(p[0], p[1] - 0.05, p[2]) for p in (plane[::-1] if sign > 0 else plane)])

    def gutter(self):
        """A half-round zinc gutter under the eaves and a downpipe at the end that the specification names."""
        g, w = self.g, self.width
        slope = self.spec["rise"] / (DEPTH_M / 2)
        y, z = self.eaves - slope * 0.42 + 0.10, 0.47
        rows = [[(x, y - 0.075 * math.sin(t), z - 0.075 * math.cos(t)) for x in (0.0, w)]
                for t in span(math.pi, 0.0, 6)]
        g.surface("steel_zinc", rows[::-1])
        x = w - 0.22 if self.spec.get("pipe", "end") == "end" else 0.22
        g.tube("steel_zinc", [(x, y - 0.05, z), (x, y - 0.22, z), (x, y - 0.75, 0.12), (x, y - 1.0, 0.10),
                              (x, 0.42, 0.10),
                              (x, 0.3, 0.13), (x, 0.22, 0.24)], 0.05, 7)
        for k in range(int(self.eaves / 2.4)):
            g.box("steel_zinc", (x - 0.065, 1.2 + 2.4 * k, 0.0), (x + 0.065, 1.25 + 2.4 * k, 0.16), "z")


HOUSES = [
    {"name": "house_l0", "side": "left", "z": (20, 6), "wall": "plaster_grey", "floors": 2, "bays": 5, "rise": 3.2,
     "window": "casement", "door": 1, "lit": {(1, 3)}, "chimneys": (2.0,)},
    {"name": "house_l1", "side": "left", "z": (6, -2.5), "wall": "plaster_ochre", "floors": 2, "bays": 3, "rise": 3.6,
     "window": "casement", "shutters": True, "door": 2, "lit": {(1, 2), (0, 0)}, "flowers": {(1, 1), (1, 2), (0, 1)},
     "dormers": (2.2, 6.2), "chimneys": (7.4,), "pipe": "start"},
    {"name": "house_l2", "side": "left", "z": (-2.5, -12.5), "wall": "brick_red", "floors": 3, "bays": 4, "rise": 3.4,
     "window": "sash", "shop": (0.9, 7.1), "door": 3, "door_part": "door_blue", "lit": {(1, 1), (2, 3), (1, 2)},
     "roof": "tile_slate", "chimneys": (0.9, 9.1)},
    {"name": "house_l3", "side": "left", "z": (-12.5, -22), "wall": "plaster_cream", "floors": 2, "bays": 3,
     "rise": 4.0,
     "window": "casement", "door": 0, "lit": {(2, 0), (1, 0)}, "dormers": (2.5, 7.0), "base": "stone_blocks"},
    {"name": "house_l4", "side": "left", "z": (-22, -33), "wall": "brick_brown", "floors": 3, "bays": 4, "rise": 3.6,
     "window": "sash", "door": 1, "lit": {(1, 0), (3, 2), (0, 2)}, "chimneys": (3.0, 9.0)},
    {"name": "house_l5", "side": "left", "z": (-33, -45), "wall": "plaster_rose", "floors": 2, "bays": 5, "rise": 4.0,
     "window": "casement", "door": 2, "lit": {(1, 1), (1, 4)}, "chimneys": (2.0,)},
    {"name": "house_r0", "side": "right", "z": (20, 3.5), "wall": "brick_brown", "floors": 2, "bays": 6, "rise": 3.4,
     "window": "sash", "door": 1, "lit": {(0, 4), (1, 2)}, "chimneys": (4.0,)},
    {"name": "house_r1", "side": "right", "z": (3.5, -8.0), "wall": "plaster_cream", "floors": 3, "bays": 4,
     "rise": 3.4,
     "window": "casement", "balconies": {(1, 1), (2, 1), (1, 2)}, "shop": (0.7, 5.1), "paint": "wood_green", "door": 3,
     "lit": {(1, 1), (2, 2), (1, 3)}, "flowers": {(1, 0)}, "base": "stone_blocks", "chimneys": (1.2, 10.2),
     "roof": "tile_slate"},
    {"name": "house_r2", "side": "right", "z": (-8.0, -15.5), "wall": "brick_red", "floors": 2, "bays": 3, "rise": 3.8,
     "window": "sash", "door": 1, "lit": {(0, 2), (2, 0)}, "dormers": (2.0, 5.5), "door_part": "door_blue"},
    {"name": "house_r3", "side": "right", "z": (-15.5, -25), "wall": "plaster_rose", "floors": 3, "bays": 3,
     "rise": 3.4,
     "window": "casement", "shutters": True, "door": 2, "lit": {(1, 2), (2, 1)}, "chimneys": (1.2,),
     "base": "stone_blocks"},
    {"name": "house_r4", "side": "right", "z": (-25, -36), "wall": "plaster_grey", "floors": 2, "bays": 4, "rise": 4.2,
     "window": "casement", "door": 0, "lit": {(1, 3), (0, 1)}, "chimneys": (8.0,)},
    {"name": "house_r5", "side": "right", "z": (-36, -45), "wall": "brick_brown", "floors": 3, "bays": 3, "rise": 3.6,
     "window": "sash", "door": 1, "lit": {(1, 0)}, "chimneys": (2.0, 7.0)},
    {"name": "house_e1", "side": "end", "z": (-30, -19), "wall": "plaster_cream", "floors": 2, "bays": 4, "rise": 4.0,
     "window": "casement", "door": 1},
    {"name": "house_e2", "side": "end", "z": (-19, -8.5), "wall": "brick_brown", "floors": 2, "bays": 4, "rise": 3.6,
     "window": "sash", "door": 2, "lit": {(1, 2)}, "chimneys": (9.0,)},
    {"name": "house_e3", "side": "end", "z": (6.5, 16), "wall": "plaster_rose", "floors": 3, "bays": 4, "rise": 3.6,
     "window": "casement", "door": 1, "lit": {(1, 0)}, "chimneys": (1.5,)},
    {"name": "house_e4", "side": "end", "z": (16, 28), "wall": "plaster_grey", "floors": 2, "bays": 4, "rise": 4.0,
     "window": "casement", "door": 2},
]


def make_houses(scene):
    shared = {"casement": parts.window_casement(TILES), "sash": parts.window_sash(TILES),
              "french": parts.window_french(TILES), "shutters": parts.shutters(TILES), "balcony": parts.balcony(TILES),
              "door_green": parts.door(TILES, "wood_green"), "door_blue": parts.door(TILES, "wood_blue"),
              "flower_box": parts.flower_box(TILES, 9)}
    for k, spec in enumerate(HOUSES):
        House(scene, shared, spec, random.Random(100 + k)).build()


def arch_height(x):
    """Underside of the footbridge: a segmental arch, 4.5 m in the middle, 2.9 m at x = +-5.2."""
    half, crown, spring = 5.2, 4.5, 2.9
    rise = crown - spring
    radius = (half * half + rise * rise) / (2 * rise)
    return crown - radius + math.sqrt(radius * radius - min(half, abs(x)) ** 2)


def make_bridge(scene):
    """A stone footbridge over the street at z = -16.2 to -19.8, on piers against the houses."""
    g = Group("bridge", TILES)
    z0, z1, deck = -19.8, -16.2, 5.15
    xs = span(-5.2, 5.2, 20)
    g.surface("stone_blocks", [[(x, arch_height(x), z) for x in reversed(xs)] for z in (z0, z1)], planar=True)
    for xa, xb in zip(xs, xs[1:]):
        ya, yb = arch_height(xa), arch_height(xb)
        g.poly("stone_blocks", [(xa, ya, z1), (xb, yb, z1), (xb, deck, z1), (xa, deck, z1)])
        g.poly("stone_blocks", [(xb, yb, z0), (xa, ya, z0), (xa, deck, z0), (xb, deck, z0)])
    for x0, x1 in ((-6.0, -5.2), (5.2, 6.0)):
        g.box("stone_blocks", (x0, 0.1, z0), (x1, deck, z1), "yY")
        g.box("stone_trim", (x0 - 0.06, 2.75, z0 - 0.06), (x1 + 0.06, 2.92, z1 + 0.06))
        g.box("stone_trim", (x0 - 0.06, 0.1, z0 - 0.06), (x1 + 0.06, 0.75, z1 + 0.06), "y")
    g.box("concrete_slabs", (-6.0, deck - 0.02, z0 + 0.28), (6.0, deck + 0.05, z1 - 0.28), "yxXzZ")
    voussoirs(g, z0, z1)
    for z, out in ((z1, 1), (z0, -1)):
        parapet(g, z, out, deck)
    scene.place(g)
    scene.place(parts.hanging_lantern(TILES), (0.0, arch_height(0.0), -18.0))


def voussoirs(g, z0, z1):
    """The ring of wedge stones round the arch, standing 4 to 6 cm proud of the wall, with a keystone."""
    count = 23
    for k in range(count):
        xa, xb = (-5.2 + 10.4 * (k + t) / count for t in (0.02, 0.98))
        key = k == count // 2
        depth, proud = (0.62, 0.11) if key else (0.46, 0.04 + 0.015 * (k % 2))
        low = [(x, arch_height(x) - (0.03 if key else 0.004)) for x in (xa, xb)]
        high = [(x * (1.0 + depth / 9.5), y + depth) for x, y in low]
        for z, s in ((z1, 1), (z0, -1)):
            front = [(*low[0], z + s * proud), (*low[1], z + s * proud), (*high[1], z + s * proud),
                     (*high[0], z + s * proud)]
            back = [(p[0], p[1], z) for p in front]
            g.poly("stone_trim", front if s > 0 else front[::-1])
            for i in range(4):
                j = (i + 1) % 4
                quad = [back[i], back[j], front[j], front[i]]
                g.poly("stone_trim", quad if s > 0 else quad[::-1])


def parapet(g, z, out, deck):
    """A balustrade: base course, turned balusters between dies, coping; out is +1 or -1 along Z."""
    inner = z - out * 0.28
    lo, hi = sorted((z + out * 0.08, inner))
    g.box("stone_trim", (-6.0, deck - 0.16, lo), (6.0, deck + 0.14, hi), "xX")
    g.box("stone_trim", (-6.0, deck + 0.84, lo - 0.02), (6.0, deck + 0.98, hi + 0.02), "xX")
    dies = [-5.7, -2.9, 0.0, 2.9, 5.7]
    for x in dies:
        g.box("stone_trim", (x - 0.24, deck + 0.14, lo + 0.02), (x + 0.24, deck + 0.84, hi - 0.02), "yY")
    for a, b in zip(dies, dies[1:]):
        count = 8
        for k in range(count):
            x = a + 0.24 + (b - a - 0.48) * (k + 0.5) / count
            g.lathe("stone_trim", [(0.075, 0.0), (0.05, 0.05), (0.1, 0.22), (0.09, 0.32), (0.05, 0.52), (0.08, 0.7)], 6,
                    (x, deck + 0.14, (lo + hi) / 2))


def make_church(scene):
    """The silhouette that closes the street: a nave with its gable to the square, and a tower with a slate spire."""
    g = Group("church", TILES)
    front, back = END_Z - 0.5, END_Z - 24.0
    nave = [(-7.0, 0), (5.5, 0), (5.5, 8.5), (-0.75, 15.0), (-7.0, 8.5)]
    g.poly("stone_blocks", [(x, y, front) for x, y in nave])
    for x, out in ((-7.0, -1), (5.5, 1)):
        side = [(x, 0, back), (x, 0, front), (x, 8.5, front), (x, 8.5, back)]
        g.poly("stone_blocks", side if out < 0 else side[::-1])
        roof = [(x + out * 0.5, 8.1, front + 0.35), (x + out * 0.5, 8.1, back), (-0.75, 15.15, back),
                (-0.75, 15.15, front + 0.35)]
        g.poly("tile_slate", roof if out > 0 else roof[::-1])
    g.lathe("glass_window_lit", [(1.5, 0.0), (0.0, 0.001)], 16)
    g.meshes.pop("glass_window_lit")
    rose_window(g, (-0.75, 9.4, front))
    tower_x, half, top = -4.6, 2.5, 20.0
    lo, hi = (tower_x - half, 0, front - 2 * half + 0.9), (tower_x + half, top, front + 0.9)
    g.box("stone_blocks", lo, hi, "yY")
    for y in (6.5, 13.0, top):
        g.box("stone_trim", (lo[0] - 0.15, y - 0.2, lo[2] - 0.15), (hi[0] + 0.15, y + 0.2, hi[2] + 0.15))
    for dx in (-0.9, 0.9):
        bell_opening(g, tower_x + dx, 14.6, hi[2] + 0.01)
    centre = (tower_x, top + 0.2, (lo[2] + hi[2]) / 2)
    r = math.sqrt(2.0)
    for k in range(8):
        a, b = (math.radians(45.0 * (k + t) + 22.5) for t in (0, 1))
        ring = 2.55
        p = [(centre[0] + ring * math.cos(t), centre[1], centre[2] + ring * math.sin(t)) for t in (b, a)]
        g.poly("tile_slate", [p[0], p[1], (centre[0], centre[1] + 12.5, centre[2])])
    for dx in (-1, 1):
        for dz in (-1, 1):
            g.lathe("stone_trim", [(0.4 * r, 0), (0.4 * r, 1.2), (0.0, 3.0)], 4,
                    (centre[0] + dx * (half - 0.35), centre[1], centre[2] + dz * (half - 0.35)), 45)
    g.tube("steel_black", [(centre[0], centre[1] + 12.2, centre[2]), (centre[0], centre[1] + 14.2, centre[2])], 0.05, 5)
    g.box("steel_black", (centre[0] - 0.45, centre[1] + 13.4, centre[2] - 0.05),
          (centre[0] + 0.45, centre[1] + 13.5, centre[2] + 0.05))
    scene.place(g)


def make_close(scene):
    """What one sees between the church and its neighbours: no sky shows beside it under the bridge."""
    front, depth, eaves, ridge = END_Z - 5.0, 8.0, 6.8, 12.4
    back, middle = front - depth, front - depth / 2
    for name, wall, x0, x1 in (("parish", "plaster_cream", -19.0, -6.9), ("school", "brick_brown", 5.4, 18.0)):
        g = Group(name, TILES)
        g.box(wall, (x0, 0, back), (x1, eaves, front), "yY")
        for x, out in ((x0, -1), (x1, 1)):
            gable = [(x, eaves, front), (x, eaves, back), (x, ridge, middle)]
            g.poly(wall, gable if out > 0 else gable[::-1])
        low = eaves - 0.3
        for z, sign in ((front + 0.4, 1), (back - 0.4, -1)):
            a, b = (x0 - 0.3, x1 + 0.3) if sign > 0 else (x1 + 0.3, x0 - 0.3)
            g.poly("tile_slate", [(a, low, z), (b, low, z), (b, ridge + 0.1, middle), (a, ridge + 0.1, middle)])
        scene.place(g)


def rose_window(g, centre):
    """A round window and a pointed portal, both lit from inside."""
    x, y, z = centre
    ring = [(x + 1.5 * math.cos(k * math.pi / 8), y + 1.5 * math.sin(k * math.pi / 8), z + 0.02) for k in range(16)]
    g.poly("glass_window_lit", ring, [(0.6 + 0.01 * k, 0.2) for k in range(16)])
    for k in range(8):
        a = k * math.pi / 4
        g.tube("stone_trim", [(x, y, z + 0.04), (x + 1.5 * math.cos(a), y + 1.5 * math.sin(a), z + 0.04)], 0.08, 5)
    g.tube("stone_trim", [(x + 1.55 * math.cos(k * math.pi / 8), y + 1.55 * math.sin(k * math.pi / 8), z + 0.04)
                          for k in range(17)], 0.16, 6)
    arch = [(-1.1, 0.0), (1.1, 0.0), (1.1, 2.6), (0.75, 3.5), (0.0, 4.3), (-0.75, 3.5), (-1.1, 2.6)]
    g.poly("wood_brown", [(x + 1.6 + a, b, z + 0.03) for a, b in arch])
    g.tube("stone_trim", [(x + 1.6 + a * 1.08, b * 1.04, z + 0.05) for a, b in arch[1:] + arch[:1]], 0.17, 6)


def bell_opening(g, x, y, z):
    arch = [(-0.5, 0), (0.5, 0), (0.5, 2.6), (0.3, 3.15), (0, 3.5), (-0.3, 3.15), (-0.5, 2.6)]
    g.poly("steel_pit", [(x + a, y + b, z) for a, b in arch])
    for k in range(5):
        g.box("wood_brown", (x - 0.5, y + 0.2 + 0.5 * k, z), (x + 0.5, y + 0.3 + 0.5 * k, z + 0.12), "z")


def make_awning(scene):
    """A striped awning over the shop, sagging between its ribs, with a valance and steel arms."""
    g = Group("awning", TILES)
    g.frame = Frame((-HALF_STREET, 0.0, -3.2), 90.0)
    width, reach, top, low = 6.6, 1.85, 3.42, 2.62
    bays, cells = 3, 4
    xs = span(0.0, width, bays * cells)

    def point(x, t):
        sag = 0.05 * math.sin(math.pi * t) * (0.35 + 0.65 * math.sin(math.pi * (x * bays / width % 1.0)))
        return (x, top + (low - top) * t - sag, 0.06 + reach * t)

    rows = [[point(x, t) for x in xs] for t in (1.0, 0.75, 0.5, 0.25, 0.0)]
    g.surface("fabric_awning", rows, uv_box=(0.0, 1.7, width / 1.2, 0.0))
    valance = []
    for drop in (1.0, 0.0):
        row = []
        for k in range(67):
            x, sway = width * k / 66, 0.02 * math.sin(k * 0.7)
            scallop = 0.20 + 0.06 * abs(math.sin(math.pi * x / 0.6))
            row.append((x, low - 0.01 - drop * scallop, 0.06 + reach + 0.005 + drop * sway))
        valance.append(row)
    g.surface("fabric_awning", valance, uv_box=(0.0, 0.25, width / 1.2, 0.0))
    for x, flip in ((0.0, False), (width, True)):
        side = [(x, low - 0.02, 0.06), (x, low - 0.02, 0.06 + reach), (x, top, 0.06)]
        g.poly("fabric_awning", side if not flip else side[::-1], [(0.08, 1), (0.08, 0.0), (0.08, 0.5)])
    g.tube("steel_black", [(0.0, low - 0.02, 0.04 + reach), (width, low - 0.02, 0.04 + reach)], 0.018, 6)
    g.tube("steel_black", [(0.0, top - 0.03, 0.09), (width, top - 0.03, 0.09)], 0.03, 6)
    for x in (0.04, width / 3, width * 2 / 3, width - 0.04):
        g.tube("steel_black", [(x, 2.5, 0.05), (x, 2.5, 0.10), (x, low - 0.03, 0.04 + reach)], 0.014, 5)
        g.tube("steel_black", [point(x, t)[:1] + (point(x, t)[1] - 0.035,) + point(x, t)[2:] for t in (0.0, 0.5, 1.0)],
               0.012, 5)
    scene.place(g)


def make_market(scene):
    """What keeps dry under the awning: crates on trestles and the ground, a bench."""
    crates = {"apple": parts.crate(TILES, "apple", 1), "orange": parts.crate(TILES, "orange", 2),
              "pear": parts.crate(TILES, "pear", 3), "empty": parts.crate(TILES, None, 4)}
    y = pavement_height(-5.2)
    for k, kind in enumerate(("apple", "pear", "orange", "apple")):
        z = -3.95 - k * 0.62
        scene.place(crates[kind], (-5.35, y + 0.62, z), 90.0 + (k % 2) * 4.0)
        scene.place(crates["empty"], (-5.36, y + 0.31, z + 0.01), 90.0 - (k % 3) * 2.0)
        scene.place(crates["empty"], (-5.35, y, z - 0.01), 91.0)
    for k, kind in enumerate(("orange", "pear", "apple")):
        scene.place(crates[kind], (-4.9, y, -4.1 - k * 0.66), 86.0 + 5.0 * k)
    scene.place(crates["empty"], (-5.0, y, -9.55), 20.0)
    scene.place(crates["empty"], (-5.02, y + 0.3, -9.53), 52.0)
    scene.place(parts.bench(TILES), (-5.72, y, -8.3), 90.0)


def make_trees(scene):
    clumps = [parts.leaf_clump(TILES, 1), parts.leaf_clump(TILES, 2)]
    rng = random.Random(8)
    pit = parts.tree_pit(TILES)
    for x, z, seed, scale in ((4.55, -4.6, 1, 1.0), (-4.5, -14.6, 2, 0.9), (4.5, -23.6, 3, 1.1)):
        trunk, places = parts.tree_trunk(TILES, seed)
        trunk.name += "_%d" % seed
        base = (x, pavement_height(x), z)
        scene.place(trunk, base, scale=scale)
        scene.place(pit, base)
        for k, p in enumerate(places):
            q = [rng.gauss(0, 1) for _ in range(4)]
            length = math.sqrt(sum(c * c for c in q))
            q = [round(c / length, 5) for c in q]
            scene.place(clumps[k % 2], tuple(base[i] + scale * p[i] for i in range(3)), quaternion=q,
                        scale=scale * rng.uniform(0.7, 1.05))


def make_furniture(scene):
    lamp, bollard, grate = parts.street_lamp(TILES), parts.bollard(TILES), parts.drain_grate(TILES)
    for x, z in LAMPS:
        scene.place(lamp, (x, pavement_height(x), z), 0.0)
    for z in (-10.9, -12.3, -13.9, -15.3):
        scene.place(bollard, (-3.9, pavement_height(3.9), z))
    for z in (-10.9, -12.3, -14.5, -15.3):
        scene.place(bollard, (3.9, pavement_height(3.9), z))
    for side in (-1, 1):
        for z in GRATES:
            scene.place(grate, (side * 3.28, road_height(3.28, z) + 0.004, z))
    cover = parts.manhole(TILES)
    for x, z in ((-0.9, 0.4), (0.7, -17.2), (-1.2, -26.0)):
        scene.place(cover, (x, road_height(x, z) + 0.004, z))
    bin_group = parts.litter_bin(TILES)
    scene.place(bin_group, (4.0, pavement_height(4.0), -0.6))
    scene.place(bin_group, (-4.0, pavement_height(4.0), -10.2))
    scene.place(parts.car(TILES), (2.38, road_height(2.38, -8.0) - 0.01, -7.6), 1.0)
    g = Group("van_far", TILES)
    del g
    scene.place(parts.bench(TILES), (5.72, pavement_height(5.7), -11.4), -90.0)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    scene = Scene(MATERIALS, street_textures.all_images())
    for make in (make_ground, make_markings, make_kerbs, make_houses, make_bridge, make_church, make_close, make_awning,
                 make_market, make_trees, make_furniture):
        make(scene)
    path = os.path.join(here, "scenes", "street.glb")
    scene.write(path)
    print("%s: %d triangles, %d nodes, %d bytes" % (os.path.relpath(path), scene.triangles(), len(scene.placements),
                                                    os.path.getsize(path)))


if __name__ == "__main__":
    main()

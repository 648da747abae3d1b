#!/usr/bin/env python3
"""Writes scenes/car.glb: the car of tools/drive, a red hatchback 4.1 m long with a cabin. Python 3 standard library
only.

Metres, Y up, its front at -Z, wheels on y = 0, as tools/drive/car.h has it. The windshield leaves room for the pane of
car.h (PANE); change both together. The game recognises parts by prefixes of their material names: cabin_ is seen from
inside and gets little sky, glass_side is not drawn from inside, wheel_ is one wheel about the origin, and rain_ is
never drawn: it keeps rain off. The same source always gives the same bytes.

The body is one loft of cross-sections along Z, like the parked car of street_parts.py, but finer, with curved ends and
the glass on the pane's own surface. Half sections run from the sill up over belt and roof rail to the middle.
"""
import math
import os

from gltf_writer import Group, Scene, unit
from street_textures import png

# CAR_GLASS_* and car_windshield_m of tools/drive: lower middle (y, z), size, rake and radius of the bend; and half the
# width that its mask leaves at the top.
PANE = {"y": 0.86, "z": -1.2, "width": 1.45, "height": 0.95, "rake": math.radians(55.0), "bend": 4.0, "top": 0.615}

MATERIALS = [
    {"name": "paint", "colour": (0.40, 0.008, 0.018), "rough": 0.14, "metal": 0.5},
    {"name": "trim", "colour": (0.012, 0.012, 0.013), "rough": 0.35},
    {"name": "plastic", "colour": (0.022, 0.022, 0.023), "rough": 0.62},
    {"name": "pit", "colour": (0.004, 0.004, 0.004), "rough": 1.0},
    {"name": "chrome", "colour": (0.55, 0.56, 0.57), "rough": 0.18, "metal": 1.0},
    {"name": "mirror", "colour": (0.62, 0.66, 0.70), "rough": 0.25, "metal": 0.9},
    {"name": "plate", "colour": (0.70, 0.70, 0.66), "rough": 0.5, "emit": (0.1, 0.095, 0.085)},
    {"name": "letters", "colour": (0.02, 0.02, 0.025), "rough": 0.5},
    {"name": "lamp_red", "colour": (0.20, 0.004, 0.004), "rough": 0.08, "emit": (0.05, 0.001, 0.0006)},
    {"name": "reflector", "colour": (0.30, 0.008, 0.006), "rough": 0.15},
    {"name": "lamp_red_lit", "colour": (0.3, 0.01, 0.01), "rough": 0.2, "emit": (1, 0.0495, 0.0275)},
    {"name": "lamp_clear", "colour": (0.10, 0.10, 0.11), "rough": 0.06, "metal": 0.3},
    {"name": "lamp_head_lit", "colour": (0.5, 0.5, 0.5), "rough": 0.2, "emit": (1.0, 0.89, 0.72), "strength": 9.0},
    {"name": "wheel_tyre", "colour": (0.026, 0.026, 0.027), "rough": 0.75},
    {"name": "wheel_rim", "colour": (0.50, 0.51, 0.52), "rough": 0.28, "metal": 0.9},
    {"name": "wheel_dark", "colour": (0.010, 0.010, 0.011), "rough": 0.6},
    {"name": "glass_side", "colour": (0.006, 0.007, 0.008), "alpha": 0.62, "rough": 0.04},
    {"name": "glass_side_frit", "colour": (0.004, 0.004, 0.004), "rough": 0.06},
    {"name": "cabin_dash", "image": "open", "colour": (0.105, 0.103, 0.105), "rough": 0.55},
    {"name": "cabin_soft", "image": "open", "colour": (0.070, 0.070, 0.074), "rough": 0.8},
    {"name": "cabin_seat", "image": "open", "colour": (0.12, 0.085, 0.065), "rough": 0.75},
    {"name": "cabin_lining", "image": "open", "colour": (0.58, 0.56, 0.52), "rough": 0.95},
    {"name": "cabin_grip", "image": "open", "colour": (0.038, 0.036, 0.036), "rough": 0.42},
    {"name": "cabin_silver", "image": "open", "colour": (0.42, 0.42, 0.43), "rough": 0.32, "metal": 0.8},
    {"name": "cabin_mirror", "colour": (0.75, 0.77, 0.78), "rough": 0.03, "metal": 1.0},
    {"name": "cabin_dial", "colour": (0.006, 0.006, 0.007), "rough": 0.35},
    {"name": "cabin_lit_white", "colour": (0.1, 0.1, 0.1), "rough": 0.6, "emit": (0.55, 0.51, 0.45)},
    {"name": "cabin_lit_amber", "colour": (0.1, 0.05, 0.0), "rough": 0.6, "emit": (0.85, 0.204, 0.034)},
    {"name": "cabin_lit_blue", "colour": (0.0, 0.02, 0.05), "rough": 0.6, "emit": (0.04, 0.13, 0.28)},
    {"name": "rain_cover", "colour": (0, 0, 0), "rough": 1.0},
    {"name": "rain_screen", "colour": (0, 0, 0), "rough": 1.0},
]
TILES = {m["name"]: 1.0 for m in MATERIALS}

FRONT, REAR = -2.08, 2.02
WHEELS, HUB, ARCH, TYRE = (-1.33, 1.27), 0.315, 0.345, 0.315

WIDE = [(-2.08, 0.72), (-1.95, 0.765), (-1.7, 0.82), (-1.38, 0.855), (-0.8, 0.862), (0.0, 0.868), (0.9, 0.878),
        (1.35, 0.878), (1.7, 0.85), (1.9, 0.815), (2.02, 0.79)]
BELT = [(-2.08, 0.62), (-1.95, 0.70), (-1.7, 0.765), (-1.38, 0.812), (-1.2, 0.835), (-0.8, 0.865), (0.0, 0.90),
        (1.0, 0.945), (1.6, 0.972), (1.85, 0.965), (2.02, 0.93)]
BONNET = [(-2.08, 0.655), (-1.98, 0.715), (-1.8, 0.775), (-1.5, 0.825), (-1.24, 0.852), (-1.16, 0.862)]
ROOF = [(-0.42, 1.402), (-0.28, 1.440), (-0.05, 1.468), (0.35, 1.482), (0.8, 1.462), (1.15, 1.412), (1.34, 1.362)]
TAIL = [(1.34, 1.362), (1.42, 1.305), (1.6, 1.145), (1.75, 1.02), (1.82, 0.985), (2.02, 0.95)]
RAIL_OUT = [(-1.16, 0.778), (-0.8, 0.735), (-0.40, 0.680), (0.0, 0.668), (0.6, 0.664), (1.2, 0.645), (1.5, 0.672),
            (1.8, 0.765)]
RAIL_IN = [(-1.16, 0.725), (-0.8, 0.675), (-0.40, 0.615), (0.0, 0.600), (0.6, 0.594), (1.2, 0.560), (1.5, 0.575),
           (1.8, 0.64)]


def smooth(keys, x):
    """Monotone cubic interpolation of (x, y) keys: no bump between them that the keys do not have."""
    if x <= keys[0][0] or x >= keys[-1][0]:
        return keys[0][1] if x <= keys[0][0] else keys[-1][1]
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(keys, keys[1:])]
    k = next(i for i in range(len(slopes)) if x <= keys[i + 1][0])

    def tangent(i):
        if i == 0 or i == len(slopes):
            return slopes[min(i, len(slopes) - 1)]
        a, b = slopes[i - 1], slopes[i]
        return 2 * a * b / (a + b) if a * b > 0 else 0.0

    (x0, y0), (x1, y1) = keys[k], keys[k + 1]
    wide = x1 - x0
    t = (x - x0) / wide
    return (y0 * (1 + 2 * t) * (1 - t) ** 2 + y1 * t * t * (3 - 2 * t)
            + wide * (tangent(k) * t * (1 - t) ** 2 - tangent(k + 1) * t * t * (1 - t)))


def ease(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


# ---- the body


def screen_y(x, z):
    """Height of the pane at (x, z)."""
    back = PANE["bend"] * (1 - math.cos(math.asin(min(abs(x) / PANE["bend"], 1.0))))
    return PANE["y"] + ((z - PANE["z"]) / math.tan(PANE["rake"])) - back / math.sin(PANE["rake"])


def crown(z):
    """Height over the middle of the car, and what a section loses of it per square metre of x beside it."""
    if z < -1.16:
        return smooth(BONNET, z), None
    if z < -0.42:
        return screen_y(0.0, z) - 0.014, 0.152
    return (smooth(ROOF, z) if z < 1.34 else smooth(TAIL, z)), 0.152 - 0.07 * ease(1.34, 1.75, z)


SIDE = [(0.0, 0.925), (0.12, 0.968), (0.30, 0.978), (0.50, 0.980), (0.70, 0.996), (0.80, 1.0), (0.88, 0.992),
        (0.95, 0.970), (1.0, 0.945)]


def sill(z):
    low = smooth([(-2.08, 0.30), (-1.9, 0.22), (1.8, 0.23), (2.02, 0.34)], z)
    for wheel in WHEELS:
        if abs(z - wheel) < ARCH:
            low = max(low, HUB + math.sqrt(ARCH * ARCH - (z - wheel) ** 2))
    return low


def side_x(z, y):
    """Half the width of the body at a height below the belt; arches stand out a little."""
    belt = smooth(BELT, z)
    x = smooth(WIDE, z) * smooth(SIDE, (y - 0.22) / (belt - 0.22))
    for wheel in WHEELS:
        x += 0.022 * (1 - ease(ARCH, ARCH + 0.10, math.hypot(z - wheel, y - HUB)))
    return x


def fillet(z, radius=0.10):
    """How far a section draws in near the ends of the car."""
    left = min(z - FRONT, REAR - z)
    return radius - math.sqrt(radius ** 2 - (radius - left) ** 2) if left < radius else 0.0


def end_shift(x, y, z):
    """Both ends are curved: in plan, and leaning away above the bumpers."""
    if z > 1.67:
        part = ((z - 1.67) / (REAR - 1.67)) ** 2
        bumper = 0.035 * (ease(0.30, 0.38, y) - ease(0.555, 0.59, y))
        return part * (bumper - 0.20 * (abs(x) / 0.8) ** 2.4 - 0.13 * ease(0.60, 1.0, y) - 0.08 * ease(0.40, 0.22, y))
    if z < -1.73:
        part = ((z + 1.73) / (FRONT + 1.73)) ** 2
        return part * (0.26 * (abs(x) / 0.8) ** 2.2 + 0.10 * ease(0.48, 0.72, y) + 0.06 * ease(0.38, 0.22, y))
    return 0.0


def section(z):
    """Half a cross-section, 21 points; 8 is the belt, 12 to 14 the rail, 20 the middle."""
    low, belt, gone = sill(z), smooth(BELT, z), fillet(z)
    top, fall = crown(z)
    low, belt, top = low + 0.5 * gone, belt - 0.6 * gone, top - 0.6 * gone
    heights = [low, low + 0.012] + [low + (belt - 0.14 - low) * f for f in (0.33, 0.67, 1.0)]
    heights += [belt - 0.105, belt - 0.075, belt - 0.03, belt]
    points = [(side_x(z, y) - gone, y) for y in heights]
    points[0] = (points[0][0] - 0.03, low)
    edge = points[8][0]
    if -1.17 < z < 1.81:
        x_in, x_out = smooth(RAIL_IN, z), smooth(RAIL_OUT, z)
        y_in = screen_y(x_in, z) - 0.006 if z < -0.42 else top - fall * x_in * x_in
        y_out = max(y_in - 0.045, belt + 0.012)
        y_in = max(y_in, y_out - 0.01 if z > 1.6 else y_in)
        foot = (edge - 0.012, belt + 0.010)
        for t, bow in ((0.0, 0.0), (0.5, 0.010), (0.92, 0.003)):
            points.append((foot[0] + (x_out - foot[0]) * t + bow, foot[1] + (y_out - foot[1]) * t))
        points += [(x_out, y_out), (x_out * 0.6 + x_in * 0.4 + 0.006, y_out * 0.4 + y_in * 0.6 + 0.006), (x_in, y_in)]
        points += [(x_in * (1 - k / 6), y_in + (top - y_in) * (1 - (1 - k / 6) ** 2)) for k in range(1, 7)]
    else:
        shares = [0.985, 0.96, 0.94, 0.92, 0.90, 0.88] + [0.88 * (1 - k / 6) for k in range(1, 7)]
        points += [(edge * s, belt + (top - belt) * (1 - s ** 2.6)) for s in shares]
    return [(x, y, z + end_shift(x, y, z)) for x, y in points]


def stations():
    at = {FRONT, FRONT + 0.006, FRONT + 0.022, FRONT + 0.05, FRONT + 0.10, -1.85, -1.24, -1.175, -1.16, -1.0, -0.88,
          -0.72, -0.58, -0.42, -0.32, -0.15, 0.05, 0.20, 0.28, 0.50, 0.75, 0.92, 1.15, 1.28, 1.34, 1.42, 1.52, 1.62,
          1.72, 1.76, 1.80, 1.815, 1.86, REAR - 0.10, REAR - 0.05, REAR - 0.022, REAR - 0.006, REAR}
    for wheel in WHEELS:
        at |= {round(wheel + ARCH * math.sin(math.radians(a)), 4)
               for a in (-89.9, -75, -55, -32, 0, 32, 55, 75, 89.9)}
    return sorted(at)


def body_material(z, j):
    """Material of a patch, by its middle z and by the row in the half section. None: no patch."""
    if j < 1 or (abs(z) > 1.73 and j < 2):
        return "plastic"
    if j in (7, 8) and -1.16 < z < 1.34:
        return "trim"
    if 9 <= j <= 11 and -1.16 < z < 1.42:
        if j < 11 and (-0.95 < z < 0.20 or 0.28 < z < 1.24):
            return "glass_side"
        return "glass_side_frit"
    if j >= 14:
        if -1.24 < z < -1.16:
            return "plastic"
        if -1.16 < z < -0.42:
            return "glass_side"
        if 1.34 < z < 1.42 or (1.42 < z < 1.78 and j == 14):
            return "glass_side_frit"
        if 1.42 < z < 1.76:
            return "glass_side"
    return "paint"


def whole(half):
    """A half section and its mirror image, from the left sill over the top to the right one."""
    return [(-x, y, z) for x, y, z in half] + list(reversed(half[:-1]))


def grid_patches(g, rows, material_of):
    """A smooth grid whose patches are of different materials; vertices are shared within each."""
    sums = Group._grid_normals(rows)
    number = {}

    def vertex(material, i, j):
        mesh = g._mesh(material)
        if (material, i, j) not in number:
            number[material, i, j] = len(mesh.positions)
            mesh.positions.append(rows[i][j])
            mesh.normals.append(tuple(-c for c in unit(sums[i][j])))
        return number[material, i, j]

    for i in range(len(rows) - 1):
        for j in range(len(rows[0]) - 1):
            material = material_of(i, j)
            if material:
                a, b, c, d = (vertex(material, *p) for p in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
                mesh = g._mesh(material)
                Group._triangle(mesh, a, b, c)
                Group._triangle(mesh, a, c, d)


def end_rows(z, count=10):
    """The face that closes an end: from the left edge of its section to the right one, row by row upwards."""
    half = section(z)[:9]
    top = section(z)[20][1]
    rows = []
    for x, y, _ in half + [(half[-1][0] * s, half[-1][1] + (top - half[-1][1]) * (1 - s ** 2.6), 0)
                           for s in (0.95, 0.9)]:
        columns = [x * (2 * k / count - 1) for k in range(count + 1)]
        rows.append([(c, y, z + end_shift(c, y, z)) for c in columns])
    return rows


def make_body():
    g = Group("body", TILES)
    at = stations()
    rows = [whole(section(z)) for z in at]
    grid_patches(g, rows, lambda i, j: body_material((at[i] + at[i + 1]) / 2, j if j < 20 else 39 - j))
    for z in (FRONT, REAR):
        face = end_rows(z)
        if z == REAR:
            face = [list(reversed(r)) for r in face]
        grid_patches(g, face, lambda i, j: "plastic" if i < 2 else "paint")
    g.box("pit", (-0.70, 0.20, -1.98), (0.70, 0.24, 1.85))
    for wheel in WHEELS:
        wheel_well(g, wheel)
    return g


def wheel_well(g, z):
    """What closes an arch: a half pipe and the wall behind the wheel."""
    angles = [math.radians(-6 + 192 * k / 12) for k in range(13)]
    arc = [(HUB + (ARCH + 0.012) * math.sin(a), z + (ARCH + 0.012) * math.cos(a)) for a in angles]
    for s in (-1, 1):
        rows = [[(s * x, y, w) for x in (0.55, 0.84)] for y, w in arc]
        g.surface("pit", rows if s < 0 else [list(reversed(r)) for r in rows])
        wall = [(s * 0.55, y, w) for y, w in arc]
        g.poly("pit", wall if s < 0 else wall[::-1])


# ---- what is on it


def on_end(points, z, lift):
    """Points (x, y) on the face of an end."""
    out = lift if z > 0 else -lift
    return [(x, y, z + end_shift(x, y, z) + out) for x, y in points]


def end_patch(g, material, z, left, right, low, high, lift, lean=0.0, steps=8, up=3):
    """A patch of an end between two x; `lean` shifts its upper edge."""
    rows = []
    for i in range(up + 1):
        y = low + (high - low) * i / up
        xs = [left + (right - left) * k / steps for k in range(steps + 1)]
        row = on_end([(x + lean * i / up * (1 if x > 0 else -1), y) for x in xs], z, lift)
        rows.append(row if z > 0 else row[::-1])
    g.surface(material, rows)


# Strokes of the plate's letters in a unit square: V A 2 0 6 4.
LETTERS = [[(0.0, 0.2, 0.4, 1.0), (0.8, 1.0, 0.4, 1.0), (0.15, 0.85, 0.0, 0.4)],
           [(0.0, 0.22, 0.0, 1.0), (0.22, 1.0, 0.82, 1.0), (0.78, 1.0, 0.5, 0.82), (0.22, 1.0, 0.38, 0.54),
            (0.7, 0.95, 0.0, 0.38)],
           [(0.0, 1.0, 0.82, 1.0), (0.78, 1.0, 0.5, 0.82), (0.0, 1.0, 0.42, 0.58), (0.0, 0.22, 0.15, 0.42),
            (0.0, 1.0, 0.0, 0.17)],
           [(0.0, 0.22, 0.0, 1.0), (0.78, 1.0, 0.0, 1.0), (0.22, 0.78, 0.83, 1.0), (0.22, 0.78, 0.0, 0.17)],
           [(0.0, 0.22, 0.0, 1.0), (0.22, 1.0, 0.83, 1.0), (0.78, 1.0, 0.0, 0.55), (0.22, 0.78, 0.42, 0.58),
            (0.22, 0.78, 0.0, 0.17)],
           [(0.0, 0.22, 0.4, 1.0), (0.0, 1.0, 0.32, 0.5), (0.68, 0.9, 0.0, 1.0)]]


def both(x0, x1):
    return [(-x1, -x0), (x0, x1)]


def make_rear(g):
    for x0, x1 in both(0.44, 0.735):
        end_patch(g, "lamp_red", REAR, x0, x1, 0.715, 0.865, 0.014, -0.03)
        outer = max(abs(x0), abs(x1))
        inner = min(abs(x0), abs(x1))
        s = 1 if x0 > 0 else -1
        for y in (0.742, 0.835):
            lean = 0.03 * (y - 0.715) / 0.15
            line = on_end([(s * (inner + (outer - inner) * (0.10 + 0.82 * k / 8) - lean), y) for k in range(9)], REAR,
                          0.018)
            g.tube("lamp_red_lit", line, 0.011, 4)
        line = on_end([(s * (outer - 0.035), 0.742 + 0.093 * k / 4) for k in range(5)], REAR, 0.018)
        g.tube("lamp_red_lit", line, 0.011, 4)
    end_patch(g, "trim", REAR, -0.44, 0.44, 0.775, 0.80, 0.010, 0.0, 10, 1)
    end_patch(g, "trim", REAR, -0.33, 0.33, 0.605, 0.752, 0.004, 0.0, 8, 2)
    end_patch(g, "plate", REAR, -0.26, 0.26, 0.622, 0.733, 0.012, 0.0, 8, 2)
    for k in range(6):
        x = -0.155 + 0.056 * k + (0.024 if k > 1 else 0.0)
        for x0, x1, y0, y1 in LETTERS[k]:
            end_patch(g, "letters", REAR, x + 0.036 * x0, x + 0.036 * x1, 0.652 + 0.052 * y0, 0.652 + 0.052 * y1, 0.015,
                      0.0, 1, 1)
    end_patch(g, "chrome", REAR, -0.05, 0.05, 0.80, 0.835, 0.018, 0.0, 3, 2)
    for x0, x1 in both(0.45, 0.66):
        end_patch(g, "reflector", REAR, x0, x1, 0.445, 0.475, 0.006, 0.0, 5, 1)
    g.tube("pit", on_end([(-0.74 + 1.48 * k / 16, 0.596) for k in range(17)], REAR, 0.004), 0.005, 4)
    for x in (-0.46, 0.46):
        g.tube("chrome", [(x, 0.285, 1.80), (x, 0.285, 1.985)], 0.036, 10)
        disc(g, "pit", (x, 0.285, 1.983), 0.032, 10)
    spoiler(g)


def disc(g, material, centre, radius, sides, facing=1):
    ring = [(centre[0] + radius * math.cos(2 * math.pi * k / sides),
             centre[1] + radius * math.sin(2 * math.pi * k / sides), centre[2]) for k in range(sides)]
    g.poly(material, ring if facing > 0 else ring[::-1])


def spoiler(g):
    """The roof runs out over the rear window, with the third brake lamp in its edge."""
    xs = [-0.56 + 1.12 * k / 10 for k in range(11)]
    upper = [[(x, crown(z)[0] - 0.152 * x * x + lift, z + out - 0.10 * (x / 0.56) ** 4 * (out > 0)) for x in xs]
             for z, out, lift in ((1.22, 0.0, 0.004), (1.34, 0.0, 0.012), (1.34, 0.12, -0.015))]
    lower = [[(x, y - 0.022, z) for x, y, z in upper[2]], [(x, y - 0.03, z - 0.10) for x, y, z in upper[2]]]
    g.surface("paint", list(reversed(upper)))
    g.surface("trim", [lower[1], lower[0]])
    g.surface("paint", [lower[0], upper[2]])
    edge = [(x, y - 0.011, z + 0.003) for x, y, z in upper[2] if abs(x) < 0.2]
    g.tube("lamp_red_lit", edge, 0.007, 5)
    g.tube("trim", [(0.0, 1.455, 1.02), (0.0, 1.50, 1.06), (0.0, 1.512, 1.13)], [0.022, 0.016, 0.006], 6)


def make_front(g):
    for x0, x1 in both(0.42, 0.70):
        end_patch(g, "lamp_clear", FRONT, x0, x1, 0.56, 0.655, 0.010, 0.02)
        middle = (x0 + x1) / 2
        for dx in (-0.06, 0.06):
            centre = on_end([(middle + dx, 0.605)], FRONT, 0.016)[0]
            disc(g, "lamp_head_lit", centre, 0.034, 12, -1)
    end_patch(g, "pit", FRONT, -0.36, 0.36, 0.53, 0.60, 0.006)
    for y in (0.545, 0.565, 0.585):
        g.tube("chrome", on_end([(-0.36 + 0.72 * k / 8, y) for k in range(9)], FRONT, 0.010), 0.005, 4)
    end_patch(g, "pit", FRONT, -0.50, 0.50, 0.33, 0.44, 0.006)
    end_patch(g, "plate", FRONT, -0.26, 0.26, 0.455, 0.535, 0.014)


def make_sides(g):
    for s in (-1, 1):
        outer = []
        for z, tall, wide in ((-0.99, 0.03, 0.055), (-0.97, 0.05, 0.085), (-0.90, 0.064, 0.10), (-0.84, 0.066, 0.10)):
            ring = [(s * (0.985 + wide * math.cos(a)), 0.955 + tall * math.sin(a), z + 0.03 * (math.cos(a) + 1) * 0.5)
                    for a in (2 * math.pi * k / 20 for k in range(21))]
            outer.append(ring)
        g.surface("paint", outer if s < 0 else [r[::-1] for r in outer])
        glass = [(x, y, z + 0.002) for x, y, z in outer[-1][:-1]]
        g.poly("mirror", glass if s < 0 else glass[::-1])
        g.tube("trim", [(s * 0.80, 0.885, -0.90), (s * 0.93, 0.925, -0.89)], 0.02, 6)
        for z in (0.08, 0.93):
            y = 0.79
            x = side_x(z, y)
            g.tube("paint", [(s * (x - 0.004), y, z), (s * (x + 0.022), y + 0.004, z + 0.03),
                             (s * (x + 0.022), y + 0.006, z + 0.13), (s * (x - 0.004), y + 0.008, z + 0.16)], 0.011, 6)
        for z0, low in ((-0.96, 0.32), (0.25, 0.32), (1.10, 0.62)):
            line = [(low + (smooth(BELT, z0) - 0.01 - low) * k / 5) for k in range(6)]
            g.tube("pit", [(s * (side_x(z0, y) - 0.001), y, z0) for y in line], 0.005, 3)
        skirt = [(s * (side_x(z, 0.27) - 0.01), 0.27, z) for z in (-0.96, -0.6, -0.2, 0.2, 0.6, 0.90)]
        g.tube("plastic", skirt, 0.035, 6)


def make_wheel():
    """Outside towards +X, about the origin."""
    g = Group("wheel", TILES)
    tyre = [(0.60, -0.09), (0.955, -0.10), (1.0, -0.075), (1.0, 0.075), (0.955, 0.10), (0.80, 0.112), (0.68, 0.10),
            (0.655, 0.085)]
    rim = [(0.655, 0.085), (0.63, 0.092), (0.60, 0.075), (0.585, 0.0)]
    for material, profile in (("wheel_tyre", tyre), ("wheel_rim", rim)):
        rows = [[(x, TYRE * r * math.cos(2 * math.pi * k / 28), TYRE * r * math.sin(2 * math.pi * k / 28))
                 for k in range(29)] for r, x in profile]
        g.surface(material, rows)
    ring = [(0.0, TYRE * 0.60 * math.cos(2 * math.pi * k / 20), TYRE * 0.60 * math.sin(2 * math.pi * k / 20))
            for k in range(20)]
    g.poly("wheel_dark", ring)
    for k in range(5):
        for side in (-0.16, 0.16):
            a = 2 * math.pi * k / 5
            root, tip, wide = 0.20, 0.63, 0.045
            place = lambda r, x, t: (x, TYRE * (r * math.cos(a + side * (0.4 + r)) - t * math.sin(a + side)),
                                     TYRE * (r * math.sin(a + side * (0.4 + r)) + t * math.cos(a + side)))
            front = [place(root, 0.085, -wide), place(tip, 0.078, -wide * 0.8), place(tip, 0.078, wide * 0.8),
                     place(root, 0.085, wide)]
            back = [(0.03, y, z) for _, y, z in front]
            g.poly("wheel_rim", front)
            g.poly("wheel_dark", [back[0], back[1], front[1], front[0]])
            g.poly("wheel_dark", [front[3], front[2], back[2], back[3]])
    rows = [[(x, TYRE * r * math.cos(2 * math.pi * j / 14), TYRE * r * math.sin(2 * math.pi * j / 14))
             for j in range(15)] for r, x in ((0.26, 0.03), (0.25, 0.085), (0.18, 0.095), (0.0, 0.098))]
    g.surface("wheel_rim", rows)
    return g


# ---- the cabin


def in_cabin(p):
    """How much light reaches a point: less near the floor and under the roof."""
    _, y, z = p
    low = 0.10 + 0.90 * ease(0.50, 0.90, y)
    roof = 1.0 - 0.20 * ease(1.15, 1.40, y)
    return low * roof * (1.0 - 0.35 * ease(-0.3, 0.6, z))


DASH = [(-1.205, 0.862), (-1.10, 0.870), (-0.97, 0.875), (-0.85, 0.876), (-0.76, 0.872), (-0.715, 0.862),
        (-0.690, 0.842), (-0.690, 0.815), (-0.712, 0.795), (-0.720, 0.760), (-0.690, 0.735), (-0.665, 0.70),
        (-0.675, 0.62), (-0.72, 0.52), (-0.76, 0.40)]


def dash_point(x, z, y):
    """The dashboard bows towards its ends and follows the foot of the windshield; it is lower before the doors."""
    back = 0.10 * (x / 0.74) ** 2
    dials = (1 - ease(0.165, 0.20, abs(x + 0.36))) * ease(-0.93, -0.84, z) * ease(0.74, 0.80, y)
    return (x, y - 0.022 * (x / 0.74) ** 2 - 0.085 * dials, z + back * (0.45 if z < -1.0 else 0.75))


def make_dash(g):
    xs = [-0.76 + 1.52 * k / 34 for k in range(35)]
    rows = [[dash_point(x, z, y) for x in xs] for z, y in reversed(DASH)]
    cut = len(DASH) - 8
    g.surface("cabin_soft", rows[:cut + 1])
    g.surface("cabin_dash", rows[cut:])
    line = [dash_point(x, -0.703, 0.803) for x in xs if x > -0.12]
    g.tube("cabin_silver", line, 0.007, 6)
    for x0, x1 in ((-0.62, -0.12), (0.10, 0.62)):
        g.tube("cabin_dial", [dash_point(x0 + (x1 - x0) * k / 8, -1.04, 0.8735) for k in range(9)], 0.006, 4)
    make_hood(g)
    shield(g, -0.045, 0.145)
    for x in (-0.66, 0.66):
        vent(g, x)


def make_hood(g):
    """The curved hood over the dials: thick at its lip, open towards the driver."""
    middle = -0.36
    arc = [math.radians(-8 + 196 * k / 16) for k in range(17)]

    def ring(z, wide, tall, foot):
        return [(middle + wide * math.cos(a), foot + tall * math.sin(a), z) for a in arc]

    outside = [ring(-1.00, 0.10, 0.012, 0.850), ring(-0.93, 0.165, 0.045, 0.848), ring(-0.84, 0.195, 0.082, 0.846),
               ring(-0.74, 0.205, 0.098, 0.846), ring(-0.685, 0.205, 0.100, 0.846), ring(-0.672, 0.200, 0.096, 0.846),
               ring(-0.672, 0.190, 0.086, 0.846)]
    inside = [ring(-0.672, 0.190, 0.086, 0.846), ring(-0.70, 0.182, 0.078, 0.846), ring(-0.775, 0.172, 0.070, 0.846)]
    g.surface("cabin_dash", [r[::-1] for r in outside])
    g.surface("cabin_soft", [r[::-1] for r in inside])
    upper = [panel_point(middle + 0.176 * math.cos(a), 0.845 + 0.075 * math.sin(a)) for a in arc[1:-1]]
    face = [panel_point(middle - 0.175, 0.78), panel_point(middle + 0.175, 0.78)] + upper
    g.poly("cabin_dial", [(x, y, z - 0.003) for x, y, z in face])
    dial(g, (middle - 0.082, 0.852), 0.058, 220.0, 14)
    dial(g, (middle + 0.082, 0.852), 0.058, 150.0, 18)
    x, y = middle, 0.845
    bars(g, [(x - 0.014 + 0.007 * k, y - 0.02, x - 0.011 + 0.007 * k, y - 0.02 + 0.01 + 0.004 * k) for k in range(5)],
         "cabin_lit_blue")


def panel_point(x, y):
    """On the face of the dials, which leans away from the driver."""
    return (x, y, -0.752 - (y - 0.79) * 0.034 / 0.135 + 0.003)


def bars(g, boxes, material):
    for x0, y0, x1, y1 in boxes:
        g.poly(material, [panel_point(x0, y0), panel_point(x1, y0), panel_point(x1, y1), panel_point(x0, y1)])


def dial(g, centre, radius, needle_deg, ticks):
    """A lit ring of ticks and a needle, and a bezel."""
    cx, cy = centre

    def at(r, deg):
        a = math.radians(deg)
        return panel_point(cx + r * math.cos(a), cy + r * math.sin(a))

    g.tube("cabin_silver", [at(radius, 20 * k) for k in range(19)], 0.0035, 4)
    for k in range(ticks + 1):
        deg, wide = 225.0 - 270.0 * k / ticks, 2.0 if k % 2 else 3.2
        inner = radius * (0.78 if k % 2 else 0.70)
        g.poly("cabin_lit_white", [at(inner, deg - wide), at(radius * 0.92, deg - wide), at(radius * 0.92, deg + wide),
                                   at(inner, deg + wide)])
    a = math.radians(needle_deg)
    side = (-math.sin(a) * 0.0028, math.cos(a) * 0.0028)
    tip = (cx + radius * 0.84 * math.cos(a), cy + radius * 0.84 * math.sin(a))
    g.poly("cabin_lit_amber", [panel_point(cx - side[0], cy - side[1]), panel_point(*tip),
                               panel_point(cx + side[0], cy + side[1])])


def shield(g, x0, x1):
    """A screen in the middle of the dashboard, with a map and two knobs."""
    z = -0.668
    low, high = 0.805, 0.905
    g.box("cabin_grip", (x0 - 0.012, low - 0.012, z - 0.022), (x1 + 0.012, high + 0.012, z))
    g.poly("cabin_dial", [(x0, low, z + 0.001), (x1, low, z + 0.001), (x1, high, z + 0.001), (x0, high, z + 0.001)])
    for k in range(5):
        t = (k + 0.5) / 5
        y = low + (high - low) * t
        far = y + 0.02 * (t - 0.5)
        street = [(x0 + 0.012, y - 0.0012), (x1 - 0.012, far - 0.0012), (x1 - 0.012, far + 0.0012),
                  (x0 + 0.012, y + 0.0012)]
        g.poly("cabin_lit_blue", [(a, b, z + 0.002) for a, b in street])
    xm = x0 + 0.62 * (x1 - x0)
    g.poly("cabin_lit_amber", [(xm - 0.004, low + 0.008, z + 0.003), (xm + 0.004, low + 0.008, z + 0.003),
                               (xm - 0.016, high - 0.03, z + 0.003), (xm - 0.024, high - 0.03, z + 0.003)])


def vent(g, x):
    centre = dash_point(x, -0.704, 0.778)
    turns = [2 * math.pi * k / 18 for k in range(19)]
    rows = [[(centre[0] + r * math.cos(a), centre[1] + 0.003 + r * math.sin(a), centre[2] + z) for a in turns]
            for r, z in ((0.05, -0.02), (0.05, 0.012), (0.043, 0.016), (0.040, 0.0))]
    g.surface("cabin_silver", rows[1:])
    g.surface("cabin_grip", rows[:2])
    disc(g, "cabin_dial", (centre[0], centre[1] + 0.003, centre[2] + 0.001), 0.041, 16)


def make_wheel_of_driver(g):
    """A round wheel of three spokes, leaning to the driver."""
    hub, lean = (-0.36, 0.835, -0.47), 0.42
    co, si = math.cos(lean), math.sin(lean)

    def at(u, v, w=0.0):
        """u to the right, v up in its plane, w towards the driver."""
        return (hub[0] + u, hub[1] + v * co + w * si, hub[2] - v * si + w * co)

    rings = []
    for k in range(33):
        a, row = 2 * math.pi * k / 32, []
        for m in range(8):
            b = 2 * math.pi * m / 7
            r = 0.182 + 0.0145 * math.cos(b)
            row.append(at(r * math.cos(a), r * math.sin(a), 0.016 * math.sin(b)))
        rings.append(row)
    g.surface("cabin_grip", rings)
    for angle in (0.0, 180.0, 270.0):
        a = math.radians(angle)
        rows = []
        for r, wide, w in ((0.045, 0.036, 0.004), (0.09, 0.024, -0.002), (0.14, 0.018, -0.004), (0.176, 0.020, 0.0)):
            row = []
            for m in range(7):
                b = 2 * math.pi * m / 6
                across, deep = wide * math.cos(b), 0.008 * math.sin(b)
                row.append(at(r * math.cos(a) - across * math.sin(a), r * math.sin(a) + across * math.cos(a), w + deep))
            rows.append(row)
        g.surface("cabin_silver" if angle != 270.0 else "cabin_grip", rows)
    pad = []
    for r, w in ((0.072, -0.03), (0.070, 0.004), (0.055, 0.018), (0.0, 0.022)):
        pad.append([at(r * math.cos(2 * math.pi * k / 20), r * 0.86 * math.sin(2 * math.pi * k / 20), w)
                    for k in range(21)])
    g.surface("cabin_soft", pad)
    g.tube("cabin_soft", [at(0, 0, -0.02), at(0, -0.01, -0.26)], 0.045, 10)
    for s in (-1, 1):
        g.tube("cabin_grip", [at(s * 0.03, 0.02, -0.07), at(s * 0.13, 0.05, -0.06), at(s * 0.19, 0.07, -0.05)],
               [0.012, 0.010, 0.013], 6)


def make_frame(g):
    """Lining of roof and pillars, with thickness; the header over the windshield, sun visors and the mirror."""
    xs = [2 * k / 12 - 1 for k in range(13)]
    rows = []
    for z, drop in ((-0.445, 0.008), (-0.435, 0.024), (-0.40, 0.034), (-0.30, 0.036), (0.0, 0.045), (0.5, 0.055),
                    (1.0, 0.055), (1.35, 0.05)):
        half = smooth(RAIL_IN, z) + 0.02
        top = crown(max(z, -0.42))[0] if z > -0.43 else screen_y(0, z)
        rows.append([(half * t, top - 0.152 * (half * t) ** 2 - drop, z) for t in xs])
    g.surface("cabin_lining", rows)
    for s in (-1, 1):
        pillar = []
        for k in range(9):
            z = -1.15 + 0.735 * k / 8
            x_in, x_out = smooth(RAIL_IN, z) - 0.004, smooth(RAIL_OUT, z) - 0.006
            y, deep = screen_y(x_in, z) - 0.018, 1 - 0.6 * ease(-0.62, -0.42, z)
            pillar.append([(s * x, y + dy * deep, z + dz * deep)
                           for x, dy, dz in ((x_in, 0, 0), (x_in - 0.012, -0.022, 0.012), (x_in - 0.004, -0.052, 0.035),
                                             (x_out - 0.012, -0.066, 0.050), (x_out, -0.050, 0.045),
                                             (x_out, -0.03, 0.02))])
        g.surface("cabin_lining", pillar if s > 0 else [r[::-1] for r in pillar])
        rail = []
        for z in (-0.54, -0.47, -0.40, -0.2, 0.1, 0.5, 0.9, 1.3):
            x_in, x_out = smooth(RAIL_IN, z), smooth(RAIL_OUT, z)
            y = screen_y(x_in, z) + 0.02 if z < -0.42 else crown(z)[0] - 0.152 * x_in * x_in
            deep = 0.3 + 0.7 * ease(-0.54, -0.36, z)
            rail.append([(s * (x_in - 0.02 * deep), y - 0.045, z), (s * x_in, y - 0.045 - 0.023 * deep, z),
                         (s * (x_out - 0.02), y - 0.045 - 0.033 * deep, z), (s * (x_out - 0.004), y - 0.06, z)])
        g.surface("cabin_lining", rail if s > 0 else [r[::-1] for r in rail])
        post = []
        for k in range(6):
            t = k / 5
            y = 0.90 + (1.385 - 0.90) * t
            x = 0.80 + (smooth(RAIL_OUT, 0.24) - 0.80) * t
            post.append([(s * (x - 0.002), y, 0.185), (s * (x - 0.045), y, 0.195), (s * (x - 0.045), y, 0.30),
                         (s * (x - 0.002), y, 0.31)])
        g.surface("cabin_lining", post if s > 0 else [r[::-1] for r in post])
        make_door(g, s)
        x0, x1 = sorted((s * 0.10, s * 0.50))
        visor = [[(x0 + (x1 - x0) * k / 6, 1.378 - 0.152 * (x0 + (x1 - x0) * k / 6) ** 2 + dy, z) for k in range(7)]
                 for z, dy in ((-0.395, -0.004), (-0.400, -0.012), (-0.392, -0.018), (-0.25, -0.002), (-0.24, 0.006))]
        g.surface("cabin_lining", visor)
    make_mirror(g)


def make_door(g, s):
    """The top of a door under its window, and what is below it, with a grip."""
    profile = [(-0.006, 0.004), (-0.030, 0.010), (-0.062, 0.002), (-0.082, -0.022), (-0.090, -0.07), (-0.080, -0.16),
               (-0.050, -0.20), (-0.060, -0.42)]
    rows = []
    for z in (-1.10, -0.95, -0.7, -0.4, -0.1, 0.25, 0.6, 1.0, 1.3):
        x, y = side_x(z, smooth(BELT, z)) - 0.012, smooth(BELT, z)
        rows.append([(s * (x + dx), y + dy, z) for dx, dy in profile])
    g.surface("cabin_dash", [r[:5] if s > 0 else r[:5][::-1] for r in rows])
    g.surface("cabin_soft", [r[4:] if s > 0 else r[4:][::-1] for r in rows])
    g.tube("cabin_silver", [(s * 0.715, 0.80, -0.50), (s * 0.685, 0.815, -0.44), (s * 0.685, 0.82, -0.30),
                            (s * 0.715, 0.81, -0.24)], 0.012, 6)


def make_mirror(g):
    """The mirror inside, on its stalk, turned to the driver."""
    centre, turn = (-0.045, 1.298, -0.465), 0.30
    co, si = math.cos(turn), math.sin(turn)

    def at(u, v, w):
        return (centre[0] + u * co - w * si, centre[1] + v, centre[2] + u * si * 0.6 + w * co)

    def ring(scale, w):
        out = []
        for k in range(25):
            a = 2 * math.pi * k / 24
            c, s = math.cos(a), math.sin(a)
            out.append(at(0.096 * scale * math.copysign(abs(c) ** 0.5, c),
                          0.028 * scale * math.copysign(abs(s) ** 0.6, s), w))
        return out

    g.surface("cabin_grip", [ring(0.55, -0.030), ring(0.92, -0.020), ring(1.0, 0.0), ring(0.97, 0.005),
                             ring(0.93, 0.005)])
    g.poly("cabin_mirror", ring(0.93, 0.0045)[:-1])
    g.tube("cabin_grip", [(-0.045, 1.302, -0.485), (-0.03, 1.335, -0.47), (-0.01, 1.368, -0.43)], 0.009, 6)
    g.tube("cabin_grip", [(-0.01, 1.362, -0.435), (-0.01, 1.385, -0.42)], 0.022, 8)


def cushion(g, material, profile, half, middle):
    """A rounded block: its (z, y) profile swept across, drawn in towards both sides."""
    rows = []
    for t in (-1.0, -0.94, -0.78, -0.4, 0.0, 0.4, 0.78, 0.94, 1.0):
        gone = 1 - 0.16 * abs(t) ** 6
        cz = sum(z for z, _ in profile) / len(profile)
        cy = sum(y for _, y in profile) / len(profile)
        rows.append([(middle + half * t, cy + (y - cy) * gone, cz + (z - cz) * gone) for z, y in profile + profile[:1]])
    g.surface(material, rows)
    for row in (rows[0], rows[-1]):
        g.poly(material, row[:-1])


def make_seats(g):
    base = [(-0.18, 0.40), (-0.20, 0.48), (-0.14, 0.52), (0.10, 0.50), (0.28, 0.46), (0.28, 0.36)]
    back = [(0.22, 0.46), (0.18, 0.60), (0.26, 0.85), (0.34, 1.04), (0.40, 1.06), (0.43, 1.02), (0.36, 0.70),
            (0.34, 0.46)]
    head = [(0.40, 1.09), (0.38, 1.16), (0.40, 1.26), (0.44, 1.28), (0.48, 1.24), (0.47, 1.10)]
    for x in (-0.36, 0.36):
        cushion(g, "cabin_seat", base, 0.25, x)
        cushion(g, "cabin_seat", back, 0.24, x)
        cushion(g, "cabin_seat", head, 0.13, x)
        for dx in (-0.05, 0.05):
            g.tube("cabin_silver", [(x + dx, 1.03, 0.40), (x + dx, 1.12, 0.43)], 0.007, 5)
    rear = [(1.16, 0.50), (1.12, 0.62), (1.24, 0.92), (1.30, 0.96), (1.36, 0.92), (1.30, 0.50)]
    cushion(g, "cabin_seat", rear, 0.60, 0.0)
    g.box("cabin_soft", (-0.72, 0.26, -1.0), (0.72, 0.30, 1.4))


def make_cabin():
    g = Group("cabin", TILES)
    make_dash(g)
    make_wheel_of_driver(g)
    make_frame(g)
    make_seats(g)
    return g


# ---- what keeps rain off


def hull(g, material, low, high):
    """A closed block between two quadrilaterals, each counter-clockwise from above."""
    g.poly(material, low[::-1])
    g.poly(material, high)
    for k in range(4):
        m = (k + 1) % 4
        g.poly(material, [low[k], low[m], high[m], high[k]])


def flat(z0, half0, y0, z1, half1, y1):
    """Corners from the back (z1) left, around."""
    return [(-half1, y1, z1), (half1, y1, z1), (half0, y0, z0), (-half0, y0, z0)]


def make_occluders():
    """Simple closed shapes: cabin, roof, bonnet and tail; and a slab under the windshield, clear of the pane."""
    g = Group("rain", TILES)
    hull(g, "rain_cover", flat(-1.00, 0.80, 0.70, 1.72, 0.80, 0.90), flat(-0.30, 0.67, 1.30, 1.25, 0.63, 1.36))
    hull(g, "rain_cover", flat(-0.41, 0.70, 1.33, 1.30, 0.66, 1.33), flat(-0.41, 0.66, 1.395, 1.30, 0.60, 1.395))
    hull(g, "rain_cover", flat(-2.0, 0.72, 0.30, -1.15, 0.85, 0.30), flat(-2.0, 0.70, 0.69, -1.15, 0.82, 0.83))
    hull(g, "rain_cover", flat(1.40, 0.86, 0.30, 2.0, 0.76, 0.30), flat(1.40, 0.82, 0.95, 2.0, 0.72, 0.93))
    hull(g, "rain_cover", flat(-1.15, 0.85, 0.30, 1.40, 0.86, 0.30), flat(-1.15, 0.82, 0.76, 1.40, 0.84, 0.90))
    hull(g, "rain_screen", flat(-1.12, 0.74, 0.80, -0.38, 0.68, 1.34), flat(-1.12, 0.74, 0.82, -0.38, 0.68, 1.36))
    return g


def ramp(size=256):
    """The texture `open`: black to white, linear in light."""
    def encode(v):
        return 255.0 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)
    return png(size, 1, [(encode(k / (size - 1)),) * 3 for k in range(size)], 256)


def set_uvs(g):
    """Texture coordinates in the ramp `open`, for a material that has it. Others need none."""
    for name, mesh in g.meshes.items():
        textured = next("image" in m for m in MATERIALS if m["name"] == name)
        mesh.uvs = [(0.02 + 0.96 * in_cabin(p), 0.5) for p in mesh.positions] if textured else []


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    scene = Scene(MATERIALS, {"open": ramp()}, "car", "make_car.py")
    body = make_body()
    make_rear(body)
    make_front(body)
    make_sides(body)
    for group in (body, make_cabin(), make_wheel(), make_occluders()):
        set_uvs(group)
        scene.place(group)
    path = os.path.join(here, "scenes", "car.glb")
    scene.write(path)
    print("%s: %d triangles, %d bytes" % (os.path.relpath(path), scene.triangles(), os.path.getsize(path)))


if __name__ == "__main__":
    main()

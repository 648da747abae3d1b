#!/usr/bin/env python3
"""Writes two people for the street: scenes/umbrella.glb, who stands and waits under an umbrella, and
scenes/raincoat.glb, who walks with the hood up. Python 3 standard library only.

Metres, Y up, facing -Z, soles on y = 0. Lengths of limbs are the fractions of the stature of Drillis and Contini 1966,
Body segment parameters (in Winter, Biomechanics and motor control of human movement, figure 4.1). Each garment is one
closed surface (surfaces.py), with folds by its shape. The faces have no features: one is under an umbrella, the other
in a hood.

raincoat.glb has its figure POSES times, as `pose_0` and so on: one stride, two steps, in equal parts. All have the same
triangles, so that a program can blend them; a foot that is on the ground moves back as fast as the figure moves on. The
same source always gives the same bytes.
"""
import math
import os

from gltf_writer import Group, Mesh, Scene, unit
from street_parts import curve
from surfaces import ball, limb, polygonise, smooth_min

MATERIALS = [
    {"name": "cloth_coat", "colour": (0.035, 0.038, 0.050), "rough": 0.92},
    {"name": "cloth_scarf", "colour": (0.30, 0.16, 0.05), "rough": 0.95},
    {"name": "cloth_hat", "colour": (0.09, 0.035, 0.03), "rough": 0.95},
    {"name": "cloth_trousers", "colour": (0.030, 0.032, 0.038), "rough": 0.85},
    {"name": "cloth_umbrella", "colour": (0.38, 0.023, 0.026), "rough": 0.42, "two_sided": True, "passes": 0.35},
    {"name": "plastic_raincoat", "colour": (0.44, 0.27, 0.03), "rough": 0.28},
    {"name": "rubber_boots", "colour": (0.022, 0.024, 0.022), "rough": 0.30},
    {"name": "rubber_gloves", "colour": (0.028, 0.020, 0.016), "rough": 0.6},
    {"name": "person_hair", "colour": (0.030, 0.019, 0.012), "rough": 0.6},
    {"name": "person_skin", "colour": (0.34, 0.21, 0.15), "rough": 0.5},
    {"name": "steel_umbrella", "colour": (0.045, 0.045, 0.048), "rough": 0.6},
    {"name": "wood_umbrella", "colour": (0.10, 0.05, 0.025), "rough": 0.4},
]
TILES = {m["name"]: 1.0 for m in MATERIALS}

STATURE = 1.70
ANKLE, KNEE, HIP, SHOULDER, CHIN = (STATURE * part for part in (0.039, 0.285, 0.530, 0.818, 0.870))
UPPER_ARM, FOREARM, FOOT = STATURE * 0.186, STATURE * 0.146, STATURE * 0.152
HIP_X, SHOULDER_X = 0.092, STATURE * 0.129 - 0.053 # of the joints

POSES, STRIDE = 6, 1.32


def stack(p, wide, deep, low, high):
    """A body of ellipses one above the other; wide and deep are (y, half the width) keys."""
    w, d = curve(wide, p[1]), curve(deep, p[1])
    f = (math.hypot(p[0] / w, p[2] / d) - 1.0) * min(w, d)
    return -smooth_min(smooth_min(-f, p[1] - low, 0.03), high - p[1], 0.03)


def folds(p, top, low, depth):
    """Of cloth that hangs from a waist: none there, `depth` at the hem."""
    part = min(max((top - p[1]) / (top - low), 0.0), 1.0)
    a = math.atan2(p[2], p[0])
    return depth * part * (math.sin(6 * a + 1.1 + 1.5 * p[1]) + 0.55 * math.sin(10 * a - 0.7 - 2.5 * p[1]))


def creases(p, centre, depth, reach=0.12):
    """Of cloth that is bent about a joint."""
    near = math.exp(-(math.dist(p, centre) / reach) ** 2)
    return depth * near * math.sin(105.0 * (p[1] - centre[1]) + 45.0 * (p[2] - centre[2]) + 28.0 * p[0])


def arm(p, shoulder, elbow, wrist, radii):
    f = smooth_min(limb(p, shoulder, elbow, radii[0], radii[1]), limb(p, elbow, wrist, radii[1], radii[2]), 0.03)
    return f + creases(p, elbow, 0.0035)


def add(group, material, made):
    """A surface of surfaces.py into a group."""
    mesh = group.meshes.setdefault(material, Mesh())
    base = len(mesh.positions)
    mesh.positions += made[0]
    mesh.normals += made[1]
    mesh.indices += [base + i for i in made[2]]


# ---- legs, of both


def trouser(p, x, ahead=0.0):
    f = smooth_min(limb(p, (x, HIP, 0.0), (x, KNEE, -0.01 - ahead), 0.084, 0.062),
                   limb(p, (x, KNEE, -0.01 - ahead), (x, 0.20, 0.012), 0.062, 0.055), 0.04)
    f = max(f, 0.16 - p[1], p[1] - 0.76) # what a coat hides is not made
    return f + 0.0035 * math.exp(-((p[1] - 0.22) / 0.07) ** 2) * math.sin(75.0 * p[1] + 22.0 * p[0] + 30.0 * p[2])


def boot(p, x):
    """A rubber boot: the sole lies on the ground, the heel is a little behind the ankle."""
    toe, heel = -0.58 * FOOT, 0.13 * FOOT
    f = smooth_min(limb(p, (x, 0.038, heel), (x * 1.08, 0.030, toe), 0.040, 0.037),
                   limb(p, (x, ANKLE, 0.022), (x, 0.25, 0.014), 0.043, 0.048), 0.04)
    return max(f, 0.002 - p[1], p[1] - 0.23)


def box_of(x, low_y, high_y, half=0.16):
    return (x - half, low_y, -0.30), (x + half, high_y, 0.20)


# ---- who waits under an umbrella

HAND = (0.155, 1.135, -0.235)
APEX = (0.045, 2.02, -0.015)
COAT_WIDE = [(0.60, 0.235), (0.80, 0.222), (1.04, 0.178), (1.24, 0.190), (1.36, 0.160), (1.43, 0.105), (1.48, 0.072)]
COAT_DEEP = [(0.60, 0.175), (0.80, 0.170), (1.04, 0.132), (1.24, 0.142), (1.36, 0.115), (1.43, 0.09), (1.48, 0.07)]


def coat(p):
    f = stack(p, COAT_WIDE, COAT_DEEP, 0.60, 1.48) + folds(p, 1.02, 0.60, 0.008)
    right = arm(p, (SHOULDER_X, SHOULDER - 0.04, 0.0), (0.245, 1.105, -0.02), (0.185, 1.115, -0.19),
                (0.070, 0.060, 0.048))
    left = arm(p, (-SHOULDER_X, SHOULDER - 0.04, 0.0), (-0.250, 1.095, 0.045), (-0.215, 0.90, -0.06),
               (0.070, 0.060, 0.056))
    f = smooth_min(f, smooth_min(right, left, 0.01), 0.045)
    lapel = 0.004 * math.exp(-((p[0] - 0.02) / 0.008) ** 2) if p[2] < 0 else 0.0
    return f + lapel + 0.004 * math.exp(-((p[1] - 1.03) / 0.014) ** 2)


def scarf(p):
    f = ball(p, (0.0, 1.475, -0.005), (0.098, 0.058, 0.098))
    tail = limb(p, (0.05, 1.45, -0.095), (0.055, 1.17, -0.142), 0.026, 0.030)
    wrapped = 0.004 * math.sin(95.0 * p[1] + 3.0 * math.atan2(p[2], p[0])) * ease(1.40, 1.44, p[1])
    return smooth_min(f, tail, 0.03) + wrapped


def hat(p):
    f = ball(p, (0.0, 1.632, 0.008), (0.094, 0.098, 0.108))
    rim = abs(math.hypot(p[0] / 0.094, (p[2] - 0.008) / 0.108) - 1.0) * 0.1
    f = smooth_min(f, math.hypot(rim, max(abs(p[1] - 1.612) - 0.016, 0.0)) - 0.010, 0.01)
    return max(f, 1.588 - p[1] + 0.25 * p[2])


def glove(p):
    """A fist about the handle, which comes out of a sleeve."""
    f = limb(p, (0.180, 1.116, -0.185), HAND, 0.036, 0.044)
    return f + 0.004 * math.sin(120.0 * p[1]) * (p[2] < HAND[2])


def umbrella(g, ribs=8, radius=0.53, drop=0.20):
    """A canopy of cloth that sags between its ribs, with its edge cut in from tip to tip. Its axis leans back."""
    axis = unit(tuple(APEX[i] - HAND[i] for i in range(3)))
    side = unit((axis[1], -axis[0], 0.0))
    other = (axis[1] * side[2] - axis[2] * side[1], axis[2] * side[0] - axis[0] * side[2],
             axis[0] * side[1] - axis[1] * side[0])

    def place(x, up, z):
        return tuple(APEX[i] + x * side[i] + up * axis[i] + z * other[i] for i in range(3))

    def rib(k, t):
        a = 2.0 * math.pi * (k + 0.5) / ribs
        return radius * t * math.cos(a), -drop * t * t * (0.75 + 0.25 * t), radius * t * math.sin(a)

    def cloth(k, v, t):
        t *= 1.0 - 0.05 * 4.0 * v * (1.0 - v)
        a, b = rib(k, t), rib(k + 1, t)
        x, y, z = (a[i] + v * (b[i] - a[i]) for i in range(3))
        return place(x, y - 0.016 * t * math.sin(math.pi * v), z)

    steps = [0.02, 0.2, 0.4, 0.6, 0.75, 0.88, 1.0]
    for k in range(ribs):
        g.surface("cloth_umbrella", [[cloth(k, v / 6, t) for v in range(7)] for t in steps])
        g.tube("steel_umbrella", [tuple(c - 0.006 * axis[i] for i, c in enumerate(place(*rib(k, t))))
                                  for t in (0.0, 0.3, 0.6, 0.85, 1.015)], 0.0028, 3)
        g.tube("steel_umbrella", [place(0, -0.30, 0), place(*(c - 0.005 * (i == 1) for i, c in
                                                             enumerate(rib(k, 0.55))))], 0.0022, 3)
    down = math.dist(APEX, HAND)
    g.tube("steel_umbrella", [place(0, 0.07, 0), place(0, -down, 0)], 0.006, 6)
    g.tube("wood_umbrella", [place(0, -down + 0.08, 0), place(0, -down - 0.10, 0)]
           + [place(0.03 - 0.03 * math.cos(a), -down - 0.10 - 0.04 * math.sin(a), 0) for a in (0.8, 1.57, 2.4, 3.14)],
           0.012, 6)


def waiting():
    g = Group("person_umbrella", TILES)
    add(g, "cloth_coat", polygonise(coat, (-0.36, 0.54, -0.33), (0.36, 1.54, 0.26), 0.030))
    add(g, "cloth_scarf", polygonise(scarf, (-0.13, 1.10, -0.20), (0.13, 1.56, 0.13), 0.020))
    add(g, "cloth_hat", polygonise(hat, (-0.13, 1.53, -0.14), (0.13, 1.76, 0.15), 0.021))
    add(g, "person_hair", polygonise(lambda p: ball(p, (0.0, 1.56, 0.036), (0.087, 0.105, 0.076)),
                                     (-0.11, 1.42, -0.06), (0.11, 1.69, 0.14), 0.025))
    add(g, "person_skin", polygonise(lambda p: ball(p, (0.0, 1.575, -0.010), (0.072, 0.112, 0.090)),
                                     (-0.10, 1.44, -0.12), (0.10, 1.71, 0.10), 0.023))
    add(g, "rubber_gloves", polygonise(glove, (0.09, 1.04, -0.31), (0.26, 1.20, -0.12), 0.018))
    for x, ahead in ((HIP_X, 0.0), (-HIP_X, 0.035)):
        add(g, "cloth_trousers", polygonise(lambda p, x=x, ahead=ahead: trouser(p, x, ahead), *box_of(x, 0.10, 0.83),
                                            0.033))
        add(g, "rubber_boots", polygonise(lambda p, x=x: boot(p, x), *box_of(x, -0.04, 0.29), 0.025))
    umbrella(g)
    return g


# ---- who walks in a raincoat

CAPE_WIDE = [(0.50, 0.285), (0.75, 0.255), (1.04, 0.208), (1.24, 0.208), (1.36, 0.168), (1.44, 0.110), (1.50, 0.09)]
CAPE_DEEP = [(0.50, 0.225), (0.75, 0.200), (1.04, 0.160), (1.24, 0.158), (1.36, 0.128), (1.44, 0.10), (1.50, 0.09)]


def raincoat(p):
    """The hands are in its pockets."""
    f = stack(p, CAPE_WIDE, CAPE_DEEP, 0.50, 1.50) + folds(p, 1.10, 0.50, 0.009)
    q = (abs(p[0]), p[1], p[2])
    sleeve = arm(q, (SHOULDER_X, SHOULDER - 0.04, 0.0), (0.272, 1.10, 0.050), (0.215, 0.90, -0.09),
                 (0.078, 0.070, 0.064))
    f = smooth_min(f, sleeve, 0.05)
    hood = ball(p, (0.0, 1.600, 0.020), (0.114, 0.138, 0.138))
    hood = smooth_min(hood, ball(p, (0.0, 1.50, 0.03), (0.125, 0.09, 0.12)), 0.06)
    hood += creases(p, (0.0, 1.49, 0.10), 0.005, 0.10)
    f = smooth_min(f, hood, 0.05)
    return -smooth_min(-f, ball(p, (0.0, 1.585, -0.135), (0.074, 0.100, 0.115)), 0.035)


def face(p):
    return ball(p, (0.0, 1.575, 0.0), (0.070, 0.110, 0.085))


# ---- a stride

THIGH, SHANK = HIP - KNEE, KNEE - ANKLE
STAND = 0.6 # of a stride a foot is on the ground
FIRST = 0.33 # where it comes down before the hips
DROP = 0.045 # of the hips, so that legs reach


def foot_at(u):
    """Where the ankle is, of a figure that stays in place, in part u of a stride from the landing on: back, up, and the
    pitch of the foot (toes up: above 0)."""
    if u < STAND:
        z = -FIRST + u * STRIDE
        lift = max(0.0, (u - 0.36) / (STAND - 0.36))
        pitch = 0.30 * max(0.0, 1 - u / 0.08) - 0.75 * lift * lift
    else:
        v = (u - STAND) / (1 - STAND)
        end = -FIRST + STAND * STRIDE
        z = end + (-FIRST - end) * v * v * (3 - 2 * v)
        pitch = -0.75 + 1.05 * min(v / 0.8, 1.0) * (2 - min(v / 0.8, 1.0))
    ball_z = -0.42 * FOOT # heels rise about the ball, toes about the heel
    about = ball_z if pitch < 0 else 0.13 * FOOT
    up = ANKLE * math.cos(pitch) + about * math.sin(pitch)
    back = z + about - about * math.cos(pitch) + ANKLE * math.sin(pitch)
    swing = 0.035 * math.sin(math.pi * (u - STAND) / (1 - STAND)) if u > STAND else 0.0
    return back, up + swing, pitch


def leg_angles(hip_y, ankle):
    """Pitches of thigh and shank (forwards: above 0) from the hip to the ankle, with the knee in front."""
    back, up = ankle
    reach = min(math.hypot(back, hip_y - up), 0.998 * (THIGH + SHANK))
    to = math.atan2(-back, hip_y - up)
    at_hip = math.acos((THIGH ** 2 + reach ** 2 - SHANK ** 2) / (2 * THIGH * reach))
    at_ankle = math.acos((SHANK ** 2 + reach ** 2 - THIGH ** 2) / (2 * SHANK * reach))
    return to + at_hip, to - at_ankle


def turn(v, pitch):
    """About X: what hangs down goes forwards, to -Z."""
    c, s = math.cos(pitch), math.sin(pitch)
    return (v[0], c * v[1] - s * v[2], s * v[1] + c * v[2])


class Pose:
    """Of one part of the stride: how points of the figure at rest move."""

    def __init__(self, part):
        self.part = part
        self.hip_y = HIP - DROP - 0.018 * math.cos(4 * math.pi * (part - 0.05))
        self.legs = {}
        for side, begin in ((1, 0.0), (-1, 0.5)):
            back, up, pitch = foot_at((part + begin) % 1.0)
            thigh, shank = leg_angles(self.hip_y, (back, up))
            self.legs[side] = (thigh, shank, pitch)

    def bones(self, side):
        """(pivot at rest, where it goes, angle) of pelvis, thigh, shank and foot."""
        thigh, shank, pitch = self.legs[side]
        hip = (0.0, self.hip_y, 0.0)
        knee = (0.0, hip[1] - THIGH * math.cos(thigh), hip[2] - THIGH * math.sin(thigh))
        ankle = (0.0, knee[1] - SHANK * math.cos(shank), knee[2] - SHANK * math.sin(shank))
        return [((0.0, HIP, 0.0), hip, 0.0), ((0.0, HIP, 0.0), hip, thigh), ((0.0, KNEE, 0.0), knee, shank),
                ((0.0, ANKLE, 0.0), ankle, pitch)]

    @staticmethod
    def carry(bone, p, n):
        pivot, to, angle = bone
        moved = turn(tuple(p[i] - pivot[i] for i in range(3)), angle)
        return tuple(moved[i] + to[i] for i in range(3)), turn(n, angle)

    def blend(self, weighted, p, n):
        at, normal = [0.0] * 3, [0.0] * 3
        for bone, weight in weighted:
            q, m = self.carry(bone, p, n)
            for i in range(3):
                at[i] += weight * q[i]
                normal[i] += weight * m[i]
        return tuple(at), unit(normal)

    def leg(self, side, p, n):
        pelvis, thigh, shank, foot = self.bones(side)
        at_hip = ease(HIP + 0.10, HIP - 0.02, p[1])
        at_knee, at_ankle = ease(KNEE + 0.09, KNEE - 0.09, p[1]), ease(ANKLE + 0.09, ANKLE + 0.01, p[1])
        return self.blend([(pelvis, 1 - at_hip), (thigh, at_hip * (1 - at_knee)),
                           (shank, at_hip * at_knee * (1 - at_ankle)), (foot, at_hip * at_knee * at_ankle)], p, n)

    def cloth(self, p, n):
        """What hangs from the hips goes with the thighs, the farther down the more; shoulders turn against them."""
        low = 0.85 * ease(HIP + 0.12, HIP - 0.30, p[1])
        right = ease(-0.14, 0.14, p[0])
        pelvis, rights, lefts = self.bones(1)[0], self.bones(1)[1], self.bones(-1)[1]
        at, normal = self.blend([(pelvis, 1 - low), (rights, low * right), (lefts, low * (1 - right))], p, n)
        yaw = 0.07 * math.cos(2 * math.pi * (self.part - 0.02)) * ease(HIP, SHOULDER, p[1])
        c, s = math.cos(yaw), math.sin(yaw)
        return ((c * at[0] + s * at[2], at[1], c * at[2] - s * at[0]),
                (c * normal[0] + s * normal[2], normal[1], c * normal[2] - s * normal[0]))


def ease(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def walking():
    """The same figure in each pose."""
    body = [("plastic_raincoat", polygonise(raincoat, (-0.42, 0.43, -0.33), (0.42, 1.82, 0.33), 0.040), None),
            ("person_skin", polygonise(face, (-0.11, 1.43, -0.13), (0.11, 1.73, 0.13), 0.055), None)]
    for side in (1, -1):
        x = side * HIP_X
        body.append(("cloth_trousers", polygonise(lambda p, x=x: trouser(p, x), *box_of(x, 0.10, 0.83), 0.045), side))
        body.append(("rubber_boots", polygonise(lambda p, x=x: boot(p, x), *box_of(x, -0.04, 0.29), 0.034), side))
    groups = []
    for k in range(POSES):
        pose, g = Pose(k / POSES), Group("pose_%d_person" % k, TILES)
        for material, (positions, normals, indices), side in body:
            moved = [pose.leg(side, p, n) if side else pose.cloth(p, n) for p, n in zip(positions, normals)]
            add(g, material, ([m[0] for m in moved], [m[1] for m in moved], indices))
        groups.append(g)
    return groups


def write(name, groups):
    used = {m for g in groups for m in g.meshes}
    scene = Scene([m for m in MATERIALS if m["name"] in used], {}, name=name, generator="make_people.py",
                  share_indices=True)
    for group in groups:
        scene.place(group)
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", name + ".glb")
    scene.write(path)
    print("%s: %d triangles, %d bytes" % (os.path.relpath(path), scene.triangles(), os.path.getsize(path)))


def main():
    write("umbrella", [waiting()])
    write("raincoat", walking())


if __name__ == "__main__":
    main()

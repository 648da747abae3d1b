#!/usr/bin/env python3
"""Checks the models of people: each garment is closed and faces outwards, a figure has the size of a person, and its
poses have the same triangles.
Usage: check_people.py FILE..."""
import json
import os
import struct
import sys

failures = 0


def fail(text):
    global failures
    failures += 1
    print("FAILED: " + text)


def read(path):
    """Meshes of a binary glTF by name: positions, normals and triangles."""
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    document, blob = json.loads(data[20:20 + length]), data[28 + length:]

    def rows(index, width, code):
        a = document["accessors"][index]
        flat = struct.unpack_from("<%d%s" % (a["count"] * width, code), blob,
                                  document["bufferViews"][a["bufferView"]]["byteOffset"])
        return [flat[i:i + width] for i in range(0, len(flat), width)]

    meshes = {}
    for mesh in document["meshes"]:
        p = mesh["primitives"][0]
        code = {5123: "H", 5125: "I"}[document["accessors"][p["indices"]]["componentType"]]
        index = [i[0] for i in rows(p["indices"], 1, code)]
        meshes[mesh["name"]] = (rows(p["attributes"]["POSITION"], 3, "f"), rows(p["attributes"]["NORMAL"], 3, "f"),
                                [tuple(index[i:i + 3]) for i in range(0, len(index), 3)])
    return meshes


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def check_closed(name, positions, normals, triangles):
    """Each edge is used as often in one direction as in the other; the volume inside is above 0."""
    edges, volume, against = {}, 0.0, 0
    for t in triangles:
        for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])):
            key, step = ((a, b), 1) if a < b else ((b, a), -1)
            edges[key] = edges.get(key, 0) + step
        p = [positions[i] for i in t]
        volume += sum(x * y for x, y in zip(p[0], cross(p[1], p[2]))) / 6
        face = cross([b - a for a, b in zip(p[0], p[1])], [b - a for a, b in zip(p[0], p[2])])
        against += sum(normals[i][k] * face[k] for i in t for k in range(3)) < 0
    if any(edges.values()):
        fail("%s is open at %d edges" % (name, sum(1 for n in edges.values() if n)))
    if not volume > 0:
        fail("%s is inside out: volume %g" % (name, volume))
    if against > 0.01 * len(triangles):
        fail("%s: %d of %d triangles face away from their normals" % (name, against, len(triangles)))


def check_file(path):
    meshes = read(path)
    if os.path.getsize(path) > 400000:
        fail("%s has %d bytes" % (path, os.path.getsize(path)))
    figure = {n: m for n, m in meshes.items() if not any(part in n for part in ("cloth_umbrella", "steel", "wood"))}
    for name, mesh in figure.items():
        check_closed(name, *mesh)
    poses = sorted({n.split("person")[0] + "person" for n in figure})
    for pose in poses:
        ys = [p[1] for n, m in figure.items() if n.startswith(pose) for p in m[0]]
        if not 1.6 <= max(ys) - min(ys) <= 1.8:
            fail("%s: %s is %.2f m high" % (path, pose, max(ys) - min(ys)))
        if not abs(min(ys)) < 0.03:
            fail("%s: the soles of %s are at %.3f m" % (path, pose, min(ys)))
        for name, mesh in figure.items():
            if name.startswith(poses[0]) and mesh[2] != figure[name.replace(poses[0], pose, 1)][2]:
                fail("%s: %s has other triangles than %s" % (path, pose, poses[0]))


for file in sys.argv[1:]:
    check_file(file)
sys.exit(failures > 0)

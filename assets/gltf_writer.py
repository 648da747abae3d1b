"""A small mesh builder and binary glTF (.glb) writer; Python standard library only.

A Group collects triangles per material, in metres, Y up. Every group becomes one glTF mesh per material, named
"<group>_<material>". Groups may be placed many times (instances), so repeated things cost their bytes once.
"""
import json
import math
import os
import struct


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length) if length > 1e-12 else (0.0, 1.0, 0.0)


class Frame:
    """Rotation about Y by yaw (degrees), then translation."""

    def __init__(self, origin=(0.0, 0.0, 0.0), yaw_deg=0.0):
        self.origin, self.yaw_deg = origin, yaw_deg
        self.c, self.s = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))

    def turn(self, v):
        return (self.c * v[0] + self.s * v[2], v[1], -self.s * v[0] + self.c * v[2])

    def point(self, p):
        t = self.turn(p)
        return (t[0] + self.origin[0], t[1] + self.origin[1], t[2] + self.origin[2])


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uvs, self.indices = [], [], [], []


class Group:
    """Triangles by material. tiles maps a material to the metres that one repeat of its texture covers."""

    def __init__(self, name, tiles):
        self.name, self.tiles, self.frame, self.meshes = name, tiles, Frame(), {}

    def _mesh(self, material):
        return self.meshes.setdefault(material, Mesh())

    def _box_uv(self, material, p, n):
        """Planar projection along the dominant axis of the normal, in tiles; v runs down, as glTF images do."""
        tile = self.tiles.get(material, 1.0)
        ax, ay, az = abs(n[0]), abs(n[1]), abs(n[2])
        if ay >= ax and ay >= az:
            return (p[0] / tile, p[2] / tile)
        return ((p[2] if ax > az else p[0]) / tile, -p[1] / tile)

    def poly(self, material, points, uvs=None, normal=None):
        """A flat convex polygon, counter-clockwise seen from its front."""
        mesh = self._mesh(material)
        world = [self.frame.point(p) for p in points]
        flat = unit(cross(sub(world[1], world[0]), sub(world[2], world[0])))
        n = flat if normal is None else unit(self.frame.turn(normal))
        base = len(mesh.positions)
        mesh.positions += world
        mesh.normals += [n] * len(world)
        mesh.uvs += uvs if uvs else [self._box_uv(material, p, flat) for p in world]
        for i in range(1, len(world) - 1):
            mesh.indices += [base, base + i, base + i + 1]

    def box(self, material, lo, hi, skip=""):
        """An axis-aligned box; skip names faces that nobody sees: any of x X y Y z Z (lower and upper side)."""
        (a, b, c), (d, e, f) = lo, hi
        faces = {
            "x": [(a, b, c), (a, b, f), (a, e, f), (a, e, c)], "X": [(d, b, f), (d, b, c), (d, e, c), (d, e, f)],
            "y": [(a, b, c), (d, b, c), (d, b, f), (a, b, f)], "Y": [(a, e, f), (d, e, f), (d, e, c), (a, e, c)],
            "z": [(d, b, c), (a, b, c), (a, e, c), (d, e, c)], "Z": [(a, b, f), (d, b, f), (d, e, f), (a, e, f)]}
        for key, points in faces.items():
            if key not in skip:
                self.poly(material, points)

    def surface(self, material, rows, planar=False, uv_scale=None, uv_box=None):
        """A smooth grid of points. The front is where columns run right and rows run up.

        Seams are smooth where first and last points coincide. uv: along the grid's lengths, or planar by normal, or
        spread over uv_box (u0, v0, u1, v1).
        """
        mesh = self._mesh(material)
        tile = uv_scale or self.tiles.get(material, 1.0)
        count_i, count_j = len(rows), len(rows[0])
        world = [[self.frame.point(p) for p in row] for row in rows]
        sums = self._grid_normals(world)
        base = len(mesh.positions)
        for i in range(count_i):
            along = 0.0
            for j in range(count_j):
                p, n = world[i][j], unit(sums[i][j])
                along += math.dist(p, world[i][j - 1]) if j else 0.0
                up = sum(math.dist(world[k][j], world[k - 1][j]) for k in range(1, i + 1)) if not planar else 0.0
                if uv_box:
                    u0, v0, u1, v1 = uv_box
                    uv = (u0 + (u1 - u0) * j / (count_j - 1), v0 + (v1 - v0) * i / (count_i - 1))
                else:
                    uv = self._box_uv(material, p, n) if planar else (along / tile, -up / tile)
                mesh.positions.append(p)
                mesh.normals.append(n)
                mesh.uvs.append(uv)
        for i in range(count_i - 1):
            for j in range(count_j - 1):
                a = base + i * count_j + j
                b, c, d = a + 1, a + count_j + 1, a + count_j
                self._triangle(mesh, a, b, c)
                self._triangle(mesh, a, c, d)

    @staticmethod
    def _triangle(mesh, a, b, c):
        """Adds a triangle unless it has no area (poles of lathes)."""
        p, q, r = mesh.positions[a], mesh.positions[b], mesh.positions[c]
        n = cross(sub(q, p), sub(r, p))
        if n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 1e-16:
            mesh.indices += [a, b, c]

    @staticmethod
    def _grid_normals(world):
        sums = [[(0.0, 0.0, 0.0) for _ in row] for row in world]
        by_place = {}
        for i in range(len(world) - 1):
            for j in range(len(world[0]) - 1):
                n = cross(sub(world[i + 1][j + 1], world[i][j]), sub(world[i + 1][j], world[i][j + 1]))
                for k, l in ((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)):
                    key = tuple(round(x, 5) for x in world[k][l])
                    s = by_place.get(key, (0.0, 0.0, 0.0))
                    by_place[key] = (s[0] + n[0], s[1] + n[1], s[2] + n[2])
        for i, row in enumerate(world):
            for j, p in enumerate(row):
                sums[i][j] = by_place[tuple(round(x, 5) for x in p)]
        return sums

    def lathe(self, material, profile, sides, centre=(0.0, 0.0, 0.0), start_deg=0.0, sweep_deg=360.0):
        """Turns (radius, height) pairs, listed from bottom to top, about a vertical axis."""
        rows = []
        for radius, height in profile:
            row = []
            for j in range(sides + 1):
                a = math.radians(start_deg - sweep_deg * j / sides)
                row.append((centre[0] + radius * math.cos(a), centre[1] + height, centre[2] + radius * math.sin(a)))
            rows.append(row)
        self.surface(material, rows)

    def tube(self, material, path, radii, sides=6):
        """A round tube along a path of points."""
        rows = []
        for i, p in enumerate(path):
            ahead = unit(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
            side = unit(cross(ahead, (0.0, 0.0, 1.0) if abs(ahead[2]) < 0.9 else (1.0, 0.0, 0.0)))
            other = cross(ahead, side)
            radius = radii[i] if isinstance(radii, (list, tuple)) else radii
            row = []
            for j in range(sides + 1):
                a = 2.0 * math.pi * j / sides
                ca, sa = radius * math.cos(a), radius * math.sin(a)
                row.append(tuple(p[k] + ca * side[k] + sa * other[k] for k in range(3)))
            rows.append(row)
        self.surface(material, rows)

    def extrude(self, material, profile, x0, x1, caps=True):
        """Sweeps a closed (z, y) profile along local X; counter-clockwise on paper with z to the right and y up."""
        count = len(profile)
        for i in range(count):
            (z0, y0), (z1, y1) = profile[i], profile[(i + 1) % count]
            self.poly(material, [(x0, y0, z0), (x1, y0, z0), (x1, y1, z1), (x0, y1, z1)])
        if caps:
            self.poly(material, [(x1, y, z) for z, y in reversed(profile)])
            self.poly(material, [(x0, y, z) for z, y in profile])


class Scene:
    """Groups, where they stand, materials and images; write() makes the file."""

    def __init__(self, materials, images, name="street", generator="make_street.py", share_indices=False):
        """share_indices: lists that are equal are written once, as those of poses are."""
        self.materials, self.images, self.placements = materials, images, []
        self.name, self.generator, self.share_indices = name, generator, share_indices

    def place(self, group, position=(0.0, 0.0, 0.0), yaw_deg=0.0, quaternion=None, scale=1.0):
        self.placements.append((group, position, yaw_deg, quaternion, scale))

    def triangles(self):
        return sum(len(m.indices) // 3 for g, *_ in self.placements for m in g.meshes.values())

    def write(self, path):
        builder = _Glb(self)
        text = json.dumps(builder.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        body = bytes(builder.blob) + b"\0" * (-len(builder.blob) % 4)
        with open(path + ".tmp", "wb") as out:
            out.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(body)))
            out.write(struct.pack("<I4s", len(text), b"JSON") + text)
            out.write(struct.pack("<I4s", len(body), b"BIN\0") + body)
        os.replace(path + ".tmp", path)


class _Glb:
    def __init__(self, scene):
        self.blob, self.views, self.accessors, self.meshes, self.nodes = bytearray(), [], [], [], []
        self.mesh_of, self.index_of = {}, {} if scene.share_indices else None
        names = [m["name"] for m in scene.materials]
        used = sorted(scene.images)
        images = [{"name": n, "mimeType": "image/png", "bufferView": self._view(scene.images[n])} for n in used]
        roots = [self._node(names, *p) for p in scene.placements]
        thin = ["KHR_materials_diffuse_transmission"] if any("passes" in m for m in scene.materials) else []
        self.document = {
            "asset": {"version": "2.0", "generator": scene.generator}, "scene": 0,
            "extensionsUsed": ["KHR_materials_emissive_strength"] + thin,
            "scenes": [{"name": scene.name, "nodes": roots}], "nodes": self.nodes, "meshes": self.meshes,
            "materials": [self._material(m, used) for m in scene.materials],
            "textures": [{"source": i, "sampler": 0} for i in range(len(used))], "images": images,
            "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
            "accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": len(self.blob)}]}

    def _view(self, data, target=None):
        self.blob += b"\0" * (-len(self.blob) % 4)
        view = {"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.blob += data
        self.views.append(view)
        return len(self.views) - 1

    def _accessor(self, rows, kind, component, code, target, bounds=False):
        flat = [x for row in rows for x in row] if kind != "SCALAR" else rows
        accessor = {"bufferView": self._view(struct.pack("<%d%s" % (len(flat), code), *flat), target),
                    "componentType": component, "count": len(rows), "type": kind}
        if bounds:
            as_floats = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in rows]
            accessor["min"] = [min(p[i] for p in as_floats) for i in range(3)]
            accessor["max"] = [max(p[i] for p in as_floats) for i in range(3)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def _indices(self, indices, wide):
        key = tuple(indices)
        if self.index_of is None or key not in self.index_of:
            made = self._accessor(indices, "SCALAR", 5125 if wide else 5123, "I" if wide else "H", 34963)
            if self.index_of is None:
                return made
            self.index_of[key] = made
        return self.index_of[key]

    def _mesh(self, name, mesh, material):
        wide = len(mesh.positions) > 65535
        attributes = {"POSITION": self._accessor(mesh.positions, "VEC3", 5126, "f", 34962, True),
                      "NORMAL": self._accessor(mesh.normals, "VEC3", 5126, "f", 34962)}
        if mesh.uvs:
            attributes["TEXCOORD_0"] = self._accessor(mesh.uvs, "VEC2", 5126, "f", 34962)
        indices = self._indices(mesh.indices, wide)
        self.meshes.append({"name": name, "primitives": [
            {"attributes": attributes, "indices": indices, "material": material}]})
        return len(self.meshes) - 1

    def _node(self, names, group, position, yaw_deg, quaternion, scale):
        if group not in self.mesh_of:
            self.mesh_of[group] = [self._mesh(group.name + "_" + m, mesh, names.index(m))
                                   for m, mesh in sorted(group.meshes.items())]
        place = {"name": group.name}
        if any(position):
            place["translation"] = [round(x, 4) for x in position]
        if yaw_deg or quaternion:
            half = math.radians(yaw_deg) / 2.0
            place["rotation"] = quaternion or [0, round(math.sin(half), 7), 0, round(math.cos(half), 7)]
        if scale != 1.0:
            place["scale"] = [round(scale, 3)] * 3
        if len(self.mesh_of[group]) == 1:
            self.nodes.append(dict(place, mesh=self.mesh_of[group][0]))
            return len(self.nodes) - 1
        children = []
        for index in self.mesh_of[group]:
            self.nodes.append({"name": self.meshes[index]["name"], "mesh": index})
            children.append(len(self.nodes) - 1)
        self.nodes.append(dict(place, children=children))
        return len(self.nodes) - 1

    @staticmethod
    def _material(m, used):
        pbr = {"baseColorFactor": list(m.get("colour", (1, 1, 1))) + [m.get("alpha", 1)],
               "metallicFactor": m.get("metal", 0), "roughnessFactor": m["rough"]}
        out = {"name": m["name"], "pbrMetallicRoughness": pbr}
        if "image" in m:
            pbr["baseColorTexture"] = {"index": used.index(m["image"])}
        if "joints" in m:
            out["occlusionTexture"] = {"index": used.index(m["joints"])}
            out["extras"] = {"virga_joints": True}
        if "bump" in m:
            out["normalTexture"] = {"index": used.index(m["bump"])}
        if "emit" in m:
            out["emissiveFactor"] = list(m["emit"])
            out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": m.get("strength", 1)}}
            if "image" in m:
                out["emissiveTexture"] = {"index": used.index(m["image"])}
        if "passes" in m:
            out.setdefault("extensions", {})["KHR_materials_diffuse_transmission"] = {
                "diffuseTransmissionFactor": m["passes"]}
        if "alpha" in m:
            out["alphaMode"] = "BLEND"
        if m.get("two_sided"):
            out["doubleSided"] = True
        return out

"""Closed smooth surfaces from fields: a field is below 0 inside. Python standard library only.

Surface nets (Gibson 1998, Constrained elastic surface nets): a vertex in each cell of a grid that the surface passes
through, a quad around each edge that crosses it. Vertices are then moved onto the surface along the gradient, which is
also their normal: folds finer than a cell are still seen in the light.
"""
import math

from gltf_writer import unit


def smooth_min(a, b, wide):
    """The lower of two, rounded where they are within `wide` of each other (Quilez, Smooth minimum, polynomial)."""
    h = max(wide - abs(a - b), 0.0) / wide
    return min(a, b) - h * h * wide * 0.25


def limb(p, a, b, ra, rb):
    """Distance to a rod from a to b whose radius goes from ra to rb, about."""
    ab = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    ap = (p[0] - a[0], p[1] - a[1], p[2] - a[2])
    t = (ap[0] * ab[0] + ap[1] * ab[1] + ap[2] * ab[2]) / (ab[0] * ab[0] + ab[1] * ab[1] + ab[2] * ab[2])
    t = min(max(t, 0.0), 1.0)
    return math.dist(ap, (ab[0] * t, ab[1] * t, ab[2] * t)) - ra - (rb - ra) * t


def ball(p, centre, radii):
    """About the distance to an ellipsoid."""
    q = [(p[i] - centre[i]) / radii[i] for i in range(3)]
    k0 = math.hypot(*q)
    k1 = math.hypot(*(q[i] / radii[i] for i in range(3)))
    return k0 * (k0 - 1.0) / k1 if k1 > 1e-9 else -min(radii)


def gradient(field, p, step=0.002):
    return tuple((field(tuple(p[i] + step * (i == axis) for i in range(3)))
                  - field(tuple(p[i] - step * (i == axis) for i in range(3)))) / (2 * step) for axis in range(3))


def _corner(low, cell, at):
    return tuple(low[i] + cell * at[i] for i in range(3))


def _cell_vertex(values, low, cell, at):
    """The mean of the points where edges of a cell cross the surface; None: it does not pass through."""
    corners = [(at[0] + (k & 1), at[1] + (k >> 1 & 1), at[2] + (k >> 2)) for k in range(8)]
    inside = [values[c] < 0 for c in corners]
    if all(inside) or not any(inside):
        return None
    points = []
    for k in range(8):
        for bit in (1, 2, 4):
            m = k | bit
            if m != k and inside[k] != inside[m]:
                t = values[corners[k]] / (values[corners[k]] - values[corners[m]])
                a, b = _corner(low, cell, corners[k]), _corner(low, cell, corners[m])
                points.append(tuple(a[i] + t * (b[i] - a[i]) for i in range(3)))
    return tuple(sum(p[i] for p in points) / len(points) for i in range(3))


def _onto(field, p, reach):
    """Moves a point onto the surface, by Newton's steps of at most `reach` each."""
    for _ in range(3):
        g = gradient(field, p)
        slope = max(sum(x * x for x in g), 0.05)
        f = min(max(field(p), -reach), reach)
        p = tuple(p[i] - f * g[i] / slope for i in range(3))
    return p


def polygonise(field, low, high, cell):
    """Positions, normals and indices of triangles of the surface where the field is 0. It must not touch the box."""
    counts = [int(math.ceil((high[i] - low[i]) / cell)) for i in range(3)]
    values = {(i, j, k): field(_corner(low, cell, (i, j, k)))
              for i in range(counts[0] + 1) for j in range(counts[1] + 1) for k in range(counts[2] + 1)}
    index, positions = {}, []
    for i in range(counts[0]):
        for j in range(counts[1]):
            for k in range(counts[2]):
                p = _cell_vertex(values, low, cell, (i, j, k))
                if p:
                    index[i, j, k] = len(positions)
                    positions.append(_onto(field, p, 0.3 * cell))
    normals = [unit(gradient(field, p)) for p in positions]
    return positions, normals, _quads(values, index, positions)


def _quads(values, index, positions):
    indices = []
    for (i, j, k), value in values.items():
        for axis, step in enumerate(((1, 0, 0), (0, 1, 0), (0, 0, 1))):
            end = (i + step[0], j + step[1], k + step[2])
            if end not in values or (value < 0) == (values[end] < 0):
                continue
            u, v = ((0, 1, 0), (0, 0, 1)) if axis == 0 else ((0, 0, 1), (1, 0, 0)) if axis == 1 else ((1, 0, 0),
                                                                                                     (0, 1, 0))
            ring = [index[tuple((i, j, k)[n] - a * u[n] - b * v[n] for n in range(3))]
                    for a, b in ((1, 1), (0, 1), (0, 0), (1, 0))]
            if value >= 0:
                ring = ring[::-1]
            a, b, c, d = ring
            if math.dist(positions[a], positions[c]) <= math.dist(positions[b], positions[d]):
                indices += [a, b, c, a, c, d]
            else:
                indices += [a, b, d, b, c, d]
    return indices

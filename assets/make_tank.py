#!/usr/bin/env python3
"""Writes scenes/tank.glb and scenes/pool.glb, in which column.yaml and block.yaml have their water. Python 3 standard
library only.

Metres, Y up, with a corner of the water at the origin. Both are floors of tiles and walls behind the water, so that
one sees what the water does to what is behind it; the walls in front are not drawn. The same source always gives the
same bytes.
"""
import os

from gltf_writer import Group, Scene

MATERIALS = [{"name": "tile_light", "colour": (0.72, 0.74, 0.72), "rough": 0.35},
             {"name": "tile_dark", "colour": (0.03, 0.16, 0.30), "rough": 0.35},
             {"name": "tile_red", "colour": (0.55, 0.07, 0.04), "rough": 0.35},
             {"name": "frame", "colour": (0.10, 0.10, 0.11), "rough": 0.4, "metal": 0.8},
             {"name": "table", "colour": (0.16, 0.15, 0.14), "rough": 0.7}]
TILES = {m["name"]: 1.0 for m in MATERIALS}
THICK = 0.02 # of floor and walls


def tiles(group, size, tile, place):
    """A board of tiles of two colours over size[0] x size[1]; `place` maps a point of it to the world."""
    columns, rows = (max(1, round(side / tile)) for side in size)
    for i in range(columns):
        for j in range(rows):
            material = ("tile_light", "tile_dark")[(i + j) % 2]
            if i % 4 == 1 and j % 4 == 1:
                material = "tile_red"
            a, b = size[0] * i / columns, size[0] * (i + 1) / columns
            c, d = size[1] * j / rows, size[1] * (j + 1) / rows
            group.poly(material, [place(a, c), place(b, c), place(b, d), place(a, d)])


def make(name, size, wall, tile):
    """Floor, back and left wall of water in size[0] x size[2], with walls as high as `wall`."""
    wide, deep = size
    scene = Scene(MATERIALS, {}, name=name, generator="make_tank.py")
    board = Group("tiles", TILES)
    tiles(board, (wide, deep), tile, lambda u, v: (u, 0.0, deep - v))
    tiles(board, (wide, wall), tile, lambda u, v: (u, v, 0.0))
    tiles(board, (deep, wall), tile, lambda u, v: (0.0, v, deep - u))
    scene.place(board)
    body = Group("tank", TILES)
    body.box("frame", (-THICK, -THICK, -THICK), (wide + THICK, 0, deep + THICK), skip="Y")
    body.box("frame", (-THICK, -THICK, -THICK), (wide + THICK, wall + THICK, 0), skip="Z")
    body.box("frame", (-THICK, -THICK, 0), (0, wall + THICK, deep + THICK), skip="X")
    for x, z in ((wide, deep), (-THICK, deep)):
        body.box("frame", (x, -THICK, z), (x + THICK, wall + THICK, z + THICK))
    body.box("frame", (-THICK, -THICK, deep), (wide, 0, deep + THICK))
    body.box("frame", (wide, -THICK, 0), (wide + THICK, 0, deep))
    body.box("table", (-4, -THICK - 0.1, -3), (wide + 4, -THICK, deep + 4))
    scene.place(body)
    scene.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenes", name + ".glb"))


def main():
    make("tank", (1.23, 0.72), 0.57, 0.06)
    make("pool", (1.0, 1.0), 0.9, 0.1)


if __name__ == "__main__":
    main()

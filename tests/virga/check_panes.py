"""What the files of panes.sh's scene must hold. Standard library only.

Usage: check_panes.py bumps FILE | stats FILE | points PLY PLY PLY SEEN STATS | pixels FILE | plate FILE R G B |
                      same FILE FILE
"""
import json
import math
import re
import struct
import sys
import zlib

FPS = 24
PROPERTIES = ([("float", name) for name in "x y z vx vy vz radius".split()] + [("uint", "id"), ("float", "age")] +
              [("uint", name) for name in "kind flags pane".split()] + [("float", "water_ul")])
X, V, RADIUS, ID, AGE, KIND, FLAGS, PANE, WATER = 0, 3, 6, 7, 8, 9, 10, 11, 12
DROP, PARTICLE = 1, 2

failures = 0


def expect(condition, text):
    global failures
    if not condition:
        failures += 1
        if failures <= 20:
            print("  " + text)


def write_bumps(paths):
    """A grey picture of 8 x 8, grooves along its columns."""
    raw = b"".join(b"\0" + bytes((column % 4) * 80 for column in range(8)) for _ in range(8))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(paths[0], "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 0, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


# ---- statistics


def nanolitres(microlitres):
    return round(microlitres * 1000)


def check_stats(paths):
    lines = [json.loads(line) for line in open(paths[0])]
    expect([line["frame"] for line in lines] == list(range(1, 13)), f"frames {[line['frame'] for line in lines]}")
    landed = [0, 0]
    for line in lines:
        panes = line["glass"]
        expect([pane["name"] for pane in panes] == ["window", "shield"], f"panes {[pane['name'] for pane in panes]}")
        for i, pane in enumerate(panes):
            water = {name: nanolitres(value) for name, value in pane["water_ul"].items()}
            off = water["landed"] - sum(value for name, value in water.items() if name != "landed")
            expect(off == 0, f"frame {line['frame']}: the budget of {pane['name']} is off by {off} nl: {water}")
            expect(water["landed"] >= landed[i], f"frame {line['frame']}: landed {water['landed']} after {landed[i]}")
            # The window is so far away that its drops are mist.
            drawn = i == 0 or line["frame"] == 1 or pane["balls"] > 0
            expect(drawn, f"frame {line['frame']}: no balls on {pane['name']}")
            lost = pane["ball_entries_dropped"] + pane["drops_without_slot"]
            expect(lost == 0, f"frame {line['frame']}: {pane}")
            landed[i] = water["landed"]
    shield, window = lines[-1]["glass"][1], lines[-1]["glass"][0]
    expect(lines[0]["glass"][0]["arrived"] == 0, "drops before any rain has fallen")
    expect(shield["to_particles"] > 0 and window["to_particles"] == 0, f"to particles {shield['to_particles']}")
    # A pane that drives into the rain at 5 m/s, 4 m/s of wind against it, meets more than one that stands in the wind.
    expect(landed[1] > 1.3 * landed[0] > 0, f"landed {landed}")


def check_same(paths):
    whole, alone = ({line["frame"]: line for line in map(json.loads, open(path))} for path in paths)
    for frame, line in alone.items():
        wanted = whole[frame]["glass"]
        expect(line["glass"] == wanted, f"frame {frame}: {line['glass']}, expected {wanted}")
    expect(sorted(alone) == [7, 8, 9], f"frames {sorted(alone)}")


# ---- points


def read_points(path):
    head, mark, body = open(path, "rb").read().partition(b"end_header\n")
    lines = [line for line in head.decode("ascii").split("\n") if line and not line.startswith("comment")]
    expect(mark and lines[:2] == ["ply", "format binary_little_endian 1.0"], f"{path}: begins with {lines[:2]}")
    count = int(lines[2].split()[2])
    properties = [tuple(line.split()[1:]) for line in lines[3:]]
    expect(properties == PROPERTIES, f"{path}: properties {properties}")
    form = "<" + "".join("f" if kind == "float" else "I" for kind, _ in PROPERTIES)
    expect(len(body) == count * struct.calcsize(form), f"{path}: {len(body)} bytes for {count} points")
    return list(struct.iter_unpack(form, body)) if failures == 0 else []


def camera_z(frame):
    """A straight path of two keys."""
    return 6 - 5 * (frame - 1) / FPS


def check_place(path, d, frame):
    """The window stands in a plane; the windshield leans back by 60 degrees, bulging by what 3 m of radius make."""
    x, y, z = d[X:X + 3]
    if d[PANE] == 0:
        expect(abs(z + 4) < 1e-4 and -0.21 < x < 1.21 and 0.49 < y < 1.26, f"{path}: at {d[:3]} on the window")
        return
    ahead = camera_z(frame) - 1
    up = (y - 0.9) / math.cos(math.radians(60))
    expect(-0.17 < up < 0.95 and abs(x) < 0.71, f"{path}: at {d[:3]} on the windshield")
    # The pane goes from its lower edge back towards the camera, and its sides bend back from the middle.
    expect(ahead - 0.01 < z < ahead + 0.75, f"{path}: at {d[:3]}, the windshield's foot is at {ahead}")


def check_points(paths):
    frames = [(6, read_points(paths[0])), (7, read_points(paths[1])), (12, read_points(paths[2]))]
    stats = {line["frame"]: line for line in map(json.loads, open(paths[4]))}
    if failures:
        return
    for (frame, points), path in zip(frames, paths):
        for pane, counted in enumerate(stats[frame]["glass"]):
            of = [d for d in points if d[PANE] == pane]
            for kind, name in ((DROP, "drops"), (PARTICLE, "particles")):
                held = [d for d in of if d[KIND] == kind]
                expect(len(held) == counted[name], f"{path}: {len(held)} {name}, expected {counted[name]}")
                water = sum(nanolitres(d[WATER]) for d in held)
                wanted = nanolitres(counted["water_ul"][name])
                expect(water == wanted, f"{path}: {name} of {water} nl, expected {wanted}")
        for d in points:
            expect(all(math.isfinite(value) for value in d) and d[KIND] in (DROP, PARTICLE), f"{path}: {d}")
            expect(0 < d[RADIUS] < 0.02 and d[AGE] >= 0, f"{path}: radius {d[RADIUS]}, age {d[AGE]}")
            check_place(path, d, frame)
    words = open(paths[3]).read().split()
    expect(int(words[0]) == len(frames[2][1]), f"assimp sees {words[0]} points, expected {len(frames[2][1])}")
    check_rest(frames[0][1], frames[1][1])


def check_rest(before, after):
    """A drop of the windshield that rests moves with the car: by 5 m/s, as its velocity says."""
    sides = [{d[ID]: d for d in points if d[PANE] == 1 and d[KIND] == DROP and not d[FLAGS] & 4}
             for points in (before, after)]
    both = sides[0].keys() & sides[1].keys()
    expect(len(both) > 50, f"{len(both)} drops rest on the windshield for a frame")
    astray = sum(abs(sides[1][i][X + 2] - sides[0][i][X + 2] + 5 / FPS) > 0.003 for i in both)
    wrong = sum(abs(sides[1][i][V + 2] + 5) > 0.05 for i in both)
    # One that has just come to rest still has its speed.
    expect(astray <= 0.05 * len(both) and wrong <= 0.15 * len(both),
           f"of {len(both)}, {astray} astray, {wrong} of wrong speed")


# ---- pixels


def statistics(path):
    text = open(path).read()
    return {key: [float(word) for word in re.search("Stats %s: ([^(\n]*)" % key, text)[1].split()]
            for key in ("Min", "Max", "Avg", "NanCount", "InfCount")}


def check_pixels(paths):
    rows = statistics(paths[0])
    expect(sum(rows["NanCount"]) + sum(rows["InfCount"]) == 0, f"not finite: {rows}")
    expect(rows["Min"][3] == 0 and 0.5 < rows["Max"][3] <= 1 and rows["Avg"][3] > 0.01, f"glass.A {rows}")
    expect(min(rows["Min"][:3]) >= 0 and max(rows["Max"][:3]) > 0.05, f"glass {rows}")
    expect(max(rows["Min"][4:6]) < -3 and min(rows["Max"][4:6]) > 3, f"refraction {rows}")
    expect(max(map(abs, rows["Min"][4:6] + rows["Max"][4:6])) < 2000, f"refraction {rows}")


def check_plate(arguments):
    """Most of the picture is the plate."""
    rows = statistics(arguments[0])
    for i, value in enumerate(map(float, arguments[1:])):
        expect(abs(rows["Avg"][i] - value) < 0.12, f"mean {rows['Avg'][i]}, the plate has {value}")


CHECKS = {"bumps": write_bumps, "stats": check_stats, "points": check_points, "pixels": check_pixels,
          "plate": check_plate, "same": check_same}
CHECKS[sys.argv[1]](sys.argv[2:])
sys.exit(1 if failures else 0)

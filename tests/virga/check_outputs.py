"""What the files of three frames of the street must hold. Standard library only; called by outputs.sh.

Usage: check_outputs.py headers|pixels|points|stats|previews FILE...
"""
import json
import math
import re
import struct
import sys

FPS = 24
WIND = (1.2, 0.0, 0.4)
SIZE = (160, 90)
CAMERA = (1.5, 1.7, 8.0)  # of frame 1, looking at
TARGET = (-0.5, 2.2, -12.0)

HALF = ["A", "B", "G", "R", "normal.X", "normal.Y", "normal.Z", "rain.A", "rain.B", "rain.G", "rain.R", "velocity.X",
        "velocity.Y"]
CHANNELS = dict([(name, "half") for name in HALF + ["wetness.Y"]] +
                [("Z", "float"), ("id.Y", "uint"), ("waterdepth.Y", "float")])

# Terminal speed by diameter, Gunn and Kinzer 1949 (mm: m/s).
SPEEDS = [(0.2, 0.72), (0.3, 1.17), (0.4, 1.62), (0.5, 2.06), (0.6, 2.47), (0.8, 3.27), (1.0, 4.03), (1.2, 4.64),
          (1.4, 5.17), (1.6, 5.65), (1.8, 6.09), (2.0, 6.49), (2.4, 7.27), (2.8, 7.82), (3.2, 8.26), (3.6, 8.60),
          (4.0, 8.83), (4.4, 8.98), (4.8, 9.07), (5.2, 9.12), (5.8, 9.17)]

failures = 0


def expect(condition, text):
    global failures
    if not condition:
        failures += 1
        if failures <= 20:
            print("  " + text)


def near(a, b, tolerance=1e-4):
    return abs(a - b) <= tolerance


# ---- frames


def transform(matrix, point):
    """OpenEXR multiplies row vectors: point * matrix."""
    row = point + (1.0,)
    return [sum(row[i] * matrix[i * 4 + j] for i in range(4)) for j in range(4)]


def check_camera(matrix):
    """Its place is the origin of the first frame, and what it looks at lies straight ahead, along -Z."""
    distance = math.dist(CAMERA, TARGET)
    for point, place in ((CAMERA, (0, 0, 0, 1)), (TARGET, (0, 0, -distance, 1))):
        seen = transform(matrix, point)
        expect(all(near(a, b, 1e-3) for a, b in zip(seen, place)), f"worldToCamera takes {point} to {seen}")


def check_header(text, number, version):
    channels = dict(re.findall(r"^   '([^']+)': (\w+) samp 1 1$", text, re.M))
    expect(channels == CHANNELS, f"frame {number} has channels {channels}")
    values = dict(re.findall(r"^  (\w+): \w+ (.*)$", text, re.M))
    kinds = dict(re.findall(r"^  (\w+): (\w+) .*$", text, re.M))
    wanted = {"seed": "int", "frame": "int", "time": "double", "sceneHash": "string", "virgaVersion": "string",
              "device": "string", "framesPerSecond": "rational", "worldToCamera": "m44f", "samples": "int"}
    for name, kind in wanted.items():
        expect(kinds.get(name) == kind, f"frame {number}: attribute {name} is {kinds.get(name)}, expected {kind}")
    if not set(wanted) <= set(values):
        return None
    expect(values["seed"] == "1" and values["samples"] == "1", f"frame {number}: seed {values['seed']}")
    expect(values["frame"] == str(number), f"frame {number}: frame {values['frame']}")
    expect(near(float(values["time"]), (number - 1) / FPS, 1e-5), f"frame {number}: time {values['time']}")
    expect(re.fullmatch("'[0-9a-f]{16}'", values["sceneHash"]), f"frame {number}: sceneHash {values['sceneHash']}")
    expect("virga " + values["virgaVersion"].strip("'") == version, f"frame {number}: {values['virgaVersion']}")
    expect(len(values["device"]) > 4, f"frame {number}: device {values['device']}")
    above, below = values["framesPerSecond"].split(" (")[0].split(" / ")
    expect(int(above) == FPS * int(below), f"frame {number}: framesPerSecond {above} / {below}")
    expect("%d x %d" % SIZE in values["dataWindow"], f"frame {number}: dataWindow {values['dataWindow']}")
    return values


def check_headers(paths):
    version = open(paths[3]).read().strip()
    frames = [check_header(open(path).read(), i + 1, version) for i, path in enumerate(paths[:3])]
    if None in frames:
        return
    check_camera([float(word) for word in re.findall(r"[-+.\de]+", frames[0]["worldToCamera"])])
    expect(len({frame["sceneHash"] for frame in frames}) == 1, "the frames have different scene hashes")
    expect(len({frame["worldToCamera"] for frame in frames}) == 3, "the camera does not move")


def check_pixels(paths):
    for number, path in enumerate(paths, 1):
        text = open(path).read()
        names = [word.split()[0] for word in re.search(r"channel list: (.*)", text)[1].split(",")]
        expect(set(names) == set(CHANNELS), f"frame {number}: OpenImageIO sees channels {names}")
        rows = {key: [float(word) for word in re.search("Stats %s: ([^(\n]*)" % key, text)[1].split()]
                for key in ("Min", "Max", "Avg", "NanCount", "InfCount")}
        of = {name: {key: rows[key][i] for key in rows} for i, name in enumerate(names)}
        for name in CHANNELS:
            expect(of[name]["NanCount"] == 0, f"frame {number}: {name} has NaN")
            expect(name == "Z" or of[name]["InfCount"] == 0, f"frame {number}: {name} is infinite")
        for name in "RGB":
            expect(0 <= of[name]["Min"] and of[name]["Max"] > 0.05, f"frame {number}: {name} {of[name]}")
            expect(of["rain." + name]["Max"] > 0.001, f"frame {number}: no rain in {name}")
        expect(of["A"]["Min"] == of["A"]["Max"] == 1, f"frame {number}: beauty is not opaque")
        expect(of["rain.A"]["Min"] >= 0 and 0.01 < of["rain.A"]["Max"] <= 1, f"frame {number}: rain.A {of['rain.A']}")
        expect(1 < of["Z"]["Min"] < 20, f"frame {number}: nearest depth {of['Z']['Min']}")
        moved = max(of["velocity.X"]["Max"], -of["velocity.X"]["Min"])
        # A dolly of 2.5 cm a frame moves what is 4 m away at the edge by half a pixel. At the first frame it begins.
        expect(moved < 0.01 if number == 1 else 0.1 < moved < 2, f"frame {number}: velocity up to {moved} pixels")


# ---- points


def read_points(path):
    data = open(path, "rb").read()
    head, mark, body = data.partition(b"end_header\n")
    lines = [line for line in head.decode("ascii").split("\n") if line and not line.startswith("comment")]
    expect(mark and lines[:2] == ["ply", "format binary_little_endian 1.0"], f"{path}: begins with {lines[:2]}")
    count = int(lines[2].split()[2]) if lines[2].startswith("element vertex ") else -1
    properties = [tuple(line.split()[1:]) for line in lines[3:]]
    wanted = [("float", name) for name in "x y z vx vy vz radius".split()] + [("uint", "id"), ("float", "age")]
    expect(properties[:9] == wanted, f"{path}: properties {properties}")
    expect(all(kind in ("float", "uint") for kind, _ in properties[9:]), f"{path}: properties {properties}")
    form = "<" + "".join("f" if kind == "float" else "I" for kind, _ in properties)
    expect(len(body) == count * struct.calcsize(form), f"{path}: {len(body)} bytes for {count} points")
    return list(struct.iter_unpack(form, body)) if failures == 0 else []


def table_speed(mm):
    for (low, slow), (high, fast) in zip(SPEEDS, SPEEDS[1:]):
        if low <= mm <= high:
            return slow + (fast - slow) * (mm - low) / (high - low)
    return None


def check_speeds(path, points):
    classes = set()
    for point in points:
        mm = 2000 * point[6]
        speed = table_speed(mm)
        if speed is None:
            continue
        falls = [point[3 + axis] - WIND[axis] for axis in range(3)]
        classes.add(int(mm))
        expect(near(-falls[1], speed, 0.02 * speed), f"{path}: {mm:.2f} mm falls at {-falls[1]:.3f}, table {speed:.3f}")
        expect(near(falls[0], 0, 1e-3) and near(falls[2], 0, 1e-3), f"{path}: {mm:.2f} mm drifts {falls} in the wind")
    expect({0, 1, 2, 3} <= classes, f"{path}: only drops of {sorted(classes)} mm")


def check_motion(one, other):
    """The same id is the same drop: a frame later it is where its velocity takes it."""
    before = {point[7]: point for point in one}
    after = {point[7]: point for point in other}
    both = before.keys() & after.keys()
    expect(len(both) > 0.8 * len(before), f"{len(both)} of {len(before)} drops live for a frame")
    astray = sum(1 for i in both
                 if any(not near(before[i][a] + before[i][3 + a] / FPS, after[i][a], 2e-3) for a in range(3)))
    expect(astray <= 0.001 * len(both), f"{astray} of {len(both)} drops are not where their velocity takes them")


def check_points(paths):
    frames = [read_points(path) for path in paths[:3]]
    if failures:
        return
    for path, points, seen in zip(paths, frames, paths[3:]):
        words = open(seen).read().split()
        ends = [value for point in (points[0], points[-1]) for value in point[:3]]
        expect(int(words[0]) == len(points), f"{path}: assimp sees {words[0]} points, expected {len(points)}")
        expect(all(near(float(a), b, 1e-6 * max(1, abs(b))) for a, b in zip(words[1:], ends)),
               f"{path}: assimp sees {words[1:]}, expected {ends}")
        expect(all(math.isfinite(value) for point in points for value in point), f"{path}: not finite")
        expect(len({point[7] for point in points}) == len(points), f"{path}: ids occur twice")
        expect(all(0.0001 <= point[6] <= 0.0034 for point in points), f"{path}: radius outside 0.1 to 3.4 mm")
        expect(all(point[8] >= 0 for point in points), f"{path}: negative age")
        check_speeds(path, points)
    check_motion(frames[0], frames[1])
    check_motion(frames[1], frames[2])


# ---- statistics and previews


def check_stats(paths):
    text = open(paths[0]).read()
    expect(text.endswith("\n"), "the last line has no end")
    lines = [json.loads(line) for line in text.splitlines()]
    expect([line.get("frame") for line in lines] == [1, 2, 3], f"frames {[line.get('frame') for line in lines]}")
    total = 0
    for i, line in enumerate(lines):
        rain, water, times = line["rain"], line["water_ul"], line["milliseconds"]
        total += water["rained"]
        expect(near(line["time_s"], i / FPS, 1e-9), f"time_s {line['time_s']}")
        expect(rain["rate_mm_h"] == 30 and rain["slots"] > 100000 and rain["streaks"] > 0, f"rain {rain}")
        expect(all(near(a, b) for a, b in zip(rain["wind_m_s"], WIND)), f"wind {rain['wind_m_s']}")
        expect(rain["impacts_dropped"] == 0, f"impacts dropped {rain['impacts_dropped']}")
        expect((rain["impacts"] > 0) == (water["rained"] > 0) == (i > 0), f"impacts {rain['impacts']}, {water}")
        expect(near(water["rained_total"], total, 1e-6 * (1 + total)), f"rained {total}, told {water['rained_total']}")
        left = sum(water[name] for name in ("elsewhere", "absorbed", "film", "puddle", "run_off", "evaporated", "kept",
                                            "forgotten"))
        expect(near(water["start"] + water["rained_total"], left, 0.0015), f"the budget of water is off: {water}")
        for name in ("rain.occlusion", "rain.step", "rain.prepare", "rain.haze", "rain.streaks", "rain.points"):
            expect(0 <= times.get(name, -1) < 60000, f"milliseconds of {name}: {times.get(name)}")
        expect(line["device_bytes"] > 0, "no device memory")


def check_previews(paths):
    for path in paths:
        data = open(path, "rb").read()
        expect(data[:8] == b"\x89PNG\r\n\x1a\n" and data[-8:-4] == b"IEND", f"{path} is no whole PNG")
        expect(struct.unpack(">II", data[16:24]) == SIZE, f"{path} is {struct.unpack('>II', data[16:24])}")


CHECKS = {"headers": check_headers, "pixels": check_pixels, "points": check_points, "stats": check_stats,
          "previews": check_previews}
CHECKS[sys.argv[1]](sys.argv[2:])
sys.exit(1 if failures else 0)

"""What the files of three frames of the street must hold. Standard library only; called by outputs.sh.

Usage: check_outputs.py headers|pixels|points|droplets|stats|previews FILE...
       check_outputs.py near FILE X Y Z
       check_outputs.py mapped POINTS STATS STATS_WITHOUT
       check_outputs.py drips STATS
       check_outputs.py long STATS
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

HALF = ["A", "B", "G", "R", "haze.A", "haze.B", "haze.G", "haze.R", "normal.X", "normal.Y", "normal.Z", "rain.A",
        "rain.B", "rain.G", "rain.R", "splash.A", "splash.B", "splash.G", "splash.R", "velocity.X", "velocity.Y"]
CHANNELS = dict([(name, "half") for name in HALF + ["wetness.Y"]] +
                [("Z", "float"), ("id.Y", "uint"), ("waterdepth.Y", "float")])

# Terminal speed by diameter, Gunn and Kinzer 1949 (mm: m/s).
SPEEDS = [(0.2, 0.72), (0.3, 1.17), (0.4, 1.62), (0.5, 2.06), (0.6, 2.47), (0.8, 3.27), (1.0, 4.03), (1.2, 4.64),
          (1.4, 5.17), (1.6, 5.65), (1.8, 6.09), (2.0, 6.49), (2.4, 7.27), (2.8, 7.82), (3.2, 8.26), (3.6, 8.60),
          (4.0, 8.83), (4.4, 8.98), (4.8, 9.07), (5.2, 9.12), (5.8, 9.17)]

# What point caches have behind x y z vx vy vz radius id age.
DROP = [("float", "weight")]
DROPLET = [("uint", name) for name in "model material state parent index".split()] + [("float", "water_ul")]

MATERIALS = ("default asphalt concrete stone brick grass sand soil wood metal glass water leaves cloth plastic tile "
             "drain").split()

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
    """Its position is the origin of the first frame, and what it looks at lies straight ahead, along -Z."""
    distance = math.dist(CAMERA, TARGET)
    for point, position in ((CAMERA, (0, 0, 0, 1)), (TARGET, (0, 0, -distance, 1))):
        seen = transform(matrix, point)
        expect(all(near(a, b, 1e-3) for a, b in zip(seen, position)), f"worldToCamera takes {point} to {seen}")


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
    version = open(paths[3]).readline().strip()
    frames = [check_header(open(path).read(), i + 1, version) for i, path in enumerate(paths[:3])]
    if None in frames:
        return
    check_camera([float(word) for word in re.findall(r"[-+.\de]+", frames[0]["worldToCamera"])])
    expect(len({frame["sceneHash"] for frame in frames}) == 1, "the frames have different scene hashes")
    expect(len({frame["worldToCamera"] for frame in frames}) == 3, "the camera does not move")


def check_moving(paths):
    """With the velocity of water: the plate moves by less than 2 pixels a frame, rain falls by a quarter of a metre."""
    text = open(paths[0]).read()
    max_pixels = [float(word) for word in re.search("Stats Max: ([^(\n]*)", text)[1].split()]
    expect("velocity.X, velocity.Y" in text, "there are other channels than velocity.X and velocity.Y")
    expect("waterVelocity: 1" in text, "the frame does not say that it has the velocity of water")
    expect(3 < max_pixels[1] < 1000, f"rain falls by {max_pixels[1]} pixels a frame")


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
        # Nothing has fallen at the first frame.
        expect(of["splash.A"]["Min"] == 0 and of["splash.A"]["Max"] <= 1 and
               (of["splash.A"]["Max"] > 0.01) == (number > 1), f"frame {number}: splash.A {of['splash.A']}")
        for name in "RGB":
            expect(of["splash." + name]["Min"] == 0 and (of["splash." + name]["Max"] > 0.001) == (number > 1),
                   f"frame {number}: splash.{name} {of['splash.' + name]}")
        expect(1 < of["Z"]["Min"] < 20, f"frame {number}: nearest depth {of['Z']['Min']}")
        moved = max(of["velocity.X"]["Max"], -of["velocity.X"]["Min"])
        # A dolly of 2.5 cm a frame moves what is 4 m away at the edge by half a pixel. At the first frame it begins.
        expect(moved < 0.01 if number == 1 else 0.1 < moved < 2, f"frame {number}: velocity up to {moved} pixels")


# ---- points


def read_points(path, more):
    data = open(path, "rb").read()
    head, mark, body = data.partition(b"end_header\n")
    lines = [line for line in head.decode("ascii").split("\n") if line and not line.startswith("comment")]
    expect(mark and lines[:2] == ["ply", "format binary_little_endian 1.0"], f"{path}: begins with {lines[:2]}")
    count = int(lines[2].split()[2]) if lines[2].startswith("element vertex ") else -1
    properties = [tuple(line.split()[1:]) for line in lines[3:]]
    wanted = [("float", name) for name in "x y z vx vy vz radius".split()] + [("uint", "id"), ("float", "age")]
    expect(properties == wanted + more, f"{path}: properties {properties}")
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


def check_seen(path, points, seen):
    """What another reader has found: how many, the first and the last."""
    words = open(seen).read().split()
    ends = [value for point in (points[0], points[-1]) for value in point[:3]]
    expect(int(words[0]) == len(points), f"{path}: assimp sees {words[0]} points, expected {len(points)}")
    expect(all(near(float(a), b, 1e-6 * max(1, abs(b))) for a, b in zip(words[1:], ends)),
           f"{path}: assimp sees {words[1:]}, expected {ends}")


def check_points(paths):
    frames = [read_points(path, DROP) for path in paths[:3]]
    if failures:
        return
    for path, points, seen in zip(paths, frames, paths[3:]):
        check_seen(path, points, seen)
        expect(all(math.isfinite(value) for point in points for value in point), f"{path}: not finite")
        expect(len({point[7] for point in points}) == len(points), f"{path}: ids occur twice")
        expect(all(0.0001 <= point[6] <= 0.0034 for point in points), f"{path}: radius outside 0.1 to 3.4 mm")
        expect(all(point[8] >= 0 for point in points), f"{path}: negative age")
        check_speeds(path, points)
    check_motion(frames[0], frames[1])
    check_motion(frames[1], frames[2])


# ---- droplets

X, V, RADIUS, ID, AGE, MODEL, MATERIAL, STATE, PARENT, INDEX, WATER = 0, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14


def absorb(state, word):
    """virga_hash_absorb of shaders/shared/random.h."""
    x = (word + state) & 0xffffffff
    x = (x ^ x >> 17) * 0xed5ad4bb & 0xffffffff
    x = x + state * 0x9e3779b1 & 0xffffffff
    x = (x ^ x >> 11) * 0xac4c1b51 & 0xffffffff
    x = (x ^ x >> 15) * 0x31848bab & 0xffffffff
    return x ^ x >> 14


def hash2(a, b):
    return absorb(absorb(0x9e3779b9, a), b)


def check_droplet(path, d, age):
    kinds = d[MODEL], d[MATERIAL], d[STATE], d[INDEX]
    expect(d[MODEL] in (1, 2) and d[MATERIAL] < 17 and d[STATE] < 6, f"{path}: kinds {kinds}")
    # Up to 32 splashes of a drop that stands for many, 64 droplets each.
    expect(d[INDEX] % 256 < 64 and d[INDEX] < 32 * 256, f"{path}: droplet {d[INDEX]} of {d[PARENT]}")
    expect(d[ID] == hash2(d[PARENT], d[INDEX]), f"{path}: id {d[ID]} of droplet {d[INDEX]} of {d[PARENT]}")
    expect(0 <= d[AGE] <= age + 1e-6, f"{path}: age {d[AGE]} at {age} s")
    expect(0.00001 < d[RADIUS] < 0.002 and d[WATER] > 0, f"{path}: radius {d[RADIUS]}, water {d[WATER]}")
    expect(math.dist(d[V:V + 3], (0, 0, 0)) < 10 and -2 < d[X + 1] < 40, f"{path}: at {d[:3]}, velocity {d[3:6]}")


def check_water(path, points):
    """A point stands for as many droplets as its water fills: the same for all of a drop."""
    filled = {}
    for d in points:
        filled.setdefault(d[PARENT], []).append(d[WATER] * 1e-9 / (4 / 3 * math.pi * d[RADIUS] ** 3))
    for parent, counts in filled.items():
        expect(max(counts) < 1.0001 * min(counts), f"{path}: droplets of {parent} stand for {counts}")
        expect(min(counts) > 0.0009 and max(counts) < 1000, f"{path}: droplets of {parent} stand for {counts}")


def check_parents(path, points, before, now):
    """Drops that were in the air in a frame before, and are no more."""
    falling, fell = {point[ID] for point in now}, {point[ID] for points in before for point in points}
    expect(not any(d[PARENT] in falling for d in points), f"{path}: droplets of drops that have not landed")
    known = sum(d[PARENT] in fell for d in points)
    expect(len(points) > 1000 and known > 0.99 * len(points), f"{path}: {known} of {len(points)} have a drop that fell")


def check_flight(one, other):
    """Drag and gravity in a frame are less than a few centimetres."""
    sides = [{d[ID]: d for d in points} for points in (one, other)]
    both = sides[0].keys() & sides[1].keys()
    pairs = [(sides[0][i], sides[1][i]) for i in both if near(sides[1][i][AGE] - sides[0][i][AGE], 1 / FPS, 1e-5)]
    astray = sum(any(not near(b[X + i] - a[X + i], (a[V + i] + b[V + i]) / 2 / FPS, 0.02) for i in range(3))
                 for a, b in pairs)
    expect(len(pairs) > 200, f"{len(pairs)} droplets live for a frame")
    expect(astray <= 0.01 * len(pairs), f"{astray} of {len(pairs)} droplets are not where they fly to")


def check_droplets(paths):
    """Point caches of three frames, what assimp sees in the last two, those of the drops, and the statistics."""
    frames = [read_points(path, DROPLET) for path in paths[:3]]
    falling = [read_points(path, DROP) for path in paths[5:8]]
    lines = [json.loads(line) for line in open(paths[8])]
    if failures:
        return
    expect(not frames[0], f"{paths[0]}: {len(frames[0])} droplets before any rain has fallen")
    for i in (1, 2):
        path, points, splash = paths[i], frames[i], lines[i]["splash"]
        check_seen(path, points, paths[2 + i])
        for droplet in points:
            check_droplet(path, droplet, i / FPS)
        expect(len({droplet[ID] for droplet in points}) == len(points), f"{path}: ids occur twice")
        check_water(path, points)
        check_parents(path, points, falling[:i], falling[i])
        living = splash["droplets"] - splash["fallen"]
        # Of a far drop that stands for many, some splash later: those are not yet there.
        expect(0.1 * living <= len(points) <= living, f"{path}: {len(points)} droplets, the statistics have {living}")
        water, in_air = sum(d[WATER] for d in points), lines[i]["water_ul"]["in_air"]
        expect(0 < water < in_air * 1.0001, f"{path}: droplets of {water} microlitres, {in_air} in the air")
    if not failures:
        check_flight(frames[1], frames[2])


def check_near(arguments):
    """Only what is near the camera has droplets."""
    points, camera = read_points(arguments[0], DROPLET), [float(word) for word in arguments[1:]]
    expect(len(points) > 200, f"{len(points)} droplets")
    expect(all(math.dist(d[X:X + 3], camera) < 5 for d in points), f"droplets far from the camera at {camera}")


def check_mapped(paths):
    """A picture of 2 x 2 texels whose middle lies at the camera: what splashes comes from the material it says."""
    points, lines, without = read_points(paths[0], DROPLET), open(paths[1]).readlines(), open(paths[2]).readlines()
    quarters = {}
    for d in points:
        x, z = d[X] - CAMERA[0], d[X + 2] - CAMERA[2]
        if min(abs(x), abs(z)) > 0.3:  # droplets have flown from where the drop fell
            quarters.setdefault((x > 0, z > 0), []).append(MATERIALS[d[MATERIAL]])
    expect(len(quarters) == 4 and min(map(len, quarters.values())) > 20, f"{[len(q) for q in quarters.values()]}")
    for (right, behind), names in quarters.items():
        wanted = {(False, False): "metal", (True, True): "tile"}.get((right, behind))
        strange = [name for name in names if (name != wanted if wanted else name in ("metal", "tile"))]
        expect(not strange, f"right {right}, behind {behind}: {strange[:5]}, expected {wanted or 'those of meshes'}")
    counted, before = ({name: sum(of.get(name, 0) for of in json.loads(line)["splash"]["splashes"].values())
                     for name in MATERIALS} for line in (lines[-1], without[-1]))
    for name in ("metal", "tile"):
        expect(counted[name] > before[name] + 100, f"{counted[name]} splashes on {name}, without a map {before[name]}")


# ---- statistics and previews

BUDGET = ("off_ground", "absorbed", "film", "puddle", "run_off", "evaporated", "cached", "evicted", "in_air")


def nanolitres(microlitres):
    return round(microlitres * 1000)


def check_splash_stats(splash, before):
    models = splash["splashes"]
    expect(list(models) == ["scattering", "crown_cone", "disk", "dot"], f"models {list(models)}")
    for model, counts in models.items():
        expect(all(name in MATERIALS and count > 0 for name, count in counts.items()), f"{model}: {counts}")
        for name, count in before["splashes"][model].items() if before else ():
            expect(counts.get(name, 0) >= count, f"{model} on {name}: {counts.get(name)} after {count}")
    total = sum(sum(counts.values()) for counts in models.values())
    expect((total > 0) == (splash["droplets"] > 0) == (before is not None), f"{total} splashes: {splash}")
    expect(splash["fallen"] <= splash["droplets"] and splash["splashes_alive"] <= total, f"splash {splash}")
    expect(splash["droplets"] - splash["fallen"] <= splash["droplets_alive"] <= splash["droplets"], f"splash {splash}")
    expect(splash["splashes_without_droplets"] <= total and (splash["sprites"] > 0) == (total > 0), f"splash {splash}")


def check_stats(paths):
    text = open(paths[0]).read()
    expect(text.endswith("\n"), "the last line has no end")
    lines = [json.loads(line) for line in text.splitlines()]
    expect([line.get("frame") for line in lines] == [1, 2, 3], f"frames {[line.get('frame') for line in lines]}")
    total, splash = 0, None
    for i, line in enumerate(lines):
        rain, water, times = line["rain"], line["water_ul"], line["milliseconds"]
        total += water["rained"]
        expect(near(line["time_s"], i / FPS, 1e-9), f"time_s {line['time_s']}")
        expect(rain["rate_mm_h"] == 30 and rain["slots"] > 100000 and rain["streaks"] > 0, f"rain {rain}")
        expect(all(near(a, b) for a, b in zip(rain["wind_m_s"], WIND)), f"wind {rain['wind_m_s']}")
        expect(rain["impacts_dropped"] == 0, f"impacts dropped {rain['impacts_dropped']}")
        expect((rain["impacts"] > 0) == (water["rained"] > 0) == (i > 0), f"impacts {rain['impacts']}, {water}")
        expect(near(water["rained_total"], total, 1e-6 * (1 + total)), 
               f"rained {total}, the statistics have {water['rained_total']}")
        off = nanolitres(water["start"]) + nanolitres(water["rained_total"]) - sum(nanolitres(water[name])
                                                                                   for name in BUDGET)
        expect(off == 0, f"the budget of water is off by {off} nl: {water}")
        expect((water["in_air"] > 0) == (i > 0), f"frame {i + 1}: {water['in_air']} microlitres in the air")
        check_splash_stats(line["splash"], splash)
        splash = line["splash"]
        for name in ("rain.step", "rain.prepare", "rain.points"):
            expect(0 <= times.get(name, -1) < 60000, f"milliseconds of {name}: {times.get(name)}")
        # Software Vulkan draws after its timestamps, and the first frame alone brings a whole window.
        expect("rain.streaks" not in times, "a draw has a time that it does not take")
        expect(i == 0 or "ground.window" not in times, "a pass that was not recorded has a time")
        expect(line["device_bytes"] > 0, "no device memory")


def check_previews(paths):
    for path in paths:
        data = open(path, "rb").read()
        expect(data[:8] == b"\x89PNG\r\n\x1a\n" and data[-8:-4] == b"IEND", f"{path} is no whole PNG")
        expect(struct.unpack(">II", data[16:24]) == SIZE, f"{path} is {struct.unpack('>II', data[16:24])}")


def check_drips(paths):
    drips = [json.loads(line)["splash"]["drips"] for line in open(paths[0])][-1]
    expect(drips["drops"] > 20, f"{drips['drops']} drops fell")
    accounted = drips["fell_ul"] + drips["on_surfaces_ul"] + drips["left_ul"]
    expect(near(drips["rain_ul"], accounted, 1e-3), f"water of drips: {drips}")
    mean_ul = drips["fell_ul"] / max(drips["drops"], 1)
    expect(14.1 < mean_ul < 65.5, f"drops of {mean_ul:.1f} ul, not of 3 to 5 mm")


def check_long(paths):
    splash = [json.loads(line)["splash"] for line in open(paths[0])][-1]
    expect(splash["fallen"] > 131072, f"{splash['fallen']} droplets landed")
    expect(splash["droplets_held"] == 0, f"{splash['droplets_held']} droplets waited in the air")


CHECKS = {"headers": check_headers, "pixels": check_pixels, "moving": check_moving, "points": check_points,
          "droplets": check_droplets,
          "near": check_near, "mapped": check_mapped, "stats": check_stats, "previews": check_previews,
          "drips": check_drips, "long": check_long}
CHECKS[sys.argv[1]](sys.argv[2:])
sys.exit(1 if failures else 0)

"""Checks a COCO file of virga dataset: the fields of the format; and boxes against mask and layer.
Usage: check_coco.py COCO FOLDER NAME...: FOLDER/STEM.alpha and STEM.mask are dumps of rain.A and of the mask."""
import json
import math
import re
import sys

coco, folder = json.load(open(sys.argv[1])), sys.argv[2]
faults = []


def need(right, what):
    if not right and len(faults) < 10:
        faults.append(what)
        print("FAILED:", what)


def values(name):
    return [float(text) for text in re.findall(r"\): (\S+)", open("%s/%s" % (folder, name)).read())]


# ---- the format
need(list(coco) == ["info", "licenses", "images", "annotations", "categories"], "parts: %s" % list(coco))
need(all(type(coco["info"][key]) is str for key in ("version", "description")), "info")
need([c["id"] for c in coco["categories"]] == [1] and type(coco["categories"][0]["name"]) is str, "categories")
images = {image["id"]: image for image in coco["images"]}
need(len(images) == len(coco["images"]) == 3, "images: %s" % sorted(images))
need([a["id"] for a in coco["annotations"]] == list(range(1, len(coco["annotations"]) + 1)), "numbers of annotations")
for image in coco["images"]:
    need(type(image["width"]) is int and type(image["height"]) is int and type(image["file_name"]) is str, "an image")
for a in coco["annotations"]:
    image, (left, top, width, height) = images[a["image_id"]], a["bbox"]
    (outline,) = a["segmentation"]
    xs, ys = outline[::2], outline[1::2]
    need(len(xs) == len(ys) >= 3 and a["iscrowd"] == 0 and a["category_id"] == 1, "annotation %d" % a["id"])
    need(min(xs) >= 0 and min(ys) >= 0 and max(xs) <= image["width"] and max(ys) <= image["height"],
         "outline %d leaves the picture" % a["id"])
    need(abs(left - min(xs)) < 0.02 and abs(left + width - max(xs)) < 0.02 and abs(top - min(ys)) < 0.02 and
         abs(top + height - max(ys)) < 0.02, "box %d is not that of its outline" % a["id"])
    area = 0.5 * abs(sum(xs[i - 1] * ys[i] - xs[i] * ys[i - 1] for i in range(len(xs))))
    need(abs(area - a["area"]) < 0.02 * area + 0.2, "area %d: %g, expected %g" % (a["id"], a["area"], area))
    need(0.2 < a["virga"]["diameter_mm"] < 6.8 and 0.01 <= a["virga"]["coverage"] <= 1, "drop of %d" % a["id"])


# ---- against the pictures
def distance(outline, x, y):
    """Of a point from a convex outline; 0 inside."""
    corners = list(zip(outline[::2], outline[1::2]))
    sides, nearest = set(), math.inf
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
        dx, dy = bx - ax, by - ay
        sides.add((dx * (y - ay) - dy * (x - ax) > 0))
        along = max(0, min(1, ((x - ax) * dx + (y - ay) * dy) / max(dx * dx + dy * dy, 1e-9)))
        nearest = min(nearest, math.hypot(x - ax - along * dx, y - ay - along * dy))
    return 0 if len(sides) == 1 else nearest


for name in sys.argv[3:]:
    stem = name.rsplit(".", 1)[0]
    (image,) = (image for image in coco["images"] if image["file_name"] == name)
    boxes = [a for a in coco["annotations"] if a["image_id"] == image["id"]]
    width, height = image["width"], image["height"]
    alpha, mask = values(stem + ".alpha"), values(stem + ".mask")
    need(len(alpha) == len(mask) == width * height, "%s: sizes" % name)
    # The layer has half floats.
    need(all((m > 0) == (a >= 0.01) or abs(a - 0.01) < 1e-5 for a, m in zip(alpha, mask)),
         "%s: the mask is not that of the layer" % name)
    shown = [(i % width + 0.5, i // width + 0.5, alpha[i]) for i in range(width * height) if mask[i] > 0]
    # Pixels that only several weak streaks together cover have no box.
    near = {}  # outlines by pixel
    for a in boxes:
        left, top, across, down = a["bbox"]
        for y in range(int(top) - 2, int(top + down) + 3):
            for x in range(int(left) - 2, int(left + across) + 3):
                near.setdefault((x, y), []).append(a["segmentation"][0])


    def beside(x, y):
        return min((distance(outline, x, y) for outline in near.get((int(x), int(y)), [])), default=9)

    free = [p for p in shown if beside(p[0], p[1]) > 1]
    covered = 0
    for a in boxes:
        own = a["virga"]
        # Across it coverage is the chord of a circle; along it, it rises and falls over ramps as long as the drop.
        body = 0.9e-3 * own["diameter_mm"] / own["distance_m"] * image["virga"]["focal_px"][1]
        path = own["length_px"] - body
        covered += a["area"] * own["coverage"] * math.pi / 4 * max(path, body) / (path + body)
    has = sum(a for i, a in enumerate(alpha) if beside(i % width + 0.5, i // width + 0.5) < 1)
    hidden = [a for a in boxes if a["bbox"][0] + a["bbox"][2] < 0.49 * width and a["virga"]["distance_m"] > 3.5]
    print("%s: %d boxes, %d pixels of streaks, %d beside all boxes; coverage %.1f px, boxes say %.1f" %
          (name, len(boxes), len(shown), len(free), has, covered))
    need(len(boxes) > 30, "%s: too few boxes" % name)
    need(len(free) <= 0.03 * len(shown), "%s: streaks without a box" % name)
    need(0.85 < covered / has < 1.1, "%s: coverage" % name)
    need(not hidden, "%s: a streak behind the picture has a box" % name)
sys.exit(len(faults) > 0)

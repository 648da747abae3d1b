#!/usr/bin/env python3
"""Measures drops on glass on a picture that is in focus on the glass: a photograph or a render, by the same rules.

usage: assets/measure_drops.py PICTURE...    each gives one row. Pictures are scaled to 240 rows first, as small
                                             photographs and large renders have other details.

A drop is what differs from the mean of a window around it, which is what is behind the glass, out of focus. Its
dark rim and its light parts are one drop where they touch. All levels are display codes from 0 to 255.

Printed for each picture: drops for an area as large as the picture's height squared; the share of the picture that they
cover; the diameter of a disc of a drop's area, in hundredths of the picture's height (median, and what a tenth
exceeds);
how many times longer than wide they are (median, and what a tenth exceeds); contrast, the deviation of a drop from what
is around it (median, and what a tenth exceeds); and in how many of those that are 5 pixels high or more the lower half
is the lighter one. Needs ffmpeg, which reads the pictures.
"""
import math
import subprocess
import sys

import measure_streaks

ROWS = 240
WINDOW = 20     # pixels from the middle of the window to its side
APART = 14      # codes that a drop differs from the mean of the window
SMALLEST = 4    # pixels


def load(path):
    width, height, _ = measure_streaks.load(path)
    width = round(width * ROWS / height)
    gray = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-vf", "scale=%d:%d:flags=area" % (width, ROWS), "-f",
                           "rawvideo", "-pix_fmt", "gray", "-"], capture_output=True, check=True).stdout
    return width, [gray[y * width:(y + 1) * width] for y in range(ROWS)]


def means(rows, width):
    """The mean of the window around each pixel, by sums over rectangles from the corner."""
    sums = [[0] * (width + 1)]
    for row in rows:
        along, line = 0, [0]
        for x, level in enumerate(row):
            along += level
            line.append(along + sums[-1][x + 1])
        sums.append(line)
    out = []
    for y in range(ROWS):
        low, high = max(y - WINDOW, 0), min(y + WINDOW + 1, ROWS)
        line = []
        for x in range(width):
            left, right = max(x - WINDOW, 0), min(x + WINDOW + 1, width)
            total = sums[high][right] - sums[high][left] - sums[low][right] + sums[low][left]
            line.append(total / ((high - low) * (right - left)))
        out.append(line)
    return out


def is_light_below(region, rows, width):
    """None if it is not high enough to say."""
    middle = sum(at // width for at in region) / len(region)
    halves = [[rows[at // width][at % width] for at in region if (at // width > middle) == below] for below in (0, 1)]
    if max(region) // width - min(region) // width < 4 or not all(halves):
        return None
    return sum(halves[1]) / len(halves[1]) > sum(halves[0]) / len(halves[0])


def measure(rows):
    """Drops as (diameter, length over width, contrast, area) in pixels, and for each high one whether it is lighter
    below."""
    width = len(rows[0])
    ground = means(rows, width)
    over = {y * width + x for y in range(ROWS) for x in range(width) if abs(rows[y][x] - ground[y][x]) >= APART}
    found, below = [], []
    for region in measure_streaks.regions(sorted(over), over, width, ROWS):
        if len(region) < SMALLEST:
            continue
        length, wide = measure_streaks.shape(region, width)
        apart = [rows[at // width][at % width] - ground[at // width][at % width] for at in region]
        found.append((2 * math.sqrt(len(region) / math.pi), length / wide,
                      math.sqrt(sum(a * a for a in apart) / len(apart)), len(region)))
        side = is_light_below(region, rows, width)
        below += [] if side is None else [side]
    return found, below


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__.strip())
    print("| picture | drops | covered | diameter | longer than wide | contrast | lighter below |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for path in sys.argv[1:]:
        width, rows = load(path)
        found, below = measure(rows)
        if not found:
            sys.exit("measure_drops.py: %s: nothing differs by %d codes from what is around it" % (path, APART))
        diameter, slender, contrast, area = zip(*found)
        pairs = [(measure_streaks.part(v, 0.5), measure_streaks.part(v, 0.9)) for v in
                 ([100 * d / ROWS for d in diameter], slender, contrast)]
        print("| %s | %.0f | %.1f %% | %s | %s | %s | %s |" %
              (path.split("/")[-1], len(found) * ROWS / width, 100 * sum(area) / (width * ROWS),
               *("%.1f, %.1f" % pair for pair in pairs), "%.0f %%" % (100 * sum(below) / len(below)) if below else "-"))


if __name__ == "__main__":
    main()

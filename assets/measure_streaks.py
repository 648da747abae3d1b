#!/usr/bin/env python3
"""Measures the streaks of rain on pictures of a sequence: photographs or renders, by the same rules.

usage: assets/measure_streaks.py FRAME FRAME FRAME...    three or more pictures of a sequence, in their order; of one
                                                         size. The camera may shake by a few pixels.

A streak is what is brighter on one picture than on the one before and the one after, wherever those show the place or
what is one pixel beside it: so edges that shake are none. It grows over what is brighter than the middle one of the
three pictures. All levels are display codes from 0 to 255. What is rounder than twice as long as wide, or smaller than
SMALLEST pixels, is no streak: a splash, or noise.

Printed by how bright the background is: streaks in a million pixels, the share of pixels that they cover, width and
length in pixels (median, and what a tenth exceeds), and contrast: how many codes they are brighter than what is behind
them, in the mean over a streak (median, and what a tenth exceeds). Needs ffmpeg and ffprobe, which read the pictures.
"""
import math
import subprocess
import sys

SEED = 7        # codes by which a streak's brightest pixel exceeds all that was there before and after
GROWN = 4       # codes over the middle one of three pictures that its other pixels need
SMALLEST = 6    # pixels
SLENDER = 2.0   # length over width
SHAKE = 4       # pixels that the camera may move from picture to picture
BANDS = ((0, 64, "dark, 0 to 63"), (64, 128, "64 to 127"), (128, 192, "128 to 191"), (192, 256, "light, 192 to 255"))


def load(path):
    """Luma of a picture: (width, height, rows)."""
    probe = subprocess.run(["ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", "stream=width,height",
                            "-of", "csv=p=0", path], capture_output=True, text=True)
    if probe.returncode != 0:
        sys.exit("measure_streaks.py: %s: is no picture that ffmpeg reads" % path)
    width, height = (int(n) for n in probe.stdout.strip().split(",")[:2])
    gray = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "gray", "-"],
                          capture_output=True, check=True).stdout
    return width, height, [gray[y * width:(y + 1) * width] for y in range(height)]


def shift_between(rows, other):
    """Whole pixels (x, y) by which `other` is displaced: where every seventh row differs least, and the fewest."""
    width, height = len(rows[0]), len(rows)
    best = None
    for dy in range(-SHAKE, SHAKE + 1):
        for dx in range(-SHAKE, SHAKE + 1):
            total = 0
            for y in range(SHAKE, height - SHAKE, 7):
                a, b = rows[y][SHAKE:width - SHAKE], other[y + dy][SHAKE + dx:width - SHAKE + dx]
                total += sum(map(abs, map(int.__sub__, a, b)))
            if best is None or (total, abs(dx) + abs(dy)) < best[0]:
                best = ((total, abs(dx) + abs(dy)), dx, dy)
    return best[1], best[2]


def shifted(rows, dx, dy):
    """The picture moved back by that many pixels; its edge is repeated."""
    width, height = len(rows[0]), len(rows)
    columns = [min(max(x + dx, 0), width - 1) for x in range(width)]
    return [bytes(map(rows[min(max(y + dy, 0), height - 1)].__getitem__, columns)) for y in range(height)]


def widened(rows):
    """The brightest of the nine pixels around each."""
    flat = [bytes(map(max, row, row[:1] + row[:-1], row[1:] + row[-1:])) for row in rows]
    return [bytes(map(max, row, flat[max(y - 1, 0)], flat[min(y + 1, len(flat) - 1)])) for y, row in enumerate(flat)]


def middle(a, b, c):
    return max(min(a, b), min(max(a, b), c))


def regions(seeds, over, width, height):
    """Connected pixels of `over` (a set of places y * width + x) that hold a seed."""
    left = set(over)
    for seed in seeds:
        if seed not in left:
            continue
        left.discard(seed)
        region, open_ends = [], [seed]
        while open_ends:
            at = open_ends.pop()
            region.append(at)
            x = at % width
            for dy in (-width, 0, width):
                for dx in (-1, 0, 1):
                    near = at + dy + dx
                    if 0 <= x + dx < width and near in left:
                        left.discard(near)
                        open_ends.append(near)
        yield region


def shape(region, width):
    """Length along the principal axis and width across it, in pixels; both of a bar of this area and moment."""
    n = len(region)
    xs, ys = [at % width for at in region], [at // width for at in region]
    mx, my = sum(xs) / n, sum(ys) / n
    xx = sum((x - mx) ** 2 for x in xs) / n + 1 / 12
    yy = sum((y - my) ** 2 for y in ys) / n + 1 / 12
    xy = sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / n
    most = 0.5 * (xx + yy) + math.sqrt(0.25 * (xx - yy) ** 2 + xy * xy)
    length = math.sqrt(12 * most) # a bar's variance along itself is a twelfth of its length squared
    return length, n / length


def measure(before, rows, after):
    """Streaks of a picture as (background, width, length, contrast), and pixels by band of background."""
    width, height = len(rows[0]), len(rows)
    before = shifted(before, *shift_between(rows, before))
    after = shifted(after, *shift_between(rows, after))
    most = [bytes(map(max, a, b)) for a, b in zip(widened(before), widened(after))]
    ground = [bytes(map(middle, a, b, c)) for a, b, c in zip(before, rows, after)]
    counts = [0] * 256
    seeds, over = [], set()
    for y in range(SHAKE, height - SHAKE):
        row, low, high, base = rows[y], ground[y], most[y], y * width
        for level in low:
            counts[level] += 1
        over.update(base + x for x in range(SHAKE, width - SHAKE) if row[x] >= low[x] + GROWN)
        seeds += [base + x for x in range(SHAKE, width - SHAKE) if row[x] >= high[x] + SEED]
    found = []
    for region in regions(seeds, over, width, height):
        length, wide = shape(region, width)
        if len(region) < SMALLEST or length < SLENDER * wide:
            continue
        behind = sum(ground[at // width][at % width] for at in region) / len(region)
        here = sum(rows[at // width][at % width] for at in region) / len(region)
        found.append((behind, wide, length, here - behind))
    return found, [sum(counts[low:high]) for low, high, _ in BANDS]


def part(values, share):
    values = sorted(values)
    return values[min(int(share * len(values)), len(values) - 1)]


def print_table(streaks, pixels):
    print("| background | share of the picture | streaks / megapixel | covered | width px | length px | contrast |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for band, (low, high, name) in enumerate(BANDS):
        here = [s for s in streaks if low <= s[0] < high]
        share = 100 * pixels[band] / max(sum(pixels), 1)
        if len(here) < 5:
            print("| %s | %.0f %% | %s |" % (name, share, " | ".join(["too few" if here else "none"] + ["-"] * 4)))
            continue
        covered = 100 * sum(s[1] * s[2] for s in here) / max(pixels[band], 1)
        pairs = ["%.1f, %.1f" % (part([s[i] for s in here], 0.5), part([s[i] for s in here], 0.9)) for i in (1, 2, 3)]
        print("| %s | %.0f %% | %.0f | %.2f %% | %s |" %
              (name, share, 1e6 * len(here) / pixels[band], covered, " | ".join(pairs)))


def main():
    paths = sys.argv[1:]
    if paths in (["-h"], ["--help"]):
        print(__doc__.strip())
        return
    if len(paths) < 3:
        sys.exit("measure_streaks.py: give three or more pictures of a sequence, in their order (see --help)")
    pictures = [load(path) for path in paths]
    sizes = {picture[:2] for picture in pictures}
    if len(sizes) > 1:
        sys.exit("measure_streaks.py: pictures of %s; they must have one size" %
                 " and ".join("%d x %d" % size for size in sorted(sizes)))
    streaks, pixels = [], [0] * len(BANDS)
    for before, here, after in zip(pictures, pictures[1:], pictures[2:]):
        found, counts = measure(before[2], here[2], after[2])
        streaks += found
        pixels = [a + b for a, b in zip(pixels, counts)]
    print_table(streaks, pixels)


if __name__ == "__main__":
    main()

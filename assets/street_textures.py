"""Procedural tileable textures for the street, as small palette PNGs; Python standard library only."""
import math
import random
import struct
import zlib


def noise(size, cells, seed, octaves=4, gain=0.5, stretch=1):
    """Tileable value noise in [0; 1], row by row; stretch > 1 makes features that much longer downwards."""
    total, weight, scale = [0.0] * (size * size), 0.0, 1.0
    for octave in range(octaves):
        cx = cells << octave
        cy = max(1, cx // stretch)
        if cx > size:
            break
        rng = random.Random(seed * 131 + octave)
        grid = [[rng.random() for _ in range(cx)] for _ in range(cy)]
        ramp = []
        for x in range(size):
            f = x * cx / size
            t = f - int(f)
            ramp.append((int(f), (int(f) + 1) % cx, t * t * (3 - 2 * t)))
        wide = [[r[a] + (r[b] - r[a]) * t for a, b, t in ramp] for r in grid]
        for y in range(size):
            f = y * cy / size
            t = f - int(f)
            t = t * t * (3 - 2 * t)
            upper, lower = wide[int(f)], wide[(int(f) + 1) % cy]
            row = y * size
            for x in range(size):
                total[row + x] += scale * (upper[x] + (lower[x] - upper[x]) * t)
        weight += scale
        scale *= gain
    return [v / weight for v in total]


def clamp_byte(v):
    return 0 if v < 0 else 255 if v > 255 else int(v + 0.5)


def palette_of(pixels, count):
    """Median cut: splits the box of colours with the widest weighted side until there are count boxes."""
    histogram = {}
    for p in pixels:
        histogram[p] = histogram.get(p, 0) + 1
    boxes = [list(histogram.items())]

    def spread(box):
        sides = [max(c[k] for c, _ in box) - min(c[k] for c, _ in box) for k in range(3)]
        axis = sides.index(max(sides))
        return sides[axis] * math.sqrt(sum(n for _, n in box)) if len(box) > 1 else -1.0, axis

    scores = [spread(boxes[0])]
    while len(boxes) < count and max(s for s, _ in scores) > 0:
        i = max(range(len(boxes)), key=lambda k: scores[k][0])
        box, axis = boxes[i], scores[i][1]
        box.sort(key=lambda e: e[0][axis])
        half, seen, cut = sum(n for _, n in box) / 2, 0, 1
        for cut in range(1, len(box)):
            seen += box[cut - 1][1]
            if seen >= half:
                break
        boxes[i:i + 1] = [box[:cut], box[cut:]]
        scores[i:i + 1] = [spread(box[:cut]), spread(box[cut:])]
    colours, index = [], {}
    for i, box in enumerate(boxes):
        n = sum(c for _, c in box)
        colours.append(tuple(clamp_byte(sum(p[k] * c for p, c in box) / n) for k in range(3)))
        for p, _ in box:
            index[p] = i
    return colours, index


def png(width, height, pixels, colours=32):
    """A palette PNG of the given float RGB pixels; 16 colours or fewer are packed two to a byte."""
    snapped = [tuple(clamp_byte(c) & 0xFE for c in p) for p in pixels]
    table, index = palette_of(snapped, colours)
    depth = 4 if len(table) <= 16 else 8
    raw = bytearray()
    for y in range(height):
        line = [index[p] for p in snapped[y * width:(y + 1) * width]]
        raw.append(0)
        raw += bytes(line) if depth == 8 else bytes((line[i] << 4) | line[i + 1] for i in range(0, width, 2))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, depth, 3, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", b"".join(bytes(c) for c in table))
            + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b""))


def asphalt(size=512):
    """4 m of old road: binder, light and dark aggregate, wheel polish, cracks that were partly sealed."""
    rng = random.Random(11)
    broad, fine = noise(size, 4, 1, 5, 0.6), noise(size, 96, 2, 2, 0.7)
    value = []
    for b, f in zip(broad, fine):
        grain = rng.gauss(0.0, 6.0)
        stone = 26.0 if rng.random() < 0.035 else -18.0 if rng.random() < 0.05 else 0.0
        value.append(74.0 + (b - 0.5) * 44.0 + (f - 0.5) * 34.0 + grain + stone)
    for _ in range(5):
        x, y, heading = rng.random() * size, rng.random() * size, rng.random() * 6.28
        drift = heading
        for _ in range(rng.randint(120, 330)):
            heading += rng.gauss(0.0, 0.35) + 0.25 * (drift - heading)
            x, y = (x + math.cos(heading)) % size, (y + math.sin(heading)) % size
            for dx, dy, depth in ((0, 0, 26), (1, 0, 12)):
                value[(int(y) + dy) % size * size + (int(x) + dx) % size] -= depth
    return png(size, size, [(v, v * 0.995, v * 0.985) for v in value], 15)


def courses(size, rows, columns, joint_px, seed, shift=0.5, wobble=0.0):
    """For each pixel of a bond: (stone's row, column, distance to the joint in pixels, along u and v)."""
    rng = random.Random(seed)
    height, width = size / rows, size / columns
    offsets = [(shift if r % 2 else 0.0) + rng.uniform(-wobble, wobble) for r in range(rows)]
    cuts = [[c + rng.uniform(-wobble, wobble) for c in range(columns)] for _ in range(rows)]
    out = []
    for y in range(size):
        r = int(y / height)
        fy = y - r * height
        for x in range(size):
            u = (x / width - offsets[r]) % columns
            c = int(u)
            left = cuts[r][c]
            right = cuts[r][(c + 1) % columns] + (columns if c + 1 == columns else 0)
            if u < left:
                c, right = (c - 1) % columns, left
                left = cuts[r][c] if c < columns - 1 else cuts[r][c] - columns
            elif u > right:
                c, left = (c + 1) % columns, right
                right = left + 1.0
            edge = min((u - left) * width, (right - u) * width, fy, height - fy) - joint_px / 2
            out.append((r, c, edge))
    return out


def brick(size=512):
    """1.8 m of brickwork, 24 courses of 8; colour varies brick by brick and the mortar is stained by noise."""
    rng = random.Random(21)
    tone = {}
    fine, broad = noise(size, 64, 3, 2, 0.6), noise(size, 3, 4, 4, 0.6)
    pixels = []
    for i, (r, c, edge) in enumerate(courses(size, 24, 8, 3.0, 22)):
        if (r, c) not in tone:
            shade = rng.gauss(1.0, 0.13) * (0.62 if rng.random() < 0.09 else 1.0)
            hue = rng.gauss(0.0, 1.0)
            tone[r, c] = (134 * shade + 7 * hue, 76 * shade + 1.5 * hue, 60 * shade - 3 * hue)
        grime = 0.74 + 0.5 * broad[i]
        texture = (0.78 + 0.44 * fine[i]) * grime
        if edge <= 0:
            m = 118 * texture
            pixels.append((m, m * 0.95, m * 0.88))
        else:
            worn = 0.86 if edge < 1.2 else 1.0
            pixels.append(tuple(k * texture * worn for k in tone[r, c]))
    return png(size, size, pixels, 40)


def slabs(size=512):
    """2.4 m of concrete paving slabs, 0.6 by 0.4 m, dark open joints, moss and chewing gum."""
    rng = random.Random(31)
    fine, broad, moss = noise(size, 80, 5, 2, 0.6), noise(size, 4, 6, 5, 0.55), noise(size, 6, 7, 4, 0.6)
    tone, pixels = {}, []
    for i, (r, c, edge) in enumerate(courses(size, 6, 4, 2.2, 32)):
        shade = tone.setdefault((r, c), rng.gauss(1.0, 0.09))
        v = 118 * shade * (0.76 + 0.48 * broad[i]) * (0.86 + 0.28 * fine[i])
        if edge <= 0:
            green = max(0.0, moss[i] - 0.45) * 120
            pixels.append((38 + green * 0.35, 38 + green * 0.55, 34 + green * 0.1))
        else:
            v *= 0.84 if edge < 2.5 else 1.0
            pixels.append((v, v * 0.975, v * 0.93))
    for _ in range(26):
        cx, cy = rng.randrange(size), rng.randrange(size)
        for dy in range(-2, 3):
            for dx in range(-2, 3):
                if dx * dx + dy * dy < 5:
                    k = (cy + dy) % size * size + (cx + dx) % size
                    pixels[k] = tuple(p * 0.72 for p in pixels[k])
    return png(size, size, pixels, 32)


def joints(size, tile_m, rows, columns, joint_px, seed, shift=0.5, wobble=0.0):
    """glTF's occlusion of a bond: black in the middle of joints, white from 12 mm beside them on."""
    pixel_m = tile_m / size
    edges = [edge * pixel_m for _, _, edge in courses(size, rows, columns, joint_px, seed, shift, wobble)]
    return png(size, size, [(255 * max(0.0, min(1.0, (m + 0.005) / 0.017)),) * 3 for m in edges], 16)


def setts(size=256):
    """0.96 m of granite setts, 8 by 8, each domed, sand and dirt between."""
    rng = random.Random(41)
    fine, pixels, tone = noise(size, 64, 8, 2, 0.6), [], {}
    for i, (r, c, edge) in enumerate(courses(size, 8, 8, 3.0, 42, 0.5, 0.09)):
        shade = tone.setdefault((r, c), rng.gauss(1.0, 0.13))
        v = 104 * shade * (0.8 + 0.4 * fine[i]) * min(1.0, 0.62 + 0.06 * max(edge, 0.0))
        pixels.append((v, v * 0.985, v * 0.97) if edge > 0 else (34 + 20 * fine[i], 31 + 18 * fine[i],
                                                                 27 + 14 * fine[i]))
    return png(size, size, pixels, 24)


def ashlar(size=256):
    """2.4 m of dressed sandstone, blocks 0.8 by 0.4 m, weathered from above."""
    rng = random.Random(51)
    fine, streak, pixels, tone = noise(size, 24, 9, 4, 0.65), noise(size, 16, 10, 3, 0.6, 6), [], {}
    for i, (r, c, edge) in enumerate(courses(size, 6, 3, 1.6, 52)):
        shade = tone.setdefault((r, c), rng.gauss(1.0, 0.08))
        v = 138 * shade * (0.7 + 0.36 * fine[i] + 0.24 * streak[i]) * (0.62 if edge <= 0 else 0.9 if edge < 2 else 1.0)
        pixels.append((v, v * 0.93, v * 0.82))
    return png(size, size, pixels, 32)


def plaster(size=256):
    """4 m of lime plaster, light grey to be tinted: trowel marks, run-down stains, patches that flaked."""
    fine, broad = noise(size, 32, 12, 3, 0.6), noise(size, 3, 13, 5, 0.55)
    streak, flake = noise(size, 32, 14, 3, 0.6, 10), noise(size, 5, 15, 5, 0.62)
    pixels = []
    for f, b, s, k in zip(fine, broad, streak, flake):
        v = 205 * (0.80 + 0.26 * b + 0.10 * f) - 70 * max(0.0, s - 0.55)
        if k > 0.69:
            v *= 0.88
        pixels.append((v, v * 0.985, v * 0.955))
    return png(size, size, pixels, 24)


def paint(size=256):
    """0.8 m of road paint, to be tinted: dirt of wheels, stones that wear through, places where it has come off."""
    rng = random.Random(61)
    broad, fine, thin = noise(size, 3, 62, 4, 0.6), noise(size, 64, 63, 2, 0.7), noise(size, 10, 64, 4, 0.62)
    pixels = []
    for b, f, t in zip(broad, fine, thin):
        v = 205 * (0.80 + 0.24 * b + 0.16 * (f - 0.5)) + rng.gauss(0.0, 4.0)
        worn = 3.0 * (t - 0.5) + 1.2 * (f - 0.5)
        if worn > 0.42:
            v -= (v - 74) * min(1.0, 4.0 * (worn - 0.42))
        pixels.append((v, v * 0.985, v * 0.96))
    return png(size, size, pixels, 16)


def roof_tiles(size=256):
    """1.6 m of clay pantiles, 8 columns of 6 rows: round rolls, a shadow under each lap."""
    rng = random.Random(61)
    fine, pixels, tone = noise(size, 32, 16, 3, 0.6), [], {}
    for y in range(size):
        r, fy = int(y * 6 / size), (y * 6 / size) % 1.0
        for x in range(size):
            c, fx = int(x * 8 / size), (x * 8 / size) % 1.0
            shade = tone.setdefault((r, c), rng.gauss(1.0, 0.13))
            roll = 0.55 + 0.45 * math.sin(math.pi * fx) ** 0.7
            v = shade * roll * (0.72 + 0.5 * fine[y * size + x]) * (0.45 if fy > 0.92 else 1.0)
            pixels.append((124 * v, 74 * v, 58 * v))
    return png(size, size, pixels, 24)


def wood(size=128):
    """1 m of painted or bare boards, grain downwards, light grey to be tinted."""
    grain, fine, pixels = noise(size, 16, 17, 4, 0.7, 8), noise(size, 32, 18, 2), []
    for y in range(size):
        for x in range(size):
            i = y * size + x
            v = 196 * (0.66 + 0.5 * grain[i]) * (0.92 + 0.16 * fine[i])
            v *= 0.45 if x % 32 < 1 else 1.0
            pixels.append((v, v * 0.97, v * 0.93))
    return png(size, size, pixels, 16)


def metal(size=128):
    """0.5 m of painted or weathered metal, light grey to be tinted."""
    fine, run = noise(size, 16, 19, 4, 0.6), noise(size, 16, 20, 3, 0.6, 8)
    return png(size, size, [(210 * (0.7 + 0.3 * f + 0.18 * r),) * 3 for f, r in zip(fine, run)], 12)


def stripes(size=128):
    """1.2 m of awning cloth: three pairs of dark red and cream stripes along v, woven and weathered."""
    weave, broad, pixels = noise(size, 64, 23, 1), noise(size, 4, 24, 4), []
    for y in range(size):
        for x in range(size):
            i = y * size + x
            shade = 0.78 + 0.2 * weave[i] + 0.25 * (broad[i] - 0.5)
            base = (150, 34, 30) if int(x * 6 / size) % 2 else (222, 208, 178)
            pixels.append(tuple(c * shade for c in base))
    return png(size, size, pixels, 24)


def foliage(size=128):
    """Leaf greens, with a lighter midrib along u = 0.5 for quads that span the image."""
    fine, pixels = noise(size, 8, 25, 4, 0.65), []
    for y in range(size):
        for x in range(size):
            v = 0.6 + 0.7 * fine[y * size + x]
            rib = 1.0 + 0.45 * math.exp(-((x / size - 0.5) / 0.03) ** 2)
            pixels.append((70 * v * rib, 98 * v * rib, 42 * v))
    return png(size, size, pixels, 16)


def earth(size=128):
    """1 m of dark soil with stones."""
    rng = random.Random(71)
    coarse, pixels = noise(size, 16, 26, 4, 0.75), []
    for n in coarse:
        v = 40 + 60 * n + rng.gauss(0, 7)
        pixels.append((v, v * 0.82, v * 0.62))
    return png(size, size, pixels, 14)


def room(x, y, kind):
    """One lit room seen through a window, x and y in [0; 1], y down: ceiling glow, wall, curtains, a lamp."""
    lamp_x, lamp_y = ((0.62, 0.30), (0.35, 0.55), (0.5, 0.16), (0.72, 0.62))[kind]
    glow = math.exp(-((x - lamp_x) ** 2 + (y - lamp_y) ** 2) / 0.10)
    core = math.exp(-((x - lamp_x) ** 2 + (y - lamp_y) ** 2) / 0.0028)
    light = 0.20 + 0.62 * glow + 0.5 * core
    if kind == 0 and y > 0.62 and 0.15 < x < 0.5:
        light *= 0.30
    if kind == 3 and 0.20 < x < 0.42 and 0.25 < y < 0.58:
        light *= 0.45
    fold = 0.5 + 0.5 * math.sin(x * 75.0 + 2.0 * math.sin(y * 3.0 + kind))
    drawn = (0.26, 0.20, 0.5, 0.14)[kind]
    if x < drawn or x > 1.0 - drawn:
        light = 0.30 * light + 0.24 * fold + 0.12
    if kind == 1 and y > 0.5:
        light = 0.55 * light + 0.25 + 0.1 * fold
    return light


def interiors(size=256):
    """Four rooms, two by two, used lit (emissive) and, much darker, for windows without light."""
    fine, pixels, half = noise(size, 32, 27, 2), [], size // 2
    for y in range(size):
        for x in range(size):
            kind = (1 if x >= half else 0) + (2 if y >= half else 0)
            v = 235 * min(1.0, room(x % half / half, y % half / half, kind)) * (0.9 + 0.2 * fine[y * size + x])
            pixels.append((v, v * 0.86, v * 0.68))
    return png(size, size, pixels, 64)


def shop_window(width=256, height=128):
    """A grocer's display: three shelves of jars, loaves and bottles before a warm back wall, lamps above."""
    rng = random.Random(81)
    pixels = [[(0.0, 0.0, 0.0)] * width for _ in range(height)]
    for y in range(height):
        for x in range(width):
            lamps = sum(math.exp(-((x - cx) ** 2 * 0.6 + (y - 6) ** 2) / 900.0) for cx in (40, 104, 168, 232))
            v = 0.30 + 0.62 * min(1.0, lamps)
            pixels[y][x] = (250 * v, 208 * v, 142 * v)
    for shelf in (52, 86, 120):
        x = 3
        while x < width - 8:
            w, h = rng.randint(4, 11), rng.randint(9, 24)
            colour = rng.choice(((170, 96, 40), (116, 34, 24), (70, 92, 40), (196, 160, 90), (60, 44, 34),
                                 (204, 190, 160)))
            for yy in range(shelf - h, shelf):
                for xx in range(x, min(width, x + w)):
                    across = (xx - x + 0.5) / w
                    inset = 0.28 if h > 17 and yy < shelf - h * 0.62 else 0.0
                    if inset < across < 1.0 - inset:
                        shade = 0.45 + 0.75 * math.sin(math.pi * across)
                        pixels[yy][xx] = tuple(c * shade * (1.15 - 0.3 * shelf / 128) for c in colour)
            x += w + rng.randint(1, 4)
        for yy in range(shelf, min(height, shelf + 3)):
            pixels[yy] = [(64, 42, 24)] * width
    return png(width, height, [p for row in pixels for p in row], 48)


def all_images():
    return {"slabs_joints": joints(512, 2.4, 6, 4, 2.2, 32),
            "setts_joints": joints(256, 0.96, 8, 8, 3.0, 42, 0.5, 0.09),
            "asphalt": asphalt(), "brick": brick(), "slabs": slabs(), "setts": setts(), "ashlar": ashlar(),
            "plaster": plaster(), "roof_tiles": roof_tiles(), "wood": wood(), "metal": metal(), "stripes": stripes(),
            "foliage": foliage(), "earth": earth(), "paint": paint(), "interiors": interiors(),
            "shop_window": shop_window()}

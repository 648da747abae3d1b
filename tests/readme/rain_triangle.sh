#!/usr/bin/env bash
# The program that engine/README.md builds up, as a newcomer builds it: against the installed library, with the
# command of that page. It runs under validation and synchronization validation, like the triangle that it began with.
# Their pictures differ by rain, over the triangle and beside it.
# Usage: rain_triangle.sh SOURCE_ROOT BUILD_ROOT "CC"
set -eu
source=$1 build=$2 cc=$3
work=$(mktemp -d "${TMPDIR:-/tmp}/virga-readme-XXXXXX")
trap 'rm -rf "$work"' EXIT
DESTDIR=$work meson install -C "$build" --no-rebuild --quiet >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
pc=$(find "$work" -name virga.pc)
prefix=$work$(sed -n 's/^prefix=//p' "$pc")
sed -i "s|^prefix=.*|prefix=$prefix|" "$pc"
PKG_CONFIG_PATH=$(dirname "$pc")
LD_LIBRARY_PATH=$(dirname "$(find "$prefix" -name 'libvirga.so')")
export PKG_CONFIG_PATH LD_LIBRARY_PATH
cp "$source"/tests/readme/*triangle.* "$work"
cd "$work"
for shader in triangle.vert triangle.frag; do
    glslangValidator -V --quiet "$shader" -o "$shader.spv"
done
warnings="-Wall -Wextra -Werror"
# shellcheck disable=SC2046,SC2086 # flags are words
$cc $warnings triangle.c -o triangle $(pkg-config --cflags --libs vulkan)
# shellcheck disable=SC2046,SC2086
$cc $warnings rain_triangle.c -o rain_triangle $(pkg-config --cflags --libs virga vulkan) -lm

export VK_INSTANCE_LAYERS VK_LAYER_ENABLES
if ls /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json >/dev/null 2>&1; then
    VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
fi
for program in triangle rain_triangle; do
    ./$program $program.ppm >said 2>&1 || { cat said; echo "failed: $program"; exit 1; }
    if grep -v "^virga info (created): " said; then
        cat said
        echo "not silent: $program"
        exit 1
    fi
done
# What the library tells a newcomer who has no other program: the device, and the rain.
expected="virga info (created): context on D, N frames in flight
virga info (created): rain: N slots in N levels, the largest N m wide, N MB of device memory in use"
told=$(sed -E 's/context on .*, /context on D, /; s/[0-9.]+/N/g' said)
[ "$told" = "$expected" ] || { cat said; echo "not told: device and rain"; exit 1; }
python3 - triangle.ppm rain_triangle.ppm <<'PYTHON'
import sys

def pixels(path):
    """Width, height and the sum of red, green and blue of each pixel, row by row."""
    head, rest = open(path, "rb").read().split(b"\n", 1)
    width, height = map(int, head.split()[1:3])
    assert len(rest) == width * height * 3
    return width, height, [sum(rest[3 * i:3 * i + 3]) for i in range(width * height)]

width, height, dry = pixels(sys.argv[1])
_, _, wet = pixels(sys.argv[2])
inside = [i for i in range(width * height) if dry[i]]
outside = [i for i in range(width * height) if not dry[i]]
assert 0.05 < len(inside) / len(dry) < 0.5, "no triangle, or nothing else"
for name, pixels in (("triangle", inside), ("sky", outside)):
    # Streaks are lit by a grey sky: 12 of 765 is one step of a channel in 64, above what rounding does.
    streaks = sum(abs(wet[i] - dry[i]) > 12 for i in pixels) / len(pixels)
    print("%.1f %% of the %s is under streaks" % (100 * streaks, name))
    assert 0.005 < streaks < 0.9, "no rain over the " + name + ", or nothing else"
PYTHON

#!/usr/bin/env bash
# The program that README.md builds up, as a newcomer builds it: against the installed library, with the command of
# README.md; run under validation and synchronization validation. Above its triangle there is nothing but rain.
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
cp "$source"/tests/readme/rain_triangle.c "$source"/tests/readme/triangle.* "$work"
cd "$work"
for shader in triangle.vert triangle.frag; do
    name=${shader/./_}
    glslangValidator -V --quiet --vn "${name}_spv" -o "$name.spv.h" "$shader"
done
# shellcheck disable=SC2046 # flags are words
$cc -Wall -Wextra -Werror rain_triangle.c -o rain_triangle $(pkg-config --cflags --libs virga vulkan) -lm

export VK_INSTANCE_LAYERS VK_LAYER_ENABLES
if ls /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json >/dev/null 2>&1; then
    VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
fi
./rain_triangle rain.ppm >said 2>&1 || { cat said; exit 1; }
[ ! -s said ] || { cat said; echo "not silent"; exit 1; }
python3 - rain.ppm <<'PYTHON'
import sys
data = open(sys.argv[1], "rb").read()
head, rest = data.split(b"\n", 1)
width, height = map(int, head.split()[1:3])
assert len(rest) == width * height * 3
def at(x, y):
    return sum(rest[3 * (y * width + x):3 * (y * width + x) + 3])
sky = sorted(at(x, y) for y in range(height // 6) for x in range(width))
middle = sky[len(sky) // 2]
streaks = sum(value > middle + 12 for value in sky) / len(sky)
print("%.1f %% of the sky are streaks" % (100 * streaks))
assert 0.005 < streaks < 0.9, "no rain in the sky, or nothing else"
assert at(width // 2, height * 2 // 3) != middle, "no triangle"
PYTHON

#!/usr/bin/env bash
# A picture of the street without rain, as a JPEG with 16 bits of depth, gets the rain that the street itself has.
# Usage: footage_street.sh VIRGA SOURCE
here=$(cd "$(dirname "$0")" && pwd)
source=$2
. "$here/common.sh" "$1" oiiotool python3

# The street as its scene has it, but for ground and splashes, which are not compared.
street() {
    local out=$1
    shift
    timeout 200 "$virga" render "$source/assets/scenes/street.yaml" -o "$work/$out" --device "$device" --frames 1 \
        --size 160x90 --set ground.on=false --set frames.warm_start=false --set rain.max_drops=65536 "$@" \
        >"$work/log" 2>&1 || { cat "$work/log"; fail "rendering $out"; }
}
export VIRGA_VALIDATE=0
street plate --layers beauty,depth --set rain.rate_mm_h=0 --picture jpg
if grep -q 'built without OpenImageIO' "$work/log"; then
    echo "skipped: built without OpenImageIO"
    exit 77
fi
# A panorama's light has nothing that hides it.
street wanted --layers rain,depth --set rain.haze=0 --set environment.around=0

# Metres as numbers of 1/256 m, 0 where there is nothing: the sky, at infinity, is clamped and taken out.
oiiotool "$work/plate/frame.0001.exr" --ch Z --clamp:min=0:max=300 -d float -o "$work/z.exr" &&
    oiiotool "$work/z.exr" --mulc -1 --addc 255 --mulc 1e6 --clamp:min=0:max=1 "$work/z.exr" --mul \
        --mulc 0.0039063096 -d uint16 -o "$work/depth.png" || fail "making the depth"

# What is known on a film set beside the picture: the camera, the weather, the lamps and a panorama of the sky.
{
    echo 'virga: 1'
    echo "environment: {file: $(realpath "$source")/assets/environments/dusk.exr, intensity: 1}"
    sed -n '/^lights:/,/^$/p; /^camera:/,/^frames:/p; /^rain:/,/^$/p' "$source/assets/scenes/street.yaml"
} >"$work/footage.yaml"
timeout 100 "$virga" render "$work/footage.yaml" -o "$work/has" --device "$device" --frames 1 --size 160x90 \
    --plate "$work/plate/picture.0001.jpg" --depth "$work/depth.png" --layers rain,depth --set rain.max_drops=65536 \
    --set rain.haze=0 >"$work/log" 2>&1 || { cat "$work/log"; fail "rain over the picture"; }

for name in has wanted; do
    oiiotool "$work/$name/frame.0001.exr" --ch Z,rain.A,rain.G -d float -o "$work/$name.tif" &&
        oiiotool --dumpdata "$work/$name.tif" >"$work/$name.txt" || fail "reading $name"
done
python3 - "$work" <<'PY' || fail "the rain is not that of the street"
import re, sys
def read(name):
    text = open(sys.argv[1] + "/" + name).read()
    return [[float(value) for value in row.split()] for row in re.findall(r"\): (.*)", text)]
has, wanted = read("has.txt"), read("wanted.txt")
def mean(rows, channel, low=0.0, high=1e9):
    values = [row[channel] for row, own in zip(rows, wanted) if low <= min(own[0], 1e8) < high]
    return sum(values) / len(values), len(values)
good = len(has) == len(wanted) == 160 * 90
def compare(what, a, b, within):
    global good
    ratio = a / b if b else 0
    print("%-28s %.5f, street %.5f: %.3f" % (what, a, b, ratio))
    good = good and abs(ratio - 1) <= within
# Without the depth, 7 % more would be seen before what is near.
compare("covered", mean(has, 1)[0], mean(wanted, 1)[0], 0.05)
compare("light", mean(has, 2)[0], mean(wanted, 2)[0], 0.05)
for low, high in ((2, 8), (8, 14), (14, 22), (22, 40), (40, 1e9)):
    a, count = mean(has, 1, low, high)
    compare("covered, %g to %g m (%d px)" % (low, high, count), a, mean(wanted, 1, low, high)[0], 0.05)
sys.exit(not good)
PY
[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

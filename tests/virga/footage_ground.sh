#!/usr/bin/env bash
# Ground that footage shows: rain lands and wets it there and nowhere else, as in the scene that the footage is of.
# Usage: footage_ground.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" idiff oiiotool python3

# A road between lawns, with a box on it. Its picture is the footage.
camera='{fov_deg: 50, keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1.2, -5]}]}'
printf '%s\n' 'newmtl asphalt' 'Kd 0.15 0.15 0.15' 'newmtl grass' 'Kd 0.1 0.25 0.05' 'newmtl brick' \
    'Kd 0.4 0.2 0.15' >"$work/world.mtl"
printf '%s\n' 'mtllib world.mtl' 'usemtl asphalt' 'v -2 0 2' 'v 2 0 2' 'v 2 0 -30' 'v -2 0 -30' 'f 1 2 3 4' \
    'usemtl grass' 'v -30 0 2' 'v -30 0 -30' 'v 30 0 2' 'v 30 0 -30' 'f 5 1 4 6' 'f 2 7 8 3' \
    'usemtl brick' 'v 0.3 0 -6' 'v 1.3 0 -6' 'v 1.3 1 -6' 'v 0.3 1 -6' 'f 9 10 11 12' >"$work/world.obj"
cat >"$work/world.yaml" <<YAML
virga: 1
meshes: [{file: world.obj}]
camera: $camera
environment: {zenith: [0.5, 0.55, 0.6], horizon: [0.7, 0.7, 0.7], ground: [0.1, 0.1, 0.1]}
frames: {fps: 24, first: 1, last: 6, size: [160, 90]}
rain: {rate_mm_h: 15, max_drops: 16384, occlusion_size: 256, haze: 0}
ground: {on: true, cells: 256, start_wetness: 0.9}
splash: {gain: 1}
YAML
sed 's/^meshes.*/footage: {ground: plane}/; /^environment/d' "$work/world.yaml" >"$work/road.yaml"

draw world plate --frames 1 --layers beauty,depth --set ground.on=false --set rain.rate_mm_h=0 --samples 4
VIRGA_VALIDATE=0 draw world wanted --frames 6 --layers beauty,depth,splash,wetness

# 255 where a pixel's middle is on the road, 100 where it is on grass 30 cm or more beside it.
python3 - >"$work/mask.pgm" <<'PY'
import math
width, height = 160, 90
focal, length = 0.5 * height / math.tan(math.radians(25)), math.hypot(0.3, 5)
print("P2", width, height, 255)
for y in range(height):
    for x in range(width):
        u, v = (x + 0.5 - width / 2) / focal, (height / 2 - y - 0.5) / focal
        d = u, (v * 5 - 0.3) / length, (-5 - v * 0.3) / length
        way = -1.5 / d[1] if d[1] < 0 else 1e9
        at_box = -6 / d[2]
        box = 0.3 < at_box * d[0] < 1.3 and 0 < 1.5 + at_box * d[1] < 1
        on = way < 1e8 and way * d[2] > -30 and not box
        print(255 if on and abs(way * d[0]) < 2 else 100 if on and abs(way * d[0]) > 2.3 else 0)
PY
oiiotool "$work/mask.pgm" -o "$work/mask.exr" || exit 1
footage=(--plate "$work/plate/frame.0001.exr" --ground-mask "$work/mask.exr")

values() {
    oiiotool "$work/$1/frame.0006.exr" --ch "$2" -d float -o "$work/v.exr" && oiiotool --dumpdata "$work/v.exr"
}
values wanted splash.A,splash.G,wetness.Y >"$work/wanted.txt"

# Wetness on the road as that of the scene, none beside it; with `rain`, splashes on the road alone, as many as there.
is_like() {
    values "$1" "${2:+splash.A,splash.G,}wetness.Y" >"$work/has.txt"
    python3 - "$work" "${2:-}" <<'PY' || fail "$1: not as the scene"
import re, sys
def read(name):
    rows = {}
    for x, y, rest in re.findall(r"Pixel \((\d+), (\d+)\): (.*)", open(sys.argv[1] + "/" + name).read()):
        rows[int(x), int(y)] = [float(value) for value in rest.split()]
    return rows
has, wanted = read("has.txt"), read("wanted.txt")
codes = [int(word) for word in open(sys.argv[1] + "/mask.pgm").read().split()[4:]]
mask = {(i % 160, i // 160): code / 255 for i, code in enumerate(codes)}
road = [at for at in mask if mask[at] > 0.5]
beside = [at for at in mask if mask[at] <= 0.5]
inner = [at for at in road if all(mask.get((at[0] + i, at[1] + k), 0) > 0.5
                                  for i in (-1, 0, 1) for k in (-1, 0, 1))]
wrong = sum(abs(has[at][-1] - wanted[at][-1]) for at in inner) / len(inner)
far = [at for at in beside if mask[at] > 0.25]
print("wetness %.4f off" % wrong)
good = wrong < 0.03 and len(inner) > 1500 and len(far) > 1000 and max(has[at][-1] for at in beside) == 0
if sys.argv[2]:
    light, wanted_light = (sum(rows[at][1] for at in inner) for rows in (has, wanted))
    print("splashes %.3f of %.3f" % (light, wanted_light))
    good = good and max(has[at][0] for at in far) == 0 and max(wanted[at][0] for at in far) > 0
    good = good and 0.5 < light / wanted_light < 2
sys.exit(not good)
PY
}

draw road plane "${footage[@]}" --frames 6 --layers beauty,depth,splash,wetness
is_like plane rain
export VIRGA_VALIDATE=0
draw road points "${footage[@]}" --depth "$work/plate/frame.0001.exr" --frames 6 --layers beauty,depth,wetness \
    --set footage.ground=depth --set rain.rate_mm_h=0 --set splash.on=false
is_like points

# ---- without rain, the plate keeps its pixels beside the mask; on it, it is wet

averages() {
    sed -n 's/.*Stats Avg: \([0-9.]*\).*/\1/p' "$work/log" | xargs
}

# The change, and then what of it is beside the mask.
oiiotool "$work/plate/frame.0001.exr" --ch R,G,B "$work/points/frame.0006.exr" --ch R,G,B --absdiff --chsum \
    --printstats "$work/mask.exr" --addc -0.5 --clamp:min=0:max=0.5 --mulc -2 --addc 1 --mul --printstats >"$work/log"
sed -n '/Stats Max/p' "$work/log" | tail -n 1 | grep -q 'Stats Max: 0.000000' ||
    { cat "$work/log"; fail "the plate is changed beside its ground"; }
averages | awk '{ exit !(NF == 2 && $1 > 0.01) }' || { cat "$work/log"; fail "the ground is not wet"; }

# ---- water mirrors the box that stands on the road, as it does in the scene

means=()
for name in points wanted; do
    for cut in 8x5+89+65 8x5+65+65; do
        means+=("$work/$name/frame.0006.exr" --ch G -d float --cut "$cut" --printstats)
    done
done
oiiotool "${means[@]}" >"$work/log"
averages |
    awk '{ print "below the box", $1 / $2, "of the road beside it, scene", $3 / $4
           exit !(NF == 4 && $1 < 0.5 * $2 && $3 < 0.5 * $4 && $2 < 1.2 * $4 && $2 > 0.8 * $4) }' ||
    fail "the box is not mirrored, or the road is not as bright as the scene's"

# ---- a dark wall, and a board in the air before it: below the board a ray comes to the wall where the board hides it.
# It is as dark there as beside it, though the sky behind the wall is bright
printf '%s\n' 'mtllib world.mtl' 'usemtl asphalt' 'v -9 0 2' 'v 9 0 2' 'v 9 0 -9' 'v -9 0 -9' 'f 1 2 3 4' \
    'usemtl dark' 'v -9 0 -9' 'v 9 0 -9' 'v 9 3 -9' 'v -9 3 -9' 'f 5 6 7 8' \
    'v -0.3 0.4 -5' 'v 0.3 0.4 -5' 'v 0.3 1.7 -5' 'v -0.3 1.7 -5' 'f 9 10 11 12' >"$work/wall.obj"
printf '%s\n' 'newmtl dark' 'Kd 0.01 0.01 0.01' >>"$work/world.mtl"
sed 's/world.obj/wall.obj/' "$work/world.yaml" >"$work/wall.yaml"
sed 's/^meshes.*/footage: {ground: depth, light: scene}/' "$work/world.yaml" >"$work/hidden.yaml"
draw wall board --frames 1 --layers beauty,depth --set ground.on=false --set rain.rate_mm_h=0 --samples 4
draw hidden below --plate "$work/board/frame.0001.exr" --depth "$work/board/frame.0001.exr" --frames 1 \
    --layers beauty,wetness --set rain.rate_mm_h=0 --set splash.on=false --set ground.start_water_mm=3
means=()
for cut in 6x4+77+62 6x4+110+62; do
    means+=("$work/below/frame.0001.exr" --ch G -d float --cut "$cut" --printstats)
done
oiiotool "${means[@]}" >"$work/log"
averages | awk '{ print "below the board", $1, "beside it", $2; exit !(NF == 2 && $1 < 1.5 * $2 && $1 > 0.5 * $2) }' ||
    { cat "$work/log"; fail "below a board the sky shines through a wall"; }

# ---- a camera that turns and moves on: the ground that it sees last is wet, too
turned='{fov_deg: 50, keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1.2, -5]},
    {time_s: 0.2, position_m: [2.5, 1.5, -1], look_at_m: [6.5, 1.2, -3]}]}'
for name in world road; do
    CAMERA=$turned awk '/^camera:/ { print "camera: " ENVIRON["CAMERA"]; next } { print }' "$work/$name.yaml" \
        >"$work/$name.turned.yaml"
done
small=(--size 96x54 --set rain.rate_mm_h=0 --set splash.on=false)
draw world.turned turned --layers beauty,depth,wetness "${small[@]}"
draw road.turned seen --plate "$work/turned/frame.%04d.exr" --depth "$work/turned/frame.%04d.exr" --frames 6 \
    --layers wetness --set footage.ground=depth "${small[@]}"
for name in turned seen; do
    oiiotool "$work/$name/frame.0006.exr" --ch wetness.Y -d float -o "$work/v.exr" &&
        oiiotool --dumpdata "$work/v.exr" >"$work/$name.txt" || fail "reading $name"
done
python3 - "$work" <<'PY' || fail "ground that the first frame does not show is dry"
import re, sys
wanted, has = ([float(v) for v in re.findall(r"\): (\S+)", open("%s/%s.txt" % (sys.argv[1], name)).read())]
               for name in ("turned", "seen"))
wet = [i for i in range(len(wanted)) if wanted[i] > 0.3 and i // 96 >= 28] # below the horizon, where grids are coarse
found = sum(has[i] > 0.3 for i in wet)
print("wet: %d of %d pixels" % (found, len(wet)))
sys.exit(len(wet) < 1000 or found < 0.95 * len(wet))
PY

# ---- checkpoints belong to a mask
render_saved() {
    VIRGA_VALIDATE=0 draw road saved --plate "$work/plate/frame.0001.exr" --set rain.max_drops=1024 \
        --set splash.max_splashes=1024 "$@"
}
render_saved --ground-mask "$work/mask.exr" --frames 1-2 --simulate --checkpoint-every 2
render_saved --ground-mask "$work/mask.exr" --frames 3 --layers beauty
grep -q 'starts from the checkpoint of frame 2' "$work/log" || { cat "$work/log"; fail "no checkpoint"; }
render_saved --frames 4 --layers beauty
grep -q 'is not used: it is of another scene' "$work/log" || { cat "$work/log"; fail "a checkpoint of another mask"; }

# ---- what is wrong

refuses() {
    local expected=$1
    shift
    timeout 60 "$virga" render "$work/road.yaml" -o "$work/refused" --frames 1 --device "$device" "$@" \
        >"$work/log" 2>&1
    local code=$?
    [ $code -eq 2 ] || { cat "$work/log"; fail "exit code $code, expected 2: $*"; }
    grep -qF -e "$expected" "$work/log" || { cat "$work/log"; fail "expected '$expected'"; }
    [ "$(wc -l <"$work/log")" -eq 1 ] || { cat "$work/log"; fail "more than one line: $*"; }
}
refuses '--ground-mask: expected a --plate' --ground-mask "$work/mask.exr"
refuses '--ground-mask: expected footage.ground' "${footage[@]}" --set footage.ground=none
refuses '--ground-mask: cannot read' --plate "$work/plate/frame.0001.exr" --ground-mask "$work/none.png"
refuses 'footage.ground: depth: expected --depth' "${footage[@]}" --set footage.ground=depth
oiiotool --pattern constant:color=0,0,0 160x90 3 -o "$work/black.exr"
refuses 'footage.ground: expected ground within 80 m in the picture, found none' \
    --plate "$work/plate/frame.0001.exr" --ground-mask "$work/black.exr"

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

#!/usr/bin/env bash
# Frames without color: what is not asked for is not drawn, and what is has the bytes of a whole frame.
# Usage: layers.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" oiiotool idiff python3

write_road
# A pane of glass on a road under water.
cat >"$work/road.mtl" <<'MTL'
newmtl pane
d 0.3
MTL
printf '%s\n' 'mtllib road.mtl' 'o pane' 'usemtl pane' 'v -1 0 0' 'v 0 0 0' 'v 0 1 0' 'v -1 1 0' 'f 1 2 3 4' \
    >"$work/pane.obj"
cat >"$work/road.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}, {file: pane.obj}]
camera: {keys: [{time_s: 0, position_m: [0, 1.5, 3], look_at_m: [0, 0.5, 0]},
                {time_s: 1, position_m: [1, 1.5, 3], look_at_m: [0, 0.5, 0]}]}
frames: {fps: 24, first: 1, last: 2, size: [96, 54], warm_start: false}
rain: {rate_mm_h: 100, max_drops: 4096, occlusion_size: 64}
ground: {on: true, cells: 128, start_water_mm: 1}
splash: {on: false}
YAML

# channels FOLDER CHANNEL,...: of the second frame, as floats.
channels() {
    oiiotool "$work/$1/frame.0002.exr" --ch "$2" -d float -o "$work/$1.exr" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "channels of $1"; }
}

# same FOLDER FOLDER CHANNEL,...
same() {
    channels "$1" "$3"
    channels "$2" "$3"
    idiff -q -fail 0 "$work/$1.exr" "$work/$2.exr" >"$work/log" 2>&1 || { idiff "$work/$1.exr" "$work/$2.exr"
        fail "$2 has other $3 than $1"; }
}

# drawn FOLDER: whether the device prepared drops to be drawn in the second frame, 1 or 0.
drawn() {
    python3 -c 'import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
print(sum(name == "rain.prepare" for name in lines[-1]["milliseconds"]))' \
        "$work/$1/stats.jsonl"
}

data=Z,velocity.X,velocity.Y,normal.X,normal.Y,normal.Z,id.Y,wetness.Y
draw road whole --stats
draw road data --layers depth,velocity,normal,id,wetness --stats
draw road depth --layers depth --stats
same whole data "$data"
same whole depth Z
[ "$(drawn whole)" -gt 0 ] || fail "a whole frame draws no rain"
[ "$(drawn data)$(drawn depth)" = 00 ] || fail "rain is drawn for a frame without it"
# Sub-frames share shading, from four on; depth is that of one, with the same jitter.
VIRGA_VALIDATE=0 draw road whole_4 --samples 4 --layers beauty,depth
VIRGA_VALIDATE=0 draw road depth_4 --samples 4 --layers depth
same whole_4 depth_4 Z

# Rain is drawn once for four sub-frames of 16, over the shutter of all. With the velocity of water it is drawn in each:
# blurred by a few pixels both are the same picture.
for kind in spans each; do
    option=
    [ $kind = spans ] || option="--water-velocity 100"
    # shellcheck disable=SC2086
    VIRGA_VALIDATE=0 draw road $kind --samples 16 --frames 2 --size 192x108 $option --layers beauty,rain,velocity \
        --set rain.haze=0
    oiiotool "$work/$kind/frame.0002.exr" --ch rain.A -d float --blur 9x9 -o "$work/$kind.exr" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "rain.A of $kind"; }
done
python3 - "$(oiiotool --stats "$work/each.exr")" "$(oiiotool --diff "$work/spans.exr" "$work/each.exr")" <<'PYTHON' ||
import re, sys
average = float(re.search(r"Stats Avg: ([\d.e-]+)", sys.argv[1]).group(1))
error = float(re.search(r"Mean error = ([\d.e-]+)", sys.argv[2]).group(1))
print(f"rain covers {average:.5f}, and differs by {error:.6f} where it is drawn over the time of four sub-frames")
sys.exit(not average > 1e-3 or error > 0.1 * average)
PYTHON
    fail "rain over the time of four sub-frames is not the rain of each"

[ $failures = 0 ] && echo "what is asked for is drawn, as in a whole frame"
[ $failures = 0 ]

#!/usr/bin/env bash
# A render that goes on from a checkpoint makes the same files as one from the beginning, to the byte; checkpoints of
# other scenes and damaged ones are not used, and said.
# Usage: checkpoint.sh VIRGA
set -u
virga=$1
device=${VIRGA_TEST_DEVICE:-cpu}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

cat >"$work/box.obj" <<'OBJ'
v -9 0 -9
v 9 0 -9
v 9 0 9
v -9 0 9
f 1 3 2
f 1 4 3
OBJ
# The camera drives, so that the window of the ground moves; a keyed rate, gusts, a pane with a wiper, and a pre-roll.
cat >"$work/scene.yaml" <<'YAML'
virga: 1
meshes: [{file: box.obj}]
camera:
  keys:
    - {time_s: 0, position_m: [0, 1, 3], look_at_m: [0, 1, 0]}
    - {time_s: 0.5, position_m: [0, 1, -3], look_at_m: [0, 1, -6]}
frames: {fps: 24, first: 1, last: 9, size: [64, 36], preroll_s: 0.2, warm_start: false}
rain:
  keys:
    - {time_s: 0, rate_mm_h: 20, wind_m_s: [0, 0, 0]}
    - {time_s: 0.3, rate_mm_h: 90, wind_m_s: [2, 0, 0]}
  gust_m_s: 2
  max_drops: 4096
  occlusion_size: 64
ground: {on: true, cells: 128, start_water_mm: 3}
splash: {on: false} # checkpoint_scenes.sh has splashes
glass:
  - width_m: 0.4
    height_m: 0.3
    follow: camera
    position_m: [0, 0, -0.5]
    wipers: [{pivot_m: [0.2, 0], reach_m: 0.2, blade_m: 0.15, low_deg: 10, high_deg: 160}]
YAML

failures=0
fail() {
    echo "FAILED: $1"
    sed 's/^/    /' "$work/err"
    failures=$((failures + 1))
}

# render CODE FOLDER OPTION...: expects an exit code.
render() {
    local expected=$1 folder=$2 code
    shift 2
    timeout 120 "$virga" render "$work/scene.yaml" -o "$work/$folder" --device "$device" "$@" \
        >"$work/stdout" 2>"$work/err"
    code=$?
    [ "$code" = "$expected" ] || fail "$folder $*: exit code $code, expected $expected"
}

# said TEXT: the last render printed it.
said() {
    grep -q -- "$1" "$work/err" || fail "expected \"$1\""
}

# same FOLDER FRAME...: the files of these frames are those of the whole render.
same() {
    local folder=$1 file
    shift
    for frame; do
        for file in "$work/whole"/*."$frame".*; do
            cmp -s "$file" "$work/$folder/$(basename "$file")" || fail "$folder: $(basename "$file") differs"
        done
    done
}

# numbers FOLDER: stats.jsonl without its times.
numbers() {
    sed -E 's/,"milliseconds":\{[^}]*\}//' "$work/$1/stats.jsonl"
}

render 0 whole --points --stats
[ "$failures" = 0 ] || exit 1

# The simulation alone leaves checkpoints; a render starts from the nearest one.
render 0 part --simulate --checkpoint-every 4
[ "$(cd "$work/part" && echo *)" = "checkpoint.0004.virga checkpoint.0008.virga checkpoint.preroll.virga" ] ||
    fail "after --simulate: $(cd "$work/part" && echo *)"
render 0 part --points --stats --frames 6-8
said "starts from the checkpoint of frame 4"
same part 0006 0007 0008
[ "$(numbers part)" = "$(numbers whole | sed -n 6,8p)" ] || fail "the statistics differ"

# So does a render with a gap of frames that are there; and writing checkpoints changes no frame.
rm "$work/part/checkpoint.0004.virga"
render 0 part --points --stats --frames 1-9 --resume --checkpoint-every 2
said "starts from the checkpoint after the pre-roll"
said "starts from the checkpoint of frame 8"
same part 0001 0002 0003 0004 0005 0009
[ -f "$work/part/checkpoint.0004.virga" ] || fail "no checkpoint beside the frames"

# What can not be used is said, and the result is the same.
mkdir "$work/bad"
cp "$work/part/checkpoint.0004.virga" "$work/bad"
python3 - "$work/bad/checkpoint.0004.virga" <<'PYTHON' 2>/dev/null || truncate -s -9 "$work/bad/checkpoint.0004.virga"
import sys
data = bytearray(open(sys.argv[1], "rb").read())
for i in range(len(data) // 2, len(data) // 2 + 64): # one bit may decompress to the same bytes
    data[i] ^= 4
open(sys.argv[1], "wb").write(data)
PYTHON
render 0 bad --frames 5-5
said "is not used"
cmp -s "$work/whole/frame.0005.exr" "$work/bad/frame.0005.exr" || fail "after a damaged checkpoint the frame differs"
cp "$work/part/checkpoint.0002.virga" "$work/bad"
render 0 bad --frames 3-3 --seed 3 --set ground.on=false --set 'glass=[]'
said "is not used: it is of another scene"

render 2 wrong --simulate
said "expected --checkpoint-every"
render 2 wrong --checkpoint-every 0

[ "$failures" = 0 ] && echo "all as expected"
exit $((failures > 0))

#!/usr/bin/env bash
# Simulated water that has struck a pane goes on from a checkpoint to the same bytes: the scene surge, small.
# Usage: checkpoint_surge.sh VIRGA SOURCE
source=$2
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3

# surge FOLDER OPTION...
surge() {
    local folder=$work/$1
    shift
    timeout 200 "$virga" render "$source/assets/scenes/surge.yaml" -o "$folder" --device "$device" --size 96x54 \
        --points --stats --set water.solver.spacing_m=0.05 "$@" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "render surge $*"; }
    ! grep '^validation: ' "$work/log" || fail "render surge $*: validation"
}

# numbers FOLDER LINE: a line of stats.jsonl without its times.
numbers() {
    sed -n "$2p" "$work/$1/stats.jsonl" | sed -E 's/,"milliseconds":\{[^}]*\}//'
}

VIRGA_VALIDATE=0 surge whole --frames 1-20 --checkpoint-every 18
python3 - "$work/whole/stats.jsonl" <<'PY' || fail "no water on the pane before the checkpoint"
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
touched = lines[17]["glass"][0]["water_ul"]["touched"]
print(f"{touched} ul of simulated water are on the pane after 18 frames")
sys.exit(not touched > 0)
PY
mkdir "$work/part"
cp "$work/whole/checkpoint.0018.virga" "$work/part"
surge part --frames 19-20
grep -q "starts from the checkpoint of frame 18" "$work/log" || fail "surge does not start from frame 18"
for frame in 0019 0020; do
    for file in "$work/whole"/*."$frame".*; do
        cmp -s "$file" "$work/part/$(basename "$file")" || fail "$(basename "$file") differs"
    done
done
for line in 1 2; do
    [ "$(numbers part $line)" = "$(numbers whole $((18 + line)))" ] || fail "the statistics of line $line differ"
done
exit $((failures > 0))

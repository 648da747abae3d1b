#!/usr/bin/env bash
# A new effect needs one file and one entry in the list of effects: its setting, its layer, its pass and its statistic
# are then there in every command.
# Usage: new_effect.sh VIRGA   (the program with the effect of nothing.c)
set -u
virga=$1
device=${VIRGA_TEST_DEVICE:-cpu}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

has() { # TEXT FILE
    grep -qF -- "$1" "$2" || { cat "$2"; fail "no '$1'"; }
}

"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }
cat >"$work/scene.yaml" <<'END'
virga: 1
camera: {keys: [{position_m: [0, 1.5, 4], look_at_m: [0, 1, 0]}]}
frames: {size: [32, 32]}
rain: {max_drops: 1024, range_m: 4, occlusion_size: 64}
nothing: {amount: 3}
END

# Help: the layer is in the list.
"$virga" help render >"$work/help"
has "nothing      nothing.R G B A  an empty layer" "$work/help"

# Settings: checked against their range.
"$virga" check "$work/scene.yaml" >"$work/log" 2>&1 || { cat "$work/log"; fail "the scene is not good"; }
"$virga" check "$work/scene.yaml" --set nothing.amount=11 >"$work/log" 2>&1
[ $? = 2 ] || fail "an amount of 11 is good"
has "nothing.amount: expected a number from 0 to 10, got '11'" "$work/log"

# A frame: the layer's channels, the setting, and what the pass has counted.
"$virga" render "$work/scene.yaml" -o "$work/out" --frames 3 --stats --layers beauty,nothing --device "$device" \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "no frame"; }
exrheader "$work/out/frame.0003.exr" >"$work/header" 2>&1 && has "nothing.A" "$work/header"
has '"nothing":{"amount":3,"steps":3}' "$work/out/stats.jsonl"

[ $failures = 0 ] && echo "a new effect is there in every command"
exit $((failures > 0))

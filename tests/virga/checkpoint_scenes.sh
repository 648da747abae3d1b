#!/usr/bin/env bash
# Our scenes go on from checkpoints to the bytes of the whole render: 3 small frames of each, after the
# pre-roll and after each frame.
# Usage: checkpoint_scenes.sh VIRGA SOURCE [SCENE...]: all scenes of assets/scenes, or those of these names.
virga=$1 source=$2
shift 2
. "$(cd "$(dirname "$0")" && pwd)/common.sh" "$virga"
[ $# -gt 0 ] || set -- $(cd "$source/assets/scenes" && ls *.yaml | sed 's/\.yaml$//')

# Options that make a scene small: pre-rolls are short, and water has few particles. A calibrated camera has its aspect.
small() {
    grep -q 'calibration:' "$1" && echo "--size 96x72" || echo "--size 96x54"
    grep -q 'preroll_s' "$1" && echo "--set frames.preroll_s=0.2"
    grep -q '^  solver:' "$1" && echo "--set water.solver.spacing_m=0.05"
}

# render NAME FOLDER OPTION...
render() {
    local file=$source/assets/scenes/$1.yaml folder=$work/$2
    shift 2
    timeout 900 "$virga" render "$file" -o "$folder" --device "$device" $(small "$file") "$@" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "render $file $*"; }
}

for name; do
    render "$name" "$name.whole" --frames 1-3
    render "$name" "$name.saved" --frames 1-3 --simulate --checkpoint-every 1
    for from in preroll 0001 0002; do
        [ -f "$work/$name.saved/checkpoint.$from.virga" ] || continue
        next=$([ $from = preroll ] && echo 1 || echo $((10#$from + 1)))
        mkdir "$work/part"
        cp "$work/$name.saved/checkpoint.$from.virga" "$work/part"
        render "$name" part --frames "$next-$next"
        grep -q '^starts from the checkpoint' "$work/log" || fail "$name: checkpoint $from is not used"
        cmp -s "$work/$name.whole/frame.000$next.exr" "$work/part/frame.000$next.exr" ||
            fail "$name: frame $next from checkpoint $from differs"
        rm -r "$work/part"
    done
    rm -r "$work/$name.whole" "$work/$name.saved"
    echo "$name: done"
done
exit $((failures > 0))

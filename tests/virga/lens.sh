#!/usr/bin/env bash
# A lens in the program: blur by depth agrees with sub-frames that look through the lens, the focus follows keys and
# names, panes are blurred by their own depth, and what is wrong with a lens is one line.
# Usage: lens.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" oiiotool

# A floor, a thin pole before the camera, a wall behind with lamps in it, and a board between them, which is in focus.
quad() { # NAME MATERIAL x0 x1 y0 y1 z
    printf 'o %s\nusemtl %s\n' "$1" "$2"
    printf 'v %s %s %s\n' "$3" "$5" "$7" "$4" "$5" "$7" "$4" "$6" "$7" "$3" "$6" "$7"
    printf 'f -4 -3 -2 -1\n'
}
{
    echo 'mtllib chart.mtl'
    printf 'o floor\nusemtl gray\nv -20 0 -9\nv 20 0 -9\nv 20 0 9\nv -20 0 9\nf -4 -1 -2 -3\n'
    quad wall dark -9 9 0 6 -9
    quad lamp_a lamp -1.7 -1.2 1.3 1.8 -8.9
    quad lamp_b lamp 1.0 1.3 1.8 2.1 -8.9
    quad board gray 0.1 0.5 0.7 1.2 -2
    quad pole red -0.12 -0.10 0 3 1.2
} >"$work/chart.obj"
cat >"$work/chart.mtl" <<'END'
newmtl gray
Kd 0.5 0.5 0.5
newmtl dark
Kd 0.05 0.06 0.1
newmtl red
Kd 0.6 0.1 0.1
newmtl lamp
Kd 0 0 0
Ke 3 2.4 1.2
END
cat >"$work/chart.yaml" <<'END'
virga: 1
meshes: [{file: chart.obj}]
environment: {zenith: [0.3, 0.35, 0.4], horizon: [0.4, 0.4, 0.4]}
camera:
  focal_mm: 50
  aperture_f: 0.25
  blades: 5
  focus_on: board
  keys: [{position_m: [0, 1.2, 2], look_at_m: [0, 1.2, 0]}]
frames: {fps: 24, first: 1, last: 48, size: [96, 64]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 0}
END

# render FOLDER OPTION...
frames=1
render() {
    local folder=$work/$1
    shift
    timeout 200 "$virga" render "$work/chart.yaml" -o "$folder" --device "$device" --frames "$frames" "$@" \
        >"$work/log" 2>&1 || { cat "$work/log"; fail "render $*"; }
    ! grep '^validation: ' "$work/log" || fail "render $*: validation"
}

# Mean of a picture, and mean difference of two, of red, green and blue.
mean() { oiiotool --stats "$1" | awk '/Stats Avg/ { print ($3 + $4 + $5) / 3 }'; }
differ() {
    oiiotool "$1" --ch R,G,B "$2" --ch R,G,B --absdiff -d float -o "$work/difference.exr" && mean "$work/difference.exr"
}
is() { awk -v a="$1" -v b="$3" "BEGIN { exit !(a $2 b) }"; }

# The tolerance: blur by depth differs from 128 looks through the lens by 5 % of the picture's mean. A sharp picture
# differs by more than 15 %. Of the light 4 % may be missing: looks beside the pole see more of the lamp that it hides.
render gather --samples 16 --layers beauty,depth
render exact --samples 128 --layers beauty,depth --set camera.blur=exact
render sharp --samples 4 --layers beauty,depth --set camera.aperture_f=0
light=$(mean "$work/exact/frame.0001.exr")
gather=$(differ "$work/gather/frame.0001.exr" "$work/exact/frame.0001.exr")
sharp=$(differ "$work/sharp/frame.0001.exr" "$work/exact/frame.0001.exr")
echo "mean light $light, difference of gather $gather, of a sharp picture $sharp"
is "$gather" '<' "$(awk "BEGIN { print 0.05 * $light }")" || fail "gather differs by $gather of $light"
is "$sharp" '>' "$(awk "BEGIN { print 0.15 * $light }")" || fail "a sharp picture differs only by $sharp of $light"
kept=$(awk -v a="$(mean "$work/gather/frame.0001.exr")" -v b="$light" 'BEGIN { print a / b }')
is "$kept" '>' 0.96 && is "$kept" '<' 1.01 || fail "gather has $kept of the light"

# Without the pole no light is hidden, and all of it is kept.
sed '/^o pole/,$d' "$work/chart.obj" >"$work/open.obj"
cp "$work/chart.yaml" "$work/full.yaml"
sed -i 's/chart.obj/open.obj/' "$work/chart.yaml"
render open --samples 16 --layers beauty,depth
render open_sharp --samples 16 --layers beauty,depth --set camera.aperture_f=0
cp "$work/full.yaml" "$work/chart.yaml"
kept=$(awk -v a="$(mean "$work/open/frame.0001.exr")" -v b="$(mean "$work/open_sharp/frame.0001.exr")" \
    'BEGIN { print a / b }')
is "$kept" '>' 0.995 && is "$kept" '<' 1.005 || fail "without the pole gather has $kept of the light"

# A rack focus: at its keys the focus is on what they name, and the whole way there it is between them.
keys='[{time_s: 0, focus_on: board}, {time_s: 0.125, focus_on: lamp_b}]'
same() { oiiotool "$work/$1/frame.$2.exr" "$work/$3/frame.$4.exr" --fail 0.002 --diff >/dev/null; }
frames=1-4
render keys --layers beauty --set "camera.focus_keys=$keys"
frames=1
render board --layers beauty
render lamp --layers beauty --set camera.focus_on=lamp_b
render there --layers beauty --set "camera.focus_keys=[{time_s: 0, focus_m: 10.9}]"
same keys 0001 board 0001 || fail "the rack focus does not begin on the board"
same keys 0004 lamp 0001 || fail "the rack focus does not end on the lamp"
same lamp 0001 there 0001 || fail "the lamp is not in focus 10.9 m away"
same keys 0002 keys 0003 && fail "the focus does not move"

# What is wrong is one line, and the exit code that of a wrong command line.
wrong() { # TEXT OPTION...
    local text=$1
    shift
    timeout 60 "$virga" render "$work/chart.yaml" -o "$work/wrong" --device "$device" --frames 1 "$@" >"$work/log" 2>&1
    [ $? = 2 ] && grep -qF -- "$text" "$work/log" || { cat "$work/log"; fail "$*: no '$text'"; }
}
wrong "camera.focus_on: expected a pane's name" --set camera.focus_on=moon
wrong "camera.focus_keys.1.focus_on: expected a pane's name" \
    --set 'camera.focus_keys=[{focus_on: wall}, {time_s: 1, focus_on: moon}]'
wrong 'camera.aperture_mm: expected it without aperture_f' --set camera.aperture_mm=3
wrong 'camera.focal_mm: expected an angle of view' --set camera.sensor_mm=1000 --set camera.focal_mm=1
"$virga" check "$work/chart.yaml" --set camera.focus_on=moon >"$work/log" 2>&1
[ $? = 2 ] && grep -q "camera.focus_on: expected a pane's name" "$work/log" || fail "check finds the moon"
"$virga" check "$work/chart.yaml" >"$work/log" && grep -q 'lens  *50 mm, f/0.25, focus on board' "$work/log" ||
    fail "check does not print the lens"

[ $failures = 0 ] || exit 1

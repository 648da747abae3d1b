#!/usr/bin/env bash
# Wet air in the program: it spreads a lamp's light and keeps it, is a layer of its own, works with a lens and before a
# pane, and is not there where it is off.
# Usage: bloom.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" oiiotool

# A lamp before a wall, 40 m away.
quad() { # NAME MATERIAL x0 x1 y0 y1 z
    printf 'o %s\nusemtl %s\n' "$1" "$2"
    printf 'v %s %s %s\n' "$3" "$5" "$7" "$4" "$5" "$7" "$4" "$6" "$7" "$3" "$6" "$7"
    printf 'f -4 -3 -2 -1\n'
}
{
    echo 'mtllib chart.mtl'
    quad wall dark -60 60 -60 60 -41
    quad lamp lamp -0.6 0.6 -0.6 0.6 -40
} >"$work/chart.obj"
printf 'newmtl dark\nKd 0.02 0.02 0.02\nnewmtl lamp\nKd 0 0 0\nKe 60 60 60\n' >"$work/chart.mtl"
cat >"$work/chart.yaml" <<'END'
virga: 1
meshes: [{file: chart.obj}]
environment: {zenith: [0.01, 0.01, 0.01], horizon: [0.01, 0.01, 0.01], ground: [0.01, 0.01, 0.01]}
camera:
  {fov_deg: 30, bloom_visibility_m: 200, bloom_drop_um: 40, keys: [{position_m: [0, 0, 0], look_at_m: [0, 0, -1]}]}
frames: {fps: 24, first: 1, last: 2, size: [128, 96], warm_start: false}
rain: {rate_mm_h: 0, max_drops: 1024, range_m: 4, occlusion_size: 0}
END
on=camera.bloom=true

# value FILE X Y [CHANNELS]: red there; mean FILE: of red
value() {
    oiiotool "$1" --ch "${4:-R}" --cut "1x1+$2+$3" --printstats | awk '/Stats Avg/ { print $3 }'
}
mean() { oiiotool "$1" --ch R --printstats | awk '/Stats Avg/ { print $3 }'; }
near() { # WHAT A B PART
    awk -v a="$2" -v b="$3" -v part="$4" 'BEGIN { d = a - b; exit !(b > 0 && d * d <= part * part * b * b) }' ||
        fail "$1: $2 is not $3"
}
less() { awk -v a="$2" -v b="$3" 'BEGIN { exit !(a < b) }' || fail "$1: $2 is not less than $3"; }

draw chart off --frames 1 --samples 4
draw chart bloom --frames 1 --samples 4 --set $on
for folder in off bloom; do cp "$work/$folder/frame.0001.exr" "$work/$folder.exr"; done
near 'the light of the picture' "$(mean "$work/bloom.exr")" "$(mean "$work/off.exr")" 0.005
less 'the lamp' "$(value "$work/bloom.exr" 64 48)" "$(value "$work/off.exr" 64 48)"
less 'beside the lamp' "$(value "$work/off.exr" 73 48)" "$(value "$work/bloom.exr" 73 48)"
oiiotool --info -v "$work/off.exr" | grep -q 'bloom\.R' && fail 'a layer of what is off'
less 'the layer' 0.001 "$(value "$work/bloom.exr" 73 48 bloom.R)"

# Off is off, whatever the air.
draw chart same --frames 1 --samples 4 --set camera.bloom=false --set camera.bloom_drop_um=3
oiiotool --ch R,G,B,A "$work/same/frame.0001.exr" -o "$work/a.exr"
oiiotool --ch R,G,B,A "$work/off.exr" -o "$work/b.exr"
idiff -q "$work/a.exr" "$work/b.exr" >/dev/null || fail 'the picture changes where it is off'

# A lens blurs what it sees through that air; a pane shows it. Smooth layers are drawn in some sub-frames only.
draw chart lens --frames 1 --samples 4 --set $on --set camera.aperture_f=1 --set camera.focus_m=10
less 'beside the lamp, with a lens' "$(value "$work/off.exr" 73 48)" "$(value "$work/lens/frame.0001.exr" 73 48)"
near 'the light with a lens' "$(mean "$work/lens/frame.0001.exr")" "$(mean "$work/off.exr")" 0.02
pane='glass=[{shape: flat, width_m: 2, height_m: 2, follow: camera, position_m: [0, -1, 0.5], max_drops: 256}]'
draw chart pane --frames 1 --samples 16 --set $on --set "$pane" --water-velocity 50
near 'the light behind a pane' "$(mean "$work/pane/frame.0001.exr")" "$(mean "$work/bloom.exr")" 0.05
draw chart pixel --frames 1 --samples 1 --set $on --size 1x1

# Errors, and what check says.
for bad in visibility_m=0:'20 to 20000' drop_um=2:'3 to 200'; do
    "$virga" check "$work/chart.yaml" --set "camera.bloom_${bad%%:*}" >"$work/log" 2>&1
    [ $? = 2 ] && grep -q "expected a number from ${bad#*:}" "$work/log" || { cat "$work/log"; fail "$bad"; }
done
"$virga" check "$work/chart.yaml" --set $on >"$work/log" && grep -q 'bloom .*40 um, visibility 200 m' "$work/log" ||
    fail 'check does not print the air'
timeout 60 "$virga" render "$work/chart.yaml" -o "$work/none" --device "$device" --layers bloom >"$work/log" 2>&1
[ $? = 2 ] && grep -q 'the scene has no bloom; expected camera.bloom: true' "$work/log" || fail 'a layer that is off'

[ $failures = 0 ] || exit 1

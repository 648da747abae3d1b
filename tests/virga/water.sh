#!/usr/bin/env bash
# Water from files of particles, from the files to surfels and statistics; what is wrong with the files is one line.
# Usage: water.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3
python3 "$here/make_particles.py" "$work" 4
cat >"$work/ball.yaml" <<'YAML'
virga: 1
camera: {keys: [{position_m: [0, 1, 2], look_at_m: [0, 0.8, 0]}]}
frames: {fps: 20, first: 1, last: 8, size: [32, 32]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
water: {files: ball_%04d.ply, rate_hz: 10, spray_density: 0}
YAML

# render FOLDER OPTION...
render() {
    local folder=$work/$1
    shift
    timeout 120 "$virga" render "$work/ball.yaml" -o "$folder" --device "$device" --points --stats "$@" \
        >"$work/log" 2>&1 || { cat "$work/log"; fail "render $*"; }
    ! grep '^validation: ' "$work/log" || fail "render $*: validation"
}

# Frames 1, 3 and 5 have a file, frame 4 is between two. A frame alone is the same.
render all --frames 1-5 --meshes
grep -q 'spacing_m: guessed 0.02.*a particle is .*e-06 m^3 (water.volume is 1)' "$work/log" || {
    cat "$work/log"
    fail "no line about the guess"
}
for frame in 1:0 3:0.1 4:0.15 5:0.2; do
    python3 "$here/check_water.py" "$work/all" ${frame%:*} ${frame#*:} || fail "surfels of frame $frame"
done
render alone --frames 4 --meshes
for file in water water_mesh; do
    cmp "$work/all/$file.0004.ply" "$work/alone/$file.0004.ply" || fail "$file of frame 4 alone is another one"
done

# What does not fit is said, also of the only frame.
for size in surfels=256 blocks=64; do
    render few --frames 3 --set "water.max_$size"
    grep -q "^virga: .* found no room; water_def.max_${size%=*} is ${size#*=}" "$work/log" ||
        { cat "$work/log"; fail "no line about max_$size"; }
done

# Its volume, too, is that of the particles that there is room for.
render part --frames 3 --set water.max_particles=100
python3 - "$work/part/stats.jsonl" <<'PY' || fail "the volume of 100 particles"
import json, sys
water = json.loads(open(sys.argv[1]).readline())["water"]
sys.exit(water["particles"] != 100 or abs(water["volume_l"] / (99 * 0.02 ** 3 * 1000) - 1) > 0.1)
PY

# Volumes, where the program was built with OpenVDB.
if "$virga" help render | grep -q 'built without OpenVDB'; then
    "$virga" render "$work/ball.yaml" -o "$work/volumes" --volumes 2>"$work/log" && fail "volumes without OpenVDB"
    grep -q 'built without OpenVDB' "$work/log" || fail "no line about volumes"
else
    render volumes --frames 3-4 --volumes
    render volume --frames 4 --volumes
    cmp "$work/volumes/water_density.0004.vdb" "$work/volume/water_density.0004.vdb" || fail "a volume alone is another"
    cmp -s "$work/volumes/water_density.0003.vdb" "$work/volume/water_density.0004.vdb" && fail "volumes do not change"
fi

# The ball covers some of the picture, and as much with sub-frames, which blur it.
if command -v oiiotool >/dev/null; then
    covered() { # FOLDER OPTION...
        render "$@" --frames 5 --size 96x96 --layers beauty,water --set frames.shutter_deg=360
        oiiotool --stats "$work/$1/frame.0005.exr" | awk '/Stats Avg/ { print $(NF - 1) }' # water.A, the last
    }
    sharp=$(covered sharp)
    blurred=$(covered blurred --samples 4)
    awk -v a="$sharp" -v b="$blurred" 'BEGIN { exit !(a > 0.002 && a < 0.1 && b > 0.9 * a && b < 1.1 * a) }' ||
        fail "water covers '$sharp' of the picture, and '$blurred' with sub-frames"
    cmp -s "$work/sharp/frame.0005.exr" "$work/blurred/frame.0005.exr" && fail "sub-frames do not blur the water"

    # Layers of data: the ball is 0.2 m thick, has normals of all directions that are seen, and falls at 0.98 m/s, which
    # at a distance of 1.9 m is 10.6 pixels a frame downwards and none to the side.
    render data --frames 3 --size 384x384 --layers water_thickness,water_normal,water_velocity \
        --set water.spray_density=0.4
    # normal X, Y, Z, thickness, velocity X, Y: files have channels in the order of their names
    oiiotool --stats "$work/data/frame.0003.exr" | awk '
        /Stats Min/ { for (i = 1; i <= 6; i++) low[i] = $(i + 2) }
        /Stats Max/ { for (i = 1; i <= 6; i++) high[i] = $(i + 2) }
        END { exit !(high[4] > 0.19 && high[4] < 0.21 && high[3] > 0.98 && high[3] <= 1 && high[1] > 0.9 &&
                     low[1] < -0.9 && high[2] > 0.9 && low[2] < -0.9 && high[6] > 10 && high[6] < 11.2 && low[6] >= 0 &&
                     high[5] < 0.2 && low[5] > -0.2) }' ||
        { oiiotool --stats "$work/data/frame.0003.exr"; fail "thickness, normals or velocity of the water"; }
    # Spray as points: the droplets that stats.jsonl counts.
    counted=$(grep -o '"droplets":[0-9]*' "$work/data/stats.jsonl" | cut -d: -f2)
    [ "$counted" -gt 0 ] && grep -aq "^element vertex $counted\$" "$work/data/water_spray.0003.ply" ||
        fail "water_spray has not the $counted droplets of stats.jsonl"
fi

# Z up, and turned back.
render turned --frames 3 --set water.up=z --set 'water.rotation_deg=[90, 0, 0]'
python3 "$here/check_water.py" "$work/turned" 3 0.1 || fail "surfels of a turned frame"

# expect WHAT OPTION...: the check refuses, in one line that has WHAT.
expect() {
    local what=$1 said
    shift
    said=$(timeout 60 "$virga" check "$work/ball.yaml" "$@" 2>&1 >"$work/out")
    [ $? = 2 ] && [ "$(wc -l <<<"$said")" = 1 ] && grep -qF -- "$what" <<<"$said" || fail "$what: got '$said'"
}
said=$("$virga" check "$work/ball.yaml" 2>/dev/null) || fail "check of a good scene"
grep -q 'particles .*4 files, 0.3 s, up to 516 particles with velocity and with ids; spacing 0.02' <<<"$said" ||
    fail "check says: $said"
# says LINES WHAT OPTION...: the check is good, with so many lines on standard error, one of which has WHAT.
says() {
    local lines=$1 what=$2 said
    shift 2
    said=$(timeout 60 "$virga" check "$work/ball.yaml" "$@" 2>&1 >"$work/out")
    [ $? = 0 ] && [ "$(grep -c . <<<"$said")" = "$lines" ] &&
        grep -qF -- "$what" <<<"$said" || fail "$what: got '$said'"
}
says 2 'max_particles: expected at most 100 particles at once, got up to 516: 416 are left out' \
    --set water.max_particles=100
grep -q '416 of them are left out' "$work/out" || fail "check does not print what is left out"
says 2 'got up to 1032 (those of two files, as there are no ids): 32 are left out' \
    --set water.max_particles=1000 --set water.ids=none
says 2 'water.volume: expected about 1: 0.8 makes a particle 6.5' --set water.volume=0.8
says 1 'water.volume: expected about 0.3: 1 makes a particle 2.7e-05 m^3' --set water.spacing_m=0.03
grep -q ' m, volume 2.7e-05 m^3 each' "$work/out" || fail "check does not print the volume"
says 0 '' --set water.spacing_m=0.02
expect 'no file has such a name' --set water.files=none_%04d.ply
expect 'expected one number like %04d' --set water.files=ball_%s.ply
expect 'ball_0009.ply is missing' --set water.first=9 --set water.step=2
expect 'expected a whole number' --set water.first=1.5
expect 'cannot read' --set water.files=none.ply
mv "$work/ball_0012.ply" "$work/kept"
expect 'ball_0012.ply is missing; expected the numbers 10 to 13 in steps of 1'
head -c 5000 "$work/kept" >"$work/ball_0012.ply"
expect 'ball_0012.ply: byte 5000: the file ends at byte 5000, expected 4 bytes here'
printf 'ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n' \
    >"$work/ball_0013.ply"
mv "$work/kept" "$work/ball_0012.ply"
"$virga" check "$work/ball.yaml" >"$work/out" 2>&1 || { cat "$work/out"; fail "a file without particles"; }
expect 'no guess from these particles' --set water.files=ball_0013.ply

[ $failures = 0 ] && echo "water is as its particles are"
exit $((failures > 0))

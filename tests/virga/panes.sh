#!/usr/bin/env bash
# Panes of a small scene: layers, point caches and statistics of a windshield with wipers that moves with the camera and
# of a window that stands; a range of frames alone is as in the whole run; footage behind the panes instead of the
# scene; what is wrong in one line.
# Usage: panes.sh VIRGA OPEN_POINTS
set -u
virga=$1 open_points=$2
device=${VIRGA_TEST_DEVICE:-cpu}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

python3 -c pass 2>/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
for tool in exrinfo oiiotool idiff; do
    command -v $tool >/dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

# A floor, and a visor whose UVs are metres.
cat >"$work/room.obj" <<'OBJ'
o floor
v -9 0 -20
v 9 0 -20
v 9 0 20
v -9 0 20
f 4 3 2 1
o visor
v -0.2 1.4 -3
v 0.2 1.4 -3
v 0.2 1.7 -3
v -0.2 1.7 -3
vt 0 0
vt 0.4 0
vt 0.4 0.3
vt 0 0.3
f 5/1 6/2 7/3 8/4
OBJ
python3 "$here/check_panes.py" bumps "$work/bumps.png" || exit 1
# Both panes, and the windshield alone: each pane builds its own pipelines, which is most of what a render costs here.
cat >"$work/scene.yaml" <<'YAML'
virga: 1
meshes: [{file: room.obj}]
camera:
  keys:
    - {time_s: 0, position_m: [0, 1.2, 6], look_at_m: [0, 1.2, 0]}
    - {time_s: 1, position_m: [0, 1.2, 1], look_at_m: [0, 1.2, -5]}
frames: {fps: 24, first: 1, last: 12, size: [96, 54]}
rain: {rate_mm_h: 100, wind_m_s: [0, 0, 4], max_drops: 1024, occlusion_size: 64, near_fade_m: 1}
glass:
  - name: window
    position_m: [0.5, 0.5, -4]
    yaw_deg: 180
    kind: dirty
    max_texels: 256
    bumps: {file: bumps.png, size_mm: [50, 50], depth_mm: 0.3}
  - name: shield
    shape: windshield
    follow: camera
    position_m: [0, -0.3, 1]
    kind: clean
    frame_m: 0.1
    max_texels: 256
    wipers:
      - {pivot_m: [0.7, 0], reach_m: 0.6, blade_m: 0.5, low_deg: 175, high_deg: 60, sweep_s: 0.3}
      - {pivot_m: [0.2, 0], reach_m: 0.3, blade_m: 0.2, low_deg: 20, high_deg: 90, drive: keys,
         keys: [{time_s: 0, angle_deg: 20}, {time_s: 0.5, angle_deg: 90}], drawn: false}
YAML
sed '/name: window/,/bumps:/d' "$work/scene.yaml" >"$work/shield.yaml"

# render FOLDER OPTION..., and the same of the windshield alone. Renders with the same passes as one before run without
# validation (VIRGA_VALIDATE=0).
render() {
    render_scene scene "$@"
}

render_shield() {
    render_scene shield "$@"
}

render_scene() {
    local scene=$work/$1.yaml folder=$work/$2
    shift 2
    timeout 120 "$virga" render "$scene" -o "$folder" --device "$device" "$@" 2>"$work/log" ||
        { cat "$work/log"; fail "render $*"; exit 1; }
    ! grep '^validation: ' "$work/log" || fail "render $*: validation"
}

# refuses TEXT OPTION...: exit code 2, one line with the text, and no files.
refuses() {
    local text=$1 code
    shift
    rm -rf "$work/bad"
    timeout 120 "$virga" render "$work/shield.yaml" -o "$work/bad" --device "$device" "$@" >"$work/stdout" 2>"$work/err"
    code=$?
    [ "$code" = 2 ] || { cat "$work/err"; fail "$*: exit code $code, expected 2"; }
    [ "$(wc -l <"$work/err")" = 1 ] && grep -qF -- "$text" "$work/err" ||
        { cat "$work/err"; fail "$*: expected one line with '$text'"; }
    [ -z "$(find "$work/bad" -type f 2>/dev/null)" ] || fail "$*: left files"
}

# ---- what there is

render out --points --stats
for frame in 0001 0012; do
    exrinfo -v "$work/out/frame.$frame.exr" >"$work/info" 2>&1
    for channel in "'glass.A': half" "'glass.R': half" "'refraction.X': float" "'refraction.Y': float"; do
        grep -q "$channel" "$work/info" || fail "frame $frame: no channel $channel"
    done
done
"$open_points" "$work/out/glass.0012.ply" >"$work/seen" || fail "assimp opens glass.0012.ply"
python3 "$here/check_panes.py" stats "$work/out/stats.jsonl" || fail "statistics of panes"
python3 "$here/check_panes.py" points "$work/out"/glass.00{06,07,12}.ply "$work/seen" "$work/out/stats.jsonl" ||
    fail "point caches of panes"
oiiotool "$work/out/frame.0012.exr" --ch glass.R,glass.G,glass.B,glass.A,refraction.X,refraction.Y --printstats \
    >"$work/pixels" || fail "oiiotool"
python3 "$here/check_panes.py" pixels "$work/pixels" || fail "pixels of panes"

# The beauty is the panes over what it would be without them; what they have no water on stays.
VIRGA_VALIDATE=0 render dry --frames 12 --layers beauty --set 'glass.0.shelter=1' --set 'glass.1.shelter=1'
render bare --frames 12 --layers beauty --set 'glass.0.shelter=1' --set 'glass.1.shelter=1' --set glass.0.style=paper
idiff -q -fail 0 "$work/dry/frame.0012.exr" "$work/bare/frame.0012.exr" >"$work/log" || fail "dry panes are seen"
oiiotool "$work/out/frame.0012.exr" -label full full --ch R=glass.A,G=glass.A,B=glass.A --mulc -1 --addc 1 -label seen \
    "$work/dry/frame.0012.exr" --ch R,G,B seen --mul full --ch R=glass.R,G=glass.G,B=glass.B --add -d float \
    -o "$work/composed.exr" && oiiotool "$work/out/frame.0012.exr" --ch R,G,B -d float -o "$work/beauty.exr"
idiff -q -fail 0.004 -failpercent 0.02 "$work/composed.exr" "$work/beauty.exr" >"$work/log" ||
    { cat "$work/log"; fail "the beauty is not the panes over the rest"; }

# ---- alone as in the whole, and going on

VIRGA_VALIDATE=0 render alone --frames 7-9 --points --stats
for frame in 0007 0008 0009; do
    cmp "$work/out/frame.$frame.exr" "$work/alone/frame.$frame.exr" || fail "frame $frame alone is another"
    cmp "$work/out/glass.$frame.ply" "$work/alone/glass.$frame.ply" || fail "drops of frame $frame alone are others"
done
python3 "$here/check_panes.py" same "$work/out/stats.jsonl" "$work/alone/stats.jsonl" ||
    fail "statistics alone are others"
rm "$work/alone/glass.0008.ply"
VIRGA_VALIDATE=0 render alone --frames 7-9 --points --stats --resume
cmp "$work/out/glass.0008.ply" "$work/alone/glass.0008.ply" || fail "going on writes other drops"
render_shield soft --frames 12 --samples 2 --layers beauty,glass
render_shield visor --frames 2 --layers glass \
    --set 'glass.1={name: visor, shape: mesh, mesh: visor, width_m: 0.4, height_m: 0.3, position_m: [0, 0, 0]}'

# ---- wet from the first frame on

# A shot that stands and has rained for 9 frames begins with what one without shows in its tenth. Wipers, which keep to
# the scene's time, are left out.
still="camera.keys=[{position_m: [0, 1.2, 6], look_at_m: [0, 1.2, 0]}]"
VIRGA_VALIDATE=0 render later --frames 10-11 --points --layers beauty,glass --set "$still" --set 'glass.1.wipers=[]'
render wet --frames 1-2 --points --layers beauty,glass --set "$still" --set 'glass.1.wipers=[]' \
    --set frames.preroll_s=0.375
for frame in 1 2; do
    idiff -q -fail 0 "$work/later/frame.00$((frame + 9)).exr" "$work/wet/frame.000$frame.exr" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "frame $frame after a pre-roll is another"; }
    cmp "$work/later/glass.00$((frame + 9)).ply" "$work/wet/glass.000$frame.ply" ||
        fail "drops of frame $frame after a pre-roll are others"
done
# Wipers begin where the scene says, however long it has rained; and a frame alone is as in the whole.
render_shield swept --frames 1-3 --points --set frames.preroll_s=1.2
VIRGA_VALIDATE=0 render_shield last --frames 3 --points --set frames.preroll_s=1.2
cmp "$work/swept/frame.0003.exr" "$work/last/frame.0003.exr" || fail "a frame alone after a pre-roll is another"
VIRGA_VALIDATE=0 render_shield begin --frames 1 --layers beauty --set rain.rate_mm_h=0
VIRGA_VALIDATE=0 render_shield begun --frames 1 --layers beauty --set rain.rate_mm_h=0 --set frames.preroll_s=1.25
idiff -q -fail 0 "$work/begin/frame.0001.exr" "$work/begun/frame.0001.exr" >"$work/log" 2>&1 ||
    fail "wipers begin elsewhere after a pre-roll"
VIRGA_VALIDATE=0 render_shield moved --frames 1 --layers beauty --set rain.rate_mm_h=0 \
    --set glass.0.wipers.0.phase_s=0.1
idiff -q -fail 0 "$work/begin/frame.0001.exr" "$work/moved/frame.0001.exr" >"$work/log" 2>&1 &&
    fail "wipers are not seen"

# ---- footage

oiiotool --pattern constant:color=0.2,0.4,0.6 96x54 3 -d half -o "$work/plate.0003.exr" &&
    oiiotool --pattern constant:color=0.6,0.4,0.2 192x108 3 -d half -o "$work/plate.0004.exr" || fail "making plates"
cp "$work/plate.0003.exr" "$work/plate.0001.exr" # the light of all frames
mkdir "$work/footage"
for frame in 1 2 3 4; do
    cp "$work/plate.000$((frame > 3 ? 4 : 3)).exr" "$work/footage/a.$frame.exr"
done
render_shield plate --frames 3-4 --plate "$work/plate.%04d.exr" --layers beauty,glass,depth
grep -q 'is 192 x 108, resampled to 96 x 54' "$work/log" || fail "resampling is not said"
oiiotool "$work/plate/frame.0004.exr" --ch R,G,B --printstats >"$work/pixels" || fail "oiiotool"
python3 "$here/check_panes.py" plate "$work/pixels" 0.6 0.4 0.2 || fail "the plate is not in the beauty"
VIRGA_VALIDATE=0 render_shield folder --frames 4 --plate "$work/footage" --layers beauty,glass,depth
idiff -q -fail 0 "$work/plate/frame.0004.exr" "$work/folder/frame.0004.exr" >"$work/log" ||
    fail "a folder of plates is another plate"
VIRGA_VALIDATE=0 render_shield still --frames 3 --plate "$work/plate.0003.exr" --layers beauty,glass,depth
idiff -q -fail 0 "$work/plate/frame.0003.exr" "$work/still/frame.0003.exr" >"$work/log" ||
    fail "one plate for all is another"
timeout 60 "$virga" render "$work/shield.yaml" -o "$work/still" --frames 3 --layers beauty,glass,depth --resume \
    --device "$device" 2>"$work/err" && fail "going on without the plate is no mistake"
grep -q 'has plate .*plate.0003.exr, expected (none)' "$work/err" || fail "another plate is not reported"

# ---- what is wrong

refuses "--plate: cannot read $work/plate.0002.exr, for frame 2" --frames 2-4 --plate "$work/plate.%04d.exr"
refuses "--plate: expected one number as in plate.%04d.exr" --plate "$work/plate.%s.exr"
refuses "--plate: expected one number" --plate "$work/%d/plate.%d.exr"
refuses "4 pictures in $work/footage, none for frame 5" --frames 5 --plate "$work/footage"
mkdir "$work/nothing"
refuses "--plate: no EXR, PNG, JPEG or TIFF pictures in the folder" --plate "$work/nothing"
refuses "glass.0.advancing_deg: expected at least the receding angle (20), got 10" --set glass.0.kind=dirty \
    --set glass.0.advancing_deg=10
refuses "glass.0.mesh: no mesh or material of the scene has 'sail' in its name" --set glass.0.shape=mesh \
    --set glass.0.mesh=sail
refuses "glass.0.mesh: no UVs of 'floor' lie on a pane of 1.4 x 0.75 m" --set glass.0.shape=mesh \
    --set glass.0.mesh=floor
refuses "glass.0.bumps.file: cannot read" \
    --set "glass.0.bumps={file: $work/room.obj, size_mm: [50, 50], depth_mm: 0.3}"
refuses "glass.0.mask: cannot read" --set "glass.0.mask=$work/room.obj"
refuses "--layers: the scene has no panes; expected a list of them, glass" --set 'glass=[]' --layers glass,refraction
refuses "frames.preroll_s: expected a number from 0 to 3600" --set frames.preroll_s=-1
refuses "expected one of paper, clean" --set glass.0.kind=wet

"$virga" check "$work/scene.yaml" >"$work/stdout" 2>&1 || { cat "$work/stdout"; fail "check"; }
for line in 'glass        window: flat, 1.4 x 0.75 m, dirty, physical style, 0 wipers' \
    'glass        shield: windshield, 1.4 x 0.75 m, clean, physical style, 2 wipers, with the camera' 'bumps '; do
    grep -qF "  $line" "$work/stdout" || { cat "$work/stdout"; fail "check does not say '$line'"; }
done
[ "$failures" = 0 ] && echo "panes are as they should be"
[ "$failures" = 0 ]

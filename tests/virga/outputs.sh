#!/usr/bin/env bash
# Every file that a render leaves, opened by programs that are not ours: layers, types and attributes of the frames,
# drops and droplets in the point caches, the lines of statistics.
# Usage: outputs.sh VIRGA SOURCE_ROOT OPEN_POINTS
set -u
virga=$1 source=$2 open_points=$3
device=${VIRGA_TEST_DEVICE:-cpu}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0 lacking=""

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

# render FOLDER OPTION...: the street, small. Without gusts, so that each drop falls with the mean wind, from the first
# frame on, so that ages and sums are those since then, and without drips, so that droplets are of splashes. Renders
# with the same passes as one before run without validation (VIRGA_VALIDATE=0).
render() {
    local folder=$work/$1
    shift
    timeout 120 "$virga" render "$source/assets/scenes/street.yaml" -o "$folder" --size 160x90 --device "$device" \
        --set rain.gust_m_s=0 --set frames.warm_start=false --set splash.drips.on=false "$@" 2>"$work/log" ||
        { cat "$work/log"; fail "render $*"; exit 1; }
    ! grep '^validation: ' "$work/log" || fail "render $*: validation"
}

python3 -c pass 2>/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

render out --frames 1-3 --points --stats --preview
out=$work/out

# Frames: as OpenEXR's own tool and as OpenImageIO see them.
# The exit code of exrinfo 3.1.5 is whatever lay on its stack; what went wrong it says on standard error.
header() { # FILE TEXT
    exrinfo -v "$1" >"$2" 2>"$work/log"
    [ -s "$2" ] && [ ! -s "$work/log" ] || { cat "$work/log"; fail "exrinfo $1"; }
}
if command -v exrinfo >/dev/null; then
    for frame in 1 2 3; do
        header "$out/frame.000$frame.exr" "$work/info.$frame"
    done
    "$virga" --version >"$work/version"
    python3 "$here/check_outputs.py" headers "$work"/info.{1,2,3} "$work/version" || fail "headers of frames"
else
    lacking="$lacking exrinfo"
fi
if command -v oiiotool >/dev/null; then
    for frame in 1 2 3; do
        oiiotool --info -v --stats "$out/frame.000$frame.exr" >"$work/pixels.$frame" ||
            fail "oiiotool frame.000$frame.exr"
    done
    python3 "$here/check_outputs.py" pixels "$work"/pixels.{1,2,3} || fail "pixels of frames"
    VIRGA_VALIDATE=0 render moving --frames 2 --layers velocity --water-velocity 1
    oiiotool --info -v --stats "$work/moving/frame.0002.exr" >"$work/moving.pixels" || fail "oiiotool moving"
    python3 "$here/check_outputs.py" moving "$work/moving.pixels" || fail "velocity of water"
else
    lacking="$lacking oiiotool"
fi

# Drops.
for frame in 1 2 3; do
    "$open_points" "$out/rain.000$frame.ply" >"$work/points.$frame" || fail "assimp opens rain.000$frame.ply"
done
python3 "$here/check_outputs.py" points "$out"/rain.000{1,2,3}.ply "$work"/points.{1,2,3} || fail "point caches"

# Droplets. At the first frame there are none.
for frame in 2 3; do
    "$open_points" "$out/splash.000$frame.ply" >"$work/droplets.$frame" || fail "assimp opens splash.000$frame.ply"
done
python3 "$here/check_outputs.py" droplets "$out"/splash.000{1,2,3}.ply "$work"/droplets.{2,3} \
    "$out"/rain.000{1,2,3}.ply "$out/stats.jsonl" || fail "point caches of droplets"

# Far from the origin they are where they are near it.
VIRGA_VALIDATE=0 render far --frames 2 --points --layers depth --set 'meshes.0.position_m=[1000, 0, -600]' \
    --set 'camera.keys=[{position_m: [1001.5, 1.7, -592], look_at_m: [999.5, 2.2, -612]}]'
python3 "$here/check_outputs.py" near "$work/far/splash.0002.ply" 1001.5 1.7 -592 || fail "droplets far from the origin"

# Rain drips from the awning, the balcony, the car and the trees; it is on them or it fell.
VIRGA_VALIDATE=0 render drips --frames 2 --stats --layers depth --set splash.drips.on=true
python3 "$here/check_outputs.py" drips "$work/drips/stats.jsonl" || fail "drips"

# In half a second more droplets land than a step of usual length has room for. None waits in the air.
VIRGA_VALIDATE=0 render long --frames 2 --stats --layers depth --set frames.fps=2 --set rain.rate_mm_h=120
python3 "$here/check_outputs.py" long "$work/long/stats.jsonl" || fail "long frames"

# A map of materials: metal ahead of the camera to the left, tiles behind it to the right, else what the meshes say.
base64 -d >"$work/map.png" <<<iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAAAAABX3VL4AAAADklEQVR4nGNg\
+M/wnxEABgECAIvKKHgAAAAASUVORK5CYII=
render mapped --frames 2-3 --points --stats --layers wetness --set "ground.material_map={file: $work/map.png, \
low_m: [-18.5, -12], high_m: [21.5, 28], materials: [metal, tile]}"
python3 "$here/check_outputs.py" mapped "$work/mapped/splash.0003.ply" "$work/mapped/stats.jsonl" "$out/stats.jsonl" ||
    fail "a map of materials"

# The beauty is the rain over the splashes over the plate. Splashes that cover nothing leave it as it would be without.
if command -v oiiotool >/dev/null; then
    VIRGA_VALIDATE=0 render bare --frames 3 --set splash.gain=0
    oiiotool "$out/frame.0003.exr" -label full "$work/bare/frame.0003.exr" -label bare \
        full --ch R=splash.A,G=splash.A,B=splash.A --mulc -1 --addc 1 -label shown \
        full --ch R=rain.A,G=rain.A,B=rain.A --mulc -1 --addc 1 -label seen \
        full --ch R=rain.R,G=rain.G,B=rain.B -label rain \
        bare --ch R,G,B rain --sub shown --mul \
        full --ch R=splash.R,G=splash.G,B=splash.B seen --mul --add rain --add -d float -o "$work/composed.exr" &&
        oiiotool "$work/bare/frame.0003.exr" --ch splash.R,splash.G,splash.B,splash.A -d float -o "$work/none.exr" &&
        oiiotool "$out/frame.0003.exr" --ch R,G,B -d float -o "$work/beauty.exr" || fail "taking frames apart"
    oiiotool --stats "$work/none.exr" | grep -q 'Constant: Yes' || fail "splashes without gain are drawn"
    idiff -q -fail 0.004 -failpercent 0.02 "$work/composed.exr" "$work/beauty.exr" >"$work/log" ||
        { cat "$work/log"; fail "the beauty is not the rain over the splashes over the plate"; }
fi

# Statistics and previews.
python3 "$here/check_outputs.py" stats "$out/stats.jsonl" || fail "stats.jsonl"
python3 "$here/check_outputs.py" previews "$out"/preview.000{1,2,3}.png || fail "previews"
if command -v ffmpeg >/dev/null; then
    [ -s "$out/preview.mp4" ] || fail "no preview.mp4"
fi
[ -z "$(find "$out" -name '.*' -type f)" ] || fail "left $(find "$out" -name '.*' -type f)"

# A seed beyond OpenEXR's signed integers, and frames behind the scene's last: the camera stays where its path ends.
VIRGA_VALIDATE=0 render behind --set frames.last=2 --set camera.keys.1.time_s=0.02 \
    --set camera.keys.2.time_s=0.0416667 --frames 2-3 --seed 4294967295 --layers depth \
    --set splash.on=false --set ground.on=false
for frame in 2 3; do
    [ -f "$work/behind/frame.000$frame.exr" ] || fail "no frame $frame of a scene with 2"
done
if command -v exrinfo >/dev/null; then
    for frame in 2 3; do
        header "$work/behind/frame.000$frame.exr" "$work/behind.$frame"
        grep -q "seed: string '4294967295'" "$work/behind.$frame" || fail "a large seed is not in the frame"
    done
    grep -q "time: double 0.08333" "$work/behind.3" || fail "time does not go on behind the last frame"
    [ "$(grep worldToCamera "$work/behind.2")" = "$(grep worldToCamera "$work/behind.3")" ] ||
        fail "the camera does not stay at its last key"
fi

[ "$failures" = 0 ] || exit 1
if [ -n "$lacking" ]; then
    echo "skipped in part: not installed:$lacking"
    exit 77
fi
echo "all outputs open and hold what they should"

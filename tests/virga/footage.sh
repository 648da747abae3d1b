#!/usr/bin/env bash
# Rain over pictures of others: PNG, JPEG and TIFF in, light added in between, and the same format out.
# Usage: footage.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" oiiotool idiff iinfo

cat >"$work/rain.yaml" <<'YAML'
virga: 1
camera: {keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1.5, -5]}]}
frames: {fps: 24, first: 1, last: 4, size: [64, 64]}
rain: {rate_mm_h: 100, max_drops: 1024, occlusion_size: 64, near_fade_m: 0.5}
YAML

render() {
    local out=$1
    shift
    draw rain "$out" --frames "${frames:-1}" --layers beauty,rain "$@"
}

refuses() {
    local expected=$1
    shift
    timeout 60 "$virga" render "$work/rain.yaml" -o "$work/refused" --device "$device" "$@" \
        >"$work/log" 2>&1
    local code=$?
    [ $code -eq 2 ] || fail "exit code $code, expected 2: $*"
    grep -qF -e "$expected" "$work/log" || { cat "$work/log"; fail "expected '$expected'"; }
    [ "$(grep -vc '^libpng' "$work/log")" -eq 1 ] || { cat "$work/log"; fail "more than one line: $*"; }
}

# All 256 codes in each channel, rising to different sides; no noise, so that a JPEG is close.
corners=topleft=0,1,0:topright=1,1,0:bottomleft=0,0,1:bottomright=1,0,1
plate() {
    oiiotool --pattern "fill:$corners" "$2" 3 -d "$3" -o "$work/$1" || fail "making $1"
}
plate a.png 256x64 uint8
plate a16.png 256x64 uint16
plate a.tif 256x64 uint8
plate a.jpg 256x64 uint8

render first --plate "$work/a.png" --set rain.rate_mm_h=0 --size plate
if grep -q 'built without OpenImageIO' "$work/log"; then
    echo "skipped: built without OpenImageIO"
    exit 77
fi
iinfo "$work/first/picture.0001.png" | grep -q '256 x   64, 3 channel, uint8 png' || fail "--size plate"

# ---- where nothing is added, all codes are as they were

export VIRGA_VALIDATE=0
unchanged() {
    local plate=$1 ending=$2 within=$3
    shift 3
    render same --plate "$work/$plate" --size plate --set rain.rate_mm_h=0 "$@"
    idiff -q -fail "$within" "$work/$plate" "$work/same/picture.0001.$ending" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "$plate is changed: $*"; }
    rm -rf "$work/same"
}
idiff -q -fail 0 "$work/a.png" "$work/first/picture.0001.png" >"$work/log" 2>&1 || fail "the plate is changed"
for curve in rec709 cineon; do
    unchanged a.png png 0 --set footage.curve=$curve
done
unchanged a16.png png 0 --set footage.curve=slog3
unchanged a.tif tif 0
unchanged a.jpg jpg 0.03
unchanged a.jpg png 0 --picture png

# ---- a color space of an OpenColorIO config, in place of the curve: primaries that are not ours, and a power
cat >"$work/config.ocio" <<'YAML'
ocio_profile_version: 2
roles: {default: lin, scene_linear: lin}
displays: {d: [!<View> {name: v, colorspace: wide}]}
colorspaces:
  - !<ColorSpace> {name: lin}
  - !<ColorSpace>
    name: wide
    to_scene_reference: !<GroupTransform>
      children:
        - !<ExponentTransform> {value: [2, 2, 2, 1]}
        - !<MatrixTransform> {matrix: [0.5, 0.25, 0.25, 0, 0.125, 0.75, 0.125, 0, 0, 0.25, 0.75, 0, 0, 0, 0, 1]}
YAML
space=(--set "footage.ocio_config=$work/config.ocio" --set footage.color_space=wide)
refuses 'footage.color_space: expected ' --plate "$work/a.png" --set footage.color_space=wide
if ! grep -q 'built without OpenColorIO' "$work/log"; then
    unchanged a.png png 0 "${space[@]}"
    unchanged a16.png png 0.0003 "${space[@]}"
    refuses "expected a color space of the config, got 'log'" --plate "$work/a.png" \
        --set "footage.ocio_config=$work/config.ocio" --set footage.color_space=log
    refuses 'footage.curve: expected auto' --plate "$work/a.png" "${space[@]}" --set footage.curve=srgb
fi

# ---- rain is added as light

render rain --plate "$work/a.png" --size plate
render again --plate "$work/a.png" --size plate
cmp "$work/rain/picture.0001.png" "$work/again/picture.0001.png" || fail "the same render has another dither"
idiff -q -fail 0 "$work/a.png" "$work/rain/picture.0001.png" >"$work/log" 2>&1 && fail "no rain over the plate"
oiiotool "$work/rain/frame.0001.exr" --ch R,G,B --clamp:min=0:max=1 \
    --colorconvert linear sRGB -d float -o "$work/beauty.exr" &&
    idiff -q -fail 0.0045 "$work/beauty.exr" "$work/rain/picture.0001.png" >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "the picture is not the beauty within one code"; }
render darker --plate "$work/a.png" --size plate --set footage.curve=linear --set rain.rate_mm_h=0
idiff -q -fail 0.02 "$work/rain/frame.0001.exr" "$work/darker/frame.0001.exr" >"$work/log" 2>&1 &&
    fail "the curve changes nothing"

# ---- a folder, and going on

mkdir "$work/folder"
cp "$work/a.png" "$work/folder/1.png"
cp "$work/a.jpg" "$work/folder/2.jpg"
frames=1-2 render folder --plate "$work/folder" --picture tif16
iinfo "$work/folder/picture.0002.tif" | grep -q '64 x   64, 3 channel, uint16 tiff' ||
    fail "--picture tif16"
rm "$work/folder/picture.0002.tif"
frames=1-2 render folder --plate "$work/folder" --picture tif16 --resume
[ -s "$work/folder/picture.0002.tif" ] || fail "--resume leaves out a missing picture"

# ---- a video: frame 2 of the scene is its second picture
cp "$work/a.png" "$work/v1.png"
oiiotool "$work/a.png" --flop -o "$work/v2.png"
if command -v ffmpeg >/dev/null &&
    ffmpeg -v error -i "$work/v%d.png" -c:v ffv1 -pix_fmt bgr0 "$work/v.mkv" </dev/null; then
    frames=2 render video --plate "$work/v.mkv" --size plate --set rain.rate_mm_h=0
    if ! grep -q 'built without FFmpeg' "$work/log"; then
        idiff -q -fail 0 "$work/v2.png" "$work/video/picture.0002.png" >"$work/log" 2>&1 ||
            { cat "$work/log"; fail "frame 2 of a video"; }
        refuses "--plate: 2 frames in $work/v.mkv, none for frame 3" --plate "$work/v.mkv" --frames 3
    fi
fi

# ---- what is wrong

refuses "--size plate: expected a --plate" --size plate
refuses "--picture: 'same' needs a --plate" --picture same
refuses "--picture: expected same, png, png16, jpg, tif, tif16, tif32 or none, got 'gif'" --picture gif
refuses "footage.curve: expected one of" --set footage.curve=gamma
head -c 300 "$work/a.png" >"$work/half.png"
refuses "--plate: cannot read $work/half.png: " --plate "$work/half.png"
cp "$work/a.jpg" "$work/wrong.tif"
refuses "--plate: cannot read $work/wrong.tif: not a TIFF picture" --plate "$work/wrong.tif"
cp "$work/a.jpg" "$work/a.gif"
refuses "expected a name that ends in .exr, .png, .jpg or .tif" --plate "$work/a.gif"

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

#!/usr/bin/env bash
# The camera of footage: a calibration, poses of a file, a speed; and what is said where they are wrong.
# Usage: footage_camera.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" idiff oiiotool exrheader

scene() {
    cat >"$work/rain.yaml" <<YAML
virga: 1
camera: {$1}
meshes: [${2:-}]
frames: {fps: 10, first: 1, last: 5, size: [64, 48]}
rain: {rate_mm_h: 100, max_drops: 1024, occlusion_size: 64, near_fade_m: 0.5}
YAML
}

render() {
    local out=$1
    shift
    draw rain "$out" --layers beauty,depth,velocity,rain "$@"
}

refuses() {
    local expected=$1
    shift
    timeout 60 "$virga" "$@" >/dev/null 2>"$work/log"
    local code=$?
    [ $code -eq 2 ] || { cat "$work/log"; fail "exit code $code, expected 2: $*"; }
    grep -qF -e "$expected" "$work/log" || { cat "$work/log"; fail "expected '$expected'"; }
    [ "$(wc -l <"$work/log")" -eq 1 ] || { cat "$work/log"; fail "more than one line: $*"; }
}

# Columns of worldToCamera, the position in the last one. The header has it row by row, of a matrix for rows of numbers.
is_at() {
    exrheader "$work/$1" | grep -A4 worldToCamera | tr -d '[](),' | tr ' ' '\n' | grep -E '^-?[0-9]' | xargs >"$work/at"
    python3 - "$work/at" $2 <<'PY' || fail "$1: the camera is not at $2"
import sys
m = [float(word) for word in open(sys.argv[1]).read().split()][-16:]
at = [-sum(m[12 + row] * m[4 * axis + row] for row in range(3)) for axis in range(3)]
wanted = [float(word) for word in sys.argv[2].split(",")]
sys.exit(max(abs(a - b) for a, b in zip(at, wanted)) > 1e-4)
PY
}

# ---- a calibration with its axis beside the middle gives what is cut out of a larger picture, here in pixels of a
# picture of twice the size
printf '%s\n' 'v -20 0 -20' 'v 20 0 -20' 'v 20 0 20' 'v -20 0 20' 'v 1 2 -5' 'f 1 4 3 2' 'f 1 2 5' >"$work/floor.obj"
keys='keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1, -5]},
    {time_s: 1, position_m: [1, 1.5, -3], look_at_m: [0, 1, -5]}]'
scene "fov_deg: 90, $keys" '{file: floor.obj}'
render whole --frames 3 --size 128x96
scene "calibration: {size_px: [128, 96], focal_px: [96, 96], center_px: [27.5, 35.5]}, $keys" '{file: floor.obj}'
render part --frames 3
for row in Z:1e-3 velocity.X:5e-3 velocity.Y:5e-3 rain.A:1e-3; do
    oiiotool "$work/whole/frame.0003.exr" --ch ${row%:*} --cut 64x48+50+30 -o "$work/whole.exr"
    oiiotool "$work/part/frame.0003.exr" --ch ${row%:*} -o "$work/part.exr"
    idiff -q -fail ${row#*:} "$work/whole.exr" "$work/part.exr" >"$work/log" ||
        { cat "$work/log"; fail "another ${row%:*}"; }
done
refuses 'camera.calibration.size_px: expected the aspect of the picture to be drawn (64 x 64), got 128 x 96' \
    render "$work/rain.yaml" -o "$work/refused" --device "$device" --size 64x64

# ---- the same calibration of a file
scene "$keys" '{file: floor.obj}'
echo '3 PINHOLE 128 96 96 96 28 36' >"$work/cameras.txt"
"$virga" check "$work/rain.yaml" --set camera.calibration.file=cameras.txt >"$work/log" 2>&1 &&
    grep -qF "focal length 96 x 96 pixels, 53.1 degrees high, of $work/cameras.txt" "$work/log" ||
    { cat "$work/log"; fail 'no calibration of a file'; }
refuses 'cameras.txt: expected camera to be one of 3, got 2' \
    check "$work/rain.yaml" --set 'camera.calibration={file: cameras.txt, camera: 2}'

# ---- poses: frame 3 is the third, and 2 m ahead of the first
printf '%s\n' '1 0 0 5 0 1 0 0 0 0 1 7' '1 0 0 5 0 1 0 0 0 0 1 8' '1 0 0 5 0 1 0 0 0 0 1 9' >"$work/poses.txt"
scene 'poses: {file: poses.txt}, height_m: 1.25'
render poses --frames 3
is_at poses/frame.0003.exr 0,1.25,-2
# Those of KITTI are of camera 0, and camera 3 is half a metre to the right.
printf 'P0: 48 0 31.5 0 0 48 23.5 0 0 0 1 0\nP3: 48 0 31.5 -24 0 48 23.5 0 0 0 1 0\n' >"$work/calib.txt"
scene 'poses: {file: poses.txt}, height_m: 1.25, calibration: {file: calib.txt, camera: "3"}'
VIRGA_VALIDATE=0 render beside --frames 3
is_at beside/frame.0003.exr 0.5,1.25,-2
scene 'poses: {file: poses.txt}, height_m: 1.25'
echo '1 0 0 5 0 1' >>"$work/poses.txt"
for command in "check $work/rain.yaml" "render $work/rain.yaml -o $work/refused --device $device"; do
    # shellcheck disable=SC2086
    refuses "poses.txt:4: expected 12 numbers of a pose (KITTI), got 6 numbers" $command
done

# ---- a speed
scene 'speed_m_s: 20, height_m: 1.25, pitch_deg: -10'
render speed --frames 2-3
is_at speed/frame.0002.exr 0,1.25,-2
is_at speed/frame.0003.exr 0,1.25,-4

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

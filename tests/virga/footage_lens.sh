#!/usr/bin/env bash
# Footage of a lens that bends lines: a plate stays as it is, and what is drawn lies on the bent lines.
# Usage: footage_lens.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" idiff oiiotool python3

# A strong barrel, as of a wide action camera. $1: where it stands; $2: meshes, or nothing; $3: k1, if another.
scene() {
    cat >"$work/rain.yaml" <<YAML
virga: 1
camera:
  $1
  calibration: {size_px: [160, 90], focal_px: [73.3, 73.2], center_px: [79.1, 45.5],
    distortion: [${3:--0.24}, 0.07, 0.0004, -0.0006, -0.008]}
meshes: [${2:-}]
environment: {zenith: [1, 1, 1], horizon: [1, 1, 1], ground: [1, 1, 1]}
frames: {fps: 10, first: 1, last: 2, size: [160, 90]}
rain: {rate_mm_h: 100, max_drops: 4096, occlusion_size: 64}
YAML
}

# ---- without rain a plate keeps its codes; with it, only pixels that rain covers change

scene 'speed_m_s: 0'
oiiotool --pattern noise:type=uniform:seed=1 160x90 3 -d uint8 -o "$work/a.png" || exit 1
draw rain none --frames 1 --plate "$work/a.png" --set rain.rate_mm_h=0 --set footage.depth_m=9
if grep -q 'built without OpenImageIO' "$work/log"; then
    echo "skipped: built without OpenImageIO"
    exit 77
fi
idiff -q -fail 0 "$work/a.png" "$work/none/picture.0001.png" >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "the plate is changed without rain"; }

export VIRGA_VALIDATE=0
draw rain some --frames 1 --plate "$work/none/picture.0001.png" --layers beauty,rain \
    --set rain.haze=0 --set footage.depth_m=9
# Where no rain is over the plate, its pixels are the same: 1 where alpha is 0, times the change.
oiiotool "$work/some/frame.0001.exr" --ch rain.A --mulc -1e9 --addc 1 --clamp:min=0:max=1 \
    "$work/none/frame.0001.exr" --ch R,G,B "$work/some/frame.0001.exr" --ch R,G,B --absdiff --chsum --printstats \
    --mul --printstats >"$work/log" || fail "comparing the frames"
grep 'Stats Max' "$work/log" >"$work/most"
[ "$(wc -l <"$work/most")" -eq 2 ] || { cat "$work/log"; fail "no two statistics"; }
tail -n 1 "$work/most" | grep -q 'Stats Max: 0.000000' || fail "the plate is changed where no rain is"
head -n 1 "$work/most" | grep -q 'Stats Max: 0.000000' && fail "no rain over the plate"

# ---- the edge of a wall, straight in 3D, is on its curve

printf '%s\n' 'newmtl black' 'Kd 0 0 0' >"$work/wall.mtl"
printf '%s\n' 'mtllib wall.mtl' 'usemtl black' 'v -40 -30 -6' 'v 40 -30 -6' 'v 40 4 -6' 'v -40 -2 -6' \
    'f 1 2 3 4' >"$work/wall.obj"
scene 'keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1.5, -5]}]' '{file: wall.obj}'
draw rain edge --frames 1 --samples 64 --layers beauty --set rain.rate_mm_h=0
oiiotool "$work/edge/frame.0001.exr" --ch G -d float -o "$work/edge.exr" &&
    oiiotool --dumpdata "$work/edge.exr" >"$work/edge.txt" || fail "reading the edge"
python3 - "$work/edge.txt" <<'PY' || fail "the edge is not on its curve within 0.05 pixels"
import re, sys
width, height = 160, 90
rows = [[0.0] * width for _ in range(height)]
for x, y, value in re.findall(r"Pixel \((\d+), (\d+)\): (\S+)", open(sys.argv[1]).read()):
    rows[int(y)][int(x)] = float(value)
k1, k2, p1, p2, k3 = -0.24, 0.07, 0.0004, -0.0006, -0.008
def seen(x, y):
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2 ** 2 + k3 * r2 ** 3
    return (73.3 * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + 79.6,
            73.2 * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + 46)
# y of the edge in a column: by halves along the edge
def curve(column):
    low, high = -9.0, 9.0
    for _ in range(60):
        middle = (low + high) / 2
        u, v = seen(middle / 6, (1.5 - (1 + 3 * middle / 40)) / 6)
        low, high = (middle, high) if u < column else (low, middle)
    return v
worst, count = 0, 0
for x in range(2, width - 2):
    wanted = curve(x + 0.5)
    row = int(wanted)
    # Shares of sky, in rows that the edge can be in. The wall mirrors a little of the sky.
    slope = (rows[row + 8][x] - rows[row + 3][x]) / 5
    wall = {y: rows[row + 3][x] + slope * (y - row - 3) for y in range(row - 3, row + 4)}
    sky = sum((rows[y][x] - wall[y]) / (rows[row - 4][x] - wall[y]) for y in wall)
    measured = row - 3 + sky
    worst, count = max(worst, abs(measured - wanted)), count + 1
print("edge: %.3f px off at most, in %d columns" % (worst, count))
sys.exit(worst > 0.05 or count < 150)
PY

# ---- what is wrong

scene 'speed_m_s: 0' '' -0.5
for command in "check $work/rain.yaml" "render $work/rain.yaml -o $work/refused --device $device"; do
    # shellcheck disable=SC2086
    timeout 60 "$virga" $command >/dev/null 2>"$work/log"
    code=$?
    [ $code -eq 2 ] || { cat "$work/log"; fail "exit code $code, expected 2: $command"; }
    grep -qF 'camera.calibration.distortion: expected a lens that can be undone over the whole picture' "$work/log" &&
        [ "$(wc -l <"$work/log")" -eq 1 ] || { cat "$work/log"; fail "a lens that folds is not said: $command"; }
done

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

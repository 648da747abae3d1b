#!/usr/bin/env bash
# Depth beside a plate: rain before and behind what it shows, against closed forms, and from several files.
# Usage: footage_depth.sh VIRGA CHECK_DEPTH
here=$(cd "$(dirname "$0")" && pwd)
check_depth=$2
. "$here/common.sh" "$1" python3 oiiotool

# Depth from 1 m at the left to 100 m at the right, as numpy.save writes it; and a small one of three rows.
python3 - "$work" <<'PYTHON' || exit 1
import struct, sys
def save(name, rows):
    head = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d), }" % (len(rows), len(rows[0]))
    values = [value for row in rows for value in row]
    with open(sys.argv[1] + "/" + name, "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + (head.ljust(117) + "\n").encode())
        file.write(struct.pack("<%df" % len(values), *values))
save("ramp.npy", [[100 ** (x / 255) for x in range(256)]] * 128)
save("rows.npy", [[0.0] * 4, [5.0] * 4, [20.0] * 4])
PYTHON
oiiotool --pattern constant:color=0.2,0.2,0.2 256x128 3 -d half -o "$work/grey.exr" || exit 1

cat >"$work/rain.yaml" <<'YAML'
virga: 1
camera: {fov_deg: 30, keys: [{position_m: [0, 1.5, 0], look_at_m: [0, 1.5, -5]}]}
frames: {fps: 4, first: 1, last: 20, size: [256, 128], shutter_deg: 30}
rain:
  rate_mm_h: 100
  sizes: table
  table: [{diameter_mm: 2.0, number: 1}, {diameter_mm: 2.1, number: 1}]
  occlusion_size: 0
  oscillation: 0
  soft_m: 0
  near_fade_m: 0
YAML

render() {
    local out=$1
    shift
    timeout 120 "$virga" render "$work/rain.yaml" -o "$work/$out" --plate "$work/grey.exr" --device "$device" \
        --layers beauty,depth,rain,haze "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "rendering $out"; }
}

refuses() {
    local expected=$1
    shift
    timeout 60 "$virga" render "$work/rain.yaml" -o "$work/refused" --frames 1 --device "$device" "$@" \
        >"$work/log" 2>&1
    local code=$?
    [ $code -eq 2 ] || fail "exit code $code, expected 2: $*"
    grep -qF -e "$expected" "$work/log" || { cat "$work/log"; fail "expected '$expected'"; }
}

# ---- density, length and veil at each depth

VIRGA_VALIDATE=0 render ramp --depth "$work/ramp.npy"
"$check_depth" "$work/ramp" 20 || fail "rain before the depth of the plate"

# ---- other depths; the first with validation

render rows --frames 1 --depth "$work/rows.npy" --size 64x48 --set footage.depth_scale=2
export VIRGA_VALIDATE=0
z() {
    oiiotool "$work/$1/frame.0001.exr" --ch Z --cut "1x1+10+$2" -d float -o "$work/z.exr"
    oiiotool --dumpdata "$work/z.exr" | sed -n 's/.*Pixel (.*): //p'
}
near() {
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > b * 0.9999 && a < b * 1.0001) }' || fail "$3: $1 m, expected $2"
}
[ "$(z rows 10)" = inf ] || fail "depth that is not known: $(z rows 10)"
near "$(z rows 20)" 10 "the middle row"
near "$(z rows 40)" 40 "the lower row"
render known --frames 1 --depth "$work/rows.npy" --size 64x48 --set footage.depth_m=7 --samples 2
near "$(z known 10)" 7 "footage.depth_m"
near "$(z known 20)" 5 "the middle row"
render constant --frames 1 --size 64x48 --set footage.depth_m=7
near "$(z constant 20)" 7 "footage.depth_m alone"
# The depth that a render wrote, for the next one.
render again --frames 1 --size 64x48 --depth "$work/known/frame.%04d.exr"
near "$(z again 20)" 5 "a depth of our own"

# ---- what is wrong

refuses "--depth: expected a --plate" --depth "$work/rows.npy"
refuses "--depth: cannot read $work/none.npy, for frame 1" --plate "$work/grey.exr" --depth "$work/none.npy"
refuses "--depth: cannot read $work/grey.exr: " --plate "$work/grey.exr" --depth "$work/grey.exr"
refuses "footage.disparity_base_m: expected more than 0" --plate "$work/grey.exr" --depth "$work/rows.npy" \
    --set footage.depth_kind=disparity
timeout 60 "$virga" render "$work/rain.yaml" -o "$work/rows" --plate "$work/grey.exr" --frames 1 --size 64x48 \
    --layers beauty,depth,rain,haze --set footage.depth_scale=2 --device "$device" --resume 2>"$work/log" &&
    fail "going on without the depth is no mistake"
grep -q 'has depth .*rows.npy, expected (none)' "$work/log" || { cat "$work/log"; fail "another depth is not said"; }

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

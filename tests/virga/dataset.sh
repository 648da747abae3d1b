#!/usr/bin/env bash
# Rain over folders of photographs: files, COCO, shards, going on; KITTI raw and Cityscapes.
# Usage: dataset.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$(realpath "$1")" oiiotool idiff iinfo python3

# make CODE FOLDER OPTION...: must end with this exit code.
make() {
    local expected=$1 folder=$2
    shift 2
    (cd "$work" && timeout 120 "$virga" dataset "$@" -o "$folder" --device "$device" \
        --set rain.max_drops=16384 --set camera.aperture_mm=0) >"$work/log" 2>&1
    local code=$?
    [ $code -eq "$expected" ] || { cat "$work/log"; fail "exit code $code, expected $expected: $*"; }
    ! grep '^validation: ' "$work/log" || fail "dataset $*: validation"
}

refuses() {
    local expected=$1
    shift
    make 2 refused "$@"
    grep -qF -e "$expected" "$work/log" || { cat "$work/log"; fail "expected '$expected'"; }
    [ "$(wc -l <"$work/log")" -eq 1 ] || { cat "$work/log"; fail "more than one line: $*"; }
}

# ---- pictures of two sizes and three formats, with a depth: 3 m at the left, 40 m at the right; a damaged picture is
# named, and the rest is made
mkdir -p "$work/in/sub" "$work/depths/sub"
corners=topleft=0.1,0.2,0:topright=0.3,0.3,0.2:bottomleft=0,0.1,0.3:bottomright=0.4,0.1,0.1
oiiotool --pattern "fill:$corners" 96x64 3 -d uint8 -o "$work/in/a.png" &&
    oiiotool --pattern "fill:$corners" 96x64 3 -d uint8 -o "$work/in/sub/b.jpg" &&
    oiiotool --pattern "fill:$corners" 64x48 3 -d uint16 -o "$work/in/c.png" || fail "making pictures"
python3 - "$work/depths" <<'PY' || exit 1
import struct, sys
head = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }"
for name in ("a", "sub/b", "c"):
    with open("%s/%s.npy" % (sys.argv[1], name), "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + (head.ljust(117) + "\n").encode())
        file.write(struct.pack("<4f", 3, 40, 3, 40))
PY
head -c 300 "$work/in/a.png" >"$work/in/z.png"
cp "$work/depths/a.npy" "$work/depths/z.npy"
make 3 one in --depth depths --rates 40
if grep -q 'built without OpenImageIO' "$work/log"; then
    echo "skipped: built without OpenImageIO"
    exit 77
fi
grep -q 'virga dataset: left out: cannot read in/z.png' "$work/log" || { cat "$work/log"; fail "z.png is not named"; }
[ -s "$work/one/40mm/boxes/c.json" ] && [ ! -e "$work/one/40mm/coco.json" ] || fail "the rest is not made"
rm "$work/in/z.png"
make 0 one in --depth depths --rates 40
for file in rain/a.png rain/sub/b.jpg layer/sub/b.exr mask/c.png boxes/c.json coco.json; do
    [ -s "$work/one/40mm/$file" ] || fail "no $file"
done
iinfo "$work/one/40mm/rain/c.png" | grep -q '64 x   48, 3 channel, uint16 png' || fail "another format"
idiff -q -fail 0 "$work/in/a.png" "$work/one/40mm/rain/a.png" >"$work/log" 2>&1 && fail "no rain"

# What the files say, against each other.
for name in a c; do
    oiiotool "$work/one/40mm/layer/$name.exr" --ch rain.A -d float -o "$work/alpha.exr" &&
        oiiotool --dumpdata "$work/alpha.exr" >"$work/$name.alpha" &&
        oiiotool --dumpdata "$work/one/40mm/mask/$name.png" >"$work/$name.mask" || fail "reading $name"
done
python3 "$here/check_coco.py" "$work/one/40mm/coco.json" "$work" a.png c.png || fail "boxes"

# ---- shards together are one run, byte for byte; and a run that goes on makes what is missing
export VIRGA_VALIDATE=0
for shard in 0/2 1/2; do
    make 0 two in --depth depths --rates 40 --shard $shard
done
diff -r "$work/one" "$work/two" >"$work/log" || { cat "$work/log"; fail "two shards are not one run"; }
rm "$work/two/40mm/mask/sub/b.png"
echo '{"info":{"virga":{"settings_hash":"0"}}}' >"$work/two/40mm/boxes/a.json"
touch "$work/now"
make 0 two in --depth depths --rates 40
diff -r "$work/one" "$work/two" >"$work/log" || { cat "$work/log"; fail "going on is not one run"; }
made=$(find "$work/two/40mm/rain" -type f -newer "$work/now" | wc -l)
[ "$made" -eq 2 ] || fail "$made pictures are made again, expected 2"
make 0 two in --depth depths --rates 40 --set rain.streak_gain=3 --shard 0/3
cmp -s "$work/one/40mm/rain/a.png" "$work/two/40mm/rain/a.png" && fail "another setting makes nothing"

# ---- KITTI: two cameras side by side are in the same rain
date=$work/kitti/2011_09_26 drive=2011_09_26/2011_09_26_drive_0001_sync
truth=$work/kd/train/2011_09_26_drive_0001_sync/proj_depth/groundtruth
for camera in 2 3; do
    mkdir -p "$work/kitti/$drive/image_0$camera/data" "$truth/image_0$camera"
    oiiotool --pattern "fill:$corners" 124x38 3 -d uint8 -o "$work/kitti/$drive/image_0$camera/data/0000000005.png"
    # 20 m, known in every fourth row of the lower half
    oiiotool --create 124x38 1 --fill:color=0.078125 124x1+0+20 --fill:color=0.078125 124x1+0+30 -d uint16 \
        -o "$truth/image_0$camera/0000000005.png"
done
mkdir -p "$work/kitti/$drive/oxts/data"
echo '49 8 112 0.03 0 -0.6 -6 -1 13.25 0.1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 4 11 6 6 6' \
    >"$work/kitti/$drive/oxts/data/0000000005.txt"
{
    echo 'calib_time: 09-Jan-2012 13:57:47'
    for camera in 2 3; do
        echo "S_0$camera: 1.3e+02 5e+01"
        echo "S_rect_0$camera: 124 38"
        echo "P_rect_0$camera: 72 0 61 $((camera * -18)) 0 72 17 0 0 0 1 0"
    done
} >"$date/calib_cam_to_cam.txt"
make 0 four kitti --layout kitti-raw --depth kd --rates 80 --min-coverage 0.003

# ---- Cityscapes: disparity of 20 m at the left, and none at the right
city=aachen/aachen_000000_000019
for kind in leftImg8bit disparity camera vehicle; do
    mkdir -p "$work/cityscapes/$kind/train/aachen"
done
oiiotool --pattern "fill:$corners" 128x64 3 -d uint8 -o "$work/cityscapes/leftImg8bit/train/${city}_leftImg8bit.png"
oiiotool --create 128x64 1 --fill:color=0.09 64x64 -d uint16 -o "$work/cityscapes/disparity/train/${city}_disparity.png"
echo '{"extrinsic": {"baseline": 0.2, "z": 1.2}, "intrinsic": {"fx": 2304, "fy": 2304, "u0": 1024, "v0": 512}}' \
    >"$work/cityscapes/camera/train/${city}_camera.json"
echo '{"speed": 8.5, "yawRate": 0}' >"$work/cityscapes/vehicle/train/${city}_vehicle.json"
make 0 five cityscapes --layout cityscapes --rates 5,50
python3 - "$work" <<'PY' || fail "what the layouts have is not found"
import json, math, sys
work, good = sys.argv[1], True
def expect(what, value, wanted, within=0):
    global good
    if abs(value - wanted) > within:
        print("%s: %r, expected %r" % (what, value, wanted))
        good = False
read = lambda path: json.load(open(work + "/" + path))
four, five = read("four/80mm/coco.json"), read("five/50mm/coco.json")
left, right = four["images"]
for image, speed, focal, rate in ((left, 13.25, 72, 80), (right, 13.25, 72, 80), (five["images"][0], 8.5, 144, 50)):
    own = image["virga"]
    expect("speed", own["speed_m_s"], speed)
    expect("focal length", own["focal_px"][0], focal, 1e-3)
    expect("depth", own["has_depth"], True)
    expect("visibility", own["visibility_m"], -math.log(0.05) / (0.5 * 0.312e-3 * rate ** 0.67), 1)
expect("wind of the other camera", right["virga"]["wind_m_s"][0], left["virga"]["wind_m_s"][0])
# A drop is to the left in the right picture, by focal length times the distance of the cameras over its depth.
def boxes_of(image):
    return {a["virga"]["drop"]: a for a in four["annotations"] if a["image_id"] == image["id"]}
def is_whole(a):
    box = a["bbox"]
    return 1 < box[0] < 122 - box[2] and 1 < box[1] < 36 - box[3] and a["virga"]["distance_m"] > 4
boxes = boxes_of(left), boxes_of(right)
both = [drop for drop in boxes[0] if drop in boxes[1] and all(is_whole(box[drop]) for box in boxes)]
for drop in both:
    a, b = boxes[0][drop], boxes[1][drop]
    x, y = a["bbox"][0] + a["bbox"][2] / 2 - 61.5, a["bbox"][1] + a["bbox"][3] / 2 - 17.5
    depth = a["virga"]["distance_m"] / math.sqrt(1 + (x * x + y * y) / 72 ** 2)
    expect("disparity of drop %d" % drop, a["bbox"][0] - b["bbox"][0], 72 * 0.25 / depth, 0.3)
print("%d drops in both pictures" % len(both))
sys.exit(not good or len(both) < 20)
PY

# ---- what is wrong
mkdir "$work/empty"
refuses 'expected folders with pictures'
refuses 'no EXR, PNG, JPEG or TIFF pictures in empty' empty
refuses 'cannot list the folder none' none
refuses '--rates: expected numbers from 0.01 to 200' in --rates 5,x
refuses '--rates: 5 is there twice' in --rates 5,5
refuses '--shard: expected I/N with I from 0 to N - 1, got 2/2' in --shard 2/2
refuses "--layout: expected kitti-raw or cityscapes, got 'kitti'" in --layout kitti
refuses '--depth: no empty/a.npy' in --depth empty
refuses 'footage.ground: expected none' in --set footage.ground=plane
refuses 'image_0N/data/NUMBER.png' in --layout kitti-raw
cp "$work/in/a.png" "$work/in/a.k.png"
cp "$work/in/a.png" "$work/in/a.tif"
refuses 'expected names that differ before the ending' in

[ $failures -eq 0 ] && echo "all is right"
exit $((failures > 0))

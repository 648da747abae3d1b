#!/usr/bin/env bash
# What drives through a scene throws the water of the ground: all of it is counted, and what is wrong with its keys is
# one line.
# Usage: vehicles.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3
write_road
# Its upper side is a roof of 1 m^2; the wheel is a triangle around the origin.
cat >"$work/cart.obj" <<'END'
o roof
v -0.5 1 -0.5
v 0.5 1 -0.5
v 0.5 1 0.5
v -0.5 1 0.5
f 1 4 3 2
o tire
v 0.1 -0.3 -0.3
v 0.1 -0.3 0.3
v 0.1 0.3 0
f 5 6 7
END
cat >"$work/drive.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}]
camera: {keys: [{position_m: [0, 1, 3], look_at_m: [0, 0, 0]}]}
frames: {fps: 20, first: 1, last: 6, size: [48, 32], warm_start: false}
rain: {rate_mm_h: 30, max_drops: 2048, occlusion_size: 64}
ground: {on: true, cells: 128, far_cells: 0, start_wetness: 1, start_water_mm: 12}
vehicles:
  - file: cart.obj
    wheel_part: tire
    keys: [{time_s: 0, position_m: [0, 0, 1.5]}, {time_s: 0.25, position_m: [0, 0, -1.5]}]
    wheels: [{contact_m: [-0.4, 0, 0], radius_m: 0.3}, {contact_m: [0.4, 0, 0], radius_m: 0.3}]
YAML
draw drive all --stats --frames 1-6
# budget FOLDER NANOLITRES: all water is counted, and more than so much was thrown.
budget() {
    python3 - "$work/$1" "$2" <<'END'
import json, sys
for line in map(json.loads, open(f"{sys.argv[1]}/stats.jsonl")):
    nl = {name: round(1000 * value) for name, value in line["water_ul"].items()}
    came = sum(nl[name] for name in "start rained_total spray spray_off_ground touched given".split())
    went = sum(nl[name] for name in "absorbed film puddle run_off evaporated in_air off_ground cached evicted taken "
               "thrown".split())
    if came != went:
        sys.exit(f"frame {line['frame']}: {came} nl came, {went} nl are there or gone")
print(nl["thrown"], "nl were thrown")
if not nl["thrown"] > float(sys.argv[2]):
    sys.exit("that is too little")
END
}
budget all 100000000 || fail "water of wheels"

# The roof is 1 m^2 and drips along its way: 30 mm/h on it are 1,250 ul in 0.15 s. Nothing else can.
draw drive drips --layers depth --stats --frames 1-6 --set splash.drips.on=true
VIRGA_VALIDATE=0 draw drive dry --layers depth --stats --frames 1-6 --set splash.drips.on=true \
    --set splash.drips.moving=false
budget drips 100000000 || fail "water of wheels and drips"
python3 - "$work" <<'END' || fail "drips of what drives"
import json, sys
lines = [json.loads(line)["splash"]["drips"] for line in open(sys.argv[1] + "/drips/stats.jsonl")]
dry = [json.loads(line)["splash"]["drips"] for line in open(sys.argv[1] + "/dry/stats.jsonl")]
first, last = lines[2], lines[-1] # the first step adds the film of rain before it
came = last["rain_ul"] - first["rain_ul"]
print(f"{last['drops']} drops fell; {came} ul of rain came in 0.15 s")
if not abs(came - 1250) < 0.06 * 1250:
    sys.exit("the roof should get 1250 ul")
if not last["drops"] > 20:
    sys.exit("it does not drip")
if any(line["drops"] or line["rain_ul"] for line in dry):
    sys.exit("it drips where it should not")
if abs(last["rain_ul"] - last["fell_ul"] - last["on_surfaces_ul"]) > 1e-3 or last["left_ul"]:
    sys.exit("water is lost")
END

# Below a bridge over the whole way no rain comes to it; below one over the first half of its way it begins there.
printf 'v -3 4 -3\nv 3 4 -3\nv 3 4 3\nv -3 4 3\nf 1 4 3 2\n' >"$work/bridge.obj"
printf 'v -3 4 0\nv 3 4 0\nv 3 4 3\nv -3 4 3\nf 1 4 3 2\n' >"$work/half.obj"
for roof in bridge half; do
    VIRGA_VALIDATE=0 draw drive $roof --layers depth --stats --frames 1-6 --set splash.drips.on=true \
        --set "meshes=[{file: road.obj}, {file: $roof.obj}]"
done
python3 - "$work" <<'END' || fail "drips below a bridge"
import json, sys
lines = {name: [json.loads(line)["splash"]["drips"]["rain_ul"] for line in open(f"{sys.argv[1]}/{name}/stats.jsonl")]
         for name in ("bridge", "half", "drips")}
print("rain on it by frame (ul):", lines)
if lines["bridge"][-1] != 0:
    sys.exit("no rain comes below the bridge")
# 30 mm/h on 1 m^2 is 417 ul in a frame. It drives 0.6 m a frame, from 1.5 m on: in frame 3 its front comes out.
half = lines["half"]
if half[1] != 0 or not 0 < half[2] < 300 or not abs(half[5] - half[4] - 417) < 0.06 * 417:
    sys.exit("rain begins where the bridge ends")
END

# A figure of one triangle, with two poses, treads on the same road: its feet throw water, too.
for pose in 0 1; do
    printf 'o pose_%d_leg\nv 0 0 %d\nv 0.2 0 %d\nv 0 1 0\nf %d %d %d\n' $pose $pose $pose $((3 * pose + 1)) \
        $((3 * pose + 2)) $((3 * pose + 3))
done >"$work/walker.obj"
cat >"$work/walk.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}]
camera: {keys: [{position_m: [0, 1, 3], look_at_m: [0, 0, 0]}]}
frames: {fps: 20, first: 1, last: 12, size: [48, 32], warm_start: false}
rain: {rate_mm_h: 30, max_drops: 2048, occlusion_size: 64}
ground: {on: true, cells: 128, far_cells: 0, start_wetness: 1, start_water_mm: 12}
vehicles:
  - file: walker.obj
    pose_part: pose_
    keys: [{time_s: 0, position_m: [0, 0, 1.5]}, {time_s: 2, position_m: [0, 0, -1.5]}]
    feet: [{sole_m: [0.1, 0, 0]}, {sole_m: [-0.1, 0, 0], lands: 0.5}]
    lamps: [{position_m: [0, 1, 0], intensity_w_sr: 10}]
YAML
draw walk steps --stats --frames 1-12
budget steps 100000 || fail "water of feet"
# One that goes down a little while it stands treads as hard.
VIRGA_VALIDATE=0 draw walk down --layers depth --stats --frames 1-12 \
    --set 'vehicles.0.keys.0.position_m=[0, 0.03, 1.5]' \
    --set 'vehicles.0.keys.1.position_m=[0, -0.1, -1.5]'
budget down 5000000 || fail "water of feet that go down"

# refuse WHAT OPTION...: the check refuses, in one line that has WHAT.
refuse() {
    local what=$1 said
    shift
    said=$(timeout 60 "$virga" check "$work/drive.yaml" "$@" 2>&1 >"$work/out")
    [ $? = 2 ] && [ "$(wc -l <<<"$said")" = 1 ] && grep -qF -- "$what" <<<"$said" || fail "$what: got '$said'"
}
refuse 'vehicles.0.keys: expected rising times, got 0 after 0' --set vehicles.0.keys.1.time_s=0
refuse 'vehicles.0.wheel_part: expected file beside it' \
    --set 'vehicles=[{wheel_part: tire, keys: [{time_s: 0, position_m: [0, 0, 0]}]}]'
refuse 'vehicles.0.wheels.0.radius_m: expected a number from 0.01 to 3' --set vehicles.0.wheels.0.radius_m=0
refuse 'vehicles.0.pose_part: expected file beside it' \
    --set 'vehicles=[{pose_part: pose_, keys: [{time_s: 0, position_m: [0, 0, 0]}]}]'
refuse 'vehicles.0.lamps.0.outer_deg: expected more than inner_deg (30), got 20' \
    --set 'vehicles.0.lamps=[{position_m: [0, 0, 0], intensity_w_sr: 1, inner_deg: 30}]'
refuse 'splash.drips.moving: expected true or false' --set splash.drips.moving=some
refuse 'vehicles.0.file' --set vehicles.0.file=none.obj

[ $failures = 0 ] && echo "wheels throw water"
exit $((failures > 0))

#!/usr/bin/env bash
# Water that the program simulates: it falls as bodies do, keeps its volume, loses energy, and is the same in a frame
# that is rendered alone; what is wrong with its keys is one line.
# Usage: solver.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3
# The first box stands on the floor, the second falls for 0.25 s beside it.
cat >"$work/pool.yaml" <<'YAML'
virga: 1
camera: {keys: [{position_m: [0, 1, 3], look_at_m: [0, 0.3, 0]}]}
frames: {fps: 20, first: 1, last: 8, size: [32, 32]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
water:
  position_m: [0.1, 0.2, 0.3]
  max_foam: 0
  spray_density: 0
  solver:
    spacing_m: 0.05
    walls: {low_m: [-0.6, 0, -0.2], high_m: [0.6, 1, 0.2]}
    boxes:
      - {low_m: [-0.6, 0, -0.2], high_m: [-0.1, 0.4, 0.2]}
      - {low_m: [0.3, 0.4, -0.1], high_m: [0.5, 0.6, 0.1], velocity_m_s: [0, 0.2, 0]}
YAML

draw pool all --points --stats --frames 1-5
python3 "$here/check_solver.py" "$work/all" 20 1-5 || fail "water in all frames"
draw pool alone --points --stats --frames 4 --samples 2
cmp "$work/all/water_particles.0004.ply" "$work/alone/water_particles.0004.ply" || fail "frame 4 alone is another one"
VIRGA_VALIDATE=0 draw pool late --points --stats --frames 5 --set water.start_s=0.1
python3 "$here/check_solver.py" "$work/late" 20 5 0.1 || fail "water that begins to move later"

# Bodies: one falls where no water is, one has keys, and a post of the scene stands in the water.
cat >"$work/post.obj" <<'END'
o post
v -0.4 0.2 0.25
v -0.3 0.2 0.25
v -0.3 0.2 0.35
v -0.4 0.2 0.35
v -0.4 0.8 0.25
v -0.3 0.8 0.25
v -0.3 0.8 0.35
v -0.4 0.8 0.35
f 1 2 3 4
f 8 7 6 5
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
END
sed '/^f 4 8 5 1/d' "$work/post.obj" >"$work/open.obj"
sed -e '/^      - {low_m: \[0.3/d' -e '/^camera/i meshes: [{file: post.obj}]' "$work/pool.yaml" >"$work/bodies.yaml"
cat >>"$work/bodies.yaml" <<'YAML'
    meshes: [post]
    bodies:
      - {name: stone, box_m: [0.1, 0.1, 0.2], density: 2, position_m: [0.4, 0.6, 0], velocity_m_s: [0, 0.5, 0.1],
         spin_deg_s: [0, 90, 0]}
      - {name: paddle, box_m: [0.1, 0.1, 0.1], keys: [{time_s: 0, position_m: [0.1, 0.7, 0]},
         {time_s: 0.1, position_m: [0.2, 0.8, 0], rotation_deg: [0, 0, 90]}]}
YAML
draw bodies bodies --points --stats --frames 1-5 --samples 2
python3 "$here/check_bodies.py" "$work/bodies" 20 || fail "bodies"

# A box drives through a puddle: its water becomes particles there, and all of it is counted.
write_road
cat >"$work/puddle.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}]
camera: {keys: [{position_m: [0, 1, 2], look_at_m: [0, 0, 0]}]}
frames: {fps: 20, first: 1, last: 8, size: [32, 32]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
ground: {on: true, cells: 128, start_wetness: 1, start_water_mm: 40}
splash: {on: false}
water:
  max_foam: 0
  spray_density: 0
  solver:
    spacing_m: 0.025
    walls: {low_m: [-0.8, 0, -0.6], high_m: [0.8, 0.5, 0.6]}
    exchange: {max_particles: 4096, margin_m: 0.05, rest_height_m: 0.1}
    bodies:
      - {name: wheel, box_m: [0.1, 0.2, 0.2], keys: [{time_s: 0, position_m: [-0.4, 0.12, 0]},
         {time_s: 0.3, position_m: [0.4, 0.12, 0]}]}
YAML
draw puddle puddle --stats --frames 1-8
python3 "$here/check_exchange.py" "$work/puddle" || fail "water of a puddle"

# Rain falls on a board that stands still and one that is turned by its keys: nearly none comes to the ground.
cat >"$work/roof.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}]
camera: {keys: [{position_m: [0, 1, 2], look_at_m: [0, 0, 0]}]}
frames: {fps: 10, first: 1, last: 8, size: [32, 32]}
rain: {rate_mm_h: 100, max_drops: 16384, occlusion_size: 128}
ground: {on: true, cells: 128}
splash: {on: false}
water:
  max_foam: 0
  solver:
    spacing_m: 0.1
    walls: {low_m: [-3, 0, -3], high_m: [3, 3, 3]}
    boxes: [{low_m: [-3, 0, -3], high_m: [-2.8, 0.2, -2.8]}]
    bodies:
      - {name: still, box_m: [0.2, 5.8, 2.9], position_m: [0, 2, -1.45], rotation_deg: [0, 0, 90]}
      - {name: turned, box_m: [5.8, 2.9, 0.2], keys: [{time_s: 0, position_m: [0, 1.5, 1.45], rotation_deg: [90, 0, 0]},
         {time_s: 1, position_m: [0, 2.5, 1.45], rotation_deg: [90, 0, 0]}]}
YAML
draw roof roof --layers depth --stats --frames 5
python3 - "$work/roof/stats.jsonl" <<'END' || fail "rain on bodies"
import json, sys
water = json.loads(open(sys.argv[1]).readlines()[-1])["water_ul"]
if not water["off_ground"] > 0.8 * water["rained_total"] > 0:
    sys.exit(f"{water['off_ground']} of {water['rained_total']} ul did not fall on the ground")
END

# It finds a board that only the water and gravity move, too: this one falls and turns from edge-on (0.07) to flat.
VIRGA_VALIDATE=0 draw roof turning --layers depth --stats --frames 5 \
    --set 'water.solver.walls={low_m: [-4, 0, -4], high_m: [4, 8, 4]}' \
    --set 'water.solver.bodies=[{name: turning, box_m: [5.8, 0.4, 5.8], density: 1, position_m: [0, 4, 0],
    rotation_deg: [0, 0, 90], spin_deg_s: [0, 0, 180]}]'
python3 - "$work/turning/stats.jsonl" <<'END' || fail "rain on a body that falls"
import json, sys
water = json.loads(open(sys.argv[1]).readlines()[-1])["water_ul"]
if not 0.5 < water["off_ground"] / water["rained_total"] < 0.9:
    sys.exit(f"{water['off_ground']} of {water['rained_total']} ul did not fall on the ground")
END

# refuse WHAT OPTION...: rendering refuses the input, in one line that has WHAT.
refuse() {
    local what=$1 said
    shift
    said=$(VIRGA_VALIDATE=0 timeout 60 "$virga" render "$work/bodies.yaml" -o "$work/none" --device "$device" \
        "$@" 2>&1 >"$work/out")
    [ $? = 2 ] && grep -qF -- "$what" <<<"$said" || fail "$what: got '$said'"
}
refuse "water.solver.meshes.0: no mesh or material of the scene has 'tower' in its name" \
    --set 'water.solver.meshes=[tower]'
refuse 'the mesh has holes' --set 'meshes=[{file: open.obj}]'
refuse "adding the body 'stone' to the water" --set 'water.solver.bodies.0={name: stone, file: open.obj}'

# Its particles are files for water.files.
"$virga" check "$work/pool.yaml" --set "water={files: $work/all/water_particles.%04d.ply, spacing_m: 0.05}" \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "its particles as files"; }
grep -q 'particles .*5 files, 0.2 s, up to 704 particles with velocity and with ids' "$work/log" ||
    { cat "$work/log"; fail "its particles as files"; }

at=pool.yaml
# expect WHAT OPTION...: the check refuses, in one line that has WHAT.
expect() {
    local what=$1 said
    shift
    said=$(timeout 60 "$virga" check "$work/$at" "$@" 2>&1 >"$work/out")
    [ $? = 2 ] && [ "$(wc -l <<<"$said")" = 1 ] && grep -qF -- "$what" <<<"$said" || fail "$what: got '$said'"
}
said=$("$virga" check "$work/pool.yaml" 2>&1) || fail "check of a good scene"
grep -q 'water .*704 particles of 0.05 m in a box of 1.2 x 1 x 0.4 m' <<<"$said" || fail "check says: $said"
expect 'water.solver.spacing_m: expected a number from 0.0001 to 10' --set water.solver.spacing_m=0
expect 'water.solver.boxes.0.high_m: expected at most walls.high_m (0.6) along x, got 0.7' \
    --set 'water.solver.boxes.0.high_m=[0.7, 0.4, 0.2]'
expect 'water.solver.boxes.0.low_m: expected at least walls.low_m (0) along y, got -0.1' \
    --set 'water.solver.boxes.0.low_m=[-0.6, -0.1, -0.2]'
expect 'water.solver.boxes.0.high_m: expected at least half a spacing (0.025) above low_m (-0.6) along x, got -0.6' \
    --set 'water.solver.boxes.0.high_m=[-0.6, 0.4, 0.2]'
expect 'water.solver.walls.high_m: expected at least 4 spacings (0.2) above low_m (-0.2) along z, got -0.15' \
    --set 'water.solver.walls.high_m=[0.6, 1, -0.15]'
expect 'water.solver.boxes: expected water of 1 to 2097152 particles, got 0' --set 'water.solver.boxes=[]'
expect 'water.solver.spacing_m: expected a spacing with which the walls have at most 16777216 cells' \
    --set water.solver.spacing_m=0.0005
expect 'water.solver: expected none, as files is there' --set "water.files=$work/all/water_particles.%04d.ply"
expect 'water.rotation_deg: expected [0, 0, 0], as solver is there' --set 'water.rotation_deg=[0, 90, 0]'
expect 'water.spacing_m: expected 0, as solver.spacing_m is there, got 0.1' --set water.spacing_m=0.1
expect 'water.solver.max_substeps: expected a whole number from 1 to 64' --set water.solver.max_substeps=65

at=bodies.yaml
expect "water.solver.bodies.0.box_m: expected sides of at least spacing_m (0.05), or file beside it; got 0.01 along y" \
    --set 'water.solver.bodies.0.box_m=[0.1, 0.01, 0.1]'
expect 'water.solver.bodies.0.box_m: expected none, as file is there' --set water.solver.bodies.0.file=post.obj
expect 'water.solver.bodies.0.density: expected 0, or 0.05 to 100, got 0.01' --set water.solver.bodies.0.density=0.01
expect 'water.solver.bodies.0.velocity_m_s: expected [0, 0, 0], as density is 0' --set water.solver.bodies.0.density=0
expect 'water.solver.bodies.1.keys: expected none, as density is above 0' --set water.solver.bodies.1.density=1
expect 'water.solver.bodies.1.keys: expected rising times, got 0.1 after 0.2' \
    --set water.solver.bodies.1.keys.0.time_s=0.2
expect 'water.solver.bodies: expected at most 8 with the 8 meshes, got 2' \
    --set 'water.solver.meshes=[a, a, a, a, a, a, a, a]'

at=puddle.yaml
expect 'water.solver.exchange: expected ground.on beside it' --set ground.on=false
expect 'water.solver.spacing_m: expected at most 0.1 with exchange, got 0.11' \
    --set water.solver.spacing_m=0.11 --set 'water.solver.bodies=[]'

[ $failures = 0 ] && echo "water is simulated"
exit $((failures > 0))

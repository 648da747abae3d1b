#!/usr/bin/env bash
# Water goes on from a checkpoint to the same bytes: simulated, with a body that floats, one with keys that stirs water
# of the ground, foam, and spray that flies on as droplets; and particles of files.
# Usage: checkpoint_water.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3

cat >"$work/floor.obj" <<'OBJ'
v -3 0 -3
v 3 0 -3
v 3 0 3
v -3 0 3
f 1 3 2
f 1 4 3
OBJ
# A box of water falls beside a wheel that drives through a puddle.
cat >"$work/pool.yaml" <<'YAML'
virga: 1
meshes: [{file: floor.obj}]
camera: {keys: [{position_m: [0, 1, 3], look_at_m: [0, 0.3, 0]}]}
frames: {fps: 20, first: 1, last: 8, size: [48, 32]}
rain: {rate_mm_h: 20, max_drops: 1024, occlusion_size: 64}
ground: {on: true, cells: 128, start_water_mm: 50}
splash: {on: true, max_splashes: 1024, max_droplets: 2048}
water:
  max_foam: 2048
  solver:
    spacing_m: 0.03
    walls: {low_m: [-0.6, 0, -0.3], high_m: [0.6, 1, 0.3]}
    boxes:
      - {low_m: [0.1, 0.4, -0.1], high_m: [0.5, 0.7, 0.1], velocity_m_s: [1, -4, 0]}
    exchange: {max_particles: 4096, margin_m: 0.1}
    bodies:
      - {name: cork, box_m: [0.15, 0.15, 0.15], density: 0.4, position_m: [0.2, 0.2, 0], spin_deg_s: [0, 90, 0]}
      - {name: wheel, box_m: [0.1, 0.1, 0.1], keys: [{time_s: 0, position_m: [-0.4, 0.05, 0]},
         {time_s: 0.4, position_m: [-0.1, 0.05, 0], rotation_deg: [0, 0, -90]}]}
YAML
mkdir "$work/particles"
python3 "$here/make_particles.py" "$work/particles" 5
cat >"$work/files.yaml" <<'YAML'
virga: 1
camera: {keys: [{position_m: [0, 1, 1.5], look_at_m: [0, 0.8, 0]}]}
frames: {fps: 20, first: 1, last: 8, size: [48, 32]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
water: {files: particles/ball_%04d.ply, rate_hz: 10, spray_density: 0.6}
YAML

# numbers FOLDER LINE: a line of stats.jsonl without its times.
numbers() {
    sed -n "$2p" "$work/$1/stats.jsonl" | sed -E 's/,"milliseconds":\{[^}]*\}//'
}

# goes_on SCENE OPTION...
goes_on() {
    local scene=$1
    shift
    VIRGA_VALIDATE=0 draw "$scene" "$scene" --frames 1-5 --checkpoint-every 4 --stats "$@"
    mkdir "$work/$scene.part"
    cp "$work/$scene/checkpoint.0004.virga" "$work/$scene.part"
    draw "$scene" "$scene.part" --frames 5-5 --stats "$@"
    grep -q "starts from the checkpoint of frame 4" "$work/log" || fail "$scene does not start from frame 4"
    for file in "$work/$scene"/*.0005.*; do
        cmp -s "$file" "$work/$scene.part/$(basename "$file")" || fail "$scene: $(basename "$file") differs"
    done
    [ "$(numbers "$scene.part" 1)" = "$(numbers "$scene" 5)" ] || fail "$scene: the statistics differ"
}

goes_on pool --points
grep -q '"taken_ul":[1-9]' "$work/pool/stats.jsonl" || fail "no water of the ground became particles"
grep -q '"handed_over":[1-9]' "$work/pool/stats.jsonl" || fail "no spray was handed over"
goes_on files --samples 2
exit $((failures > 0))

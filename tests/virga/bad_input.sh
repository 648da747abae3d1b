#!/usr/bin/env bash
# Broken scene files, meshes, pictures and command lines, one by one, with the address and undefined-behaviour
# sanitizers: each gives one clear line and exit code 2, and leaves nothing behind. What goes wrong on the way, with
# all of that right, has exit code 1.
# Usage: bad_input.sh VIRGA SOURCE_ROOT PLAIN, with a program that was built with them and one without
set -u
virga=$1 source=$2 plain=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The drivers and the model loader keep memory of their own until the end; leaks of ours are counted by the tests of
# the library, in which everything is destroyed and counted. The driver's compiler allocates most of all: its stacks are
# cut short, and 32 MB of what was freed last are watched.
export ASAN_OPTIONS=detect_leaks=0:abort_on_error=1:malloc_context_size=6:quarantine_size_mb=32
export UBSAN_OPTIONS=halt_on_error=1:abort_on_error=1
unset VIRGA_VALIDATE

cp "$source/assets/environments/dusk.exr" "$work/sky.exr"
cat >"$work/box.obj" <<'OBJ'
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
f 1 2 3
f 1 3 4
OBJ
cat >"$work/good.yaml" <<'YAML'
virga: 1
meshes: [{file: box.obj}]
environment: {file: sky.exr}
camera: {keys: [{time_s: 0, position_m: [0, 1, 3], look_at_m: [0, 1, 0]}]}
frames: {fps: 24, first: 1, last: 2, size: [32, 32]}
rain: {rate_mm_h: 10, max_drops: 1024, occlusion_size: 64}
YAML

count=0 failures=0
complain() {
    echo "FAILED: $1"
    sed 's/^/    /' "$work/err"
    failures=$((failures + 1))
}

# fails CODE NAME ARGUMENT...: must fail cleanly.
fails() {
    local expected=$1 name=$2 code lines
    shift 2
    count=$((count + 1))
    rm -rf "$work/out"
    timeout 60 "$virga" "$@" >"$work/stdout" 2>"$work/err"
    code=$?
    grep -v -e '^warning: ' -e ', 1 sample$' -e '^frame .* left' "$work/err" >"$work/lines"
    lines=$(wc -l <"$work/lines")
    [ "$code" = "$expected" ] || { complain "$name: exit code $code, expected $expected"; return; }
    [ "$lines" = 1 ] || { complain "$name: $lines lines"; return; }
    [ -z "$(find "$work/out" -type f 2>/dev/null)" ] || complain "$name: left $(find "$work/out" -type f)"
}

# bad NAME ARGUMENT...: wrong, as a command line, a scene or a file.
bad() {
    fails 2 "$@"
}

# says NAME TEXT: what the line above it had to say.
says() {
    grep -qF -- "$2" "$work/lines" || { cp "$work/lines" "$work/err"; complain "$1: does not say '$2'"; }
}

# scene NAME SED-SCRIPT: the good scene, spoiled.
scene() {
    sed "$2" "$work/good.yaml" >"$work/bad.yaml"
    bad "$1" render "$work/bad.yaml" -o "$work/out"
}

scene 'unknown key' 's/rate_mm_h/rate_mm_s/'
scene 'wrong type' 's/rate_mm_h: 10/rate_mm_h: lots/'
scene 'out of range' 's/rate_mm_h: 10/rate_mm_h: 1000/'
scene 'negative' 's/fps: 24/fps: -24/'
scene 'not a number' 's/rate_mm_h: 10/rate_mm_h: .nan/'
scene 'infinite' 's/position_m: \[0,/position_m: [.inf,/'
scene 'vector too short' 's/\[0, 1, 3\]/[0, 1]/'
scene 'vector too long' 's/\[0, 1, 3\]/[0, 1, 3, 4]/'
scene 'no camera' '/^camera/d'
scene 'no keys' 's/keys: \[.*\]/keys: []/'
scene 'wrong version' 's/virga: 1/virga: 7/'
scene 'no version' '/^virga/d'
scene 'missing mesh' 's/box.obj/none.obj/'
scene 'missing sky' 's/sky.exr/none.exr/'
scene 'broken yaml' 's/meshes: \[/meshes: [[/'
scene 'tab in yaml' 's/^frames: /\tframes: /'
scene 'doubled key' 's/^virga: 1/virga: 1\nvirga: 1/'
scene 'frames backwards' 's/first: 1, last: 2/first: 9, last: 2/'
scene 'size of zero' 's/\[32, 32\]/[0, 32]/'
scene 'fov of 180' 's/camera: {/camera: {fov_deg: 180, /'
scene 'splash without ground' '$a splash: {on: true}'
scene 'unknown key of splash' '$a ground: {on: true}\nsplash: {droplet_m: 3}'
scene 'unknown mode of splash' '$a ground: {on: true}\nsplash: {mode: real}'
scene 'too many droplets' '$a ground: {on: true}\nsplash: {max_droplets: 99999999}'
scene 'splash that is no group' '$a splash: true'
scene 'unknown material' '$a ground: {on: true, materials: [{match: default, material: asphlat}]}'
scene 'pane without a position' '$a glass: [{}]'
scene 'panes that are no list' '$a glass: {width_m: 1}'
scene 'unknown key of a pane' '$a glass: [{position_m: [0, 0, 0], width: 1}]'
scene 'unknown kind of pane' '$a glass: [{position_m: [0, 0, 0], kind: wet}]'
scene 'two panes of one name' '$a glass: [{position_m: [0, 0, 0]}, {position_m: [0, 0, 0]}]'
scene 'angles that do not go together' '$a glass: [{position_m: [0, 0, 0], kind: leaf, advancing_deg: 40}]'
scene 'missing bumps' '$a glass: [{position_m: [0, 0, 0], bumps: {file: no.png, size_mm: [9, 9], depth_mm: 1}}]'
scene 'missing mask' '$a glass: [{position_m: [0, 0, 0], mask: no.png}]'
scene 'sky for a mask' '$a glass: [{position_m: [0, 0, 0], mask: sky.exr}]'
scene 'mesh that is no pane' '$a glass: [{position_m: [0, 0, 0], shape: mesh, mesh: box}]'
scene 'mesh that is not there' '$a glass: [{position_m: [0, 0, 0], shape: mesh, mesh: none}]'
scene 'blade longer than its arm' '$a glass: [{position_m: [0, 0, 0], wipers: [{pivot_m: [0, 0], reach_m: 0.5, \
blade_m: 1, low_deg: 0, high_deg: 90}]}]'
scene 'looks at itself' 's/look_at_m: \[0, 1, 0\]/look_at_m: [0, 1, 3]/'
: >"$work/empty.yaml"
bad 'empty scene' render "$work/empty.yaml" -o "$work/out"
head -c 4000 /dev/urandom >"$work/noise.yaml"
bad 'noise for a scene' render "$work/noise.yaml" -o "$work/out"
bad 'no scene' render "$work/none.yaml" -o "$work/out"
bad 'folder for a scene' render "$work" -o "$work/out"

mesh() {
    sed "s/box.obj/$2/" "$work/good.yaml" >"$work/bad.yaml"
    bad "$1" render "$work/bad.yaml" -o "$work/out"
}
: >"$work/empty.obj"
mesh 'empty mesh' empty.obj
head -c 3000 /dev/urandom >"$work/noise.glb"
mesh 'noise for a mesh' noise.glb
head -c 900 "$source/assets/scenes/street.glb" >"$work/cut.glb"
mesh 'mesh cut short' cut.glb
printf 'v 0 0 0\nv 1 0 0\nv 2 1 0\n' >"$work/points.obj"
mesh 'mesh without faces' points.obj
echo 'hello' >"$work/text.xyz"
mesh 'unknown kind of mesh' text.xyz

sky() {
    sed "s/sky.exr/$2/" "$work/good.yaml" >"$work/bad.yaml"
    bad "$1" render "$work/bad.yaml" -o "$work/out"
}
: >"$work/empty.exr"
sky 'empty picture' empty.exr
head -c 20000 "$work/sky.exr" >"$work/cut.exr"
sky 'picture cut short' cut.exr
head -c 3000 /dev/urandom >"$work/noise.exr"
sky 'noise for a picture' noise.exr
echo 'hello' >"$work/text.exr"
sky 'text for a picture' text.exr

# Footage.
for file in empty.exr cut.exr noise.exr text.exr none.exr 'none.%04d.exr' '%s.exr' '%d%d.exr' '%n' .; do
    bad "plate $file" render "$work/good.yaml" -o "$work/out" --plate "$work/$file"
done
bad 'plate without a name' render "$work/good.yaml" -o "$work/out" --plate

# A grey picture of 0 and 255, and one of 16 bits.
base64 -d >"$work/map.png" <<<iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR4nGNg\
+A8AAQIBAEK+vGgAAAAASUVORK5CYII=
base64 -d >"$work/deep.png" <<<iVBORw0KGgoAAAANSUhEUgAAAAEAAAABEAAAAABq7kcWAAAAC0lEQVR4nGNg\
YAQAAAQAAr96P0oAAAAASUVORK5CYII=
cat - "$work/good.yaml" >"$work/mapped.yaml" <<'YAML'
ground:
  on: true
  cells: 128
  materials: [{match: nothing, material: sand}]
  material_map:
    file: map.png
    low_m: [-1, -1]
    high_m: [1, 1]
    materials: [tile, drain]
YAML

# map NAME TEXT SED-SCRIPT: the scene with a map, spoiled, is refused with the same line whoever reads it, and before a
# device is looked for.
map() {
    local command
    sed "$3" "$work/mapped.yaml" >"$work/bad.yaml"
    for command in check "render --device none -o $work/out"; do
        bad "$1, ${command%% *}" $command "$work/bad.yaml"
        says "$1, ${command%% *}" "bad.yaml:$2"
    done
}
names='expected one of default, asphalt, concrete, stone, brick, grass, sand, soil, wood, metal, glass, water, leaves,'
names="$names cloth, plastic, tile, drain, got"
map 'unknown material' "4: ground.materials.0.material: $names 'snad', did you mean 'sand'?" 's/sand/snad/'
map 'unknown material of a map' "9: ground.material_map.materials.1: $names 'cheese'" 's/drain/cheese/'
map 'missing map' '6: ground.material_map.file: cannot read' 's/map.png/none.png/'
map 'folder for a map' '6: ground.material_map.file: expected a file' 's/map.png/./'
map 'map without corner' '6: ground.material_map.low_m: is missing' '/low_m/d'
map 'map without materials' '6: ground.material_map.materials: is missing' '/tile/d'
map 'map without extent' '8: ground.material_map.high_m: expected more than low_m in z (-1), got -1' \
    's/high_m.*/high_m: [1, -1]/'
: >"$work/empty.png"
map 'empty map' "6: ground.material_map.file: cannot read $work/empty.png: not a PNG picture" 's/map.png/empty.png/'
map 'sky for a map' "6: ground.material_map.file: cannot read $work/sky.exr: not a PNG picture" 's/map.png/sky.exr/'
map 'map of 16 bits' '6: ground.material_map.file: cannot read' 's/map.png/deep.png/'
says 'map of 16 bits' 'expected 8 bits a channel, got 16'
head -c 50 "$work/map.png" >"$work/cut.png"
map 'map cut short' "6: ground.material_map.file: cannot read $work/cut.png: the picture is damaged" \
    's/map.png/cut.png/'

good="$work/good.yaml"
bad 'no command' rendre
bad 'unknown option' render "$good" -o "$work/out" --sise 32x32
bad 'option without value' render "$good" -o
bad 'no output' render "$good"
bad 'wrong size' render "$good" -o "$work/out" --size 32
bad 'wrong frames' render "$good" -o "$work/out" --frames 5-2
bad 'frames of text' render "$good" -o "$work/out" --frames one
bad 'no samples' render "$good" -o "$work/out" --samples 0
bad 'no velocity of water' render "$good" -o "$work/out" --water-velocity 0
bad 'velocity of more than all' render "$good" -o "$work/out" --water-velocity 101
bad 'unknown layer' render "$good" -o "$work/out" --layers beuty
bad 'splash layer without splashes' render "$good" -o "$work/out" --layers splash
bad 'splash layer where they are off' render "$good" -o "$work/out" --set ground.on=true --set splash.on=false \
    --layers splash
bad 'glass layer without panes' render "$good" -o "$work/out" --layers glass,refraction
bad 'set of a pane that is not there' render "$good" -o "$work/out" --set glass.0.kind=clean
bad 'set of splash' render "$good" -o "$work/out" --set ground.on=true --set splash.pile_max_s=0
bad 'unknown device' render "$good" -o "$work/out" --device 99
bad 'wrong set' render "$good" -o "$work/out" --set rain.rate=5
bad 'set without value' render "$good" -o "$work/out" --set rain.rate_mm_h
bad 'file for a folder' render "$good" -o "$good"
bad 'folder in a file' render "$good" -o "$good/out"
bad 'folder where none can be' render "$good" -o /proc/none/out
bad 'frame before the first' render "$good" -o "$work/out" --frames 0
bad 'number for a gpu' render "$good" -o "$work/out" --device no-such-gpu
bad 'seed below zero' render "$good" -o "$work/out" --seed -1
bad 'seed of 33 bits' render "$good" -o "$work/out" --seed 4294967296
bad 'nothing to measure' bench snow
bad 'device that is not listed' info --device 99
bad 'file without particles' info "$good"
bad 'no files of particles' check "$good" --set water.files=none_%04d.ply
bad 'a mesh for particles' check "$good" --set water.files=box.obj
bad 'particles at a rate of 0' check "$good" --set water.files=box.obj --set water.rate_hz=0
bad 'files of a device' info --device cpu "$good"
sed 's/box.obj/none.obj/' "$good" >"$work/bad.yaml"
bad 'missing mesh, checked' check "$work/bad.yaml"

# compile OPTION...: has the shaders of a render compiled, by the program without sanitizers. With them that takes four
# times as long; what they are here to see is not in the driver's compiler.
compile() {
    "$plain" render "$@" -o "$work/compiled" >"$work/stdout" 2>"$work/err" || complain "compiling of $1"
    rm -r "$work/compiled"
}

# The machine's fault. The program of the sanitizers needs files of its own, but none so large as a frame.
compile "$good" --layers rain --size 256x256 --frames 1
(
    ulimit -f 1
    fails 1 'file too large' render "$good" -o "$work/out" --layers rain --size 256x256
    VK_ICD_FILENAMES=/none fails 1 'no driver' render "$good" -o "$work/out"
    says 'no driver' 'mesa-vulkan-drivers'
    exit "$failures"
)
failures=$? count=$((count + 2))

# And the good one still works, so that none of the above failed for another reason.
compile "$good" --points
"$virga" render "$good" -o "$work/fine" >"$work/stdout" 2>"$work/err" || complain 'the good scene'
[ -f "$work/fine/frame.0002.exr" ] || complain 'the good scene wrote no frame'
wet=(--points --stats --set ground.on=true --set ground.cells=128 --set ground.start_water_mm=3
    --set rain.rate_mm_h=100 --set frames.warm_start=false)
compile "$good" "${wet[@]}"
"$virga" render "$good" -o "$work/wet" "${wet[@]}" >"$work/stdout" 2>"$work/err" ||
    complain 'the good scene with splashes'
[ -f "$work/wet/splash.0002.ply" ] || complain 'the good scene with splashes wrote no droplets'
"$virga" check "$good" --set ground.on=true --set splash.mode=paper >"$work/stdout" 2>"$work/err" ||
    complain 'the good scene with splashes, checked'
grep -q '^  splash *paper, film style, [0-9]* splashes, [0-9]* droplets$' "$work/stdout" ||
    complain 'splashes are not in what check says'
cat - "$good" >"$work/glazed.yaml" <<'YAML'
glass:
  - name: window
    position_m: [0, 0, 1]
    wipers: [{pivot_m: [0.7, 0], reach_m: 0.7, blade_m: 0.5, low_deg: 10, high_deg: 170, sweep_s: 0.2}]
    frame_m: 0.1
    max_texels: 256
    max_drops: 4096
  - {name: shield, shape: windshield, follow: camera, position_m: [0, -0.3, 0.8], style: paper, max_texels: 256,
     max_drops: 4096}
YAML
compile "$work/glazed.yaml" --frames 1-4 --points --stats --plate "$work/sky.exr"
"$virga" render "$work/glazed.yaml" -o "$work/glazed" --frames 1-4 --points --stats --plate "$work/sky.exr" \
    >"$work/stdout" 2>"$work/err" || complain 'the good scene with panes before a plate'
compile "$work/glazed.yaml" --frames 6 --samples 2
"$virga" render "$work/glazed.yaml" -o "$work/glazed" --frames 6 --samples 2 >"$work/stdout" 2>"$work/err" ||
    complain 'the good scene with panes'
[ -f "$work/glazed/glass.0004.ply" ] || complain 'the good scene with panes wrote no drops'
compile "$work/mapped.yaml" --frames 1
"$virga" render "$work/mapped.yaml" -o "$work/map" --frames 1 >"$work/stdout" 2>"$work/err" ||
    complain 'the scene with a map'
"$virga" check "$work/mapped.yaml" >"$work/stdout" 2>"$work/err" || complain 'the scene with a map, checked'
grep -q '^  material map .*/map.png: 2 x 1, 2 materials on 50 % of it$' "$work/stdout" ||
    complain 'the map is not in what check says'
"$virga" check "$work/mapped.yaml" --set ground.material_map=~ >"$work/stdout" 2>"$work/err" &&
    ! grep 'material map' "$work/stdout" >"$work/err" || complain 'the scene without its map'
base64 -d >"$work/map.png" <<<iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAAAAADRSSBWAAAAC0lEQVR4nGNg\
/A8AAQQBAcV71F8AAAAASUVORK5CYII=
bad 'going on with another map' render "$work/mapped.yaml" -o "$work/map" --frames 1 --resume
says 'going on with another map' 'scene hash'
bad 'going on with another seed' render "$good" -o "$work/fine" --resume --seed 9
"$virga" render "$good" -o "$work/fine" --resume --points --stats >"$work/stdout" 2>"$work/err" ||
    complain 'going on with the good scene'
echo "$count broken inputs, $failures failures"
[ "$failures" = 0 ]

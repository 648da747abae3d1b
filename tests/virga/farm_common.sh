# Sourced by farm.sh and farm_slurm.sh: a small scene of rain alone, as each process builds its pipelines; its whole
# render, and comparisons with it.
set -u
virga=$1
device=${VIRGA_TEST_DEVICE:-cpu}
work=$(mktemp -d)
failures=0

"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

cat >"$work/box.obj" <<'OBJ'
v -9 0 -9
v 9 0 -9
v 9 0 9
v -9 0 9
f 1 3 2
f 1 4 3
OBJ
cat >"$work/scene.yaml" <<'YAML'
virga: 1
meshes: [{file: box.obj}]
camera: {keys: [{time_s: 0, position_m: [0, 1, 3], look_at_m: [0, 1, 0]}]}
frames: {fps: 24, first: 1, last: 12, size: [64, 36], preroll_s: 0.1, warm_start: false}
rain: {rate_mm_h: 30, gust_m_s: 1, max_drops: 4096, occlusion_size: 64}
YAML
options=(--device "$device" --points --stats)

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

# numbers FOLDER: stats.jsonl without its times.
numbers() {
    sed -E 's/,"milliseconds":\{[^}]*\}//' "$work/$1/stats.jsonl"
}

# same FOLDER: all files of the whole render are there, to the byte, and no half one.
same() {
    local file
    for file in "$work/whole"/*.exr "$work/whole"/*.ply; do
        cmp -s "$file" "$work/$1/$(basename "$file")" || fail "$1: $(basename "$file") differs"
    done
    [ "$(numbers "$1")" = "$(numbers whole)" ] || fail "$1: the statistics differ"
    [ -z "$(find "$work/$1" -name '*.tmp*' -o -name '.*.part')" ] || fail "$1: temporary files are left"
}

"$virga" render "$work/scene.yaml" -o "$work/whole" "${options[@]}" >"$work/log" 2>&1 ||
    { echo "FAILED: the whole render"; cat "$work/log"; exit 1; }

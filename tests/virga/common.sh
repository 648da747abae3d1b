# Sourced by tests of the program, with it and the programs that they need: `. common.sh "$1" python3 oiiotool`.
# Sets up a folder to work in and a count of failures. Skips (77) without one of the programs, or without a device.
set -u
virga=$1
shift
device=${VIRGA_TEST_DEVICE:-cpu}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

for program in "$@"; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

# Writes $work/road.obj: level ground of 6 x 6 m.
write_road() {
    printf '%s\n' 'o road' 'v -3 0 -3' 'v 3 0 -3' 'v 3 0 3' 'v -3 0 3' 'f 1 4 3 2' >"$work/road.obj"
}

# draw SCENE FOLDER OPTION...: renders $work/SCENE.yaml into $work/FOLDER. Any message of the validation layer is a
# failure.
draw() {
    local scene=$1 folder=$2
    shift 2
    timeout 120 "$virga" render "$work/$scene.yaml" -o "$work/$folder" --device "$device" "$@" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "render $scene $*"; }
    ! grep '^validation: ' "$work/log" || fail "render $scene $*: validation"
}

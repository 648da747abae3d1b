#!/usr/bin/env bash
# The sample game, without a display: inside and outside, in rain and dry. Under validation and synchronization
# validation, but for runs with the same passes as one before.
# Usage: drive.sh DRIVE LOOK
set -eu
drive=$1 look=$2
work=$(mktemp -d "${TMPDIR:-/tmp}/virga-drive-XXXXXX")
trap 'rm -rf "$work"' EXIT
if ! ls /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json >/dev/null 2>&1; then
    echo "skipped: the validation layer is not installed"
    exit 77
fi
export VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
export VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
export LP_NUM_THREADS=${LP_NUM_THREADS:-2}
[ "$LP_NUM_THREADS" = 0 ] || export MALLOC_PERTURB_=0 # see tests/images/same_bytes.sh

render() { # name options...
    local name=$1
    shift
    if ! "$drive" --device "${VIRGA_TEST_DEVICE:-cpu}" --size 160x96 --fps 10 --start 12 --frames 5 "$@" \
        --out "$work/$name.png" >"$work/$name.log" 2>&1; then
        cat "$work/$name.log"
        echo "failed: drive $*"
        exit 1
    fi
    if grep -qE "Validation|VUID|SYNC-HAZARD|virga \(" "$work/$name.log"; then
        cat "$work/$name.log"
        echo "not silent: drive $*"
        exit 1
    fi
}

without_layers() { # name options...
    (unset VK_INSTANCE_LAYERS VK_LAYER_ENABLES; render "$@")
}

# The layer is really there: the loader says so.
VK_LOADER_DEBUG=layer "$drive" --device no-such-device --frames 1 --out "$work/none.png" >"$work/layers" 2>&1 && exit 1
grep -q "VK_LAYER_KHRONOS_validation" "$work/layers" || { echo "validation is not on"; exit 1; }

render inside_rain --rain 80 --wipers off
without_layers inside_dry --rain 0 --wipers off
python3 "$look" "$work/inside_rain.png" "$work/inside_dry.png" 0.02
render inside_focus --rain 0 --wipers off --focus
python3 "$look" "$work/inside_focus.png" "$work/inside_dry.png" 0.006
render outside_rain --rain 80 --outside
without_layers outside_dry --rain 0 --outside
python3 "$look" "$work/outside_rain.png" "$work/outside_dry.png" 0.02

# Walls that the wind blows at are wet.
without_layers walls_rain --rain 10 --outside --frames 2 --quality low
without_layers walls_dry --rain 0 --outside --frames 2 --quality low
python3 "$look" "$work/walls_rain.png" "$work/walls_dry.png" 0 walls

# The pipelines that a run compiled are kept, and taken by the next.
render first --rain 10 --frames 1 --quality low --pipelines "$work/pipelines"
[ -s "$work/pipelines" ] || { echo "no pipelines were kept"; exit 1; }
without_layers second --rain 10 --frames 1 --quality low --pipelines "$work/pipelines"

# Frames as long as they take; the quantiles of their times are printed.
(unset VK_INSTANCE_LAYERS VK_LAYER_ENABLES
    "$drive" --device "${VIRGA_TEST_DEVICE:-cpu}" --size 160x96 --rain 10 --frames 12 --quality low --real-time \
        --out "$work/timed.png" >"$work/timed.log" 2>&1) || { cat "$work/timed.log"; exit 1; }
for times in frame processor; do
    grep -qE "^$times +[0-9.]+ ms median, 90 % [0-9.]+, 99 % [0-9.]+, longest [0-9.]+, of 4 frames" "$work/timed.log" ||
        { cat "$work/timed.log"; echo "no times: $times"; exit 1; }
done

# Every option of the command line stands in the help.
"$drive" --help >"$work/help" || { echo "drive --help failed"; exit 1; }
for option in track start outside focus rain wipers frames out fps real-time size quality budget device pipelines; do
    grep -q -- "--$option" "$work/help" || { echo "drive --help does not say --$option"; exit 1; }
done

# Wrong input: one line, and an exit code.
refuse() { # code text options...
    local code=$1 text=$2 got=0
    shift 2
    "$drive" "$@" >"$work/out" 2>"$work/err" || got=$?
    [ "$got" = "$code" ] || { echo "drive $*: exit code $got, expected $code"; cat "$work/err"; exit 1; }
    grep -q -- "$text" "$work/err" || { echo "drive $*: expected '$text', got"; cat "$work/err"; exit 1; }
}
refuse 2 "expected 0 to 200 mm/h" --rain wet
refuse 2 "expected off, intermittent, slow or fast" --wipers sometimes
refuse 2 "expected low, medium, high or film" --quality best
refuse 2 "expected 0 to 1000 ms" --budget soon
refuse 2 "expected WxH" --size 640
refuse 2 "expected --frames N" --out "$work/x.png"
refuse 1 "no such track" "$work/nothing.glb" --frames 1 --out "$work/x.png" --device "${VIRGA_TEST_DEVICE:-cpu}"
echo "point 1 2" >"$work/bad.track"
refuse 1 "bad.track:1: expected" --track "$work/bad.track" --frames 1 --out "$work/x.png" \
    --device "${VIRGA_TEST_DEVICE:-cpu}"

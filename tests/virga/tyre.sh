#!/usr/bin/env bash
# The scene of the tyre with large particles: a wheel throws water out of a puddle. All of it is counted: in the cells
# of the ground, in the solver, and as droplets in the air.
# Usage: tyre.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3
timeout 120 "$virga" render "$here/../../assets/scenes/tyre.yaml" -o "$work/tyre" --device "$device" --stats \
    --frames 9-10 --size 32x32 --set frames.fps=24 --set water.solver.spacing_m=0.04 --set water.max_foam=0 \
    --set rain.max_drops=1024 --set rain.occlusion_size=64 --set ground.far_cells=0 --set ground.cached_tiles=0 \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "a wheel"; }
! grep '^validation: ' "$work/log" || fail "a wheel: validation"
python3 "$here/check_exchange.py" "$work/tyre" spray || fail "water of a puddle"
[ $failures = 0 ] && echo "the water of a wheel is counted"
exit $((failures > 0))

#!/usr/bin/env bash
# The views of water in the window: density, states of spray, and surfels. Each shows the ball, in a picture of its own.
# Usage: view_water.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$(realpath "$1")" python3 xvfb-run oiiotool idiff
"$virga" help view | grep -q -- --script || { echo "skipped: built without a window"; exit 77; }
python3 "$here/make_particles.py" "$work" 2
cat >"$work/ball.yaml" <<'YAML'
virga: 1
camera: {fov_deg: 20, keys: [{position_m: [0, 1, 1], look_at_m: [0, 1, 0]}]}
frames: {fps: 20, first: 1, last: 2, size: [160, 90]}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
water: {files: ball_%04d.ply, rate_hz: 10, spray_density: 0.4}
YAML
cat >"$work/views.txt" <<'END'
panel off
step 1
window picture.png
view water_density
window water_density.png
view water_spray
window water_spray.png
view water_surfels
window water_surfels.png
quit
END
(cd "$work" && timeout 200 xvfb-run -a -s "-screen 0 1280x720x24" "$virga" view ball.yaml --window 320x320 \
    --script views.txt --device "$device") >"$work/log" 2>&1 || { cat "$work/log"; fail "the window"; }
! grep '^validation: ' "$work/log" || fail "validation"

# The mean of the middle, where the ball is, and of a corner: from 0 to 255.
mean() { # FILE GEOMETRY
    oiiotool "$1" --cut "$2" --ch R,G,B -d float --printstats |
        awk '$1 == "Stats" && $2 == "Avg:" { print int(255 * ($3 + $4 + $5)) }'
}

earlier=picture
for view in water_density water_spray water_surfels; do
    [ -s "$work/$view.png" ] || { fail "no picture of $view"; continue; }
    middle=$(mean "$work/$view.png" 60x60+130+130) corner=$(mean "$work/$view.png" 40x40+5+275)
    [ $((middle > corner ? middle - corner : corner - middle)) -gt 20 ] ||
        fail "$view: the ball is not seen: $middle in the middle, $corner in the corner"
    for other in $earlier; do
        ! idiff -q -fail 0.02 "$work/$view.png" "$work/$other.png" >/dev/null 2>&1 ||
            fail "$view shows the same as $other"
    done
    earlier="$earlier $view"
done
[ $failures = 0 ] && echo "three views of water"
exit $((failures > 0))

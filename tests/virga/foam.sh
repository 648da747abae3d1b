#!/usr/bin/env bash
# The layer `foam` of a rendered frame shows foam where the point file of that frame has it, and nowhere else.
# Usage: foam.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3 oiiotool
# A box of water falls on the floor of a tank. The camera looks at its side, 3 m away.
cat >"$work/tank.yaml" <<'YAML'
virga: 1
camera: {fov_deg: 30, keys: [{position_m: [0, 0.4, 3], look_at_m: [0, 0.4, 0]}]}
frames: {fps: 24, first: 1, last: 12, size: [192, 108], shutter_deg: 0}
rain: {rate_mm_h: 0, max_drops: 1024, occlusion_size: 64}
water:
  spray_density: 0
  foam_radius_m: 0.02
  foam_air_hz: 100
  foam_crest_hz: 100
  max_foam: 4096
  solver:
    spacing_m: 0.04
    walls: {low_m: [-0.6, 0, -0.2], high_m: [0.6, 1, 0.2]}
    boxes:
      - {low_m: [-0.2, 0.2, -0.2], high_m: [0.2, 0.6, 0.2], velocity_m_s: [0, -2, 0]}
YAML
draw tank out --frames 1-12 --points --stats --layers foam
for frame in 0009 0012; do
    oiiotool --ch foam.A --dumpdata "$work/out/frame.$frame.exr" >"$work/alpha.txt" || fail "frame $frame has no foam.A"
    python3 "$here/check_foam.py" "$work/alpha.txt" "$work/out/water_foam.$frame.ply" "$work/out/stats.jsonl" $frame ||
        fail "foam of frame $frame"
done
exit $((failures > 0))

#!/usr/bin/env bash
# The light of drops is that of the camera's place: a wall in the way takes the sky's, and a frame does not depend on
# which frames are drawn.
# Usage: place.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" oiiotool

# A black wall of 40 x 20 m, a metre behind the rain that is seen in front of it; the camera goes along it.
printf '%s\n' 'mtllib wall.mtl' 'o wall' 'usemtl soot' 'v -40 -2 -3' 'v 40 -2 -3' 'v 40 20 -3' 'v -40 20 -3' \
    'f 1 2 3 4' >"$work/wall.obj"
printf '%s\n' 'newmtl soot' 'Kd 0 0 0' 'Ks 0 0 0' >"$work/wall.mtl"
cat >"$work/wall.yaml" <<'YAML'
virga: 1
meshes: [{file: wall.obj}]
environment: {zenith: [1, 1, 1], horizon: [1, 1, 1], ground: [1, 1, 1]}
camera:
  fov_deg: 40
  keys:
    - {time_s: 0, position_m: [-4, 1.5, 0], look_at_m: [-4, 1.5, -3]}
    - {time_s: 1, position_m: [4, 1.5, 0], look_at_m: [4, 1.5, -3]}
frames: {fps: 12, first: 1, last: 12, size: [96, 96]}
rain: {rate_mm_h: 100, max_drops: 8192, occlusion_size: 512}
YAML
draw wall place --layers beauty,rain
draw wall sky --frames 6 --layers beauty,rain --set environment.around=0
draw wall alone --frames 6-8 --layers beauty,rain

mean() {
    oiiotool "$work/$1/frame.0006.exr" --ch rain.G --printstats | awk '/Stats Avg/ {print $3}'
}
# All around is of radiance 1, and so are drops, by whatever it is seen. Before the wall they are darker: it takes most
# of what they refract.
awk -v place="$(mean place)" -v sky="$(mean sky)" 'BEGIN {
    print "rain before a black wall: " place ", with the light of the whole sky " sky
    exit !(sky > 0 && place > 0.02 * sky && place < 0.6 * sky)
}' || fail "light before a wall"
for frame in 0006 0007 0008; do
    cmp "$work/place/frame.$frame.exr" "$work/alone/frame.$frame.exr" || fail "frame $frame alone is another"
done
[ $failures = 0 ] && echo "drops have the light of the camera's place"

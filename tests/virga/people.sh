#!/usr/bin/env bash
# The people and the bicycle of the street: their scripts write the same bytes as ever, their surfaces are closed, and
# an umbrella keeps the figure and the ground below it dry and drips.
# Usage: people.sh VIRGA SOURCE
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" python3 oiiotool
assets=$2/assets

mkdir -p "$work/assets/scenes"
cp "$assets"/*.py "$work/assets"
for script in make_people make_bicycle; do
    python3 "$work/assets/$script.py" >"$work/log" || fail "$script"
done
for file in umbrella raincoat bicycle; do
    cmp "$work/assets/scenes/$file.glb" "$assets/scenes/$file.glb" || fail "$file.glb is not what its script writes"
done
python3 "$here/check_people.py" "$assets"/scenes/{umbrella,raincoat}.glb || fail "surfaces"

# Driving rain on dry ground: 0.1 m aside in a metre of fall. The camera looks under the umbrella.
write_road
cp "$assets/scenes/umbrella.glb" "$work"
cat >"$work/wait.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}, {file: umbrella.glb}]
camera: {fov_deg: 58, keys: [{position_m: [0, 1.2, 2.7], look_at_m: [0, 1, 0]}]}
frames: {fps: 12, first: 1, last: 12, size: [160, 160], preroll_s: 2}
rain: {rate_mm_h: 100, max_drops: 16384, occlusion_size: 512, wind_m_s: [0.6, 0, 0]}
ground: {on: true, cells: 128, far_cells: 0}
splash: {drips: {on: true}}
YAML
draw wait wet --stats --frames 12 --layers beauty,wetness --set rain.walls.start_h=1
draw wait dry --frames 12 --layers beauty,wetness
# mean CHANNEL WIDTHxHEIGHT+X+Y [OPTION...]: of a crop of the wet picture, or of what the options make of it.
mean() {
    oiiotool "$work/wet/frame.0012.exr" "${@:3}" --ch "$1" --cut "$2" --printstats | awk '/Stats Avg/ {print $3}'
}
against_dry=("$work/dry/frame.0012.exr" --absdiff)
python3 - "$work/wet/stats.jsonl" "$(mean G 24x8+68+25 "${against_dry[@]}")" \
    "$(mean G 14x26+73+62 "${against_dry[@]}")" "$(mean wetness.Y 16x2+78+130)" "$(mean wetness.Y 160x8+0+152)" \
    <<'END_OF_PYTHON' || fail "water"
import json, sys
line, wrong = json.loads(open(sys.argv[1]).read().splitlines()[-1]), []
canopy, coat, sheltered, around = map(float, sys.argv[2:])
drips, nl = line["splash"]["drips"], {name: round(1000 * value) for name, value in line["water_ul"].items()}
came = sum(nl[name] for name in "start rained_total spray spray_off_ground touched given".split())
went = sum(nl[name] for name in "absorbed film puddle run_off evaporated in_air off_ground cached evicted taken "
           "thrown".split())
print(f"{drips['drops']} drops fell; wet cloth changes the canopy by {canopy}, the coat by {coat}; "
      f"wetness {sheltered} below it, {around} around it")
if came != went:
    wrong.append(f"{came} nl came, {went} nl are there or gone")
if not drips["drops"] > 100:
    wrong.append("it does not drip")
if not (canopy > 0.005 and coat < 0.02 * canopy):
    wrong.append("the coat is not drier than the canopy")
if not (around > 0.1 and sheltered < 0.5 * around): # drips splash inwards
    wrong.append("the ground below is not drier than that around it")
sys.exit("; ".join(wrong) or None)
END_OF_PYTHON
[ $failures = 0 ] && echo "an umbrella keeps dry, and drips"
exit $((failures > 0))

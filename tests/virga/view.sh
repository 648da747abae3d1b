#!/usr/bin/env bash
# The window, driven by a script on a display that nobody sees: pictures with the panel, screenshots, the tuned scene as
# a file that renders, real keys, and one line about what is wrong.
# Usage: view.sh VIRGA
set -u
virga=$(realpath "$1")
device=${VIRGA_TEST_DEVICE:-cpu}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
    echo "FAILED: $1"
    failures=$((failures + 1))
}

# A number of a picture's red, of 255, inside WIDTHxHEIGHT+X+Y.
number() { # Avg|StdDev FILE GEOMETRY
    oiiotool "$2" --cut "$3" --ch R,G,B -d float --printstats |
        awk -v what="$1:" '$1 == "Stats" && $2 == what { print int(255 * $3) }'
}

has() { # TEXT FILE
    grep -qF -- "$1" "$2" || { cat "$2"; fail "no '$1'"; }
}

for need in xvfb-run oiiotool idiff; do
    command -v "$need" >/dev/null || { echo "skipped: $need is not installed"; exit 77; }
done
"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

# A floor with a lamp, and a pane with a wiper: small, so that frames are quick. Each effect builds pipelines, which
# takes the longest, so pane.yaml has no ground and no splashes, and rain.yaml has only rain.
cat >"$work/floor.obj" <<'END'
v -20 0 -20
v 20 0 -20
v 20 0 20
v -20 0 20
f 1 4 3 2
END
cat >"$work/scene.yaml" <<'END'
virga: 1
meshes: [{file: floor.obj}]
lights: [{position_m: [0, 3, -3], intensity_w_sr: 6}]
camera: {keys: [{time_s: 0, position_m: [0, 1.5, 4], look_at_m: [0, 1, 0]},
                {time_s: 2, position_m: [0, 1.5, 3], look_at_m: [0, 1, 0]}]}
frames: {size: [320, 180]}
rain: {rate_mm_h: 40, max_drops: 8192, range_m: 8, occlusion_size: 128}
ground: {on: true, cells: 128}
splash: {max_splashes: 4096, max_droplets: 4096}
glass:
  - {name: pane, width_m: 0.6, height_m: 0.3, follow: camera, position_m: [0, -0.2, 0.8], max_drops: 1024,
     max_texels: 128,
     wipers: [{pivot_m: [0.3, -0.05], reach_m: 0.3, blade_m: 0.2, low_deg: 160, high_deg: 20}]}
END
grep -v -e '^ground' -e '^splash' "$work/scene.yaml" >"$work/pane.yaml"
sed '/^glass/,$d' "$work/pane.yaml" >"$work/rain.yaml"

# view SCENE NAME OPTION...: a script from standard input.
view() {
    local scene=$1.yaml name=$2
    shift 2
    cat >"$work/$name.txt"
    (cd "$work" && timeout 200 xvfb-run -a -s "-screen 0 1280x720x24" "$virga" view "$scene" --window 900x500 \
        --script "$name.txt" --device "$device" "$@") >"$work/$name.out" 2>"$work/$name.err"
    local code=$?
    ! grep '^validation: ' "$work/$name.err" || fail "$name: validation"
    return $code
}

if ! "$virga" help view | grep -q -- --script; then
    "$virga" view "$work/scene.yaml" 2>"$work/err" && fail "a build without a window opens one"
    has 'this build has no window: install libglfw3-dev and libimgui-dev' "$work/err"
    [ "$failures" = 0 ] && { echo "skipped: built without a window"; exit 77; }
    exit 1
fi

# ---- what the window shows, and what comes out of it

view scene tour <<'END' || { cat "$work/tour.err"; fail "tour"; }
downscale 2
wait 3
window first.png
set rain.rate_mm_h 90            # what the saved scene must have
set glass.*.wipers.*.sweep_s 1.5
set splash.style paper
set glass.0.film_um 9
view state
window state.png
view material
wait 1
view occlusion 1
wait 1
view pane
window pane.png
view height
wait 1
view refraction
wait 1
view velocity
wait 1
view picture
preset storm
step 2
shot still.png
shot still.exr
set rain.rate_mm_h 90
set ground.start_wetness 0.5
restart
panel off
camera 1 2 5 10 -15
resize 700 400
wait 2
shot flown.png
print
window bare.png
save tuned.yaml
quit
END
grep -q '^time .* s, paused, 90 mm/h, view picture, camera free, 3[0-9][0-9] x ' "$work/tour.out" ||
    { cat "$work/tour.out"; fail "what print says"; }
# Windows have the picture in their left half; what is around it is darker than 20.
while read -r picture geometry; do
    [ -s "$work/$picture" ] || { fail "no $picture"; continue; }
    [ "$(number Avg "$work/$picture" "$geometry")" -gt 20 ] || fail "$picture is black"
done <<'END'
first.png 120x60+80+200
pane.png 120x60+80+200
bare.png 120x60+200+150
still.png 120x60+40+50
flown.png 120x60+40+50
END
# The focus goes to what is picked: the floor below the middle is 1.5 m lower, and the view depth there
# 1.5 / (sin(7.125) + 0.5 tan(20) cos(7.125)) = 4.92 m. Above the horizon it is infinity, the default,
# which is not written.
sed 's/^camera:.*/camera: {fov_deg: 40, aperture_f: 2.8, keys: [{position_m: [0, 1.5, 4], look_at_m: [0, 1, 0]}]}/
    /{time_s: 2/d' "$work/rain.yaml" >"$work/picked.yaml"
view picked pick <<'END' || { cat "$work/pick.err"; fail "pick"; }
downscale 2
wait 1
focus 0.5 0.75
wait 2
save floor.yaml
focus 0.5 0.02
wait 2
save sky.yaml
quit
END
focus_of() { grep -o 'focus_m: [0-9.e+]*' "$1" | cut -d' ' -f2; }
awk -v m="$(focus_of "$work/floor.yaml")" 'BEGIN { exit !(m > 4.82 && m < 5) }' ||
    fail "the focus is at $(focus_of "$work/floor.yaml") m, not on the floor"
[ -z "$(focus_of "$work/sky.yaml")" ] || fail "the focus is at $(focus_of "$work/sky.yaml") m, not at infinity"
# The panel: on the right, with buttons and text on its dark ground.
[ "$(number StdDev "$work/first.png" 420x480+475+10)" -gt 12 ] || fail "the window has no panel"
oiiotool --info "$work/bare.png" | grep -q '700 x *400' || fail "the window was not resized"
oiiotool --info -v "$work/still.exr" >"$work/header" && grep -q 'rain.R' "$work/header" &&
    grep -q 'glass.R' "$work/header" || { cat "$work/header"; fail "layers of the screenshot"; }

# ---- pools that the device has no room for: the window stays, and the rain starts as before

view rain pools <<'END' || { cat "$work/pools.err"; fail "pools"; }
wait 1
set rain.max_drops 4194304
restart
wait 1
set rain.max_drops 4096
restart
wait 1
print
quit
END
if "$virga" info --device "$device" | grep -q '^\*.*llvmpipe'; then # storage buffers of 128 MiB; others may have room
    has '; started as before' "$work/pools.err"
    [ "$(grep -c 'started as before' "$work/pools.err")" = 1 ] || fail "the second start had the first one's pools"
fi
has '40 mm/h' "$work/pools.out"

# ---- any frame, from the nearest checkpoint: what virga render draws
(cd "$work" && "$virga" render rain.yaml -o saved --frames 1-12 --simulate --checkpoint-every 6 --device "$device") \
    >"$work/log" 2>&1 || { cat "$work/log"; fail "checkpoints"; }
view rain sought --checkpoints saved <<'END' || { cat "$work/sought.err"; fail "sought"; }
seek 8
print
shot ahead.exr
seek 14
seek 8
shot back.exr
quit
END
view rain stepped <<'END' || { cat "$work/stepped.err"; fail "stepped"; }
seek 8
shot stepped.exr
quit
END
has 'frame 8, from the checkpoint of frame 6' "$work/sought.err"
has 'frame 14, from the checkpoint of frame 12' "$work/sought.err"
has 'time 0.2917 s, paused' "$work/sought.out"
size=$(sed -n 's/.* \([0-9]*\) x \([0-9]*\)$/\1x\2/p' "$work/sought.out" | head -n 1)
"$virga" render "$work/rain.yaml" -o "$work/drawn" --frames 8 --size "$size" --device "$device" >"$work/log" 2>&1 ||
    { cat "$work/log"; fail "frame 8"; }
for other in back.exr stepped.exr drawn/frame.0008.exr; do
    idiff -q -fail 0 "$work/ahead.exr" "$work/$other" >"$work/log" 2>&1 ||
        { cat "$work/log"; fail "another frame: $other"; }
done

# ---- a lens that is opened while the window is there

view rain opened <<'END' || { cat "$work/opened.err"; fail "opened"; }
downscale 4
step 1
shot sharp.png
set camera.aperture_f 0.05
shot soft.png
wait 1
set camera.aperture_f 0
shot closed.png
quit
END
idiff -q -fail 0 "$work/sharp.png" "$work/closed.png" >"$work/diff" 2>&1 || fail "a closed lens blurs"
idiff -q -fail 0 "$work/sharp.png" "$work/soft.png" >"$work/diff" 2>&1 && fail "an opened lens blurs nothing"

# ---- the tuned scene is a scene

"$virga" check "$work/tuned.yaml" >"$work/check" 2>&1 || { cat "$work/check"; fail "virga check of the saved scene"; }
has '90 mm/h' "$work/check"
for line in 'sweep_s: 0.55' 'style: paper' 'film_um: 9' 'kind: clean' 'start_wetness: 0.5'; do
    has "$line" "$work/tuned.yaml"
done
# It renders what the same settings, given by hand, render. Other tests validate renders.
render() {
    VIRGA_VALIDATE=0 timeout 100 "$virga" render "$1" -o "$work/$2" --frames 2 --device "$device" \
        --layers beauty,rain,glass "${@:3}" 2>"$work/err" || { cat "$work/err"; fail "render $1"; }
}
view pane save <<'END' || { cat "$work/save.err"; fail "save"; }
downscale 4
set rain.rate_mm_h 90
set glass.*.kind coated
save plain.yaml
quit
END
render "$work/plain.yaml" by_view
render "$work/pane.yaml" by_hand --set rain.rate_mm_h=90 --set glass.0.kind=coated
oiiotool "$work/by_view/frame.0002.exr" "$work/by_hand/frame.0002.exr" --fail 0 --diff >"$work/diff" 2>&1 ||
    { cat "$work/diff"; fail "the saved scene renders another picture"; }

# ---- lists grow and shrink, while it rains and in the saved scene

view pane lists <<'END' || { cat "$work/lists.err"; fail "lists"; }
downscale 4
add lights
set lights.1.position_m [2, 3, -1]
add glass.0.wipers
set glass.0.wipers.1.phase_s 0.4
add rain.keys
add camera.keys
unfold Lamps on
unfold Camera on
wait 3
window lists.png
drop camera.keys
drop rain.keys
wait 2
save grown.yaml
quit
END
"$virga" check "$work/grown.yaml" >"$work/check" 2>&1 || { cat "$work/check"; fail "virga check of grown lists"; }
has 'lights       2' "$work/check"
has '2 wipers' "$work/check"
has 'phase_s: 0.4' "$work/grown.yaml"

# ---- drops are lit by what a lamp lights around them: of a lamp that has been put out nothing is left

sed -e 's/intensity_w_sr: 6/intensity_w_sr: 300/' -e 's/^frames:/environment: {intensity: 0.01}\n&/' "$work/rain.yaml" \
    >"$work/lamp.yaml"
view lamp put_out <<'END' || { cat "$work/put_out.err"; fail "put out"; }
downscale 2
step 3
shot lit.exr
set lights.0.intensity_w_sr 0
wait 2
shot put_out.exr
quit
END
view lamp never_lit <<'END' || { cat "$work/never_lit.err"; fail "never lit"; }
downscale 2
set lights.0.intensity_w_sr 0
step 3
wait 2
shot never_lit.exr
quit
END
oiiotool "$work/put_out.exr" "$work/never_lit.exr" --fail 0 --diff >"$work/diff" 2>&1 ||
    { cat "$work/diff"; fail "a lamp that was put out is seen in drops"; }
oiiotool "$work/lit.exr" "$work/never_lit.exr" --fail 0.01 --diff >/dev/null 2>&1 && fail "a lamp lights nothing"

# ---- real keys

if command -v xdotool >/dev/null; then
    cat >"$work/keys.txt" <<'END'
downscale 4
wait 2
await paused
await no-panel
await flying
quit
END
    (cd "$work" && timeout 150 xvfb-run -a -s "-screen 0 1280x720x24" bash -c '
        "$0" view rain.yaml --window 640x360 --script keys.txt --device "$1" &
        viewer=$!
        pressed=""
        for try in $(seq 600); do
            kill -0 $viewer 2>/dev/null || break
            sleep 0.2
            xdotool search --name "virga view" windowfocus 2>/dev/null || continue
            # Each once: space and tab are toggles.
            case $try in
            *0) [ "${pressed#*s}" != "$pressed" ] || { xdotool key space && pressed=s$pressed; } ;;
            *5) [ "${pressed#*t}" != "$pressed" ] || { xdotool key Tab && pressed=t$pressed; } ;;
            *) xdotool keydown w sleep 0.15 keyup w ;;
            esac
        done
        wait $viewer' "$virga" "$device") >"$work/out" 2>"$work/err" || { cat "$work/err"; fail "keys of a user"; }
fi

# ---- what is wrong

refuses() { # TEXT, and a script from standard input
    view rain wrong && fail "accepted: $1"
    has "$1" "$work/wrong.err"
}
refuses "wrong.txt:2: no command 'wiat'; did you mean 'wait'?" <<'END'
play
wiat 3
END
refuses 'wrong.txt:1: expected resize W H' <<'END'
resize 3
END
refuses 'script, line 1: rain.rate_mm_h: expected a number from 0 to 200' <<'END'
set rain.rate_mm_h 900
END
refuses 'camera.keys: a scene has 1 at least' <<'END'
drop camera.keys
drop camera.keys
END
refuses 'snow: the scene has no list of this name' <<'END'
add snow
END
refuses "no preset 'hail'" <<'END'
preset hail
END
(cd "$work" && env -u DISPLAY -u WAYLAND_DISPLAY timeout 60 "$virga" view scene.yaml) 2>"$work/err" &&
    fail "a window without a display"
has 'virga view: no display to open a window on' "$work/err"
[ "$(wc -l <"$work/err")" = 1 ] || { cat "$work/err"; fail "more than a line about a missing display"; }
(cd "$work" && timeout 60 "$virga" view scene.yaml --downscale 9) 2>"$work/err" && fail "--downscale 9"
has '--downscale: expected' "$work/err"

[ "$failures" = 0 ] && echo "the window is as it should be"
[ "$failures" = 0 ]

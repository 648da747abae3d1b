#!/usr/bin/env bash
# Several processes write the same files as one, to the byte; what ends one of them is said in one line, and none is
# left behind.
# Usage: jobs.sh VIRGA
here=$(cd "$(dirname "$0")" && pwd)
. "$here/common.sh" "$1" pgrep python3

write_road
cat >"$work/scene.yaml" <<'YAML'
virga: 1
meshes: [{file: road.obj}]
camera:
  keys:
    - {time_s: 0, position_m: [0, 1, 3], look_at_m: [0, 1, 0]}
    - {time_s: 0.5, position_m: [0, 1, -1], look_at_m: [0, 1, -6]}
frames: {fps: 24, first: 1, last: 9, size: [64, 36], preroll_s: 0.2, warm_start: false}
rain: {rate_mm_h: 60, gust_m_s: 2, max_drops: 4096, occlusion_size: 64}
ground: {on: true, cells: 128, start_water_mm: 3}
splash: {on: false}
YAML

# same FOLDER: all files are those of the folder that one process wrote. A film has the time at which it was made, and a
# checkpoint what the device has drawn so far.
same() {
    local file
    [ "$(ls "$work/one")" = "$(ls "$work/$1")" ] || fail "$1: has $(ls "$work/$1")"
    for file in "$work/one"/*; do
        case $file in
        *.mp4 | *.virga) ;;
        *.jsonl) python3 "$here/check_lines.py" "$file" "$work/$1/stats.jsonl" || fail "$1: the statistics differ" ;;
        *) cmp "$file" "$work/$1/${file##*/}" || fail "$1: ${file##*/} differs" ;;
        esac
    done
}

# refuses CODE TEXT OPTION...: one line, and that exit code.
refuses() {
    local expected=$1 text=$2
    shift 2
    timeout 60 "$virga" render "$work/scene.yaml" -o "$work/refused" "$@" >"$work/log" 2>&1
    local code=$?
    [ $code = "$expected" ] || fail "exit code $code, expected $expected: $*"
    grep -q -- "$text" "$work/log" && [ "$(wc -l <"$work/log")" = 1 ] || { cat "$work/log"; fail "expected '$text'"; }
}

options=(--points --stats --preview --checkpoint-every 4)
draw scene one "${options[@]}" --jobs 1
[ "$(ls "$work/one" | grep -c frame)" = 9 ] || { fail "one process"; exit 1; }
draw scene three "${options[@]}" --jobs 3
grep -q ', 3 processes, ' "$work/log" || fail "not three processes"
[ "$(grep -c ' processes, ' "$work/log")" = 1 ] || fail "processes say the same"
same three
[ "$(cut -d, -f1 "$work/one/stats.jsonl")" = "$(cut -d, -f1 "$work/three/stats.jsonl")" ] ||
    fail "the lines are not in the order of frames"

# More than there are frames; and gaps, behind which they begin at checkpoints.
export VIRGA_VALIDATE=0 # it has seen all passes now
rm "$work/three"/frame.000[135678].exr
draw scene three "${options[@]}" --jobs 40 --resume
grep -q ', 6 processes, ' "$work/log" || fail "not one process for each frame that is missing"
same three

refuses 2 '--jobs: expected .*, got .0' --jobs 0
refuses 2 '--jobs: expected' --jobs 65
refuses 2 '--jobs: expected' --jobs two
refuses 2 '--jobs: expected no --claim' --jobs 2 --claim a
refuses 2 '--jobs: expected no --simulate' --jobs 2 --simulate --checkpoint-every 4
refuses 2 'nothing.obj' --jobs 2 --set 'meshes=[{file: nothing.obj}]'
refuses 2 'no device' --jobs 2 --device nothing
[ ! -e "$work/refused/stats.jsonl" ] || fail "a refused render has written statistics"

# begin FOLDER: draws many frames, and waits for the first.
begin() {
    local i
    "$virga" render "$work/scene.yaml" -o "$work/$1" --device "$device" --frames 1-5000 --jobs 2 >"$work/log" 2>&1 &
    running=$!
    for i in $(seq 3000); do
        [ ! -e "$work/$1/frame.0002.exr" ] || break
        sleep 0.01
    done
    workers=$(pgrep -P $running)
    [ "$(wc -w <<<"$workers")" = 2 ] || fail "not two processes: $workers"
}

# ended: none of them is there any more.
ended() {
    local i worker
    for worker in $workers; do
        for i in $(seq 300); do
            kill -0 "$worker" 2>/dev/null || break
            sleep 0.1
        done
        ! kill -0 "$worker" 2>/dev/null || { fail "a process is left"; kill -9 "$worker"; }
    done
}

begin killed
kill -9 ${workers%%[[:space:]]*}
wait $running
code=$?
[ $code = 1 ] || fail "exit code $code, expected 1"
ended
grep -v -e ' sample$' -e '^frame [0-9]* of' -e '^pre-roll' "$work/log" >"$work/said"
grep -q '^virga render: one of 2 processes was killed.*; [0-9]* finished frames are kept in' "$work/said" &&
    [ "$(wc -l <"$work/said")" = 1 ] || { cat "$work/log"; fail "not said that one was killed"; }

begin parent
kill -9 $running
wait $running 2>/dev/null
ended

exit $((failures > 0))

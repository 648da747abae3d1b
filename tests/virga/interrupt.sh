#!/usr/bin/env bash
# A render that is interrupted, killed, refused or out of disk leaves whole files only, and --resume makes the folder
# what a run that nothing stopped makes of it, to the byte.
# Usage: interrupt.sh VIRGA [JOBS]
set -u
virga=$1
jobs=${2:-1}
device=${VIRGA_TEST_DEVICE:-cpu}
here=$(cd "$(dirname "$0")" && pwd)
frames=$((jobs > 1 ? 64 : 16)) # so many that some are left at an interruption
work=$(mktemp -d)
running=""
trap '[ -z "$running" ] || kill -9 "$running" 2>/dev/null; umount "$work/disk" 2>/dev/null; rm -rf "$work"' EXIT

python3 -c pass 2>/dev/null || { echo "skipped: python3 is not installed"; exit 77; }
"$virga" info --device "$device" >"$work/log" 2>&1 || { echo "skipped: no device"; cat "$work/log"; exit 77; }

cat >"$work/box.obj" <<'OBJ'
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
f 1 2 3
f 1 3 4
OBJ
cat >"$work/scene.yaml" <<YAML
virga: 1
meshes: [{file: box.obj}]
camera: {keys: [{time_s: 0, position_m: [0, 1, 3], look_at_m: [0, 1, 0]}]}
frames: {fps: 24, first: 1, last: $frames, size: [64, 36], warm_start: false}
rain: {rate_mm_h: 10, gust_m_s: 1, max_drops: 4096, occlusion_size: 64}
YAML

failures=0
fail() {
    echo "FAILED: $1"
    sed 's/^/    /' "$work/err"
    failures=$((failures + 1))
}

# arguments FOLDER: what all renders have in common.
arguments() {
    arguments=(render "$work/scene.yaml" -o "$work/$1" --device "$device" --points --stats --jobs "$jobs")
}

# render CODE FOLDER OPTION...: waits for the end, expects an exit code.
render() {
    local expected=$1 folder=$2 code
    shift 2
    arguments "$folder"
    timeout 60 "$virga" "${arguments[@]}" "$@" >"$work/stdout" 2>"$work/err"
    code=$?
    [ "$code" = "$expected" ] || fail "$folder $*: exit code $code, expected $expected"
}

# start FOLDER OPTION...: does not wait.
start() {
    arguments "$1"
    shift
    "$virga" "${arguments[@]}" "$@" >"$work/stdout" 2>"$work/err" &
    running=$!
}

# until_there COMMAND...: polls, for half a minute. A frame takes 5 ms, and `sleep` as long to begin: the shell itself
# waits, for input that never comes.
exec 8<> <(:)
until_there() {
    local i
    for ((i = 0; i < 10000; i++)); do
        "$@" && return
        kill -0 "$running" 2>/dev/null || break
        read -rt 0.003 -u 8
    done
    "$@" || fail "never: $*"
}

# stop SIGNAL CODE: signals what was started and waits for it, for half a minute.
stop() {
    local code i
    kill "-$1" "$running"
    for i in $(seq 300); do
        kill -0 "$running" 2>/dev/null || break
        sleep 0.1
    done
    kill -9 "$running" 2>/dev/null
    wait "$running" 2>/dev/null
    code=$?
    running=""
    [ "$code" = "$2" ] || fail "SIG$1: exit code $code, expected $2"
}

count() { # FOLDER PATTERN
    find "$work/$1" -name "$2" | wc -l
}

# untorn FOLDER: each file there is as in the folder of the run that nothing stopped. whole: and none is temporary.
untorn() {
    local file
    for file in "$work/$1"/*.exr "$work/$1"/*.ply "$work/$1"/*.png; do
        [ ! -e "$file" ] || cmp -s "$file" "$work/once/${file##*/}" || fail "$1: ${file##*/} is not as it should be"
    done
}

whole() {
    untorn "$1"
    [ "$(count "$1" '.*.tmp')" = 0 ] || fail "$1: left $(find "$work/$1" -name '.*.tmp')"
}

# complete FOLDER: whole, and all of it.
complete() {
    whole "$1"
    [ "$(count "$1" 'frame.*.exr')" = "$frames" ] && [ "$(count "$1" 'rain.*.ply')" = "$frames" ] ||
        fail "$1: is not complete"
    python3 "$here/check_lines.py" "$work/once/stats.jsonl" "$work/$1/stats.jsonl" >"$work/err" 2>&1 ||
        fail "$1: stats.jsonl"
}

# said LINES PATTERN: how many lines the program said beside its usual ones, one of them like the pattern.
said() {
    grep -v -e ' sample$' -e '^frame [0-9]* of' -e '^$' "$work/err" >"$work/said"
    [ "$(wc -l <"$work/said")" = "$1" ] && grep -Eq -- "$2" "$work/said" || fail "said, instead of $1 with '$2':"
}

begin() {
    : >"$work/err"
    echo "$1"
}

begin "a run that nothing stops"
render 0 once --preview
! grep '^validation: ' "$work/err" || fail "validation"
export VIRGA_VALIDATE=0 # it has seen all passes now
[ "$(count once 'frame.*.exr')" = "$frames" ] || { fail "the run that nothing stops"; exit 1; }
cp -r "$work/once" "$work/broken"
complete once

begin "Ctrl-C finishes the frame in hand"
start interrupted --preview
until_there test -e "$work/interrupted/frame.0002.exr"
stop INT 130
done=$(count interrupted 'frame.*.exr')
[ "$done" -ge 2 ] && [ "$done" -lt "$frames" ] || fail "$done frames before the interruption"
[ "$(count interrupted 'rain.*.ply')" = "$done" ] && [ "$(count interrupted 'preview.*.png')" = "$done" ] ||
    fail "a frame was left half-way"
[ "$(wc -l <"$work/interrupted/stats.jsonl")" = "$done" ] || fail "not one line of statistics a frame"
next=1 # where several processes draw, frames behind it may be there
while [ -e "$work/interrupted/$(printf frame.%04d.exr $next)" ]; do next=$((next + 1)); done
[ "$jobs" -gt 1 ] || [ "$next" = $((done + 1)) ] || fail "a frame is left out"
said 2 "interrupted: $done frames are in .*; --resume goes on with frame $next$"
whole interrupted
render 0 interrupted --preview --resume
complete interrupted

begin "Ctrl-C on the way to a far frame"
start far --frames 90000
until_there grep -q ' sample$' "$work/err"
stop INT 130
[ "$(count far '*.exr')" = 0 ] || fail "a frame was written"

begin "kill leaves no torn frame"
start killed
until_there test -e "$work/killed/frame.0003.exr"
stop KILL 137
untorn killed
render 0 killed --resume
complete killed

begin "what a kill leaves is cleaned up"
broken=$work/broken
rm "$broken/frame.0004.exr" "$broken/rain.0007.ply" "$broken/preview.0008.png" "$broken/rain.0011.ply"
: >"$broken/frame.0005.exr"
head -c 300 "$work/once/frame.0006.exr" >"$broken/frame.0006.exr"
sed -i 9d "$broken/stats.jsonl"
sed -n 2p "$work/once/stats.jsonl" >>"$broken/stats.jsonl"
printf '{"frame":10,"time_s":0.3' >>"$broken/stats.jsonl"
echo torn >"$broken/.virga-4194305-0.tmp"
echo mine >"$broken/.virga-notes.tmp"
exec 9>"$broken/.virga-4194305-1.tmp"
flock 9
render 0 broken --resume --preview
said 2 "frame.0005.exr: the file is empty; the frame is rendered again$"
[ ! -e "$broken/.virga-4194305-0.tmp" ] || fail "a dead run's temporary file is still there"
[ -e "$broken/.virga-4194305-1.tmp" ] || fail "a living run's temporary file was taken away"
[ -e "$broken/.virga-notes.tmp" ] || fail "somebody's own file was taken away"
exec 9>&-
rm "$broken/.virga-4194305-1.tmp" "$broken/.virga-notes.tmp"
complete broken

begin "frames of another render are refused"
refused() { # PATTERN OPTION...
    local pattern=$1
    shift
    render 2 once --resume "$@"
    said 1 "once/frame.0001.exr has $pattern"
}
find "$work/once" -type f -exec md5sum {} + | sort >"$work/before"
refused 'seed 1, expected 4294967295; ' --seed 4294967295
refused 'size 64x36, expected 32x32; ' --size 32x32
refused 'samples 1, expected 2; ' --samples 2
refused 'layers beauty,depth,haze,rain,velocity,normal,id, expected rain; ' --layers rain
refused 'water velocity \(none\), expected 50; ' --water-velocity 50
refused 'scene hash [0-9a-f]{16}, expected [0-9a-f]{16}; ' --set rain.rate_mm_h=11
find "$work/once" -type f -exec md5sum {} + | sort >"$work/after"
cmp -s "$work/before" "$work/after" || fail "a refused render has changed files"

begin "no room for a file"
mkdir "$work/limited"
render 0 limited --frames 1-3
(ulimit -f 32; render 1 limited --frames 1-6 --resume; exit "$failures") || failures=$((failures + 1))
said 1 "cannot write .*rain.000[45].ply: File too large; 0 finished frames are kept in"
[ "$(count limited 'frame.*.exr')" = 3 ] || fail "finished frames were not kept"
whole limited
render 0 limited --resume
complete limited

begin "a full disk"
mkdir "$work/disk"
if [ "$(id -u)" = 0 ] && mount -t tmpfs -o size=1m virga-test "$work/disk" 2>/dev/null; then
    render 1 disk
    done=$(count disk 'frame.*.exr')
    said 1 "cannot write .*: No space left on device; $done finished frames are kept in"
    [ "$done" -gt 2 ] && [ "$done" -lt "$frames" ] || fail "$done frames on the disk"
    whole disk
    mount -o remount,size=64m "$work/disk"
    render 0 disk --resume
    complete disk
    umount "$work/disk"
else
    echo "  (left out: only root can mount a small disk)"
fi

[ "$failures" = 0 ] && echo "nothing torn, nothing lost"

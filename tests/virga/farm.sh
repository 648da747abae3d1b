#!/usr/bin/env bash
# A farm of processes makes the same files as one render, to the byte, also where tasks are killed; a frame that can not
# be written is named with the end of its log, and the rest is finished.
# Usage: farm.sh VIRGA
. "$(dirname "$0")/farm_common.sh"
running=""
trap '[ -z "$running" ] || kill -9 "$running" 2>/dev/null; rm -rf "$work"' EXIT

# Tasks are killed at two moments, and each time once more at random.
"$virga" farm "$work/scene.yaml" -o "$work/farm" --local --tasks 3 --jobs 2 -- "${options[@]}" >"$work/out" 2>&1 &
running=$!
for kill in 1 2; do
    for _ in $(seq 300); do
        pkill -9 -f "$work/farm .*--claim" && break
        sleep 0.1
    done
    sleep 0.$((RANDOM % 10))
done
wait "$running" || { fail "the farm: exit code $?"; cat "$work/out"; }
running=""
same farm
grep -q "12 of 12 frames are done" "$work/out" || { fail "the end of the farm says"; cat "$work/out"; }

# Frame 7 can not be written.
mkdir -p "$work/bad/frame.0007.exr"
"$virga" farm "$work/scene.yaml" -o "$work/bad" --local --frames 6-8 --tasks 1 -- --device "$device" >"$work/out" 2>&1
[ $? = 1 ] || fail "a farm with a bad frame: exit code"
"$virga" farm --status "$work/bad" >"$work/status"
grep -q "2 of 3 frames are done, 0 are being drawn, 1 have failed, 0 wait" "$work/status" ||
    { fail "the status of a bad frame"; cat "$work/status"; }
grep -q "frame 7 has failed 3 times" "$work/status" || fail "the bad frame is not named"
grep -q "frame.0007.exr" "$work/status" || fail "the reason is not shown"

# What is wrong is one line.
wrong() {
    local expected=$1
    shift
    "$virga" farm "$@" >"$work/out" 2>&1
    [ $? = 2 ] && [ "$(wc -l <"$work/out")" = 1 ] && grep -q -- "$expected" "$work/out" ||
        { fail "$*: expected one line, \"$expected\""; cat "$work/out"; }
}
wrong "expected one of --local and --slurm" "$work/scene.yaml" -o "$work/x"
wrong "expected -o DIR" "$work/scene.yaml" --local
wrong "the farm sets it for each task" "$work/scene.yaml" -o "$work/x" --local -- --frames 1-2
wrong "expected a folder of virga farm" --status "$work/nowhere"
wrong "cannot read" "$work/none.yaml" -o "$work/x" --local

[ "$failures" = 0 ] && echo "all as expected"
exit $((failures > 0))

#!/usr/bin/env bash
# Every scene of ours is one that `virga check` calls good, and the changelog names it.
# Usage: scenes.sh VIRGA SOURCE
set -u
virga=$1 source=$2
failures=0
for scene in "$source"/assets/scenes/*.yaml; do
    name=$(basename "$scene" .yaml)
    said=$(timeout 60 "$virga" check "$scene" 2>&1) && [ "$(tail -n 1 <<<"$said")" = good ] ||
        { echo "FAILED: $name: $said"; failures=$((failures + 1)); }
    grep -q "^- Scenes of our own:.*\`$name\`" "$source/CHANGELOG.md" ||
        { echo "FAILED: $name is not in the changelog's list of scenes"; failures=$((failures + 1)); }
done
[ $failures = 0 ] && echo "all scenes are good"
exit $((failures > 0))

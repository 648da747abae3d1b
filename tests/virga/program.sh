#!/usr/bin/env bash
# What the program says of itself: version, commit, device and driver; a manual page of all commands.
# Usage: program.sh VIRGA MAN_PAGE VERSION
set -u
virga=$1 page=$2 version=$3
status=0
fail() {
    echo "$*"
    status=1
}
said=$("$virga" --version) || fail "--version failed"
number=1
for pattern in "virga $version" 'commit: ([0-9a-f]{7,}(-dirty)?|unknown)' 'device: .+, Vulkan 1\.[0-9]+' \
    'driver: .+'; do
    line=$(echo "$said" | sed -n "${number}p")
    echo "$line" | grep -qxE "$pattern" || fail "line $number of --version: '$line', expected $pattern"
    number=$((number + 1))
done
# Without a driver it still says what it is.
bare=$(VK_ICD_FILENAMES=/nowhere VK_DRIVER_FILES=/nowhere "$virga" --version 2>/dev/null) ||
    fail "--version without a driver failed"
echo "$bare" | grep -q '^device: none, ' || fail "without a driver: '$bare'"

# A number that no device has: those that there are, by what --device accepts.
absent=$("$virga" info --device 99 2>&1 >/dev/null)
echo "$absent" | grep -qxE 'virga info: no device 99: there (is only|are) 0, (cpu|gpu)(; [0-9]+, (cpu|gpu))*' ||
    fail "info --device 99: '$absent'"

for command in $("$virga" help | sed -n 's/^  \([a-z]*\)  *[a-z].*/\1/p'); do
    [ "$command" = help ] || [ "$command" = virga ] && continue
    grep -q "^\.SS virga $command$" "$page" || fail "the manual page lacks $command"
    long=$("$virga" help "$command" | awk 'length > 100')
    [ -z "$long" ] || fail "help $command: wider than 100 columns: $long"
done
long=$("$virga" help | awk 'length > 100')
[ -z "$long" ] || fail "help: wider than 100 columns: $long"
if command -v groff >/dev/null; then
    warnings=$(groff -man -Tutf8 -ww "$page" 2>&1 >/dev/null)
    [ -z "$warnings" ] || fail "groff: $warnings"
fi
exit $status

#!/usr/bin/env bash
# The library links no Vulkan symbol, needs only libc and libm, and exports what its headers declare and what the list
# of its ABI says: no less, no more. Usage: symbols.sh LIBRARY INCLUDE_DIR LIST [--update]
set -u
library=$1 headers=$2 list=$3
status=0
undefined=$(nm -D --undefined-only "$library" | awk '{print $NF}')
if echo "$undefined" | grep -q '^vk'; then
    echo "undefined Vulkan symbols:"
    echo "$undefined" | grep '^vk'
    status=1
fi
needed=$(objdump -p "$library" | awk '/NEEDED/ {print $2}' | grep -v -E '^lib(c|m)\.so' || true)
if [ -n "$needed" ]; then
    echo "needs more than libc and libm: $needed"
    status=1
fi

exported=$(nm -D --defined-only "$library" | awk '$2 != "A" {print $NF}' | LC_ALL=C sort)
declared=$(cat "$headers"/virga/*.h | tr '\n' ' ' | grep -o 'VIRGA_API [^;(]*(' |
    sed 's/ *($//; s/.*[ *]//' | grep '^virga_' | LC_ALL=C sort)
same() { # what is, what should be, where from
    difference=$(LC_ALL=C comm -3 <(echo "$1") <(echo "$2"))
    [ -z "$difference" ] && return
    echo "exported and not in $3 (left), or in $3 and not exported (right):"
    echo "$difference"
    status=1
}
same "$exported" "$declared" "the headers"
if [ "${4:-}" = --update ]; then
    echo "$exported" >"$list"
else
    same "$exported" "$(cat "$list")" "$list"
    [ $status -eq 0 ] || echo "after an intended change of the ABI: $0 $library $headers $list --update"
fi

# Until 1.0 each 0.x may break the ABI, and its number is 0.x; from then on it is the major version.
version=$(objdump -p "$library" | awk '/SONAME/ {print $2}')
wanted=$(awk '/define VIRGA_VERSION_MAJOR/ {major = $3} /define VIRGA_VERSION_MINOR/ {minor = $3}
    END {print "libvirga.so." (major > 0 ? major : major "." minor)}' "$headers/virga/base.h")
if [ "$version" != "$wanted" ]; then
    echo "the library calls itself $version, expected $wanted"
    status=1
fi
exit $status

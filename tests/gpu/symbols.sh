#!/usr/bin/env bash
# The library links no Vulkan symbol, needs only libc and libm, and exports only virga_*.
# Usage: symbols.sh LIBRARY
set -u
status=0
undefined=$(nm -D --undefined-only "$1" | awk '{print $NF}')
if echo "$undefined" | grep -q '^vk'; then
    echo "undefined Vulkan symbols:"
    echo "$undefined" | grep '^vk'
    status=1
fi
needed=$(objdump -p "$1" | awk '/NEEDED/ {print $2}' | grep -v -E '^lib(c|m)\.so' || true)
if [ -n "$needed" ]; then
    echo "needs more than libc and libm: $needed"
    status=1
fi
foreign=$(nm -D --defined-only "$1" | awk '$2 != "A" {print $NF}' | grep -v '^virga_' || true)
if [ -n "$foreign" ]; then
    echo "exports what is not virga_*: $foreign"
    status=1
fi
exit $status

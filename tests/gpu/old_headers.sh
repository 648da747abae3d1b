#!/usr/bin/env bash
# With the Vulkan headers of 1.1 or 1.0, the first line of the compiler says what is needed; with those of 1.1 it is the
# only error. The old headers are cut out of the installed ones. Usage: old_headers.sh INCLUDE_DIR "CC" "CXX"
set -eu
include=$1 cc=$2 cxx=$3
work=$(mktemp -d "${TMPDIR:-/tmp}/virga-headers-XXXXXX")
trap 'rm -rf "$work"' EXIT
core=$(echo '#include <vulkan/vulkan_core.h>' | ${cc%% *} -E -M - | tr ' ' '\n' | grep '/vulkan_core.h$')
echo '#include <virga/virga.h>' >"$work/host.c"
cp "$work/host.c" "$work/host.cpp"
wanted='Virga needs the headers of Vulkan 1.2 or newer'

# Up to the section of the next version, which is one line of 1.0, and those of 1.1.
try() { # next version, compiler, file
    mkdir -p "$work/$1/vulkan"
    cp "${core%/*}/vk_platform.h" "$work/$1/vulkan/"
    {
        sed "/^#define VK_VERSION_$1 1/,\$d" "$core"
        printf '#ifdef __cplusplus\n}\n#endif\n#endif\n'
    } >"$work/$1/vulkan/vulkan_core.h"
    echo '#include "vulkan_core.h"' >"$work/$1/vulkan/vulkan.h"
    if $2 -fsyntax-only -I "$work/$1" -I "$include" "$work/$3" 2>"$work/log"; then
        echo "$2 took headers without version $1"
        exit 1
    fi
    grep 'error:' "$work/log" >"$work/errors"
    head -1 "$work/errors" | grep -q "$wanted" && return
    head -3 "$work/errors"
    echo "no line says what is needed"
    exit 1
}
for compiler in "$cc host.c" "$cxx host.cpp"; do
    try 1_2 "${compiler% *}" "${compiler##* }"
    [ "$(wc -l <"$work/errors")" = 1 ] || { cat "$work/errors"; echo "more than one error"; exit 1; }
    try 1_1 "${compiler% *}" "${compiler##* }"
done

#!/bin/sh
# Stands in for glslangValidator where a test builds the library again from the same source: copies the array that
# BUILD_ROOT has compiled from the same shader. Shaders are most of the time of such a build.
# Usage: compiled_shader.sh BUILD_ROOT OPTION..., with the options of shaders/meson.build
# `compiled_shader.sh BUILD_ROOT --native-file` prints the machine file that tells Meson to use it.
set -eu
build=$1
shift
if [ "${1-}" = --native-file ]; then
    printf "[binaries]\nglslangValidator = ['%s', '%s']\n" "$(realpath "$0")" "$build"
    exit
fi
output="" depfile="" name="" option=""
for argument in "$@"; do
    case $option in
    -o) output=$argument ;;
    --depfile) depfile=$argument ;;
    --vn) name=${argument%_spv} ;;
    esac
    option=$argument
done
compiled=$build/shaders/$name.spv.h
[ -n "$output" ] && [ -n "$depfile" ] && [ -f "$compiled" ] || exec glslangValidator "$@"
cp "$compiled" "$output"
echo "$output: $compiled" >"$depfile"

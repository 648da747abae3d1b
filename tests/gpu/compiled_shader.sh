#!/bin/sh
# Stands in for shaders/compile.sh and for glslangValidator where a test builds the library again from the same source:
# copies the array that BUILD_ROOT has compiled from the same shader. Shaders are most of the time of such a build.
# Usage: compiled_shader.sh BUILD_ROOT OPTION..., with the options of shaders/meson.build
#        compiled_shader.sh BUILD_ROOT compile.sh GLSLANG SPIRV_OPT OPTION..., where GLSLANG is this and BUILD_ROOT
# `compiled_shader.sh BUILD_ROOT --native-file` prints the machine file that tells Meson to use it.
set -eu
build=$1
shift
if [ "${1-}" = --native-file ]; then
    self=$(realpath "$0")
    printf "[binaries]\nglslangValidator = ['%s', '%s']\ncompile.sh = ['%s', '%s', 'compile.sh']\n" \
        "$self" "$build" "$self" "$build"
    exit
fi
[ "${1-}" != compile.sh ] || shift 4
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

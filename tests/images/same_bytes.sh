#!/usr/bin/env bash
# The same seed gives the same files: on any number of threads, in two vector widths, and for frames rendered alone.
# Usage: same_bytes.sh VIRGA SCENE NARROW_CACHE "SYSTEM..." [OPTION...] with a folder that is kept for the shaders of
# the narrow width (none: without that width), the systems that write point caches, and further options of the program.
set -eu
virga=$1 scene=$2 narrow_cache=$3 systems=$4
shift 4
options=("$@") layers=()
[[ " $* " == *" --size "* ]] || options+=(--size 160x90)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { # folder frames [environment...]
    local folder=$work/$1 frames=$2
    shift 2
    # Validation has seen these passes in the first run.
    [ ! -d "$work/once" ] || export VIRGA_VALIDATE=0
    env "$@" "$virga" render "$scene" -o "$folder" --frames "$frames" --points --device cpu \
        --set rain.max_drops=16384 "${options[@]}" "${layers[@]}" 2>"$folder.log" || { cat "$folder.log"; exit 1; }
    ! grep '^validation: ' "$folder.log" || exit 1
}

same() { # folder file...
    local folder=$1
    shift
    for file in "$@"; do
        cmp "$work/once/$file" "$work/$folder/$file" || { echo "$folder/$file differs"; exit 1; }
    done
}

points="" last="frame.0002.exr"
for system in $systems; do
    points+=" $system.0001.ply $system.0002.ply"
    last+=" $system.0002.ply"
done
frames="frame.0001.exr frame.0002.exr $points"
# Software Vulkan (Mesa 22.3) signals the end of a draw from a thread while another one may free what is signalled. With
# freed memory overwritten, as Meson asks for, it then waits for ever, now and then.
render once 1-2 LP_NUM_THREADS=3 MALLOC_PERTURB_=0
render one_thread 1-2 LP_NUM_THREADS=1 MALLOC_PERTURB_=0
same one_thread $frames
# Software Vulkan's shader cache does not know the vector width, so this width has one of its own.
if [ "$narrow_cache" != none ]; then
    # All its shaders are compiled anew, so only what moves drops is compared, and little is drawn.
    layers=(--layers depth)
    render narrow 1-2 LP_NATIVE_VECTOR_WIDTH=128 MESA_SHADER_CACHE_DIR="$narrow_cache"
    same narrow $points
    layers=()
fi
render alone 2
same alone $last
echo "same bytes"

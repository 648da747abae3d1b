#!/bin/sh
# Compiles one shader to a C array and makes it smaller: by a quarter to two fifths, which is a fifth less time for a
# driver to read it.
# Usage: compile.sh GLSLANG SPIRV_OPT OPTION..., with the options that meson.build gives to glslangValidator
#
# All passes move, merge and remove instructions, and none computes: glslang's own -Os also folds constants, which
# rounds differently. So the results are the same to the last bit with and without. Names stay, for captures.
set -eu
glslang=$1 spirv_opt=$2
shift 2
output="" depfile="" name="" option=""
for argument in "$@"; do
    case $option in
    -o) output=$argument ;;
    --depfile) depfile=$argument ;;
    --vn) name=$argument ;;
    esac
    option=$argument
done

# --vn asks for an array in place of a binary, so it is left out.
count=$# skip=0
while [ "$count" -gt 0 ]; do
    argument=$1
    shift
    count=$((count - 1))
    if [ "$argument" = --vn ]; then
        skip=2
    elif [ "$argument" = "$output" ]; then
        argument=$output.spv
    fi
    if [ "$skip" -gt 0 ]; then
        skip=$((skip - 1))
    else
        set -- "$@" "$argument"
    fi
done
trap 'rm -f "$output.spv" "$output.opt"' EXIT
# Most of glslang's time goes to its tables of what GLSL has built in: some 40 MB of small pieces. In large pages, and
# with the heap grown in large steps, that takes a quarter less. glibc before 2.35 ignores the names.
GLIBC_TUNABLES=glibc.malloc.hugetlb=1:glibc.malloc.top_pad=67108864 "$glslang" "$@"
sed -i "1s|^[^:]*:|$output:|" "$depfile"

# Functions into main and variables into values, what is dead or twice removed; then once more, as each leaves work for
# the others.
"$spirv_opt" --target-env=vulkan1.2 --scalar-block-layout \
    --merge-return --inline-entry-points-exhaustive --eliminate-dead-functions --private-to-local \
    --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive \
    --scalar-replacement=100 --convert-local-access-chains \
    --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive --ssa-rewrite \
    --eliminate-dead-code-aggressive --eliminate-dead-branches --merge-blocks --eliminate-dead-inserts \
    --redundancy-elimination --eliminate-dead-code-aggressive --cfg-cleanup \
    "$output.spv" -o "$output.opt"
{
    echo "const uint32_t $name[] = {"
    od -v -An -tx4 -w32 "$output.opt" | sed 's/ \([0-9a-f]*\)/0x\1,/g'
    echo "};"
} >"$output"

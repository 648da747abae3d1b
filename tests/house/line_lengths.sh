#!/bin/sh
# line_lengths.sh SOURCE - no line of code is longer than 120 columns, also where .clang-format does not reach.
cd "$1" || exit 1
long=$(find engine shaders tools tests -name '*.[ch]' -o -name '*.glsl' -o -name '*.comp' -o -name '*.vert' \
    -o -name '*.frag' -o -name '*.py' | xargs awk 'length > 120 {print FILENAME ":" FNR ": " length}')
[ -z "$long" ] && exit 0
echo "longer than 120 columns:"
echo "$long"
exit 1

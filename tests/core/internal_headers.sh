#!/bin/sh
# Compiles every header of the engine's own folders alone, as the engine is compiled.
# usage: internal_headers.sh ENGINE_DIR "CC" [compiler flags such as -I]
set -u
engine=$1 cc=$2
shift 2
failed=0 count=0

command -v "${cc%% *}" >/dev/null || { echo "internal_headers.sh: no C compiler '$cc'"; exit 77; }
headers=$(cd "$engine" && find . -name '*.h' ! -path './include/*' | sed 's|^\./||' | sort)
[ -n "$headers" ] || { echo "internal_headers.sh: no headers under $engine" >&2; exit 1; }
for header in $headers; do
    # The declaration stands for headers of macros alone, which would leave nothing to compile. EFFECT is for the header
    # of the tables of effects.
    if printf '#include "%s"\nextern int alone;\n' "$header" | $cc -x c -std=gnu11 -Wall -Wextra -Werror -fsyntax-only \
        -DEFFECT=rain -I"$engine" -I"$engine/include" "$@" -; then
        count=$((count + 1))
    else
        echo "internal_headers.sh: \"$header\" does not compile alone" >&2
        failed=$((failed + 1))
    fi
done
echo "internal_headers.sh: $count compiled, $failed failed"
[ "$failed" -eq 0 ]

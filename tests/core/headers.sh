#!/bin/sh
# Compiles every public header alone, as C11 and C++17, and all together as C17, pedantically.
# usage: headers.sh INCLUDE_DIR "CC" "CXX" [compiler flags such as -I]
set -u
include=$1 cc=$2 cxx=$3
shift 3
failed=0 count=0

try() { # compiler, language, standard, header...
    compiler=$1 language=$2 standard=$3
    shift 3
    # The declaration stands for headers of macros alone, which would leave nothing to compile.
    if { printf '#include <%s>\n' "$@" && echo 'extern int alone;'; } | $compiler -x "$language" -std="$standard" \
        -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" $flags -; then
        count=$((count + 1))
    else
        echo "headers.sh: <$*> does not compile as $standard" >&2
        failed=$((failed + 1))
    fi
}

flags="$*"
command -v "${cc%% *}" >/dev/null || { echo "headers.sh: no C compiler '$cc'"; exit 77; }
command -v "${cxx%% *}" >/dev/null || { echo "headers.sh: no C++ compiler '$cxx'"; exit 77; }
headers=$(cd "$include" && find -L virga -name '*.h' | sort)
[ -n "$headers" ] || { echo "headers.sh: no headers under $include/virga" >&2; exit 1; }
for header in $headers; do
    try "$cc" c c11 "$header"
    try "$cxx" c++ c++17 "$header"
done
# What one header needs is the same in both standards of C.
# shellcheck disable=SC2086 # headers are words
try "$cc" c c17 $headers
echo "headers.sh: $count compiled, $failed failed"
[ "$failed" -eq 0 ]

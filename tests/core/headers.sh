#!/bin/sh
# Compiles every public header alone, as C11, C17 and C++17, pedantically.
# usage: headers.sh INCLUDE_DIR "CC" "CXX" [compiler flags such as -I]
set -u
include=$1 cc=$2 cxx=$3
shift 3
failed=0 count=0

try() { # compiler, language, standard, header
    # The declaration stands for headers of macros alone, which would leave nothing to compile.
    if printf '#include <%s>\nextern int alone;\n' "$4" | $1 -x "$2" -std="$3" \
        -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" $flags -; then
        count=$((count + 1))
    else
        echo "headers.sh: <$4> does not compile alone as $3" >&2
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
    try "$cc" c c17 "$header"
    try "$cxx" c++ c++17 "$header"
done
echo "headers.sh: $count compiled, $failed failed"
[ "$failed" -eq 0 ]

#!/usr/bin/env bash
# The program as `meson install` leaves it, under any prefix: it finds its own library, and its manual page is there.
# Usage: installed.sh BUILD_ROOT PREFIX
set -eu
build=$1 prefix=$2
work=$(mktemp -d "${TMPDIR:-/tmp}/virga-installed-XXXXXX")
trap 'rm -rf "$work"' EXIT
DESTDIR=$work meson install -C "$build" --no-rebuild --quiet >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
unset LD_LIBRARY_PATH
cd /
"$work$prefix/bin/virga" help >"$work/help" || { echo "the installed program does not run"; exit 1; }
grep -q "virga COMMAND" "$work/help" || { cat "$work/help"; exit 1; }
library=$(ldd "$work$prefix/bin/virga" | sed -n 's/.*libvirga[^ ]* => \([^ ]*\).*/\1/p')
case $(realpath "${library:-$work}") in # nothing where the library is static
    "$work" | "$work"/*) ;;
    *) echo "it takes another library: $library"; exit 1 ;;
esac
[ -s "$(find "$work$prefix" -name virga.1)" ] || { echo "no manual page"; exit 1; }

#!/usr/bin/env bash
# The program as `meson install` leaves it, under any prefix: it finds its own library and the module that reads
# pictures, and its manual page is there.
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
# The module is loaded with the first picture; this one is damaged.
printf 'virga: 1\ncamera: {keys: [{position_m: [0, 1, 3], look_at_m: [0, 1, 0]}]}\n' >"$work/scene.yaml"
echo words >"$work/plate.png"
"$work$prefix/bin/virga" render "$work/scene.yaml" -o "$work/out" --plate "$work/plate.png" 2>"$work/log" && exit 1
grep -q -e 'not a PNG picture' -e 'built without OpenImageIO' "$work/log" || { cat "$work/log"; exit 1; }

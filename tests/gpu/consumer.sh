#!/usr/bin/env bash
# Somebody else's programs: a Meson project has the library as a subproject, builds it as a release and installs it
# below a temporary prefix. Then it is used from there, outside the tree, by C and by C++, through pkg-config and
# through CMake. No device is needed.
# Usage: consumer.sh SOURCE_ROOT BUILD_ROOT "CC" "CXX" VERSION, where BUILD_ROOT has the compiled shaders
set -eu
source=$(cd "$1" && pwd) build=$2 cc=$3 cxx=$4 version=$5
for tool in meson pkg-config cmake ninja "${cc%% *}" "${cxx%% *}"; do
    command -v "$tool" >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done
work=$(mktemp -d "${TMPDIR:-/tmp}/virga-consumer-XXXXXX")
trap 'rm -rf "$work"' EXIT
unset DESTDIR MESON_BUILD_ROOT MESON_SOURCE_ROOT MESON_SUBDIR CFLAGS CXXFLAGS LDFLAGS || true
quietly() { # says what a command said only where it fails
    "$@" >"$work/log" 2>&1 || { cat "$work/log"; echo "failed: $*"; exit 1; }
}
expect() { # got wanted what
    [ "$1" = "$2" ] || { echo "$3: got '$1', expected '$2'"; exit 1; }
}

# What a consumer does before it has a device: asks for the version, drops a drop, forgets to fill a definition.
cat >"$work/consumer.c" <<'SOURCE'
#include <virga/virga.h>
#include <virga/shared/drop.h>

#include <stdio.h>
#include <string.h>

static int lines;

static void count_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    (void)text;
    lines += level == VIRGA_LOG_ERROR && id == VIRGA_LOG_COOKIE;
}

int main(void)
{
    virga_context_def def;
    virga_context *context = NULL;
    VkPhysicalDeviceVulkan12Features features12;
    VkPhysicalDeviceFeatures2 features;
    memset(&def, 0, sizeof def);
    def.log = count_line;
    memset(&features12, 0, sizeof features12);
    features12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    memset(&features, 0, sizeof features);
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &features12;
    if (virga_context_create(&def, &context) != VIRGA_ERROR_INVALID || context || lines != 1)
        return 2; /* not checked, in a release build */
    if (virga_enable_features(&features) != VIRGA_OK || !features12.scalarBlockLayout)
        return 3;
    if (sizeof(virga_drop_gpu) != 16 || virga_default_rain_def().size != sizeof(virga_rain_def))
        return 4;
    printf("%s %.2f\n", virga_version(), virga_drop_terminal_speed(0.002, 0));
    return 0;
}
SOURCE
cp "$work/consumer.c" "$work/consumer.cpp"

# ---- as a subproject of a release, which also installs the library: one build serves all that follows
"$source/tests/gpu/compiled_shader.sh" "$build" --native-file >"$work/native.ini"
mkdir -p "$work/host/subprojects"
ln -s "$source" "$work/host/subprojects/virga"
cp "$work/consumer.c" "$work/host/"
cat >"$work/host/meson.build" <<'SOURCE'
project('host', 'c', version: '1', default_options: ['c_std=c11', 'warning_level=3'])
virga = subproject('virga')
executable('consumer', 'consumer.c', dependencies: dependency('virga'))
SOURCE
quietly meson setup "$work/host/build" "$work/host" --native-file "$work/native.ini" --wrap-mode nofallback \
    --prefix "$work/prefix" --libdir lib --buildtype release -Db_ndebug=true -Doptimization=0
# The program and its libraries are not a host's business.
if grep -qiE "dependency (openexr|assimp|jansson|cmocka|yaml-0.1) found" "$work/log"; then
    cat "$work/log"
    echo "as a subproject it looks for what only the program and the tests need"
    exit 1
fi
quietly ninja -j2 -C "$work/host/build"
expect "$("$work/host/build/consumer")" "$version 6.49" "consumer of a subproject"

# ---- installed
quietly meson install -C "$work/host/build" --no-rebuild
export PKG_CONFIG_PATH="$work/prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
expect "$(pkg-config --modversion virga)" "$version" "version of the pkg-config file"
flags=$(pkg-config --cflags --libs virga)
case $flags in *"$source"* | *"$work/host"*) echo "pkg-config names the tree: $flags"; exit 1 ;; esac
mkdir "$work/outside"
cd "$work/outside"
warnings="-Wall -Wextra -Wpedantic -Werror"
# shellcheck disable=SC2086 # flags are words
quietly $cc -std=c11 $warnings "$work/consumer.c" -o in_c $flags
# shellcheck disable=SC2086
quietly $cxx -std=c++17 $warnings "$work/consumer.cpp" -o in_cpp $flags
export LD_LIBRARY_PATH="$work/prefix/lib"
expect "$(./in_c)" "$version 6.49" "consumer in C"
expect "$(./in_cpp)" "$version 6.49" "consumer in C++"
unset LD_LIBRARY_PATH

# By CMake, which finds the library where it was installed and links it by its path.
mkdir "$work/cmake"
cp "$work/consumer.c" "$work/consumer.cpp" "$work/cmake/"
cat >"$work/cmake/CMakeLists.txt" <<SOURCE
cmake_minimum_required(VERSION 3.16)
project(host C CXX)
find_package(virga $version REQUIRED)
add_executable(in_c consumer.c)
add_executable(in_cpp consumer.cpp)
set_target_properties(in_c PROPERTIES C_STANDARD 11 C_EXTENSIONS OFF)
set_target_properties(in_cpp PROPERTIES CXX_STANDARD 17 CXX_EXTENSIONS OFF)
foreach(program in_c in_cpp)
  target_compile_options(\${program} PRIVATE -Wall -Wextra -Wpedantic -Werror)
  target_link_libraries(\${program} PRIVATE virga::virga)
endforeach()
SOURCE
export CC=$cc CXX=$cxx
quietly cmake -S "$work/cmake" -B "$work/cmake/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix"
quietly ninja -j2 -C "$work/cmake/build"
expect "$("$work/cmake/build/in_c")" "$version 6.49" "consumer in C by CMake"
expect "$("$work/cmake/build/in_cpp")" "$version 6.49" "consumer in C++ by CMake"
# A version that is not there is refused, not taken for another.
sed 's/find_package(virga [0-9.]*/find_package(virga 99.0/' "$work/cmake/CMakeLists.txt" >"$work/cmake/other"
mv "$work/cmake/other" "$work/cmake/CMakeLists.txt"
if cmake -S "$work/cmake" -B "$work/cmake/other" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/log" 2>&1; then
    echo "CMake took version $version for 99.0"
    exit 1
fi
unset CC CXX

# Every header is there, none of the internal ones is, and nothing else was installed.
installed=$(cd "$work/prefix" && find . -type f -o -type l | sort | tr '\n' ' ')
for header in "$source"/engine/include/virga/*.h; do
    [ -f "$work/prefix/include/virga/${header##*/}" ] || { echo "not installed: ${header##*/}"; exit 1; }
done
stray=$(cd "$work/prefix" && find . \( -type f -o -type l \) \
    ! -path './include/virga/*.h' ! -path './include/virga/shared/*.glsl' \
    ! -path './lib/libvirga.so*' ! -path './lib/pkgconfig/virga.pc' ! -path './lib/cmake/virga/virgaConfig*.cmake')
[ -z "$stray" ] || { echo "installed what nobody asked for: $stray"; exit 1; }

# ---- without CMake
# CMake is nothing that a host of Meson, or who installs for one, must have: its package is left out then.
mkdir "$work/tools"
# ccache's folder is left out: its links would find themselves in place of the compiler.
clean_path=${PATH//\/usr\/lib\/ccache:/}
(IFS=:; for folder in $clean_path; do [ ! -d "$folder" ] || ln -sn "$folder"/* "$work/tools" 2>/dev/null || true; done)
rm -f "$work"/tools/cmake*
PATH=$work/tools quietly meson setup "$work/host/no_cmake" "$work/host" --wrap-mode nofallback
echo "installed: $installed"

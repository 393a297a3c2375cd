#!/usr/bin/env bash
# clang-tidy 14 (.clang-tidy) over the project's own sources, or over the files named, each compiled by itself: the release
# preset compiles the files of a folder together, so build/tidy is configured to tell how one alone is compiled. The whole
# project takes long; what ctest gives it is told in project_tests.cmake. Exit 77 (skipped) without clang-tidy.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."

command -v run-clang-tidy >/dev/null || { echo "SKIPPED: clang-tidy is not here"; exit 77; }
built=${GNOMON_BUILD_DIR:-build/release} build=${GNOMON_TIDY_DIR:-build/tidy}
[[ -d $built/raster/glad ]] || { echo "SKIPPED: no OpenGL loader in $built"; exit 77; }
mkdir -p "$(dirname -- "$build")"
cmake --preset release -B "$build" -DGNOMON_UNITY=OFF -DGNOMON_TESTS=ON >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }
mkdir -p "$build/raster" && cp -r "$built/raster/glad" "$build/raster/"  # generated; the rest is there once configured

files=("$@")
((${#files[@]})) || files=('/(app|compare|hybrid|raster|raytrace|scene|tests)/.*\.cpp$')
status=0
findings=$(run-clang-tidy -quiet -j "$(nproc)" -p "$build" "${files[@]}" 2>/dev/null) || status=1
grep -vE '^clang-tidy(-[0-9]+)? ' <<<"$findings" || true
((status)) || echo "clang-tidy has nothing to say"
exit "$status"

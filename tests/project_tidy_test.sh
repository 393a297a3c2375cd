#!/usr/bin/env bash
# clang-tidy 14 (.clang-tidy) over the project's own sources, or over the files named, compiled as build/release (or
# GNOMON_BUILD_DIR) compiles them. The whole project takes long; what ctest gives it is told in project_tests.cmake.
# Exit 77 (skipped) without clang-tidy or without a build that tells how files are compiled.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."

build=${GNOMON_BUILD_DIR:-build/release}
command -v run-clang-tidy >/dev/null || { echo "SKIPPED: clang-tidy is not here"; exit 77; }
[[ -f $build/compile_commands.json ]] || { echo "SKIPPED: no compile_commands.json in $build"; exit 77; }

files=("$@")
((${#files[@]})) || files=('/(app|compare|hybrid|raster|raytrace|scene|tests)/.*\.cpp$')
status=0
findings=$(run-clang-tidy -quiet -j "$(nproc)" -p "$build" "${files[@]}" 2>/dev/null) || status=1
grep -vE '^clang-tidy(-[0-9]+)? ' <<<"$findings" || true
((status)) || echo "clang-tidy has nothing to say"
exit "$status"

#!/usr/bin/env bash
# clang-tidy 14 (.clang-tidy) over the project's own sources, or over the files named, each compiled by itself: the release
# preset compiles the files of a folder together, so build/tidy is configured to tell how one alone is compiled. The whole
# project takes long; what ctest gives it is told in project_tests.cmake. Exit 77 (skipped) without clang-tidy 14, the
# version of Debian 12: other versions look for other things.
#
#   project_tidy_test.sh [FILE...]         each file by itself
#   project_tidy_test.sh --joined FOLDER   the sources of a folder joined to one, which takes a tenth of the time: most of
#                                          it goes into the headers that they share
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."

version=$(clang-tidy --version 2>/dev/null | grep -oE 'version [0-9]+' | grep -oE '[0-9]+' || true)
[[ $version == 14 ]] || { echo "SKIPPED: clang-tidy 14 is not here (found: ${version:-none})"; exit 77; }
built=${GNOMON_BUILD_DIR:-build/release} build=${GNOMON_TIDY_DIR:-build/tidy}
[[ -d $built/raster/glad ]] || { echo "SKIPPED: no OpenGL loader in $built"; exit 77; }
mkdir -p "$(dirname -- "$build")"
cmake --preset release -B "$build" -DGNOMON_UNITY=OFF -DGNOMON_TESTS=ON >"$build.log" 2>&1 || { cat "$build.log"; exit 1; }
mkdir -p "$build/raster" && cp -r "$built/raster/glad" "$build/raster/"  # generated; the rest is there once configured

look_at_each() {
  local findings status=0
  findings=$(run-clang-tidy -quiet -j "$(nproc)" -p "$build" "$@" 2>/dev/null) || status=1
  grep -vE '^clang-tidy(-[0-9]+)? ' <<<"$findings" || true
  return "$status"
}

# What two checks cannot tell of joined files: a header that one of them includes twice, and a using-declaration that one of
# them does not need.
look_at_lines() {
  awk '
    function unneeded(name) { for (name in named) if (words[name] < 2) print file ": using " name " is not needed" }
    FNR == 1 { unneeded(); file = FILENAME; delete seen; delete named; delete words }
    /^#include/ && seen[$0]++ { print file ": twice: " $0 }
    { line = $0; gsub(/[^A-Za-z0-9_]+/, " ", line); n = split(line, word, " "); for (i = 1; i <= n; ++i) ++words[word[i]] }
    /^using [A-Za-z0-9_:]+::[A-Za-z0-9_]+;/ { named[word[n]] = 1 }
    END { unneeded() }' "$@"
}

look_at_joined() {
  local sources=("$1"/*.cpp) joined=$build/${1//\//_}_joined.cpp flags findings status=0
  cat -- "${sources[@]}" >"$joined"
  mapfile -t flags < <(python3 - "$build/compile_commands.json" "$PWD/${sources[0]}" <<'END'
import json, shlex, sys
command, = [c["command"] for c in json.load(open(sys.argv[1])) if c["file"] == sys.argv[2]]
words = shlex.split(command)
print("\n".join(words[1:words.index("-o")]))
END
  )
  findings=$(clang-tidy -quiet --config-file=.clang-tidy --checks=-readability-duplicate-include "$joined" -- "${flags[@]}" 2>/dev/null) || status=1
  findings+=$(look_at_lines "${sources[@]}")
  ((status)) || [[ -n $findings ]] || return 0
  look_at_each "${sources[@]/#/$PWD/}" || true  # names the file and the line
  echo "$findings"
  return 1
}

status=0
if [[ ${1-} == --joined ]]; then
  look_at_joined "${2:?--joined needs a folder}" || status=1
elif (($#)); then
  look_at_each "$@" || status=1
else
  look_at_each '/(app|compare|hybrid|raster|raytrace|scene|tests)/.*\.cpp$' || status=1
fi
((status)) || echo "clang-tidy has nothing to say"
exit "$status"

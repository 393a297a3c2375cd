#!/usr/bin/env bash
# clang-tidy 14 (.clang-tidy) over the project's own sources, or over the files named, each compiled by itself: the release
# preset compiles a target's files together, so build/tidy is configured to tell how one alone is compiled. The whole
# project takes long; what ctest gives it is told in project/tests.cmake. Exit 77 (skipped) without clang-tidy 14, the
# version of Debian 12: other versions look for other things.
#
#   project_tidy_test.sh [FILE...]         each file by itself
#   project_tidy_test.sh --together ROOM   a room's sources as the release preset compiles them, which takes a tenth of
#                                          the time: most of it goes into the headers that they share
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

version=$(clang-tidy --version 2>/dev/null | grep -oE 'version [0-9]+' | grep -oE '[0-9]+' || true)
[[ $version == 14 ]] || { echo "SKIPPED: clang-tidy 14 is not here (found: ${version:-none})"; exit 77; }
built=${GNOMON_BUILD_DIR:-build/release} build=${GNOMON_TIDY_DIR:-build/tidy}
[[ -d $built/raster/glad ]] || { echo "SKIPPED: no OpenGL loader in $built"; exit 77; }

alone_configured() {
  mkdir -p "$(dirname -- "$build")"
  cmake --preset release -B "$build" -DGNOMON_UNITY=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DGNOMON_TESTS=ON >"$build.log" 2>&1 || { cat "$build.log"; return 1; }
  mkdir -p "$build/raster" && cp -r "$built/raster/glad" "$build/raster/"  # generated; the rest is there once configured
}

# tidy FOLDER OF compile_commands.json, FILE...
tidy() {
  local findings status=0
  findings=$(run-clang-tidy -quiet -j "$(nproc)" -p "$@" 2>/dev/null) || status=1
  grep -vE '^clang-tidy(-[0-9]+)? ' <<<"$findings" || true
  return "$status"
}

# What a check cannot tell of files compiled together: a using-declaration that one of them does not need.
# shellcheck disable=SC2016  # awk expands these
unneeded_using='
    function unneeded(name) { for (name in named) if (words[name] < 2) { print file ": using " name " is not needed"; found = 1 } }
    FNR == 1 { unneeded(); file = FILENAME; delete named; delete words }
    { line = $0; gsub(/[^A-Za-z0-9_]+/, " ", line); n = split(line, word, " "); for (i = 1; i <= n; ++i) ++words[word[i]] }
    /^using [A-Za-z0-9_:]+::[A-Za-z0-9_]+;/ { named[word[n]] = 1 }
    END { unneeded(); exit found }'

# What Highway compiles several times stands alone in the release preset, too, and is told by its own name.
tidy_together() {
  local room=$1 units status=0
  units="/(gnomon_${room}(_untimed)?\\.dir/Unity/unity_part_[0-9]+_cxx\\.cxx|$room/(base/)?[^/]*\\.cpp)\$"
  grep -qE "\"file\": \"[^\"]*${units%\$}\"" "$built/compile_commands.json" || { echo "nothing of $room is compiled in $built"; return 1; }
  # CMake's own file of a unit includes sources.
  tidy "$built" -checks=-bugprone-suspicious-include -header-filter="/$room/.*" "$units" || status=1
  find "$room" -name '*.cpp' -print0 | sort -z | xargs -0 awk "$unneeded_using" || status=1
  return "$status"
}

status=0
if [[ ${1-} == --together ]]; then
  tidy_together "${2:?--together needs a room}" || status=1
else
  alone_configured || exit 1
  (($#)) || set -- '/(app|compare|hybrid|raster|raytrace|report|scene|studies|tests|verify)/.*\.cpp$'
  tidy "$build" "$@" || status=1
fi
((status)) || echo "clang-tidy has nothing to say"
exit "$status"

#!/usr/bin/env bash
# clang-tidy 14 (.clang-tidy) over the project's own sources, or over the files named, each compiled by itself: the release
# preset compiles a target's files together, so build/tidy is configured to tell how one alone is compiled. The whole
# project takes long; what ctest gives it is told in project/tests.cmake. Exit 77 (skipped) without clang-tidy 14, the
# version of Debian 12: other versions look for other things.
#
#   project_tidy_test.sh [FILE...]         each file by itself
#   project_tidy_test.sh --together ROOM   a room's sources as the release preset compiles them, which takes a tenth of
#                                          the time: most of it goes into the headers that they share. What it found
#                                          clean is looked at again once a file that it is made of is another
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

# key_of FOLDER COMMAND: stands for all that clang-tidy's answer depends on: itself, what it is asked, how the unit is compiled, and
# each file that the compiler read for it. Fails where the build does not know these, or one of them is newer than the object.
key_of() {
  local object files
  object=$(sed -E 's/.* -o ([^ ]+) -c .*/\1/' <<<"$2")
  mapfile -t files < <(ninja -C "$built" -t deps "$object" 2>/dev/null | sed -n 's/^    //p')
  cd -- "$1" || return 1
  ((${#files[@]})) && [[ -z $(find -L "${files[@]}" -newer "$object" -print -quit 2>&1) ]] || return 1
  { printf '%s\n' "$version" "$2" "${files[@]}"; cat -- "$here/.clang-tidy" "$here/tests/project/project_tidy_test.sh" "${files[@]}"; } |
    sha256sum | cut -d ' ' -f 1
}

# What Highway compiles several times stands alone in the release preset, too, and is told by its own name. A unit that was
# found clean has a file in $built/tidy, named by its key.
tidy_together() {
  local room=$1 units unit folder command key status=0 any=0 here=$PWD look=() keys=()
  units="/(gnomon_${room}(_untimed)?\\.dir/Unity/unity_part_[0-9]+_cxx\\.cxx|$room/(base/)?[^/]*\\.cpp)\$"
  while IFS=$'\t' read -r folder command unit; do
    [[ $unit =~ $units ]] || continue
    any=1
    key=$(key_of "$folder" "$command") || key=
    [[ -z $key || ! -f $built/tidy/$key ]] || continue
    look+=("^$unit\$")
    [[ -z $key ]] || keys+=("$built/tidy/$key")
  done < <(sed -nE '/^ *"directory": /h; /^ *"(command|file)": /H; /^ *"file": /{x; s/\n/\t/g; s/ *"(directory|command|file)": "//g; s/",?(\t|$)/\1/g; p}' \
    "$built/compile_commands.json")
  ((any)) || { echo "nothing of $room is compiled in $built"; return 1; }
  # What GCC precompiled says nothing to clang; every file includes what it needs itself.
  mkdir -p "$built/tidy"
  sed -E 's/ -(Winvalid-pch|fpch-preprocess|include [^ ]*cmake_pch\.hxx)//g' "$built/compile_commands.json" >"$built/tidy/compile_commands.json"
  # CMake's own file of a unit includes sources.
  if ((${#look[@]})) && tidy "$built/tidy" -checks=-bugprone-suspicious-include -header-filter="/$room/.*" "${look[@]}"; then
    ((${#keys[@]} == 0)) || touch "${keys[@]}"
  elif ((${#look[@]})); then
    status=1
  fi
  find "$room" -name '*.cpp' -print0 | sort -z | xargs -0 awk "$unneeded_using" || status=1
  return "$status"
}

status=0
if [[ ${1-} == --together ]]; then
  tidy_together "${2:?--together needs a room}" || status=1
else
  alone_configured || exit 1
  (($#)) || set -- '/(app|benchmark|compare|functions|grade|hybrid|judge|lab|raster|raytrace|report|scene|studies|tests|verify)/.*\.cpp$'
  tidy "$build" "$@" || status=1
fi
((status)) || echo "clang-tidy has nothing to say"
exit "$status"

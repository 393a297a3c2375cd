#!/bin/sh
# The libraries, installed, and a program that is built with them as docs/library.md says.
# project_library_test.sh BUILD_FOLDER WORK_FOLDER SOURCE_FOLDER
set -eu
build=$1 work=$2 source=$3
rm -rf "$work"
mkdir -p "$work"
cmake --install "$build" --component development --prefix "$work/prefix" >"$work/install.log"
cmake -S "$source/docs/examples/library" -B "$work/example" -DCMAKE_PREFIX_PATH="$work/prefix" >"$work/configure.log" 2>&1 ||
  { cat "$work/configure.log"; exit 1; }
# Nothing of the sources or the build may be needed.
if grep -RE "(^|[\"' ;=])$source" "$work/prefix/lib" --include='*.cmake'; then echo "the package names the sources"; exit 1; fi
cmake --build "$work/example" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
"$work/example/wrong_pixels" fence 512 | tee "$work/coarse"
"$work/example/wrong_pixels" fence 4096 >"$work/fine"
wrong() { sed -n 's/ of .* pixels are wrong//p' "$1"; }
[ "$(wrong "$work/fine")" -gt 0 ] && [ "$(wrong "$work/coarse")" -gt "$(wrong "$work/fine")" ] ||
  { echo "a finer map is to be less wrong: $(wrong "$work/coarse"), $(wrong "$work/fine")"; exit 1; }
# The classes sum to the wrong pixels.
awk 'NR == 1 { wrong = $1 } NR > 1 { sum += $1 } END { exit sum != wrong }' "$work/coarse"
# A scene that is not there is an error with the program's exit code.
status=0
"$work/example/wrong_pixels" absent.json 2>/dev/null || status=$?
[ "$status" -eq 3 ]

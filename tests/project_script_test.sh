#!/usr/bin/env bash
# When ./gnomon configures a build: the first time, where the checkout was moved or copied (CMake cannot move a build), and
# after the presets have changed; and then no more. CMake and Ninja are stand-ins that note what they are asked.
# usage: project_script_test.sh SOURCE_DIR
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { printf '%s\n' "$*" >&2; exit 1; }

mkdir -p "$work/bin" "$work/first place"
cat >"$work/bin/cmake" <<'EOF'
#!/bin/sh
echo "$*" >>"$WORK/asked"
mkdir -p "$2/build/release/app"
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$2" >"$2/build/release/CMakeCache.txt"
echo >"$2/build/release/build.ninja"
EOF
cat >"$work/bin/ninja" <<'EOF'
#!/bin/sh
case "$*" in *-n*) echo 'ninja: no work to do.'; exit ;; esac
printf '#!/bin/sh\necho "$0"\n' >"$2/app/gnomon" && chmod +x "$2/app/gnomon"
EOF
chmod +x "$work/bin/cmake" "$work/bin/ninja"
export WORK=$work PATH=$work/bin:$PATH
unset GNOMON_STRICT
cp "$source/gnomon" "$source/CMakePresets.json" "$work/first place"
touch -d '1 hour ago' "$work/first place/CMakePresets.json"

# expect FOLDER OPTIONS: cmake is called with these behind the preset, or not at all where they are "-".
expect() {
  : >"$work/asked"
  local ran
  ran=$("$work/$1/gnomon" scenes 2>"$work/said") || fail "$1: $(cat "$work/said")"
  [[ $ran == "$work/$1/build/release/app/gnomon" ]] || fail "$1: ran $ran"
  local wanted="-S $work/$1 --preset release${2:+ $2}"
  [[ $2 != - ]] || wanted=
  [[ $(<"$work/asked") == "$wanted" ]] || fail "$1: cmake was asked '$(<"$work/asked")', not '$wanted'"
}

expect 'first place' '--fresh -DGNOMON_TESTS=OFF'
expect 'first place' -
touch "$work/first place/CMakePresets.json"
expect 'first place' ''
expect 'first place' -
mv "$work/first place" "$work/second"
expect second '--fresh -DGNOMON_TESTS=OFF'
expect second -
cp -a "$work/second" "$work/copy"
expect copy '--fresh -DGNOMON_TESTS=OFF'
expect second -

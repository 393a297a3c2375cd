#!/usr/bin/env bash
# When ./gnomon configures a build: the first time, where the checkout was moved or copied (CMake cannot move a build), and
# after the presets have changed; and then no more. Ninja is asked where something has changed since, and else is not:
# that takes longer than starting the program. CMake and Ninja are stand-ins that note what they are asked.
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
echo "$*" >>"$WORK/built"
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

# expect_build yes|no WHEN: whether Ninja is asked.
expect_build() {
  : >"$work/built"
  expect copy -
  [[ $([[ -s $work/built ]] && echo yes || echo no) == "$1" ]] || fail "$2: was Ninja asked? not '$1'"
}
expect_build no 'nothing has changed'
mkdir "$work/copy/scene"
expect_build yes 'a new folder'
expect_build no 'built since'
touch -d '1 hour ago' "$work/copy/scene/old.cpp"
expect_build yes 'a file that was put there, though an old one'
echo >>"$work/copy/scene/old.cpp"
expect_build yes 'an edited file'
rm "$work/copy/scene/old.cpp"
expect_build yes 'a file that is gone'
mkdir -p "$work/copy/.git/logs" && touch "$work/copy/.git/logs/HEAD"
expect_build yes 'another commit'
expect_build no 'built since'
rm "$work/copy/build/release/app/gnomon"
expect_build yes 'the program is gone'

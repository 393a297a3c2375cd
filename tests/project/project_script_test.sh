#!/usr/bin/env bash
# When ./gnomon configures a build: the first time, where the checkout was moved or copied (CMake cannot move a build), and
# after the presets have changed; and then no more. Ninja is asked where something has changed since, and else is not:
# that takes longer than starting the program. Who waits for another ./gnomon says so, and asks for a text without waiting.
# What cannot be written, and words that are missing, end with the README's exit codes. Another apt is waited for. CMake,
# Ninja and dpkg-query are stand-ins that note what they are asked.
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
for program in gnomon gnomon-judge gnomon-bench; do
  printf '#!/bin/sh\necho "$0"\n' >"$2/app/$program" && chmod +x "$2/app/$program"
done
EOF
cat >"$work/bin/dpkg-query" <<'EOF'
#!/bin/sh
case $2 in
  *Version*) cat "$WORK/installed" ;;
  *) [ -e "$WORK/missing" ] || echo installed ;;
esac
EOF
chmod +x "$work/bin/cmake" "$work/bin/ninja" "$work/bin/dpkg-query"
printf 'installed %s\n' 'libtbb-dev 1' 'libpng-dev 1' >"$work/installed"
mkdir "$work/dpkg" && touch -d '1 hour ago' "$work/dpkg/status"
export DPKG_ADMINDIR=$work/dpkg
export WORK=$work PATH=$work/bin:$PATH
unset GNOMON_STRICT
mkdir "$work/first place/cmake"
cp "$source/gnomon" "$source/CMakePresets.json" "$work/first place"
echo 'set(GNOMON_PROGRAMS app=gnomon benchmark=gnomon-bench judge=gnomon-judge)' >"$work/first place/cmake/GnomonProgram.cmake"
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

expect 'first place' '--fresh -DGNOMON_TESTS=OFF -DGNOMON_ALL_VECTORS=OFF'
expect 'first place' -
touch "$work/first place/CMakePresets.json"
expect 'first place' ''
expect 'first place' -
mv "$work/first place" "$work/second"
expect second '--fresh -DGNOMON_TESTS=OFF -DGNOMON_ALL_VECTORS=OFF'
expect second -
cp -a "$work/second" "$work/copy"
expect copy '--fresh -DGNOMON_TESTS=OFF -DGNOMON_ALL_VECTORS=OFF'
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

# Packages: dpkg's status is newer after any change, and only a change of what was built with counts.
echo 'installed libunrelated-dev 1' >>"$work/installed" && sleep 0.01 && touch "$work/dpkg/status"
expect_build no 'an unrelated package'
expect_build no 'an unrelated package, looked at once more'
sed -i 's/libtbb-dev 1/libtbb-dev 2/' "$work/installed" && touch "$work/dpkg/status"
expect_build yes 'another version of a package'
sed -i /libpng-dev/d "$work/installed" && touch "$work/dpkg/status"
expect_build yes 'a package that is gone'
expect_build no 'built since'

# expect_targets TARGETS ARGUMENTS...: what Ninja is asked for: gnomon itself, the program that has the command, or all.
expect_targets() {
  local targets=$1
  shift
  rm -f "$work"/copy/build/release/up-to-date*
  : >"$work/built"
  "$work/copy/gnomon" "$@" >/dev/null 2>"$work/said" || fail "$*: $(cat "$work/said")"
  [[ $(<"$work/built") == *" -j $(nproc) $targets" ]] || fail "$*: Ninja was asked '$(<"$work/built")', not for $targets"
}
mkdir -p "$work"/copy/{app,judge}/commands
printf 'GNOMON_COMMAND(\n    judge, 140, "") {\n' >"$work/copy/judge/commands/judge.cpp"
printf 'GNOMON_COMMAND(compare, 10, "") {\n' >"$work/copy/app/commands/compare.cpp"
expect_targets app/gnomon compare fence
expect_targets app/gnomon no-such-command
expect_targets app/gnomon --version
expect_targets 'app/gnomon gnomon_judge_program' judge compare
expect_targets 'app/gnomon gnomon_judge_program' --help judge
expect_targets gnomon_programs --man-page

expect_targets 'app/gnomon gnomon_judge_program' help judge
expect_targets app/gnomon version

# expect_rebuilt yes|no WHEN ARGUMENTS...: of a finished build, a program that is missing or does not run is built again.
expect_rebuilt() {
  local wanted=$1 when=$2
  shift 2
  : >"$work/built"
  "$work/copy/gnomon" "$@" >/dev/null 2>"$work/said" || fail "$when: $(cat "$work/said")"
  [[ $([[ -s $work/built ]] && echo yes || echo no) == "$wanted" ]] || fail "$when: was Ninja asked? not '$wanted'"
}
"$work/copy/gnomon" judge x >/dev/null 2>"$work/said" || fail "judge: $(cat "$work/said")"
expect_rebuilt no 'all is there' judge x
rm "$work/copy/build/release/app/gnomon-judge"
expect_rebuilt no 'what another command needs is gone' compare fence
expect_rebuilt yes 'the program of the command is gone' judge x
expect_rebuilt no 'built since' judge x
chmod -x "$work/copy/build/release/app/gnomon-judge"
expect_rebuilt yes 'the program may not be executed' judge x
"$work/copy/gnomon" --man-page >/dev/null 2>"$work/said" || fail "--man-page: $(cat "$work/said")"
rm "$work/copy/build/release/app/gnomon-bench"
expect_rebuilt yes 'one of all programs is gone' --man-page

: >"$work/asked"
"$work/copy/gnomon" build 2>"$work/said" || fail "build: $(cat "$work/said")"
[[ $(<"$work/asked") == *-DGNOMON_ALL_VECTORS=ON ]] || fail "build: not for every processor: $(<"$work/asked")"

# expect_end CODE WORDS ARGUMENTS...: in the copy, with nothing on stdout.
as=()
expect_end() {
  local code=$1 words=$2 status=0
  shift 2
  "${as[@]}" "$work/copy/gnomon" "$@" >"$work/out" 2>"$work/said" </dev/null || status=$?
  [[ $status == "$code" && $(<"$work/said") == *"$words"* && ! -s $work/out ]] ||
    fail "$*: exit $status, not $code with '$words': $(cat "$work/said" "$work/out")"
}
expect_end 2 '--preset needs a name' test --preset
expect_end 2 '--only needs names' test --only
expect_end 2 'no such preset (got nosuch' build nosuch
expect_end 2 'no such preset (got ../x' build ../x
expect_end 2 'no such preset (got nosuch' test --preset nosuch
expect_end 2 '--quick or --only, not both' test --quick --only one_test

# Another ./gnomon that builds.
exec 8>"$work/copy/build/.lock"
flock 8
echo $$ >&8
"$work/copy/gnomon" scenes >/dev/null 2>"$work/said" 8>&- || fail 'a program that is built waits or fails'
touch "$work/copy/CMakePresets.json" "$work/copy/scene/new.cpp"
for text in --help --version; do
  timeout 60 "$work/copy/gnomon" $text >"$work/out" 2>"$work/said" 8>&- || fail "$text waits for another build"
  [[ -s $work/out && $(<"$work/said") == *'another ./gnomon builds'* ]] || fail "$text: $(cat "$work/said")"
done
rm "$work/said"
"$work/copy/gnomon" scenes >"$work/out" 2>"$work/said" 8>&- &
waits=$!
for ((i = 0; i < 600; ++i)); do [[ ! -s $work/said ]] || break; sleep 0.1; done
[[ $(<"$work/said") == *"waiting for another ./gnomon"*"(process $$)"* ]] || fail "who waits says: $(cat "$work/said")"
[[ ! -s $work/out ]] || fail 'it did not wait'
exec 8>&-
wait $waits || fail "after it had waited: $(cat "$work/said")"

# Another apt or dpkg that holds a lock: it is waited for, and named. apt-get is the real one, with folders of its own, and
# installs nothing.
hold() {  # hold LOCK: until $work/LOCK's name.free is there
  local name=${1##*/}
  rm -f "$work/$name.free"
  /usr/bin/python3 - "$1" "$work/$name" <<'EOF' &
import fcntl, os, sys, time
lock = open(sys.argv[1], "w")
fcntl.lockf(lock, fcntl.LOCK_EX)
open(sys.argv[2] + ".held", "w").close()
for _ in range(3000):
    if os.path.exists(sys.argv[2] + ".free"): break
    time.sleep(0.02)
EOF
  holder=$!
  for ((i = 0; i < 600; ++i)); do [[ ! -e $work/$name.held ]] || break; sleep 0.1; done
}
# expect_said WORDS: by the ./gnomon that waits, which has not ended.
expect_said() {
  local i
  for ((i = 0; i < 600; ++i)); do [[ $(<"$work/said") != *"$1"* ]] || break; sleep 0.1; done
  [[ $(<"$work/said") == *"$1"* ]] || fail "who waits for apt does not say '$1': $(cat "$work/said")"
  kill -0 $waits || fail "who waits for apt has ended: $(cat "$work/said")"
}
if ((EUID == 0)) && [[ -x /usr/bin/apt-get && -x /usr/bin/python3 ]]; then
  apt=$work/apt
  mkdir -p "$apt"/lists/partial "$apt"/archives/partial "$apt"/dpkg "$apt"/etc/{sources.list.d,preferences.d,apt.conf.d} "$apt"/repo
  touch "$apt/dpkg/status" "$apt/repo/Packages"
  echo "deb [trusted=yes] file:$apt/repo ./" >"$apt/etc/sources.list"
  cat >"$work/bin/apt-get" <<'EOF'
#!/bin/bash
apt=$WORK/apt words=()
for word; do words+=("$word"); [[ $word != install ]] || break; done
/usr/bin/apt-get -o Dir::State="$apt" -o Dir::State::status="$apt/dpkg/status" -o Dir::State::Lists="$apt/lists" \
  -o Dir::Cache="$apt" -o Dir::Cache::archives="$apt/archives" -o Dir::Etc="$apt/etc" "${words[@]}" || exit
[[ $word == update ]] || rm -f "$WORK/missing"
EOF
  chmod +x "$work/bin/apt-get"
  hold "$apt/lists/lock"; of_lists=$holder
  hold "$apt/dpkg/lock-frontend"; of_dpkg=$holder
  touch "$work/missing" && rm "$work/copy/build/packages-run" && : >"$work/said"
  "$work/copy/gnomon" scenes >"$work/out" 2>"$work/said" &
  waits=$!
  expect_said "waiting for process $of_lists (python3), which holds $apt/lists/lock"
  touch "$work/lock.free"
  expect_said "waiting for process $of_dpkg (python3), which holds $apt/dpkg/lock-frontend"
  [[ -e $work/missing ]] || fail 'packages were installed beside another dpkg'
  touch "$work/lock-frontend.free"
  wait $waits || fail "after it had waited for apt: $(cat "$work/said")"
  [[ ! -e $work/missing && -s $work/out ]] || fail "what was waited for was not done: $(cat "$work/said")"
  [[ $(grep -c waiting "$work/said") == 2 ]] || fail "each is said once: $(cat "$work/said")"

  sed -i 's/^apt_wait_s=.*/apt_wait_s=1/' "$work/copy/gnomon"
  hold "$apt/lists/lock"
  touch "$work/missing" && rm "$work/copy/build/packages-run"
  expect_end 5 "still waiting for process $holder (python3)" scenes
  touch "$work/lock.free"
  rm "$work/missing" "$work/bin/apt-get"
  "$work/copy/gnomon" scenes >"$work/out" 2>"$work/said" || fail "with its packages again: $(cat "$work/said")"
fi

# Who sees no test end for long is told which of them run.
told=$({ printf '%s\n' '      Start  1: a' '      Start  2: b_1' '1/2 Test  #1: a ....   Passed    0.1 sec' && sleep 3; } |
  bash -c "$(sed -n '/^say() /p; /^say_what_runs()/,/^}/p' "$source/gnomon"); say_what_runs 2" 2>&1)
[[ $told == *'Passed'*$'\n''gnomon: still running: b_1 ('[23]' s)' ]] || fail "what runs is not said: $told"

# After a long run the words of what failed stand last, with ctest's own summary below them.
printf '%s\n' '      Start 1: a' '      Start 2: b' '1/3 Test #1: a ....   Passed    1.56 sec' '2/3 Test #2: b ....***Failed    0.10 sec' \
  'why b failed' '      Start 3: c' '3/3 Test #3: c ....***Skipped   0.10 sec' 'no tool for c' '' '67% tests passed, 1 tests failed out of 3' \
  '	  2 - b (Failed)' >"$work/said"
told=$(. <(sed -n '/^failed_words()/,/^}/p' "$source/gnomon") && failed_words "$work/said")
[[ $told == '2/3 Test #2: b '*'why b failed'*'67% tests passed'*'2 - b (Failed)' && $told != *'Passed'* && $told != *'for c'* ]] ||
  fail "what failed is not told last: $told"

# What cannot be written. A user who may not write can run what is built.
if ((EUID == 0)) && command -v setpriv >/dev/null; then
  as=(setpriv --reuid=65534 --regid=65534 --clear-groups)
  chmod -R a+rX "$work"
  "${as[@]}" "$work/copy/gnomon" scenes >"$work/out" 2>"$work/said" || fail "as another user: $(cat "$work/said")"
  touch "$work/copy/scene/newer.cpp"
  expect_end 4 'its owner' scenes
  expect_end 4 'cannot write' test
  as=()
fi
rm -rf "$work/copy/build" && touch "$work/copy/build"
expect_end 4 'cannot write' scenes

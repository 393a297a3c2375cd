#!/bin/sh
# The commit in the program's version: from git, from git archive's file, or none. Usage: SOURCE CMAKE PROGRAM
set -eu
source=$1 cmake=$2 program=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "project_commit_test: $*" >&2; exit 1; }
found() { "$cmake" "-DSOURCE=$1" "-DFILE=$work/commit.cpp" -P "$source/cmake/GnomonCommit.cmake"; sed -n 's/.*return "\(.*\)".*/\1/p' "$work/commit.cpp"; }

mkdir -p "$work/tarball/cmake" "$work/bare/cmake" "$work/checkout/cmake"
echo 0123456789abcdef0123456789abcdef01234567 >"$work/tarball/cmake/commit.txt"
[ "$(found "$work/tarball")" = 0123456789ab ] || fail "not the archive's commit: $(found "$work/tarball")"
cp "$source/cmake/commit.txt" "$work/bare/cmake"
[ -z "$(found "$work/bare")" ] || fail "a commit from nowhere: $(found "$work/bare")"

if command -v git >/dev/null; then
  cp "$source/cmake/commit.txt" "$work/checkout/cmake"
  cp "$source/.gitattributes" "$work/checkout"
  as() { git -C "$work/checkout" -c user.name=test -c user.email=test@localhost "$@"; }
  as init -q && as add . && as commit -qm first
  head=$(git -C "$work/checkout" rev-parse --short=12 HEAD)
  [ "$(found "$work/checkout")" = "$head" ] || fail "not the checkout's commit: $(found "$work/checkout")"
  mkdir "$work/archive"
  as archive HEAD | tar -x -C "$work/archive"
  [ "$(found "$work/archive")" = "$head" ] || fail "not the archive's commit: $(found "$work/archive")"
  echo more >"$work/checkout/cmake/more.txt"
  as add .
  [ "$(found "$work/checkout")" = "$head.changed" ] || fail "the change is not told: $(found "$work/checkout")"
fi
# A file that says the same is not written again, so that nothing is compiled.
found "$work/tarball" >"$work/first"
touch -d '2001-01-01' "$work/commit.cpp"
found "$work/tarball" >"$work/second"
[ -z "$(find "$work/commit.cpp" -newermt 2002-01-01)" ] || fail "written anew for nothing"

version=$("$program" --version)
echo "$version" | grep -Eq '^gnomon [0-9]+\.[0-9]+\.[0-9]+(\+[0-9a-f]{12}(\.changed)?)?$' || fail "version: $version"
if [ -e "$source/.git" ] && command -v git >/dev/null; then
  echo "$version" | grep -q '+' || fail "no commit in the version of a checkout: $version"
fi

#!/usr/bin/env bash
# Every own C++ file is as clang-format leaves it (.clang-format), every own TypeScript and JavaScript file as prettier does
# (.prettierrc.json). `--fix` formats in place instead of checking.
# Exit 77 (skipped) without clang-format 14, the version of Debian 12: other versions break lines elsewhere; or without prettier,
# which comes with the report page's npm packages. What is here checks nevertheless.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

# files_of ENDINGS...: the project's own files with these endings, one a line.
files_of() {
  local names=()
  for ending in "$@"; do names+=(-o -name "*.$ending"); done
  find . \( -name node_modules -o -name dist -o -name generated -o -path ./build -o -path ./out -o -path './.*' \) -prune -o \
    -type f \( "${names[@]:1}" \) -printf '%P\n' | sort
}

skipped=0 failed=0
skip() { echo "SKIPPED: $1"; skipped=1; }

# shellcheck disable=SC2086  # words
# format NAME FIX CHECK FILES...: FIX and CHECK are the formatter's words; a check names each wrong file on a line of its own.
format() {
  local name=$1 fix=$2 check=$3 said
  shift 3
  (($# >= 20)) || { echo "the sources for $name were not found"; exit 1; }
  if [[ $mode == --fix ]]; then
    $fix "$@" >/dev/null
    echo "formatted $# files with $name"
  # Some sixty files a process: starting one takes longer than reading a file.
  elif said=$(printf '%s\0' "$@" | xargs -0 -n 64 -P "$(nproc)" $check 2>&1); then
    echo "$# files are formatted by $name"
  else
    said=$(sed -nE 's/^([^:]+):[0-9]+:[0-9]+: error: code should be clang-formatted.*/\1/p; s/^\[warn\] ([^ ]+)$/\1/p; /^\[error\]/p' <<<"$said" | sort -u)
    printf 'not formatted:\n%s\n./gnomon format does it\n' "$said"
    failed=1
  fi
}

mode=${1-}
version=$(clang-format --version 2>/dev/null | grep -oE 'version [0-9]+' | grep -oE '[0-9]+' || true)
if [[ $version == 14 ]]; then
  mapfile -t files < <(files_of h cpp)
  format clang-format "clang-format -i" "clang-format --dry-run -Werror" "${files[@]}"
else
  skip "clang-format 14 is not here (found: ${version:-none})"
fi

prettier=report/page/node_modules/prettier/bin/prettier.cjs
if [[ -f $prettier ]] && command -v node >/dev/null; then
  mapfile -t files < <(files_of ts mts js mjs)
  format prettier "node $prettier --write --log-level warn" "node $prettier --check --log-level warn" "${files[@]}"
else
  skip "prettier is not here: npm install --no-save --prefix report/page"
fi

((failed == 0)) || exit 1
((skipped == 0)) || exit 77

#!/usr/bin/env bash
# Every own C++ file is as clang-format leaves it (.clang-format). `--fix` formats in place instead of checking.
# Exit 77 (skipped) without clang-format 14, the version of Debian 12: other versions break lines elsewhere.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."

version=$(clang-format --version 2>/dev/null | grep -oE 'version [0-9]+' | grep -oE '[0-9]+' || true)
if [[ $version != 14 ]]; then
  echo "SKIPPED: clang-format 14 is not here (found: ${version:-none})"
  exit 77
fi

mapfile -t files < <(find app compare hybrid raster raytrace scene shaders tests -name node_modules -prune -o \
  -type f \( -name '*.h' -o -name '*.cpp' \) -print | sort)
((${#files[@]} >= 20)) || { echo "the sources were not found"; exit 1; }

if [[ ${1-} == --fix ]]; then
  clang-format -i "${files[@]}"
  echo "formatted ${#files[@]} files"
else
  wrong=()
  for file in "${files[@]}"; do clang-format "$file" | cmp -s - "$file" || wrong+=("$file"); done
  if ((${#wrong[@]})); then
    printf 'not formatted: %s\n' "${wrong[@]}"
    echo "./gnomon format does it"
    exit 1
  fi
  echo "${#files[@]} files are formatted"
fi

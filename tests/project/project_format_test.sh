#!/usr/bin/env bash
# Every own C++ file is as clang-format leaves it (.clang-format). `--fix` formats in place instead of checking.
# Exit 77 (skipped) without clang-format 14, the version of Debian 12: other versions break lines elsewhere.
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

version=$(clang-format --version 2>/dev/null | grep -oE 'version [0-9]+' | grep -oE '[0-9]+' || true)
if [[ $version != 14 ]]; then
  echo "SKIPPED: clang-format 14 is not here (found: ${version:-none})"
  exit 77
fi

mapfile -t files < <(find app benchmark cmake compare hybrid raster raytrace report scene shaders studies tests verify -name node_modules -prune -o \
  -type f \( -name '*.h' -o -name '*.cpp' \) -print | sort)
((${#files[@]} >= 20)) || { echo "the sources were not found"; exit 1; }

if [[ ${1-} == --fix ]]; then
  clang-format -i "${files[@]}"
  echo "formatted ${#files[@]} files"
else
  # Some sixty files a process: starting one takes longer than reading a file.
  said=$(printf '%s\0' "${files[@]}" | xargs -0 -n 64 -P "$(nproc)" clang-format --dry-run -Werror 2>&1) || {
    wrong=$(sed -nE 's/^([^:]+):[0-9]+:[0-9]+: error: code should be clang-formatted.*/not formatted: \1/p' <<<"$said" | sort -u)
    printf '%s\n./gnomon format does it\n' "${wrong:-$said}"
    exit 1
  }
  echo "${#files[@]} files are formatted"
fi

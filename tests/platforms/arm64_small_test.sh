#!/usr/bin/env bash
# A part of the tracer, made by Debian's cross compiler for 64-bit ARM, finds under qemu the same hits as the native program, to the last
# bit. The whole program is compared by arm64.sh. Usage: arm64_small_test.sh NATIVE_SMALL_RAYS FOLDER. Exit code 77 where there is no
# cross compiler or no qemu (./gnomon install arm64).
set -euo pipefail

native=$(readlink -f -- "$1")
mkdir -p -- "$2"
folder=$(readlink -f -- "$2")
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."
compiler=aarch64-linux-gnu-g++
emulator=$(command -v qemu-aarch64-static || command -v qemu-aarch64) || emulator=
if [[ -z $emulator ]] || ! command -v "$compiler" >/dev/null; then
  echo "skipped: there is nothing here that compiles for arm64 and runs it: ./gnomon install arm64"
  exit 77
fi
cache=$(command -v ccache) || cache=

# Libraries of headers alone are the same for all processors; beside them the compiler has its own.
mkdir -p "$folder/headers"
for library in fmt glm hwy tl; do ln -sfn "/usr/include/$library" "$folder/headers/$library"; done
sources=(tests/platforms/small_rays{,_alone}.cpp platform/web/one_thread.cpp scene/world.cpp raytrace/huge_array.cpp
  raytrace/bvh/{boxes,bvh,clusters,instance,leaf_primitives,treelet,wide_instances,wide_on_demand,wide_pack,wide_traverse,wide_tree}.cpp)
# The flags that decide about numbers are gnomon_flags' own (cmake/GnomonTarget.cmake).
read -ra deciding < <(sed -n 's/^target_compile_options(gnomon_flags INTERFACE \(-f[^)]*\))$/\1/p' cmake/GnomonTarget.cmake)
flags=(-std=c++20 -O2 "${deciding[@]}" -Wno-psabi
  -DGLM_FORCE_EXPLICIT_CTOR -DGLM_FORCE_SILENT_WARNINGS -DTOOLCHAIN_MISS_SYS_AUXV_H -DFMT_HEADER_ONLY -I. -isystem "$folder/headers")
[[ " ${flags[*]} " == *" -ffp-contract=off "* ]] || { echo "gnomon_flags no longer says -ffp-contract=off"; exit 1; }
objects=()
for source in "${sources[@]}"; do objects+=("$folder/${source//\//_}.o"); done
paste -d '\n' <(printf '%s\n' "${sources[@]}") <(printf '%s\n' "${objects[@]}") |
  xargs -n 2 -P "$(nproc)" sh -c "$cache $compiler ${flags[*]} -c \"\$0\" -o \"\$1\""
"$compiler" "${objects[@]}" -o "$folder/small_rays" -static

"$native" >"$folder/native.txt"
"$emulator" "$folder/small_rays" >"$folder/arm64.txt"
hits=$(sed -n '$s/^hits \([0-9]*\) .*/\1/p' "$folder/native.txt")
((hits > 10000)) || { echo "only $hits rays hit anything"; exit 1; }
diff "$folder/native.txt" "$folder/arm64.txt" || { echo "on arm64 (>) rays do not find what they find here (<)"; exit 1; }
echo "arm64: $hits hits with the same bits"

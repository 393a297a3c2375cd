#!/usr/bin/env bash
# toolchain.sh FOLDER PACKAGES -- SOURCES: what ./gnomon web builds with, in FOLDER: Debian 13's emscripten with its clang, whose
# packages are unpacked into FOLDER/root and made to find each other there, and the sources of libraries in FOLDER/src. Needs
# no root and changes nothing outside FOLDER. apt-get fetches; what it cannot verify it refuses.
set -euo pipefail
folder=$1
shift
packages=() sources=()
while (($#)) && [[ $1 != -- ]]; do packages+=("$1"); shift; done
(($# == 0)) || shift
sources=("$@")

release=trixie
mkdir -p "$folder"/{packages,root,src}
folder=$(readlink -f -- "$folder")
rm -f "$folder/complete"
# shellcheck source=platform/own_apt.sh
source "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../own_apt.sh"
own_apt "$folder" "$release"

cd "$folder/packages"
apt-get -qq download "${packages[@]}"
for package in *.deb; do dpkg-deb -x "$package" "$folder/root"; done
rm -f -- *.deb

# Programs of another release of Debian: each is told where its own loader and libraries are.
root=$folder/root
for program in "$root"/usr/lib/llvm-19/bin/{clang,lld,llvm-ar,llvm-nm,llvm-objcopy} \
  "$root"/usr/bin/wasm-{opt,emscripten-finalize,metadce,ctor-eval,split} "$root/usr/bin/wasm2js"; do
  patchelf --set-interpreter "$root/usr/lib64/ld-linux-x86-64.so.2" --force-rpath \
    --set-rpath "$root/usr/lib/x86_64-linux-gnu:$root/usr/lib/llvm-19/lib" "$program"
done
cat >"$root/usr/share/emscripten/.emscripten" <<END
LLVM_ROOT = '$root/usr/lib/llvm-19/bin'
BINARYEN_ROOT = '$root/usr'
NODE_JS = '$(command -v node)'
FROZEN_CACHE = True
END

# Where node looks for what emscripten's scripts import.
ln -sfn nodejs "$root/usr/share/node_modules"

# Of a source package the original archive alone, whose name and SHA-256 apt's signed list has.
cd "$folder/src"
for source in "${sources[@]}"; do
  read -r address file _ sum < <(apt-get -qq source --print-uris --download-only "$source" | grep -F '.orig.tar.' | grep -v '\.asc' | tr -d "'" | head -n 1)
  [[ -n ${sum-} ]] || { echo "no source package $source in $release" >&2; exit 1; }
  /usr/lib/apt/apt-helper download-file "$address" "$file" "$sum" >/dev/null
  mkdir -p "$source"
  tar -xf "$file" -C "$source" --strip-components=1
  rm -f -- "$file"
done

#!/usr/bin/env bash
# Builds the program for 64-bit ARM with Debian's cross compiler, and holds what it computes under qemu to the native program of
# the same sources, to the last bit: pictures, channels and results of compare, raytrace and raster (tests/tools/same_results.py).
#
#   tests/platforms/arm64.sh [FOLDER [SCENE...]]      default: $HOME/.cache/gnomon/arm64, acne-floor sphere-plane shapes
#
# FOLDER keeps Debian's libraries for arm64 (1 GB), which are unpacked there without root; nothing else is changed. Needs the
# packages g++-aarch64-linux-gnu and qemu-user-static, a network, and a native build (./gnomon build).
set -euo pipefail

die() { printf 'arm64.sh: %s\n' "$*" >&2; exit 2; }

project=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd)
folder=${1:-$HOME/.cache/gnomon/arm64}
scenes=("${@:2}")
((${#scenes[@]})) || scenes=(acne-floor sphere-plane shapes)
command -v aarch64-linux-gnu-g++ >/dev/null || die "the cross compiler is not there (apt-get install g++-aarch64-linux-gnu)"
command -v qemu-aarch64-static >/dev/null || die "qemu is not there (apt-get install qemu-user-static)"
native=$project/build/release/app/gnomon
[[ -x $native ]] || die "there is no native program to compare with (./gnomon build)"

# The libraries of ./gnomon's own list, and the C and C++ libraries that come with a native compiler.
packages=(libc6-dev libstdc++-12-dev openimageio-tools libosmesa6)
while read -r package; do packages+=("$package"); done < <(
  sed -n '/^run_packages=(/,/^)/p' "$project/gnomon" | tr ' ' '\n' | grep -E '^(lib.*-dev|nettle-dev|nlohmann-json3-dev)$')

# shellcheck source=cmake/platform/own_apt.sh
source "$project/cmake/platform/own_apt.sh"
fetch_libraries() {
  local apt=$folder/apt root=$folder/root package link
  rm -rf "$root"
  mkdir -p "$root"/usr/{bin,lib,sbin}
  for link in bin lib sbin; do ln -sfn "usr/$link" "$root/$link"; done
  own_apt "$folder" bookworm arm64
  apt-get -qq -y --no-install-recommends --download-only install "${packages[@]}"
  for package in "$apt"/archives/*.deb; do
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$root" --keep-directory-symlink --no-same-owner
  done
  rm -f "$apt"/archives/*.deb
  # Names that begin at the root mean this one.
  find "$root" -type l -lname '/*' | while read -r link; do
    if [[ -e $root$(readlink "$link") ]]; then ln -sfn -r "$root$(readlink "$link")" "$link"; fi
  done
  sed -i "s|\"/usr/|\"$root/usr/|g" "$root"/usr/lib/aarch64-linux-gnu/cmake/draco/*.cmake
  printf '%s\n' "${packages[*]}" >"$folder/complete"
}

mkdir -p "$folder"
folder=$(readlink -f -- "$folder")
[[ -r $folder/complete && $(<"$folder/complete") == "${packages[*]}" ]] || fetch_libraries

export GNOMON_ARM64_ROOT=$folder/root
cmake -S "$project" --preset arm64 -DGNOMON_TESTS=OFF >"$folder/configure.log" 2>&1 || { cat "$folder/configure.log" >&2; exit 1; }
ninja -C "$project/build/arm64" app/gnomon scene/libgnomon_images.so
cat >"$folder/gnomon" <<END
#!/bin/sh
exec qemu-aarch64-static -L "$GNOMON_ARM64_ROOT" "$project/build/arm64/app/gnomon" "\$@"
END
chmod +x "$folder/gnomon"
"$project/tests/tools/same_results.py" "$native" "$folder/gnomon" "${scenes[@]}" --size 96x54 --leave-out renderer

#!/usr/bin/env bash
# Builds the program and those of its tests that are over in seconds for 64-bit ARM with Debian's cross compiler, and holds what the
# program computes under qemu to the native program of the same sources, to the last bit: pictures, channels and results of compare,
# raytrace and raster (tests/tools/same_results.py), and grades. Then the tests run under qemu. Last it asks Debian whether every package
# of the Dockerfile is there for arm64.
#
#   tests/platforms/arm64.sh [FOLDER [SCENE...]]      default: $HOME/.cache/gnomon/arm64, acne-floor sphere-plane shapes
#
# FOLDER keeps Debian's libraries for arm64 (1 GB), which are unpacked there without root; nothing else is changed. Needs
# ./gnomon install arm64, a network, and a native build (./gnomon build).
set -euo pipefail

die() { printf 'arm64.sh: %s\n' "$*" >&2; exit 2; }

project=$(cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.." && pwd)
folder=${1:-$HOME/.cache/gnomon/arm64}
scenes=("${@:2}")
((${#scenes[@]})) || scenes=(acne-floor sphere-plane shapes)
command -v aarch64-linux-gnu-g++ >/dev/null || die "the cross compiler is not there (./gnomon install arm64)"
command -v qemu-aarch64-static >/dev/null || die "qemu is not there (./gnomon install arm64)"
native=$project/build/release/app/gnomon
[[ -x $native ]] || die "there is no native program to compare with (./gnomon build)"

# Natively 41 s; here 40 minutes one by one, beside other work. Not among them: those of minutes natively (grade, judge, sweep, the
# closed forms, the wide tree); the effects', which is not over in ten minutes; those that draw for more than two seconds, for which Mesa
# takes a hundred times as long here; those of windows and browsers; those that start Debian's tools; and core_run_program_test (to qemu
# a vfork() is a fork(), so that posix_spawn() does not say that there is no such program). Of those below one check is left out: at
# which address freed memory comes again is qemu's to say.
not_checked=HugeArrays.PagesAreUsedAgain
tests=(compare_lists_test exact_gmp_test gltf_instances_gl_test orthographic_gl_test raytrace_cells_test raytrace_packet_test
  raytrace_solids_test raytrace_test scene_files_test scene_gltf_writer_test)

# The libraries of ./gnomon's own list, those of the tests, and the C and C++ libraries that come with a native compiler.
run_packages=()
while read -r package; do run_packages+=("$package"); done < <(
  sed -n '/^run_packages=(/,/^)/p' "$project/gnomon" | tr ' ' '\n' | grep -vE '^(run_packages=\(|\)|)$')
packages=(libc6-dev libembree-dev libgtest-dev librapidcheck-dev libstdc++-12-dev openimageio-tools libosmesa6)
while read -r package; do packages+=("$package"); done < <(
  printf '%s\n' "${run_packages[@]}" | grep -E '^(lib.*-dev|nettle-dev|nlohmann-json3-dev)$')

# shellcheck source=platform/own_apt.sh
source "$project/platform/own_apt.sh"
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
  # What Debian's alternatives choose when a package is set up.
  for link in blas lapack; do ln -sf "$link/lib$link.so.3" "$root/usr/lib/aarch64-linux-gnu/"; done
  printf '%s\n' "${packages[*]}" >"$folder/complete"
}

mkdir -p "$folder"
folder=$(readlink -f -- "$folder")
[[ -r $folder/complete && $(<"$folder/complete") == "${packages[*]}" ]] || fetch_libraries

export GNOMON_ARM64_ROOT=$folder/root
qemu=$(command -v qemu-aarch64-static)
# Without binfmt_misc nothing starts a child for another processor but this.
export GNOMON_ARM64_PRELOAD=$folder/children.so
aarch64-linux-gnu-g++ -std=c++20 -O1 -Wall -Wextra -Werror -shared -fPIC "-DEMULATOR=\"$qemu\"" "-DROOT=\"$GNOMON_ARM64_ROOT\"" \
  "$project/tests/platforms/arm64_children.cpp" -o "$GNOMON_ARM64_PRELOAD"
cmake -S "$project" --preset arm64 -DGNOMON_TESTS=ON >"$folder/configure.log" 2>&1 || { cat "$folder/configure.log" >&2; exit 1; }
ninja -C "$project/build/arm64" app/gnomon scene/libgnomon_images.so "${tests[@]}"
cat >"$folder/gnomon" <<END
#!/bin/sh
exec "$qemu" -E LD_PRELOAD="$GNOMON_ARM64_PRELOAD" -L "$GNOMON_ARM64_ROOT" "$project/build/arm64/app/gnomon" "\$@"
END
chmod +x "$folder/gnomon"
"$project/tests/tools/same_results.py" "$native" "$folder/gnomon" "${scenes[@]}" --size 96x54 --leave-out renderer

# Each drawing of a grade is made by a child.
grades() { "$1" grade rays-and-light --quiet --json - | grep -v '"command"'; }
diff <(grades "$native") <(grades "$folder/gnomon")
echo "grade rays-and-light: the same"

GTEST_FILTER=-$not_checked ctest --test-dir "$project/build/arm64" -R "^($(IFS='|'; echo "${tests[*]}"))\$" --output-on-failure --no-tests=error --parallel "$(nproc)"

# What the Dockerfile installs, beside what the package itself depends on, whose -dev packages are among these.
own_apt "$folder" bookworm arm64
container=$(sed -n 's/.*apt-get install -y --no-install-recommends \([a-z].*\)$/\1/p' "$project/Dockerfile")
depends=$(sed -n 's/^set(CPACK_DEBIAN_PACKAGE_DEPENDS "\(.*\)")$/\1/p' "$project/cmake/GnomonPackage.cmake" | sed 's/ | [^,]*//g; s/,//g')
# shellcheck disable=SC2086  # words
apt-get -qq --simulate --no-install-recommends install $container $depends "${run_packages[@]}" >"$folder/container.log"
echo "Dockerfile: $(grep -c ^Inst "$folder/container.log") packages for arm64"

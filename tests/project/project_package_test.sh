#!/bin/sh
# The Debian package: what must be in it is, its libraries are found, and the program in it runs.
# project_package_test.sh BUILD_FOLDER WORK_FOLDER
set -eu
build=$1 work=$2
command -v dpkg-shlibdeps >/dev/null || { echo "skipped: dpkg-dev is not installed"; exit 77; }
rm -rf "$work"
mkdir -p "$work"
cpack --config "$build/CPackConfig.cmake" -B "$work" >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
package=$(ls "$work"/gnomon_*.deb)
dpkg-deb --contents "$package" >"$work/contents"
for file in usr/bin/gnomon usr/lib/gnomon/libgnomon_images.so usr/share/man/man1/gnomon.1 usr/share/bash-completion/completions/gnomon \
  usr/share/zsh/site-functions/_gnomon usr/share/fish/vendor_completions.d/gnomon.fish \
  usr/share/doc/gnomon/CITATION.cff usr/share/doc/gnomon/docs/manual/options.md usr/share/doc/gnomon/docs/manual/json.md \
  usr/share/doc/gnomon/docs/manual/techniques.md usr/share/doc/gnomon/docs/manual/shaders.md \
  usr/share/doc/gnomon/docs/lessons/acne.md usr/share/doc/gnomon/docs/images/lesson-acne.png \
  usr/share/doc/gnomon/examples/shaders/technique/hard.glsl usr/share/gnomon/schema/result.schema.json; do
  grep -q " \./$file\$" "$work/contents" || { echo "not in the package: $file"; cat "$work/contents"; exit 1; }
done
depends=$(dpkg-deb --field "$package" Depends)
for library in libosmesa6 libgl1-mesa-dri libopenimageio libtbb; do
  case $depends in *"$library"*) ;; *) echo "not a dependency: $library (in: $depends)"; exit 1 ;; esac
done
dpkg-deb --extract "$package" "$work/root"
"$work/root/usr/bin/gnomon" --version
# EXR goes through a module that the program finds beside itself.
"$work/root/usr/bin/gnomon" raytrace sphere-plane --size 32x18 --quiet -o "$work/picture.exr"

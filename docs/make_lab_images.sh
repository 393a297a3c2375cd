#!/bin/sh
# Makes the pictures of docs/lab.md with the program itself: docs/make_lab_images.sh PROGRAM
# PROGRAM: the gnomon to run [default build/release/app/gnomon]. Needs Xvfb, and oiiotool to make them smaller.
set -eu
program=$(readlink -f "${1:-build/release/app/gnomon}")
images=$(cd "$(dirname "$0")" && pwd)/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat > "$work/script.txt" <<'SCRIPT'
set size 1280x720
set map-size 512
show acne
set layout swipe
set swipe 0.45
set view labels
wait done
click 747 578
wait done
screenshot lab.png
set theme light
set layout quad
set map-size 128
set bias 0.25texel
set slope-bias 1
set pane 3 texels
set pane 4 gap
wait done
screenshot lab-four.png
SCRIPT
(cd "$work" && xvfb-run -a -s "-screen 0 1280x1024x24" "$program" view floating-box --script script.txt --quiet)
for name in lab lab-four; do
  oiiotool --nosoftwareattrib "$work/$name.png" --resize 800x450 --attrib png:compressionLevel 9 -o "$images/$name.png"
done

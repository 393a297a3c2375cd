#!/bin/sh
# Makes the pictures of docs/ (docs/images/) with the program itself: docs/make_images.sh PROGRAM
# PROGRAM: the gnomon to run [default build/release/app/gnomon]. Needs oiiotool to put pictures side by side.
set -eu
program=${1:-build/release/app/gnomon}
images=$(cd "$(dirname "$0")" && pwd)/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# picture NAME FILE SCENE OPTIONS…: one picture of a comparison
picture() {
  name=$1 file=$2
  shift 2
  "$program" compare "$@" --size 480x270 --runs 1 --quiet -o "$work/$name"
  cp "$work/$name/$file.png" "$images/lesson-$name.png"
}

# pair NAME FILE_A FILE_B SCENE OPTIONS…: two pictures of one comparison side by side
pair() {
  name=$1 left=$2 right=$3
  shift 3
  "$program" compare "$@" --size 320x180 --runs 1 --quiet -o "$work/$name"
  oiiotool --nosoftwareattrib "$work/$name/$left.png" "$work/$name/$right.png" --mosaic:pad=8 2x1 -o "$images/lesson-$name.png"
}

# The two of the first page.
"$program" compare fence --size 960x540 --runs 1 --quiet -o "$work/fence"
for picture in raster difference; do
  oiiotool --nosoftwareattrib "$work/fence/$picture.png" -o "$images/fence-$picture.png"
done

pair acne raster difference acne-floor --bias 0 --map-size 64
pair peter-panning raster difference floating-box --bias 0.6
pair light-leaks raster difference thin-wall --bias 0.02 --normal-offset 8
pair aliasing raster difference wires --map-size 128
pair soft-shadows raster raytrace penumbra --slope-bias 1
pair filtering difference error fence --technique pcf --filter-radius 2 --map-size 512 --slope-bias 2
pair precision raster difference acne-floor --depth-format d16 --slope-bias 1 --bias 0 --map-size 4096
picture hybrid decisions courtyard --technique hybrid
pair error-budget raytrace labels courtyard --map-size 512

# A film: an animated PNG.
"$program" shimmer fence --path walk --frames 16 --fps 10 --map-size 256 --size 320x180 --quiet -o "$work/shimmer"
cp "$work/shimmer/film-0-drawn.png" "$images/lesson-shimmer.png"

# One map and four cascades of one scene.
for technique in hard csm; do
  "$program" compare fence --map-size 256 --technique $technique --size 320x180 --runs 1 --quiet -o "$work/map-$technique"
done
oiiotool --nosoftwareattrib "$work/map-hard/difference.png" "$work/map-csm/difference.png" --mosaic:pad=8 2x1 -o "$images/lesson-cascades.png"

# Two biases of one scene.
for bias in 0.25texel 4texel; do
  "$program" compare courtyard --bias $bias --size 320x180 --runs 1 --quiet -o "$work/bias-$bias"
done
oiiotool --nosoftwareattrib "$work/bias-0.25texel/difference.png" "$work/bias-4texel/difference.png" --mosaic:pad=8 2x1 -o "$images/lesson-bias.png"

# What two structures test for each pixel, in a scene that each of them suits.
heat() {
  "$program" raytrace "$1" --accel "$2" --heatmap "$3" --size 480x270 --quiet -o "$work/$1-$2.png"
}
for structure in grid kdtree; do
  heat stadium $structure triangles
  heat field $structure nodes
done
oiiotool --nosoftwareattrib "$work/stadium-grid.png" "$work/stadium-kdtree.png" "$work/field-grid.png" "$work/field-kdtree.png" \
  --mosaic:pad=8 2x2 -o "$images/structures.png"

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

# rendered NAME OPTIONS…: one ray-traced picture
rendered() {
  name=$1
  shift
  "$program" raytrace "$@" --quiet -o "$work/$name.png"
}

# beside NAME COLUMNSxROWS PICTURE…: pictures of the same size in one
beside() {
  name=$1 grid=$2
  shift 2
  oiiotool --nosoftwareattrib "$@" --mosaic:pad=8 "$grid" -o "$images/lesson-$name.png"
}

# The two of the first page.
"$program" compare fence --size 960x540 --runs 1 --quiet -o "$work/fence"
for picture in raster difference; do
  oiiotool --nosoftwareattrib "$work/fence/$picture.png" -o "$images/fence-$picture.png"
done

# What a filter does: the same part of a picture without and with it, and by rays, enlarged.
for technique in hard pcf; do
  "$program" compare fence --technique $technique --size 640x360 --runs 1 --quiet -o "$work/measures-$technique"
done
part="--cut 104x78+180+232 --resize:filter=box 312x234"
oiiotool --nosoftwareattrib "$work/measures-hard/raster.png" $part "$work/measures-pcf/raster.png" $part \
  "$work/measures-pcf/raytrace.png" $part --mosaic:pad=8 3x1 -o "$images/measures.png"

# with_map NAME WIDTH SCENE OPTIONS…: what the light stores, WIDTH pixels wide, beside what the eye sees
with_map() {
  name=$1 width=$2
  shift 2
  "$program" compare "$@" --size 480x270 --runs 1 --quiet -o "$work/$name"
  oiiotool "$work/$name/depth-map.png" --resize "${width}x270" -o "$work/$name/small.png"
  oiiotool --nosoftwareattrib --create "$((width + 488))x270" 3 "$work/$name/small.png" --swap --paste +0+0 \
    "$work/$name/raster.png" --swap --paste "+$((width + 8))+0" -o "$images/lesson-$name.png"
}
with_map shadow-map 270 teapot --map-size 512
with_map cube-maps 405 sphere-plane --map-size 256

# Maps of several sizes.
for size in 128 1024; do
  "$program" compare teapot --map-size $size --size 320x180 --runs 1 --quiet -o "$work/size-$size"
done
beside map-sizes 2x1 "$work/size-128/difference.png" "$work/size-1024/difference.png"
for size in 256 1024 4096; do
  "$program" compare fence --map-size $size --size 320x180 --runs 1 --quiet -o "$work/cost-$size"
done
beside cost 3x1 "$work/cost-256/difference.png" "$work/cost-1024/difference.png" "$work/cost-4096/difference.png"

# Rays.
rendered ray-tracing whitted --size 640x360 --aa 16
oiiotool --nosoftwareattrib "$work/ray-tracing.png" -o "$images/lesson-ray-tracing.png"
rendered intersections shapes --size 640x360 --aa 16
oiiotool --nosoftwareattrib "$work/intersections.png" -o "$images/lesson-intersections.png"
rendered smooth sphere-plane --size 320x180 --camera-distance 5.2
rendered facets sphere-plane --size 320x180 --camera-distance 5.2 --tessellate 12
beside terminator 2x1 "$work/smooth.png" "$work/facets.png"
rendered naive far-away --size 320x180 --camera-distance 5.2 --precision fast
rendered robust far-away --size 320x180 --camera-distance 5.2
beside robustness 2x1 "$work/naive.png" "$work/robust.png"
for structure in octree kdtree bsp bvh; do
  rendered "$structure" stadium --accel $structure --heatmap nodes --size 320x180
  oiiotool --nosoftwareattrib "$work/$structure.png" -o "$images/lesson-$structure.png"
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

# One ray a pixel, as it is and denoised.
for denoiser in none penumbra; do
  "$program" compare penumbra --technique rays --denoiser $denoiser --size 320x180 --runs 1 --quiet -o "$work/rays-$denoiser"
done
beside one-ray 2x1 "$work/rays-none/raster.png" "$work/rays-penumbra/raster.png"

# What no map can draw.
"$program" raster studio --size 320x180 --quiet -o "$work/studio-map.png"
rendered studio-rays studio --size 320x180 --aa 4 --samples 16 --indirect-samples 8
beside glossy 2x1 "$work/studio-map.png" "$work/studio-rays.png"
rendered direct courtyard --size 320x180
rendered gathered courtyard --size 320x180 --indirect-samples 64
beside indirect 2x1 "$work/direct.png" "$work/gathered.png"

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

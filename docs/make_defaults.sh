#!/bin/sh
# Makes the table of docs/defaults.md with the program itself: docs/make_defaults.sh PROGRAM [DATA] > TABLE
# PROGRAM: the gnomon to run; DATA: the folder of models [default ../shared/data beside the checkout]. A model that is
# not there has a row that says so.
set -eu
program=${1:-build/release/app/gnomon}
data=${2:-$(cd "$(dirname "$0")/.." && pwd)/../shared/data}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# wrong SCENE OPTIONS…: the share of wrong pixels of all lights, percent
wrong() {
  "$program" compare "$@" --size 640x360 --runs 1 --threads 0 --quiet --json "$work/result.json" -o "$work/out" 2> /dev/null || {
    echo failed
    return
  }
  awk '{ if (match($0, /"wrong": [0-9]+/)) wrong += substr($0, RSTART + 9, RLENGTH - 9)
         if (match($0, /"compared": [0-9]+/)) compared += substr($0, RSTART + 12, RLENGTH - 12) }
       END { printf "%.3f\n", (compared > 0) ? 100 * wrong / compared : 0 }' "$work/result.json"
}

row() {
  printf '| %s | %s | %s | %s |\n' "$1" "$(wrong "$2" --bias 1texel)" "$(wrong "$2" --slope-bias 1 --bias auto)" \
    "$(wrong "$2" --adaptive-bias)"
}

echo '| scene | `--bias 1texel`, % wrong | the default, % wrong | `--adaptive-bias`, % wrong |'
echo '|---|--:|--:|--:|'
for scene in acne-floor courtyard fence field floating-box orchard penumbra shapes sphere-plane stadium studio teapot thin-wall whitted wires; do
  row $scene $scene
done
models() {
  cat << 'END'
stanford_dragon/dragon_vrip_res2.ply
stanford_dragon/dragon_vrip_res4.ply
libigl_armadillo/armadillo.obj
3dc_wickerchair/glTF-Binary/WickerChair.glb
3dc_mixer/glTF-Binary/Mixer.glb
3dc_tennisracquet/glTF/TennisRacquet.gltf
common_organic/stanford-bunny.obj
common_organic/spot.obj
common_organic/teapot.obj
common_organic/suzanne.obj
alpha_blend_mode_test/AlphaBlendModeTest.glb
playcanvas_house/house.glb
vsa_building/subpass_scene_opaque.gltf
vsa_zfight_terrain/terrain/terrain.gltf
vsa_zfight_terrain/torusknot.gltf
transmission_roughness_test/TransmissionRoughnessTest.glb
sunglasses_khronos/SunglassesKhronos.glb
kaykit_dungeon/gltf/stairs_wood_decorated.gltf.glb
kaykit_dungeon/gltf/wall_gated.gltf.glb
lowpoly_tree/low-poly-tree.glb
attenuation_test/AttenuationTest.glb
glass_table/glass-table.glb
nvpro_cornellbox/cornellBox.gltf
bevy_palmtree/PalmTree.gltf
no_index_building/no_indices_3storybuilding.glb
END
}
models | while read -r model; do
  if [ -f "$data/$model" ]; then row "$(basename "$model")" "$data/$model"; else echo "| $(basename "$model") | not there | not there | not there |"; fi
done

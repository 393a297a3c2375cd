# The built-in scenes and the generators of their geometry.
target_sources(gnomon_scene PRIVATE
  builtin/builtin.cpp
  generate/architecture.cpp generate/basic.cpp generate/fence.cpp generate/garden.cpp generate/mesh_builder.cpp
  generate/noise.cpp generate/plants.cpp generate/registry.cpp generate/stonework.cpp generate/swarm.cpp generate/teapot.cpp generate/teapot_patches.cpp
  generate/textures.cpp)
gnomon_embed(gnomon_scene builtin_scenes
  builtin/acne-floor.json builtin/courtyard.json builtin/far-away.json builtin/fence.json builtin/field.json builtin/floating-box.json builtin/forest.json builtin/orchard.json builtin/penumbra.json builtin/shapes.json builtin/sphere-plane.json
  builtin/stadium.json builtin/studio.json builtin/teapot.json builtin/thin-wall.json builtin/whitted.json
  builtin/wires.json)

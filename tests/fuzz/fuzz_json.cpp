// The project's own scene files.
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gnomon::fuzz::load_as(".json", data, size);
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      R"({
  // comments are allowed
  "schema": "gnomon/scene/1", "name": "all", "description": "One of each.",
  "camera": { "eye": [0, 1, 5], "target": [0, 0.5, 0], "up": [0, 1, 0], "vertical_fov_degrees": 40 },
  "lights": [
    { "name": "sun", "type": "directional", "direction": [0.3, -1, 0.2], "intensity": [1, 1, 1],
      "angular_diameter_degrees": 0.53 },
    { "name": "lamp", "type": "point", "position": [0, 4, 0], "intensity": [19, 17.5, 15],
      "disc": { "radius": 0.4, "normal": [0, -1, 0] }, "shadow_samples": 16 },
    { "name": "spot", "type": "spot", "position": [1, 3, 1], "direction": [0, -1, 0], "intensity": [9, 9, 9],
      "inner_angle_degrees": 10, "outer_angle_degrees": 30 }],
  "materials": [
    { "name": "grey", "diffuse": [0.6, 0.6, 0.6], "specular": 0.25, "shininess": 60 },
    { "name": "glass", "diffuse": [0, 0, 0], "transmission": 0.9, "ior": 1.5, "absorption": [0.1, 0, 0.2] }],
  "meshes": [
    { "name": "box", "generate": { "kind": "box" } },
    { "name": "own", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] }],
  "instances": [
    { "name": "one", "mesh": "box", "material": "grey", "translate": [0, 1, 0], "scale": [1, 2, 1] },
    { "name": "two", "mesh": "own", "material": "glass" }],
  "shapes": [
    { "name": "plane", "plane": { "point": [0, 0, 0], "normal": [0, 1, 0] }, "material": "grey" },
    { "name": "ball", "sphere": { "center": [0, 1, 0], "radius": 0.5 }, "material": "glass" }],
  "ambient": [0.08, 0.10, 0.13], "background": [0.05, 0.07, 0.11], "exposure": 1, "max_depth": 4
})",
      R"({"schema":"gnomon/scene/1","materials":[{"name":"a"}],"shapes":[{"sphere":{"center":[0,0,0],"radius":1},"material":"a"}]})"};
}

// The list of built-in scenes. A test holds each description to the one in the scene's own file.

#include <embedded/builtin_scenes.h>
#include <array>
#include <string>

#include "scene/load.h"

namespace gnomon {
namespace {

// In the order in which a newcomer should see them.
constexpr std::array<BuiltinScene, 17> scenes{{
    {"fence", "A picket fence, a low sun and a garden path: long shadows of thin things."},
    {"acne-floor",
     "A large floor under a slanting sun and nothing that could cast a shadow on it: every shadow is false."},
    {"floating-box",
     "Boxes that stand on a floor and boxes that float just above it: bias detaches their shadows."},
    {"thin-wall", "A wall thinner than the bias that cures acne: its shadow starts too far away."},
    {"wires", "Straight edges and wires thinner than a texel, along the map's rows and slanted."},
    {"sphere-plane",
     "One exact sphere over an exact plane under a point light: the truth has a closed form."},
    {"far-away", "The scene sphere-plane a hundred thousand units from the origin: where floats break."},
    {"shapes",
     "Quadrics, a torus and implicit surfaces, all exact: what is wrong in a shadow is the shadow map's "
     "alone."},
    {"penumbra", "A disc light over a disc over a floor: umbra and penumbra have closed forms."},
    {"whitted", "Glass and mirror spheres over a checkered floor, after Whitted's picture of 1980."},
    {"studio", "A drink with ice, brushed metal and frosted glass under a large soft light."},
    {"teapot", "Newell's teapot on a table."},
    {"courtyard",
     "A court with arcades, stairs, balustrades and a fountain: tens of thousands of triangles in the sun."},
    {"stadium", "A teapot in a stadium: where uniform grids lose."},
    {"field", "An even field of small things: where a uniform grid is at its best."},
    {"orchard", "One tree planted over two hundred times: what a two-level structure saves."},
    {"forest",
     "Two thousand trees of ten thousand triangles along a sunny ride: twenty million, of which forty "
     "thousand are "
     "stored.",
     true},
}};

}  // namespace

std::vector<BuiltinScene> builtin_scenes() {
  return {scenes.begin(), scenes.end()};
}

std::optional<BuiltinFile> find_builtin_scene(std::string_view name) {
  for (const BuiltinScene& s : scenes) {
    if (s.name == name) return BuiltinFile{s.name, embedded::builtin_scenes(std::string(name) + ".json")};
  }
  return std::nullopt;
}

}  // namespace gnomon

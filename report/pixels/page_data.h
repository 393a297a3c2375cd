// What the page's scripts read beside result.json: words, and per light the pixels' numbers, the map and the
// geometry that the probe draws. JSON texts; arrays as in packing.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "report/page.h"
#include "report/pixels/channels.h"
#include "report/pixels/surface_prediction.h"
#include "scene/world.h"

namespace gnomon::report {

/// The large parts apart, so that they may stand in files of their own: "pixels" (what both renderers see and
/// their linear pictures), "geometry", and "light-0", "light-1", …
struct PageData {
  std::string head;
  std::vector<DataPart> parts;
};
PageData page_data(const PageInput& input);

// What the page's script reads of one light: its map, and of every pixel the ladder, the lookup and the
// metrics.

constexpr double position_steps = 256.0, visibility_steps = 25200.0;

/// `surfaces` must last until the packer has run.
nlohmann::ordered_json light_data(const PageInput& input, std::size_t index, Packer& packer,
                                  const PixelSurfaces& surfaces);

// What the page cuts to draw its cross-section: the scene's triangles and, as finely tessellated meshes, the
// solids whose cut is no circle or line. Spheres and planes the page cuts itself, exactly.

struct SectionMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Is the number of sectors of quadrics and tori (scene/shapes/tessellate.h), twice the number of cells across an
  /// implicit surface; 0: there are none.
  int solid_sectors = 0;
  bool complete = true;  ///< false: triangles or solids are too many for a page and left out
};

/// `most_triangles`: of the scene's own, and again of the solids', who get fewer sectors before they go.
SectionMesh section_mesh(const World& world, std::size_t most_triangles = 200000);

}  // namespace gnomon::report

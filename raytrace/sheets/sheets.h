// Texels of a map, and which triangles share an edge. A *sheet* is a connected piece of equally facing triangles inside
// the column of light rays of one texel. Two triangles join where their shared edge (vertices welded by position) crosses
// the column (sheets/column_sheets.h). A shape is a sheet of its own per side. A sheet that ends nowhere inside the column
// covers it exactly once, so it cannot shadow itself. Its projection along the rays is a proper local homeomorphism of a
// connected surface onto a disc. Hence it is a covering of degree one (hybrid/texel_bounds.h). A sheet ends in one of
// these places:
// - at an edge crossing the column that is not shared by exactly two equally facing triangles
// - at an edge-on or degenerate triangle
// - at an alpha-masked one
// - at a vertex whose projected fan winds more than once
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/huge_array.h"
#include "raytrace/tracer.h"
#include "scene/light_map/light_view.h"
#include "scene/light_map/texel_key.h"

namespace gnomon::raytrace {

using gnomon::TexelKey;

/// Triangle adjacency with vertices welded by exact position; built once per world, whose meshes must outlive it.
class Topology {
 public:
  explicit Topology(const World& world);
  static constexpr std::uint32_t boundary = 0xffffffffu;  ///< an edge with one triangle
  static constexpr std::uint32_t non_manifold =
      0xfffffffeu;  ///< an edge with three or more, or inconsistent winding
  /// The triangle across edge k (corners k and k+1) of a triangle, or boundary, or non_manifold.
  std::uint32_t across(std::uint32_t triangle, int edge) const {
    const Part& part = parts_[triangles_.of(triangle)];
    const std::size_t at = 3 * std::size_t{triangle - part.first_triangle} + static_cast<std::size_t>(edge);
    const std::uint32_t across = across_[part.at.across + at];
    return across >= non_manifold ? across : across + part.add_triangle;
  }
  /// The lowest vertex where a triangle's corner is.
  std::uint32_t welded(std::uint32_t triangle, int corner) const {
    const Part& part = parts_[triangles_.of(triangle)];
    const int stored = part.turned && corner > 0 ? 3 - corner : corner;
    const auto& vertices = part.triangles[triangle - part.first_triangle];
    return welded_[part.at.welded + vertices[static_cast<std::size_t>(stored)]] + part.add_vertex;
  }
  /// The triangle of which this one is an instance: in the first of the parts that share their mesh's numbers; itself
  /// where its part shares none.
  std::uint32_t shared(std::uint32_t triangle) const {
    const Part& part = parts_[triangles_.of(triangle)];
    return triangle - part.first_triangle + part.shared_triangle;
  }

 private:
  /// Where a part's numbers begin.
  struct Place {
    std::size_t across = 0, welded = 0;
  };
  /// Describes an instance in the world. What instances share is numbered as their mesh is.
  struct Part {
    const std::array<std::uint32_t, 3>* triangles = nullptr;
    Place at;
    std::uint32_t first_triangle = 0, add_triangle = 0, add_vertex = 0;
    std::uint32_t shared_triangle = 0;  ///< the first one of the first part with the same numbers
    bool turned = false;
  };
  /// Appends the numbers of these parts, one after the other.
  Place connect(const std::vector<const WorldPart*>& parts);
  /// Places the parts that share their mesh's numbers; returns 1 for those that do not.
  std::vector<char> share_meshes(const World& world);

  Ranges triangles_;  ///< of the parts
  std::vector<Part> parts_;
  HugeVector<std::uint32_t> across_, welded_;  ///< three for each triangle; one for each vertex
};

}  // namespace gnomon::raytrace

#include "report/pixels/page_data.h"

#include "scene/shapes/tessellate.h"

namespace gnomon::report {

namespace {

// At 128 sectors a chord strays from its circle by 0.03 % of the radius. Implicit surfaces get half as many
// cells across their box.
constexpr std::array sector_choices{128, 64, 32, 16, 8};

bool is_curved_solid(const Shape& shape) {
  return !std::holds_alternative<Sphere>(shape.geometry) && !std::holds_alternative<Plane>(shape.geometry);
}

void append(SectionMesh& to, const Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(to.positions.size());
  to.positions.insert(to.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const auto& [a, b, c] : mesh.triangles) to.triangles.push_back({first + a, first + b, first + c});
}

/// False, and nothing in `mesh`, when there are too many triangles.
bool tessellate_solids(const World& world, int sectors, std::size_t most_triangles, SectionMesh& mesh) {
  for (const Shape& shape : world.shapes) {
    if (!is_curved_solid(shape)) continue;
    const bool is_implicit = std::holds_alternative<Implicit>(shape.geometry);
    append(mesh, tessellated(shape, is_implicit ? sectors / 2 : sectors));
    if (mesh.triangles.size() > most_triangles) {
      mesh = {};
      return false;
    }
  }
  return true;
}

SectionMesh solids_mesh(const World& world, std::size_t most_triangles) {
  SectionMesh mesh;
  if (std::none_of(world.shapes.begin(), world.shapes.end(), is_curved_solid)) return mesh;
  for (const int sectors : sector_choices) {
    if (!tessellate_solids(world, sectors, most_triangles, mesh)) continue;
    mesh.solid_sectors = sectors;
    return mesh;
  }
  mesh.complete = false;
  return mesh;
}

}  // namespace

SectionMesh section_mesh(const World& world, std::size_t most_triangles) {
  SectionMesh mesh = solids_mesh(world, most_triangles);
  if (world.triangle_count() > most_triangles) {
    mesh.complete = false;
    return mesh;
  }
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::vector<Vec3> positions = positions_of(world);
  mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
  for (const auto& triangle : triangles_of(world))
    mesh.triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
  return mesh;
}

}  // namespace gnomon::report

// A swarm: small octahedra, one in each cell of a lattice, each somewhere near its cell's middle. Even by
// construction, and none touches another.
#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

void add_octahedron(MeshBuilder& builder, const Vec3& center, double radius) {
  const std::array<Vec3, 4> around{Vec3(radius, 0, 0), Vec3(0, 0, -radius), Vec3(-radius, 0, 0),
                                   Vec3(0, 0, radius)};
  const Vec3 up(0, radius, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = center + around[i], b = center + around[(i + 1) % 4];
    builder.polygon(std::array<Vec3, 3>{a, b, center + up});
    builder.polygon(std::array<Vec3, 3>{b, a, center - up});
  }
}

Expected<GeneratedModel> make_swarm(const Values& values) {
  const Vec3 count = values.vec3("count");
  const double spacing = values.number("spacing"), radius = values.number("radius");
  if (2.0 * radius >= spacing) return fail_parameter("radius", "must be less than half of the spacing");
  const double reach = values.number("jitter") * (0.5 * spacing - radius);  // stays inside its own cell
  Random random(values.seed());
  MeshBuilder builder;
  for (int y = 0; y < static_cast<int>(count.y); ++y)
    for (int z = 0; z < static_cast<int>(count.z); ++z)
      for (int x = 0; x < static_cast<int>(count.x); ++x) {
        const Vec3 middle = spacing * (Vec3(x, y, z) + Vec3(0.5) - 0.5 * Vec3(count.x, 0.0, count.z));
        Vec3 shift;
        for (int axis = 2; axis >= 0; --axis) shift[axis] = random.between(-reach, reach);
        add_octahedron(builder, middle + shift, radius);
      }
  GeneratedModel model;
  model.parts.push_back({"swarm", builder.take()});
  return model;
}

const std::array<std::string_view, 1> swarm_parts{"swarm"};
const std::array<ParameterInfo, 5> swarm_parameters{{
    {"count", "", std::vector<double>{10.0, 10.0, 10.0}, 1.0, 40.0, "octahedra along x, y and z", true},
    length_parameter("spacing", 1.0, 1e-3, 1e3, "between neighbouring cells' middles"),
    length_parameter("radius", 0.2, 1e-4, 500.0, "of an octahedron; less than half of the spacing"),
    {"jitter", "", 0.5, 0.0, 0.95,
     "how far an octahedron may stray from its cell's middle; at 1 it would touch the cell's side"},
    seed_parameter(),
}};

}  // namespace

std::span<const MeshGenerator> swarm_generators() {
  static const std::array<MeshGenerator, 1> list{
      {{{"swarm", "Small octahedra strewn evenly through a block that stands on y = 0.", swarm_parameters,
         swarm_parts},
        make_swarm}}};
  return list;
}

}  // namespace gnomon

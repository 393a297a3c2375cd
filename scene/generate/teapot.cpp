// Newell's teapot as triangles. It is not closed, and never was. The lid rests in the air a gap's width
// inside the rim, the spout is open at its tip, handle and spout end inside the body.
#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"
#include "scene/generate/teapot_patches.h"

namespace gnomon {
namespace {

using teapot::NamedPatch;

Vec3 y_up(const Vec3& p) {
  return {p.x, p.z, -p.y};
}

// Triangles whose corners coincide at a collapsed row of the patch are left out.
void tessellate(const teapot::Patch& patch, int n, double scale, MeshBuilder& b) {
  std::vector<std::uint32_t> ids;
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(k) / n;
      const double s = static_cast<double>(n - i) / n, t = static_cast<double>(n - k) / n;
      points.push_back(scale * y_up(teapot::evaluate(patch, u, s, v, t)) + Vec3(0.0));
      ids.push_back(b.vertex(points.back(), y_up(teapot::normal(patch, u, v)), {v, u}));
    }
  }
  const auto add = [&](int a, int c, int d) {
    const Vec3 &pa = points[a], &pc = points[c], &pd = points[d];
    if (pa != pc && pc != pd && pd != pa) b.triangle(ids[a], ids[c], ids[d]);
  };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const int low = i * (n + 1) + k, high = low + n + 1;
      add(low, high + 1, high);
      add(low, low + 1, high + 1);
    }
  }
}

Expected<GeneratedModel> make_teapot(const Values& values) {
  const int n = values.count("divisions");
  const double scale = values.number("height") / teapot::height;
  constexpr std::array<std::string_view, 4> names{"body", "lid", "handle", "spout"};
  std::array<MeshBuilder, 4> pieces;
  for (const NamedPatch& p : teapot::patches())
    tessellate(p.patch, n, scale, pieces[static_cast<std::size_t>(p.piece)]);
  GeneratedModel model;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    model.parts.push_back({std::string(names[i]), pieces[i].take()});
  return model;
}

const std::array<std::string_view, 4> teapot_parts{"body", "lid", "handle", "spout"};
const std::array<ParameterInfo, 2> teapot_parameters{{
    length_parameter("height", 0.315, 1e-6, 1e6, "from the foot to the knob's top; the spout points to +x"),
    count_parameter("divisions", 16, 2, 256, "segments along each side of the 32 patches"),
}};

}  // namespace

std::span<const MeshGenerator> teapot_generators() {
  static const std::array<MeshGenerator, 1> list{{
      {{"teapot",
        "Newell's teapot: 32 bicubic patches, tessellated; texture coordinates run 0 to 1 on each patch.",
        teapot_parameters, teapot_parts},
       make_teapot},
  }};
  return list;
}

}  // namespace gnomon

// Equal surfaces in different descriptions, one on the other: a sphere as an ellipsoid or by its expression, a plane by its
// expression, a cylinder as a cone, a square in a cap's plane. What shows and what hides is a matter of rounding there.
#include <gtest/gtest.h>

#include "raytrace/frame.h"
#include "scene/light.h"
#include "scene/shapes/solid.h"
#include "tests/support/raytrace_support.h"
#include "verify/random_scene.h"

namespace gnomon {
namespace {

using raytrace::PointVisibility;
using raytrace::Precision;

std::vector<Shape> twin_originals() {
  const ShapeFrame upright = frame_along(Vec3(0.3, 0.0, 0.2), Vec3(0, 1, 0));
  const ShapeFrame tilted = frame_along(Vec3(0.3, 0.1, 0.2), glm::normalize(Vec3(0.1, 1.0, 0.05)));
  const ShapeFrame center = frame_along(Vec3(0.1, 0.7, 0.2), glm::normalize(Vec3(0.2, 1.0, 0.3)));
  return {test::sphere({0.3, 0.6, 0.2}, 0.5),
          test::plane({0.0, 0.3, 0.0}, glm::normalize(Vec3(0.1, 1.0, 0.05))),
          test::plane({0.0, 0.3, 0.0}, {0, 1, 0}),
          {"ellipsoid", make_ellipsoid(tilted, {0.6, 0.4, 0.5})},
          {"cylinder", make_cylinder(upright, 0.5, 1.0, true)},
          {"tilted cylinder", make_cylinder(tilted, 0.5, 0.7, true)},
          {"open cylinder", make_cylinder(tilted, 0.5, 0.7, false)},
          {"cone", make_cone(tilted, 0.5, 0.0, 1.0, true)},
          {"cut cone", make_cone(tilted, 0.5, 0.3, 0.7, true)},
          {"paraboloid", make_paraboloid(tilted, 0.6, 1.0, true)},
          {"hyperboloid", make_hyperboloid(center, 0.5, 0.3, 1.0, true)},
          {"torus", Torus{center, 0.7, 0.2}}};
}

/// A floor under a lamp or a sun, and one of these with its twin, first or last.
Scene with_twin(const Shape& shape, bool in_cap, bool twin_first, bool is_lamp, verify::Random& random) {
  std::vector<Mesh> meshes{test::quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0})};
  std::vector<Shape> shapes{shape};
  Mesh square = in_cap ? verify::quad_in_cap(shape, random) : Mesh{};
  if (!square.triangles.empty())
    meshes.push_back(std::move(square));
  else
    shapes.insert(twin_first ? shapes.begin() : shapes.end(),
                  verify::described_otherwise(shape, 3.0, random));
  Scene scene = test::scene_of(std::move(meshes), std::move(shapes));
  scene.lights = {is_lamp ? test::point_light({2.0, 4.0, 1.0})
                          : test::sun(glm::normalize(Vec3(-1.0, -2.0, -0.5)))};
  scene.camera.eye = {3, 3, 5}, scene.camera.target = {0, 0.3, 0};
  return scene;
}

struct TwinPixels {
  std::size_t on_shapes = 0, uncertain = 0, contradicted = 0;
};

void count_twin_pixels(const Scene& scene, TwinPixels& out) {
  const test::TestWorld w(scene);
  const std::array<std::uint32_t, 1> first{0};
  raytrace::RaytraceOptions options;
  options.size = {64, 36}, options.picture = false;
  const auto trace = [&](Precision precision) {
    return trace_frame(raytrace::Tracer(w.world(), raytrace::Accel::bvh, precision), plan_effects(scene),
                       scene.camera, first, options);
  };
  const auto robust = trace(Precision::robust), exact = trace(Precision::exact);
  for (std::size_t i = 0; i < robust.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint& p = robust.receiver.data[i];
    if (p.primitive == no_id || p.primitive != exact.receiver.data[i].primitive) continue;
    if (w.world().is_triangle(p.primitive) || light_cannot_reach(scene.lights[0], p.position, p.normal))
      continue;
    const PointVisibility a = robust.lights[0].centre.data[i], b = exact.lights[0].centre.data[i];
    const bool doubtful = a == PointVisibility::uncertain || b == PointVisibility::uncertain;
    ++out.on_shapes, out.uncertain += a == PointVisibility::uncertain ? 1 : 0;
    out.contradicted += !doubtful && a != b ? 1 : 0;
  }
}

TEST(Twins, RobustAndExactAgreeOnEqualSurfacesInDifferentDescriptions) {
  verify::Random random(7);
  for (const Shape& shape : twin_originals()) {
    TwinPixels found;
    for (int i = 0; i < 16; ++i)
      count_twin_pixels(with_twin(shape, i % 4 == 3, i % 2 == 0, i < 8, random), found);
    EXPECT_GT(found.on_shapes, 100u) << shape.name;
    EXPECT_EQ(found.contradicted, 0u) << shape.name;
    // But where the surface turns away from the light, at rims and at an apex, a ray leaves it steeply.
    EXPECT_LT(found.uncertain, found.on_shapes / 10) << shape.name << " of " << found.on_shapes;
  }
}

}  // namespace
}  // namespace gnomon

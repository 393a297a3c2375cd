// Triangles made of exact shapes: corners on the surface, closed where the shape is, outside out, converging.
#include <gtest/gtest.h>

#include "scene/shapes/closed_mesh.h"
#include "scene/shapes/tessellate.h"
#include "tests/support/solid_samples.h"

namespace gnomon {
namespace {

double volume(const Mesh& mesh) {
  double six = 0.0;
  for (const auto& t : mesh.triangles)
    six += glm::dot(mesh.positions[t[0]], glm::cross(mesh.positions[t[1]], mesh.positions[t[2]]));
  return six / 6.0;
}

std::vector<Shape> samples() {
  std::vector<Shape> shapes = test::solid_samples();
  shapes.push_back({"ball", Sphere{Vec3(0.1, 0.2, -0.3), 0.8}, 0});
  return shapes;
}

bool closed(const Shape& shape) {
  return !is_solid(shape.geometry) || is_closed(shape.geometry);
}

TEST(Tessellation, ClosedShapesGiveClosedMeshes) {
  for (const Shape& shape : samples())
    for (const int n : {3, 8, 33}) {
      const Mesh mesh = tessellated(shape, n);
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
      if (shape.geometry.index() == 4 && n < 8) continue;  // coarser than the surface: nothing may be left
      EXPECT_FALSE(mesh.triangles.empty()) << shape.name;
      EXPECT_EQ(open_edges(mesh.positions, mesh.triangles) == 0, closed(shape)) << shape.name << " " << n;
      if (closed(shape)) {
        EXPECT_GT(volume(mesh), 0.0) << shape.name << " " << n;
      }
    }
}

TEST(Tessellation, CornersLieOnTheSurface) {
  for (const Shape& shape : samples()) {
    const Mesh mesh = tessellated(shape, 24);
    const bool implicit = shape.geometry.index() == 4;
    int off = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      double distance = std::abs(glm::length(mesh.positions[i] - Vec3(0.1, 0.2, -0.3)) - 0.8);
      if (is_solid(shape.geometry)) {
        const Vec3 p = to_local(frame_of(shape.geometry), mesh.positions[i]);
        const auto f = solid_gradient(shape.geometry, p);
        const Aabb box = local_box(shape.geometry);
        distance = std::abs(f.value) / std::max(glm::length(f.change), 1e-3);
        for (int a = implicit ? 0 : 2; a < 3 && closed(shape); ++a)
          distance = std::min({distance, std::abs(p[a] - box.max[a]), std::abs(p[a] - box.min[a])});
      }
      // Newton's steps leave a cell of 1/12 where the surface bends within it: those corners stay inside it.
      off += distance > (implicit ? 1e-3 : 1e-9) ? 1 : 0;
    }
    EXPECT_LE(off, implicit ? static_cast<int>(mesh.positions.size() / 5) : 0) << shape.name;
  }
}

TEST(Tessellation, VolumeConvergesWithTheSquareOfN) {
  const Shape ball{"ball", Sphere{Vec3(0.0), 1.0}, 0};
  const Shape tire = test::solid("torus", Torus{ShapeFrame{}, 0.7, 0.25});
  const std::pair<Shape, double> cases[] = {{ball, 4.0 / 3.0 * pi}, {tire, 2.0 * pi * pi * 0.7 * 0.0625}};
  for (const auto& [shape, truth] : cases) {
    const double coarse = truth - volume(tessellated(shape, 32)),
                 fine = truth - volume(tessellated(shape, 64));
    EXPECT_GT(fine, 0.0) << shape.name;
    EXPECT_NEAR(coarse / fine, 4.0, 0.1) << shape.name;
  }
}

TEST(Tessellation, PlanesStayAndNotesAreMade) {
  Scene scene;
  scene.materials.resize(2);
  scene.shapes = samples();
  scene.shapes.push_back({"floor", Plane{}, 1});
  const std::size_t count = scene.shapes.size();
  const Scene out = tessellate_shapes(scene, 8);
  ASSERT_EQ(out.shapes.size(), 1u);
  EXPECT_EQ(out.shapes[0].name, "floor");
  EXPECT_EQ(out.instances.size(), count - 1);
  EXPECT_EQ(out.instances[0].name, "ellipsoid");
  ASSERT_EQ(out.notes.size(), 1u);
  EXPECT_NE(out.notes[0].find("16 exact shapes are made of triangles (--tessellate 8)"), std::string::npos)
      << out.notes[0];
}

}  // namespace
}  // namespace gnomon

// The shadow terminator's counts against what the scene is made of: corners of a tessellated sphere lie on it, so that
// the normal between them is that of the place itself as seen from the middle.
#include "scene/shapes/tessellate.h"
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

using compare::TerminatorCount;

const Vec3 middle(0.0, 2.0, 0.0);

Scene ball(int sectors) {
  Scene scene = sunlit_scene({}, {-1.0, -0.5, 0.2});
  scene.shapes.push_back({"ball", Sphere{middle, 1.0}, 0});
  scene.camera = {{0.0, 2.5, 4.0}, middle, {0, 1, 0}, 0.6};
  return sectors > 0 ? tessellate_shapes(std::move(scene), sectors) : scene;
}

TerminatorCount expected(const compare::Comparison& run, const Light& light) {
  TerminatorCount out;
  const compare::LightComparison& compared = run.lights[0];
  for (std::size_t i = 0; i < compared.labels.data.size(); ++i) {
    const raytrace::SurfacePoint& at = run.raytraced.receiver.data[i];
    const compare::Label label = compared.labels.data[i];
    if (at.primitive == no_id || label == compare::Label::silhouette) continue;
    const bool body_faces = glm::dot(at.position - middle, light.direction) < 0.0;
    const bool triangle_faces = glm::dot(at.normal, light.direction) < 0.0;
    out.dark += body_faces && !triangle_faces ? 1 : 0;
    out.unlit += !body_faces && triangle_faces && compare::is_compared(label) ? 1 : 0;
  }
  return out;
}

TEST(Terminator, IsCountedWhereBodyAndTrianglesDisagree) {
  for (const int sectors : {8, 12, 48}) {
    OneWorld one(ball(sectors));
    const compare::Comparison run = one.compare(test_options({200, 200}, 256, 0.01));
    const TerminatorCount counted = run.lights[0].terminator, known = expected(run, one.scene.lights[0]);
    std::printf("  %d sectors: %d dark, %d unlit\n", sectors, int(counted.dark), int(counted.unlit));
    EXPECT_GT(known.dark, 50u);
    EXPECT_GT(known.unlit, 50u);
    EXPECT_EQ(counted.dark, known.dark);
    EXPECT_EQ(counted.unlit, known.unlit);
  }
}

// The exact sphere has no facets, and a mesh without normals of its own is what it looks like.
TEST(Terminator, IsNoneOfShapesAndFlatMeshes) {
  OneWorld exact(ball(0));
  const compare::Comparison of_shape = exact.compare(test_options({64, 64}, 64, 0.01));
  EXPECT_EQ(of_shape.lights[0].terminator.dark + of_shape.lights[0].terminator.unlit, 0u);
  Scene scene = ball(8);
  for (Mesh& mesh : scene.meshes) mesh.normals.clear();
  OneWorld flat(std::move(scene));
  const compare::Comparison of_flat = flat.compare(test_options({64, 64}, 64, 0.01));
  EXPECT_EQ(of_flat.lights[0].terminator.dark + of_flat.lights[0].terminator.unlit, 0u);
}

}  // namespace
}  // namespace gnomon::test

// The conformance suite: its masks against the closed form. What the camera sees and what stands before the
// light is worked out again with slabs and squares, without triangles and without the ray tracer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>

#include "app/suite/write.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/light.h"
#include "scene/load.h"
#include "tests/support/scene_files_support.h"

namespace gnomon::app {
namespace {

/// A box, or a square in the plane y = 0, in its instance's space.
struct Part {
  const MeshInstance* instance;
  Aabb box;
  Mat4 object_from_world;
};

std::vector<Part> parts_of(const Scene& scene) {
  std::vector<Part> parts;
  for (const MeshInstance& instance : scene.instances) {
    const std::string& mesh = scene.meshes[instance.mesh].name;
    const Mat4 inverse = glm::inverse(instance.world_from_object);
    if (mesh == "box") parts.push_back({&instance, {Vec3(-0.5), Vec3(0.5)}, inverse});
    if (mesh == "square") parts.push_back({&instance, {Vec3(-0.5, 0.0, -0.5), Vec3(0.5, 0.0, 0.5)}, inverse});
    if (mesh == "ell")
      for (const Aabb& box : ell_boxes()) parts.push_back({&instance, box, inverse});
  }
  return parts;
}

bool is_square(const Part& part) {
  return part.box.min.y == part.box.max.y;
}

/// The masked leaf's texel is there; true for every other part.
bool is_solid_at(const Scene& scene, const Part& part, const Vec3& object) {
  const Material& material = scene.materials[part.instance->material];
  if (material.alpha_mode != AlphaMode::mask || !is_square(part)) return true;
  const Texture& texture = scene.textures[material.diffuse_texture];
  const auto texel = [](double v, int size) {
    return std::clamp(static_cast<int>(std::floor(v * size)), 0, size - 1);
  };
  const int x = texel(object.x + 0.5, texture.size.width), y = texel(object.z + 0.5, texture.size.height);
  return texture.texels[static_cast<std::size_t>(y * texture.size.width + x)].a >= 128;
}

struct Hit {
  double t = infinity;
  std::size_t part = 0;
  Vec3 normal{0.0};  ///< of the face, in the world, any length
};

/// Where the ray enters the part: the slab method; nothing behind its start.
std::optional<Hit> enter(const Scene& scene, const Part& part, const Ray& ray) {
  const Vec3 o = Vec3(part.object_from_world * Vec4(ray.origin, 1.0));
  const Vec3 d = Vec3(part.object_from_world * Vec4(ray.direction, 0.0));
  double in = -infinity, out = infinity;
  int axis = 1;
  for (int a = 0; a < 3; ++a) {
    const double t0 = (part.box.min[a] - o[a]) / d[a], t1 = (part.box.max[a] - o[a]) / d[a];
    if (std::min(t0, t1) > in) in = std::min(t0, t1), axis = a;
    out = std::min(out, std::max(t0, t1));
  }
  if (!(in <= out) || !(in > 0.0) || !is_solid_at(scene, part, o + in * d)) return std::nullopt;
  Vec3 normal(0.0);
  normal[axis] = 1.0;
  return Hit{in, 0, glm::transpose(Mat3(part.object_from_world)) * normal};
}

struct Answer {
  bool asked = false, lit = false;
};

class ClosedForm {
 public:
  explicit ClosedForm(const Scene& scene)
      : scene_(scene), light_(scene.lights.front()), parts_(parts_of(scene)) {}

  Answer at(const Ray& eye) const {
    Hit first;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (auto hit = enter(scene_, parts_[i], eye); hit && hit->t < first.t) first = *hit, first.part = i;
    if (first.t == infinity) return {};
    const Vec3 place = eye.origin + first.t * eye.direction;
    const bool sun = light_.type == LightType::directional;
    const Vec3 way = sun ? -light_.direction : light_.position - place;
    if (glm::dot(first.normal, way) * glm::dot(first.normal, eye.direction) >= 0.0) return {};
    if (light_.type == LightType::spot &&
        glm::dot(-glm::normalize(way), light_.direction) <= std::cos(light_.outer_angle))
      return {};
    return {true, !blocked({place, way}, first.part, sun ? infinity : 1.0)};
  }

 private:
  // No part stands before its own lit side; the two boxes of an ell are parts of their own.
  bool blocked(const Ray& ray, std::size_t own, double end) const {
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (i != own)
        if (const auto hit = enter(scene_, parts_[i], ray); hit && hit->t < end) return true;
    return false;
  }

  const Scene& scene_;
  const Light& light_;
  std::vector<Part> parts_;
};

constexpr ImageSize size{160, 90};

TEST(Suite, MasksAreTheClosedForm) {
  for (const SuiteScene& entry : suite_scenes()) {
    const SuiteMask mask = suite_mask(entry.scene, size);
    const ClosedForm closed(entry.scene);
    const View view = make_view(entry.scene.camera, size);
    int wrong = 0, lit = 0, dark = 0;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const auto i = static_cast<std::size_t>(y * size.width + x);
        const Answer answer = closed.at(pixel_ray(view, x + 0.5, y + 0.5));
        const bool same = answer.asked == (mask.asked[i] > 0.0f) && answer.lit == (mask.lit[i] > 0.0f);
        if (!same && ++wrong <= 3)
          ADD_FAILURE() << fmt::format("{}: pixel {}, {}: closed form {} {}, mask {} {}", entry.scene.name, x,
                                       y, answer.asked, answer.lit, mask.asked[i], mask.lit[i]);
        (answer.lit ? lit : dark) += answer.asked;
      }
    EXPECT_EQ(wrong, 0) << entry.scene.name;
    EXPECT_GT(lit, 1000) << entry.scene.name;
    EXPECT_GT(dark, entry.scene.name == "tilted-plane" ? -1 : 50) << entry.scene.name;
  }
}

TEST(Suite, ScenesComeBackFromTheirFiles) {
  const TemporaryFolder folder;
  for (const SuiteScene& entry : suite_scenes()) {
    const auto file = write_gltf(entry.scene, true);
    ASSERT_TRUE(file);
    const auto again = load_scene(folder.put(entry.scene.name + ".glb", file->bytes));
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_TRUE(again->notes.empty()) << again->notes.front();
    EXPECT_EQ(positions_of(make_world(entry.scene)), positions_of(make_world(*again))) << entry.scene.name;
    const SuiteMask before = suite_mask(entry.scene, size), after = suite_mask(*again, size);
    EXPECT_EQ(before.lit, after.lit) << entry.scene.name;
    EXPECT_EQ(before.asked, after.asked) << entry.scene.name;
  }
}

TEST(Suite, TheReadmeNamesEveryScene) {
  const TemporaryFolder folder;
  Console console(true);
  const auto written = write_suite(folder.path(), {16, 9}, console);
  ASSERT_TRUE(written) << written.error().message();
  const std::string readme = test::bytes_of(folder.file("README.md"));
  for (const SuiteScene& entry : suite_scenes())
    EXPECT_NE(readme.find(fmt::format("| `{}` | {} |", entry.scene.name, entry.description)),
              std::string::npos)
        << entry.scene.name;
  EXPECT_EQ(folder.file_count(), 2 * suite_scenes().size() + 1);
}

}  // namespace
}  // namespace gnomon::app

// The same scene in other numbers: lengths times a power of two, triangles in another order and cut into four, and
// everything far from the origin. What is compared, wrong and labelled is then counted alike, whatever the technique.
// What does not hold: other axes (maps and cube faces are aligned to the world's, so that their texels lie elsewhere).
//
// In ctest each technique is tried under one kind of light; GNOMON_INVARIANCE=N in the environment: all of them under
// every kind that they draw, on N random scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>
#include <tuple>

#include "app/verify/random.h"
#include "app/verify/small_world.h"
#include "compare/compare.h"
#include "hybrid/visibility.h"
#include "raster/technique_traits.h"

namespace gnomon::test {
namespace {

/// To 1/64: sums with 1e7 and halves of differences are then exact.
double rounded(double x) {
  return std::round(64.0 * x) / 64.0;
}

Scene given_scene(LightType type, std::uint64_t seed) {
  verify::Random random(seed);
  Mesh soup = verify::soup(24, 1.5, 0.8, random);
  for (Vec3& p : soup.positions) p = {rounded(p.x), rounded(p.y) + 1.0, rounded(p.z)};
  Scene scene = verify::scene_of({verify::quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}),
                                  verify::box({-1, 0.5, -1}, {0, 1.5, 0}), std::move(soup)});
  Light light = verify::point_light({-1.75, 4.25, 1.5});
  light.type = type;
  light.direction = glm::normalize(Vec3(0.5, -1.0, -0.375));
  light.outer_angle = 0.7;
  scene.lights = {light};
  scene.camera.eye = {3.5, 2.5, 4.0}, scene.camera.target = {0.0, 0.5, 0.0};
  return scene;
}

void move_all(Scene& scene, const std::function<Vec3(const Vec3&)>& moved) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = moved(p);
  for (Light& light : scene.lights) light.position = moved(light.position);
  scene.camera.eye = moved(scene.camera.eye), scene.camera.target = moved(scene.camera.target);
}

void shuffle_triangles(Scene& scene) {
  std::mt19937 random(7);
  for (Mesh& mesh : scene.meshes) {
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      std::rotate(mesh.triangles[i].begin(), mesh.triangles[i].begin() + static_cast<std::ptrdiff_t>(i % 3),
                  mesh.triangles[i].end());
  }
}

/// At the middles of its edges, so that neighbours stay neighbours.
void split_triangles(Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    std::vector<std::array<std::uint32_t, 3>> parts;
    for (const auto& t : mesh.triangles) {
      const auto n = static_cast<std::uint32_t>(mesh.positions.size());
      for (const std::size_t k : {0, 1, 2})
        mesh.positions.push_back(0.5 * (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]));
      for (const auto& part : {std::array{t[0], n, n + 2}, std::array{n, t[1], n + 1},
                               std::array{n + 2, n + 1, t[2]}, std::array{n, n + 1, n + 2}})
        parts.push_back(part);
    }
    mesh.triangles.assign(parts.begin(), parts.end());
  }
}

struct Change {
  const char* name;
  std::function<void(Scene&)> apply;
};

std::vector<Change> changes() {
  return {{"lengths times 2^20", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p20 * p; }); }},
          {"lengths times 2^-20", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p-20 * p; }); }},
          {"triangles in another order", shuffle_triangles},
          {"triangles cut into four", split_triangles},
          {"moved to 1e7",
           [](Scene& s) { move_all(s, [](const Vec3& p) { return p + Vec3(1e7, -1e7, 1e7); }); }}};
}

/// A scene ready to be compared under any technique.
class Bench {
 public:
  explicit Bench(Scene scene) : scene_(std::move(scene)), world_(make_world(scene_)) {
    auto context = raster::create_context(raster::Backend::automatic);
    if (!context) return;
    auto renderer = raster::Renderer::create(std::move(*context), world_, plan_effects(scene_));
    if (!renderer) return;
    renderer_ = std::move(*renderer);
    renderer_->use_external_visibility(hybrid::make_visibility(world_));
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  bool ready() const { return renderer_ != nullptr; }

  Expected<compare::Comparison> compare(raster::Technique technique) {
    compare::CompareOptions options;
    options.raster.size = options.raytrace.size = {160, 90};
    options.raster.map.size = 128, options.raster.map.technique = technique;
    options.raster.runs = 0, options.raytrace.picture = false, options.perceptual = false;
    const std::array<std::uint32_t, 1> first{0};
    return compare::compare_world(world_, *renderer_, first, options);
  }

 private:
  Scene scene_;
  World world_;
  std::unique_ptr<raster::Renderer> renderer_;
};

auto counts(const compare::LightComparison& c) {
  return std::tuple(c.pixels.background, c.pixels.facing_away, c.pixels.silhouette, c.pixels.uncertain,
                    c.pixels.compared, c.error.false_shadow, c.error.missed_shadow, c.classes);
}

void expect_alike(LightType type, std::span<const raster::Technique> techniques, std::uint64_t seed) {
  Bench given(given_scene(type, seed));
  if (!given.ready()) GTEST_SKIP() << "no OpenGL here";
  std::vector<compare::LightComparison> expected;
  for (const raster::Technique technique : techniques) {
    auto compared = given.compare(technique);
    ASSERT_TRUE(compared.has_value()) << compared.error().message();
    expected.push_back(compared->lights.front());
    EXPECT_GT(expected.back().pixels.compared, 2000u);
  }
  for (const Change& change : changes()) {
    Scene scene = given_scene(type, seed);
    change.apply(scene);
    Bench changed(std::move(scene));
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      const auto compared = changed.compare(techniques[i]);
      ASSERT_TRUE(compared.has_value()) << compared.error().message();
      EXPECT_EQ(counts(compared->lights.front()), counts(expected[i]))
          << change.name << ", " << raster::technique_name(techniques[i]) << ", seed " << seed;
    }
  }
}

constexpr std::array kinds{LightType::point, LightType::spot, LightType::directional};

/// Which techniques a kind of light is tried with: each in turn takes the next kind that it draws, or all.
std::vector<raster::Technique> techniques_for(LightType type, bool all) {
  std::vector<raster::Technique> out;
  std::size_t turn = 0;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    if (all ? traits.lights.has(type) : false) out.push_back(traits.technique);
    if (all) continue;
    while (!traits.lights.has(kinds[turn % kinds.size()])) ++turn;
    if (kinds[turn++ % kinds.size()] == type) out.push_back(traits.technique);
  }
  return out;
}

TEST(Invariance, CountsAreThoseOfTheSameSceneInOtherNumbers) {
  const char* asked = std::getenv("GNOMON_INVARIANCE");
  const std::uint64_t scenes = asked == nullptr ? 1 : std::strtoull(asked, nullptr, 10);
  ASSERT_GE(scenes, 1u) << "GNOMON_INVARIANCE is a number of scenes";
  for (std::uint64_t seed = 1; seed <= scenes; ++seed)
    for (const LightType type : kinds) expect_alike(type, techniques_for(type, asked != nullptr), seed);
}

}  // namespace
}  // namespace gnomon::test

// The same scene in other numbers: lengths times a power of two, triangles in another order and cut into four, and
// everything far from the origin. What is compared, wrong and labelled is then counted alike, whatever the technique.
// Cut triangles hold so for the rays; what is drawn may move by the rounding of their corners. What does not hold at
// all: other axes (maps and cube faces are aligned to the world's, so that their texels lie elsewhere).
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
#include <span>
#include <string>

#include "app/verify/random.h"
#include "app/verify/small_world.h"
#include "compare/compare.h"
#include "hybrid/visibility.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

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
  std::uint64_t may_differ = 0;  ///< sum over what was counted
};

/// OpenGL rounds corners to 1/256 of a pixel or texel, new ones too, so that an edge moves by up to as much. Of the
/// pictures' 14,400 pixels and the maps' 16,384 texels fewer than 4,000 lie on edges: some 16 of each change, and one
/// changes two or three counts of each pixel that it stands for.
constexpr std::uint64_t of_new_corners = 100;

std::vector<Change> changes() {
  return {{"lengths times 2^20", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p20 * p; }); }},
          {"lengths times 2^-20", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p-20 * p; }); }},
          {"triangles in another order", shuffle_triangles},
          {"triangles cut into four", split_triangles, of_new_corners},
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

constexpr std::size_t kinds_of_truth = 5;  ///< background, facing away, shadowed, lit, uncertain

/// What rays say, and what was drawn and compared.
struct Counts {
  std::array<std::uint64_t, kinds_of_truth> truth{};
  std::vector<std::uint64_t> drawn;
  bool operator==(const Counts&) const = default;
};

Counts counts(const compare::Comparison& c) {
  Counts out;
  const Light& light = c.world->scene->lights.front();
  for (std::size_t i = 0; i < c.raytraced.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint& p = c.raytraced.receiver.data[i];
    const raytrace::Verdict verdict = c.raytraced.lights[0].verdict.data[i];
    std::size_t kind = verdict == raytrace::Verdict::shadowed ? 2 : verdict == raytrace::Verdict::lit ? 3 : 4;
    if (p.primitive == no_id)
      kind = 0;
    else if (light_cannot_reach(light, p.position, p.normal))
      kind = 1;
    ++out.truth[kind];
  }
  const compare::LightComparison& l = c.lights.front();
  out.drawn = {l.pixels.background, l.pixels.facing_away, l.pixels.silhouette,  l.pixels.uncertain,
               l.pixels.compared,   l.error.false_shadow, l.error.missed_shadow};
  out.drawn.insert(out.drawn.end(), l.classes.begin(), l.classes.end());
  return out;
}

std::uint64_t distance(const Counts& a, const Counts& b) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.drawn.size(); ++i)
    sum += a.drawn[i] > b.drawn[i] ? a.drawn[i] - b.drawn[i] : b.drawn[i] - a.drawn[i];
  return sum;
}

void expect_alike(LightType type, std::span<const raster::Technique> techniques, std::uint64_t seed) {
  Bench given(given_scene(type, seed));
  if (!given.ready()) GTEST_SKIP() << "no OpenGL here";
  std::vector<Counts> expected;
  for (const raster::Technique technique : techniques) {
    auto compared = given.compare(technique);
    ASSERT_TRUE(compared.has_value()) << compared.error().message();
    expected.push_back(counts(*compared));
    EXPECT_GT(compared->lights.front().pixels.compared, 2000u);
  }
  for (const Change& change : changes()) {
    Scene scene = given_scene(type, seed);
    change.apply(scene);
    Bench changed(std::move(scene));
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      const auto compared = changed.compare(techniques[i]);
      ASSERT_TRUE(compared.has_value()) << compared.error().message();
      const Counts found = counts(*compared);
      const std::string what = std::string(change.name) + ", " +
                               std::string(raster::technique_name(techniques[i])) + ", seed " +
                               std::to_string(seed);
      EXPECT_EQ(found.truth, expected[i].truth) << what;
      EXPECT_LE(distance(found, expected[i]), change.may_differ) << what;
    }
  }
}

constexpr std::array kinds{LightType::point, LightType::spot, LightType::directional};

/// Which techniques a kind of light is tried with: each in turn takes the next kind that it draws, or all.
std::vector<raster::Technique> techniques_for(LightType type, bool all) {
  std::vector<raster::Technique> out;
  std::size_t turn = 0;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    if (all) {
      if (traits.lights.has(type)) out.push_back(traits.technique);
      continue;
    }
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

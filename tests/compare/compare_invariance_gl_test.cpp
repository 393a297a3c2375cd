// The same scene in other numbers: lengths times a power of two, everything far from the origin, triangles in another
// order, with another corner first, and cut into four. What rays say is then the same, pixel by pixel. What is drawn:
//  - lengths times a power of two, another order of triangles: every map and every visibility to the bit;
//  - far from the origin: every pixel has its label;
//  - another corner first: OpenGL interpolates depth from one corner, so that stored depths change in their last bits,
//    and a pixel may change its label only where it is as good as undecided;
//  - cut: OpenGL rounds corners to 1/256 of a pixel or texel, the new ones too, so that edges move by that.
// What does not hold at all: other axes (maps and cube faces are aligned to the world's, so that their texels lie
// elsewhere).
//
// In ctest each technique is tried under one kind of light; GNOMON_INVARIANCE=N in the environment: all of them under
// every kind that they draw, on N random scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <span>
#include <string>

#include "compare/compare.h"
#include "compare/truth/stored_surface.h"
#include "hybrid/visibility.h"
#include "raster/technique_traits.h"
#include "scene/light.h"
#include "verify/random_scene.h"

namespace gnomon::test {
namespace {

using compare::Comparison;

void move_all(Scene& scene, const std::function<Vec3(const Vec3&)>& moved) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = moved(p);
  for (Light& light : scene.lights) light.position = moved(light.position);
  scene.camera.eye = moved(scene.camera.eye), scene.camera.target = moved(scene.camera.target);
}

void shuffle_triangles(Scene& scene) {
  std::mt19937 random(7);
  for (Mesh& mesh : scene.meshes) std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
}

void turn_corners(Scene& scene) {
  for (Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      std::rotate(mesh.triangles[i].begin(), mesh.triangles[i].begin() + static_cast<std::ptrdiff_t>(i % 3),
                  mesh.triangles[i].end());
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

/// A scene ready to be compared under any technique.
class Bench {
 public:
  explicit Bench(Scene scene) : scene_(std::move(scene)), world_(make_world(scene_)) {
    auto context = raster::create_context(raster::Backend::automatic);
    if (!context) return;
    auto renderer = raster::Renderer::create(std::move(*context), world_, plan_effects(scene_));
    if (!renderer) return;
    renderer_ = std::move(*renderer);
    renderer_->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world_));
  }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  bool ready() const { return renderer_ != nullptr; }

  Expected<Comparison> compare(raster::Technique technique) {
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

const raster::LightRecord& record_of(const Comparison& c) {
  return c.raster.lights.front();
}

/// What rays say of each pixel, whatever the numbers of triangles.
std::vector<int> truth(const Comparison& c) {
  enum { background, facing_away, hit };
  const Light& light = c.world->scene->lights.front();
  std::vector<int> out;
  for (std::size_t i = 0; i < c.raytraced.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint& p = c.raytraced.receiver.data[i];
    if (p.primitive == no_id)
      out.push_back(background);
    else if (light_cannot_reach(light, p.position, p.normal))
      out.push_back(facing_away);
    else
      out.push_back(hit + static_cast<int>(c.raytraced.lights[0].centre.data[i]));
  }
  return out;
}

float error_of(const Comparison& c, std::size_t pixel) {
  const auto& rungs = c.lights[0].rungs;
  return std::abs(rungs.back().data[pixel] - rungs.front().data[pixel]);
}

/// What averages moments is moved by rounding (msm's visibility by a tenth at most), and with it the cause of what is off by one
/// half at most: whether there is one, and which.
bool is_moved_by_rounding(const Comparison& a, const Comparison& b, std::size_t pixel) {
  const float x = error_of(a, pixel), y = error_of(b, pixel);
  return x != y && std::max(x, y) <= 0.5f;
}

std::vector<std::size_t> other_labels(const Comparison& a, const Comparison& b) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < a.lights[0].labels.data.size(); ++i)
    if (a.lights[0].labels.data[i] != b.lights[0].labels.data[i] && !is_moved_by_rounding(a, b, i))
      out.push_back(i);
  return out;
}

void expect_labels(const Comparison& given, const Comparison& changed, const std::string& what) {
  for (const std::size_t i : other_labels(given, changed))
    ADD_FAILURE() << what << ", pixel " << i << ": " << label_name(given.lights[0].labels.data[i]) << " and "
                  << label_name(changed.lights[0].labels.data[i]) << ", errors " << error_of(given, i)
                  << " and " << error_of(changed, i);
}

/// The sheets of the hybrid are as sure of as many pixels, so that it asks for as many rays.
void expect_scaled(const Comparison& given, const Comparison& changed, const std::string& what) {
  expect_labels(given, changed, what);
  const auto &before = record_of(given).external, &after = record_of(changed).external;
  ASSERT_EQ(before.has_value(), after.has_value()) << what;
  if (!before) return;
  EXPECT_EQ(before->surely_lit, after->surely_lit) << what;
  EXPECT_EQ(before->surely_shadowed, after->surely_shadowed) << what;
  EXPECT_EQ(before->rays, after->rays) << what;
}

void expect_bits(const Comparison& given, const Comparison& changed, const std::string& what) {
  EXPECT_EQ(record_of(given).map.depth, record_of(changed).map.depth) << what;
  EXPECT_EQ(record_of(given).visibility.data, record_of(changed).visibility.data) << what;
  expect_labels(given, changed, what);
}

/// A gap within rounding of the bias; or, where depths are averaged, a visibility near one half: one texel of pcf's nine
/// moves it by 1/9, and rounding moves msm's by a tenth at most (one of 2 million pixels; the others' by 4e-4).
bool is_undecided(const raster::LightRecord& record, std::size_t pixel) {
  return std::abs(record.gap.data[pixel] - record.bias_constant_world) <= record.rounding_world ||
         std::abs(record.visibility.data[pixel] - 0.5f) <= 1.0f / 8;
}

void expect_decided_labels(const Comparison& given, const Comparison& changed, const std::string& what) {
  for (const std::size_t i : other_labels(given, changed))
    EXPECT_TRUE(is_undecided(record_of(given), i) || is_undecided(record_of(changed), i))
        << what << ", pixel " << i << ", visibility " << record_of(given).visibility.data[i] << " and "
        << record_of(changed).visibility.data[i];
}

/// Whether the next pixel to the right or below shows another triangle.
bool beside_an_edge(const Image<std::uint32_t>& shown, std::size_t i) {
  const auto width = static_cast<std::size_t>(shown.size.width);
  const auto other = [&](std::size_t next) {
    return next < shown.data.size() && shown.data[next] != shown.data[i];
  };
  return ((i + 1) % width != 0 && other(i + 1)) || other(i + width);
}

/// Tells whether what is stored in the texel of the pixel's receiver lies beside an edge.
bool beside_an_edge(const raytrace::Tracer& tracer, const Comparison& c, std::size_t pixel) {
  const raster::LightRecord& record = record_of(c);
  const raster::ShadowMap& map = record.map;
  const auto clamped = [&](float x) { return std::clamp(static_cast<int>(x), 0, map.view.size - 2); };
  const int face = record.face.data[pixel], column = clamped(record.texel_uv.data[pixel].x),
            row = clamped(record.texel_uv.data[pixel].y);
  const auto stored = [&](int x, int y) {
    const raytrace::TexelKey key = raytrace::TexelKey::pack(face, x, y);
    return compare::stored_surface(tracer, record, c.raster.options.map, key).primitive;
  };
  const std::uint32_t here = stored(column, row);
  return stored(column + 1, row) != here || stored(column, row + 1) != here;
}

/// A corner is rounded by up to 1/512 along each axis, the given as well as the new one, so that an edge moves by up to
/// sqrt(2)/256 of the distance between two centres. It lies anywhere between them: the share of edges that pass over a
/// centre is no more, and most corners are rounded by less.
double labels_at_moved_edges(const Comparison& given) {
  const raytrace::Tracer tracer(*given.world, raytrace::Accel::bvh);
  std::size_t edges = 0;
  for (std::size_t i = 0; i < given.raster.primitive.data.size(); ++i)
    edges += beside_an_edge(given.raster.primitive, i) + beside_an_edge(tracer, given, i);
  return std::numbers::sqrt2 / 256 * static_cast<double>(edges);
}

void expect_moved_edges(const Comparison& given, const Comparison& changed, const std::string& what) {
  EXPECT_LE(static_cast<double>(other_labels(given, changed).size()), labels_at_moved_edges(given)) << what;
}

struct Change {
  const char* name;
  std::function<void(Scene&)> apply;
  void (*expect)(const Comparison& given, const Comparison& changed, const std::string& what);
};

std::vector<Change> changes() {
  return {
      {"lengths times 2^60", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p60 * p; }); },
       expect_scaled},
      {"lengths times 2^-60", [](Scene& s) { move_all(s, [](const Vec3& p) { return 0x1p-60 * p; }); },
       expect_scaled},
      {"triangles in another order", shuffle_triangles, expect_bits},
      {"triangles with another corner first", turn_corners, expect_decided_labels},
      {"triangles cut into four", split_triangles, expect_moved_edges},
      {"moved to 1e7", [](Scene& s) { move_all(s, [](const Vec3& p) { return p + Vec3(1e7, -1e7, 1e7); }); },
       expect_labels}};
}

void expect_alike(LightType type, std::span<const raster::Technique> techniques, std::uint64_t seed) {
  const auto scene_given = [&] { return verify::invariant_scene(type, verify::Random(seed)); };
  Bench given(scene_given());
  if (!given.ready()) GTEST_SKIP() << "no OpenGL here";
  std::vector<Comparison> expected;
  for (const raster::Technique technique : techniques) {
    auto compared = given.compare(technique);
    ASSERT_TRUE(compared.has_value()) << compared.error().message();
    EXPECT_GT(compared->lights.front().pixels.compared, 2000u);
    expected.push_back(std::move(*compared));
  }
  for (const Change& change : changes()) {
    Scene scene = scene_given();
    change.apply(scene);
    Bench changed(std::move(scene));
    for (std::size_t i = 0; i < techniques.size(); ++i) {
      const auto found = changed.compare(techniques[i]);
      ASSERT_TRUE(found.has_value()) << found.error().message();
      const std::string what = std::string(change.name) + ", " +
                               std::string(raster::technique_name(techniques[i])) + ", seed " +
                               std::to_string(seed);
      EXPECT_EQ(truth(*found), truth(expected[i])) << what;
      change.expect(expected[i], *found, what);
    }
  }
}

constexpr std::array kinds{LightType::point, LightType::spot, LightType::directional};

/// Which techniques a kind of light is tried with: each in turn takes the next kind that it draws, or all.
std::vector<raster::Technique> techniques_for(LightType type, bool all) {
  std::vector<raster::Technique> out;
  std::size_t turn = 0;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits()) {
    if (raster::samples_rays(traits.technique))
      continue;  // its noise is of the pixel's and the light's number
    if (all) {
      if (traits.lights.has(type)) out.push_back(traits.technique);
      continue;
    }
    while (!traits.lights.has(kinds[turn % kinds.size()])) ++turn;
    if (kinds[turn++ % kinds.size()] == type) out.push_back(traits.technique);
  }
  return out;
}

TEST(Invariance, PixelsAreThoseOfTheSameSceneInOtherNumbers) {
  const char* asked = std::getenv("GNOMON_INVARIANCE");
  const std::uint64_t scenes = asked == nullptr ? 1 : std::strtoull(asked, nullptr, 10);
  ASSERT_GE(scenes, 1u) << "GNOMON_INVARIANCE is a number of scenes";
  for (std::uint64_t seed = 1; seed <= scenes; ++seed)
    for (const LightType type : kinds) expect_alike(type, techniques_for(type, asked != nullptr), seed);
}

// In a map that is a perspective one the sheets' bounds are lengths, too.
TEST(Invariance, TheHybridIsAsSureUnderALampInATinySceneAsInALargeOne) {
  constexpr std::array hybrid{raster::Technique::hybrid};
  expect_alike(LightType::point, hybrid, 1);
}

}  // namespace
}  // namespace gnomon::test

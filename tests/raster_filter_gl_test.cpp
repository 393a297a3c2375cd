// Every filtering technique's drawn visibility against its formula in double precision on the depth map read
// back (raster_filter_reference.h).
#include "tests/raster_filter_reference.h"

#include "raster/light_block.h"
#include "raster/moment_pass.h"
#include "shaders/shared_constants.h"

namespace gnomon::test {
namespace {

using raster::FilterKernel;
using raster::Technique;

Scene lit_still_life(LightType type) {
  Scene scene = still_life(false);
  scene.lights = {type == LightType::directional ? sun({-0.5, -1.0, -0.6})
                                                 : lamp(type, {0.3, 3.2, 1.2}, {0.0, 0.0, 0.0})};
  return scene;
}

raster::RasterOptions technique_options(Technique technique) {
  raster::RasterOptions options = small_options(128);
  options.map.technique = technique;
  options.map.bias.constant = 1.5;
  options.map.filter.mipmaps = false;
  options.map.filter.receiver_plane = technique == Technique::pcss;
  return options;
}

class Filter : public testing::TestWithParam<LightType> {
 protected:
  /// Draws, and holds every receiver's visibility against reference(receiver, doubt); those in doubt are left
  /// out.
  void compare(const raster::RasterOptions& options, double tolerance,
               const std::function<double(const Drawn&, const FilterReceiver&, bool&)>& reference) {
    const Drawn drawn = draw(lit_still_life(GetParam()), options);
    ASSERT_FALSE(drawn.frame.lights.empty());
    int tested = 0, between = 0, doubtful = 0;
    for_receivers(drawn, 6.0, [&](const FilterReceiver& r) {
      bool doubt = false;
      const double expected = reference(drawn, r, doubt);
      if (doubt) {
        ++doubtful;
        return;
      }
      const double visibility = drawn.light().visibility.data[r.pixel];
      ++tested;
      between += visibility > 0.0 && visibility < 1.0 ? 1 : 0;
      ASSERT_NEAR(visibility, expected, tolerance) << "at " << r.at.u << ", " << r.at.v;
    });
    EXPECT_GT(tested, 4000);
    EXPECT_GT(between, 100);
    EXPECT_LT(doubtful, tested);
  }
};

// A rounding error may choose other texels near a texel's border.
bool near_border(double texels) {
  return std::abs(texels - std::round(texels)) < 1e-3;
}

double box_mean(const Drawn& drawn, const FilterReceiver& r, int radius, bool& doubt) {
  doubt = doubt || near_border(r.at.u) || near_border(r.at.v);
  double sum = 0.0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) sum += lit_at(drawn, r, r.at.column() + i, r.at.row() + j, doubt);
  return sum / ((2 * radius + 1) * (2 * radius + 1));
}

// Sums of at most 49 equal weights, in float.
constexpr double sum_tolerance = 1e-5;

TEST_P(Filter, BoxIsTheMeanOfHardTests) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.radius_texels = 2.5;
  compare(options, sum_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& doubt) {
    return box_mean(drawn, r, 2, doubt);
  });
}

TEST_P(Filter, ReceiverPlaneTakesThePlanesDepthAtEachTap) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.radius_texels = 3.5;
  options.map.bias.constant = 0.2;
  options.map.bias.receiver_plane = true;
  compare(options, sum_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& doubt) {
    return box_mean(drawn, r, 3, doubt);
  });
}

// The share of a texel of a row that a square around the receiver covers.
double covered(int texel, double middle, double radius) {
  return std::clamp(std::min(texel + 1.0, middle + radius) - std::max(double(texel), middle - radius), 0.0,
                    1.0);
}

double square_mean(const Drawn& drawn, const FilterReceiver& r, double radius, bool& doubt) {
  double sum = 0.0;
  const int reach = static_cast<int>(std::ceil(radius)) + 1;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double weight =
          covered(r.at.column() + i, r.at.u, radius) * covered(r.at.row() + j, r.at.v, radius);
      if (weight > 0.0) sum += weight * lit_at(drawn, r, r.at.column() + i, r.at.row() + j, doubt);
    }
  return sum / (4.0 * radius * radius);
}

// Texel positions of some hundred carry a rounding of 1e-5 into the weights; a few of them add up.
constexpr double weight_tolerance = 4e-4;

TEST_P(Filter, HardwareIsTheBilinearMeanOfFour) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::hardware;
  compare(options, weight_tolerance, [](const Drawn& drawn, const FilterReceiver& r, bool& doubt) {
    return square_mean(drawn, r, 0.5, doubt);
  });
}

TEST_P(Filter, OptimisedWeighsTexelsByTheirOverlap) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::optimised;
  for (const double radius : {1.0, 1.7, 2.5}) {
    options.map.filter.radius_texels = radius;
    compare(options, weight_tolerance, [radius](const Drawn& drawn, const FilterReceiver& r, bool& doubt) {
      return square_mean(drawn, r, radius, doubt);
    });
  }
}

// The turn differs from pixel to pixel; what must hold is that taps are at most a radius away, and many make
// the mean over the disc.
TEST_P(Filter, VogelIsTheMeanOverADisc) {
  raster::RasterOptions options = technique_options(Technique::pcf);
  options.map.filter.kernel = FilterKernel::vogel;
  options.map.filter.radius_texels = 3.0;
  options.map.filter.samples = 512;
  // 512 evenly spread points: each cell of the disc is found to about one point in sqrt(512).
  compare(options, 0.05, [](const Drawn& drawn, const FilterReceiver& r, bool& doubt) {
    double sum = 0.0;
    int count = 0;
    bool any = false;
    constexpr int grid = 48;
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) {
        const Vec2 p((2.0 * i + 1.0) / grid - 1.0, (2.0 * j + 1.0) / grid - 1.0);
        if (glm::dot(p, p) > 1.0) continue;
        ++count;
        sum += lit_at(drawn, r, static_cast<int>(std::floor(r.at.u + 3.0 * p.x)),
                      static_cast<int>(std::floor(r.at.v + 3.0 * p.y)), any);
      }
    doubt = any;
    return sum / count;
  });
}

/// The reference of a technique of moments: blurred and read bilinearly, then `visibility` of the moments and
/// the receiver's biased share.
template <class Moments, class Visibility>
auto moment_reference(const Moments& moments, const Visibility& visibility) {
  auto faces = std::make_shared<std::map<int, BlurredFace>>();
  return [=](const Drawn& drawn, const FilterReceiver& r, bool&) {
    const auto& map = drawn.light().map;
    const int radius = drawn.frame.options.map.filter.blur_radius_texels;
    auto found = faces->find(r.at.face);
    if (found == faces->end())
      found = faces->emplace(r.at.face, BlurredFace(map, r.at.face, radius, moments)).first;
    return visibility(found->second.bilinear(r.at.u, r.at.v),
                      BlurredFace::share(map.view, r.at.distance - r.slack));
  };
}

TEST_P(Filter, VsmIsChebyshevsBound) {
  raster::RasterOptions options = technique_options(Technique::vsm);
  options.map.filter.light_bleeding_reduction = 0.3;
  // The variance is a difference of squares: rounding of 2^-24 against a variance of 1e-4 and less.
  compare(options, 0.02,
          moment_reference(
              [](double z) {
                return BlurredFace::Value{z, z * z, 0, 0};
              },
              [](const BlurredFace::Value& m, double x) {
                return std::clamp((chebyshev(m[0], m[1], x) - 0.3) / 0.7, 0.0, 1.0);
              }));
}

TEST_P(Filter, EsmIsTheMeanExponential) {
  raster::RasterOptions options = technique_options(Technique::esm);
  options.map.filter.esm_exponent = 60.0;
  compare(options, 2e-3,
          moment_reference(
              [](double z) {
                return BlurredFace::Value{std::exp(60.0 * z), 0, 0, 0};
              },
              [](const BlurredFace::Value& m, double x) {
                return std::clamp(m[0] * std::exp(-60.0 * x), 0.0, 1.0);
              }));
}

TEST_P(Filter, EvsmIsTheSmallerOfTwoBounds) {
  raster::RasterOptions options = technique_options(Technique::evsm);
  options.map.filter.light_bleeding_reduction = 0.0;
  options.map.filter.evsm_positive_exponent = 20.0;
  const auto warp = [](double share) {
    const double z = 2.0 * share - 1.0;
    return std::pair(std::exp(20.0 * z), -std::exp(-5.0 * z));
  };
  compare(options, 0.02,
          moment_reference(
              [warp](double share) {
                const auto [p, n] = warp(share);
                return BlurredFace::Value{p, p * p, n, n * n};
              },
              [warp](const BlurredFace::Value& m, double x) {
                const auto [p, n] = warp(x);
                return std::min(chebyshev(m[0], m[1], p), chebyshev(m[2], m[3], n));
              }));
}

TEST_P(Filter, MsmIsTheLeastShadowOfFourMoments) {
  raster::RasterOptions options = technique_options(Technique::msm);
  options.map.filter.light_bleeding_reduction = 0.0;
  options.map.filter.moment_bias =
      1e-3;  // large, so that the comparison is one of formulas and not of rounding
  compare(options, 0.03,
          moment_reference(
              [](double share) {
                const double z = 2.0 * share - 1.0;
                return BlurredFace::Value{z, z * z, z * z * z, z * z * z * z};
              },
              [](BlurredFace::Value m, double x) {
                const BlurredFace::Value safe{0.0, 0.375, 0.0, 0.375};
                for (std::size_t k = 0; k < 4; ++k) m[k] = m[k] * (1.0 - 1e-3) + 1e-3 * safe[k];
                return std::clamp(1.0 - least_share_before(m, 2.0 * x - 1.0), 0.0, 1.0);
              }));
}

INSTANTIATE_TEST_SUITE_P(Lights, Filter,
                         testing::Values(LightType::directional, LightType::point, LightType::spot));

/// Two squares above each other over the ground, seen by a sun from straight above: over the far corner of
/// the lower one, a filter mixes the upper square's depth with the lower one's; below both, the ground is in
/// full shadow.
Scene two_occluders() {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {square_mesh(4.0), square_mesh(1.0)};
  scene.instances.push_back({"ground", 0, placed({0.0, 0.0, 0.0}, 1.0), 0});
  scene.instances.push_back({"middle", 1, placed({0.0, 1.0, 0.0}, 1.0), 0});
  scene.instances.push_back({"top", 1, placed({1.0, 3.0, 0.0}, 1.0), 0});
  scene.lights = {sun({0.0, -1.0, 0.0})};
  scene.camera.eye = {0.0, 0.7, 6.0};  // below the middle square
  scene.camera.target = {0.0, 0.0, 0.0};
  return scene;
}

// Donnelly and Lauritzen's light bleeding: with a share p of the filter on the upper occluder at distance a,
// 1 - p on the lower one at b, the receiver at c gets variance / (variance + (c - mean)^2) though nothing of
// it is lit.
TEST(FilterScenes, VsmBleedsByItsFormula) {
  raster::RasterOptions options = technique_options(Technique::vsm);
  options.map.bias.constant = 0.0;
  options.map.filter.light_bleeding_reduction = 0.0;
  const Drawn drawn = draw(two_occluders(), options);
  const auto& record = drawn.light();
  const LightView& view = record.map.view;
  const double a = BlurredFace::share(view, project_to_texel(view, {1.0, 3.0, 0.0}).distance);
  const double b = BlurredFace::share(view, project_to_texel(view, {0.0, 1.0, 0.0}).distance);
  const double c = BlurredFace::share(view, project_to_texel(view, {0.0, 0.0, 0.0}).distance);
  int tested = 0;
  double most = 0.0;
  for_receivers(drawn, 6.0, [&](const FilterReceiver& r) {
    if (r.position.y > 1e-6 || std::abs(r.position.z) > 0.7 || r.position.x < -0.6 || r.position.x > 0.6)
      return;
    // The texels under the filter: which share of them the upper square covers, read from the map.
    double share = 0.0;
    const int radius = options.map.filter.blur_radius_texels;
    const int base = static_cast<int>(std::floor(r.at.u - 0.5));
    const double fraction = r.at.u - 0.5 - base;
    for (int side = 0; side <= 1; ++side)
      for (int i = -radius; i <= radius; ++i) {
        const Ray ray = texel_ray(view, 0, base + side + i + 0.5, r.at.row() + 0.5);
        const bool upper = (ray.origin + ray.direction * 1.0).x > 0.0;
        share += upper ? (side ? fraction : 1.0 - fraction) / (2 * radius + 1) : 0.0;
      }
    const double mean = share * a + (1.0 - share) * b;
    const double variance = share * (1.0 - share) * (b - a) * (b - a);
    const double expected = variance / (variance + (c - mean) * (c - mean));
    ++tested;
    most = std::max(most, expected);
    // Float moments of order one: a variance of 0.01 to about 1e-5 of it.
    ASSERT_NEAR(record.visibility.data[r.pixel], expected, 2e-3) << r.position.x;
  });
  EXPECT_GT(tested, 80);
  EXPECT_GT(most, 0.1);
}

// A floor under a lamp, where two faces of its cube meet: filters read across the edge, so that nothing shows
// there.
TEST(FilterScenes, CubeEdgesDoNotShow) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {square_mesh(4.0)};
  scene.instances.push_back({"floor", 0, placed({0.0, 0.0, 0.0}, 1.0), 0});
  scene.lights = {lamp(LightType::point, {0.3, 1.1, 0.2}, {0.0, 0.0, 0.0})};
  scene.lights[0].extent = SphereLight{0.1};
  scene.camera.eye = {0.5, 3.0, 5.0};
  scene.camera.target = {0.0, 0.0, 0.0};
  for (const Technique technique :
       {Technique::pcf, Technique::pcss, Technique::vsm, Technique::esm, Technique::evsm, Technique::msm}) {
    raster::RasterOptions options = technique_options(technique);
    options.map.bias.constant = 0.5;
    options.map.bias.receiver_plane = technique == Technique::pcf;
    if (raster::uses_moments(technique)) options.map.bias.slope = 6.0;  // the blur is five texels wide
    options.map.filter.radius_texels = 4.5;
    const Drawn drawn = draw(scene, options);
    float at_edge = 1.0f, elsewhere = 1.0f;
    int edge_pixels = 0;
    for_receivers(drawn, 0.0, [&](const FilterReceiver& r) {
      const double to_edge = std::min(std::min(r.at.u, r.at.v), 128.0 - std::max(r.at.u, r.at.v));
      float& least = to_edge < 5.0 ? at_edge : elsewhere;
      edge_pixels += to_edge < 5.0 ? 1 : 0;
      least = std::min(least, drawn.light().visibility.data[r.pixel]);
    });
    EXPECT_GT(edge_pixels, 100);
    EXPECT_GT(elsewhere, 0.9f) << int(technique);
    EXPECT_GT(at_edge, elsewhere - 0.03f) << int(technique);
  }
}

// What blur and moments cost is counted with the map: two floats a texel, and once more for the rows' means.
TEST(FilterScenes, CostsOfTheFilterAreCounted) {
  const Drawn hard = draw(lit_still_life(LightType::directional), technique_options(Technique::hard));
  const Drawn vsm = draw(lit_still_life(LightType::directional), technique_options(Technique::vsm));
  const std::uint64_t texels = 128 * 128;
  EXPECT_EQ(hard.frame.map_texels, texels);
  EXPECT_EQ(hard.frame.map_bytes, 4 * texels);
  EXPECT_EQ(vsm.frame.map_texels, 4 * texels);
  EXPECT_EQ(vsm.frame.map_bytes, 4 * texels + 2 * 8 * texels);
}

/// A world on a device with one light's depth map drawn: the passes without the renderer around them.
class DrawnMap {
 public:
  DrawnMap(Scene scene, const raster::MapOptions& options)
      : scene_(std::move(scene)),
        world_(make_world(scene_)),
        context_(software_context()),
        options_(options) {
    context_->make_current();
    gl_ = std::move(*raster::Gl::load(*context_));
    const raster::SceneFeatures features = raster::scene_features(plan_effects(scene_), world_);
    programs_ = std::make_unique<raster::ProgramCache>(*gl_, features);
    buffers_ = std::make_unique<raster::WorldBuffers>(*raster::WorldBuffers::upload(*gl_, world_, features));
    buffers_->set_reference(Vec3(0.0));
    view_ = *fit_light_view(world_, scene_.lights[0], scene_.camera, 1.5, options.size);
    block_ = std::make_unique<raster::Buffer>(*gl_);
    block_->write_one(raster::make_light_block(scene_.lights[0], view_, options, 0.0, {}, Vec3(0.0)));
    block_->bind(GL_UNIFORM_BUFFER, shaders::light_block);
    map_ = std::make_unique<raster::DepthMapPass>(*gl_, *programs_);
    EXPECT_TRUE(map_->prepare(view_, options.depth_format, false).has_value());
    EXPECT_TRUE(map_->draw(*buffers_, view_, options.cull, false).has_value());
  }

  /// The moments of face 0, one component, after a blur.
  std::vector<float> moments(int blur_radius) {
    options_.filter.blur_radius_texels = blur_radius;
    const raster::MapJob job{*buffers_, scene_.lights[0], view_, *map_, options_};
    raster::MomentPass pass(*gl_, *programs_);
    EXPECT_TRUE(pass.prepare(job).has_value());
    EXPECT_TRUE(pass.draw(job).has_value());
    std::vector<float> values(pass.moments().size().pixels());
    pass.moments().read(GL_RED, GL_FLOAT, std::as_writable_bytes(std::span(values)));
    return values;
  }

 private:
  Scene scene_;
  World world_;
  std::unique_ptr<raster::Context> context_;
  raster::MapOptions options_;
  std::unique_ptr<raster::Gl> gl_;
  std::unique_ptr<raster::ProgramCache> programs_;
  std::unique_ptr<raster::WorldBuffers> buffers_;
  LightView view_;
  std::unique_ptr<raster::Buffer> block_;
  std::unique_ptr<raster::DepthMapPass> map_;
};

// A blur spreads values and adds none. The last texel of a row repeats beyond the edge, so that it weighs
// more and its neighbours less: with those weights the sums before and after are the same.
TEST(FilterScenes, BlurConservesTheMean) {
  raster::MapOptions options;
  options.technique = Technique::vsm;
  options.size = 96;
  options.filter.mipmaps = false;
  constexpr int radius = 3;
  DrawnMap map(lit_still_life(LightType::directional), options);
  const std::vector<float> plain = map.moments(0), blurred = map.moments(radius);
  std::vector<double> weight(96, 0.0);
  for (int i = 0; i < 96; ++i)
    for (int k = -radius; k <= radius; ++k)
      weight[static_cast<std::size_t>(std::clamp(i + k, 0, 95))] += 1.0 / (2 * radius + 1);
  double before = 0.0, after = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    before += plain[i] * weight[i % 96] * weight[i / 96];
    after += blurred[i];
    spread = std::max(spread, double(std::abs(plain[i] - blurred[i])));
  }
  EXPECT_NEAR(after, before, 1e-6 * before);  // rounding of 2^-24 per texel, mostly cancelling
  EXPECT_GT(spread, 0.01);
}

}  // namespace
}  // namespace gnomon::test

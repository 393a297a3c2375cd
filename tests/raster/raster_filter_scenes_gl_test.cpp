// Filters where something particular is to be seen: light bleeding, the edges of a cube map, what a blur
// conserves and costs.
#include "raster/passes/light_block.h"
#include "raster/passes/moment_pass.h"
#include "shaders/shared_constants.h"
#include "tests/raster/raster_filter_reference.h"

namespace gnomon::test {
namespace {

using raster::Technique;

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
  const std::uint64_t texels = std::uint64_t{128} * 128;
  EXPECT_EQ(hard.frame.map_texels, texels);
  EXPECT_EQ(hard.frame.map_bytes, 4 * texels);
  EXPECT_EQ(vsm.frame.map_texels, 4 * texels);
  EXPECT_EQ(vsm.frame.map_bytes, 4 * texels + 2 * (8 * texels));
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
    EXPECT_TRUE(map_->prepare(view_, options.depth_format).has_value());
    EXPECT_TRUE(map_->draw(*buffers_, view_, options.cull).has_value());
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

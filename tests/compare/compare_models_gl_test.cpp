// The whole chain on real models: everything loads, compares and adds up; the bunny's acne is called acne;
// the truth agrees with Embree; nothing depends on the number of threads.
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>
#include <random>

#include "compare/result/outputs.h"
#include "scene/load.h"
#include "tests/support/compare_support.h"
#include "tests/support/embree.h"
#include "tests/support/model_files.h"

namespace gnomon::test {
namespace {

using compare::Label;

std::uint64_t count(const compare::LightComparison& light, Label label) {
  return light.classes[static_cast<std::size_t>(label) - 1];
}

Scene load(const std::string& path) {
  auto scene = load_scene(path);
  if (!scene) ADD_FAILURE() << scene.error().message();
  return scene.value_or(Scene{});
}

TEST(Models, EveryOneLoadsComparesAndAddsUp) {
  if (data_is_absent()) GTEST_SKIP() << "no models in " << data_folder();
  const std::vector<std::string> files = well_formed_models();
  ASSERT_GT(files.size(), 40u);
  for (const std::string& file : files) {
    auto scene = load_scene(file);
    if (!scene) {  // a model without triangles says so; anything else is a failure
      EXPECT_NE(scene.error().message().find("triangle"), std::string::npos) << scene.error().message();
      std::printf("  %-48s %s\n", std::filesystem::path(file).filename().c_str(),
                  scene.error().reason.c_str());
      continue;
    }
    compare::CompareOptions options = test_options({320, 180}, 256);
    options.perceptual = true;  // whatever a comparison can work out
    const Compared run = run_comparison(std::move(*scene), options);
    ASSERT_FALSE(run.result.lights.empty()) << file;
    for (const auto& light : run.result.lights) {
      std::uint64_t classes = 0;
      for (const std::uint64_t c : light.classes) classes += c;
      EXPECT_EQ(classes, light.error.wrong) << file;
      double steps = 0.0;
      for (const auto& step : light.budget) steps += step.signed_mean;
      const double missed_less_false = double(light.error.missed_shadow) - double(light.error.false_shadow);
      if (light.pixels.compared > 0) {
        EXPECT_NEAR(steps, missed_less_false / double(light.pixels.compared), 1e-9) << file;
      }
      EXPECT_LE(light.pixels.uncertain, light.pixels.total / 1000) << file;
    }
    const auto& first = run.light();
    std::printf("  %-48s %8u triangles  compared %6llu  wrong %6.2f %%  silhouette %llu\n",
                std::filesystem::path(file).filename().c_str(), run.world->triangle_count(),
                static_cast<unsigned long long>(first.pixels.compared), 100.0 * first.error.wrong_fraction,
                static_cast<unsigned long long>(first.pixels.silhouette));
  }
}

// With bias 0 a curved, finely tessellated surface is full of acne; charging it to sampling (aliasing) is the
// classic mistake that sheets prevent. What sampling is left must be balanced between false and missed
// shadow, as chance has it.
TEST(Bunny, FalseShadowInsideTheLitBodyIsAcne) {
  const std::string path = (data_folder() / "common_organic/stanford-bunny.obj").string();
  if (data_is_absent()) GTEST_SKIP() << "no models in " << data_folder();
  const Scene scene = load(path);
  for (const int size : {64, 128, 256, 512, 1024}) {
    const Compared run = run_comparison(scene, test_options({1280, 720}, size));
    const auto& light = run.light();
    std::uint64_t sampling_false = 0;
    std::uint64_t sampling_missed = 0;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
      if (!compare::is_compared(light.labels.data[i])) continue;
      sampling_false += light.rungs[2].data[i] < light.rungs[1].data[i];
      sampling_missed += light.rungs[2].data[i] > light.rungs[1].data[i];
    }
    const auto compared = double(light.pixels.compared);
    const double share_false = double(sampling_false) / compared;
    const double share_missed = double(sampling_missed) / compared;
    std::printf("  map %4d  acne %.4f  aliasing %.4f  sampling: false %.5f missed %.5f\n", size,
                double(count(light, Label::acne)) / compared,
                double(count(light, Label::aliasing)) / compared, share_false, share_missed);
    EXPECT_GT(count(light, Label::acne), 20 * count(light, Label::aliasing));
    if (size == 1024) {
      EXPECT_NEAR(share_false, share_missed, 2e-4);
    }
  }
}

// Embree in robust mode, single precision: an independent program's word on each compared pixel.
class EmbreeTruth {
 public:
  explicit EmbreeTruth(const World& world)
      : world_(world), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | test::filter_by_query);
    RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), world.vertex_count()));
    for (const Vec3& p : positions_of(world))
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(p[k]);
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), world.triangle_count()));
    for (const auto& t : triangles_of(world))
      for (const std::uint32_t v : t) *indices++ = v;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_);
  }
  ~EmbreeTruth() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeTruth(const EmbreeTruth&) = delete;
  EmbreeTruth& operator=(const EmbreeTruth&) = delete;

  bool shadowed(const Vec3& from, const Vec3& direction, double distance, std::uint32_t own) const {
    struct Query {
      test::EmbreeQuery base;
      std::uint32_t own;
    };
    Query query{test::EmbreeQuery(false,
                                  [](const RTCFilterFunctionNArguments* a) {
                                    const auto* asked = reinterpret_cast<const Query*>(a->context);
                                    if (RTCHitN_primID(a->hit, a->N, 0) == asked->own) a->valid[0] = 0;
                                  }),
                own};
    const double scale = world_.finite_bounds.diagonal();
    RTCRay ray{};
    ray.org_x = float(from.x), ray.org_y = float(from.y), ray.org_z = float(from.z);
    ray.dir_x = float(direction.x), ray.dir_y = float(direction.y), ray.dir_z = float(direction.z);
    ray.tnear = static_cast<float>(1e-6 * scale);
    ray.tfar = std::isfinite(distance) ? static_cast<float>(distance * (1.0 - 1e-6))
                                       : std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
    test::embree_occluded(scene_, query.base, ray);
    return ray.tfar < 0.0f;
  }

 private:
  const World& world_;
  RTCDevice device_;
  RTCScene scene_;
};

// A difference is explained when moving the ray by single-precision rounding makes Embree agree.
bool explained_by_rounding(const EmbreeTruth& embree, const Vec3& from, const Vec3& direction,
                           double distance, std::uint32_t own, bool ours, double scale) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-1.0, 1.0);
  for (int i = 0; i < 256; ++i) {
    const Vec3 moved = from + 2e-6 * scale * Vec3{jitter(random), jitter(random), jitter(random)};
    const Vec3 turned = direction + 5e-7 * Vec3{jitter(random), jitter(random), jitter(random)};
    if (embree.shadowed(moved, turned, distance, own) == ours) return true;
  }
  return false;
}

void expect_embree_agrees(const Scene& scene) {
  const Compared run = run_comparison(scene, test_options({1280, 720}, 256));
  const EmbreeTruth embree(*run.world);
  for (const auto& light : run.result.lights) {
    const Light& source = run.scene->lights[light.light];
    std::uint64_t differs = 0;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
      if (!compare::is_compared(light.labels.data[i])) continue;
      const auto& x = run.result.raytraced.receiver.data[i];
      const LightAtPoint at = light_at(source, x.position);
      const bool ours = light.rungs[0].data[i] < 0.5f;
      // The ground plane is not in Embree's scene: it is convex to all that stands on it and hides nothing
      // from a light above.
      if (embree.shadowed(x.position, at.to_light, at.distance, x.primitive) == ours) continue;
      ++differs;
      EXPECT_TRUE(explained_by_rounding(embree, x.position, at.to_light, at.distance, x.primitive, ours,
                                        run.world->finite_bounds.diagonal()))
          << scene.name << " pixel " << i % 1280 << ", " << i / 1280 << " light " << source.name;
    }
    std::printf("  %-24s %-8s compared %llu differ %llu\n", scene.name.c_str(), source.name.c_str(),
                static_cast<unsigned long long>(light.pixels.compared),
                static_cast<unsigned long long>(differs));
    EXPECT_LE(double(differs), 1e-5 * double(light.pixels.compared));
  }
}

TEST(Truth, AgreesWithEmbreeOnTheBuiltInScenes) {
  for (const char* name : {"fence", "courtyard"}) expect_embree_agrees(load(name));
}

TEST(Truth, AgreesWithEmbreeOnRealModels) {
  if (data_is_absent()) GTEST_SKIP() << "no models in " << data_folder();
  for (const char* name : {"common_organic/stanford-bunny.obj", "libigl_armadillo/armadillo.obj"})
    expect_embree_agrees(load((data_folder() / name).string()));
}

// result.json without what may differ between two runs: times, and the number of threads asked for.
nlohmann::json timeless(const std::string& text) {
  nlohmann::json json = nlohmann::json::parse(text);
  json.erase("times_ms");
  json.erase("threads");
  json.erase("peak_memory_bytes");
  for (auto& light : json["lights"]) light.erase("times_ms");
  return json;
}

compare::Comparison compared_with_threads(const Scene& scene, int threads, std::string& json) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  compare::CompareOptions options = test_options({640, 360}, 512);
  options.raytrace.picture = options.perceptual = true;
  Compared run = run_comparison(scene, options);
  json = compare::result_json(run.result);
  return std::move(run.result);
}

TEST(Threads, DoNotChangeAnything) {
  for (const char* name : {"whitted", "fence"}) {
    const Scene scene = load(name);
    std::string json_one, json_two;
    const auto one = compared_with_threads(scene, 1, json_one);
    const auto two = compared_with_threads(scene, 2, json_two);
    ASSERT_EQ(one.lights.size(), two.lights.size());
    EXPECT_EQ(timeless(json_one), timeless(json_two));
    EXPECT_EQ(one.raytraced.color.data, two.raytraced.color.data);
    EXPECT_EQ(one.raster.color.data, two.raster.color.data);
    for (std::size_t i = 0; i < one.lights.size(); ++i) {
      EXPECT_EQ(one.lights[i].labels.data, two.lights[i].labels.data);
      for (std::size_t k = 0; k < compare::rung_count; ++k)
        EXPECT_EQ(one.lights[i].rungs[k].data, two.lights[i].rungs[k].data);
      EXPECT_EQ(one.lights[i].edges.rms_texels, two.lights[i].edges.rms_texels);
      EXPECT_GT(one.lights[i].error.flip, 0.0);
      EXPECT_EQ(one.lights[i].error.flip, two.lights[i].error.flip);
    }
  }
}

}  // namespace
}  // namespace gnomon::test

// gnomon judge on what most people have first: two screenshots, with ambient light, a sky, a tone curve and eight bits, whose
// shadow errors are known; and on pictures of a ray tracer, whose rays start in the wrong place.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "compare/result/judged.h"
#include "scene/files/pictures/image_io.h"
#include "tests/support/capture_support.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Label;
using judge::Capture;
using raytrace::SurfacePoint;

// ---- two screenshots ----

/// How a viewer shows a scene. Light is in multiples of a surface that faces the judged light squarely.
struct Look {
  Vec3f sky{0.4f, 0.5f, 0.7f};
  Vec3f ambient{0.3f}, from_below{0.3f};  ///< of surfaces that face up, and down
  float highlight = 0.0f;
  std::function<float(float)> curve = [](float v) { return v; };
  bool eight_bits = false;
  int noise = 0;     ///< steps of eight bits, at most, either way
  Vec3f with{0.0f};  ///< other light in the picture with shadows alone
};

float after_reinhard_and_srgb(float v) {
  return srgb_from_linear(v / (1.0f + v));
}

/// A checkered surface.
Vec3f albedo_at(const SurfacePoint& point) {
  const Vec3 at = glm::floor(1.7 * point.position);
  const bool odd = std::fmod(std::abs(at.x + at.y + at.z), 2.0) > 0.5;
  return odd ? Vec3f(0.8f, 0.75f, 0.7f) : Vec3f(0.35f, 0.4f, 0.3f);
}

struct Shot {
  Vec3f shadowed, unshadowed;
};

Shot shown(const Compared& drawn, const Look& look, std::size_t i) {
  const SurfacePoint& point = drawn.result.raytraced.receiver.data[i];
  if (point.primitive == no_id) return {look.sky, look.sky};
  const Light& light = drawn.scene->lights[drawn.light().light];
  const LightAtPoint at = light_at(light, point.position);
  const bool reached = !light_cannot_reach(light, point.position, point.normal);
  const Vec3f own =
      reached ? Vec3f(at.irradiance) * static_cast<float>(glm::dot(point.normal, at.to_light)) : Vec3f(0.0f);
  const auto up = static_cast<float>(0.5 + 0.5 * point.normal.y);
  const Vec3f rest = glm::mix(look.from_below, look.ambient, up);
  const Vec3 half = glm::normalize(at.to_light + glm::normalize(drawn.scene->camera.eye - point.position));
  const float shine =
      look.highlight * static_cast<float>(std::pow(std::max(0.0, glm::dot(half, point.normal)), 40.0));
  const float seen = drawn.result.raster.lights[0].visibility.data[i];
  const Vec3f albedo = albedo_at(point), direct = albedo * own + (reached ? shine : 0.0f) * own;
  return {albedo * (rest + look.with) + seen * direct, albedo * rest + direct};
}

/// The brightest light that a pixel gets, by which pictures are exposed.
double exposure_of(const Compared& drawn) {
  double most = 1e-9;
  const Light& light = drawn.scene->lights[drawn.light().light];
  for (const SurfacePoint& point : drawn.result.raytraced.receiver.data)
    if (point.primitive != no_id) most = std::max(most, double{light_at(light, point.position).irradiance.x});
  return 1.0 / most;
}

void write_shot(const std::string& stem, ImageSize size, const std::vector<Vec3f>& pixels, const Look& look,
                std::string& file) {
  std::uint32_t state = 7;
  const auto noise = [&] {
    state = state * 1664525u + 1013904223u;
    return look.noise == 0 ? 0 : int((state >> 20) % unsigned(2 * look.noise + 1)) - look.noise;
  };
  Rgb8Image png(size);
  std::vector<Channel> channels{{"R", {}}, {"G", {}}, {"B", {}}};
  for (std::size_t i = 0; i < pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float v = look.curve(std::max(0.0f, pixels[i][c]));
      channels[std::size_t(c)].values.push_back(v);
      png.data[i][c] = static_cast<std::uint8_t>(std::clamp(int(to_8_bit(v)) + noise(), 0, 255));
    }
  file = stem + (look.eight_bits ? ".png" : ".exr");
  const auto written = look.eight_bits ? write_png(file, png) : write_exr(file, size, channels);
  ASSERT_TRUE(written) << written.error().message();
}

Capture screenshots(const Compared& drawn, const std::string& name, const Look& look) {
  const std::string folder = folder_for(name);
  Capture out = self_capture(drawn, folder, {.positions = false, .ratio = true});
  const auto exposure = static_cast<float>(exposure_of(drawn));
  std::vector<Vec3f> with, without;
  for (std::size_t i = 0; i < drawn.result.raytraced.receiver.data.size(); ++i) {
    Look exposed = look;
    const bool sky = drawn.result.raytraced.receiver.data[i].primitive == no_id;
    exposed.ambient /= exposure, exposed.from_below /= exposure, exposed.with /= exposure;
    const Shot shot = shown(drawn, exposed, i);
    with.push_back(sky ? look.sky : exposure * shot.shadowed);
    without.push_back(sky ? look.sky : exposure * shot.unshadowed);
  }
  write_shot(folder + "/shadowed", out.size, with, look, out.shadowed);
  write_shot(folder + "/unshadowed", out.size, without, look, out.unshadowed);
  return out;
}

/// Judges screenshots of what was drawn, and finds the errors that are in it. `slack`: pixels, as a share of the compared ones.
void expect_judged(const Compared& drawn, const std::string& name, const Look& look, double slack = 0.003) {
  const JudgeOutcome judged = judge(screenshots(drawn, name, look), *drawn.scene);
  ASSERT_TRUE(judged.result) << name << ": " << reason(judged);
  const compare::LightComparison &own = drawn.light(), &its = judged.result->lights[0];
  ASSERT_TRUE(judged.result->judged->other_light) << name;
  EXPECT_GT(judged.result->judged->other_light->agree, 0.8) << name;
  EXPECT_GT(its.pixels.compared, 0.97 * double(own.pixels.compared)) << name;
  const double allowed = slack * double(own.pixels.compared);
  EXPECT_NEAR(double(own.error.false_shadow), double(its.error.false_shadow), allowed) << name;
  EXPECT_NEAR(double(own.error.missed_shadow), double(its.error.missed_shadow), allowed) << name;
  EXPECT_TRUE(std::ranges::any_of(judged.result->judged->notes, [](const std::string& note) {
    return note.find("both pictures hold other light") != std::string::npos;
  })) << name;
}

Compared sunny() {
  return draw_scene(scene_under("sun"), small_picture, hard_map(128));
}

TEST(TwoScreenshots, WithAmbientLightAndASkyAreJudged) {
  const Compared drawn = sunny();
  for (const float ambient : {0.05f, 0.3f, 1.0f})
    expect_judged(drawn, "ambient", {.ambient = Vec3f(ambient), .from_below = Vec3f(ambient)});
  expect_judged(drawn, "black-sky", {.sky = Vec3f(0.0f)});
}

TEST(TwoScreenshots, OfEightBitsWithAnyToneCurveAreJudged) {
  const Compared drawn = sunny();
  Look look{.ambient = Vec3f(0.1f, 0.15f, 0.4f), .from_below = Vec3f(0.1f, 0.15f, 0.4f), .eight_bits = true};
  look.curve = srgb_from_linear;
  expect_judged(drawn, "srgb", look);
  look.curve = after_reinhard_and_srgb;
  expect_judged(drawn, "reinhard", look);
  look.noise = 2;
  expect_judged(drawn, "noise", look, 0.01);
}

TEST(TwoScreenshots, WithLightFromAboveAndBelowAndHighlightsAreJudged) {
  const Compared drawn = sunny();
  Look look{.ambient = Vec3f(0.4f, 0.45f, 0.5f), .from_below = Vec3f(0.1f, 0.08f, 0.05f)};
  look.curve = srgb_from_linear, look.eight_bits = true;
  expect_judged(drawn, "hemisphere", look);
  look.highlight = 0.6f;
  expect_judged(drawn, "highlight", look);
}

// What a full shadow takes changes from place to place.
TEST(TwoScreenshots, OfLampsAreJudged) {
  for (const std::string light : {"lamp", "bulb"}) {
    const Compared drawn = draw_scene(scene_under(light), small_picture, hard_map(128));
    Look look{
        .ambient = Vec3f(0.2f), .from_below = Vec3f(0.2f), .curve = srgb_from_linear, .eight_bits = true};
    expect_judged(drawn, light, look, 0.01);
  }
}

TEST(TwoScreenshots, OfThisLightAloneAreReadAsBefore) {
  const Compared drawn = sunny();
  const JudgeOutcome judged =
      judge(self_capture(drawn, folder_for("alone"), {.positions = false, .ratio = true}), *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  EXPECT_FALSE(judged.result->judged->other_light);
}

TEST(TwoScreenshots, OfAnotherViewAreRefusedForThatReason) {
  const Compared drawn = sunny();
  const Capture capture = screenshots(drawn, "turned", {});
  for (const std::string* file : {&capture.shadowed, &capture.unshadowed})
    spoil(*file, [&](ChannelImage& image) {
      for (Channel& channel : image.channels) {
        const auto w = static_cast<std::ptrdiff_t>(image.size.width);
        for (std::ptrdiff_t y = 0; y < image.size.height / 2; ++y)
          std::swap_ranges(channel.values.begin() + y * w, channel.values.begin() + (y + 1) * w,
                           channel.values.begin() + (image.size.height - 1 - y) * w);
      }
    });
  EXPECT_NE(reason(judge(capture, *drawn.scene)).find("the picture is upside down"), std::string::npos)
      << reason(judge(capture, *drawn.scene));
  judge::JudgeOptions fixing;
  fixing.fix = true;
  EXPECT_TRUE(judge(capture, *drawn.scene, fixing).result);
  // A little to the side: no convention explains it, and none is named.
  Scene moved = *drawn.scene;
  const Vec3 ahead = moved.camera.target - moved.camera.eye;
  moved.camera.target += 0.12 * glm::length(ahead) * glm::normalize(glm::cross(ahead, moved.camera.up));
  const std::string why = reason(judge(screenshots(drawn, "beside", {}), moved));
  EXPECT_NE(why.find("is it this scene, seen from this camera?"), std::string::npos) << why;
  EXPECT_EQ(why.find("centimetres"), std::string::npos) << why;
}

// Every pixel that differs does so by another share: nothing says which is full shadow.
TEST(TwoScreenshots, WithoutAFullShadowAreRefused) {
  const Compared drawn = sunny();
  const Capture capture = screenshots(drawn, "grey", {});
  const auto unshadowed = read_channels(capture.unshadowed);
  ASSERT_TRUE(unshadowed);
  spoil(capture.shadowed, [&](ChannelImage& image) {
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      for (std::size_t i = 0; i < image.channels[c].values.size(); ++i) {
        const float u = unshadowed->channels[c].values[i], s = image.channels[c].values[i];
        const float share = 0.05f + 0.95f * float((i * 2654435761u >> 7) % 1000) / 1000.0f;
        image.channels[c].values[i] = u - share * (u - s);
      }
  });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  EXPECT_NE(reason(judged).find("how dark a full shadow is does not show"), std::string::npos)
      << reason(judged) << (judged.result ? judged.result->judged->other_light->agree : 0.0);
}

// ---- a ray tracer ----

/// Turned, so that no surface lies on numbers that 32 bits hold, and far from the origin, where such places are thousandths
/// apart.
Scene far_away() {
  const Vec3 by(100000.0, 0.0, -60000.0);
  const Mat3 turn(glm::rotate(Mat4(1.0), 0.4, glm::normalize(Vec3(1.0, 0.3, 0.2))));
  Scene scene = scene_under("sun");
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = turn * p + by;
  scene.lights[0].direction = turn * scene.lights[0].direction;
  scene.camera.eye = turn * scene.camera.eye + by, scene.camera.target = turn * scene.camera.target + by;
  scene.camera.up = turn * scene.camera.up;
  return scene;
}

/// A plate close above a floor, beside a box on it.
Scene with_plate() {
  Scene scene = sunlit_scene({floor_mesh(4, 4), box_mesh({-0.5, 0.0, -0.5}, {0.5, 0.8, 0.5}),
                              box_mesh({-1.6, 0.05, 0.0}, {-0.7, 0.1, 1.2})},
                             {0.7, -1.0, 0.3});
  scene.camera = {{2.5, 3.0, 4.0}, {0.2, 0.2, 0}, {0, 1, 0}, 0.7};
  return scene;
}

/// Truth, and the shadow of a surface on itself where the receiver's place of 32 bits, moved by `offset` along the normal, lies
/// below it by more than a thousandth along the ray.
Capture traced(const Compared& drawn, const std::string& name, double offset, double skipped = 0.0) {
  Capture out = self_capture(drawn, folder_for(name), {.positions = false});
  out.kind = judge::RendererKind::ray_tracer;
  const Light& light = drawn.scene->lights[drawn.light().light];
  const raytrace::Tracer tracer(*drawn.world, raytrace::Accel::bvh);
  spoil(out.visibility, [&](ChannelImage& image) {
    for (std::size_t i = 0; i < image.channels[0].values.size(); ++i) {
      const SurfacePoint& point = drawn.result.raytraced.receiver.data[i];
      float& v = image.channels[0].values[i];
      if (point.primitive == no_id) continue;
      const bool reached = !light_cannot_reach(light, point.position, point.normal);
      v = reached && tracer.centre_visibility(point, light) == raytrace::PointVisibility::lit ? 1.0f : 0.0f;
      const Vec3 to_light = light_at(light, point.position).to_light;
      const Vec3 place = Vec3(Vec3f(point.position)) + offset * point.normal;
      const double below = -glm::dot(place - point.position, point.normal);
      if (below / std::max(1e-6, glm::dot(point.normal, to_light)) > 1e-3) v = 0.0f;
      if (skipped <= 0.0 || !reached || v > 0.0f) continue;
      Ray ray = tracer.shadow_ray(point, light);
      ray.t.min = skipped;
      if (!tracer.occluded(ray)) v = 1.0f;
    }
  });
  return out;
}

std::uint64_t labelled(const compare::Comparison& c, Label label) {
  return c.lights[0].classes[static_cast<std::size_t>(label) - 1];
}

TEST(RayTracers, SelfIntersectionIsNamedAndTheOffsetCuresIt) {
  const Compared drawn = draw_scene(far_away(), small_picture, hard_map(64));
  const JudgeOutcome judged = judge(traced(drawn, "rays", 0.0), *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::Comparison& c = *judged.result;
  ASSERT_GT(c.lights[0].error.wrong, 100u) << c.lights[0].pixels.compared;
  EXPECT_GT(double(labelled(c, Label::acne)), 0.95 * double(c.lights[0].error.wrong));
  std::string notes;
  for (const std::string& note : c.judged->notes) notes += note + '\n';
  EXPECT_NE(notes.find("self-intersection"), std::string::npos) << notes;
  EXPECT_NE(notes.find("places of 32 bits are 0.0078 apart"), std::string::npos) << notes;
  double offset = 0.0;
  ASSERT_EQ(std::sscanf(c.judged->cure.c_str(), "Start shadow rays %lf off", &offset), 1) << c.judged->cure;
  const JudgeOutcome cured = judge(traced(drawn, "rays", offset), *drawn.scene);
  ASSERT_TRUE(cured.result) << reason(cured);
  EXPECT_EQ(cured.result->lights[0].error.wrong, 0u) << "offset " << offset;
}

TEST(RayTracers, AnOffsetBeyondTheCasterIsNamed) {
  const Compared drawn = draw_scene(with_plate(), small_picture, hard_map(64));
  const double skipped = 0.35;
  const JudgeOutcome judged = judge(traced(drawn, "skipped", 0.0, skipped), *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  const compare::Comparison& c = *judged.result;
  ASSERT_GT(c.lights[0].error.wrong, 20u);
  EXPECT_GT(double(labelled(c, Label::peter_panning)), 0.95 * double(c.lights[0].error.wrong));
}

// A shadow that lies elsewhere is no noise of rounding.
TEST(RayTracers, AShadowOfSomethingElseStaysUnexplained) {
  const Compared drawn = draw_scene(scene_under("sun"), small_picture, hard_map(64));
  const Capture capture = traced(drawn, "patch", 0.0);
  spoil(capture.visibility, [](ChannelImage& image) {
    for (int y = 60; y < 100; ++y)
      for (int x = 20; x < 70; ++x)
        image.channels[0].values[std::size_t(y) * std::size_t(image.size.width) + std::size_t(x)] = 0.0f;
  });
  const JudgeOutcome judged = judge(capture, *drawn.scene);
  ASSERT_TRUE(judged.result) << reason(judged);
  ASSERT_GT(judged.result->lights[0].error.wrong, 100u);
  EXPECT_EQ(labelled(*judged.result, Label::acne), 0u);
  EXPECT_EQ(judged.result->judged->cure, "");
}

}  // namespace
}  // namespace gnomon::test

// A comparison made by hand, in which every label occurs, for the tests of what is written about comparisons.
// The ladder of each pixel follows its label; every statistic is counted from the pixels here, apart from the
// engine's own code.
#pragma once

#include <cmath>
#include <memory>

#include "compare/comparison.h"
#include "compare/ladder/budget.h"

namespace gnomon::compare {

struct Synthetic {
  Scene scene;
  World world;
  Comparison comparison;
};

/// V0 … V6 of a pixel with this label; `lit` is the truth where the label leaves it open.
inline std::array<float, rung_count> synthetic_ladder(Label label, bool lit) {
  const float v = lit ? 1.0f : 0.0f, w = 1.0f - v;
  switch (label) {
    case Label::acne:
      return {1, 1, 1, 0, 0, 0, 0};
    case Label::stored_depth:
      return {v, v, v, v, w, w, w};
    case Label::peter_panning:
    case Label::light_leak:
      return {0, 0, 0, 0, 0, 1, 1};
    case Label::aliasing:
    case Label::outside_map:
      return {v, v, w, w, w, w, w};
    case Label::missed_feature:
      return {0, 0, 1, 1, 1, 1, 1};
    case Label::false_feature:
      return {1, 1, 0, 0, 0, 0, 0};
    case Label::blur:
      return {v, v, v, v, v, v, lit ? 0.25f : 0.75f};
    case Label::light_size:
      return {v, w, w, w, w, w, w};
    case Label::custom_shader:
      return {v, v, v, v, v, v, w};
    case Label::unexplained:
      return {v, v, w, w, w, w, w};
    default:
      return {v, v, v, v, v, v, v};
  }
}

namespace synthetic {

inline constexpr ImageSize image_size{320, 180};
inline constexpr int map_size = 64;

inline bool in_ellipse(int x, int y, double cx, double cy, double rx, double ry) {
  return std::pow((x - cx) / rx, 2) + std::pow((y - cy) / ry, 2) < 1.0;
}

// Sky above, a ball with a dark lower half and a silhouette, its shadow, ten hatched patches of wrong pixels
// in front and one to the left, a few uncertain pixels along the shadow's edge.
inline Label label_at(int x, int y) {
  if (in_ellipse(x, y, 150, 70, 36, 36))
    return !in_ellipse(x, y, 150, 70, 34, 34) ? Label::silhouette
           : y > 76                           ? Label::facing_away
                                              : Label::right;
  if (y < 54) return Label::background;
  if (y >= 120 && y < 170 && x >= 10 && x < 310) {
    const int patch = (x - 10) / 30, within_x = (x - 10) % 30;
    if (within_x < 24 && (x + y) % (patch + 2) == 0) return static_cast<Label>(patch + 1);
  }
  if (y >= 90 && y < 110 && x >= 10 && x < 34 && (x + y) % 12 == 0) return Label::custom_shader;
  if (in_ellipse(x, y, 196, 98, 50, 16) != in_ellipse(x, y, 196, 98, 50.4, 16.4)) return Label::uncertain;
  return Label::right;
}

inline Scene make_scene(int lights) {
  Scene scene;
  scene.name = "ball & <floor>";
  scene.path = "scenes/ball.json";
  scene.sha256 = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08";
  scene.notes = {"The file names no camera: one was placed so that everything is in view.",
                 "Texture 'a<b' was not found."};
  scene.materials.push_back({});
  scene.shapes.push_back({"floor", Plane{}, 0});
  scene.shapes.push_back({"ball", Sphere{}, 0});
  Light sun;
  sun.name = "sun";
  sun.direction = glm::normalize(Vec3(0.6, -0.7, -0.3));
  scene.lights.push_back(sun);
  Light lamp;
  lamp.name = "lamp / 2";
  lamp.type = LightType::point;
  lamp.position = Vec3(1, 2, 3);
  for (int i = 1; i < lights; ++i) scene.lights.push_back(lamp);
  return scene;
}

inline raster::ShadowMap make_map(const Light& light) {
  raster::ShadowMap map;
  const bool point = light.type == LightType::point;
  map.view.projection = point ? LightProjection::perspective : LightProjection::orthographic;
  map.view.size = map_size;
  map.view.face_count = point ? 6 : 1;
  LightFace down;
  down.right = Vec3(1, 0, 0), down.up = Vec3(0, 0, -1), down.forward = Vec3(0, -1, 0);
  map.view.faces.fill(down);
  map.view.origin = Vec3(160, 5.5, 90);
  map.view.set_extent(point ? Vec2(1.0) : Vec2(160.0), 1.0, 11.0);
  const auto texels = static_cast<std::size_t>(map.view.face_count) * map_size * map_size;
  map.depth.assign(texels, 1.0f);
  for (int face = 0; face < map.view.face_count; ++face)
    for (int row = 0; row < map_size; ++row)
      for (int column = 0; column < map_size; ++column)
        if (row > face * 4) {
          const bool ball = in_ellipse(column, row, 30, 34, 12, 12);
          map.depth[map.texel_index(face, column, row)] =
              ball ? 0.25f : 0.6f + 0.004f * static_cast<float>(row);
        }
  return map;
}

/// In the order of the labels from acne on: slope, precision, bias, bias, sampling thrice, filter, light
/// size, outside the map (sampling), filter.
inline std::size_t blamed_step(Label label) {
  constexpr std::array<std::size_t, class_count> steps{2, 3, 4, 4, 1, 1, 1, 5, 0, 1, 5};
  return steps[static_cast<std::size_t>(label) - 1];
}

inline void count(LightComparison& light) {
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    const Label label = light.labels.data[i];
    ++light.pixels.total;
    light.pixels.background += label == Label::background;
    light.pixels.facing_away += label == Label::facing_away;
    light.pixels.silhouette += label == Label::silhouette;
    light.pixels.uncertain += label == Label::uncertain;
    if (!is_compared(label)) continue;
    ++light.pixels.compared;
    const double error = double{light.rungs[6].data[i]} - double{light.rungs[0].data[i]};
    light.error.mean_absolute += std::abs(error);
    light.error.rms += error * error;
    light.error.false_shadow += error < -0.5;
    light.error.missed_shadow += error > 0.5;
    light.error.ties += std::abs(error) == 0.5;
    const auto between = [](float v) { return v > 0.0f && v < 1.0f; };
    light.error.fractional += between(light.rungs[6].data[i]) || between(light.rungs[0].data[i]);
    for (std::size_t k = 0; k < rung_count; ++k) light.rung_mean[k] += double{light.rungs[k].data[i]};
    for (std::size_t k = 0; k < cause_count; ++k) {
      const double step = double{light.rungs[k + 1].data[i]} - double{light.rungs[k].data[i]};
      light.budget[k].signed_mean += step;
      light.budget[k].absolute_mean += std::abs(step);
    }
    if (!has_cause(label)) continue;
    light.class_errors[static_cast<std::size_t>(label) - 1] += std::abs(error);
    if (!(std::abs(error) > 0.5)) continue;
    ++light.classes[static_cast<std::size_t>(label) - 1];
    BudgetStep& blamed = light.budget[blamed_step(label)];
    ++(error < 0.0 ? blamed.false_shadow : blamed.missed_shadow);
  }
  const auto n = static_cast<double>(light.pixels.compared);
  light.error.wrong = light.error.false_shadow + light.error.missed_shadow;
  light.error.wrong_fraction =
      (static_cast<double>(light.error.wrong) + 0.5 * static_cast<double>(light.error.ties)) / n;
  light.error.mean_absolute /= n;
  light.error.rms = std::sqrt(light.error.rms / n);
  for (double& mean : light.rung_mean) mean /= n;
  for (double& mean : light.class_errors) mean /= n;
  for (BudgetStep& step : light.budget) step.signed_mean /= n, step.absolute_mean /= n;
}

inline LightComparison make_light(std::uint32_t index) {
  LightComparison light;
  light.light = index;
  light.record = index;
  light.labels = Image<Label>(image_size);
  for (Image<float>& rung : light.rungs) rung = Image<float>(image_size, 1.0f);
  for (int y = 0; y < image_size.height; ++y)
    for (int x = 0; x < image_size.width; ++x) {
      const Label label = label_at(x, y);
      light.labels.at(x, y) = label;
      const bool lit = !in_ellipse(x, y, 196, 98, 50, 16) && (y < 145 || (x / 6) % 2 == 0);
      auto ladder = synthetic_ladder(label, lit);
      if (label == Label::right && lit && y >= 100 && (x + y) % 5 == 0)
        ladder[3] = ladder[4] = 0.0f;  // acne, cured
      for (std::size_t k = 0; k < rung_count; ++k)
        light.rungs[k].at(x, y) = label == Label::background ? 1.0f : ladder[k];
    }
  count(light);
  light.error.flip = 0.0421;
  light.error.ssim = 0.913;
  light.error.flip_compared = 0.0513;
  light.error.ssim_compared = 0.894;
  light.theory.acne_free_bias = {57000, 0.011, 0.019, 0.034, 0.21};
  light.theory.aliasing = light.theory.measured_aliasing = {57000, 0.8, 1.7, 2.9, 6.5};
  light.edges = {412, 0.31, 0.74, 1.9};
  light.detachment = {133, 0.021, 0.055};
  for (int i = 0; i <= 64; ++i) {
    const double bias = -0.02 + 0.0025 * i;
    const auto too_dark = static_cast<std::uint64_t>(9000.0 / (1.0 + std::exp(120.0 * (bias - 0.02)))),
               too_light = static_cast<std::uint64_t>(4000.0 / (1.0 + std::exp(-60.0 * (bias - 0.08))));
    light.bias_curve.push_back({bias, too_dark, too_light,
                                wrong_share(too_dark + too_light, light.error.ties, light.pixels.compared)});
  }
  light.best_bias = {0.045, 0.011, false, 0.093, 0.021, 213, 97};
  light.texel_world = {0.041, 0.052, 0.078};
  light.bias_texel_world = 0.052;
  light.classify.runs = {14.25};
  return light;
}

inline void make_frames(Comparison& c) {
  c.raster.context = {"osmesa", "4.5 (Core Profile) Mesa 22.3.6", "llvmpipe (LLVM 15.0.6, 256 bits)", 16384};
  c.raster.options.size = image_size;
  c.raster.options.map.size = map_size;
  c.raster.color = c.raytraced.color = ColorImage(image_size);
  c.raster.primitive = Image<std::uint32_t>(image_size, no_id);
  c.raytraced.receiver = Image<raytrace::SurfacePoint>(image_size);
  const LightComparison& first = c.lights.front();
  for (int y = 0; y < image_size.height; ++y)
    for (int x = 0; x < image_size.width; ++x) {
      const Label label = first.labels.at(x, y);
      const bool ball = in_ellipse(x, y, 150, 70, 36, 36);
      if (label == Label::background) {
        c.raster.color.at(x, y) = c.raytraced.color.at(x, y) = Vec3f(0.25f, 0.4f, 0.62f);
        continue;
      }
      const Vec3f albedo = ball ? Vec3f(0.7f, 0.3f, 0.2f) : Vec3f(0.55f, 0.52f, 0.47f);
      const float lit = label == Label::facing_away ? 0.0f : 1.0f;
      c.raster.color.at(x, y) = albedo * (0.12f + lit * 0.88f * first.rungs[6].at(x, y));
      c.raytraced.color.at(x, y) = albedo * (0.12f + lit * 0.88f * first.rungs[0].at(x, y));
      raytrace::SurfacePoint& point = c.raytraced.receiver.at(x, y);
      point.position = Vec3(x, 0.5, y);
      point.normal = Vec3(0, 1, 0);
      point.primitive = ball ? 1 : 0;
      c.raster.primitive.at(x, y) = point.primitive;
    }
}

inline void make_records(Comparison& c, const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    raster::LightRecord drawn;
    drawn.light = i;
    drawn.map = make_map(scene.lights[i]);
    drawn.bias_constant_world = 0.052;
    drawn.texel_world = 0.052;
    drawn.visibility = c.lights[i].rungs[6];
    drawn.texel_uv = Image<Vec2f>(image_size, Vec2f(3.25f, 7.5f));
    drawn.face = Image<std::uint8_t>(image_size, 0);
    drawn.distance = Image<float>(image_size, 5.0f);
    drawn.gap = Image<float>(image_size, 0.125f);
    drawn.gap.at(5, 60) = -std::numeric_limits<float>::infinity();
    drawn.map_pass.runs = {12.5, 11.0, 12.0};
    drawn.shade_pass.runs = {31.0, 30.0, 35.5};
    c.raster.lights.push_back(std::move(drawn));
    raytrace::LightTruth truth;
    truth.light = i;
    truth.shadow_rays.runs = {95.25};
    truth.rays = 41234;
    c.raytraced.lights.push_back(std::move(truth));
  }
}

}  // namespace synthetic

/// `lights`: the first a sun, the others point lights.
inline std::unique_ptr<Synthetic> make_synthetic(int lights = 1) {
  auto made = std::make_unique<Synthetic>();
  made->scene = synthetic::make_scene(lights);
  made->world = make_world(made->scene);
  Comparison& c = made->comparison;
  c.world = &made->world;
  c.command = "gnomon compare scenes/ball.json --map-size 64 --light 'a<b'";
  c.seed = 7;
  c.threads = 2;
  c.machine = {"Example CPU @ 2.0 GHz", "Linux 6.1", 2};
  c.plan = plan_effects(made->scene);
  for (std::uint32_t i = 0; i < made->scene.lights.size(); ++i) c.lights.push_back(synthetic::make_light(i));
  synthetic::make_frames(c);
  synthetic::make_records(c, made->scene);
  c.raster.map_texels = 4096;
  c.raster.map_bytes = 16384;
  c.raytraced.rays = {57600, 41234, 120, 60};
  c.raytraced.primary_rays.runs = {140.5};
  c.raytraced.picture_ms = 61.0;
  c.exposure = 1.1;
  c.load_ms = 3.5, c.raytraced.structure.runs = {8.25}, c.report_ms = 0.0, c.total_ms = 612.0;
  c.peak_memory_bytes = 187654321;
  return made;
}

/// A light for which no pixel can be compared.
inline void clear_comparison(LightComparison& light) {
  LightComparison empty;
  empty.light = light.light;
  empty.record = light.record;
  empty.rungs = light.rungs;
  empty.labels = Image<Label>(light.labels.size, Label::background);
  empty.error.flip = 0.0, empty.error.ssim = 1.0;  // two white pictures
  empty.pixels.total = empty.pixels.background = light.labels.data.size();
  light = std::move(empty);
}

}  // namespace gnomon::compare

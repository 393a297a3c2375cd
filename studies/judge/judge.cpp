#include "studies/judge/judge.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/base/stages.h"
#include "scene/exposure.h"
#include "studies/judge/advice.h"
#include "studies/judge/align.h"
#include "studies/judge/captured_frame.h"
#include "studies/judge/described_test.h"
#include "studies/judge/map_content.h"

namespace gnomon::compare {
namespace {

struct Judging {
  const Capture& capture;
  Scene& scene;
  const World& world;
  const JudgeOptions& options;
  std::uint32_t light;
  CapturedPictures pictures;
  Sight sight;
  Image<std::uint8_t> elsewhere;
  const LightView* map = nullptr;  ///< null: the capture has none
};

Expected<void> trace_truth(Judging& in, const raytrace::Tracer& tracer, const EffectPlan& plan,
                           Comparison& out) {
  raytrace::RaytraceOptions options = in.options.raytrace;
  options.size = in.capture.size;
  in.sight.view = make_view(in.scene.camera, in.capture.size);
  out.raytraced = raytrace::trace_frame(tracer, plan, in.scene.camera, {&in.light, 1}, options);
  auto judged = std::make_shared<Judged>(*out.judged);
  const auto aligned = align({in.capture, tracer, in.light, out.raytraced, in.options.fix, in.map}, in.scene,
                             in.sight, in.pictures, *judged);
  out.judged = judged;
  if (!aligned) return fail(aligned.error());
  if (aligned->trace_again)
    out.raytraced = raytrace::trace_frame(tracer, plan, in.scene.camera, {&in.light, 1}, options);
  in.elsewhere =
      retrace(tracer, in.sight, in.pictures, aligned->everywhere, options, out.raytraced).elsewhere;
  return {};
}

/// The share of the compared pixels whose test, as climbed, is what was drawn.
double biased_is_drawn(const LightComparison& light) {
  std::size_t same = 0, count = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!is_compared(light.labels.data[i])) continue;
    ++count;
    same += std::abs(light.rungs[5].data[i] - light.rungs[6].data[i]) <= 0.5f ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(same) / static_cast<double>(count) : 1.0;
}

/// Lengths in texels of a map that is not known.
void forget_texels(LightComparison& light) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  light.texel_world.fill(unknown);
  light.bias_texel_world = unknown;
  light.edges.mean_texels = light.edges.rms_texels = light.edges.mean_absolute_texels = unknown;
  light.theory = {};
}

Judged describe_capture(const Capture& capture) {
  Judged judged;
  judged.capture = capture.path;
  judged.renderer = capture.renderer, judged.version = capture.version;
  judged.settings = capture.settings;
  judged.has_map = !capture.map.empty();
  judged.has_positions = !capture.position.empty() || capture.depth.has_value();
  judged.of_ratio = capture.visibility.empty();
  return judged;
}

std::optional<std::uint32_t> place_of(const std::string& text, std::size_t count) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos || text.size() > 6)
    return std::nullopt;
  const auto place = static_cast<std::size_t>(std::stoul(text));
  if (place >= count) return std::nullopt;
  return static_cast<std::uint32_t>(place);
}

void finish(Judging& in, const raytrace::Tracer& tracer, Comparison& out) {
  auto judged = std::make_shared<Judged>(*out.judged);
  LightComparison& light = out.lights.front();
  if (judged->has_map) {
    const raster::LightRecord& record = out.raster.lights.front();
    judged->biased_is_drawn = biased_is_drawn(light);
    judged->unit_world = record.captured->test->unit_world;
    const FrameInput frame{in.capture,      in.pictures,   in.world,     tracer,
                           in.scene.camera, out.raytraced, in.elsewhere, out.exposure};
    const DescribedTest test = check_described_test(frame, out.raster, light);
    const auto other = test.is_drawn() ? std::nullopt : find_drawn_test(frame, out.raster, light);
    for (std::string& note : described_test_notes(test, other)) judged->notes.push_back(std::move(note));
    const MapContent content = label_map_content(frame, out.raster, light, advice_holds(test, other));
    for (std::string& note : map_content_notes(content, record)) judged->notes.push_back(std::move(note));
    for (std::string& note : outside_map_notes(frame, light, record))
      judged->notes.push_back(std::move(note));
    if (advice_holds(test, other) && !content.is_main_cause(light))
      judged->advice = give_advice(frame, out.raster.options.map.bias, light, record);
  }
  if (!judged->has_map) forget_texels(light);
  out.judged = std::move(judged);
}

}  // namespace

Expected<std::uint32_t> captured_light(const Capture& capture, const Scene& scene) {
  std::string names;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    if (scene.lights[i].name == capture.light) return i;
    names += (names.empty() ? "" : ", ") + scene.lights[i].name;
  }
  if (capture.light.empty() && scene.lights.size() == 1) return std::uint32_t{0};
  if (capture.light.empty())
    return capture_error(
        capture, "light",
        fmt::format("is missing; the scene has {} lights (allowed {})", scene.lights.size(), names));
  if (const auto place = place_of(capture.light, scene.lights.size())) return *place;
  return capture_error(capture, "light",
                       fmt::format("the scene has no such light (got {}, allowed {})", capture.light, names));
}

Expected<Comparison> judge_capture(const Capture& capture, Scene& scene, const World& world,
                                   const JudgeOptions& options, const Progress& progress) {
  const auto report = [&](std::string_view stage, double done) {
    if (progress) progress(stage, done);
  };
  if (const auto sound = check_capture(capture); !sound) return fail(sound.error());
  if (const auto sized = check_picture_sizes(capture); !sized) return fail(sized.error());
  const auto light = captured_light(capture, scene);
  if (!light) return fail(light.error());
  report("reading the capture", 0.0);
  TimedStage reading("read capture");
  auto pictures = read_pictures(capture, scene.camera.orthographic());
  if (!pictures) return fail(pictures.error());
  Judged judged = describe_capture(capture);
  if (const auto order = check_order(capture, scene.camera.orthographic(), options.fix, *pictures, judged);
      !order)
    return fail(order.error());
  std::optional<CapturedMap> map;
  if (!capture.map.empty()) {
    auto read = read_map(capture, scene.lights[*light], world);
    if (!read) return fail(read.error());
    map = std::move(*read);
  }
  reading.end();
  Comparison out;
  out.judged = std::make_shared<Judged>(std::move(judged));
  out.plan = plan_effects(scene);
  report("ray tracing", 0.2);
  const raytrace::Tracer tracer(world, options.accel, options.precision);
  Judging judging{
      capture, scene, world, options, *light, std::move(*pictures), {}, {}, map ? &map->map.view : nullptr};
  if (const auto traced = trace_truth(judging, tracer, out.plan, out); !traced) return fail(traced.error());
  out.exposure = scene.exposure ? *scene.exposure : auto_exposure(out.raytraced.color);
  report("comparing", 0.6);
  auto frame = make_frame({capture, judging.pictures, world, tracer, scene.camera, out.raytraced,
                           judging.elsewhere, out.exposure},
                          std::move(map));
  if (!frame) return fail(frame.error());
  out.raster = std::move(*frame);
  const Plan plan{.tracer = tracer,
                  .picture = capture.size,
                  .lights = {&*light, 1},
                  .measure = {.bias_curve_points = options.bias_curve_points}};
  if (const auto measured = measure_frames(out, plan); !measured) return fail(measured.error());
  finish(judging, tracer, out);
  report("compared", 1.0);
  return out;
}

}  // namespace gnomon::compare

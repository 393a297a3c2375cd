#include "judge/judge.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/engines.h"
#include "compare/result/number_text.h"
#include "judge/absent_caster.h"
#include "judge/advice.h"
#include "judge/align.h"
#include "judge/atlas_reads.h"
#include "judge/captured_frame.h"
#include "judge/caster_bias.h"
#include "judge/described_test.h"
#include "judge/far_triangles.h"
#include "judge/map_content.h"
#include "judge/other_light.h"
#include "judge/outside_map.h"
#include "judge/own_test.h"
#include "judge/stored_format.h"
#include "judge/traced_rays.h"
#include "judge/turned_map.h"
#include "scene/base/stages.h"
#include "scene/exposure.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::Comparison;
using compare::Judged;

struct Judging {
  Capture capture;  ///< in the scene's world
  Scene& scene;
  const World& world;
  const raytrace::Tracer& tracer;
  const JudgeOptions& options;
  std::uint32_t light;
  CapturedPictures pictures;
  std::optional<CapturedMap> map;
  std::optional<Error> matrices;  ///< what is wrong with the map's; it is not read yet then
  Sight sight{};
  Image<std::uint8_t> elsewhere{};
  CasterBiases casters{};
  MapFacts facts{};
  std::string doubt{};  ///< Aligned::doubt

  const LightView* view() const { return map ? &map->map.view : nullptr; }
};

FrameInput frame_input(const Judging& in, const Comparison& c) {
  return {in.capture,  in.pictures,  in.world,   in.tracer, in.scene.camera,
          c.raytraced, in.elsewhere, c.exposure, in.facts};
}

AlignInput align_input(const Judging& in, const Comparison& c) {
  return {in.capture, in.tracer, in.light, c.raytraced, in.options.fix, in.view()};
}

/// Receivers and truth of what the capture shows, as far as is known by now.
void trace_again(Judging& in, const raytrace::RaytraceOptions& options, const Aligned& aligned,
                 Comparison& out) {
  if (aligned.trace_again)
    out.raytraced = raytrace::trace_frame(in.tracer, out.plan, in.scene.camera, {&in.light, 1}, options);
  in.elsewhere =
      retrace(in.tracer, in.sight, in.pictures, aligned.everywhere, options, out.raytraced).elsewhere;
}

/// The map of another world than the scene's is read once it is known which: that of the positions, where its matrices are
/// the light's in it.
Expected<void> read_late_map(Judging& in, const Mat3& of_positions, const Comparison& c, Judged& judged) {
  const bool same = of_positions == Mat3(1.0);
  if (in.capture.map.empty() || (same && !in.matrices)) return {};
  const Light& light = in.scene.lights[in.light];
  Mat3 world = of_positions;
  if (same || !check_map_matrices(in_world_of_scene(in.capture, world), light, in.world)) {
    if (!in.matrices) return {};
    const auto found = align_map(align_input(in, c), *in.matrices, light, judged);
    if (!found) return fail(found.error());
    world = *found;
  }
  in.capture = in_world_of_scene(std::move(in.capture), world);
  auto map = read_map(in.capture, light, in.world);
  if (!map) return fail(map.error());
  in.map = std::move(*map);
  return {};
}

/// Says a strength that the capture does not, or says otherwise. `full_shadow`: what is left of it in the picture once what
/// the capture says is undone.
std::string strength_note(const std::optional<double>& said, double full_shadow) {
  const double strength = said.value_or(1.0) * (1.0 - full_shadow);
  if (said)
    return fmt::format(
        "`strength` is {:.3g} (got {:.3g}): full shadow is drawn as {:.3g}; judged is what the picture "
        "shows with that as 0",
        strength, *said, 1.0 - strength);
  return fmt::format(
      "full shadow is drawn as {:.3g}: a strength of {:.3g}, or light of something else; judged "
      "is what the picture shows "
      "with that as 0 (`strength` says so in a capture)",
      full_shadow, strength);
}

/// Undoes the strength that the capture says; a note where a part of the picture is darker than that allows.
void undo_strength(Judging& in, const raytrace::RayTracedFrame& traced, Judged& judged) {
  const Capture& capture = in.capture;
  Image<float>& visibility = in.pictures.visibility;
  if (!capture.strength) return;
  constexpr float one_value = 0.02f;
  constexpr std::size_t few = 50;
  const float full = static_cast<float>(1.0 - *capture.strength), least = full - one_value;
  const Light& light = in.scene.lights[in.light];
  std::vector<float> darker;
  for (std::size_t i = 0; i < visibility.data.size(); ++i) {
    const raytrace::SurfacePoint& point = traced.receiver.data[i];
    const bool reached = point.primitive != no_id && !light_cannot_reach(light, point.position, point.normal);
    if (reached && visibility.data[i] < least) darker.push_back(visibility.data[i]);
  }
  if (darker.size() >= few) {
    const auto middle = darker.begin() + static_cast<std::ptrdiff_t>(darker.size() / 2);
    std::nth_element(darker.begin(), middle, darker.end());
    judged.notes.push_back(fmt::format(
        "`strength` is more than {:.3g}: {} pixels are darker than {:.3g}, half of them than {:.3g}",
        *capture.strength, compare::grouped(darker.size()), double{full}, double{*middle}));
  }
  stretch_to_full_shadow(1.0 - *capture.strength, visibility);
}

/// Of a ratio that holds other light: the visibility that is in it. With a strength that the capture says the ratio is
/// enough.
Expected<void> undo_rest(Judging& in, const raytrace::RayTracedFrame& traced, Judged& judged) {
  if (!in.pictures.other_light || in.capture.strength) return {};
  const auto found = undo_other_light(in.capture, in.scene.lights[in.light], traced, in.pictures);
  if (!found) return fail(found.error());
  judged.other_light = *found;
  if (!judged.other_light) return {};
  for (std::string& note : other_light_notes(*judged.other_light)) judged.notes.push_back(std::move(note));
  return {};
}

/// What the picture shows as full shadow becomes 0; a note says so.
void undo_full_shadow(Judging& in, double full_shadow, Judged& judged) {
  if (full_shadow == 0.0) return;
  stretch_to_full_shadow(full_shadow, in.pictures.visibility);
  judged.notes.push_back(strength_note(in.capture.strength, full_shadow));
}

/// A strength of the shadow is undone before anything is measured, as the capture says it, or as the test finds it.
Expected<bool> believe_own_test(Judging& in, const Comparison& c, Judged& judged) {
  undo_strength(in, c.raytraced, judged);
  if (!in.map || judged.agreement.empty()) return false;
  const FrameInput input = frame_input(in, c);
  const auto frame = make_frame(input, *in.map);
  if (!frame) return fail(frame.error());
  const OwnTest test = try_own_test(input, *frame);
  if (test.is_believed()) undo_full_shadow(in, test.full_shadow, judged);
  return test.is_believed();
}

/// Tells whether a usual mistake in its description makes the test the one that was drawn, whose strength is undone then.
bool believe_mistaken_test(Judging& in, const Comparison& c, Judged& judged) {
  if (!in.map) return false;
  const FrameInput input = frame_input(in, c);
  auto frame = make_frame(input, *in.map);
  if (!frame) return false;
  const double darkest = try_own_test(input, *frame).darkest;
  stretch_to_full_shadow(darkest, frame->lights.front().visibility);
  if (!is_drawn_but_for_a_mistake(input, *frame)) return false;
  undo_full_shadow(in, darkest, judged);
  return true;
}

Expected<void> trace_truth(Judging& in, Comparison& out, Judged& judged) {
  raytrace::RaytraceOptions options = in.options.raytrace;
  options.size = in.capture.size;
  in.sight.view = make_view(in.scene.camera, in.capture.size);
  in.sight.shift = in.capture.jitter;
  out.raytraced = raytrace::trace_frame(in.tracer, out.plan, in.scene.camera, {&in.light, 1}, options);
  if (in.pictures.ratio)
    in.pictures.other_light = holds_other_light(in.pictures, out.raytraced, in.scene.lights[in.light]);
  auto geometry = align_geometry(align_input(in, out), in.scene, in.sight, in.pictures, judged);
  if (!geometry) return fail(geometry.error());
  geometry->everywhere = geometry->everywhere || in.sight.shift != Vec2(0.0);
  if (const auto late = read_late_map(in, geometry->place_from_captured, out, judged); !late) return late;
  trace_again(in, options, *geometry, out);
  if (const auto undone = undo_rest(in, out.raytraced, judged); !undone) return undone;
  const auto believed = believe_own_test(in, out, judged);
  if (!believed) return fail(believed.error());
  AlignInput shadows = align_input(in, out);
  shadows.shadows_believed = *believed;
  shadows.drawn_by_mistake = [&] { return believe_mistaken_test(in, out, judged); };
  auto aligned = align_shadows(shadows, in.scene, in.sight, in.pictures, judged);
  if (!aligned) return fail(aligned.error());
  in.doubt = aligned->doubt;
  if (!aligned->pictures_differ) return {};
  aligned->everywhere = aligned->everywhere || geometry->everywhere;
  trace_again(in, options, *aligned, out);
  return {};
}

/// The share of the compared pixels whose test, as climbed, is what was drawn.
double biased_is_drawn(const compare::LightComparison& light) {
  std::size_t same = 0, count = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    ++count;
    same += std::abs(light.rungs[5].data[i] - light.rungs[6].data[i]) <= 0.5f ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(same) / static_cast<double>(count) : 1.0;
}

Judged describe_capture(const Capture& capture, const compare::TunedEngine* engine) {
  Judged judged;
  if (engine == nullptr) engine = compare::engine_of_renderer(capture.renderer);
  if (engine != nullptr) judged.engine = engine->name;
  judged.capture = capture.path;
  judged.renderer = capture.renderer, judged.version = capture.version;
  judged.settings = capture.settings;
  judged.has_map = !capture.map.empty();
  judged.has_positions = !capture.position.empty() || capture.depth.has_value();
  judged.of_ratio = capture.visibility.empty();
  judged.traces = capture.kind == RendererKind::ray_tracer;
  return judged;
}

std::optional<std::uint32_t> place_of(const std::string& text, std::size_t count) {
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos || text.size() > 6)
    return std::nullopt;
  const auto place = static_cast<std::size_t>(std::stoul(text));
  if (place >= count) return std::nullopt;
  return static_cast<std::uint32_t>(place);
}

/// Refuses a capture whose casters were found where the truth may be that of something that casts no shadow.
Expected<void> check_casters(const Judging& in, const Comparison& out) {
  if (!in.capture.casters_found || !out.judged->has_map) return {};
  const auto absent = find_absent_caster(frame_input(in, out), out.raster, out.lights.front());
  if (absent) return capture_error(in.capture, "scene", absent_caster_words(*absent));
  return {};
}

void finish(Judging& in, Comparison& out) {
  auto judged = std::make_shared<Judged>(*out.judged);
  compare::LightComparison& light = out.lights.front();
  if (judged->has_map) {
    const raster::LightRecord& record = out.raster.lights.front();
    judged->biased_is_drawn = biased_is_drawn(light);
    judged->unit_world = record.foreign->unit_world, judged->units = record.foreign->units;
    const FrameInput frame = frame_input(in, out);
    const auto note = [&](std::vector<std::string> notes) {
      for (std::string& one : notes) judged->notes.push_back(std::move(one));
    };
    const DescribedTest test = check_described_test(frame, out.raster, light);
    const auto other =
        test.is_drawn() || test.filter_is_known() ? std::nullopt : find_drawn_test(frame, out.raster, light);
    note(described_test_notes(test, other));
    note(far_triangle_notes(in.world, out.raytraced));
    note(far_places_notes(frame, record));
    note(no_shadow_notes(light, record));
    note(caster_bias_notes(in.casters, record));
    const bool even = record.map.view.projection == LightProjection::orthographic ||
                      captured_test(record).stores != Stores::depths;
    note(format_notes(in.facts.format, even ? judged->unit_world : 0.0));
    const auto turned = test.is_drawn() ? find_turned_map(frame, out.raster, light) : std::nullopt;
    if (turned) note({turned_map_note(*turned, light)}), judged->cure = turned_map_cure(*turned);
    const bool described = advice_holds(test, other) && !turned;
    const MapContent content = label_map_content(frame, out.raster, light, described);
    note(map_content_notes(content, record));
    const AtlasReads atlas = label_atlas_reads(frame, out.raster, light);
    note(atlas.notes);
    const OutsideFindings outside = find_outside_map(frame, light, record);
    note(outside.notes);
    for (const std::string& cure : {atlas.cure, outside.cure})
      if (judged->cure.empty()) judged->cure = cure;
    const bool is_explained = test.is_drawn() || test.filter_is_known() || other || !judged->cure.empty() ||
                              content.is_main_cause(light);
    if (is_explained) in.doubt.clear();
    const TimedStage advising("advice");
    judged->advice_sought = described && !content.is_main_cause(light);
    if (judged->advice_sought)
      judged->advice =
          give_advice(frame, out.raster, light, in.casters,
                      other && other->of_constant ? other->constant_world : record.bias_constant_world);
    for (compare::Advice& advice : judged->advice) {
      if (advice.unit == "stored depth") advice.units = judged->units;
      if (advice.with && advice.with->unit == "stored depth") advice.with->units = judged->units;
      advice.in_engine = settings_in_engine(judged->engine, advice, in.scene.lights[in.light].type,
                                            out.raster.options.map.technique, record, in.world);
    }
  }
  if (judged->traces) {
    const TracedFinding found = label_traced_rays(frame_input(in, out), light);
    for (std::string& one : traced_notes(found)) judged->notes.push_back(std::move(one));
    judged->cure = traced_advice(found, light);
  }
  if (!in.doubt.empty()) judged->notes.push_back(in.doubt);
  if (!judged->has_map) compare::forget_texels(light);
  out.judged = std::move(judged);
}

/// The capture's picture and map as a frame.
Expected<void> take_frame(Judging& in, Comparison& out) {
  const std::vector<CapturedCasterBias> given =
      in.map ? in.map->caster_bias : std::vector<CapturedCasterBias>{};
  const FrameInput input = frame_input(in, out);
  if (in.map) in.facts.atlas = std::move(in.map->atlas);
  // Averages have the bits of sums, not those of depths.
  if (in.map && in.map->test->reads() != CapturedTest::Reads::averages)
    in.facts.format = find_format(std::move(in.map->captured_numbers));
  auto frame = make_frame(input, std::move(in.map));
  in.map.reset();
  if (!frame) return fail(frame.error());
  out.raster = std::move(*frame);
  raster::LightRecord& record = out.raster.lights.front();
  if (!record.has_known_map()) return {};
  find_lit_depths(input, out.raster, in.facts);
  in.casters = take_out_caster_bias(input, given, record);
  find_culling(input, out.raster);
  return {};
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
                                   const JudgeOptions& options, const compare::Progress& progress) {
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
  Judged judged = describe_capture(capture, options.engine);
  if (const auto order = check_order(capture, scene.camera.orthographic(), options.fix, *pictures, judged);
      !order)
    return fail(order.error());
  std::optional<CapturedMap> map;
  std::optional<Error> matrices;
  if (!capture.map.empty()) {
    const Light& own = scene.lights[*light];
    if (const auto sound = check_map_matrices(capture, own, world); !sound) matrices = sound.error();
    auto read = matrices ? Expected<CapturedMap>() : read_map(capture, own, world);
    if (!read) return fail(read.error());
    if (!matrices) map = std::move(*read);
  }
  reading.end();
  Comparison out;
  out.plan = plan_effects(scene);
  report("ray tracing", 0.2);
  const raytrace::Tracer tracer(world, options.accel, options.precision);
  Judging judging{capture,        scene,   world, tracer, options, *light, std::move(*pictures),
                  std::move(map), matrices};
  if (const auto traced = trace_truth(judging, out, judged); !traced) return fail(traced.error());
  out.judged = std::make_shared<Judged>(std::move(judged));
  out.exposure = scene.exposure ? *scene.exposure : auto_exposure(out.raytraced.color);
  report("comparing", 0.6);
  if (const auto taken = take_frame(judging, out); !taken) return fail(taken.error());
  const compare::Plan plan{.tracer = tracer,
                           .picture = capture.size,
                           .lights = {&*light, 1},
                           .measure = {.bias_curve_points = options.bias_curve_points}};
  if (const auto measured = compare::measure_frames(out, plan); !measured) return fail(measured.error());
  if (const auto sound = check_casters(judging, out); !sound) return fail(sound.error());
  finish(judging, out);
  report("compared", 1.0);
  return out;
}

}  // namespace gnomon::judge

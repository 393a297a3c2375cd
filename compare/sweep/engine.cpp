#include "compare/sweep/engine.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "compare/light_comparison.h"
#include "compare/outputs.h"
#include "compare/palette.h"
#include "compare/sweep/bias_axis.h"
#include "scene/exposure.h"

namespace gnomon::compare {
namespace {

// What the truth hangs on.
bool same_truth(const Setting& a, const Setting& b) {
  return a.accel == b.accel && a.precision == b.precision && a.raytrace == b.raytrace &&
         a.camera == b.camera && a.lights == b.lights && a.compared == b.compared;
}

// The drawing options are equal but for the constant bias.
bool same_but_bias(const raster::RasterOptions& a, const raster::RasterOptions& b) {
  raster::RasterOptions rebiased = a;
  rebiased.map.bias.constant = b.map.bias.constant;
  rebiased.map.bias.unit = b.map.bias.unit;
  return rebiased == b;
}

// Two drawings stored the same map and show the same primitives at the same places: the lower rungs agree.
bool same_map(const raster::RasterFrame& a, const raster::RasterFrame& b, std::size_t light) {
  const raster::LightRecord &x = a.lights[light], &y = b.lights[light];
  return a.options.map.cull == b.options.map.cull && x.light == y.light && x.map.format == y.map.format &&
         x.map.view.size == y.map.view.size && x.map.depth == y.map.depth &&
         x.map.primitive == y.map.primitive && x.texel_uv.data == y.texel_uv.data &&
         x.face.data == y.face.data && a.primitive.data == b.primitive.data;
}

}  // namespace

bool biases_follow_from_gaps(const raster::MapOptions& map) {
  return map.technique == raster::Technique::hard;
}

double bias_in_world_units(const raster::Bias& bias, const LightView& view, const World& world) {
  return bias.unit == raster::BiasUnit::world ? bias.constant
                                              : bias.constant * raster::texel_world(view, world);
}

void rebias(const Image<std::uint32_t>& primitive, double constant_world, raster::LightRecord& record) {
  record.bias_constant_world = constant_world;
  const auto bias = static_cast<float>(constant_world);
  tbb::parallel_for(std::size_t{0}, record.gap.data.size(), [&](std::size_t i) {
    const bool shadowed = primitive.data[i] != no_id && record.gap.data[i] > bias;
    record.visibility.data[i] = shadowed ? 0.0f : 1.0f;
  });
}

struct Engine::Impl {
  Scene& scene;
  const World& world;
  raster::Renderer& renderer;
  bool perceptual;
  raytrace::Topology topology;
  std::unique_ptr<raytrace::Tracer> tracer;
  Comparison comparison;
  std::optional<Setting> truth_of, drawn_for;
  /// The drawing that the lower climbs were made from, and one climb per light compared.
  std::unique_ptr<raster::RasterFrame> lower_frame;
  std::vector<std::unique_ptr<LowerClimb>> lower;
  Rgb8Image backdrop;  ///< the ray-traced picture in grey; empty: not made yet
  bool has_images = false;
  std::vector<raster::Bias> expected;
  std::vector<std::vector<LightComparison>> table;  ///< by light and expected bias; empty: not made yet
  EngineWork work;
  bool derived = false;

  Impl(Scene& s, const World& w, raster::Renderer& r, bool p)
      : scene(s), world(w), renderer(r), perceptual(p), topology(w) {}

  LadderInput input(const raster::RasterFrame& frame, std::size_t i) const {
    const Light& light = scene.lights[frame.lights[i].light];
    return {world,
            *tracer,
            topology,
            light,
            frame,
            frame.lights[i],
            comparison.raytraced,
            comparison.raytraced.lights[i]};
  }

  void trace(const Setting& setting) {
    if (truth_of && same_truth(*truth_of, setting)) return;
    lower.clear();
    table.clear();
    backdrop = {};
    drawn_for.reset();
    if (!tracer || truth_of->accel != setting.accel || truth_of->precision != setting.precision) {
      tracer = std::make_unique<raytrace::Tracer>(world, setting.accel, setting.precision);
      comparison.precision = setting.precision;
      comparison.accel_build_ms = tracer->stats().build_ms;
    }
    scene.camera = setting.camera;
    scene.lights = setting.lights;
    comparison.plan = plan_effects(scene);
    comparison.raytraced =
        raytrace::trace_frame(*tracer, comparison.plan, scene.camera, setting.compared, setting.raytrace);
    comparison.exposure = scene.exposure ? *scene.exposure : auto_exposure(comparison.raytraced.color);
    truth_of = setting;
    ++work.truths;
  }

  Expected<void> draw(const Setting& setting) {
    drawn_for.reset();
    raster::RasterOptions drawing = setting.raster;
    drawing.seed = setting.raytrace.seed, drawing.shadow_samples = setting.raytrace.shadow_samples;
    auto frame = renderer.render(drawing, setting.compared);
    if (!frame) return fail(frame.error());
    comparison.raster = std::move(*frame);
    drawn_for = setting;
    ++work.renders;
    return {};
  }

  /// The bias alone, or the images with it.
  void derive(const Setting& setting, Detail detail) {
    comparison.raster.options = setting.raster;
    for (raster::LightRecord& record : comparison.raster.lights) {
      const double world_units = bias_in_world_units(setting.raster.map.bias, record.map.view, world);
      record.bias_constant_world = world_units;
      if (detail == Detail::images) rebias(comparison.raster.primitive, world_units, record);
    }
    ++work.derived;
  }

  /// The lower rungs of all lights, kept where the maps are the same as before.
  void climb_lower() {
    const raster::RasterFrame& frame = comparison.raster;
    bool same = lower.size() == frame.lights.size();
    for (std::size_t i = 0; same && i < lower.size(); ++i) same = same_map(*lower_frame, frame, i);
    if (same) return;
    lower.clear();
    lower_frame = std::make_unique<raster::RasterFrame>(frame);
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
      const LadderInput in = input(*lower_frame, i);
      lower.push_back(std::make_unique<LowerClimb>(in, sort_pixels(in)));
      ++work.lower_climbs;
    }
  }

  MeasureOptions measure_options() const {
    MeasureOptions options;
    options.perceptual = perceptual;
    return options;
  }

  /// Place of the bias among those expected, or their count.
  std::size_t expected_place(const raster::Bias& bias) const {
    const auto same = [&](const raster::Bias& b) {
      return b.constant == bias.constant && b.unit == bias.unit;
    };
    return static_cast<std::size_t>(std::find_if(expected.begin(), expected.end(), same) - expected.begin());
  }

  /// The numbers of all expected biases, once per drawing; false where they cannot be made together.
  bool fill_table() {
    if (!table.empty()) return true;
    if (perceptual || comparison.lights.size() != lower.size()) return false;
    for (const auto& light : lower)
      if (!biases_add_up(*light)) return false;
    for (std::size_t i = 0; i < lower.size(); ++i) {
      const LadderInput in = input(comparison.raster, i);
      std::vector<double> biases;
      for (const raster::Bias& bias : expected)
        biases.push_back(bias_in_world_units(bias, in.record.map.view, world));
      table.push_back(
          compare_biases(*lower[i], in, comparison.lights[i], biases, measure_options().bias_curve_points));
    }
    return true;
  }

  bool measure_from_table(const raster::Bias& bias) {
    const std::size_t place = expected_place(bias);
    if (place == expected.size() || !fill_table()) return false;
    for (std::size_t i = 0; i < table.size(); ++i) comparison.lights[i] = table[i][place];
    return true;
  }

  static void count(const LadderInput& in, bool with_gaps, Probe& probe) {
    const Image<Label> labels = sort_pixels(in);
    for (std::size_t i = 0; i < labels.data.size(); ++i) {
      if (!is_compared(labels.data[i])) continue;
      const bool lit = in.truth.verdict.data[i] == raytrace::Verdict::lit;
      ++probe.compared;
      probe.wrong += std::abs(in.record.visibility.data[i] - (lit ? 1.0f : 0.0f)) > 0.5f;
      if (with_gaps) (lit ? probe.gaps.lit : probe.gaps.shadowed).push_back(in.record.gap.data[i]);
    }
  }

  // V6 - V0 of the light that is most wrong at a pixel.
  float worst_error(std::size_t pixel) const {
    float worst = 0.0f;
    for (std::size_t i = 0; i < lower.size(); ++i) {
      if (!is_compared(lower[i]->sorted.data[pixel])) continue;
      const raster::LightRecord& record = comparison.raster.lights[i];
      const bool lit = !(record.gap.data[pixel] > static_cast<float>(record.bias_constant_world));
      const float drawn = has_images ? record.visibility.data[pixel] : (lit ? 1.0f : 0.0f);
      const float error = drawn - lower[i]->rungs[0].data[pixel];
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    return worst;
  }

  // Grey between 64 and 232, so that both error colours stand out from it.
  void make_backdrop() {
    if (!backdrop.data.empty()) return;
    backdrop = raytraced_picture(comparison);
    for (glm::u8vec3& c : backdrop.data) {
      const float luma = 0.2126f * float(c.r) + 0.7152f * float(c.g) + 0.0722f * float(c.b);
      c = glm::u8vec3(static_cast<std::uint8_t>(64.5f + luma * (168.0f / 255.0f)));
    }
  }

  // The mean colour of the pixels x0 … x1, y0 … y1 (ends excluded).
  glm::u8vec3 mean_colour(int x0, int x1, int y0, int y1) const {
    Vec3f sum(0.0f);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const std::size_t pixel = backdrop.index(x, y);
        const float error = worst_error(pixel);
        const Vec3f mark(error < 0.0f ? false_shadow_colour : missed_shadow_colour);
        sum += glm::mix(Vec3f(backdrop.data[pixel]), mark, std::min(std::abs(error), 1.0f));
      }
    return glm::u8vec3(sum / static_cast<float>((x1 - x0) * (y1 - y0)) + 0.5f);
  }

  void measure() {
    if (!derived) climb_lower();
    has_images = true;
    comparison.lights.clear();
    for (std::size_t i = 0; i < comparison.raster.lights.size(); ++i) {
      const LadderInput in = input(comparison.raster, i);
      Times classify;
      Climb climbed;
      time_run(classify, [&] { climbed = climb_up(*lower[i], in); });
      comparison.lights.push_back(measure_light(in, i, std::move(climbed), measure_options()));
      comparison.lights.back().classify = classify;
    }
  }

  Expected<void> compare(const Setting& setting, Detail detail) {
    trace(setting);
    derived = drawn_for && biases_follow_from_gaps(setting.raster.map) &&
              same_but_bias(drawn_for->raster, setting.raster);
    if (!derived) {
      if (auto drawn = draw(setting); !drawn) return drawn;
      table.clear();
      measure();
      return {};
    }
    if (detail == Detail::numbers && expected_place(setting.raster.map.bias) < expected.size()) {
      derive(setting, Detail::numbers);
      has_images = false;
      if (measure_from_table(setting.raster.map.bias)) return {};
      --work.derived;
    }
    derive(setting, Detail::images);
    measure();
    return {};
  }
};

Engine::Engine(Scene& scene, const World& world, raster::Renderer& renderer, bool perceptual)
    : impl_(std::make_unique<Impl>(scene, world, renderer, perceptual)) {
  impl_->comparison.world = &world;
  impl_->comparison.threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

Engine::~Engine() = default;

Expected<Probe> Engine::probe(const Setting& setting) {
  impl_->trace(setting);
  if (auto drawn = impl_->draw(setting); !drawn) return fail(drawn.error());
  impl_->table.clear();
  impl_->lower.clear();
  impl_->drawn_for.reset();
  Probe probe;
  const raster::RasterFrame& frame = impl_->comparison.raster;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    impl_->count(impl_->input(frame, i), biases_follow_from_gaps(setting.raster.map), probe);
    probe.raster_ms += frame.lights[i].map_pass.median() + frame.lights[i].shade_pass.median();
  }
  if (!frame.lights.empty()) probe.bias_world = frame.lights.front().bias_constant_world;
  std::sort(probe.gaps.lit.begin(), probe.gaps.lit.end());
  std::sort(probe.gaps.shadowed.begin(), probe.gaps.shadowed.end());
  return probe;
}

Rgb8Image Engine::thumbnail(int width) const {
  impl_->make_backdrop();
  const ImageSize full = impl_->backdrop.size;
  const int columns = std::min(width, full.width);
  const int rows = std::max(1, static_cast<int>(std::lround(double(columns) * full.height / full.width)));
  Rgb8Image small({columns, rows});
  const auto edge = [](int i, int count, int pixels) {
    return static_cast<int>(static_cast<std::int64_t>(i) * pixels / count);
  };
  tbb::parallel_for(0, rows, [&](int y) {
    for (int x = 0; x < columns; ++x)
      small.at(x, y) = impl_->mean_colour(edge(x, columns, full.width), edge(x + 1, columns, full.width),
                                          edge(y, rows, full.height), edge(y + 1, rows, full.height));
  });
  return small;
}

bool Engine::last_was_derived() const {
  return impl_->derived;
}

const EngineWork& Engine::work() const {
  return impl_->work;
}

void Engine::expect_biases(std::vector<raster::Bias> biases) {
  impl_->expected = std::move(biases);
  impl_->table.clear();
}

Expected<Comparison*> Engine::compare(const Setting& setting, Detail detail) {
  if (auto compared = impl_->compare(setting, detail); !compared) return fail(compared.error());
  return &impl_->comparison;
}

}  // namespace gnomon::compare

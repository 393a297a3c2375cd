// The timed drawing: shading with and without shadows, and what is read back of it (renderer_passes.cpp: maps).
#include <algorithm>
#include <cstring>
#include <thread>
#include <utility>

#include "raster/gl/context.h"
#include "raster/gl_renderer.h"
#include "raster/passes/izb_pass.h"
#include "raster/passes/map_shape.h"
#include "raster/programs/programs.h"
#include "raster/programs/shader_folder.h"
#include "raster/technique_traits.h"
#include "scene/base/interruptible.h"

namespace gnomon::raster {
namespace {

/// Measures a pass by the wall's clock or by the processor's.
class PassClock {
 public:
  explicit PassClock(bool of_processor) : of_processor_(of_processor) {}
  double elapsed_ms() const { return of_processor_ ? processor_.elapsed_ms() : wall_.elapsed_ms(); }

 private:
  bool of_processor_;
  Stopwatch wall_;
  ProcessorStopwatch processor_;
};

bool same_bits(const Image<float>& a, const Image<float>& b) {
  return a.size == b.size && std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

}  // namespace

Expected<void> GlRenderer::warm_up_shading(const Job& job, const ShadePermutation& permutation) {
  const bool timed = job.options.runs > 0 || job.options.keep_time;
  if (!warm_shadings_.insert(permutation).second && !timed) return {};
  return warm_up([&] { return shading_.draw_light(buffers_, permutation, false); });
}

// What the program's own shaders draw is the same every time.
void GlRenderer::keep_timed_visibility(Job& job) const {
  if (gl_->shader_folder().replaced().empty()) return;
  const ReadBack reading(job.frame);
  Image<float> drawn;
  shading_.read_drawn_visibility(drawn);
  if (!job.timed_visibility)
    job.timed_visibility = std::move(drawn);
  else if (!same_bits(*job.timed_visibility, drawn))
    job.timed_alike = false;
}

// A system may count processor time in steps of 10 ms, many times what a small picture takes.
Expected<double> GlRenderer::time_as_judged(Job& job, const ShadePermutation& judged,
                                            const VisibilityRequest* asked) {
  constexpr double long_enough_ms = 100.0;
  constexpr int most_drawings = 500;
  const bool software = draws_in_software(info_.renderer);
  double sum_ms = 0.0;
  int drawings = 0;
  while (sum_ms < long_enough_ms && drawings < most_drawings) {
    const PassClock clock(software);
    if (!job.goes_on)
      if (auto seen = shading_.draw_visibility(buffers_, job.view); !seen) return fail(seen.error());
    if (auto found = find_external(asked); !found) return fail(found.error());
    if (auto drawn = shading_.draw_light(buffers_, judged, !job.first_light); !drawn)
      return fail(drawn.error());
    (*gl_)->Finish();
    sum_ms += clock.elapsed_ms();
    ++drawings;
    keep_timed_visibility(job);
  }
  return sum_ms / drawings;
}

Expected<void> GlRenderer::time_shading_as_judged(Job& job, const MapJob& map_job,
                                                  const VisibilityRequest* asked, LightRecord& record) {
  const ShadePermutation judged = shade_permutation(map_job.light, map_job.options, job.first_light, true);
  const Pass once = [&]() -> Expected<void> {
    if (!job.goes_on)
      if (auto seen = shading_.draw_visibility(buffers_, job.view); !seen) return seen;
    return shading_.draw_light(buffers_, judged, !job.first_light);
  };
  if (auto ok = warm_up(once); !ok) return ok;
  const Pass pass = [&]() -> Expected<void> {
    const auto ms = time_as_judged(job, judged, asked);
    if (!ms) return fail(ms.error());
    record.shade_pass.runs.push_back(*ms);
    return {};
  };
  if (auto ok = repeat("shading runs", job.options, record.shade_pass, 1, pass); !ok) return ok;
  job.visibility_drawn = job.visibility_drawn || !job.goes_on;
  return {};
}

bool GlRenderer::has_spans(const Job& job, const LightRecord* record) {
  return job.options.span_drawings > 0 && !is_external(job.options.map.technique) &&
         !job.frame.lights.empty() && record == &job.frame.lights.front();
}

// The device's clock counts for who draws little else meanwhile: the map, which is kept, is drawn the same to the bit.
Expected<void> GlRenderer::span(const Job& job, const Pass& pass) {
  const ShareOf whole(nullptr);
  spans_.begin();
  for (int drawing = 0; drawing < job.options.span_drawings; ++drawing)
    if (auto ok = pass(); !ok) return ok;
  spans_.end();
  return {};
}

Expected<void> GlRenderer::span_shading(const Job& job, const MapJob& map_job) {
  const ShadePermutation shadowed = shade_permutation(map_job.light, map_job.options, job.first_light, false);
  for (const ShadePermutation& drawn : {shadowed, unshadowed(shadowed)})
    if (auto ok = span(job, [&] { return shading_.draw_light(buffers_, drawn, true); }); !ok) return ok;
  return {};
}

std::optional<ShadowSpans> GlRenderer::take_spans() {
  if (!context_->make_current()) return ShadowSpans{};
  const auto ms = spans_.answer();
  if (!ms) return std::nullopt;
  if (ms->size() != 3) return ShadowSpans{};
  return ShadowSpans{true, spans_.is_of_device(), (*ms)[0], (*ms)[1], (*ms)[2]};
}

/// What the camera sees is the same for all lights, maps and techniques: once it was timed often enough, its median
/// stands for it.
Expected<void> GlRenderer::time_camera(Job& job) {
  if (job.goes_on) return {};
  RasterOptions options = job.options;
  options.runs = std::max(options.runs, usual_runs);
  Times& camera = shading_.times(buffers_, job.view);
  const Pass pass = [&] { return shading_.draw_visibility(buffers_, job.view); };
  if (times_again(camera, options.runs, options.enough_ms)) {
    if (auto ok = warm_up(pass); !ok) return ok;
    if (auto ok = time_pass("shading runs", options, camera, pass); !ok) return ok;
  }
  job.visibility_drawn = true;
  return shows(job) ? Expected<void>{} : pass();
}

void GlRenderer::keep_time(const Job& job, const MapJob& map_job, double ms) {
  kept_time_ = KeptTime{job.options, world_->scene->camera, map_job.light, map_job.view, ms};
}

std::optional<double> GlRenderer::take_kept_time(const Job& job, const MapJob& map_job) {
  const auto kept = std::exchange(kept_time_, std::nullopt);
  if (!kept || !job.first_light || rows_ || job.options.runs != 1 || job.options.shadow_cost)
    return std::nullopt;
  RasterOptions drawn = job.options;
  drawn.runs = 0, drawn.analysis = false, drawn.keep_time = true;
  const bool same = kept->options == drawn && kept->camera == world_->scene->camera &&
                    kept->light == map_job.light && same_window(kept->map, map_job.view);
  return same ? std::optional(kept->ms) : std::nullopt;
}

/// What is shaded in turn. A strip of llvmpipe's tiles keeps each of its threads busy; to a GPU the picture is one.
std::vector<PictureRows> GlRenderer::strips_in_turn() const {
  constexpr int tile = 64, tiles_of_each = 8;
  const ImageSize size = shading_.size();
  if (!draws_in_software(info_.renderer)) return {shading_.all_rows()};
  const int across = (size.width + tile - 1) / tile;
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return bands_of(size, tile * ((tiles_of_each * threads + across - 1) / across));
}

/// Each run draws the light with its shadows, and where RasterOptions::shadow_cost asks for it once more without them, strip
/// by strip. So both have the same moments of the machine, and now the one and now the other first.
Expected<void> GlRenderer::time_shading(Job& job, const MapJob& map_job, const VisibilityRequest* asked,
                                        LightRecord& record) {
  const RasterOptions& options = job.options;
  if (options.runs == 0) return {};
  if (options.timed_as_judged && options.analysis) return time_shading_as_judged(job, map_job, asked, record);
  if (auto ok = time_camera(job); !ok) return ok;
  const double seen_ms = job.goes_on ? 0.0 : shading_.times(buffers_, job.view).median();
  if (const auto ms = take_kept_time(job, map_job)) {
    record.shade_pass.runs.push_back(seen_ms + *ms);
    return {};
  }
  const ShadePermutation shadowed = shade_permutation(map_job.light, map_job.options, job.first_light, false);
  const ShadePermutation plain = unshadowed(shadowed);
  const auto in_turn = [&](bool plain_first, const auto& draw) -> Expected<void> {
    for (const bool with_shadows : {!plain_first, plain_first})
      if (with_shadows || options.shadow_cost)
        if (auto drawn = draw(with_shadows); !drawn) return drawn;
    return {};
  };
  const auto draw = [&](bool with_shadows, const PictureRows& rows) {
    return shading_.draw_light(buffers_, with_shadows ? shadowed : plain, !job.first_light, rows);
  };
  const auto draw_all = [&](bool with_shadows) { return draw(with_shadows, shading_.all_rows()); };
  if (auto found = find_external(asked); !found) return found;
  const Pass both_orders = [&]() -> Expected<void> {
    if (auto ok = in_turn(false, draw_all); !ok) return ok;
    return in_turn(true, draw_all);
  };
  if (auto ok = warm_up(both_orders); !ok) return ok;
  const auto strips = options.shadow_cost ? strips_in_turn() : std::vector{shading_.all_rows()};
  std::vector<TimedStrip> timed(strips.size());
  const Pass pass = [&]() -> Expected<void> {
    bool plain_first = record.shade_pass.runs.size() % 2 != 0;
    for (std::size_t i = 0; i < strips.size(); ++i, plain_first = !plain_first) {
      const auto drawn = in_turn(plain_first, [&](bool with_shadows) -> Expected<void> {
        const Stopwatch watch;
        if (with_shadows && i == 0)
          if (auto found = find_external(asked); !found) return found;
        if (auto ok = draw(with_shadows, strips[i]); !ok) return ok;
        (*gl_)->Finish();
        (with_shadows ? timed[i].whole : timed[i].part).runs.push_back(watch.elapsed_ms());
        return {};
      });
      if (!drawn) return drawn;
    }
    const auto add_run = [&](Times& sum, Times TimedStrip::*pass_of) {
      double ms = seen_ms;
      for (const TimedStrip& strip : timed) ms += (strip.*pass_of).runs.back();
      sum.runs.push_back(ms);
    };
    add_run(record.shade_pass, &TimedStrip::whole);
    if (options.shadow_cost) add_run(record.unshadowed_pass, &TimedStrip::part);
    return {};
  };
  const auto told = [&] { return !options.shadow_cost || beyond_part(timed).told; };
  if (auto ok = repeat("shading runs", options, record.shade_pass,
                       options.shadow_cost ? options.least_subtracted : 1, pass, told);
      !ok)
    return ok;
  if (options.shadow_cost) record.strips = std::move(timed);
  return {};
}

Expected<void> GlRenderer::shade(Job& job, const MapJob& map_job, const VisibilityRequest& request,
                                 LightRecord* record) {
  const MapOptions& map = map_job.options;
  const VisibilityRequest* asked = is_external(map.technique) ? &request : nullptr;
  const bool records = record != nullptr && job.options.analysis;
  if (asked == nullptr || records) slot_->pass.bind_for_lookup();
  if (technique_pass_ != nullptr) technique_pass_->bind_for_lookup();
  if (record != nullptr)
    if (auto ok = time_shading(job, map_job, asked, *record); !ok) return ok;
  if (job.options.times_alone) {
    job.first_light = false;
    return gl_->check("shading");
  }
  if (!job.visibility_drawn && !shows(job))
    if (auto ok = draw_noted_visibility(job); !ok) return ok;
  job.visibility_drawn = true;
  if (asked != nullptr && (record == nullptr || job.options.runs == 0)) {
    if (auto ok = find_external(asked); !ok) return ok;
  }
  if (has_spans(job, record))
    if (auto ok = span_shading(job, map_job); !ok) return ok;
  const ShadePermutation kept = shade_permutation(map_job.light, map, job.first_light, records);
  if (auto ok = warm_up_shading(job, kept); !ok) return ok;
  TimedStage shading(records ? "shading with records" : "shading");
  const Stopwatch watch;
  if (auto ok = shading_.draw_light(buffers_, kept, false); !ok) return ok;
  (*gl_)->Finish();
  if (job.options.keep_time && !records && record != nullptr && job.first_light && asked == nullptr)
    keep_time(job, map_job, watch.elapsed_ms());
  shading.end();
  if (records)
    if (auto ok = read_shading(job, map_job, *record); !ok) return ok;
  if (asked != nullptr && record != nullptr) {
    record->external = external_.costs(request, records);
    for (double& run : record->map_pass.runs) run += record->external->build_later_ms;
    job.frame.map_bytes = std::max(job.frame.map_bytes, record->external->bytes);
  }
  job.first_light = false;
  return gl_->check("shading");
}

Expected<void> GlRenderer::read_shading(Job& job, const MapJob& map_job, LightRecord& record) {
  const ReadBack reading(job.frame);
  shading_.read_records(record);
  if (gl_->shader_folder().replaced().empty()) return {};
  const std::string file = technique_file(map_job.options, map_job.light);
  if (auto fine = check_visibility(record.visibility, gl_->shader_folder(), file); !fine) return fine;
  const std::optional<Image<float>> timed = std::exchange(job.timed_visibility, std::nullopt);
  const bool alike = std::exchange(job.timed_alike, true);
  if (!timed || (alike && same_bits(*timed, record.visibility))) return {};
  return fail(draws_differently(gl_->shader_folder(), file));
}

std::size_t GlRenderer::most_pixels(const MapOptions& map) const {
  if (traits_of(map.technique).contents != MapContents::pixels || !context_->make_current()) return 0;
  return IzbPass::most_pixels(*gl_);
}

Expected<void> GlRenderer::shade_without_light(Job& job) {
  if (!job.goes_on)
    if (auto ok = draw_visibility(job.view); !ok) return ok;
  ShadePermutation permutation;
  permutation.no_light = true;
  permutation.first_light = true;
  if (auto ok = warm_up_shading(job, permutation); !ok) return ok;
  if (auto ok = shading_.draw_light(buffers_, permutation, false); !ok) return ok;
  return gl_->check("shading");
}

}  // namespace gnomon::raster

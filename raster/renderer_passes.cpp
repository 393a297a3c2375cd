// The timed drawing: maps, shading with and without shadows, and what is read back of them.
#include <algorithm>
#include <cstring>
#include <utility>

#include "raster/gl/context.h"
#include "raster/gl_renderer.h"
#include "raster/passes/izb_pass.h"
#include "raster/passes/map_shape.h"
#include "raster/programs/programs.h"
#include "raster/programs/shader_folder.h"
#include "raster/technique_traits.h"
#include "scene/base/stages.h"

namespace gnomon::raster {
namespace {

/// In the time budget, what the driver makes of programs when they are first drawn with.
constexpr std::string_view translation_stage = "driver translation";

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

bool draws_map_for_records(Technique technique) {
  return !compares_depths(technique);
}

bool hands_on_map(const RasterOptions& options) {
  return options.analysis && (options.map_contents || draws_map_for_records(options.map.technique));
}

ShadePermutation shade_permutation(const Light& light, const MapOptions& map, bool first, bool records) {
  ShadePermutation p;
  p.first_light = first;
  p.records = records;
  p.light = light.type;
  p.slope_bias = map.bias.slope != 0.0;
  p.normal_offset = map.bias.normal_offset_texels > 0.0;
  p.receiver_plane = map.bias.receiver_plane;
  p.technique = technique_shader(map, light);
  for (std::string& define : map_defines(map)) p.technique.defines.push_back(std::move(define));
  return p;
}

ShadePermutation unshadowed(ShadePermutation shadowed) {
  shadowed.slope_bias = shadowed.normal_offset = shadowed.receiver_plane = false;
  shadowed.technique = {"unshadowed", {"UNSHADOWED"}};
  return shadowed;
}

std::uint64_t texels_of(const LightView& view) {
  const auto side = static_cast<std::uint64_t>(view.size);
  return static_cast<std::uint64_t>(view.face_count) * side * side;
}

// Twice: llvmpipe translates a program once more where earlier draw calls left other samplers in the places that its
// buffer textures have none for. After one turn those are the pass's own.
Expected<void> GlRenderer::warm_up(const Pass& pass) {
  const TimedStage stage(translation_stage);
  const SmallDrawing little(buffers_);
  for (int turn = 0; turn < 2; ++turn)
    if (auto ok = pass(); !ok) return ok;
  (*gl_)->Finish();
  return {};
}

Expected<void> GlRenderer::repeat(std::string_view repeats, const RasterOptions& options, const Times& times,
                                  int least, const Pass& pass) {
  const TimedStage stage(repeats, TimedStage::Inner::included);
  (*gl_)->Finish();
  while (times_again(times, options.runs, options.enough_ms, least))
    if (auto ok = pass(); !ok) return ok;
  return {};
}

Expected<void> GlRenderer::time_pass(std::string_view repeats, const RasterOptions& options, Times& times,
                                     const Pass& pass) {
  return repeat(repeats, options, times, 1, [&] {
    Expected<void> result;
    time_run(times, [&] {
      result = pass();
      (*gl_)->Finish();
    });
    return result;
  });
}

// The comparison's rungs below V6 are those of a depth map, which is drawn for them alone.
Expected<void> GlRenderer::prepare_external(Job& job, const VisibilityRequest& request, LightRecord* record) {
  if (auto ok = external_.check(); !ok) return ok;
  job.frame.map_texels += texels_of(request.map);
  if (record != nullptr && !job.goes_on && job.options.runs > 0) {
    constexpr std::string_view stage = "sheet runs";
    {
      const TimedStage first(stage, TimedStage::Inner::included);
      if (auto ok = external_.prepare(request, false); !ok) return ok;
    }
    const Pass pass = [&] { return external_.prepare(request, true); };
    if (auto ok = time_pass(stage, job.options, record->map_pass, pass); !ok) return ok;
  }
  const TimedStage stage("sheets");
  return external_.prepare(request, false);
}

// What a camera sees is read back where the technique fits its map to that. Of the picture's own camera the
// visibility buffer is what the picture needs next.
Expected<std::vector<Vec3>> GlRenderer::visible_surfaces(Job& job, const Camera& camera) {
  const bool own = !map_camera_;
  const View view = own ? job.view : make_view(camera, job.options.size);
  if (!own) shading_.set_camera(buffers_, view);
  if (auto ok = draw_visibility(view); !ok) return fail(ok.error());
  std::vector<Vec3> visible = shading_.read_positions(*world_, view);
  if (!own) shading_.set_camera(buffers_, job.view);
  job.visibility_drawn = own;
  return visible;
}

Expected<LightView> GlRenderer::fit(Job& job, const Light& light, const MapOptions& map) {
  const Camera& camera = map_camera_ ? map_camera_->camera : world_->scene->camera;
  std::vector<Vec3> visible;
  if (const auto found = fitted_.find(job.light_index); job.goes_on && found != fitted_.end())
    return found->second;
  if (fits_to_samples(map)) {
    auto seen = visible_surfaces(job, camera);
    if (!seen) return fail(seen.error());
    visible = std::move(*seen);
  }
  const double aspect = double(job.options.size.width) / job.options.size.height;
  auto view = fit_map(*world_, light, camera, aspect, map, visible);
  if (view && map_camera_) move_window(map_camera_->shift, map_camera_->margin, *view);
  if (view && map.snap && map.window.origin.empty()) snap_window(*view, !map.window.size.empty());
  if (view && rows_) fitted_[job.light_index] = *view;
  return view;
}

Expected<void> GlRenderer::prepare_maps(Job& job, const MapJob& map) {
  if (technique_ != map.options.technique) {
    technique_pass_ = make_technique_pass(*gl_, programs_, map.options.technique);
    technique_ = map.options.technique;
  }
  if (auto ok = map_pass_.prepare(map.view, map.options.depth_format); !ok) return ok;
  if (map.options.technique == Technique::hybrid) return {};  // drawn for the records alone
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (!replaced) job.frame.map_texels += texels_of(map.view);
  std::uint64_t bytes = replaced ? 0 : map_pass_.bytes();
  if (technique_pass_ != nullptr) {
    if (auto ok = technique_pass_->prepare(map); !ok) return ok;
    job.frame.map_texels += technique_pass_->texels();
    bytes += technique_pass_->bytes();
  }
  job.frame.map_bytes = std::max(job.frame.map_bytes, bytes);
  return {};
}

Expected<void> GlRenderer::draw_map(const MapJob& map, bool for_records) {
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (!replaced || for_records) {
    if (auto ok = map_pass_.draw(buffers_, map.view, map.options.cull, map.caster_bias); !ok) return ok;
  }
  return technique_pass_ != nullptr ? technique_pass_->draw(map) : Expected<void>{};
}

// For the records alone: what the casters' bias makes of the map is the bias step's. The map that is looked up is drawn
// again, the same to the bit.
Expected<void> GlRenderer::read_unbiased_map(const MapJob& map, ShadowMap& out) {
  out.unbiased.clear();
  if (!map.caster_bias.moves_casters()) return {};
  if (auto ok = map_pass_.draw(buffers_, map.view, map.options.cull, {}); !ok) return ok;
  map_pass_.read(out.unbiased);
  return map_pass_.draw(buffers_, map.view, map.options.cull, map.caster_bias);
}

Expected<void> GlRenderer::time_and_draw_map(Job& job, const MapJob& map, LightRecord* record) {
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (replaced && !job.visibility_drawn && !shows(job)) {
    if (auto ok = draw_visibility(job.view); !ok) return ok;
    job.visibility_drawn = true;
  }
  const bool timed =
      record != nullptr && !job.goes_on && job.options.runs > 0 && map.options.technique != Technique::hybrid;
  if (timed) {
    const Pass pass = [&]() -> Expected<void> {
      if (fits_to_samples(map.options)) {
        if (auto fitted = fit(job, map.light, map.options); !fitted) return fail(fitted.error());
      }
      return draw_map(map, false);
    };
    if (auto ok = warm_up([&] { return draw_map(map, false); }); !ok) return ok;
    record->first_map_ms = job.map_started.elapsed_ms();
    if (auto ok = time_pass("map runs", job.options, record->map_pass, pass); !ok) return ok;
    record->first_map_ms += record->map_pass.runs.front();
  }
  const bool for_records = record != nullptr && hands_on_map(job.options);
  if (!timed || (for_records && draws_map_for_records(map.options.technique))) {
    // What the timed runs left in the technique's pass stays: the map of depths alone is still to be drawn.
    const Pass kept = [&] {
      return timed ? map_pass_.draw(buffers_, map.view, map.options.cull, map.caster_bias)
                   : draw_map(map, for_records);
    };
    if (auto ok = warm_up_map(job, map, for_records, kept); !ok) return ok;
    const TimedStage drawing("map");
    if (auto ok = kept(); !ok) return ok;
    (*gl_)->Finish();
  }
  const ReadBack reading(job.frame);
  if (for_records) map_pass_.read(record->map.depth);
  if (for_records && technique_pass_ != nullptr) technique_pass_->read(record->map);
  if (for_records)
    if (auto ok = read_unbiased_map(map, record->map); !ok) return ok;
  return gl_->check("drawing the shadow map");
}

Expected<void> GlRenderer::find_external(const VisibilityRequest* request) {
  if (request == nullptr) return {};
  if (auto ok = external_.find(*request, shading_); !ok) return ok;
  external_.bind_for_lookup();
  return {};
}

// A frame that draws nothing would not tell which of the user's shaders drew it.
bool GlRenderer::shows(const Job& job) const {
  return gl_->shader_folder().replaced().empty() && shading_.shows(buffers_, job.view);
}

Expected<void> GlRenderer::draw_visibility(const View& view) {
  const Pass pass = [&] { return shading_.draw_visibility(buffers_, view); };
  if (!std::exchange(warm_camera_, true))
    if (auto ok = warm_up(pass); !ok) return ok;
  return pass();
}

Expected<void> GlRenderer::warm_up_map(const Job& job, const MapJob& map, bool for_records,
                                       const Pass& pass) {
  const FilterOptions& filter = map.options.filter;
  const WarmMap key{map.options.technique,
                    map.light.type,
                    map.options.depth_format,
                    map.options.cull,
                    filter.blur_radius_texels > 0,
                    filter.mipmaps,
                    for_records,
                    map.caster_bias.moves_casters()};
  const bool first = warm_maps_.insert(key).second;
  return first || job.options.runs > 0 ? warm_up(pass) : Expected<void>{};
}

Expected<void> GlRenderer::warm_up_shading(const Job& job, const ShadePermutation& permutation) {
  if (!warm_shadings_.insert(permutation).second && job.options.runs == 0) return {};
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

/// Each run draws the light with its shadows, and where RasterOptions::shadow_cost asks for it once more without them, so
/// that both have the same moments of the machine, and now the one and now the other first.
Expected<void> GlRenderer::time_shading(Job& job, const MapJob& map_job, const VisibilityRequest* asked,
                                        LightRecord& record) {
  const RasterOptions& options = job.options;
  if (options.runs == 0) return {};
  if (options.timed_as_judged && options.analysis) return time_shading_as_judged(job, map_job, asked, record);
  if (auto ok = time_camera(job); !ok) return ok;
  const double seen_ms = job.goes_on ? 0.0 : shading_.times(buffers_, job.view).median();
  const ShadePermutation shadowed = shade_permutation(map_job.light, map_job.options, job.first_light, false);
  const ShadePermutation plain = unshadowed(shadowed);
  const auto in_turn = [&](bool plain_first, const auto& draw) -> Expected<void> {
    for (const bool with_shadows : {!plain_first, plain_first})
      if (with_shadows || options.shadow_cost)
        if (auto drawn = draw(with_shadows); !drawn) return drawn;
    return {};
  };
  const auto draw = [&](bool with_shadows) {
    return shading_.draw_light(buffers_, with_shadows ? shadowed : plain, !job.first_light);
  };
  if (auto found = find_external(asked); !found) return found;
  const Pass both_orders = [&]() -> Expected<void> {
    if (auto ok = in_turn(false, draw); !ok) return ok;
    return in_turn(true, draw);
  };
  if (auto ok = warm_up(both_orders); !ok) return ok;
  const Pass pass = [&] {
    return in_turn(record.shade_pass.runs.size() % 2 != 0, [&](bool with_shadows) -> Expected<void> {
      const Stopwatch watch;
      if (with_shadows)
        if (auto found = find_external(asked); !found) return found;
      if (auto drawn = draw(with_shadows); !drawn) return drawn;
      (*gl_)->Finish();
      (with_shadows ? record.shade_pass : record.unshadowed_pass)
          .runs.push_back(seen_ms + watch.elapsed_ms());
      return {};
    });
  };
  return repeat("shading runs", options, record.shade_pass, options.shadow_cost ? subtracted_runs : 1, pass);
}

Expected<void> GlRenderer::shade(Job& job, const MapJob& map_job, const VisibilityRequest& request,
                                 LightRecord* record) {
  const MapOptions& map = map_job.options;
  const VisibilityRequest* asked = map.technique == Technique::hybrid ? &request : nullptr;
  const bool records = record != nullptr && job.options.analysis;
  if (asked == nullptr || records) map_pass_.bind_for_lookup();
  if (technique_pass_ != nullptr) technique_pass_->bind_for_lookup();
  if (record != nullptr)
    if (auto ok = time_shading(job, map_job, asked, *record); !ok) return ok;
  if (!job.visibility_drawn && !shows(job))
    if (auto ok = draw_visibility(job.view); !ok) return ok;
  job.visibility_drawn = true;
  if (asked != nullptr && (record == nullptr || job.options.runs == 0)) {
    if (auto ok = find_external(asked); !ok) return ok;
  }
  const ShadePermutation kept = shade_permutation(map_job.light, map, job.first_light, records);
  if (auto ok = warm_up_shading(job, kept); !ok) return ok;
  TimedStage shading(records ? "shading with records" : "shading");
  if (auto ok = shading_.draw_light(buffers_, kept, false); !ok) return ok;
  (*gl_)->Finish();
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
  if (map.technique != Technique::izb || !context_->make_current()) return 0;
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

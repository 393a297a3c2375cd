// The timed drawing: maps, shading with and without shadows, and what is read back of them.
#include <algorithm>
#include <cstring>
#include <utility>

#include "raster/gl_renderer.h"
#include "raster/izb_pass.h"
#include "raster/map_shape.h"
#include "raster/renderer_name.h"
#include "raster/shader_folder.h"
#include "raster/technique_shader.h"
#include "raster/technique_traits.h"
#include "scene/stages.h"

namespace gnomon::raster {

namespace {

/// Of the wall, or of the processor.
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

Expected<void> GlRenderer::repeat(std::string_view repeats, const RasterOptions& options, const Times& times,
                                  const Pass& warm_up, const Pass& pass) {
  if (options.runs == 0) return {};
  const TimedStage stage(repeats, TimedStage::Inner::included);
  if (auto ok = warm_up(); !ok) return ok;
  (*gl_)->Finish();
  while (times_again(times, options.runs, options.enough_ms))
    if (auto ok = pass(); !ok) return ok;
  return {};
}

Expected<void> GlRenderer::time_pass(std::string_view repeats, const RasterOptions& options, Times& times,
                                     const Pass& warm_up, const Pass& pass) {
  return repeat(repeats, options, times, warm_up, [&] {
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
  if (record != nullptr && !job.goes_on) {
    const Pass warm_up = [&] { return external_.prepare(request, false); };
    const Pass pass = [&] { return external_.prepare(request, true); };
    if (auto ok = time_pass("sheet runs", job.options, record->map_pass, warm_up, pass); !ok) return ok;
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
  if (auto ok = shading_.draw_visibility(buffers_, view); !ok) return fail(ok.error());
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
  if (view && map.snap) snap_window(*view);
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
    if (auto ok = map_pass_.draw(buffers_, map.view, map.options.cull); !ok) return ok;
  }
  return technique_pass_ != nullptr ? technique_pass_->draw(map) : Expected<void>{};
}

Expected<void> GlRenderer::time_and_draw_map(Job& job, const MapJob& map, LightRecord* record) {
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (replaced && !job.visibility_drawn && !shows(job)) {
    if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
    job.visibility_drawn = true;
  }
  if (record != nullptr && !job.goes_on && map.options.technique != Technique::hybrid) {
    const Pass pass = [&]() -> Expected<void> {
      if (fits_to_samples(map.options)) {
        if (auto fitted = fit(job, map.light, map.options); !fitted) return fail(fitted.error());
      }
      return draw_map(map, false);
    };
    const Pass warm_up = [&]() -> Expected<void> {
      const FewTriangles few(buffers_);
      auto done = draw_map(map, false);
      (*gl_)->Finish();
      record->first_map_ms = job.map_started.elapsed_ms();
      return done;
    };
    if (auto ok = time_pass("map runs", job.options, record->map_pass, warm_up, pass); !ok) return ok;
    if (!record->map_pass.runs.empty()) record->first_map_ms += record->map_pass.runs.front();
  }
  const bool for_records = record != nullptr && hands_on_map(job.options);
  const bool drawn = record != nullptr && !job.goes_on && !record->map_pass.runs.empty();
  if (!drawn || (for_records && draws_map_for_records(map.options.technique))) {
    const TimedStage drawing("map");
    if (auto ok = drawn ? map_pass_.draw(buffers_, map.view, map.options.cull) : draw_map(map, for_records);
        !ok)
      return ok;
    (*gl_)->Finish();
  }
  const ReadBack reading(job.frame);
  if (for_records) map_pass_.read(record->map);
  if (for_records && technique_pass_ != nullptr) technique_pass_->read(record->map);
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

Expected<void> GlRenderer::warm_up_shading(const Job& job, bool camera, const VisibilityRequest* asked,
                                           std::initializer_list<ShadePermutation> permutations) {
  if (job.goes_on) return {};
  if (asked != nullptr) {
    if (!shows(job))
      if (auto seen = shading_.draw_visibility(buffers_, job.view); !seen) return seen;
    if (auto found = find_external(asked); !found) return found;
  }
  for (const ShadePermutation& permutation : permutations) {
    if (last_timed_ == permutation) continue;
    const bool with_camera = camera && asked == nullptr;
    if (auto ok = shading_.warm_up(buffers_, job.view, permutation, !job.first_light, with_camera); !ok)
      return ok;
  }
  return {};
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

/// Each run draws what the camera sees, its shadows, and where RasterOptions::shadow_cost asks for it the same
/// picture once more without them, so that both have the same moments of the machine. What the camera sees is the same
/// for all lights, maps and techniques: once it was timed often enough, its median stands for it.
Expected<void> GlRenderer::time_shading(Job& job, const MapJob& map_job, const VisibilityRequest* asked,
                                        LightRecord& record) {
  const RasterOptions& options = job.options;
  const bool as_judged = options.timed_as_judged && options.analysis;
  const ShadePermutation timed =
      shade_permutation(map_job.light, map_job.options, job.first_light, as_judged);
  const ShadePermutation plain = unshadowed(timed);
  Times& camera = shading_.times(buffers_, job.view);
  const bool enough = !times_again(camera, std::max(options.runs, usual_runs), options.enough_ms);
  const bool sees = !job.goes_on && (as_judged || !(enough && shows(job)));
  const Pass pass = [&]() -> Expected<void> {
    double seen_ms = job.goes_on ? 0.0 : camera.median();
    if (sees) {
      const Stopwatch watch;
      if (auto seen = shading_.draw_visibility(buffers_, job.view); !seen) return seen;
      (*gl_)->Finish();
      seen_ms = watch.elapsed_ms();
      camera.runs.push_back(seen_ms);
    }
    const Stopwatch shadowed;
    if (auto found = find_external(asked); !found) return found;
    if (auto drawn = shading_.draw_light(buffers_, timed, !job.first_light); !drawn) return drawn;
    (*gl_)->Finish();
    record.shade_pass.runs.push_back(seen_ms + shadowed.elapsed_ms());
    if (!options.shadow_cost) return {};
    const Stopwatch without;
    if (auto drawn = shading_.draw_light(buffers_, plain, !job.first_light); !drawn) return drawn;
    (*gl_)->Finish();
    record.unshadowed_pass.runs.push_back(seen_ms + without.elapsed_ms());
    return {};
  };
  const Pass judged = [&]() -> Expected<void> {
    const auto ms = time_as_judged(job, timed, asked);
    if (!ms) return fail(ms.error());
    record.shade_pass.runs.push_back(*ms);
    return {};
  };
  const Pass warm_up = [&] {
    return options.shadow_cost ? warm_up_shading(job, sees, asked, {plain, timed})
                               : warm_up_shading(job, sees, asked, {timed});
  };
  if (auto ok = repeat("shading runs", options, record.shade_pass, warm_up, as_judged ? judged : pass); !ok)
    return ok;
  if (options.runs == 0) return {};
  last_timed_ = timed;
  job.visibility_drawn = job.visibility_drawn || sees;
  return {};
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
    if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
  job.visibility_drawn = true;
  if (asked != nullptr && (record == nullptr || job.options.runs == 0)) {
    if (auto ok = find_external(asked); !ok) return ok;
  }
  const ShadePermutation kept = shade_permutation(map_job.light, map, job.first_light, records);
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
    if (auto ok = shading_.draw_visibility(buffers_, job.view); !ok) return ok;
  ShadePermutation permutation;
  permutation.no_light = true;
  permutation.first_light = true;
  if (auto ok = shading_.draw_light(buffers_, permutation, false); !ok) return ok;
  return gl_->check("shading");
}

}  // namespace gnomon::raster

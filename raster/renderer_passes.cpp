// The timed drawing: warming up, maps, and what is read back of them (renderer_shading.cpp: shading).
#include <algorithm>
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
                                  int least, const Pass& pass, const std::function<bool()>& told) {
  const TimedStage stage(repeats, TimedStage::Inner::included);
  (*gl_)->Finish();
  const auto again = [&] {
    const bool untold = told && static_cast<int>(times.runs.size()) >= least && !told();
    return times_again(times, options.runs, options.enough_ms, untold ? options.runs : least);
  };
  while (again())
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
  if (auto ok = external_.check(request.options.technique); !ok) return ok;
  if (traits_of(request.options.technique).contents == MapContents::sheets)
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
    technique_ = map.options.technique;
    const auto make_pass = traits_of(technique_).drawing->make_pass;
    technique_pass_ = make_pass != nullptr ? make_pass(*gl_, programs_) : nullptr;
  }
  if (auto ok = slot_->pass.prepare(map.view, map.options.depth_format); !ok) return ok;
  if (is_external(map.options.technique)) return {};  // drawn for the records alone
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (!replaced) job.frame.map_texels += texels_of(map.view);
  std::uint64_t bytes = replaced ? 0 : slot_->pass.bytes();
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
    if (auto ok = slot_->pass.draw(buffers_, map.view, map.options.cull, map.caster_bias); !ok) return ok;
  }
  return technique_pass_ != nullptr ? technique_pass_->draw(map) : Expected<void>{};
}

// For the records alone: what the casters' bias makes of the map is the bias step's. The map that is looked up is drawn
// again, the same to the bit.
Expected<void> GlRenderer::read_unbiased_map(const MapJob& map, ShadowMap& out) {
  out.unbiased.clear();
  if (!map.caster_bias.moves_casters()) return {};
  if (auto ok = slot_->pass.draw(buffers_, map.view, map.options.cull, {}); !ok) return ok;
  slot_->pass.read(out.unbiased);
  return slot_->pass.draw(buffers_, map.view, map.options.cull, map.caster_bias);
}

Expected<void> GlRenderer::time_and_draw_map(Job& job, const MapJob& map, LightRecord* record) {
  const bool replaced = technique_pass_ != nullptr && technique_pass_->replaces_map();
  if (replaced && !job.visibility_drawn && !shows(job)) {
    if (auto ok = draw_visibility(job.view); !ok) return ok;
    job.visibility_drawn = true;
  }
  const bool timed =
      record != nullptr && !job.goes_on && job.options.runs > 0 && !is_external(map.options.technique);
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
      return timed ? slot_->pass.draw(buffers_, map.view, map.options.cull, map.caster_bias)
                   : draw_map(map, for_records);
    };
    if (auto ok = warm_up_map(job, map, for_records, kept); !ok) return ok;
    const TimedStage drawing("map");
    const Stopwatch watch;
    if (auto ok = kept(); !ok) return ok;
    (*gl_)->Finish();
    const bool whole = !draws_map_for_records(map.options.technique) && !fits_to_samples(map.options);
    if (!timed && whole) job.map_drawn_ms = watch.elapsed_ms();
    if (record != nullptr && !timed) record->first_map_ms = job.map_started.elapsed_ms();
  }
  const ReadBack reading(job.frame);
  if (for_records) slot_->pass.read(record->map.depth);
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

Expected<void> GlRenderer::warm_up_camera(const View& view) {
  if (std::exchange(warm_camera_, true)) return {};
  return warm_up([&] { return shading_.draw_visibility(buffers_, view); });
}

Expected<void> GlRenderer::draw_visibility(const View& view) {
  if (auto ok = warm_up_camera(view); !ok) return ok;
  return shading_.draw_visibility(buffers_, view);
}

Expected<void> GlRenderer::draw_noted_visibility(const Job& job) {
  Times& camera = shading_.times(buffers_, job.view);
  if (!job.options.analysis || !camera.runs.empty()) return draw_visibility(job.view);
  if (auto ok = warm_up_camera(job.view); !ok) return ok;
  Expected<void> drawn;
  time_run(camera, [&] {
    drawn = shading_.draw_visibility(buffers_, job.view);
    (*gl_)->Finish();
  });
  return drawn;
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
                    for_records && technique_pass_ != nullptr && technique_pass_->replaces_map(),
                    map.caster_bias.moves_casters()};
  const bool first = warm_maps_.insert(key).second;
  return first || job.options.runs > 0 ? warm_up(pass) : Expected<void>{};
}

}  // namespace gnomon::raster

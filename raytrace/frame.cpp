#include "raytrace/frame.h"

#include <cmath>
#include <numeric>

#include "raytrace/choose_tracer.h"
#include "raytrace/packets/passes.h"
#include "raytrace/packets/shadow_pass.h"
#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/light_shaft.h"
#include "raytrace/shading/picture.h"
#include "raytrace/tiles.h"
#include "scene/base/stages.h"

namespace gnomon::raytrace {
namespace {

/// Where the time of a pass is charged: the first run makes what is kept, the others only repeat it.
struct PassStages {
  std::string_view kept, repeats;
};
constexpr PassStages primary_stages{"primary rays", "primary ray repeats"};
constexpr PassStages shadow_stages{"shadow rays", "shadow ray repeats"};
constexpr PassStages soft_shadow_stages{"soft shadow rays", "soft shadow ray repeats"};

template <class Pass>
Times time_pass(const PassStages& stages, const RaytraceOptions& options, const Pass& pass) {
  Times times;
  {
    const TimedStage kept(stages.kept);
    time_run(times, pass);
  }
  if (!times_again(times, options.runs, options.enough_ms)) return times;
  const TimedStage repeats(stages.repeats, TimedStage::Inner::included);
  while (times_again(times, options.runs, options.enough_ms)) time_run(times, pass);
  return times;
}

/// Tiles for the lights' passes; none where they are not asked for.
using QuantisedTiles = HugeArray<QuantisedTile>;

/// What is traced of a picture. RaytraceOptions::size is the band's wherever the two come together.
struct Band {
  View view;  ///< of the whole picture
  int first_row = 0;
};

/// Traces as trace_primary does and keeps only what is seen.
void find_primary(const Tracer& tracer, const Band& band, const RaytraceOptions& options,
                  RayTracedFrame& frame, UnstoredReceivers& unstored, QuantisedTiles& tiles) {
  unstored.hits = HugeArray<TileHits>(TileGrid{options.size}.count());
  unstored.first_row = band.first_row;
  frame.primary_rays = time_pass(primary_stages, options, [&] {
    primary_pass(tracer, band.view, edge_setup_of_eye(tracer, band.view),
                 {.size = options.size,
                  .first_row = band.first_row,
                  .hits = {unstored.hits.data(), unstored.hits.size()},
                  .receivers = nullptr,
                  .quantised = {tiles.data(), tiles.size()}},
                 options.stop);
  });
  frame.rays.primary = options.size.pixels();
}

void trace_primary(const Tracer& tracer, const Band& band, PrimaryMethod way, const RaytraceOptions& options,
                   RayTracedFrame& frame, QuantisedTiles& tiles) {
  frame.receiver = Image<SurfacePoint>(options.size);
  frame.primary_rays = time_pass(primary_stages, options, [&] {
    if (way == PrimaryMethod::blocks) {
      primary_pass(tracer, band.view, edge_setup_of_eye(tracer, band.view),
                   {.size = options.size,
                    .first_row = band.first_row,
                    .hits = {},
                    .receivers = &frame.receiver,
                    .quantised = {tiles.data(), tiles.size()}},
                   options.stop);
      return;
    }
    for_each_pixel({options.size, options.stop}, [&](int x, int y, std::size_t) {
      const Ray ray = pixel_ray(band.view, x + 0.5, y + band.first_row + 0.5);
      const std::optional<Hit> hit = tracer.closest_seen(ray);
      frame.receiver.at(x, y) = hit ? tracer.surface_point(ray, *hit) : SurfacePoint{};
    });
  });
  frame.rays.primary = options.size.pixels();
}

bool reaches(const Light& light, const SurfacePoint& point) {
  return point.primitive != no_id && !light_cannot_reach(light, point.position, point.normal);
}

LightTruth trace_shadows(const Tracer& tracer, std::uint32_t light_index, ShadowMethod way,
                         const RaytraceOptions& options, const Image<SurfacePoint>& receivers,
                         const Band& band, const UnstoredReceivers& unstored, const QuantisedTiles& tiles) {
  const Light& light = tracer.world().scene->lights[light_index];
  LightTruth truth{.light = light_index,
                   .centre = Image<PointVisibility>(options.size, PointVisibility::lit),
                   .shadow_rays = {},
                   .light_structure = {}};
  const PictureReceivers source{.tracer = tracer,
                                .size = options.size,
                                .stored = unstored.apply() ? nullptr : &receivers,
                                .view = &band.view,
                                .hits = {unstored.hits.data(), unstored.hits.size()},
                                .quantised = {tiles.data(), tiles.size()},
                                .first_row = band.first_row};
  const TileGrid grid{options.size, options.stop};
  std::vector<std::uint64_t> rays(grid.count());
  truth.shadow_rays = time_pass(shadow_stages, options, [&] {
    truth.light_structure.runs.push_back(0.0);
    if (way == ShadowMethod::blocks) {
      const ShadowRayCounts counts = shadow_pass(source, light, truth.centre, options.stop);
      truth.rays = counts.cast, truth.single_rays = counts.single;
      return;
    }
    std::fill(rays.begin(), rays.end(), 0);
    for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
      const SurfacePoint& point = receivers.at(x, y);
      if (point.primitive == no_id) return;
      const bool reached = reaches(light, point);
      truth.centre.at(x, y) = reached ? tracer.centre_visibility(point, light) : PointVisibility::shadowed;
      rays[tile] += reached && tracer.receives_shadow(point) ? 1 : 0;
    });
    truth.rays = truth.single_rays = std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
  });
  return truth;
}

// The truth of a light with size: the share of its samples that arrive.
void trace_soft_shadows(const Tracer& tracer, const Band& band, const RaytraceOptions& options,
                        const Image<SurfacePoint>& receivers, LightTruth& truth) {
  const Light& light = tracer.world().scene->lights[truth.light];
  truth.samples = samples_of(light, options);
  truth.visibility = Image<float>(options.size, 1.0f);
  truth.standard_error = Image<float>(options.size, 0.0f);
  const TileGrid grid{options.size, options.stop};
  const std::size_t first_pixel = receivers.index(0, band.first_row);
  struct Counts {
    std::uint64_t asked = 0, cast = 0;
  };
  std::vector<Counts> rays(grid.count());
  truth.soft_shadow_rays = time_pass(soft_shadow_stages, options, [&] {
    prepare_light_shafts(tracer, truth.samples);
    std::fill(rays.begin(), rays.end(), Counts{});
    for_each_pixel(grid, [&](int x, int y, std::size_t tile) {
      if (options.stop.stop_requested()) return;  // a pixel may have thousands of samples
      const SurfacePoint& point = receivers.at(x, y);
      if (point.primitive == no_id) return;
      const std::uint64_t key = pixel_key(options.seed, first_pixel + receivers.index(x, y), truth.light);
      const bool reached = reaches(light, point);
      const SampledVisibility setup = reached ? light_visibility(tracer, point, light, truth.samples, key)
                                              : SampledVisibility{0.0, 0.0, 0};
      truth.visibility.at(x, y) = static_cast<float>(setup.share);
      truth.standard_error.at(x, y) = static_cast<float>(setup.standard_error);
      rays[tile].asked += reached ? static_cast<std::uint64_t>(truth.samples) : 0;
      rays[tile].cast += setup.rays;
    });
  });
  for (const Counts& n : rays) truth.soft_rays += n.cast, truth.soft_rays_asked += n.asked;
}

}  // namespace

RayCounts& RayCounts::operator+=(const RayCounts& other) {
  primary += other.primary, shadow += other.shadow, soft_shadow += other.soft_shadow;
  soft_shadow_asked += other.soft_shadow_asked;
  reflection += other.reflection, refraction += other.refraction, glossy += other.glossy;
  indirect += other.indirect, antialiasing += other.antialiasing, interior += other.interior;
  return *this;
}

namespace {

/// Traces the same rays through a few pixels in the middle of the picture. Code, hierarchy and threads are then as they will
/// be, at the cost of some thousand rays and of what these see.
void warm_up(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
             std::span<const std::uint32_t> lights, RaytraceOptions options) {
  constexpr int most_pixels_across = 64;
  const TimedStage stage(primary_stages.repeats, TimedStage::Inner::included);
  const ImageSize picture = options.size;
  options.size = {std::min(picture.width, most_pixels_across), std::min(picture.height, most_pixels_across)};
  options.runs = options.shadow_samples = 1;
  options.picture = options.warm_up = false;
  trace_frame(tracer, plan, narrowed(camera, double(options.size.height) / picture.height), lights, options);
}

}  // namespace

RayTracedFrame trace_frame(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                           std::span<const std::uint32_t> lights, const RaytraceOptions& options) {
  return trace_band(tracer, plan, camera, lights, options, {0, options.size.height});
}

RayTracedFrame trace_band(const Tracer& tracer, const EffectPlan& plan, const Camera& camera,
                          std::span<const std::uint32_t> lights, const RaytraceOptions& whole,
                          const PictureRows& rows) {
  if (whole.warm_up) warm_up(tracer, plan, camera, lights, whole);
  const Band band{make_view(camera, whole.size), rows.first};
  RaytraceOptions options = whole;
  options.size.height = rows.count;
  RayTracedFrame frame;
  frame.options = whole;
  const TracerPlan methods = choose_tracer(tracer, band.view, lights, options);
  const bool at_centres = methods.primary != PrimaryMethod::none;
  QuantisedTiles tiles;
  if (methods.quantised) tiles = QuantisedTiles(TileGrid{options.size}.count());
  UnstoredReceivers unstored;
  if (methods.receivers == ReceiverStore::found_again)
    find_primary(tracer, band, options, frame, unstored, tiles);
  else if (methods.receivers == ReceiverStore::stored)
    trace_primary(tracer, band, methods.primary, options, frame, tiles);
  for (const std::uint32_t light : lights) {
    if (!at_centres || options.stop.stop_requested()) break;
    const bool soft = has_size(tracer.world().scene->lights[light]);
    if (options.records || !soft) {
      frame.lights.push_back(
          trace_shadows(tracer, light, methods.shadow, options, frame.receiver, band, unstored, tiles));
    } else {
      frame.lights.emplace_back().light = light;
    }
    LightTruth& truth = frame.lights.back();
    frame.rays.shadow += truth.rays;
    if (!soft) continue;
    trace_soft_shadows(tracer, band, options, frame.receiver, truth);
    frame.rays.soft_shadow += truth.soft_rays;
    frame.rays.soft_shadow_asked += truth.soft_rays_asked;
  }
  if (rows.first == 0) frame.structure = time_structure(tracer, whole.runs);
  if (!at_centres) frame.rays.primary = options.size.pixels();
  if (options.picture && !options.stop.stop_requested()) {
    frame.color = ColorImage(options.size);
    const TimedStage stage("ray-traced picture");
    const Stopwatch watch;
    shade_picture(tracer, plan, band.view, band.first_row, options, unstored.apply() ? &unstored : nullptr,
                  frame);
    frame.picture_ms = watch.elapsed_ms();
  }
  return frame;
}

void add_costs(const RayTracedFrame& band, RayTracedFrame& sum) {
  const std::uint64_t interior = std::max(sum.rays.interior, band.rays.interior);
  sum.rays += band.rays;
  sum.rays.interior = interior;
  sum.primary_rays.add_part(band.primary_rays);
  if (sum.structure.runs.empty()) sum.structure = band.structure;
  sum.picture_ms += band.picture_ms;
  sum.non_finite += band.non_finite;
  if (sum.lights.empty()) sum.lights.resize(band.lights.size());
  for (std::size_t i = 0; i < sum.lights.size(); ++i) {
    const LightTruth& part = band.lights[i];
    LightTruth& truth = sum.lights[i];
    truth.light = part.light, truth.samples = part.samples;
    truth.rays += part.rays, truth.single_rays += part.single_rays, truth.soft_rays += part.soft_rays;
    truth.soft_rays_asked += part.soft_rays_asked;
    truth.shadow_rays.add_part(part.shadow_rays);
    truth.light_structure.add_part(part.light_structure);
    truth.soft_shadow_rays.add_part(part.soft_shadow_rays);
  }
}

}  // namespace gnomon::raytrace

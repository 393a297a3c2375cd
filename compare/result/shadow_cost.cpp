#include "compare/result/shadow_cost.h"

#include <algorithm>

#include <fmt/core.h>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {

TimeDifference shadow_lookups(const raster::LightRecord& drawn) {
  return drawn.strips.empty() ? beyond_part(drawn.shade_pass, drawn.unshadowed_pass)
                              : beyond_part(drawn.strips);
}

Times standing_rays(const raytrace::LightTruth& truth) {
  return truth.is_soft() ? truth.soft_shadow_rays
                         : beyond_part(truth.shadow_rays, truth.light_structure).pairs;
}

ShadowParts& ShadowParts::operator+=(const ShadowParts& other) {
  map += other.map, lookups += other.lookups, rays += other.rays;
  if (!tree.timed()) tree = other.tree;
  if (other.asks_tree()) by = other.by;
  return *this;
}

std::string_view shadow_side(raster::Technique technique) {
  if (!raster::is_external(technique)) return "map";
  return raster::samples_rays(technique) ? "few rays" : "hybrid";
}

ShadowParts shadow_parts(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& drawn = drawn_record(c, light);
  return {.map = with_spread(drawn.map_pass),
          .lookups = shadow_lookups(drawn),
          .rays = with_spread(true_record(c, light).exact_times()),
          .tree = with_spread(c.raytraced.structure),
          .by = shadow_side(c.raster.options.map.technique)};
}

namespace {

/// Not timed where one of both is not.
TimeDifference sum_of(TimeDifference a, const TimeDifference& b) {
  if (!a.timed() || !b.timed()) return {};
  a += b;
  a.told = a.low > 0.0;
  return a;
}

constexpr std::array situations{
    ShadowSituation{"nothing_moves", "nothing moves", "the map looked up; rays",
                    "few rays cast and denoised; rays", &ShadowCosts::nothing_moves},
    ShadowSituation{"light_moves", "light or camera moves", "the map drawn and looked up; rays",
                    "few rays cast and denoised; rays", &ShadowCosts::light_moves},
    ShadowSituation{"casters_move", "casters move", "the map drawn and looked up; the tree built, rays",
                    "the tree built, few rays cast and denoised; the tree built, rays",
                    &ShadowCosts::casters_move}};

}  // namespace

std::optional<ShadowCosts> shadow_costs(const ShadowParts& parts) {
  if (!parts.lookups.timed() || !parts.rays.timed()) return std::nullopt;
  ShadowCosts costs;
  costs.nothing_moves = {parts.lookups, parts.rays};
  costs.light_moves = {sum_of(parts.map, parts.lookups), parts.rays};
  costs.casters_move = {parts.asks_tree() ? sum_of(costs.light_moves.map, parts.tree) : costs.light_moves.map,
                        sum_of(parts.rays, parts.tree)};
  return costs;
}

std::span<const ShadowSituation> shadow_situations() {
  return situations;
}

std::string sides_text(const ShadowCosts::Sides& sides, std::string_view by) {
  return fmt::format("{} by the {}, {} by rays", milliseconds(sides.map), by, milliseconds(sides.rays));
}

std::vector<std::string> shadow_cost_lines(const ShadowCosts& costs, std::string_view by) {
  std::vector<std::string> lines;
  for (const ShadowSituation& one : shadow_situations())
    lines.push_back(fmt::format("{}: {}", one.words, sides_text(costs.*one.sides, by)));
  return lines;
}

bool is_software(const raster::ContextInfo& context) {
  constexpr std::array names{"llvmpipe", "softpipe", "SWR", "swrast"};
  return std::any_of(names.begin(), names.end(), [&context](const char* name) {
    return context.renderer.find(name) != std::string::npos;
  });
}

std::optional<std::uint64_t> count_lookups(const raster::RasterFrame& frame, const raster::LightRecord& drawn,
                                           const Image<Label>& labels) {
  if (!raster::compares_depths(frame.options.map.technique)) return std::nullopt;
  if (frame.custom_shader || drawn.lookups.data.size() != labels.data.size()) return std::nullopt;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < labels.data.size(); ++i)
    sum += is_compared(labels.data[i]) ? drawn.lookups.data[i] : 0u;
  return sum;
}

void add_ray_work(const raytrace::Tracer& tracer, const Light& light,
                  const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                  std::size_t first_pixel, std::size_t all_pixels, RayWork& sum) {
  constexpr std::size_t about = 1024;  // rays
  raytrace::WorkCounts work;
  const std::size_t step = std::max<std::size_t>(1, all_pixels / about);
  std::size_t next = step / 2;
  if (next < first_pixel) next += (first_pixel - next + step - 1) / step * step;
  for (std::size_t i = next - first_pixel; i < labels.data.size(); i += step) {
    if (!is_compared(labels.data[i])) continue;
    static_cast<void>(tracer.occluded(tracer.shadow_ray(receivers.data[i], light), work));
    ++sum.rays;
  }
  sum.boxes += work.boxes, sum.primitives += work.primitives;
}

}  // namespace gnomon::compare

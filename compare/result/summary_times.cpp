// What a comparison took and what that bought, as lines of the summary.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compare/result/estimate.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/shadow_cost.h"
#include "compare/result/summary_page.h"

namespace gnomon::compare {
namespace {

// What the exact shadow took, and of what.
std::string exact_shadows_line(const raytrace::LightTruth& truth) {
  std::string text = fmt::format("exact shadows: {} for {} ray{}", median_text(truth.exact_times()),
                                 grouped(truth.exact_rays()), truth.exact_rays() == 1 ? "" : "s");
  if (!truth.is_soft()) return text;
  return text + fmt::format(", of {} samples asked for ({} a receiver); and {} to the light's centre",
                            grouped(truth.soft_rays_asked), truth.samples, median_text(truth.shadow_rays));
}

// The shadows' part of a frame on both sides, by what has moved.
void add_shadow_costs(SummaryPage& page, std::string_view name, const Comparison& c,
                      const LightComparison& light) {
  const ShadowParts parts = shadow_parts(c, light);
  const auto costs = shadow_costs(parts);
  if (!costs) return;
  for (const std::string& line : shadow_cost_lines(*costs, parts.by))
    page.field(std::exchange(name, ""), line);
  std::string_view estimate = "estimate";
  for (const std::string& line : estimate_lines(c, light)) page.field(std::exchange(estimate, ""), line);
}

// What does not depend on the machine.
std::string work_line(const Comparison& c, const LightComparison& light) {
  const raytrace::LightTruth& truth = true_record(c, light);
  std::string text;
  if (c.raster.has_map()) text = counted(drawn_record(c, light).map_texels, "texel") + " drawn";
  if (light.lookups)
    text += fmt::format(", {} looked up ({} a pixel)", grouped(*light.lookups),
                        plain_number(static_cast<double>(*light.lookups) /
                                     static_cast<double>(std::max<std::uint64_t>(light.pixels.compared, 1))));
  text += (text.empty() ? "" : "; ") + counted(truth.exact_rays(), "ray");
  const RayWork& work = light.ray_work;
  if (work.rays > 0)
    text += fmt::format(", {} boxes and {} primitives tested for one (of {} through the tree)",
                        plain_number(static_cast<double>(work.boxes) / static_cast<double>(work.rays)),
                        plain_number(static_cast<double>(work.primitives) / static_cast<double>(work.rays)),
                        grouped(work.rays));
  return text;
}

}  // namespace

std::string median_text(const Times& t) {
  return milliseconds(t.runs.empty() ? -1.0 : t.median());
}

void add_times(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& drawn = drawn_record(c, light);
  const bool without_map = !c.raster.has_map();
  if (!c.judged)
    page.field("time", without_map ? fmt::format("{} to shade the picture with its few rays",
                                                 median_text(drawn.shade_pass))
                                   : fmt::format("the map: {}, and {} to shade the picture with it",
                                                 median_text(drawn.map_pass), median_text(drawn.shade_pass)));
  page.field(c.judged ? "time" : "", exact_shadows_line(true_record(c, light)));
  add_shadow_costs(page, "shadows", c, light);
  if (c.judged) return;
  if (!drawn.unshadowed_pass.runs.empty())
    page.field("picture",
               fmt::format("without shadows: {} to shade it, {} for primary rays",
                           median_text(drawn.unshadowed_pass), median_text(c.raytraced.primary_rays)));
  page.field("work", work_line(c, light));
}

void add_once(SummaryPage& page, const Comparison& c) {
  double first_map = 0.0;
  for (const LightComparison& light : c.lights) {
    const raster::LightRecord& drawn = drawn_record(c, light);
    first_map += drawn.map_pass.runs.empty() ? 0.0 : drawn.first_map_ms;
  }
  page.field(
      "once",
      fmt::format("{} to upload the scene, {} to make memory for the maps and draw them first; "
                  "{} to build the tracer's hierarchy",
                  milliseconds(c.raster.upload_ms), first_map > 0.0 ? milliseconds(first_map) : "not timed",
                  median_text(c.raytraced.structure)));
  page.field("", fmt::format("for the comparison alone: {} to join triangles, {} to read back",
                             milliseconds(c.topology_ms), milliseconds(c.raster.read_back_ms)));
  if (is_software(c.raster.context)) page.field("", std::string(software_note));
}

void add_time_in_short(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  if (c.judged || drawn_record(c, light).unshadowed_pass.runs.empty())
    return page.field("time", exact_shadows_line(true_record(c, light)));
  add_shadow_costs(page, "time", c, light);
  page.field("work", work_line(c, light));
}

}  // namespace gnomon::compare

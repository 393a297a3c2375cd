// What the shadows cost on the page: the map and its lookups beside the light's structure and its rays.
#include "compare/result/shadow_cost.h"

#include <fmt/core.h>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {
namespace {

struct Side {
  std::string key;  ///< of result.json; empty: a sum of others
  double ms = 0.0;
  std::string text = milliseconds(ms);
};

Side timed_side(std::string key, const Times& times) {
  constexpr double not_timed = -1.0;
  return times.runs.empty() ? Side{{}, not_timed} : Side{std::move(key), times.median()};
}

std::string cell(const Side& side) {
  if (side.text.empty()) return "nothing";
  return side.key.empty() ? escaped(side.text) : keyed(side.key + ".median", side.ms, side.text);
}

std::string row(std::string_view name, std::string_view what, const Side& raster, const Side& rays) {
  return fmt::format(
      R"(<tr><th scope="row">{}<small>{}</small></th><td class="n">{}</td><td class="n">{}</td></tr>
)",
      name, what, cell(raster), cell(rays));
}

std::string rows_of(const Comparison& c, std::size_t i) {
  const raster::LightRecord& drawn = drawn_record(c, c.lights[i]);
  const raytrace::LightTruth& truth = true_record(c, c.lights[i]);
  if (drawn.unshadowed_pass.runs.empty()) return {};
  const auto key = [i](std::string_view name) { return light_key(i, fmt::format("times_ms.{}", name)); };
  const TimeDifference lookups = shadow_lookups(drawn), both = map_and_lookups(drawn);
  const Side map = timed_side(key("map_pass"), drawn.map_pass);
  const Side looked_up{key("shadow_lookups"), lookups.median, milliseconds(lookups)};
  const double structure_ms = truth.is_soft() ? 0.0 : truth.light_structure.median();
  const Side structure = structure_ms > 0.0 ? Side{key("light_structure"), structure_ms} : Side{{}, 0.0, {}};
  const Side rays = timed_side(key("exact_shadows_standing"), standing_rays(truth));
  const std::string name = c.lights.size() > 1 ? escaped(shown_light_name(c, i)) + ": " : std::string();
  const std::string_view map_name = drawn.external ? "the sheets" : "the map";
  return row(name + "what is made for the light",
             fmt::format("{}; rays ask the scene's own hierarchy", map_name), map, structure) +
         row(name + "asking it", "every frame, even where light and casters stand still", looked_up, rays) +
         row(name + "both", "a frame in which something has moved", {{}, both.median, milliseconds(both)},
             timed_side(key("exact_shadows"), truth.exact_times())) +
         row(name + "the picture without shadows", "shading, or primary rays",
             {key("unshadowed_pass"), drawn.unshadowed_pass.median()},
             {"times_ms.primary_rays", c.raytraced.primary_rays.median()});
}

}  // namespace

std::string shadow_cost_table(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string rows;
  for (std::size_t i = 0; i < c.lights.size(); ++i) rows += rows_of(c, i);
  std::string note = "<p class=\"hint\">Before the first frame: " +
                     keyed("times_ms.upload.median", c.raster.upload_ms, milliseconds(c.raster.upload_ms)) +
                     " to upload the scene to the rasterizer, " +
                     keyed("times_ms.accel_build.median", c.accel_build_ms, milliseconds(c.accel_build_ms)) +
                     " to build the tracer\u2019s hierarchy.";
  if (is_software(c.raster.context)) {
    std::string said(software_note);
    said.front() = 'A';
    note += " " + escaped(said) + ".";
  }
  note += "</p>\n";
  if (rows.empty()) return note;
  return R"(<table class="times"><caption>The shadows alone, without what the picture costs</caption><thead><tr><th scope="col">part</th><th scope="col" class="n">rasterizer</th><th scope="col"
class="n">rays</th></tr></thead><tbody>
)" + rows +
         "</tbody></table>\n" + note;
}

}  // namespace gnomon::compare

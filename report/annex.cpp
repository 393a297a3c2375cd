// The end of the page: what it cost, what was simulated, where the numbers come from.
#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "report/charts.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {
namespace {

// --- times ---

struct TimeRow {
  std::string key;   // in result.json, of the {median, runs} object
  std::string name;  // HTML
  Times times;
  std::string what;   // HTML
  bool rays = false;  // of the ray tracer
};

std::vector<TimeRow> light_rows(const Comparison& c, std::size_t i) {
  const LightComparison& light = c.lights[i];
  const raytrace::LightTruth& truth = true_record(c, light);
  const raster::LightRecord& drawn = drawn_record(c, light);
  const std::string suffix = c.lights.size() > 1 ? ", " + escaped(shown_light_name(c, i)) : "";
  const std::uint64_t texels = static_cast<std::uint64_t>(drawn.map.view.face_count) *
                               static_cast<std::uint64_t>(drawn.map.view.size) *
                               static_cast<std::uint64_t>(drawn.map.view.size);
  std::vector<TimeRow> rows{
      {light_key(i, "times_ms.map_pass"), (drawn.external ? "sheets" : "depth map") + suffix, drawn.map_pass,
       grouped(texels) + " texels"},
      {light_key(i, "times_ms.shade_pass"), "shading" + suffix, drawn.shade_pass,
       "the picture with its shadow lookups"}};
  if (truth.is_soft())
    rows.push_back(
        {light_key(i, "times_ms.soft_shadow_rays"), "exact shadows" + suffix, truth.soft_shadow_rays,
         fmt::format("{} rays, of {} samples asked for ({} a receiver)",
                     keyed_count(light_key(i, "soft_shadow_rays"), truth.soft_rays),
                     keyed_count(light_key(i, "soft_shadow_rays_asked"), truth.soft_rays_asked),
                     keyed_count(light_key(i, "shadow_samples"), static_cast<std::uint64_t>(truth.samples))),
         true});
  const std::string where = truth.is_soft() ? " to the light's centre" : " exact rays";
  rows.push_back({light_key(i, "times_ms.shadow_rays"),
                  (truth.is_soft() ? "the light as a point" : "exact shadows") + suffix, truth.shadow_rays,
                  keyed_count(light_key(i, "shadow_rays"), truth.rays) + where, true});
  return rows;
}

std::string time_row(const TimeRow& row, double longest) {
  const bool timed = !row.times.runs.empty();
  const double median = row.times.median();
  const std::size_t runs = row.times.runs.size();
  return fmt::format(
      R"(<tr><th scope="row">{}<small>{}</small></th><td class="wide">{}</td><td class="n">{}</td><td
class="n">{}</td></tr>
)",
      row.name, row.what, timed ? share_bar(median / longest, row.rays ? "rays" : "raster") : "",
      timed ? keyed(row.key + ".median", median, milliseconds(median)) : "not timed",
      runs > 1    ? fmt::format("{} runs", runs)
      : runs == 1 ? "1 run"
                  : "");
}

std::string time_table(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::vector<TimeRow> rows;
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    for (TimeRow& row : light_rows(c, i)) rows.push_back(std::move(row));
  rows.push_back({"times_ms.primary_rays", "primary rays", c.raytraced.primary_rays,
                  keyed_count("costs.primary_rays", c.raytraced.rays.primary) + " rays, one for each pixel",
                  true});
  double longest = 0.0;
  for (const TimeRow& row : rows) longest = std::max(longest, row.times.median());
  std::string text;
  for (const TimeRow& row : rows) text += time_row(row, std::max(longest, 1e-9));
  return R"(<table class="times"><caption>What the pictures took</caption><thead class="quiet"><tr><th
scope="col">pass</th><th scope="col">share of the longest</th><th scope="col"
class="n">median</th><th scope="col" class="n">of</th></tr></thead><tbody>
)" + text +
         "</tbody></table>\n";
}

std::string plain_row(std::string_view name, const std::string& value) {
  return fmt::format(R"(<tr><th scope="row">{}</th><td class="n">{}</td></tr>
)",
                     name, value);
}

std::string one_time(std::string_view key, double ms) {
  return keyed(fmt::format("times_ms.{}.median", key), ms, milliseconds(ms));
}

std::string work_table(const Comparison& c) {
  const raytrace::RayCounts& rays = c.raytraced.rays;
  std::string rows =
      plain_row("depth-map texels rendered", keyed_count("costs.map_texels", c.raster.map_texels));
  rows += plain_row("depth-map memory", keyed("costs.map_bytes", static_cast<double>(c.raster.map_bytes),
                                              byte_count(c.raster.map_bytes)));
  rows += plain_row("primary rays", keyed_count("costs.primary_rays", rays.primary));
  rows += plain_row("shadow rays", keyed_count("costs.shadow_rays", rays.shadow));
  if (rays.soft_shadow_asked > 0) {
    rows += plain_row("rays to lights with size", keyed_count("costs.soft_shadow_rays", rays.soft_shadow));
    rows +=
        plain_row("samples asked for", keyed_count("costs.soft_shadow_rays_asked", rays.soft_shadow_asked));
  }
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    if (c.lights[i].lookups)
      rows += plain_row("map lookups of compared pixels" +
                            (c.lights.size() > 1 ? ", " + escaped(shown_light_name(c, i)) : std::string()),
                        keyed_count(light_key(i, "lookups.total"), *c.lights[i].lookups));
  rows += plain_row("reflection rays", keyed_count("costs.reflection_rays", rays.reflection));
  rows += plain_row("refraction rays", keyed_count("costs.refraction_rays", rays.for_refraction()));
  if (rays.glossy > 0) rows += plain_row("glossy rays", keyed_count("costs.glossy_rays", rays.glossy));
  if (rays.indirect > 0)
    rows += plain_row("indirect rays", keyed_count("costs.indirect_rays", rays.indirect));
  return "<table><caption>Work, the same on every machine</caption><tbody>\n" + rows + "</tbody></table>\n";
}

std::string whole_table(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string rows = plain_row("loading the scene", one_time("load", c.load_ms));
  rows += plain_row("building the ray tracer's hierarchy", one_time("accel_build", c.accel_build_ms));
  rows += plain_row("shading the ray-traced picture", one_time("picture", c.raytraced.picture_ms));
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    rows += plain_row("finding each pixel's ladder and label" +
                          (c.lights.size() > 1 ? ", " + escaped(shown_light_name(c, i)) : std::string()),
                      c.lights[i].classify.runs.empty()
                          ? "not timed"
                          : keyed(light_key(i, "times_ms.classify.median"), c.lights[i].classify.median(),
                                  milliseconds(c.lights[i].classify.median())));
  rows += plain_row("whole process, up to this page", one_time("total", in.total_ms));
  rows += plain_row("peak memory", byte_count(c.peak_memory_bytes));
  return "<table><caption>The rest of the run</caption><tbody>\n" + rows + "</tbody></table>\n";
}

// --- provenance ---

std::string entry(std::string_view name, const std::string& html) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html);
}

std::string text_entry(std::string_view name, std::string_view text) {
  return text.empty() ? std::string() : entry(name, escaped(text));
}

// In the page itself, unless it has files beside it: these two are among them.
std::string saving(const PageInput& in) {
  return fmt::format(
      R"(<p class="save"><a class="button" download="result.json" href="{}">Save result.json</a> <a
class="button" download="result.csv" href="{}">Save result.csv</a></p>
)",
      in.beside ? "result.json" : data_uri("application/json", in.json),
      in.beside ? "result.csv" : data_uri("text/csv", in.csv));
}

}  // namespace

std::string shown_light_name(const Comparison& c, std::size_t index) {
  const std::string& name = light_of(c, c.lights[index]).name;
  const std::uint32_t number = c.lights[index].light + 1;
  if (name.empty()) return fmt::format("light {}", number);
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    if (i != index && light_of(c, c.lights[i]).name == name)
      return fmt::format("{} (light {})", name, number);
  return name;
}

std::string light_key(std::size_t index, std::string_view rest) {
  return fmt::format("lights.{}.{}", index, rest);
}

std::string picture(const PageInput& in, const EncodedPicture& encoded, std::string_view alt,
                    std::string_view id) {
  return fmt::format(R"(<img{} src="{}" width="{}" height="{}" alt="{}">)",
                     id.empty() ? std::string() : fmt::format(" id=\"{}\"", id),
                     in.beside ? escaped(encoded.file_name) : data_uri("image/png", encoded.png),
                     encoded.size.width, encoded.size.height, escaped(alt));
}

std::string scroll_region(std::string_view label, std::string_view content) {
  return fmt::format(R"(<div class="scroll" role="region" tabindex="0" aria-label="{}">{}</div>
)",
                     label, content);
}

std::string cost_section(const PageInput& in) {
  return R"(<section id="cost" aria-labelledby="cost-title">
<h2 id="cost-title">Time and work</h2>
<p>Wall-clock medians on this machine, each pass finished before the clock stops.</p>
)" + time_table(in) +
         shadow_cost_table(in) + (in.budget != nullptr ? time_budget_block(*in.budget) : std::string()) +
         R"(<div class="columns">
<div>)" + work_table(in.comparison) +
         "</div>\n<div>" + whole_table(in) + "</div>\n</div>\n</section>\n";
}

std::string effects_section(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string rows;
  for (const EffectEntry& e : c.plan.entries) {
    std::string name(effect_name(e.effect));
    std::replace(name.begin(), name.end(), '_', ' ');
    const std::string_view state = e.simulated    ? "simulated"
                                   : e.called_for ? "asked for, not simulated"
                                                  : "not needed";
    rows += fmt::format(R"(<tr class="{}"><th scope="row">{}</th><td>{}</td><td>{}</td></tr>
)",
                        e.simulated    ? "on"
                        : e.called_for ? "lacking"
                                       : "off",
                        name, state, escaped(e.reason));
  }
  std::string notes;
  for (const std::string& note : c.world->scene->notes) notes += "<li>" + escaped(note) + "</li>\n";
  if (!notes.empty()) notes = "<h3>Notes</h3>\n<ul class=\"notes\">\n" + notes + "</ul>\n";
  const std::string table =
      R"(<table class="effects"><thead><tr><th scope="col">effect</th><th scope="col">here</th>
<th scope="col">because</th></tr></thead><tbody>
)" + rows +
      "</tbody></table>";
  return R"(<section id="effects" aria-labelledby="effects-title">
<h2 id="effects-title">What was simulated</h2>
<p>Only what the scene calls for runs; the rest costs nothing.</p>
)" + scroll_region("Effects", table) +
         notes + "</section>\n";
}

std::string provenance_section(const PageInput& in) {
  const Comparison& c = in.comparison;
  const Scene& scene = *c.world->scene;
  std::string out = text_entry("Scene", scene.path) + text_entry("SHA-256 of the scene file", scene.sha256);
  out += text_entry("Gnomon", program_version());
  out += entry("Threads and seed",
               fmt::format("{} and {}", keyed_count("threads", static_cast<std::uint64_t>(c.threads)),
                           keyed("seed", static_cast<double>(c.seed), fmt::format("{}", c.seed))));
  out += text_entry("Processor", fmt::format("{}, {} cores", c.machine.cpu, c.machine.cores));
  out += text_entry("System", c.machine.os);
  out += text_entry("OpenGL", fmt::format("{} through {}: {}", c.raster.context.version,
                                          c.raster.context.backend, c.raster.context.renderer));
  for (const raster::ReplacedShader& shader : c.raster.replaced_shaders)
    out += text_entry("Replaced shader", fmt::format("{}, SHA-256 {}", shader.name, shader.sha256));
  out += entry("Exposure of both pictures", keyed("exposure", c.exposure, plain_number(c.exposure)));
  return R"(<section id="provenance" aria-labelledby="provenance-title">
<h2 id="provenance-title">Where this comes from</h2>
<p class="command"><code>)" +
         escaped(c.command) + R"(</code></p>
<dl class="provenance">
)" + out +
         "</dl>\n" + saving(in) + "</section>\n";
}

}  // namespace gnomon::compare

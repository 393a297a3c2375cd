#include "report/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "compare/bias/bias_advice.h"
#include "compare/ladder/labels.h"
#include "compare/measure/reduced.h"
#include "compare/result/judged.h"
#include "compare/result/layout.h"
#include "compare/result/map_words.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/shadow_cost.h"
#include "compare/result/verdict.h"
#include "report/html.h"
#include "report/lessons.h"

namespace gnomon::report {
namespace {

using compare::Comparison;
using compare::Json;

using Json = nlohmann::ordered_json;

std::string hex(const glm::u8vec3& colour) {
  return hex_colour(colour.r, colour.g, colour.b);
}

/// Returns the lessons that the page shows: of the errors that occur, and of its own parts.
Json lesson_facts(const Comparison& c) {
  std::set<std::string_view> shown{"error-budget", "bias"};
  for (const compare::LightComparison& light : c.lights) {
    if (c.raster.options.map.technique == raster::Technique::hybrid) shown.insert("hybrid");
    for (std::size_t k = 0; k < compare::class_count; ++k)
      if (light.classes[k] > 0 || light.class_errors[k] > 0.0)
        shown.insert(lesson_of(static_cast<compare::Label>(k + 1)).name);
  }
  Json lessons = Json::object();
  for (const std::string_view name : shown) {
    const Lesson& one = lesson(name);
    lessons[std::string(name)] = {{"title", one.title}, {"html", lesson_html(one)}, {"command", one.command}};
  }
  return lessons;
}

/// "pcf shadows, map 1024 × 1024, d32f, bias 0.012 (0.5 texels; a texel is 0.024 wide), slope bias 1"
std::string map_words(const Comparison& c) {
  const raster::MapOptions& map = c.raster.options.map;
  if (!c.raster.has_known_map()) return "a shadow whose map is not known";
  if (raster::samples_rays(map.technique)) return "shadows of few rays, no map";
  const std::string_view how = c.judged && c.judged->identified ? "inferred: " : "";
  return fmt::format("{}{} shadows, map {}\u202f\u00d7\u202f{}", how, technique_name(map.technique), map.size,
                     map.size) +
         compare::map_details(c, c.lights.size() == 1 ? &c.lights[0] : nullptr);
}

Json depth_facts(const PageInput& in, std::size_t index) {
  const Comparison& c = in.comparison;
  if (!c.raster.has_map()) return nullptr;
  const LightView& view = compare::drawn_record(c, c.lights[index]).map.view;
  return {{"near", view.depth_range().min},
          {"far", view.depth_range().max},
          {"perspective", view.projection == LightProjection::perspective},
          {"texels_per_pixel", in.pictures.lights[index].depth_map_small_step}};
}

Json smaller_facts(const compare::BestBias& best) {
  if (!best.smaller) return nullptr;
  return {{"constant_world", best.smaller->constant_world}, {"wrong_fraction", best.smaller->wrong_fraction}};
}

Json light_facts(const PageInput& in, std::size_t index) {
  const Comparison& c = in.comparison;
  const compare::LightComparison& light = c.lights[index];
  const compare::Verdict verdict = compare::verdict_on(c, light);
  const bool has_curve = light.bias_curve_withheld.empty() && !light.bias_curve.empty();
  return {
      {"name", shown_light_name(c, index)},
      {"verdict", {{"headline", verdict.headline()}, {"detail", verdict.detail}, {"whole", verdict.whole()}}},
      {"window", compare::window_words(c, light)},
      {"contradiction",
       has_curve && !light.best_bias.feasible
           ? compare::contradiction(light.best_bias, light.bias_texel_world, c.raster.options.map.bias)
           : std::string()},
      {"smaller", smaller_facts(light.best_bias)},
      {"depth", depth_facts(in, index)}};
}

}  // namespace

Json label_facts() {
  Json list = Json::array();
  for (int k = static_cast<int>(compare::Label::uncertain); k <= static_cast<int>(compare::class_count);
       ++k) {
    const compare::LabelText& text = compare::label_text(static_cast<compare::Label>(k));
    list.push_back({{"value", k},
                    {"key", text.key},
                    {"name", text.name},
                    {"letter", text.letter},
                    {"what", text.what},
                    {"cause", text.cause},
                    {"cure", text.cure},
                    {"colour", hex(text.colour)},
                    {"lesson", text.lesson}});
  }
  return list;
}

Json rung_facts(compare::Ladder ladder) {
  Json list = Json::array();
  for (std::size_t k = 0; k < compare::rung_count; ++k) {
    const compare::RungText& rung = compare::rung_text(static_cast<compare::Rung>(k), ladder);
    Json json{{"symbol", rung.symbol}, {"name", rung.name}, {"what", rung.what}};
    if (k > 0) json["step"] = compare::step_text(static_cast<compare::Cause>(k - 1), ladder).name;
    list.push_back(std::move(json));
  }
  return list;
}

Json situation_facts(bool has_map) {
  Json list = Json::array();
  for (const compare::ShadowSituation& one : compare::shadow_situations())
    list.push_back({{"key", one.key}, {"words", one.words}, {"made", has_map ? one.made : one.made_of_rays}});
  return list;
}

Json report_facts(const PageInput& in) {
  const Comparison& c = in.comparison;
  Json lights = Json::array();
  for (std::size_t i = 0; i < c.lights.size(); ++i) lights.push_back(light_facts(in, i));
  Json facts{{"lessons", lesson_facts(c)},
             {"map", map_words(c)},
             {"bias_parts", compare::bias_parts(c.raster.options.map.bias)},
             {"compares_depths", compare::compares_depths(c)},
             {"edge_scale_texels", compare::edge_scale_texels},
             {"detachment_scale_texels", compare::detachment_scale_texels},
             {"reduced", reduced_words(c)},
             {"peak_memory_bytes", c.peak_memory_bytes},
             {"software_note", compare::software_note},
             {"shadow_situations", situation_facts(!raster::samples_rays(c.raster.options.map.technique))},
             {"light_facts", std::move(lights)}};
  if (c.judged) facts["judged"] = compare::judged_lines(c);
  if (in.introduction != nullptr) facts["tune"] = Json::parse(in.introduction->facts);
  return facts;
}

std::string reduced_words(const Comparison& c) {
  const int step = compare::image_step(c.raster.options.size);
  if (step == 1) return {};
  return fmt::format(
      "This page shows one pixel of every {0} \u00d7 {0} (a place is counted in these); its numbers, and the "
      "pictures in its folder, are of all pixels.",
      step);
}

std::string shown_light_name(const Comparison& c, std::size_t index) {
  const std::string& name = compare::light_of(c, c.lights[index]).name;
  const std::uint32_t number = c.lights[index].light + 1;
  if (name.empty()) return fmt::format("light {}", number);
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    if (i != index && compare::light_of(c, c.lights[i]).name == name)
      return fmt::format("{} (light {})", name, number);
  return name;
}

}  // namespace gnomon::report

#include "studies/commands/tune_answer.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/options/options.h"
#include "app/options/values.h"
#include "compare/result/engine_units.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "compare/result/text_layout.h"
#include "compare/result/views.h"
#include "scene/base/expected.h"

namespace gnomon::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t columns = 80;  // of a terminal

// The lines of a paragraph, the later ones indented.
std::string paragraph(std::string_view text, std::size_t indent) {
  std::string out;
  for (const std::string& line : compare::wrapped(text, columns - 2 * indent))
    out += std::string(out.empty() ? indent : 2 * indent, ' ') + line + "\n";
  return out;
}

// Engine, setting and value in columns; the formula as far as there is room, and on.
std::string unit_lines(const compare::EngineUnit& unit) {
  constexpr std::size_t before = 51;  // columns up to the formula
  std::string out, start = fmt::format("  {:<15} {:<20} {:<11} ", unit.engine, unit.setting,
                                       compare::plain_number(*unit.value));
  for (const std::string& line : compare::wrapped(unit.formula, columns - before)) {
    out += start + line + "\n";
    start = std::string(before, ' ');
  }
  return out;
}

// Where an engine has no number for this light, docs/engine-units.md and the JSON say why.
std::string units_text(const studies::TuneResult& result) {
  std::string out;
  for (const auto& [light, units, derived] : result.engine_units) {
    out += "\nThe bias in the units of engines" +
           (result.engine_units.size() > 1 ? fmt::format(", light '{}'", one_line(light)) : std::string()) +
           ", for a map of this size, width and depth:\n";
    for (const compare::EngineUnit& unit : units)
      if (unit.value) out += unit_lines(unit);
    for (const auto& [layer, text] : compare::layer_lines(derived))
      out += paragraph(fmt::format("{}: {}", layer, text), 2);
  }
  return out.empty() ? out
                     : out + "docs/engine-units.md explains the symbols, and what engines have no number.\n";
}

Json units_json(const studies::TuneResult& result) {
  Json list = Json::array();
  for (const auto& [light, units, derived] : result.engine_units)
    list.push_back({{"light", light},
                    {"units", compare::engine_units_json(units)},
                    {"derived_bias", compare::derived_bias_json(derived)}});
  return list;
}

Json just_over_json(const studies::TuneResult& result) {
  Json list = Json::array();
  for (const studies::JustOver& over : result.just_over)
    list.push_back({{"family", result.families[over.family].family.name},
                    {"map_size", over.attempt.size},
                    {"error", over.attempt.error},
                    {"time_ms", over.attempt.time_ms}});
  return list;
}

Json goal_json(const studies::TuneGoal& goal) {
  if (!goal.max_error) return {{"max_time_ms", *goal.max_time_ms}};
  return {{"threshold", compare::threshold_text(*goal.max_error)},
          {"measure", goal.max_error->measure->measure.name},
          {"limit", goal.max_error->limit}};
}

/// The figures that a threshold may be held against and that every search makes, and those of films.
bool is_made(const compare::Figure& figure) {
  using enum compare::FigureNeeds;
  return !figure.measure.name.empty() && (figure.needs == nothing || figure.needs == film);
}

Json family_json(const TuneAnswer& answer, std::size_t i) {
  const studies::FamilyResult& family = answer.result.families[i];
  const studies::Attempt& attempt = attempt_of(family);
  Json options = Json::object();
  for (const auto& [name, value] : answer.values(i, attempt)) options[name] = value;
  Json json{{"command", answer.line(i)},
            {"technique", options.value("technique", std::string("hard"))},
            {"options", options},
            {"error", attempt.error}};
  json.update(compare::named_figures(attempt.figures, is_made));
  json.update(
      {{"time_ms", attempt.time_ms},
       {"runs_ms", attempt.times.runs},
       {"costs",
        {{"map_texels", attempt.map_texels}, {"map_bytes", attempt.map_bytes}, {"rays", attempt.rays}}},
       {"custom_shader", attempt.custom_shader},
       {"feasible", family.answer.has_value()},
       {"why", family.why}});
  return json;
}

}  // namespace

OptionValues answer_values(const OptionValues& fixed, const OptionFamily& family,
                           const studies::Attempt& attempt) {
  OptionValues values;
  for (const auto& entry : fixed)
    if (entry.first != "map-size") values.push_back(entry);
  values.insert(values.end(), family.values.begin(), family.values.end());
  std::erase_if(values,
                [](const auto& entry) { return entry.first == "bias" || entry.first == "slope-bias"; });
  const raster::MapOptions& map = family.tuned.map;
  values.emplace_back("map-size", std::to_string(attempt.size));
  if (!attempt.reads_bias) return values_read(values);
  if (map.bias.slope != 0.0) values.emplace_back("slope-bias", number_text(map.bias.slope));
  values.emplace_back("bias", raster::bias_text(attempt.bias));
  return values_read(values);
}

OptionValues TuneAnswer::values(std::size_t family, const studies::Attempt& attempt) const {
  return settled_values(question.scene.name, answer_values(question.fixed, families[family], attempt));
}

std::string TuneAnswer::line(std::size_t family) const {
  return line(family, attempt_of(result.families[family]));
}

std::string TuneAnswer::line(std::size_t family, const studies::Attempt& attempt) const {
  const auto option = [](const char* name, const std::string& value) {
    return value.empty() ? std::string() : fmt::format(" {} {}", name, shell_quoted(value));
  };
  const bool filmed = question.asked.is_filmed();
  return (filmed ? "gnomon shimmer " : "gnomon compare ") + question.scene.words() +
         option("--camera", question.camera) + setting_arguments(values(family, attempt)) +
         (filmed ? film_arguments(question.asked.film)
                 : measure_argument(*question.asked.measure) +
                       view_arguments(question.views, question.asked.film, false)) +
         option("--shader-dir", question.shader_folder) + max_lights_argument(question.max_lights) +
         backend_argument(question.backend);
}

std::vector<std::size_t> TuneAnswer::others() const {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < result.families.size(); ++i)
    if (i != result.winner && result.families[i].is_tried()) order.push_back(i);
  const auto rank = [&](std::size_t i) {
    const studies::FamilyResult& f = result.families[i];
    const studies::Attempt& a = attempt_of(f);
    const bool by_time = question.goal.max_error.has_value() == f.answer.has_value();
    return std::pair(!f.answer.has_value(), by_time ? a.time_ms : a.error);
  };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rank(a) < rank(b); });
  return order;
}

constexpr std::size_t rivals_shown = 2;

std::vector<std::size_t> TuneAnswer::rivals() const {
  std::vector<std::size_t> rivals;
  const auto has_technique = [&](raster::Technique technique) {
    return std::ranges::any_of(
        rivals, [&](std::size_t i) { return result.families[i].family.map.technique == technique; });
  };
  for (const bool of_engines : {true, false})
    for (const std::size_t i : others()) {
      const raster::MapOptions& map = result.families[i].family.map;
      if (compare::any_engine_draws(map) != of_engines || has_technique(map.technique)) continue;
      if (map.technique == result.families[result.winner].family.map.technique) continue;
      if (rivals.size() < rivals_shown) rivals.push_back(i);
    }
  return rivals;
}

namespace {

/// What the table's column of errors is about: "error (wrong and mean)", "error (flip)".
std::string error_head(const compare::Figure& measure) {
  return fmt::format("error ({})", measure.measure.name);
}

std::string row_text(const studies::FamilyResult& family, const studies::TuneGoal& goal) {
  const studies::Attempt& a = family.attempt();
  const std::string size = family.family.has_map() ? std::to_string(a.size) : "-";
  return fmt::format("  {:<34} {:>6} {:>10} {:>10}  {}\n", family.family.name, size,
                     compare::milliseconds(a.time_ms), compare::byte_count(a.map_bytes),
                     compare::figure_words(a.figures, goal.measure()));
}

// Those of the engine that was asked about, of the first light.
std::string own_units(const TuneAnswer& answer) {
  if (answer.question.engine == nullptr || answer.result.engine_units.empty()) return {};
  const auto& [light, units, derived] = answer.result.engine_units.front();
  const std::string_view engine = answer.question.engine->name;
  std::string text = fmt::format("In {}, for a map of this size, width and depth:\n", engine);
  for (const compare::EngineUnit& unit : units)
    if (unit.engine == engine)
      text += unit.value ? fmt::format("  {} {}\n", unit.setting, compare::plain_number(*unit.value))
                         : fmt::format("  {}: no number, {}\n", unit.setting, unit.formula);
  return text;
}

std::string untried_text(const TuneAnswer& answer) {
  std::vector<std::string> names;
  for (const studies::FamilyResult& family : answer.result.families)
    if (!family.is_tried()) names.push_back(family.family.name);
  if (names.empty()) return {};
  const std::string why = answer.question.quick && answer.result.feasible
                              ? "Not tried, since another is good enough (--quick)"
                              : fmt::format("Not tried within {} s of processor time (--time-limit)",
                                            compare::plain_number(answer.question.most_seconds));
  return paragraph(fmt::format("{}: {}.", why, fmt::join(names, "; ")), 0);
}

std::string begin_of(const TuneAnswer& answer) {
  const studies::FamilyResult& winner = answer.result.families[answer.result.winner];
  std::string text = answer.line(answer.result.winner) + "\n\n";
  if (!answer.result.feasible) text += "The goal cannot be met by what was tried.\n";
  text += paragraph(fmt::format("{}: {}.", winner.family.name, winner.why), 0);
  const std::string views = compare::views_line(answer.result.views);
  return views.empty() ? text : text + paragraph(views, 0);
}

}  // namespace

std::string TuneAnswer::text() const {
  std::string text = begin_of(*this);
  text += fmt::format("\n  {:<34} {:>6} {:>10} {:>10}  {}\n", "", "texels", "time", "map",
                      error_head(question.goal.measure()));
  text += row_text(result.families[result.winner], question.goal);
  for (const std::size_t i : rivals()) text += row_text(result.families[i], question.goal);
  text += own_units(*this) + untried_text(*this);
  return text + fmt::format("{} {}s; -v says why the others lost{}\n", result.renders,
                            question.asked.is_filmed() ? "film" : "drawing",
                            question.engine == nullptr ? ", and the bias in the units of engines" : "");
}

std::string TuneAnswer::whole_text() const {
  std::string text = begin_of(*this);
  text +=
      fmt::format("{} {}{} made; the command's own {} gave the error.\n", result.renders,
                  question.asked.is_filmed() ? "film" : "drawing", result.renders == 1 ? " was" : "s were",
                  question.asked.is_filmed() ? "film" : "comparison");
  text += untried_text(*this);
  text += units_text(result);
  const std::vector<std::size_t> order = others();
  if (!order.empty()) text += "\nThe others:\n";
  for (const std::size_t i : order)
    text += paragraph(fmt::format("{}: {}.", result.families[i].family.name, result.families[i].why), 2);
  return text;
}

std::string TuneAnswer::json() const {
  Json json = family_json(*this, result.winner);
  json["feasible"] = result.feasible;
  json["goal"] = goal_json(question.goal);
  json["as_fast"] = result.families[result.winner].as_fast;
  json["just_over_limit"] = just_over_json(result);
  json["renders"] = result.renders;
  if (!result.views.views.empty()) json["views"] = compare::views_json(result.views);
  json["untried"] = Json::array();
  for (const studies::FamilyResult& family : result.families)
    if (!family.is_tried()) json["untried"].push_back(family.family.name);
  json["engine_units"] = units_json(result);
  json["shaders"] = compare::shaders_json(question.shaders);
  json["others"] = Json::array();
  for (const std::size_t i : others()) json["others"].push_back(family_json(*this, i));
  return compare::dumped(json, 2);
}

}  // namespace gnomon::app

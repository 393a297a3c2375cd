#include "studies/tune/page.h"

#include <algorithm>
#include <cmath>

#include "compare/bias/bias_advice.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "raster/technique_traits.h"

namespace gnomon::studies {
namespace {

using compare::Json;

std::string goal_text(const TuneGoal& goal) {
  return goal.max_error ? compare::limit_words(*goal.max_error)
                        : "at most " + compare::milliseconds(*goal.max_time_ms) + " for map and shading";
}

bool reads_bias(const TuneFamily& family, const Attempt& attempt) {
  return compares_depths(family.map.technique) && attempt.reads_bias;
}

// World units, "0.25 texel", "auto": the constant in the unit that the command asks for it in.
std::string constant_words(const raster::Bias& bias) {
  if (bias.unit == raster::BiasUnit::automatic) return "auto";
  return bias.unit == raster::BiasUnit::world ? compare::plain_number(bias.constant)
                                              : compare::texels_text(bias.constant, 3);
}

Json family_json(const TunePageInput& in, std::size_t i) {
  const FamilyResult& family = in.result.families[i];
  const Attempt& a = family.attempt();
  const compare::Figure& measure = in.goal.measure();
  return {{"name", family.family.name},
          {"technique", technique_name(family.family.map.technique)},
          {"why", family.why},
          {"command", in.commands[i]},
          {"size", family.family.has_map() ? Json(a.size) : Json(nullptr)},
          {"bias", reads_bias(family.family, a) ? Json(constant_words(a.bias)) : Json(nullptr)},
          {"words", compare::figure_words(a.figures, measure)},
          {"wrong_fraction", number(a.figures.error.wrong_fraction)},
          {"mean_absolute", number(a.figures.error.mean_absolute)},
          {"figure", number(measure.of(a.figures))},
          {"time_ms", number(a.time_ms)}};
}

/// The families as the page lists them: the winner first.
std::vector<std::size_t> listed(const TunePageInput& in) {
  std::vector<std::size_t> order{in.result.winner};
  order.insert(order.end(), in.order.begin(), in.order.end());
  return order;
}

/// The sizes that were drawn again have the times of that.
void add_tried(const TunePageInput& in, std::size_t family, std::size_t place, Json& list) {
  const FamilyResult& result = in.result.families[family];
  const Attempt& chosen = result.attempt();
  for (const Attempt& drawn : result.tried) {
    const Attempt& a = drawn.size == chosen.size ? chosen : drawn;
    if (!(a.time_ms > 0.0)) continue;
    list.push_back({{"family", place},
                    {"size", result.family.has_map() ? Json(a.size) : Json(nullptr)},
                    {"error", number(a.error)},
                    {"time_ms", number(a.time_ms)},
                    {"words", compare::figure_words(a.figures, in.goal.measure())},
                    {"answer", family == in.result.winner && &a == &chosen}});
  }
}

/// Where its gaps tell the error of every bias.
void add_line(const FamilyResult& family, std::size_t place, Json& list) {
  const Attempt& a = family.attempt();
  if (a.curve.size() < 2 || !(a.texel_world > 0.0)) return;
  Json texels = Json::array(), shares = Json::array();
  for (const compare::BiasCurvePoint& p : a.curve) {
    texels.push_back(number(p.bias / a.texel_world));
    shares.push_back(number(p.wrong_fraction));
  }
  list.push_back({{"family", place},
                  {"size", a.size},
                  {"good", family.answer.has_value()},
                  {"cost", number(a.cost)},
                  {"error", number(a.error)},
                  {"texels", std::move(texels)},
                  {"shares", std::move(shares)},
                  {"best_texels", number(a.best.constant_world / a.texel_world)},
                  {"best_share", number(a.best.wrong_fraction)}});
}

}  // namespace

report::PageIntroduction tune_introduction(const TunePageInput& in) {
  const FamilyResult& winner = in.result.families[in.result.winner];
  const Attempt& a = winner.attempt();
  const compare::Figure& measure = in.goal.measure();
  const bool proven = !in.result.feasible && has_proof(a, measure);
  const std::vector<std::size_t> order = listed(in);
  Json families = Json::array(), tried = Json::array(), lines = Json::array();
  for (std::size_t place = 0; place < order.size(); ++place)
    families.push_back(family_json(in, order[place]));
  for (std::size_t i = 0; i < in.result.families.size(); ++i) {
    const auto place = static_cast<std::size_t>(std::find(order.begin(), order.end(), i) - order.begin());
    add_tried(in, i, place, tried);
    add_line(in.result.families[i], place, lines);
  }
  const Json facts{
      {"scene", in.scene},
      {"wanted", goal_text(in.goal)},
      {"feasible", in.result.feasible},
      {"max_error", in.goal.max_error ? compare::number(in.goal.max_error->limit) : Json(nullptr)},
      {"max_time_ms", in.goal.max_time_ms ? compare::number(*in.goal.max_time_ms) : Json(nullptr)},
      {"shares", measure.form() == compare::FigureForm::percent},
      {"head",
       measure.form() == compare::FigureForm::percent ? std::string() : compare::figure_head(measure)},
      {"films", measure.needs == compare::FigureNeeds::film},
      {"renders", in.result.renders},
      {"proof",
       proven ? compare::contradiction(a.best, a.texel_world, winner.family.map.bias) : std::string()},
      {"proof_has_both", proven && compare::names_both_bounds(a.best)},
      {"families", std::move(families)},
      {"tried", std::move(tried)},
      {"lines", std::move(lines)}};
  return {"Tuning " + in.scene + " \u2013 Gnomon",
          facts.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

}  // namespace gnomon::studies

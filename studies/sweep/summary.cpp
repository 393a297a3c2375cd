#include "studies/sweep/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/result/result_parts.h"
#include "scene/base/parallel.h"
#include "studies/sweep/rounds.h"

namespace gnomon::studies {
namespace {

using compare::Json;

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : not_known;
}

std::string value_text(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// By label, the share of the mean error. Sweeps made before have counts of wrong pixels alone.
Json label_shares(const Json& light) {
  if (light.contains("class_errors")) return light.at("class_errors");
  const double compared = std::max(1.0, light.at("pixels").at("compared").get<double>());
  Json shares = light.at("classes");
  for (Json& share : shares) share = share.get<double>() / compared;
  return shares;
}

void add_light(const Json& light, CellSummary& sum, Json& classes) {
  sum.lights.push_back(compare::read_pooled_figures(light));
  const auto compared = light.at("pixels").at("compared").get<double>();
  const Json shares = label_shares(light);
  for (const auto& [name, share] : shares.items())
    classes[name] = classes.value(name, 0.0) + share.get<double>() * compared;
}

std::string main_label(const Json& classes) {
  double most = 0.0;
  std::string label;
  for (const auto& [name, error] : classes.items())
    if (error.get<double>() > most) most = error.get<double>(), label = name;
  return label;
}

Times times_of(const Json& times) {
  return {times.at("runs").get<std::vector<double>>()};
}

void add_times(const Json& times, CellSummary& sum) {
  sum.cell = times.at("cell").get<std::size_t>();
  sum.derived = times.at("derived").get<bool>();
  sum.rays_ms = number(times.at("primary_rays").at("median"));
  sum.load = number(times.value("load", Json()));
  std::optional<compare::ShadowParts> parts;
  for (const Json& light : times.at("lights")) {
    const compare::ShadowParts own = read_shadow_parts(light, times);
    parts ? * parts += own : parts.emplace(own);
    sum.rays_ms += number(light.at("exact_shadows").at("median"));
    sum.exact_shadow_ms += number(light.at("exact_shadows").at("median"));
    for (const char* pass : {"map_pass", "shade_pass"}) {
      sum.raster_ms += number(light.at(pass).at("median"));
      if (const Times times = times_of(light.at(pass)); !times.runs.empty()) sum.raster.add_part(times);
    }
  }
  if (parts) sum.costs = compare::shadow_costs(*parts);
}

/// What --measure asked for; a configuration without it, or with a film, has none.
const compare::Figure* measure_of(const SweepHeader& header) {
  const Json configuration = Json::parse(header.configuration, nullptr, false);
  if (!configuration.is_object()) return &compare::wrong_and_mean();
  const compare::Figure* asked = compare::find_measure(configuration.value("measure", std::string()));
  return asked == nullptr ? &compare::wrong_and_mean() : asked;
}

}  // namespace

Expected<CellSummary> summarise(std::string_view line, std::string_view times) {
  try {
    const Json json = Json::parse(line);
    CellSummary sum;
    for (const auto& [name, value] : json.at("axes").items()) sum.axes.emplace_back(name, value_text(value));
    sum.no_effect = json.value("no_effect", std::vector<std::string>{});
    sum.command = json.at("command").get<std::string>();
    Json classes = Json::object();
    for (const Json& light : json.at("lights")) {
      add_light(light, sum, classes);
      sum.technique = light.at("map").at("technique").get<std::string>();
      sum.map_size = number(light.at("map").at("size"));
    }
    sum.figures = compare::pool_lights(sum.lights), sum.main_label = main_label(classes);
    sum.map_texels = json.at("costs").at("map_texels").get<std::uint64_t>();
    sum.map_bytes = json.at("costs").at("map_bytes").get<std::uint64_t>();
    add_times(Json::parse(times), sum);
    return sum;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::bad_input, std::string("not a line of a sweep: ") + error.what());
  }
}

Expected<std::vector<CellSummary>> summarise(const SweepLines& sweep) {
  const compare::Figure* asked = measure_of(sweep.header);
  std::vector<Expected<CellSummary>> read(sweep.lines.size());
  parallel_for(read.size(), [&](std::size_t i) { read[i] = summarise(sweep.lines[i], sweep.times[i]); });
  std::vector<CellSummary> cells;
  for (Expected<CellSummary>& cell : read) {
    if (!cell) return fail(cell.error());
    cell->asked = asked;
    cells.push_back(std::move(*cell));
  }
  return cells;
}

bool clearly_faster(const CellSummary& a, const CellSummary& b) {
  return a.tells_time() && b.tells_time() && gnomon::clearly_faster(a.raster, b.raster, false);
}

bool share_one_drawing(const std::vector<CellSummary>& cells) {
  const auto same_but_bias = [&](const CellSummary& cell) {
    return std::ranges::equal(cell.axes, cells.front().axes, [](const auto& a, const auto& b) {
      return a.first == b.first && (a.second == b.second || a.first == "bias");
    });
  };
  return cells.size() > 1 && std::ranges::any_of(cells, &CellSummary::derived) &&
         std::ranges::all_of(cells, same_but_bias);
}

namespace {

// Of cells with equal errors, from `first` to `last` (excluded).
template <class Iterator>
std::size_t least_cost(const std::vector<CellSummary>& cells, Iterator first, Iterator last) {
  const auto fastest = *std::min_element(
      first, last, [&](std::size_t a, std::size_t b) { return cells[a].raster_ms < cells[b].raster_ms; });
  std::size_t best = fastest;
  for (; first != last; ++first) {
    const CellSummary &c = cells[*first], &b = cells[best];
    if (clearly_faster(cells[fastest], c)) continue;
    if (std::pair(c.map_texels, c.map_bytes) < std::pair(b.map_texels, b.map_bytes)) best = *first;
  }
  return best;
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<CellSummary>& cells) {
  if (share_one_drawing(cells)) return {};
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].tells_time()) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cells[a].error() < cells[b].error(); });
  std::vector<std::size_t> front;
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(),
                                   [&](std::size_t i) { return cells[i].error() > cells[*first].error(); });
    const std::size_t best = least_cost(cells, first, last);
    if (front.empty() || clearly_faster(cells[best], cells[front.back()])) front.push_back(best);
    first = last;
  }
  std::reverse(front.begin(), front.end());
  return front;
}

}  // namespace gnomon::studies

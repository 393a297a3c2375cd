#include "studies/sweep/rounds.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "compare/result/figures.h"
#include "compare/result/output_parts.h"
#include "compare/result/result_parts.h"

namespace gnomon::studies {
namespace {

using compare::Json;

constexpr std::array repeated_passes{"map_pass", "shade_pass", "unshadowed_pass"};

Times read_times(const Json& times) {
  return {times.at("runs").get<std::vector<double>>()};
}

std::vector<TimedStrip> read_strips(const Json& light) {
  std::vector<TimedStrip> strips;
  for (const Json& strip : light.value("shading_strips", Json::array()))
    strips.push_back({{strip.at("shade_pass").get<std::vector<double>>()},
                      {strip.at("unshadowed_pass").get<std::vector<double>>()}});
  return strips;
}

TimeDifference read_lookups(const Json& light) {
  const std::vector<TimedStrip> strips = read_strips(light);
  return strips.empty()
             ? beyond_part(read_times(light.at("shade_pass")), read_times(light.at("unshadowed_pass")))
             : beyond_part(strips);
}

void append_runs(const Json& from, Json& to) {
  for (const Json& run : from) to.push_back(run);
}

void add_runs(const Json& round, Json& light) {
  for (const char* pass : repeated_passes) {
    append_runs(round.at(pass), light.at(pass).at("runs"));
    light.at(pass) = compare::times_json(read_times(light.at(pass)));
  }
  if (!light.contains("shading_strips")) return;
  Json& strips = light.at("shading_strips");
  for (std::size_t i = 0; i < strips.size(); ++i)
    for (const char* pass : {"shade_pass", "unshadowed_pass"})
      append_runs(round.at("shading_strips").at(i).at(pass), strips.at(i).at(pass));
}

void write_differences(Json& light, const Json& line) {
  light["shadow_lookups"] = compare::difference_json(read_lookups(light));
  compare::LightFigures figures;
  figures.shadow_costs = compare::shadow_costs(read_shadow_parts(light, line));
  if (figures.shadow_costs) light["shadows"] = compare::block_json("times_ms.shadows", figures);
}

/// `rounds`: the lines of one cell.
std::string joined(const std::vector<const std::string*>& rounds) {
  Json line = Json::parse(*rounds.front());
  for (std::size_t r = 1; r < rounds.size(); ++r) {
    const Json round = Json::parse(*rounds[r]);
    if (round.at("cell") != line.at("cell")) throw Json::other_error::create(501, "another cell", nullptr);
    for (std::size_t i = 0; i < line.at("lights").size(); ++i)
      add_runs(round.at("lights").at(i), line.at("lights").at(i));
    if (round.at("load").is_number() && line.at("load").is_number())
      line["load"] = std::max(line.at("load").get<double>(), round.at("load").get<double>());
  }
  for (Json& light : line.at("lights")) write_differences(light, line);
  return compare::on_one_line(line);
}

}  // namespace

Json round_json(const std::vector<raster::LightRecord>& lights, std::size_t cell,
                const compare::MachineInfo& machine) {
  Json list = Json::array();
  for (const raster::LightRecord& light : lights)
    list.push_back({{"map_pass", light.map_pass.runs},
                    {"shade_pass", light.shade_pass.runs},
                    {"unshadowed_pass", light.unshadowed_pass.runs},
                    {"shading_strips", compare::strips_json(light.strips)}});
  return {{"cell", cell}, {"load", compare::load_json(machine)}, {"lights", std::move(list)}};
}

Expected<std::vector<std::string>> joined_rounds(const std::vector<std::string>& times, std::size_t cells) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(cells, times.size()); ++i) try {
      std::vector<const std::string*> rounds;
      for (std::size_t k = i; k < times.size(); k += cells) rounds.push_back(&times[k]);
      out.push_back(rounds.size() == 1 ? times[i] : joined(rounds));
    } catch (const Json::exception& error) {
      return fail(ErrorKind::bad_input,
                  fmt::format("not the times of a sweep's cell {}: {}", i, error.what()));
    }
  return out;
}

/// The name as ShadowParts has it, which outlives the line.
std::string_view side_named(const std::string& name) {
  for (const raster::TechniqueTraits& technique : raster::all_technique_traits())
    if (compare::shadow_side(technique.technique) == name) return compare::shadow_side(technique.technique);
  return "map";
}

compare::ShadowParts read_shadow_parts(const Json& light, const Json& line) {
  const Json tree = line.value("accel_build", Json());
  return {.map = with_spread(read_times(light.at("map_pass"))),
          .lookups = read_lookups(light),
          .rays = with_spread(read_times(light.at("exact_shadows"))),
          .tree = tree.is_object() ? with_spread(read_times(tree)) : TimeDifference{},
          .by = side_named(line.value("by", "map"))};
}

}  // namespace gnomon::studies

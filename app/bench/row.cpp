#include "app/bench/row.h"

#include <nlohmann/json.hpp>

#include "app/machine.h"

namespace gnomon::app {

std::optional<double> BenchRow::ratio() const {
  if (!peer || (more_is_better ? peer->value : value) == 0.0) return std::nullopt;
  return more_is_better ? value / peer->value : peer->value / value;
}

std::optional<bool> BenchRow::met() const {
  if (!peer || !goal) return std::nullopt;
  const std::optional<double> r = ratio();
  return !r || *r >= *goal;
}

std::string bench_json(std::span<const BenchRow> rows, std::string_view target) {
  const auto or_null = [](const auto& v) { return v ? nlohmann::ordered_json(*v) : nullptr; };
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BenchRow& row : rows) {
    list.push_back({{"name", row.name},
                    {"scene", row.scene},
                    {"threads", row.threads},
                    {"value", row.value},
                    {"unit", row.unit},
                    {"peer", row.peer ? nlohmann::ordered_json(row.peer->name) : nullptr},
                    {"peer_value", row.peer ? nlohmann::ordered_json(row.peer->value) : nullptr},
                    {"ratio", or_null(row.ratio())},
                    {"goal", or_null(row.goal)},
                    {"met", or_null(row.met())}});
  }
  const compare::MachineInfo machine = machine_info();
  nlohmann::ordered_json document{
      {"schema", "gnomon/bench/1"},
      {"machine", {{"cpu", machine.cpu}, {"cores", machine.cores}, {"os", machine.os}}}};
  if (!target.empty()) document["target"] = target;
  document["rows"] = std::move(list);
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace gnomon::app

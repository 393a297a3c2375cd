#include "benchmark/row.h"

#include <nlohmann/json.hpp>

#include "compare/result/result_parts.h"

namespace gnomon::bench {

std::optional<double> BenchRow::ratio() const {
  if (!peer || (more_is_better ? peer->value : value) == 0.0) return std::nullopt;
  return more_is_better ? value / peer->value : peer->value / value;
}

std::optional<bool> BenchRow::met() const {
  if (!peer || !goal) return std::nullopt;
  const std::optional<double> r = ratio();
  return !r || *r >= *goal;
}

std::string bench_json(std::span<const BenchRow> rows, const compare::MachineInfo& machine,
                       std::string_view target) {
  const auto or_null = [](const auto& v) { return v ? compare::Json(*v) : nullptr; };
  compare::Json list = compare::Json::array();
  for (const BenchRow& row : rows) {
    list.push_back({{"name", row.name},
                    {"scene", row.scene},
                    {"threads", row.threads},
                    {"value", row.value},
                    {"unit", row.unit},
                    {"peer", row.peer ? compare::Json(row.peer->name) : nullptr},
                    {"peer_value", row.peer ? compare::Json(row.peer->value) : nullptr},
                    {"ratio", or_null(row.ratio())},
                    {"goal", or_null(row.goal)},
                    {"met", or_null(row.met())},
                    {"exponent", or_null(row.exponent)}});
  }
  compare::Json document{{"schema", "gnomon/bench/1"}, {"machine", compare::machine_json(machine)}};
  if (!target.empty()) document["target"] = target;
  document["rows"] = std::move(list);
  return compare::dumped(document, 2);
}

}  // namespace gnomon::bench

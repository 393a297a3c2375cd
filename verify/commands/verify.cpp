// gnomon verify: the hard cases, run on this machine, as a table.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "app/session.h"
#include "verify/verify.h"

namespace gnomon::app {

namespace {

using verify::Row;

struct VerifyCommand {
  verify::Options options;
  std::vector<int> cases;  ///< none: all
  std::string json;
  int threads = 0;
  bool quiet = false;
};

std::string case_numbers() {
  std::string text;
  for (const verify::Case& c : verify::all_cases())
    text += fmt::format("{}{}", text.empty() ? "" : ", ", c.number);
  return text;
}

/// JSON has no infinity: an error that is not a number stands as null.
nlohmann::ordered_json error_json(double worst) {
  return std::isfinite(worst) ? nlohmann::ordered_json(worst) : nlohmann::ordered_json();
}

nlohmann::ordered_json outcome_json(const verify::Outcome& outcome) {
  return {{"tried", outcome.tried}, {"wrong", outcome.wrong}, {"worst", error_json(outcome.worst)}};
}

std::string rows_json(const std::vector<Row>& rows, raytrace::Precision precision) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    list.push_back({{"case", row.name},
                    {"number", row.number},
                    {"tried", row.outcome.tried},
                    {"wrong", row.outcome.wrong},
                    {"worst", error_json(row.outcome.worst)},
                    {"bound", row.bound},
                    {"unit", row.unit},
                    {"ok", row.ok()}});
    if (!row.skipped.empty()) list.back()["skipped"] = row.skipped;
    if (row.naive) list.back()["naive"] = outcome_json(*row.naive);
  }
  const nlohmann::ordered_json document{
      {"schema", "gnomon/verify/1"}, {"precision", raytrace::precision_name(precision)}, {"rows", list}};
  return document.dump(2) + "\n";
}

std::string error_text(const Row& row, double worst) {
  return row.unit.empty() ? "-" : fmt::format("{:.3g}", worst);
}

std::string naive_text(const Row& row) {
  if (!row.naive) return "";
  const auto tried = static_cast<double>(std::max<std::uint64_t>(row.naive->tried, 1));
  return fmt::format("{:>11}{:>9.3g}%{:>10}  ", row.naive->wrong,
                     100.0 * static_cast<double>(row.naive->wrong) / tried,
                     error_text(row, row.naive->worst));
}

std::string table_row(const Row& row) {
  if (!row.skipped.empty())
    return fmt::format("{:>4}  {:<44}skipped: {}\n", row.number, row.name, row.skipped);
  return fmt::format("{:>4}  {:<44}{:>11}{:>10}{:>10}{:>8}  {:<4}{}{}\n", row.number, row.name,
                     row.outcome.tried, row.outcome.wrong, error_text(row, row.outcome.worst),
                     error_text(row, row.bound), row.ok() ? "ok" : "NO", naive_text(row), row.unit);
}

std::string table_head(bool with_naive) {
  return fmt::format("{:>4}  {:<44}{:>11}{:>10}{:>10}{:>8}  {:<4}{}{}\n", "no.", "case", "tried", "wrong",
                     "worst", "bound", "", with_naive ? "naive wrong         %     worst  " : "",
                     "unit of worst and bound");
}

bool is_chosen(const VerifyCommand& command, int number) {
  return command.cases.empty() ||
         std::find(command.cases.begin(), command.cases.end(), number) != command.cases.end();
}

Expected<ExitCode> run_verify(const VerifyCommand& command) {
  Console console(command.quiet);
  if (const auto writable = check_output_file(command.json); !writable) return fail(writable.error());
  const bool shows_table = !command.quiet && command.json != "-";
  if (shows_table) print_data(table_head(command.options.show_naive));
  std::vector<Row> all;
  for (const verify::Case& c : verify::all_cases()) {
    if (!is_chosen(command, c.number)) continue;
    const auto progress = [&](std::string_view row, double done) {
      console.progress(fmt::format("case {}: {}", c.number, row), done);
    };
    for (Row& row : verify::run_case(c, command.options, progress)) {
      row.name = fmt::format("{}: {}", c.name, row.name);
      console.clear_progress();
      if (shows_table) print_data(table_row(row));
      all.push_back(std::move(row));
    }
  }
  if (const auto out = hand_out_json(command.json, rows_json(all, command.options.precision)); !out)
    return fail(out.error());
  const auto failed = std::count_if(all.begin(), all.end(), [](const Row& row) { return !row.ok(); });
  if (failed > 0) console.message(fmt::format("{} of {} rows fall short", failed, all.size()));
  return failed > 0 ? ExitCode::threshold_exceeded : ExitCode::done;
}

Expected<void> store_cases(std::vector<int>& cases, const std::string& text) {
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    const auto known = verify::all_cases();
    const Expected<std::int64_t> number =
        parse_integer(text.substr(start, end - start), 1, known.back().number);
    if (!number) return fail(number.error());
    const bool exists =
        std::any_of(known.begin(), known.end(), [&](const auto& c) { return c.number == *number; });
    if (!exists)
      return fail(ErrorKind::usage,
                  fmt::format("no such case (got {}, allowed {})", *number, case_numbers()));
    cases.push_back(static_cast<int>(*number));
    start = end + 1;
  }
  return {};
}

}  // namespace

GNOMON_COMMAND(verify, 110,
               "Run the hard cases of ray tracing and of shadow maps on this machine: how many were wrong, "
               "and the worst error.") {
  app->footer(
      "gnomon verify --rays 1e8\n"
      "gnomon verify --show-naive --case 1,5,10\n"
      "gnomon verify --case 1,25 --json -\n"
      "Exits with 1 when a case falls short.");
  const auto command = std::make_shared<VerifyCommand>();
  add_ray_count(*app, command->options.rays);
  add_checked(*app, "--case", "N[,N]", "run these cases only [numbers of the table; default all]",
              [command](const std::string& text) { return store_cases(command->cases, text); });
  add_precision(*app, command->options.precision);
  app->add_flag(
      "--show-naive", command->options.show_naive,
      "set the textbooks' formulation beside it, on the same rays: float Moeller-Trumbore, a slab test that "
      "lets NaN through, the naive quadratic, a fixed epsilon [default off]");
  add_seed(*app, command->options.seed,
           "of the random rays; the same seed gives the same table on any machine");
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_json(*app, command->json, "the table");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_verify(*command); }; });
}

}  // namespace gnomon::app

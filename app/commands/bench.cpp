// gnomon bench: what the acceleration structures cost and bring on a scene, as a table.
#include <fmt/format.h>

#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/bench/row.h"
#include "app/invocation.h"
#include "app/options.h"
#include "app/output_path.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct BenchCommand {
  std::string scene, json;
  ImageSize size{640, 360};
  std::vector<raytrace::Accel> accels = all_accels();
  std::optional<int> runs;
  int threads = 0;
  bool quiet = false;
};

Expected<ExitCode> run_bench(const BenchCommand& command) {
  constexpr int usual_runs = 3;
  Console console(command.quiet);
  const ThreadLimit thread_limit(command.threads);
  if (const auto writable = check_output_file(command.json); !writable) return fail(writable.error());
  const auto loaded = load(command.scene, console);
  if (!loaded) return fail(loaded.error());
  const auto thread_count =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  const BenchInput input{*loaded,
                         loaded->scene->name,
                         command.size,
                         command.runs.value_or(usual_runs),
                         thread_count,
                         command.accels,
                         [&](const std::string& what, double done) { console.progress(what, done); }};
  auto result = bench_structures(input);
  if (!result) return fail(result.error());
  auto hybrid = bench_hybrid(input);
  if (!hybrid) return fail(hybrid.error());
  result->table += hybrid->table;
  result->rows.insert(result->rows.end(), hybrid->rows.begin(), hybrid->rows.end());
  console.clear_progress();
  if (!command.quiet && command.json != "-") print_data(result->table);
  if (command.json.empty()) return ExitCode::done;
  const std::string json = bench_json(result->rows);
  if (command.json == "-") {
    print_data(json);
  } else if (const auto written = write_file(command.json, json); !written) {
    return fail(written.error());
  }
  return ExitCode::done;
}

}  // namespace

void add_bench(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand(
      "bench", "Build time, memory, work per ray and speed of the acceleration structures on a scene.");
  app->footer(
      "gnomon bench stadium --accel all       where a grid loses\n"
      "gnomon bench field --accel bvh,grid    where it is at its best");
  const auto command = std::make_shared<BenchCommand>();
  add_scene(*app, command->scene);
  add_accel_list(*app, command->accels);
  add_size(*app, command->size);
  add_runs(*app, command->runs, "3");
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_json(*app, command->json, "the rows");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_bench(*command); }; });
}

}  // namespace gnomon::app

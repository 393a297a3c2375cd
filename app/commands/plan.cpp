// gnomon plan: which effects the scene calls for, which are simulated, and why.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/invocation.h"
#include "app/options.h"
#include "app/output_path.h"
#include "app/session.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct PlanCommand {
  std::string scene, json;
  bool quiet = false;
};

std::string plan_json(const EffectPlan& plan) {
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const EffectEntry& entry : plan.entries) {
    effects.push_back({{"effect", effect_name(entry.effect)},
                       {"simulated", entry.simulated},
                       {"called_for", entry.called_for},
                       {"reason", entry.reason}});
  }
  return nlohmann::ordered_json{{"effects", effects}}.dump(2, ' ', false,
                                                           nlohmann::ordered_json::error_handler_t::replace) +
         "\n";
}

std::string_view verdict(const EffectEntry& entry) {
  if (entry.simulated) return "simulated";
  return entry.called_for ? "NOT YET" : "off";
}

std::string plan_table(const EffectPlan& plan) {
  std::string text = fmt::format("{:<16}{:<12}{}\n", "effect", "", "why");
  for (const EffectEntry& entry : plan.entries) {
    text += fmt::format("{:<16}{:<12}{}\n", effect_name(entry.effect), verdict(entry), entry.reason);
  }
  return text;
}

Expected<ExitCode> run_plan(const PlanCommand& command) {
  Console console(command.quiet);
  if (const auto writable = check_output_file(command.json); !writable) return fail(writable.error());
  const auto loaded = load(command.scene, console);
  if (!loaded) return fail(loaded.error());
  if (!command.json.empty() && command.json != "-") {
    if (const auto made = make_folder_for(command.json); !made) return fail(made.error());
    if (const auto written = write_file(command.json, plan_json(loaded->plan)); !written)
      return fail(written.error());
  }
  if (command.json == "-") {
    print_data(plan_json(loaded->plan));
  } else if (!command.quiet) {
    print_data(plan_table(loaded->plan));
  }
  return ExitCode::done;
}

}  // namespace

void add_plan(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand(
      "plan", "List the effects that a scene calls for, and which light or material does.");
  app->footer(
      "gnomon plan whitted\n"
      "gnomon plan model.glb --json - | jq '.effects[] | select(.simulated)'");
  const auto command = std::make_shared<PlanCommand>();
  add_scene(*app, command->scene);
  add_json(*app, command->json, "the plan");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_plan(*command); }; });
}

}  // namespace gnomon::app

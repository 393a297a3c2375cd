// gnomon merge: the shards of a sweep put together, as if it had been made in one go.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "scene/base/expected.h"
#include "scene/files/path_status.h"
#include "studies/sweep/page.h"

namespace gnomon::app {

namespace {

struct MergeCommand {
  std::vector<std::string> shards;
  std::string folder;
  double report_max_mb = report::default_report_max_mb;
  bool quiet = false;
};

Expected<ExitCode> run_merge(const MergeCommand& command) {
  Console console(command.quiet);
  if (const auto writable = check_output_folder(command.folder); !writable) return fail(writable.error());
  for (const std::string& shard : command.shards) {
    const auto same = are_one_path(shard, command.folder);
    if (!same) return fail(same.error());
    if (*same)
      return fail(
          ErrorKind::usage,
          fmt::format("-o: this folder is also a shard, which would be lost (got {})", command.folder));
  }
  const OutputGuard whole_outputs;
  const auto merged = studies::merge_sweeps(command.shards, command.folder, command.report_max_mb);
  if (!merged) return fail(merged.error());
  if (merged->page.beside) console.note(beside_note(merged->page.page_mb, command.report_max_mb));
  if (merged->drawers.size() > 1)
    console.note(fmt::format("not all cells were drawn alike: {}", fmt::join(merged->drawers, "; ")));
  console.message(fmt::format("sweep: {}/report.html, {} cell{} from {} shard{}", command.folder,
                              merged->cells, merged->cells == 1 ? "" : "s", command.shards.size(),
                              command.shards.size() == 1 ? "" : "s"));
  if (!command.quiet)
    for (const std::string& line : merged->page.headline.lines()) print_data(one_line(line) + "\n");
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(merge, 90, "Put the shards of a sweep together.") {
  app->footer("gnomon merge part1 part2 part3 -o whole");
  const auto command = std::make_shared<MergeCommand>();
  app->add_option("SHARD", command->shards, "folders written by gnomon sweep --shard")->required();
  app->add_option("-o,--output", command->folder, "folder for the whole sweep")->required()->type_name("DIR");
  add_report_max_mb(*app, command->report_max_mb);
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_merge(*command); }; });
}

}  // namespace gnomon::app

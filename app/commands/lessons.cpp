// gnomon lessons: the lessons as a site that works from disk.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>

#include "app/console.h"
#include "app/invocation.h"
#include "app/lessons/site.h"
#include "app/options/options.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "scene/base/timing.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct LessonsCommand {
  std::string folder;
  std::vector<std::string> only;
  bool quiet = false;
};

Expected<void> write_pages(const std::vector<lessons::SitePage>& pages, const std::string& folder) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const lessons::SitePage& page : pages)
    if (const auto written = write_file(staged->path() + "/" + page.file, page.html); !written)
      return written;
  if (const auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish("index.html");
}

Expected<ExitCode> run_lessons(const LessonsCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  RunFiles files;
  constexpr std::array<std::string_view, 1> names{"index.html"};
  files.writes_folder("-o", command.folder, names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto pages = lessons::make_site(command.only, console);
  if (!pages) return fail(pages.error());
  if (const auto written = write_pages(*pages, command.folder); !written) return fail(written.error());
  console.clear_progress();
  double bytes = 0.0;
  for (const lessons::SitePage& page : *pages) bytes += static_cast<double>(page.html.size());
  console.message(fmt::format("lessons: {}/index.html ({} pages, {:.1f} MB, {:.1f} s)", command.folder,
                              pages->size(), bytes / 1e6, total.elapsed_ms() / 1000.0));
  return ExitCode::done;
}

}  // namespace

void add_lessons(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand("lessons",
                                         "Write the lessons as a site that works from disk, without a "
                                         "server: text, figures, slides to project.");
  app->footer(
      "gnomon lessons                                    out/lessons/index.html\n"
      "gnomon lessons -o site --only acne,peter-panning  these pages alone");
  const auto command = std::make_shared<LessonsCommand>();
  command->folder = "out/lessons";
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for index.html and a page for each lesson, each one file [default out/lessons]");
  app->add_option("--only", command->only, "these lessons alone, with commas between [default: all]")
      ->delimiter(',')
      ->type_name("NAMES");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_lessons(*command); }; });
}

}  // namespace gnomon::app

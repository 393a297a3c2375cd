// gnomon lessons: the lessons as a site that works from disk; or a lecture made of their parts.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "lab/lessons/site.h"
#include "scene/base/timing.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct LessonsCommand {
  std::string folder;  ///< empty: the default
  std::vector<std::string> only;
  std::string lecture;  ///< empty: the site
  bool quiet = false;
};

Expected<void> write_pages(const std::vector<lab::lessons::SitePage>& pages, const std::string& folder) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const lab::lessons::SitePage& page : pages)
    if (const auto written = write_file(staged->path() + "/" + page.file, page.html); !written)
      return written;
  if (const auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish(pages.back().file);
}

/// The last one is that to open.
Expected<std::vector<lab::lessons::SitePage>> make_pages(const LessonsCommand& command, Console& console) {
  if (command.lecture.empty()) return lab::lessons::make_site(command.only, console);
  auto page = lab::lessons::make_lecture(command.lecture, console);
  if (!page) return fail(page.error());
  std::vector<lab::lessons::SitePage> pages;
  pages.push_back(std::move(*page));
  return pages;
}

Expected<ExitCode> run_lessons(const LessonsCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  RunFiles files;
  const bool is_lecture = !command.lecture.empty();
  const std::string folder = !command.folder.empty() ? command.folder
                             : is_lecture            ? "out/lectures"
                                                     : "out/lessons";
  const std::string first = is_lecture ? command.lecture + ".html" : "index.html";
  const std::array<std::string_view, 1> names{first};
  files.writes_folder("-o", folder, names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto pages = make_pages(command, console);
  if (!pages) return fail(pages.error());
  if (const auto written = write_pages(*pages, folder); !written) return fail(written.error());
  console.clear_progress();
  double bytes = 0.0;
  for (const lab::lessons::SitePage& page : *pages) bytes += static_cast<double>(page.html.size());
  console.message(fmt::format("{}: {}/{} ({} page{}, {:.1f} MB, {:.1f} s)",
                              is_lecture ? "lecture" : "lessons", folder, first, pages->size(),
                              pages->size() == 1 ? "" : "s", bytes / 1e6, total.elapsed_ms() / 1000.0));
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(lessons, 160,
               "Write the lessons as a site that works from disk, without a server: text, figures, slides to "
               "project; or a lecture of 90 minutes made of their parts.") {
  app->footer(
      "gnomon lessons                                    out/lessons/index.html\n"
      "gnomon lessons -o site --only acne,peter-panning  these pages alone\n"
      "gnomon lessons --lecture shadows                  out/lectures/shadows.html, to project");
  const auto command = std::make_shared<LessonsCommand>();
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for index.html and a page for each lesson, each one file, or for the lecture [default "
             "out/lessons, "
             "out/lectures]");
  CLI::Option* only =
      app->add_option("--only", command->only, "these lessons alone, with commas between [default: all]")
          ->delimiter(',')
          ->type_name("NAMES");
  app->add_option(
         "--lecture", command->lecture,
         fmt::format("in place of the site a lecture: {}", fmt::join(lab::lessons::lecture_names(), ", ")))
      ->excludes(only)
      ->type_name("NAME");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_lessons(*command); }; });
}

}  // namespace gnomon::app

// gnomon site: all that can be read and tried in a browser, as one folder for a host of plain files.
#include <embedded/page_scripts.h>
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/console.h"
#include "app/help/manual.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "lab/lab_options.h"
#include "lab/lessons/comparison.h"
#include "lab/lessons/site.h"
#include "lab/serve/lab_answers.h"
#include "report/html.h"
#include "scene/base/run_program.h"
#include "scene/base/timing.h"
#include "scene/files/own_program.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

using lab::lessons::SitePage;

struct SiteCommand {
  std::string folder = "out/site", web = GNOMON_WEB_PROGRAM;
  bool quiet = false;
};

/// The lab's engine, as ./gnomon web builds it.
Expected<std::vector<SitePage>> engine_files(const std::string& folder) {
  std::vector<SitePage> files;
  for (const char* name : {"gnomon.mjs", "gnomon.wasm", "gnomon_worker.mjs"}) {
    auto bytes = read_file(folder + "/" + name);
    if (!bytes)
      return fail(ErrorKind::bad_input,
                  fmt::format("--web: {} is not there, which ./gnomon web builds in build/web/app (got {})",
                              name, folder));
    files.push_back({name, std::move(*bytes)});
  }
  return files;
}

constexpr std::string_view first_scene = "acne-floor";  ///< with which the lab is begun

/// The built-in scenes as cards, each with the picture of its labels, that open the lab; that to begin with is the first.
Expected<std::string> gallery(Console& console) {
  std::string cards;
  std::vector<BuiltinScene> scenes = builtin_scenes();
  std::stable_partition(scenes.begin(), scenes.end(),
                        [](const BuiltinScene& scene) { return scene.name == first_scene; });
  for (const BuiltinScene& scene : scenes) {
    if (scene.large) continue;
    const auto picture = lab::lessons::labels_png(std::string(scene.name), console);
    if (!picture) return fail(picture.error());
    cards += fmt::format(
        "<li><a href=\"lab.html#scene={0}\"><span class=\"card-picture\"><img src=\"{1}\" "
        "alt=\"\"></span><b>{0}</b> "
        "<span>{2}</span></a></li>\n",
        scene.name, report::data_uri("image/png", *picture), report::escaped(scene.description));
  }
  return cards;
}

/// Where it all begins: the lab, the lessons, the lectures, the manual, and every scene to be opened in the lab.
Expected<SitePage> start_page(const std::vector<SitePage>& lectures, Console& console) {
  const auto cards = gallery(console);
  if (!cards) return fail(cards.error());
  std::string decks;
  for (const SitePage& deck : lectures)
    decks += fmt::format("{}<a href=\"lectures/{}\">{}</a>", decks.empty() ? "" : ", ", deck.file,
                         deck.file.substr(0, deck.file.find('.')));
  const std::string main = fmt::format(
      R"(<article class="lesson-text">
<h1>Gnomon</h1>
<p>Gnomon renders a scene twice, once as a rasterizer with shadow maps and once as a ray tracer, compares the shadows pixel by
pixel, and says for every pixel that differs why.</p>
<p><b><a href="lab.html#scene={0}">Begin here</a></b>: a floor under a sun, in the lab. Turn the constant bias up and down, and see in
colour what is wrong.</p>
<ul>
<li><a href="lab.html">The lab</a>: change every setting of a shadow map, turn the light, and watch what becomes of the shadows. It
is drawn and compared in this page, on your own machine.</li>
<li><a href="lessons/index.html">The lessons</a>: shadow maps and ray tracing, with figures to try.</li>
<li>The lectures: {1}. Slides of 90 minutes each, to project and to print.</li>
<li><a href="manual/index.html">The manual</a>: every option, key, label and channel.</li>
</ul>
<h2>Scenes to open in the lab</h2>
<p>The pictures show where the shadow map is right (white and grey) and, in colour, where it errs and why.</p>
</article>
<ul class="cards">
{2}</ul>
)",
      first_scene, decks, *cards);
  return SitePage{"index.html", lab::lessons::page_of_text("Gnomon", "", main)};
}

/// All of them, or none.
Expected<void> write_files(const std::string& folder, const std::vector<SitePage>& files) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const SitePage& file : files) {
    const std::string path = staged->path() + "/" + file.file;
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, file.html); !written) return written;
  }
  if (const auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish("index.html");
}

void add_below(const std::string& folder, std::vector<SitePage> pages, std::vector<SitePage>& files) {
  for (SitePage& page : pages) files.push_back({folder + "/" + page.file, std::move(page.html)});
}

/// The chapters that gnomon makes of all programs' commands.
Expected<std::vector<lab::lessons::ManualChapter>> printed_chapters() {
  std::vector<lab::lessons::ManualChapter> chapters;
  for (const std::string_view name : written_chapters) {
    auto printed = run_and_listen({program_beside("gnomon"), "--manual", std::string(name)});
    if (!printed) return fail(printed.error());
    if (printed->code != 0) return fail(ErrorKind::graphics, one_line(printed->said));
    chapters.push_back({fmt::format("{}.md", name), std::move(printed->said)});
  }
  return chapters;
}

Expected<ExitCode> run_site(const SiteCommand& command) {
  const Stopwatch total;
  Console console(command.quiet);
  RunFiles paths;
  constexpr std::array<std::string_view, 1> names{"index.html"};
  paths.writes_folder("-o", command.folder, names);
  if (const auto fine = paths.check(); !fine) return fail(fine.error());
  auto files = engine_files(command.web);
  if (!files) return fail(files.error());
  auto lesson_pages = lab::lessons::make_site({}, console, "../lab.html");
  if (!lesson_pages) return fail(lesson_pages.error());
  const auto chapters = printed_chapters();
  if (!chapters) return fail(chapters.error());
  auto manual = lab::lessons::manual_pages(*chapters);
  if (!manual) return fail(manual.error());
  lab::LabOptions lab;
  lab.scene = lab.scene.named(std::string(first_scene));
  lab.compare.raster.size = {640, 360};
  files->push_back({"lab.html", lab::lab_page(lab, true)});
  for (const embedded::Entry& script : embedded::page_scripts_entries())
    files->push_back({std::string(script.name), std::string(script.bytes)});
  std::vector<SitePage> lectures;
  for (const std::string_view name : lab::lessons::lecture_names()) {
    auto lecture = lab::lessons::make_lecture(name, console);
    if (!lecture) return fail(lecture.error());
    lectures.push_back(std::move(*lecture));
  }
  auto start = start_page(lectures, console);
  if (!start) return fail(start.error());
  files->push_back(std::move(*start));
  add_below("lectures", std::move(lectures), *files);
  add_below("lessons", std::move(*lesson_pages), *files);
  add_below("manual", std::move(*manual), *files);
  if (const auto written = write_files(command.folder, *files); !written) return fail(written.error());
  console.clear_progress();
  console.message(fmt::format("site: {}/index.html ({:.1f} s)", command.folder, total.elapsed_ms() / 1000.0));
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(site, 170,
               "Write a site for any host of plain files: a start page, the lab with an engine of its own, "
               "the lessons, the lectures and the manual.") {
  app->footer(
      "./gnomon web && ./gnomon site -o public   the folder public, to put on a host\n"
      "python3 -m http.server -d public          and to look at it here");
  const auto command = std::make_shared<SiteCommand>();
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for index.html and all else [default out/site]");
  app->add_option(
         "--web", command->web,
         "where ./gnomon web has built the program for the web [a folder; default build/web/app where the "
         "program was built]")
      ->type_name("DIR");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_site(*command); }; });
}

}  // namespace gnomon::app

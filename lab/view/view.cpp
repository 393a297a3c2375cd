#include "lab/view/view.h"

#include <fmt/core.h>

#include "app/outputs/run_files.h"
#include "app/session.h"
#include "lab/view/state/first_state.h"
#include "lab/view/viewer.h"
#include "scene/files/read_file.h"

namespace gnomon::lab {

namespace {

/// The file that a step writes; empty: none.
std::string output_of(const ScriptStep& step) {
  if (const auto* shot = std::get_if<Screenshot>(&step.what)) return shot->path;
  if (const auto* save = std::get_if<SaveScene>(&step.what)) return save->path;
  return {};
}

/// A screenshot's file can be written; nobody wants to learn that at the end of a long script.
Expected<void> check_step_output(const ScriptStep& step, const std::string& script) {
  const std::string path = output_of(step);
  if (path.empty()) return {};
  const Expected<void> writable = app::check_output_file(path);
  if (writable) return {};
  Error error = writable.error();
  error.reason = error.message();
  error.file = script;
  error.line = step.line;
  return fail(std::move(error));
}

/// `files` learns what its steps read and write.
Expected<std::vector<ScriptStep>> read_script(const std::string& path, const Scene& scene,
                                              app::RunFiles& files) {
  if (path.empty()) return std::vector<ScriptStep>{};
  files.reads(path);
  const Expected<std::string> text = read_file(path);
  if (!text) return fail(text.error());
  std::vector<std::string> opened;
  auto steps = parse_script(*text, path, scene.lights, &opened);
  if (!steps) return steps;
  for (const std::string& file : opened) files.reads(file);
  for (const ScriptStep& step : *steps) {
    if (const auto writable = check_step_output(step, path); !writable) return fail(writable.error());
    if (const std::string output = output_of(step); !output.empty())
      files.writes(fmt::format("{}:{}", path, step.line), output);
  }
  return steps;
}

}  // namespace

Expected<app::ExitCode> run_view(const ViewOptions& options) {
  app::Console console(options.quiet);
  auto source = first_source(options, console);
  if (!source) return fail(source.error());
  const app::LoadedScene& loaded = *source->loaded;
  app::RunFiles files;  // with the script's, which the window does not watch
  if (const auto reads = files.also_reads(source->files); !reads) return fail(reads.error());
  auto state = first_state(options, given_scene(*loaded.scene, *loaded.world, loaded.paths));
  if (!state) return fail(state.error());
  state->look.theme = options.theme, state->look.ui_scale = options.ui_scale;
  state->look.large_type = options.large_type, state->look.panels = !options.no_panels;
  auto script = read_script(options.script, *loaded.scene, files);
  if (!script) return fail(script.error());
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  const auto viewer =
      Viewer::open(options, std::move(*source), std::move(*state), std::move(*script), console);
  if (!viewer) return fail(viewer.error());
  if (const auto ran = (*viewer)->run(); !ran) return fail(ran.error());
  return app::ExitCode::done;
}

}  // namespace gnomon::lab

// gnomon shaders: the rasterizer's GLSL, to be read and edited; --shader-dir takes what was edited.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/console.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "raster/programs/shader_folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

struct ShadersCommand {
  std::string folder;
  bool quiet = false;
};

/// "technique/pcf_box.glsl      Percentage-closer filtering (Reeves, …)": a file's first comment line.
std::string list_of_shaders() {
  constexpr std::size_t name_column = 28;  // columns
  std::string text;
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string_view line = file.text.substr(0, file.text.find('\n'));
    text += fmt::format("{:<{}}{}\n", file.name, name_column, line.starts_with("// ") ? line.substr(3) : "");
  }
  return text;
}

/// What is there and differs may be somebody's work.
Expected<void> check_nothing_is_lost(const ShadersCommand& command) {
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string path = (std::filesystem::path(command.folder) / file.name).string();
    const auto is = is_there(path, ErrorKind::cannot_write);
    if (!is) return fail(is.error());
    if (!*is) continue;
    const auto there = read_file(path);
    if (there && *there == file.text) continue;
    return fail(Error{ErrorKind::cannot_write,
                      "is there already and differs from the program's own; move it away first", path});
  }
  return {};
}

constexpr const char* named_shader = "technique/hard.glsl";

Expected<void> write_shaders(const std::string& folder) {
  const OutputGuard whole_outputs;
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const raster::ShaderFile& file : raster::own_shaders()) {
    const std::string path = (std::filesystem::path(staged->path()) / file.name).string();
    if (auto made = make_folder_for(path); !made) return made;
    if (auto written = write_file(path, file.text); !written) return written;
  }
  if (auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish(named_shader);
}

Expected<ExitCode> run_shaders(const ShadersCommand& command) {
  if (command.folder.empty()) {
    print_data(list_of_shaders());
    return ExitCode::done;
  }
  Console console(command.quiet);
  if (const auto writable = check_output_folder(command.folder); !writable) return fail(writable.error());
  if (const auto safe = check_nothing_is_lost(command); !safe) return fail(safe.error());
  if (const auto written = write_shaders(command.folder); !written) return fail(written.error());
  console.message(fmt::format("shaders: {}/{} and {} more", command.folder, named_shader,
                              raster::own_shaders().size() - 1));
  return ExitCode::done;
}

}  // namespace

void add_shaders(CLI::App& program, Invocation& invocation) {
  CLI::App* app = program.add_subcommand(
      "shaders", "List the rasterizer's shaders, or write them into a folder to be edited for --shader-dir.");
  app->footer(
      "gnomon shaders                  their names and what they are\n"
      "gnomon shaders -o mine          then edit mine/technique/hard.glsl\n"
      "gnomon compare fence --shader-dir mine");
  const auto command = std::make_shared<ShadersCommand>();
  add_output(*app, "-o,--output", command->folder, "DIR",
             "folder for the files; one that was edited there is not overwritten [default: list them]");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_shaders(*command); }; });
}

}  // namespace gnomon::app

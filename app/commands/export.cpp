// gnomon export: a scene as glTF 2.0, for other renderers.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/commands.h"
#include "app/console.h"
#include "app/invocation.h"
#include "app/lesson_scene.h"
#include "app/options/effect_options.h"
#include "app/options/options.h"
#include "app/options/values.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/session.h"
#include "app/suite/write.h"
#include "scene/base/stages.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "scene/shapes/tessellate.h"

namespace gnomon::app {

namespace {

struct ExportCommand {
  SceneArgument scene;
  std::string camera, file, suite;
  ImageSize size = quick_picture;  ///< of the suite's masks
  int tessellate = 64;             ///< sectors, in [min_tessellation, max_tessellation]
  bool quiet = false;
  std::vector<std::string> given;  ///< options
  bool is_given(std::string_view option) const {
    return std::find(given.begin(), given.end(), option) != given.end();
  }
};

Expected<ExitCode> export_suite(const ExportCommand& command, Console& console) {
  if (!command.scene.name.empty() || !command.file.empty())
    return fail(ErrorKind::usage, "export: --suite has scenes of its own (give no SCENE and no -o)");
  for (const char* option : {"camera", "tessellate"})
    if (command.is_given(option))
      return fail(ErrorKind::usage,
                  fmt::format("--{}: the scenes of --suite are written as they are", option));
  if (const auto writable = check_output_folder(command.suite); !writable) return fail(writable.error());
  if (const auto written = write_suite(command.suite, command.size, console); !written)
    return fail(written.error());
  console.message(fmt::format("suite: {}/README.md", command.suite));
  return ExitCode::done;
}

Expected<ExitCode> run_export(ExportCommand& command) {
  Console console(command.quiet);
  if (!command.suite.empty()) return export_suite(command, console);
  if (command.scene.name.empty()) return fail(ErrorKind::usage, "export: SCENE is required, or --suite DIR");
  if (command.is_given("size")) return fail(ErrorKind::usage, "--size: is that of the masks of --suite");
  if (command.file.empty()) command.file = default_output(command.scene.name) + ".glb";
  if (const auto known = check_extension("-o", command.file, ".glb .gltf"); !known)
    return fail(known.error());
  RunFiles files;
  files.reads(command.scene);
  files.writes("-o", command.file);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  auto loaded = load(command.scene, files, console, command.tessellate, command.camera, false,
                     command.is_given("tessellate"));
  if (!loaded) return fail(loaded.error());
  if (const std::string asked = scene_settings_text(scene_of_lesson(command.scene.name)); !asked.empty())
    console.note("glTF has no place for what the scene asks for: give " + asked + " yourself");
  loaded->scene->notes.clear();
  const Scene scene = cut_planes(std::move(*loaded->scene));
  const auto gltf = write_gltf(scene, lower_extension(command.file) == ".glb");
  if (!gltf) return fail(gltf.error());
  for (const std::string& note : scene.notes) console.note(note);
  for (const std::string& note : gltf->notes) console.note(note);
  const TimedStage writing("write");
  const OutputGuard whole_outputs;
  if (const auto made = make_folder_for(command.file); !made) return fail(made.error());
  if (const auto written = write_file(command.file, gltf->bytes); !written) return fail(written.error());
  console.message(fmt::format("scene: {}", command.file));
  return ExitCode::done;
}

void add_sectors(CLI::App& app, int& sectors) {
  add_checked(
      app, "--tessellate", "N",
      fmt::format("make triangles of the exact shapes, which glTF has not: N sectors around, N/2 rings, "
                  "N^3 cells of an implicit surface [sectors, {} to {}; default {}]",
                  min_tessellation, max_tessellation, sectors),
      [&sectors](const std::string& text) -> Expected<void> {
        const auto value = parse_integer(text, min_tessellation, max_tessellation);
        if (!value) return fail(value.error());
        sectors = static_cast<int>(*value);
        return {};
      });
}

}  // namespace

GNOMON_COMMAND(export, 80, "Write a scene as glTF 2.0, so that another renderer can draw it and be judged.") {
  app->footer(
      "gnomon export courtyard -o courtyard.glb\n"
      "gnomon export shapes --tessellate 128 -o shapes.gltf\n"
      "gnomon export model.obj --camera front -o model.glb\n"
      "gnomon export --suite suite");
  const auto command = std::make_shared<ExportCommand>();
  add_scene(*app, command->scene);
  add_scene_time(*app, command->scene);
  app->get_option("SCENE")->required(false);
  add_output(*app, "-o,--output", command->file, "FILE",
             ".glb, or .gltf with everything inside [default out/NAME.glb]");
  add_sectors(*app, command->tessellate);
  add_camera(*app, command->camera);
  app->add_option(
         "--suite", command->suite,
         "write the conformance suite into this folder instead: a dozen scenes with true masks and a "
         "README")
      ->type_name("DIR");
  add_checked(*app, "--size", "WxH",
              fmt::format("size of the suite's masks [{}; default {}x{}]", size_choices(),
                          command->size.width, command->size.height),
              [command](const std::string& text) -> Expected<void> {
                const auto size = parse_size(text);
                if (!size) return fail(size.error());
                command->size = *size;
                return {};
              });
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation, app] {
    command->given = given_options(*app);
    invocation.action = [command] { return run_export(*command); };
  });
}

}  // namespace gnomon::app

#include "app/outputs/picture_command.h"

#include <fmt/core.h>

#include "app/options/effect_options.h"
#include "app/options/options.h"
#include "app/outputs/picture_file.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "compare/result/outputs.h"
#include "scene/base/stages.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_files.h"

namespace gnomon::app {

namespace {

constexpr std::size_t many_lights = 64;  // more take seconds, and a user may not know how many there are

}  // namespace

bool PictureCommand::wants_records() const {
  return lower_extension(image) == ".exr";
}

void add_picture_subject(CLI::App& app, PictureCommand& command, ImageSize& size, const std::string& output) {
  add_scene(app, command.scene);
  add_scene_time(app, command.scene);
  add_output(app, "-o,--output", command.image, "IMAGE", output);
  add_size(app, size);
  add_tessellate(app, command.tessellate);
  add_camera(app, command.camera);
  add_max_lights(app, command.max_lights);
}

void add_picture_manner(CLI::App& app, PictureCommand& command, const char* threads, const char* json) {
  add_threads(app, command.threads, threads);
  add_memory(app, command.memory, command.scene.memory);
  add_exposure(app, command.exposure);
  add_json(app, command.json, json);
  add_quiet(app, command.quiet);
}

void note_call(const CLI::App& app, const Invocation& invocation, PictureCommand& command) {
  command.command_line = invocation.command_line;
  command.trace = invocation.trace;
  command.given = given_options(app);
}

Expected<RunFiles> check_files(PictureCommand& command, const std::string& renderer) {
  if (command.image.empty()) command.image = default_output(command.scene.name) + "-" + renderer + ".png";
  if (const auto known = check_extension("-o", command.image, ".png .exr"); !known)
    return fail(known.error());
  RunFiles files;
  files.reads(command.scene);
  files.writes("-o", command.image);
  files.writes("--json", command.json);
  files.writes("--trace", command.trace);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  return files;
}

Expected<LoadedScene> open_scene(const PictureCommand& command, RunFiles& files, ImageSize size,
                                 const BytesPerPixel& bytes, Console& console) {
  if (const auto fits = check_memory(command.memory, size, bytes.of(command)); !fits)
    return fail(fits.error());
  auto loaded = load(command.scene, files, console, command.tessellate, command.camera);
  if (!loaded) return loaded;
  keep_strongest_lights(*loaded, command.max_lights, named_lights(command.light), command.poses, console);
  if (const std::size_t lights = loaded->scene->lights.size(); lights > many_lights)
    console.note(fmt::format(
        "all {} lights are drawn, each with its shadows; --max-lights N keeps the strongest alone", lights));
  return loaded;
}

Expected<ExitCode> hand_out(const PictureCommand& command, const LoadedScene& loaded,
                            const PictureWriter& writer, const Stopwatch& watch, Console& console) {
  const OutputGuard whole_outputs;
  TimedStage writing("write");
  StagedFiles files;
  const auto place = files.place_of(command.image);
  if (!place) return fail(place.error());
  const Expected<double> exposure = writer.picture(*place);
  if (!exposure) return fail(exposure.error());
  writing.end();
  const RenderRecord record{command.command_line, command.image, loaded, *exposure, watch.elapsed_ms()};
  std::string json;
  if (!command.json.empty()) json = compare::with_time_budget(writer.json(record));
  if (const auto out = publish_texts({{command.json, json}}, files); !out) return fail(out.error());
  console.message(fmt::format("picture: {}", command.image));
  return ExitCode::done;
}

}  // namespace gnomon::app

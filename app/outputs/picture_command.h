// What `gnomon raster` and `gnomon raytrace` have in common. They make one picture of a scene and tell of it
// in JSON. The picture is a PNG, or an EXR with the renderer's records. In order: check_files, open_scene,
// the renderer's own work, hand_out.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/invocation.h"
#include "app/options/pose_options.h"
#include "app/outputs/render_json.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "scene/base/timing.h"

namespace gnomon::app {

struct PictureCommand {
  SceneArgument scene;
  std::string image, camera, light, json, trace, command_line;
  std::optional<std::optional<double>> exposure;
  PoseOptions poses;
  MemoryLimit memory;
  int threads = 0;
  int tessellate = 0;                ///< sectors; 0: shapes stay exact
  int max_lights = most_max_lights;  ///< a picture has all
  bool quiet = false;
  std::vector<std::string> given;  ///< options

  bool wants_records() const;  ///< an .exr has them
};

/// The scene, --output, --size, --tessellate, --camera, --max-lights.
void add_picture_subject(CLI::App& app, PictureCommand& command, ImageSize& size, const std::string& output);
/// --threads, --memory, --exposure, --json, --quiet.
void add_picture_manner(CLI::App& app, PictureCommand& command, const char* threads, const char* json);
/// When all is parsed: how the command was called.
void note_call(const CLI::App& app, const Invocation& invocation, PictureCommand& command);

/// Gives the picture its default name, out/NAME-RENDERER.png; nothing is written yet.
Expected<RunFiles> check_files(PictureCommand& command, const std::string& renderer);

/// By which the peak of memory grows, for a .png and for an .exr.
struct BytesPerPixel {
  PictureBytes png, exr;
  const PictureBytes& of(const PictureCommand& command) const { return command.wants_records() ? exr : png; }
};
Expected<LoadedScene> open_scene(const PictureCommand& command, RunFiles& files, ImageSize size,
                                 const BytesPerPixel& bytes, Console& console);

/// How a renderer's frame becomes a file and a document.
struct PictureWriter {
  /// Writes it at a place in the making, and gives its exposure.
  std::function<Expected<double>(const std::string& place)> picture;
  std::function<std::string(const RenderRecord& record)> json;
};
/// Writes the picture and, where it is asked for, the JSON, both or none and neither to be interrupted.
Expected<ExitCode> hand_out(const PictureCommand& command, const LoadedScene& loaded,
                            const PictureWriter& writer, const Stopwatch& watch, Console& console);

}  // namespace gnomon::app

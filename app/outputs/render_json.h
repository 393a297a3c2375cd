// What `gnomon raster` and `gnomon raytrace` write for --json: "gnomon/render/1", whose form is
// app/outputs/render.schema.json. Keys are those of result.json where they mean the same; a time is {median, runs[]}
// in ms, median null when it was not timed.
#pragma once

#include <string>
#include <vector>

#include "app/session.h"
#include "raster/frame.h"
#include "raytrace/frame.h"
#include "scene/files/staged_files.h"

namespace gnomon::app {

/// What both renderers' documents say.
struct RenderRecord {
  std::string command_line;
  std::string picture;  ///< path
  const LoadedScene& loaded;
  double exposure = 1.0;
  double total_ms = 0.0;  ///< the whole command's
};

std::string render_json(const RenderRecord& record, const raster::RasterFrame& frame);
std::string render_json(const RenderRecord& record, const raytrace::Tracer& tracer, std::string_view accel,
                        const raytrace::RaytraceOptions& options, const raytrace::RayTracedFrame& frame);

/// Any command's --json, and whatever else goes to FILE|-: onto stdout for "-", into a file, whose folder is made where
/// there is none, for any other path but "".
Expected<void> hand_out_json(const std::string& path, const std::string& json);
/// Hands out several of a command's outputs, which appear together or not at all, and with `files`. What goes onto stdout
/// comes when all others are in their places.
Expected<void> publish_texts(const std::vector<FileText>& texts, StagedFiles& files);
/// Returns those of the texts that go into files.
std::vector<FileText> texts_for_files(const std::vector<FileText>& texts);
/// Writes the others onto stdout.
void print_texts(const std::vector<FileText>& texts);

}  // namespace gnomon::app

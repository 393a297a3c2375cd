// Captures that Gnomon makes of its own pictures, as another renderer would hand them over.
#pragma once

#include <functional>

#include "compare/judge/capture_pictures.h"
#include "compare/judge/judge.h"
#include "support/compare_support.h"

namespace gnomon::test {

/// Draws a built-in scene's first light and compares; the picture is what is captured.
Compared draw_builtin(const std::string& name, ImageSize size, const raster::MapOptions& map);

struct CaptureParts {
  bool positions = true, mask = false, map = false;
};

/// Writes the pictures of the first light compared into `folder` (made anew) and says what they are.
compare::Capture self_capture(const Compared& drawn, const std::string& folder, const CaptureParts& parts);

/// The capture's file, capture.json in `folder`; its name.
std::string write_json(const compare::Capture& capture, const std::string& folder);

/// One picture of a capture through a function of its channels.
using Spoil = std::function<void(ChannelImage&)>;
void spoil(const std::string& file, const Spoil& change);

/// Judges with a scene of its own, since --fix changes it.
struct Verdict {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<World> world;
  Expected<compare::Comparison> result = fail(ErrorKind::internal, "not judged");
};
Verdict judge(const compare::Capture& capture, const compare::JudgeOptions& options = {});

}  // namespace gnomon::test

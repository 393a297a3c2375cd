// Captures that Gnomon makes of its own pictures, as another renderer would hand them over.
#pragma once

#include <functional>

#include "judge/capture_pictures.h"
#include "judge/judge.h"
#include "tests/support/compare_support.h"

namespace gnomon::test {

inline constexpr ImageSize small_picture{192, 108};
/// Pixels that fall on a texel's border may look up either, in floats and in doubles: of 20,000 pixels a few.
inline constexpr double border_share = 0.003;

/// Where a capture of that name is written.
inline std::string folder_for(const std::string& name) {
  return testing::TempDir() + "/gnomon-judge-" + name;
}

/// Draws a built-in scene's first light and compares; the picture is what is captured.
Compared draw_builtin(const std::string& name, ImageSize size, const raster::MapOptions& map);

/// Draws a scene made in code.
Compared draw_scene(Scene scene, ImageSize size, const raster::MapOptions& map);
/// A hard map with a constant bias of 0.02 world units.
raster::MapOptions hard_map(int size, raster::Technique technique = raster::Technique::hard);

struct CaptureParts {
  bool positions = true, mask = false, map = false;
  bool ratio = false;                             ///< `shadowed` and `unshadowed` for `visibility`
  std::optional<judge::StoredDepth> stored = {};  ///< of the map [a sun's zero_to_one, else distance]
  judge::RowOrder rows = judge::RowOrder::bottom_up;
  const judge::CapturedDepth* depth = nullptr;  ///< of the camera; its file is named here
};

/// Writes the pictures of the first light compared into `folder` (made again) and says what they are.
judge::Capture self_capture(const Compared& drawn, const std::string& folder, const CaptureParts& parts);

/// The capture's file, capture.json in `folder`; its name.
std::string write_json(const judge::Capture& capture, const std::string& folder);

/// One picture of a capture through a function of its channels.
using Spoil = std::function<void(ChannelImage&)>;
void spoil(const std::string& file, const Spoil& change);

/// Judges with a scene of its own, since --fix changes it.
struct JudgeOutcome {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<World> world;
  Expected<compare::Comparison> result = fail(ErrorKind::internal, "not judged");
};
JudgeOutcome judge(const judge::Capture& capture, const judge::JudgeOptions& options = {});
JudgeOutcome judge(const judge::Capture& capture, const Scene& scene,
                   const judge::JudgeOptions& options = {});
/// "judged", or why not.
std::string reason(const JudgeOutcome& outcome);

// A shadow test written with nothing but a capture's matrix and texels, as another renderer would have it.

/// Floor and boxes under one light: "sun", "lamp" (spot) or "bulb" (point).
Scene scene_under(const std::string& light);

/// Where the other renderer's filter compares, texels beside the place; empty: at the place alone.
struct FilterTaps {
  std::vector<Vec2> taps{};
  bool linear = false;  ///< each compares with the four texels around it, by how near they are
  bool turned = false;  ///< at every pixel by another angle
};
/// `side` x `side` of them, a texel apart.
FilterTaps square_taps(int side, bool linear = false);

/// Puts in the place of the capture's visibility what the other renderer draws on the capture's map, with the
/// capture's bias. `outside`: what it draws beside the map. `by_fronts`: offsets go along the fronts' normals, also where a
/// back is seen.
void draw_again(const judge::Capture& capture, const Compared& drawn, float outside = 1.0f,
                bool by_fronts = false, const FilterTaps& filter = {});

/// Turns the layers' stored numbers into the moments of the capture's filter, averaged over 5 x 5 texels.
void store_moments(judge::Capture& capture);

}  // namespace gnomon::test

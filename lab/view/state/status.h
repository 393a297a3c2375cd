// The viewer in words: the window's title, and the command line that makes the same comparison without a
// window.
#pragma once

#include <string>
#include <vector>

#include "lab/lab_options.h"
#include "lab/view/state/state.h"
#include "lab/view/work/render_thread.h"

namespace gnomon::lab {

/// The numbers beside the pictures. They are of the state shown, or of the newest one that is finished.
struct Readings {
  double bias_world = 0.0, texel_world = 0.0;
  double raster_ms = 0.0;  ///< the live picture, with reading it back
  struct Compared {
    bool current = false;  ///< of the state as it is now
    bool preview = false;
    double wrong_fraction = 0.0;
    double mean_absolute = 0.0;  ///< mean error of visibility
  };
  std::optional<Compared> compared;
};
Readings readings_of(const Snapshot& shown, const ViewState& state);

/// What the shadows take of a frame, by what has moved since the last one.
struct ShadowTimeWords {
  struct Row {
    std::string name, time;
  };
  std::vector<Row> rows;
  std::string by;          ///< by which clock, how often, in which steps
  bool of_device = false;  ///< by the GPU's own clock
};
/// Nothing before the first comparison; its times are said once they are known (ShadowTimes).
ShadowTimeWords shadow_time_words(const Snapshot& shown, const ViewState& state);

/// Scene, view, technique, map size, bias in texels and world units, share of wrong pixels.
std::string status_line(const ViewState& state, const Readings& readings, const std::string& scene);

/// "gnomon compare SCENE --size ... ": what differs from the defaults and, always, size, map size and bias.
std::string compare_command(const ViewState& state, const LabOptions& options,
                            const app::SceneArgument& scene);
/// Returns the words of the setting without "gnomon compare SCENE", each by itself and not quoted; `scene` is the path or
/// name in its place, whose own settings they set back.
std::vector<std::string> setting_words(const ViewState& state, const LabOptions& options,
                                       const std::string& scene);

/// The tuner draws no more pixels than these: its answer hardly depends on them, its time does.
inline constexpr double tuned_pixels = 480 * 270;
/// What `gnomon tune` is told of the view: camera, light and truth as shown, the picture's shape, and no map.
std::vector<std::string> tuning_words(const ViewState& state, const LabOptions& options);

/// "--backend", "egl-software"; nothing for auto.
std::vector<std::string> backend_words(raster::Backend backend);
/// Its part about the camera and the light.
std::vector<std::string> pose_words(const ViewState& state);

/// Lights that were turned but are not the chosen one: the command line has no words for them.
std::vector<std::string> other_turned_lights(const ViewState& state);

}  // namespace gnomon::lab

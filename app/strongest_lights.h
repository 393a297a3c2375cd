// In scenes of very many lights a comparison is made for the few that would light most of what the camera sees. So it
// ends in seconds and its page can be read. A single picture has all, unless it is asked for fewer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/options/pose_options.h"
#include "app/session.h"

namespace CLI {
class App;
}

namespace gnomon::app {

inline constexpr int usual_max_lights = 8;
inline constexpr int most_max_lights = 100000;

/// --max-lights; the field holds the default.
void add_max_lights(CLI::App& command, int& max_lights);
/// " --max-lights N" for a command that makes the same again; nothing of the usual number.
std::string max_lights_argument(int max_lights);

/// Indices, ascending, of the `count` lights that would give the camera's picture the most light: the luminance of
/// their irradiance, shadows left out, summed over a grid of receivers. The earlier one of two alike.
std::vector<std::uint32_t> strongest_lights(const LoadedScene& loaded, const std::vector<Light>& lights,
                                            const Camera& camera, std::size_t count);

/// What is named by --light NAME: nothing of an empty name.
inline std::vector<std::string> named_lights(const std::string& name) {
  return name.empty() ? std::vector<std::string>{} : std::vector<std::string>{name};
}

/// Chooses the lights that stay, for one camera after the other: where there are more than `max_lights`, those that
/// strongest_lights() finds or --light names. `loaded` outlives it, and is taken as it is when this is made.
class LightSelection {
 public:
  LightSelection(const LoadedScene& loaded, int max_lights);

  /// Never where a name is not a light's.
  bool leaves_out(const std::vector<std::string>& named) const;
  /// `poses` are not applied to them; what counts is what their camera sees.
  std::vector<Light> kept(const std::vector<std::string>& named, const PoseOptions& poses);
  /// What is to be said where leaves_out().
  std::string note(const std::vector<std::string>& named) const;

 private:
  const LoadedScene& loaded_;
  std::size_t most_;
  Camera camera_;
  std::vector<Light> lights_;
  std::optional<Camera> seen_by_;         ///< the camera that `strongest_` is of
  std::vector<std::uint32_t> strongest_;  ///< indices in `lights_`
};

/// The lights that the selection leaves out are left out of everything; a note says so. To be called before `poses` are
/// applied, whose light is one of those that stay.
void keep_strongest_lights(LoadedScene& loaded, int max_lights, const std::vector<std::string>& named,
                           const PoseOptions& poses, Console& console);

}  // namespace gnomon::app

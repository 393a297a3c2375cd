// Scenes of very many lights: a comparison is made for the few that would light most of what the camera sees, so that
// it ends in seconds and its page can be read. A single picture has all, unless it is asked for fewer.
#pragma once

#include <string>
#include <vector>

#include "app/pose_options.h"
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

/// Indices in Scene::lights, ascending, of the `count` lights that would give the camera's picture the most light:
/// the luminance of their irradiance, shadows left out, summed over a grid of receivers. The earlier one of two alike.
std::vector<std::uint32_t> strongest_lights(const LoadedScene& loaded, const Camera& camera,
                                            std::size_t count);

/// What keep_strongest_lights() takes for --light NAME: nothing of an empty name.
inline std::vector<std::string> named_lights(const std::string& name) {
  return name.empty() ? std::vector<std::string>{} : std::vector<std::string>{name};
}

/// Where the scene has more than `max_lights` lights, those stay that strongest_lights() finds or `named` names, and the
/// others are left out of everything; a note says so. Nothing is done where a name is not a light's. To be called before
/// `poses` are applied, whose light is one of those that stay: what counts is what their camera sees.
void keep_strongest_lights(LoadedScene& loaded, int max_lights, const std::vector<std::string>& named,
                           const PoseOptions& poses, Console& console);

}  // namespace gnomon::app

#include "app/shimmer_options.h"

#include <algorithm>
#include <sstream>

#include "app/option_kinds.h"

namespace gnomon::app {

namespace {

using compare::CameraPath;
using compare::LightPath;
using compare::Moves;

constexpr std::pair<std::string_view, Moves> all_moves[] = {
    {"camera", Moves::camera}, {"light", Moves::light}, {"both", Moves::both}};
constexpr std::pair<std::string_view, CameraPath> camera_paths[] = {{"orbit", CameraPath::orbit},
                                                                    {"walk", CameraPath::walk},
                                                                    {"turn", CameraPath::turn},
                                                                    {"drift", CameraPath::drift},
                                                                    {"still", CameraPath::still}};
constexpr std::pair<std::string_view, LightPath> light_paths[] = {
    {"orbit", LightPath::orbit}, {"sun", LightPath::sun}, {"still", LightPath::still}};
constexpr NumberRange speed_range{-1e6, 1e6};
constexpr NumberRange drift_range{-1000.0, 1000.0};

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

Expected<Vec2> parse_drift(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() != 2)
    return fail(ErrorKind::usage, fmt::format("wrong value (got {}, allowed U,V)", text));
  const auto u = parse_number(parts[0], drift_range), v = parse_number(parts[1], drift_range);
  if (!u) return fail(u.error());
  if (!v) return fail(v.error());
  return Vec2(*u, *v);
}

bool is_file(const std::string& path) {
  return path.ends_with(".json");
}

template <class Path, std::size_t N>
const Path* find_path(const std::pair<std::string_view, Path> (&known)[N], const std::string& name) {
  const auto found =
      std::find_if(std::begin(known), std::end(known), [&](const auto& one) { return one.first == name; });
  return found == std::end(known) ? nullptr : &found->second;
}

LightPath usual_light_path(const Scene& scene) {
  const bool sun = std::any_of(scene.lights.begin(), scene.lights.end(),
                               [](const Light& light) { return light.type == LightType::directional; });
  return sun ? LightPath::sun : LightPath::orbit;
}

// The first name is the camera's where it moves; the last one the light's.
Expected<void> take_names(const MovementOptions& movement, compare::ShimmerPath& path) {
  const bool camera = movement.moves != Moves::light, light = movement.moves != Moves::camera;
  const auto& names = movement.paths;
  if (names.size() > (camera && light ? 2u : 1u))
    return fail(ErrorKind::usage,
                fmt::format("--path: one path for each of what moves (got {} paths)", names.size()));
  if (camera && !names.empty()) {
    const CameraPath* found = find_path(camera_paths, names.front());
    if (found == nullptr)
      return fail(ErrorKind::usage, fmt::format("--path: no path of a camera (got {}, allowed {}, FILE.json)",
                                                names.front(), choice_names<CameraPath>(camera_paths, ", ")));
    path.camera = *found;
  }
  if (light && names.size() > (camera ? 1u : 0u)) {
    const LightPath* found = find_path(light_paths, names.back());
    if (found == nullptr)
      return fail(ErrorKind::usage, fmt::format("--path: no path of a light (got {}, allowed {}, FILE.json)",
                                                names.back(), choice_names<LightPath>(light_paths, ", ")));
    path.light = *found;
  }
  return {};
}

}  // namespace

void add_movement_options(CLI::App& app, MovementOptions& movement) {
  add_choice(app, "--move", movement.moves, all_moves, "WHAT", "what moves");
  add_value(
      app, "--path", "NAME[,NAME]|FILE.json",
      describe(
          "how: of the camera orbit, walk, turn, drift (sideways by parts of a texel, the map's window along "
          "with it) or still; of the light orbit, sun (over a day) or still; the camera's first where both "
          "move; or keys from a file (gnomon/path/1, docs/shimmer.md)",
          "names", "orbit; of a light sun where one is directional"),
      [&movement](const std::string& text) -> Expected<void> {
        movement.paths = parts_of(text);
        if (movement.paths.empty()) return fail(ErrorKind::usage, "wrong value (got nothing)");
        return {};
      });
  add_number(app, "--speed", movement.speed, speed_range, "factor",
             "how fast a path that is built in goes; orbit and turn: 10 degrees a second, walk: a tenth of "
             "the way to "
             "the camera's target a second, sun: a day in the whole film");
  add_value(
      app, "--drift", "U,V",
      describe(
          "of --path drift: how far the map's window goes with each frame, along its right and its up",
          fmt::format("texels, each {}", range_text(drift_range)),
          fmt::format("{},{}", number_text(movement.drift_texels.x), number_text(movement.drift_texels.y))),
      [&movement](const std::string& text) { return assign(movement.drift_texels, parse_drift(text)); });
}

std::string path_file(const MovementOptions& movement) {
  return movement.paths.size() == 1 && is_file(movement.paths.front()) ? movement.paths.front()
                                                                       : std::string();
}

Expected<compare::ShimmerPath> resolve_movement(const MovementOptions& movement, const Scene& scene) {
  const bool camera = movement.moves != Moves::light, light = movement.moves != Moves::camera;
  compare::ShimmerPath path;
  path.speed = movement.speed;
  path.drift_texels = movement.drift_texels;
  path.camera = camera ? CameraPath::orbit : CameraPath::still;
  path.light = light ? usual_light_path(scene) : LightPath::still;
  if (const std::string file = path_file(movement); !file.empty()) {
    auto keys = compare::read_path(file);
    if (!keys) return fail(keys.error());
    path.keys = std::move(*keys);
    path.camera = camera ? CameraPath::keys : CameraPath::still;
    path.light = light ? LightPath::keys : LightPath::still;
    return path;
  }
  if (const auto taken = take_names(movement, path); !taken) return fail(taken.error());
  return path;
}

}  // namespace gnomon::app

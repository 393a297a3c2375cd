// Paths of camera and light over a film's frames (docs/shimmer.md): built-in ones, and keys from a JSON file
// (schema gnomon/path/1). A pose is a function of the frame alone, so that any frame may be made again.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/expected.h"
#include "scene/world.h"

namespace gnomon::compare {

enum class Moves : std::uint8_t { camera, light, both };
enum class CameraPath : std::uint8_t {
  still,
  orbit,  ///< the eye about the target and the camera's up, 10 degrees a second
  walk,   ///< eye and target ahead, across up, a tenth of their distance a second
  turn,   ///< the target about the eye and the camera's up, 10 degrees a second
  drift,  ///< sideways by parts of a texel; the map's window moves along and keeps its size
  keys
};
enum class LightPath : std::uint8_t {
  still,
  orbit,  ///< about the middle of all that is finite and the camera's up, 10 degrees a second
  sun,  ///< directional: from 5 degrees after sunrise to 5 before sunset over the film; the scene's light is noon
  keys
};
std::string_view camera_path_name(CameraPath path);
std::string_view light_path_name(LightPath path);

enum class Interpolation : std::uint8_t { linear, cubic, step };

/// A vector over time. cubic: Catmull-Rom over the keys' own times (Barry and Goldman 1988), with the ends'
/// slopes from their one neighbour. Before the first and after the last key it stands still.
struct KeyedVector {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< seconds, rising
  std::vector<Vec3> values;   ///< one for each time
  Vec3 at(double time) const;
};

/// Keys from a file; what has none stands still.
struct KeyedPath {
  std::optional<KeyedVector> eye, target, up;
  struct OfLight {
    std::optional<KeyedVector> position, direction;
  };
  std::map<std::string, OfLight> lights;  ///< by name
};
/// Error (bad input) with line and column.
Expected<KeyedPath> read_path(const std::string& file);

struct ShimmerPath {
  CameraPath camera = CameraPath::orbit;
  LightPath light = LightPath::still;
  double speed = 1.0;            ///< factor of the built-in paths' own; finite
  Vec2 drift_texels{0.1, 0.07};  ///< per frame, along the map's right and up
  KeyedPath keys;
};

struct FilmTime {
  int frames = 60;    ///< >= 2
  double fps = 30.0;  ///< > 0
  /// In [0, 1] over the film.
  double share(int frame) const { return double(frame) / (frames - 1); }
  double seconds(int frame) const { return frame / fps; }
};

/// Error (usage): the path does not suit the scene's lights, or names one that is not there.
Expected<void> check_path(const ShimmerPath& path, const Scene& scene);

/// What stands where in a frame. A drift is not in it: that is of the map's texels (shimmer.h).
struct Pose {
  Camera camera;
  std::vector<Light> lights;
};
/// `first`: as the scene has it; `centre`: what lights turn about.
Pose pose_at(const ShimmerPath& path, const FilmTime& time, const Pose& first, const Vec3& centre, int frame);

/// Error (bad input): a camera without a view, its eye on its target or its up along its view.
Expected<void> check_pose(const Pose& pose, int frame);

}  // namespace gnomon::compare

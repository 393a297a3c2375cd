// Paths of camera and light over a film's frames (docs/shimmer.md): built-in ones, and keys (scene/keyed_path.h). A
// pose is a function of the frame alone, so that any frame may be made again.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/keyed_path.h"
#include "scene/world.h"

namespace gnomon::raster {
class Renderer;
}

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

struct ShimmerPath {
  CameraPath camera = CameraPath::orbit;
  LightPath light = LightPath::still;
  double speed = 1.0;            ///< factor of the built-in paths' own; finite
  Vec2 drift_texels{0.1, 0.07};  ///< per frame, along the map's right and up
  KeyedPath keys;
  bool objects = false;  ///< those that the keys' animation moves are moved, too (FilmPlan::stage)
};

struct FilmTime {
  int frames = 60;    ///< >= 2
  double fps = 30.0;  ///< > 0
  /// In [0, 1] over the film.
  double share(int frame) const { return double(frame) / (frames - 1); }
  double seconds(int frame) const { return frame / fps; }
};

/// The scene at one moment of a film whose objects move: the same triangles in the same order, elsewhere.
struct FilmStage {
  const World& world;
  Scene& scene;  ///< the world's own
  raster::Renderer& renderer;
};

/// What a film is besides its scene and its setting.
struct FilmPlan {
  ShimmerPath path;
  FilmTime time;
  int anchors = 1;  ///< receivers at every so many pixels along both axes, in [1, 64]
  /// Where objects move: the scene as it stands at so many seconds, valid until the next call.
  std::function<Expected<FilmStage>(double seconds)> stage{};
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

/// Error (bad input): a camera without a view, its eye on its target or its up along its view; a light
/// whose keys pass through no direction.
Expected<void> check_pose(const Pose& pose, int frame);

}  // namespace gnomon::compare

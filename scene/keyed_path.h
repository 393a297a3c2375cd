// Where a camera and lights stand over time, by keys. These come from a file of the project's own (schema
// gnomon/path/1), from the "paths" of a scene, or from the animations of a glTF file.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <string>
#include <valarray>
#include <vector>

#include "scene/base/expected.h"
#include "scene/scene.h"

namespace gnomon {

using Quaternion = glm::dquat;

enum class Interpolation : std::uint8_t { linear, cubic, step };

/// A value over time. Before the first and after the last key it stands still.
template <class Value>
struct Keys {
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;  ///< seconds, rising
  std::vector<Value> values;  ///< one for each time
  /// cubic: the derivative before and behind each key, per second (glTF 2.0, appendix C); empty: Catmull-Rom over the
  /// keys' own times (Barry and Goldman 1988), with the ends' slopes from their one neighbour.
  std::vector<Value> slopes_in{}, slopes_out{};
};

struct KeyedVector : Keys<Vec3> {
  Vec3 at(double seconds) const;
};
/// Unit quaternions. linear: the shorter great arc; cubic: normalised afterwards. Needs slopes to be cubic.
struct KeyedRotation : Keys<Quaternion> {
  Quaternion at(double seconds) const;
};

/// Lists of numbers, all of one length: weights of morph targets.
struct KeyedNumbers : Keys<std::valarray<double>> {
  std::valarray<double> at(double seconds) const;
};

/// A node of a tree: its parent's space from its own. What has no keys stays as it is stored.
struct MovedNode {
  Mat4 matrix{1.0};  ///< of a node without any keys
  Vec3 translation{0.0}, scale{1.0};
  Quaternion rotation{1.0, 0.0, 0.0, 0.0};
  std::optional<KeyedVector> translations{}, scales{};
  std::optional<KeyedRotation> rotations{};
  bool is_keyed() const { return translations || scales || rotations; }
  Mat4 at(double seconds) const;
};
/// From the root on to the node that carries a camera or a light, which look along -z, with y up.
using NodeChain = std::vector<MovedNode>;
Mat4 transform_at(const NodeChain& chain, double seconds);

struct KeyedPath {
  std::string name{};
  std::optional<KeyedVector> eye{}, target{}, up{};
  NodeChain camera{};  ///< of a glTF file, in place of the above; empty: the camera does not move
  struct OfLight {
    std::optional<KeyedVector> position{}, direction{};
    NodeChain nodes{};  ///< as for the camera
  };
  std::map<std::string, OfLight> lights{};  ///< by name
  /// Tells until when a glTF file's animation moves objects, seconds; where they stand is for the loader to say
  /// (LoadOptions::animation). None: it moves none.
  std::optional<double> objects_until{};

  bool moves_camera() const { return eye || target || up || !camera.empty(); }
  double seconds() const;  ///< the last key's time, that of objects too
  Camera camera_at(const Camera& stored, double seconds) const;
  /// Returns the light at that time; it is as stored where the path has no keys of its name.
  Light light_at(const Light& stored, double seconds) const;
};

/// A file of schema gnomon/path/1. Error (bad input) with line and column.
Expected<KeyedPath> read_path(const std::string& file);

}  // namespace gnomon

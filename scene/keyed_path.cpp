#include "scene/keyed_path.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {
namespace {

struct Between {
  std::size_t key = 0;  // the one before
  double share = 0.0;   // of the way to the next, in [0, 1)
};

// Nothing before the first key and from the last one on.
template <class Value>
std::optional<Between> between(const Keys<Value>& keys, double seconds) {
  if (!(seconds > keys.times.front()) || seconds >= keys.times.back()) return std::nullopt;
  const auto after = std::upper_bound(keys.times.begin(), keys.times.end(), seconds);
  const auto i = static_cast<std::size_t>(after - keys.times.begin()) - 1;
  return Between{i, (seconds - keys.times[i]) / (keys.times[i + 1] - keys.times[i])};
}

template <class Value>
const Value& end_value(const Keys<Value>& keys, double seconds) {
  return seconds > keys.times.front() ? keys.values.back() : keys.values.front();
}

template <class Value>
Value slope_at(const Keys<Value>& keys, std::size_t k) {
  const std::size_t before = k > 0 ? k - 1 : k, after = std::min(k + 1, keys.times.size() - 1);
  return (keys.values[after] - keys.values[before]) * (1.0 / (keys.times[after] - keys.times[before]));
}

// A cubic Hermite curve over the segment's own time.
template <class Value>
Value cubic_at(const Keys<Value>& keys, const Between& at) {
  const std::size_t i = at.key;
  const double length = keys.times[i + 1] - keys.times[i], s = at.share, s2 = s * s, s3 = s2 * s;
  const bool given = !keys.slopes_out.empty();
  const Value from = given ? keys.slopes_out[i] : slope_at(keys, i);
  const Value to = given ? keys.slopes_in[i + 1] : slope_at(keys, i + 1);
  return (2.0 * s3 - 3.0 * s2 + 1.0) * keys.values[i] + (s3 - 2.0 * s2 + s) * length * from +
         (3.0 * s2 - 2.0 * s3) * keys.values[i + 1] + (s3 - s2) * length * to;
}

template <class Value>
Value value_at(const Keys<Value>& keys, double seconds) {
  const auto found = between(keys, seconds);
  if (!found) return end_value(keys, seconds);
  switch (keys.interpolation) {
    case Interpolation::step:
      return keys.values[found->key];
    case Interpolation::linear:
      return (1.0 - found->share) * keys.values[found->key] + found->share * keys.values[found->key + 1];
    case Interpolation::cubic:
      break;
  }
  return cubic_at(keys, *found);
}

template <class Value>
double last_time(const std::optional<Value>& keys) {
  return keys ? keys->times.back() : 0.0;
}

double last_time(const NodeChain& chain) {
  double last = 0.0;
  for (const MovedNode& node : chain)
    last = std::max({last, last_time(node.translations), last_time(node.scales), last_time(node.rotations)});
  return last;
}

// What turns the stored light's shape along with its node.
Mat3 turn_between(const Mat4& from, const Mat4& to) {
  const auto axes = [](const Mat4& m) {
    const Vec3 z = glm::normalize(Vec3(m[2]));
    const Vec3 x = glm::normalize(Vec3(m[0]) - glm::dot(Vec3(m[0]), z) * z);
    return Mat3(x, glm::cross(z, x), z);
  };
  return axes(to) * glm::transpose(axes(from));
}

}  // namespace

Vec3 KeyedVector::at(double seconds) const {
  return value_at(*this, seconds);
}

std::valarray<double> KeyedNumbers::at(double seconds) const {
  return value_at(*this, seconds);
}

Quaternion KeyedRotation::at(double seconds) const {
  const auto found = between(*this, seconds);
  if (!found) return glm::normalize(end_value(*this, seconds));
  switch (interpolation) {
    case Interpolation::step:
      return glm::normalize(values[found->key]);
    case Interpolation::linear:
      return glm::slerp(glm::normalize(values[found->key]), glm::normalize(values[found->key + 1]),
                        found->share);
    case Interpolation::cubic:
      break;
  }
  return glm::normalize(cubic_at(*this, *found));
}

Mat4 MovedNode::at(double seconds) const {
  if (!is_keyed()) return matrix;
  const Mat4 moved = glm::translate(Mat4(1.0), translations ? translations->at(seconds) : translation);
  const Mat4 turned = glm::mat4_cast(rotations ? rotations->at(seconds) : rotation);
  return glm::scale(moved * turned, scales ? scales->at(seconds) : scale);
}

Mat4 transform_at(const NodeChain& chain, double seconds) {
  Mat4 world(1.0);
  for (const MovedNode& node : chain) world *= node.at(seconds);
  return world;
}

double KeyedPath::seconds() const {
  double last = std::max(
      {objects_until.value_or(0.0), last_time(eye), last_time(target), last_time(up), last_time(camera)});
  for (const auto& [light, keys] : lights)
    last = std::max({last, last_time(keys.position), last_time(keys.direction), last_time(keys.nodes)});
  return last;
}

Camera KeyedPath::camera_at(const Camera& stored, double seconds) const {
  Camera out = stored;
  if (eye) out.eye = eye->at(seconds);
  if (target) out.target = target->at(seconds);
  if (up) out.up = up->at(seconds);
  if (camera.empty()) return out;
  const Mat4 world = transform_at(camera, seconds);
  const double ahead = glm::length(stored.target - stored.eye);
  out.eye = Vec3(world[3]);
  out.target = out.eye - ahead * glm::normalize(Vec3(world[2]));
  out.up = glm::normalize(Vec3(world[1]));
  return out;
}

Light KeyedPath::light_at(const Light& stored, double seconds) const {
  const auto found = lights.find(stored.name);
  if (found == lights.end()) return stored;
  const OfLight& keys = found->second;
  Light out = stored;
  if (keys.position) out.position = keys.position->at(seconds);
  if (keys.direction) out.direction = glm::normalize(keys.direction->at(seconds));
  if (keys.nodes.empty()) return out;
  const Mat4 world = transform_at(keys.nodes, seconds);
  out.position = Vec3(world[3]);
  out.direction = -glm::normalize(Vec3(world[2]));
  const Mat3 turn = turn_between(transform_at(keys.nodes, 0.0), world);
  turn_shape(out.extent, [&](const Vec3& v) { return turn * v; });
  return out;
}

}  // namespace gnomon

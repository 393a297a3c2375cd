#include "scene/files/made_view.h"

#include <algorithm>
#include <array>

#include "scene/files/defaults.h"

namespace gnomon {
namespace {

constexpr double default_fov = 40.0 * pi / 180.0;
constexpr double margin = 1.1;
constexpr double visible = 0.5;  // of what is looked at: one need not look from elsewhere

/// The ways from the target to the eye that are tried, the first one wherever it does.
constexpr std::array ways_back{Vec3(0.55, 0.5, 1.0), Vec3(-0.55, 0.5, 1.0), Vec3(0.55, 0.5, -1.0),
                               Vec3(-0.55, 0.5, -1.0), Vec3(0.4, 1.4, 0.7)};

/// A point's least distance of the eye from `center` for which the point is in the picture.
class Framing {
 public:
  Framing(const Vec3& center, const Vec3& back, double aspect)
      : center_(center), back_(glm::normalize(back)), aspect_(aspect) {
    right_ = glm::normalize(glm::cross(Vec3(0.0, 1.0, 0.0), back_));
    up_ = glm::cross(back_, right_);
  }
  double distance(const Vec3& p) const {
    const Vec3 offset = p - center_;
    const double across =
        std::max(std::abs(glm::dot(offset, right_)) / aspect_, std::abs(glm::dot(offset, up_)));
    return across / (std::tan(0.5 * default_fov) / margin) + glm::dot(offset, back_);
  }
  Camera at(double distance) const {
    Camera camera;
    camera.target = center_;
    camera.eye = center_ + back_ * (distance > 0.0 ? distance : 1.0);
    camera.vertical_fov = default_fov;
    return camera;
  }

 private:
  Vec3 center_, back_, right_, up_;
  double aspect_;
};

/// The subject, and what shadow the default sun throws of it on the ground below it.
Camera framed_with_shadow(const SceneParts& parts, const Subject& subject, const Vec3& back, double aspect) {
  const Vec3 sun = default_sun(framed(subject.box, back, aspect)).direction;
  std::vector<Vec3> shadow;
  Aabb box = subject.box;
  for_each_corner(subject.box, [&](const Vec3& p) {
    shadow.push_back(p + sun * ((subject.box.min.y - p.y) / sun.y));
    box.grow(shadow.back());
  });
  const Framing framing(box.center(), back, aspect);
  double distance = 0.0;
  const auto include = [&](const Vec3& p) { distance = std::max(distance, framing.distance(p)); };
  for (const Vec3& p : shadow) include(p);
  parts.visit_triangles([&](const PlacedTriangle& t, std::uint32_t part) {
    if (subject.aside[part] == 0) include(t.a), include(t.b), include(t.c);
  });
  parts.visit_shapes([&](const Shape& shape, std::uint32_t part) {
    if (subject.aside[part] == 0) for_each_corner(box_of(shape), include);
  });
  return framing.at(distance);
}

/// Nearer by that factor, and of a field as much wider.
Camera stepped_in(Camera camera, double factor) {
  camera.eye = glm::mix(camera.target, camera.eye, factor);
  camera.vertical_fov = 2.0 * std::atan(std::tan(0.5 * camera.vertical_fov) / factor);
  return camera;
}

/// From where most of the subject is seen, else none: the first that is about as good as any.
std::optional<Camera> look_at(const Scene& scene, const SceneParts& parts, const Subject& subject,
                              double aspect) {
  constexpr double as_good = 0.6, least = 0.05;
  const auto counts = [&](std::uint32_t part) { return subject.aside[part] == 0; };
  std::vector<std::pair<double, Camera>> tried;
  double best = least;
  for (const double factor : {1.0, 0.7, 0.45})
    for (const Vec3& back : ways_back) {
      const Camera camera = stepped_in(framed_with_shadow(parts, subject, back, aspect), factor);
      tried.emplace_back(seen_share(scene, parts, camera, counts), camera);
      if (tried.size() == 1 && tried.front().first >= visible) return camera;
      best = std::max(best, tried.back().first);
    }
  const auto found =
      std::find_if(tried.begin(), tried.end(), [&](const auto& t) { return t.first >= as_good * best; });
  return found == tried.end() ? std::nullopt : std::optional(found->second);
}

/// Whether no eye outside sees what a shell holds.
bool is_hidden(const Scene& scene, const SceneParts& parts, const Subject& subject, const Aabb& bounds) {
  constexpr double hidden = 0.1;
  return std::all_of(ways_back.begin(), ways_back.end(), [&](const Vec3& back) {
    return seen_share(scene, parts, framed(bounds, back),
                      [&](std::uint32_t part) { return subject.aside[part] == 0; }) <= hidden;
  });
}

}  // namespace

Camera framed(const Aabb& box, const Vec3& back, double aspect) {
  const Framing framing(box.center(), back, aspect);
  double distance = 0.0;
  for_each_corner(box, [&](const Vec3& p) { distance = std::max(distance, framing.distance(p)); });
  return framing.at(distance);
}

Camera default_camera(const Scene& scene, const Aabb& bounds, double aspect) {
  const Framing framing(bounds.center(), ways_back[0], aspect);
  const double distance = over_points(
      scene, 0.0, [&](double& most, const Vec3& p) { most = std::max(most, framing.distance(p)); },
      [](double& most, double more) { most = std::max(most, more); });
  return distance == 0.0 ? framed(bounds, ways_back[0], aspect) : framing.at(distance);  // planes alone
}

MadeView find_view(const Scene& scene, const SceneParts& parts, const Aabb& bounds, double aspect) {
  Subject subject = find_subject(parts, true);
  if (subject.in_shell && !is_hidden(scene, parts, subject, bounds)) subject = find_subject(parts, false);
  if (subject.anything)
    if (const auto camera = look_at(scene, parts, subject, aspect)) {
      std::vector<char> looked_at;
      for (const char aside : subject.aside) looked_at.push_back(static_cast<char>(aside == 0));
      return {*camera, subject.in_shell, std::move(looked_at)};
    }
  return {default_camera(scene, bounds, aspect), false, std::vector<char>(parts.all().size(), 1)};
}

}  // namespace gnomon

#include "lab/view/state/projection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon::lab {

namespace {

constexpr double least_depth = 1e-3;  // of the distance to the target: what is nearer is behind the eye

/// Returns a view that is as wide as it is high: what lies beside it has coordinates beyond -1 and 1.
View square_view(const Camera& camera) {
  return make_view(camera, {1, 1});
}

/// So that the dome lies inside the picture.
double sun_radius(const ViewState& state) {
  const Camera camera = posed_camera(state);
  return 0.65 * 0.5 * picture_height(camera, glm::length(camera.target - camera.eye));
}

}  // namespace

std::optional<Vec2> ScreenCamera::project(const Vec3& world) const {
  const View view = square_view(camera);
  const Vec3 v = world - camera.eye;
  const double depth = glm::dot(v, view.forward);
  if (depth < least_depth * glm::length(camera.target - camera.eye)) return std::nullopt;
  const double scale = 0.5 * place.height / (view.half_y + depth * view.tan_half_y);
  return Vec2{place.x + 0.5 * place.width + scale * glm::dot(v, view.right),
              place.y + 0.5 * place.height - scale * glm::dot(v, view.up)};
}

std::optional<std::pair<Vec2, Vec2>> ScreenCamera::project(const Vec3& from, const Vec3& to) const {
  const Vec3 forward = square_view(camera).forward;
  const double least = 1.01 * least_depth * glm::length(camera.target - camera.eye);
  Vec3 a = from, b = to;
  const double da = glm::dot(a - camera.eye, forward), db = glm::dot(b - camera.eye, forward);
  if (da < least && db < least) return std::nullopt;
  if (da < least) a += (least - da) / (db - da) * (b - a);
  if (db < least) b += (least - db) / (da - db) * (a - b);
  const auto pa = project(a), pb = project(b);
  if (!pa || !pb) return std::nullopt;
  return std::pair{*pa, *pb};
}

Ray ScreenCamera::ray(Vec2 pixel) const {
  const View view = square_view(camera);
  const double half = 0.5 * place.height;
  const Vec2 at((pixel.x - place.x - 0.5 * place.width) / half, -(pixel.y - place.y - half) / half);
  return {view.ray_origin(at), view.ray_direction(at)};
}

LightHandle light_handle(const ViewState& state) {
  const Light light = posed_light(state);
  if (light.type != LightType::directional) return {state.given.centre, light.position, false};
  const Vec3 centre = posed_camera(state).target;
  return {centre, centre - sun_radius(state) * light.direction, true};
}

Change drag_handle(const ViewState& state, const LightHandle& handle, const ScreenCamera& camera,
                   Vec2 pixel) {
  const Ray ray = camera.ray(pixel);
  const Vec3 direction = ray.direction, eye = ray.origin;
  const Vec3 forward = glm::normalize(camera.camera.target - camera.camera.eye);
  if (!handle.sun) {
    const double t = glm::dot(handle.place - eye, forward) / glm::dot(direction, forward);
    return PlaceLamp{eye + t * direction};
  }
  // The point of the dome nearest to the ray, on the near side where the ray meets it.
  const double radius = sun_radius(state), a = glm::dot(direction, direction);
  const double b = glm::dot(direction, eye - handle.centre);
  const double c = glm::dot(eye - handle.centre, eye - handle.centre) - radius * radius;
  const double root = b * b - a * c;
  const bool far_side = glm::dot(handle.place - handle.centre, forward) > 0.0;
  const double t = (-b + (far_side ? 1.0 : -1.0) * std::sqrt(std::max(0.0, root))) / a;
  Light sun = state.given.lights[state.setup.light];
  sun.direction = -glm::normalize(eye + t * direction - handle.centre);
  const app::LightPose to = app::light_pose(sun, state.given.centre), from = current_light(state);
  return TurnLightBy{app::wrapped_degrees(to.azimuth_degrees - from.azimuth_degrees),
                     to.elevation_degrees - from.elevation_degrees};
}

std::vector<std::pair<Vec3, Vec3>> box_edges(const std::array<Vec3, 8>& corners) {
  std::vector<std::pair<Vec3, Vec3>> edges;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    edges.emplace_back(corners[i], corners[i + 4]);
    edges.emplace_back(corners[i], corners[next]);
    edges.emplace_back(corners[i + 4], corners[next + 4]);
  }
  return edges;
}

std::vector<std::pair<Vec3, Vec3>> frustum_edges(const LightView& view) {
  std::vector<std::pair<Vec3, Vec3>> edges;
  for (int f = 0; f < view.face_count; ++f) {
    const auto of_face = box_edges(face_corners(view, f));
    edges.insert(edges.end(), of_face.begin(), of_face.end());
  }
  return edges;
}

}  // namespace gnomon::lab

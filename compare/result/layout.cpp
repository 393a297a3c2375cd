#include "compare/result/layout.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/summary_page.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {
namespace {

/// How far the camera sees, world units along its axis: to the farthest corner of what is finite, or twice as far as what
/// it looks at.
double depth_seen(const World& world, const Camera& camera) {
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  const double to_target = glm::length(camera.target - camera.eye);
  if (world.finite_bounds.empty()) return 2.0 * to_target;
  double farthest = 0.0;
  for (int k = 0; k < 8; ++k) {
    const Vec3& low = world.finite_bounds.min;
    const Vec3& high = world.finite_bounds.max;
    const Vec3 corner((k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                      (k & 4) != 0 ? high.z : low.z);
    farthest = std::max(farthest, glm::dot(corner - camera.eye, forward));
  }
  return farthest > 0.0 ? farthest : 2.0 * to_target;
}

/// Of another renderer's map its size; of a window that was given which casters it lacks.
std::string casters_words(const Comparison& c, const LightView& view) {
  const LightFace& face = view.face(0);
  if (c.raster.lights.front().foreign)
    return fmt::format("The capture's map is {} x {}.", plain_number(2.0 * face.half_extent.x),
                       plain_number(2.0 * face.half_extent.y));
  if (c.raster.options.map.window.empty()) return "The map was fitted to hold the casters.";
  const WindowCasters casters = window_casters(*c.world, view);
  if (casters.inside == casters.count())
    return casters.count() == 1 ? "The window holds the one caster."
                                : fmt::format("The window holds all {} casters.", grouped(casters.count()));
  std::string text =
      fmt::format("Of {} the window holds {}", counted(casters.count(), "caster"), grouped(casters.inside));
  std::string_view before = "; ";
  const auto add = [&](std::uint64_t count, std::string_view where) {
    if (count == 0) return;
    text += fmt::format("{}{} {} {}", before, grouped(count), count == 1 ? "lies" : "lie", where);
    before = ", ";
  };
  add(casters.cut, "across its border");
  add(casters.beside, "beside it (their shadows are missing)");
  add(casters.before, "before the near plane (drawn at it)");
  add(casters.beyond, "beyond the far plane (not drawn)");
  return text + ".";
}

std::string share_words(std::uint64_t part, std::uint64_t whole) {
  return percent(double(part) / double(std::max<std::uint64_t>(whole, 1)));
}

std::string receivers_words(const LightComparison& light) {
  const OutsideMap& outside = light.outside;
  if (light.pixels.compared == 0) return {};
  if (outside.receivers == 0) return "All that is seen lies in it.";
  const std::string text = fmt::format("{} of what is seen lies outside it, ",
                                       share_words(outside.receivers, light.pixels.compared));
  if (outside.drawn_dark > 0)
    return text + fmt::format("{} of it drawn as shadow.", counted(outside.drawn_dark, "pixel"));
  return text + (outside.shadowed == 0 ? std::string("drawn as lit; no shadow falls there.")
                                       : fmt::format("drawn as lit; {} is shadow that is lost.",
                                                     share_words(outside.shadowed, light.pixels.compared)));
}

}  // namespace

std::array<Vec3, 8> camera_corners(const World& world, const Camera& camera, const ImageSize& size) {
  const View view = make_view(camera, size);
  const double far = depth_seen(world, camera);
  std::array<Vec3, 8> corners;
  std::size_t next = 0;
  for (const double depth : {0.0, far})
    for (const Vec2& at : corner_places)
      corners[next++] = view.ray_origin(at) + depth * view.ray_direction(at);
  return corners;
}

Json camera_json(const Comparison& c) {
  const World& world = *c.world;
  const Camera& camera = world.scene->camera;
  const View view = make_view(camera, c.raster.options.size);
  Json corners = Json::array();
  for (const Vec3& corner : camera_corners(world, camera, c.raster.options.size))
    corners.push_back(vector3(corner));
  const Aabb& bounds = world.finite_bounds;
  return {{"eye", vector3(camera.eye)},
          {"forward", vector3(view.forward)},
          {"corners", std::move(corners)},
          {"finite_bounds", bounds.empty() ? Json(nullptr) : Json{vector3(bounds.min), vector3(bounds.max)}}};
}

Json windows_json(const Comparison& c, const LightComparison& light) {
  Json windows = Json::array();
  if (!c.raster.has_map()) return windows;
  const LightView& view = drawn_record(c, light).map.view;
  for (int face = 0; face < view.face_count; ++face) {
    Json corners = Json::array();
    for (const Vec3& corner : face_corners(view, face)) corners.push_back(vector3(corner));
    windows.push_back(std::move(corners));
  }
  return windows;
}

std::string window_words(const Comparison& c, const LightComparison& light) {
  if (!c.raster.has_map() || c.world == nullptr) return {};
  const LightView& view = drawn_record(c, light).map.view;
  const bool parallel = view.projection == LightProjection::orthographic;
  return joined_sentences(
      {parallel && view.face_count == 1 ? casters_words(c, view) : std::string(), receivers_words(light)});
}

}  // namespace gnomon::compare

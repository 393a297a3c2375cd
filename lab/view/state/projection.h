// From the world to a picture on the screen and back, and the handle that moves the light. Plain data, without a
// window.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "lab/view/state/state.h"
#include "lab/view/window/layout.h"
#include "scene/camera.h"
#include "scene/light_map/light_view.h"

namespace gnomon::lab {

/// Where points of the world lie on a picture that is shown at `place`; pixels of the window.
struct ScreenCamera {
  Camera camera;
  Box place;
  /// Nothing for what is behind the eye.
  std::optional<Vec2> project(const Vec3& world) const;
  /// The part of a line that lies before the eye.
  std::optional<std::pair<Vec2, Vec2>> project(const Vec3& from, const Vec3& to) const;
  /// Through a pixel; its direction is not unit.
  Ray ray(Vec2 pixel) const;
};

/// The handle of the light that is compared: of a lamp its own place, of a sun a point on a dome over the scene's
/// centre, both in the world.
struct LightHandle {
  Vec3 centre, place;
  bool sun = false;
};
LightHandle light_handle(const ViewState& state);
/// What dragging the handle to this pixel makes: a lamp stays in the plane that faces the camera, a sun on its
/// dome, on the side that faces the eye.
Change drag_handle(const ViewState& state, const LightHandle& handle, const ScreenCamera& camera, Vec2 pixel);

/// The twelve edges of a box or a frustum, by its corners as face_corners has them.
std::vector<std::pair<Vec3, Vec3>> box_edges(const std::array<Vec3, 8>& corners);
/// The edges of what the map covers, face by face: lines in the world.
std::vector<std::pair<Vec3, Vec3>> frustum_edges(const LightView& view);

}  // namespace gnomon::lab

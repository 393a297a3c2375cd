// The mouse over the pictures.
#include <cmath>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "lab/view/state/projection.h"
#include "lab/view/viewer.h"

namespace gnomon::lab {

namespace {

/// The pane under the pointer, and where in its picture: shares of the sides.
struct Under {
  std::size_t pane = 0;
  Box place;
  Vec2 share{0.5};
};

std::optional<Under> under(const LabLayout& layout, const ViewState& state, Vec2 at) {
  for (std::size_t i = 0; i < layout.panes.size(); ++i) {
    if (!layout.panes[i].holds(at.x, at.y)) continue;
    const Box place = placed(layout.picture, layout.panes[i], state.look);
    return Under{i, place, {(at.x - place.x) / place.width, (at.y - place.y) / place.height}};
  }
  return std::nullopt;
}

constexpr double grip_pixels = 8.0;     // how near the line of a swipe one has to be
constexpr double handle_pixels = 12.0;  // how near the light's handle

/// Where a view that shows the light's handle has it: where the part that is shown ends, it is not seen.
struct SeenHandle {
  ScreenCamera camera;
  Box part;
  Vec2 place{0.0};
};

std::vector<SeenHandle> seen_handles(const LabLayout& layout, const ViewState& state) {
  std::vector<SeenHandle> seen;
  if (!state.look.panels) return seen;
  for (const ShownView& view : shown_views(layout, state.look, state.picture, state.previous)) {
    if (!shows_scene(view.picture)) continue;
    const ScreenCamera camera{posed_camera(state), placed(layout.picture, view.pane, state.look)};
    if (const auto place = camera.project(light_handle(state).place))
      seen.push_back({camera, view.part, *place});
  }
  return seen;
}

/// The camera of the view under the pointer, where its handle of the light lies there.
std::optional<ScreenCamera> handle_under(const LabLayout& layout, const ViewState& state, Vec2 at,
                                         double reach) {
  for (const SeenHandle& handle : seen_handles(layout, state))
    if (handle.part.holds(at.x, at.y) && glm::length(handle.place - at) < reach) return handle.camera;
  return std::nullopt;
}

}  // namespace

std::optional<Vec2> Viewer::shown_handle() const {
  for (const SeenHandle& handle : seen_handles(layout_, state_))
    if (handle.part.holds(handle.place.x, handle.place.y)) return handle.place;
  return std::nullopt;
}

void Viewer::press(int button, bool down, const Modifiers& held) {
  busy_frames_ = 3;
  if (!down) {
    const bool held_something = holds_swipe_ || held_light_;
    holds_swipe_ = false;
    held_light_.reset();
    if (held_something) return;
    if (!pointer_.release(button)) return;
    if (const auto hit = under(layout_, state_, pointer_.place()))
      lab::carry_out(state_, ProbePixel{PixelPlace{static_cast<int>(hit->share.x * layout_.picture.width),
                                                   static_cast<int>(hit->share.y * layout_.picture.height)}});
    return;
  }
  if (interface_->wants_pointer() || !layout_.pictures.holds(pointer_.place().x, pointer_.place().y)) return;
  const Box& pane = layout_.panes.front();
  const double line = pane.x + state_.look.swipe * pane.width;
  holds_swipe_ = button == GLFW_MOUSE_BUTTON_LEFT && state_.look.layout == PaneLayout::swipe &&
                 std::abs(pointer_.place().x - line) < grip_pixels * type().scale;
  if (holds_swipe_) return;
  if (button == GLFW_MOUSE_BUTTON_LEFT)
    held_light_ = handle_under(layout_, state_, pointer_.place(), handle_pixels * type().scale);
  if (!held_light_) pointer_.press(button, held);
}

void Viewer::move(double x, double y) {
  busy_frames_ = 3;
  const Box& pane = layout_.panes.empty() ? Box{0, 0, 1, 1} : layout_.panes.front();
  const Box place =
      placed(layout_.picture.pixels() > 0 ? layout_.picture : ImageSize{1, 1}, pane, state_.look);
  const auto change = pointer_.move_to(x, y, {place.width, place.height});
  if (holds_swipe_) return lab::carry_out(state_, SwipeTo{(x - pane.x) / pane.width});
  if (held_light_)
    return lab::carry_out(state_, drag_handle(state_, light_handle(state_), *held_light_, {x, y}));
  if (change) lab::carry_out(state_, *change);
}

void Viewer::scroll(double notches, const Modifiers& held) {
  busy_frames_ = 3;
  if (interface_->wants_pointer()) return;
  const auto hit = under(layout_, state_, pointer_.place());
  if (!hit) return;
  if (held.control) return lab::carry_out(state_, ZoomPicture{std::pow(1.25, notches), hit->share});
  lab::carry_out(state_, zoom_for_scroll(notches));
}

}  // namespace gnomon::lab

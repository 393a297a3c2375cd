#include "app/view/input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

namespace gnomon::app {

namespace {

constexpr double orbit_step = 5.0, fine_orbit_step = 1.0;         // degrees
constexpr double light_step = 2.0, fine_light_step = 0.25;        // degrees
constexpr double bias_step = 1.0 / 16.0, coarse_bias_step = 1.0;  // texels
constexpr double slope_step = 0.125, coarse_slope_step = 1.0;     // multiples of the texel's depth slope
constexpr double offset_step = 0.125, coarse_offset_step = 1.0;   // texels
constexpr double zoom_step = 1.1;                                 // of the distance, per notch or key
constexpr double degrees_per_pixel = 0.25;                        // of a drag

std::optional<Change> view_change(int key) {
  switch (key) {
    case GLFW_KEY_1:
      return Show{Picture::raster};
    case GLFW_KEY_2:
      return Show{Picture::raytrace};
    case GLFW_KEY_3:
      return Show{Picture::difference};
    case GLFW_KEY_4:
      return Show{Picture::labels};
    case GLFW_KEY_5:
      return Show{Picture::depth};
    case GLFW_KEY_TAB:
      return ShowPrevious{};
    default:
      return std::nullopt;
  }
}

std::optional<Change> turning_change(int key, bool fine) {
  const double orbit = fine ? fine_orbit_step : orbit_step, light = fine ? fine_light_step : light_step;
  switch (key) {
    case GLFW_KEY_LEFT:
      return OrbitBy{-orbit, 0.0};
    case GLFW_KEY_RIGHT:
      return OrbitBy{orbit, 0.0};
    case GLFW_KEY_DOWN:
      return OrbitBy{0.0, -orbit};
    case GLFW_KEY_UP:
      return OrbitBy{0.0, orbit};
    case GLFW_KEY_PAGE_UP:
      return ZoomBy{1.0 / zoom_step};
    case GLFW_KEY_PAGE_DOWN:
      return ZoomBy{zoom_step};
    case GLFW_KEY_LEFT_BRACKET:
      return TurnLightBy{-light, 0.0};
    case GLFW_KEY_RIGHT_BRACKET:
      return TurnLightBy{light, 0.0};
    case GLFW_KEY_SEMICOLON:
      return TurnLightBy{0.0, -light};
    case GLFW_KEY_APOSTROPHE:
      return TurnLightBy{0.0, light};
    default:
      return std::nullopt;
  }
}

std::optional<Change> map_change(int key, bool coarse) {
  const double bias = coarse ? coarse_bias_step : bias_step, slope = coarse ? coarse_slope_step : slope_step;
  const double offset = coarse ? coarse_offset_step : offset_step;
  switch (key) {
    case GLFW_KEY_MINUS:
      return StepBias{-bias};
    case GLFW_KEY_EQUAL:
      return StepBias{bias};
    case GLFW_KEY_9:
      return StepSlopeBias{-slope};
    case GLFW_KEY_0:
      return StepSlopeBias{slope};
    case GLFW_KEY_7:
      return StepNormalOffset{-offset};
    case GLFW_KEY_8:
      return StepNormalOffset{offset};
    case GLFW_KEY_COMMA:
      return HalveMap{};
    case GLFW_KEY_PERIOD:
      return DoubleMap{};
    case GLFW_KEY_D:
      return NextDepthFormat{};
    case GLFW_KEY_K:
      return NextCull{};
    case GLFW_KEY_L:
      return NextLight{};
    case GLFW_KEY_R:
      return Reset{};
    default:
      return std::nullopt;
  }
}

std::optional<Command> command(int key) {
  switch (key) {
    case GLFW_KEY_P:
    case GLFW_KEY_F12:
      return Command::save_screenshot;
    case GLFW_KEY_C:
      return Command::print_command;
    case GLFW_KEY_H:
    case GLFW_KEY_F1:
      return Command::print_help;
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE:
      return Command::quit;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<Action> action_for_key(int key, bool shift) {
  if (const auto change = view_change(key)) return *change;
  if (const auto change = turning_change(key, shift)) return *change;
  if (const auto change = map_change(key, shift)) return *change;
  if (const auto asked = command(key)) return *asked;
  return std::nullopt;
}

Change zoom_for_scroll(double notches) {
  return ZoomBy{std::pow(zoom_step, -notches)};
}

void Pointer::press(int button) {
  if (button == GLFW_MOUSE_BUTTON_LEFT) left_ = true;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) right_ = true;
}

void Pointer::release(int button) {
  if (button == GLFW_MOUSE_BUTTON_LEFT) left_ = false;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) right_ = false;
}

std::optional<Change> Pointer::move_to(double x, double y) {
  const double right = (x - x_) * degrees_per_pixel, down = (y - y_) * degrees_per_pixel;
  x_ = x, y_ = y;
  if (left_) return OrbitBy{-right, down};  // the scene follows the hand
  if (right_) return TurnLightBy{right, -down};
  return std::nullopt;
}

std::string key_help() {
  return "left drag, arrows       turn the camera (shift: finer)    scroll, page up/down  zoom\n"
         "right drag, [ ] ; '     turn the light (shift: finer)     L                     next light\n"
         "1 raster  2 ray traced  3 difference  4 labels  5 depth map                     tab  the one "
         "before\n"
         "- =  bias               9 0  slope bias                   7 8  normal offset    (shift: coarser)\n"
         ", .  map size           D  depth format                   K  cull               R  as at the "
         "start\n"
         "P, F12  screenshot      C  print the compare command      H, F1  this help      Q, Esc  quit\n";
}

}  // namespace gnomon::app

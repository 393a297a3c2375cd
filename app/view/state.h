// What the window shows, as plain data, and how each action changes it. No window, no OpenGL: all of this is
// tested without a display. The camera and the light are kept as poses (app/pose.h), so that a state can be
// said in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/pose.h"
#include "raster/options.h"
#include "scene/expected.h"
#include "scene/world.h"

namespace gnomon::app {

enum class Picture : std::uint8_t { raster, raytrace, difference, labels, depth };
inline constexpr std::size_t picture_count = 5;
std::string_view picture_name(Picture picture);
/// Unknown names are ErrorKind::usage, with a suggestion.
Expected<Picture> parse_picture(std::string_view name);

/// The scene's own camera and lights, which poses refer to.
struct GivenScene {
  Camera camera;
  std::vector<Light> lights;
  Vec3 centre{0.0};  ///< what a lamp turns about
};
GivenScene given_scene(const Scene& scene, const World& world);

/// Everything that the pictures depend on.
struct Setup {
  std::optional<CameraPose> camera;              ///< none: as the file has it, to the last bit
  std::vector<std::optional<LightPose>> lights;  ///< as the scene's
  std::uint32_t light = 0;                       ///< the one that is compared and turned
  raster::MapOptions map;
  ImageSize size{1280, 720};  ///< pixels of the window
};

/// Gives the scene the camera and the lights that the setup says.
void place(const GivenScene& given, const Setup& setup, Scene& scene);

struct ViewState {
  GivenScene given;
  Setup setup, initial;  ///< initial: what Reset goes back to (but for the size, which is the window's)
  Picture picture = Picture::raster;
  Picture previous = Picture::raytrace;
  std::uint64_t revision = 1;  ///< grows whenever the setup changes
  int max_map_size = 65536;    ///< texels; what keys may double the map to
  double texel_world =
      0.0;  ///< world width of a texel in the last map drawn; what a bias step is measured by

  std::string_view light_name() const { return given.lights[setup.light].name; }
};

// Actions. Angles are degrees.
struct Show {
  Picture picture;
};
struct ShowPrevious {};
struct OrbitBy {
  double azimuth, elevation;
};
struct OrbitTo {
  double azimuth, elevation;
};
struct ZoomBy {
  double factor;
};  ///< of the camera's distance
struct DistanceTo {
  double distance;
};
struct TurnLightBy {
  double azimuth, elevation;
};
struct LightAzimuthTo {
  double azimuth;
};
struct LightElevationTo {
  double elevation;
};
struct NextLight {};
struct PickLight {
  std::uint32_t light;
};
struct StepBias {
  double texels;
};
struct StepSlopeBias {
  double amount;
};
struct StepNormalOffset {
  double texels;
};
struct DoubleMap {};
struct HalveMap {};
struct NextDepthFormat {};
struct NextCull {};
struct SetMapOption {
  std::string name, value;
};  ///< as on the command line, without the dashes; checked (map_option.h)
struct Resize {
  ImageSize size;
};
struct Reset {};

using Change =
    std::variant<Show, ShowPrevious, OrbitBy, OrbitTo, ZoomBy, DistanceTo, TurnLightBy, LightAzimuthTo,
                 LightElevationTo, NextLight, PickLight, StepBias, StepSlopeBias, StepNormalOffset, DoubleMap,
                 HalveMap, NextDepthFormat, NextCull, SetMapOption, Resize, Reset>;

void carry_out(ViewState& state, const Change& change);

/// Keys zoom and turn within these bounds.
inline constexpr double max_zoom =
    1000.0;  ///< nearest and farthest: the file's own distance by and times this

}  // namespace gnomon::app

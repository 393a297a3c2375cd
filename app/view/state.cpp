#include "app/view/state.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <charconv>

#include "app/suggest.h"
#include "app/view/map_option.h"

namespace gnomon::app {

namespace {

constexpr std::array<std::string_view, picture_count> picture_names{"raster", "raytrace", "difference",
                                                                    "labels", "depth"};

CameraPose current_camera(const ViewState& s) {
  return s.setup.camera.value_or(camera_pose(s.given.camera));
}

LightPose current_light(const ViewState& s) {
  const std::uint32_t i = s.setup.light;
  return s.setup.lights[i].value_or(light_pose(s.given.lights[i], s.given.centre));
}

/// Steps and drags leave numbers that a person can read and type again: nine digits, finer than anything on
/// screen.
double tidy(double value) {
  const std::string text = fmt::format("{:.9g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

double clamped(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

void show(ViewState& s, Picture picture) {
  if (picture == s.picture) return;
  s.previous = s.picture;
  s.picture = picture;
}

/// The setup's changes; each is followed by a new revision.
struct SetupChange {
  ViewState& s;

  void turn_camera(double azimuth, double elevation) const {
    CameraPose pose = current_camera(s);
    pose.azimuth_degrees = wrapped_degrees(azimuth);
    pose.elevation_degrees = clamped(elevation, max_camera_elevation_degrees);
    s.setup.camera = pose;
  }
  void turn_light(double azimuth, double elevation) const {
    s.setup.lights[s.setup.light] =
        LightPose{wrapped_degrees(azimuth), clamped(elevation, max_light_elevation_degrees)};
  }
  void move_camera(double distance) const {
    CameraPose pose = current_camera(s);
    pose.distance = distance;
    s.setup.camera = pose;
  }

  void operator()(const OrbitBy& c) const {
    const CameraPose pose = current_camera(s);
    turn_camera(tidy(pose.azimuth_degrees + c.azimuth), tidy(pose.elevation_degrees + c.elevation));
  }
  void operator()(const OrbitTo& c) const { turn_camera(c.azimuth, c.elevation); }
  void operator()(const ZoomBy& c) const {
    const double own = camera_pose(s.given.camera).distance;
    move_camera(tidy(std::clamp(current_camera(s).distance * c.factor, own / max_zoom, own * max_zoom)));
  }
  void operator()(const DistanceTo& c) const { move_camera(c.distance); }
  void operator()(const TurnLightBy& c) const {
    const LightPose pose = current_light(s);
    turn_light(tidy(pose.azimuth_degrees + c.azimuth), tidy(pose.elevation_degrees + c.elevation));
  }
  void operator()(const LightAzimuthTo& c) const {
    turn_light(c.azimuth, current_light(s).elevation_degrees);
  }
  void operator()(const LightElevationTo& c) const {
    turn_light(current_light(s).azimuth_degrees, c.elevation);
  }
  void operator()(const NextLight&) const {
    s.setup.light = (s.setup.light + 1) % static_cast<std::uint32_t>(s.given.lights.size());
  }
  void operator()(const PickLight& c) const { s.setup.light = c.light; }

  /// Steps stop at zero on their way from either side: zero is what one is looking for there.
  void operator()(const StepBias& c) const {
    raster::Bias& bias = s.setup.map.bias;
    if (bias.unit == raster::BiasUnit::automatic)
      bias.constant *= raster::automatic_bias_texels, bias.unit = raster::BiasUnit::texel;
    const double unit = bias.unit == raster::BiasUnit::texel ? 1.0 : s.texel_world;
    const double next = tidy(bias.constant + c.texels * unit);
    bias.constant = next * bias.constant < 0.0 ? 0.0 : next;
  }
  void operator()(const StepSlopeBias& c) const {
    double& slope = s.setup.map.bias.slope;
    const double next = slope + c.amount;
    slope = next * slope < 0.0 ? 0.0 : next;
  }
  void operator()(const StepNormalOffset& c) const {
    double& offset = s.setup.map.bias.normal_offset_texels;
    offset = std::max(0.0, offset + c.texels);
  }
  void operator()(const DoubleMap&) const {
    s.setup.map.size =
        static_cast<int>(std::min<std::int64_t>(2 * std::int64_t{s.setup.map.size}, s.max_map_size));
  }
  void operator()(const HalveMap&) const { s.setup.map.size = std::max(1, s.setup.map.size / 2); }
  void operator()(const NextDepthFormat&) const {
    using enum raster::DepthFormat;
    raster::DepthFormat& format = s.setup.map.depth_format;
    format = format == d16 ? d24 : format == d24 ? d32f : d16;
  }
  void operator()(const NextCull&) const {
    raster::Cull& cull = s.setup.map.cull;
    cull = cull == raster::Cull::none    ? raster::Cull::front
           : cull == raster::Cull::front ? raster::Cull::back
                                         : raster::Cull::none;
  }
  void operator()(const SetMapOption& c) const {
    [[maybe_unused]] const Expected<void> set = set_map_option(s.setup.map, c.name, c.value);
    assert(set && "checked when it was read");
  }
  void operator()(const Resize& c) const { s.setup.size = c.size; }
  void operator()(const Reset&) const {
    const ImageSize size = s.setup.size;
    s.setup = s.initial;
    s.setup.size = size;
  }
};

}  // namespace

std::string_view picture_name(Picture picture) {
  return picture_names[static_cast<std::size_t>(picture)];
}

Expected<Picture> parse_picture(std::string_view name) {
  for (std::size_t i = 0; i < picture_count; ++i) {
    if (picture_names[i] == name) return static_cast<Picture>(i);
  }
  return fail(ErrorKind::usage,
              fmt::format("no such view (got {}, allowed {}){}", name, fmt::join(picture_names, ", "),
                          did_you_mean(name, picture_names)));
}

GivenScene given_scene(const Scene& scene, const World& world) {
  return {scene.camera, scene.lights, scene_centre(world)};
}

void place(const GivenScene& given, const Setup& setup, Scene& scene) {
  scene.camera = setup.camera ? posed_camera(given.camera, *setup.camera) : given.camera;
  scene.lights = given.lights;
  for (std::size_t i = 0; i < given.lights.size(); ++i) {
    if (setup.lights[i]) scene.lights[i] = posed_light(given.lights[i], given.centre, *setup.lights[i]);
  }
}

void carry_out(ViewState& state, const Change& change) {
  if (const auto* shown = std::get_if<Show>(&change)) return show(state, shown->picture);
  if (std::holds_alternative<ShowPrevious>(change)) return show(state, state.previous);
  std::visit(
      [&state](const auto& c) {
        if constexpr (std::is_invocable_v<SetupChange, decltype(c)>) SetupChange{state}(c);
      },
      change);
  ++state.revision;
}

}  // namespace gnomon::app

#include "lab/view/state/state.h"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "raster/settings.h"

namespace gnomon::lab {

namespace {

using app::CameraPose;
using app::LightPose;

/// Steps and drags leave numbers that a person can read and type again: nine digits, finer than anything on
/// screen.
double tidy(double value) {
  const std::string text = fmt::format("{:.9g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

Vec3 tidy(const Vec3& v) {
  return {tidy(v.x), tidy(v.y), tidy(v.z)};
}

CameraPose tidy(CameraPose pose) {
  for (double* number : {&pose.azimuth_degrees, &pose.elevation_degrees, &pose.distance})
    *number = tidy(*number);
  if (pose.target) pose.target = tidy(*pose.target);
  if (pose.up) pose.up = tidy(*pose.up);
  if (pose.height) pose.height = tidy(*pose.height);
  return pose;
}

LightPose tidy(LightPose pose) {
  for (double* number : {&pose.azimuth_degrees, &pose.elevation_degrees}) *number = tidy(*number);
  if (pose.distance) pose.distance = tidy(*pose.distance);
  return pose;
}

double clamped(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

/// The next of all values of a setting, and after the last one the first.
void go_to_next_choice(raster::MapOptions& map, std::string_view name) {
  const auto& choice = std::get<raster::ChoiceSetting>(raster::find_setting(name)->kind);
  choice.set(map, (choice.get(map) + 1) % choice.names().size());
}

/// The setup's changes; each is followed by a new revision.
struct SetupChange {
  ViewState& s;

  void turn_camera(double azimuth, double elevation) const {
    CameraPose pose = current_camera(s);
    pose.azimuth_degrees = app::wrapped_degrees(azimuth);
    pose.elevation_degrees = clamped(elevation, app::max_camera_elevation_degrees);
    s.setup.camera = pose;
  }
  void turn_light(double azimuth, double elevation) const {
    LightPose pose = current_light(s);
    pose.azimuth_degrees = app::wrapped_degrees(azimuth);
    pose.elevation_degrees = clamped(elevation, app::max_light_elevation_degrees);
    s.setup.lights[s.setup.light] = pose;
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
    if (posed_camera(s).orthographic()) return zoom_height(c.factor);
    const double own = app::camera_pose(s.given.camera).distance;
    move_camera(tidy(std::clamp(current_camera(s).distance * c.factor, own / max_zoom, own * max_zoom)));
  }
  /// Changes the height of an orthographic picture, which distance does not change.
  void zoom_height(double factor) const {
    const CameraPose first = s.initial.camera.value_or(app::camera_pose(s.given.camera));
    const double now = posed_camera(s).orthographic_height;
    const double own =
        first.height.value_or(s.given.camera.orthographic() ? s.given.camera.orthographic_height : now);
    (*this)(HeightTo{tidy(std::clamp(now * factor, own / max_zoom, own * max_zoom))});
  }
  void operator()(const DistanceTo& c) const { move_camera(c.distance); }
  void operator()(const HeightTo& c) const {
    CameraPose pose = current_camera(s);
    pose.height = c.height;
    s.setup.camera = pose;
  }
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
  void operator()(const NextDepthFormat&) const { go_to_next_choice(s.setup.map, "depth-format"); }
  void operator()(const NextCull&) const { go_to_next_choice(s.setup.map, "cull"); }
  void operator()(const SetMapOption& c) const {
    [[maybe_unused]] const Expected<void> set = raster::set_setting(c.name, s.setup.map, c.value);
    assert(set && "checked when it was read");
  }
  /// The pixel that is explained stays at its place in the picture.
  void operator()(const Resize& c) const {
    if (auto& probe = s.look.probe) {
      probe->x = static_cast<int>((probe->x + 0.5) * c.size.width / s.setup.size.width);
      probe->y = static_cast<int>((probe->y + 0.5) * c.size.height / s.setup.size.height);
    }
    s.setup.size = c.size;
  }
  void operator()(const Reset&) const {
    const ImageSize size = s.setup.size;
    s.setup = s.initial;
    s.setup.size = size;
    s.film = {};
  }
  void operator()(const SetMap& c) const { s.setup.map = c.map; }
  void operator()(const SetPrecision& c) const { s.setup.precision = c.precision; }
  void operator()(const FreezeMaps& c) const {
    std::optional<Camera>& frozen = s.setup.map_camera;
    const bool on = c.on.value_or(!frozen);
    if (on != frozen.has_value()) frozen = on ? std::optional(posed_camera(s)) : std::nullopt;
  }
  void operator()(const PanBy& c) const {
    const Camera camera = posed_camera(s);
    const Vec3 forward = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
    const double height = picture_height(camera, glm::length(camera.target - camera.eye));
    const Vec3 target = camera.target + height * (c.right * right + c.up * up);
    (*this)(TargetTo{{tidy(target.x), tidy(target.y), tidy(target.z)}});
  }
  void operator()(const TargetTo& c) const {
    CameraPose pose = current_camera(s);
    pose.target = c.target;
    s.setup.camera = pose;
  }
  void operator()(const LightDistanceTo& c) const {
    if (s.given.lights[s.setup.light].type == LightType::directional) return;
    LightPose pose = current_light(s);
    pose.distance = c.distance;
    s.setup.lights[s.setup.light] = pose;
  }
  void operator()(const LightSizeTo& c) const {
    const bool sun = s.given.lights[s.setup.light].type == LightType::directional;
    LightPose pose = current_light(s);
    pose.size = sun ? std::min(c.size, app::most_sun_degrees) : c.size;
    s.setup.lights[s.setup.light] = pose;
  }
  void operator()(const PlaceLamp& c) const {
    Light light = s.given.lights[s.setup.light];
    const double distance = glm::length(c.position - s.given.centre);
    if (light.type == LightType::directional || !(distance > 0.0)) return;
    light.position = c.position;
    const LightPose pose = app::light_pose(light, s.given.centre);
    s.setup.lights[s.setup.light] = LightPose{tidy(pose.azimuth_degrees), tidy(pose.elevation_degrees),
                                              tidy(distance), current_light(s).size};
  }
  void operator()(const PickFilm& c) const {
    s.film = {c.film, 0.0, s.film.plays && c.film};
    if (c.film) (*this)(FilmTo{0.0});
  }
  void operator()(const FilmTo& c) const {
    if (!s.film.film) return;
    const LabFilm& film = s.given.films[*s.film.film];
    s.film.seconds = std::clamp(c.seconds, 0.0, film.seconds);
    const FilmMoment moment =
        moment_of(film, {s.given.camera, s.given.lights}, s.given.centre, s.film.seconds);
    if (moment.camera) s.setup.camera = tidy(*moment.camera);
    for (std::size_t i = 0; i < moment.lights.size(); ++i) {
      if (!moment.lights[i]) continue;
      const std::optional<LightPose> before = s.setup.lights[i];
      s.setup.lights[i] = tidy(*moment.lights[i]);
      if (before) s.setup.lights[i]->size = before->size;
    }
  }
  void operator()(const FilmGoesOn& c) const {
    if (s.film.film)
      (*this)(FilmTo{std::fmod(s.film.seconds + c.seconds, s.given.films[*s.film.film].seconds)});
  }
  void operator()(const SunHour& c) const {
    if (s.given.lights[s.setup.light].type != LightType::directional) return;
    const LightPose pose = sun_at(c.hours);
    turn_light(tidy(pose.azimuth_degrees), tidy(pose.elevation_degrees));
  }
};

void keep_in_picture(Look& look) {
  const double margin = 0.5 / look.zoom;
  for (int i = 0; i < 2; ++i) look.middle[i] = std::clamp(look.middle[i], margin, 1.0 - margin);
}

/// The look's changes, which leave the revision as it is.
struct LookChange {
  ViewState& s;

  void operator()(const Show& c) const {
    if (c.picture == s.picture) return;
    s.previous = s.picture;
    s.picture = c.picture;
  }
  void operator()(const ShowPrevious&) const { (*this)(Show{s.previous}); }
  void operator()(const PlayFilm& c) const {
    s.film.plays = c.on && !s.given.films.empty();
    if (s.film.plays && !s.film.film) s.film.film = 0;
  }
  void operator()(const TogglePlay&) const { (*this)(PlayFilm{!s.film.plays}); }
  void operator()(const SetLayout& c) const { s.look.layout = c.layout; }
  void operator()(const NextLayout&) const {
    s.look.layout = static_cast<PaneLayout>((static_cast<int>(s.look.layout) + 1) % 3);
  }
  void operator()(const SetTheme& c) const { s.look.theme = c.theme; }
  void operator()(const NextTheme&) const {
    s.look.theme = s.look.theme == Theme::dark ? Theme::light : Theme::dark;
  }
  void operator()(const SetUiScale& c) const {
    s.look.ui_scale = std::clamp(c.scale, least_ui_scale, most_ui_scale);
  }
  void operator()(const ScaleUi& c) const { (*this)(SetUiScale{s.look.ui_scale * c.factor}); }
  void operator()(const SetFlag& c) const { s.look.*c.flag = c.on; }
  void operator()(const ToggleFlag& c) const { s.look.*c.flag = !(s.look.*c.flag); }
  void operator()(const SwipeTo& c) const { s.look.swipe = std::clamp(c.share, 0.0, 1.0); }
  void operator()(const SwipeBy& c) const { (*this)(SwipeTo{s.look.swipe + c.share}); }
  void operator()(const SetPane& c) const { s.look.quad[c.pane] = c.picture; }
  void operator()(const ZoomPicture& c) const {
    Look& look = s.look;
    const double zoom = std::clamp(look.zoom * c.factor, 1.0, max_picture_zoom);
    look.middle = c.about + (look.middle - c.about) * (look.zoom / zoom);  // the place stays where it is
    look.zoom = zoom;
    keep_in_picture(look);
  }
  void operator()(const ZoomPictureTo& c) const {
    s.look.zoom = std::clamp(c.zoom, 1.0, max_picture_zoom);
    keep_in_picture(s.look);
  }
  void operator()(const MovePicture& c) const {
    s.look.middle += Vec2{c.x, c.y};
    keep_in_picture(s.look);
  }
  void operator()(const StepPicture& c) const { (*this)(MovePicture{c.x / s.look.zoom, c.y / s.look.zoom}); }
  void operator()(const ProbePixel& c) const { s.look.probe = c.pixel; }
  void operator()(const MoveProbe& c) const {
    const ImageSize size = s.setup.size;
    std::optional<PixelPlace>& probe = s.look.probe;
    if (!probe) {
      probe = PixelPlace{size.width / 2, size.height / 2};
    } else {
      probe->x = std::clamp(probe->x + c.right, 0, size.width - 1);
      probe->y = std::clamp(probe->y + c.down, 0, size.height - 1);
    }
  }
};

}  // namespace

CameraPose current_camera(const ViewState& s) {
  return s.setup.camera.value_or(app::camera_pose(s.given.camera));
}

LightPose current_light(const ViewState& s) {
  const std::uint32_t i = s.setup.light;
  return s.setup.lights[i].value_or(app::light_pose(s.given.lights[i], s.given.centre));
}

Camera posed_camera(const ViewState& s) {
  return s.setup.camera ? app::posed_camera(s.given.camera, *s.setup.camera) : s.given.camera;
}

Light posed_light(const ViewState& s) {
  const std::uint32_t i = s.setup.light;
  return s.setup.lights[i] ? app::posed_light(s.given.lights[i], s.given.centre, *s.setup.lights[i])
                           : s.given.lights[i];
}

constexpr double latitude = pi / 4.0;

LightPose sun_at(double hours) {
  const double angle = (hours - 12.0) * pi / 12.0;  // of the earth since noon
  const double east = -std::sin(angle), south = std::cos(angle) * std::sin(latitude),
               up = std::cos(angle) * std::cos(latitude);
  LightPose pose;
  pose.azimuth_degrees = std::atan2(east, south) * 180.0 / pi;
  pose.elevation_degrees = std::asin(std::clamp(up, -1.0, 1.0)) * 180.0 / pi;
  return pose;
}

double sun_hour(const LightPose& pose) {
  const double azimuth = pose.azimuth_degrees * pi / 180.0;
  const double angle = std::atan2(-std::sin(azimuth) * std::sin(latitude), std::cos(azimuth));
  return 12.0 + angle * 12.0 / pi;
}

GivenScene given_scene(const Scene& scene, const World& world, const std::vector<KeyedPath>& paths) {
  const Vec3 centre = world.middle();
  return {scene.camera, scene.lights, centre, films_of({scene.camera, scene.lights}, centre, paths)};
}

void place(const GivenScene& given, const Setup& setup, Scene& scene) {
  scene.camera = setup.camera ? app::posed_camera(given.camera, *setup.camera) : given.camera;
  scene.lights = given.lights;
  for (std::size_t i = 0; i < given.lights.size(); ++i) {
    if (setup.lights[i]) scene.lights[i] = app::posed_light(given.lights[i], given.centre, *setup.lights[i]);
  }
}

void carry_out(ViewState& state, const Change& change) {
  std::visit(
      [&state](const auto& c) {
        if constexpr (std::is_invocable_v<LookChange, decltype(c)>) {
          LookChange{state}(c);
        } else {
          SetupChange{state}(c);
          ++state.revision;
        }
      },
      change);
}

}  // namespace gnomon::lab

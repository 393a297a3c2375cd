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
#include "lab/view/state/film.h"
#include "lab/view/state/look.h"
#include "raster/options.h"
#include "raytrace/tracer.h"
#include "scene/base/expected.h"
#include "scene/world.h"

namespace gnomon::lab {

/// The scene's own camera and lights, which poses refer to.
struct GivenScene {
  Camera camera;
  std::vector<Light> lights;
  Vec3 centre{0.0};  ///< what a lamp turns about
  std::vector<LabFilm> films{};
};
/// `paths`: the scene's own.
GivenScene given_scene(const Scene& scene, const World& world, const std::vector<KeyedPath>& paths);

/// Everything that the pictures depend on.
struct Setup {
  std::optional<app::CameraPose> camera;              ///< none: as the file has it, to the last bit
  std::vector<std::optional<app::LightPose>> lights;  ///< as the scene's
  std::uint32_t light = 0;                            ///< the one that is compared and turned
  std::optional<Camera> map_camera{};                 ///< what maps are laid for; none: the view's own camera
  raster::MapOptions map;
  raytrace::Precision precision = raytrace::Precision::robust;  ///< of the rays
  ImageSize size{1280, 720};                                    ///< pixels of the picture
};

/// Gives the scene the camera and the lights that the setup says.
void place(const GivenScene& given, const Setup& setup, Scene& scene);

/// The film that moves the camera or the lights, and where it stands.
struct FilmState {
  std::optional<std::size_t> film;  ///< of GivenScene::films; none: nothing is filmed
  double seconds = 0.0;
  bool plays = false;
};

struct ViewState {
  GivenScene given;
  Setup setup, initial;  ///< initial: what Reset goes back to (but for the size, which is the window's)
  FilmState film;
  Look look;
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
};  ///< of the camera's distance, or an orthographic picture's height
struct DistanceTo {
  double distance;
};
/// What the picture's height covers, through an orthographic camera.
struct HeightTo {
  double height;
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
};  ///< as on the command line, without the dashes; checked (raster/settings.h)
struct SetMap {
  raster::MapOptions map;
};  ///< all of them; checked (raster::check_map_options)
struct SetPrecision {
  raytrace::Precision precision;
};
/// Maps stay laid for the camera as it stands now, while it flies on; off: they follow it again.
struct FreezeMaps {
  std::optional<bool> on{};  ///< none: the other
};
struct Resize {
  ImageSize size;
};
struct Reset {};
/// Moves the camera's target across the view by shares of the picture's height.
struct PanBy {
  double right, up;
};
struct TargetTo {
  Vec3 target;
};
/// A lamp's, from the scene's centre. A sun has none.
struct LightDistanceTo {
  double distance;
};
struct PlaceLamp {
  Vec3 position;
};
struct LightSizeTo {
  double size;
};  ///< light_size()
/// Begins a film, or ends it where it stands.
struct PickFilm {
  std::optional<std::size_t> film;
};
struct FilmTo {
  double seconds;
};  ///< clamped to the film; without one nothing
/// It goes on by so much, and from its end to its beginning.
struct FilmGoesOn {
  double seconds;
};
/// Local solar time, from 0 to 24: the sun of an equinox at 45 degrees north; +z is south, +x is east. Lamps
/// stay.
struct SunHour {
  double hours;
};

// Of the look; these ask for no new pictures.
struct PlayFilm {
  bool on;
};  ///< the first one, where none is picked
struct TogglePlay {};
struct SetLayout {
  PaneLayout layout;
};
struct NextLayout {};
struct SetTheme {
  Theme theme;
};
struct SetUiScale {
  double scale;
};
struct ScaleUi {
  double factor;
};
/// panels, settings, results, help, large_type.
struct SetFlag {
  bool Look::*flag;
  bool on;
};
struct ToggleFlag {
  bool Look::*flag;
};
struct NextTheme {};
struct SwipeTo {
  double share;
};
struct SwipeBy {
  double share;
};
/// What a pane of the four shows.
struct SetPane {
  std::size_t pane;
  Picture picture;
};
/// Enlarges the pictures about a place of theirs (shares of their sides).
struct ZoomPicture {
  double factor;
  Vec2 about;
};
struct ZoomPictureTo {
  double zoom;
};
/// Moves what is in the middle (shares of the picture's sides).
struct MovePicture {
  double x, y;
};
/// Moves the picture by shares of what is seen of it.
struct StepPicture {
  double x, y;
};
struct ProbePixel {
  std::optional<PixelPlace> pixel;
};
/// To the pixel so many to the right and down; begins in the middle of the picture.
struct MoveProbe {
  int right, down;
};

using Change =
    std::variant<Show, ShowPrevious, OrbitBy, OrbitTo, ZoomBy, DistanceTo, HeightTo, TurnLightBy,
                 LightAzimuthTo, LightElevationTo, NextLight, PickLight, StepBias, StepSlopeBias,
                 StepNormalOffset, DoubleMap, HalveMap, NextDepthFormat, NextCull, SetMapOption, SetMap,
                 SetPrecision, FreezeMaps, Resize, Reset, PanBy, TargetTo, LightDistanceTo, PlaceLamp,
                 LightSizeTo, PickFilm, FilmTo, FilmGoesOn, SunHour, PlayFilm, TogglePlay, SetLayout,
                 NextLayout, SetTheme, NextTheme, SetUiScale, ScaleUi, SetFlag, ToggleFlag, SwipeTo, SwipeBy,
                 SetPane, ZoomPicture, ZoomPictureTo, MovePicture, StepPicture, ProbePixel, MoveProbe>;

void carry_out(ViewState& state, const Change& change);

/// The camera and the light that are compared, as they stand now.
Camera posed_camera(const ViewState& state);
Light posed_light(const ViewState& state);
app::LightPose current_light(const ViewState& state);
app::CameraPose current_camera(const ViewState& state);

/// Where SunHour puts the sun, and the hour at which it stands at this azimuth.
app::LightPose sun_at(double hours);
double sun_hour(const app::LightPose& pose);

/// Keys zoom and turn within these bounds.
inline constexpr double max_zoom =
    1000.0;  ///< nearest and farthest: the file's own distance by and times this

}  // namespace gnomon::lab

#include "lab/view/script/script.h"

#include <fmt/core.h>

#include <algorithm>

#include "app/options/pose_options.h"

namespace gnomon::lab {

namespace {

using Values = std::vector<std::string>;

constexpr OptionRange hour_range{0.0, 24.0};
constexpr OptionRange film_range{0.0, 1e6};
constexpr OptionRange share_range{0.0, 1.0};
constexpr OptionRange zoom_range{1.0, max_picture_zoom};
constexpr OptionRange scale_range{least_ui_scale, most_ui_scale};
constexpr int most_pixels = 65536;

/// Hands the error of `value` on, or the change made of it.
template <class Value, class Make>
Expected<Change> change_of(const Expected<Value>& value, const Make& make) {
  if (!value) return fail(value.error());
  return Change{make(*value)};
}

/// A key with one number.
template <class Kind, const OptionRange& range>
Expected<Change> number(const Values& values) {
  return change_of(parse_number(values[0], range), [](double v) { return Kind{v}; });
}

template <bool Look::*flag>
Expected<Change> on_or_off(const Values& values) {
  if (values[0] != "on" && values[0] != "off")
    return fail(ErrorKind::usage, fmt::format("neither (got {}, allowed on, off)", values[0]));
  return Change{SetFlag{flag, values[0] == "on"}};
}

Expected<Change> play(const Values& values) {
  if (values[0] != "on" && values[0] != "off")
    return fail(ErrorKind::usage, fmt::format("neither (got {}, allowed on, off)", values[0]));
  return Change{PlayFilm{values[0] == "on"}};
}

Expected<Change> freeze(const Values& values) {
  if (values[0] != "on" && values[0] != "off")
    return fail(ErrorKind::usage, fmt::format("neither (got {}, allowed on, off)", values[0]));
  return Change{FreezeMaps{values[0] == "on"}};
}

Expected<Change> orbit(const Values& values) {
  const Expected<double> azimuth = parse_number(values[0], app::azimuth_range);
  if (!azimuth) return fail(azimuth.error());
  return change_of(parse_number(values[1], app::camera_elevation_range), [&](double elevation) {
    return OrbitTo{*azimuth, elevation};
  });
}

Expected<Change> target(const Values& values) {
  Vec3 place{0.0};
  for (int i = 0; i < 3; ++i) {
    const Expected<double> value = parse_number(values[static_cast<std::size_t>(i)], app::coordinate_range);
    if (!value) return fail(value.error());
    place[i] = *value;
  }
  return Change{TargetTo{place}};
}

Expected<Change> probe(const Values& values) {
  const auto x = parse_integer(values[0], 0, most_pixels);
  if (!x) return fail(x.error());
  return change_of(parse_integer(values[1], 0, most_pixels), [&](std::int64_t y) {
    return ProbePixel{PixelPlace{static_cast<int>(*x), static_cast<int>(y)}};
  });
}

Expected<Change> pane(const Values& values) {
  const auto number = parse_integer(values[0], 1, 4);
  if (!number) return fail(number.error());
  return change_of(parse_picture(values[1]), [&](Picture picture) {
    return SetPane{static_cast<std::size_t>(*number - 1), picture};
  });
}

Expected<Change> precision(const Values& values) {
  for (const auto precision :
       {raytrace::Precision::fast, raytrace::Precision::robust, raytrace::Precision::exact})
    if (raytrace::precision_name(precision) == values[0]) return Change{SetPrecision{precision}};
  return fail(ErrorKind::usage,
              fmt::format("no such arithmetic (got {}, allowed fast, robust, exact)", values[0]));
}

constexpr ScriptKey keys[] = {
    {"view", 1, "set view NAME",
     [](const Values& v) { return change_of(parse_picture(v[0]), [](Picture p) { return Show{p}; }); }},
    {"size", 1, "set size WxH",
     [](const Values& v) { return change_of(app::parse_size(v[0]), [](ImageSize s) { return Resize{s}; }); }},
    {"light-azimuth", 1, "set light-azimuth DEG", number<LightAzimuthTo, app::azimuth_range>},
    {"light-elevation", 1, "set light-elevation DEG", number<LightElevationTo, app::light_elevation_range>},
    {"light-distance", 1, "set light-distance D", number<LightDistanceTo, app::distance_range>},
    {"light-size", 1, "set light-size S", number<LightSizeTo, app::size_range>},
    {"film-time", 1, "set film-time SECONDS", number<FilmTo, film_range>},
    {"film-play", 1, "set film-play on|off", play},
    {"freeze-maps", 1, "set freeze-maps on|off", freeze},
    {"time-of-day", 1, "set time-of-day HOURS", number<SunHour, hour_range>},
    {"camera-orbit", 2, "set camera-orbit AZIMUTH ELEVATION", orbit},
    {"camera-distance", 1, "set camera-distance D", number<DistanceTo, app::distance_range>},
    {"camera-height", 1, "set camera-height H", number<HeightTo, app::distance_range>},
    {"camera-target", 3, "set camera-target X Y Z", target},
    {"precision", 1, "set precision NAME", precision},
    {"layout", 1, "set layout NAME",
     [](const Values& v) {
       return change_of(parse_pane_layout(v[0]), [](PaneLayout l) { return SetLayout{l}; });
     }},
    {"pane", 2, "set pane N VIEW", pane},
    {"swipe", 1, "set swipe SHARE", number<SwipeTo, share_range>},
    {"zoom", 1, "set zoom FACTOR", number<ZoomPictureTo, zoom_range>},
    {"probe", 2, "set probe X Y", probe},
    {"theme", 1, "set theme NAME",
     [](const Values& v) { return change_of(parse_theme(v[0]), [](Theme t) { return SetTheme{t}; }); }},
    {"ui-scale", 1, "set ui-scale FACTOR", number<SetUiScale, scale_range>},
    {"panels", 1, "set panels on|off", on_or_off<&Look::panels>},
    {"settings", 1, "set settings on|off", on_or_off<&Look::settings>},
    {"results", 1, "set results on|off", on_or_off<&Look::results>},
    {"help", 1, "set help on|off", on_or_off<&Look::help>},
    {"large-type", 1, "set large-type on|off", on_or_off<&Look::large_type>},
};

}  // namespace

const ScriptKey* find_script_key(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(keys), std::end(keys), [&](const ScriptKey& key) { return key.name == name; });
  return found == std::end(keys) ? nullptr : found;
}

std::vector<std::string> script_key_names() {
  std::vector<std::string> names{"light", "film"};
  for (const ScriptKey& key : keys) names.emplace_back(key.name);
  return names;
}

}  // namespace gnomon::lab

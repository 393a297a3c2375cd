#include "app/view/script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "app/suggest.h"
#include "app/values.h"
#include "app/view/map_option.h"
#include "scene/files/read_file.h"

namespace gnomon::app {

namespace {

using Words = std::vector<std::string>;
using Step = decltype(ScriptStep::what);

constexpr NumberRange azimuth_range{-360.0, 360.0};
constexpr NumberRange camera_elevation_range{-max_camera_elevation_degrees, max_camera_elevation_degrees};
constexpr NumberRange light_elevation_range{-max_light_elevation_degrees, max_light_elevation_degrees};
constexpr NumberRange distance_range{0.0, 1e12, true};
constexpr std::int64_t max_wait_frames = 1'000'000;
constexpr std::array<std::string_view, 4> verbs{"set", "wait", "screenshot", "quit"};
constexpr std::array<std::string_view, 7> own_keys{
    "view", "size", "light", "light-azimuth", "light-elevation", "camera-orbit", "camera-distance"};

Words words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

tl::unexpected<Error> wrong(std::string reason) {
  return fail(ErrorKind::bad_input, std::move(reason));
}

Expected<void> expect_count(const Words& words, std::size_t count, std::string_view usage) {
  if (words.size() == count) return {};
  return wrong(fmt::format("wrong number of words (got {}, allowed {}: {})", words.size(), count, usage));
}

/// Hands the error of `value` on, or the change made of it.
template <class Value, class Make>
Expected<Change> change_of(const Expected<Value>& value, const Make& make) {
  if (!value) return fail(value.error());
  return Change{make(*value)};
}

Expected<Change> pick_light(const std::string& name, const std::vector<Light>& lights) {
  std::vector<std::string_view> names;
  for (const Light& light : lights) names.push_back(light.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return Change{PickLight{static_cast<std::uint32_t>(found - names.begin())}};
  return wrong(fmt::format("the scene has no such light (got {}, allowed {}){}", name, fmt::join(names, ", "),
                           did_you_mean(name, names)));
}

Expected<Change> orbit_to(const Words& words) {
  const Expected<double> azimuth = parse_number(words[2], azimuth_range);
  if (!azimuth) return fail(azimuth.error());
  return change_of(parse_number(words[3], camera_elevation_range), [&](double elevation) {
    return OrbitTo{*azimuth, elevation};
  });
}

Expected<Change> set_own(const Words& words, const std::vector<Light>& lights) {
  const std::string &key = words[1], &value = words[2];
  if (key == "view") return change_of(parse_picture(value), [](Picture p) { return Show{p}; });
  if (key == "size") return change_of(parse_size(value), [](ImageSize s) { return Resize{s}; });
  if (key == "light") return pick_light(value, lights);
  if (key == "camera-orbit") return orbit_to(words);
  if (key == "camera-distance")
    return change_of(parse_number(value, distance_range), [](double d) { return DistanceTo{d}; });
  if (key == "light-azimuth")
    return change_of(parse_number(value, azimuth_range), [](double a) { return LightAzimuthTo{a}; });
  return change_of(parse_number(value, light_elevation_range), [](double e) { return LightElevationTo{e}; });
}

Expected<Change> set_map(const std::string& key, const std::string& value) {
  raster::MapOptions scratch;
  if (const auto set = set_map_option(scratch, key, value); !set) return fail(set.error());
  return Change{SetMapOption{key, value}};
}

Expected<Change> unknown_key(const std::string& key) {
  std::vector<std::string> names(own_keys.begin(), own_keys.end());
  for (const std::string& name : map_option_names()) names.push_back(name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  return wrong(fmt::format("nothing to set by this name (got {}, allowed {}){}", key, fmt::join(names, ", "),
                           did_you_mean(key, known)));
}

Expected<Step> parse_set(const Words& words, const std::vector<Light>& lights) {
  if (words.size() < 2) return wrong("nothing to set (got set alone, allowed set KEY VALUE)");
  const std::string& key = words[1];
  const bool own = std::find(own_keys.begin(), own_keys.end(), key) != own_keys.end();
  if (!own && !is_map_option(key)) return fail(unknown_key(key).error());
  const bool orbit = key == "camera-orbit";
  const auto complete =
      expect_count(words, orbit ? 4 : 3, orbit ? "set camera-orbit AZIMUTH ELEVATION" : "set KEY VALUE");
  if (!complete) return fail(complete.error());
  const Expected<Change> change = own ? set_own(words, lights) : set_map(key, words[2]);
  if (change) return Step{*change};
  Error error = change.error();
  error.field = key;
  return fail(std::move(error));
}

Expected<Step> parse_wait(const Words& words) {
  if (const auto complete = expect_count(words, 2, "wait N, or wait done"); !complete)
    return fail(complete.error());
  if (words[1] == "done") return Step{WaitDone{}};
  const Expected<std::int64_t> frames = parse_integer(words[1], 1, max_wait_frames);
  if (!frames)
    return wrong(fmt::format("not a wait (got {}, allowed 1 to {}, or done)", words[1], max_wait_frames));
  return Step{WaitFrames{*frames}};
}

Expected<Step> parse_screenshot(const Words& words) {
  if (const auto complete = expect_count(words, 2, "screenshot FILE.png"); !complete)
    return fail(complete.error());
  if (lower_extension(words[1]) != ".png")
    return wrong(fmt::format("not a PNG file's name (got {}, allowed *.png)", words[1]));
  return Step{Screenshot{words[1]}};
}

Expected<Step> parse_step(const Words& words, const std::vector<Light>& lights) {
  const std::string& verb = words[0];
  if (verb == "set") return parse_set(words, lights);
  if (verb == "wait") return parse_wait(words);
  if (verb == "screenshot") return parse_screenshot(words);
  if (verb != "quit") {
    return wrong(fmt::format("no such step (got {}, allowed {}){}", verb, fmt::join(verbs, ", "),
                             did_you_mean(verb, verbs)));
  }
  if (const auto complete = expect_count(words, 1, "quit"); !complete) return fail(complete.error());
  return Step{Quit{}};
}

}  // namespace

Expected<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file,
                                               const std::vector<Light>& lights) {
  std::vector<ScriptStep> steps;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const Words words = words_of(line);
    if (words.empty()) continue;
    const Expected<Step> step = parse_step(words, lights);
    if (!step) {
      Error error = step.error();
      error.kind = ErrorKind::bad_input;
      error.file = file;
      error.line = number;
      return fail(std::move(error));
    }
    steps.push_back({number, *step});
  }
  return steps;
}

}  // namespace gnomon::app

#include "lab/view/script/script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "app/lesson_scene.h"
#include "app/options/map_options.h"
#include "app/options/values.h"
#include "scene/base/option_text.h"
#include "scene/files/read_file.h"
#include "scene/load.h"

namespace gnomon::lab {

namespace {

using Words = std::vector<std::string>;
using Step = decltype(ScriptStep::what);

constexpr std::int64_t max_wait_frames = 1'000'000;
constexpr OptionRange pixel_range{-1e6, 1e6};
constexpr std::array<std::string_view, 13> verbs{"set",        "key",   "open", "show", "drag",
                                                 "click",      "point", "drop", "wait", "screenshot",
                                                 "save-scene", "print", "quit"};
constexpr std::array<std::string_view, 4> preset_names{"acne", "peter-panning", "aliasing", "leak"};

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

Expected<Step> parse_light(const Words& words, const std::vector<Light>& lights) {
  if (const auto complete = expect_count(words, 3, "set light NAME"); !complete)
    return fail(complete.error());
  if (const auto known = light_of_name(words[2], lights); !known) return fail(known.error());
  return Step{PickByName{PickByName::Kind::light, words[2]}};
}

Expected<Change> set_map(const std::string& key, const std::string& value) {
  raster::MapOptions scratch;
  if (const auto set = raster::set_setting(key, scratch, value); !set) return fail(set.error());
  return Change{SetMapOption{key, value}};
}

Expected<Change> unknown_key(const std::string& key) {
  std::vector<std::string> names = script_key_names();
  for (const std::string& name : app::map_setting_names()) names.push_back(name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  return wrong(fmt::format("nothing to set by this name (got {}, allowed {}){}", key, fmt::join(names, ", "),
                           did_you_mean(key, known)));
}

Expected<Step> parse_set(const Words& words, const std::vector<Light>& lights) {
  if (words.size() < 2) return wrong("nothing to set (got set alone, allowed set KEY VALUE)");
  const std::string& key = words[1];
  if (key == "film") {
    if (const auto complete = expect_count(words, 3, "set film NAME|off"); !complete)
      return fail(complete.error());
    return Step{PickByName{PickByName::Kind::film, words[2]}};
  }
  if (key == "light") return parse_light(words, lights);
  const ScriptKey* own = find_script_key(key);
  if (own == nullptr && raster::find_setting(key) == nullptr) return fail(unknown_key(key).error());
  const std::size_t values = own != nullptr ? own->values : 1;
  const auto complete = expect_count(words, 2 + values, own != nullptr ? own->usage : "set KEY VALUE");
  if (!complete) return fail(complete.error());
  const Expected<Change> change =
      own != nullptr ? own->read(Words(words.begin() + 2, words.end())) : set_map(key, words[2]);
  if (change) return Step{*change};
  Error error = change.error();
  error.field = key;
  return fail(std::move(error));
}

Expected<Step> parse_show(const Words& words) {
  if (const auto complete = expect_count(words, 2, "show PRESET"); !complete) return fail(complete.error());
  const auto found = std::find(preset_names.begin(), preset_names.end(), words[1]);
  if (found != preset_names.end())
    return Step{UsePreset{static_cast<std::size_t>(found - preset_names.begin())}};
  return wrong(fmt::format("nothing to show by this name (got {}, allowed {}){}", words[1],
                           fmt::join(preset_names, ", "), did_you_mean(words[1], preset_names)));
}

Expected<Step> parse_key(const Words& words) {
  if (const auto complete = expect_count(words, 2, "key NAME"); !complete) return fail(complete.error());
  const std::optional<Key> key = key_of_name(words[1]);
  if (!key || !(action_for_key(*key) || is_panel_key(*key)))
    return wrong(fmt::format(
        "a key that does nothing (got {}, allowed those of docs/lab.md, such as F6, tab, ctrl+B)", words[1]));
  return Step{PressKey{*key}};
}

/// Reads a place from two words of a line.
Expected<Vec2> parse_place(const Words& words, std::size_t first) {
  const Expected<double> x = parse_number(words[first], pixel_range);
  const Expected<double> y = parse_number(words[first + 1], pixel_range);
  if (!x || !y) return fail(x ? y.error() : x.error());
  return Vec2{*x, *y};
}

Expected<Step> parse_light_drag(const Words& words) {
  if (const auto complete = expect_count(words, 4, "drag light X Y"); !complete)
    return fail(complete.error());
  const Expected<Vec2> to = parse_place(words, 2);
  if (!to) return fail(to.error());
  return Step{DragPointer{Vec2(0.0), *to, 0, true}};
}

Expected<Step> parse_point(const Words& words) {
  if (const auto complete = expect_count(words, 3, "point X Y"); !complete) return fail(complete.error());
  const Expected<Vec2> at = parse_place(words, 1);
  if (!at) return fail(at.error());
  return Step{PointAt{*at}};
}

Expected<Step> parse_drag(const Words& words) {
  if (words.size() > 1 && words[1] == "light") return parse_light_drag(words);
  const bool click = words[0] == "click";
  const std::size_t numbers = click ? 2 : 4;
  const bool has_button = !click && words.size() == 6;
  if (const auto complete = expect_count(words, (has_button ? 2 : 1) + numbers,
                                         click ? "click X Y" : "drag X Y X Y [left|right|middle]");
      !complete)
    return fail(complete.error());
  const Expected<Vec2> from = parse_place(words, 1), to = click ? from : parse_place(words, 3);
  if (!from || !to) return fail(from ? to.error() : from.error());
  DragPointer drag{*from, *to, 0, false};
  if (!has_button) return Step{drag};
  constexpr std::array<std::string_view, 3> buttons{"left", "right", "middle"};
  const auto found = std::find(buttons.begin(), buttons.end(), words.back());
  if (found == buttons.end())
    return wrong(fmt::format("no such button (got {}, allowed {})", words.back(), fmt::join(buttons, ", ")));
  drag.button = static_cast<int>(found - buttons.begin());
  return Step{drag};
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

Expected<std::string> parse_file(const Words& words, const std::string& extension) {
  const std::string usage = fmt::format("{} FILE{}", words[0], extension);
  if (const auto complete = expect_count(words, 2, usage); !complete) return fail(complete.error());
  if (lower_extension(words[1]) == extension) return words[1];
  return wrong(fmt::format("the file's name has another ending (got {}, allowed *{})", words[1], extension));
}

Expected<Step> parse_step(const Words& words, const std::vector<Light>& lights) {
  const std::string& verb = words[0];
  if (verb == "set") return parse_set(words, lights);
  if (verb == "show") return parse_show(words);
  if (verb == "key") return parse_key(words);
  if (verb == "drag" || verb == "click") return parse_drag(words);
  if (verb == "point") return parse_point(words);
  if (verb == "wait") return parse_wait(words);
  if (verb == "screenshot" || verb == "save-scene") {
    const auto path = parse_file(words, verb == "screenshot" ? ".png" : ".json");
    if (!path) return fail(path.error());
    return verb == "screenshot" ? Step{Screenshot{*path}} : Step{SaveScene{*path}};
  }
  if (std::find(verbs.begin(), verbs.end(), verb) == verbs.end())
    return wrong(fmt::format("no such step (got {}, allowed {}){}", verb, fmt::join(verbs, ", "),
                             did_you_mean(verb, verbs)));
  if (verb == "print" && words.size() == 2 && words[1] == "clipboard") return Step{PrintClipboard{}};
  const bool open = verb == "open" || verb == "drop";
  if (const auto complete = expect_count(words, open ? 2 : 1, open ? verb + " SCENE" : verb); !complete)
    return fail(complete.error());
  if (verb == "drop") return Step{DropFile{words[1]}};
  if (open) return Step{OpenScene{words[1]}};
  return verb == "print" ? Step{PrintCommand{}} : Step{Quit{}};
}

}  // namespace

std::span<const std::string_view> script_verbs() {
  return verbs;
}

Expected<std::uint32_t> light_of_name(const std::string& name, const std::vector<Light>& lights) {
  std::vector<std::string_view> names;
  for (const Light& light : lights) names.push_back(light.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::uint32_t>(found - names.begin());
  Error error{ErrorKind::bad_input, fmt::format("the scene has no such light (got {}, allowed {}){}", name,
                                                fmt::join(names, ", "), did_you_mean(name, names))};
  error.field = "light";
  return fail(std::move(error));
}

Expected<std::vector<ScriptStep>> parse_script(std::string_view text, const std::string& file,
                                               const std::vector<Light>& lights,
                                               std::vector<std::string>* opened) {
  std::vector<ScriptStep> steps;
  std::vector<Light> known = lights;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const Words words = words_of(line);
    if (words.empty()) continue;
    Expected<Step> step = parse_step(words, known);
    if (step && (std::holds_alternative<OpenScene>(*step) || std::holds_alternative<DropFile>(*step))) {
      // Its lights' names are needed from here on.
      const auto scene = load_scene(app::scene_of_lesson(words[1]), {.confine_paths = true, .files = opened});
      if (scene) known = scene->lights;
      if (!scene) step = fail(scene.error());
    }
    if (!step) {
      Error error = step.error();
      if (!error.file.empty()) error.reason = error.message();
      error.kind = ErrorKind::bad_input;
      error.file = file;
      error.line = number;
      return fail(std::move(error));
    }
    steps.push_back({number, *step});
  }
  return steps;
}

}  // namespace gnomon::lab

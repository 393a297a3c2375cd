#include "app/lessons/figures.h"

#include <embedded/lectures.h>
#include <fmt/core.h>

#include <sstream>

#include "app/console.h"
#include "app/lessons/flatland.h"
#include "scene/base/stages.h"

namespace gnomon::app::lessons {

namespace {

/// What of a mark is said to the comparison; `own`: to the figure alone.
Settings for_comparison(const LiveMark& mark, std::string_view own = {}) {
  Settings settings;
  for (const auto& setting : mark.settings)
    if (setting.first != "scene" && setting.first != own) settings.push_back(setting);
  return settings;
}

/// "acne-floor --map-size 64 --bias 0/": before the names of a comparison's parts.
std::string key_of(const LiveMark& mark, const Settings& settings) {
  std::string key = mark.setting("scene");
  for (const auto& [name, value] : settings) key += fmt::format(" --{} {}", name, value);
  return key + "/";
}

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

}  // namespace

std::string PageFigures::keep(const std::string& key, SmallComparison&& comparison, int light) {
  words_ = std::move(comparison.words);
  if (!comparisons_.contains(key)) comparisons_[key] = std::move(comparison.shared);
  for (compare::DataPart& part : comparison.parts) {
    part.name = part.name == "light-0" ? fmt::format("{}light-{}", key, light) : key + part.name;
    if (kept_.insert(part.name).second) parts_.push_back(std::move(part));
  }
  return key;
}

Expected<SmallComparison> PageFigures::compare(const LiveMark& mark, const Settings& settings) {
  return compare_small(mark.setting("scene"), settings, console_);
}

Expected<PageFigures::Json> PageFigures::bias(const LiveMark& mark) {
  const Settings settings = for_comparison(mark);
  auto made = compare(mark, settings);
  if (!made) return fail(made.error());
  Json json{{"light", made->light}};
  json["comparison"] = keep(key_of(mark, settings), std::move(*made), 0);
  return json;
}

Expected<PageFigures::Json> PageFigures::map_size(const LiveMark& mark) {
  const std::string key = key_of(mark, for_comparison(mark));
  Json json{{"comparison", key}, {"sizes", Json::array()}};
  for (const std::string& size : words_of(mark.setting("sizes"))) {
    Settings settings = for_comparison(mark, "sizes");
    settings.emplace_back("map-size", size);
    auto made = compare(mark, settings);
    if (!made) return fail(made.error());
    json["sizes"].push_back({{"size", std::stoi(size)},
                             {"wrong_fraction", made->wrong_fraction},
                             {"texel_world", made->texel_world}});
    keep(key, std::move(*made), static_cast<int>(json["sizes"].size()) - 1);
  }
  return json;
}

Expected<PageFigures::Json> PageFigures::two_passes(const LiveMark& mark) {
  Settings settings = for_comparison(mark);
  if (mark.setting("map-size").empty()) settings.emplace_back("map-size", "64");  // texels that can be seen
  auto made = compare(mark, settings);
  if (!made) return fail(made.error());
  return Json{{"comparison", keep(key_of(mark, settings), std::move(*made), 0)}};
}

Expected<void> PageFigures::add(const LiveMark& mark) {
  const TimedStage stage("figures");
  Expected<Json> made = Json(nullptr);
  if (mark.name == "bias") made = bias(mark);
  if (mark.name == "map-size") made = map_size(mark);
  if (mark.name == "flatland")
    made = flatland(mark.setting("show") == "penumbra" ? "disc" : mark.setting("scene"));
  if (mark.name == "structure") made = structure_cut(mark.setting("kind"), mark.setting("scene"));
  if (mark.name == "whitted" || mark.name == "two-ways") made = whitted_cut();
  if (mark.name == "intersection") made = intersection_checks(mark.setting("kind"));
  if (mark.name == "build") made = intersection_checks("discs");
  if (mark.name == "grid-curve") made = grid_curve(mark.setting("scene"));
  if (mark.name == "eye-ray") made = eye_ray_checks();
  if (mark.name == "cube-faces") made = lessons::flatland("ball");
  if (mark.name == "box-fit") made = Json::object();  // all of it is worked out in the page
  if (mark.name == "two-passes") made = two_passes(mark);
  if (!made) return fail(made.error());
  if (made->is_null())
    console_.note(fmt::format("no live figure of that name: {}; its picture stands", mark.name));
  Json settings = Json::object();
  for (const auto& [key, value] : mark.settings) settings[key] = value;
  figures_.push_back(made->is_null() ? Json(nullptr)
                                     : Json{{"name", mark.name}, {"settings", settings}, {"data", *made}});
  return {};
}

std::string PageFigures::data() const {
  Json json{{"kind", "lesson"}, {"figures", figures_}, {"labels", Json::array()}};
  json.update(words_);
  json["comparisons"] = comparisons_;
  if (!lab_.empty()) json["lab"] = lab_;
  // English has none: its words stand in the page's own script.
  if (const std::string_view words = embedded::lectures("figures.json"); !words.empty())
    json["figure_words"] = Json::parse(words);
  return json.dump();
}

}  // namespace gnomon::app::lessons

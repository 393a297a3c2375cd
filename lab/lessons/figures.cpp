#include "lab/lessons/figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "app/console.h"
#include "lab/lessons/flatland.h"
#include "lab/serve/setting_facts.h"
#include "scene/base/stages.h"

namespace gnomon::lab::lessons {

namespace {

using Json = nlohmann::ordered_json;

/// What of a mark is said to the comparison; `own`: to the figure alone. A map's window is that of the scene that "window-of" names: who
/// chooses another scene in the page has a map that is fitted to that.
Settings for_comparison(const LiveMark& mark, std::string_view own = {}) {
  const std::string window_of = mark.setting("window-of");
  const bool has_window = window_of == mark.setting("scene");
  Settings settings;
  for (const auto& setting : mark.settings) {
    const std::string& name = setting.first;
    const bool is_window = name.starts_with("window-");
    const bool is_left_out = name == "window-of" || (is_window && !window_of.empty() && !has_window);
    if (name != "scene" && name != own && !is_left_out) settings.push_back(setting);
  }
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

using Names = std::vector<std::string_view>;

/// Sunlit scenes in which something can go wrong; such of triangles alone, whose structures are walked; and such as grids are filled with.
const Names sunlit{"acne-floor", "floating-box", "thin-wall", "wires", "fence", "teapot", "courtyard"},
    meshes{"stadium", "teapot", "courtyard"}, filled{"field", "stadium", "teapot", "courtyard"};

Json choice_facts(std::string_view name, std::string_view title, std::string_view what,
                  const Names& choices) {
  return {{"name", name},   {"group", raster::group_title(raster::SettingGroup::map)},
          {"title", title}, {"control", "choice"},
          {"what", what},   {"choices", choices}};
}

}  // namespace

struct PageFigures::Row {
  std::string_view name;
  Expected<Json> (*make)(PageFigures& page, const LiveMark& mark);
  /// Of the map, and "sizes": what the figure can be computed with again. Where a constant bias is one, the slope is another: a
  /// bias that is asked for takes the place of the default's slope.
  Names settings{};
  Names scenes{};  ///< the same
};

std::span<const PageFigures::Row> PageFigures::rows() {
  using Page = PageFigures;
  using Mark = const LiveMark;
  static const std::array table{
      Row{"bias",
          [](Page& page, Mark& mark) { return page.bias(mark); },
          {"map-size", "slope-bias", "normal-offset", "depth-format", "cull"},
          sunlit},
      Row{"map-size",
          [](Page& page, Mark& mark) { return page.map_size(mark); },
          {"sizes", "technique", "bias", "slope-bias", "filter-kernel", "filter-radius"},
          sunlit},
      Row{"two-passes",
          [](Page& page, Mark& mark) { return page.two_passes(mark); },
          {"map-size", "bias", "slope-bias", "cull"},
          sunlit},
      Row{"structure",
          [](Page&, Mark& mark) { return structure_cut(mark.setting("kind"), mark.setting("scene")); },
          {},
          meshes},
      Row{"grid-curve", [](Page&, Mark& mark) { return grid_curve(mark.setting("scene")); }, {}, filled},
      Row{"flatland",
          [](Page&, Mark& mark) {
            return lessons::flatland(mark.setting("show") == "penumbra" ? "disc" : mark.setting("scene"));
          }},
      Row{"cube-faces", [](Page&, Mark&) { return lessons::flatland("ball"); }},
      Row{"whitted", [](Page&, Mark&) { return whitted_cut(); }},
      Row{"two-ways", [](Page&, Mark&) { return whitted_cut(); }},
      Row{"intersection", [](Page&, Mark& mark) { return intersection_checks(mark.setting("kind")); }},
      Row{"build", [](Page&, Mark&) { return intersection_checks("discs"); }},
      Row{"eye-ray", [](Page&, Mark&) -> Expected<Json> { return eye_ray_checks(); }},
      // All of it is worked out in the page.
      Row{"box-fit", [](Page&, Mark&) -> Expected<Json> { return Json::object(); }}};
  return table;
}

std::string PageFigures::keep(const std::string& key, SmallComparison&& comparison, int light) {
  words_ = std::move(comparison.words);
  drawn_ = std::move(comparison.drawn);
  if (!comparisons_.contains(key)) comparisons_[key] = std::move(comparison.shared);
  for (report::DataPart& part : comparison.parts) {
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
  Settings settings = for_comparison(mark, "passes");  // how far they have come at first
  if (mark.setting("map-size").empty()) settings.emplace_back("map-size", "64");  // texels that can be seen
  auto made = compare(mark, settings);
  if (!made) return fail(made.error());
  return Json{{"comparison", keep(key_of(mark, settings), std::move(*made), 0)}};
}

PageFigures::Json PageFigures::controls_of(const Row& row) {
  Json controls = Json::array();
  if (!row.scenes.empty())
    controls.push_back(choice_facts("scene", "Scene", "The built-in scene that is looked at.", row.scenes));
  for (const std::string_view name : row.settings) {
    const raster::MapSetting* setting = raster::find_setting(name);
    controls.push_back(
        setting != nullptr
            ? setting_facts(*setting)
            : choice_facts(name, "Map sizes", "Texels along one side of each map.",
                           {"16,32,64,128", "64,128,256,512", "128,256,512,1024", "256,512,1024,2048"}));
  }
  return controls;
}

Expected<void> PageFigures::add(const LiveMark& mark) {
  const TimedStage stage("figures");
  const auto table = rows();
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const Row& one) { return one.name == mark.name; });
  if (row == table.end()) {
    console_.note(fmt::format("no live figure of that name: {}; its picture stands", mark.name));
    figures_.emplace_back(nullptr);
    return {};
  }
  drawn_ = {{"values", Json::object()}};
  auto made = row->make(*this, mark);
  if (!made) return fail(made.error());
  Json figure{{"name", mark.name}, {"settings", Json::object()}, {"data", std::move(*made)}};
  for (const auto& [key, value] : mark.settings) {
    figure["settings"][key] = value;
    drawn_["values"].emplace(key, value);
  }
  if (Json controls = controls_of(*row); !lab_.empty() && !controls.empty()) {
    figure["controls"] = std::move(controls);
    figure["drawn"] = std::move(drawn_);
  }
  figures_.push_back(std::move(figure));
  return {};
}

PageFigures::Json PageFigures::data() const {
  Json json{{"kind", "lesson"}, {"figures", figures_}, {"labels", Json::array()}};
  json.update(words_);
  json["comparisons"] = comparisons_;
  if (!lab_.empty()) json["lab"] = lab_;
  return json;
}

Expected<std::string> compute_figure(const LiveMark& mark, app::Console& console) {
  PageFigures page(console, "lab.html");
  if (const auto added = page.add(mark); !added) return fail(added.error());
  nlohmann::ordered_json json = page.data();
  json["parts"] = nlohmann::ordered_json::object();
  for (const report::DataPart& part : page.parts())
    json["parts"][part.name] = nlohmann::ordered_json::parse(part.json);
  return json.dump();
}

}  // namespace gnomon::lab::lessons

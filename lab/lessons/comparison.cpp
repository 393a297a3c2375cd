#include "lab/lessons/comparison.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/lesson_scene.h"
#include "app/options/map_options.h"
#include "app/options/options.h"
#include "app/options/setting_options.h"
#include "app/session.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/result_parts.h"
#include "lab/serve/setting_facts.h"
#include "report/pixels/page_data.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::lab::lessons {

namespace {

using app::Console;

using Json = nlohmann::ordered_json;

constexpr ImageSize picture_size{480, 270};  // pixels: one for all, as the page's script has one
constexpr ImageSize card_size{320, 180};     // of a picture alone

struct Words {
  app::SceneArgument scene;
  app::SettingOptions setting;
};

/// Reads the settings as the command line of `gnomon compare` does, a lesson's and a scene's own among them.
Expected<void> read_settings(const std::string& scene, const Settings& settings, ImageSize size,
                             Words& words) {
  CLI::App app("", "compare");
  app::add_scene(app, words.scene);
  app::add_setting_options(app, words.setting);
  std::vector<std::string> line{scene};
  for (const auto& [key, value] : settings) line.push_back(fmt::format("--{}={}", key, value));
  std::reverse(line.begin(), line.end());  // CLI11 takes the last one first
  try {
    app.parse(std::move(line));
    app::add_lesson_settings(app);
    if (const auto added = app::add_scene_settings(app); !added) return fail(added.error());
    app::finish_map_options(app, words.setting.options.raster.map);
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::internal, fmt::format("a live figure of {}: {}", scene, error.what()));
  }
  raster::RasterOptions& raster = words.setting.options.raster;
  raster.size = words.setting.options.raytrace.size = size;
  raster.runs = words.setting.options.raytrace.runs = 1;
  words.setting.options.perceptual = false;
  return {};
}

Expected<compare::Comparison> compared(const Words& words, const app::LoadedScene& loaded, Console& console) {
  const auto lights = app::choose_lights(*loaded.scene, words.setting.light);
  if (!lights) return fail(lights.error());
  auto renderer = app::make_renderer(raster::Backend::automatic, loaded, console);
  if (!renderer) return fail(renderer.error());
  const std::vector<std::uint32_t> first{lights->front()};
  return compare::compare_world(*loaded.world, **renderer, first, words.setting.options);
}

struct Compared {
  app::LoadedScene loaded;  ///< which the comparison points to
  compare::Comparison comparison;
  raster::MapOptions asked;
};

Expected<Compared> load_and_compare(const std::string& scene, const Settings& settings, ImageSize size,
                                    Console& console) {
  Words words;
  if (const auto read = read_settings(scene, settings, size, words); !read) return fail(read.error());
  app::RunFiles files;
  auto loaded = app::load(words.scene, files, console);
  if (!loaded) return fail(loaded.error());
  const auto posed = app::apply_poses(words.setting.poses, words.setting.light, *loaded);
  if (!posed) return fail(posed.error());
  auto comparison = compared(words, *loaded, console);
  if (!comparison) return fail(comparison.error());
  return Compared{std::move(*loaded), std::move(*comparison), words.setting.options.raster.map};
}

Json part_of(const Json& head, std::initializer_list<const char*> keys) {
  Json part = Json::object();
  for (const char* key : keys) part[key] = head.at(key);
  return part;
}

/// What the chart of every bias shows (page/src/bias_chart.ts).
Json curve_of(const Json& light) {
  Json part = part_of(light, {"pixels", "error", "best_bias", "bias_curve"});
  part["map"] = {{"bias", light.at("map").at("bias")}};
  return part;
}

}  // namespace

Expected<std::string> labels_png(const std::string& scene, Console& console) {
  const auto made = load_and_compare(scene, {}, card_size, console);
  if (!made) return fail(made.error());
  return encode_png(compare::label_picture(made->comparison.lights.front()));
}

Expected<SmallComparison> compare_small(const std::string& scene, const Settings& settings,
                                        Console& console) {
  const auto made = load_and_compare(scene, settings, picture_size, console);
  if (!made) return fail(made.error());
  const compare::Comparison& comparison = made->comparison;
  const compare::LightComparison& light = comparison.lights.front();
  const compare::PictureSet none;
  report::PageData data = report::page_data({comparison, none, {}, {}});
  const Json head = Json::parse(data.head);
  SmallComparison out;
  out.words = part_of(head, {"labels", "rungs", "width", "height", "position_steps", "visibility_steps",
                             "colour_steps", "darkest_octave"});
  out.shared = part_of(head, {"exposure", "rays", "materials"});
  out.parts = std::move(data.parts);
  out.light = curve_of(compare::light_block(comparison, light));
  out.drawn = {{"values", setting_values(made->asked)},
               {"bias_world", compare::drawn_record(comparison, light).bias_constant_world},
               {"texel_world", light.bias_texel_world}};
  out.wrong_fraction = light.error.wrong_fraction;
  out.texel_world = light.texel_world[1];
  return out;
}

}  // namespace gnomon::lab::lessons

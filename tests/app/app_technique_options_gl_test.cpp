// Every technique with every option of the shadow map: what it reads changes the drawing, what it does not
// read changes no bit of it, and the command line refuses exactly that.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "app/command_line.h"
#include "app/options/effect_options.h"
#include "app/options/map_options.h"
#include "app/options/options.h"
#include "rays/visibility.h"
#include "studies/commands/axes.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

using Words = std::vector<std::string>;

std::vector<std::pair<raster::Technique, std::string>> techniques() {
  std::vector<std::pair<raster::Technique, std::string>> all;
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits())
    all.emplace_back(traits.technique, traits.name);
  return all;
}

struct Choice {
  const char* option;
  const char* value;           ///< unlike the default; of a flag: on
  const char* kernel = "box";  ///< of pcf
};
// filter-samples once for each kernel of pcf that it must and must not concern.
constexpr Choice choices[] = {{"window-size", "9,8"},
                              {"window-origin", "0.3,4,0.2"},
                              {"window-depths", "0.5,9"},
                              {"bias", "3texel"},
                              {"slope-bias", "2"},
                              {"normal-offset", "3"},
                              {"receiver-plane", "on"},
                              {"adaptive-bias", "on"},
                              {"caster-bias", "2texel"},
                              {"caster-slope-bias", "2"},
                              {"depth-format", "d16"},
                              {"cull", "front"},
                              {"filter-kernel", "vogel"},
                              {"filter-radius", "3"},
                              {"filter-radius", "3", "hardware"},
                              {"filter-radius", "3", "optimised"},
                              {"filter-plane", "off"},
                              {"filter-samples", "5"},
                              {"filter-samples", "5", "vogel"},
                              {"blocker-samples", "3"},
                              {"search-radius", "0.5"},
                              {"blur-radius", "5"},
                              {"mipmaps", "off"},
                              {"bleeding-reduction", "0.6"},
                              {"esm-exponent", "20"},
                              {"evsm-exponent", "10"},
                              {"evsm-negative-exponent", "30"},
                              {"moment-bias", "0.01"},
                              {"cascades", "2"},
                              {"cascade-lambda", "0.9"},
                              {"cascade-splits", "2,3,5,9"},
                              {"no-snap", "on"},
                              {"cascade-fit", "on"},
                              {"cascade-blend", "0.3"},
                              {"snap", "on"},
                              {"rays", "4"},
                              {"ray-sampler", "random"},
                              {"denoiser", "none"},
                              {"history", "3"}};

TEST(TechniqueOptions, EverySettingIsTried) {
  std::set<std::string_view> tried{"map-size", "technique"};  // which concern every technique
  for (const Choice& choice : choices) tried.insert(choice.option);
  for (const raster::MapSetting& setting : raster::map_settings())
    EXPECT_TRUE(tried.contains(setting.name)) << setting.name;
}

/// Holds for each pixel what the light leaves and, where the technique tests it, the gap (a finer witness of what is
/// stored). Or it says why nothing was drawn.
class Drawings {
 public:
  explicit Drawings(LightType type) : drawn_(make_drawn(scene(type))) {
    drawn_.renderer->use_external_visibility(raster::Technique::rays, rays::make_visibility(*drawn_.world));
  }

  Expected<std::vector<float>> draw(const raster::MapOptions& map) {
    raster::RasterOptions options = small_options();
    options.size = {240, 160};
    options.map = map;
    const std::vector<std::uint32_t> lights{0};
    auto frame = drawn_.renderer->render(options, lights);
    if (!frame) return fail(frame.error());
    const raster::LightRecord& light = frame->lights[0];
    std::vector<float> seen = light.visibility.data;
    if (map.technique != raster::Technique::izb && !raster::samples_rays(map.technique))
      seen.insert(seen.end(), light.gap.data.begin(), light.gap.data.end());
    return seen;
  }

 private:
  /// A light with a size, for pcss.
  static Scene scene(LightType type) {
    Scene scene = still_life();
    if (type == LightType::directional) {
      scene.lights = {sun({0.6, -1.0, 0.35})};
      scene.lights[0].extent = SunDisc{0.3};
    } else {
      scene.lights = {lamp(type, {1.5, 3.0, 2.0}, {0.0, 0.0, 0.0})};
    }
    return scene;
  }
  Drawn drawn_;
};

/// The options that tell most of what is tried: bias 0 shows every change of a depth, a coarse map each
/// texel.
raster::MapOptions base_options(raster::Technique technique, const std::string& kernel) {
  raster::MapOptions map;
  map.technique = technique;
  map.size = 128;
  map.bias = {0.0, raster::BiasUnit::texel};
  EXPECT_TRUE(raster::set_setting("filter-kernel", map, kernel).has_value());
  return map;
}

void expect_as_the_table_says(Drawings& drawings, const std::string& name, raster::Technique technique) {
  std::map<std::string, Expected<std::vector<float>>> before_by_kernel;
  for (const Choice& choice : choices) {
    const bool pcf = technique == raster::Technique::pcf;
    if (!pcf && choice.kernel != std::string("box")) continue;
    const raster::MapOptions plain = base_options(technique, choice.kernel);
    raster::MapOptions changed = plain;
    ASSERT_TRUE(raster::set_setting(choice.option, changed, choice.value).has_value()) << choice.option;
    const bool reads = raster::reads_setting(plain, choice.option);
    // Read or not, a clash is refused where the frame is drawn; the table has it under "not read".
    if (!raster::check_map_options(changed)) {
      EXPECT_FALSE(reads) << name << " --" << choice.option;
      continue;
    }
    auto before = before_by_kernel.find(choice.kernel);
    if (before == before_by_kernel.end())
      before = before_by_kernel.emplace(choice.kernel, drawings.draw(plain)).first;
    const auto after = drawings.draw(changed);
    ASSERT_TRUE(before->second.has_value() && after.has_value()) << name;
    EXPECT_EQ(*before->second != *after, reads) << name << " --" << choice.option << " " << choice.value;
  }
}

TEST(TechniqueOptions, WhatATechniqueReadsChangesTheDrawingAndNothingElseDoes) {
  Drawings under_sun(LightType::directional), under_lamp(LightType::point);
  for (const auto& [technique, name] : techniques()) {
    if (technique == raster::Technique::hybrid) continue;  // it has no shader of its own: hybrid/
    Drawings& drawings = raster::has_map_for(technique, LightType::directional) ? under_sun : under_lamp;
    expect_as_the_table_says(drawings, std::string(name), technique);
  }
}

struct Outcome {
  int code = 0;
  std::string error;
};

Outcome run(const Words& words) {
  std::vector<const char*> argv{"gnomon"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  testing::internal::CaptureStderr();
  const int code = app::run_command_line(static_cast<int>(argv.size()), argv.data());
  return {code, testing::internal::GetCapturedStderr()};
}

Words option_words(const Choice& choice) {
  const std::string name = "--" + std::string(choice.option), value = choice.value;
  const bool flag = value == "on";
  return flag ? Words{name} : Words{name + "=" + value};
}

// The scene does not exist, which is found out after the options: exit 3 says that these were accepted.
TEST(TechniqueOptions, TheCommandLineRefusesWhatIsNotRead) {
  for (const char* command : {"raster", "compare", "view"})
    for (const auto& [technique, name] : techniques())
      for (const Choice& choice : choices) {
        Words words{command, "no-such-scene.json", "--technique", std::string(name)};
        for (const std::string& word : option_words(choice)) words.push_back(word);
        const bool kernel = technique == raster::Technique::pcf && choice.kernel != std::string("box");
        if (kernel) words.insert(words.end(), {"--filter-kernel", choice.kernel});
        raster::MapOptions map = base_options(technique, kernel ? choice.kernel : "box");
        ASSERT_TRUE(raster::set_setting(choice.option, map, choice.value).has_value());
        const Outcome outcome = run(words);
        const bool reads = raster::reads_setting(map, choice.option);
        EXPECT_EQ(outcome.code, reads ? 3 : 2) << command << " " << name << " " << choice.option;
        if (reads) continue;
        const std::string text = "--" + std::string(choice.option) + ": belongs to ";
        EXPECT_NE(outcome.error.find(text), std::string::npos) << outcome.error;
        EXPECT_NE(outcome.error.find("; --technique is " + std::string(name)), std::string::npos)
            << outcome.error;
        EXPECT_NE(outcome.error.find("; did you mean --"), std::string::npos) << outcome.error;
      }
}

TEST(TechniqueOptions, ASweepTakesWhatOneOfItsTechniquesReads) {
  const Words sweep{"sweep", "no-such-scene.json"};
  const auto with = [&](Words more) {
    more.insert(more.begin(), sweep.begin(), sweep.end());
    return run(more);
  };
  EXPECT_EQ(with({"--technique", "hard,pcf", "--filter-radius", "1,2"}).code, 3);
  EXPECT_EQ(with({"--technique", "hard,pcf", "--filter-radius", "1"}).code, 3);
  EXPECT_EQ(with({"--technique", "pcf", "--filter-kernel", "box,vogel", "--filter-samples", "4"}).code, 3);
  EXPECT_EQ(with({"--filter-radius", "1,2"}).code, 2);
  EXPECT_EQ(with({"--technique", "hard,izb", "--filter-radius", "1"}).code, 2);
  const Outcome wrong =
      with({"--technique", "pcf", "--filter-kernel", "box,hardware", "--filter-samples", "4"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(
      wrong.error.find("belongs to pcf (vogel), pcss; --technique is pcf with --filter-kernel box, hardware"),
      std::string::npos)
      << wrong.error;
  EXPECT_EQ(
      run({"tune", "no-such-scene.json", "--max-error", "1%", "--technique", "hard", "--cascades", "2"}).code,
      2);
  EXPECT_EQ(run({"tune", "no-such-scene.json", "--max-error", "1%", "--cascades", "2"}).code, 3);
}

TEST(TechniqueOptions, ACellNamesOnlyWhatItsTechniqueReads) {
  const std::vector<std::pair<std::string, std::string>> values{
      {"technique", "izb"}, {"filter-radius", "2"}, {"bias", "0"}, {"map-size", "64"}};
  EXPECT_EQ(app::setting_arguments(app::values_read(values)), " --technique izb --map-size 64");
}

// --snap is there or not; --mipmaps takes the word, without which it has its default.
TEST(TechniqueOptions, SwitchesAndOnesThatTakeAWordAreToldApart) {
  const std::vector<std::pair<std::string, std::string>> off{
      {"technique", "vsm"}, {"mipmaps", "off"}, {"snap", "off"}, {"filter-plane", "off"}};
  EXPECT_EQ(app::setting_arguments(off), " --technique vsm --mipmaps off --snap=false --filter-plane off");
  const std::vector<std::pair<std::string, std::string>> on{
      {"technique", "vsm"}, {"mipmaps", "on"}, {"snap", "on"}, {"filter-plane", "on"}};
  EXPECT_EQ(app::setting_arguments(on), " --technique vsm --mipmaps on --snap --filter-plane on");
}

TEST(TechniqueOptions, ABiasThatIsAskedForReplacesTheDefaultsSlope) {
  using Values = std::vector<std::pair<std::string, std::string>>;
  using enum raster::BiasUnit;
  const auto bias = [](const Values& values) {
    const auto parsed = app::parse_setting(values);
    EXPECT_TRUE(parsed.has_value());
    return parsed ? parsed->options.raster.map.bias : raster::Bias{-1.0};
  };
  const raster::Bias by_default{.slope = 1.0}, constant{1.0, texel};
  EXPECT_EQ(bias({}), by_default);
  EXPECT_EQ(bias({{"bias", "auto"}}), raster::Bias{});
  EXPECT_EQ(bias({{"technique", "csm"}}), by_default);
  EXPECT_EQ(bias({{"technique", "pcf"}}), raster::Bias{}) << "compares with the receiver's plane";
  EXPECT_EQ(bias({{"technique", "pcf"}, {"filter-plane", "off"}}), by_default);
  EXPECT_EQ(bias({{"technique", "csm"}, {"bias", "1texel"}}), constant);
  EXPECT_EQ(bias({{"slope-bias", "2"}}), (raster::Bias{.slope = 2.0}));
  EXPECT_EQ(bias({{"normal-offset", "1"}}), (raster::Bias{.normal_offset_texels = 1.0}));
  EXPECT_EQ(bias({{"receiver-plane", "on"}}), (raster::Bias{.receiver_plane = true}));
  EXPECT_EQ(bias({{"cull", "front"}}), by_default);
}

// The scene's matter, not the command line's: said in a note.
TEST(EffectOptions, WhatTheSceneDoesNotCallForIsNamed) {
  Scene scene = still_life();
  scene.lights = {sun({0.6, -1.0, 0.35})};
  const Words given{"samples", "glossy-samples", "min-contribution", "size"};
  const EffectPlan hard = plan_effects(scene);
  const Words notes = app::options_without_effect(given, hard);
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_EQ(notes[0], "--samples has no effect: no light has a size");
  scene.lights[0].extent = SunDisc{0.1};
  scene.materials[2].mirror = 0.5f;
  scene.materials[2].roughness = 0.2f;
  EXPECT_EQ(app::options_without_effect(given, plan_effects(scene)), Words{});
  raster::MapOptions map;
  map.technique = raster::Technique::pcss;
  const std::vector<std::uint32_t> lights{0};
  EXPECT_EQ(app::options_without_effect(Words{"search-radius"}, map, scene, lights), Words{});
  scene.lights[0].extent = {};
  EXPECT_EQ(app::options_without_effect(Words{"search-radius"}, map, scene, lights).size(), 1u);
  map.technique = raster::Technique::csm, map.cascades.count = 1, map.snap = true;
  const Words of_map{"cascade-lambda", "snap"};
  EXPECT_EQ(app::options_without_effect(of_map, map, scene, lights),
            Words{"--cascade-lambda has no effect: there is one cascade"});
  map.cascades.count = 2, scene.lights[0].type = LightType::point;
  EXPECT_EQ(app::options_without_effect(of_map, map, scene, lights),
            Words{"--snap has no effect: no light is directional"});
  EXPECT_EQ(app::page_options_without_effect(Words{"report-max-mb", "size"}),
            Words{"--report-max-mb has no effect: no page is written"});
  EXPECT_EQ(app::page_options_without_effect(Words{"size"}), Words{});
  EXPECT_EQ(app::heatmap_options_without_effect(Words{"size", "aa"}),
            Words{"--aa has no effect: a heat map shows the work of one ray through each pixel's centre"});
}

}  // namespace
}  // namespace gnomon::test

// The title and the command line in words.
#include "lab/view/state/status.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "raster/settings.h"
#include "tests/view/view_fixture.h"

namespace gnomon::lab {
namespace {

TEST(ViewStatus, CommandSaysWhatDiffers) {
  LabOptions options;
  options.scene.name = "my scene.json";
  ViewState state = two_light_state();
  EXPECT_EQ(compare_command(state, options, options.scene),
            "gnomon compare 'my scene.json' --size 1280x720 --map-size 1024 --bias auto --slope-bias 1 "
            "--light sun");
  carry_out(state, OrbitTo{-30.0, 20.5});
  carry_out(state, PickLight{1});
  carry_out(state, LightAzimuthTo{45.0});
  carry_out(state, SetMapOption{"bias", "-0.25"});
  carry_out(state, SetMapOption{"slope-bias", "2"});
  carry_out(state, NextCull{});
  options.exposure = std::optional<double>(1.5);
  EXPECT_EQ(compare_command(state, options, options.scene),
            "gnomon compare 'my scene.json' --size 1280x720 --map-size 1024 --bias=-0.25 --slope-bias 2 "
            "--cull front "
            "--light lamp --camera-orbit=-30,20.5 --camera-distance 5 --light-azimuth 45 --light-elevation 0 "
            "--exposure 1.5");
}

// Camera and light as they are shown, in the picture's shape, and nothing of the map.
TEST(ViewStatus, TheTunerIsAskedForThePictureShown) {
  LabOptions options;
  options.max_lights = 7;
  ViewState state = two_light_state();
  carry_out(state, OrbitTo{-30.0, 20.5});
  carry_out(state, LightAzimuthTo{45.0});
  carry_out(state, SetMapOption{"bias", "-0.25"});
  state.setup.size = {376, 554};
  std::string words;
  for (const std::string& word : tuning_words(state, options)) words += " " + word;
  EXPECT_EQ(words.find(
                " --size 297x437 --light sun --camera-orbit=-30,20.5 --camera-distance 5 --light-azimuth 45"),
            0u)
      << words;
  EXPECT_NE(words.find(" --max-lights 7"), std::string::npos) << words;
  EXPECT_EQ(words.find("bias"), std::string::npos) << words;
  EXPECT_EQ(words.find("map"), std::string::npos) << words;
  state.setup.size = {96, 64};
  EXPECT_EQ(tuning_words(state, options)[1], "96x64");
}

// As every command takes it, the sweep with them.
TEST(ViewStatus, AFlagOfTheMapsSettingsIsOn) {
  raster::MapOptions map;
  map.bias.receiver_plane = true;
  const auto settings = raster::map_values(map);
  EXPECT_EQ(std::count(settings.begin(), settings.end(),
                       std::pair<std::string, std::string>("receiver-plane", "on")),
            1);
}

TEST(ViewStatus, LightsThatTheCommandCannotTurnAreNamed) {
  ViewState state = two_light_state();
  carry_out(state, TurnLightBy{5.0, 0.0});
  EXPECT_TRUE(other_turned_lights(state).empty());
  carry_out(state, NextLight{});
  EXPECT_EQ(other_turned_lights(state), std::vector<std::string>{"sun"});
}

// Whatever a bias has beside its constant stands in the settings' table, the casters' own bias too.
TEST(ViewStatus, LineHasEveryPartOfABias) {
  ViewState state = two_light_state();
  raster::MapOptions& map = state.setup.map;
  const raster::MapOptions plain = map;
  for (const raster::MapSetting& setting : raster::map_settings()) {
    if (setting.group != raster::SettingGroup::bias || setting.name == "bias") continue;
    map = plain, map.bias = {0.02, raster::BiasUnit::world};
    const bool is_switch = std::holds_alternative<raster::SwitchSetting>(setting.kind);
    ASSERT_TRUE(raster::set_setting(setting, map, is_switch ? "on" : "0.5")) << setting.name;
    const std::string line = status_line(state, {0.02, 0.01, 12.0, {}}, "fence");
    std::string title(setting.title);
    title.front() = static_cast<char>(std::tolower(title.front()));
    EXPECT_NE(line.find(title), std::string::npos) << setting.name << ": " << line;
  }
}

TEST(ViewStatus, LineHasBiasInBothUnitsAndSaysWhatIsStale) {
  ViewState state = two_light_state();
  state.setup.map.bias = {0.02, raster::BiasUnit::world};
  Readings readings{0.02, 0.01, 12.0, {}};
  std::string line = status_line(state, readings, "fence");
  EXPECT_NE(line.find("fence | raster | sun | hard 1024² | bias 0.02 = 2 texels"), std::string::npos) << line;
  EXPECT_NE(line.find("comparing"), std::string::npos) << line;
  readings.compared = Readings::Compared{true, false, 0.041, 0.041};
  line = status_line(state, readings, "fence");
  EXPECT_NE(line.find("wrong 4.1 %"), std::string::npos) << line;
  EXPECT_TRUE(line.ends_with("mean error 4.1 %")) << "times of one side alone say nothing: " << line;
  readings.compared->preview = true;
  EXPECT_NE(status_line(state, readings, "fence").find("(preview)"), std::string::npos);
  readings.compared->current = false;
  EXPECT_NE(status_line(state, readings, "fence").find("(before)"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::lab

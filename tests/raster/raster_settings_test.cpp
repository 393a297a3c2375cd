// The table of settings by itself: every value can be written and read back, ranges hold, and a set of options is what its
// own words ask for.
#include "raster/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gnomon::raster {
namespace {

/// The values that a row is tried with, as text.
std::vector<std::string> tried_values(const MapSetting& setting) {
  if (const auto* number = std::get_if<NumberSetting>(&setting.kind))
    return {number_text(number->range.min), number_text(number->range.max),
            number_text(number->slider.min + 0.3 * (number->slider.max - number->slider.min))};
  if (const auto* integer = std::get_if<IntegerSetting>(&setting.kind))
    return {std::to_string(integer->min), std::to_string(integer->max), std::to_string(integer->slider_to)};
  if (std::holds_alternative<SwitchSetting>(setting.kind)) return {"on", "off"};
  if (const auto* list = std::get_if<ListSetting>(&setting.kind)) {
    std::string most = "1";
    for (int i = 1; i < list->most; ++i) most += "," + std::to_string(i + 1);
    return {most, "auto"};
  }
  if (const auto* constant = std::get_if<ConstantBiasSetting>(&setting.kind))
    return {constant->may_be_automatic ? "auto" : "3", "0.5texel", "-0.25", "0"};
  const auto names = std::get<ChoiceSetting>(setting.kind).names();
  return {names.begin(), names.end()};
}

TEST(Settings, AValueIsReadBackFromItsText) {
  for (const MapSetting& setting : map_settings())
    for (const std::string& value : tried_values(setting)) {
      MapOptions map;
      ASSERT_TRUE(set_setting(setting, map, value)) << setting.name << " " << value;
      EXPECT_EQ(setting_text(setting, map), value) << setting.name;
    }
}

TEST(Settings, ARowSetsItsOwnFieldAlone) {
  const MapOptions plain;
  for (const MapSetting& changed : map_settings())
    for (const std::string& value : tried_values(changed)) {
      MapOptions map;
      ASSERT_TRUE(set_setting(changed, map, value));
      for (const MapSetting& other : map_settings())
        if (other.name != changed.name) {
          EXPECT_EQ(setting_text(other, map), setting_text(other, plain))
              << changed.name << " " << other.name;
        }
    }
}

TEST(Settings, ValuesBeyondTheRangeAreRefusedAsTextAndAsNumbers) {
  for (const MapSetting& setting : map_settings()) {
    const auto* number = std::get_if<NumberSetting>(&setting.kind);
    if (number == nullptr) continue;
    for (const double value :
         {std::nextafter(number->range.min, -1e9), std::nextafter(number->range.max, 1e9),
          std::numeric_limits<double>::infinity(), std::nan("")}) {
      MapOptions map;
      EXPECT_FALSE(set_setting(setting, map, number_text(value))) << setting.name << " " << value;
      number->set(map, value);
      EXPECT_FALSE(check_map_options(map)) << setting.name << " " << value;
    }
  }
}

TEST(Settings, DefaultsAndSlidersLieWithinTheRange) {
  const MapOptions plain;
  EXPECT_TRUE(check_map_options(plain));
  for (const MapSetting& setting : map_settings()) {
    if (const auto* n = std::get_if<NumberSetting>(&setting.kind)) {
      EXPECT_TRUE(n->range.contains(n->get(plain))) << setting.name;
      EXPECT_TRUE(n->range.contains(n->slider.min) && n->range.contains(n->slider.max)) << setting.name;
      EXPECT_FALSE(n->logarithmic && n->slider.min <= 0.0) << setting.name;
    }
    if (const auto* n = std::get_if<IntegerSetting>(&setting.kind)) {
      EXPECT_TRUE(n->slider_from >= n->min && n->slider_to <= n->max) << setting.name;
    }
  }
}

TEST(Settings, EveryRowHasItsWords) {
  for (const MapSetting& setting : map_settings()) {
    EXPECT_EQ(find_setting(setting.name), &setting);
    for (const std::string_view text :
         {setting.help, setting.title, setting.what, setting.acne, setting.peter_panning})
      EXPECT_FALSE(text.empty()) << setting.name;
    const auto* on_off = std::get_if<SwitchSetting>(&setting.kind);
    EXPECT_EQ(setting.type.empty(), on_off != nullptr && on_off->form != SwitchForm::word) << setting.name;
  }
  EXPECT_EQ(find_setting("no-such-setting"), nullptr);
}

TEST(Settings, AMistypedNameIsAnswered) {
  MapOptions map;
  const Expected<void> wrong = set_setting("technique", map, "vms");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().reason.find("(got vms, allowed hard, "), std::string::npos) << wrong.error().reason;
  EXPECT_NE(wrong.error().reason.find("did you mean"), std::string::npos) << wrong.error().reason;
}

/// The options that these values ask for, in the way that commands take them.
MapOptions asked_for(const std::vector<std::pair<std::string, std::string>>& values) {
  MapOptions map;
  map.bias.slope = 0.0;  // a bias is asked for always
  for (const auto& [name, value] : values) EXPECT_TRUE(set_setting(name, map, value)) << name;
  return map;
}

TEST(Settings, OptionsAreWhatTheirWordsAskFor) {
  for (const TechniqueTraits& traits : all_technique_traits())
    for (const MapSetting& setting : map_settings()) {
      if (setting.name == "technique" || !reads(traits, setting)) continue;
      for (const std::string& value : tried_values(setting)) {
        MapOptions map;
        map.technique = traits.technique;
        if (!reads(map, setting)) continue;
        ASSERT_TRUE(set_setting(setting, map, value));
        if (!compares_depths(map.technique)) map.bias.slope = 0.0;  // which it does not read
        EXPECT_EQ(asked_for(map_values(map)), map) << traits.name << " " << setting.name << " " << value;
      }
    }
}

}  // namespace
}  // namespace gnomon::raster

// Every choice about the shadow map, one row each. A row has its names on the command line and in result.json, unit, range
// and default, which techniques read it, and what it does. From these rows are made:
// - the command line with its help, checks and completion, and the manual
// - the axes of sweeps and the panel of the lab
// - the commands that give a setting back, and result.json
// A new choice is a field in options.h and a row in settings.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "raster/technique_traits.h"
#include "scene/base/option_text.h"

namespace gnomon::raster {

enum class SettingGroup : std::uint8_t { map, window, bias, filter, cascades, rays };
/// What stands above a group's settings in the lab. A literal, ended by a zero.
constexpr std::string_view group_title(SettingGroup group) {
  constexpr std::string_view titles[] = {"Map", "Window", "Bias", "Filter", "Cascades", "Rays"};
  return titles[static_cast<std::size_t>(group)];
}

/// The order in which a panel has the groups.
inline constexpr SettingGroup panel_groups[] = {SettingGroup::map,    SettingGroup::bias,
                                                SettingGroup::filter, SettingGroup::cascades,
                                                SettingGroup::rays,   SettingGroup::window};

/// A number of this unit. The slider's ends lie within the range; what lies beyond them can be typed.
struct NumberSetting {
  double (*get)(const MapOptions&);
  void (*set)(MapOptions&, double);
  std::string_view unit;
  OptionRange range;
  OptionRange slider;
  bool logarithmic = false;  ///< the slider
};

struct IntegerSetting {
  int (*get)(const MapOptions&);
  void (*set)(MapOptions&, int);
  std::string_view unit;
  int min, max;
  int slider_from, slider_to;
  bool powers_of_two = false;  ///< the slider
};

enum class SwitchForm : std::uint8_t {
  flag,      ///< --NAME turns it on
  off_flag,  ///< --NAME turns it off
  word       ///< --NAME on|off
};

struct SwitchSetting {
  bool (*get)(const MapOptions&);
  void (*set)(MapOptions&, bool);
  SwitchForm form;
};

/// One of several names, by its place among them.
struct ChoiceSetting {
  std::size_t (*get)(const MapOptions&);
  void (*set)(MapOptions&, std::size_t);
  std::vector<std::string_view> (*names)();
};

/// Some numbers of this unit, one after the other, separated by commas: `least` to `most` of them, or none, which is said
/// by "auto" and stands for what is fitted.
struct ListSetting {
  const NumberList& (*get)(const MapOptions&);
  void (*set)(MapOptions&, const NumberList&);
  std::string_view unit;
  OptionRange range;
  int least, most;
  bool ascending = false;  ///< each number is above the one before
};

/// A constant of Bias with its unit. The slider counts texels, whatever the unit.
struct ConstantBiasSetting {
  static constexpr OptionRange slider{0.0, 10.0};
  double Bias::*constant;
  BiasUnit Bias::*unit;
  bool may_be_automatic;
};

struct MapSetting {
  std::string_view name;   ///< on the command line, without "--"
  std::string_view key{};  ///< in its group's part of result.json; "" where nothing but the setting says it
  SettingGroup group;
  std::variant<NumberSetting, IntegerSetting, SwitchSetting, ChoiceSetting, ListSetting, ConstantBiasSetting>
      kind;
  /// Null where every technique reads it.
  bool (*read_by)(const TechniqueTraits&) = nullptr;
  /// With technique pcf, null where every kernel reads it.
  bool (*read_by_kernel)(FilterKernel) = nullptr;
  std::string_view type{};  ///< of the value, as --help names it; of a switch: ""
  std::string_view help;    ///< what the option does
  std::string_view title;   ///< in the lab; in lower case the words of the terminal and the page
  std::string_view what;    ///< one sentence
  /// What more of it does to acne and to peter-panning.
  std::string_view acne = "None.", peter_panning = "None.";
  std::string_view slider_unit{};  ///< where the unit is too long for a panel
  /// Where unit, range or default need more words than the row's numbers.
  std::string_view range_help{}, default_help{};
};

/// All of them, in the order of --help; those of a group in the panel's order.
std::span<const MapSetting> map_settings();
/// Null where there is none of that name.
const MapSetting* find_setting(std::string_view name);

/// Whether the technique reads the setting, with one of pcf's kernels at least.
bool reads(const TechniqueTraits& technique, const MapSetting& setting);
/// Whether the options' technique, with their filter kernel, reads the setting.
bool reads(const MapOptions& map, const MapSetting& setting);
/// By name; true of a name that is no setting's.
bool reads_setting(const MapOptions& map, std::string_view name);

std::string_view depth_format_name(DepthFormat format);  ///< "d16", "d24", "d32f", "d32f-reversed"
std::string_view cull_name(Cull cull);                   ///< "none", "front", "back"

/// The value as the command line takes it: "0.5texel", "d32f", "on".
std::string setting_text(const MapSetting& setting, const MapOptions& map);
/// Sets the value from such a text. Error (usage): not of the kind, or out of range.
Expected<void> set_setting(const MapSetting& setting, MapOptions& map, std::string_view text);
/// Sets the setting of that name. Error (usage) also where there is none.
Expected<void> set_setting(std::string_view name, MapOptions& map, std::string_view text);
/// Error (usage): the number is out of range or not finite. Anything else is always in range.
Expected<void> check_range(const MapSetting& setting, const MapOptions& map);
/// "texels, 1 to 65536": the unit and the allowed values, as --help has them; of a switch "on or off".
std::string allowed_text(const MapSetting& setting);

struct BiasValue {
  double constant = 0.0;
  BiasUnit unit = BiasUnit::world;
};
inline constexpr OptionRange bias_range{-1e30, 1e30};
/// "0.02" (world units along the light ray), "0.5texel" or, where it may be, "auto".
Expected<BiasValue> parse_bias(std::string_view text, bool may_be_automatic = true);
/// The constant as parse_bias() reads it; an automatic one counts once.
std::string bias_text(const Bias& bias);

/// What asks for these options, by name: every setting that the technique reads and that differs from the default, the
/// map's size and the constant bias always. A bias that is asked for takes the place of the default's slope.
std::vector<std::pair<std::string, std::string>> map_values(const MapOptions& map);
/// Returns the settings as words of a command line.
std::vector<std::string> map_arguments(const MapOptions& map);
/// Returns values by name as words of a command line; a switch is "on" or "off".
std::vector<std::string> words_of(const std::vector<std::pair<std::string, std::string>>& values);
/// "--slope-bias 1 --bias auto": what asks for a bias beside what asked for that of `drawn`, whose other parts are set back, since
/// they may have been written out. The automatic constant is asked for, too, because a scene or a lesson may ask for another.
std::string bias_arguments(const Bias& bias, const MapOptions& drawn);

}  // namespace gnomon::raster

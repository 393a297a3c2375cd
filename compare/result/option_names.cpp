#include "compare/result/option_names.h"

#include <fmt/core.h>

#include <cctype>

#include "compare/result/number_text.h"

/// The program brings it along (cmake/GnomonCommit.cmake), so that a new commit compiles no library again;
/// other programs that use this room have none.
extern "C" [[gnu::weak]] const char* gnomon_commit();

namespace gnomon::compare {

namespace {

std::string value_words(const raster::MapSetting& setting, const raster::MapOptions& map) {
  const auto text = [](double value, std::string_view unit) {
    return unit == "texels" ? texels_text(value) : plain_number(value);
  };
  if (const auto* number = std::get_if<raster::NumberSetting>(&setting.kind))
    return text(number->get(map), number->unit);
  if (const auto* number = std::get_if<raster::IntegerSetting>(&setting.kind))
    return text(number->get(map), number->unit);
  return raster::setting_text(setting, map);
}

}  // namespace

std::string setting_words(const raster::MapSetting& setting, const raster::MapOptions& map) {
  std::string words(setting.title);
  words.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(words.front())));
  if (const auto* on_off = std::get_if<raster::SwitchSetting>(&setting.kind))
    return on_off->get(map) ? words : "no " + words;
  return words + " " + value_words(setting, map);
}

std::vector<std::string> bias_parts(const raster::Bias& bias) {
  raster::MapOptions map, none;
  map.bias = bias, none.bias = raster::Bias{};
  std::vector<std::string> parts;
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.group == raster::SettingGroup::bias && setting.name != "bias" &&
        raster::setting_text(setting, map) != raster::setting_text(setting, none))
      parts.push_back(setting_words(setting, map));
  return parts;
}

std::string beside_constant(const raster::MapOptions& map) {
  std::string text;
  for (const std::string& part : bias_parts(map.bias)) text += ", " + part;
  return map.cull == raster::Cull::none ? text : text + fmt::format(", cull {}", cull_name(map.cull));
}

std::string_view program_version() {
  static const std::string version = [] {
    const std::string commit = gnomon_commit != nullptr ? gnomon_commit() : "";
    return commit.empty() ? std::string(GNOMON_VERSION) : GNOMON_VERSION "+" + commit;
  }();
  return version;
}

}  // namespace gnomon::compare

#include "compare/option_names.h"

#include <fmt/core.h>

#include <string>

#include "compare/number_text.h"

/// The program brings it along (cmake/GnomonCommit.cmake), so that a new commit compiles no library anew;
/// other programs that use this room have none.
extern "C" [[gnu::weak]] const char* gnomon_commit();

namespace gnomon::compare {

std::string_view depth_format_name(raster::DepthFormat format) {
  switch (format) {
    case raster::DepthFormat::d16:
      return "d16";
    case raster::DepthFormat::d24:
      return "d24";
    case raster::DepthFormat::d32f:
      return "d32f";
    case raster::DepthFormat::d32f_reversed:
      return "d32f-reversed";
  }
  return "unknown";
}

std::string_view cull_name(raster::Cull cull) {
  switch (cull) {
    case raster::Cull::none:
      return "none";
    case raster::Cull::front:
      return "front";
    case raster::Cull::back:
      return "back";
  }
  return "unknown";
}

std::string bias_arguments(const raster::Bias& bias, const raster::MapOptions& drawn) {
  const bool asked = drawn.bias != raster::default_bias(drawn);  // then what is not needed is set back
  std::string text;
  const auto add_number = [&](std::string_view option, double wanted, double before) {
    if (wanted != 0.0 || (asked && before != 0.0)) text += fmt::format("--{} {} ", option, wanted);
  };
  const auto add_flag = [&](std::string_view option, bool wanted, bool before) {
    if (wanted || (asked && before)) text += fmt::format("--{}{} ", option, wanted ? "" : "=false");
  };
  add_number("slope-bias", bias.slope, drawn.bias.slope);
  add_number("normal-offset", bias.normal_offset_texels, drawn.bias.normal_offset_texels);
  add_flag("receiver-plane", bias.receiver_plane, drawn.bias.receiver_plane);
  add_flag("adaptive-bias", bias.adaptive, drawn.bias.adaptive);
  if (bias.unit == raster::BiasUnit::automatic) return text + "--bias auto";
  return text +
         fmt::format("--bias {}{}", bias.constant, bias.unit == raster::BiasUnit::texel ? "texel" : "");
}

std::vector<std::string> bias_parts(const raster::Bias& bias) {
  std::vector<std::string> parts;
  if (bias.slope != 0.0) parts.push_back("slope bias " + plain_number(bias.slope));
  if (bias.normal_offset_texels != 0.0)
    parts.push_back("normal offset " + texels_text(bias.normal_offset_texels));
  if (bias.receiver_plane) parts.emplace_back("receiver plane");
  if (bias.adaptive) parts.emplace_back("adaptive bias");
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

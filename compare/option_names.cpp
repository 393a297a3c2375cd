#include "compare/option_names.h"

#include <fmt/format.h>

#include <string>

/// The program brings it along (cmake/GnomonCommit.cmake), so that a new commit compiles no library anew;
/// other programs that use this room have none.
extern "C" [[gnu::weak]] const char* gnomon_commit();

namespace gnomon::compare {

std::string_view light_type_name(LightType type) {
  switch (type) {
    case LightType::directional:
      return "directional";
    case LightType::point:
      return "point";
    case LightType::spot:
      return "spot";
  }
  return "unknown";
}

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

std::string bias_arguments(const raster::Bias& bias) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
  if (bias.slope != 0.0) add(fmt::format("--slope-bias {}", bias.slope));
  if (bias.normal_offset_texels != 0.0) add(fmt::format("--normal-offset {}", bias.normal_offset_texels));
  if (bias.receiver_plane) add("--receiver-plane");
  if (bias.adaptive) add("--adaptive-bias");
  if (bias.unit != raster::BiasUnit::automatic)
    add(fmt::format("--bias {}{}", bias.constant, bias.unit == raster::BiasUnit::texel ? "texel" : ""));
  else if (text.empty())
    add("--bias auto");
  return text;
}

std::string_view program_version() {
  static const std::string version = [] {
    const std::string commit = gnomon_commit != nullptr ? gnomon_commit() : "";
    return commit.empty() ? std::string(GNOMON_VERSION) : GNOMON_VERSION "+" + commit;
  }();
  return version;
}

}  // namespace gnomon::compare

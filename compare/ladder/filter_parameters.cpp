#include "compare/ladder/filter_parameters.h"

#include <cmath>

#include "compare/result/option_names.h"

namespace gnomon::compare {
namespace {

using raster::FilterKernel;
using raster::Technique;

/// Of a filter what is neither its kind nor how it takes the receiver's depth.
bool is_parameter(const raster::MapSetting& setting) {
  return setting.group == raster::SettingGroup::filter && setting.name != "filter-kernel" &&
         setting.name != "filter-plane";
}

// The square of texels around the receiver's own, or around the receiver.
double pcf_reach(const raster::FilterOptions& filter) {
  switch (filter.kernel) {
    case FilterKernel::box:
      return std::floor(filter.radius_texels) + 1.0;
    case FilterKernel::hardware:
      return 1.0;
    case FilterKernel::vogel:
    case FilterKernel::optimised:
      return filter.radius_texels + 1.0;
  }
  return 0.0;
}

}  // namespace

std::string_view filter_kind(const raster::MapOptions& map) {
  if (map.technique == Technique::pcf) return raster::traits_of(map.filter.kernel).name;
  if (map.technique == Technique::pcss) return "penumbra";
  return raster::uses_moments(map.technique) ? "moments" : "none";
}

double filter_reach_texels(const raster::MapOptions& map, double level) {
  if (map.technique == Technique::pcf) return pcf_reach(map.filter);
  if (map.technique == Technique::pcss) return map.filter.search_radius_texels + 1.0;
  if (!raster::uses_moments(map.technique)) return 0.0;
  const double side = std::exp2(std::ceil(level));
  return map.filter.blur_radius_texels + side + 0.5 * (side - 1.0);
}

std::string filter_text(const raster::MapOptions& map) {
  if (filter_kind(map) == "none") return "";
  std::string text(filter_kind(map));
  for (const raster::MapSetting& setting : raster::map_settings())
    if (is_parameter(setting) && raster::reads(map, setting)) text += ", " + setting_words(setting, map);
  return text;
}

}  // namespace gnomon::compare

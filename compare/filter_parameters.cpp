#include "compare/filter_parameters.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/number_text.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

using raster::FilterKernel;
using raster::MapOption;
using raster::Technique;
using Parameters = std::vector<std::pair<std::string, double>>;

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

Parameters filter_parameters(const raster::MapOptions& map) {
  const raster::FilterOptions& f = map.filter;
  const struct {
    MapOption option;
    const char* name;
    double value;
  } all[] = {{MapOption::filter_samples, "samples", double(f.samples)},
             {MapOption::blocker_samples, "blocker_samples", double(f.blocker_samples)},
             {MapOption::search_radius, "search_radius_texels", f.search_radius_texels},
             {MapOption::blur_radius, "blur_radius_texels", double(f.blur_radius_texels)},
             {MapOption::mipmaps, "mipmaps", f.mipmaps ? 1.0 : 0.0},
             {MapOption::bleeding_reduction, "bleeding_reduction", f.light_bleeding_reduction},
             {MapOption::esm_exponent, "exponent", f.esm_exponent},
             {MapOption::evsm_exponent, "exponent", f.evsm_positive_exponent},
             {MapOption::evsm_negative_exponent, "negative_exponent", f.evsm_negative_exponent},
             {MapOption::moment_bias, "moment_bias", f.moment_bias}};
  Parameters out;
  for (const auto& [option, name, value] : all)
    if (raster::reads_option(map, option)) out.emplace_back(name, value);
  return out;
}

std::string filter_text(const raster::MapOptions& map) {
  if (filter_kind(map) == "none") return "";
  std::string text(filter_kind(map));
  if (map.technique == Technique::pcf && map.filter.kernel != FilterKernel::hardware)
    text += fmt::format(", radius {}", texels_text(map.filter.radius_texels));
  for (auto [name, value] : filter_parameters(map)) {
    const bool texels = name.ends_with("_texels");
    if (texels) name.resize(name.size() - 7);
    std::replace(name.begin(), name.end(), '_', ' ');
    if (name == "mipmaps")
      text += value != 0.0 ? ", mipmaps" : ", no mipmaps";
    else
      text += fmt::format(", {} {}", name, texels ? texels_text(value) : plain_number(value));
  }
  return text;
}

}  // namespace gnomon::compare

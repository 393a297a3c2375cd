#include "compare/filter_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/number_text.h"

namespace gnomon::compare {
namespace {

using raster::FilterKernel;
using raster::Technique;
using Parameters = std::vector<std::pair<std::string, double>>;

std::string_view kernel_name(FilterKernel kernel) {
  switch (kernel) {
    case FilterKernel::box:
      return "box";
    case FilterKernel::hardware:
      return "hardware";
    case FilterKernel::vogel:
      return "vogel";
    case FilterKernel::optimised:
      return "optimised";
  }
  return "unknown";
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

Parameters moment_parameters(const raster::MapOptions& map) {
  const raster::FilterOptions& f = map.filter;
  Parameters out{{"blur_radius_texels", f.blur_radius_texels}, {"mipmaps", f.mipmaps ? 1.0 : 0.0}};
  if (map.technique != Technique::esm) out.emplace_back("bleeding_reduction", f.light_bleeding_reduction);
  if (map.technique == Technique::esm) out.emplace_back("exponent", f.esm_exponent);
  if (map.technique == Technique::evsm) {
    out.emplace_back("exponent", f.evsm_positive_exponent);
    out.emplace_back("negative_exponent", f.evsm_negative_exponent);
  }
  if (map.technique == Technique::msm) out.emplace_back("moment_bias", f.moment_bias);
  return out;
}

}  // namespace

std::string_view filter_kind(const raster::MapOptions& map) {
  if (map.technique == Technique::pcf) return kernel_name(map.filter.kernel);
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
  if (map.technique == Technique::pcss)
    return {{"samples", f.samples},
            {"blocker_samples", f.blocker_samples},
            {"search_radius_texels", f.search_radius_texels}};
  if (raster::uses_moments(map.technique)) return moment_parameters(map);
  if (map.technique == Technique::pcf && f.kernel == FilterKernel::vogel) return {{"samples", f.samples}};
  return {};
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

#include "app/filter_options.h"

#include "app/option_kinds.h"
#include "app/technique_options.h"
#include "raster/technique_traits.h"

namespace gnomon::app {
namespace {

constexpr std::pair<std::string_view, bool> switches[] = {{"on", true}, {"off", false}};

void add_pcf_options(CLI::App& command, raster::FilterOptions& filter) {
  add_choice(command, "--filter-kernel", filter.kernel, filter_kernels(), "NAME",
             "N x N texels alike, 2 x 2 bilinear, a disc turned at every pixel, or a sliding square");
  add_number(command, "--filter-radius", filter.radius_texels, {0.001, 64.0}, "texels",
             "half the kernel's width; box covers 2 floor(radius) + 1");
  add_choice(command, "--filter-plane", filter.receiver_plane, switches, "on|off",
             "compare each texel with the receiver's plane at its centre, not with its own depth");
  add_integer(command, "--filter-samples", filter.samples, 1, 1024, "lookups", "points of the filter");
  add_integer(command, "--blocker-samples", filter.blocker_samples, 1, 1024, "lookups",
              "points of the search for what blocks the light");
  add_number(command, "--search-radius", filter.search_radius_texels, {0.001, 1024.0}, "texels",
             "the search goes no farther, however large the light");
}

void add_moment_options(CLI::App& command, raster::FilterOptions& filter) {
  add_integer(command, "--blur-radius", filter.blur_radius_texels, 0, 64, "texels",
              "the map is averaged over 2 N + 1 texels each way");
  add_choice(command, "--mipmaps", filter.mipmaps, switches, "on|off",
             "pixels that cover several texels read their average");
  add_number(command, "--bleeding-reduction", filter.light_bleeding_reduction, {0.0, 0.999}, "visibility",
             "up to this is drawn black, the rest stretched");
  add_number(command, "--esm-exponent", filter.esm_exponent, {0.001, 80.0}, "per depth range of the map",
             "c in exp(c z)");
  add_number(command, "--evsm-exponent", filter.evsm_positive_exponent, {0.001, 40.0}, "per half depth range",
             "p in exp(p z)");
  add_number(command, "--evsm-negative-exponent", filter.evsm_negative_exponent, {0.001, 40.0},
             "per half depth range", "n in -exp(-n z)");
  add_number(command, "--moment-bias", filter.moment_bias, {0.0, 1.0}, "share",
             "of a fixed distribution, mixed into the moments against rounding");
}

}  // namespace

void add_filter_options(CLI::App& command, raster::FilterOptions& filter) {
  add_pcf_options(command, filter);
  add_moment_options(command, filter);
}

std::span<const std::pair<std::string_view, raster::FilterKernel>> filter_kernels() {
  static const auto choices = [] {
    std::vector<std::pair<std::string_view, raster::FilterKernel>> all;
    for (const auto& traits : raster::all_filter_kernel_traits())
      all.emplace_back(traits.name, traits.kernel);
    return all;
  }();
  return choices;
}

std::string filter_options_text(const raster::MapOptions& map) {
  const raster::FilterOptions& filter = map.filter;
  const raster::FilterOptions plain;
  std::string text;
  const auto add = [&](std::string_view name, const auto& value, const auto& fallback,
                       const std::string& shown) {
    if (value != fallback && technique_reads(name.substr(2), map)) text += fmt::format(" {} {}", name, shown);
  };
  const auto number = [&](const char* name, double raster::FilterOptions::*field) {
    add(name, filter.*field, plain.*field, number_text(filter.*field));
  };
  const auto integer = [&](const char* name, int raster::FilterOptions::*field) {
    add(name, filter.*field, plain.*field, std::to_string(filter.*field));
  };
  add("--filter-kernel", filter.kernel, plain.kernel, std::string(raster::traits_of(filter.kernel).name));
  number("--filter-radius", &raster::FilterOptions::radius_texels);
  add("--filter-plane", filter.receiver_plane, plain.receiver_plane, filter.receiver_plane ? "on" : "off");
  integer("--filter-samples", &raster::FilterOptions::samples);
  integer("--blocker-samples", &raster::FilterOptions::blocker_samples);
  number("--search-radius", &raster::FilterOptions::search_radius_texels);
  integer("--blur-radius", &raster::FilterOptions::blur_radius_texels);
  add("--mipmaps", filter.mipmaps, plain.mipmaps, filter.mipmaps ? "on" : "off");
  number("--bleeding-reduction", &raster::FilterOptions::light_bleeding_reduction);
  number("--esm-exponent", &raster::FilterOptions::esm_exponent);
  number("--evsm-exponent", &raster::FilterOptions::evsm_positive_exponent);
  number("--evsm-negative-exponent", &raster::FilterOptions::evsm_negative_exponent);
  number("--moment-bias", &raster::FilterOptions::moment_bias);
  return text;
}

}  // namespace gnomon::app

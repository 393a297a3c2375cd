// How a row of settings.cpp reaches its field: values by name, and each kind of setting over the members that lead to a field of
// MapOptions. Private to settings.cpp.
#pragma once

#include <algorithm>

#include "raster/settings.h"

namespace gnomon::raster {

template <class Enum>
using Names = std::span<const std::pair<std::string_view, Enum>>;

inline Names<DepthFormat> depth_formats() {
  static constexpr std::pair<std::string_view, DepthFormat> all[] = {
      {"d16", DepthFormat::d16},
      {"d24", DepthFormat::d24},
      {"d32f", DepthFormat::d32f},
      {"d32f-reversed", DepthFormat::d32f_reversed}};
  return all;
}

inline Names<Cull> culls() {
  static constexpr std::pair<std::string_view, Cull> all[] = {
      {"none", Cull::none}, {"front", Cull::front}, {"back", Cull::back}};
  return all;
}

inline Names<RayCount> ray_counts() {
  static constexpr std::pair<std::string_view, RayCount> all[] = {
      {"1/4", RayCount::quarter}, {"1", RayCount::one},   {"2", RayCount::two},
      {"4", RayCount::four},      {"8", RayCount::eight}, {"16", RayCount::sixteen}};
  return all;
}

inline Names<RaySampler> ray_samplers() {
  static constexpr std::pair<std::string_view, RaySampler> all[] = {{"random", RaySampler::random},
                                                                    {"stratified", RaySampler::stratified},
                                                                    {"blue-noise", RaySampler::blue_noise}};
  return all;
}

inline Names<Denoiser> denoisers() {
  static constexpr std::pair<std::string_view, Denoiser> all[] = {{"none", Denoiser::none},
                                                                  {"penumbra", Denoiser::penumbra},
                                                                  {"atrous", Denoiser::atrous},
                                                                  {"svgf", Denoiser::svgf},
                                                                  {"fidelityfx", Denoiser::fidelityfx}};
  return all;
}

template <class Enum, class Row>
std::vector<std::pair<std::string_view, Enum>> names_of(std::span<const Row> rows, Enum Row::*value) {
  std::vector<std::pair<std::string_view, Enum>> all;
  for (const Row& row : rows) all.emplace_back(row.name, row.*value);
  return all;
}

inline Names<Technique> technique_values() {
  static const auto all = names_of(all_technique_traits(), &TechniqueTraits::technique);
  return all;
}

inline Names<FilterKernel> kernel_values() {
  static const auto all = names_of(all_filter_kernel_traits(), &FilterKernelTraits::kernel);
  return all;
}

template <class Enum>
std::size_t place_among(Names<Enum> all, Enum value) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.second == value; });
  return static_cast<std::size_t>(found - all.begin());
}

template <class Enum>
std::string_view name_among(Names<Enum> all, Enum value) {
  const std::size_t place = place_among(all, value);
  return place < all.size() ? all[place].first : "unknown";
}

template <auto... path>
constexpr NumberSetting number(std::string_view unit, OptionRange range, OptionRange slider,
                               bool logarithmic = false) {
  return {[](const MapOptions& map) -> double { return (map.*....*path); },
          [](MapOptions& map, double value) { (map.*....*path) = value; },
          unit,
          range,
          slider,
          logarithmic};
}
template <auto... path>
constexpr IntegerSetting integer(std::string_view unit, int min, int max, int slider_from, int slider_to,
                                 bool powers_of_two = false) {
  return {[](const MapOptions& map) -> int { return (map.*....*path); },
          [](MapOptions& map, int value) { (map.*....*path) = value; },
          unit,
          min,
          max,
          slider_from,
          slider_to,
          powers_of_two};
}
template <auto... path>
constexpr ListSetting list(std::string_view unit, OptionRange range, int least, int most,
                           bool ascending = false) {
  return {[](const MapOptions& map) -> const NumberList& { return (map.*....*path); },
          [](MapOptions& map, const NumberList& values) { (map.*....*path) = values; },
          unit,
          range,
          least,
          most,
          ascending};
}
template <auto... path>
constexpr SwitchSetting on_off(SwitchForm form) {
  return {[](const MapOptions& map) -> bool { return (map.*....*path); },
          [](MapOptions& map, bool on) { (map.*....*path) = on; }, form};
}
/// `all`: the function that lists the values.
template <auto all, auto... path>
constexpr ChoiceSetting choice() {
  return {[](const MapOptions& map) { return place_among(all(), (map.*....*path)); },
          [](MapOptions& map, std::size_t place) { (map.*....*path) = all()[place].second; },
          [] {
            std::vector<std::string_view> names;
            for (const auto& [name, value] : all()) names.push_back(name);
            return names;
          }};
}

}  // namespace gnomon::raster

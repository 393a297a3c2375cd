// The options of the shadow map as rows of the settings panel: what each is called, how it is set, and what it
// does to acne and to peter-panning. Bound to the same struct as the command line, by the same names; plain
// data, without a window.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "raster/options.h"

namespace gnomon::app {

/// A number on a slider. Beyond the slider's ends any value of the option's range can be typed.
struct NumberRow {
  double (*get)(const raster::MapOptions&) = nullptr;
  void (*set)(raster::MapOptions&, double) = nullptr;
  double from = 0.0, to = 1.0;
  std::string_view unit;
  bool logarithmic = false;
};
struct IntegerRow {
  int (*get)(const raster::MapOptions&) = nullptr;
  void (*set)(raster::MapOptions&, int) = nullptr;
  int from = 0, to = 1;
  std::string_view unit;
  bool powers_of_two = false;
};
struct SwitchRow {
  bool (*get)(const raster::MapOptions&) = nullptr;
  void (*set)(raster::MapOptions&, bool) = nullptr;
};
/// One of the values that the command line takes, by its place among them.
struct ChoiceRow {
  std::size_t (*get)(const raster::MapOptions&) = nullptr;
  void (*set)(raster::MapOptions&, std::size_t) = nullptr;
  std::vector<std::string_view> (*names)() = nullptr;
};
/// The constant bias, which has three units.
struct BiasRow {};

enum class RowGroup : std::uint8_t { map, bias, filter, cascades };

struct MapRow {
  std::string_view option;  ///< on the command line, without "--"
  std::string_view title;
  RowGroup group;
  std::variant<NumberRow, IntegerRow, SwitchRow, ChoiceRow, BiasRow> kind;
  std::string_view what;           ///< one sentence
  std::string_view acne;           ///< what more of it does to acne
  std::string_view peter_panning;  ///< and to peter-panning
};

/// All of them, in the panel's order.
std::span<const MapRow> map_rows();
/// Whether the options' technique reads the row.
bool is_read(const MapRow& row, const raster::MapOptions& map);

/// The constant bias in texels of this width, and set so; a bias in world units stays in world units.
double bias_texels(const raster::Bias& bias, double constant_world, double texel_world);
void set_bias_texels(raster::Bias& bias, double texels, double texel_world);

/// A setting that shows one artifact, on whatever scene.
struct Preset {
  std::string_view title;
  std::string_view what;
  raster::MapOptions (*apply)(const raster::MapOptions&);
};
std::span<const Preset> presets();

}  // namespace gnomon::app

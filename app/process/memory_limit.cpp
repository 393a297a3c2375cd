
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "app/options/options.h"
#include "app/options/values.h"
#include "app/process/machine.h"
#include "compare/ladder/penumbra.h"
#include "compare/measure/reduced.h"
#include "compare/metrics/edges.h"
#include "scene/files/pictures/texture_memory.h"

namespace gnomon::app {
namespace {

constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
constexpr double most_by_default = 2.0 * gibibyte;
constexpr OptionRange memory_range{0.0, 1e18, true};

std::string text_of_bytes(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", std::ceil(bytes / 1e6))
                     : fmt::format("{:.1f} GB", bytes / 1e9);
}

/// Writes a number of bytes for --memory, rounded up in the largest unit of which it has ten, so that it is at most a tenth
/// more.
std::string option_text(double bytes) {
  double value = std::ceil(bytes / 1024.0);
  std::string_view units = "KMGT";
  for (; value >= 10.0 * 1024.0 && units.size() > 1; units.remove_prefix(1))
    value = std::ceil(value / 1024.0);
  return fmt::format("{:.0f}{}", value, units.front());
}

/// A number alone in a file; infinite for "max", and where there is none.
double number_in(const std::string& path) {
  double value = infinity;
  if (std::ifstream file(path); !(file >> value)) return infinity;
  return value;
}

/// What the process's control group (version 2, as the process sees it) leaves it.
double free_in_group() {
  std::ifstream file("/proc/self/cgroup");
  std::string line;
  while (std::getline(file, line) && !line.starts_with("0::")) {
  }
  if (!line.starts_with("0::")) return infinity;
  const std::string folder = "/sys/fs/cgroup" + line.substr(3) + "/memory.";
  const double limit = number_in(folder + "max");
  return std::isfinite(limit) ? std::max(0.0, limit - number_in(folder + "current")) : infinity;
}

/// The largest whole number of band_step rows, at least that.
int in_steps(double rows) {
  const double steps = std::floor(rows / band_step);
  return band_step * static_cast<int>(std::clamp(steps, 1.0, 1e6));
}

}  // namespace

Expected<double> parse_bytes(const std::string& text) {
  constexpr std::array<std::pair<char, double>, 4> units{
      {{'K', 1024.0}, {'M', 1024.0 * 1024.0}, {'G', gibibyte}, {'T', 1024.0 * gibibyte}}};
  std::string number = text;
  double unit = 1.0;
  for (const auto& [letter, factor] : units)
    if (!number.empty() && std::toupper(static_cast<unsigned char>(number.back())) == letter) {
      unit = factor;
      number.pop_back();
      break;
    }
  const Expected<double> value = parse_number(number, memory_range);
  if (!value)
    return fail(ErrorKind::usage,
                fmt::format("not a number of bytes (got {}, allowed such as 500M or 2G, {})", text,
                            range_text(memory_range)));
  return *value * unit;
}

void add_memory(CLI::App& command, MemoryLimit& bytes, MemoryLimit& textures) {
  add_checked(
      command, "--memory", "BYTES",
      "what the picture's pixels may take at a time, besides scene, maps and OpenGL; a picture that would "
      "take more is worked through in bands, with the same results. A scene whose decoded textures would "
      "take more is refused [bytes, also 500M or 2G (units of 1024); default half of what the machine has "
      "free, of pixels at most 2G]",
      [&bytes, &textures](const std::string& text) -> Expected<void> {
        const Expected<double> value = parse_bytes(text);
        if (!value) return fail(value.error());
        bytes = textures = GivenBytes{*value, text};
        return {};
      });
}

namespace {

double half_of_the_free() {
  return 0.5 * std::min(available_memory(), free_in_group());
}

}  // namespace

double default_memory() {
  return std::min(half_of_the_free(), most_by_default);
}

TextureMemory texture_memory(const MemoryLimit& limit) {
  if (limit) return {limit->bytes, limit->text + " by --memory"};
  const double half = half_of_the_free();
  return {half, text_of_bytes(half) + ", half of what is free,"};
}

double PictureBytes::of(const ImageSize& size, int rows) const {
  const auto pixels = static_cast<double>(size.pixels());
  if (rows >= size.height) return piece * pixels;
  return whole * pixels + band * size.width * std::min(rows + margin, size.height) +
         soft * size.width * std::min(rows + compare::penumbra_rows_kept, size.height);
}

PictureBytes compare_bytes(const Scene& scene, const std::vector<std::uint32_t>& lights,
                           const ImageSize& size, bool page) {
  // Measured: what the peak of a picture in one piece grows by from 320x180 to 2560x1440, with one light and with
  // four. In bands what the camera sees, the longest list and a picture on its way to its file are whole, and what
  // the page shows; half as much as of a band is kept of the rows around it, and for soft shadows what their widths
  // take (compare/ladder/penumbra.h).
  const double light = static_cast<double>(lights.size());
  const auto soft =
      std::count_if(lights.begin(), lights.end(), [&](std::uint32_t i) { return has_size(scene.lights[i]); });
  const double piece = 260.0 + 57.0 * light, shown = 30.0 + 80.0 * light, step = compare::image_step(size);
  return {.piece = piece,
          .whole = 20.0 + (page ? shown / (step * step) : 0.0),
          .band = piece,
          .margin = compare::edge_margin,
          .soft = 36.0 * static_cast<double>(soft)};
}

Expected<std::vector<PictureRows>> plan_bands(const MemoryLimit& limit, const ImageSize& size,
                                              const PictureBytes& bytes, std::size_t most_pixels) {
  const double allowed = limit ? limit->bytes : default_memory();
  const bool fits = bytes.of(size, size.height) <= allowed;
  if (fits && (most_pixels == 0 || size.pixels() <= most_pixels)) return bands_of(size, size.height);
  if (limit && bytes.of(size, band_step) > allowed)
    return fail(ErrorKind::graphics,
                fmt::format("--memory: too little for a picture of {}x{} (got {}, allowed {} and more)",
                            size.width, size.height, limit->text, option_text(bytes.of(size, band_step))));
  const double left = allowed - bytes.of(size, 0);
  double rows = fits ? size.height : left / ((bytes.band + bytes.soft) * size.width);
  if (most_pixels > 0) rows = std::min(rows, static_cast<double>(most_pixels) / size.width);
  return bands_of(size, in_steps(rows));
}

std::string bands_text(const ImageSize& size, const PictureBytes& bytes,
                       const std::vector<PictureRows>& bands) {
  const int rows = bands.front().count;
  const std::string takes = text_of_bytes(bytes.of(size, rows));
  if (bands.size() == 1) return takes + ", in one piece";
  return fmt::format("{}, in {} bands of {} rows", takes, bands.size(), rows);
}

Expected<void> check_memory(const MemoryLimit& limit, const ImageSize& size, const PictureBytes& bytes,
                            double other) {
  const auto bands = plan_bands(limit, size, bytes);
  if (!bands) return fail(bands.error());
  return check_memory(size, bytes.of(size, bands->front().count) / static_cast<double>(size.pixels()), other);
}

}  // namespace gnomon::app

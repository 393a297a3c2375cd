#include "app/outputs/heatmap.h"

#include <array>
#include <cmath>

#include "compare/result/palette.h"
#include "scene/base/parallel.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon::app {
namespace {

using compare::viridis;

constexpr int octaves = 12;  // the scale ends at 2^12 - 1
constexpr int strip_height = 12, label_height = 16, digit_scale = 2;
constexpr glm::u8vec3 background{0xff, 0xff, 0xff}, ink{0x20, 0x20, 0x20};

// Digits of three by five dots, row by row from the top, the left dot highest.
constexpr std::array<std::array<std::uint8_t, 5>, 10> digits{{{7, 5, 5, 5, 7},
                                                              {2, 6, 2, 2, 7},
                                                              {7, 1, 7, 4, 7},
                                                              {7, 1, 7, 1, 7},
                                                              {5, 5, 7, 1, 1},
                                                              {7, 4, 7, 1, 7},
                                                              {7, 4, 7, 5, 7},
                                                              {7, 1, 1, 1, 1},
                                                              {7, 5, 7, 5, 7},
                                                              {7, 5, 7, 1, 7}}};

std::uint64_t count_of(const raytrace::WorkCounts& work, HeatmapOf what) {
  return what == HeatmapOf::nodes ? work.boxes : work.primitives;
}

void set(Rgb8Image& image, int x, int y, glm::u8vec3 colour) {
  if (x >= 0 && x < image.size.width && y >= 0 && y < image.size.height) image.at(x, y) = colour;
}

void draw_digit(Rgb8Image& image, int left, int top, std::size_t digit) {
  for (int y = 0; y < 5 * digit_scale; ++y)
    for (int x = 0; x < 3 * digit_scale; ++x)
      if ((digits[digit][static_cast<std::size_t>(y / digit_scale)] >> (2 - x / digit_scale) & 1) != 0)
        set(image, left + x, top + y, ink);
}

/// Centred at x, but whole within the picture.
void draw_number(Rgb8Image& image, int x, int top, int number) {
  const std::string text = std::to_string(number);
  const int advance = 4 * digit_scale, width = advance * static_cast<int>(text.size()) - digit_scale;
  int left = std::clamp(x - width / 2, 0, std::max(0, image.size.width - width));
  for (const char c : text) {
    draw_digit(image, left, top, static_cast<std::size_t>(c - '0'));
    left += advance;
  }
}

void draw_legend(Rgb8Image& image, int top) {
  const int width = image.size.width;
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < strip_height; ++y) set(image, x, top + y, viridis((x + 0.5) / width));
  const int apart = width >= 640 ? 1 : width >= 320 ? 2 : 6;  // octaves between labels
  for (int octave = 0; octave <= octaves; ++octave) {
    const int x = std::min(width - 1, octave * width / octaves);
    for (int y = 0; y < 3; ++y) set(image, x, top + strip_height + y, ink);
    if (octave % apart == 0) draw_number(image, x, top + strip_height + 4, (1 << octave) - 1);
  }
}

}  // namespace

Image<raytrace::WorkCounts> primary_ray_work(const raytrace::Tracer& tracer, const Camera& camera,
                                             ImageSize size) {
  const View view = make_view(camera, size);
  Image<raytrace::WorkCounts> work(size);
  parallel_for(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x)
      tracer.closest_seen(pixel_ray(view, x + 0.5, y + 0.5), work.at(x, y));
  });
  return work;
}

double heat_share(std::uint64_t count) {
  return std::min(1.0, std::log2(1.0 + static_cast<double>(count)) / octaves);
}

Rgb8Image heatmap_image(const Image<raytrace::WorkCounts>& work, HeatmapOf what) {
  const ImageSize size{work.size.width, work.size.height + strip_height + label_height};
  Rgb8Image image(size, background);
  for (int y = 0; y < work.size.height; ++y)
    for (int x = 0; x < work.size.width; ++x)
      image.at(x, y) = viridis(heat_share(count_of(work.at(x, y), what)));
  draw_legend(image, work.size.height);
  return image;
}

Expected<void> write_heatmap(const std::string& path, const Image<raytrace::WorkCounts>& work,
                             HeatmapOf what) {
  if (lower_extension(path) == ".png") return write_png(path, heatmap_image(work, what));
  std::vector<Channel> channels{{"nodes.V", {}}, {"triangles.V", {}}};
  for (const raytrace::WorkCounts& w : work.data) {
    channels[0].values.push_back(static_cast<float>(w.boxes));
    channels[1].values.push_back(static_cast<float>(w.primitives));
  }
  return write_exr(path, work.size, channels);
}

}  // namespace gnomon::app

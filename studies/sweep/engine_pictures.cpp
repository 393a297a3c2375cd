// A cell in pictures: its thumbnail, its drawing in small, and its labels as codes.

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "scene/base/parallel.h"
#include "studies/sweep/engine_impl.h"

namespace gnomon::studies {
namespace {

using compare::Label;

// A picture of at most `width` pixels, each of `colour(x0, x1, y0, y1)`: what becomes of that block.
template <class Colour>
Rgb8Image reduced(ImageSize full, int width, const Colour& colour) {
  const int columns = std::min(width, full.width);
  const int rows = std::max(1, static_cast<int>(std::lround(double(columns) * full.height / full.width)));
  Rgb8Image small({columns, rows});
  const auto edge = [](int i, int count, int pixels) {
    return static_cast<int>(static_cast<std::int64_t>(i) * pixels / count);
  };
  parallel_for(rows, [&](int y) {
    for (int x = 0; x < columns; ++x)
      small.at(x, y) = colour(edge(x, columns, full.width), edge(x + 1, columns, full.width),
                              edge(y, rows, full.height), edge(y + 1, rows, full.height));
  });
  return small;
}

std::uint8_t code_of(Label label) {
  return static_cast<std::uint8_t>(static_cast<int>(label) - static_cast<int>(Label::uncertain));
}

bool has_cause_code(std::uint8_t code) {
  return (code & code_label_mask) > code_of(Label::right);
}

bool is_wrong_code(std::uint8_t code) {
  return has_cause_code(code) && (code & code_small_error) == 0;
}

/// Drawn minus true visibility where the test is hard.
float error_of_code(std::uint8_t code) {
  if (!is_wrong_code(code)) return 0.0f;
  return (code & code_false_shadow) != 0 ? -1.0f : 1.0f;
}

}  // namespace

float Engine::Impl::worst_error(std::size_t pixel) const {
  float worst = 0.0f;
  for (std::size_t i = 0; i < lower.size(); ++i) {
    if (!compare::is_compared(lower[i]->sorted.data[pixel])) continue;
    const raster::LightRecord& record = comparison.raster.lights[i];
    const bool lit = !(record.gap.data[pixel] > static_cast<float>(record.bias_constant_world));
    const float drawn = has_images ? record.visibility.data[pixel] : (lit ? 1.0f : 0.0f);
    const float error = drawn - lower[i]->rungs[0].data[pixel];
    if (std::abs(error) > std::abs(worst)) worst = error;
  }
  return worst;
}

void Engine::Impl::make_backdrop() {
  if (!backdrop.data.empty()) return;
  backdrop = compare::raytraced_picture(comparison);
  for (glm::u8vec3& c : backdrop.data) c = compare::grey_backdrop(c);
}

glm::u8vec3 Engine::Impl::mean_colour(const Image<std::uint8_t>* codes, int x0, int x1, int y0,
                                      int y1) const {
  glm::uvec3 whole(0u);  // of the pixels that are right, nearly all
  Vec3f marked(0.0f);
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = backdrop.index(0, y);
    for (int x = x0; x < x1; ++x) {
      const glm::u8vec3 grey = backdrop.at(x, y);
      const std::size_t pixel = row + static_cast<std::size_t>(x);
      const float error = codes ? error_of_code(codes->data[pixel]) : worst_error(pixel);
      if (error == 0.0f) {
        whole += glm::uvec3(grey);
        continue;
      }
      const Vec3f mark(error < 0.0f ? compare::false_shadow_colour : compare::missed_shadow_colour);
      marked += glm::mix(Vec3f(grey), mark, std::min(std::abs(error), 1.0f));
    }
  }
  return glm::u8vec3((Vec3f(whole) + marked) / static_cast<float>((x1 - x0) * (y1 - y0)) + 0.5f);
}

std::uint8_t Engine::Impl::code_of_light(std::size_t i, std::size_t pixel) const {
  const float truth = lower[i]->rungs[0].data[pixel];
  const std::uint8_t shadow = truth < 0.5f ? code_true_shadow : std::uint8_t{0};
  if (!has_images) return static_cast<std::uint8_t>(code_of(Label::right) | shadow);
  const compare::LightComparison& light = comparison.lights[i];
  const Label label = light.labels.data[pixel];
  std::uint8_t code = static_cast<std::uint8_t>(code_of(label) | shadow);
  if (!compare::has_cause(label)) return code;
  const auto rungs = compare::rungs_at(light.rungs, pixel);
  if (rungs[6] < truth) code |= code_false_shadow;
  if (!compare::is_wrong(rungs)) code |= code_small_error;
  return code;
}

Image<std::uint8_t> Engine::Impl::codes_of_images() const {
  Image<std::uint8_t> codes(comparison.raytraced.receiver.size);
  parallel_for(codes.data.size(), [&](std::size_t p) {
    std::uint8_t code = code_of(lower.empty() ? Label::background : lower.front()->sorted.data[p]);
    for (std::size_t i = 0; i < lower.size(); ++i) {
      if (!compare::is_compared(lower[i]->sorted.data[p]) || is_wrong_code(code)) continue;
      const std::uint8_t own = code_of_light(i, p);
      if (is_wrong_code(own) || !has_cause_code(code)) code = own;
    }
    codes.data[p] = code;
  });
  return codes;
}

Image<std::uint8_t> Engine::Impl::class_codes() {
  if (has_images) return codes_of_images();
  if (right_codes.data.empty()) right_codes = codes_of_images();
  Image<std::uint8_t> codes = right_codes;
  for (const BiasTable& light : table) {
    const std::size_t place = light.place[table_place];
    for (const WrongSpan& span : light.spans) {
      std::uint8_t& code = codes.data[span.pixel];
      if (place < span.from || place >= span.to || is_wrong_code(code)) continue;
      code = static_cast<std::uint8_t>((code & code_true_shadow) | code_of(span.label) |
                                       (span.false_shadow ? code_false_shadow : 0));
    }
  }
  return codes;
}

Rgb8Image Engine::thumbnail(int width) const {
  impls_[shown_]->make_backdrop();
  // Of a hard test's many biases the codes say it all.
  const std::optional<Image<std::uint8_t>> codes =
      impls_[shown_]->has_images ? std::nullopt : std::optional(impls_[shown_]->class_codes());
  return reduced(impls_[shown_]->backdrop.size, width, [&](int x0, int x1, int y0, int y1) {
    return impls_[shown_]->mean_colour(codes ? &*codes : nullptr, x0, x1, y0, y1);
  });
}

Rgb8Image Engine::drawing(int width) const {
  const Rgb8Image whole = compare::raster_picture(impls_[shown_]->comparison);
  if (width >= whole.size.width) return whole;
  return reduced(whole.size, width, [&whole](int x0, int x1, int y0, int y1) {
    Vec3f sum(0.0f);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) sum += Vec3f(whole.at(x, y));
    return glm::u8vec3(sum / static_cast<float>((x1 - x0) * (y1 - y0)) + 0.5f);
  });
}

Image<std::uint8_t> Engine::class_codes() const {
  return impls_[shown_]->class_codes();
}

}  // namespace gnomon::studies

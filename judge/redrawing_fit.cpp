// Finds which filter the picture was drawn with, which pixels the description explains, and what is drawn outside the map.
#include <algorithm>
#include <cmath>

#include "compare/ladder/budget.h"
#include "judge/redrawing.h"
#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

constexpr double of_like_kernels = 0.25;  ///< what filters differ by that are known in kind alone
constexpr double kernel_is_known = 0.01, kernel_is_alike = 0.15;  ///< mean differences of partly lit pixels
constexpr double fits_alike = 1.25;                               ///< times the least of these differences
constexpr double a_tap = 1.0 / 16.0;  ///< the weight of one tap of a filter known in kind alone
constexpr std::size_t most_fitted = 1000, few_partly_lit = 50;
constexpr std::size_t few_beside = 20;  ///< tell nothing of what is drawn outside the map
constexpr double nearly_all_beside = 0.95;

}  // namespace

/// Kernels that the filter may have, with how far each is off the picture where that is partly lit.
std::vector<Redrawing::Fit> Redrawing::tried_kernels() const {
  std::vector<FilterKernel> kernels = kernels_of_reach(frame_.options.map.filter.radius_texels);
  if (reads_ == Reads::elsewhere) kernels = {{FilterKernel::Shape::taps, 1}};
  if (reads_ == Reads::between)
    std::erase_if(kernels, [](const FilterKernel& k) { return k.shape != FilterKernel::Shape::linear_taps; });
  std::vector<std::uint32_t> partly;
  for (const Pixel& pixel : fits_.front().pixels)
    if (is_partly_lit(double{light_.rungs[6].data[pixel.index]})) partly.push_back(pixel.index);
  const std::size_t step = std::max<std::size_t>(1, partly.size() / most_fitted);
  std::vector<Fit> out(kernels.size());
  parallel_for(kernels.size(), [&](std::size_t k) {
    out[k].kernel = kernels[k];
    Reading reading{.kernel = kernels[k]};
    std::size_t count = 0;
    for (std::size_t i = 0; i < partly.size(); i += step) {
      read(drawn_, partly[i], 0, reading);
      if (!reading.known) continue;
      out[k].error +=
          std::abs(light(drawn_.own, reading, constant_world_) - double{light_.rungs[6].data[partly[i]]});
      ++count;
    }
    out[k].error /= static_cast<double>(std::max<std::size_t>(1, count));
  });
  if (partly.size() < few_partly_lit) out.front().error = std::max(out.front().error, kernel_is_known);
  return out;
}

/// The kernel that comes nearest to the picture. Where it is known in kind alone, the narrowest and the widest of those that come
/// as near stand beside it. So does itself with a tap as far off as the capture says that the filter reaches.
void Redrawing::fit_kernel() {
  const std::vector<Fit> tried = tried_kernels();
  const auto by_error = [](const Fit& a, const Fit& b) { return a.error < b.error; };
  const Fit& best = *std::min_element(tried.begin(), tried.end(), by_error);
  Fit& own = fits_.front();
  own.kernel = best.kernel, own.error = best.error;
  exact_ = best.error < kernel_is_known, known_ = best.error < kernel_is_alike;
  if (exact_ || !known_) return;
  const Fit *narrowest = &best, *widest = &best;
  for (const Fit& fit : tried) {
    if (fit.error > fits_alike * best.error) continue;
    if (fit.kernel.half_width() < narrowest->kernel.half_width()) narrowest = &fit;
    if (fit.kernel.half_width() > widest->kernel.half_width()) widest = &fit;
  }
  for (const Fit* other : {narrowest, widest})
    if (other != &best) fits_.push_back(*other);
  if (reads_ == Reads::elsewhere || reads_ == Reads::between) return;
  Fit& rimmed = fits_.emplace_back(best);
  rimmed.kernel.rim_radius = frame_.options.map.filter.radius_texels, rimmed.kernel.rim_share = a_tap;
}

/// What the renderer draws where its test finds no place in the map: lit, or dark where nearly all such pixels are.
void Redrawing::look_outside() {
  Reading reading;
  std::size_t outside = 0, dark = 0, lit = 0;
  for (const Pixel& pixel : fits_.front().pixels) {
    read(drawn_, pixel.index, 0, reading);
    if (reading.known) continue;
    const double drawn = double{light_.rungs[6].data[pixel.index]};
    ++outside, lit += drawn >= 1.0 - light_rounding ? 1 : 0, dark += drawn <= light_rounding ? 1 : 0;
  }
  const auto nearly_all = [outside](std::size_t count) {
    return outside >= few_beside && double(count) >= nearly_all_beside * double(outside);
  };
  outside_is_told_ = nearly_all(lit) || nearly_all(dark);
  outside_light_ = nearly_all(dark) ? 0.0 : 1.0;
}

void Redrawing::look_at_picture(Fit& fit) const {
  parallel_for((fit.pixels.size() + pixels_at_a_time - 1) / pixels_at_a_time, [&](std::size_t part) {
    Reading reading{.kernel = fit.kernel};
    for (std::size_t i = part * pixels_at_a_time;
         i < std::min(fit.pixels.size(), (part + 1) * pixels_at_a_time); ++i)
      fit.pixels[i] = look_at(fit.pixels[i].index, fit.error, reading);
  });
  doubt_neighbours(fit);
}

/// What another filter makes of a sample of the pixels, of which the best one tells where it draws.
void Redrawing::look_at_sample(Fit& fit) const {
  const Fit& best = fits_.front();
  for (std::size_t i = 0; i < best.pixels.size(); i += best.step) fit.pixels.push_back(best.pixels[i]);
  parallel_for(fit.pixels.size(), pixels_at_a_time, [&](std::size_t k) {
    Pixel& pixel = fit.pixels[k];
    Reading reading{.kernel = fit.kernel};
    read(drawn_, pixel.index, pixel.shift, reading);
    if (reading.known) pixel.now = static_cast<float>(light(drawn_.own, reading, constant_world_));
  });
}

/// Where something else draws, the test agrees by chance on many pixels: what lies among unexplained pixels that are drawn
/// alike is not explained either.
void Redrawing::doubt_neighbours(Fit& fit) const {
  constexpr int reach = 3;
  constexpr double share = 0.15;  // at a corner of what is drawn so a third is, of which half agrees
  Image<char> asked(in_.capture.size, 0), doubted(in_.capture.size, 0);
  for (const Pixel& pixel : fit.pixels) {
    asked.data[pixel.index] = 1;
    doubted.data[pixel.index] = pixel.explained ? 0 : 1;
  }
  const ImageSize size = in_.capture.size;
  parallel_for(fit.pixels.size(), pixels_at_a_time, [&](std::size_t k) {
    Pixel& pixel = fit.pixels[k];
    if (!pixel.explained) return;
    const int x = static_cast<int>(pixel.index) % size.width, y = static_cast<int>(pixel.index) / size.width;
    const float drawn = light_.rungs[6].data[pixel.index];
    int around = 0, alike = 0;
    for (int j = std::max(0, y - reach); j <= std::min(size.height - 1, y + reach); ++j)
      for (int i = std::max(0, x - reach); i <= std::min(size.width - 1, x + reach); ++i) {
        const std::size_t at = asked.index(i, j);
        around += asked.data[at];
        if (doubted.data[at] != 0 && std::abs(light_.rungs[6].data[at] - drawn) <= float(light_rounding))
          ++alike;
      }
    if (alike > share * around) pixel.explained = false;
  });
}

/// A pixel on a texel's border may be drawn by the neighbour: of the places that rounding reaches, the first that explains it.
Redrawing::Pixel Redrawing::look_at(std::uint32_t index, double kernel_error, Reading& reading) const {
  const double drawn = double{light_.rungs[6].data[index]};
  Pixel out{.index = index};
  for (std::size_t shift = 0; shift < shift_count && !out.explained; ++shift) {
    read(drawn_, index, static_cast<int>(shift), reading);
    if (!reading.known) {
      out.now = static_cast<float>(outside_light_);
      out.explained = std::abs(drawn - outside_light_) <= light_rounding;
      return out;
    }
    const double now = light(drawn_.own, reading, constant_world_);
    const double low = light(drawn_.own, reading, constant_world_ - slack_world_);
    const double high = light(drawn_.own, reading, constant_world_ + slack_world_);
    const double off = exact_ ? light_rounding : std::max(of_like_kernels, 4.0 * kernel_error);
    if (shift == 0) out.now = static_cast<float>(now);
    if (drawn < low - off || drawn > high + off) continue;
    out.explained = true, out.shift = static_cast<std::uint8_t>(shift);
    out.now = static_cast<float>(exact_ ? std::clamp(drawn, low, high) : now);
  }
  return out;
}

}  // namespace gnomon::judge

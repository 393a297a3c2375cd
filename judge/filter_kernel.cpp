#include "judge/filter_kernel.h"

#include <algorithm>
#include <cmath>

namespace gnomon::judge {
namespace {

using Shape = FilterKernel::Shape;

constexpr int disc_places = 12;  ///< along an axis

/// The integral from the left of the tent of height 1 over [-1, 1].
double tent_below(double x) {
  const double at = std::clamp(x, -1.0, 1.0);
  return at < 0.0 ? 0.5 * (1.0 + at) * (1.0 + at) : 1.0 - 0.5 * (1.0 - at) * (1.0 - at);
}

/// Weights along one axis of a kernel that is the product of two.
void weigh_axis(const FilterKernel& kernel, double within, std::vector<double>& weights) {
  const int reach = kernel.reach();
  weights.assign(static_cast<std::size_t>(kernel.width()), 0.0);
  const auto add = [&](double place, double weight) {
    const auto texel = static_cast<int>(std::floor(place)) + reach;
    weights[static_cast<std::size_t>(std::clamp(texel, 0, 2 * reach))] += weight;
  };
  if (kernel.shape == Shape::tent) {
    for (int i = -reach; i <= reach; ++i)
      add(i, tent_below((i + 1.0 - within) / kernel.radius) - tent_below((i - within) / kernel.radius));
    return;
  }
  for (int k = 0; k < kernel.side; ++k) {
    const double at = within + kernel.tap_offset(k);
    if (kernel.shape == Shape::linear_taps) {
      const double share = at - 0.5 - std::floor(at - 0.5);
      add(at - 0.5, (1.0 - share) / kernel.side), add(at + 0.5, share / kernel.side);
    } else {
      add(at, 1.0 / kernel.side);
    }
  }
}

void weigh_disc(const FilterKernel& kernel, const Vec2& within, std::vector<double>& weights) {
  const int reach = kernel.reach(), width = kernel.width();
  weights.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(width), 0.0);
  double all = 0.0;
  const auto place = [](int k) { return (2.0 * k + 1.0) / disc_places - 1.0; };
  for (int j = 0; j < disc_places; ++j)
    for (int i = 0; i < disc_places; ++i) {
      const Vec2 off(place(i), place(j));
      if (glm::dot(off, off) > 1.0) continue;
      const Vec2 texel = glm::floor(within + kernel.radius * off) + double(reach);
      weights[static_cast<std::size_t>(texel.y * width + texel.x)] += 1.0;
      all += 1.0;
    }
  for (double& weight : weights) weight /= all;
}

}  // namespace

int FilterKernel::reach() const {
  const auto of_shape = [this] {
    switch (shape) {
      case Shape::one:
        return 0.0;
      case Shape::taps:
        return 0.5 * (side - 1) * spacing;
      case Shape::linear_taps:
        return 0.5 * (side - 1) * spacing + 0.5;
      case Shape::tent:
      case Shape::disc:
        break;
    }
    return radius;
  };
  return static_cast<int>(std::ceil(std::max(of_shape(), rim_radius)));
}

double FilterKernel::half_width() const {
  const double square = 0.5 * side * spacing + (shape == Shape::linear_taps ? 0.5 : 0.0);
  return std::max(radius > 0.0 ? radius : square, rim_radius);
}

void FilterKernel::weigh(const Vec2& within, std::vector<double>& weights) const {
  weigh_shape(within, weights);
  if (rim_share == 0.0) return;
  constexpr int rim_places = 32;
  for (double& weight : weights) weight *= 1.0 - rim_share;
  for (int k = 0; k < rim_places; ++k) {
    const double angle = 2.0 * pi * k / rim_places;
    const Vec2 texel =
        glm::floor(within + rim_radius * Vec2(std::cos(angle), std::sin(angle))) + double(reach());
    weights[static_cast<std::size_t>(texel.y * width() + texel.x)] += rim_share / rim_places;
  }
}

void FilterKernel::weigh_shape(const Vec2& within, std::vector<double>& weights) const {
  if (shape == Shape::disc) return weigh_disc(*this, within, weights);
  thread_local std::vector<double> across, up;
  weigh_axis(*this, within.x, across), weigh_axis(*this, within.y, up);
  weights.clear();
  for (const double row : up)
    for (const double column : across) weights.push_back(row * column);
}

std::vector<FilterKernel> kernels_of_reach(double radius) {
  std::vector<FilterKernel> out;
  const auto is_alike = [radius](double reach) {
    return reach <= 1.6 * radius + 1.0 && reach >= 0.4 * radius;
  };
  for (const double spacing : {1.0, 0.5, 1.5, 2.0})
    for (const int side : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 13})
      for (const Shape shape : {Shape::taps, Shape::linear_taps}) {
        const double reach = 0.5 * side * spacing + (shape == Shape::linear_taps ? 0.5 : 0.0);
        const bool repeats = side == 1 && spacing != 1.0;
        if (is_alike(reach) && !repeats) out.push_back({shape, side, spacing, 0.0});
      }
  for (const double share : {1.0, 0.75, 1.25, 0.5, 1.5})
    for (const Shape shape : {Shape::tent, Shape::disc})
      out.push_back({shape, 1, 1.0, std::max(0.5, share * radius)});
  return out;
}

}  // namespace gnomon::judge

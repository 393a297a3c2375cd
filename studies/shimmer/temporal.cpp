#include "studies/shimmer/temporal.h"

#include <algorithm>

#include "compare/ladder/ladder.h"
#include "compare/truth/surfaces.h"
#include "scene/parallel.h"

namespace gnomon::compare {
namespace {

bool is_flip(double error) {
  return std::abs(error) > 0.5;
}

std::array<float, rung_count> rungs_at(const RungFrame& frame, std::size_t i) {
  std::array<float, rung_count> out{};
  for (std::size_t k = 0; k < rung_count; ++k) out[k] = frame.rungs[k].data[i];
  return out;
}

}  // namespace

std::string_view flip_label_name(std::size_t label) {
  return label == outside_map_flip ? std::string_view("outside_map") : cause_name(static_cast<Cause>(label));
}

std::array<double, cause_count> temporal_errors(const std::array<float, rung_count>& before,
                                                const std::array<float, rung_count>& after) {
  const double truth = double{after[0]} - double{before[0]};
  std::array<double, cause_count> errors{};
  for (std::size_t k = 0; k < cause_count; ++k)
    errors[k] = (double{after[k + 1]} - double{before[k + 1]}) - truth;
  return errors;
}

Cause flip_cause(const std::array<float, rung_count>& before, const std::array<float, rung_count>& after) {
  const auto error = [](const std::array<float, rung_count>& v) { return std::abs(v[6] - v[0]); };
  const auto& worse = error(after) >= error(before) ? after : before;
  if (error(worse) > 0.5f) return deciding_step(worse);
  const auto errors = temporal_errors(before, after);
  std::size_t step = cause_count - 1;
  while (step > 0 && is_flip(errors[step - 1])) --step;
  return static_cast<Cause>(step);
}

TemporalSums& TemporalSums::operator+=(const TemporalSums& o) {
  receivers += o.receivers, flips += o.flips, seam_flips += o.seam_flips;
  for (std::size_t k = 0; k < flip_label_count; ++k) by_label[k] += o.by_label[k];
  for (std::size_t k = 0; k < cause_count; ++k)
    signed_sum[k] += o.signed_sum[k], absolute_sum[k] += o.absolute_sum[k];
  error_sum += o.error_sum, error_absolute_sum += o.error_absolute_sum;
  drawn_swept += o.drawn_swept, true_swept += o.true_swept, edge_length += o.edge_length;
  return *this;
}

ReceiverSpacing receiver_spacing(const Image<raytrace::SurfacePoint>& receivers, const World& world,
                                 int step) {
  const ImageSize size = receivers.size;
  ReceiverSpacing out{Image<float>(size, 0.0f), Image<float>(size, 0.0f), Image<float>(size, 0.0f)};
  parallel_for(size.height, [&](int y) {
    if (y % step != 0) return;
    for (int x = 0; x < size.width; x += step) {
      if (x + step >= size.width || y + step >= size.height) continue;
      const auto &here = receivers.at(x, y), &right = receivers.at(x + step, y),
                 &down = receivers.at(x, y + step);
      if (!on_smooth_surface(here, right, world) || !on_smooth_surface(here, down, world)) continue;
      const Vec3 a = right.position - here.position, b = down.position - here.position;
      out.right.at(x, y) = static_cast<float>(glm::length(a));
      out.down.at(x, y) = static_cast<float>(glm::length(b));
      out.area.at(x, y) = static_cast<float>(glm::length(glm::cross(a, b)));
    }
  });
  return out;
}

TemporalBudget::TemporalBudget(ImageSize size, int frames, ReceiverSpacing spacing, int step)
    : spacing_(std::move(spacing)),
      step_(step),
      flips_(size, 0),
      last_flips_(size, 0),
      absolute_(size, 0.0f) {
  transitions_.reserve(static_cast<std::size_t>(frames));
}

// The true shadow's edge by Crofton's formula with the two directions of the grid: pi / 4 of the lengths that its
// crossings between neighbours stand for, right on average over the edge's direction.
void TemporalBudget::add_length(int x, int y, TemporalSums& sums) const {
  const std::size_t i = last_.counted.index(x, y), right = i + static_cast<std::size_t>(step_),
                    down = i + static_cast<std::size_t>(step_) *
                                   static_cast<std::size_t>(last_.counted.size.width);
  const double a = double{spacing_.right.data[i]}, b = double{spacing_.down.data[i]};
  if (!(double{spacing_.area.data[i]} > 0.0)) return;
  const Image<float>& truth = last_.rungs[0];
  const auto crossing = [&](std::size_t other) {
    return last_.counted.data[other] != 0 ? std::abs(double{truth.data[other]} - double{truth.data[i]}) : 0.0;
  };
  sums.edge_length += 0.25 * pi * (crossing(right) * b + crossing(down) * a);
}

void TemporalBudget::add_row(int y, const RungFrame& next, TemporalSums& sums) {
  for (int x = 0; x < next.counted.size.width; x += step_) {
    const std::size_t i = next.counted.index(x, y);
    last_flips_.data[i] = 0;
    if (last_.counted.data[i] == 0 || next.counted.data[i] == 0) continue;
    ++sums.receivers;
    add_length(x, y, sums);
    const auto before = rungs_at(last_, i), after = rungs_at(next, i);
    if (before == after) continue;
    const auto errors = temporal_errors(before, after);
    double below = 0.0;
    for (std::size_t k = 0; k < cause_count; ++k) {
      sums.signed_sum[k] += errors[k] - below, sums.absolute_sum[k] += std::abs(errors[k] - below);
      below = errors[k];
    }
    const double area = double{spacing_.area.data[i]};
    sums.drawn_swept += area * std::abs(double{after[6]} - double{before[6]});
    sums.true_swept += area * std::abs(double{after[0]} - double{before[0]});
    sums.error_sum += errors.back(), sums.error_absolute_sum += std::abs(errors.back());
    absolute_.data[i] += static_cast<float>(std::abs(errors.back()));
    if (!is_flip(errors.back())) continue;
    const bool outside = last_.outside.data[i] != 0 || next.outside.data[i] != 0;
    const auto label = outside ? outside_map_flip : static_cast<std::uint8_t>(flip_cause(before, after));
    ++sums.flips, ++sums.by_label[label];
    sums.seam_flips += last_.face.data[i] != next.face.data[i] ? 1 : 0;
    ++flips_.data[i];
    last_flips_.data[i] = static_cast<std::uint8_t>(label + 1);
  }
}

const TemporalSums& TemporalBudget::add(RungFrame next) {
  TemporalSums sums;
  if (has_last_) {
    std::vector<TemporalSums> rows(static_cast<std::size_t>(next.counted.size.height));
    parallel_for(rows.size(), [&](std::size_t y) {
      if (static_cast<int>(y) % step_ == 0) add_row(static_cast<int>(y), next, rows[y]);
    });
    for (const TemporalSums& row : rows) sums += row;
    total_ += sums;
    transitions_.push_back(sums);
  }
  last_ = std::move(next);
  has_last_ = true;
  static const TemporalSums none;
  return transitions_.empty() ? none : transitions_.back();
}

std::vector<WorstReceiver> TemporalBudget::worst(std::size_t count) const {
  std::vector<WorstReceiver> all;
  for (std::size_t i = 0; i < flips_.data.size(); ++i)
    if (flips_.data[i] > 0)
      all.push_back({static_cast<std::uint32_t>(i), flips_.data[i], double{absolute_.data[i]}});
  const auto before = [](const WorstReceiver& a, const WorstReceiver& b) {
    if (a.flips != b.flips) return a.flips > b.flips;
    return a.absolute != b.absolute ? a.absolute > b.absolute : a.pixel < b.pixel;
  };
  const std::size_t kept = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(), before);
  all.resize(kept);
  return all;
}

}  // namespace gnomon::compare

#include "studies/shimmer/temporal.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "compare/ladder/ladder.h"
#include "compare/truth/surfaces.h"
#include "scene/base/parallel.h"

namespace gnomon::studies {
namespace {

using compare::cause_count;
using compare::rung_count;

bool is_flip(double error) {
  return std::abs(error) > 0.5;
}

std::array<float, rung_count> rungs_at(const RungFrame& frame, std::size_t i) {
  std::array<float, rung_count> out{};
  for (std::size_t k = 0; k < rung_count; ++k) out[k] = frame.rungs[k].data[i];
  return out;
}

/// A neighbour in the grid of receivers.
struct GridStep {
  int columns, rows;
};
using GridSteps = std::array<GridStep, 8>;

/// Eight steps spread over the directions of a grid whose pixels are `columns` times as long downwards as to the right, or
/// `rows` times as long to the right; one of the two is 1.
GridSteps spread_steps(int columns, int rows) {
  GridSteps out{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 1}, {-2, 1}, {1, 2}, {-1, 2}}};
  for (GridStep& step : out) {
    step = {step.columns * columns, step.rows * rows};
    const int common = std::gcd(step.columns, step.rows);
    step = {step.columns / common, step.rows / common};
  }
  return out;
}

/// The steps of pixels four, three, two times as long downwards, as long both ways, and two, three, four times as long to the
/// right.
const std::array<GridSteps, 7>& all_steps() {
  static const std::array<GridSteps, 7> steps{spread_steps(4, 1), spread_steps(3, 1), spread_steps(2, 1),
                                              spread_steps(1, 1), spread_steps(1, 2), spread_steps(1, 3),
                                              spread_steps(1, 4)};
  return steps;
}
constexpr std::size_t square_steps = 3;
/// Where neighbours lie `right` and `down` away, world units: which of all_steps().
std::size_t steps_index(double right, double down) {
  const auto times = [](double ratio) {
    return static_cast<std::size_t>(std::lround(std::clamp(ratio, 1.0, 4.0)));
  };
  return square_steps + times(right / down) - times(down / right);
}

Vec2 way_in_plane(const GridStep& to, const Vec2& right, const Vec2& down) {
  return double(to.columns) * right + double(to.rows) * down;
}

/// The share of the half circle of directions that each step stands for: half the angle to the direction on
/// either side of it. They sum to pi.
std::array<double, 8> angles_stood_for(std::span<const GridStep> steps, const Vec2& right, const Vec2& down) {
  std::array<double, 8> angle{}, out{};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const Vec2 way = way_in_plane(steps[k], right, down);
    angle[k] = std::atan2(way.y, way.x);  // in [0, pi): rows are not negative
  }
  for (std::size_t k = 0; k < steps.size(); ++k) {
    double after = pi, before = pi;
    for (std::size_t other = 0; other < steps.size(); ++other) {
      if (other == k) continue;
      const double turn = angle[other] - angle[k];
      after = std::min(after, turn > 0.0 ? turn : turn + pi);
      before = std::min(before, turn > 0.0 ? pi - turn : -turn);
    }
    out[k] = 0.5 * (before + after);
  }
  return out;
}

}  // namespace

std::string_view flip_label_name(std::size_t label, compare::Ladder ladder) {
  return label == outside_map_flip ? std::string_view("outside_map")
                                   : compare::cause_name(static_cast<compare::Cause>(label), ladder);
}

std::array<double, cause_count> temporal_errors(const std::array<float, rung_count>& before,
                                                const std::array<float, rung_count>& after) {
  const double truth = double{after[0]} - double{before[0]};
  std::array<double, cause_count> errors{};
  for (std::size_t k = 0; k < cause_count; ++k)
    errors[k] = (double{after[k + 1]} - double{before[k + 1]}) - truth;
  return errors;
}

compare::Cause flip_cause(const std::array<float, rung_count>& before,
                          const std::array<float, rung_count>& after) {
  const auto error = [](const std::array<float, rung_count>& v) { return std::abs(v[6] - v[0]); };
  const auto& worse = error(after) >= error(before) ? after : before;
  if (error(worse) > 0.5f) return compare::deciding_step(worse);
  const auto errors = temporal_errors(before, after);
  std::size_t step = cause_count - 1;
  while (step > 0 && is_flip(errors[step - 1])) --step;
  return static_cast<compare::Cause>(step);
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
  const Image<float> none(size, 0.0f);
  ReceiverSpacing out{none, none, none, none};
  parallel_for(size.height, [&](int y) {
    if (y % step != 0) return;
    for (int x = 0; x < size.width; x += step) {
      if (x + step >= size.width || y + step >= size.height) continue;
      const auto &here = receivers.at(x, y), &right = receivers.at(x + step, y),
                 &down = receivers.at(x, y + step);
      if (!compare::on_smooth_surface(here, right, world) || !compare::on_smooth_surface(here, down, world))
        continue;
      const Vec3 a = right.position - here.position, b = down.position - here.position;
      out.right.at(x, y) = static_cast<float>(glm::length(a));
      out.down.at(x, y) = static_cast<float>(glm::length(b));
      out.area.at(x, y) = static_cast<float>(glm::length(glm::cross(a, b)));
      out.dot.at(x, y) = static_cast<float>(glm::dot(a, b));
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
  edge_steps_ = edge_steps();
  transitions_.reserve(static_cast<std::size_t>(frames));
}

// Whether every step of the way from receiver (x, y) over dx columns and then dy >= 0 rows stays on one surface.
bool TemporalBudget::are_connected(int x, int y, int dx, int dy) const {
  const ImageSize size = spacing_.area.size;
  const auto is_inside = [&](int column, int row) {
    return column >= 0 && column < size.width && row >= 0 && row < size.height &&
           spacing_.area.at(column, row) > 0.0f;
  };
  for (int k = 0; k < std::abs(dx); ++k)
    if (!is_inside(x + step_ * (dx > 0 ? k : -k - 1), y)) return false;
  for (int k = 0; k < dy; ++k)
    if (!is_inside(x + step_ * dx, y + step_ * k)) return false;
  return true;
}

// By receiver: 0 where a neighbour among its eight is on another surface, else 1 + the index in all_steps().
Image<std::uint8_t> TemporalBudget::edge_steps() const {
  Image<std::uint8_t> out(spacing_.area.size, 0);
  parallel_for(out.size.height, [&](int y) {
    for (int x = 0; x < out.size.width; x += step_) {
      if (y % step_ != 0 || !(spacing_.area.at(x, y) > 0.0f)) continue;
      const std::size_t index = steps_index(double{spacing_.right.at(x, y)}, double{spacing_.down.at(x, y)});
      const GridSteps& steps = all_steps()[index];
      if (std::ranges::all_of(steps,
                              [&](const GridStep& to) { return are_connected(x, y, to.columns, to.rows); }))
        out.at(x, y) = static_cast<std::uint8_t>(1 + index);
    }
  });
  return out;
}

// The length of the true shadow's edge that receiver (x, y) stands for, world units, by Crofton's formula. A crossing
// between it and one of its eight neighbours stands for the receiver's area over the neighbour's distance, weighted by half
// the angles that the neighbour's direction stands for. Right on average over the edge's direction, and within 4 % for each
// of them (2 % on square pixels). Where a neighbour is on another surface, the grid's two directions serve.
double TemporalBudget::edge_length(int x, int y) const {
  const std::size_t i = last_.counted.index(x, y);
  const double area = double{spacing_.area.data[i]};
  if (!(area > 0.0)) return 0.0;
  const std::uint8_t code = edge_steps_.data[i];
  const GridSteps& all = all_steps()[code != 0 ? code - 1 : square_steps];
  const std::span<const GridStep> steps(all.data(), code != 0 ? all.size() : 2);
  const auto crossing = [&](const GridStep& to) {
    const std::size_t other = last_.counted.index(x + step_ * to.columns, y + step_ * to.rows);
    const double change = double{last_.rungs[0].data[other]} - double{last_.rungs[0].data[i]};
    return last_.counted.data[other] != 0 ? std::abs(change) : 0.0;
  };
  if (std::ranges::all_of(steps, [&](const GridStep& to) { return crossing(to) == 0.0; })) return 0.0;
  const Vec2 right(double{spacing_.right.data[i]}, 0.0),
      down = Vec2(double{spacing_.dot.data[i]}, area) / right.x;
  const auto angles = angles_stood_for(steps, right, down);
  double length = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k)
    length += 0.5 * angles[k] * crossing(steps[k]) * area / glm::length(way_in_plane(steps[k], right, down));
  return length;
}

void TemporalBudget::add_row(int y, const RungFrame& next, TemporalSums& sums) {
  for (int x = 0; x < next.counted.size.width; x += step_) {
    const std::size_t i = next.counted.index(x, y);
    last_flips_.data[i] = 0;
    if (last_.counted.data[i] == 0 || next.counted.data[i] == 0) continue;
    ++sums.receivers;
    sums.edge_length += edge_length(x, y);
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

}  // namespace gnomon::studies

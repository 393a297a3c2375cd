#include "compare/ladder/penumbra.h"

#include <algorithm>

#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

constexpr int gradient_window = 3;    // half-width of the gradient's window, pixels
constexpr double walk_step = 0.5;     // of a walk, pixels
constexpr double walk_reach = 256.0;  // of a walk, pixels
constexpr double dark = 0.1, bright = 0.9;

// Where a walk came to a level of visibility: pixels, and world units on the receiver.
struct Crossing {
  Vec2 pixel;
  Vec3 world;
};

}  // namespace

class PenumbraMeasure::Walker {
 public:
  Walker(const Pixels& pixels, int first_row) : pixels_(pixels), first_row_(first_row) {}

  bool same_object(int x, int y, std::uint32_t own) const {
    const ImageSize& s = pixels_.objects.size;
    return x >= 0 && y >= 0 && x < s.width && y < s.height && pixels_.objects.at(x, y) == own;
  }

  /// The way on the picture that runs straight across the edge on the receiver, from shadow to light, unit
  /// length; zero where the window is balanced or its surroundings are another object's.
  Vec2 towards_light(int x, int y) const {
    const std::uint32_t own = pixels_.objects.at(x, y);
    Vec2 slope(0.0);
    for (int dy = -gradient_window; dy <= gradient_window; ++dy)
      for (int dx = -gradient_window; dx <= gradient_window; ++dx)
        if (same_object(x + dx, y + dy, own))
          slope += Vec2(dx, dy) * (2.0 * double{pixels_.truth.at(x + dx, y + dy)} - 1.0);
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      if (!same_object(x + dx, y + dy, own)) return Vec2(0.0);
    // The steepest way on the surface: its metric in pixels, inverted, times the slope in the picture.
    const Vec3 u = receiver(x + 1, y) - receiver(x - 1, y), v = receiver(x, y + 1) - receiver(x, y - 1);
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
    const Vec2 across(vv * slope.x - uv * slope.y, uu * slope.y - uv * slope.x);
    const double length = glm::length(across);
    return length > 0.0 ? across / length : Vec2(0.0);
  }

  struct Place {
    double visibility;
    Vec3 world;
  };

  /// Between pixel centres, bilinearly; none where one of the four is not of the object.
  std::optional<Place> place(const Image<float>& v, Vec2 p, std::uint32_t own) const {
    const int x = static_cast<int>(std::floor(p.x - 0.5)), below = static_cast<int>(std::floor(p.y - 0.5));
    const double fx = p.x - 0.5 - x, fy = p.y - 0.5 - below;
    const int y = below - first_row_;
    Place sum{0.0, Vec3(0.0)};
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const double weight = (i == 0 ? 1.0 - fx : fx) * (j == 0 ? 1.0 - fy : fy);
        if (weight == 0.0) continue;
        if (!same_object(x + i, y + j, own)) return std::nullopt;
        sum.visibility += weight * double{v.at(x + i, y + j)};
        sum.world += weight * receiver(x + i, y + j);
      }
    return sum;
  }

  /// Walks until the visibility has come to a level, from below when it rises to it.
  std::optional<Crossing> walk(const Image<float>& v, Vec2 from, Vec2 direction, std::uint32_t own,
                               double level, bool rising) const {
    std::optional<Place> before;
    for (double s = 0.0; s <= walk_reach; s += walk_step) {
      const Vec2 p = from + s * direction;
      const auto here = place(v, p, own);
      if (!here) return std::nullopt;
      if (rising ? here->visibility >= level : here->visibility <= level) {
        if (!before) return Crossing{p, here->world};
        const double back = (here->visibility - level) / (here->visibility - before->visibility);
        return Crossing{p - back * walk_step * direction, glm::mix(here->world, before->world, back)};
      }
      before = here;
    }
    return std::nullopt;
  }

  /// From the place where the visibility crosses one half.
  Width width(const Image<float>& v, Vec2 half, Vec2 normal, std::uint32_t own) const {
    Width out;
    const auto lit = walk(v, half, normal, own, bright, true);
    const auto shadow = walk(v, half, -normal, own, dark, false);
    if (lit && shadow) out.penumbra = glm::length(lit->world - shadow->world);
    if (!shadow) return out;
    // From where samples no longer make it lighter than that again by chance.
    const auto deep = walk(v, shadow->pixel, -normal, own, 0.5 * dark, false);
    if (!deep) return out;
    const auto end = walk(v, deep->pixel, -normal, own, dark, true);
    if (end) out.umbra = glm::length(shadow->world - end->world);
    return out;
  }

  /// Returns the drawn shadow's crossing of one half that is nearest to a place.
  std::optional<Vec2> nearest_crossing(const Image<float>& v, Vec2 from, Vec2 normal,
                                       std::uint32_t own) const {
    const auto lit = walk(v, from, normal, own, 0.5, true);
    const auto shadow = walk(v, from, -normal, own, 0.5, false);
    if (!lit && !shadow) return std::nullopt;
    if (!lit || !shadow) return lit ? lit->pixel : shadow->pixel;
    return glm::length(lit->pixel - from) > glm::length(shadow->pixel - from) ? lit->pixel : shadow->pixel;
  }

  void measure(int px, int py, int qx, int qy, std::vector<Sample>& out) const {
    const std::uint32_t own = pixels_.objects.at(px, py);
    const Image<float>& truth = pixels_.truth;
    if (own == no_id || !same_object(qx, qy, own) || (truth.at(px, py) > 0.5f) == (truth.at(qx, qy) > 0.5f))
      return;
    const Vec2 normal = towards_light(px, py);
    if (normal == Vec2(0.0)) return;
    const Vec2 middle(0.5 * (px + qx) + 0.5, 0.5 * (py + qy + 2 * first_row_) + 0.5);  // in the whole picture
    Sample sample{width(truth, middle, normal, own), {}};
    if (!sample.truth.penumbra) return;
    if (const auto crossing = nearest_crossing(pixels_.drawn, middle, normal, own))
      sample.drawn = width(pixels_.drawn, *crossing, normal, own);
    out.push_back(sample);
  }

 private:
  const Vec3& receiver(int x, int y) const { return pixels_.positions.at(x, y); }
  const Pixels& pixels_;
  int first_row_;
};

namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void count_one(float visibility, std::uint64_t& umbra, std::uint64_t& penumbra) {
  if (visibility <= 0.0f)
    ++umbra;
  else if (visibility < 1.0f)
    ++penumbra;
}

}  // namespace

void PenumbraMeasure::add_widths(const std::vector<Sample>& samples, PenumbraStats& out) {
  std::vector<double> truth, drawn, true_umbra, drawn_umbra;
  for (const Sample& s : samples) {
    if (s.truth.penumbra && s.drawn.penumbra) {
      truth.push_back(*s.truth.penumbra);
      drawn.push_back(*s.drawn.penumbra);
    }
    if (s.truth.umbra && s.drawn.umbra) {
      true_umbra.push_back(*s.truth.umbra);
      drawn_umbra.push_back(*s.drawn.umbra);
    }
  }
  out.edges = truth.size();
  out.umbra_edges = true_umbra.size();
  out.true_penumbra_world = median(std::move(truth));
  out.drawn_penumbra_world = median(std::move(drawn));
  out.true_umbra_world = median(std::move(true_umbra));
  out.drawn_umbra_world = median(std::move(drawn_umbra));
}

PenumbraMeasure::Pixels PenumbraMeasure::pixels_of(const LadderInput& in, const Image<float>& truth,
                                                   const Image<Label>& labels) {
  Pixels out{Image<Vec3>(labels.size), Image<std::uint32_t>(labels.size), truth, in.record().visibility};
  parallel_for(labels.data.size(), [&](std::size_t i) {
    out.positions.data[i] = in.traced.receiver.data[i].position;
    out.objects.data[i] =
        is_compared(labels.data[i]) ? in.world().object_of(in.drawn.primitive.data[i]) : no_id;
  });
  return out;
}

void PenumbraMeasure::keep(Pixels&& rows, int height) {
  if (rows.objects.size.height == height) {
    pixels_ = std::move(rows);
    return;
  }
  const int kept = std::min(penumbra_rows_kept, height);
  append_rows(pixels_.positions, rows.positions, kept);
  append_rows(pixels_.objects, rows.objects, kept);
  append_rows(pixels_.truth, rows.truth, kept);
  append_rows(pixels_.drawn, rows.drawn, kept);
}

void PenumbraMeasure::count(const Pixels& rows) {
  for (std::size_t i = 0; i < rows.objects.data.size(); ++i) {
    if (rows.objects.data[i] == no_id) continue;
    count_one(rows.truth.data[i], counts_.true_umbra_pixels, counts_.true_penumbra_pixels);
    count_one(rows.drawn.data[i], counts_.drawn_umbra_pixels, counts_.drawn_penumbra_pixels);
  }
}

void PenumbraMeasure::measure(const PictureRows& rows) {
  const Walker walker(pixels_, first_);
  std::vector<std::vector<Sample>> by_row(static_cast<std::size_t>(rows.count));
  parallel_for(rows.count, [&](int i) {
    const int y = rows.first - first_ + i;
    std::vector<Sample>& row = by_row[static_cast<std::size_t>(i)];
    for (int x = 0; x < pixels_.objects.size.width; ++x) {
      walker.measure(x, y, x + 1, y, row);
      walker.measure(x, y, x, y + 1, row);
    }
  });
  for (const auto& row : by_row) samples_.insert(samples_.end(), row.begin(), row.end());
}

void PenumbraMeasure::forget_above(int row) {
  const int dropped = row - first_;
  if (dropped < most_spare_rows) return;
  first_ = row;
  drop_rows(pixels_.positions, dropped);
  drop_rows(pixels_.objects, dropped);
  drop_rows(pixels_.truth, dropped);
  drop_rows(pixels_.drawn, dropped);
}

void PenumbraMeasure::add(const LadderInput& in, const Image<float>& truth, const Image<Label>& labels) {
  const int height = in.place.picture_height > 0 ? in.place.picture_height : labels.size.height;
  Pixels rows = pixels_of(in, truth, labels);
  count(rows);
  keep(std::move(rows), height);
  const int end = first_ + pixels_.objects.size.height;
  const int measurable = end == height ? end : std::max(measured_, end - penumbra_margin);
  measure({measured_, measurable - measured_});
  measured_ = measurable;
  if (measured_ == height)
    pixels_ = {};
  else
    forget_above(measured_ - penumbra_margin);
}

PenumbraStats PenumbraMeasure::stats() const {
  PenumbraStats out = counts_;
  add_widths(samples_, out);
  return out;
}

}  // namespace gnomon::compare

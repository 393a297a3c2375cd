#include "compare/penumbra.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace gnomon::compare {
namespace {

constexpr int window = 3;        // half-width of the gradient's window, pixels
constexpr double step = 0.5;     // of a walk, pixels
constexpr double reach = 256.0;  // of a walk, pixels
constexpr float dark = 0.1f, bright = 0.9f;

struct Width {
  std::optional<double> penumbra, umbra;  // world units; none where a walk left the object or the picture
};

struct Sample {
  Width truth, drawn;
};

class Walker {
 public:
  Walker(const LadderInput& in, const Image<float>& truth, const Image<Label>& labels)
      : in_(in), truth_(truth), labels_(labels) {}

  bool same_object(int x, int y, std::uint32_t own) const {
    const ImageSize& s = labels_.size;
    return x >= 0 && y >= 0 && x < s.width && y < s.height && is_compared(labels_.at(x, y)) &&
           object(labels_.index(x, y)) == own;
  }
  std::uint32_t object(std::size_t i) const { return in_.world.object_of(in_.drawn.primitive.data[i]); }

  /// From shadow to light, unit length; zero where the window is balanced.
  Vec2 towards_light(int x, int y) const {
    const std::uint32_t own = object(labels_.index(x, y));
    Vec2 sum(0.0);
    for (int dy = -window; dy <= window; ++dy)
      for (int dx = -window; dx <= window; ++dx)
        if (same_object(x + dx, y + dy, own)) sum += Vec2(dx, dy) * (2.0 * truth_.at(x + dx, y + dy) - 1.0);
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : Vec2(0.0);
  }

  /// Walks until stop(visibility); the pixel's place, or none.
  template <class Stop>
  std::optional<Vec2> walk(const Image<float>& v, Vec2 from, Vec2 direction, std::uint32_t own,
                           const Stop& stop) const {
    for (double s = 0.0; s <= reach; s += step) {
      const Vec2 p = from + s * direction;
      const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
      if (!same_object(x, y, own)) return std::nullopt;
      if (stop(v.at(x, y))) return p;
    }
    return std::nullopt;
  }

  double world_distance(Vec2 a, Vec2 b) const { return glm::length(receiver(a) - receiver(b)); }

  /// From the place where the visibility crosses one half.
  Width width(const Image<float>& v, Vec2 half, Vec2 normal, std::uint32_t own) const {
    Width out;
    const auto lit = walk(v, half, normal, own, [](float x) { return x >= bright; });
    const auto shadow = walk(v, half, -normal, own, [](float x) { return x <= dark; });
    if (lit && shadow) out.penumbra = world_distance(*lit, *shadow);
    if (!shadow) return out;
    const auto end = walk(v, *shadow, -normal, own, [](float x) { return x > dark; });
    if (end) out.umbra = world_distance(*shadow, *end);
    return out;
  }

  /// Of the drawn shadow, the crossing nearest to a place.
  std::optional<Vec2> nearest_crossing(const Image<float>& v, Vec2 from, Vec2 normal,
                                       std::uint32_t own) const {
    const auto lit = walk(v, from, normal, own, [](float x) { return x > 0.5f; });
    const auto shadow = walk(v, from, -normal, own, [](float x) { return x <= 0.5f; });
    if (!lit || !shadow) return lit ? lit : shadow;
    return glm::length(*lit - from) > glm::length(*shadow - from) ? lit : shadow;
  }

  void measure(int px, int py, int qx, int qy, std::vector<Sample>& out) const {
    if (!same_object(px, py, object(labels_.index(px, py)))) return;
    const std::uint32_t own = object(labels_.index(px, py));
    if (!same_object(qx, qy, own) || (truth_.at(px, py) > 0.5f) == (truth_.at(qx, qy) > 0.5f)) return;
    const Vec2 normal = towards_light(px, py);
    if (normal == Vec2(0.0)) return;
    const Vec2 middle(0.5 * (px + qx) + 0.5, 0.5 * (py + qy) + 0.5);
    Sample sample{width(truth_, middle, normal, own), {}};
    if (!sample.truth.penumbra) return;
    if (const auto crossing = nearest_crossing(in_.record.visibility, middle, normal, own))
      sample.drawn = width(in_.record.visibility, *crossing, normal, own);
    out.push_back(sample);
  }

 private:
  Vec3 receiver(Vec2 p) const {
    return in_.traced.receiver.at(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)))
        .position;
  }
  const LadderInput& in_;
  const Image<float>& truth_;
  const Image<Label>& labels_;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_widths(const std::vector<Sample>& samples, PenumbraStats& out) {
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

void count(float visibility, std::uint64_t& umbra, std::uint64_t& penumbra) {
  if (visibility <= 0.0f)
    ++umbra;
  else if (visibility < 1.0f)
    ++penumbra;
}

}  // namespace

PenumbraStats measure_penumbra(const LadderInput& in, const Image<float>& truth, const Image<Label>& labels) {
  const Walker walker(in, truth, labels);
  std::vector<std::vector<Sample>> rows(static_cast<std::size_t>(labels.size.height));
  tbb::parallel_for(0, labels.size.height, [&](int y) {
    for (int x = 0; x < labels.size.width; ++x) {
      if (!is_compared(labels.at(x, y))) continue;
      walker.measure(x, y, x + 1, y, rows[static_cast<std::size_t>(y)]);
      walker.measure(x, y, x, y + 1, rows[static_cast<std::size_t>(y)]);
    }
  });
  std::vector<Sample> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  PenumbraStats out;
  add_widths(all, out);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (!is_compared(labels.data[i])) continue;
    count(truth.data[i], out.true_umbra_pixels, out.true_penumbra_pixels);
    count(in.record.visibility.data[i], out.drawn_umbra_pixels, out.drawn_penumbra_pixels);
  }
  return out;
}

}  // namespace gnomon::compare

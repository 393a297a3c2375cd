#include "compare/metrics/edges.h"

#include "scene/base/parallel.h"

namespace gnomon::compare {

void EdgeSums::add(double moved_texels, double offset_pixels, double moved_world) {
  ++edges;
  texels += moved_texels;
  texels_absolute += std::abs(moved_texels);
  world += moved_world;
  world_absolute += std::abs(moved_world);
  world_squared += moved_world * moved_world;
  texels_squared += moved_texels * moved_texels;
  pixels_squared += offset_pixels * offset_pixels;
}

void EdgeSums::add(const EdgeSums& other) {
  edges += other.edges;
  texels += other.texels;
  texels_squared += other.texels_squared;
  pixels_squared += other.pixels_squared;
  texels_absolute += other.texels_absolute;
  world += other.world;
  world_absolute += other.world_absolute;
  world_squared += other.world_squared;
}

EdgeStats EdgeSums::stats() const {
  EdgeStats out;
  out.edges = edges;
  if (edges == 0) return out;
  const auto n = static_cast<double>(edges);
  out.mean_texels = texels / n;
  out.rms_texels = std::sqrt(texels_squared / n);
  out.rms_pixels = std::sqrt(pixels_squared / n);
  out.mean_absolute_texels = texels_absolute / n;
  out.mean_world = world / n;
  out.mean_absolute_world = world_absolute / n;
  out.rms_world = std::sqrt(world_squared / n);
  return out;
}

namespace {

constexpr int window = 3;       // half-width of the gradient's window, pixels
constexpr double step = 0.5;    // of the walk, pixels
constexpr double reach = 64.0;  // of the walk, pixels

// The way of a walk from an edge to the pixel where it ended.
struct Moved {
  double texels = 0.0, world = 0.0;
};

struct EdgeWalk : EdgeInput {
  explicit EdgeWalk(const EdgeInput& input) : EdgeInput(input) {}

  bool usable(int x, int y) const {
    const ImageSize& s = labels.size;
    return x >= 0 && y >= 0 && x < s.width && y < s.height && is_compared(labels.at(x, y));
  }
  bool lit(const Image<float>& image, std::size_t i) const { return image.data[i] > 0.5f; }
  std::uint32_t object(std::size_t i) const { return world.object_of(drawn.primitive.data[i]); }

  // From shadow to light, unit length; zero where the window is balanced.
  Vec2 towards_light(int x, int y) const {
    Vec2 sum(0.0);
    const std::uint32_t own = object(labels.index(x, y));
    for (int dy = -window; dy <= window; ++dy) {
      for (int dx = -window; dx <= window; ++dx) {
        if (!usable(x + dx, y + dy)) continue;
        const std::size_t i = labels.index(x + dx, y + dy);
        if (object(i) == own) sum += Vec2(dx, dy) * (lit(truth, i) ? 1.0 : -1.0);
      }
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : Vec2(0.0);
  }

  // Walks from the edge into one side of it, as far as that side goes: visit(pixel, offset in pixels) until
  // it returns true.
  template <class Visit>
  void follow(Vec2 from, Vec2 direction, bool truly_lit, std::uint32_t own, const Visit& visit) const {
    for (double s = 0.5 * step; s <= reach; s += step) {
      const Vec2 p = from + s * direction;
      const int x = static_cast<int>(std::floor(p.x));
      const int y = static_cast<int>(std::floor(p.y)) - first_row;
      if (!usable(x, y)) return;
      const std::size_t i = labels.index(x, y);
      if (object(i) != own || lit(truth, i) != truly_lit) return;
      if (visit(i, s - 0.5 * step)) return;
    }
  }

  // Into the side that is drawn wrong there, until it is drawn right again; the offset in pixels, or
  // infinity. `end` is the pixel where the walk ended.
  double walk(Vec2 from, Vec2 direction, bool expected_lit, std::uint32_t own, std::size_t& end) const {
    double found = infinity;
    follow(from, direction, expected_lit, own, [&](std::size_t i, double offset) {
      end = i;
      const bool right = lit(record.visibility, i) == expected_lit;
      if (right) found = offset;
      return right;
    });
    return found;
  }

  // In the whole picture, as all places of a walk are, so that they are rounded alike wherever it is cut.
  Vec2 middle_of(int px, int py, int qx, int qy) const {
    return {0.5 * (px + qx) + 0.5, 0.5 * (py + qy + 2 * first_row) + 0.5};
  }
  // Where a true edge between two pixels lies: in the picture, on the map, in the world.
  struct Start {
    Vec2 middle, uv;
    Vec3 position;
  };
  Start start_at(int px, int py, int qx, int qy) const {
    return {middle_of(px, py, qx, qy),
            0.5 * (Vec2(record.texel_uv.at(px, py)) + Vec2(record.texel_uv.at(qx, qy))),
            0.5 * (receivers.at(px, py).position + receivers.at(qx, qy).position)};
  }
  // Map positions and receivers are those of pixel centres, while a walk ends where it enters a pixel. What is left is the
  // way to the pixel's centre, scaled to the way that was walked.
  Moved moved(const Start& start, std::size_t end, double offset) const {
    const auto width = static_cast<std::size_t>(labels.size.width);
    const std::size_t column = end % width, row = end / width + static_cast<std::size_t>(first_row);
    const Vec2 centre(double(column) + 0.5, double(row) + 0.5);
    const double scale = offset / glm::length(centre - start.middle);
    return {glm::length(Vec2(record.texel_uv.data[end]) - start.uv) * scale,
            glm::length(receivers.data[end].position - start.position) * scale};
  }

  // A true edge between pixels p (shadowed) and q (lit), and where the drawn one lies: along `normal`, in
  // pixels, infinite where it was not found.
  struct Found {
    Start start;
    Vec2 normal{0.0};
    double offset = infinity;
    std::size_t end = 0;
  };
  Found find_drawn(int px, int py, int qx, int qy) const {
    const std::size_t p = labels.index(px, py);
    Found found{start_at(px, py, qx, qy), towards_light(px, py), infinity, p};
    if (found.normal == Vec2(0.0)) return found;
    const std::uint32_t own = object(p);
    found.offset = walk(found.start.middle, found.normal, true, own, found.end);
    if (found.offset == 0.0) found.offset = -walk(found.start.middle, -found.normal, false, own, found.end);
    return found;
  }
  void measure(int px, int py, int qx, int qy, EdgeSums& sums) const {
    const Found found = find_drawn(px, py, qx, qy);
    if (!std::isfinite(found.offset)) return;
    const Moved way = moved(found.start, found.end, std::abs(found.offset));
    sums.add(std::copysign(way.texels, found.offset), found.offset, std::copysign(way.world, found.offset));
  }

  // act(shadowed pixel, lit pixel) where a true edge runs between two neighbours.
  template <class Act>
  void at_edge(int px, int py, int qx, int qy, const Act& act) const {
    if (!usable(px, py) || !usable(qx, qy)) return;
    const std::size_t p = labels.index(px, py);
    const std::size_t q = labels.index(qx, qy);
    if (lit(truth, p) == lit(truth, q) || object(p) != object(q)) return;
    if (record.face.data[p] != record.face.data[q]) return;
    if (lit(truth, p))
      act(qx, qy, px, py);
    else
      act(px, py, qx, qy);
  }
  template <class Act>
  void at_edges_of_row(int y, const Act& act) const {
    for (int x = 0; x < labels.size.width; ++x) {
      at_edge(x, y, x + 1, y, act);
      at_edge(x, y, x, y + 1, act);
    }
  }
};

}  // namespace

void add_edges(const EdgeInput& input, const PictureRows& rows, EdgeSums& total) {
  const EdgeWalk walk(input);
  std::vector<EdgeSums> by_row(static_cast<std::size_t>(rows.count));
  parallel_for(rows.count, [&](int i) {
    EdgeSums& sums = by_row[static_cast<std::size_t>(i)];
    walk.at_edges_of_row(rows.first + i,
                         [&](int px, int py, int qx, int qy) { walk.measure(px, py, qx, qy, sums); });
  });
  for (const EdgeSums& row : by_row) total.add(row);
}

Image<float> edge_displacement_rows(const EdgeInput& input, const PictureRows& rows) {
  const EdgeWalk walk(input);
  const ImageSize size{input.labels.size.width, rows.count};
  const std::size_t first = input.labels.index(0, rows.first);
  Image<float> map(size, std::numeric_limits<float>::quiet_NaN());
  struct Stroke {
    std::uint32_t pixel;  ///< of the map
    float texels;
  };
  const auto add_strokes = [&](int px, int py, int qx, int qy, std::vector<Stroke>& strokes) {
    const EdgeWalk::Found found = walk.find_drawn(px, py, qx, qy);
    if (!std::isfinite(found.offset)) return;
    const std::size_t p = input.labels.index(px, py);
    const double texels = walk.moved(found.start, found.end, std::abs(found.offset)).texels;
    const auto value = static_cast<float>(std::copysign(texels, found.offset));
    const auto add = [&](std::size_t pixel) {
      if (pixel >= first && pixel - first < map.data.size())
        strokes.push_back({static_cast<std::uint32_t>(pixel - first), value});
    };
    add(p), add(input.labels.index(qx, qy));
    const bool outwards = found.offset > 0.0;
    walk.follow(found.start.middle, outwards ? found.normal : -found.normal, outwards, walk.object(p),
                [&](std::size_t pixel, double offset) {
                  if (offset < std::abs(found.offset)) add(pixel);
                  return offset >= std::abs(found.offset);
                });
  };
  constexpr int beside = static_cast<int>(reach) + 2;  // rows whose walks may come into these
  const int begin = std::max(0, rows.first - beside);
  const int end = std::min(rows.end() + beside, input.labels.size.height);
  std::vector<std::vector<Stroke>> strokes(static_cast<std::size_t>(end - begin));
  parallel_for(strokes.size(), [&](std::size_t row) {
    std::vector<Stroke>& own = strokes[row];
    walk.at_edges_of_row(begin + static_cast<int>(row),
                         [&](int px, int py, int qx, int qy) { add_strokes(px, py, qx, qy, own); });
  });
  for (const std::vector<Stroke>& row : strokes)  // one after the other: of equal ones the first stays
    for (const auto& [pixel, texels] : row)
      if (float& there = map.data[pixel]; std::isnan(there) || std::abs(there) < std::abs(texels))
        there = texels;
  return map;
}

EdgePaths::EdgePaths(const EdgeInput& input) {
  const EdgeWalk walk(input);
  const raster::LightRecord& record = input.record;
  const Image<Label>& labels = input.labels;
  const auto count = [&] { return static_cast<std::uint32_t>(stops_.size()); };
  const auto add_edge = [&](int px, int py, int qx, int qy) {
    const Vec2 normal = walk.towards_light(px, py);
    if (normal == Vec2(0.0)) return;
    const std::uint32_t own = walk.object(labels.index(px, py));
    const EdgeWalk::Start start = walk.start_at(px, py, qx, qy);
    const auto add_stop = [&](float gap, double offset, std::size_t pixel) {
      const Moved way = walk.moved(start, pixel, offset);
      stops_.push_back({gap, offset, way.texels, way.world});
    };
    Edge edge{count(), 0, 0};
    // Only a pixel whose gap undercuts (on the shadowed side: exceeds) all before it can end a walk.
    float record_gap = std::numeric_limits<float>::infinity();
    walk.follow(start.middle, normal, true, own, [&](std::size_t i, double offset) {
      const float gap = record.gap.data[i];
      if (gap < record_gap || (std::isnan(gap) && record_gap > -std::numeric_limits<float>::infinity())) {
        // NaN exceeds no bias: drawn lit at every one.
        record_gap = std::isnan(gap) ? -std::numeric_limits<float>::infinity() : gap;
        add_stop(record_gap, offset, i);
      }
      return false;
    });
    edge.turn = count();
    record_gap = -std::numeric_limits<float>::infinity();
    walk.follow(start.middle, -normal, false, own, [&](std::size_t i, double offset) {
      const float gap = record.gap.data[i];
      if (gap > record_gap) add_stop(record_gap = gap, offset, i);
      return false;
    });
    edge.end = count();
    edges_.push_back(edge);
  };
  for (int y = 0; y < labels.size.height; ++y) {
    walk.at_edges_of_row(y, add_edge);
    row_ends_.push_back(static_cast<std::uint32_t>(edges_.size()));
  }
}

EdgeStats EdgePaths::at(float bias) const {
  EdgeSums all;
  std::size_t next = 0;
  for (const std::uint32_t row_end : row_ends_) {
    EdgeSums row;
    for (; next < row_end; ++next) {
      const Edge& edge = edges_[next];
      const auto begin = stops_.begin();
      const auto lit = std::find_if(begin + edge.first, begin + edge.turn,
                                    [bias](const Stop& stop) { return !(stop.gap > bias); });
      if (lit == begin + edge.turn) continue;
      if (lit->offset_pixels != 0.0) {
        row.add(lit->moved_texels, lit->offset_pixels, lit->moved_world);
        continue;
      }
      const auto dark = std::find_if(begin + edge.turn, begin + edge.end,
                                     [bias](const Stop& stop) { return stop.gap > bias; });
      if (dark == begin + edge.end) continue;
      const bool moved = dark->offset_pixels != 0.0;
      row.add(moved ? -dark->moved_texels : -0.0, -dark->offset_pixels, moved ? -dark->moved_world : -0.0);
    }
    all.add(row);
  }
  return all.stats();
}

std::optional<double> detachment_distance(const raytrace::Tracer& tracer, const Light& light,
                                          const raytrace::SurfacePoint& x) {
  const auto occluder = tracer.nearest_occluder(x, light);
  if (!occluder) return std::nullopt;
  return occluder->t * glm::length(glm::cross(light_at(light, x.position).to_light, x.normal));
}

void DetachmentSum::add(double distance) {
  ++sums_.pixels;
  sums_.mean_world += distance;
  sums_.rms_world += distance * distance;
  sums_.max_world = std::max(sums_.max_world, distance);
}

Detachment DetachmentSum::stats() const {
  Detachment out = sums_;
  if (out.pixels == 0) return out;
  out.mean_world /= static_cast<double>(out.pixels);
  out.rms_world = std::sqrt(out.rms_world / static_cast<double>(out.pixels));
  return out;
}

Image<float> detachment_map(const raytrace::Tracer& tracer, const Light& light,
                            const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                            const std::array<Image<float>, rung_count>& rungs) {
  Image<float> map(labels.size, std::numeric_limits<float>::quiet_NaN());
  parallel_for(labels.data.size(), [&](std::size_t i) {
    const auto levels = rungs_at(rungs, i);
    if (!is_detached(labels.data[i], levels[6] < levels[0]) || !is_wrong(levels)) return;
    if (const auto distance = detachment_distance(tracer, light, receivers.data[i]))
      map.data[i] = static_cast<float>(*distance);
  });
  return map;
}

Detachment measure_detachment(const Image<float>& map) {
  DetachmentSum sum;
  for (const float distance : map.data)
    if (!std::isnan(distance)) sum.add(double{distance});
  return sum.stats();
}

}  // namespace gnomon::compare

#include "judge/caster_bias.h"

#include <fmt/core.h>

#include <algorithm>
#include <span>

#include "compare/result/number_text.h"
#include "judge/stored_depths.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using raytrace::TexelKey;

constexpr std::size_t too_few_texels = 64;  ///< tell no bias
constexpr double nearly_every = 0.75;       ///< of the texels looked at, the rest being edges
constexpr double few_as_they_are = 0.5;     ///< hold a depth of the scene
/// A rule of two numbers has to explain this much more than one of one: most texels may be of one floor.
constexpr double much_of_rest = 0.6, few_more = 16.0;
/// What a stored number may be off: floats, the rasterizer's places of vertices (texels), and a share of the offset.
constexpr double of_arithmetic = 0x1p-21, of_places = 1.0 / 32.0, of_offset = 0.02;

double away_from_light(const LightView& view) {
  return view.reversed ? -1.0 : 1.0;
}

double clamped(double offset, double clamp) {
  if (clamp > 0.0) return std::min(offset, clamp);
  return clamp < 0.0 ? std::max(offset, clamp) : offset;
}

/// A surface in a texel, as the map's own numbers.
struct Held {
  double depth = 0.0, stored = 0.0, slope = 0.0;
  double step = 0.0;    ///< of the map's format there
  double cosine = 1.0;  ///< of the angle between its normal and the light
};

/// How much later a ray meets a plane that was moved against its normal.
double against_normal(const CapturedCasterBias& bias, double cosine) {
  constexpr double grazing = 0.02;  // below it the outline moves, and not the depth
  if (bias.normal_offset_world == 0.0) return 0.0;
  return bias.normal_offset_world * angle_factor(bias.normal_offset_angle, cosine) /
         std::max(cosine, grazing);
}

class FaceReader {
 public:
  FaceReader(const StoredDepths& depths, const LightView& view, int face)
      : depths_(depths), view_(view), face_(face) {}

  std::optional<Held> held(const SurfaceOnRay& surface, TexelKey key) const {
    const LightFace& face = view_.face(face_);
    if (!(surface.depth > face.near_depth && surface.depth < face.far_depth)) return std::nullopt;
    if (!std::isfinite(surface.stored_slope)) return std::nullopt;
    return Held{surface.depth, stored_from_depth(view_, face_, key.row() + 0.5, surface.depth),
                surface.stored_slope, depths_.step(key, surface.depth), surface.cosine};
  }
  double moved(const Held& held, TexelKey key, const CapturedCasterBias& bias) const {
    double stored = held.stored;
    if (const double by = bias.constant_world + against_normal(bias, held.cosine); by != 0.0)
      stored = stored_from_depth(view_, face_, key.row() + 0.5, held.depth + by * along(key));
    const double offset = clamped(bias.constant + bias.slope * held.slope, bias.clamp);
    return std::clamp(stored + away_from_light(view_) * offset, 0.0, 1.0);
  }
  /// How much farther along the axis a place lies that is one farther along the texel's ray.
  double along(TexelKey key) const {
    return glm::dot(texel_ray(view_, face_, key.column() + 0.5, key.row() + 0.5).direction,
                    view_.face(face_).forward);
  }
  double slack(const Held& held, double offset) const {
    return 1.5 * held.step + of_arithmetic + of_places * held.slope + of_offset * std::abs(offset);
  }

 private:
  const StoredDepths& depths_;
  const LightView& view_;
  int face_;
};

/// A texel whose first surface is known, and by how much the map's number is off it.
struct Point {
  TexelKey key;
  Held held;
  std::vector<Held>
      behind{};  ///< further surfaces on the ray, of which the bias may leave one nearer than the first
  double stored = 0.0;
  bool empty = false;
  double off = 0.0;       ///< stored numbers, away from the light
  double world = 0.0;     ///< the same along the ray
  bool as_it_is = false;  ///< the map holds one of the scene's surfaces there, unmoved
};

std::vector<Point> look_at(const StoredDepths& depths, const FaceReader& reader, const raster::ShadowMap& map,
                           int face, bool backs) {
  const LightView& view = map.view;
  const std::vector<TexelKey> keys = sampled_texels(view, face);
  std::vector<std::optional<Point>> points(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) {
    const TexelKey key = keys[i];
    const std::vector<SurfaceOnRay> all = depths.all(key, 4);
    const auto surface =
        std::find_if(all.begin(), all.end(), [backs](const SurfaceOnRay& s) { return !backs || !s.front; });
    if (surface == all.end()) return;
    const auto held = reader.held(*surface, key);
    if (!held) return;
    const double stored = depths.stored(key);
    const auto holds = [&](const SurfaceOnRay& s) {
      const auto one = reader.held(s, key);
      return one && std::abs(stored - one->stored) <= reader.slack(*one, 0.0);
    };
    std::vector<Held> behind;
    for (auto next = surface + 1; next != all.end(); ++next)
      if (const auto one = reader.held(*next, key); one && (!backs || !next->front)) behind.push_back(*one);
    const bool empty = depths.is_empty(key);
    points[i] = Point{key,
                      *held,
                      std::move(behind),
                      stored,
                      empty,
                      away_from_light(view) * (stored - held->stored),
                      empty ? 0.0 : (depths.depth(key) - held->depth) / reader.along(key),
                      !empty && std::any_of(all.begin(), all.end(), holds)};
  });
  std::vector<Point> out;
  for (const auto& point : points)
    if (point) out.push_back(*point);
  return out;
}

template <class Value>
double median_of(const std::vector<Point>& points, const Value& value) {
  std::vector<double> values;
  for (const Point& p : points)
    if (!p.empty) values.push_back(value(p));
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Whether the map holds the first surface, moved: others behind it have another slope, and tell nothing of a line.
bool is_first_moved(const FaceReader& reader, const LightView& view, const Point& p,
                    const CapturedCasterBias& bias) {
  const double offset = away_from_light(view) * (reader.moved(p.held, p.key, bias) - p.held.stored);
  return std::abs(p.off - offset) <= reader.slack(p.held, offset);
}

/// The map holds the nearest of the surfaces once they are moved, or of a renderer that casts rays the first one; one at the far
/// end is nothing drawn.
bool is_explained(const FaceReader& reader, const LightView& view, const Point& p,
                  const CapturedCasterBias& bias) {
  const auto is_stored = [&](const Held& held, double moved) {
    return std::abs(p.stored - moved) <= reader.slack(held, moved - held.stored);
  };
  const Held* nearest = &p.held;
  double moved = reader.moved(p.held, p.key, bias);
  if (is_stored(p.held, moved)) return true;
  for (const Held& held : p.behind)
    if (const double next = reader.moved(held, p.key, bias); away_from_light(view) * (next - moved) < 0.0)
      nearest = &held, moved = next;
  return is_stored(*nearest, moved);
}

/// The share of the points that the rule explains; 0 where that is no more than `at_least`.
double explained(const FaceReader& reader, const LightView& view, const std::vector<Point>& points,
                 const CapturedCasterBias& bias, double at_least) {
  const double most_left = (1.0 - at_least) * double(points.size());
  double left = 0.0;
  for (const Point& p : points)
    if (!is_explained(reader, view, p, bias) && ++left >= most_left) return 0.0;
  return 1.0 - left / double(points.size());
}

/// Points that tell a line: some all over the surfaces, and some of each of the slopes that most texels have, however few have a
/// second one. Of those the middle may be hidden behind what lies after it, so that two beside it are taken, too.
std::vector<Point> telling_points(std::vector<Point> points) {
  std::erase_if(points, [](const Point& p) { return p.empty; });
  if (points.empty()) return {};
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.held.slope < b.held.slope; });
  constexpr std::size_t places = 24, most_slopes = 8;
  std::vector<Point> out;
  for (std::size_t i = 0; i < places; ++i) out.push_back(points[i * (points.size() - 1) / (places - 1)]);
  using Group = std::span<Point>;
  std::vector<Group> groups;
  for (std::size_t first = 0, i = 1; i <= points.size(); ++i) {
    if (i < points.size() && points[i].held.slope <= 1.05 * points[first].held.slope) continue;
    groups.push_back(Group(points).subspan(first, i - first)), first = i;
  }
  std::sort(groups.begin(), groups.end(), [](Group a, Group b) { return a.size() > b.size(); });
  groups.resize(std::min(groups.size(), most_slopes));
  for (const Group& group : groups) {
    std::sort(group.begin(), group.end(), [](const Point& a, const Point& b) { return a.off < b.off; });
    for (const std::size_t sixth : {1U, 3U, 5U}) out.push_back(group[group.size() * sixth / 6]);
  }
  std::sort(out.begin(), out.end(),
            [](const Point& a, const Point& b) { return a.held.slope < b.held.slope; });
  return out;
}

/// Lines off = constant + slope * m through two of the telling points each.
std::vector<CapturedCasterBias> lines_through(const std::vector<Point>& points) {
  const std::vector<Point> telling = telling_points(points);
  std::vector<CapturedCasterBias> lines;
  for (std::size_t i = 0; i < telling.size(); ++i)
    for (std::size_t j = i + 1; j < telling.size(); ++j) {
      const Point &a = telling[i], &b = telling[j];
      const double spread = b.held.slope - a.held.slope;
      if (!(spread > 0.05 * b.held.slope)) continue;
      const double slope = (b.off - a.off) / spread;
      lines.push_back({.constant = a.off - slope * a.held.slope, .slope = slope});
    }
  return lines;
}

/// Of the points that the line explains, the constant and slope with the least squares.
CapturedCasterBias refined(const FaceReader& reader, const LightView& view, const std::vector<Point>& points,
                           const CapturedCasterBias& line) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Point& p : points) {
    if (p.empty || !is_first_moved(reader, view, p, line)) continue;
    n += 1.0, x += p.held.slope, y += p.off, xx += p.held.slope * p.held.slope, xy += p.held.slope * p.off;
  }
  const double spread = n * xx - x * x;
  if (!(spread > 0.0)) return line;
  const double slope = (n * xy - x * y) / spread;
  return {.constant = (y - slope * x) / n, .slope = slope};
}

struct Explained {
  CapturedCasterBias rule;
  double share = 0.0;
};

Explained best_of(const FaceReader& reader, const LightView& view, const std::vector<Point>& points,
                  const std::vector<CapturedCasterBias>& rules, Explained best = {}) {
  for (const CapturedCasterBias& rule : rules)
    if (const double share = explained(reader, view, points, rule, best.share); share > best.share)
      best = {rule, share};
  return best;
}

/// The rule that explains the points: a constant in stored numbers or along the ray, a slope, or a constant and a slope.
std::optional<CapturedCasterBias> find_rule(const FaceReader& reader, const LightView& view,
                                            const std::vector<Point>& points) {
  if (points.size() < too_few_texels) return std::nullopt;
  const auto unmoved = std::count_if(points.begin(), points.end(), [](const Point& p) { return p.as_it_is; });
  if (double(unmoved) >= few_as_they_are * double(points.size())) return std::nullopt;
  const Explained one = best_of(
      reader, view, points,
      {{.constant = median_of(points, [](const Point& p) { return p.off; })},
       {.constant_world = median_of(points, [](const Point& p) { return p.world; })},
       {.slope = median_of(points,
                           [](const Point& p) { return p.held.slope > 0.0 ? p.off / p.held.slope : 0.0; })}});
  const Explained two = best_of(reader, view, points, lines_through(points), one);
  const double gain = (two.share - one.share) * double(points.size());
  if (two.share >= nearly_every && gain >= few_more && 1.0 - two.share < much_of_rest * (1.0 - one.share))
    return refined(reader, view, points, two.rule);
  return one.share >= nearly_every ? std::optional(one.rule) : std::nullopt;
}

std::optional<CapturedCasterBias> find_bias(const StoredDepths& depths, const raster::ShadowMap& map,
                                            int face) {
  const FaceReader reader(depths, map.view, face);
  for (const bool backs : {false, true})
    if (const auto rule = find_rule(reader, map.view, look_at(depths, reader, map, face, backs))) return rule;
  return std::nullopt;
}

/// What the map would store without the bias, the slope of the surface that it holds, and its angle to the light.
struct Unmoved {
  double stored = 0.0, slope = 0.0, cosine = 1.0;
  explicit Unmoved(const Held& held) : Unmoved(held, held.stored) {}
  Unmoved(const Held& held, double number) : stored(number), slope(held.slope), cosine(held.cosine) {}
};

class TexelMender {
 public:
  TexelMender(const StoredDepths& depths, const LightView& view, int face, const CapturedCasterBias& bias)
      : depths_(depths), view_(view), face_(face), reader_(depths, view, face), bias_(bias) {}

  /// None where the map holds no surface of the scene so moved.
  std::optional<Unmoved> unmoved(TexelKey key) const {
    const double stored = depths_.stored(key);
    if (const auto first = depths_.first(key))
      if (const auto held = reader_.held(*first, key); held && is_held(*held, key, stored))
        return Unmoved(*held, stored - offset(*held, key));
    const auto first = depths_.first(key);
    if (const auto held = first ? outline_moved(*first, key) : std::nullopt) return Unmoved(*held);
    return among_all(key, stored);
  }
  /// Of an empty texel: the first surface, where the bias moves that to the far end, whose number is that of nothing drawn.
  std::optional<Unmoved> pushed_out(TexelKey key) const {
    const auto first = depths_.first(key);
    if (!first) return std::nullopt;
    if (const auto held = outline_moved(*first, key)) return Unmoved(*held);
    const auto held = reader_.held(*first, key);
    if (!held || behind(*held, key, view_.reversed ? 0.0 : 1.0) < -slack(*held, key)) return std::nullopt;
    return Unmoved(*held);
  }

 private:
  double offset(const Held& held, TexelKey key) const {
    return reader_.moved(held, key, bias_) - held.stored;
  }
  /// How far behind the map's number a surface lies once it is moved.
  double behind(const Held& held, TexelKey key, double stored) const {
    return away_from_light(view_) * (reader_.moved(held, key, bias_) - stored);
  }
  double slack(const Held& held, TexelKey key) const {
    return reader_.slack(held, offset(held, key)) + 0.5 * held.slope;
  }
  bool is_held(const Held& held, TexelKey key, double stored) const {
    return std::abs(behind(held, key, stored)) <= slack(held, key);
  }
  /// A surface that the bias pushed behind the one that the map holds would be there without it.
  std::optional<Unmoved> among_all(TexelKey key, double stored) const {
    std::optional<Held> holder, nearest;
    double least = infinity;
    for (const SurfaceOnRay& surface : depths_.all(key)) {
      const auto held = reader_.held(surface, key);
      if (!held) continue;
      const double off = behind(*held, key, stored);
      if (std::abs(off) <= slack(*held, key) && std::abs(off) < least) holder = held, least = std::abs(off);
      if (!nearest && off >= -slack(*held, key)) nearest = held;
    }
    if (!holder) return std::nullopt;
    if (nearest->depth == holder->depth) return Unmoved(*holder, stored - offset(*holder, key));
    return Unmoved(*holder, nearest->stored);
  }
  /// What lies so near to its outline that the offset against its normals takes it off this ray.
  std::optional<Held> outline_moved(const SurfaceOnRay& first, TexelKey key) const {
    const double by = std::abs(bias_.normal_offset_world);
    if (by == 0.0) return std::nullopt;
    const auto at = [&](const Vec2& off) {
      const Ray ray = depths_.ray(key, off);
      const double t =
          (first.depth - glm::dot(ray.origin - view_.origin, forward())) / glm::dot(ray.direction, forward());
      return ray.at(t);
    };
    const double texels = by / glm::distance(at(Vec2(0.0)), at(Vec2(1.0, 0.0)));
    for (const Vec2 way : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1), Vec2(0.7, 0.7), Vec2(-0.7, 0.7),
                           Vec2(0.7, -0.7), Vec2(-0.7, -0.7)}) {
      const Vec2 off = (texels + 0.5) * way;
      const auto beside = depths_.first(key, off);
      if (!beside || beside->depth > first.depth + by + 2.0 * glm::length(off) * first.across)
        return reader_.held(first, key);
    }
    return std::nullopt;
  }
  Vec3 forward() const { return view_.face(face_).forward; }

  const StoredDepths& depths_;
  const LightView& view_;
  int face_;
  FaceReader reader_;
  const CapturedCasterBias& bias_;
};

}  // namespace

CasterBiases take_out_caster_bias(const FrameInput& in, const std::vector<CapturedCasterBias>& given,
                                  raster::LightRecord& record) {
  const TimedStage stage("casters' bias");
  raster::ShadowMap& map = record.map;
  const StoredDepths depths(in, record);
  CasterBiases out;
  out.faces = given;
  const auto moves = [](const CapturedCasterBias& bias) { return bias.moves(); };
  if (std::none_of(given.begin(), given.end(), moves)) {
    // Averages lie behind the nearest of what they are taken of (Jensen's inequality), which no caster's bias makes.
    if (captured_test(record).reads() == CapturedTest::Reads::averages) return {};
    out.faces.assign(static_cast<std::size_t>(map.view.face_count), {});
    for (int face = 0; face < map.view.face_count; ++face)
      if (const auto bias = find_bias(depths, map, face))
        out.faces[static_cast<std::size_t>(face)] = *bias, out.found = true;
    if (!out.found) return {};
  }
  std::vector<float> unbiased = map.depth;
  out.slopes.assign(map.depth.size(), 0.0f);
  out.cosines.assign(map.depth.size(), 1.0f);
  const auto n = static_cast<std::size_t>(map.view.size);
  parallel_for(unbiased.size() / n, [&](std::size_t line) {
    const int face = static_cast<int>(line / n), row = static_cast<int>(line % n);
    const CapturedCasterBias& bias = out.faces[static_cast<std::size_t>(face)];
    const TexelMender mender(depths, map.view, face, bias);
    for (int column = 0; column < map.view.size; ++column) {
      const TexelKey key = TexelKey::pack(face, column, row);
      const bool empty = depths.is_empty(key);
      const std::size_t i = map.texel_index(face, column, row);
      const auto unmoved = empty ? mender.pushed_out(key) : mender.unmoved(key);
      if (empty && !unmoved) continue;
      const double constant = away_from_light(map.view) * clamped(bias.constant, bias.clamp);
      const double stored = unmoved ? unmoved->stored : double{map.depth[i]} - constant;
      unbiased[i] = static_cast<float>(std::clamp(stored, 0.0, 1.0));
      if (unmoved) out.slopes[i] = static_cast<float>(unmoved->slope);
      if (unmoved) out.cosines[i] = static_cast<float>(unmoved->cosine);
    }
  });
  map.unbiased = std::move(unbiased);
  return out;
}

std::vector<float> with_caster_bias(const raster::ShadowMap& map, const CasterBiases& casters,
                                    const CapturedCasterBias& instead) {
  const LightView& view = map.view;
  std::vector<float> out = map.depth;
  const auto n = static_cast<std::size_t>(view.size);
  parallel_for(out.size() / n, [&](std::size_t line) {
    const int face = static_cast<int>(line / n), row = static_cast<int>(line % n);
    const CapturedCasterBias& bias = casters.faces[static_cast<std::size_t>(face)];
    if (!bias.moves()) return;
    for (int column = 0; column < view.size; ++column) {
      const std::size_t i = map.texel_index(face, column, row);
      if (!holds_caster(view, double{map.depth[i]})) continue;
      const auto offset = [&](const CapturedCasterBias& of) {
        return away_from_light(view) * clamped(of.constant + of.slope * double{casters.slopes[i]}, of.clamp);
      };
      // Outlines move with the normals' offset: where that is another one the map without any bias is the start.
      const bool anew = instead.normal_offset_world != bias.normal_offset_world;
      const CapturedCasterBias now = anew ? CapturedCasterBias{} : bias;
      double stored = double{anew ? map.unbiased[i] : map.depth[i]} - offset(now);
      const auto world = [&](const CapturedCasterBias& of) {
        return of.constant_world + against_normal(of, double{casters.cosines[i]});
      };
      if (const double by = world(instead) - world(now); by != 0.0) {
        const double along =
            glm::dot(texel_ray(view, face, column + 0.5, row + 0.5).direction, view.face(face).forward);
        stored = stored_from_depth(view, face, row + 0.5,
                                   depth_from_stored(view, face, row + 0.5, stored) + by * along);
      }
      out[i] = static_cast<float>(std::clamp(stored + offset(instead), 0.0, 1.0));
    }
  });
  return out;
}

namespace {

/// How a reader finds a face of the map in the capture, whose cubes have their faces in any order. Nothing: there is no other.
std::string name_of(const LightView& view, std::size_t face) {
  if (view.face_count == 1) return {};
  if (!view.seamless) return fmt::format("layer {}: ", face);
  const Vec3 forward = view.face(static_cast<int>(face)).forward, length = glm::abs(forward);
  const int axis = length.x > 0.5 ? 0 : length.y > 0.5 ? 1 : 2;
  return fmt::format("face {}{}: ", forward[axis] > 0.0 ? '+' : '-', "xyz"[axis]);
}

}  // namespace

std::vector<std::string> caster_bias_notes(const CasterBiases& casters, const raster::LightRecord& record) {
  if (!casters.found) return {};
  std::string text;
  for (std::size_t face = 0; face < casters.faces.size(); ++face) {
    const CapturedCasterBias& bias = casters.faces[face];
    if (!bias.moves()) continue;
    const LightFace& f = record.map.view.face(static_cast<int>(face));
    const bool parallel = record.map.view.projection == LightProjection::orthographic;
    std::vector<std::string> parts;
    if (bias.constant != 0.0)
      parts.push_back(fmt::format(
          "an offset of {}{:.3g} of stored depth",
          parallel ? fmt::format("{:.3g} world units, ", bias.constant * (f.far_depth - f.near_depth))
                   : std::string(),
          bias.constant));
    if (bias.constant_world != 0.0)
      parts.push_back(fmt::format("an offset of {:.3g} world units", bias.constant_world));
    if (bias.slope != 0.0) parts.push_back(fmt::format("a slope-scaled offset of factor {:.3g}", bias.slope));
    text += fmt::format("{}{}{}", text.empty() ? "" : "; ", name_of(record.map.view, face), parts.front());
    if (parts.size() > 1) text += " and " + parts.back();
  }
  return {"the map was drawn with " + text +
          ": its casters lie so much farther from the light than the scene's (map[].caster_bias says so in a "
          "capture)"};
}

}  // namespace gnomon::judge

// Which caster of the scene the map lacks, holds elsewhere or holds moved, told by what the rays through texels' centres
// meet. What holds of a texel alone is told by it; whether an object is missing, moved or biased is told by all of its
// texels that were looked at: a grid over the map, and those that wrong pixels look up.
#include "studies/judge/map_content.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "compare/ladder/biased_test.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "studies/judge/identify.h"
#include "studies/judge/stored_depths.h"

namespace gnomon::compare {
namespace {

using raytrace::TexelKey;

constexpr int grid_side = 192;             ///< texels looked at on each side of a face
constexpr std::size_t most_surfaces = 12;  ///< on a texel's ray
constexpr std::size_t few_of_a_kind = 10;  ///< of which nothing is said in a note
constexpr std::size_t few_texels = 24;     ///< tell no bias
constexpr double half = 0.5;
constexpr double hardly_any = 0.1;    ///< share of back faces that the map holds where they were left out
constexpr double nearly_all = 0.8;    ///< share of texels that a bias of casters, or culling, has to explain
constexpr double moved_share = 0.25;  ///< foreign depths for each texel of an object that was moved
constexpr double bias_slack = 0.1;    ///< of the depth that a bias moves a caster by

/// How the scene's casters stand in one texel.
struct Texel {
  TexelKey key;
  std::vector<SurfaceOnRay> surfaces;  ///< the first is what the map should hold
  bool held = false;                   ///< the map holds the scene's depth
  bool held_at_centre = false;
  std::optional<std::size_t> stored{};  ///< the surface whose depth the map holds instead
  double depth = infinity;              ///< as stored
  bool empty = false;

  bool has_first() const { return !surfaces.empty(); }
  const SurfaceOnRay& first() const { return surfaces.front(); }
  /// Stored nearer than all that the scene has there, or in the middle of nothing.
  bool is_foreign() const { return !held && !empty && !stored; }
};

/// A line depth = constant + scale * across that moves casters away from the light.
struct CasterBias {
  double constant = 0.0, scale = 0.0;
  double at(const SurfaceOnRay& surface) const { return constant + scale * surface.across; }
};

struct Share {
  std::size_t texels = 0, held = 0;
  double of_held() const { return texels > 0 ? double(held) / double(texels) : 1.0; }
};

class Content {
 public:
  Content(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in), map_(drawn.options.map), record_(drawn.lights.front()), stored_(in, record_) {}

  void look_at(std::vector<TexelKey> keys);
  void judge_objects();
  /// Nothing: the map holds the scene's depth there, and what is off is precision.
  std::optional<Label> label_of(TexelKey key, bool false_shadow) const;
  const Texel& texel(TexelKey key) const {
    const auto found = std::lower_bound(texels_.begin(), texels_.end(), key,
                                        [](const Texel& t, TexelKey k) { return t.key < k; });
    return *found;
  }
  std::string object_name(std::uint32_t primitive) const;
  /// How far a bias of casters moves the first surface there.
  double moved_by(const Texel& t) const {
    const CasterBias* bias = t.has_first() ? bias_of(object(t.first())) : nullptr;
    return bias != nullptr ? bias->at(t.first()) : 0.0;
  }

 private:
  Texel look(TexelKey key) const;
  std::uint32_t object(const SurfaceOnRay& s) const { return in_.world.object_of(s.primitive); }
  bool is_clipped(const SurfaceOnRay& s, TexelKey key) const {
    const LightFace& face = record_.map.view.face(key.face());
    return s.depth < face.near_depth || s.depth > face.far_depth;
  }
  void find_bias(const std::vector<const Texel*>& group, std::optional<CasterBias>& out) const;
  const CasterBias* bias_of(std::uint32_t object) const;
  bool is_biased(const Texel& t) const;
  bool is_biased_object(const SurfaceOnRay& s) const {
    const auto found = biased_.find(object(s));
    return found != biased_.end() &&
           double(found->second) >= moved_share * double(objects_.at(found->first).texels);
  }
  bool is_culled(const Texel& t) const;
  /// A map of back faces holds that of the first surface's object.
  bool holds_other_side(const Texel& t) const {
    return map_.cull != raster::Cull::none && t.stored && object(t.surfaces[*t.stored]) == object(t.first());
  }
  bool is_masked_out(const Texel& t) const;
  Label missing_label(const Texel& t) const;

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  StoredDepths stored_;
  std::vector<Texel> texels_;  ///< ascending by key
  Share all_, fronts_, backs_;
  std::map<std::uint32_t, Share> objects_;
  std::size_t foreign_ = 0;
  std::optional<CasterBias> whole_bias_;
  std::map<std::uint32_t, CasterBias> object_bias_;
  std::map<std::uint32_t, std::size_t> biased_;  ///< texels of each object that a bias of casters explains
};

Texel Content::look(TexelKey key) const {
  Texel t{key, stored_.all(key, most_surfaces)};
  t.held = stored_.holds_scene(key);
  t.held_at_centre =
      t.held && t.has_first() && stored_.is_stored(key, t.first().depth, 0.25 * t.first().across);
  t.empty = stored_.is_empty(key);
  if (!t.empty) t.depth = stored_.depth(key);
  for (std::size_t k = 1; !t.held && k < t.surfaces.size() && !t.stored; ++k)
    if (stored_.is_stored(key, t.surfaces[k].depth, half * t.surfaces[k].across)) t.stored = k;
  return t;
}

void Content::look_at(std::vector<TexelKey> keys) {
  const LightView& view = record_.map.view;
  const int step = std::max(1, view.size / grid_side);
  for (int face = 0; face < view.face_count; ++face)
    for (int row = step / 2; row < view.size; row += step)
      for (int column = step / 2; column < view.size; column += step)
        keys.push_back(TexelKey::pack(face, column, row));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  texels_.resize(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) { texels_[i] = look(keys[i]); });
}

void Content::judge_objects() {
  std::map<std::uint32_t, std::vector<const Texel*>> by_object;
  std::vector<const Texel*> whole;
  for (const Texel& t : texels_) {
    foreign_ += t.is_foreign() && (!t.has_first() || t.depth < t.first().depth) ? 1 : 0;
    if (!t.has_first()) continue;
    const auto count = [&](Share& share) { ++share.texels, share.held += t.held ? 1 : 0; };
    count(all_), count(objects_[object(t.first())]), count(t.first().front ? fronts_ : backs_);
    whole.push_back(&t), by_object[object(t.first())].push_back(&t);
  }
  if (all_.of_held() < half) find_bias(whole, whole_bias_);
  for (const auto& [number, group] : by_object) {
    std::optional<CasterBias> bias;
    if (objects_[number].of_held() < half) find_bias(group, bias);
    if (bias) object_bias_[number] = *bias;
  }
  for (const Texel& t : texels_)
    if (t.has_first() && is_biased(t)) ++biased_[object(t.first())];
}

/// The line through depths that no surface of the scene has, those farthest off it left out step by step.
void Content::find_bias(const std::vector<const Texel*>& group, std::optional<CasterBias>& out) const {
  struct Point {
    double across, moved;
  };
  std::vector<Point> points;
  for (const Texel* t : group)
    if (t->is_foreign() && std::isfinite(t->first().across) && t->depth > t->first().depth)
      points.push_back({t->first().across, t->depth - t->first().depth});
  if (points.size() < few_texels || double(points.size()) < half * double(group.size())) return;
  CasterBias line;
  const auto off = [&line](const Point& p) {
    return std::abs(p.moved - line.constant - line.scale * p.across);
  };
  std::vector<Point> kept = points;
  for (int round = 0; round < 6; ++round) {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    const auto n = double(kept.size());
    for (const Point& p : kept)
      x += p.across, y += p.moved, xx += p.across * p.across, xy += p.across * p.moved;
    const double spread = n * xx - x * x;
    line.scale = spread > 1e-9 * n * xx ? (n * xy - x * y) / spread : 0.0;
    line.constant = (y - line.scale * x) / n;
    std::vector<Point> nearest = points;
    const std::size_t count = std::max(few_texels, points.size() * 3 / 4);
    std::nth_element(nearest.begin(), nearest.begin() + std::ptrdiff_t(count) - 1, nearest.end(),
                     [&](const Point& a, const Point& b) { return off(a) < off(b); });
    nearest.resize(count);
    kept = std::move(nearest);
  }
  out = line;
  const auto explained = std::count_if(group.begin(), group.end(), [&](const Texel* t) {
    return t->is_foreign() && std::abs(t->depth - t->first().depth - line.at(t->first())) <=
                                  bias_slack * (t->depth - t->first().depth);
  });
  if (double(explained) < nearly_all * double(points.size())) out.reset();
}

const CasterBias* Content::bias_of(std::uint32_t object) const {
  if (whole_bias_) return &*whole_bias_;
  const auto found = object_bias_.find(object);
  return found == object_bias_.end() ? nullptr : &found->second;
}

/// The map holds one of the texel's surfaces as the bias moves it, or what lies before the first one so moved.
bool Content::is_biased(const Texel& t) const {
  if (t.empty || t.held_at_centre) return false;
  const auto moved = [&](const SurfaceOnRay& s) {
    const CasterBias* bias = bias_of(object(s));
    return bias != nullptr ? bias->at(s) : 0.0;
  };
  for (const SurfaceOnRay& s : t.surfaces)
    if (const double by = moved(s);
        by > 0.0 && stored_.is_stored(t.key, s.depth + by, bias_slack * by + half * s.across))
      return true;
  return t.has_first() && t.depth > t.first().depth &&
         t.depth <= t.first().depth + (1.0 + bias_slack) * moved(t.first());
}

/// Sides that the renderer left out: of the first surface's side the map holds hardly any, of the other side it does.
bool Content::is_culled(const Texel& t) const {
  if (!t.has_first()) return false;
  const bool left_out = t.empty || t.depth > t.first().depth;
  const bool has_other_side = std::any_of(
      t.surfaces.begin() + 1, t.surfaces.end(),
      [&](const SurfaceOnRay& s) { return object(s) == object(t.first()) && s.front != t.first().front; });
  if (!left_out || has_other_side) return false;
  if (t.first().front) return map_.cull == raster::Cull::front;
  const Material& m = in_.world.scene->materials[in_.world.material_of(t.first().primitive)];
  return !m.double_sided && backs_.of_held() < hardly_any && fronts_.of_held() >= half;
}

/// The map holds a triangle where its alpha mask has a hole.
bool Content::is_masked_out(const Texel& t) const {
  if (t.empty) return false;
  const Ray ray = stored_.ray(t.key);
  const LightView& view = record_.map.view;
  const Vec3& forward = view.face(t.key.face()).forward;
  for (const WorldPart& part : in_.world.parts) {
    for (std::uint32_t k = 0; k < part.triangle_count(); ++k) {
      if (in_.world.scene->materials[part.material_of(k)].alpha_mode != AlphaMode::mask) continue;
      const auto corners = part.corners(k);
      const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      const double facing = glm::dot(normal, ray.direction);
      if (facing == 0.0) continue;
      const Vec3 place = ray.at(glm::dot(normal, corners[0] - ray.origin) / facing);
      bool inside = true;
      for (std::size_t c = 0; c < 3; ++c)
        inside = inside &&
                 glm::dot(normal, glm::cross(corners[(c + 1) % 3] - corners[c], place - corners[c])) >= 0.0;
      if (!inside) continue;
      const double depth = glm::dot(place - view.origin, forward);
      const double slope =
          texel_world_size(view, t.key.face(), depth) * glm::length(normal) / std::abs(facing);
      if (stored_.is_stored(t.key, depth, half * slope)) return true;
    }
  }
  return false;
}

/// Returns the label of a caster that the map does not hold at its place.
Label Content::missing_label(const Texel& t) const {
  const Share& own = objects_.at(object(t.first()));
  const auto lacking = double(own.texels - own.held);
  const bool elsewhere = own.of_held() < half && double(foreign_) >= moved_share * lacking;
  return elsewhere ? Label::moved_caster : Label::missing_caster;
}

std::optional<Label> Content::label_of(TexelKey key, bool false_shadow) const {
  const Texel& t = texel(key);
  if (is_biased(t)) return Label::caster_bias;
  const bool lacks_object = t.has_first() && objects_.at(object(t.first())).of_held() < half;
  if (t.held_at_centre || (t.held && !lacks_object) || holds_other_side(t)) return std::nullopt;
  if (t.has_first() && is_clipped(t.first(), key)) return Label::clipped_caster;
  if (is_culled(t)) return Label::culled_caster;
  const bool nearer = !t.empty && (!t.has_first() || t.depth < t.first().depth);
  if (!nearer && lacks_object) return is_biased_object(t.first()) ? Label::caster_bias : missing_label(t);
  if (stored_.holds_neighbours(key)) return Label::aliasing;
  if (nearer && is_masked_out(t)) return Label::ignored_alpha;
  if (nearer) return Label::moved_caster;
  if (!t.has_first()) return std::nullopt;
  return false_shadow ? Label::moved_caster : missing_label(t);
}

std::string Content::object_name(std::uint32_t primitive) const {
  const World& world = in_.world;
  if (!world.is_triangle(primitive)) return world.shape(primitive).name;
  return world.part_of(primitive).mesh->name;
}

/// The texel that the biased test looks up.
std::optional<TexelKey> lookup_of(const FrameInput& in, const raster::RasterFrame& drawn, std::size_t pixel) {
  const raster::LightRecord& record = drawn.lights.front();
  const Light& light = in.world.scene->lights[record.light];
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const auto lookup = biased_lookup(record, drawn.options.map.bias,
                                    light_at(light, receiver.position).to_light, receiver, pixel);
  if (!lookup) return std::nullopt;
  return lookup->key;
}

/// What the ladder charges to precision, and of a culled map what the bias step takes for a leak.
bool may_be_content(const LightComparison& light, std::size_t i, bool culled) {
  const Label label = light.labels.data[i];
  if (label == Label::stored_depth) return true;
  const bool missed = light.rungs[6].data[i] > light.rungs[0].data[i];
  return culled && missed && (label == Label::light_leak || label == Label::peter_panning);
}

class Findings {
 public:
  Findings(const Content& content, const LightComparison& light) : content_(content), light_(light) {}

  void add(std::size_t pixel, Label label, const Texel& t) {
    Kind& kind = kinds_[label];
    ++kind.finding.pixels;
    kind.finding.wrong += is_wrong(rungs_at(light_.rungs, pixel)) ? 1 : 0;
    const bool of_scene =
        t.has_first() && label != Label::ignored_alpha && (t.empty || t.depth > t.first().depth);
    if (of_scene) ++kind.objects[content_.object_name(t.first().primitive)];
    if (label == Label::caster_bias) kind.moved.push_back(content_.moved_by(t));
    if (label != Label::clipped_caster) return;
    const double depth = t.first().depth;
    auto &low = kind.finding.nearest, &high = kind.finding.farthest;
    low = std::min(low.value_or(depth), depth), high = std::max(high.value_or(depth), depth);
  }

  std::vector<ContentFinding> take() {
    std::vector<ContentFinding> out;
    for (auto& [label, kind] : kinds_) {
      kind.finding.label = label;
      std::size_t most = 0;
      for (const auto& [name, count] : kind.objects)
        if (count > most) most = count, kind.finding.object = name;
      std::sort(kind.moved.begin(), kind.moved.end());
      if (!kind.moved.empty()) kind.finding.bias_world = kind.moved[kind.moved.size() / 2];
      out.push_back(std::move(kind.finding));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.pixels > b.pixels; });
    return out;
  }

 private:
  struct Kind {
    ContentFinding finding;
    std::map<std::string, std::size_t> objects;
    std::vector<double> moved;
  };
  const Content& content_;
  const LightComparison& light_;
  std::map<Label, Kind> kinds_;
};

std::string object_words(const ContentFinding& found) {
  return found.object.empty() ? "" : fmt::format(", mostly of '{}'", found.object);
}

std::string reason_words(const ContentFinding& found, const raster::LightRecord& record) {
  const LightFace& face = record.map.view.face(0);
  switch (found.label) {
    case Label::caster_bias:
      return fmt::format(
          "a bias of the casters: the map holds surfaces some {:.3g} world units behind where they are (a "
          "polygon "
          "offset, or casters moved when the map is drawn)",
          found.bias_world);
    case Label::missing_caster:
      return "a caster that is missing from the map";
    case Label::moved_caster:
      return "a caster that stands elsewhere in the map, or in it alone: it was drawn before something moved";
    case Label::clipped_caster:
      return found.nearest && *found.nearest < face.near_depth
                 ? fmt::format(
                       "a caster before the map's near plane: it reaches to {:.4g} world units before it, "
                       "and "
                       "a near plane there, or depths clamped to it, would hold it",
                       face.near_depth - *found.nearest)
                 : fmt::format("a caster behind the map's far plane, by {:.4g} world units",
                               found.farthest.value_or(face.far_depth) - face.far_depth);
    case Label::culled_caster:
      return "a caster of which the side that faces the light was culled";
    case Label::ignored_alpha:
      return "a caster drawn whole where its alpha mask has holes: the map's pass does not test alpha";
    default:
      return {};
  }
}

}  // namespace

bool MapContent::is_main_cause(const LightComparison& light) const {
  std::size_t wrong = 0;
  for (const ContentFinding& one : found) wrong += one.label == Label::caster_bias ? 0 : one.wrong;
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
  return wrong > 0 && 2 * wrong >= light.error.wrong - outside;
}

MapContent label_map_content(const FrameInput& in, const raster::RasterFrame& drawn, LightComparison& light,
                             bool is_as_described) {
  const TimedStage stage("map's content");
  const bool culled = drawn.options.map.cull != raster::Cull::none;
  std::vector<std::pair<std::uint32_t, TexelKey>> asked;
  for (const std::uint32_t i : pixels_where(light.labels.data.size(), [&](std::size_t i) {
         return has_cause(light.labels.data[i]) && may_be_content(light, i, culled);
       }))
    if (const auto key = lookup_of(in, drawn, i)) asked.emplace_back(i, *key);
  if (asked.empty()) return {};
  Content content(in, drawn);
  std::vector<TexelKey> keys;
  for (const auto& [pixel, key] : asked) keys.push_back(key);
  content.look_at(std::move(keys));
  content.judge_objects();
  Findings findings(content, light);
  for (const auto& [pixel, key] : asked) {
    const bool dark = light.rungs[6].data[pixel] < light.rungs[0].data[pixel];
    const auto label = content.label_of(key, dark);
    if (!label || (*label == Label::aliasing && light.labels.data[pixel] != Label::stored_depth)) continue;
    if (is_as_described && *label != Label::aliasing) findings.add(pixel, *label, content.texel(key));
    light.labels.data[pixel] = is_as_described ? *label : Label::unexplained;
    light.detachment_map.data[pixel] = std::numeric_limits<float>::quiet_NaN();
  }
  count_labels_again(light);
  return {findings.take()};
}

std::vector<std::string> map_content_notes(const MapContent& content, const raster::LightRecord& record) {
  std::vector<std::string> out;
  for (const ContentFinding& found : content.found)
    if (found.pixels >= few_of_a_kind)
      out.push_back(
          fmt::format("in {} pixels with an error{} the map does not hold what the light meets first: {}",
                      grouped(found.pixels), object_words(found), reason_words(found, record)));
  return out;
}

}  // namespace gnomon::compare

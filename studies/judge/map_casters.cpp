#include "studies/judge/map_casters.h"

#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

using raytrace::TexelKey;

constexpr std::size_t few_texels = 24;  ///< tell no bias
constexpr double half = 0.5;
constexpr double hardly_any = 0.1;    ///< share of back faces that the map holds where they were left out
constexpr double nearly_all = 0.8;    ///< share of texels that a bias of casters, or culling, has to explain
constexpr double moved_share = 0.25;  ///< foreign depths for each texel of an object that was moved
constexpr double bias_slack = 0.1;    ///< of the depth that a bias moves a caster by

}  // namespace

CasterTexel MapCasters::look(TexelKey key) const {
  CasterTexel t{key, stored_.all(key)};
  t.held = stored_.holds_scene(key);
  t.held_at_centre =
      t.held && t.has_first() && stored_.is_stored(key, t.first().depth, 0.25 * t.first().across);
  t.empty = stored_.is_empty(key);
  if (!t.empty) t.depth = stored_.depth(key);
  for (std::size_t k = 1; !t.held && k < t.surfaces.size() && !t.stored; ++k)
    if (stored_.is_stored(key, t.surfaces[k].depth, half * t.surfaces[k].across)) t.stored = k;
  return t;
}

void MapCasters::look_at(std::vector<TexelKey> keys) {
  const LightView& view = record_.map.view;
  for (int face = 0; face < view.face_count; ++face) {
    const std::vector<TexelKey> sampled = sampled_texels(view, face);
    keys.insert(keys.end(), sampled.begin(), sampled.end());
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  texels_.resize(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) { texels_[i] = look(keys[i]); });
}

void MapCasters::judge_objects() {
  std::map<std::uint32_t, std::vector<const CasterTexel*>> by_object;
  std::vector<const CasterTexel*> whole;
  for (const CasterTexel& t : texels_) {
    foreign_ += t.is_foreign() && (!t.has_first() || t.depth < t.first().depth) ? 1 : 0;
    if (!t.has_first()) continue;
    const auto count = [&](Share& share) { ++share.texels, share.held += t.held ? 1 : 0; };
    count(all_), count(objects_[object(t.first())]), count(t.first().front ? fronts_ : backs_);
    whole.push_back(&t), by_object[object(t.first())].push_back(&t);
  }
  if (all_.of_held() < half) find_bias(whole, whole_bias_);
  for (const auto& [number, group] : by_object) {
    std::optional<CasterLine> bias;
    if (objects_[number].of_held() < half) find_bias(group, bias);
    if (bias) object_bias_[number] = *bias;
  }
  for (const CasterTexel& t : texels_)
    if (t.has_first() && is_biased(t)) ++biased_[object(t.first())];
}

/// The line through depths that no surface of the scene has, those farthest off it left out step by step.
void MapCasters::find_bias(const std::vector<const CasterTexel*>& group,
                           std::optional<CasterLine>& out) const {
  struct Point {
    double across, moved;
  };
  std::vector<Point> points;
  for (const CasterTexel* t : group)
    if (t->is_foreign() && std::isfinite(t->first().across) && t->depth > t->first().depth)
      points.push_back({t->first().across, t->depth - t->first().depth});
  if (points.size() < few_texels || double(points.size()) < half * double(group.size())) return;
  CasterLine line;
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
  const auto explained = std::count_if(group.begin(), group.end(), [&](const CasterTexel* t) {
    return t->is_foreign() && std::abs(t->depth - t->first().depth - line.at(t->first())) <=
                                  bias_slack * (t->depth - t->first().depth);
  });
  if (double(explained) < nearly_all * double(points.size())) out.reset();
}

const CasterLine* MapCasters::bias_of(std::uint32_t object) const {
  if (whole_bias_) return &*whole_bias_;
  const auto found = object_bias_.find(object);
  return found == object_bias_.end() ? nullptr : &found->second;
}

/// The map holds one of the texel's surfaces as the bias moves it, or what lies before the first one so moved.
bool MapCasters::is_biased(const CasterTexel& t) const {
  if (t.empty || t.held_at_centre) return false;
  const auto moved = [&](const SurfaceOnRay& s) {
    const CasterLine* bias = bias_of(object(s));
    return bias != nullptr ? bias->at(s) : 0.0;
  };
  for (const SurfaceOnRay& s : t.surfaces)
    if (const double by = moved(s);
        by > 0.0 && stored_.is_stored(t.key, s.depth + by, bias_slack * by + half * s.across))
      return true;
  return t.has_first() && t.depth > t.first().depth &&
         t.depth <= t.first().depth + (1.0 + bias_slack) * moved(t.first());
}

bool MapCasters::is_biased_object(const SurfaceOnRay& s) const {
  const auto found = biased_.find(object(s));
  return found != biased_.end() &&
         double(found->second) >= moved_share * double(objects_.at(found->first).texels);
}

/// Sides that the renderer left out: of the first surface's side the map holds hardly any, of the other side it does.
bool MapCasters::is_culled(const CasterTexel& t) const {
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
bool MapCasters::is_masked_out(const CasterTexel& t) const {
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
Label MapCasters::missing_label(const CasterTexel& t) const {
  const Share& own = objects_.at(object(t.first()));
  const auto lacking = double(own.texels - own.held);
  const bool elsewhere = own.of_held() < half && double(foreign_) >= moved_share * lacking;
  return elsewhere ? Label::moved_caster : Label::missing_caster;
}

std::optional<Label> MapCasters::label_of(TexelKey key, bool false_shadow) const {
  const CasterTexel& t = texel(key);
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

std::string MapCasters::object_name(std::uint32_t primitive) const {
  const World& world = in_.world;
  if (!world.is_triangle(primitive)) return world.shape(primitive).name;
  return world.part_of(primitive).mesh->name;
}

}  // namespace gnomon::compare

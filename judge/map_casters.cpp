#include "judge/map_casters.h"

#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

using compare::Label;

using raytrace::TexelKey;

constexpr std::size_t few_texels = 24;  ///< tell no bias
constexpr double half = 0.5;
constexpr double hardly_any = 0.1;    ///< share of back faces that the map holds where they were left out
constexpr double nearly_all = 0.8;    ///< share of texels that a bias of casters, or culling, has to explain
constexpr double moved_share = 0.25;  ///< foreign depths for each texel of an object that was moved
constexpr double bias_slack = 0.1;    ///< of the depth that a bias moves a caster by

bool any_masked(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.alpha_mode == AlphaMode::mask; });
}

Scene without_masks(Scene scene) {
  for (Material& m : scene.materials) m.alpha_mode = AlphaMode::opaque;
  return scene;
}

}  // namespace

Unmasked::Unmasked(const World& masked)
    : scene(without_masks(*masked.scene)), world(make_world(scene)), tracer(world, raytrace::Accel::bvh) {}

MapCasters::MapCasters(const FrameInput& in, const raster::RasterFrame& drawn)
    : in_(in),
      map_(drawn.options.map),
      record_(drawn.lights.front()),
      stored_(in, record_),
      unmasked_(any_masked(*in.world.scene) ? std::make_unique<Unmasked>(in.world) : nullptr) {}

CasterTexel MapCasters::look(TexelKey key) const {
  CasterTexel t{key, stored_.all(key)};
  t.held = stored_.holds_scene(key);
  t.held_at_centre =
      t.held && t.has_first() && stored_.is_stored(key, t.first().depth, 0.25 * t.first().across);
  t.empty = stored_.is_empty(key);
  if (!t.empty) t.depth = stored_.depth(key);
  for (std::size_t k = 1; !t.held && k < t.surfaces.size() && !t.stored; ++k)
    if (stored_.is_stored(key, t.surfaces[k].depth, half * t.surfaces[k].across)) t.stored = k;
  if (unmasked_ != nullptr) look_for_hole(t);
  return t;
}

/// The hole before the first surface whose depth the map holds; else the first one. The first surface's own depth at the texel's
/// centre is no hole's, and one of a place beside it is.
void MapCasters::look_for_hole(CasterTexel& t) const {
  for (const SurfaceOnRay& s : stored_.all(unmasked_->tracer, t.key)) {
    if (t.has_first() && s.depth >= t.first().depth) break;
    if (!t.hole) t.hole = s;
    if (t.held_at_centre || !stored_.is_stored(t.key, s.depth, half * s.across)) continue;
    t.hole = s, t.fills_hole = true;
    break;
  }
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
    if (t.hole) ++holes_[object(*t.hole)].texels, holes_[object(*t.hole)].held += t.fills_hole ? 1 : 0;
    if (!t.has_first()) continue;
    const auto count = [&](Share& share) { ++share.texels, share.held += t.held ? 1 : 0; };
    count(all_), count(objects_[object(t.first())]), count(t.first().front ? fronts_ : backs_);
    whole.push_back(&t), by_object[object(t.first())].push_back(&t);
  }
  const bool averaged =
      captured_test(record_).reads() == CapturedTest::Reads::averages;  // which lies behind the nearest depth
  if (!averaged && all_.of_held() < half) find_bias(whole, whole_bias_);
  for (const auto& [number, group] : by_object) {
    std::optional<CasterLine> bias;
    if (!averaged && objects_[number].of_held() < half) find_bias(group, bias);
    if (bias) object_bias_[number] = *bias;
  }
  for (const CasterTexel& t : texels_) {
    const bool biased = is_biased(t);
    if (biased && t.has_first()) ++biased_[object(t.first())];
    foreign_ += t.is_foreign() && !biased && !t.fills_hole ? 1 : 0;
  }
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
  const auto is_explained = [&](const CasterTexel* t) {
    return t->is_foreign() && std::abs(t->depth - t->first().depth - line.at(t->first())) <=
                                  bias_slack * (t->depth - t->first().depth);
  };
  // What the bias moves behind another surface, or to the far plane, is not seen in the map.
  const auto is_hidden = [&](const CasterTexel* t) {
    const double moved = t->first().depth + (1.0 + bias_slack) * line.at(t->first());
    if (t->empty) return moved >= record_.map.view.face(t->key.face()).far_depth;
    return t->stored && t->surfaces[*t->stored].depth <= moved;
  };
  const auto explained = std::count_if(group.begin(), group.end(), is_explained);
  const auto hidden = std::count_if(group.begin(), group.end(), is_hidden);
  // An object that moved leaves a strip of its place empty, and fills another.
  if (double(explained) >= nearly_all * double(points.size()) &&
      double(explained + hidden) >= nearly_all * double(group.size()))
    out = line;
}

const CasterLine* MapCasters::bias_of(std::uint32_t object) const {
  if (whole_bias_) return &*whole_bias_;
  const auto found = object_bias_.find(object);
  return found == object_bias_.end() ? nullptr : &found->second;
}

/// The bias moves the first surface to the far plane, so that nothing is drawn.
bool MapCasters::is_pushed_out(const CasterTexel& t) const {
  const CasterLine* bias = t.has_first() ? bias_of(object(t.first())) : nullptr;
  const LightFace& face = record_.map.view.face(t.key.face());
  return bias != nullptr && t.first().depth < face.far_depth &&
         t.first().depth + (1.0 + bias_slack) * bias->at(t.first()) >= face.far_depth;
}

/// The map holds one of the texel's surfaces as the bias moves it, or what lies before the first one so moved.
bool MapCasters::is_biased(const CasterTexel& t) const {
  if (t.empty) return is_pushed_out(t);
  if (t.held_at_centre) return false;
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

bool MapCasters::holds_some_of(std::uint32_t number) const {
  Share share;
  for (const CasterTexel& t : texels_) {
    if (!t.has_first() || object(t.first()) != number) continue;
    const bool other_side = t.stored && object(t.surfaces[*t.stored]) == number;
    ++share.texels, share.held += t.held || other_side || is_biased(t) ? 1 : 0;
  }
  return share.texels > 0 && share.of_held() >= hardly_any;
}

/// The map fills a hole of an object's mask here, and at half of all of its holes.
bool MapCasters::is_masked_out(const CasterTexel& t) const {
  return t.fills_hole && holes_.at(object(*t.hole)).of_held() >= half;
}

/// Returns the label of a caster that the map does not hold at its place.
Label MapCasters::missing_label(const CasterTexel& t) const {
  const Share& own = objects_.at(object(t.first()));
  const auto lacking = double(own.texels - own.held);
  return double(foreign_) >= moved_share * lacking ? Label::moved_caster : Label::missing_caster;
}

std::optional<Label> MapCasters::label_of(TexelKey key, bool false_shadow) const {
  const CasterTexel& t = texel(key);
  if (is_masked_out(t)) return Label::ignored_alpha;
  if (is_biased(t)) return Label::caster_bias;
  const bool lacks_object = t.has_first() && objects_.at(object(t.first())).of_held() < half;
  if (t.held_at_centre || (t.held && !lacks_object) || holds_other_side(t)) return std::nullopt;
  if (t.has_first() && is_clipped(t.first(), key)) return Label::clipped_caster;
  if (is_culled(t)) return Label::culled_caster;
  const bool nearer = !t.empty && (!t.has_first() || t.depth < t.first().depth);
  if (!nearer && lacks_object) return is_biased_object(t.first()) ? Label::caster_bias : missing_label(t);
  if (stored_.holds_neighbours(key)) return Label::aliasing;
  if (nearer) return Label::moved_caster;
  if (!t.has_first()) return std::nullopt;
  return false_shadow ? Label::moved_caster : missing_label(t);
}

std::string MapCasters::object_name(std::uint32_t primitive) const {
  const World& world = in_.world;
  if (!world.is_triangle(primitive)) return world.shape(primitive).name;
  return world.part_of(primitive).mesh->name;
}

}  // namespace gnomon::judge

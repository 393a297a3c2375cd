#include "raytrace/tracer.h"

#include <algorithm>

#include "raytrace/accel/any_structure.h"
#include "raytrace/bvh/wide_single.h"
#include "raytrace/kernels.h"
#include "raytrace/precision/exact.h"
#include "raytrace/precision/fast.h"
#include "raytrace/precision/ray_offset.h"
#include "raytrace/precision/visibility.h"
#include "scene/base/stages.h"
#include "scene/base/timing.h"

namespace gnomon::raytrace {
namespace {

/// Whether a triangle's material is such; each list of materials is looked at once.
template <class Is>
bool any_triangle_material(const World& world, const Is& is) {
  const auto of = [&](std::uint32_t material) { return is(world.scene->materials[material]); };
  std::vector<char> seen(world.scene->meshes.size(), 0);
  for (const WorldPart& part : world.parts) {
    if (part.triangle_count() == 0) continue;
    const auto& of_triangles = part.mesh->triangle_materials;
    if (of_triangles.empty() && of(part.material)) return true;
    char& done = seen[static_cast<std::size_t>(part.mesh - world.scene->meshes.data())];
    if (done == 0 && std::any_of(of_triangles.begin(), of_triangles.end(), of)) return true;
    done = 1;
  }
  return false;
}
template <class Is>
bool any_material(const World& world, const Is& is) {
  return any_triangle_material(world, is) ||
         std::any_of(world.shapes.begin(), world.shapes.end(),
                     [&](const Shape& shape) { return is(world.scene->materials[shape.material]); });
}

Structures make_structures(const World& world, Accel accel, Precision precision) {
  Structures s;
  s.world = &world;
  s.precision = precision;
  std::shared_ptr<Structure> other;
  if (has_structure(accel)) other = std::make_shared<Structure>(build_structure(world, accel));
  if (auto* two = std::get_if<TwoLevel>(other.get()))
    s.bvh = std::move(two->leaves);
  else
    s.bvh = accel == Accel::bvh ? build_bvh(world) : build_flat(world);
  s.structure = std::move(other);
  if (accel == Accel::bvh) s.wide = std::make_unique<WideOnDemand>(precision == Precision::fast);
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id) {
    const auto* plane = std::get_if<Plane>(&world.shape(id).geometry);
    if (plane == nullptr)
      s.has_shapes = true;
    else if (all_finite(plane->point) && all_finite(plane->normal))
      s.planes.push_back(id);
    else
      ++s.bvh.dropped;
  }
  if (precision == Precision::fast)
    for (std::uint32_t i = 0; i < s.bvh.ids.size(); ++i)
      s.fast.push_back(fast_primitive(leaf_at(s, i), world.is_triangle(s.bvh.ids[i])));
  s.has_masks = any_material(world, [](const Material& m) { return m.alpha_mode == AlphaMode::mask; });
  if (s.has_masks) s.masks = mask_cells(*world.scene);
  s.has_non_casters = any_material(world, [](const Material& m) { return !m.casts_shadow; });
  s.has_non_receivers = any_material(world, [](const Material& m) { return !m.receives_shadow; });
  s.has_masks = s.has_masks || s.has_non_casters;
  s.hides_backs = any_triangle_material(world, [](const Material& m) { return !shows_back(m); });
  return s;
}

std::uint64_t bytes_of(const Bvh& bvh) {
  std::uint64_t bytes = bvh.nodes.size() * sizeof(BvhNode) + bvh.below.size() * sizeof(LeafRange) +
                        bvh.primitives.bytes() + bvh.ids.size() * sizeof(std::uint32_t) +
                        bvh.instances.size() * sizeof(BvhInstance);
  for (const Bvh& tree : bvh.trees) bytes += bytes_of(tree);
  return bytes;
}
std::uint64_t bytes_of(const std::vector<MaskCells>& masks) {
  std::uint64_t bytes = 0;
  for (const MaskCells& cells : masks) bytes += cells.bytes();
  return bytes;
}
std::uint64_t nodes_of(const Bvh& bvh) {
  std::uint64_t nodes = bvh.nodes.size();
  for (const Bvh& tree : bvh.trees) nodes += tree.nodes.size();
  return nodes;
}

/// verb(masks, arithmetic) with types that stand for the scene's masks and the chosen arithmetic.
template <class Verb>
[[gnu::always_inline]] inline auto specialise(const Structures& s, const Verb& verb) {
  const auto with = [&]<class Arithmetic>() {
    return s.has_masks ? verb.template operator()<true, Arithmetic>()
                       : verb.template operator()<false, Arithmetic>();
  };
  switch (s.precision) {
    case Precision::fast:
      return with.template operator()<FastArithmetic>();
    case Precision::exact:
      return with.template operator()<ExactArithmetic>();
    case Precision::robust:
      break;
  }
  return with.template operator()<RobustArithmetic>();
}

// Queries without counts go through the wide tree where it is there. What is counted is always the default
// hierarchy: counts are to be compared with other structures', and not to depend on the rays that came
// before.

/// refused also where there is no wide tree (yet).
[[gnu::always_inline]] inline WideAnswer closest_in_wide(const Structures& s, const Ray& ray,
                                                         std::uint32_t skip, Hit& best, WorkCounts* work) {
  const WideTree* tree = wide_tree(s);
  if (tree == nullptr) return WideAnswer::refused;
  return specialise(s, [&]<bool masks, class Arithmetic>() {
    return closest_wide<masks, Arithmetic>(s, *tree, ray, skip, best, work);
  });
}
[[gnu::always_inline]] inline WideAnswer any_in_wide(const Structures& s, const Ray& ray, WorkCounts* work) {
  const WideTree* tree = wide_tree(s);
  if (tree == nullptr) return WideAnswer::refused;
  return specialise(
      s, [&]<bool masks, class Arithmetic>() { return any_wide<masks, Arithmetic>(s, *tree, ray, work); });
}

template <class Stats>
[[gnu::noinline]] std::optional<Hit> closest_plainly(const Structures& s, const Ray& ray, std::uint32_t skip,
                                                     Stats stats) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return std::nullopt;
  return specialise(
      s, [&]<bool masks, class Arithmetic>() { return closest<masks, Arithmetic>(s, *frame, skip, stats); });
}
template <class Stats>
[[gnu::noinline]] bool any_plainly(const Structures& s, const Ray& ray, Stats stats) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  return frame && specialise(s, [&]<bool masks, class Arithmetic>() {
           return any<masks, Arithmetic>(s, *frame, stats);
         });
}

template <class Stats>
[[gnu::always_inline]] inline std::optional<Hit> closest_of(const Structures& s, const Ray& ray,
                                                            std::uint32_t skip, Stats stats) {
  if constexpr (std::is_same_v<Stats, NoStats>) {
    Hit hit;
    const WideAnswer answer = closest_in_wide(s, ray, skip, hit, nullptr);
    if (answer == WideAnswer::nothing) return std::nullopt;
    if (answer == WideAnswer::hit) return hit;
  }
  return closest_plainly(s, ray, skip, stats);
}

/// Few hits are backs that are not seen, so the search that knows of sides comes second.
template <class Stats>
std::optional<Hit> closest_on_side(const Structures& s, const Ray& ray, Sides sides, Stats stats,
                                   std::uint32_t skip = no_id) {
  const std::optional<Hit> hit = closest_of(s, ray, skip, stats);
  if (!hit || is_on_side(s, ray.direction, hit->primitive, sides)) return hit;
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  return specialise(
      s, [&]<bool, class Arithmetic>() { return closest<true, Arithmetic>(s, *frame, skip, stats, sides); });
}

template <class Stats>
bool any_of(const Structures& s, const Ray& ray, Stats stats) {
  if constexpr (std::is_same_v<Stats, NoStats>) {
    const WideAnswer answer = any_in_wide(s, ray, nullptr);
    if (answer != WideAnswer::refused) return answer == WideAnswer::hit;
  }
  return any_plainly(s, ray, stats);
}

/// The textbook's point: what the ray says, and no bound.
void forget_bounds(SurfacePoint& point, const Ray& ray, double t) {
  point.position = Vec3(Vec3f(ray.at(t)));
  point.position_error = Vec3(0.0);
}

}  // namespace

std::string_view accel_name(Accel accel) {
  constexpr std::array<std::string_view, 10> names{
      "bvh",  "bvh-median",    "kdtree", "kdtree-cyclic", "octree",
      "grid", "grid-textbook", "bsp",    "two-level",     "brute"};
  return names[static_cast<std::size_t>(accel)];
}

std::span<const Accel> all_accels() {
  using enum Accel;
  static constexpr Accel all[] = {bvh,  bvh_median,    kdtree, kdtree_cyclic, octree,
                                  grid, grid_textbook, bsp,    two_level,     brute};
  return all;
}

std::string_view precision_name(Precision precision) {
  constexpr std::array<std::string_view, 3> names{"fast", "robust", "exact"};
  return names[static_cast<std::size_t>(precision)];
}

struct Tracer::Impl {
  Accel accel = Accel::bvh;
  Structures structures;
  AccelStats stats;
};

Tracer::Tracer(const World& world, Accel accel, Precision precision) : impl_(std::make_unique<Impl>()) {
  const TimedStage stage("build");
  const Stopwatch watch;
  impl_->accel = accel;
  impl_->structures = make_structures(world, accel, precision);
  // The textbook's hits may lie outside the boxes, so that the tree decides with them: all rays go through the same one.
  if (precision == Precision::fast) prepare_single_rays(*this);
  const Bvh& bvh = impl_->structures.bvh;
  const auto& other = impl_->structures.structure;
  const StructureSize size = other != nullptr ? size_of(*other) : StructureSize{};
  impl_->stats = {.build_ms = watch.elapsed_ms(),
                  .bytes = bytes_of(bvh) + size.bytes +
                           impl_->structures.fast.size() * sizeof(FastPrimitive) +
                           bytes_of(impl_->structures.masks),
                  .nodes = nodes_of(bvh) + size.nodes,
                  .dropped = bvh.dropped};
}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

const World& Tracer::world() const {
  return *impl_->structures.world;
}
Precision Tracer::precision() const {
  return impl_->structures.precision;
}
const AccelStats& Tracer::stats() const {
  return impl_->stats;
}
Accel Tracer::accel() const {
  return impl_->accel;
}
const Structures& Tracer::structures() const {
  return impl_->structures;
}
void prepare_single_rays(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  if (s.wide != nullptr) s.wide->collapse(s.bvh, *s.world);
}
std::uint64_t single_ray_bytes(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  return s.wide != nullptr ? s.wide->bytes() : 0;
}

namespace {

/// What single rays go through is made with the rest where the precision is fast, else when it is asked for.
double structure_ms(const Tracer& tracer) {
  const Structures& s = tracer.structures();
  const bool apart = s.wide != nullptr && s.precision != Precision::fast;
  return tracer.stats().build_ms + (apart ? s.wide->collapse_ms() : 0.0);
}

}  // namespace

Times time_structure(const Tracer& tracer, int most) {
  Times times{{structure_ms(tracer)}};
  const TimedStage stage("build repeats", TimedStage::Inner::included);
  while (times_again(times, most, usual_enough_ms)) {
    const Tracer again(tracer.world(), tracer.accel(), tracer.precision());
    if (single_ray_bytes(tracer) > 0) prepare_single_rays(again);
    times.runs.push_back(structure_ms(again));
  }
  return times;
}

std::optional<Hit> counted_closest_hit(const Tracer& tracer, const Ray& ray, WorkCounts& work) {
  Hit hit;
  const WideAnswer answer = closest_in_wide(tracer.structures(), ray, no_id, hit, &work);
  if (answer == WideAnswer::refused) return tracer.closest_hit(ray, work);
  return answer == WideAnswer::hit ? std::optional(hit) : std::nullopt;
}
bool counted_occluded(const Tracer& tracer, const Ray& ray, WorkCounts& work) {
  const WideAnswer answer = any_in_wide(tracer.structures(), ray, &work);
  return answer == WideAnswer::refused ? tracer.occluded(ray, work) : answer == WideAnswer::hit;
}

std::optional<Hit> Tracer::closest_hit(const Ray& ray) const {
  return closest_of(impl_->structures, ray, no_id, NoStats{});
}
std::optional<Hit> Tracer::closest_hit(const Ray& ray, Sides sides) const {
  return closest_on_side(impl_->structures, ray, sides, NoStats{});
}
bool Tracer::occluded(const Ray& ray) const {
  return any_of(impl_->structures, ray, NoStats{});
}
std::optional<Hit> Tracer::closest_seen(const Ray& ray) const {
  return closest_on_side(impl_->structures, ray, Sides::seen, NoStats{});
}
std::optional<Hit> Tracer::closest_seen(const Ray& ray, WorkCounts& work) const {
  return closest_on_side(impl_->structures, ray, Sides::seen, CountWork{work});
}
std::optional<Hit> Tracer::closest_hit(const Ray& ray, WorkCounts& work) const {
  return closest_of(impl_->structures, ray, no_id, CountWork{work});
}
bool Tracer::occluded(const Ray& ray, WorkCounts& work) const {
  return any_of(impl_->structures, ray, CountWork{work});
}

SurfacePoint Tracer::surface_point(const Ray& ray, const Hit& hit) const {
  const World& w = world();
  SurfacePoint point;
  point.primitive = hit.primitive;
  point.barycentric = hit.barycentric;
  if (w.is_triangle(hit.primitive)) {
    point.position = triangle_point(w.corners(hit.primitive), hit.barycentric, point.position_error);
  } else {
    const auto& geometry = w.shape(hit.primitive).geometry;
    if (const auto* sphere = std::get_if<Sphere>(&geometry))
      point.position = sphere_point(*sphere, ray.at(hit.t), point.position_error);
    else if (is_solid(geometry))
      point.position = solid_point(geometry, ray.at(hit.t), point.position_error);
    else
      point.position = plane_point(std::get<Plane>(geometry), ray.at(hit.t), point.position_error);
  }
  if (precision() == Precision::fast) forget_bounds(point, ray, hit.t);
  point.normal = face_forward(geometric_normal(w, hit.primitive, point.position), ray.direction);
  return point;
}

Ray Tracer::spawn_ray(const SurfacePoint& from, const Vec3& direction) const {
  if (precision() == Precision::fast) return {from.position, direction, {textbook_epsilon, infinity}};
  return {offset_origin(from, direction), direction};
}

Ray Tracer::shadow_ray(const SurfacePoint& from, const Light& light) const {
  if (light.type == LightType::directional) return spawn_ray(from, -light.direction);
  return shadow_ray(from, light.position);
}

Ray Tracer::shadow_ray(const SurfacePoint& from, const Vec3& target) const {
  if (precision() == Precision::fast) {
    const double distance = glm::length(target - from.position);
    const Vec3 direction = (target - from.position) / distance;
    return {from.position, direction, {textbook_epsilon, distance - textbook_epsilon}};
  }
  const Vec3 origin = offset_origin(from, target - from.position);
  const Vec3 offset = target - origin;
  const double distance = glm::length(offset);
  const double error =
      error_gamma(8) * distance + glm::dot(from.position_error + glm::abs(origin - from.position), Vec3(1.0));
  return {origin, offset / distance, {0.0, distance - error}};
}

bool Tracer::receives_shadow(const SurfacePoint& point) const {
  return !impl_->structures.has_non_receivers || world().receives_shadow(point.primitive);
}

PointVisibility Tracer::centre_visibility(const SurfacePoint& from, const Light& light,
                                          LastBlocker* last) const {
  if (!receives_shadow(from)) return PointVisibility::lit;
  const Ray ray = shadow_ray(from, light);
  switch (precision()) {
    case Precision::fast:
      return occluded(ray) ? PointVisibility::shadowed : PointVisibility::lit;
    case Precision::exact:
      return certified_visibility(impl_->structures, from, ray, light, nullptr, last);
    case Precision::robust:
      break;
  }
  return point_visibility(impl_->structures, from, ray, nullptr, last);
}

std::optional<Hit> Tracer::closest_seen_among(const Ray& ray, std::span<const std::uint32_t> leaves) const {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame) return std::nullopt;
  const Structures& s = impl_->structures;
  const auto report = [&](const RayFrame&, const auto& visit) {
    for (const std::uint32_t leaf : leaves) visit(leaf);
  };
  return specialise(s, [&]<bool masks, class Arithmetic>() {
    return s.hides_backs ? closest_reported<true, Arithmetic>(s, *frame, no_id, report, Sides::seen)
                         : closest_reported<masks, Arithmetic>(s, *frame, no_id, report);
  });
}

bool Tracer::occluded_among(const Ray& ray, std::span<const std::uint32_t> leaves) const {
  const Structures& s = impl_->structures;
  return specialise(
      s, [&]<bool masks, class Arithmetic>() { return any_among<masks, Arithmetic>(s, ray, leaves); });
}

PointVisibility Tracer::centre_visibility_among(const SurfacePoint& from, const Light& light,
                                                std::span<const std::uint32_t> leaves) const {
  if (!receives_shadow(from)) return PointVisibility::lit;
  const Ray ray = shadow_ray(from, light);
  return precision() == Precision::exact ? certified_visibility(impl_->structures, from, ray, light, &leaves)
                                         : point_visibility(impl_->structures, from, ray, &leaves);
}

std::optional<Hit> Tracer::nearest_occluder(const SurfacePoint& from, const Light& light) const {
  const World& w = world();
  const bool planar =
      w.is_triangle(from.primitive) || std::holds_alternative<Plane>(w.shape(from.primitive).geometry);
  return closest_on_side(impl_->structures, shadow_ray(from, light), Sides::casting, NoStats{},
                         planar ? from.primitive : no_id);
}

}  // namespace gnomon::raytrace

#include "compare/ladder/biased_test.h"

#include <algorithm>

#include "compare/truth/texel_groups.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {

double plane_depth(const LightView& view, int face, double u, double v, const Vec3& position,
                   const Vec3& normal) {
  const Ray ray = texel_ray(view, face, u, v);
  const double facing = glm::dot(normal, ray.direction);
  if (!(facing < 0.0)) return infinity;
  const double t = glm::dot(normal, position - ray.origin) / facing;
  if (view.projection == LightProjection::orthographic) return t;
  if (!(t > 0.0)) return infinity;
  return t * glm::dot(ray.direction, view.faces[static_cast<std::size_t>(face)].forward);
}

namespace {

/// Returns the plane's slope over a map whose texels are all alike: its depth changes by the same from each texel to the
/// next.
double even_depth_slope(const LightView& view, const LightFace& face, const Vec3& normal) {
  const double facing = -glm::dot(normal, face.forward);
  if (!(facing > 0.0)) return infinity;
  return (std::abs(glm::dot(normal, face.right)) * face.half_extent.x +
          std::abs(glm::dot(normal, face.up)) * face.half_extent.y) /
         (facing * view.size);
}

}  // namespace

double texel_depth_slope(const LightView& view, const TexelCoordinate& at, const Vec3& position,
                         const Vec3& normal) {
  if (view.projection == LightProjection::orthographic && view.face(at.face).warp == 0.0)
    return even_depth_slope(view, view.face(at.face), normal);
  const auto slope = [&](double du, double dv) {
    const double below = plane_depth(view, at.face, at.u - du, at.v - dv, position, normal);
    const double above = plane_depth(view, at.face, at.u + du, at.v + dv, position, normal);
    return std::isinf(below) || std::isinf(above) ? infinity : 0.5 * std::abs(above - below);
  };
  const double along_ray = at.distance / at.depth;
  const double scale = view.projection == LightProjection::orthographic ? 1.0 : along_ray;
  return (slope(0.5, 0.0) + slope(0.0, 0.5)) * scale;
}

namespace {

/// The rasterizer's own maps.
class OwnTest final : public raster::MapTest {
 public:
  std::optional<BiasedLookup> lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                     const raster::MapReceiver& receiver) const override;
  std::optional<double> caster(const raster::LightRecord& record, const BiasedLookup& lookup) const override {
    return stored_caster(record, lookup.key);
  }
  double gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
             const BiasedLookup& lookup, double caster_depth) const override;
  std::optional<double> reach_texels(const raster::MapOptions& map) const override;
  double constant_world(const raster::LightRecord& record, int /*face*/, double texel_world,
                        double /*stored_per_world*/) const override {
    const double constant = record.bias_constant_world + record.caster_constant_world;
    const double base = record.rounding.constant_texel_world;
    return base > 0.0 ? constant * texel_world / base : constant;
  }
};

std::optional<BiasedLookup> OwnTest::lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                            const raster::MapReceiver& receiver) const {
  const LightView& view = record.map.view;
  BiasedLookup out;
  out.position = receiver.position;
  out.at = project_to_face(view, record.face.data[receiver.pixel], receiver.position);
  out.cosine = std::clamp(glm::dot(receiver.normal, receiver.to_light), 0.0, 1.0);
  if (!(bias.normal_offset_texels > 0.0))
    return texel_of_pixel(record, receiver.pixel, out.key) ? std::optional(out) : std::nullopt;
  const double sine = glm::length(glm::cross(receiver.normal, receiver.to_light));
  out.position += receiver.normal * (bias.normal_offset_texels * texel_world_size(view, out.at) * sine);
  out.at = project_to_texel(view, out.position);
  if (!out.at.inside) return std::nullopt;
  out.key = TexelKey::pack(out.at.face, out.at.column(), out.at.row());
  return out;
}

double OwnTest::gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                    const BiasedLookup& lookup, double caster_depth) const {
  const LightView& view = record.map.view;
  const TexelCoordinate& at = lookup.at;
  const int face = lookup.key.face();
  const double centre_v = lookup.key.row() + 0.5;
  const auto plane = [&] {
    return plane_depth(view, face, lookup.key.column() + 0.5, centre_v, lookup.position, normal);
  };
  double receiver_depth = at.depth;
  if (bias.receiver_plane) {
    const double stored = stored_from_depth(view, face, centre_v, caster_depth);
    const double next = depth_from_stored(view, face, centre_v, stored + record.rounding.stored_step);
    receiver_depth = plane() - record.rounding.float_world - std::abs(next - caster_depth);
  }
  if (bias.adaptive)
    receiver_depth -= std::max(0.0, at.depth - plane()) + record.rounding.adaptive_epsilon_world;
  const double along_ray = view.projection == LightProjection::orthographic ? 1.0 : at.distance / at.depth;
  double gap = (receiver_depth - caster_depth) * along_ray;
  if (bias.slope != 0.0) gap -= bias.slope * texel_depth_slope(view, at, lookup.position, normal);
  if (const double base = record.rounding.constant_texel_world; base > 0.0)
    gap *= base / texel_world_size(view, at);
  return gap;
}

std::optional<double> OwnTest::reach_texels(const raster::MapOptions& map) const {
  constexpr double own_texel = 0.5, two_by_two = 1.0;
  const raster::TechniqueTraits& traits = raster::traits_of(map.technique);
  if (traits.contents != raster::MapContents::nearest_depth || traits.texels == raster::TexelShape::warped)
    return std::nullopt;
  if (traits.test == raster::ShadowTest::single) return own_texel;
  if (traits.filter != raster::EdgeFilter::kernel) return std::nullopt;
  const double radius = map.filter.radius_texels;
  switch (map.filter.kernel) {
    case raster::FilterKernel::hardware:
      return two_by_two;
    case raster::FilterKernel::box:
      return std::floor(radius) + own_texel;
    default:
      return radius + own_texel;
  }
}

}  // namespace

const raster::MapTest& test_of(const raster::LightRecord& record) {
  static const OwnTest own;
  const bool is_foreign = record.foreign && record.foreign->test;
  return is_foreign ? *record.foreign->test : static_cast<const raster::MapTest&>(own);
}

std::optional<BiasedLookup> biased_lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                          const Vec3& to_light, const raytrace::SurfacePoint& receiver,
                                          std::size_t pixel) {
  return test_of(record).lookup(record, bias, {receiver.position, receiver.normal, to_light, pixel});
}

double gap_before(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                  const BiasedLookup& lookup, double caster_depth) {
  return test_of(record).gap(record, bias, normal, lookup, caster_depth);
}

double depth_of_distance(const LightView& view, raytrace::TexelKey key, double distance) {
  const Ray ray = texel_ray(view, key.face(), key.column() + 0.5, key.row() + 0.5);
  return distance * glm::dot(ray.direction, view.face(key.face()).forward);
}

namespace {

std::optional<double> caster_in(const std::vector<float>& depths, const raster::ShadowMap& map,
                                raytrace::TexelKey key) {
  const double stored = depths[map.texel_index(key.face(), key.column(), key.row())];
  if (!holds_caster(map.view, stored)) return std::nullopt;
  return depth_from_stored(map.view, key.face(), key.row() + 0.5, stored);
}

}  // namespace

std::optional<double> stored_caster(const raster::LightRecord& record, raytrace::TexelKey key) {
  return caster_in(record.map.depth, record.map, key);
}

std::optional<double> compared_caster(const raster::LightRecord& record, const BiasedLookup& lookup) {
  return test_of(record).caster(record, lookup);
}

std::optional<double> unbiased_caster(const raster::LightRecord& record, raytrace::TexelKey key) {
  return caster_in(record.map.true_depth(), record.map, key);
}

bool is_moved_out(const raster::LightRecord& record, raytrace::TexelKey key) {
  return !record.map.unbiased.empty() && unbiased_caster(record, key) && !stored_caster(record, key);
}

double caster_offset(const raster::LightRecord& record, raytrace::TexelKey key) {
  if (record.map.unbiased.empty()) return 0.0;
  const auto moved = stored_caster(record, key), own = unbiased_caster(record, key);
  return moved && own ? *moved - *own : 0.0;
}

double biased_gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& to_light,
                  const raytrace::SurfacePoint& receiver, std::size_t pixel) {
  const auto lookup = biased_lookup(record, bias, to_light, receiver, pixel);
  if (!lookup) return -infinity;
  const auto depth = compared_caster(record, *lookup);
  return depth ? gap_before(record, bias, receiver.normal, *lookup, *depth) : -infinity;
}

}  // namespace gnomon::compare

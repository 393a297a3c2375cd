#include "compare/ladder/biased_test.h"

#include <algorithm>

#include "compare/ladder/moments.h"
#include "compare/ladder/paraboloids.h"
#include "compare/truth/texel_groups.h"

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

double angle_factor(raster::AngleForm form, double cosine) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  switch (form) {
    case raster::AngleForm::sine:
      return sine;
    case raster::AngleForm::tangent:
      return cosine > 0.0 ? sine / cosine : infinity;
    case raster::AngleForm::one_minus_cosine:
      return 1.0 - cosine;
    case raster::AngleForm::none:
      break;
  }
  return 1.0;
}

namespace {

/// Returns by how much another renderer moves a receiver along its normal, world units.
double captured_offset(const raster::CapturedTest& test, int face, double cosine) {
  double offset = test.normal_offset_world;
  if (!test.layers.empty()) offset += test.layers[static_cast<std::size_t>(face)].normal_offset_world;
  return offset == 0.0 ? 0.0 : offset * angle_factor(test.normal_offset_angle, cosine);
}

}  // namespace

std::optional<BiasedLookup> biased_lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                          const Vec3& to_light, const raytrace::SurfacePoint& receiver,
                                          std::size_t pixel) {
  const LightView& view = record.map.view;
  BiasedLookup out;
  out.position = receiver.position;
  out.at = project_to_face(view, record.face.data[pixel], receiver.position);
  out.cosine = std::clamp(glm::dot(receiver.normal, to_light), 0.0, 1.0);
  const raster::CapturedTest* test = record.captured ? &*record.captured->test : nullptr;
  const double given = test != nullptr ? captured_offset(*test, record.face.data[pixel], out.cosine) : 0.0;
  if (bias.normal_offset_texels > 0.0 || given != 0.0) {
    const double sine = glm::length(glm::cross(receiver.normal, to_light));
    const double texels = bias.normal_offset_texels * texel_world_size(view, out.at) * sine;
    out.position += receiver.normal * (texels + given);
    const bool by_place = test == nullptr || test->face_of(pixel) == raster::CapturedTest::any_face;
    out.at = by_place ? project_to_texel(view, out.position)
                      : project_to_face(view, record.face.data[pixel], out.position);
    if (!out.at.inside) return std::nullopt;
    if (test != nullptr && !test->holds(out.at.face, out.at.column(), out.at.row())) return std::nullopt;
    out.key = raytrace::TexelKey::pack(out.at.face, out.at.column(), out.at.row());
  } else if (!texel_of_pixel(record, pixel, out.key)) {
    return std::nullopt;
  }
  return out;
}

namespace {

/// Returns the constant, stored numbers, from which on the test draws light where the receiver lies this far behind what is
/// stored. The two are compared after the constant was multiplied by the angle's factor and held within its limits.
double constant_that_lights(const raster::CapturedTest& test, double behind, double cosine) {
  if (!test.has_angle()) return behind;
  if (behind <= test.least) return -infinity;
  if (behind > test.most) return infinity;
  const double factor = angle_factor(test.constant_angle, cosine);
  if (factor == 0.0) return behind > 0.0 ? infinity : -infinity;
  return std::isinf(factor) ? 0.0 : behind / factor;
}

/// Returns by how many stored numbers the receiver lies behind a caster, its slope bias taken off.
double stored_behind(const raster::LightRecord& record, double slope_world, const BiasedLookup& lookup,
                     double caster_depth) {
  const LightView& view = record.map.view;
  const TexelCoordinate& at = lookup.at;
  const raster::CapturedTest& test = *record.captured->test;
  const int face = lookup.key.face();
  const double u = lookup.key.column() + 0.5, v = lookup.key.row() + 0.5;
  if (test.stores == raster::CapturedTest::Stores::distances) {
    const double along = glm::dot(texel_ray(view, face, u, v).direction, view.face(face).forward);
    return (at.distance - caster_depth / along - slope_world) / test.unit_world;
  }
  if (test.stores == raster::CapturedTest::Stores::linear_z)
    return (at.depth - caster_depth - slope_world * at.depth / at.distance) / test.unit_world;
  const double own = stored_from_depth(view, face, v, at.depth);
  const double before = stored_from_depth(view, face, v, at.depth - slope_world * at.depth / at.distance);
  const double caster = stored_from_depth(view, face, v, caster_depth);
  const double behind = view.reversed ? caster - own : own - caster;
  return behind - std::abs(own - before);
}

/// Returns the gap as another renderer tests its own map: a difference of stored numbers.
double captured_gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                    const BiasedLookup& lookup, double caster_depth) {
  const raster::CapturedTest& test = *record.captured->test;
  const double slope =
      bias.slope != 0.0 ? bias.slope * texel_depth_slope(record.map.view, lookup.at, lookup.position, normal)
                        : 0.0;
  const double behind = stored_behind(record, slope, lookup, caster_depth);
  const double beside =
      test.layers.empty() ? 0.0 : test.layers[static_cast<std::size_t>(lookup.key.face())].constant;
  return (constant_that_lights(test, behind, lookup.cosine) - beside) * test.unit_world;
}

}  // namespace

double gap_before(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                  const BiasedLookup& lookup, double caster_depth) {
  if (record.captured) return captured_gap(record, bias, normal, lookup, caster_depth);
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

std::array<WeighedTexel, 4> texels_between(const raster::LightRecord& record, const TexelCoordinate& at) {
  const raster::ShadowMap& map = record.map;
  const auto& parts = record.captured->test->parts;
  const raster::CapturedTest::Part part = parts.empty()
                                              ? raster::CapturedTest::Part{0, 0, map.view.size, map.view.size}
                                              : parts[static_cast<std::size_t>(at.face)];
  const double u = at.u - 0.5, v = at.v - 0.5;
  const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
  const auto texel = [&](int du, int dv) {
    const double across = du == 0 ? column + 1 - u : u - column, up = dv == 0 ? row + 1 - v : v - row;
    return WeighedTexel{
        map.texel_index(at.face, std::clamp(column + du, part.column, part.column + part.width - 1),
                        std::clamp(row + dv, part.row, part.row + part.height - 1)),
        across * up};
  };
  return {texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)};
}

std::optional<double> compared_caster(const raster::LightRecord& record, const BiasedLookup& lookup) {
  using Read = raster::CapturedTest::Read;
  const Read how = record.captured ? record.captured->test->read : Read::nearest;
  if (how == Read::nearest) return stored_caster(record, lookup.key);
  if (how == Read::moments) return caster_of_moments(record, lookup);
  if (how == Read::paraboloids) return caster_of_paraboloids(record, lookup);
  const raster::ShadowMap& map = record.map;
  double read = 0.0;
  for (const WeighedTexel& near : texels_between(record, lookup.at))
    read += near.weight * double{map.depth[near.index]};
  if (!holds_caster(map.view, read)) return std::nullopt;
  return depth_from_stored(map.view, lookup.at.face, lookup.key.row() + 0.5, read);
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

#include "judge/captured_test.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "compare/truth/texel_groups.h"
#include "judge/capture_pictures.h"

namespace gnomon::judge {

double angle_factor(BiasAngle form, double cosine) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  switch (form) {
    case BiasAngle::sine:
      return sine;
    case BiasAngle::tangent:
      return cosine > 0.0 ? sine / cosine : infinity;
    case BiasAngle::one_minus_cosine:
      return 1.0 - cosine;
    case BiasAngle::none:
      break;
  }
  return 1.0;
}

namespace {

using raster::LightRecord;
using raster::MapLookup;

/// Returns by how much the renderer moves a receiver along its normal, world units.
double offset_of(const CapturedTest& test, int face, double cosine) {
  double offset = test.normal_offset_world;
  if (!test.layers.empty()) offset += test.layers[static_cast<std::size_t>(face)].normal_offset_world;
  return offset == 0.0 ? 0.0 : offset * angle_factor(test.normal_offset_angle, cosine);
}

/// Returns the constant, stored numbers, from which on the test draws light where the receiver lies this far behind what is
/// stored. The two are compared after the constant was multiplied by the angle's factor and held within its limits.
double constant_that_lights(const CapturedTest& test, double behind, double cosine) {
  if (!test.has_angle()) return behind;
  if (behind <= test.least) return -infinity;
  if (behind > test.most) return infinity;
  const double factor = angle_factor(test.constant_angle, cosine);
  if (factor == 0.0) return behind > 0.0 ? infinity : -infinity;
  return std::isinf(factor) ? 0.0 : behind / factor;
}

double depth_along(const LightView& view, TexelKey key) {
  return compare::depth_of_distance(view, key, 1.0);
}

/// Returns by how many stored numbers the receiver lies behind a caster, its slope bias taken off.
double stored_behind(const LightRecord& record, const CapturedTest& test, double slope_world,
                     const MapLookup& lookup, double caster_depth) {
  const LightView& view = record.map.view;
  const TexelCoordinate& at = lookup.at;
  if (test.stores == Stores::distances)
    return (at.distance - caster_depth / depth_along(view, lookup.key) - slope_world) / test.unit_world;
  if (test.stores == Stores::linear_z)
    return (at.depth - caster_depth - slope_world * at.depth / at.distance) / test.unit_world;
  const int face = lookup.key.face();
  const double v = lookup.key.row() + 0.5;
  const double own = stored_from_depth(view, face, v, at.depth);
  const double before = stored_from_depth(view, face, v, at.depth - slope_world * at.depth / at.distance);
  const double caster = stored_from_depth(view, face, v, caster_depth);
  const double behind = view.reversed ? caster - own : own - caster;
  return behind - std::abs(own - before);
}

}  // namespace

CapturedTest::Part CapturedTest::part(const LightView& view, int face) const {
  return parts.empty() ? Part{0, 0, view.size, view.size} : parts[static_cast<std::size_t>(face)];
}

double CapturedTest::taken_off(double constant, double cosine) const {
  if (!has_angle() || constant == 0.0) return std::clamp(constant, least, most);
  return std::clamp(constant * angle_factor(constant_angle, cosine), least, most);
}

double CapturedTest::number_of(const LightView& view, TexelKey key, double depth) const {
  if (stores == Stores::depths) return stored_from_depth(view, key.face(), key.row() + 0.5, depth);
  const double world = stores == Stores::distances ? depth / depth_along(view, key) : depth;
  return (world - range.x) / (range.y - range.x);
}

double CapturedTest::depth_of(const LightView& view, TexelKey key, double number) const {
  if (stores == Stores::depths) return depth_from_stored(view, key.face(), key.row() + 0.5, number);
  const double world = range.x + number * (range.y - range.x);
  return stores == Stores::distances ? world * depth_along(view, key) : world;
}

std::optional<MapLookup> CapturedTest::lookup(const LightRecord& record, const raster::Bias& /*bias*/,
                                              const raster::MapReceiver& receiver) const {
  const LightView& view = record.map.view;
  const int face = record.face.data[receiver.pixel];
  MapLookup out;
  out.position = receiver.position;
  out.at = project_to_face(view, face, receiver.position);
  out.cosine = std::clamp(glm::dot(receiver.normal, receiver.to_light), 0.0, 1.0);
  const double offset = offset_of(*this, face, out.cosine);
  if (offset == 0.0)
    return compare::texel_of_pixel(record, receiver.pixel, out.key) ? std::optional(out) : std::nullopt;
  out.position += receiver.normal * offset;
  out.at = face_of(receiver.pixel) == any_face ? project_to_texel(view, out.position)
                                               : project_to_face(view, face, out.position);
  if (!out.at.inside || !holds(out.at.face, out.at.column(), out.at.row())) return std::nullopt;
  out.key = TexelKey::pack(out.at.face, out.at.column(), out.at.row());
  return out;
}

/// A difference of stored numbers.
double CapturedTest::gap(const LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                         const MapLookup& lookup, double caster_depth) const {
  const double slope = bias.slope != 0.0 ? bias.slope * compare::texel_depth_slope(record.map.view, lookup.at,
                                                                                   lookup.position, normal)
                                         : 0.0;
  const double behind = stored_behind(record, *this, slope, lookup, caster_depth);
  return (constant_that_lights(*this, behind, lookup.cosine) - constant_beside(lookup.key.face())) *
         unit_world;
}

std::optional<double> CapturedTest::reach_texels(const raster::MapOptions& map) const {
  constexpr double own_texel = 0.5;
  if (map.technique == raster::Technique::hard) return own_texel;
  if (map.technique != raster::Technique::pcf) return std::nullopt;
  return std::max(own_texel, map.filter.radius_texels);
}

std::optional<double> CapturedTest::stored_per_world(const LightView& view) const {
  const bool even = view.projection == LightProjection::orthographic && stores == Stores::depths;
  return even ? std::nullopt : std::optional(1.0 / unit_world);
}

/// It is one stored number for all layers.
double CapturedTest::constant_world(const LightRecord& record, int face, double /*texel_world*/,
                                    double stored_per_world) const {
  const double constant = record.bias_constant_world + record.caster_constant_world;
  return (constant / unit_world + constant_beside(face)) / stored_per_world;
}

Expected<LayerNumbers> CapturedTest::read_layer(const Capture& capture, std::size_t layer) const {
  LayerNumbers out;
  auto channel = read_layer_numbers(capture, layer, out.size);
  if (!channel) return fail(channel.error());
  out.values = std::move(channel->values);
  return out;
}

void CapturedTest::describe(raster::MapOptions& /*map*/, raster::ForeignPicture& picture) const {
  constexpr std::array<std::string_view, 3> words{"depths", "distances", "linear depths"};
  picture.stores = words[static_cast<std::size_t>(stores)];
}

std::array<WeighedTexel, 4> texels_between(const LightRecord& record, const CapturedTest& test,
                                           const TexelCoordinate& at) {
  const raster::ShadowMap& map = record.map;
  const CapturedTest::Part part = test.part(map.view, at.face);
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

std::optional<double> DepthsTest::caster(const LightRecord& record, const MapLookup& lookup) const {
  if (!between_) return compare::stored_caster(record, lookup.key);
  const raster::ShadowMap& map = record.map;
  double read = 0.0;
  for (const WeighedTexel& near : texels_between(record, *this, lookup.at))
    read += near.weight * double{map.depth[near.index]};
  if (!holds_caster(map.view, read)) return std::nullopt;
  return depth_from_stored(map.view, lookup.at.face, lookup.key.row() + 0.5, read);
}

std::optional<double> DepthsTest::reach_texels(const raster::MapOptions& map) const {
  constexpr double two_by_two = 1.0;
  return between_ && map.technique == raster::Technique::hard ? two_by_two : CapturedTest::reach_texels(map);
}

std::shared_ptr<CapturedTest> make_depths_test(const Capture& capture) {
  return std::make_shared<DepthsTest>(capture.filter && capture.filter->read == FilterRead::linear_depths);
}

}  // namespace gnomon::judge

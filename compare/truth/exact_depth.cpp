#include "compare/truth/exact_depth.h"

#include "compare/ladder/biased_test.h"
#include "compare/ladder/labelling.h"
#include "compare/truth/stored_surface.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

using Reads = raster::MapTest::Reads;

// Infinite where the ray meets nothing.
std::optional<double> depth_of_stored(const LadderInput& in, raytrace::TexelKey key, double first_depth) {
  if (raster::traits_of(in.drawn.options.map.technique).contents == raster::MapContents::midpoint_depth)
    return std::nullopt;
  if (in.drawn.options.map.cull == raster::Cull::none) return first_depth;
  const StoredSurface stored = stored_surface(in, key);
  if (stored.primitive == no_id) return std::nullopt;
  return stored.depth;
}

std::optional<BiasedLookup> lookup_of(const LadderInput& in, std::size_t pixel) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const Vec3 to_light = light_at(in.light(), receiver.position).to_light;
  return biased_lookup(in.record(), in.drawn.options.map.bias, to_light, receiver, pixel);
}

// Up to the rounding of doubles the receiver itself counts as level with what it is compared with, as in V3.
double gap_before_exact(const LadderInput& in, const BiasedLookup& lookup,
                        const raytrace::SurfacePoint& receiver, double depth) {
  const raytrace::TexelKey key = lookup.key;
  const Ray ray =
      caster_ray(in.world(), in.record().map.view, key.face(), key.column() + 0.5, key.row() + 0.5);
  return gap_before(in.record(), in.drawn.options.map.bias, receiver.normal, lookup, depth) -
         plane_rounding(ray, receiver);
}

double gap_with_bias(const LowerClimb& lower, const LadderInput& in, std::size_t group, std::size_t pixel,
                     raytrace::TexelKey& texel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return -infinity;
  texel = lookup->key;
  const auto depth = compared_caster(in.record(), *lookup);
  if (!depth) return -infinity;
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const double exact = lower.centres[group];
  const double moved = caster_offset(in.record(), texel);
  const Reads reads = test_of(in.record()).reads();
  const bool of_texel =
      texel == lower.groups.keys[group] && (reads == Reads::texel || reads == Reads::between);
  if (of_texel && is_exact(in, texel, *depth - moved, exact))
    return gap_before_exact(in, *lookup, receiver, exact + moved);
  return gap_before(in.record(), in.drawn.options.map.bias, receiver.normal, *lookup, *depth);
}

/// The distance to what the test's own ray meets first, as a depth on the ray through the looked-up texel's centre.
double exact_depth_elsewhere(const LadderInput& in, const BiasedLookup& lookup) {
  const raster::LightRecord& record = in.record();
  const auto hit = in.tracer.closest_hit(test_of(record).exact_ray(record, lookup), raytrace::Sides::casting);
  return hit ? depth_of_distance(record.map.view, lookup.key, hit->t) : infinity;
}

/// The depth at which the ray through the looked-up texel's centre meets what the texel stores.
std::optional<double> exact_depth(const LowerClimb& lower, const LadderInput& in, std::size_t group,
                                  raytrace::TexelKey key) {
  const double first = key == lower.groups.keys[group] ? lower.centres[group] : trace_centre(in, key).depth;
  return depth_of_stored(in, key, first);
}

std::optional<double> gap_to_exact(const LowerClimb& lower, const LadderInput& in, std::size_t group,
                                   std::size_t pixel) {
  const auto lookup = lookup_of(in, pixel);
  if (!lookup) return std::nullopt;
  const Reads reads = test_of(in.record()).reads();
  if (reads == Reads::between) return std::nullopt;
  const auto depth = reads == Reads::elsewhere ? exact_depth_elsewhere(in, *lookup)
                                               : exact_depth(lower, in, group, lookup->key);
  if (!depth) return std::nullopt;
  if (std::isinf(*depth) || is_moved_out(in.record(), lookup->key)) return -infinity;
  return gap_before_exact(in, *lookup, in.traced.receiver.data[pixel],
                          *depth + caster_offset(in.record(), lookup->key));
}

/// Whether the test reads averages among which that depth may be.
bool averages_exact(const LowerClimb& lower, const LadderInput& in, std::size_t group,
                    raytrace::TexelKey key) {
  if (test_of(in.record()).reads() != Reads::averages) return false;
  const auto depth = exact_depth(lower, in, group, key);
  return depth && is_exact(in, key, *depth, *depth);
}

/// A shader of the user's own that names neither bias nor gap draws without a bias.
bool tests_bias(const LadderInput& in) {
  return !in.drawn.custom_shader || in.drawn.custom_shader->reads_bias;
}

float lit_with(double gap, double bias_world) {
  return gap > bias_world ? 0.0f : 1.0f;
}

}  // namespace

UpperPixel::UpperPixel(const LowerClimb& lower, const LadderInput& in, Column& column, std::size_t group,
                       std::uint32_t pixel, const Rungs& rungs)
    : lower_(lower),
      in_(in),
      column_(column),
      group_(group),
      pixel_(pixel),
      rungs_(rungs),
      lookup_(lower.groups.keys[group]),
      gap_(gap_with_bias(lower, in, group, pixel, lookup_)) {}

const std::optional<double>& UpperPixel::exact_gap() {
  if (!exact_) exact_ = gap_to_exact(lower_, in_, group_, pixel_);
  return *exact_;
}

/// V5 is off, and the exact depth in place of the stored one would have made the biased test right.
bool UpperPixel::right_with_exact_depth(Levels v, double bias_world) {
  if (!is_off_at(v, 5)) return false;
  const auto& exact = exact_gap();
  if (!exact) return false;
  v[5] = lit_with(*exact, bias_world);
  return !is_off_at(v, 5);
}

std::optional<double> UpperPixel::unmoved_gap() const {
  if (in_.record().map.unbiased.empty()) return std::nullopt;
  const auto lookup = lookup_of(in_, pixel_);
  const auto depth = lookup ? unbiased_caster(in_.record(), lookup->key) : std::nullopt;
  if (!depth) return std::nullopt;
  const Vec3& normal = in_.traced.receiver.data[pixel_].normal;
  return gap_before(in_.record(), in_.drawn.options.map.bias, normal, *lookup, *depth);
}

/// V5 is off, and the depth of the casters where they are would have made the biased test right.
bool UpperPixel::right_with_unmoved_casters(Levels v, double bias_world) const {
  if (!is_off_at(v, 5)) return false;
  const auto gap = unmoved_gap();
  if (!gap) return false;
  v[5] = lit_with(*gap, bias_world);
  return !is_off_at(v, 5);
}

UpperPixel::Verdict UpperPixel::verdict_at(double bias_world, float drawn, bool labelled) {
  const float truth = rungs_[0].data[pixel_];
  Verdict out{tests_bias(in_) ? lit_with(gap_, bias_world) : rungs_[4].data[pixel_]};
  if (!labelled || !has_error(drawn, truth)) return out;
  Levels v = rungs_at(rungs_, pixel_);
  v[5] = out.biased, v[6] = drawn;
  // Moments are bias and filter in one: what the bias alone would not make is the filter's.
  if (averages_exact(lower_, in_, group_, lookup_) && exact_gap()) v[5] = lit_with(*exact_gap(), bias_world);
  const bool exact = right_with_exact_depth(v, bias_world);
  out.label = label_of_error(lower_, in_, column_,
                             {pixel_, lookup_, deciding_step(v), drawn < truth, exact, truth,
                              right_with_unmoved_casters(v, bias_world)},
                             v);
  return out;
}

}  // namespace gnomon::compare

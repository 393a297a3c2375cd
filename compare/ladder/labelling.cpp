#include "compare/ladder/labelling.h"

#include <algorithm>

#include "compare/ladder/filter_probe.h"
#include "compare/ladder/labels.h"
#include "compare/truth/stored_surface.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::compare {

using raytrace::SurfacePoint;

namespace {

Label sampling_label(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  if (wrong.false_shadow)
    return false_caster_goes_on(in, column, wrong) ? Label::aliasing : Label::false_feature;
  return missed_caster_is_known(in, column, wrong) ? Label::aliasing : Label::missed_feature;
}

// The stored primitive, or one that hangs together with it in this column, lies between x and the light.
bool stored_is_true_occluder(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  const std::uint32_t stored = stored_surface(in, wrong.lookup).primitive;
  const SurfacePoint& receiver = in.traced.receiver.data[wrong.pixel];
  const auto met = first_on_ray(
      in.tracer, in.tracer.shadow_ray(receiver, in.light()), infinity, [&](const raytrace::Hit& hit) {
        return hit.primitive == stored || (stored != no_id && column.same_sheet(stored, hit.primitive));
      });
  return met.has_value();
}

Label bias_label(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  if (wrong.unmoved_is_right) return Label::caster_bias;
  if (!wrong.false_shadow)
    return stored_is_true_occluder(in, column, wrong) ? Label::peter_panning : Label::light_leak;
  const std::uint32_t stored = stored_surface(in, wrong.lookup).primitive;
  const std::uint32_t receiver = in.traced.receiver.data[wrong.pixel].primitive;
  return stored != no_id && column.same_sheet(stored, receiver) ? Label::acne : Label::false_feature;
}

// A filter that averages comparisons draws what they say. Where true comparisons, averaged alike, are right,
// those with the map are at fault, and what they find dark is the surface itself. Of moments the least is
// known: only where nothing within reach is shadowed is the surface itself the caster.
bool filters_own_surface(const LowerClimb& lower, const LadderInput& in, const WrongPixel& wrong) {
  if (!raster::has_kernel(in.drawn.options.map.technique)) return !shadowed_within_reach(in, wrong.pixel);
  return !(std::abs(true_average(lower, in, wrong.pixel) - double{wrong.truth}) > 0.5);
}

bool has_filter(const LadderInput& in) {
  return filter_kind(in.drawn.options.map) != "none";
}

/// Returns the label where the technique has no filter: V5 and V6 differ by rounding, or where cascades are mixed.
Label unfiltered_label(const LadderInput& in) {
  return raster::mixes_cascades(in.drawn.options.map) ? Label::blur : Label::stored_depth;
}

// Light where nothing within the filter's reach is lit has leaked; near an edge it is the edge's blur.
Label filter_label(const LowerClimb& lower, const LadderInput& in, const WrongPixel& wrong) {
  if (in.drawn.custom_shader) return Label::custom_shader;
  if (!has_filter(in)) return unfiltered_label(in);
  if (wrong.false_shadow) return filters_own_surface(lower, in, wrong) ? Label::acne : Label::blur;
  return lit_within_reach(in, wrong.pixel) ? Label::blur : Label::light_leak;
}

/// The filter step of a small error, where a filter of true comparisons is not to blame.
Label own_fault_of_filter(const LadderInput& in, const WrongPixel& off) {
  if (in.drawn.custom_shader) return Label::custom_shader;
  if (!has_filter(in)) return unfiltered_label(in);
  return off.false_shadow ? Label::acne : Label::light_leak;
}

template <class OfFilter>
Label label_by_step(const LadderInput& in, Column& column, const WrongPixel& wrong,
                    const OfFilter& of_filter) {
  if (wrong.exact_is_right) return Label::stored_depth;
  switch (wrong.step) {
    case Cause::light_size:
      return Label::light_size;
    case Cause::sampling:
      return sampling_label(in, column, wrong);
    case Cause::slope:
      return wrong.false_shadow ? Label::acne : Label::light_leak;
    case Cause::precision:
      return Label::stored_depth;
    case Cause::bias:
      return bias_label(in, column, wrong);
    case Cause::filter:
      return of_filter();
    case Cause::caster:  // has no rung
      break;
  }
  return Label::blur;
}

/// What a filter draws that averages true comparisons is off on the error's side by more than half of the error.
bool filter_is_to_blame(const LowerClimb& lower, const LadderInput& in, const WrongPixel& off, float error) {
  if (in.drawn.custom_shader || !has_filter(in)) return false;
  const double average = true_average(lower, in, off.pixel) - double{off.truth};
  return (off.false_shadow ? -average : average) > 0.5 * double{std::abs(error)};
}

/// Returns the label of an error of one half and less. A filter's own doing comes first: the one texel of V2 to V5 is one of
/// many then.
Label label_of_small_error(const LowerClimb& lower, const LadderInput& in, Column& column,
                           const WrongPixel& off, const std::array<float, rung_count>& rungs) {
  const bool softens = raster::traits_of(in.drawn.options.map.technique).soft;
  if (has_size(in.light()) && !softens && is_off_at(rungs, 1)) return Label::light_size;
  if (filter_is_to_blame(lower, in, off, rungs[6] - rungs[0])) return Label::blur;
  return label_by_step(in, column, off, [&] { return own_fault_of_filter(in, off); });
}

}  // namespace

Label label_of_error(const LowerClimb& lower, const LadderInput& in, Column& column, const WrongPixel& off,
                     const std::array<float, rung_count>& rungs) {
  if (in.drawn.custom_shader && !in.drawn.custom_shader->reads_bias) return Label::custom_shader;
  if (!is_wrong(rungs)) return label_of_small_error(lower, in, column, off, rungs);
  return label_by_step(in, column, off, [&] { return filter_label(lower, in, off); });
}

Cause step_of_label(Label label, const std::array<float, rung_count>& rungs) {
  // Blur is the filter step of a map and the blur step of few rays, whichever decides.
  const std::optional<Cause> step = label == Label::blur ? std::nullopt : label_text(label).step;
  return step ? *step : deciding_step(rungs);
}

// A half plane that holds a point holds at least one of the four texel centres around it; one that holds a
// texel's centre, but not a point of the texel, holds at least one of the two neighbouring centres away from
// the point. The edge of a caster that is straight over two texels is therefore never taken for a feature.

namespace {

using Casters = std::vector<std::uint32_t>;

class Nearby {
 public:
  Nearby(const LadderInput& in, const Column& column, std::size_t pixel)
      : in_(in),
        column_(column),
        receiver_(in.traced.receiver.data[pixel]),
        at_(project_to_face(in.record().map.view, column.key().face(), receiver_.position)) {}

  const raytrace::SurfacePoint& receiver() const { return receiver_; }
  Vec2 place() const { return {at_.u, at_.v}; }
  Ray ray(const Vec2& uv) const {
    return caster_ray(in_.world(), in_.record().map.view, column_.key().face(), uv.x, uv.y);
  }

  // Where the ray meets the receiver's tangent plane; infinite where it does not meet it from the front.
  double plane_distance(const Ray& ray) const {
    const double facing = glm::dot(receiver_.normal, ray.direction);
    if (!(facing < 0.0)) return infinity;
    const double t = glm::dot(receiver_.normal, receiver_.position - ray.origin) / facing;
    return t - plane_rounding(ray, receiver_);
  }
  bool covered(const Vec2& uv, const Casters& casters) const {
    const Ray light = ray(uv);
    const auto met = first_on_ray(in_.tracer, light, plane_distance(light), [&](const raytrace::Hit& hit) {
      return hit.primitive != receiver_.primitive &&
             std::any_of(casters.begin(), casters.end(), [&](std::uint32_t caster) {
               return column_.surfaces().same(caster, hit.primitive);
             });
    });
    return met.has_value();
  }

 private:
  const LadderInput& in_;
  const Column& column_;
  const raytrace::SurfacePoint& receiver_;
  TexelCoordinate at_;
};

// All that the ray meets before t_end and that `wanted` holds of.
template <class Wanted>
Casters casters_on(const raytrace::Tracer& tracer, const Ray& ray, double t_end, const Wanted& wanted) {
  Casters casters;
  (void)first_on_ray(tracer, ray, t_end, [&](const raytrace::Hit& hit) {
    if (wanted(hit.primitive)) casters.push_back(hit.primitive);
    return false;
  });
  return casters;
}

}  // namespace

bool missed_caster_is_known(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  const Nearby nearby(in, column, wrong.pixel);
  const Casters casters = casters_on(in.tracer, in.tracer.shadow_ray(nearby.receiver(), in.light()), infinity,
                                     [](std::uint32_t) { return true; });
  const Vec2 low = glm::floor(nearby.place() - 0.5) + 0.5;
  for (int k = 0; k < 4; ++k)
    if (nearby.covered(low + Vec2(k & 1, k >> 1), casters)) return true;
  return casters.empty();
}

bool false_caster_goes_on(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  const Nearby nearby(in, column, wrong.pixel);
  const std::uint32_t own = nearby.receiver().primitive;
  const Vec2 centre(column.key().column() + 0.5, column.key().row() + 0.5);
  const Ray ray = nearby.ray(centre);
  const Casters casters = casters_on(in.tracer, ray, nearby.plane_distance(ray), [&](std::uint32_t hit) {
    return hit != own && !column.same_sheet(own, hit);
  });
  const Vec2 away(centre.x < nearby.place().x ? -1.0 : 1.0, centre.y < nearby.place().y ? -1.0 : 1.0);
  for (const Vec2& step : {Vec2(away.x, 0.0), Vec2(0.0, away.y), away})
    if (nearby.covered(centre + step, casters)) return true;
  return casters.empty();
}

}  // namespace gnomon::compare

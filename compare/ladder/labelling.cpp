#include "compare/ladder/labelling.h"

#include "compare/ladder/features.h"
#include "compare/ladder/filter_parameters.h"
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
  if (!wrong.false_shadow)
    return stored_is_true_occluder(in, column, wrong) ? Label::peter_panning : Label::light_leak;
  const std::uint32_t stored = stored_surface(in, wrong.lookup).primitive;
  const std::uint32_t receiver = in.traced.receiver.data[wrong.pixel].primitive;
  return stored != no_id && column.same_sheet(stored, receiver) ? Label::acne : Label::false_feature;
}

// A filter that averages comparisons draws what they say: where true comparisons, averaged alike, are right,
// those with the map are at fault, and what they find dark is the surface itself. Of moments the least is
// known: only where nothing within reach is shadowed is the surface itself the caster.
bool filters_own_surface(const LowerClimb& lower, const LadderInput& in, const WrongPixel& wrong) {
  if (in.drawn.options.map.technique != raster::Technique::pcf)
    return !shadowed_within_reach(in, wrong.pixel);
  return !(std::abs(true_average(lower, in, wrong.pixel) - double{wrong.truth}) > 0.5);
}

bool has_filter(const LadderInput& in) {
  return filter_kind(in.drawn.options.map) != "none";
}

/// Of a technique without a filter V5 and V6 differ by rounding, or where cascades are mixed.
Label unfiltered_label(const LadderInput& in) {
  const raster::MapOptions& map = in.drawn.options.map;
  const bool mixes = map.technique == raster::Technique::csm && map.cascades.blend > 0.0;
  return mixes ? Label::blur : Label::precision;
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
  if (wrong.exact_is_right) return Label::precision;
  switch (wrong.step) {
    case Cause::light_size:
      return Label::light_size;
    case Cause::sampling:
      return sampling_label(in, column, wrong);
    case Cause::slope:
      return wrong.false_shadow ? Label::acne : Label::light_leak;
    case Cause::precision:
      return Label::precision;
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

/// Of an error of one half and less. A filter's own doing comes first: the one texel of V2 to V5 is one of many then.
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
  const std::optional<Cause>& step = label_text(label).step;
  return step ? *step : deciding_step(rungs);
}

}  // namespace gnomon::compare

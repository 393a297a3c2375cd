#include "compare/labelling.h"

#include "compare/bleeding.h"
#include "compare/filter_parameters.h"

namespace gnomon::compare {

using raytrace::SurfacePoint;

namespace {

// Deeper chains of occluders than this are not walked: the stored one is among the first few or not at all.
constexpr int max_chain = 64;

// Whether x's own surface is met by the light ray through (u, v), and lit there: -1 not met, 0 shadowed, 1
// lit.
int own_surface_on_ray(const LadderInput& in, const Column& column, std::uint32_t receiver, double u,
                       double v) {
  const LightView& view = in.record.map.view;
  Ray ray = caster_ray(view, column.key().face(), u, v);
  for (int depth = 0; depth < max_chain; ++depth) {
    const auto hit = in.tracer.closest_hit(ray);
    if (!hit) return -1;
    if (column.same_sheet(receiver, hit->primitive)) return depth == 0 ? 1 : 0;
    ray.t.min = std::nextafter(hit->t, infinity);
  }
  return -1;
}

// The receiver's surface changes between lit and shadowed inside the texel's footprint: probed at its
// corners, the middles of its sides, and its centre.
bool edge_in_footprint(const LadderInput& in, const Column& column, const SurfacePoint& receiver,
                       bool truly_lit) {
  for (int j = 0; j <= 2; ++j) {
    for (int i = 0; i <= 2; ++i) {
      const int there = own_surface_on_ray(in, column, receiver.primitive, column.key().column() + 0.5 * i,
                                           column.key().row() + 0.5 * j);
      if (there >= 0 && (there == 1) != truly_lit) return true;
    }
  }
  return false;
}

Label sampling_label(const LadderInput& in, const Column& column, const WrongPixel& wrong) {
  const SurfacePoint& receiver = in.traced.receiver.data[wrong.pixel];
  if (edge_in_footprint(in, column, receiver, wrong.false_shadow)) return Label::aliasing;
  return wrong.false_shadow ? Label::false_feature : Label::missed_feature;
}

// The stored primitive, or one that hangs together with it in this column, lies between x and the light.
bool stored_is_true_occluder(const LadderInput& in, const Column& column, const WrongPixel& wrong) {
  const std::uint32_t stored = in.record.map.primitive[wrong.lookup];
  const SurfacePoint& receiver = in.traced.receiver.data[wrong.pixel];
  Ray ray = in.tracer.shadow_ray(receiver, in.light);
  for (int depth = 0; depth < max_chain; ++depth) {
    const auto hit = in.tracer.closest_hit(ray);
    if (!hit) return false;
    if (hit->primitive == stored || (stored != no_id && column.same_sheet(hit->primitive, stored)))
      return true;
    ray.t.min = std::nextafter(hit->t, infinity);
  }
  return false;
}

Label bias_label(const LadderInput& in, const Column& column, const WrongPixel& wrong) {
  if (!wrong.false_shadow)
    return stored_is_true_occluder(in, column, wrong) ? Label::peter_panning : Label::light_leak;
  const std::uint32_t stored = in.record.map.primitive[wrong.lookup];
  const std::uint32_t receiver = in.traced.receiver.data[wrong.pixel].primitive;
  return stored != no_id && column.same_sheet(receiver, stored) ? Label::acne : Label::false_feature;
}

// Light where nothing within the filter's reach is lit has leaked; near an edge it is the edge's blur.
Label filter_label(const LadderInput& in, const WrongPixel& wrong) {
  if (wrong.false_shadow) return Label::blur;
  const double reach = filter_reach_texels(in.drawn.options.map);
  return lit_within_reach(in, wrong.pixel, reach) ? Label::blur : Label::light_leak;
}

}  // namespace

Label label_wrong_pixel(const LadderInput& in, const Column& column, const WrongPixel& wrong) {
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
      return filter_label(in, wrong);
  }
  return Label::blur;
}

}  // namespace gnomon::compare

// Rungs of docs/design.md, section 3. V0 and V1 come from the ray tracer, V6 from the rasterizer; V2 and V3 from
// the exact ray through the texel's centre, V4 from the stored depth, V5 from the technique's bias in double
// precision.
#include "compare/ladder/ladder.h"

#include <optional>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/labelling.h"
#include "compare/metrics/pixel_list.h"
#include "compare/truth/columns.h"
#include "compare/truth/exact_depth.h"
#include "compare/truth/stored_surface.h"
#include "raster/technique_traits.h"
#include "raytrace/receiver_tiles.h"
#include "raytrace/sheets/column_sheets.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/shapes/solid.h"

namespace gnomon::compare {

using raytrace::PointVisibility;
using raytrace::SurfacePoint;

namespace {

// The share of the light that is seen may as well lie on the other side of one half.
bool samples_leave_doubt(const raytrace::LightTruth& truth, std::size_t pixel) {
  if (truth.standard_error.data.empty()) return false;
  const float error = truth.standard_error.data[pixel];
  return error > 0.0f && std::abs(truth.visibility.data[pixel] - 0.5f) <= error;
}

bool ray_leaves_doubt(const raytrace::LightTruth& truth, std::size_t pixel) {
  return truth.centre.data[pixel] == PointVisibility::uncertain;
}

}  // namespace

Image<Label> sort_pixels(const LadderInput& in) {
  const TimedStage stage("labels");
  Image<Label> labels(in.drawn.primitive.size, Label::background);
  parallel_for(labels.data.size(), [&](std::size_t i) {
    const SurfacePoint& receiver = in.traced.receiver.data[i];
    if (receiver.primitive != in.drawn.primitive.data[i]) {
      labels.data[i] = Label::silhouette;
    } else if (receiver.primitive != no_id) {
      if (light_cannot_reach(in.light(), receiver.position, receiver.normal))
        labels.data[i] = Label::facing_away;
      else
        labels.data[i] = ray_leaves_doubt(in.truth(), i) || samples_leave_doubt(in.truth(), i)
                             ? Label::uncertain
                             : Label::right;
    }
  });
  return labels;
}

Image<Label> labels_climbed(const LadderInput& in, const Image<Label>& labels) {
  Image<Label> climbed = labels;
  if (in.truth().standard_error.data.empty()) return climbed;
  parallel_for(labels.data.size(), [&](std::size_t i) {
    if (labels.data[i] == Label::uncertain && !ray_leaves_doubt(in.truth(), i))
      climbed.data[i] = Label::right;
  });
  return climbed;
}

float true_visibility(const LadderInput& in, std::size_t pixel) {
  if (!in.truth().visibility.data.empty()) return in.truth().visibility.data[pixel];
  return in.truth().centre.data[pixel] == PointVisibility::lit ? 1.0f : 0.0f;
}

bool is_off_at(const std::array<float, rung_count>& v, std::size_t k) {
  const float error = v[6] - v[0];
  const float most = std::abs(error) > 0.5f ? 0.5f : 0.5f * std::abs(error);
  return (error < 0.0f ? v[0] - v[k] : v[k] - v[0]) > most;
}

Cause deciding_step(const std::array<float, rung_count>& v) {
  if (!is_off_at(v, 5)) return Cause::filter;
  std::size_t step = 4;
  if (v[6] > v[0])
    for (step = 0; !is_off_at(v, step + 1);) ++step;
  else
    while (is_off_at(v, step)) --step;
  return static_cast<Cause>(step);
}

namespace {

float lit(bool is_lit) {
  return is_lit ? 1.0f : 0.0f;
}

// A sphere's or closed solid's inside is another sheet than the outside that the light meets first.
bool on_inner_side(const LadderInput& in, const SurfacePoint& receiver) {
  if (in.world().is_triangle(receiver.primitive)) return false;
  const ShapeGeometry& geometry = in.world().shape(receiver.primitive).geometry;
  if (is_solid(geometry))
    return is_closed(geometry) && glm::dot(receiver.normal, geometric_normal(in.world(), receiver.primitive,
                                                                             receiver.position)) < 0.0;
  const auto* sphere = std::get_if<Sphere>(&geometry);
  return sphere != nullptr && glm::dot(receiver.normal, receiver.position - sphere->center) < 0.0;
}

// Of a solid that is not convex, one primitive may hold several sheets.
bool on_one_piece(const LadderInput& in, const SurfacePoint& receiver, const TexelCentre& centre) {
  if (in.world().is_triangle(receiver.primitive) || centre.hit->primitive != receiver.primitive) return true;
  const ShapeGeometry& geometry = in.world().shape(receiver.primitive).geometry;
  if (!is_solid(geometry)) return true;
  const LightView& view = in.record().map.view;
  const bool orthographic = view.projection == LightProjection::orthographic;
  const Vec3 own = orthographic ? centre.ray.direction : glm::normalize(receiver.position - view.origin);
  return raytrace::hang_together(geometry, receiver.position, centre.ray.at(centre.hit->t), own,
                                 centre.ray.direction);
}

// V2: the ray through the texel's centre is lit on x's own sheet, or where it reaches the receiver's tangent
// plane unhindered.
float texel_rung(const LadderInput& in, Column& column, const SurfacePoint& receiver,
                 const TexelCentre& centre) {
  if (meets_plane_unhindered(in, centre, receiver)) return 1.0f;
  if (on_inner_side(in, receiver) || !column.same_sheet(centre.hit->primitive, receiver.primitive))
    return 0.0f;
  return lit(on_one_piece(in, receiver, centre));
}

// V3: the same first hit against x's own depth.
float flat_rung(const SurfacePoint& receiver, const TexelCentre& centre, double own) {
  if (!centre.hit) return 1.0f;
  return lit(!(centre.depth < own - plane_rounding(centre.ray, receiver)));
}

// The first surface on a texel's ray lies where the map stores nothing, such as on an endless plane near the
// horizon.
bool beyond_map(const LightView& view, const TexelCentre& centre) {
  const Interval range = view.depth_range();
  return centre.hit && !(centre.depth >= range.min && centre.depth < range.max);
}

bool stores_midpoints(const raster::MapOptions& map) {
  return raster::traits_of(map.technique).contents == raster::MapContents::midpoint_depth;
}

// V4: the depth really stored, but for the casters' own bias, which is the bias step's. Where culling kept the first surface out of the map, that is the technique's
// doing, not a matter of precision. The rung then stays at V3 and the bias step takes the difference. So it
// does where the map stores the midpoint between two surfaces, where its depths end before the first surface,
// and where the stored depth is the exact one.
float stored_rung(const LadderInput& in, const TexelCentre& centre, raytrace::TexelKey key, bool stores_first,
                  double own, float flat) {
  const raster::ShadowMap& map = in.record().map;
  if (stores_midpoints(in.drawn.options.map)) return flat;
  if (!stores_first) return flat;
  const double stored = map.true_depth()[map.texel_index(key.face(), key.column(), key.row())];
  const double row = key.row();
  if (!holds_caster(map.view, stored)) return beyond_map(map.view, centre) ? flat : 1.0f;
  const double before = depth_from_stored(map.view, centre.face, row + 0.5, stored);
  return is_exact(in, key, before, centre.depth) ? flat : lit(!(own > before));
}

// V1: the light shrunk to its centre.
float point_rung(const LadderInput& in, std::size_t pixel) {
  return lit(in.truth().centre.data[pixel] == PointVisibility::lit);
}

void climb_outside(const LadderInput& in, std::size_t pixel, Climb& out) {
  const float truth = out.rungs[0].data[pixel];
  const float drawn = in.record().visibility.data[pixel];
  out.rungs[1].data[pixel] = point_rung(in, pixel);
  const float test = test_of(in.record()).looks_up(pixel) ? drawn : 1.0f;
  for (std::size_t k = 2; k < 6; ++k) out.rungs[k].data[pixel] = test;
  out.rungs[6].data[pixel] = drawn;
  if (is_compared(out.labels.data[pixel]) && has_error(drawn, truth))
    out.labels.data[pixel] = Label::outside_map;
}

// Whether culling left the centre ray's first surface in the map.
bool stores_first_surface(const LadderInput& in, const TexelCentre& centre, raytrace::TexelKey key) {
  if (in.drawn.options.map.cull == raster::Cull::none) return true;
  const StoredSurface stored = stored_surface(in, key);
  return centre.hit && stored.primitive == centre.hit->primitive && stored.t == centre.hit->t;
}

void climb_lower(const LadderInput& in, Column& column, const TexelCentre& centre, raytrace::TexelKey key,
                 bool stores_first, std::size_t pixel, LowerClimb& out) {
  const SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const LightView& view = in.record().map.view;
  // The depth that project_to_face gives.
  const double own = glm::dot(receiver.position - view.origin, view.face(centre.face).forward);
  const float flat = flat_rung(receiver, centre, own);
  out.rungs[0].data[pixel] = true_visibility(in, pixel);
  out.rungs[1].data[pixel] = point_rung(in, pixel);
  out.rungs[2].data[pixel] = texel_rung(in, column, receiver, centre);
  out.rungs[3].data[pixel] = flat;
  out.rungs[4].data[pixel] = stored_rung(in, centre, key, stores_first, own, flat);
}

bool drawn_off(const LadderInput& in, const Climb& climbed, std::size_t pixel) {
  return is_compared(climbed.labels.data[pixel]) &&
         has_error(in.record().visibility.data[pixel], climbed.rungs[0].data[pixel]);
}

// V5 and V6 of one texel's pixels, and the labels of those that are wrong. `out` holds the lower rungs.
void climb_group(const LowerClimb& lower, const LadderInput& in, std::size_t group, Climb& out) {
  Column column(in, lower.groups.keys[group], lower.surfaces);
  const raster::LightRecord& record = in.record();
  for (const std::uint32_t pixel : lower.groups[group]) {
    const bool compared = is_compared(out.labels.data[pixel]);
    const float drawn = record.visibility.data[pixel];
    const auto [biased, label] = UpperPixel(lower, in, column, group, pixel, out.rungs)
                                     .verdict_at(record.bias_constant_world, drawn, compared);
    out.rungs[5].data[pixel] = biased, out.rungs[6].data[pixel] = drawn;
    if (compared) out.labels.data[pixel] = label;
  }
}

// Of a picture alone the light's size is known, and that the rest is what some map made of it.
Climb climb_unexplained(const LadderInput& in, Climb out) {
  const Image<Label> climbed = labels_climbed(in, out.labels);
  parallel_for(out.labels.data.size(), [&](std::size_t i) {
    if (!is_compared(climbed.data[i])) return;
    out.rungs[0].data[i] = true_visibility(in, i);
    out.rungs[1].data[i] = point_rung(in, i);
    const float drawn = in.record().visibility.data[i];
    for (std::size_t k = 2; k < rung_count; ++k) out.rungs[k].data[i] = drawn;
    if (drawn_off(in, out, i))
      out.labels.data[i] = is_off_at(rungs_at(out.rungs, i), 1) ? Label::light_size : Label::unexplained;
  });
  return out;
}

/// What the denoiser of Technique::rays makes of the truth, from the receivers that it was drawn with.
Image<rays::Signal<rays::with_passengers>> carry_truth(const LadderInput& in) {
  const TimedStage stage("the truth through the denoiser");
  const raster::RasterOptions& options = in.drawn.options;
  const View view = make_view(in.world().scene->camera, options.size);
  const int first_row = in.place.first_row;
  raytrace::Receivers receivers;
  raytrace::ReceiverFinder(in.tracer).find(view, first_row, in.drawn.primitive, receivers);
  const rays::Guides guides = rays::make_guides(in.tracer, view, first_row, in.light(), receivers.points);
  Image<float> truth(guides.size);
  parallel_for(truth.data.size(), [&](std::size_t i) { truth.data[i] = true_visibility(in, i); });
  const rays::StillScene scene{
      in.tracer,
      {options.map.rays, options.seed, in.record().light, 0, static_cast<std::uint32_t>(first_row)},
      guides,
      receivers.points};
  return in.passengers != nullptr ? in.passengers->carry(scene, truth) : rays::carry_passengers(scene, truth);
}

// A technique that asks for every receiver's own visibility has no texel, no stored depth and no bias: the rungs from
// V1 on are what it drew. Under a light without size V1 to V3 are the truth, and rounding is what is left, or a
// shader of the user's own.
Climb climb_without_map(const LadderInput& in, Climb out) {
  const Image<Label> climbed = labels_climbed(in, out.labels);
  const bool sized = has_size(in.light());
  const std::size_t first_drawn = sized ? 1 : 4;
  const Label label = in.drawn.custom_shader ? Label::custom_shader
                      : sized                ? Label::light_size
                                             : Label::stored_depth;
  for (std::size_t i = 0; i < out.labels.data.size(); ++i) {
    if (!is_compared(climbed.data[i])) continue;
    for (std::size_t k = 0; k < rung_count; ++k)
      out.rungs[k].data[i] = k < first_drawn ? true_visibility(in, i) : in.record().visibility.data[i];
    if (drawn_off(in, out, i)) out.labels.data[i] = label;
  }
  return out;
}

Label label_of_rays(const std::array<float, rung_count>& rungs) {
  switch (deciding_step(rungs)) {
    case Cause::rays_lag:
      return Label::lag;
    case Cause::rays_noise:
      return Label::noise;
    case Cause::rays_remap:
      return Label::remap;
    default:
      return Label::blur;
  }
}

// The rungs between are what the very denoiser makes of the truth, and of the rays without its nonlinear ends (rays/signal.h).
Climb climb_few_rays(const LadderInput& in, Climb out) {
  const Image<Label> climbed = labels_climbed(in, out.labels);
  const auto carried = carry_truth(in);
  parallel_for(out.labels.data.size(), [&](std::size_t i) {
    if (!is_compared(climbed.data[i])) return;
    const float truth = true_visibility(in, i), drawn = in.record().visibility.data[i];
    const auto& through = carried.data[i];
    const std::array levels{
        truth, truth, truth, through[rays::blurred], through[rays::lagged], through[rays::sampled], drawn};
    for (std::size_t k = 0; k < rung_count; ++k) out.rungs[k].data[i] = levels[k];
    if (drawn_off(in, out, i)) out.labels.data[i] = label_of_rays(levels);
  });
  return out;
}

std::vector<std::uint32_t> compared_pixels(const Image<Label>& labels) {
  return pixels_where(labels.data.size(), [&](std::size_t i) { return labels.data[i] == Label::right; });
}

}  // namespace

LowerClimb::LowerClimb(const LadderInput& in, Image<Label> to_compare)
    : sorted(std::move(to_compare)), surfaces(in.world(), in.topology) {
  const TimedStage stage("columns and sheets");
  parallel_for(rungs.size(), [&](std::size_t k) { rungs[k] = Image<float>(sorted.size, 1.0f); });
  groups = group_by_texel(in.record(), compared_pixels(labels_climbed(in, sorted)), outside);
  parallel_for(outside.size(), [&](std::size_t i) {
    rungs[0].data[outside[i]] = true_visibility(in, outside[i]);
    rungs[1].data[outside[i]] = point_rung(in, outside[i]);
  });
  const std::vector<TexelCentre> rays = trace_centres(in, groups.keys);
  centres.reserve(rays.size());
  for (const TexelCentre& ray : rays) centres.push_back(ray.depth);
  if (!rays.empty()) surfaces.prepare();
  parallel_for(groups.keys.size(), [&](std::size_t g) {
    Column column(in, groups.keys[g], surfaces);
    const bool stores_first = stores_first_surface(in, rays[g], groups.keys[g]);
    for (const std::uint32_t pixel : groups[g])
      climb_lower(in, column, rays[g], groups.keys[g], stores_first, pixel, *this);
  });
}

bool have_same_lower_climb(const raster::RasterFrame& a, const raster::RasterFrame& b, std::size_t light) {
  const raster::LightRecord &x = a.lights[light], &y = b.lights[light];
  return a.options.map.cull == b.options.map.cull &&
         stores_midpoints(a.options.map) == stores_midpoints(b.options.map) && x.light == y.light &&
         x.map.format == y.map.format && x.map.view.size == y.map.view.size && x.map.depth == y.map.depth &&
         x.texel_uv.data == y.texel_uv.data && x.face.data == y.face.data &&
         a.primitive.data == b.primitive.data;
}

namespace {

/// `out`: the lower rungs and what is to be compared.
Climb climb_on(const LowerClimb& lower, const LadderInput& in, Climb out) {
  const TimedStage stage("labels");
  const raster::Technique technique = in.drawn.options.map.technique;
  if (raster::samples_rays(technique) && has_size(in.light()) && !in.drawn.custom_shader)
    return climb_few_rays(in, std::move(out));
  if (!raster::compares_depths(technique)) return climb_without_map(in, std::move(out));
  parallel_for(lower.outside.size(), [&](std::size_t i) { climb_outside(in, lower.outside[i], out); });
  const std::size_t count = lower.groups.keys.size();
  parallel_for(count, [&](std::size_t g) { climb_group(lower, in, g, out); });
  return out;
}

}  // namespace

Climb climb_up(const LowerClimb& lower, const LadderInput& in) {
  return climb_on(lower, in, {lower.rungs, lower.sorted});
}

Climb climb(const LadderInput& in, Image<Label> sorted) {
  if (!in.record().has_known_map()) {
    Climb start{{}, std::move(sorted)};
    for (Image<float>& rung : start.rungs) rung = Image<float>(start.labels.size, 1.0f);
    return climb_unexplained(in, std::move(start));
  }
  LowerClimb lower(in, std::move(sorted));
  Climb start{std::move(lower.rungs), std::move(lower.sorted)};
  return climb_on(lower, in, std::move(start));
}

}  // namespace gnomon::compare

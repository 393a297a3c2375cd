#include "raster/options.h"

#include <fmt/core.h>

#include <algorithm>

#include "raster/passes/light_block.h"
#include "raster/settings.h"

namespace gnomon::raster {
namespace {

Error usage(std::string field, std::string reason) {
  Error error{ErrorKind::usage, std::move(reason)};
  error.field = std::move(field);
  return error;
}

/// The numbers' ranges.
Expected<void> check_ranges(const MapOptions& options) {
  for (const MapSetting& setting : map_settings()) {
    const Expected<void> valid = check_range(setting, options);
    if (valid) continue;
    std::string field(setting.name);
    std::replace(field.begin(), field.end(), '-', ' ');
    return fail(usage(std::move(field), valid.error().reason));
  }
  return {};
}

Expected<void> check_size(std::string field, std::string_view unit, int size, int limit,
                          std::string_view limit_name) {
  if (size < 1)
    return fail(usage(std::move(field), fmt::format("must be at least 1 {} (got {})", unit, size)));
  if (size <= limit) return {};
  Error error{ErrorKind::graphics, fmt::format("is too large for this OpenGL (got {} {}, allowed {}: {})",
                                               size, unit, limit, limit_name)};
  error.field = std::move(field);
  return fail(std::move(error));
}

}  // namespace

bool uses_moments(Technique technique) {
  return traits_of(technique).contents == MapContents::moments;
}

MapOptions effective_options(const MapOptions& options) {
  MapOptions out = options;
  const TechniqueTraits& traits = traits_of(options.technique);
  const bool filters = reads_setting(options, "filter-plane");
  out.bias.receiver_plane =
      options.bias.receiver_plane || (filters && options.filter.receiver_plane && !options.bias.adaptive);
  if (traits.contents == MapContents::back_depth) out.cull = Cull::front;
  if (options.cascades.fit_samples) out.cascades.snap = false;
  // What is set for another technique stays set.
  if (!reads_setting(options, "caster-bias")) out.bias.caster_constant = out.bias.caster_slope = 0.0;
  if (!reads_setting(options, "window-size")) out.window.size = out.window.origin = {};
  if (!reads_setting(options, "window-depths")) out.window.depths = {};
  if (!options.cascades.splits.empty()) out.cascades.count = options.cascades.splits.count;
  return out;
}

Expected<void> check_map_options(const MapOptions& options) {
  if (auto ok = check_ranges(options); !ok) return ok;
  const TechniqueTraits& traits = traits_of(options.technique);
  if (traits.contents == MapContents::back_depth && options.cull == Cull::back)
    return fail(usage(fmt::format("technique {}", traits.name),
                      "leaves out front faces (got --cull back, allowed none, front)"));
  if (!options.cascades.splits.empty() && options.cascades.fit_samples)
    return fail(
        usage("cascade splits", "are given, or fitted to the surfaces that the camera sees: not both"));
  if (options.bias.adaptive && uses_moments(options.technique))
    return fail(
        usage("adaptive bias", "does not go with vsm, esm, evsm and msm: they compare with no single texel"));
  if (options.bias.receiver_plane && uses_moments(options.technique))
    return fail(usage("receiver plane",
                      "does not go with vsm, esm, evsm and msm: they compare with no single texel"));
  return {};
}

Expected<void> check_options(const RasterOptions& options, const ContextInfo& context) {
  constexpr std::string_view limits = "the least of GL_MAX_TEXTURE_SIZE and GL_MAX_VIEWPORT_DIMS";
  const int limit = context.max_map_size;
  if (auto ok = check_size("map size", "texels", options.map.size, limit, limits); !ok) return ok;
  if (auto ok = check_size("image width", "pixels", options.size.width, limit, limits); !ok) return ok;
  if (auto ok = check_size("image height", "pixels", options.size.height, limit, limits); !ok) return ok;
  if (options.runs < 0)
    return fail(usage("runs", fmt::format("must not be negative (got {})", options.runs)));
  if (traits_of(options.map.technique).contents == MapContents::pixels && !is_whole(context.backend))
    return fail(
        ErrorKind::graphics,
        fmt::format("technique {} writes storage buffers, which WebGL 2 lacks (the native program draws it)",
                    technique_name(options.map.technique)));
  return check_map_options(options.map);
}

Bias default_bias(const MapOptions& map) {
  Bias bias = MapOptions{}.bias;
  if (map.filter.receiver_plane) bias.slope = traits_of(map.technique).default_slope_bias;
  return bias;
}

bool scales_bias(const MapOptions& map) {
  return follows_camera(map.technique) && map.bias.unit != BiasUnit::world;
}

double texel_world(const LightView& view, const World& world) {
  TexelCoordinate at;
  if (!world.finite_bounds.empty()) at = project_to_texel(view, world.finite_bounds.center());
  const LightFace& face = view.face(at.face);
  if (!(at.depth > 0.0)) at.depth = std::sqrt(std::max(0.0, face.near_depth * face.far_depth));
  return texel_world_size(view, at.face, at.depth);
}

BiasRounding bias_rounding(const MapOptions& map, const LightView& view, const World& world,
                           const Vec3& reference) {
  // Vertices, planes and projections are rounded to floats of this size, some eight times over.
  double reach = glm::length(view.origin - reference);
  const Aabb& box = world.finite_bounds;
  if (!box.empty()) reach += glm::length(box.center() - reference) + 0.5 * box.diagonal();
  for (int i = 0; i < view.face_count; ++i)
    if (view.projection == LightProjection::orthographic)
      reach = std::max(reach, glm::length(view.face(i).half_extent));
  const int bits = map.depth_format == DepthFormat::d16 ? 16 : 24;
  const double scene = box.empty() ? reach : box.diagonal();
  const bool by_texel = scales_bias(map);
  return {.float_world = 8.0 * std::exp2(-24.0) * reach,
          .stored_step = std::exp2(-bits),
          .adaptive_epsilon_world = adaptive_epsilon * scene,
          .constant_texel_world = by_texel ? texel_world(view, world) : 0.0};
}

namespace {

// One step of the stored depth on a face, world units of depth.
double stored_step_world(double step, const LightView& view, int face, const World& world) {
  const LightFace& f = view.face(face);
  if (view.projection == LightProjection::orthographic) {
    const double middle = 0.5 * view.size;
    return std::abs(depth_from_stored(view, face, middle, step) - depth_from_stored(view, face, middle, 0.0));
  }
  double farthest = f.far_depth;
  if (const Aabb& box = world.finite_bounds; !box.empty())
    farthest = std::min(farthest, glm::length(box.center() - view.origin) + 0.5 * box.diagonal());
  return step * farthest * farthest * (f.far_depth - f.near_depth) / (f.near_depth * f.far_depth);
}

}  // namespace

double rounding_world(const BiasRounding& rounding, const LightView& view, const World& world) {
  double step = 0.0;
  for (int i = 0; i < view.face_count; ++i)
    step = std::max(step, stored_step_world(rounding.stored_step, view, i, world));
  return rounding.float_world + step;
}

double automatic_bias_world(const BiasRounding& rounding, const LightView& view, const World& world) {
  const double base = texel_world(view, world);
  // A constant that scales with the texel must cover the rounding on the narrowest ones.
  double narrowest = base;
  if (rounding.constant_texel_world > 0.0)
    for (int i = 0; i < view.face_count; ++i) narrowest = std::min(narrowest, texel_world_size(view, i, 1.0));
  return automatic_bias_texels * base + rounding_world(rounding, view, world) * (base / narrowest);
}

double caster_bias_world(const Bias& bias, const LightView& view, const World& world) {
  return bias.caster_unit == BiasUnit::texel ? bias.caster_constant * texel_world(view, world)
                                             : bias.caster_constant;
}

double constant_bias_world(const Bias& bias, const BiasRounding& rounding, const LightView& view,
                           const World& world) {
  switch (bias.unit) {
    case BiasUnit::world:
      return bias.constant;
    case BiasUnit::texel:
      return bias.constant * texel_world(view, world);
    case BiasUnit::automatic:
      break;
  }
  return bias.constant * automatic_bias_world(rounding, view, world);
}

}  // namespace gnomon::raster

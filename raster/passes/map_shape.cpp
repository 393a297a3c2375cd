#include "raster/passes/map_shape.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "raster/passes/technique_pass.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::raster {

bool has_map_for(Technique technique, LightType type) {
  return traits_of(technique).lights.has(type);
}

namespace {

/// "hard, pcf, ...": the techniques that have a map for such lights.
std::string techniques_for(LightType type) {
  std::string text;
  for (const TechniqueTraits& t : all_technique_traits())
    if (t.lights.has(type)) text += fmt::format("{}{}", text.empty() ? "" : ", ", t.name);
  return text;
}

}  // namespace

Expected<void> check_light(Technique technique, const Light& light) {
  if (has_map_for(technique, light.type)) return {};
  const bool has_point = has_map_for(technique, LightType::point);
  Error error{ErrorKind::usage,
              fmt::format("is made for {} lights alone (got the {} light {}, allowed there {}); --light "
                          "chooses one",
                          has_point ? "point" : "directional", light_type_name(light.type), light.name,
                          techniques_for(light.type))};
  error.field = fmt::format("technique {}", technique_name(technique));
  return fail(std::move(error));
}

bool fits_to_samples(const MapOptions& options) {
  return has_cascades(options.technique) && options.cascades.fit_samples;
}

Expected<LightView> fit_map(const World& world, const Light& light, const Camera& camera, double aspect,
                            const MapOptions& options, std::span<const Vec3> visible) {
  const auto fit = traits_of(options.technique).drawing->fit;
  auto view = fit != nullptr ? fit(world, light, camera, aspect, options, visible)
                             : fit_light_view(world, light, camera, aspect, options.size, options.window);
  if (!view) return view;
  view->seamless = light.type == LightType::point;
  view->reversed = options.depth_format == DepthFormat::d32f_reversed;
  return view;
}

void move_window(const Vec3& shift, double margin, LightView& view) {
  if (view.projection != LightProjection::orthographic) return;
  for (int i = 0; i < view.face_count; ++i) {
    LightFace& face = view.faces[static_cast<std::size_t>(i)];
    if (face.warp == 0.0) face.half_extent += Vec2(margin);
    face.center += Vec2(glm::dot(face.right, shift), glm::dot(face.up, shift));
  }
}

void snap_window(LightView& view, bool keep_size) {
  LightFace& face = view.faces[0];
  if (view.projection != LightProjection::orthographic || view.face_count > 1 || face.warp != 0.0) return;
  const Vec3 middle = face_origin(view, face);
  const Vec2 place(glm::dot(face.right, middle), glm::dot(face.up, middle));
  for (int axis = 0; axis < 2; ++axis) {
    const double room =
        face.half_extent[axis] * view.size / std::max(1.0, view.size - 2.0);  // for half a texel
    if (!keep_size) face.half_extent[axis] = up_to_size_step(room);
    const double texel = 2.0 * face.half_extent[axis] / view.size;
    face.center[axis] += std::round(place[axis] / texel) * texel - place[axis];
  }
}

bool same_window(const LightView& a, const LightView& b) {
  const auto same_face = [](const LightFace& f, const LightFace& g) {
    return f.right == g.right && f.up == g.up && f.forward == g.forward && f.center == g.center &&
           f.half_extent == g.half_extent && f.near_depth == g.near_depth && f.far_depth == g.far_depth &&
           f.warp == g.warp;
  };
  return a.projection == b.projection && a.size == b.size && a.face_count == b.face_count &&
         a.origin == b.origin && a.seamless == b.seamless && a.reversed == b.reversed &&
         std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), same_face);
}

std::vector<std::string> map_defines(const MapOptions& options) {
  std::vector<std::string> defines;
  const std::string_view of_faces = traits_of(options.technique).drawing->map_define;
  if (!of_faces.empty()) defines.emplace_back(of_faces);
  if (options.depth_format == DepthFormat::d32f_reversed) defines.emplace_back("REVERSED");
  if (scales_bias(options)) defines.emplace_back("TEXEL_BIAS");
  if (options.bias.adaptive) defines.emplace_back("ADAPTIVE_BIAS");
  return defines;
}

}  // namespace gnomon::raster

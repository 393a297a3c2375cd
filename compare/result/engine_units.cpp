#include "compare/result/engine_units.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

/// The symbols of docs/engine-units.md.
struct Symbols {
  double b;          ///< constant of receivers and casters together, world units along the light's ray
  double s;          ///< slope bias
  double f;          ///< slope bias of casters
  double n;          ///< normal offset, texels
  double w;          ///< a texel's world width
  double near, far;  ///< of the map
  double z;          ///< depth at which a perspective map is taken: of the finite scene's centre
  double ulp;        ///< the depth format's step
  bool parallel;

  double range() const { return far - near; }
  /// Stored depth per world unit of depth.
  double stored_per_world() const { return parallel ? 1.0 / range() : near * far / (z * z * range()); }
};

Symbols symbols_of(const raster::Bias& bias, double constant_world, const raster::LightRecord& record,
                   const World& world) {
  const LightView& view = record.map.view;
  TexelCoordinate at;
  if (!world.finite_bounds.empty()) at = project_to_texel(view, world.finite_bounds.center());
  const LightFace& face = view.face(at.face);
  const double middle = std::sqrt(std::max(0.0, face.near_depth * face.far_depth));
  return {constant_world + raster::caster_bias_world(bias, view, world),
          bias.slope,
          bias.caster_slope,
          bias.normal_offset_texels,
          record.texel_world,
          face.near_depth,
          face.far_depth,
          at.depth > 0.0 ? at.depth : middle,
          record.rounding.stored_step,
          view.projection == LightProjection::orthographic};
}

using Units = std::vector<EngineUnit>;

constexpr const char* no_slope =
    "has no slope bias; the normal offset is its nearest kin, to be tried with --normal-offset";

void add_three(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back({"three.js", "shadow.bias", -q.b * q.stored_per_world(),
                   "-b near far / (z^2 (far - near)), at depth z"});
  else
    out.push_back({"three.js", "shadow.bias", -q.b / q.range(), "-b / (far - near)"});
  out.push_back({"three.js", "shadow.normalBias", q.n * q.w, "n w"});
}

void add_unity(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::directional) {
    out.push_back({"Unity (URP)", "Depth Bias", q.b / q.w, "b / w; with soft shadows over 2.5"});
    out.push_back({"Unity (URP)", "Normal Bias", q.n, "n; with soft shadows over 2.5"});
  } else {
    out.push_back({"Unity (URP)", "Depth Bias", std::nullopt,
                   "b N / (tan(angle / 2) Range), over 2.5 with soft shadows: Range is Unity's own"});
  }
}

void add_unreal(const Symbols& q, LightType light, Units& out) {
  if (light != LightType::directional) {
    out.push_back({"Unreal", "Shadow Bias", std::nullopt,
                   "of point and spot lights it is no length: it depends on the light's radius"});
    return;
  }
  out.push_back(
      {"Unreal", "Shadow Bias", q.b / (5.0 * q.w), "b / (5 w): cascaded maps with r.Shadow.CSMDepthBias 10"});
  if (q.b > 0.0)
    out.push_back({"Unreal", "Shadow Slope Bias", q.s * std::sqrt(0.5) * q.w / (3.0 * q.b),
                   "s w / (3 sqrt(2) b), with r.Shadow.CSMSlopeScaleDepthBias 3; it multiplies Shadow Bias"});
  else
    out.push_back({"Unreal", "Shadow Slope Bias", std::nullopt, "multiplies Shadow Bias, which is 0 here"});
}

void add_godot(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::directional)
    out.push_back({"Godot", "shadow_bias", 100.0 * q.b,
                   "100 b: Forward+, first split, shadow_blur 1; Godot scales the other splits"});
  else
    out.push_back({"Godot", "shadow_bias", std::nullopt,
                   "of omni and spot lights it scales with their range, which is Godot's own"});
  out.push_back({"Godot", "shadow_normal_bias", q.n, "n, of Godot's own texels"});
}

void add_bevy(const Symbols& q, LightType light, Units& out) {
  out.push_back({"Bevy", "shadow_depth_bias", q.b, "b"});
  const bool directional = light == LightType::directional;
  out.push_back({"Bevy", "shadow_normal_bias", directional ? std::optional(q.n) : std::nullopt,
                 directional ? "n" : "n times the texel that Bevy assumes at distance 1"});
}

void add_babylon(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back(
        {"Babylon.js", "bias", std::nullopt, "a share of the projected depth, whose scale is its own"});
  else
    out.push_back({"Babylon.js", "bias", q.b / q.range(),
                   light == LightType::directional
                       ? "b / (far - near); with PCF or contact hardening twice that"
                       : "b / (far - near)"});
  out.push_back({"Babylon.js", "normalBias", q.n * q.w, "n w"});
}

void add_playcanvas(const Symbols& q, Units& out) {
  out.push_back(
      {"PlayCanvas", "shadowBias", (q.s + q.f) / 10.0,
       "(s + f) / 10: a polygon offset of factor and units 10 each; it has no constant of its own"});
}

void add_filament(const Symbols& q, Units& out) {
  out.push_back({"Filament", "constantBias", q.b, "b"});
  out.push_back(
      {"Filament", "normalBias", std::nullopt, "multiplies an error that Filament works out itself"});
}

void add_polygon_offset(const Symbols& q, raster::DepthFormat format, Units& out) {
  out.push_back({"polygon offset", "factor", q.s + q.f, "s + f"});
  const bool floats = format == raster::DepthFormat::d32f || format == raster::DepthFormat::d32f_reversed;
  if (format == raster::DepthFormat::d32f_reversed) {
    out.push_back({"polygon offset", "units", std::nullopt,
                   "a step of a float shrinks towards 0, where a reversed map has its far end"});
    return;
  }
  const std::string step = format == raster::DepthFormat::d16 ? "2^-16" : "2^-24";
  const std::string depth = q.parallel ? "b / (far - near)" : "b near far / (z^2 (far - near))";
  out.push_back(
      {"polygon offset", "units", q.b * q.stored_per_world() / q.ulp,
       depth + " / " + step + (floats ? ", for stored depths from 1/2 on; nearer ones need more" : "")});
}

}  // namespace

std::vector<EngineUnit> engine_units(const raster::Bias& bias, double constant_world, LightType light,
                                     const raster::LightRecord& record, const World& world) {
  const Symbols q = symbols_of(bias, constant_world, record, world);
  Units out;
  add_three(q, light, out);
  add_unity(q, light, out);
  add_unreal(q, light, out);
  add_godot(q, light, out);
  add_bevy(q, light, out);
  add_babylon(q, light, out);
  add_playcanvas(q, out);
  add_filament(q, out);
  add_polygon_offset(q, record.map.format, out);
  const bool sloped = bias.slope != 0.0;
  if (sloped)
    for (const char* engine : {"three.js", "Unity (URP)", "Godot", "Bevy", "Babylon.js", "Filament"})
      out.push_back({engine, "slope", std::nullopt, no_slope});
  for (EngineUnit& unit : out)
    if (unit.value && *unit.value == 0.0) unit.value = 0.0;  // no -0
  return out;
}

std::vector<EngineUnit> engine_units(const Comparison& c, const LightComparison& light) {
  if (!draws_bias(c)) return {};
  const raster::LightRecord& record = drawn_record(c, light);
  return engine_units(c.raster.options.map.bias, record.bias_constant_world, light_of(c, light).type, record,
                      *c.world);
}

nlohmann::ordered_json engine_units_json(const std::vector<EngineUnit>& units) {
  auto list = nlohmann::ordered_json::array();
  for (const EngineUnit& unit : units)
    list.push_back({{"engine", unit.engine},
                    {"setting", unit.setting},
                    {"value", unit.value && std::isfinite(*unit.value) ? nlohmann::ordered_json(*unit.value)
                                                                       : nlohmann::ordered_json()},
                    {"formula", unit.formula}});
  return list;
}

}  // namespace gnomon::compare

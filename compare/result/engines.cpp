#include "compare/result/engines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/settings.h"

namespace gnomon::compare {
namespace {

using raster::Technique;
using Units = std::vector<EngineUnit>;

void add_three(const BiasSymbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back({"three.js", "shadow.bias", -q.b * q.stored_per_world,
                   "-b near far / (z^2 (far - near)), at depth z"});
  else
    out.push_back({"three.js", "shadow.bias", -q.b / q.range(), "-b / (far - near)"});
  out.push_back({"three.js", "shadow.normalBias", q.n * q.w, "n w", BiasPart::normal_offset});
}

void add_unity(const BiasSymbols& q, LightType light, Units& out) {
  if (light == LightType::directional) {
    out.push_back({"Unity (URP)", "Depth Bias", q.b / q.w, "b / w; with soft shadows over 2.5"});
    out.push_back(
        {"Unity (URP)", "Normal Bias", q.n, "n; with soft shadows over 2.5", BiasPart::normal_offset});
  } else {
    out.push_back({"Unity (URP)", "Depth Bias", std::nullopt,
                   "b N / (tan(angle / 2) Range), over 2.5 with soft shadows: Range is Unity's own"});
  }
}

void add_unreal(const BiasSymbols& q, LightType light, Units& out) {
  if (light != LightType::directional) {
    out.push_back({"Unreal", "Shadow Bias", std::nullopt,
                   "of point and spot lights it is no length: it depends on the light's radius"});
    return;
  }
  out.push_back(
      {"Unreal", "Shadow Bias", q.b / (5.0 * q.w), "b / (5 w): cascaded maps with r.Shadow.CSMDepthBias 10"});
  if (q.b > 0.0)
    out.push_back({"Unreal", "Shadow Slope Bias", q.s * std::sqrt(0.5) * q.w / (3.0 * q.b),
                   "s w / (3 sqrt(2) b), with r.Shadow.CSMSlopeScaleDepthBias 3; it multiplies Shadow Bias",
                   BiasPart::slope});
  else
    out.push_back({"Unreal", "Shadow Slope Bias", std::nullopt, "multiplies Shadow Bias, which is 0 here",
                   BiasPart::slope});
}

void add_godot(const BiasSymbols& q, LightType light, Units& out) {
  if (light == LightType::directional)
    out.push_back({"Godot", "shadow_bias", 100.0 * q.b,
                   "100 b: Forward+, first split, shadow_blur 1; Godot scales the other splits"});
  else
    out.push_back({"Godot", "shadow_bias", std::nullopt,
                   "of omni and spot lights it scales with their range, which is Godot's own"});
  out.push_back({"Godot", "shadow_normal_bias", q.n, "n, of Godot's own texels", BiasPart::normal_offset});
}

void add_godot3(const BiasSymbols& q, LightType, Units& out) {
  if (q.cascades)
    out.push_back({"Godot 3", "shadow_bias", std::nullopt,
                   "of PSSM it scales with the splits: present value x what is advised / what was drawn"});
  else
    out.push_back({"Godot 3", "shadow_bias", q.b, "b"});
}

void add_bevy(const BiasSymbols& q, LightType light, Units& out) {
  out.push_back({"Bevy", "shadow_depth_bias", q.b, "b"});
  const bool directional = light == LightType::directional;
  out.push_back({"Bevy", "shadow_normal_bias", directional ? std::optional(q.n) : std::nullopt,
                 directional ? "n" : "n times the texel that Bevy assumes at distance 1",
                 BiasPart::normal_offset});
}

void add_babylon(const BiasSymbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back(
        {"Babylon.js", "bias", std::nullopt, "a share of the projected depth, whose scale is its own"});
  else
    out.push_back({"Babylon.js", "bias", q.b / q.range(),
                   light == LightType::directional
                       ? "b / (far - near); with PCF or contact hardening twice that"
                       : "b / (far - near)"});
  out.push_back({"Babylon.js", "normalBias", q.n * q.w, "n w", BiasPart::normal_offset});
}

void add_playcanvas(const BiasSymbols& q, LightType light, Units& out) {
  out.push_back({"PlayCanvas", "shadowBias", (q.s + q.f) / 10.0,
                 "(s + f) / 10: a polygon offset of factor and units 10 each; it has no constant of its own",
                 BiasPart::slope});
  if (light == LightType::directional)
    out.push_back({"PlayCanvas", "normalOffsetBias", q.n * q.w, "n w", BiasPart::normal_offset});
  else
    out.push_back({"PlayCanvas", "normalOffsetBias", q.n * q.w / q.z,
                   "n w / z: it is multiplied by the depth, as a texel's width is", BiasPart::normal_offset});
}

void add_filament(const BiasSymbols& q, LightType, Units& out) {
  out.push_back({"Filament", "constantBias", q.b, "b"});
  out.push_back({"Filament", "normalBias", std::nullopt, "multiplies an error that Filament works out itself",
                 BiasPart::normal_offset});
}

void add_polygon_offset(const BiasSymbols& q, LightType, Units& out) {
  const raster::DepthFormat format = q.format;
  out.push_back({"polygon offset", "factor", q.s + q.f, "s + f", BiasPart::slope});
  const bool floats = format == raster::DepthFormat::d32f || format == raster::DepthFormat::d32f_reversed;
  if (format == raster::DepthFormat::d32f_reversed) {
    out.push_back({"polygon offset", "units", std::nullopt,
                   "a step of a float shrinks towards 0, where a reversed map has its far end"});
    return;
  }
  const std::string step = format == raster::DepthFormat::d16 ? "2^-16" : "2^-24";
  const std::string depth = q.parallel ? "b / (far - near)" : "b near far / (z^2 (far - near))";
  out.push_back(
      {"polygon offset", "units", q.b * q.stored_per_world / q.ulp,
       depth + " / " + step + (floats ? ", for stored depths from 1/2 on; nearer ones need more" : "")});
}

constexpr Technique unity[] = {Technique::hard, Technique::pcf, Technique::csm};
constexpr Technique unreal[] = {Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique godot[] = {Technique::hard, Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique godot3[] = {Technique::hard, Technique::pcf, Technique::csm};
constexpr Technique bevy[] = {Technique::pcf, Technique::pcss, Technique::csm};
constexpr Technique three[] = {Technique::hard, Technique::pcf, Technique::vsm, Technique::csm};
constexpr Technique babylon[] = {Technique::hard, Technique::pcf, Technique::pcss, Technique::esm,
                                 Technique::csm};
constexpr Technique playcanvas[] = {Technique::pcf, Technique::pcss,
                                    Technique::csm};  // of VSM the bias has no number
constexpr Technique filament[] = {Technique::pcf, Technique::pcss, Technique::vsm, Technique::csm,
                                  Technique::lispsm};

constexpr TunedEngine engines[] = {
    {.key = "three",
     .name = "three.js",
     .techniques = three,
     .front_faces_culled = true,
     .add_units = add_three},
    {.key = "unity",
     .name = "Unity (URP)",
     .techniques = unity,
     .constant_in_texels = true,
     .add_units = add_unity},
    {.key = "unreal",
     .name = "Unreal",
     .techniques = unreal,
     .constant_in_texels = true,
     .add_units = add_unreal},
    {.key = "godot",
     .name = "Godot",
     .techniques = godot,
     .front_faces_culled = true,
     .add_units = add_godot},
    {.key = "godot3",
     .name = "Godot 3",
     .techniques = godot3,
     .front_faces_culled = true,
     .add_units = add_godot3},
    {.key = "bevy", .name = "Bevy", .techniques = bevy, .add_units = add_bevy},
    {.key = "babylon",
     .name = "Babylon.js",
     .techniques = babylon,
     .front_faces_culled = true,
     .filtered_constant = 2.0,
     .add_units = add_babylon},
    {.key = "playcanvas",
     .name = "PlayCanvas",
     .techniques = playcanvas,
     .offsets_casters = true,
     .normal_offset_alone = Technique::pcss,
     .add_units = add_playcanvas},
    {.key = "filament", .name = "Filament", .techniques = filament, .add_units = add_filament},
    {.key = "", .name = "polygon offset", .techniques = {}, .add_units = add_polygon_offset},
};

/// Whether a part of a bias is a number in the engine's settings.
bool tells(const TunedEngine& engine, BiasPart part, LightType light, bool cascades) {
  BiasSymbols all;
  all.b = all.s = all.f = all.n = 1.0;
  all.parallel = light == LightType::directional, all.cascades = cascades;
  Units units;
  engine.add_units(all, light, units);
  return std::ranges::any_of(
      units, [&](const EngineUnit& unit) { return unit.part == part && unit.value.has_value(); });
}

}  // namespace

bool TunedEngine::has(BiasPart part) const {
  return tells(*this, part, LightType::directional, false);
}

bool TunedEngine::draws(const raster::MapOptions& map, LightType light) const {
  const raster::Bias& bias = map.bias;
  if (std::ranges::find(techniques, map.technique) == techniques.end()) return false;
  if ((map.cull == raster::Cull::front && !front_faces_culled) || bias.adaptive ||
      bias.caster_constant != 0.0)
    return false;
  if (raster::effective_options(map).bias.receiver_plane) return false;
  const double slope = offsets_casters ? bias.caster_slope : bias.slope;
  if ((offsets_casters ? bias.slope : bias.caster_slope) != 0.0) return false;
  if (slope != 0.0 && normal_offset_alone == map.technique) return false;
  const bool has_constant_part = has(BiasPart::constant) || bias.constant != 0.0;
  if (!has_constant_part && slope == 0.0 && bias.normal_offset_texels == 0.0) return false;
  const auto is_told = [&](bool has, BiasPart part) {
    return !has || tells(*this, part, light, raster::has_cascades(map.technique));
  };
  return is_told(has_constant_part, BiasPart::constant) && is_told(slope != 0.0, BiasPart::slope) &&
         is_told(bias.normal_offset_texels != 0.0, BiasPart::normal_offset);
}

bool TunedEngine::draws(const raster::MapOptions& map) const {
  return draws(map, LightType::directional) || draws(map, LightType::spot) || draws(map, LightType::point);
}

std::span<const TunedEngine> known_engines() {
  return engines;
}

std::span<const TunedEngine> tuned_engines() {
  return std::span(engines).first(std::size(engines) - 1);
}

const TunedEngine* find_engine(std::string_view key) {
  const auto found = std::ranges::find(tuned_engines(), key, &TunedEngine::key);
  return found == tuned_engines().end() ? nullptr : &*found;
}

const TunedEngine* engine_of_renderer(std::string_view name) {
  const TunedEngine* found = nullptr;
  for (const TunedEngine& engine : tuned_engines())
    if (name.starts_with(engine.name) && (found == nullptr || engine.name.size() > found->name.size()))
      found = &engine;
  return found;
}

bool any_engine_draws(const raster::MapOptions& map) {
  return std::ranges::any_of(tuned_engines(), [&](const TunedEngine& engine) { return engine.draws(map); });
}

}  // namespace gnomon::compare

#include "judge/capture.h"

#include <fmt/core.h>

#include <algorithm>

namespace gnomon::judge {
namespace {

Expected<void> check_depth(const Capture& capture) {
  const CapturedDepth& depth = *capture.depth;
  const auto wrong = [&](const char* field, std::string reason) {
    return capture_error(capture, fmt::format("depth.{}", field), std::move(reason));
  };
  if (depth.file.empty()) return wrong("file", "is missing");
  if (!depth.convention) return wrong("convention", "is missing");
  const bool of_buffer =
      *depth.convention == PixelDepth::zero_to_one || *depth.convention == PixelDepth::reversed;
  const std::string_view name = pixel_depth_names[static_cast<std::size_t>(*depth.convention)];
  if (of_buffer && !depth.near) return wrong("near", fmt::format("is missing; {} needs it", name));
  if (*depth.convention == PixelDepth::zero_to_one && !depth.far)
    return wrong("far", fmt::format("is missing; {} needs it", name));
  if (!of_buffer && (depth.near || depth.far))
    return wrong(depth.near ? "near" : "far", fmt::format("does not go with {}, which needs none", name));
  if (depth.near && depth.far && *depth.far <= *depth.near)
    return wrong("far", fmt::format("must be more than near (got {}, near {})", *depth.far, *depth.near));
  return {};
}

/// What all layers have in common of their biases.
Expected<void> check_layer_biases(const Capture& capture) {
  const CapturedBias own = capture.bias.value_or(CapturedBias{});
  for (std::size_t i = 1; i < capture.map.size(); ++i) {
    const CapturedBias first = capture.map[0].bias.value_or(own), bias = capture.map[i].bias.value_or(own);
    const char* differs = bias.slope != first.slope                               ? "slope"
                          : bias.angle != first.angle                             ? "angle"
                          : bias.min != first.min                                 ? "min"
                          : bias.max != first.max                                 ? "max"
                          : bias.normal_offset_angle != first.normal_offset_angle ? "normal_offset_angle"
                                                                                  : nullptr;
    if (differs != nullptr)
      return capture_error(
          capture, fmt::format("map[{}].bias.{}", i, differs),
          "differs from that of map[0]; layers may differ in constant_depth and normal_offset_world");
  }
  return {};
}

/// What of a layer's casters the convention leaves nothing to say of.
Expected<void> check_caster_bias(const Capture& capture, std::size_t i) {
  const CapturedLayer& layer = capture.map[i];
  if (!layer.caster_bias) return {};
  const CapturedCasterBias& bias = *layer.caster_bias;
  const auto wrong = [&](const char* field, const char* reason) {
    return capture_error(capture, fmt::format("map[{}].caster_bias.{}", i, field), reason);
  };
  const bool linear = is_linear(*layer.convention);
  constexpr const char* of_matrix =
      "is of the depths that a matrix makes; of distance, linear_z and paraboloid constant_world is known";
  if (linear && bias.slope != 0.0) return wrong("slope", of_matrix);
  if (linear && bias.clamp != 0.0) return wrong("clamp", of_matrix);
  if (*layer.convention == StoredDepth::linear_z && bias.constant != 0.0)
    return wrong("constant", "is not of linear_z; constant_world is, along the light's ray");
  if (bias.clamp != 0.0 && bias.constant == 0.0 && bias.slope == 0.0)
    return wrong("clamp", "limits constant and slope, and neither is there");
  return {};
}

Expected<void> check_map(const Capture& capture) {
  const std::size_t layers = capture.map.size();
  if (layers > most_layers)
    return capture_error(capture, "map", fmt::format("needs one layer to {}", most_layers));
  for (std::size_t i = 0; i < layers; ++i) {
    const CapturedLayer& layer = capture.map[i];
    const auto wrong = [&](const char* field, std::string reason) {
      return capture_error(capture, fmt::format("map[{}].{}", i, field), std::move(reason));
    };
    if (layer.depth.empty()) return wrong("depth", "is missing");
    if (!layer.convention) return wrong("convention", "is missing");
    if (!layer.rows) return wrong("rows", "is missing");
    if (!layer.clip_from_world) return wrong("clip_from_world", "is missing");
    if (const auto sound = check_caster_bias(capture, i); !sound) return sound;
    if (layer.convention != capture.map.front().convention)
      return wrong("convention", fmt::format("differs from that of map[0] (got {}, there {})",
                                             convention_of(*layer.convention).name,
                                             convention_of(*capture.map.front().convention).name));
    if (layer.range && !is_linear(*layer.convention))
      return wrong("range", "is of distance and linear_z; the matrix says it of the others");
    if (layer.range != capture.map.front().range) return wrong("range", "differs from that of map[0]");
    if (layer.select && layer.select->blend > 0.0 && i + 1 == layers)
      return wrong("select.blend",
                   "is towards the next layer, and there is none; `fade` is of shadows that end");
  }
  const auto has_select = [](const CapturedLayer& layer) { return layer.select.has_value(); };
  const auto selected = std::count_if(capture.map.begin(), capture.map.end(), has_select);
  if (selected != 0 && selected != static_cast<std::ptrdiff_t>(layers))
    return capture_error(capture, "map",
                         "has a select in some layers; it needs one in all of them or in none");
  if (const auto alike = check_layer_biases(capture); !alike) return alike;
  if (layers > 0) {
    const FilterRead read = capture.filter ? capture.filter->read : FilterRead::nearest;
    if (const auto sound = convention_of(read).check(capture); !sound) return sound;
    if (const auto sound = convention_of(*capture.map.front().convention).layout->check(capture); !sound)
      return sound;
  }
  if (layers == 0 && capture.bias) return capture_error(capture, "bias", "says nothing without map");
  if (layers == 0 && capture.filter) return capture_error(capture, "filter", "says nothing without map");
  if (layers == 0 && capture.fade) return capture_error(capture, "fade", "says nothing without map");
  return {};
}

}  // namespace

tl::unexpected<Error> capture_error(const Capture& capture, const std::string& field, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = capture.path.empty() ? "capture" : capture.path;
  error.field = capture.within + field;
  return fail(std::move(error));
}

Expected<void> check_capture(const Capture& capture) {
  const auto wrong = [&](const char* field, const char* reason) {
    return capture_error(capture, field, reason);
  };
  if (capture.renderer.empty()) return wrong("renderer", "is missing");
  if (capture.scene.empty()) return wrong("scene", "is missing");
  if (capture.size.pixels() == 0) return wrong("size", "is missing");
  const bool ratio = !capture.shadowed.empty() || !capture.unshadowed.empty();
  if (capture.visibility.empty() && !ratio)
    return wrong("visibility", "is missing, and so are shadowed and unshadowed");
  if (!capture.visibility.empty() && ratio)
    return wrong("visibility", "cannot stand beside shadowed and unshadowed");
  if (ratio && capture.shadowed.empty()) return wrong("shadowed", "is missing; unshadowed is there");
  if (ratio && capture.unshadowed.empty()) return wrong("unshadowed", "is missing; shadowed is there");
  if (!capture.position.empty() && capture.depth) return wrong("depth", "cannot stand beside position");
  if (capture.depth)
    if (const auto sound = check_depth(capture); !sound) return sound;
  if (capture.kind == RendererKind::ray_tracer && !capture.map.empty())
    return wrong("map", "is not of a ray tracer, which `renderer.kind` says this renderer is");
  return check_map(capture);
}

}  // namespace gnomon::judge

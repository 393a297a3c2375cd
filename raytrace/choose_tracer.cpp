#include "raytrace/choose_tracer.h"

#include <algorithm>

#include "raytrace/packets/light_setup.h"

namespace gnomon::raytrace {
namespace {

static_assert(most_primitives == BvhChild::first_mask);

/// Why packets of floats cannot trace this world; empty where they can.
std::string_view why_no_packets(const Tracer& tracer) {
  if (packets_apply(tracer)) return {};
  const Structures& s = tracer.structures();
  if (s.precision == Precision::fast) return "the textbook's arithmetic is traced as textbooks do";
  if (s.bvh.nodes.empty()) return "this structure has no hierarchy that packets could traverse";
  return "the scene's size or distance from the origin is out of the floats' range";
}

void choose_primary(const Tracer& tracer, const View& view, TracerPlan& plan) {
  const std::string_view obstacle = why_no_packets(tracer);
  if (!obstacle.empty()) {
    plan.primary = PrimaryMethod::single_rays, plan.primary_reason = obstacle;
  } else if (view.orthographic()) {
    plan.primary = PrimaryMethod::single_rays;
    plan.primary_reason = "an orthographic camera's rays start at no common point";
  } else if (!blocks_apply(tracer, view)) {
    plan.primary = PrimaryMethod::single_rays;
    plan.primary_reason = "the field of view is too wide for one frame to hold it";
  } else {
    plan.primary = PrimaryMethod::blocks;
    plan.primary_reason =
        "neighbouring pixels see the same primitives, and one frame holds the field of view";
  }
}

/// Receivers are 96 bytes a pixel, which to clear and to page in takes longer than to find them twice. They
/// need not be stored where nobody reads them but passes that find them again quickly.
void choose_receivers(const Tracer& tracer, std::span<const std::uint32_t> lights,
                      const RaytraceOptions& options, TracerPlan& plan) {
  const Structures& s = tracer.structures();
  plan.receivers = ReceiverStore::stored;
  const auto because = [&](bool holds, std::string_view reason) {
    if (holds && plan.receivers_reason.empty()) plan.receivers_reason = reason;
  };
  because(options.records || !options.picture, "the frame hands them on");
  because(plan.primary != PrimaryMethod::blocks, "single rays find them but once");
  because(s.has_shapes, "floats are not sure of curved shapes");
  for (const std::uint32_t i : lights) {
    const Light& light = s.world->scene->lights[i];
    because(has_size(light), "a light with size reads them for every sample");
    because(light.type == LightType::spot, "a spot light's cone is asked of each of them");
  }
  if (!plan.receivers_reason.empty()) return;
  plan.receivers = ReceiverStore::found_again;
  plan.receivers_reason = "only the picture is wanted, and to find them again is cheaper than to store them";
}

void choose_shadow(const Tracer& tracer, std::span<const std::uint32_t> lights,
                   const RaytraceOptions& options, TracerPlan& plan) {
  const bool asked = std::any_of(lights.begin(), lights.end(), [&](std::uint32_t i) {
    return options.records || !has_size(tracer.world().scene->lights[i]);
  });
  const std::string_view obstacle = why_no_packets(tracer);
  if (!asked) {
    plan.shadow_reason = "no light's centre is asked for";
  } else if (!obstacle.empty()) {
    plan.shadow = ShadowMethod::single_rays, plan.shadow_reason = obstacle;
  } else {
    plan.shadow = ShadowMethod::blocks;
    plan.shadow_reason =
        "neighbouring receivers see the light past the same primitives, and what lies elsewhere costs "
        "nothing";
  }
}

}  // namespace

std::string_view name_of(PrimaryMethod way) {
  constexpr std::array<std::string_view, 3> names{"none", "blocks of 64 x 64", "single rays"};
  return names[static_cast<std::size_t>(way)];
}
std::string_view name_of(ReceiverStore store) {
  constexpr std::array<std::string_view, 3> names{"none", "stored", "found again"};
  return names[static_cast<std::size_t>(store)];
}
std::string_view name_of(ShadowMethod way) {
  constexpr std::array<std::string_view, 3> names{"none", "blocks of 64 x 64", "single rays"};
  return names[static_cast<std::size_t>(way)];
}

TracerPlan choose_tracer(const Tracer& tracer, const View& view, std::span<const std::uint32_t> lights,
                         const RaytraceOptions& options) {
  TracerPlan plan;
  if (!options.records && options.samples_per_pixel > 1) {
    plan.primary_reason = "every sample of the pixel is a ray of its own, shaded as it is cast";
    plan.receivers_reason = plan.shadow_reason = "no ray goes through the pixel's centre";
    return plan;
  }
  choose_primary(tracer, view, plan);
  choose_receivers(tracer, lights, options, plan);
  choose_shadow(tracer, lights, options, plan);
  plan.quantised = plan.primary == PrimaryMethod::blocks && !lights.empty();
  return plan;
}

}  // namespace gnomon::raytrace

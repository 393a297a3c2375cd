// By which methods a frame's rays are traced. This is the one place that chooses; trace_frame() does what it says, and
// gnomon plan prints it with the reasons.
#pragma once

#include <span>
#include <string_view>

#include "raytrace/frame.h"

namespace gnomon::raytrace {

/// More than this no tree can number: its leaves have 27 bits for a primitive's position.
inline constexpr std::uint32_t most_primitives = (1u << 27) - 1;

/// How the rays from the eye find what they see.
enum class PrimaryMethod : std::uint8_t {
  none,        ///< the picture's own samples are all that is cast
  blocks,      ///< blocks of 64 x 64 pixels, packets of 16 rays (raytrace/packets/view_block.h)
  single_rays  ///< each by itself
};

/// Where the points that the eye sees are kept for the lights' passes and the picture.
enum class ReceiverStore : std::uint8_t {
  none,
  stored,      ///< in double, a frame's receivers
  found_again  ///< of each pixel the primitive alone; a tile's points are found again when they are asked for
};

/// How rays to a light's centre find what stands between.
enum class ShadowMethod : std::uint8_t {
  none,
  blocks,      ///< blocks of 64 x 64 receivers, packets of 16 rays (raytrace/packets/shadow_block.h)
  single_rays  ///< each by itself
};

std::string_view name_of(PrimaryMethod way);
std::string_view name_of(ReceiverStore store);
std::string_view name_of(ShadowMethod way);

struct TracerPlan {
  PrimaryMethod primary = PrimaryMethod::none;
  ReceiverStore receivers = ReceiverStore::none;
  ShadowMethod shadow = ShadowMethod::none;
  bool quantised = false;  ///< tiles of float receivers are made for the lights' passes
  std::string_view primary_reason, receivers_reason, shadow_reason;
};

/// `lights`: those whose truth trace_frame() is asked for.
TracerPlan choose_tracer(const Tracer& tracer, const View& view, std::span<const std::uint32_t> lights,
                         const RaytraceOptions& options);

}  // namespace gnomon::raytrace

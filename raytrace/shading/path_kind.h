// What a path of Whitted's recursion may do, what it has on its way, and what all paths of a picture have in common.
#pragma once

#include <cstdint>
#include <type_traits>

#include "raytrace/frame.h"
#include "raytrace/shading/interior.h"
#include "scene/camera.h"
#include "scene/effects.h"

namespace gnomon::raytrace {

enum class Secondary : std::uint8_t { none, mirror, glass };

/// What a path may do.
template <Secondary secondary>
struct PathKind {
  static constexpr bool reflects = secondary != Secondary::none;
  static constexpr bool refracts = secondary == Secondary::glass;
};

/// The other effects that the scene calls for.
struct ShadedEffects {
  explicit ShadedEffects(const EffectPlan& plan)
      : textures(plan.simulates(Effect::textures)),
        specular(plan.simulates(Effect::specular)),
        soft(plan.simulates(Effect::soft_shadow)),
        glossy(plan.simulates(Effect::glossy)),
        absorbs(plan.simulates(Effect::absorption)),
        indirect(plan.simulates(Effect::indirect_light)),
        vertex_colors(plan.simulates(Effect::vertex_colors)) {}
  bool textures, specular;
  bool soft;      ///< some light has a size
  bool glossy;    ///< some mirror or glass is rough
  bool absorbs;   ///< some glass takes light on the way through it
  bool indirect;  ///< the scene asks for it
  bool vertex_colors;
};

/// Where there is no glass there is nothing to be inside of.
struct NoGlass {};

/// What a ray has hit on its way into the recursion.
template <class Kind>
struct PathOf {
  using Inside = std::conditional_t<Kind::refracts, Interior, NoGlass>;
  Vec3 direction;                         ///< unit
  int depth = 0;                          ///< 0: from the eye
  double weight = 1.0;                    ///< share of the pixel
  int siblings = 1;                       ///< paths that share the pixel's samples with this one
  bool gathers = false;                   ///< has left a point to gather indirect light
  [[no_unique_address]] Inside inside{};  ///< the glass that the ray runs in
};

struct UnstoredReceivers;

/// What all pixels of a picture have in common.
struct PictureInput {
  const Tracer& tracer;
  const View& view;
  const RaytraceOptions& options;
  const ShadedEffects effects;
  Interior eye{};                               ///< the glass that the camera is in
  const UnstoredReceivers* unstored = nullptr;  ///< where the frame stores no receivers of pixel centres
  int first_row = 0;                            ///< of the view's picture; options.size begins there

  /// The number of the first pixel in the view's picture.
  std::size_t first_pixel() const {
    return static_cast<std::size_t>(first_row) * static_cast<std::size_t>(view.size.width);
  }
};

}  // namespace gnomon::raytrace

// Maps of a directional light that spend their texels where the camera needs them. Cascades have one face for
// each slice of the view (Zhang, Sun, Xu, Lun 2006, "Parallel-Split Shadow Maps for Large-scale Virtual
// Environments"). A warp goes towards the eye (Wimmer, Scherzer, Purgathofer 2004, "Light Space Perspective
// Shadow Maps").
#pragma once

#include <cmath>
#include <span>

#include "scene/light_map/light_view.h"

namespace gnomon {

struct CascadeOptions {
  int count = 4;        ///< in [1, 6]
  double lambda = 0.5;  ///< in [0, 1]: 0 splits the view's depth evenly, 1 evenly in its logarithm
  /// Each cascade covers the sphere around its slice, whose size is kept from camera to camera, and moves by
  /// whole texels: what stands still keeps its texels.
  bool snap = true;
  /// Splits and rectangles from the surfaces that the camera sees (Lauritzen, Salvi, Lefohn 2010, "Sample
  /// Distribution Shadow Maps"); follows every move of the camera, so `snap` does not apply.
  bool fit_samples = false;
  /// In [0, 0.5]: along the border of a cascade, over this share of its width, its test is mixed with the next one's.
  double blend = 0.0;
  /// The depth along the view at which each cascade ends, ascending, as the user gives them; empty: by `lambda`. There are
  /// `count` of them.
  NumberList splits{};
  bool operator==(const CascadeOptions&) const = default;
};

/// `visible`: surface points that the camera sees; read only when options.fit_samples. The last cascade
/// reaches as far as any shadow of a finite caster that the camera can see. Of an orthographic camera all slices are as wide: they
/// gain only where its depth is much greater than its picture. Error (graphics) when nothing can
/// be fitted.
Expected<LightView> fit_cascades(const World& world, const Light& light, const Camera& camera, double aspect,
                                 int size, const CascadeOptions& options, std::span<const Vec3> visible);

/// One face, warped by n_opt (section 4 of the paper). With the light along the view direction, and of an orthographic camera,
/// whose texels are as large on the screen near as far, no warp.
/// `snap`: all that the map depends on goes by steps, each of them outwards. The steps are a 64th of a turn, a quarter octave
/// of warp and width, a 16th of the sides. Between two steps the map stands still in the world to the last bit. A warp allows
/// no more: its texels differ in size, so that no way moves each of them onto another.
Expected<LightView> fit_warped(const World& world, const Light& light, const Camera& camera, double aspect,
                               int size, bool snap = false);

// Sizes that must not change with every step of the camera go by steps, four to an octave.

/// The least such size that is no smaller. `size` > 0.
inline double up_to_size_step(double size) {
  constexpr double steps_per_octave = 4.0;
  return std::exp2(std::ceil(std::log2(size) * steps_per_octave) / steps_per_octave);
}

}  // namespace gnomon

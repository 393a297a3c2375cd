// How well a capture agrees with Gnomon's own view of the scene, on samples of its pixels.
#pragma once

#include "compare/result/judged.h"
#include "judge/suspects.h"
#include "scene/light_map/light_view.h"

namespace gnomon::judge {

struct EvidenceInput {
  const raytrace::Tracer& tracer;
  std::uint32_t light = 0;
  const CapturedPictures& pictures;
  Sight sight;
  const LightView* map = nullptr;  ///< shadows are asked of places within it alone; null: everywhere
};

/// Irradiance of what faces the light; 0 else.
double light_on(const Light& light, const raytrace::SurfacePoint& point);

/// Pixels of the capture, by index: a grid over it, and the borders of what was drawn (by the capture, and by
/// Gnomon, as it is). Of a ratio that holds other light, in which nothing is black, neighbours on rows and columns.
struct Samples {
  std::vector<std::uint32_t> grid, border;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours;
  double brightest = 0.0;  ///< irradiance on the grid's surfaces
};
Samples choose_samples(const EvidenceInput& input, const raytrace::RayTracedFrame& frame);

/// Shares in [0, 1]; none where the capture does not tell.
struct Evidence {
  std::optional<double> positions, depths, silhouettes, visibility;
  std::size_t lit = 0, shadowed = 0;  ///< samples of visibility
  /// How many samples silhouettes have; the lesser of two shares of them: what Gnomon sees as something, and as nothing. A
  /// view in which all are something, or of few silhouettes, agrees with any picture.
  std::size_t outlines = 0;
  double least_kind = 0.5;
  float darkest = 1.0f, lightest = 0.0f;  ///< of the picture at these

  /// By positions, depths or silhouettes, the first that there is: its name and share.
  std::optional<compare::Agreement> geometry() const;
  std::vector<compare::Agreement> all() const;
};

/// The capture with what the suspect undoes.
Evidence gather(const EvidenceInput& input, const Samples& samples, const Suspect& suspect);

}  // namespace gnomon::judge

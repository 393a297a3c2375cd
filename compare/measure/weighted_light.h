// The truth weighed by what each part of a light contributes, beside the truth as a share of the light.
#pragma once

#include "compare/comparison.h"
#include "raytrace/tracer.h"

namespace gnomon::compare {

/// Adds up |W - V0| at receivers that see a part of a light with size. V0 is the share of the light that is seen. W is the share of
/// its unshadowed light that arrives. Samples are weighed by the cosine at the receiver, those of a disc or rectangle also by the
/// cosine at the light over the squared distance. That is equation 2 of Heitz, Hill and McGuire 2018, "Combining Analytic Direct
/// Illumination and Stochastic Shadows". Both are of the same samples, at receivers of some 4096 pixels spread over the picture.
class WeightedLight {
 public:
  /// Rows of `all_pixels`, the first pixel of which is `first_pixel`; `truth` says who sees a part.
  void add(const raytrace::Tracer& tracer, const Light& light, int samples,
           const Image<raytrace::SurfacePoint>& receivers, const Image<float>& truth,
           const Image<Label>& labels, std::size_t first_pixel, std::size_t all_pixels);
  void write_to(PenumbraStats& out) const;

 private:
  double sum_ = 0.0;
  std::uint64_t receivers_ = 0;
};

}  // namespace gnomon::compare

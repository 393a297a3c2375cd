// The frames that a still camera's history holds, one after the other: their rays, and what the denoiser draws of the last.
#pragma once

#include <memory>

#include "rays/denoiser.h"
#include "raytrace/tracer.h"

namespace gnomon::rays {

/// What the frames of one light share. All must outlive who reads it.
struct StillScene {
  const raytrace::Tracer& tracer;
  RaysWanted wanted;  ///< its frame is not read
  const Guides& guides;
  const Image<raytrace::SurfacePoint>& receivers;
};

/// The rays' shares, and with passengers the truth of the pixel whose rays they are.
template <std::size_t count>
Image<Signal<count>> signal_of(const LightRays& rays, const Image<float>* truth);

/// How many frames are cast before the one that is drawn: options.history - 1.
inline int frames_before(const raster::RayOptions& options) {
  return options.history - 1;
}

/// Draws with the whole history, from its first frame on, for `truth` at each receiver.
Image<Signal<with_passengers>> carry_passengers(const StillScene& scene, const Image<float>& truth);

/// The history of a film with its passengers, frame after frame from the first.
class FilmPassengers {
 public:
  /// Draws the next frame, for `truth` at each of its receivers.
  Image<Signal<with_passengers>> carry(const StillScene& scene, const Image<float>& truth);

 private:
  std::unique_ptr<Denoiser<with_passengers>> denoiser_;
  std::uint32_t frame_ = 0;
};

}  // namespace gnomon::rays

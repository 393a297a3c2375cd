#include "rays/frames.h"

namespace gnomon::rays {

template <std::size_t count>
Image<Signal<count>> signal_of(const LightRays& rays, const Image<float>* truth) {
  Image<Signal<count>> signal(rays.share.size, all_of<count>(1.0f));
  parallel_for(signal.data.size(), [&](std::size_t i) {
    const std::uint32_t source = rays.source.data[i];
    if (source == no_id) return;
    Signal<count>& out = signal.data[i];
    out[drawn] = rays.share.data[i];
    if constexpr (count > alone) {
      out[sampled] = out[drawn];
      out[lagged] = out[blurred] = truth->data[source];
    }
  });
  return signal;
}
template Image<Signal<alone>> signal_of<alone>(const LightRays&, const Image<float>*);
template Image<Signal<with_passengers>> signal_of<with_passengers>(const LightRays&, const Image<float>*);

Image<Signal<with_passengers>> carry_passengers(const StillScene& scene, const Image<float>& truth) {
  const raster::RayOptions& options = scene.wanted.options;
  const auto denoiser = make_denoiser<with_passengers>(options, scene.guides.size);
  Image<Signal<with_passengers>> out;
  RaysWanted wanted = scene.wanted;
  for (int frame = 0; frame <= frames_before(options); ++frame) {
    wanted.frame = static_cast<std::uint32_t>(frame);
    const LightRays rays = cast_rays(scene.tracer, wanted, scene.guides, scene.receivers);
    denoiser->add({scene.guides, rays, signal_of<with_passengers>(rays, &truth)}, out);
  }
  return out;
}

Image<Signal<with_passengers>> FilmPassengers::carry(const StillScene& scene, const Image<float>& truth) {
  if (!denoiser_) denoiser_ = make_denoiser<with_passengers>(scene.wanted.options, scene.guides.size);
  RaysWanted wanted = scene.wanted;
  wanted.frame = frame_++;
  const LightRays rays = cast_rays(scene.tracer, wanted, scene.guides, scene.receivers);
  Image<Signal<with_passengers>> out;
  denoiser_->add({scene.guides, rays, signal_of<with_passengers>(rays, &truth), true}, out);
  return out;
}

}  // namespace gnomon::rays

#include "rays/denoiser.h"

namespace gnomon::rays {

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_denoiser(const raster::RayOptions& options, ImageSize size) {
  switch (options.denoiser) {
    case raster::Denoiser::none:
      break;
    case raster::Denoiser::penumbra:
      return make_penumbra<count>(options.history, size);
    case raster::Denoiser::atrous:
      return make_atrous<count>(options.history, size);
    case raster::Denoiser::svgf:
      return make_svgf<count>(size);
    case raster::Denoiser::fidelityfx:
      return make_fidelityfx<count>(size);
  }
  return make_none<count>(options.history, size);
}
template std::unique_ptr<Denoiser<alone>> make_denoiser<alone>(const raster::RayOptions&, ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_denoiser<with_passengers>(const raster::RayOptions&,
                                                                                   ImageSize);

}  // namespace gnomon::rays

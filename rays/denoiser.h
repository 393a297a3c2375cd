// Denoisers: each takes frame after frame of few rays and says what is drawn of the last. All that they do to the picture is a
// sum with weights of neighbours and of earlier frames, but for clamps and contrasts, which act on Channel::drawn alone.
#pragma once

#include <memory>

#include "raster/options.h"
#include "rays/guides.h"
#include "rays/light_rays.h"
#include "rays/signal.h"
#include "scene/base/parallel.h"

namespace gnomon::rays {

/// One frame as a denoiser takes it.
template <std::size_t count>
struct NoisyFrame {
  const Guides& guides;
  const LightRays& rays;
  const Image<Signal<count>>& signal;  ///< 1 where no ray is asked for
  /// Something may have moved since the frame before: another truth than this frame's is in the history.
  bool moves = false;
};

template <std::size_t count>
class Denoiser {
 public:
  Denoiser() = default;
  Denoiser& operator=(const Denoiser&) = delete;
  virtual ~Denoiser() = default;
  /// Takes the frame into the history and draws it. Pixels that are not asked stay 1. Returns how many values of neighbours and
  /// of the history were read.
  virtual std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) = 0;
  /// With the same history.
  virtual std::unique_ptr<Denoiser> clone() const = 0;
  /// What is kept from frame to frame.
  virtual std::uint64_t history_bytes() const = 0;

 protected:
  Denoiser(const Denoiser&) = default;
};

/// Frames come from one camera that stands still. A pixel's history is given up where it shows another place.
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_denoiser(const raster::RayOptions& options, ImageSize size);

// The kinds; `frames`: how many the mean of the history holds at most.

/// The rays as they are: the mean of the frames.
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_none(int frames, ImageSize size);
/// denoisers/penumbra.cpp
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_penumbra(int frames, ImageSize size);
/// denoisers/atrous.cpp
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_atrous(int frames, ImageSize size);
/// denoisers/svgf.cpp
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_svgf(ImageSize size);
/// denoisers/fidelityfx.cpp
template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_fidelityfx(ImageSize size);

/// Writes signal(x, y, taps) to every pixel that is asked, and 1 to the others; returns the sum of taps.
template <std::size_t count, class Filter>
std::uint64_t filter_asked(const Guides& guides, Image<Signal<count>>& out, const Filter& filter) {
  if (!(out.size == guides.size)) out = Image<Signal<count>>(guides.size);
  return parallel_reduce(
      static_cast<std::size_t>(guides.size.height), 8, std::uint64_t{0},
      [&](std::size_t first, std::size_t last, std::uint64_t taps) {
        for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y)
          for (int x = 0; x < guides.size.width; ++x)
            out.at(x, y) = guides.at(x, y).asked() ? filter(x, y, taps) : all_of<count>(1.0f);
        return taps;
      },
      [](std::uint64_t a, std::uint64_t b) { return a + b; });
}

inline bool lies_in(const ImageSize& size, int x, int y) {
  return x >= 0 && y >= 0 && x < size.width && y < size.height;
}

}  // namespace gnomon::rays

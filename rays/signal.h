// What a denoiser filters: at each pixel the share of the rays that arrived, alone or with passengers.
//
// A denoiser is a sum with weights that it works out from the rays and from what the camera sees. What else is carried through
// the same weights tells what they do by themselves. So three passengers ride along where the picture is explained. One is the
// rays' shares without the denoiser's nonlinear ends; one the truth of every frame that the history holds; one this frame's truth.
#pragma once

#include <array>
#include <cstddef>

#include "scene/image.h"

namespace gnomon::rays {

/// Is the place of a channel in a Signal.
enum Channel : std::size_t {
  drawn,    ///< what decides the weights, and is drawn in the end
  sampled,  ///< the same without clamps and contrast
  lagged,   ///< each frame's truth in place of its rays
  blurred   ///< this frame's truth in place of all frames' rays
};

inline constexpr std::size_t alone = 1, with_passengers = 4;

/// Visibilities of one pixel: 1 lit, 0 shadowed. `count`: alone or with_passengers.
template <std::size_t count>
using Signal = std::array<float, count>;

template <std::size_t count>
Signal<count> all_of(float value) {
  Signal<count> signal;
  signal.fill(value);
  return signal;
}

/// Adds weight times `more`.
template <std::size_t count>
void add_weighted(float weight, const Signal<count>& more, Signal<count>& sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += weight * more[i];
}

template <std::size_t count>
Signal<count> scaled(const Signal<count>& signal, float factor) {
  Signal<count> out;
  for (std::size_t i = 0; i < count; ++i) out[i] = factor * signal[i];
  return out;
}

/// Returns `from` where `share` is 0, `to` where it is 1.
template <std::size_t count>
Signal<count> between(const Signal<count>& from, const Signal<count>& to, float share) {
  Signal<count> out;
  for (std::size_t i = 0; i < count; ++i) out[i] = from[i] + share * (to[i] - from[i]);
  return out;
}

}  // namespace gnomon::rays

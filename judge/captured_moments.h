// A captured map of moments: what its channels and its filter's keys say, and the usual mistakes in them.
#pragma once

#include "judge/capture.h"
#include "judge/test_suspects.h"
#include "raster/frame.h"

namespace gnomon::compare {

/// Returns how the capture's filter reads moments; `texels` stay empty. Needs reads_moments().
raster::CapturedMoments moments_of(const Capture& capture);

/// A layer's stored numbers, rows as in its picture. Of moments they are the means that these tell.
struct LayerNumbers {
  ImageSize size;
  std::vector<float> values;
  std::vector<raster::CapturedMoments::Texel> moments;  ///< empty where the layer holds none
};

/// Reads a layer of moments, in the channels R, G, B, A as many as its kind has. Errors (bad input) name picture and field: a
/// channel that is missing, or numbers that are not finite.
Expected<LayerNumbers> read_moments(const Capture& capture, std::size_t layer,
                                    const raster::CapturedMoments& moments);

/// Adds other numbers of the formula; nothing where the test reads no moments.
void add_moment_suspects(const raster::CapturedMoments& moments, std::vector<TestSuspect>& suspects);

}  // namespace gnomon::compare

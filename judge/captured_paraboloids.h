// A captured map of two paraboloids: its halves as the test reads them, beside a cube for the exact side of the ladder, and the
// usual mistakes in them.
#pragma once

#include "judge/captured_map.h"
#include "judge/test_suspects.h"

namespace gnomon::compare {

/// Errors (bad input): a matrix that is no turn and shift, or not the light's; halves that do not look opposite ways.
Expected<void> check_paraboloids(const Capture& capture, const Light& light, const World& world);

/// Reads both halves. The cube has about as many texels as they have together, each with the number of the paraboloid's texel in
/// which its middle lies. Errors (bad input): those of check_paraboloids(); a picture that cannot be read; numbers that are not
/// finite.
Expected<CapturedMap> read_paraboloids(const Capture& capture, const Light& light, const World& world);

/// Adds other orders of rows and halves; nothing where the test reads no paraboloids.
void add_paraboloid_suspects(const raster::CapturedTest& test, std::vector<TestSuspect>& suspects);

}  // namespace gnomon::compare

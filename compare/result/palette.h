// The fixed colours of the pictures. Scales never change from image to image, so that any two can be
// compared.
#pragma once

#include "scene/image.h"

namespace gnomon::compare {

/// Drawn dark, truly lit; and drawn lit, truly dark (Okabe & Ito 2008).
inline constexpr glm::u8vec3 false_shadow_colour{0xd5, 0x5e, 0x00};
inline constexpr glm::u8vec3 missed_shadow_colour{0x56, 0xb4, 0xe9};
/// A right pixel in shadow, in the label picture (a right lit pixel has label_colour(Label::right)).
inline constexpr glm::u8vec3 right_in_shadow_colour{0xc6, 0xc6, 0xc2};
/// Who decided a pixel of the hybrid; the first two tint the grey picture.
inline constexpr glm::u8vec3 surely_lit_colour{0xf0, 0xe4, 0x42}, surely_shadowed_colour{0x00, 0x72, 0xb2},
    traced_colour{0xa0, 0x00, 0x30};
/// Where nothing was stored in a depth map, and the gaps between its faces.
inline constexpr glm::u8vec3 nothing_stored_colour{0x3c, 0x42, 0x4c};

/// Grey of a picture, kept between 64 and 232 so that both error colours stand out from it.
glm::u8vec3 grey_backdrop(const glm::u8vec3& colour);

/// Viridis (Smith & van der Walt 2015) at t in [0, 1]: dark purple to bright yellow; clamped.
glm::u8vec3 viridis(double t);
/// Magma, from black over purple and orange to pale yellow: for errors, 0 no error; clamped, NaN as 0.
glm::u8vec3 magma(double t);

}  // namespace gnomon::compare

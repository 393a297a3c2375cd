// How a texture is looked up: one formula for both renderers (the rasterizer's GLSL twin uses texelFetch and
// the same arithmetic, never the driver's filter). No mipmaps: both renderers sample the full resolution.
//
// For a texture of W x H texels, texel (i, j) covers [i/W, (i+1)/W) x [j/H, (j+1)/H) of (u, v); j = 0 is the
// top row and v = 0 its upper edge. Each axis by itself (N texels, coordinate t):
//   wrap      repeat: t' = t - floor(t)                clamp: t' = min(max(t, 0), 1)
//   nearest   index = floor(t' N)
//   bilinear  x = t' N - 1/2, i = floor(x), f = x - i; texels i and i + 1 with weights 1 - f and f
//   indices   repeat: modulo N (so -1 is N - 1)        clamp: to 0 … N - 1
// RGB of an sRGB texture is decoded per texel, before the weights; alpha is linear (value / 255).
#pragma once

#include <array>

#include "scene/scene.h"

namespace gnomon {

/// uv' = offset + R (scale * uv) with R = [cos r, sin r; -sin r, cos r]: KHR_texture_transform, a rotation
/// that looks counter-clockwise where v points down.
Vec2 transform_uv(const TextureTransform& transform, const Vec2& uv);

/// Linear RGB and alpha at (u, v), after any transform. The texture has at least one texel; a coordinate that
/// is not finite counts as 0.
Vec4f sample_texture(const Texture& texture, const Vec2& uv);

/// IEC 61966-2-1 decoding of the 256 8-bit values, for those who fill textures on another device.
const std::array<float, 256>& linear_from_srgb8();

}  // namespace gnomon

// Seeded, stratified sample points. What a point is depends on the seed, the pixel and its number alone, so
// pictures are the same for any number of threads. Kollig and Keller 2002, "Efficient Multidimensional
// Sampling" (scrambled Hammersley points: of 2^m points each box of area 2^-m of the elementary grids holds
// exactly one).
#pragma once

#include <bit>
#include <cstdint>

#include "scene/math.h"

namespace gnomon::raytrace {

/// SplitMix64's finaliser (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}
/// A key of its own for each pair.
constexpr std::uint64_t sample_key(std::uint64_t key, std::uint64_t index) {
  return mix_bits(mix_bits(key) + index);
}

constexpr std::uint32_t reversed_bits(std::uint32_t v) {
  v = (v >> 16) | (v << 16);
  v = ((v & 0xff00ff00U) >> 8) | ((v & 0x00ff00ffU) << 8);
  v = ((v & 0xf0f0f0f0U) >> 4) | ((v & 0x0f0f0f0fU) << 4);
  v = ((v & 0xccccccccU) >> 2) | ((v & 0x33333333U) << 2);
  return ((v & 0xaaaaaaaaU) >> 1) | ((v & 0x55555555U) << 1);
}

/// `count` (1 to 2^31) points of the unit square [0, 1)^2, each uniformly distributed, one in each of `count`
/// columns.
class StratifiedSquare {
 public:
  StratifiedSquare(std::uint32_t count, std::uint64_t key)
      : count_(count),
        free_bits_(0xffffffffU >> std::bit_width(count - 1)),
        key_(key),
        scramble_(static_cast<std::uint32_t>(mix_bits(key))) {}

  Vec2 operator[](std::uint32_t i) const {
    const std::uint64_t jitter = sample_key(key_, i);
    const auto low = static_cast<std::uint32_t>(jitter), high = static_cast<std::uint32_t>(jitter >> 32);
    const std::uint32_t row = ((reversed_bits(i) ^ scramble_) & ~free_bits_) | (low & free_bits_);
    return {(i + high * 0x1p-32) / count_, row * 0x1p-32};
  }

 private:
  std::uint32_t count_, free_bits_;
  std::uint64_t key_;
  std::uint32_t scramble_;
};

/// A direction of the hemisphere around the unit vector n, as likely as its cosine with n: the disc lifted
/// onto the hemisphere (Malley's method; PBR 4th ed., section A.5.3).
inline Vec3 cosine_direction(const Vec3& n, const Vec2& square) {
  Vec3 tangent, bitangent;
  orthonormal_basis(n, tangent, bitangent);
  const Vec2 p = concentric_disc(square);
  return p.x * tangent + p.y * bitangent + std::sqrt(std::max(0.0, 1.0 - glm::dot(p, p))) * n;
}

}  // namespace gnomon::raytrace

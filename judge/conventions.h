// What a captured map holds and how it is read: a row for each word that a capture may say. A new convention is a row here and
// one file; its word goes into capture.schema.json and docs/capture.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "scene/base/expected.h"
#include "scene/light.h"
#include "scene/world.h"

namespace gnomon::judge {

struct Capture;
struct CapturedMap;
class CapturedTest;

/// What the light's matrix makes of depth, and what a texel of its map holds.
enum class StoredDepth : std::uint8_t {
  zero_to_one,
  minus_one_to_one,
  reversed,
  distance,
  linear_z,
  paraboloid,
};
/// What a texel's number is: the depth of the matrix, a distance from the light, or a depth along the light's axis. The last
/// two are even in world units.
enum class Stores : std::uint8_t { depths, distances, linear_z };

/// How a map is looked up.
struct MapLayout {
  /// Says what a capture of it has too much or too little: bad input, with the field.
  Expected<void> (*check)(const Capture& capture);
  /// Errors (bad input): a matrix that is not of this layout, or not the light's.
  Expected<void> (*check_matrices)(const Capture& capture, const Light& light, const World& world);
  /// Reads all layers. Errors (bad input): those of check_matrices; a picture that cannot be read; numbers that are none.
  Expected<CapturedMap> (*read)(const Capture& capture, const Light& light, const World& world);
};
extern const MapLayout projected_layout;   ///< captured_map.cpp: a matrix projects each layer
extern const MapLayout paraboloid_layout;  ///< paraboloids.cpp

struct StoredConvention {
  std::string_view name;
  Stores stores = Stores::depths;
  bool halves = false;    ///< the matrix makes depths of -1 to 1
  bool reversed = false;  ///< of the matrix's depths, 1 is near
  bool since_2 = false;   ///< capture.json: not of version 1
  const MapLayout* layout = &projected_layout;
};
inline constexpr std::array<StoredConvention, 6> stored_conventions{
    {{"zero_to_one"},
     {"minus_one_to_one", Stores::depths, true},
     {"reversed", Stores::depths, false, true},
     {"distance", Stores::distances, true},
     {"linear_z", Stores::linear_z, true, false, true},
     {"paraboloid", Stores::distances, true, false, true, &paraboloid_layout}}};
constexpr const StoredConvention& convention_of(StoredDepth stored) {
  return stored_conventions[static_cast<std::size_t>(stored)];
}
/// Whether stored numbers are world units, or evenly spaced in them (CapturedLayer::range), whatever the matrix makes of depth.
constexpr bool is_linear(StoredDepth stored) {
  return convention_of(stored).stores != Stores::depths;
}

/// Which numbers are compared.
enum class FilterRead : std::uint8_t {
  nearest,        ///< the texel's own
  linear_depths,  ///< what is read between the four nearest texels, each weighed by how near it is
  moments,        ///< the number up to which moments that are so read leave half of the light
};
struct ReadConvention {
  std::string_view name;
  /// Returns the test without a map.
  std::shared_ptr<CapturedTest> (*make)(const Capture& capture);
  /// As MapLayout::check.
  Expected<void> (*check)(const Capture& capture);
};
std::shared_ptr<CapturedTest> make_depths_test(const Capture& capture);   // captured_test.cpp
std::shared_ptr<CapturedTest> make_moments_test(const Capture& capture);  // moments_test.cpp
Expected<void> check_moments(const Capture& capture);
inline Expected<void> check_nothing(const Capture&) {
  return {};
}
inline constexpr std::array<ReadConvention, 3> read_conventions{
    {{"nearest", make_depths_test, check_nothing},
     {"linear_depths", make_depths_test, check_nothing},
     {"moments", make_moments_test, check_moments}}};
constexpr const ReadConvention& convention_of(FilterRead read) {
  return read_conventions[static_cast<std::size_t>(read)];
}

/// The words of a table.
template <class Row, std::size_t N>
constexpr std::array<std::string_view, N> names_of(const std::array<Row, N>& rows) {
  std::array<std::string_view, N> names;
  for (std::size_t i = 0; i < N; ++i) names[i] = rows[i].name;
  return names;
}

/// How a bias grows with the angle between the receiver's normal and the light.
enum class BiasAngle : std::uint8_t { none, sine, tangent, one_minus_cosine };
inline constexpr std::array<std::string_view, 4> bias_angle_names{"none", "sine", "tangent",
                                                                  "one_minus_cosine"};

}  // namespace gnomon::judge

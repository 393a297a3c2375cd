// Dual paraboloid maps (Brabec, Annen and Seidel 2002, section 3), of which each layer is one half. Let something lie from the
// light in the unit direction d, in the half's own axes. It is looked up at d.xy / (1 + d.z), which runs from -1 to 1 where
// d.z >= 0.
#include <fmt/core.h>

#include "judge/directions_test.h"

namespace gnomon::judge {
namespace {

constexpr double axis_slack = 1e-4;

class ParaboloidsTest final : public DirectionsTest {
 public:
  std::vector<Mat3>
      half_from_world{};  ///< of directions: a turn, or one that mirrors; two that look opposite ways

  /// In the first half, unless it points away from that one's axis.
  DirectionPlace place(const Vec3& direction) const override {
    const std::size_t half = (half_from_world[0] * direction).z >= 0.0 ? 0 : 1;
    const Vec3 d = half_from_world[half] * direction;
    const DistanceLayer& layer = pictures[half];
    return {half, 0.5 * (d.x / (1.0 + d.z) + 1.0) * layer.width,
            0.5 * (d.y / (1.0 + d.z) + 1.0) * layer.height};
  }
  /// d.z = (1 - r^2) / (1 + r^2), and d.xy = (1 + d.z) (x, y).
  Vec3 direction(const DirectionPlace& place) const override {
    const DistanceLayer& layer = pictures[place.layer];
    const double x = 2.0 * place.u / layer.width - 1.0, y = 2.0 * place.v / layer.height - 1.0;
    const double square = x * x + y * y, more = 2.0 / (1.0 + square);
    return glm::transpose(half_from_world[place.layer]) * Vec3(more * x, more * y, more - 1.0);
  }
  std::shared_ptr<CapturedTest> clone() const override { return std::make_shared<ParaboloidsTest>(*this); }
};

Expected<std::vector<LightTurn>> read_halves(const Capture& capture, const Light& light, const World& world) {
  std::vector<LightTurn> halves;
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const auto half =
        read_turn(capture, i, light, world,
                  "a half's matrix is the light's view without a projection, z along the half's axis");
    if (!half) return fail(half.error());
    halves.push_back(*half);
  }
  const auto axis = [&](std::size_t i) { return glm::transpose(halves[i].turn)[2]; };
  if (glm::dot(axis(0), axis(1)) > axis_slack - 1.0)
    return capture_error(capture, "map[1].clip_from_world", "does not look the opposite way of map[0]");
  return halves;
}

Expected<void> check_halves(const Capture& capture) {
  if (capture.map.size() != 2)
    return capture_error(capture, "map", "of paraboloids has two layers, one for each half");
  for (std::size_t i = 0; i < 2; ++i) {
    const CapturedLayer& layer = capture.map[i];
    const std::string field = fmt::format("map[{}].", i);
    if (layer.bias)
      return capture_error(capture, field + "bias", "is not of paraboloids: `bias` is that of both halves");
    if (layer.caster_bias != capture.map.front().caster_bias)
      return capture_error(capture, field + "caster_bias", "differs from that of the other half");
  }
  return check_directions(capture, "paraboloids");
}

Expected<void> check_half_matrices(const Capture& capture, const Light& light, const World& world) {
  const auto halves = read_halves(capture, light, world);
  if (!halves) return fail(halves.error());
  return {};
}

Expected<CapturedMap> read_paraboloids(const Capture& capture, const Light& light, const World& world) {
  const auto halves = read_halves(capture, light, world);
  if (!halves) return fail(halves.error());
  const auto test = std::make_shared<ParaboloidsTest>();
  for (const LightTurn& half : *halves) test->half_from_world.push_back(half.turn);
  constexpr double share_of_disc = 0.25 * pi;
  return read_directions(capture, halves->front().origin, test, share_of_disc);
}

}  // namespace

const MapLayout paraboloid_layout{check_halves, check_half_matrices, read_paraboloids};

}  // namespace gnomon::judge

// An instance repeated on a lattice: the "repeat" of a JSON scene's instance.
#include <fmt/core.h>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/files/json/json_parts.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

constexpr NumberRange copies_range{1.0, 256.0, false, false, true};
constexpr NumberRange seed_range{0.0, 4294967295.0, false, false, true};

struct Repeat {
  std::array<int, 2> count{1, 1};
  Vec2 spacing{1.0};
  double jitter = 0.0;
  bool turn = false;
  Vec2 scale{1.0};
  std::uint64_t seed = 1;
};

Repeat read(const JsonObject& object) {
  Repeat r;
  if (const auto count = object.require("count")) {
    const auto items = count->as_array(2);
    for (std::size_t i = 0; i < items.size(); ++i)
      r.count[i] = static_cast<int>(std::max(1.0, items[i].as_number(copies_range)));
  }
  if (const auto spacing = object.require("spacing")) {
    r.spacing = spacing->as_scale2();
    if (!(r.spacing.x > 0.0 && r.spacing.y > 0.0))
      spacing->error("leaves no room between copies (allowed: numbers > 0)");
  }
  r.jitter = object.number("jitter", 0.0, unit_interval);
  r.turn = object.boolean("turn", false);
  if (const auto scale = object.find("scale")) {
    r.scale = scale->as_vec2();
    if (!(r.scale.x > 0.0 && r.scale.x <= r.scale.y))
      scale->error("is no range (allowed: two numbers > 0, the second not less than the first)");
  }
  r.seed = static_cast<std::uint64_t>(object.number("seed", 1.0, seed_range));
  return r;
}

}  // namespace

std::vector<RepeatedPlace> read_repeat(const JsonNode& node) {
  const Repeat r = read(JsonObject(node, {"count", "spacing", "jitter", "turn", "scale", "seed"}));
  std::vector<RepeatedPlace> places;
  if (node.errors().first) return places;
  Random random(r.seed);
  for (int z = 0; z < r.count[1]; ++z)
    for (int x = 0; x < r.count[0]; ++x) {
      const double along = x + 0.5 - 0.5 * r.count[0] + 0.5 * r.jitter * random.between(-1.0, 1.0);
      const double across = z + 0.5 - 0.5 * r.count[1] + 0.5 * r.jitter * random.between(-1.0, 1.0);
      const double angle = random.between(0.0, 2.0 * pi), size = random.between(r.scale.x, r.scale.y);
      RepeatedPlace place;
      place.offset = {r.spacing.x * along, 0.0, r.spacing.y * across};
      if (r.turn) place.own = glm::rotate(place.own, angle, Vec3(0.0, 1.0, 0.0));
      place.own = glm::scale(place.own, Vec3(size));
      places.push_back(place);
    }
  return places;
}

}  // namespace gnomon

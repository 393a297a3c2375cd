#include "compare/result/places.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

constexpr int longer_side = 64;  // squares

Vec2 from_above(const Vec3& point) {
  return {point.x, point.z};
}

Vec2 middle_of(const ErrorPlaces& places, std::size_t cell) {
  const auto columns = static_cast<std::size_t>(places.columns);
  const std::size_t column = cell % columns, row = cell / columns;
  return places.corner + places.side * (Vec2(double(column), double(row)) + 0.5);
}

double all_error(const ErrorPlaces& places) {
  double sum = places.beyond.error;
  for (const ErrorPlaces::Cell& cell : places.cells) sum += cell.error;
  return sum;
}

/// The square that a point lies above or below; that of what lies beyond them all.
ErrorPlaces::Cell& cell_at(ErrorPlaces& places, const Vec3& point) {
  const Vec2 at = glm::floor((from_above(point) - places.corner) / places.side);
  const bool inside = at.x >= 0.0 && at.y >= 0.0 && at.x < places.columns && at.y < places.rows;
  return inside ? places.cells[std::size_t(at.y) * std::size_t(places.columns) + std::size_t(at.x)]
                : places.beyond;
}

}  // namespace

ErrorPlaces places_of(const World& world, const Camera& camera) {
  Vec2 low, high;
  if (world.finite_bounds.empty()) {
    const double around = glm::length(camera.target - camera.eye);
    low = from_above(camera.target) - around, high = from_above(camera.target) + around;
  } else {
    low = from_above(world.finite_bounds.min), high = from_above(world.finite_bounds.max);
    const double around = 0.5 * std::max(high.x - low.x, high.y - low.y);
    low -= around, high += around;
  }
  ErrorPlaces places;
  const Vec2 size = high - low;
  places.corner = low;
  places.side = std::max(size.x, size.y) / longer_side;
  if (!(places.side > 0.0)) places.side = 1.0;
  places.columns = std::max(1, static_cast<int>(std::ceil(size.x / places.side)));
  places.rows = std::max(1, static_cast<int>(std::ceil(size.y / places.side)));
  places.cells.resize(std::size_t(places.columns) * std::size_t(places.rows));
  return places;
}

void add_errors(const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels,
                const Image<float>& truth, const Image<float>& drawn, ErrorPlaces& places) {
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (!is_compared(labels.data[i])) continue;
    ErrorPlaces::Cell& cell = cell_at(places, receivers.data[i].position);
    ++cell.pixels;
    cell.error += std::abs(double(drawn.data[i]) - double(truth.data[i]));
  }
}

std::optional<std::size_t> worst_place(const ErrorPlaces& places) {
  const auto worst = std::max_element(places.cells.begin(), places.cells.end(),
                                      [](const auto& a, const auto& b) { return a.error < b.error; });
  if (worst == places.cells.end() || !(worst->error > 0.0)) return std::nullopt;
  return static_cast<std::size_t>(worst - places.cells.begin());
}

double share_of_error(const ErrorPlaces& places, std::size_t cell) {
  return places.cells[cell].error / all_error(places);
}

std::string places_line(const ErrorPlaces& places) {
  const auto worst = worst_place(places);
  if (!worst) return {};
  const Vec2 at = middle_of(places, *worst);
  return fmt::format("Most error around x {:.3g}, z {:.3g} ({} of it).", at.x, at.y,
                     percent(share_of_error(places, *worst)));
}

Json places_json(const ErrorPlaces& places) {
  Json cells = Json::array();
  for (std::size_t i = 0; i < places.cells.size(); ++i) {
    const ErrorPlaces::Cell& cell = places.cells[i];
    if (cell.pixels == 0) continue;
    const double mean = cell.error / double(cell.pixels);
    cells.push_back({i % std::size_t(places.columns), i / std::size_t(places.columns), cell.pixels,
                     std::round(mean * 1e5) / 1e5});
  }
  const auto worst = worst_place(places);
  return {{"corner", {places.corner.x, places.corner.y}},
          {"side", places.side},
          {"cells", std::move(cells)},
          {"worst", worst ? Json{*worst % std::size_t(places.columns), *worst / std::size_t(places.columns)}
                          : Json(nullptr)},
          {"worst_share", worst ? number(share_of_error(places, *worst)) : Json(nullptr)},
          {"pixels_beyond", places.beyond.pixels},
          {"mean_absolute_beyond", places.beyond.pixels > 0
                                       ? number(places.beyond.error / double(places.beyond.pixels))
                                       : Json(nullptr)}};
}

}  // namespace gnomon::compare

#include "lab/view/state/pixel_story.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/ladder/labels.h"
#include "report/pixel_words.h"
#include "scene/light_map/light_view.h"

namespace gnomon::lab {

namespace {

using compare::Label;

PixelPlace scaled(PixelPlace place, ImageSize from, ImageSize to) {
  return {std::clamp(static_cast<int>((place.x + 0.5) * to.width / from.width), 0, to.width - 1),
          std::clamp(static_cast<int>((place.y + 0.5) * to.height / from.height), 0, to.height - 1)};
}

/// Distance along the light ray through (u, v) at which it meets the plane; NaN where it does not.
double plane_distance(const LightView& view, int face, double u, double v, const Vec3& point,
                      const Vec3& normal) {
  const Ray ray = texel_ray(view, face, u, v);
  const double along = glm::dot(ray.direction, normal);
  if (std::abs(along) < 1e-9) return std::nan("");
  return glm::dot(point - ray.origin, normal) / along;
}

/// Stored depth of a texel as a distance along the ray through its centre.
double stored_distance(const raster::ShadowMap& map, int face, int column, int row) {
  const int n = map.view.size;
  if (column < 0 || row < 0 || column >= n || row >= n || map.depth.empty()) return std::nan("");
  const double stored = static_cast<double>(map.depth[map.texel_index(face, column, row)]);
  if (!holds_caster(map.view, stored)) return std::numeric_limits<double>::infinity();
  const double depth = depth_from_stored(map.view, face, row + 0.5, stored);
  const Ray ray = texel_ray(map.view, face, column + 0.5, row + 0.5);
  return depth / glm::dot(ray.direction, map.view.face(face).forward);
}

void add_neighbours(const raster::LightRecord& record, PixelPlace pixel, LightCut& cut, int texels) {
  constexpr int reach = 80;  // pixels
  const ImageSize size = record.gap.size;
  const int across = cut.along_v ? 0 : 1, along = 1 - across;
  const Vec2f own = record.texel_uv.at(pixel.x, pixel.y);
  const std::uint8_t face = record.face.at(pixel.x, pixel.y);
  for (int y = std::max(0, pixel.y - reach); y < std::min(size.height, pixel.y + reach); ++y)
    for (int x = std::max(0, pixel.x - reach); x < std::min(size.width, pixel.x + reach); ++x) {
      const Vec2f uv = record.texel_uv.at(x, y);
      if (record.face.at(x, y) != face || std::floor(uv[across]) != std::floor(own[across])) continue;
      const float d = record.distance.at(x, y);
      if (d == 0.0f || std::abs(uv[along] - own[along]) > float(texels) + 1.0f) continue;
      cut.neighbours.emplace_back(uv[along], d);
    }
}

std::optional<compare::ShownMaterial> material_at(const ShownSurfaces& shown,
                                                  const Image<std::uint32_t>& places, int x, int y) {
  const std::uint32_t place = places.data.empty() ? 0u : places.at(x, y);
  return place == 0u ? std::nullopt : std::optional(shown.list[place - 1]);
}

/// A surface is there, and a map that holds its place.
bool looks_up(const raster::LightRecord& record, const PixelStory& story) {
  return story.seen && !record.map.depth.empty() && story.distance != 0.0 &&
         record.outside_map.at(story.pixel.x, story.pixel.y) == 0;
}

}  // namespace

PixelStory tell_story(const ComparisonOutcome& outcome, PixelPlace place, ImageSize picture) {
  const compare::LightComparison& light = outcome.comparison.lights.front();
  const raster::LightRecord& record = outcome.comparison.raster.lights.front();
  PixelStory story;
  story.pixel = scaled(place, picture, light.labels.size);
  const int x = story.pixel.x, y = story.pixel.y;
  story.label = light.labels.at(x, y);
  story.seen = story.label != Label::background;
  for (std::size_t k = 0; k < compare::rung_count; ++k)
    story.rungs[k] = static_cast<double>(light.rungs[k].at(x, y));
  story.ladder = compare::ladder_of(outcome.comparison.raster.options.map.technique);
  story.gap = static_cast<double>(record.gap.at(x, y));
  story.distance = static_cast<double>(record.distance.at(x, y));
  story.texel_world = record.texel_world;
  story.bias_world = record.bias_constant_world;
  const Vec2f uv = record.texel_uv.at(x, y);
  story.u = static_cast<double>(uv.x), story.v = static_cast<double>(uv.y);
  story.face = record.face.at(x, y);
  report::PixelFacts facts{story.label, story.rungs, story.gap, story.u, story.v};
  facts.ladder = story.ladder;
  facts.seen = story.seen && story.label != Label::silhouette;
  facts.material = material_at(outcome.shown, outcome.shown.material, x, y);
  facts.stored_glass = material_at(outcome.shown, outcome.shown.stored_glass, x, y);
  if (record.external && !record.external->decision.data.empty())
    facts.decision = record.external->decision.at(x, y);
  story.deciding = report::deciding_rung(facts);
  story.words = report::pixel_words(outcome.comparison, light, facts);
  story.remarks = report::pixel_remarks(facts);
  if (story.deciding > 0) story.cure = compare::label_text(story.label).cure;
  return story;
}

std::optional<LightCut> cut_through(const ComparisonOutcome& outcome, const PixelStory& story, int texels) {
  const raster::LightRecord& record = outcome.comparison.raster.lights.front();
  const LightView& view = record.map.view;
  if (!looks_up(record, story)) return std::nullopt;
  LightCut cut;
  cut.distance = story.distance;
  cut.bias = story.bias_world;
  const Ray ray = texel_ray(view, story.face, story.u, story.v);
  const Vec3 point = ray.origin + story.distance * ray.direction;
  const Vec3 normal(outcome.normals.at(story.pixel.x, story.pixel.y));
  const auto slope = [&](double du, double dv) {
    return std::abs(plane_distance(view, story.face, story.u + du, story.v + dv, point, normal) -
                    plane_distance(view, story.face, story.u - du, story.v - dv, point, normal));
  };
  cut.along_v = slope(0.0, 0.5) > slope(0.5, 0.0);  // the steeper way shows more
  cut.at = cut.along_v ? story.v : story.u;
  const int own = static_cast<int>(std::floor(cut.at));
  const int other = static_cast<int>(std::floor(cut.along_v ? story.u : story.v));
  cut.first = own - texels;
  for (int k = cut.first; k <= own + texels; ++k)
    cut.stored.push_back(
        stored_distance(record.map, story.face, cut.along_v ? other : k, cut.along_v ? k : other));
  const int samples = 8 * (2 * texels + 1);
  for (int i = 0; i <= samples; ++i) {
    const double t = cut.first + (2.0 * texels + 1.0) * i / samples;
    const double d =
        plane_distance(view, story.face, cut.along_v ? story.u : t, cut.along_v ? t : story.v, point, normal);
    if (std::isfinite(d)) cut.receiver.emplace_back(t, d);
  }
  add_neighbours(record, story.pixel, cut, texels);
  return cut;
}

std::optional<LightSpace> light_space(const ComparisonOutcome& outcome, const PixelStory& story, int texels) {
  constexpr int reach = 80;  // pixels
  const raster::LightRecord& record = outcome.comparison.raster.lights.front();
  const LightView& view = record.map.view;
  if (!looks_up(record, story)) return std::nullopt;
  LightSpace space;
  space.u = story.u, space.v = story.v, space.bias = story.bias_world;
  space.rounding = 8.0 * std::numeric_limits<float>::epsilon() * story.distance;
  space.side = 2 * texels + 1;
  space.first_u = static_cast<int>(std::floor(story.u)) - texels;
  space.first_v = static_cast<int>(std::floor(story.v)) - texels;
  const Ray ray = texel_ray(view, story.face, story.u, story.v);
  const Vec3 point = ray.origin + story.distance * ray.direction;
  const Vec3 normal(outcome.normals.at(story.pixel.x, story.pixel.y));
  for (int row = space.first_v; row < space.first_v + space.side; ++row)
    for (int column = space.first_u; column < space.first_u + space.side; ++column)
      space.nearer.push_back(plane_distance(view, story.face, column + 0.5, row + 0.5, point, normal) -
                             stored_distance(record.map, story.face, column, row));
  const auto inside = [&](const Vec2f& uv) {
    return uv.x >= float(space.first_u) && uv.y >= float(space.first_v) &&
           uv.x < float(space.first_u + space.side) && uv.y < float(space.first_v + space.side);
  };
  // One dot a cell, for where texels are large on the screen a drawing of all would be nothing but dots.
  constexpr int cells = 3;  // of a texel, each way
  std::vector<char> taken(static_cast<std::size_t>(cells * cells * space.side * space.side));
  const auto is_first_in_its_cell = [&](const Vec2f& uv) {
    const auto column = static_cast<std::size_t>((uv.x - float(space.first_u)) * float(cells));
    const auto row = static_cast<std::size_t>((uv.y - float(space.first_v)) * float(cells));
    const std::size_t cell = row * static_cast<std::size_t>(cells * space.side) + column;
    return cell < taken.size() && std::exchange(taken[cell], 1) == 0;
  };
  const ImageSize size = record.gap.size;
  for (int y = std::max(0, story.pixel.y - reach); y < std::min(size.height, story.pixel.y + reach); ++y)
    for (int x = std::max(0, story.pixel.x - reach); x < std::min(size.width, story.pixel.x + reach); ++x)
      if (record.face.at(x, y) == story.face && record.distance.at(x, y) != 0.0f &&
          inside(record.texel_uv.at(x, y)) && is_first_in_its_cell(record.texel_uv.at(x, y)))
        space.neighbours.emplace_back(record.texel_uv.at(x, y));
  return space;
}

}  // namespace gnomon::lab

// What all lights share. Normals are rounded to 1/32767, linear colours to 1/64 of an octave (half a
// percent), corners of triangles to 2^-20 of the scene's size.
#include "report/pixels/page_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "compare/result/outputs.h"
#include "compare/result/result_parts.h"
#include "compare/truth/shown_materials.h"
#include "report/page.h"
#include "report/pixels/channels.h"
#include "report/pixels/packing.h"
#include "scene/base/parallel.h"

namespace gnomon::report {
namespace {

using compare::vector3;

using Json = nlohmann::ordered_json;

constexpr double corner_bits = 20.0;

// --- what is seen at each pixel ---

// A picture's colours differ less from each other, and from those of the other picture, than from pixel to
// pixel.
void add_pictures(Channels& channels, const ColorImage& drawn, const ColorImage& traced) {
  constexpr std::string_view rgb = "RGB";
  using Numbers = std::array<std::vector<std::uint16_t>, 3>;
  const auto raster = std::make_shared<const Numbers>(colour_numbers(drawn));
  const auto rays = std::make_shared<const Numbers>(colour_numbers(traced));
  const auto minus = [](const auto& numbers, const auto& taken, std::size_t i) {
    return std::uint32_t{numbers[i]} - std::uint32_t{taken[i]};
  };
  for (std::size_t k = 0; k < rgb.size(); ++k) {
    const std::string name = fmt::format("raster{}", rgb[k]);
    if (k == 0)
      channels.add(name, drawn.data.size(), {2, From::previous},
                   [raster](std::size_t i) { return std::uint32_t{raster->front()[i]}; });
    else
      channels.add(
          name, drawn.data.size(), {2, From::previous},
          [raster, minus, k](std::size_t i) { return minus((*raster)[k], (*raster)[k - 1], i); },
          fmt::format("raster{}", rgb[k - 1]));
  }
  for (std::size_t k = 0; k < rgb.size(); ++k)
    channels.add(
        fmt::format("raytraced{}", rgb[k]), traced.data.size(), {2},
        [raster, rays, minus, k](std::size_t i) { return minus((*rays)[k], (*raster)[k], i); },
        fmt::format("raster{}", rgb[k]));
}

void add_receiver(Channels& channels, const PixelSurfaces& surfaces) {
  const std::size_t n = surfaces.count();
  channels.add("primitive", n, {4, From::previous},
               [&surfaces](std::size_t i) { return surfaces.primitive(i); });
  for (int k = 0; k < 3; ++k)
    channels.add(fmt::format("n{}", "xyz"[k]), n, {2, From::surface}, [&surfaces, k](std::size_t i) {
      return static_cast<std::uint32_t>(std::int32_t{surfaces.seen.data[i].normal[k]});
    });
}

Json rays_json(const PixelRays& rays) {
  return {{"eye", vector3(rays.eye)},
          {"corner", vector3(rays.corner)},
          {"across", vector3(rays.across)},
          {"down", vector3(rays.down)}};
}

Json materials_json(const compare::ShownMaterials& materials) {
  Json list = Json::array();
  for (const compare::ShownMaterial& m : materials.list())
    list.push_back({{"name", m.name}, {"mirror", m.mirror}, {"transmission", m.transmission}});
  return list;
}

// What all lights share: what is seen at each pixel, and both pictures.
Json pixels_json(const compare::Comparison& c, Packer& packer, const PixelSurfaces& surfaces,
                 const compare::ShownMaterials& materials) {
  Channels channels(packer, &surfaces.sources);
  add_receiver(channels, surfaces);
  if (!materials.empty())
    channels.add("material", surfaces.count(), {2, From::surface},
                 [&](std::size_t i) { return materials.of(surfaces.primitive(i)); });
  add_pictures(channels, c.raster.color, c.raytraced.color);
  return channels.json();
}

// --- geometry ---

using Corner = std::array<std::uint32_t, 3>;

// Corners rounded to a step, those that coincide then once.
struct Corners {
  std::vector<Corner> places;
  std::vector<std::uint32_t> of_triangles;
};

/// Numbers corners in the order in which they first come: a table with open places, at most half full.
class CornerNumbers {
 public:
  explicit CornerNumbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), none) {}

  /// The number of a corner among `known`, to which a new one is added.
  std::uint32_t number(const Corner& corner, std::vector<Corner>& known) {
    std::size_t slot = hash(corner) & (slots_.size() - 1);
    while (slots_[slot] != none && known[slots_[slot]] != corner) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == none)
      slots_[slot] = static_cast<std::uint32_t>(known.size()), known.push_back(corner);
    return slots_[slot];
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  static std::size_t hash(const Corner& c) {
    return ((std::uint64_t{c[0]} << 42) ^ (std::uint64_t{c[1]} << 21) ^ c[2]) * 0x9e3779b97f4a7c15u >> 16;
  }
  std::vector<std::uint32_t> slots_;
};

Corners rounded_corners(const SectionMesh& mesh, const Vec3& low, double step) {
  Corners out;
  std::vector<std::uint32_t> place(mesh.positions.size());
  CornerNumbers numbers(place.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Vec3 p = (mesh.positions[i] - low) / step;
    place[i] = numbers.number({rounded(p.x), rounded(p.y), rounded(p.z)}, out.places);
  }
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) out.of_triangles.push_back(place[corner]);
  return out;
}

double corner_step(const Aabb& bounds) {
  const Vec3 extent = bounds.max - bounds.min;
  return std::exp2(std::ceil(std::log2(std::max({extent.x, extent.y, extent.z, 1e-300}))) - corner_bits);
}

/// `corners`: of the mesh, rounded to corner_step().
Json triangles_json(const std::shared_ptr<const Corners>& corners, const Aabb& bounds, Packer& packer) {
  constexpr PackOptions options{4, From::previous};
  Channels channels(packer);
  for (std::size_t k = 0; k < 3; ++k)
    channels.add(std::string(1, "xyz"[k]), corners->places.size(), options,
                 [corners, k](std::size_t i) { return corners->places[i][k]; });
  channels.add("corner", corners->of_triangles.size(), options,
               [corners](std::size_t i) { return corners->of_triangles[i]; });
  return {{"low", vector3(bounds.min)}, {"step", corner_step(bounds)}, {"channels", channels.json()}};
}

/// What can be cut through at a pixel.
struct Geometry {
  SectionMesh mesh;
  std::shared_ptr<const Corners> corners;
  explicit Geometry(const World& world)
      : mesh(section_mesh(world)),
        corners(std::make_shared<const Corners>(
            rounded_corners(mesh, world.finite_bounds.min, corner_step(world.finite_bounds)))) {}
};

Json geometry_json(const World& world, const Geometry& geometry, Packer& packer) {
  const SectionMesh& mesh = geometry.mesh;
  Json shapes = Json::array();
  for (const Shape& shape : world.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      shapes.push_back(
          {{"name", shape.name}, {"center", vector3(sphere->center)}, {"radius", sphere->radius}});
    else if (const auto* plane = std::get_if<Plane>(&shape.geometry))
      shapes.push_back(
          {{"name", shape.name}, {"point", vector3(plane->point)}, {"normal", vector3(plane->normal)}});
  }
  Json json{
      {"shapes", std::move(shapes)}, {"solid_sectors", mesh.solid_sectors}, {"complete", mesh.complete}};
  if (!mesh.triangles.empty())
    json["triangles"] = triangles_json(geometry.corners, world.finite_bounds, packer);
  return json;
}

}  // namespace

PageData page_data(const PageInput& in) {
  const compare::Comparison& c = in.comparison;
  PageData out;
  compare::Json head{{"kind", "compare"},
                     {"labels", label_facts()},
                     {"rungs", rung_facts(compare::ladder_of(c.raster.options.map.technique))},
                     {"width", c.raytraced.color.size.width},
                     {"height", c.raytraced.color.size.height},
                     {"position_steps", position_steps},
                     {"visibility_steps", visibility_steps},
                     {"colour_steps", colour_steps},
                     {"darkest_octave", darkest_octave},
                     {"exposure", c.exposure},
                     {"lights", c.lights.size()}};
  out.head = head.dump();
  if (c.lights.empty()) return out;
  struct Part {
    std::string name;
    compare::Json json;
    std::size_t first;  // job of its arrays
  };
  Packer packer;
  std::vector<Part> parts;
  const auto add = [&](std::string name, const auto& make) {
    const std::size_t first = packer.count();
    parts.push_back({std::move(name), make(), first});
  };
  std::optional<Geometry> geometry;
  std::optional<PixelSurfaces> surfaces;
  std::optional<compare::ShownMaterials> materials;
  const auto describe_pixels = [&] {
    surfaces.emplace(pixel_surfaces(c));
    materials.emplace(*c.world);
    head["rays"] = rays_json(surfaces->rays);
    head["materials"] = materials_json(*materials);
    out.head = head.dump();
    add("pixels", [&] { return pixels_json(c, packer, *surfaces, *materials); });
    for (std::size_t i = 0; i < c.lights.size(); ++i)
      add(fmt::format("light-{}", i), [&] { return light_data(in, i, packer, *surfaces); });
  };
  parallel_invoke(describe_pixels, [&] { geometry.emplace(*c.world); });
  add("geometry", [&] { return geometry_json(*c.world, *geometry, packer); });
  packer.run();
  for (const Part& part : parts) out.parts.push_back({part.name, packer.filled(part.json, part.first)});
  return out;
}

}  // namespace gnomon::report

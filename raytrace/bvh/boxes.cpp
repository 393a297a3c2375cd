// The boxes of a world's primitives, for every structure's builder: raytrace/bvh/bvh.h.

#include "raytrace/bvh/bvh.h"
#include "raytrace/bvh/float4.h"
#include "scene/base/parallel.h"
#include "scene/shapes/solid.h"

namespace gnomon::raytrace {
namespace {

Float4 floats_of(const Vec3& v) {
  return Float4::of(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f);
}
/// What float_below and float_above give way.
Float4 way_of(Float4 f) {
  return magnitude(f) * Float4::all(FLT_EPSILON) + Float4::all(FLT_MIN);
}

// float_below and float_above, three at a time. A difference of doubles is right to 2^-53 of itself, far less than these
// give way.
BoxRef box_of(const Vec3& min, const Vec3& max, std::uint32_t id) {
  const Float4 low = min_keep(Float4::all(FLT_MAX), floats_of(min));
  const Float4 high = max_keep(Float4::all(-FLT_MAX), floats_of(max));
  alignas(16) float below[4], above[4];
  (low - way_of(low)).store(below), (high + way_of(high)).store(above);
  return {{below[0], below[1], below[2]}, {above[0], above[1], above[2]}, id};
}

BoxRef triangle_box(const std::array<Vec3, 3>& corners, std::uint32_t id, const Vec3& center) {
  const auto& [a, b, c] = corners;
  return box_of(glm::min(a, glm::min(b, c)) - center, glm::max(a, glm::max(b, c)) - center, id);
}

BoxRef sphere_box(const Sphere& sphere, std::uint32_t id, const Vec3& center) {
  const Vec3 middle = sphere.center - center;
  const Vec3 half = Vec3(sphere.radius) + error_gamma(3) * (glm::abs(middle) + Vec3(sphere.radius));
  return box_of(middle - half, middle + half, id);
}

BoxRef solid_box(const ShapeGeometry& solid, std::uint32_t id, const Vec3& center) {
  const Aabb box = world_box(solid);
  const Vec3 error = error_gamma(32) * (glm::abs(box.min) + glm::abs(box.max) + box.extent());
  return box_of(box.min - error - center, box.max + error - center, id);
}

/// The boxes of those of a part's triangles from `first` to before `last`, by its own numbers, that have a surface; returns
/// the end of what is written.
BoxRef* write_boxes(const WorldPart& part, std::uint32_t first, std::uint32_t last, const Vec3& center,
                    BoxRef* at) {
  for (std::uint32_t i = first; i < last; ++i) {
    const std::array<Vec3, 3> corners = part.corners(i);
    if (has_surface(corners)) *at++ = triangle_box(corners, part.first_triangle + i, center);
  }
  return at;
}

/// The parts that are asked for, and their triangles in one row.
struct TriangleRow {
  std::vector<const WorldPart*> parts;
  Ranges of_parts;

  TriangleRow(const World& world, bool with_kept) {
    std::vector<std::uint32_t> begins{0};
    for (const WorldPart& part : world.parts) {
      if (part.kept() && !with_kept) continue;
      parts.push_back(&part), begins.push_back(begins.back() + part.triangle_count());
    }
    of_parts = Ranges(std::move(begins));
  }
};

// In blocks over all threads, each at the place of its triangles; closed up where some were left out.
void append_triangles(const World& world, bool with_kept, FinitePrimitives& out) {
  constexpr std::uint32_t block_size = 2048;
  const TriangleRow row(world, with_kept);
  const std::uint32_t count = row.of_parts.size();
  std::vector<std::uint32_t> kept((count + block_size - 1) / block_size);
  out.boxes.resize(count);
  parallel_for(kept.size(), [&](std::size_t block) {
    const auto first = static_cast<std::uint32_t>(block) * block_size;
    const std::uint32_t end = std::min(first + block_size, count);
    BoxRef* at = out.boxes.data() + first;
    for (std::uint32_t i = first; i < end;) {
      const std::uint32_t number = row.of_parts.of(i), begin = row.of_parts.begin_of(number);
      const WorldPart& part = *row.parts[number];
      const std::uint32_t last = std::min(end - begin, part.triangle_count());
      at = write_boxes(part, i - begin, last, out.center, at);
      i = begin + last;
    }
    kept[block] = static_cast<std::uint32_t>(at - out.boxes.data()) - first;
  });
  leave_if_given_up();
  std::size_t size = 0;
  for (std::size_t block = 0; block < kept.size(); size += kept[block++])
    if (size != block * block_size)
      std::copy_n(out.boxes.data() + block * block_size, kept[block], out.boxes.data() + size);
  out.boxes.resize(size);
  out.dropped += count - size;
}

}  // namespace

BoxRef shape_box(const World& world, std::uint32_t id, const Vec3& center) {
  const ShapeGeometry& geometry = world.shape(id).geometry;
  if (is_solid(geometry)) return solid_box(geometry, id, center);
  return sphere_box(std::get<Sphere>(geometry), id, center);
}

namespace {

FinitePrimitives primitives_of(const World& world, bool kept) {
  FinitePrimitives out;
  const Vec3 middle = world.finite_bounds.center();
  if (all_finite(middle)) out.center = middle;
  append_triangles(world, kept, out);
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id) {
    const ShapeGeometry& geometry = world.shape(id).geometry;
    if (std::holds_alternative<Plane>(geometry)) continue;
    if (is_solid(geometry)) {
      const Aabb box = world_box(geometry);
      if (all_finite(box.min) && all_finite(box.max))
        out.boxes.push_back(solid_box(geometry, id, out.center));
      else
        ++out.dropped;
      continue;
    }
    const auto* sphere = std::get_if<Sphere>(&geometry);
    if (all_finite(sphere->center) && std::isfinite(sphere->radius) && sphere->radius > 0.0)
      out.boxes.push_back(sphere_box(*sphere, id, out.center));
    else
      ++out.dropped;
  }
  return out;
}

}  // namespace

FinitePrimitives finite_primitives(const World& world) {
  return primitives_of(world, true);
}
FinitePrimitives flattened_primitives(const World& world) {
  return primitives_of(world, false);
}

}  // namespace gnomon::raytrace

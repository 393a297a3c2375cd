// A coarse picture of a scene: which part each of its pixels sees. For choosing a camera, which needs no more; the
// renderers' own pictures know nothing of it.
#pragma once

#include <span>
#include <vector>

#include "scene/camera.h"
#include "scene/files/parts.h"

namespace gnomon {

class Sketch {
 public:
  static constexpr std::uint32_t nothing = no_id;

  explicit Sketch(const View& view);
  /// Draws all parts for which `draws(part)` holds, and planes where `with_planes`. `lit`: from a light, to which backs
  /// are there as well, and what casts no shadow is not.
  template <class Draws>
  void draw(const Scene& scene, const SceneParts& parts, bool with_planes, bool lit, const Draws& draws) {
    parts.visit_triangles([&](const PlacedTriangle& t, std::uint32_t part) {
      if (!draws(part)) return;
      const Material& material = scene.materials[t.material];
      if (!lit || material.casts_shadow) draw_triangle(t, part, lit || shows_back(material));
    });
    parts.visit_shapes([&](const Shape& shape, std::uint32_t part) {
      if (draws(part) && (!lit || scene.materials[shape.material].casts_shadow)) draw_shape(shape, part);
    });
    if (!with_planes) return;
    for (const Shape& shape : scene.shapes)
      if (const auto* plane = std::get_if<Plane>(&shape.geometry)) draw_plane(*plane);
  }

  /// By pixel, the number of the part that it sees; `nothing` where that is a plane or no surface.
  const std::vector<std::uint32_t>& parts() const { return part_; }
  /// By pixel, along the view's direction; infinity where nothing is.
  const std::vector<double>& depths() const { return depth_; }
  /// Returns the share of the pixels that see a part for which `counts(part)` holds.
  template <class Counts>
  double share(const Counts& counts) const {
    std::size_t sum = 0;
    for (const std::uint32_t part : part_) sum += part != nothing && counts(part) ? 1 : 0;
    return static_cast<double>(sum) / static_cast<double>(part_.size());
  }
  /// Returns whether such a part reaches the picture's border.
  template <class Counts>
  bool cuts(const Counts& counts) const {
    const auto width = static_cast<std::size_t>(view_.size.width);
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const std::size_t x = i % width;
      const bool border = x == 0 || x + 1 == width || i < width || i + width >= part_.size();
      if (border && part_[i] != nothing && counts(part_[i])) return true;
    }
    return false;
  }

 private:
  void draw_triangle(const PlacedTriangle& t, std::uint32_t part, bool shows_back);
  /// A sphere, or the box around a solid.
  void draw_shape(const Shape& shape, std::uint32_t part);
  void draw_plane(const Plane& plane);
  void draw_polygon(std::span<const Vec3> corners, std::uint32_t part, bool shows_back);
  void put(std::size_t pixel, double depth, std::uint32_t part) {
    if (depth > 0.0 && depth < depth_[pixel]) depth_[pixel] = depth, part_[pixel] = part;
  }
  Vec2 place(int x, int y) const {
    return {2.0 * (x + 0.5) / view_.size.width - 1.0, 1.0 - 2.0 * (y + 0.5) / view_.size.height};
  }

  View view_;
  std::vector<std::uint32_t> part_;
  std::vector<double> depth_;
};

}  // namespace gnomon

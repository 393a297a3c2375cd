// Where an analytic shape can fall on a map's face or on the camera's image: the rectangle that its impostor
// covers.
#pragma once

#include <optional>

#include "scene/light_map/light_view.h"
#include "scene/shapes/solid.h"

namespace gnomon::raster {

/// In normalised device coordinates, [-1, 1] on both axes.
struct ClipRectangle {
  Vec2 min{-1.0}, max{1.0};
};

/// An image to project onto: an orthonormal frame and the half extent at unit depth (perspective) or at any
/// depth. The frame's own extent and depths are not looked at, but its warp is (light_view.h).
struct Projection {
  Vec3 origin;
  LightFace frame;
  Vec2 half_extent;
  bool perspective = true;
  Vec2 pixel{0.0};  ///< one pixel in normalised device coordinates: the margin kept around the shape
};

/// A face of a light's map.
Projection face_projection(const LightView& view, int face);

/// None when no part of the shape can be seen. A plane's rectangle ends at its horizon.
std::optional<ClipRectangle> shape_bounds(const Projection& projection, const Shape& shape);

/// The shape as seen from the projection's origin along its axes, worked out in double precision. Of a sphere
/// it is centre and radius, of a plane the unit normal n and the offset d of n . p = d. Of a solid nothing:
/// see below.
Vec4 shape_in_frame(const Vec3& origin, const LightFace& frame, const Shape& shape);

/// Takes a place in that frame to the solid's own; requires a solid.
Mat4 solid_from_frame(const Vec3& origin, const LightFace& frame, const ShapeGeometry& solid);

}  // namespace gnomon::raster

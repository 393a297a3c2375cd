// Pixel centres and camera matrices: one policy for both renderers.
// Pixel (x, y) counts from the top left; its centre is (x + 1/2, y + 1/2). View space looks down -z, y up.
// At depth z, along `forward` from the eye, a picture reaches half_x + z tan_half_x to either side. A pinhole camera has
// only the second part, an orthographic one only the first.
#pragma once

#include "scene/image.h"
#include "scene/math.h"
#include "scene/scene.h"

namespace gnomon {

/// A camera with its frame worked out for one image size.
struct View {
  Vec3 eye;
  Vec3 right, up, forward;        ///< orthonormal
  double tan_half_x, tan_half_y;  ///< 0 of an orthographic camera
  ImageSize size;
  double half_x = 0.0, half_y = 0.0;  ///< world units; 0 of a pinhole camera

  bool orthographic() const { return half_y > 0.0; }
  /// Where the ray starts that goes through a place in the picture, each of whose coordinates runs from -1 to 1, x to the
  /// right and y up.
  Vec3 ray_origin(const Vec2& place) const;
  /// The way from there to depth 1.
  Vec3 ray_direction(const Vec2& place) const;
  /// How far from the eye, or the plane through it, a point lies along the ray that sees it.
  double distance(const Vec3& world) const;
};

/// Requires eye != target, up not parallel to the view direction, fov in (0, pi) (the loaders check).
View make_view(const Camera& camera, ImageSize size);

/// What the picture's height covers at a depth, world units.
double picture_height(const Camera& camera, double depth);

/// A camera that sees the middle of the picture alone, this share of its height.
Camera narrowed(const Camera& camera, double share);

/// The ray through image position (x, y) in pixels (pixel centres at .5). Direction has unit length.
Ray pixel_ray(const View& view, double x, double y);

/// Image position in pixels of a world point; z is the depth along `forward` (<= 0 behind the eye).
Vec3 project_to_pixels(const View& view, const Vec3& world);

/// The ray that sees a world point before the eye.
Ray ray_to(const View& view, const Vec3& world);

/// A pixel's side, world units, at a distance from the eye.
double pixel_footprint(const View& view, double distance);

/// Rotation only: the eye is the origin of what is uploaded (camera-relative, so that scenes far from the
/// origin keep their precision).
Mat4 view_from_eye_relative(const View& view);

/// Reversed depth, for glClipControl(..., GL_ZERO_TO_ONE). Of a pinhole camera `reach` is the near distance, and z_ndc = reach /
/// depth, with an infinite far plane; of an orthographic one it is the far distance, and z_ndc = 1 - depth / reach.
Mat4 clip_from_view(const View& view, double reach);

}  // namespace gnomon

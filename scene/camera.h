// Pixel centres and camera matrices: one policy for both renderers.
// Pixel (x, y) counts from the top left; its centre is (x + 1/2, y + 1/2). View space looks down -z, y up.
#pragma once

#include "scene/image.h"
#include "scene/math.h"
#include "scene/scene.h"

namespace gnomon {

/// A camera with its frame worked out for one image size.
struct View {
  Vec3 eye;
  Vec3 right, up, forward;  ///< orthonormal
  double tan_half_x, tan_half_y;
  ImageSize size;
};

/// Requires eye != target, up not parallel to the view direction, fov in (0, pi) (the loaders check).
View make_view(const Camera& camera, ImageSize size);

/// The ray through image position (x, y) in pixels (pixel centres at .5). Direction has unit length.
Ray pixel_ray(const View& view, double x, double y);

/// Image position in pixels of a world point; z is the depth along `forward` (<= 0 behind the eye).
Vec3 project_to_pixels(const View& view, const Vec3& world);

/// Rotation only: the eye is the origin of what is uploaded (camera-relative, so that scenes far from the
/// origin keep their precision).
Mat4 view_from_eye_relative(const View& view);

/// Reversed depth with an infinite far plane, for glClipControl(..., GL_ZERO_TO_ONE): z_ndc = near /
/// distance.
Mat4 clip_from_view(const View& view, double near_distance);

}  // namespace gnomon

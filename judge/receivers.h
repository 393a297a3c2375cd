// The surfaces that the capture's pixels show, and the truth there.
#pragma once

#include "judge/capture_pictures.h"
#include "raytrace/frame.h"
#include "scene/camera.h"

namespace gnomon::judge {

/// Where a picture was seen from: a view, and how far its samples lie from the pixels' centres.
struct Sight {
  View view;
  Vec2 shift{0.0};  ///< pixels
};

/// The eye's ray through the place that a pixel of the capture shows; through its centre where the capture
/// does not say it.
Ray sight_ray(const Sight& sight, const CapturedPictures& pictures, int x, int y);
/// The place that the capture gives a pixel, world units; none where it gives none.
std::optional<Vec3> captured_place(const Sight& sight, const CapturedPictures& pictures, int x, int y);

struct Retraced {
  Image<std::uint8_t> elsewhere;  ///< 1 where the capture's place is none of the scene's on that sight line
};
/// Traces receivers and the light's truth again where the capture says which positions its pixels show;
/// `everywhere`: where it does not, too (a sight other than the frame's). Receivers lie on the scene's own
/// surfaces, on the sight line through the capture's place, so that it does no harm when a surface was cut into
/// other triangles.
Retraced retrace(const raytrace::Tracer& tracer, const Sight& sight, const CapturedPictures& pictures,
                 bool everywhere, const raytrace::RaytraceOptions& options, raytrace::RayTracedFrame& frame);

}  // namespace gnomon::judge

// Two pictures of a ratio that hold more than the one light: ambient light, a sky, other lamps. What a full shadow takes is
// then not all of a pixel's light, but a share. It follows from the surface's angle and distance to the light. The pixels
// which differ tell it.
#pragma once

#include "compare/result/judged.h"
#include "judge/capture_pictures.h"
#include "raytrace/frame.h"

namespace gnomon::judge {

/// Returns whether the pictures of a ratio hold other light: what the light cannot reach in the scene (a background, surfaces
/// that face away) is bright in them. Where the view shows nothing of the kind: whether no pixel is in full darkness.
bool holds_other_light(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame,
                       const Light& light);

/// Works out the visibility of pictures that hold other light, and undoes their tone curve where it is known. Pixels of which
/// the light has too small a share to tell are no longer `reached`. Error (bad input): how dark a full shadow is does not
/// show. None, and nothing is changed: the pictures are alike.
Expected<std::optional<compare::OtherLight>> undo_other_light(const Capture& capture, const Light& light,
                                                              const raytrace::RayTracedFrame& frame,
                                                              CapturedPictures& pictures);

/// Sentences on what was found and assumed.
std::vector<std::string> other_light_notes(const compare::OtherLight& found);

}  // namespace gnomon::judge

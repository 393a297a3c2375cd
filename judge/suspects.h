// The ways in which a capture's conventions usually differ from what it says: each with what undoes it.
#pragma once

#include <string>
#include <vector>

#include "judge/receivers.h"

namespace gnomon::judge {

struct Suspect {
  std::string what;                     ///< "the picture is upside down"; empty: the capture as it is
  bool flip_x = false, flip_y = false;  ///< of every picture
  bool visibility_only = false;         ///< the flips are those of the shadow's picture alone
  Vec2 shift{0.0};                      ///< pixels, of the samples from the pixels' centres
  std::optional<View> view;             ///< in place of the camera's
  Mat3 place_from_captured{1.0};        ///< of positions
  double depth_scale = 1.0;             ///< of depths
  bool other_depth = false;             ///< depths along the axis are distances, or the reverse
  bool light_turned = false;            ///< the light shines the other way
  bool inverted = false;                ///< 1 is shadow
  bool geometric = true;                ///< seen by silhouettes, positions or depths; else by shadows alone
  bool by_shadows = true;               ///< shadows tell it, too, where a capture has nothing else
};

struct SuspectInput {
  const Camera& camera;
  ImageSize size;
  bool has_positions = false, has_depths = false, has_direction = false;
};

std::vector<Suspect> usual_suspects(const SuspectInput& input);

/// Another world's axes and unit, as words after "is": "z-up, the scene y-up, and in centimetres, the scene in metres".
std::string world_words(const Mat3& scene_from_captured);
/// The world of signed axes and one unit in which the captured places are those of the pixels' receivers, by least squares
/// over the grid. None where no such world is, or it is the scene's own.
std::optional<Mat3> find_world(const Image<Vec3>& position, const raytrace::RayTracedFrame& frame);
/// Those that renderers have, to be tried one by one.
std::vector<Mat3> usual_worlds();

/// The place in the capture's pictures that shows pixel (x, y) of the scene.
inline std::pair<int, int> flipped(bool flip_x, bool flip_y, const ImageSize& size, int x, int y) {
  return {flip_x ? size.width - 1 - x : x, flip_y ? size.height - 1 - y : y};
}

/// Undoes a suspect in the pictures and the sight.
void undo(const Suspect& suspect, CapturedPictures& pictures, Sight& sight);

}  // namespace gnomon::judge

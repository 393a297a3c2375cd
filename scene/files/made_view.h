// Cameras for files that have none: from where one sees what casts shadows on something.
#pragma once

#include <optional>

#include "scene/files/parts.h"
#include "scene/files/sketch.h"

namespace gnomon {

inline constexpr ImageSize sketch_size{96, 54};

/// A camera that looks at the middle of a box from `back`, the way from there to the eye. It is so near that the box is
/// just in a picture of `aspect`, width by height, and in every wider one.
Camera framed(const Aabb& box, const Vec3& back, double aspect = 4.0 / 3.0);

/// Returns how much of the parts for which `counts(part)` holds the camera sees, as a share of what it would see of them with
/// nothing before them; 0 where it would see none.
template <class Counts>
double seen_share(const Scene& scene, const SceneParts& parts, const Camera& camera, const Counts& counts,
                  bool lit = false) {
  const View view = make_view(camera, sketch_size);
  Sketch alone(view), all(view);
  alone.draw(scene, parts, false, lit, counts);
  all.draw(scene, parts, true, lit, [](std::uint32_t) { return true; });
  const double most = alone.share(counts);
  return most > 0.0 ? all.share(counts) / most : 0.0;
}

/// Where one stands in a room, and where its lamp hangs.
struct Interior {
  Camera camera;
  std::optional<Vec3> lamp;    ///< none where the sky is seen from inside
  Vec3 open{0.0};              ///< outwards, through the side that is not there; 0: closed all around
  std::vector<char> contents;  ///< by part: it stands in the room
};

/// None unless faces cover most of `bounds`. They must lie flat near each of its six sides, or of all but one other than the
/// floor. And they must face inwards, or something must shine inside, or stand inside that cannot be seen from outside.
std::optional<Interior> find_interior(const Scene& scene, const SceneParts& parts, const Aabb& bounds);

struct MadeView {
  Camera camera;
  bool in_shell = false;        ///< the eye is inside of what hides the rest
  std::vector<char> looked_at;  ///< by part
};

/// A camera outside of rooms. `bounds`: the scene's; `aspect`: of the picture.
MadeView find_view(const Scene& scene, const SceneParts& parts, const Aabb& bounds, double aspect);

}  // namespace gnomon

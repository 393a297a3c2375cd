#include <array>

#include "lab/lessons/figures.h"
#include "scene/camera.h"

namespace gnomon::lab::lessons {

nlohmann::ordered_json eye_ray_checks() {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const ImageSize size : {ImageSize{8, 6}, ImageSize{16, 9}, ImageSize{3, 5}})
    for (const double degrees : {30.0, 60.0, 100.0}) {
      Camera camera;
      camera.eye = Vec3(0.0), camera.target = Vec3(0.0, 0.0, -1.0),
      camera.vertical_fov = degrees * pi / 180.0;
      const View view = make_view(camera, size);
      for (const auto& [x, y] :
           std::array<std::pair<int, int>, 3>{{{0, 0}, {size.width - 1, 1}, {1, size.height - 1}}}) {
        const Vec3 d = pixel_ray(view, x + 0.5, y + 0.5).direction;
        checks.push_back({{"columns", size.width},
                          {"rows", size.height},
                          {"fov", degrees},
                          {"x", x},
                          {"y", y},
                          {"direction", {d.x, d.y, d.z}}});
      }
    }
  return {{"checks", checks}};
}

}  // namespace gnomon::lab::lessons

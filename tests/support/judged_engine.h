// An engine's picture and map of one light as a capture: its own test, on the map that Gnomon draws for it.
#pragma once

#include <fmt/ranges.h>

#include "compare/result/judged.h"
#include "tests/support/capture_support.h"

namespace gnomon::test {

/// A floor, a plate that hovers closely over it, turned, and a box that stands on it.
inline Scene hovering_box(const std::string& light) {
  Mesh high = box_mesh({-0.8, 0.0, -0.9}, {0.8, 0.03, 0.9}),
       low = box_mesh({1.2, 0.0, -1.4}, {2.0, 0.7, -0.5});
  for (Vec3& p : high.positions) p = Vec3(0.98 * p.x - 0.2 * p.y, 0.2 + 0.2 * p.x + 0.98 * p.y, p.z);
  Scene scene = sunlit_scene({floor_mesh(4, 4), high, low}, {0.9, -1.0, 0.5});
  scene.camera = {{3.5, 2.2, 4.5}, {0.4, 0.1, 0.2}, {0, 1, 0}, 0.8};
  if (light == "sun") return scene;
  Light& lamp = scene.lights[0];
  lamp.type = light == "bulb" ? LightType::point : LightType::spot;
  lamp.position = {-1.5, 6.0, -1.0};
  lamp.direction = glm::normalize(-lamp.position);
  lamp.inner_angle = 0.6, lamp.outer_angle = 0.7;
  return scene;
}

/// A light's map and the picture that another renderer draws on it with this bias.
struct Engine {
  explicit Engine(const std::string& name, double constant_depth, const std::string& light = "sun",
                  judge::StoredDepth stored = judge::StoredDepth::zero_to_one,
                  const raster::Bias& casters = {}, raster::Technique technique = raster::Technique::hard)
      : drawn(draw_scene(hovering_box(light), small_picture, map_with(casters, technique))),
        capture(self_capture(drawn, folder_for("own-" + name), {.map = true, .stored = stored})) {
    capture.bias = judge::CapturedBias{.constant_depth = constant_depth};
    draw_again(capture, drawn);
  }
  static raster::MapOptions map_with(const raster::Bias& casters, raster::Technique technique) {
    raster::MapOptions map = hard_map(512, technique);
    map.bias = casters;
    map.bias.constant = 0.0, map.bias.unit = raster::BiasUnit::world;
    return map;
  }
  JudgeOutcome judged(bool fix = false) const {
    judge::JudgeOptions options;
    options.fix = fix;
    return judge(capture, *drawn.scene, options);
  }
  const LightView& view() const { return drawn.result.raster.lights[0].map.view; }
  double range() const { return view().face(0).far_depth - view().face(0).near_depth; }
  void change_picture(const std::function<float(float)>& change) {
    spoil(capture.visibility, [&](ChannelImage& image) {
      for (float& v : image.channels[0].values) v = change(v);
    });
  }

  Compared drawn;
  judge::Capture capture;
};

inline std::string notes_in(const JudgeOutcome& judged) {
  return judged.result ? fmt::format("{}", fmt::join(judged.result->judged->notes, "\n")) : reason(judged);
}

}  // namespace gnomon::test

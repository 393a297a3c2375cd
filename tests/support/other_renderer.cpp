#include "support/capture_support.h"

#include "scene/files/pictures/image_io.h"
#include "scene/light.h"
#include "support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Capture;
using compare::RowOrder;
using compare::StoredDepth;

/// Looks shadows up as engines write it: the place through the layer's matrix, one texel, two stored numbers compared.
class OtherRenderer {
 public:
  OtherRenderer(const Capture& capture, const Light& light, float outside)
      : capture_(capture), light_(light), outside_(outside) {
    for (const compare::CapturedLayer& layer : capture.map) texels_.push_back(*read_channels(layer.depth));
  }

  float visibility(const Vec3& surface, const Vec3& normal) const {
    const Vec3 place = surface + capture_.bias->normal_offset_world * normal;
    const auto layer = layer_of(place);
    if (!layer) return outside_;
    const Vec4 clip = *capture_.map[*layer].clip_from_world * Vec4(place, 1.0);
    const int n = texels_[*layer].size.width;
    const auto texel = [&](double ndc) {
      return std::clamp(static_cast<int>((0.5 * ndc + 0.5) * n), 0, n - 1);
    };
    const int x = texel(clip.x / clip.w), y = texel(clip.y / clip.w);
    const int row = capture_.map[*layer].rows == RowOrder::top_down ? n - 1 - y : y;
    const double stored = texels_[*layer].channels[0].values[static_cast<std::size_t>(row * n + x)];
    return is_dark(clip.z / clip.w, glm::length(place - light_.position), stored) ? 0.0f : 1.0f;
  }

 private:
  bool is_dark(double z, double distance, double stored) const {
    const double bias = capture_.bias->constant_depth;
    switch (*capture_.map.front().convention) {
      case StoredDepth::zero_to_one:
        return stored < 1.0 && z - stored > bias;
      case StoredDepth::minus_one_to_one:
        return stored < 1.0 && 0.5 * z + 0.5 - stored > bias;
      case StoredDepth::reversed:
        return stored > 0.0 && stored - z > bias;
      case StoredDepth::distance:
        break;
    }
    return stored > 0.0 && distance - stored > bias;
  }

  /// A cube's face that looks at the place, or the first cascade that holds it and its neighbouring texels.
  std::optional<std::size_t> layer_of(const Vec3& place) const {
    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t i = 0; i < texels_.size(); ++i) {
      const Vec4 clip = *capture_.map[i].clip_from_world * Vec4(place, 1.0);
      const bool perspective = light_.type != LightType::directional, cube = texels_.size() == 6;
      const double margin = i + 1 < texels_.size() ? 1.0 - 2.0 / texels_[i].size.width : 1.0;
      const double beside = std::max(std::abs(clip.x), std::abs(clip.y)) / clip.w;
      if (clip.w <= most || (!cube && beside >= margin)) continue;
      best = i, most = clip.w;
      if (!perspective) break;
    }
    return best;
  }

  const Capture& capture_;
  const Light& light_;
  float outside_;
  std::vector<ChannelImage> texels_;
};

}  // namespace

Scene scene_under(const std::string& light) {
  Scene scene = boxes_under_three_lights();
  std::erase_if(scene.lights, [&](const Light& l) { return l.name != light; });
  EXPECT_EQ(scene.lights.size(), 1U) << light;
  return scene;
}

void draw_again(const Capture& capture, const Compared& drawn, float outside, bool by_fronts) {
  const OtherRenderer other(capture, drawn.scene->lights[0], outside);
  spoil(capture.visibility, [&](ChannelImage& image) {
    for (Channel& channel : image.channels)
      for (std::size_t i = 0; channel.name != "A" && i < channel.values.size(); ++i) {
        const raytrace::SurfacePoint& point = drawn.result.raytraced.receiver.data[i];
        if (point.primitive == no_id) {
          channel.values[i] = 1.0f;
          continue;
        }
        const Vec3 normal =
            by_fronts ? outward_normal(*drawn.world, point.primitive, point.position) : point.normal;
        channel.values[i] = other.visibility(point.position, normal);
      }
  });
}

}  // namespace gnomon::test

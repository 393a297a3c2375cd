#include "tests/support/capture_support.h"

#include "scene/files/pictures/image_io.h"
#include "scene/light.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using compare::Capture;
using compare::RowOrder;
using compare::StoredDepth;

/// Looks shadows up as engines write it: the place through the layer's matrix, one texel, two stored numbers compared.
class OtherRenderer {
 public:
  OtherRenderer(const Capture& capture, const Light& light, const View& view, float outside)
      : capture_(capture), light_(light), view_(view), outside_(outside) {
    for (const compare::CapturedLayer& layer : capture.map) texels_.push_back(*read_channels(layer.depth));
  }

  float visibility(const Vec3& surface, const Vec3& normal) const {
    const auto seen = layer_of(surface);
    float light = layer_visibility(surface, normal, seen);
    if (selects() && seen && capture_.map[*seen].select->blend > 0.0) {
      const compare::CapturedSelect& select = *capture_.map[*seen].select;
      const double left = select.far - from_camera(select.by_distance, surface);
      const double next = std::clamp(1.0 - left / select.blend, 0.0, 1.0);
      light = float((1.0 - next) * light + next * layer_visibility(surface, normal, *seen + 1));
    }
    if (const auto& fade = capture_.fade) {
      const double at = from_camera(fade->by_distance, surface);
      const double gone = fade->to > fade->from
                              ? std::clamp((at - fade->from) / (fade->to - fade->from), 0.0, 1.0)
                              : (at > fade->from ? 1.0 : 0.0);
      light = float(gone + (1.0 - gone) * light);
    }
    return float(1.0 - capture_.strength.value_or(1.0) * (1.0 - light));
  }

 private:
  double from_camera(bool by_distance, const Vec3& place) const {
    return by_distance ? glm::length(place - view_.eye) : glm::dot(place - view_.eye, view_.forward);
  }

  float layer_visibility(const Vec3& surface, const Vec3& normal, std::optional<std::size_t> seen) const {
    const compare::CapturedBias bias = seen ? bias_of(*seen) : *capture_.bias;
    const double cosine = std::max(0.0, glm::dot(normal, light_at(light_, surface).to_light));
    const Vec3 place =
        surface + bias.normal_offset_world * by_angle(bias.normal_offset_angle, cosine) * normal;
    const auto layer = selects() ? seen : layer_of(place);
    if (!layer) return outside_;
    const Vec4 clip = *capture_.map[*layer].clip_from_world * Vec4(place, 1.0);
    const Vec3 ndc = Vec3(clip) / clip.w;
    if (!holds(*layer, ndc, 0.0)) return outside_;
    const compare::CapturedBias own = bias_of(*layer);
    const double constant = std::clamp(own.constant_depth * by_angle(own.angle, cosine), own.min, own.max);
    const Vec2 range = capture_.map[*layer].range.value_or(Vec2(0.0, 1.0));
    const auto stored = [&](double world) { return (world - range.x) / (range.y - range.x); };
    const double sign = range.y > range.x ? 1.0 : -1.0;
    const double texel = sign * read(*layer, ndc);
    return is_dark(ndc.z, sign * stored(clip.w), sign * stored(glm::length(place - light_.position)), texel,
                   constant)
               ? 0.0f
               : 1.0f;
  }

  /// As shaders write it, of the dot product of normal and light.
  static double by_angle(raster::AngleForm form, double cosine) {
    switch (form) {
      case raster::AngleForm::sine:
        return std::sqrt(1.0 - cosine * cosine);
      case raster::AngleForm::tangent:
        return std::tan(std::acos(cosine));
      case raster::AngleForm::one_minus_cosine:
        return 1.0 - cosine;
      case raster::AngleForm::none:
        break;
    }
    return 1.0;
  }

  bool selects() const { return capture_.map.front().select.has_value(); }
  compare::CapturedBias bias_of(std::size_t layer) const {
    return capture_.map[layer].bias.value_or(*capture_.bias);
  }

  /// Whether a place lies on the layer's part of its picture, with so many texels around it.
  bool holds(std::size_t layer, const Vec3& ndc, double margin) const {
    const ImageSize size = texels_[layer].size;
    const compare::CapturedRect rect =
        capture_.map[layer].rect.value_or(compare::CapturedRect{0, 0, size.width, size.height});
    const bool top_down = capture_.map[layer].rows == RowOrder::top_down;
    const int low = top_down ? size.height - rect.y - rect.height : rect.y;
    const Vec2 at = (0.5 * Vec2(ndc) + 0.5) * Vec2(size.width, size.height);
    return at.x >= rect.x + margin && at.x < rect.x + rect.width - margin && at.y >= low + margin &&
           at.y < low + rect.height - margin;
  }

  double texel(std::size_t layer, int x, int row) const {
    const ImageSize size = texels_[layer].size;
    x = std::clamp(x, 0, size.width - 1), row = std::clamp(row, 0, size.height - 1);
    const int y = capture_.map[layer].rows == RowOrder::top_down ? size.height - 1 - row : row;
    return texels_[layer].channels[0].values[static_cast<std::size_t>(y * size.width + x)];
  }

  double read(std::size_t layer, const Vec3& ndc) const {
    const ImageSize size = texels_[layer].size;
    const Vec2 at = (0.5 * Vec2(ndc) + 0.5) * Vec2(size.width, size.height);
    if (!capture_.filter || !capture_.filter->linear_depths)
      return texel(layer, static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
    const Vec2 corner = glm::floor(at - 0.5), share = at - 0.5 - corner;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    return (1.0 - share.y) * ((1.0 - share.x) * texel(layer, x, y) + share.x * texel(layer, x + 1, y)) +
           share.y * ((1.0 - share.x) * texel(layer, x, y + 1) + share.x * texel(layer, x + 1, y + 1));
  }

  /// `along`: the depth along the light's axis, and `distance` that from the light, as they are stored.
  bool is_dark(double z, double along, double distance, double stored, double bias) const {
    switch (*capture_.map.front().convention) {
      case StoredDepth::zero_to_one:
        return stored < 1.0 && z - stored > bias;
      case StoredDepth::minus_one_to_one:
        return stored < 1.0 && 0.5 * z + 0.5 - stored > bias;
      case StoredDepth::reversed:
        return stored > 0.0 && stored - z > bias;
      case StoredDepth::linear_z:
        return stored != 0.0 && along - stored > bias;
      case StoredDepth::distance:
        break;
    }
    return stored != 0.0 && distance - stored > bias;
  }

  /// The layer whose distance it is; a cube's face that looks at the place, or the first cascade that holds it and its
  /// neighbouring texels.
  std::optional<std::size_t> layer_of(const Vec3& place) const {
    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t i = 0; i < texels_.size(); ++i) {
      if (const auto& select = capture_.map[i].select) {
        const double distance = from_camera(select->by_distance, place);
        if (distance >= select->near && distance < select->far) return i;
        continue;
      }
      const Vec4 clip = *capture_.map[i].clip_from_world * Vec4(place, 1.0);
      const bool perspective = light_.type != LightType::directional, cube = texels_.size() == 6;
      const double margin = i + 1 < texels_.size() ? 1.0 : 0.0;
      if (clip.w <= most || (!cube && !holds(i, Vec3(clip) / clip.w, margin))) continue;
      best = i, most = clip.w;
      if (!perspective) break;
    }
    return best;
  }

  const Capture& capture_;
  const Light& light_;
  View view_;
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
  const OtherRenderer other(capture, drawn.scene->lights[0], make_view(drawn.scene->camera, capture.size),
                            outside);
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

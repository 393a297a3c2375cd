#include "tests/support/capture_support.h"

#include "scene/files/pictures/image_io.h"
#include "scene/light.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {
namespace {

using judge::Capture;
using judge::RowOrder;
using judge::StoredDepth;

/// Looks shadows up as engines write it: the place through the layer's matrix, one texel, two stored numbers compared.
class OtherRenderer {
 public:
  OtherRenderer(const Capture& capture, const Light& light, const View& view, float outside,
                const FilterTaps& filter)
      : capture_(capture), light_(light), view_(view), outside_(outside), filter_(filter) {
    for (const judge::CapturedLayer& layer : capture.map) texels_.push_back(*read_channels(layer.depth));
  }

  float visibility(const Vec3& surface, const Vec3& normal) const {
    const bool halves = capture_.map.front().convention == StoredDepth::paraboloid;
    const auto seen = halves ? std::nullopt : layer_of(surface);
    float light = halves ? paraboloid_visibility(surface, normal) : layer_visibility(surface, normal, seen);
    if (selects() && seen && capture_.map[*seen].select->blend > 0.0) {
      const judge::CapturedSelect& select = *capture_.map[*seen].select;
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
    const judge::CapturedBias bias = seen ? bias_of(*seen) : *capture_.bias;
    const double cosine = std::max(0.0, glm::dot(normal, light_at(light_, surface).to_light));
    const Vec3 place =
        surface + bias.normal_offset_world * by_angle(bias.normal_offset_angle, cosine) * normal;
    const auto layer = selects() ? seen : layer_of(place);
    if (!layer) return outside_;
    const Vec4 clip = *capture_.map[*layer].clip_from_world * Vec4(place, 1.0);
    const Vec3 ndc = Vec3(clip) / clip.w;
    if (!holds(*layer, ndc, 0.0)) return outside_;
    const judge::CapturedBias own = bias_of(*layer);
    const double constant = std::clamp(own.constant_depth * by_angle(own.angle, cosine), own.min, own.max);
    const Vec2 range = capture_.map[*layer].range.value_or(Vec2(0.0, 1.0));
    const auto stored = [&](double world) { return (world - range.x) / (range.y - range.x); };
    const double sign = range.y > range.x ? 1.0 : -1.0;
    if (capture_.filter && capture_.filter->read == judge::FilterRead::moments)
      return float(light_of(
          *layer, ndc,
          number_of(ndc.z, stored(clip.w), stored(glm::length(place - light_.position))) - constant));
    const double along = sign * stored(clip.w),
                 distance = sign * stored(glm::length(place - light_.position));
    return averaged(*layer, ndc, [&](const Vec3& at) {
      return is_dark(ndc.z, along, distance, sign * read(*layer, at, 0), constant) ? 0.0 : 1.0;
    });
  }

  /// The mean of the comparisons at the filter's taps, each of one texel or of four by how near they are; without taps the one.
  template <class Lit>
  float averaged(std::size_t layer, const Vec3& ndc, const Lit& lit) const {
    if (filter_.taps.empty()) return float(lit(ndc));
    const Vec2 size(texels_[layer].size.width, texels_[layer].size.height),
        own = (0.5 * Vec2(ndc) + 0.5) * size;
    const auto at = [&](const Vec2& texels) { return lit(Vec3(2.0 * texels / size - 1.0, ndc.z)); };
    // One turn for each pixel, as noise would give it.
    const double angle = filter_.turned ? 1e4 * (own.x + 1.7 * own.y) : 0.0;
    double sum = 0.0;
    for (const Vec2& tap : filter_.taps) {
      const Vec2 place = own + Vec2(std::cos(angle) * tap.x - std::sin(angle) * tap.y,
                                    std::sin(angle) * tap.x + std::cos(angle) * tap.y);
      const Vec2 corner = glm::floor(place - 0.5) + 0.5, share = place - corner;
      sum += !filter_.linear
                 ? at(place)
                 : (1.0 - share.y) * ((1.0 - share.x) * at(corner) + share.x * at(corner + Vec2(1.0, 0.0))) +
                       share.y * ((1.0 - share.x) * at(corner + Vec2(0.0, 1.0)) +
                                  share.x * at(corner + Vec2(1.0, 1.0)));
    }
    return float(sum / double(filter_.taps.size()));
  }

  /// As Brabec and others write it: the half that the place lies before, and the distance.
  float paraboloid_visibility(const Vec3& surface, const Vec3& normal) const {
    const judge::CapturedBias& bias = *capture_.bias;
    const Vec3 place = surface + bias.normal_offset_world * normal;
    const auto in_half = [&](std::size_t half) {
      return Vec3(*capture_.map[half].clip_from_world * Vec4(place, 1.0));
    };
    const std::size_t half = in_half(0).z >= 0.0 ? 0 : 1;
    const Vec3 d = in_half(half);
    const double distance = glm::length(d);
    Vec2 at = 0.5 * Vec2(d) / (distance + d.z) + 0.5;
    if (const auto& rect = capture_.map[half].rect) {
      const Vec2 picture(texels_[half].size.width, texels_[half].size.height);
      at = (Vec2(rect->x, rect->y) + at * Vec2(rect->width, rect->height)) / picture;
    }
    const Vec2 range = capture_.map[half].range.value_or(Vec2(0.0, 1.0));
    const double texel = read(half, Vec3(2.0 * at - 1.0, 0.0), 0);
    const double own = (distance - range.x) / (range.y - range.x);
    return texel != 0.0 && own - texel > bias.constant_depth ? 0.0f : 1.0f;
  }

  /// As shaders write it, of the dot product of normal and light.
  static double by_angle(judge::BiasAngle form, double cosine) {
    switch (form) {
      case judge::BiasAngle::sine:
        return std::sqrt(1.0 - cosine * cosine);
      case judge::BiasAngle::tangent:
        return std::tan(std::acos(cosine));
      case judge::BiasAngle::one_minus_cosine:
        return 1.0 - cosine;
      case judge::BiasAngle::none:
        break;
    }
    return 1.0;
  }

  bool selects() const { return capture_.map.front().select.has_value(); }
  judge::CapturedBias bias_of(std::size_t layer) const {
    return capture_.map[layer].bias.value_or(*capture_.bias);
  }

  /// Whether a place lies on the layer's part of its picture, with so many texels around it.
  bool holds(std::size_t layer, const Vec3& ndc, double margin) const {
    const ImageSize size = texels_[layer].size;
    const judge::CapturedRect rect =
        capture_.map[layer].rect.value_or(judge::CapturedRect{0, 0, size.width, size.height});
    const bool top_down = capture_.map[layer].rows == RowOrder::top_down;
    const int low = top_down ? size.height - rect.y - rect.height : rect.y;
    const Vec2 at = (0.5 * Vec2(ndc) + 0.5) * Vec2(size.width, size.height);
    return at.x >= rect.x + margin && at.x < rect.x + rect.width - margin && at.y >= low + margin &&
           at.y < low + rect.height - margin;
  }

  /// The receiver's own number, as it is stored.
  double number_of(double z, double along, double distance) const {
    switch (*capture_.map.front().convention) {
      case StoredDepth::minus_one_to_one:
        return 0.5 * z + 0.5;
      case StoredDepth::linear_z:
        return along;
      case StoredDepth::distance:
        return distance;
      default:
        return z;
    }
  }

  /// A technique of moments as its shaders are written.
  double light_of(std::size_t layer, const Vec3& ndc, double x) const {
    const judge::CapturedFilter& filter = *capture_.filter;
    const auto m = [&](std::size_t channel) { return read(layer, ndc, channel); };
    const auto bound = [](double first, double second, double at, double least) {
      const double variance = std::max(second - first * first, std::max(least, 2.4e-7 * second));
      return at <= first ? 1.0 : variance / (variance + (at - first) * (at - first));
    };
    const auto warped = [&](std::size_t which, std::size_t channel) {
      const double sign = which == 0 ? 1.0 : -1.0, exponent = filter.exponents[which];
      const double at = sign * std::exp(sign * exponent * (2.0 * x - 1.0)), slope = exponent * at;
      return bound(m(channel), m(channel + 1), at, filter.minimum_variance * slope * slope);
    };
    double light = 1.0;
    switch (filter.kind) {
      case judge::FilterName::esm:
        return std::min(1.0, m(0) * std::exp(-filter.exponents[0] * x));
      case judge::FilterName::evsm:
        light = warped(0, 0);
        if (filter.exponents.size() > 1) light = std::min(light, warped(1, 2));
        break;
      case judge::FilterName::msm:
        light = hamburger({m(0), m(1), m(2), m(3)}, x, filter.moment_bias);
        break;
      default:
        light = bound(m(0), m(1), x, filter.minimum_variance);
    }
    const double cut = filter.light_bleeding_reduction;
    return std::clamp((light - cut) / (1.0 - cut), 0.0, 1.0);
  }

  /// Peters and Klein 2015, algorithm 3, by Cholesky's decomposition.
  static double hamburger(std::array<double, 4> b, double x, double bias) {
    for (double& one : b) one = (1.0 - bias) * one + bias * 0.5;
    const double d2 = b[1] - b[0] * b[0], l32 = (b[2] - b[0] * b[1]) / d2;
    const double d3 = b[3] - b[1] * b[1] - l32 * l32 * d2;
    // What the paper divides by d3 is not divided by it here: that is 0 of a texel that holds one of its two ends alone.
    const double c2 = x * x - b[1] - l32 * (x - b[0]), c1 = d3 * (x - b[0]) / d2 - l32 * c2;
    const double c0 = d3 - b[0] * c1 - b[1] * c2;
    const double root = std::sqrt(std::max(0.25 * c1 * c1 / (c2 * c2) - c0 / c2, 0.0));
    const double low = -0.5 * c1 / c2 - root, high = -0.5 * c1 / c2 + root;
    if (x <= low) return 1.0;
    if (x <= high) return 1.0 - (x * high - b[0] * (x + high) + b[1]) / ((high - low) * (x - low));
    return (low * high - b[0] * (low + high) + b[1]) / ((x - low) * (x - high));
  }

  double texel(std::size_t layer, int x, int row, std::size_t channel) const {
    const ImageSize size = texels_[layer].size;
    x = std::clamp(x, 0, size.width - 1), row = std::clamp(row, 0, size.height - 1);
    const int y = capture_.map[layer].rows == RowOrder::top_down ? size.height - 1 - row : row;
    return texels_[layer].channels[channel].values[static_cast<std::size_t>(y * size.width + x)];
  }

  double read(std::size_t layer, const Vec3& ndc, std::size_t channel) const {
    const ImageSize size = texels_[layer].size;
    const Vec2 at = (0.5 * Vec2(ndc) + 0.5) * Vec2(size.width, size.height);
    if (!capture_.filter || capture_.filter->read == judge::FilterRead::nearest)
      return texel(layer, static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)), channel);
    const Vec2 corner = glm::floor(at - 0.5), share = at - 0.5 - corner;
    const int x = static_cast<int>(corner.x), y = static_cast<int>(corner.y);
    return (1.0 - share.y) *
               ((1.0 - share.x) * texel(layer, x, y, channel) + share.x * texel(layer, x + 1, y, channel)) +
           share.y * ((1.0 - share.x) * texel(layer, x, y + 1, channel) +
                      share.x * texel(layer, x + 1, y + 1, channel));
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
      case StoredDepth::paraboloid:
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
  const FilterTaps& filter_;
  std::vector<ChannelImage> texels_;
};

/// What the texels of a technique hold of a stored number, as its papers say.
std::array<double, 4> moments_of(const judge::CapturedFilter& filter, double x) {
  const auto warped = [&](std::size_t which, double sign) {
    return sign * std::exp(sign * filter.exponents[which] * (2.0 * x - 1.0));
  };
  if (filter.kind == judge::FilterName::esm) return {std::exp(filter.exponents[0] * x), 0.0, 0.0, 0.0};
  if (filter.kind != judge::FilterName::evsm) return {x, x * x, x * x * x, x * x * x * x};
  const double positive = warped(0, 1.0), negative = filter.exponents.size() > 1 ? warped(1, -1.0) : 0.0;
  return {positive, positive * positive, negative, negative * negative};
}

}  // namespace

void store_moments(Capture& capture) {
  capture.filter->read = judge::FilterRead::moments, capture.filter->radius_texels = 2.5;
  constexpr const char* names[] = {"R", "G", "B", "A"};
  const judge::CapturedFilter& filter = *capture.filter;
  const int reach = static_cast<int>(filter.radius_texels);
  for (const judge::CapturedLayer& layer : capture.map)
    spoil(layer.depth, [&](ChannelImage& image) {
      const int n = image.size.width, rows = image.size.height;
      std::vector<std::array<double, 4>> one(image.size.pixels()), across = one;
      for (std::size_t i = 0; i < one.size(); ++i)
        one[i] = moments_of(filter, double{image.channels[0].values[i]});
      const auto blur = [&](auto& from, auto& to, int dx, int dy) {
        for (int y = 0; y < rows; ++y)
          for (int x = 0; x < n; ++x) {
            std::array<double, 4> sum{};
            for (int i = -reach; i <= reach; ++i)
              for (std::size_t k = 0; k < 4; ++k)
                sum[k] += from[std::size_t(std::clamp(y + i * dy, 0, rows - 1) * n +
                                           std::clamp(x + i * dx, 0, n - 1))][k];
            for (std::size_t k = 0; k < 4; ++k) to[std::size_t(y * n + x)][k] = sum[k] / (2 * reach + 1);
          }
      };
      blur(one, across, 1, 0), blur(across, one, 0, 1);
      const bool esm = filter.kind == judge::FilterName::esm;
      const bool four = filter.kind == judge::FilterName::msm || filter.exponents.size() > 1;
      image.channels.clear();
      for (std::size_t k = 0; k < (esm ? 1U : four ? 4U : 2U); ++k) {
        Channel& channel = image.channels.emplace_back(Channel{names[k], {}});
        for (const auto& texel : one) channel.values.push_back(static_cast<float>(texel[k]));
      }
    });
}

Scene scene_under(const std::string& light) {
  Scene scene = boxes_under_three_lights();
  std::erase_if(scene.lights, [&](const Light& l) { return l.name != light; });
  EXPECT_EQ(scene.lights.size(), 1U) << light;
  return scene;
}

FilterTaps square_taps(int side, bool linear) {
  FilterTaps out{.linear = linear};
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) out.taps.emplace_back(i - 0.5 * (side - 1), j - 0.5 * (side - 1));
  return out;
}

void draw_again(const Capture& capture, const Compared& drawn, float outside, bool by_fronts,
                const FilterTaps& filter) {
  const OtherRenderer other(capture, drawn.scene->lights[0], make_view(drawn.scene->camera, capture.size),
                            outside, filter);
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

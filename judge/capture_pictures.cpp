#include "judge/capture_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/files/path_status.h"

namespace gnomon::judge {
namespace {

constexpr std::array<std::string_view, 3> visibility_names{"V", "Y", "R"};
constexpr std::array<std::string_view, 4> depth_names{"Z", "Y", "R", "V"};
/// Floats that an average or a resampling makes may leave [0, 1] by so much.
constexpr float range_slack = 1e-3f;
/// The share of the brightest unshadowed value below which a ratio says nothing: a 16-bit PNG's step is
/// 1.5e-5, so that the ratio is known within 2 % there.
constexpr float least_light = 1e-3f;
/// The share that something else leaves below which eight bits know the shadow's no better than to 6 %.
constexpr float least_also = 1.0f / 16.0f;
/// What noise and eight bits do not make: a quarter of the value and a hundredth of the brightest.
constexpr float clear_share = 0.25f, clear_light = 0.01f;

tl::unexpected<Error> picture_error(const std::string& file, const std::string& field, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.file = file, error.field = field;
  return fail(std::move(error));
}

/// Checks that the picture has the capture's size in pixels.
Expected<ImageSize> checked_size(const Capture& capture, const std::string& file, const std::string& field,
                                 bool of_pixels) {
  if (const auto there = size_of_file(file); !there)
    return capture_error(capture, field, fmt::format("{} (got {})", there.error().reason, file));
  const auto size = read_image_size(file);
  if (size && of_pixels && *size != capture.size)
    return picture_error(file, field,
                         fmt::format("is of another size (got {} x {}, the capture says {} x {})",
                                     size->width, size->height, capture.size.width, capture.size.height));
  return size;
}

Expected<void> check_layer_sizes(const Capture& capture) {
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const std::string field = fmt::format("map[{}].depth", i);
    const auto picture = checked_size(capture, capture.map[i].depth, field, false);
    if (!picture) return fail(picture.error());
    const CapturedRect rect =
        capture.map[i].rect.value_or(CapturedRect{0, 0, picture->width, picture->height});
    if (rect.x + rect.width > picture->width || rect.y + rect.height > picture->height)
      return capture_error(
          capture, fmt::format("map[{}].rect", i),
          fmt::format("reaches beyond its picture (got [{}, {}, {}, {}], the picture is {} x {})", rect.x,
                      rect.y, rect.width, rect.height, picture->width, picture->height));
  }
  return {};
}

/// Whatever its size was when it was looked at first, a file that has changed since is refused.
Expected<ChannelImage> read_picture(const Capture& capture, const std::string& file, const std::string& field,
                                    bool of_pixels) {
  const auto size = checked_size(capture, file, field, of_pixels);
  if (!size) return fail(size.error());
  auto picture = read_channels(file);
  if (picture && picture->size != *size) return picture_error(file, field, "has changed while it was read");
  return picture;
}

const Channel* find_alpha(const ChannelImage& picture) {
  const Channel* alpha = picture.find("A");
  return alpha != nullptr ? alpha : picture.find("alpha");
}

/// The one channel that is not alpha. OpenImageIO calls a grey PNG's channel Y.
Expected<Channel> single_channel(ChannelImage& picture, const std::string& file, const std::string& field,
                                 std::span<const std::string_view> names) {
  const Channel* alpha = find_alpha(picture);
  std::vector<Channel*> values;
  for (Channel& channel : picture.channels)
    if (&channel != alpha) values.push_back(&channel);
  if (values.size() != 1) {
    std::string got;
    for (const Channel* channel : values) got += (got.empty() ? "" : ", ") + channel->name;
    return picture_error(
        file, field,
        fmt::format("has {} channels where one is wanted (got {}, allowed {}){}", values.size(), got,
                    fmt::join(names, " or "),
                    field.starts_with("map[") ? "; of moments `filter.read` is \"moments\"" : ""));
  }
  const std::string& name = values.front()->name;
  const bool known = std::any_of(names.begin(), names.end(), [&](std::string_view n) { return n == name; });
  if (!known)
    return picture_error(
        file, field,
        fmt::format("has no channel that is known (got {}, allowed {})", name, fmt::join(names, ", ")));
  return std::move(*values.front());
}

Expected<void> check_finite(const Channel& channel, const std::string& file, const std::string& field,
                            bool infinity_allowed) {
  const auto bad = std::count_if(channel.values.begin(), channel.values.end(), [&](float v) {
    return infinity_allowed ? std::isnan(v) : !std::isfinite(v);
  });
  if (bad == 0) return {};
  return picture_error(file, field,
                       fmt::format("{} pixels of channel {} are not finite numbers", bad, channel.name));
}

void take_mask(const ChannelImage& picture, Image<std::uint8_t>& drawn) {
  const Channel* alpha = find_alpha(picture);
  if (alpha == nullptr) return;
  drawn = Image<std::uint8_t>(picture.size, 0);
  for (std::size_t i = 0; i < drawn.data.size(); ++i) drawn.data[i] = alpha->values[i] > 0.5f;
}

Expected<void> read_visibility(const Capture& capture, CapturedPictures& out) {
  const std::string& file = capture.visibility;
  auto picture = read_picture(capture, file, "visibility", true);
  if (!picture) return fail(picture.error());
  take_mask(*picture, out.drawn);
  auto channel = single_channel(*picture, file, "visibility", visibility_names);
  if (!channel) return fail(channel.error());
  if (const auto finite = check_finite(*channel, file, "visibility", false); !finite) return finite;
  const auto [low, high] = std::minmax_element(channel->values.begin(), channel->values.end());
  if (*low < -range_slack || *high > 1.0f + range_slack)
    return picture_error(
        file, "visibility",
        fmt::format("values beyond their range (got {:.4g} to {:.4g}, allowed 0 to 1)", *low, *high));
  out.visibility.data = std::move(channel->values);
  for (float& v : out.visibility.data) v = std::clamp(v, 0.0f, 1.0f);
  for (std::size_t i = 0; i < out.color.data.size(); ++i) out.color.data[i] = Vec3f(out.visibility.data[i]);
  return {};
}

/// RGB, or one channel for all three.
Expected<ColorImage> read_colour(const Capture& capture, const std::string& file, const std::string& field) {
  auto picture = read_picture(capture, file, field, true);
  if (!picture) return fail(picture.error());
  std::array<const Channel*, 3> rgb{picture->find("R"), picture->find("G"), picture->find("B")};
  if (rgb[0] == nullptr) rgb.fill(picture->find("Y"));
  if (rgb[0] != nullptr && rgb[1] == nullptr && rgb[2] == nullptr) rgb.fill(rgb[0]);
  if (rgb[0] == nullptr || rgb[1] == nullptr || rgb[2] == nullptr)
    return picture_error(file, field, "needs channels R, G, B, or Y alone");
  for (const Channel* channel : rgb)
    if (const auto finite = check_finite(*channel, file, field, false); !finite) return fail(finite.error());
  ColorImage out(picture->size);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    out.data[i] = {rgb[0]->values[i], rgb[1]->values[i], rgb[2]->values[i]};
  return out;
}

float sum(const Vec3f& colour) {
  return colour.x + colour.y + colour.z;
}

float brightest_of(const ColorImage& picture) {
  float brightest = 0.0f;
  for (const Vec3f& colour : picture.data) brightest = std::max(brightest, sum(colour));
  return brightest;
}

void count_differences(const ColorImage& shadowed, const ColorImage& unshadowed, CapturedPictures& out) {
  const float least = clear_light * std::max(brightest_of(shadowed), brightest_of(unshadowed));
  const auto clearly = [&](float a, float b) { return a > (1.0f + clear_share) * b + least; };
  for (std::size_t i = 0; i < shadowed.data.size(); ++i) {
    const float with = sum(shadowed.data[i]), without = sum(unshadowed.data[i]);
    out.brighter += clearly(with, without) ? 1 : 0, out.darker += clearly(without, with) ? 1 : 0;
  }
}

bool has_eight_bits(const ColorImage& picture) {
  const auto is_step = [](float v) {
    const float steps = 255.0f * v;
    return std::abs(steps - std::round(steps)) < 1e-3f;
  };
  return std::all_of(picture.data.begin(), picture.data.end(),
                     [&](const Vec3f& c) { return is_step(c.x) && is_step(c.y) && is_step(c.z); });
}

Expected<void> read_ratio(const Capture& capture, CapturedPictures& out) {
  auto shadowed = read_colour(capture, capture.shadowed, "shadowed");
  if (!shadowed) return fail(shadowed.error());
  auto unshadowed = read_colour(capture, capture.unshadowed, "unshadowed");
  if (!unshadowed) return fail(unshadowed.error());
  const float brightest = brightest_of(*unshadowed);
  if (!(brightest > 0.0f)) return picture_error(capture.unshadowed, "unshadowed", "is black all over");
  for (std::size_t i = 0; i < out.visibility.data.size(); ++i) {
    const float light = sum(unshadowed->data[i]);
    out.reached.data[i] = light > least_light * brightest;
    if (out.reached.data[i] != 0)
      out.visibility.data[i] = std::clamp(sum(shadowed->data[i]) / light, 0.0f, 1.0f);
  }
  count_differences(*shadowed, *unshadowed, out);
  out.ratio = true, out.eight_bits = has_eight_bits(*shadowed) && has_eight_bits(*unshadowed);
  out.color = std::move(*shadowed), out.unshadowed = std::move(*unshadowed);
  return {};
}

Expected<void> read_also(const Capture& capture, CapturedPictures& out) {
  ImageSize size = capture.size;
  const auto also = read_single_channel(capture, capture.also, "also", visibility_names, size);
  if (!also) return fail(also.error());
  if (const auto finite = check_finite(*also, capture.also, "also", false); !finite) return finite;
  const auto [low, high] = std::minmax_element(also->values.begin(), also->values.end());
  if (*low < -range_slack || *high > 1.0f + range_slack)
    return picture_error(
        capture.also, "also",
        fmt::format("values beyond their range (got {:.4g} to {:.4g}, allowed 0 to 1)", *low, *high));
  out.also = Image<float>(capture.size);
  out.also.data = also->values;
  divide_by_also(out);
  return {};
}

Expected<void> read_positions(const Capture& capture, CapturedPictures& out) {
  const std::string& file = capture.position;
  auto picture = read_picture(capture, file, "position", true);
  if (!picture) return fail(picture.error());
  std::array<const Channel*, 3> xyz{picture->find("X"), picture->find("Y"), picture->find("Z")};
  if (xyz[0] == nullptr) xyz = {picture->find("R"), picture->find("G"), picture->find("B")};
  if (xyz[0] == nullptr || xyz[1] == nullptr || xyz[2] == nullptr)
    return picture_error(file, "position", "needs channels X, Y, Z (or R, G, B)");
  for (const Channel* channel : xyz)
    if (const auto finite = check_finite(*channel, file, "position", false); !finite) return finite;
  Image<std::uint8_t> drawn;
  take_mask(*picture, drawn);
  const bool masked = !drawn.data.empty();
  if (!masked) drawn = Image<std::uint8_t>(capture.size, 0);
  out.position = Image<Vec3>(capture.size, Vec3(0.0));
  for (std::size_t i = 0; i < out.position.data.size(); ++i) {
    out.position.data[i] = {xyz[0]->values[i], xyz[1]->values[i], xyz[2]->values[i]};
    if (!masked) drawn.data[i] = out.position.data[i] != Vec3(0.0);
  }
  out.drawn = std::move(drawn);
  return {};
}

/// World units along the view's axis or the ray; 0 where nothing was drawn.
double world_depth(const CapturedDepth& depth, bool orthographic, double value) {
  if (orthographic && depth.near) {
    const double share = *depth.convention == PixelDepth::reversed ? 1.0 - value : value;
    return share < 0.0 || share >= 1.0 ? 0.0 : *depth.near + share * (*depth.far - *depth.near);
  }
  switch (*depth.convention) {
    case PixelDepth::view_z:
    case PixelDepth::distance:
      return std::isfinite(value) && value > 0.0 ? value : 0.0;
    case PixelDepth::zero_to_one:
      return value >= 1.0 || value < 0.0
                 ? 0.0
                 : *depth.near * *depth.far / (*depth.far - value * (*depth.far - *depth.near));
    case PixelDepth::reversed:
      break;
  }
  if (value <= 0.0) return 0.0;
  if (!depth.far) return *depth.near / value;
  return *depth.near * *depth.far / (*depth.near + value * (*depth.far - *depth.near));
}

Expected<void> read_depths(const Capture& capture, bool orthographic, CapturedPictures& out) {
  const CapturedDepth& depth = *capture.depth;
  if (orthographic && depth.near && !depth.far)
    return capture_error(capture, "depth.far",
                         "is missing; the depth buffer of an orthographic camera has one");
  ImageSize size = capture.size;
  const auto channel = read_single_channel(capture, depth.file, "depth.file", depth_names, size);
  if (!channel) return fail(channel.error());
  const bool endless = *depth.convention == PixelDepth::view_z || *depth.convention == PixelDepth::distance;
  if (const auto finite = check_finite(*channel, depth.file, "depth.file", endless); !finite) return finite;
  out.depth = Image<double>(capture.size);
  out.drawn = Image<std::uint8_t>(capture.size, 0);
  out.depth_is_distance = *depth.convention == PixelDepth::distance;
  for (std::size_t i = 0; i < out.depth.data.size(); ++i) {
    out.depth.data[i] = world_depth(depth, orthographic, double{channel->values[i]});
    out.drawn.data[i] = out.depth.data[i] > 0.0;
  }
  return {};
}

}  // namespace

Expected<Channel> read_single_channel(const Capture& capture, const std::string& file,
                                      const std::string& field, std::span<const std::string_view> names,
                                      ImageSize& size) {
  const bool of_pixels = size.pixels() > 0;
  auto picture = read_picture(capture, file, field, of_pixels);
  if (!picture) return fail(picture.error());
  size = picture->size;
  return single_channel(*picture, file, field, names);
}

Expected<ChannelImage> read_layer(const Capture& capture, std::size_t layer) {
  return read_picture(capture, capture.map[layer].depth, fmt::format("map[{}].depth", layer), false);
}

Expected<void> check_picture_sizes(const Capture& capture) {
  for (const auto& [field, file] :
       {std::pair{"visibility", &capture.visibility}, std::pair{"shadowed", &capture.shadowed},
        std::pair{"unshadowed", &capture.unshadowed}, std::pair{"also", &capture.also},
        std::pair{"position", &capture.position}}) {
    if (file->empty()) continue;
    if (const auto size = checked_size(capture, *file, field, true); !size) return fail(size.error());
  }
  if (capture.depth)
    if (const auto size = checked_size(capture, capture.depth->file, "depth.file", true); !size)
      return fail(size.error());
  return check_layer_sizes(capture);
}

Expected<ImageSize> layer_picture_size(const Capture& capture, std::size_t layer) {
  return checked_size(capture, capture.map[layer].depth, fmt::format("map[{}].depth", layer), false);
}

Expected<ImageSize> layer_size(const Capture& capture, std::size_t layer) {
  if (const auto& rect = capture.map[layer].rect) return ImageSize{rect->width, rect->height};
  return layer_picture_size(capture, layer);
}

Expected<CapturedPictures> read_pictures(const Capture& capture, bool orthographic) {
  CapturedPictures out;
  out.visibility = Image<float>(capture.size, 1.0f);
  out.reached = Image<std::uint8_t>(capture.size, 1);
  out.color = ColorImage(capture.size, Vec3f(0.0f));
  const auto read = capture.visibility.empty() ? read_ratio(capture, out) : read_visibility(capture, out);
  if (!read) return fail(read.error());
  if (!capture.also.empty())
    if (const auto also = read_also(capture, out); !also) return fail(also.error());
  if (!capture.position.empty())
    if (const auto positions = read_positions(capture, out); !positions) return fail(positions.error());
  if (capture.depth)
    if (const auto depths = read_depths(capture, orthographic, out); !depths) return fail(depths.error());
  return out;
}

void divide_by_also(CapturedPictures& out) {
  for (std::size_t i = 0; i < out.also.data.size(); ++i) {
    const bool tells = out.also.data[i] >= least_also;
    if (!tells) out.reached.data[i] = 0;
    float& v = out.visibility.data[i];
    v = tells ? std::min(1.0f, v / out.also.data[i]) : 1.0f;
  }
}

Expected<Channel> read_layer_numbers(const Capture& capture, std::size_t layer, ImageSize& size) {
  static constexpr std::array<std::string_view, 4> names{"Z", "Y", "R", "V"};
  return read_single_channel(capture, capture.map[layer].depth, fmt::format("map[{}].depth", layer), names,
                             size);
}

}  // namespace gnomon::judge

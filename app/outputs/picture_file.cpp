// Ids are exact up to 2^24, as far as 32-bit floats count.
#include "app/outputs/picture_file.h"

#include <array>
#include <vector>

#include "scene/exposure.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon::app {

namespace {

class Channels {
 public:
  explicit Channels(ImageSize size) : size_(size) {}

  /// `value` maps a pixel's index to its number.
  template <class Value>
  void add(const std::string& name, const Value& value) {
    Channel channel{name, std::vector<float>(size_.pixels())};
    for (std::size_t i = 0; i < channel.values.size(); ++i) channel.values[i] = static_cast<float>(value(i));
    channels_.push_back(std::move(channel));
  }

  void add_color(const ColorImage& color) {
    constexpr std::array<const char*, 3> names{"R", "G", "B"};
    for (int k = 0; k < 3; ++k) {
      add(names[static_cast<std::size_t>(k)], [&](std::size_t i) { return color.data[i][k]; });
    }
  }

  /// `value` gives a world-space vector.
  template <class Value>
  void add_vector(const std::string& name, const Value& value) {
    constexpr std::array<const char*, 3> axes{".X", ".Y", ".Z"};
    for (int k = 0; k < 3; ++k) {
      add(name + axes[static_cast<std::size_t>(k)], [&](std::size_t i) { return value(i)[k]; });
    }
  }

  /// `primitive` gives a pixel's primitive or no_id.
  template <class Primitive>
  void add_ids(const World& world, const Primitive& primitive) {
    add("object.V", [&](std::size_t i) {
      return id_value(primitive(i) == no_id ? no_id : world.object_of(primitive(i)));
    });
    add("primitive.V", [&](std::size_t i) { return id_value(primitive(i)); });
  }

  std::vector<Channel> take() { return std::move(channels_); }

 private:
  static double id_value(std::uint32_t id) { return id == no_id ? -1.0 : static_cast<double>(id); }
  ImageSize size_;
  std::vector<Channel> channels_;
};

/// "" for the only light, "NAME." for one of several.
std::string light_prefix(const World& world, std::uint32_t light, std::size_t light_count) {
  return light_count == 1 ? std::string() : world.scene->lights[light].name + ".";
}

void add_record(Channels& channels, const raster::LightRecord& record, const std::string& prefix) {
  channels.add(prefix + "drawn.V", [&](std::size_t i) { return record.visibility.data[i]; });
  channels.add(prefix + "gap.V", [&](std::size_t i) { return record.gap.data[i]; });
  channels.add(prefix + "texel_uv.U", [&](std::size_t i) { return record.texel_uv.data[i].x; });
  channels.add(prefix + "texel_uv.V", [&](std::size_t i) { return record.texel_uv.data[i].y; });
  channels.add(prefix + "distance.V", [&](std::size_t i) { return record.distance.data[i]; });
}

double truth_value(const raytrace::LightTruth& light, std::size_t pixel) {
  if (!light.visibility.data.empty()) return light.visibility.data[pixel];
  const raytrace::PointVisibility visibility = light.centre.data[pixel];
  if (visibility == raytrace::PointVisibility::uncertain) return 0.5;
  return visibility == raytrace::PointVisibility::lit ? 1.0 : 0.0;
}

bool is_png(const std::string& path) {
  return lower_extension(path) == ".png";
}

}  // namespace

double choose_exposure(const std::optional<std::optional<double>>& asked, const Scene& scene,
                       const ColorImage& color) {
  const std::optional<double> factor = known_exposure(asked, scene);
  return factor ? *factor : auto_exposure(color);
}

std::optional<double> known_exposure(const std::optional<std::optional<double>>& asked, const Scene& scene) {
  return asked ? *asked : scene.exposure;
}

std::vector<Channel> exr_channels(const World& world, const raster::RasterFrame& frame) {
  Channels channels(frame.color.size);
  channels.add_color(frame.color);
  channels.add_ids(world, [&](std::size_t i) { return frame.primitive.data[i]; });
  for (const raster::LightRecord& record : frame.lights) {
    add_record(channels, record, light_prefix(world, record.light, frame.lights.size()));
  }
  return channels.take();
}

std::vector<Channel> exr_channels(const World& world, const raytrace::RayTracedFrame& frame) {
  const View view = make_view(world.scene->camera, frame.color.size);
  const auto& points = frame.receiver.data;
  const auto seen = [&](std::size_t i) { return points[i].primitive != no_id; };
  Channels channels(frame.color.size);
  channels.add_color(frame.color);
  channels.add("Z", [&](std::size_t i) {
    return seen(i) ? glm::dot(points[i].position - view.eye, view.forward) : infinity;
  });
  channels.add_vector("position", [&](std::size_t i) { return seen(i) ? points[i].position : Vec3(0.0); });
  channels.add_vector("normal", [&](std::size_t i) { return seen(i) ? points[i].normal : Vec3(0.0); });
  channels.add_ids(world, [&](std::size_t i) { return points[i].primitive; });
  for (const raytrace::LightTruth& light : frame.lights) {
    channels.add(light_prefix(world, light.light, frame.lights.size()) + "truth.V",
                 [&](std::size_t i) { return truth_value(light, i); });
  }
  return channels.take();
}

Expected<void> write_picture(const std::string& path, const World& world, const raster::RasterFrame& frame,
                             double exposure) {
  if (is_png(path)) return write_png(path, display_image(frame.color, exposure));
  return write_exr(path, frame.color.size, exr_channels(world, frame));
}

Expected<void> write_picture(const std::string& path, const World& world,
                             const raytrace::RayTracedFrame& frame, double exposure) {
  if (is_png(path)) return write_png(path, display_image(frame.color, exposure));
  return write_exr(path, frame.color.size, exr_channels(world, frame));
}

}  // namespace gnomon::app

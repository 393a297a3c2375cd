// The EXR file of per-pixel numbers (docs/manual/aov.md). Where the pixel shows no surface every channel is
// 0 except R,G,B (the background), the ladder (1: lit) and class.V, cause.V, object.V and primitive.V (-1). gap.V is
// not finite where the receiver's texel holds nothing or its bias has no bound (LightRecord::gap). Ids are exact up to
// 2^24, as far as 32-bit floats count.
#include <fmt/core.h>

#include <array>

#include "compare/ladder/labels.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"

namespace gnomon::compare {
namespace {

// Collects channels of one size; `value` maps a pixel's index to its number.
class AovChannels {
 public:
  explicit AovChannels(std::size_t pixels) : pixels_(pixels) {}

  template <class Value>
  void add(std::string name, const Value& value) {
    Channel channel{std::move(name), std::vector<float>(pixels_)};
    for (std::size_t i = 0; i < pixels_; ++i) channel.values[i] = static_cast<float>(value(i));
    list_.push_back(std::move(channel));
  }
  std::vector<Channel> take() { return std::move(list_); }

 private:
  std::size_t pixels_;
  std::vector<Channel> list_;
};

double id_value(std::uint32_t id) {
  return id == no_id ? -1.0 : static_cast<double>(id);
}

void add_receiver(AovChannels& channels, const AovRows& c) {
  const auto& points = c.raytraced.receiver.data;
  const auto seen = [&points](std::size_t i) { return points[i].primitive != no_id; };
  constexpr std::array<const char*, 3> axes{"X", "Y", "Z"};
  for (int k = 0; k < 3; ++k)
    channels.add(fmt::format("position.{}", axes[static_cast<std::size_t>(k)]),
                 [&](std::size_t i) { return seen(i) ? points[i].position[k] : 0.0; });
  for (int k = 0; k < 3; ++k)
    channels.add(fmt::format("normal.{}", axes[static_cast<std::size_t>(k)]),
                 [&](std::size_t i) { return seen(i) ? points[i].normal[k] : 0.0; });
}

void add_ids(AovChannels& channels, const AovRows& c) {
  const auto& points = c.raytraced.receiver.data;
  channels.add("object.V", [&](std::size_t i) {
    return points[i].primitive == no_id ? -1.0 : id_value(c.world.object_of(points[i].primitive));
  });
  channels.add("primitive.V", [&](std::size_t i) { return id_value(points[i].primitive); });
}

void add_ladder(AovChannels& channels, const AovRows& light) {
  const Ladder ladder = ladder_of(light.raster.options.map.technique);
  for (std::size_t k = 0; k < rung_count; ++k)
    channels.add(fmt::format("{}.V", rung_text(static_cast<Rung>(k), ladder).name),
                 [&](std::size_t i) { return light.rungs[k].data[i]; });
  const auto label = [&](std::size_t i) { return static_cast<double>(light.labels.data[i]); };
  channels.add("class.V", [&](std::size_t i) {
    return has_cause(light.labels.data[i]) && !is_wrong(rungs_at(light.rungs, i)) ? 0.0 : label(i);
  });
  channels.add("cause.V", label);
}

void add_lookup(AovChannels& channels, const AovRows& c) {
  const raster::LightRecord& record = c.record;
  const auto drawn = [&c](std::size_t i) { return c.raster.primitive.data[i] != no_id; };
  channels.add("texel_uv.U", [&](std::size_t i) { return drawn(i) ? record.texel_uv.data[i].x : 0.0f; });
  channels.add("texel_uv.V", [&](std::size_t i) { return drawn(i) ? record.texel_uv.data[i].y : 0.0f; });
  channels.add("gap.V", [&](std::size_t i) { return drawn(i) ? record.gap.data[i] : 0.0f; });
  // Who decided: 0 surely shadowed, 1 surely lit, 2 traced, 3 not asked.
  if (record.external && !record.external->decision.data.empty())
    channels.add("decision.V", [&](std::size_t i) { return record.external->decision.data[i]; });
}

void add_picture(AovChannels& channels, const AovRows& c) {
  const auto& colour = c.raytraced.color.data;
  channels.add("R", [&](std::size_t i) { return colour[i].r; });
  channels.add("G", [&](std::size_t i) { return colour[i].g; });
  channels.add("B", [&](std::size_t i) { return colour[i].b; });
}

}  // namespace

std::vector<Channel> aov_channels(const AovRows& rows) {
  AovChannels channels(rows.labels.data.size());
  add_receiver(channels, rows);
  add_ladder(channels, rows);
  add_ids(channels, rows);
  add_lookup(channels, rows);
  add_picture(channels, rows);
  return channels.take();
}

AovAttributes aov_attributes(const Comparison& c, const LightComparison& light) {
  std::string classes;
  for (std::size_t k = 0; k <= class_count; ++k)
    classes += fmt::format("{}{}={}", k == 0 ? "" : " ", k, label_name(static_cast<Label>(k)));
  return {{{"gnomon_version", std::string(program_version())},
           {"gnomon_command", c.command},
           {"gnomon_scene", c.world->scene->name},
           {"gnomon_light", light_of(c, light).name},
           {"gnomon_classes", classes}}};
}

Expected<void> write_aov(const Comparison& c, std::span<const std::string> places) {
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    const LightComparison& light = c.lights[i];
    const AovRows rows{*c.world, c.raster, drawn_record(c, light), c.raytraced, light.rungs, light.labels};
    const Expected<void> written =
        write_exr(places[i], light.labels.size, aov_channels(rows), aov_attributes(c, light));
    if (!written) return written;
  }
  return {};
}

}  // namespace gnomon::compare

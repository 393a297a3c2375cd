// Gives the labels of casters to pixels whose error the map's format and arithmetic do not explain, and says how many
// have each.
#include "judge/map_content.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "compare/ladder/biased_test.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "judge/identify.h"
#include "judge/map_casters.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using compare::Label;
using compare::LightComparison;

using raytrace::TexelKey;

constexpr std::size_t few_of_a_kind = 10;  ///< of which nothing is said in a note

/// What the ladder charges to precision, and of a culled map what the bias step takes for a leak.
bool may_be_content(const LightComparison& light, std::size_t i, bool culled) {
  const Label label = light.labels.data[i];
  if (label == Label::stored_depth) return true;
  const bool missed = light.rungs[6].data[i] > light.rungs[0].data[i];
  return culled && missed && (label == Label::light_leak || label == Label::peter_panning);
}

class Findings {
 public:
  Findings(const MapCasters& content, const LightComparison& light) : content_(content), light_(light) {}

  void add(std::size_t pixel, Label label, const CasterTexel& t) {
    Kind& kind = kinds_[label];
    ++kind.finding.pixels;
    kind.finding.wrong += compare::is_wrong(compare::rungs_at(light_.rungs, pixel)) ? 1 : 0;
    const bool of_scene =
        t.has_first() && label != Label::ignored_alpha && (t.empty || t.depth > t.first().depth);
    if (of_scene) ++kind.objects[content_.object_name(t.first().primitive)];
    if (label == Label::caster_bias) kind.moved.push_back(content_.moved_by(t));
    if (label != Label::clipped_caster) return;
    const double depth = t.first().depth;
    auto &low = kind.finding.nearest, &high = kind.finding.farthest;
    low = std::min(low.value_or(depth), depth), high = std::max(high.value_or(depth), depth);
  }

  std::vector<ContentFinding> take() {
    std::vector<ContentFinding> out;
    for (auto& [label, kind] : kinds_) {
      kind.finding.label = label;
      std::size_t most = 0;
      for (const auto& [name, count] : kind.objects)
        if (count > most) most = count, kind.finding.object = name;
      std::sort(kind.moved.begin(), kind.moved.end());
      if (!kind.moved.empty()) kind.finding.bias_world = kind.moved[kind.moved.size() / 2];
      out.push_back(std::move(kind.finding));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.pixels > b.pixels; });
    return out;
  }

 private:
  struct Kind {
    ContentFinding finding;
    std::map<std::string, std::size_t> objects;
    std::vector<double> moved;
  };
  const MapCasters& content_;
  const LightComparison& light_;
  std::map<Label, Kind> kinds_;
};

std::string object_words(const ContentFinding& found) {
  return found.object.empty() ? "" : fmt::format(", mostly of '{}'", found.object);
}

std::string reason_words(const ContentFinding& found, const raster::LightRecord& record) {
  const LightFace& face = record.map.view.face(0);
  switch (found.label) {
    case Label::caster_bias:
      return fmt::format(
          "a bias of the casters: the map holds surfaces some {} behind where they are (a polygon offset, or "
          "casters moved when the map is drawn)",
          compare::with_noun(fmt::format("{:.3g}", found.bias_world), "world unit"));
    case Label::missing_caster:
      return "a caster that is missing from the map";
    case Label::moved_caster:
      return "a caster that stands elsewhere in the map, or in it alone: it was drawn before something moved";
    case Label::clipped_caster:
      return found.nearest && *found.nearest < face.near_depth
                 ? fmt::format(
                       "a caster before the map's near plane: it reaches to {} before it, and a near plane "
                       "there, or depths "
                       "clamped to it, would hold it",
                       compare::with_noun(compare::plain_number_up(face.near_depth - *found.nearest),
                                          "world unit"))
                 : fmt::format(
                       "a caster behind the map's far plane, by {}",
                       compare::with_noun(
                           compare::plain_number_up(found.farthest.value_or(face.far_depth) - face.far_depth),
                           "world unit"));
    case Label::culled_caster:
      return "a caster of which the side that faces the light was culled";
    case Label::ignored_alpha:
      return "a caster drawn whole where its alpha mask has holes: the map's pass does not test alpha";
    default:
      return {};
  }
}

}  // namespace

std::optional<TexelKey> lookup_of(const FrameInput& in, const raster::RasterFrame& drawn, std::size_t pixel) {
  const raster::LightRecord& record = drawn.lights.front();
  const Light& light = in.world.scene->lights[record.light];
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const auto lookup = compare::biased_lookup(record, drawn.options.map.bias,
                                             light_at(light, receiver.position).to_light, receiver, pixel);
  if (!lookup) return std::nullopt;
  return lookup->key;
}

bool MapContent::is_main_cause(const LightComparison& light) const {
  std::size_t wrong = 0;
  for (const ContentFinding& one : found) wrong += one.label == Label::caster_bias ? 0 : one.wrong;
  const std::uint64_t outside = light.classes[static_cast<std::size_t>(Label::outside_map) - 1];
  return wrong > 0 && 2 * wrong >= light.error.wrong - outside;
}

MapContent label_map_content(const FrameInput& in, const raster::RasterFrame& drawn, LightComparison& light,
                             bool is_as_described) {
  const TimedStage stage("map's content");
  const bool culled = drawn.options.map.cull != raster::Cull::none;
  std::vector<std::pair<std::uint32_t, TexelKey>> asked;
  for (const std::uint32_t i : compare::pixels_where(light.labels.data.size(), [&](std::size_t i) {
         return compare::has_cause(light.labels.data[i]) && may_be_content(light, i, culled);
       }))
    if (const auto key = lookup_of(in, drawn, i)) asked.emplace_back(i, *key);
  if (asked.empty()) return {};
  MapCasters content(in, drawn);
  std::vector<TexelKey> keys;
  for (const auto& [pixel, key] : asked) keys.push_back(key);
  content.look_at(std::move(keys));
  content.judge_objects();
  Findings findings(content, light);
  for (const auto& [pixel, key] : asked) {
    const bool dark = light.rungs[6].data[pixel] < light.rungs[0].data[pixel];
    const auto label = content.label_of(key, dark);
    if (!label || (*label == Label::aliasing && light.labels.data[pixel] != Label::stored_depth)) continue;
    if (is_as_described && *label != Label::aliasing) findings.add(pixel, *label, content.texel(key));
    light.labels.data[pixel] = is_as_described ? *label : Label::unexplained;
    light.detachment_map.data[pixel] = std::numeric_limits<float>::quiet_NaN();
  }
  count_labels_again(light);
  return {findings.take()};
}

std::vector<std::string> map_content_notes(const MapContent& content, const raster::LightRecord& record) {
  std::vector<std::string> out;
  for (const ContentFinding& found : content.found)
    if (found.pixels >= few_of_a_kind)
      out.push_back(
          fmt::format("in {} pixels with an error{} the map does not hold what the light meets first: {}",
                      compare::grouped(found.pixels), object_words(found), reason_words(found, record)));
  return out;
}

}  // namespace gnomon::judge

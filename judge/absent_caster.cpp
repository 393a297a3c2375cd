#include "judge/absent_caster.h"

#include <fmt/core.h>

#include <map>

#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "judge/map_casters.h"
#include "judge/map_content.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

constexpr std::size_t most_looked_at = 4096;  ///< that are looked at, in even steps
constexpr std::size_t few_shadowed = 16;      ///< in shadow, which tell nothing
constexpr double most_of_it = 0.5;

/// The texels that pixels in the truth's shadow look up.
std::vector<raytrace::TexelKey> shadowed_texels(const FrameInput& in, const raster::RasterFrame& drawn,
                                                const compare::LightComparison& light) {
  const auto shadowed = compare::pixels_where(light.labels.data.size(), [&](std::size_t i) {
    return compare::is_compared(light.labels.data[i]) && light.rungs[0].data[i] < 0.5f;
  });
  std::vector<raytrace::TexelKey> keys;
  const std::size_t step = 1 + shadowed.size() / most_looked_at;
  for (std::size_t i = 0; i < shadowed.size(); i += step)
    if (const auto key = lookup_of(in, drawn, shadowed[i])) keys.push_back(*key);
  return keys;
}

}  // namespace

std::optional<AbsentCaster> find_absent_caster(const FrameInput& in, const raster::RasterFrame& drawn,
                                               const compare::LightComparison& light) {
  const TimedStage stage("absent caster");
  const std::vector<raytrace::TexelKey> keys = shadowed_texels(in, drawn, light);
  if (keys.size() < few_shadowed) return std::nullopt;
  MapCasters casters(in, drawn);
  casters.look_at(keys);
  casters.judge_objects();
  std::map<std::uint32_t, std::pair<std::size_t, std::uint32_t>>
      met;  // object: pixels, one of its primitives
  for (const raytrace::TexelKey key : keys)
    if (const CasterTexel& t = casters.texel(key); t.has_first()) {
      auto& [pixels, primitive] = met[casters.object(t.first())];
      ++pixels, primitive = t.first().primitive;
    }
  for (const auto& [object, of_it] : met) {
    const double share = double(of_it.first) / double(keys.size());
    if (share > most_of_it && !casters.holds_some_of(object))
      return AbsentCaster{casters.object_name(of_it.second), share};
  }
  return std::nullopt;
}

std::string absent_caster_words(const AbsentCaster& absent) {
  return fmt::format(
      "'{}' makes {} of the shadow that rays find, and the map holds nothing of it, so that nothing is "
      "judged. "
      "Is it a sky, a lamp or a helper? Then record the frame without it. Should it cast, it is missing from "
      "the map",
      absent.object, compare::percent(absent.share));
}

}  // namespace gnomon::judge

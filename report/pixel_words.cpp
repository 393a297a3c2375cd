#include "report/pixel_words.h"

#include <fmt/core.h>

#include <embedded/report.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "compare/bias/bias_curve.h"
#include "compare/ladder/labels.h"
#include "compare/ladder/ladder.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

using Places = std::vector<std::pair<std::string_view, std::string>>;

/// A phrase with its places filled in.
std::string say(const char* name, const Places& places = {}) {
  static const auto phrases = nlohmann::json::parse(embedded::report("phrases.json"));
  const std::string phrase = phrases.at(name).get<std::string>();
  std::string text;
  for (std::size_t at = 0; at < phrase.size();) {
    const std::size_t open = std::min(phrase.find('{', at), phrase.size());
    text += phrase.substr(at, open - at);
    if (open == phrase.size()) break;
    const std::size_t close = phrase.find('}', open);
    const std::string place = phrase.substr(open + 1, close - open - 1);
    for (const auto& [key, value] : places)
      if (key == place) text += value;
    at = close + 1;
  }
  return text;
}

std::string number(double value) {
  return fmt::format("{:.3g}", value);
}

std::string named(const ShownMaterial& material, const char* kind) {
  if (material.name.empty()) return say(kind);
  return say("named_material", {{"kind", say(kind)}, {"name", material.name}});
}

struct Story {
  const Comparison& comparison;
  const LightComparison& light;
  const PixelFacts& pixel;
  const raster::LightRecord& record = drawn_record(comparison, light);
  double bias = draws_bias(comparison) ? record.bias_constant_world : 0.0;

  std::string what() const { return std::string(label_text(pixel.label).what); }

  /// What the step changes; of a caster that is not the scene's that is the caster.
  const StepText& change(Cause step) const {
    return step_text(label_text(pixel.label).step == Cause::caster ? Cause::caster : step);
  }

  std::string went_wrong() const {
    if (pixel.label == Label::stored_depth) return say("went_wrong_by_precision", {{"what", what()}});
    const int step = deciding_rung(pixel);
    return say("went_wrong", {{"before", std::to_string(step - 1)},
                              {"step", std::to_string(step)},
                              {"change", std::string(change(static_cast<Cause>(step - 1)).name)},
                              {"what", what()}});
  }
  std::string brightness(double v) const {
    return pixel.material ? say(v > 0.5 ? "light_reaches" : "light_does_not_reach")
                          : say(v > 0.5 ? "lit" : "in_shadow");
  }
  std::string gives(bool dark) const {
    return pixel.material ? say(dark ? "gives_no_light" : "gives_light")
                          : say(dark ? "draws_in_shadow" : "draws_lit");
  }

  /// What the bias is made of besides its constant.
  std::vector<std::string> parts() const {
    const raster::Bias& own = comparison.raster.options.map.bias;
    std::vector<std::string> list;
    if (own.slope != 0.0) list.push_back(say("slope_bias"));
    if (own.normal_offset_texels != 0.0) list.push_back(say("normal_offset"));
    if (own.receiver_plane) list.push_back(say("receiver_plane"));
    if (own.adaptive) list.push_back(say("adaptive_bias"));
    return list;
  }

  std::string map_test() const {
    const int size = record.map.view.size;
    const bool outside = pixel.u < 0.0 || pixel.v < 0.0 || pixel.u >= size || pixel.v >= size;
    if (!std::isfinite(pixel.gap)) return say(outside ? "outside" : "nothing_stored");
    const std::vector<std::string> list = parts();
    std::string joined;
    for (const std::string& part : list) joined += (joined.empty() ? "" : say("and")) + part;
    const bool dark = pixel.gap > static_cast<double>(static_cast<float>(bias));
    const double texel = light.bias_texel_world;
    const Places places{
        {"texel", say("texel", {{"u", std::to_string(static_cast<int>(std::floor(pixel.u)))},
                                {"v", std::to_string(static_cast<int>(std::floor(pixel.v)))}})},
        {"constant", say(list.empty() ? "the_bias" : "the_constant_bias", {{"bias", number(bias)}})},
        {"distance", number(std::abs(pixel.gap))},
        {"texels", texels_text(texel > 0.0 ? pixel.gap / texel : 0.0)},
        {"gives", gives(dark)},
        {"more", say(dark ? "more" : "no_more")},
        {"allowed", say(list.size() == 1 ? "allowed_by_one" : "allowed_by_several", {{"parts", joined}})}};
    if (pixel.gap <= 0.0) return say(list.empty() ? "stores_behind" : "stores_nothing_nearer", places);
    return say(list.empty() ? "stores_nearer" : "stores_nearer_than_allowed", places);
  }

  std::string technique() const { return std::string(drawn_technique(comparison)); }

  /// Techniques that decide exactly: how, and beside it what a hard test of a map of this size would make of it.
  std::string exactly() const {
    constexpr std::array names{"surely_in_shadow", "surely_lit", "not_sure"};
    std::string how = pixel.decision ? "" : say("tests_its_list", {{"technique", technique()}});
    if (pixel.decision && *pixel.decision < names.size()) how = say(names.at(*pixel.decision));
    const Places places{{"drawn", number(pixel.rungs[6])}, {"truth", number(pixel.rungs[0])}};
    return how + " " + say(pixel.rungs[6] == pixel.rungs[0] ? "drawn_as_rays" : "drawn_not_as_rays", places) +
           " " + say("for_comparison", {{"test", map_test()}});
  }

  /// Where more than the one texel decides: the single test (V5) first, then what the technique makes of it (V6).
  std::string filtered() const {
    const bool same = pixel.rungs[6] == pixel.rungs[5];
    return (std::isfinite(pixel.gap) ? map_test() + " " : "") +
           say("single_test", {{"single", number(pixel.rungs[5])}}) + " " +
           say(same ? "changes_nothing" : "reads_more",
               {{"technique", technique()}, {"drawn", number(pixel.rungs[6])}}) +
           " " + say("rays_give", {{"truth", number(pixel.rungs[0])}}) + " " +
           (pixel.label == Label::right ? say("right_within_half") : went_wrong());
  }

  /// Tells the story of a pixel whose picture's map is not known.
  std::string compared_alone() const {
    return say("drawn_not_as_rays", {{"drawn", number(pixel.rungs[6])}, {"truth", number(pixel.rungs[0])}}) +
           " " +
           (pixel.label == Label::right ? say("right_within_half") : say("label_alone", {{"what", what()}}));
  }

  std::string whole() const {
    if (!is_compared(pixel.label)) return say("not_compared", {{"what", what()}});
    if (!comparison.raster.has_known_map()) return compared_alone();
    if (!compares_depths(comparison)) return exactly();
    if (!biases_follow_from_gaps(comparison.raster)) return filtered();
    return map_test() + " " + say("ray_says", {{"brightness", brightness(pixel.rungs[0])}}) + " " +
           (pixel.label == Label::right ? say("right") : went_wrong());
  }
};

}  // namespace

int deciding_rung(const PixelFacts& pixel) {
  if (!has_cause(pixel.label)) return 0;
  const auto rung_of = [](Cause step) { return static_cast<int>(step) + 1; };
  if (pixel.label == Label::stored_depth) return rung_of(Cause::precision);
  std::array<float, rung_count> rungs{};
  for (std::size_t k = 0; k < rung_count; ++k) rungs[k] = static_cast<float>(pixel.rungs[k]);
  if (!is_wrong(rungs) && (pixel.label == Label::blur || pixel.label == Label::light_size))
    return rung_of(*label_text(pixel.label).step);
  return rung_of(deciding_step(rungs));
}

std::string pixel_words(const Comparison& comparison, const LightComparison& light, const PixelFacts& pixel) {
  return Story{comparison, light, pixel}.whole();
}

std::vector<std::string> pixel_remarks(const PixelFacts& pixel) {
  std::vector<std::string> list;
  if (!pixel.seen) return list;
  if (const auto& own = pixel.material)
    list.push_back(own->is_glass() ? say("shown_glass", {{"material", named(*own, "glass")}})
                                   : say("shown_mirror", {{"material", named(*own, "mirror")}}));
  if (const auto& stored = pixel.stored_glass)
    list.push_back(say("stored_glass", {{"material", named(*stored, "glass")}}));
  return list;
}

}  // namespace gnomon::compare

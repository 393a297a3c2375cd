#include "report/pixel_words.h"

#include <fmt/format.h>

#include <embedded/report.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "compare/bias/bias_curve.h"
#include "compare/ladder/labels.h"
#include "compare/ladder/ladder.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"

namespace gnomon::report {
namespace {

using compare::Cause;
using compare::Label;

/// What holds of a pixel and what its phrases' places are filled with; the phrases (phrases.json) follow from these. The
/// first of a phrase's forms whose words all hold is told; a place that has no value is a phrase itself.
class Telling {
 public:
  void holds(std::string_view word, bool does = true) {
    if (does) holding_.insert(word);
  }
  void put(std::string_view place, std::string text) { places_[place] = std::move(text); }

  std::string say(const std::string& name) const {
    static const auto phrases = nlohmann::json::parse(embedded::report("phrases.json"));
    const auto& phrase = phrases.at(name);
    if (phrase.is_string()) return filled(phrase.get<std::string>());
    const auto told = std::find_if(phrase.begin(), phrase.end(), [&](const auto& form) {
      return hold(form[0].template get<std::string>());
    });
    return filled((*told)[1].get<std::string>());
  }

 private:
  bool hold(const std::string& words) const {
    std::istringstream list(words);
    return std::all_of(std::istream_iterator<std::string>(list), {},
                       [&](const std::string& word) { return holding_.contains(word); });
  }

  std::string filled(const std::string& phrase) const {
    std::string text;
    for (std::size_t at = 0; at < phrase.size();) {
      const std::size_t open = std::min(phrase.find('{', at), phrase.size());
      text += phrase.substr(at, open - at);
      if (open == phrase.size()) break;
      const std::size_t close = phrase.find('}', open);
      const std::string place = phrase.substr(open + 1, close - open - 1);
      const auto value = places_.find(place);
      text += value == places_.end() ? say(place) : value->second;
      at = close + 1;
    }
    return text;
  }

  std::set<std::string_view> holding_;
  std::map<std::string_view, std::string> places_;
};

std::string three_digits(double value) {
  return fmt::format("{:.3g}", value);
}

void add_material(Telling& telling, const compare::ShownMaterial& material, bool is_glass) {
  telling.holds("glass", is_glass);
  telling.holds("named", !material.name.empty());
  telling.put("name", material.name);
}

/// What the bias is made of besides its constant.
std::string add_parts(Telling& telling, const raster::Bias& own) {
  std::vector<std::string> parts;
  if (own.slope != 0.0) parts.push_back(telling.say("slope_bias"));
  if (own.normal_offset_texels != 0.0) parts.push_back(telling.say("normal_offset"));
  if (own.receiver_plane) parts.push_back(telling.say("receiver_plane"));
  if (own.adaptive) parts.push_back(telling.say("adaptive_bias"));
  telling.holds("with_parts", !parts.empty());
  telling.holds("several_parts", parts.size() > 1);
  return fmt::format("{}", fmt::join(parts, telling.say("and")));
}

void add_map_test(Telling& telling, const compare::Comparison& c, const compare::LightComparison& light,
                  const PixelFacts& pixel) {
  const raster::LightRecord& record = compare::drawn_record(c, light);
  const int size = record.map.view.size;
  const double bias = compare::draws_bias(c) ? record.bias_constant_world : 0.0,
               texel = light.bias_texel_world;
  telling.holds("outside", pixel.u < 0.0 || pixel.v < 0.0 || pixel.u >= size || pixel.v >= size);
  telling.holds("empty", !std::isfinite(pixel.gap));
  if (!std::isfinite(pixel.gap)) return;
  telling.holds("behind", pixel.gap <= 0.0);
  telling.holds("dark", pixel.gap > static_cast<double>(static_cast<float>(bias)));
  telling.put("parts", add_parts(telling, c.raster.options.map.bias));
  telling.put("u", std::to_string(static_cast<int>(std::floor(pixel.u))));
  telling.put("v", std::to_string(static_cast<int>(std::floor(pixel.v))));
  telling.put("bias", three_digits(bias));
  telling.put("distance", three_digits(std::abs(pixel.gap)));
  telling.put("texels", compare::texels_text(texel > 0.0 ? pixel.gap / texel : 0.0));
}

/// Tells which step made it wrong; of a caster that is not the scene's that is the caster.
void add_step(Telling& telling, const PixelFacts& pixel) {
  const compare::LabelText& label = compare::label_text(pixel.label);
  telling.put("what", std::string(label.what));
  telling.holds("by_precision", pixel.label == Label::stored_depth);
  const int step = deciding_rung(pixel);
  if (step == 0) return;
  const Cause cause = label.step == Cause::caster ? Cause::caster : static_cast<Cause>(step - 1);
  telling.put("before", std::to_string(step - 1));
  telling.put("step", std::to_string(step));
  telling.put("change", std::string(compare::step_text(cause, pixel.ladder).name));
}

/// Tells how a technique that decides exactly did it.
void add_decision(Telling& telling, const PixelFacts& pixel) {
  constexpr std::array names{"surely_in_shadow", "surely_lit", "not_sure"};
  telling.holds("by_columns", pixel.decision.has_value());
  if (pixel.decision && *pixel.decision < names.size()) telling.holds(names.at(*pixel.decision));
}

}  // namespace

int deciding_rung(const PixelFacts& pixel) {
  if (!compare::has_cause(pixel.label)) return 0;
  const auto rung_of = [](Cause step) { return static_cast<int>(step) + 1; };
  if (pixel.label == Label::stored_depth) return rung_of(Cause::precision);
  std::array<float, compare::rung_count> rungs{};
  for (std::size_t k = 0; k < compare::rung_count; ++k) rungs[k] = static_cast<float>(pixel.rungs[k]);
  if (pixel.ladder == compare::Ladder::map && !compare::is_wrong(rungs) &&
      (pixel.label == Label::blur || pixel.label == Label::light_size))
    return rung_of(*compare::label_text(pixel.label).step);
  return rung_of(compare::deciding_step(rungs));
}

std::string pixel_words(const compare::Comparison& c, const compare::LightComparison& light,
                        const PixelFacts& pixel) {
  const double truth = pixel.rungs[0], single = pixel.rungs[5], drawn = pixel.rungs[6];
  Telling telling;
  telling.holds("not_compared", !compare::is_compared(pixel.label));
  telling.holds("without_map", !c.raster.has_known_map());
  const bool of_rays = pixel.ladder == compare::Ladder::rays,
             sized = compare::true_record(c, light).samples > 0;  // the lab keeps no world
  telling.holds("one_ray", of_rays && !sized), telling.holds("few_rays", of_rays);
  telling.holds("as_cast", c.raster.options.map.rays.denoiser == raster::Denoiser::none);
  telling.holds("exact", !compare::compares_depths(c));
  telling.holds("filtered", !compare::biases_follow_from_gaps(c.raster));
  telling.holds("right", pixel.label == Label::right);
  telling.holds("shows_more", pixel.material.has_value());
  telling.holds("lit", truth > 0.5);
  telling.holds("as_rays", drawn == truth);
  telling.holds("unchanged", drawn == single);
  telling.put("truth", three_digits(truth)), telling.put("single", three_digits(single)),
      telling.put("drawn", three_digits(drawn));
  telling.put("through", three_digits(pixel.rungs[4]));
  telling.put("technique", std::string(compare::drawn_technique(c)));
  add_step(telling, pixel);
  if (compare::is_compared(pixel.label) && c.raster.has_known_map() && pixel.ladder == compare::Ladder::map)
    add_map_test(telling, c, light, pixel);
  add_decision(telling, pixel);
  return telling.say("story");
}

std::vector<std::string> pixel_remarks(const PixelFacts& pixel) {
  std::vector<std::string> list;
  if (!pixel.seen) return list;
  const auto remark = [&](const char* name, const compare::ShownMaterial& material, bool is_glass) {
    Telling telling;
    add_material(telling, material, is_glass);
    list.push_back(telling.say(name));
  };
  if (const auto& own = pixel.material) remark("shown", *own, own->is_glass());
  if (const auto& stored = pixel.stored_glass) remark("stored_glass", *stored, true);
  return list;
}

}  // namespace gnomon::report

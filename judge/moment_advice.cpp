// Advice on filters of moments, in their own settings.
#include <algorithm>
#include <memory>

#include "judge/advisor.h"
#include "judge/moment_maps.h"

namespace gnomon::compare {
namespace {

/// What a technique of moments has of its own: a setting, the values that people give it, and where the test has it.
struct MomentSetting {
  const char* setting;
  const char* unit;
  std::vector<double> values;  ///< ascending
  double& (*of)(raster::CapturedMoments&);
};

std::vector<MomentSetting> settings_of_moments(raster::Technique technique) {
  using raster::CapturedMoments, raster::Technique;
  const MomentSetting reduction{
      "filter.light_bleeding_reduction",
      "share of the light",
      {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8},
      [](CapturedMoments& m) -> double& { return m.filter.light_bleeding_reduction; }};
  const MomentSetting variance{"filter.minimum_variance",
                               "square of stored depth",
                               {0.0, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3},
                               [](CapturedMoments& m) -> double& { return m.minimum_variance; }};
  const MomentSetting bias{"filter.moment_bias",
                           "share of the moments",
                           {3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3},
                           [](CapturedMoments& m) -> double& { return m.filter.moment_bias; }};
  if (technique == Technique::esm) return {};
  return technique == Technique::msm ? std::vector{reduction, bias} : std::vector{reduction, variance};
}

}  // namespace

/// The best value of one setting alone.
void Advisor::try_moment_settings(double& least, std::optional<Candidate>& best) {
  TestedRecord tested = redrawing_.as_drawn();
  raster::CapturedMoments present = test().moments;
  for (const MomentSetting& one : settings_of_moments(present.technique))
    for (const double value : one.values) {
      const double now = one.of(present);
      const auto change = [of = one.of, value](raster::LightRecord& record) {
        of(record.captured->test->moments) = value;
      };
      tested.change(change);
      const double left = search_.left_at(tested, search_.now);
      tested.change([&](raster::LightRecord& record) { one.of(record.captured->test->moments) = now; });
      if (value == now || !(left < worth_changing * least)) continue;
      least = left;
      Advice advice;
      static_cast<AdvisedSetting&>(advice) = {one.setting, now, value, one.unit};
      best = Candidate{advice, change, search_.now};
    }
}

/// Other exponents than the present ones, as far as the map can be made again.
void Advisor::try_exponents(double& least, std::optional<Candidate>& best) {
  constexpr std::size_t most_texels = std::size_t{1} << 21;  // a ray for each
  constexpr double like_drawn = 0.1;
  const raster::CapturedMoments& present = test().moments;
  const std::vector<WarpExponents> tries = exponents_to_try(present);
  if (tries.empty() || record().map.depth.size() > most_texels) return;
  const MomentMaps maps(in_, record());
  if (!maps.are_as_stored()) return;
  TestedRecord tested = redrawing_.as_drawn();
  const auto change_to = [&](const WarpExponents& exponents) {
    raster::CapturedMoments moments = present;
    moments.filter.esm_exponent = moments.filter.evsm_positive_exponent = exponents.positive;
    moments.filter.evsm_negative_exponent = exponents.negative;
    moments.texels = maps.texels(moments);
    return [made = std::make_shared<raster::CapturedMoments>(std::move(moments))](
               raster::LightRecord& record) { record.captured->test->moments = *made; };
  };
  const WarpExponents now{present.technique == raster::Technique::esm ? present.filter.esm_exponent
                                                                      : present.filter.evsm_positive_exponent,
                          present.filter.evsm_negative_exponent};
  const double drawn = search_.left_at(tested, search_.now);
  tested.change(change_to(now));
  if (std::abs(search_.left_at(tested, search_.now) - drawn) > like_drawn * drawn) return;
  for (const WarpExponents& other : tries) {
    if (other.positive == now.positive && other.negative == now.negative) continue;
    const auto change = change_to(other);
    tested.change(change);
    const double left = search_.left_at(tested, search_.now);
    if (!(left < worth_changing * least)) continue;
    least = left;
    const AdvisedSetting first{"filter.exponents[0]", now.positive, other.positive, "no unit"},
        second{"filter.exponents[1]", now.negative, other.negative, "no unit"};
    Advice advice;
    static_cast<AdvisedSetting&>(advice) = other.positive != now.positive ? first : second;
    if (other.positive != now.positive && other.negative != now.negative) advice.with = second;
    best = Candidate{advice, change, search_.now, true};
  }
}

/// One setting of moments, and that with the constant that suits it.
void Advisor::propose_on_moments(double least) {
  std::optional<Candidate> best;
  try_moment_settings(least, best);
  try_exponents(least, best);
  if (!best) return;
  propose(*best);
  if (best->advice.with) return;
  TestedRecord tested = redrawing_.as_drawn();
  tested.change(best->change);
  const GoodConstant there = search_.best_beside(tested);
  if (!(there.left < worth_changing * least)) return;
  best->advice.with = constant(there.stored), best->stored = there.stored;
  propose(std::move(*best));
}

}  // namespace gnomon::compare

// Other values of a moment filter's settings. The averages that other exponents would have stored are made again: what the
// light meets first at each texel is warped with them and averaged as the renderer averages.
#include <algorithm>
#include <cmath>

#include "judge/moments_test.h"
#include "judge/stored_depths.h"
#include "scene/base/parallel.h"

namespace gnomon::judge {
namespace {

using raster::Technique;

/// Exponents that people set: of the positive warp, and of the negative one (0: none).
struct WarpExponents {
  double positive = 0.0, negative = 0.0;
};

/// What a channel of a technique with exponents holds of a number.
double channel_of(const MomentFormula& formula, std::size_t channel, double x) {
  if (formula.technique == Technique::esm) return std::exp(formula.filter.esm_exponent * x);
  const double sign = channel < 2 ? 1.0 : -1.0;
  const double exponent =
      channel < 2 ? formula.filter.evsm_positive_exponent : formula.filter.evsm_negative_exponent;
  const double warped = sign * std::exp(sign * exponent * (2.0 * x - 1.0));
  return channel % 2 == 0 ? warped : warped * warped;
}

std::size_t warped_channels(const MomentFormula& formula) {
  if (formula.technique == Technique::esm) return 1;
  return formula.filter.evsm_negative_exponent > 0.0 ? 4 : 2;
}

class MomentMaps {
 public:
  /// Traces a ray for each texel.
  MomentMaps(const FrameInput& input, const raster::LightRecord& record);

  /// Tells whether the averages so made are those that are stored, but for a tenth of what averaging changes.
  bool are_as_stored() const { return as_stored_; }
  /// Returns the texels with the exponents of a formula of the record's technique.
  std::vector<MomentsTest::Texel> texels(const MomentFormula& formula) const;

 private:
  std::vector<double> averaged(const std::vector<double>& values, int reach) const;
  void fit_reach(const MomentsTest& test);

  int size_ = 0;                 ///< of a face, texels on a side
  std::vector<double> numbers_;  ///< by texel, as they are stored; 1 where nothing is met
  int reach_ = 0;                ///< texels to each side that are averaged
  bool as_stored_ = false;
};

MomentMaps::MomentMaps(const FrameInput& in, const raster::LightRecord& record)
    : size_(record.map.view.size) {
  const StoredDepths depths(in, record);
  const CapturedTest& test = captured_test(record);
  const auto n = static_cast<std::size_t>(size_);
  numbers_.assign(record.map.depth.size(), 1.0);
  parallel_for(numbers_.size() / n, [&](std::size_t line) {
    const int face = static_cast<int>(line / n), row = static_cast<int>(line % n);
    for (int column = 0; column < size_; ++column) {
      const auto key = TexelKey::pack(face, column, row);
      if (const auto met = depths.first(key))
        numbers_[record.map.texel_index(face, column, row)] =
            std::clamp(test.number_of(record.map.view, key, met->depth), 0.0, 1.0);
    }
  });
  fit_reach(static_cast<const MomentsTest&>(test));
}

/// The mean over a square, row by row and then column by column; of texels beyond the border the nearest.
std::vector<double> MomentMaps::averaged(const std::vector<double>& values, int reach) const {
  const auto n = static_cast<std::size_t>(size_);
  std::vector<double> across(values.size()), out(values.size());
  const auto pass = [&](const std::vector<double>& from, std::vector<double>& to, bool rows) {
    parallel_for(values.size() / n, [&](std::size_t line) {
      const std::size_t face = line / n, fixed = line % n;
      const auto index = [&](int k) {
        const auto along = static_cast<std::size_t>(std::clamp(k, 0, size_ - 1));
        return face * n * n + (rows ? fixed * n + along : along * n + fixed);
      };
      for (int i = 0; i < size_; ++i) {
        double sum = 0.0;
        for (int k = i - reach; k <= i + reach; ++k) sum += from[index(k)];
        to[index(i)] = sum / (2 * reach + 1);
      }
    });
  };
  pass(values, across, true), pass(across, out, false);
  return out;
}

void MomentMaps::fit_reach(const MomentsTest& test) {
  constexpr double alike = 0.1;
  const MomentFormula& formula = test.formula;
  std::vector<double> warped(numbers_.size());
  for (std::size_t i = 0; i < warped.size(); ++i) warped[i] = channel_of(formula, 0, numbers_[i]);
  const auto off = [&](const std::vector<double>& averages) {
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i)
      sum += std::abs(formula.mean({averages[i], 0.0, 0.0, 0.0}) -
                      formula.mean({double{test.texels[i][0]}, 0.0, 0.0, 0.0}));
    return sum;
  };
  const double unaveraged = off(warped);
  double least = infinity;
  const int most = static_cast<int>(std::ceil(0.5 / std::sqrt(formula.own_share) + 1.0));
  for (int reach = 0; reach <= most; ++reach)
    if (const double now = off(averaged(warped, reach)); now < least) least = now, reach_ = reach;
  as_stored_ = reach_ > 0 && least <= alike * unaveraged;
}

std::vector<MomentsTest::Texel> MomentMaps::texels(const MomentFormula& formula) const {
  std::vector<MomentsTest::Texel> out(numbers_.size(), MomentsTest::Texel{});
  std::vector<double> warped(numbers_.size());
  for (std::size_t channel = 0; channel < warped_channels(formula); ++channel) {
    for (std::size_t i = 0; i < warped.size(); ++i) warped[i] = channel_of(formula, channel, numbers_[i]);
    const std::vector<double> averages = averaged(warped, reach_);
    for (std::size_t i = 0; i < out.size(); ++i) out[i][channel] = static_cast<float>(averages[i]);
  }
  return out;
}

std::vector<WarpExponents> exponents_to_try(const MomentFormula& formula) {
  const raster::FilterOptions& now = formula.filter;
  std::vector<WarpExponents> out;
  if (formula.technique == Technique::esm)
    for (const double exponent : {20.0, 40.0, 60.0, 80.0}) out.push_back({exponent, 0.0});
  if (formula.technique == Technique::evsm) {
    // The square of the warp has to be a float.
    for (const double positive : {now.evsm_positive_exponent, 10.0, 20.0, 40.0})
      for (const double negative : {0.0, 5.0, 10.0})
        if (negative > 0.0 || now.evsm_negative_exponent == 0.0) out.push_back({positive, negative});
  }
  return out;
}

/// A setting of a formula, and the values that people give it, ascending.
struct MomentSetting {
  const char* setting;
  const char* unit;
  std::vector<double> values;
  double& (*of)(MomentFormula&);
};

std::vector<MomentSetting> settings_of(Technique technique) {
  const MomentSetting reduction{
      "filter.light_bleeding_reduction",
      "share of the light",
      {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8},
      [](MomentFormula& m) -> double& { return m.filter.light_bleeding_reduction; }};
  const MomentSetting variance{"filter.minimum_variance",
                               "square of stored depth",
                               {0.0, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3},
                               [](MomentFormula& m) -> double& { return m.minimum_variance; }};
  const MomentSetting bias{"filter.moment_bias",
                           "share of the moments",
                           {3e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3},
                           [](MomentFormula& m) -> double& { return m.filter.moment_bias; }};
  if (technique == Technique::esm) return {};
  return technique == Technique::msm ? std::vector{reduction, bias} : std::vector{reduction, variance};
}

/// Each setting alone with each of its values.
OtherSettings other_numbers(MomentFormula present) {
  OtherSettings out;
  for (const MomentSetting& one : settings_of(present.technique))
    for (const double value : one.values) {
      const double now = one.of(present);
      if (value == now) continue;
      out.settings.push_back(
          {{one.setting, now, value, one.unit}, {}, [of = one.of, value](raster::LightRecord& record) {
             of(changed_test<MomentsTest>(record).formula) = value;
           }});
    }
  return out;
}

RecordChange with_exponents(std::shared_ptr<const MomentMaps> maps, const WarpExponents& exponents) {
  return [maps = std::move(maps), exponents](raster::LightRecord& record) {
    auto& test = changed_test<MomentsTest>(record);
    raster::FilterOptions& filter = test.formula.filter;
    filter.esm_exponent = filter.evsm_positive_exponent = exponents.positive;
    filter.evsm_negative_exponent = exponents.negative;
    test.texels = maps->texels(test.formula);
  };
}

/// Other exponents than the present ones, as far as the map can be made again.
OtherSettings other_exponents(const FrameInput& in, const raster::LightRecord& record,
                              const MomentFormula& formula) {
  constexpr std::size_t most_texels = std::size_t{1} << 21;  // a ray for each
  const std::vector<WarpExponents> tries = exponents_to_try(formula);
  if (tries.empty() || record.map.depth.size() > most_texels) return {};
  const auto maps = std::make_shared<const MomentMaps>(in, record);
  if (!maps->are_as_stored()) return {};
  const bool esm = formula.technique == Technique::esm;
  const WarpExponents now{esm ? formula.filter.esm_exponent : formula.filter.evsm_positive_exponent,
                          formula.filter.evsm_negative_exponent};
  OtherSettings out{with_exponents(maps, now)};
  for (const WarpExponents& other : tries) {
    const compare::AdvisedSetting first{"filter.exponents[0]", now.positive, other.positive, "no unit"},
        second{"filter.exponents[1]", now.negative, other.negative, "no unit"};
    const bool is_first = other.positive != now.positive, is_second = other.negative != now.negative;
    if (!is_first && !is_second) continue;
    out.settings.push_back({is_first ? first : second, {}, with_exponents(maps, other), true});
    if (is_first && is_second) out.settings.back().with = second;
  }
  return out;
}

}  // namespace

std::vector<OtherSettings> MomentsTest::other_settings(const FrameInput& in,
                                                       const raster::LightRecord& record) const {
  return {other_numbers(formula), other_exponents(in, record, formula)};
}

}  // namespace gnomon::judge

#include "compare/ladder/budget.h"

#include "compare/ladder/labelling.h"
#include "compare/ladder/labels.h"
#include "compare/result/output_parts.h"
#include "compare/result/result_parts.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

using Rungs = std::array<Image<float>, rung_count>;
using Labels = std::array<std::uint64_t, 256>;  ///< pixels by label

/// How many pixels have each label.
Labels count_labels(const Image<Label>& labels) {
  constexpr std::size_t block = 1 << 16;
  return parallel_reduce(
      labels.data.size(), block, Labels{},
      [&](std::size_t first, std::size_t last, Labels counts) {
        for (std::size_t i = first; i < last; ++i) ++counts[static_cast<std::uint8_t>(labels.data[i])];
        return counts;
      },
      [](Labels a, const Labels& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
        return a;
      });
}

PixelCounts pixels_of(const Labels& labels) {
  const auto of = [&labels](Label label) { return labels[static_cast<std::uint8_t>(label)]; };
  PixelCounts counts;
  for (const std::uint64_t count : labels) counts.total += count;
  counts.background = of(Label::background);
  counts.facing_away = of(Label::facing_away);
  counts.silhouette = of(Label::silhouette);
  counts.uncertain = of(Label::uncertain);
  counts.compared =
      counts.total - counts.background - counts.facing_away - counts.silhouette - counts.uncertain;
  return counts;
}

bool is_between(float visibility) {
  return visibility > 0.0f && visibility < 1.0f;
}

}  // namespace

// Sums are taken along rows of pixels and then over the rows, 16384 of each at most, and each addition is off by 2^-53
// of `sizes` at most. Together it is 2^-38. Means and the six steps add few roundings more, for which this is twice that.
// A hard test's sum is a whole number of pixels, of 2^28 at most, and never so small unless it is 0.
double beyond_rounding(double sum, double sizes) {
  constexpr double most = 0x1p-37;
  return std::abs(sum) > most * sizes ? sum : 0.0;
}

bool is_accident(const std::array<float, rung_count>& v) {
  return std::abs(v[2] - v[0]) > 0.5f && !(std::abs(v[1] - v[0]) > 0.5f) && !(std::abs(v[6] - v[0]) > 0.5f);
}

double wrong_share(std::uint64_t wrong, std::uint64_t ties, std::uint64_t pixels) {
  return pixels > 0 ? (double(wrong) + 0.5 * double(ties)) / double(pixels) : 0.0;
}

void PixelTerms::add(const std::array<float, rung_count>& v, Label label, double times) {
  const double difference = double{v[6]} - double{v[0]};
  compared_ += times;
  false_shadow_ += difference < -0.5 ? times : 0.0, missed_shadow_ += difference > 0.5 ? times : 0.0;
  ties_ += std::abs(difference) == 0.5 ? times : 0.0;
  fractional_ += is_between(v[6]) || is_between(v[0]) ? times : 0.0;
  absolute_ += times * std::abs(difference), squared_ += times * (difference * difference);
  for (std::size_t k = 0; k < rung_count; ++k) rungs_[k] += times * double{v[k]};
  if (is_accident(v)) accidents_[v[2] > v[0] ? 0 : 1] += times;
  // What a map holds of its casters may show as any step's doing.
  const bool of_casters =
      label == Label::caster_bias || (has_cause(label) && label_text(label).step == Cause::caster);
  const auto moved = of_casters ? static_cast<std::size_t>(deciding_step(v)) : cause_count;
  const auto charged = of_casters ? static_cast<std::size_t>(step_of_label(label, v)) : cause_count;
  for (std::size_t k = 0; k < cause_count; ++k) {
    const double change = double{v[k + 1]} - double{v[k]};
    Step& step = steps_[k == moved ? charged : k];
    step.signed_sum += times * change, step.absolute_sum += times * std::abs(change);
  }
  if (!has_cause(label)) return;
  class_errors_[static_cast<std::size_t>(label) - 1] += times * std::abs(difference);
  if (!is_wrong(v)) return;
  classes_[static_cast<std::size_t>(label) - 1] += times;
  Step& blamed = steps_[static_cast<std::size_t>(step_of_label(label, v))];
  (v[6] < v[0] ? blamed.false_shadow : blamed.missed_shadow) += times;
}

void PixelTerms::add(const PixelTerms& other) {
  compared_ += other.compared_, false_shadow_ += other.false_shadow_, missed_shadow_ += other.missed_shadow_;
  ties_ += other.ties_, fractional_ += other.fractional_;
  absolute_ += other.absolute_, squared_ += other.squared_;
  for (std::size_t k = 0; k < rung_count; ++k) rungs_[k] += other.rungs_[k];
  for (std::size_t k = 0; k < accidents_.size(); ++k) accidents_[k] += other.accidents_[k];
  for (std::size_t k = 0; k < class_count; ++k)
    classes_[k] += other.classes_[k], class_errors_[k] += other.class_errors_[k];
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    Step& step = steps_[k];
    const Step& more = other.steps_[k];
    step.signed_sum += more.signed_sum, step.absolute_sum += more.absolute_sum;
    step.false_shadow += more.false_shadow, step.missed_shadow += more.missed_shadow;
  }
}

ErrorStats PixelTerms::error() const {
  ErrorStats error;
  error.false_shadow = static_cast<std::uint64_t>(false_shadow_);
  error.missed_shadow = static_cast<std::uint64_t>(missed_shadow_);
  error.wrong = error.false_shadow + error.missed_shadow;
  error.ties = static_cast<std::uint64_t>(ties_);
  error.fractional = static_cast<std::uint64_t>(fractional_);
  if (!(compared_ > 0.0)) return error;
  error.wrong_fraction = wrong_share(error.wrong, error.ties, static_cast<std::uint64_t>(compared_));
  error.mean_absolute = absolute_ / compared_;
  error.rms = std::sqrt(squared_ / compared_);
  return error;
}

std::array<std::uint64_t, class_count> PixelTerms::classes() const {
  std::array<std::uint64_t, class_count> classes{};
  for (std::size_t k = 0; k < class_count; ++k) classes[k] = static_cast<std::uint64_t>(classes_[k]);
  return classes;
}

std::array<double, class_count> PixelTerms::class_errors() const {
  std::array<double, class_count> means{};
  for (std::size_t k = 0; k < class_count && compared_ > 0.0; ++k) means[k] = class_errors_[k] / compared_;
  return means;
}

RightByAccident PixelTerms::accidents() const {
  return {static_cast<std::uint64_t>(accidents_[0]), static_cast<std::uint64_t>(accidents_[1])};
}

std::array<double, rung_count> PixelTerms::rung_means() const {
  std::array<double, rung_count> means{};
  for (std::size_t k = 0; k < rung_count && compared_ > 0.0; ++k) means[k] = rungs_[k] / compared_;
  return means;
}

Budget PixelTerms::budget() const {
  Budget budget{};
  for (std::size_t k = 0; k < budget.size() && compared_ > 0.0; ++k) {
    const Step& step = steps_[k];
    budget[k] = {step.signed_sum / compared_, step.absolute_sum / compared_,
                 static_cast<std::uint64_t>(step.false_shadow),
                 static_cast<std::uint64_t>(step.missed_shadow)};
  }
  return budget;
}

void PixelTerms::write_to(LightComparison& light) const {
  light.error = error(), light.budget = budget();
  light.classes = classes(), light.class_errors = class_errors();
  light.accidents = accidents(), light.rung_mean = rung_means();
}

template <class RungsOf>
void PixelSums::add_rows(const Image<Label>& labels, const RungsOf& rungs_of) {
  const Labels counted = count_labels(labels);
  for (std::size_t k = 0; k < counted.size(); ++k) labels_[k] += counted[k];
  std::vector<PixelTerms> rows(static_cast<std::size_t>(labels.size.height));
  const auto width = static_cast<std::size_t>(labels.size.width);
  parallel_for(rows.size(), [&](std::size_t y) {
    PixelTerms sums;
    for (std::size_t i = y * width; i < (y + 1) * width; ++i)
      if (is_compared(labels.data[i])) sums.add(rungs_of(i), labels.data[i]);
    rows[y] = sums;
  });
  for (const PixelTerms& row : rows) terms_.add(row);
}

void PixelSums::add(const Rungs& rungs, const Image<Label>& labels) {
  add_rows(labels, [&](std::size_t i) { return rungs_at(rungs, i); });
}

void PixelSums::add_ends(const Image<float>& truth, const Image<float>& drawn, const Image<Label>& labels) {
  add_rows(labels, [&](std::size_t i) {
    std::array<float, rung_count> v{};
    v.fill(truth.data[i]);
    v.back() = drawn.data[i];
    return v;
  });
}

PixelCounts PixelSums::pixels() const {
  return pixels_of(labels_);
}

PixelCounts count_pixels(const Image<Label>& labels) {
  return pixels_of(count_labels(labels));
}

// The budget of each cascade by itself: its compared pixels alone.

namespace {

Json steps_json(const Budget& budget) {
  Json steps = Json::array();
  for (std::size_t k = 0; k < cause_count; ++k)
    steps.push_back({{"cause", cause_name(static_cast<Cause>(k))},
                     {"signed", number(budget[k].signed_mean)},
                     {"absolute", number(budget[k].absolute_mean)}});
  return steps;
}

}  // namespace

std::vector<CascadeSums> sums_of_cascades(const raster::RasterFrame& drawn,
                                          const raster::LightRecord& record) {
  std::vector<CascadeSums> sums;
  if (!raster::has_cascades(drawn.options.map.technique) || record.foreign) return sums;
  for (int face = 0; face < record.map.view.face_count; ++face) sums.emplace_back(face);
  return sums;
}

std::vector<CascadeFigures> cascade_figures(const std::vector<CascadeSums>& sums) {
  std::vector<CascadeFigures> figures;
  for (const CascadeSums& cascade : sums)
    figures.push_back(
        {cascade.sums.pixels().compared, cascade.sums.terms().error(), cascade.sums.terms().budget()});
  return figures;
}

void CascadeSums::add(const raster::LightRecord& record, const std::array<Image<float>, rung_count>& rungs,
                      const Image<Label>& labels) {
  Image<Label> own = labels;
  for (std::size_t i = 0; i < own.data.size(); ++i)
    if (record.face.data[i] != face) own.data[i] = Label::background;
  sums.add(rungs, own);
}

Json by_cascade_json(const std::vector<CascadeFigures>& cascades) {
  if (cascades.empty()) return nullptr;
  Json out = Json::array();
  for (std::size_t face = 0; face < cascades.size(); ++face) {
    const CascadeFigures& figures = cascades[face];
    out.push_back({{"cascade", face},
                   {"compared", figures.compared},
                   {"wrong", figures.error.wrong},
                   {"mean_absolute", number(figures.error.mean_absolute)},
                   {"budget", steps_json(figures.budget)}});
  }
  return out;
}

}  // namespace gnomon::compare

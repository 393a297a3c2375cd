// The budget of each cascade by itself: its compared pixels alone.
#include "compare/budget.h"
#include "compare/output_parts.h"
#include "compare/result_parts.h"

namespace gnomon::compare {
namespace {

Json steps_json(const std::array<BudgetStep, cause_count>& budget) {
  Json steps = Json::array();
  for (std::size_t k = 0; k < cause_count; ++k)
    steps.push_back({{"cause", cause_name(static_cast<Cause>(k))},
                     {"signed", number(budget[k].signed_mean)},
                     {"absolute", number(budget[k].absolute_mean)}});
  return steps;
}

}  // namespace

Json by_cascade_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const bool cascades = c.raster.options.map.technique == raster::Technique::csm && !c.judged;
  if (!cascades || light.labels.data.empty() || record.face.data.size() != light.labels.data.size())
    return nullptr;
  Json out = Json::array();
  for (int face = 0; face < record.map.view.face_count; ++face) {
    Image<Label> labels = light.labels;
    for (std::size_t i = 0; i < labels.data.size(); ++i)
      if (record.face.data[i] != face) labels.data[i] = Label::background;
    const ErrorStats error = measure_error(light.rungs, labels);
    out.push_back({{"cascade", face},
                   {"compared", count_pixels(labels).compared},
                   {"wrong", error.wrong},
                   {"mean_absolute", number(error.mean_absolute)},
                   {"budget", steps_json(add_up_budget(light.rungs, labels))}});
  }
  return out;
}

}  // namespace gnomon::compare

// The budget of each cascade by itself: its compared pixels alone.
#include "compare/ladder/by_cascade.h"

#include "compare/result/output_parts.h"
#include "compare/result/result_parts.h"

namespace gnomon::compare {
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
  if (drawn.options.map.technique != raster::Technique::csm || record.captured) return sums;
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

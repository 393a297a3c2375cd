#include "compare/measure/ends.h"

#include "compare/measure/sums.h"
#include "compare/result/figures.h"

namespace gnomon::compare {

LightFigures measure_ends(const LadderInput& in, const Figure& measure) {
  LightFigures light;
  const Image<Label> labels = sort_pixels(in);
  const Image<Label> climbed = labels_climbed(in, labels);
  Image<float> truth(labels.size, 1.0f), drawn = truth;
  for (std::size_t i = 0; i < climbed.data.size(); ++i) {
    if (!is_compared(climbed.data[i])) continue;
    truth.data[i] = true_visibility(in, i);
    drawn.data[i] = in.record().visibility.data[i];
  }
  PixelSums sums;
  sums.add_ends(truth, drawn, labels);
  light.pixels = sums.pixels();
  light.pixels.uncertain_by_samples = count_pixels(climbed).compared - light.pixels.compared;
  light.error = sums.terms().error();
  const PictureRows all{0, labels.size.height};
  if (measure.needs == FigureNeeds::perception) {
    Perception perception;
    FinishedMaps maps;
    perception.add({truth, drawn, labels, climbed}, 0, all, all.count, maps);
    perception.write_to(light.error);
  }
  light.edges.rms_texels = std::numeric_limits<double>::quiet_NaN();
  if (measure.needs == FigureNeeds::edges) {
    EdgeSums edges;
    add_edges({in.drawn, in.record(), in.traced.receiver, truth, climbed, in.world()}, all, edges);
    light.edges = edges.stats();
  }
  return light;
}

}  // namespace gnomon::compare

#include "judge/identify.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "compare/ladder/budget.h"
#include "compare/ladder/labelling.h"
#include "compare/metrics/edges.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "judge/turned_sun.h"
#include "scene/base/stages.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::Comparison;
using compare::LightComparison;

using raster::Technique;

constexpr std::array map_sizes{128, 256, 512, 1024, 2048, 4096};
constexpr std::array radii{1.5, 2.5, 3.5};  // texels, of pcf
/// A picture with fewer greys than this share was not filtered.
constexpr double least_greys = 0.002;
/// Is the number of filtered maps, the nearest ones, of which a size's bias is searched.
constexpr std::size_t sizes_refined = 3;
/// A setting with one part more must explain clearly more than one without.
constexpr double simpler = 0.9;
constexpr int bias_steps = 12;
/// Are shares of the error: a model that explains less than the first labels nothing, and below the second labels are
/// guesses.
constexpr double least_explained = 0.5, well_explained = 0.8;
/// A turn of less than this, degrees, is what a bias or a coarse map make of shadows, too.
constexpr double least_turn = 1.0;

std::size_t index_of_size(int map_size) {
  return static_cast<std::size_t>(std::find(map_sizes.begin(), map_sizes.end(), map_size) -
                                  map_sizes.begin());
}

/// A drawing of the model, and what it leaves of the picture.
struct Model {
  raster::MapOptions map;
  double bias_world = 0.0;
  double error = infinity;  ///< mean |model - picture|
};

class Identifier {
 public:
  Identifier(Comparison& judged, raster::Renderer& renderer, const compare::Progress& progress)
      : judged_(judged), renderer_(renderer), progress_(progress) {
    const LightComparison& light = judged.lights.front();
    for (std::size_t i = 0; i < light.labels.data.size(); ++i)
      if (compare::is_compared(light.labels.data[i])) pixels_.push_back(static_cast<std::uint32_t>(i));
  }

  Expected<void> run();
  const Model& best() const { return best_; }
  int renders() const { return renders_; }
  double picture_error() const;
  double model_error(const raster::RasterFrame& frame) const;
  Expected<raster::RasterFrame> draw(const raster::MapOptions& map);

 private:
  const Image<float>& picture() const { return judged_.raster.lights.front().visibility; }
  double greys() const;
  Expected<void> try_by_gaps(raster::MapOptions map);
  Expected<void> search_bias(const raster::MapOptions& map);
  Expected<void> find_filter();
  Expected<Model> nearest_filter(std::size_t size);
  template <class Attempt>
  Expected<void> for_sizes(const Attempt& attempt);
  void keep(const raster::MapOptions& map, double bias, double error, double handicap);
  Expected<double> error_at(raster::MapOptions map, double bias);

  Comparison& judged_;
  raster::Renderer& renderer_;
  const compare::Progress& progress_;
  std::vector<std::uint32_t> pixels_;
  Model best_;
  std::array<double, map_sizes.size()> hard_bias_{}, texel_{};
  int renders_ = 0;
};

double Identifier::picture_error() const {
  const Image<float>& truth = judged_.lights.front().rungs[0];
  double sum = 0.0;
  for (const std::uint32_t i : pixels_) sum += double{std::abs(truth.data[i] - picture().data[i])};
  return pixels_.empty() ? 0.0 : sum / static_cast<double>(pixels_.size());
}

double Identifier::model_error(const raster::RasterFrame& frame) const {
  double sum = 0.0;
  const Image<float>& drawn = frame.lights.front().visibility;
  for (const std::uint32_t i : pixels_) sum += double{std::abs(drawn.data[i] - picture().data[i])};
  return pixels_.empty() ? 0.0 : sum / static_cast<double>(pixels_.size());
}

double Identifier::greys() const {
  const auto count = std::count_if(pixels_.begin(), pixels_.end(), [&](std::uint32_t i) {
    return picture().data[i] > 0.02f && picture().data[i] < 0.98f;
  });
  return pixels_.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(pixels_.size());
}

Expected<raster::RasterFrame> Identifier::draw(const raster::MapOptions& map) {
  if (progress_) progress_("looking for the nearest setting", std::min(0.95, renders_ / 100.0));
  raster::RasterOptions options;
  options.size = judged_.raster.options.size;
  options.map = map, options.runs = 0;
  ++renders_;
  const std::array lights{judged_.lights.front().light};
  return renderer_.render(options, lights);
}

// `handicap` > 1: the part that this setting has more.
void Identifier::keep(const raster::MapOptions& map, double bias, double error, double handicap) {
  if (!(error * handicap < best_.error)) return;
  best_ = {map, bias, error};
  if (map.bias.unit == raster::BiasUnit::world) best_.map.bias.constant = bias;
}

/// A pixel is lit from the bias on that its gap is: the picture's error against every bias is a running sum.
Expected<void> Identifier::try_by_gaps(raster::MapOptions map) {
  // Cascades' texels differ: their biases are usually meant in texels.
  const bool scales = map.technique == Technique::csm;
  map.bias.constant = 0.0, map.bias.unit = scales ? raster::BiasUnit::texel : raster::BiasUnit::world;
  const auto frame = draw(map);
  if (!frame) return fail(frame.error());
  const raster::LightRecord& record = frame->lights.front();
  std::vector<std::pair<float, float>> steps;  // gap; what the error changes by when it is passed
  double sum = 0.0;
  for (const std::uint32_t i : pixels_) {
    const float gap = record.gap.data[i], v = picture().data[i];
    const bool lit = !(gap > 0.0f);
    sum += double{lit ? 1.0f - v : v};
    if (!lit) steps.emplace_back(gap, 1.0f - 2.0f * v);
  }
  std::sort(steps.begin(), steps.end());
  double least = sum, from = 0.0, to = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    sum += double{steps[k].second};
    if (k + 1 < steps.size() && steps[k + 1].first == steps[k].first) continue;
    const double next = k + 1 < steps.size() ? double{steps[k + 1].first} : 2.0 * double{steps[k].first};
    if (sum < least - 1e-6) least = sum, from = double{steps[k].first}, to = next;
  }
  if (to == 0.0) to = steps.empty() ? 0.0 : double{steps.front().first};
  const double bias = 0.5 * (from + to);
  const double error = pixels_.empty() ? 0.0 : least / static_cast<double>(pixels_.size());
  if (map.technique == Technique::hard && map.bias.slope == 0.0) {
    hard_bias_[index_of_size(map.size)] = bias;
    texel_[index_of_size(map.size)] = record.texel_world;
  }
  if (scales) map.bias.constant = bias / record.texel_world;
  keep(map, bias, error, map.bias.slope != 0.0 || map.technique == Technique::csm ? 1.0 / simpler : 1.0);
  return {};
}

Expected<double> Identifier::error_at(raster::MapOptions map, double bias) {
  map.bias.constant = bias, map.bias.unit = raster::BiasUnit::world;
  const auto frame = draw(map);
  if (!frame) return fail(frame.error());
  return model_error(*frame);
}

/// A filter's drawing tells of one bias alone: the bias is searched between a hundredth of a texel and four.
Expected<void> Identifier::search_bias(const raster::MapOptions& map) {
  const double texel = texel_[index_of_size(map.size)];
  double low = std::log(0.01 * texel), high = std::log(4.0 * texel);
  constexpr double golden = 0.6180339887498949;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  auto at_a = error_at(map, std::exp(a)), at_b = error_at(map, std::exp(b));
  for (int k = 2; k < bias_steps; ++k) {
    if (!at_a || !at_b) return fail(at_a ? at_b.error() : at_a.error());
    if (*at_a < *at_b) {
      high = b, b = a, at_b = at_a, a = high - golden * (high - low);
      at_a = error_at(map, std::exp(a));
    } else {
      low = a, a = b, at_a = at_b, b = low + golden * (high - low);
      at_b = error_at(map, std::exp(b));
    }
  }
  if (!at_a || !at_b) return fail(at_a ? at_b.error() : at_a.error());
  keep(map, std::exp(*at_a < *at_b ? a : b), std::min(*at_a, *at_b), 1.0);
  return {};
}

template <class Attempt>
Expected<void> Identifier::for_sizes(const Attempt& attempt) {
  const int limit = std::min(renderer_.info().max_map_size, map_sizes.back());
  for (std::size_t s = 0; s < map_sizes.size(); ++s)
    if (map_sizes[s] <= limit)
      if (const auto done = attempt(s); !done) return done;
  return {};
}

/// Every filter at the bias of hard shadows, without the receiver's plane, as most renderers draw it; and pcf as
/// Gnomon draws it unasked, which needs no bias searched.
Expected<Model> Identifier::nearest_filter(std::size_t size) {
  Model nearest;
  const auto attempt = [&](const raster::MapOptions& map) -> Expected<void> {
    const auto frame = draw(map);
    if (!frame) return fail(frame.error());
    const double error = model_error(*frame);
    if (error < nearest.error) nearest = {map, frame->lights.front().bias_constant_world, error};
    return {};
  };
  for (const Technique technique : {Technique::pcf, Technique::vsm})
    for (const double radius : radii) {
      raster::MapOptions map;
      map.technique = technique, map.size = map_sizes[size];
      map.filter.radius_texels = radius;
      map.bias = raster::default_bias(map);
      if (technique == Technique::pcf)
        if (const auto unasked = attempt(map); !unasked) return fail(unasked.error());
      // Moments have no radius here: other biases are tried in its place.
      const double share = radius == radii[1] ? 0.3 : 1.0;
      const bool of_hard = technique == Technique::pcf || radius == radii.front();
      const double bias = of_hard ? std::max(hard_bias_[size], 0.01 * texel_[size]) : share * texel_[size];
      map.bias = {.constant = bias, .unit = raster::BiasUnit::world};
      map.filter.receiver_plane = false;
      if (const auto flat = attempt(map); !flat) return fail(flat.error());
    }
  return nearest;
}

Expected<void> Identifier::find_filter() {
  best_.error = infinity;
  std::vector<Model> models;
  const auto drawn = for_sizes([&](std::size_t size) -> Expected<void> {
    auto model = nearest_filter(size);
    if (!model) return fail(model.error());
    models.push_back(std::move(*model));
    return {};
  });
  if (!drawn) return drawn;
  std::sort(models.begin(), models.end(), [](const Model& a, const Model& b) { return a.error < b.error; });
  models.resize(std::min(models.size(), sizes_refined));
  for (const Model& model : models) {
    keep(model.map, model.bias_world, model.error, 1.0);
    if (model.map.bias.unit != raster::BiasUnit::world) continue;
    if (const auto searched = search_bias(model.map); !searched) return searched;
  }
  return {};
}

Expected<void> Identifier::run() {
  const Light& light = judged_.world->scene->lights[judged_.lights.front().light];
  const auto by_gaps = [&](Technique technique, double slope) {
    return for_sizes([&](std::size_t s) {
      raster::MapOptions map;
      map.technique = technique, map.size = map_sizes[s];
      map.bias = {.constant = 0.0, .unit = raster::BiasUnit::world, .slope = slope};
      return try_by_gaps(map);
    });
  };
  if (const auto hard = by_gaps(Technique::hard, 0.0); !hard) return hard;
  if (greys() > least_greys && !has_size(light)) return find_filter();
  if (const auto sloped = by_gaps(Technique::hard, 1.0); !sloped) return sloped;
  if (!raster::has_map_for(Technique::csm, light.type)) return {};
  return by_gaps(Technique::csm, 0.0);
}

std::string options_text(const raster::MapOptions& map) {
  raster::MapOptions unasked;  // on a line of its own there is nothing to set back
  unasked.bias = {.constant = 0.0, .unit = raster::BiasUnit::world};
  std::string text = fmt::format("--technique {} --map-size {} {}", technique_name(map.technique), map.size,
                                 raster::bias_arguments(map.bias, unasked));
  if (map.technique == Technique::pcf) text += fmt::format(" --filter-radius {:g}", map.filter.radius_texels);
  if (raster::reads_setting(map, "filter-plane") && !map.filter.receiver_plane) text += " --filter-plane off";
  return text;
}

/// The picture above the model's rungs; what the model draws otherwise is not explained by it.
Expected<void> put_below(Comparison& judged, raster::RasterFrame model, const IdentifyOptions& options) {
  const World& world = *judged.world;
  const raytrace::Tracer tracer(world, options.accel, options.precision);
  const Image<float> drawn_by_model = model.lights.front().visibility;
  model.lights.front().visibility = judged.raster.lights.front().visibility;
  model.primitive = judged.raster.primitive;
  model.color = std::move(judged.raster.color);
  model.context = judged.raster.context;
  judged.raster = std::move(model);
  const std::vector<std::uint32_t> lights{judged.lights.front().light};
  const compare::Plan plan{.tracer = tracer,
                           .picture = judged.raster.primitive.size,
                           .lights = lights,
                           .measure = {.bias_curve_points = options.bias_curve_points}};
  if (const auto measured = compare::measure_frames(judged, plan); !measured) return measured;
  mark_unexplained(drawn_by_model, judged.lights.front());
  return {};
}

/// Names a sun that stands elsewhere where that explains most of the error, and clearly more than the nearest setting
/// does. No setting labels anything then.
bool note_turned_sun(compare::Judged& told, double explained_by_setting, const Comparison& judged,
                     const IdentifyOptions& options) {
  if (explained_by_setting >= well_explained) return false;
  const raytrace::Tracer tracer(*judged.world, options.accel, options.precision);
  const auto sun = find_turned_sun(judged, tracer);
  if (!sun || sun->angle_degrees < least_turn || sun->explained < least_explained ||
      1.0 - sun->explained > simpler * (1.0 - explained_by_setting))
    return false;
  const Vec3& d = sun->direction;
  told.notes.push_back(fmt::format(
      "the sun stands elsewhere: shadows are those of a light along ({:.4g}, {:.4g}, {:.4g}), {:.3g} "
      "degrees from what the capture says, which explains {} of the error; correct the capture's "
      "direction, or look for what clamps or delays it in the renderer",
      d.x, d.y, d.z, sun->angle_degrees, compare::percent(sun->explained)));
  return true;
}

}  // namespace

void mark_unexplained(const Image<float>& drawn_by_model, LightComparison& light) {
  mark_unexplained(compare::pixels_where(light.labels.data.size(),
                                         [&](std::size_t i) {
                                           const float drawn = light.rungs[6].data[i];
                                           const float error = std::abs(drawn - light.rungs[0].data[i]);
                                           return compare::has_cause(light.labels.data[i]) &&
                                                  std::abs(drawn_by_model.data[i] - drawn) >
                                                      (error > 0.5f ? 0.5f : 0.5f * error);
                                         }),
                   light);
}

void mark_unexplained(const std::vector<std::uint32_t>& pixels, LightComparison& light) {
  for (const std::uint32_t i : pixels) {
    light.labels.data[i] = compare::Label::unexplained;
    light.detachment_map.data[i] = std::numeric_limits<float>::quiet_NaN();
  }
  count_labels_again(light);
}

void count_labels_again(LightComparison& light) {
  compare::PixelSums sums;
  sums.add(light.rungs, light.labels);
  light.classes = sums.terms().classes(), light.class_errors = sums.terms().class_errors();
  light.budget = sums.terms().budget();
  light.detachment = compare::measure_detachment(light.detachment_map);
}

Expected<void> identify(Comparison& judged, raster::Renderer& renderer, const IdentifyOptions& options,
                        const compare::Progress& progress) {
  const TimedStage stage("identify");
  Identifier identifier(judged, renderer, progress);
  if (const auto run = identifier.run(); !run) return run;
  const Model& best = identifier.best();
  auto model = identifier.draw(best.map);
  if (!model) return fail(model.error());
  auto told = std::make_shared<compare::Judged>(*judged.judged);
  compare::Identified& found = told->identified.emplace();
  found.technique = technique_name(best.map.technique);
  found.options = options_text(best.map);
  found.map_size = best.map.size;
  found.bias_world = best.bias_world;
  found.bias_texels = best.bias_world / model->lights.front().texel_world;
  found.model_error = identifier.model_error(*model);
  found.picture_error = identifier.picture_error();
  if (found.picture_error > 0.0)
    found.explained = std::clamp(1.0 - found.model_error / found.picture_error, 0.0, 1.0);
  found.renders = identifier.renders();
  if (note_turned_sun(*told, found.explained, judged, options)) {
    told->identified.reset();
    judged.judged = std::move(told);
    return {};
  }
  const auto explained = fmt::format("the nearest setting ({}) explains {} of the error", found.options,
                                     compare::percent(found.explained));
  const bool labels = found.explained >= least_explained;
  if (!labels)
    told->notes.push_back(explained + ": too little to label anything by it");
  else if (found.explained < well_explained)
    told->notes.push_back(explained + ": labels and steps are guesses");
  if (!labels) told->identified.reset();
  judged.judged = std::move(told);
  return labels ? put_below(judged, std::move(*model), options) : Expected<void>{};
}

}  // namespace gnomon::judge

#include "compare/result/views.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/result/figures.h"
#include "compare/result/output_parts.h"
#include "compare/result/places.h"

namespace gnomon::compare {

bool add_view(ViewErrors& errors, std::string name, const Comparison& comparison) {
  const Camera& camera = comparison.world->scene->camera;
  ViewErrors::OfView view{std::move(name),
                          {},
                          std::numeric_limits<double>::quiet_NaN(),
                          camera.eye,
                          glm::normalize(camera.target - camera.eye)};
  for (const LightComparison& light : comparison.lights) {
    if (says_nothing({errors.measure}, {&static_cast<const LightFigures&>(light), 1})) continue;
    const double error = errors.measure->of(light);
    if (error <= view.error) continue;
    view.error = error, view.light = light_of(comparison, light).name;
  }
  errors.views.push_back(std::move(view));
  const double now = errors.views.back().error, most = errors.views[errors.worst].error;
  const bool first = errors.views.size() == 1;
  if (!first && !(now > most) && !(std::isnan(most) && !std::isnan(now))) return false;
  errors.worst = errors.views.size() - 1;
  return true;
}

double mean_error(const ViewErrors& errors) {
  double sum = 0.0, count = 0.0;
  for (const ViewErrors::OfView& view : errors.views)
    if (!std::isnan(view.error)) sum += view.error, count += 1.0;
  return sum / count;
}

std::string views_line(const ViewErrors& errors) {
  if (errors.views.empty()) return {};
  const ViewErrors::OfView& worst = errors.views[errors.worst];
  if (std::isnan(worst.error)) return fmt::format("Nothing is compared in {} views.", errors.views.size());
  const std::string where = places_line(errors.places);
  return fmt::format("Worst of {} views: {}, {} ({} in the mean).{}{}", errors.views.size(), worst.name,
                     figure_text(*errors.measure, worst.error),
                     figure_text(*errors.measure, mean_error(errors)), where.empty() ? "" : " ", where);
}

Json views_json(const ViewErrors& errors) {
  Json each = Json::array();
  for (const ViewErrors::OfView& view : errors.views)
    each.push_back({{"view", view.name},
                    {"light", view.light},
                    {"error", number(view.error)},
                    {"eye", vector3(view.eye)},
                    {"direction", vector3(view.direction)}});
  Json views{{"measure", errors.measure->measure.name},
             {"worst", errors.views[errors.worst].name},
             {"worst_error", number(errors.views[errors.worst].error)},
             {"mean_error", number(mean_error(errors))},
             {"each", std::move(each)}};
  if (!errors.places.cells.empty()) views["places"] = places_json(errors.places);
  return views;
}

}  // namespace gnomon::compare

#include "judge/turned_sun.h"

#include <algorithm>
#include <cmath>

#include "raytrace/tracer.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

constexpr std::size_t pixels_searched = 1200;        // pixels of a direction
constexpr int grid_directions = 1500;                // five degrees apart
constexpr std::size_t starts_kept = 6;               // of them
constexpr double first_step = 4.0, last_step = 0.1;  // degrees
/// A direction that most pixels face away from says nothing of them.
constexpr double least_facing = 0.6;

struct Candidate {
  Vec3 direction;
  double error = infinity;  ///< mean |exact visibility - picture| of the pixels that face the light
};

class SunSearch {
 public:
  SunSearch(const compare::Comparison& judged, const raytrace::Tracer& tracer)
      : judged_(judged), tracer_(tracer) {
    const compare::LightComparison& light = judged.lights.front();
    std::vector<std::size_t> compared;
    for (std::size_t i = 0; i < light.labels.data.size(); ++i)
      if (compare::is_compared(light.labels.data[i])) compared.push_back(i);
    const std::size_t step = std::max<std::size_t>(1, compared.size() / pixels_searched);
    for (std::size_t k = 0; k < compared.size(); k += step) pixels_.push_back(compared[k]);
  }

  /// Infinity where too few pixels face the light.
  double error(const Vec3& direction) const {
    Light light = judged_.world->scene->lights[judged_.lights.front().light];
    light.direction = direction;
    const Image<float>& picture = judged_.raster.lights.front().visibility;
    double sum = 0.0;
    std::size_t facing = 0;
    for (const std::size_t i : pixels_) {
      const raytrace::SurfacePoint& point = judged_.raytraced.receiver.data[i];
      if (glm::dot(point.normal, direction) >= 0.0) continue;
      const double lit = tracer_.occluded(tracer_.shadow_ray(point, light)) ? 0.0 : 1.0;
      sum += std::abs(lit - double(picture.data[i]));
      ++facing;
    }
    return double(facing) < least_facing * double(pixels_.size()) ? infinity : sum / double(facing);
  }

  std::vector<Candidate> measured(std::vector<Vec3> directions) const {
    std::vector<Candidate> out(directions.size());
    parallel_for(out.size(), [&](std::size_t i) { out[i] = {directions[i], error(directions[i])}; });
    return out;
  }

  /// Goes to the best neighbour as long as there is a better one, in ever smaller steps.
  Candidate refine(Candidate best) const {
    for (double step = first_step; step >= last_step;) {
      const Candidate next = best_of(measured(neighbours(best.direction, glm::radians(step))));
      if (next.error < best.error)
        best = next;
      else
        step *= 0.5;
    }
    return best;
  }

  static Candidate best_of(const std::vector<Candidate>& candidates) {
    return *std::min_element(candidates.begin(), candidates.end(),
                             [](const Candidate& a, const Candidate& b) { return a.error < b.error; });
  }

  bool is_empty() const { return pixels_.empty(); }

 private:
  static std::vector<Vec3> neighbours(const Vec3& direction, double radians) {
    const Vec3 beside = std::abs(direction.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    const Vec3 right = glm::normalize(glm::cross(direction, beside)), up = glm::cross(right, direction);
    std::vector<Vec3> out;
    for (int k = 0; k < 8; ++k) {
      const double turn = k * pi / 4.0;
      out.push_back(std::cos(radians) * direction +
                    std::sin(radians) * (std::cos(turn) * right + std::sin(turn) * up));
    }
    return out;
  }

  const compare::Comparison& judged_;
  const raytrace::Tracer& tracer_;
  std::vector<std::size_t> pixels_;
};

/// Evenly over the sphere, along a spiral of the golden angle.
std::vector<Vec3> all_directions() {
  std::vector<Vec3> out;
  const double golden_angle = pi * (3.0 - std::sqrt(5.0));
  for (int k = 0; k < grid_directions; ++k) {
    const double y = 1.0 - (2.0 * k + 1.0) / grid_directions, r = std::sqrt(1.0 - y * y);
    out.emplace_back(r * std::cos(golden_angle * k), y, r * std::sin(golden_angle * k));
  }
  return out;
}

}  // namespace

std::optional<TurnedSun> find_turned_sun(const compare::Comparison& judged, const raytrace::Tracer& tracer) {
  const Light& light = judged.world->scene->lights[judged.lights.front().light];
  if (light.type != LightType::directional) return std::nullopt;
  const SunSearch search(judged, tracer);
  if (search.is_empty()) return std::nullopt;
  const double now = search.error(light.direction);
  if (!(now > 0.0) || !std::isfinite(now)) return std::nullopt;
  std::vector<Candidate> grid = search.measured(all_directions());
  std::partial_sort(grid.begin(), grid.begin() + std::ptrdiff_t(starts_kept), grid.end(),
                    [](const Candidate& a, const Candidate& b) { return a.error < b.error; });
  grid.resize(starts_kept);
  grid.push_back({light.direction, now});
  std::vector<Candidate> ends;
  for (const Candidate& start : grid) ends.push_back(search.refine(start));
  const Candidate best = SunSearch::best_of(ends);
  const double cosine = std::clamp(glm::dot(best.direction, light.direction), -1.0, 1.0);
  return TurnedSun{best.direction, glm::degrees(std::acos(cosine)),
                   std::clamp(1.0 - best.error / now, 0.0, 1.0)};
}

}  // namespace gnomon::judge

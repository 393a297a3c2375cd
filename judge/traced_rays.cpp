#include "judge/traced_rays.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "judge/identify.h"
#include "raytrace/shading/smooth_surface.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::Label;
using compare::LightComparison;

using raytrace::PointVisibility;
using raytrace::SurfacePoint;

/// Fewer pixels name no cause.
constexpr std::size_t few_traced = 10;
/// Self-intersection is rounding's: of the pixels of a patch of it so many have a right one of their surface beside them.
constexpr double least_speckled = 0.5;
/// As the shadow terminator's (compare/ladder/terminator.cpp).
constexpr double facing_rounding = 0x1p-22;
/// A place is rounded where it is worked out and where it is stored, by half a step each along each axis; as much again for
/// the sums in between.
constexpr double roundings_of_a_place = 2.0;
constexpr int most_surfaces = 64;

double spacing_of_32_bits(double coordinate) {
  const float at = std::abs(static_cast<float>(coordinate));
  return double{std::nextafter(at, std::numeric_limits<float>::infinity())} - double{at};
}

/// By how much rounding moves a place along the normal, at most.
double moved_along_normal(const SurfacePoint& point) {
  double moved = 0.0;
  for (int k = 0; k < 3; ++k) moved += std::abs(point.normal[k]) * spacing_of_32_bits(point.position[k]);
  return roundings_of_a_place * moved;
}

class TracedPixels {
 public:
  TracedPixels(const FrameInput& in, LightComparison& light)
      : in_(in), light_(light), shines_(in.world.scene->lights[light.light]) {}

  TracedFinding run() {
    const std::vector<std::uint32_t> wrong =
        compare::pixels_where(light_.labels.data.size(),
                              [&](std::size_t i) { return light_.labels.data[i] == Label::unexplained; });
    found_.wrong = wrong.size();
    find_self_intersection();
    find_skipped_casters();
    if (found_.self_intersection + found_.terminator + found_.too_far > 0) count_labels_again(light_);
    return found_;
  }

 private:
  const SurfacePoint& point(std::size_t i) const { return in_.traced.receiver.data[i]; }
  bool is_too_dark(std::size_t i) const {
    return light_.labels.data[i] == Label::unexplained && light_.rungs[6].data[i] < light_.rungs[0].data[i];
  }
  void give(std::size_t i, Label label, std::size_t first_rung);

  bool is_beyond_terminator(std::size_t i) const {
    if (!in_.world.has_normals()) return false;
    const Vec3 to_light = light_at(shines_, point(i).position).to_light;
    return glm::dot(raytrace::shading_normal(in_.world, point(i)), to_light) < -facing_rounding;
  }
  template <class Visit>
  void beside(std::size_t i, const Visit& visit) const;
  /// A right pixel of the same surface lies beside it.
  bool is_speckle(std::size_t i) const;
  void find_self_intersection();
  std::vector<std::uint32_t> patch_from(std::uint32_t first, std::vector<char>& seen) const;
  void count_offset(const std::vector<std::uint32_t>& pixels);

  double farthest_caster(const SurfacePoint& from) const;
  void find_skipped_casters();

  const FrameInput& in_;
  LightComparison& light_;
  const Light& shines_;
  TracedFinding found_;
};

/// From the rung on it is as drawn, before it as the light's centre sees it.
void TracedPixels::give(std::size_t i, Label label, std::size_t first_rung) {
  light_.labels.data[i] = label;
  for (std::size_t k = 2; k < first_rung; ++k) light_.rungs[k].data[i] = light_.rungs[1].data[i];
}

template <class Visit>
void TracedPixels::beside(std::size_t i, const Visit& visit) const {
  const auto w = static_cast<std::size_t>(light_.labels.size.width);
  const std::size_t x = i % w;
  if (x > 0) visit(i - 1);
  if (x + 1 < w) visit(i + 1);
  if (i >= w) visit(i - w);
  if (i + w < light_.labels.data.size()) visit(i + w);
}

bool TracedPixels::is_speckle(std::size_t i) const {
  bool found = false;
  beside(i, [&](std::size_t j) {
    const bool right = light_.labels.data[j] == Label::right && light_.rungs[0].data[j] > 0.5f;
    found = found || (right && glm::dot(point(j).normal, point(i).normal) > 0.9);
  });
  return found;
}

/// The pixels that are too dark and hang together with this one.
std::vector<std::uint32_t> TracedPixels::patch_from(std::uint32_t first, std::vector<char>& seen) const {
  std::vector<std::uint32_t> patch{first};
  seen[first] = 1;
  for (std::size_t at = 0; at < patch.size(); ++at)
    beside(patch[at], [&](std::size_t j) {
      if (seen[j] != 0 || !is_too_dark(j)) return;
      seen[j] = 1;
      patch.push_back(static_cast<std::uint32_t>(j));
    });
  return patch;
}

void TracedPixels::find_self_intersection() {
  std::vector<char> seen(light_.labels.data.size(), 0);
  std::vector<std::vector<std::uint32_t>> patches;
  std::vector<std::uint32_t> terminator, speckles;
  for (std::uint32_t i = 0; i < seen.size(); ++i)
    if (seen[i] == 0 && is_too_dark(i)) patches.push_back(patch_from(i, seen));
  for (const std::vector<std::uint32_t>& patch : patches) {
    const auto speckled =
        std::count_if(patch.begin(), patch.end(), [&](std::uint32_t i) { return is_speckle(i); });
    const bool is_noise = static_cast<double>(speckled) >= least_speckled * static_cast<double>(patch.size());
    for (const std::uint32_t i : patch)
      if (is_beyond_terminator(i))
        terminator.push_back(i);
      else if (is_noise)
        speckles.push_back(i);
  }
  if (speckles.size() < few_traced) speckles.clear();
  if (terminator.size() < few_traced) terminator.clear();
  found_.self_intersection = speckles.size(), found_.terminator = terminator.size();
  if (!speckles.empty()) count_offset(speckles);
  for (const std::vector<std::uint32_t>* list : {&speckles, &terminator})
    for (const std::uint32_t i : *list) give(i, Label::acne, 3);
}

/// The offset that no speckle's rounding reaches, and what it does elsewhere by Gnomon's own rays.
void TracedPixels::count_offset(const std::vector<std::uint32_t>& pixels) {
  std::vector<double> distances;
  for (const std::uint32_t i : pixels) {
    found_.offset = std::max(found_.offset, moved_along_normal(point(i)));
    for (int k = 0; k < 3; ++k)
      found_.spacing = std::max(found_.spacing, spacing_of_32_bits(point(i).position[k]));
    distances.push_back(glm::length(point(i).position));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  found_.from_origin = *middle;
  found_.left = parallel_reduce(
      light_.labels.data.size(), 1024, std::size_t{0},
      [&](std::size_t first, std::size_t last, std::size_t sum) {
        for (std::size_t i = first; i < last; ++i) {
          if (!compare::is_compared(light_.labels.data[i])) continue;
          SurfacePoint from = point(i);
          from.position += found_.offset * from.normal;
          const PointVisibility moved = in_.tracer.centre_visibility(from, shines_);
          if (moved == PointVisibility::uncertain) continue;
          sum += (moved == PointVisibility::lit) != (light_.rungs[1].data[i] > 0.5f) ? 1 : 0;
        }
        return sum;
      },
      [](std::size_t a, std::size_t b) { return a + b; });
}

/// The last surface on the way to the light, world units from the receiver; 0: none.
double TracedPixels::farthest_caster(const SurfacePoint& from) const {
  Ray ray = in_.tracer.shadow_ray(from, shines_);
  double farthest = 0.0;
  for (int k = 0; k < most_surfaces; ++k) {
    const auto hit = in_.tracer.closest_hit(ray);
    if (!hit) break;
    farthest = hit->t;
    ray.t.min = std::nextafter(hit->t * (1.0 + 1e-12), infinity);
  }
  return farthest;
}

/// The distance below which casters are not met: the one that explains most missed shadows, less those that are drawn though
/// they, too, would be missed.
void TracedPixels::find_skipped_casters() {
  const std::vector<std::uint32_t> shadowed =
      compare::pixels_where(light_.labels.data.size(), [&](std::size_t i) {
        return compare::is_compared(light_.labels.data[i]) && light_.rungs[1].data[i] < 0.5f;
      });
  struct Reach {
    double distance;
    std::uint32_t pixel;
    bool missed;
  };
  std::vector<Reach> reach(shadowed.size());
  parallel_for(shadowed.size(), [&](std::size_t k) {
    const std::uint32_t i = shadowed[k];
    reach[k] = {farthest_caster(point(i)), i, light_.rungs[6].data[i] > 0.5f};
  });
  std::sort(reach.begin(), reach.end(),
            [](const Reach& a, const Reach& b) { return a.distance < b.distance; });
  std::ptrdiff_t gain = 0, best = 0;
  std::size_t end = 0;
  for (std::size_t k = 0; k < reach.size(); ++k) {
    gain += reach[k].missed ? 1 : -1;
    if (gain > best) best = gain, end = k + 1;
  }
  if (best < static_cast<std::ptrdiff_t>(few_traced)) return;
  found_.skipped = reach[end - 1].distance;
  for (std::size_t k = 0; k < end; ++k) {
    if (!reach[k].missed || light_.labels.data[reach[k].pixel] != Label::unexplained) continue;
    give(reach[k].pixel, Label::peter_panning, 5);
    ++found_.too_far;
  }
}

std::string share_of_wrong(std::size_t part, const TracedFinding& found) {
  return fmt::format("{} of {} pixels with an error", compare::grouped(part), compare::grouped(found.wrong));
}

}  // namespace

TracedFinding label_traced_rays(const FrameInput& in, LightComparison& light) {
  return TracedPixels(in, light).run();
}

std::vector<std::string> traced_notes(const TracedFinding& found) {
  std::vector<std::string> out;
  if (found.self_intersection > 0) {
    out.push_back(
        fmt::format("{} are self-intersection: speckles on lit surfaces, where a shadow ray starts below "
                    "the surface that it leaves",
                    share_of_wrong(found.self_intersection, found)));
    out.push_back(
        fmt::format("at {} from the origin places of 32 bits are {:.2g} apart: rounding moves them by up to "
                    "{:.2g} along the normal; an offset of that, or places relative to the camera, mends it",
                    compare::plain_number(found.from_origin), found.spacing, found.offset));
  }
  if (found.terminator > 0)
    out.push_back(
        fmt::format("{} are the shadow terminator: the smooth normal faces away from the light, the "
                    "triangle does not",
                    share_of_wrong(found.terminator, found)));
  if (found.too_far > 0)
    out.push_back(
        fmt::format("{} are lit though a caster stands nearer than {:.2g}: shadow rays start beyond it, or "
                    "leave out hits as near as that",
                    share_of_wrong(found.too_far, found), found.skipped));
  return out;
}

std::string traced_advice(const TracedFinding& found, const LightComparison& light) {
  if (2 * found.self_intersection > found.wrong)
    return fmt::format(
        "Start shadow rays {:.2g} off the surface: by Gnomon's own rays from there {} of the pixels are "
        "wrong.",
        found.offset,
        compare::percent(static_cast<double>(found.left) /
                         static_cast<double>(std::max<std::uint64_t>(1, light.pixels.compared))));
  if (2 * found.too_far > found.wrong)
    return fmt::format("Start shadow rays nearer to the surface: casters up to {:.2g} away are left out.",
                       found.skipped);
  return {};
}

}  // namespace gnomon::judge

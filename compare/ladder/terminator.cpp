#include "compare/ladder/terminator.h"

#include "raytrace/shading/smooth_surface.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

/// Normals of vertices are floats: each component is off by no more than 2^-24, and by as much again where it was
/// normalised, so that a cosine with them may lie on the wrong side of 0 by less than this.
constexpr double rounding = 0x1p-22;

void add_pixel(const LadderInput& in, const raytrace::SurfacePoint& receiver, Label label,
               TerminatorCount& out) {
  const bool away = label == Label::facing_away;
  if (!away && !is_compared(label)) return;
  const LightAtPoint light = light_at(in.light(), receiver.position);
  const double facing = glm::dot(raytrace::shading_normal(in.world(), receiver), light.to_light);
  if (away && facing > rounding && !light_cannot_reach(in.light(), receiver.position, light.to_light))
    ++out.dark;
  if (!away && facing < -rounding) ++out.unlit;
}

}  // namespace

TerminatorCount count_terminator(const LadderInput& in, const Image<Label>& labels) {
  if (!in.world().has_normals()) return {};
  return parallel_reduce(
      labels.data.size(), 4096, TerminatorCount{},
      [&](std::size_t first, std::size_t last, TerminatorCount sum) {
        for (std::size_t i = first; i < last; ++i)
          add_pixel(in, in.traced.receiver.data[i], labels.data[i], sum);
        return sum;
      },
      [](const TerminatorCount& a, const TerminatorCount& b) {
        return TerminatorCount{a.dark + b.dark, a.unlit + b.unlit};
      });
}

}  // namespace gnomon::compare

#include "compare/ladder/ladder.h"

#include "raytrace/shading/smooth_surface.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

/// Normals of vertices are floats: each component is off by no more than 2^-24, and by as much again where it was
/// normalised. So a cosine with them may lie on the wrong side of 0 by less than this.
constexpr double rounding = 0x1p-22;

/// Neighbouring pixels show one triangle: where a directional light falls on one side of all of it, none counts.
class LastTriangle {
 public:
  explicit LastTriangle(const LadderInput& in)
      : in_(in), directional_(in.light().type == LightType::directional) {}
  bool is_one_sided(const raytrace::SurfacePoint& receiver) {
    if (!directional_ || !in_.world().is_triangle(receiver.primitive)) return false;
    if (receiver.primitive != primitive_ || receiver.normal != normal_) {
      primitive_ = receiver.primitive, normal_ = receiver.normal;
      const Vec3 to_light = light_at(in_.light(), receiver.position).to_light;
      one_sided_ = raytrace::corners_see_alike(in_.world(), primitive_, normal_, to_light, rounding);
    }
    return one_sided_;
  }

 private:
  const LadderInput& in_;
  bool directional_, one_sided_ = false;
  std::uint32_t primitive_ = no_id;
  Vec3 normal_{0.0};
};

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
        LastTriangle triangle(in);
        for (std::size_t i = first; i < last; ++i)
          if (const raytrace::SurfacePoint& receiver = in.traced.receiver.data[i];
              receiver.primitive != no_id && !triangle.is_one_sided(receiver))
            add_pixel(in, receiver, labels.data[i], sum);
        return sum;
      },
      [](const TerminatorCount& a, const TerminatorCount& b) {
        return TerminatorCount{a.dark + b.dark, a.unlit + b.unlit};
      });
}

}  // namespace gnomon::compare

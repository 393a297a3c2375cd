// A half plane that holds a point holds at least one of the four texel centres around it; one that holds a
// texel's centre, but not a point of the texel, holds at least one of the two neighbouring centres away from
// the point. The edge of a caster that is straight over two texels is therefore never taken for a feature.
#include "compare/ladder/features.h"

#include <algorithm>

namespace gnomon::compare {
namespace {

using Casters = std::vector<std::uint32_t>;

class Nearby {
 public:
  Nearby(const LadderInput& in, const Column& column, std::size_t pixel)
      : in_(in),
        column_(column),
        receiver_(in.traced.receiver.data[pixel]),
        at_(project_to_face(in.record().map.view, column.key().face(), receiver_.position)) {}

  const raytrace::SurfacePoint& receiver() const { return receiver_; }
  Vec2 place() const { return {at_.u, at_.v}; }
  Ray ray(const Vec2& uv) const {
    return caster_ray(in_.world(), in_.record().map.view, column_.key().face(), uv.x, uv.y);
  }

  // Where the ray meets the receiver's tangent plane; infinite where it does not meet it from the front.
  double plane_distance(const Ray& ray) const {
    const double facing = glm::dot(receiver_.normal, ray.direction);
    if (!(facing < 0.0)) return infinity;
    const double t = glm::dot(receiver_.normal, receiver_.position - ray.origin) / facing;
    return t - plane_rounding(ray, receiver_);
  }
  bool covered(const Vec2& uv, const Casters& casters) const {
    const Ray light = ray(uv);
    const auto met = first_on_ray(in_.tracer, light, plane_distance(light), [&](const raytrace::Hit& hit) {
      return hit.primitive != receiver_.primitive &&
             std::any_of(casters.begin(), casters.end(), [&](std::uint32_t caster) {
               return column_.surfaces().same(caster, hit.primitive);
             });
    });
    return met.has_value();
  }

 private:
  const LadderInput& in_;
  const Column& column_;
  const raytrace::SurfacePoint& receiver_;
  TexelCoordinate at_;
};

// All that the ray meets before t_end and that `wanted` holds of.
template <class Wanted>
Casters casters_on(const raytrace::Tracer& tracer, const Ray& ray, double t_end, const Wanted& wanted) {
  Casters casters;
  (void)first_on_ray(tracer, ray, t_end, [&](const raytrace::Hit& hit) {
    if (wanted(hit.primitive)) casters.push_back(hit.primitive);
    return false;
  });
  return casters;
}

}  // namespace

bool missed_caster_is_known(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  const Nearby nearby(in, column, wrong.pixel);
  const Casters casters = casters_on(in.tracer, in.tracer.shadow_ray(nearby.receiver(), in.light()), infinity,
                                     [](std::uint32_t) { return true; });
  const Vec2 low = glm::floor(nearby.place() - 0.5) + 0.5;
  for (int k = 0; k < 4; ++k)
    if (nearby.covered(low + Vec2(k & 1, k >> 1), casters)) return true;
  return casters.empty();
}

bool false_caster_goes_on(const LadderInput& in, Column& column, const WrongPixel& wrong) {
  const Nearby nearby(in, column, wrong.pixel);
  const std::uint32_t own = nearby.receiver().primitive;
  const Vec2 centre(column.key().column() + 0.5, column.key().row() + 0.5);
  const Ray ray = nearby.ray(centre);
  const Casters casters = casters_on(in.tracer, ray, nearby.plane_distance(ray), [&](std::uint32_t hit) {
    return hit != own && !column.same_sheet(own, hit);
  });
  const Vec2 away(centre.x < nearby.place().x ? -1.0 : 1.0, centre.y < nearby.place().y ? -1.0 : 1.0);
  for (const Vec2& step : {Vec2(away.x, 0.0), Vec2(0.0, away.y), away})
    if (nearby.covered(centre + step, casters)) return true;
  return casters.empty();
}

}  // namespace gnomon::compare

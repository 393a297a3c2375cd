// The two precisions on random scenes whose light lies in planes of faces, at corners and inside bodies, of half of them but
// for rounding: precisions_agree_test [SCENES [SEED]]. Where the robust tracer is certain, exact says the same of the same
// receiver, but where a surface that the light or the receiver touches, within rounding, is all that hides it: robust says
// that it hides nothing, exact takes the numbers as they are; the receiver's, if it lies on a triangle or a plane: no others
// are known exactly. On a sample of all pixels exact says what rational numbers do.
// Fails when it does not, or when the scenes were not hard.
#include <fmt/format.h>

#include <cstdlib>

#include "raytrace/precision/visibility.h"
#include "scene/light.h"
#include "verify/random_scene.h"
#include "verify/rational.h"

namespace gnomon::verify {
namespace {

using raytrace::PointVisibility;
using raytrace::Precision;

struct Tried {
  std::uint64_t pixels = 0, doubtful = 0, touched = 0, certain_differ = 0, asked = 0, exact_wrong = 0;
};

constexpr double roundings = 64 * 0x1p-53;

bool on_plane(const Vec3& at, const Vec3& normal, const Vec3& point) {
  return std::abs(glm::dot(normal, at - point)) <=
         roundings * glm::dot(glm::abs(normal), glm::abs(at) + glm::abs(point));
}

/// Within rounding, a place lies on the triangle's plane or on the shape.
bool lies_on(const Vec3& at, const World& world, std::uint32_t id) {
  if (world.is_triangle(id)) return on_plane(at, geometric_normal(world.corners(id)), world.corners(id)[0]);
  const auto& geometry = world.shape(id).geometry;
  if (const auto* plane = std::get_if<Plane>(&geometry)) return on_plane(at, plane->normal, plane->point);
  const auto* sphere = std::get_if<Sphere>(&geometry);
  return sphere != nullptr &&
         std::abs(glm::distance(at, sphere->center) - sphere->radius) <=
             roundings * (glm::length(at) + glm::length(sphere->center) + sphere->radius);
}

/// Within rounding, a light lies on it, or a sun shines along the infinite plane.
bool touches(const Light& light, const World& world, std::uint32_t id) {
  if (light.type != LightType::directional) return lies_on(light.position, world, id);
  if (world.is_triangle(id)) return false;
  const auto* plane = std::get_if<Plane>(&world.shape(id).geometry);
  return plane != nullptr && std::abs(glm::dot(plane->normal, light.direction)) <= roundings;
}

/// Whether what the light or the receiver touches is all that blocks the light's way, exactly. Of what has holes and is
/// not touched: not known, so left out.
bool only_touched_block(const World& world, const raytrace::SurfacePoint& from, const Light& light) {
  const raytrace::ExactShadow exact(world, from, light);
  const bool is_known = raytrace::is_known_exactly(world, from.primitive);
  bool one_does = false;
  for (std::uint32_t id = 0; id < world.primitive_count(); ++id) {
    if (id == from.primitive || !exact.decides(id) || !exact.blocks(id)) continue;
    // What another receiver lies on hides nothing of it in either precision.
    if (touches(light, world, id))
      one_does = true;
    else if (lies_on(from.position, world, id))
      one_does = one_does || is_known;
    else if (!world.is_masked(id))
      return false;
  }
  return one_does;
}

raytrace::RayTracedFrame traced(const World& world, Precision precision) {
  raytrace::RaytraceOptions rays;
  rays.picture = false, rays.size = {160, 90};
  const std::array<std::uint32_t, 1> first{0};
  const raytrace::Tracer tracer(world, raytrace::Accel::bvh, precision);
  return trace_frame(tracer, plan_effects(*world.scene), world.scene->camera, first, rays);
}

void print_pixel(const char* what, std::uint64_t scene, std::size_t pixel, const raytrace::SurfacePoint& p) {
  fmt::print(stderr, "scene {} pixel {}: {} (primitive {}, at {:a} {:a} {:a})\n", scene, pixel, what,
             p.primitive, p.position.x, p.position.y, p.position.z);
}

bool same_place(const raytrace::SurfacePoint& a, const raytrace::SurfacePoint& b) {
  return a.primitive == b.primitive && a.position == b.position && a.barycentric == b.barycentric;
}

void try_scene(const Scene& scene, std::uint64_t number, Tried& tried) {
  constexpr std::size_t sampled = 97, sampled_doubts = 41;  // the rationals take 0.1 ms
  const World world = world_of(scene);
  const auto robust = traced(world, Precision::robust), exact = traced(world, Precision::exact);
  for (std::size_t i = 0; i < robust.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint &p = robust.receiver.data[i], &q = exact.receiver.data[i];
    if (p.primitive == no_id || !same_place(p, q)) continue;
    if (light_cannot_reach(scene.lights[0], p.position, p.normal)) continue;
    const PointVisibility given = robust.lights[0].centre.data[i], truth = exact.lights[0].centre.data[i];
    if (truth == PointVisibility::uncertain) continue;  // a solid in the way, which exact leaves to rounding
    ++tried.pixels;
    const bool doubtful = given == PointVisibility::uncertain;
    const bool touched = given == PointVisibility::lit && truth == PointVisibility::shadowed &&
                         only_touched_block(world, p, scene.lights[0]);
    const bool differ = !doubtful && !touched && given != truth;
    tried.doubtful += doubtful ? 1 : 0, tried.touched += touched ? 1 : 0;
    if (differ && tried.certain_differ++ < 5) print_pixel("robust is certain, exact differs", number, i, p);
    if (!differ && i % (doubtful ? sampled_doubts : sampled) != 0) continue;
    const std::optional<bool> shadowed = rationally_shadowed(world, q, scene.lights[0]);
    if (!shadowed) continue;
    ++tried.asked;
    if (truth != (*shadowed ? PointVisibility::shadowed : PointVisibility::lit) && tried.exact_wrong++ < 5)
      print_pixel("exact differs from rational numbers", number, i, q);
  }
}

int run(std::uint64_t scenes, std::uint64_t seed) {
  Tried tried;
  for (std::uint64_t i = 0; i < scenes; ++i) {
    Random random(seed * 1000003u + i);
    try_scene(random_scene(random), i, tried);
  }
  fmt::print(
      "{} pixels that face the light: robust is certain of all but {}, and of these {} differ from exact; "
      "{} pixels asked of rational numbers, exact is wrong on {}; {} are hidden by what the light or they "
      "touch "
      "within rounding\n",
      tried.pixels, tried.doubtful, tried.certain_differ, tried.asked, tried.exact_wrong, tried.touched);
  const bool hard = tried.doubtful > scenes && tried.asked > 10 * scenes;
  return hard && tried.certain_differ == 0 && tried.exact_wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace gnomon::verify

int main(int argc, char** argv) {
  const double scenes = argc > 1 ? std::strtod(argv[1], nullptr) : 60;
  const unsigned long long seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (!(scenes >= 1.0 && scenes <= 1e6)) return 2;
  return gnomon::verify::run(static_cast<std::uint64_t>(scenes), seed);
}

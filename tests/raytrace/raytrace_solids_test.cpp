// Quadrics, tori and implicit surfaces: hits against an oracle in 128-bit floating point that knows nothing
// of intervals or closed forms (dense signs and bisection), tangents, rims and apexes, roots that are easily
// skipped, points and offsets, visibility, and every structure against brute force.
#include <gtest/gtest.h>

#include "raytrace/frame.h"
#include "raytrace/shapes/along_ray.h"
#include "raytrace/shapes/solid.h"
#include "tests/support/raytrace_support.h"
#include "tests/support/solid_samples.h"
#include "verify/quad.h"

namespace gnomon {
namespace {

using namespace raytrace;  // NOLINT(google-build-using-namespace): every second word here is from that room
using test::frame_of_ray;
using test::Random;
using test::TestWorld;

// Of solids around the origin, of size about 1: aimed inside, from near and far.
Ray random_ray(Random& random) {
  const Vec3 target = random.in_box(0.9);
  const double away = std::exp2(random.uniform(-2.0, 6.0));
  const Vec3 origin = target + away * random.direction();
  return {origin, target - origin};
}

// ---- the oracle ----

using verify::Quad;

/// 1 inside the body, 0 outside, -1 where even 128 bits cannot tell from the surface at this scale. The open
/// ones are seen as bodies too: the oracle's crossings of f are then filtered by the box.
Quad oracle_value(const ShapeGeometry& solid, const LocalRay& ray, Quad s) {
  const auto at = [&](int a) { return Quad(ray.origin[a]) + s * Quad(ray.direction[a]); };
  return test::quad_value(solid, at(0), at(1), at(2));
}

struct OracleHit {
  double s;
  bool doubtful;
};

/// The crossings of the line with f = 0 within the local box, found by `steps` equal steps.
std::vector<OracleHit> oracle_crossings(const ShapeGeometry& solid, const LocalRay& ray, int steps) {
  std::vector<OracleHit> out;
  const Aabb box = local_box(solid);
  const Interval range = box_range(ray, box);
  if (range.empty()) return out;
  Quad before = oracle_value(solid, ray, range.min);
  for (int i = 0; i < steps; ++i) {
    Quad lo = Quad(range.min) + (Quad(range.max) - Quad(range.min)) * i / steps;
    Quad hi = Quad(range.min) + (Quad(range.max) - Quad(range.min)) * (i + 1) / steps;
    const Quad after = oracle_value(solid, ray, hi);
    if ((before < 0) != (after < 0)) {
      const bool negative = before < 0;
      for (int k = 0; k < 80; ++k) {
        const Quad middle = (lo + hi) / 2;
        ((oracle_value(solid, ray, middle) < 0) == negative ? lo : hi) = middle;
      }
      out.push_back({static_cast<double>(lo), false});
    }
    before = after;
  }
  // Caps of a closed solid: where the line enters or leaves the box within the body.
  if (is_closed(solid)) {
    if (oracle_value(solid, ray, range.min) < 0) out.insert(out.begin(), {range.min, false});
    if (oracle_value(solid, ray, range.max) < 0) out.push_back({range.max, false});
  }
  return out;
}

TEST(Solids, CrossingsEqualTheOracles) {
  Random random(71);
  for (const Shape& shape : test::solid_samples()) {
    int wrong = 0, crossed = 0;
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
      const Ray ray = random_ray(random);
      const RayFrame frame = frame_of_ray(ray);
      const LocalRay local = local_ray(frame, shape.geometry);
      const std::vector<double> found = solid_crossings(frame, shape.geometry);
      const std::vector<OracleHit> truth = oracle_crossings(shape.geometry, local, 400);
      crossed += static_cast<int>(truth.size());
      if (found.size() != truth.size()) {
        // Pairs that 400 steps do not separate are the oracle's own misses: more must be found, never less.
        const bool grazing = found.size() > truth.size() && (found.size() - truth.size()) % 2 == 0;
        wrong += grazing ? 0 : 1;
        continue;
      }
      for (std::size_t k = 0; k < found.size(); ++k) {
        const double off = std::abs(found[k] - truth[k].s) * glm::length(local.direction);
        const double steep =
            std::abs(AlongRay{&shape.geometry, local.origin, local.direction}.slope(truth[k].s).change) /
            glm::length(local.direction);
        // Rounding of the far origin, magnified where the ray grazes.
        const double bound = 1e-12 * (1.0 + glm::length(local.origin)) / std::min(1.0, steep);
        worst = std::max(worst, off);
        wrong += off > bound ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << shape.name << ", worst " << worst;
    EXPECT_GT(crossed, 100) << shape.name;
  }
}

TEST(Solids, ClosedOnesAreCrossedEvenly) {
  Random random(72);
  for (const Shape& shape : test::solid_samples()) {
    if (!is_closed(shape.geometry)) continue;
    int odd = 0;
    for (int i = 0; i < 20000; ++i)
      odd += solid_crossings(frame_of_ray(random_ray(random)), shape.geometry).size() % 2 == 0 ? 0 : 1;
    EXPECT_EQ(odd, 0) << shape.name;
  }
}

// Rays through the rim of a capped solid, nudged by single units: the body and its caps leave no gap.
TEST(Solids, RimsDoNotLeak) {
  Random random(73);
  const Shape can = test::solid("can", make_cylinder(test::tilted_frame(), 0.8, 1.2, true));
  const Shape hat = test::solid("hat", make_cone(test::tilted_frame(), 0.9, 0.0, 1.1, true));
  for (const Shape& shape : {can, hat}) {
    const auto& q = std::get<Quadric>(shape.geometry);
    const double rim = std::sqrt(-q.one);
    int leaks = 0;
    for (int i = 0; i < 20000; ++i) {
      const double turn = random.uniform(0.0, 2.0 * pi);
      const Vec3 on_rim = to_world(q.frame, Vec3(rim * std::cos(turn), rim * std::sin(turn), 0.0));
      const Vec3 middle = to_world(q.frame, Vec3(0.0, 0.0, 0.3));
      const Vec3 origin = random.nudged(middle + 4.0 * (on_rim - middle), 2);
      leaks += solid_crossings(frame_of_ray({origin, on_rim - origin}), shape.geometry).empty() ? 1 : 0;
    }
    EXPECT_EQ(leaks, 0) << shape.name;
  }
}

// ---- implicit surfaces ----

TEST(Implicits, TheSphereEqualsTheSphere) {
  const TestWorld exact(test::scene_of({}, {test::sphere({0.1, -0.2, 0.3}, 0.8)}));
  Shape same = test::implicit("sphere", "x^2 + y^2 + z^2 - 0.64", {Vec3(-1.0), Vec3(1.0)});
  std::get<Implicit>(same.geometry).frame.origin = Vec3(0.1, -0.2, 0.3);
  const TestWorld written(test::scene_of({}, {same}));
  const Tracer a(exact.world(), Accel::bvh), b(written.world(), Accel::bvh);
  Random random(74);
  int differ = 0, hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = random_ray(random);
    const auto h = a.closest_hit(ray), k = b.closest_hit(ray);
    hits += h ? 1 : 0;
    // 1e-7: the root of the rounding, at grazing rays.
    differ += h.has_value() != k.has_value() || (h && std::abs(h->t - k->t) > 1e-7) ? 1 : 0;
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(hits, 5000);
}

TEST(Implicits, TheTorusEqualsTheTorus) {
  const Shape quartic = test::solid("torus", Torus{ShapeFrame{}, 0.7, 0.25});
  const Shape rooted =
      test::implicit("rooted", "(sqrt(x^2 + y^2) - 0.7)^2 + z^2 - 0.0625", {Vec3(-1.0), Vec3(1.0)});
  const Shape expanded = test::implicit(
      "expanded", "(x^2 + y^2 + z^2 + 0.49 - 0.0625)^2 - 4 * 0.49 * (x^2 + y^2)", {Vec3(-1.0), Vec3(1.0)});
  Random random(75);
  int differ = 0, four = 0;
  for (int i = 0; i < 10000; ++i) {
    const RayFrame ray = frame_of_ray(random_ray(random));
    const auto truth = solid_crossings(ray, quartic.geometry);
    four += truth.size() == 4 ? 1 : 0;
    for (const Shape* other : {&rooted, &expanded}) {
      const auto found = solid_crossings(ray, other->geometry);
      differ += found.size() == truth.size() ? 0 : 1;
      for (std::size_t k = 0; k < found.size() && k < truth.size(); ++k)
        differ += std::abs(found[k] - truth[k]) < 1e-6 ? 0 : 1;
    }
  }
  EXPECT_EQ(differ, 0);
  EXPECT_GT(four, 200);
}

// Sheets so thin, bumps so narrow and tangents so close that steps or Newton's method alone would skip them.
TEST(Implicits, NoRootIsSkipped) {
  struct Case {
    const char* function;
    std::size_t roots;  // on the ray along x from -2, at y = 0, z = 0
  };
  const Case cases[] = {
      {"(x - 0.3) * (x - 0.3 - 1e-9)", 2},       // a double sheet
      {"(x + 0.1)^2 - 1e-16", 2},                // two roots 2e-8 apart
      {"(x - 0.25)^2", 1},                       // a touch: the sheet itself
      {"(x - 0.25)^2 + 1e-12", 0},               // a near miss
      {"exp(-(1e5 * (x - 0.123))^2) - 0.5", 2},  // a spike 1e-5 wide in a flat field
      {"sin(200 * x)", 127},                     // 200 * 2 / pi = 127.3
      {"abs(x - 0.5) - 1e-7", 2},                // a kink between the roots
      {"1 / (x - 0.2)", 0},                      // a pole is no root
      {"sqrt(x - 0.3) - 0.5", 1},                // defined on a part of the ray only
      {"log(x) + 0.7", 1},
      {"max(x - 0.9, (x + 0.4)^2 - 1e-8)", 2},  // a parabola handed over to a line
      {"x^3 - 3e-6 * x", 3},
      {"(x^2 - 1e-10) * (x - 0.5)^3", 3},
      {"max(abs(x) - 0.5, 0.25 - abs(x))", 4},
  };
  for (const Case& c : cases) {
    const Shape shape = test::implicit("case", c.function, {Vec3(-1.0), Vec3(1.0)});
    const auto found = solid_crossings(frame_of_ray({{-2, 0, 0}, {1, 0, 0}}), shape.geometry);
    EXPECT_EQ(found.size(), c.roots) << c.function;
  }
}

// ---- points, normals, offsets ----

TEST(Solids, PointsLieOnTheSurfaceAndNormalsAreGradients) {
  Random random(76);
  for (const Shape& shape : test::solid_samples()) {
    const TestWorld w(test::scene_of({}, {shape}));
    const Tracer tracer(w.world(), Accel::bvh);
    int off = 0, bent = 0, hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = random_ray(random);
      const auto hit = tracer.closest_hit(ray);
      if (!hit) continue;
      ++hits;
      const SurfacePoint p = tracer.surface_point(ray, *hit);
      const Vec3 local = to_local(frame_of(shape.geometry), p.position);
      const SolidPart part = nearest_part(shape.geometry, local);
      if (part.axis >= 0) continue;
      // Central differences, 1e-5 apart: good to 1e-9.
      Vec3 slope;
      for (int a = 0; a < 3; ++a) {
        Vec3 step(0.0);
        step[a] = 1e-5;
        const Vec3 q = local + step, r = local - step;
        slope[a] =
            (solid_value(shape.geometry, q.x, q.y, q.z) - solid_value(shape.geometry, r.x, r.y, r.z)) / 2e-5;
      }
      const double steep = glm::length(slope);
      if (steep < 1e-3) continue;  // an apex
      off += std::abs(solid_value(shape.geometry, local.x, local.y, local.z)) >
                     steep * glm::length(p.position_error)
                 ? 1
                 : 0;
      const Vec3 normal = glm::transpose(frame_of(shape.geometry).axes) * p.normal;
      bent += std::abs(std::abs(glm::dot(normal, slope / steep)) - 1.0) > 1e-6 ? 1 : 0;
      EXPECT_LT(glm::dot(p.normal, ray.direction), 1e-9) << shape.name;
    }
    EXPECT_EQ(off, 0) << shape.name;
    EXPECT_EQ(bent, 0) << shape.name;
    EXPECT_GT(hits, 100) << shape.name;
  }
}

bool same_part(const Shape& shape, const Vec3& p, const Vec3& q) {
  const ShapeFrame& frame = frame_of(shape.geometry);
  const SolidPart a = nearest_part(shape.geometry, to_local(frame, p)),
                  b = nearest_part(shape.geometry, to_local(frame, q));
  return a.axis == b.axis && a.high == b.high;
}

// A convex solid does not meet a ray that leaves it outwards. No part of a solid meets it within a thousandth of the
// solid's size when it leaves that part steeply: from inside, near a rim, it meets the other part.
TEST(Solids, NothingShadowsItself) {
  Random random(77);
  for (const double size : {1e-4, 1.0, 1e4})
    for (const double away : {0.0, 1e5})
      for (const Shape& shape : test::solid_samples(size, Vec3(away, -away, 0.5 * away))) {
        if (size < 1.0 && away > 0.0) continue;  // below the resolution of the world's coordinates
        const TestWorld w(test::scene_of({}, {shape}));
        const Tracer tracer(w.world(), Accel::bvh);
        int self = 0, left = 0;
        for (int i = 0; i < 400; ++i) {
          Ray ray = random_ray(random);
          ray.origin = size * ray.origin + Vec3(away, -away, 0.5 * away), ray.direction *= size;
          const auto hit = tracer.closest_hit(ray);
          if (!hit) continue;
          const SurfacePoint p = tracer.surface_point(ray, *hit);
          Vec3 out = random.direction();
          if (glm::dot(out, p.normal) < 0.0) out = -out;
          if (glm::dot(out, p.normal) < 0.2) continue;
          ++left;
          const bool outside = !solid_contains(shape.geometry, p.position + 1e-6 * size * p.normal);
          Ray leaving = tracer.spawn_ray(p, out);
          if (!(is_convex(shape.geometry) && outside)) leaving.t.max = 1e-3 * size;
          const auto met = tracer.closest_hit(leaving);
          EXPECT_EQ(met.has_value(), tracer.occluded(leaving));
          self += met && same_part(shape, p.position, leaving.at(met->t)) ? 1 : 0;
        }
        EXPECT_EQ(self, 0) << shape.name << " of size " << size << " at " << away;
        EXPECT_GT(left, 10) << shape.name;
      }
}

// ---- visibility ----

TEST(Solids, VerdictsAgreeWithRaysAndAreSeldomUncertain) {
  Random random(78);
  for (const Shape& shape : test::solid_samples()) {
    const Shape floor = test::plane({0, -1.5, 0}, {0, 1, 0});
    const TestWorld w(test::scene_of({}, {shape, floor}));
    const Tracer tracer(w.world(), Accel::bvh);
    int wrong = 0, ambiguous = 0, asked = 0, shadowed = 0;
    for (int i = 0; i < 4000; ++i) {
      const Light light = test::point_light(random.direction() * 4.0 + Vec3(0, 3.0, 0));
      const Vec3 target = random.below(2) == 0 ? random.in_box(1.0) : Vec3(0, -1.5, 0) + random.in_box(3.0);
      const Vec3 eye = random.direction() * 5.0 + Vec3(0, 4.0, 0);
      const Ray ray{eye, target - eye};
      const auto hit = tracer.closest_hit(ray);
      if (!hit) continue;
      const SurfacePoint p = tracer.surface_point(ray, *hit);
      if (glm::dot(p.normal, light.position - p.position) <= 0.0) continue;
      ++asked;
      const PointVisibility v = tracer.centre_visibility(p, light);
      if (v == PointVisibility::uncertain) {
        ++ambiguous;
        continue;
      }
      shadowed += v == PointVisibility::shadowed ? 1 : 0;
      wrong += (v == PointVisibility::shadowed) != tracer.occluded(tracer.shadow_ray(p, light)) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << shape.name;
    EXPECT_LE(ambiguous, asked / 500) << shape.name << " of " << asked;
    EXPECT_GT(shadowed, 20) << shape.name;
    EXPECT_GT(asked, 500) << shape.name;
  }
}

// Frames are traced in packets where that is sure; solids, and spheres seen from within, shadow themselves.
TEST(Solids, FramesShadowAsSingleRaysDo) {
  std::vector<Shape> shapes = test::solid_samples();
  shapes.push_back(test::implicit(
      "gyroid ball", "max(x^2+y^2+z^2-1, abs(sin(5*x)*cos(5*y)+sin(5*y)*cos(5*z)+sin(5*z)*cos(5*x))-0.4)",
      {Vec3(-1.01), Vec3(1.01)}));
  shapes.push_back(test::sphere({0, 0, 3.5}, 4.0));  // about the eye
  for (const Shape& shape : shapes) {
    Scene scene = test::scene_of({}, {shape, test::plane({0, -1.2, 0}, {0, 1, 0})});
    scene.camera.eye = Vec3(0.6, 1.2, 4.0);
    scene.camera.target = Vec3(0.0, -0.2, 0.0);
    scene.lights = {test::sun({-0.5, -0.8, -0.6}), test::point_light({1.5, 6.0, 1.0})};
    const TestWorld w(scene);
    const Tracer tracer(w.world(), Accel::bvh);
    RaytraceOptions options;
    options.size = {100, 70};  // whole tiles and partial ones
    const std::vector<std::uint32_t> lights{0, 1};
    const RayTracedFrame frame = trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
    for (std::size_t l = 0; l < 2; ++l) {
      const Light& light = scene.lights[l];
      int wrong = 0, dark = 0;
      for (std::size_t i = 0; i < frame.receiver.data.size(); ++i) {
        const SurfacePoint& p = frame.receiver.data[i];
        if (p.primitive == no_id || light_cannot_reach(light, p.position, p.normal)) continue;
        const PointVisibility truth = tracer.centre_visibility(p, light);
        dark += truth == PointVisibility::shadowed ? 1 : 0;
        wrong += frame.lights[l].centre.data[i] != truth ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0) << shape.name << ", light " << l;
      EXPECT_GT(dark, 20) << shape.name << ", light " << l;
    }
  }
}

// ---- structures ----

TEST(Solids, EveryStructureAgreesWithBruteForce) {
  Random random(79);
  std::vector<Shape> shapes;
  for (int i = 0; i < 4; ++i) {
    const Vec3 place = random.in_box(3.0);
    for (Shape& s : test::solid_samples(random.uniform(0.2, 1.5), place)) shapes.push_back(std::move(s));
  }
  for (int i = 0; i < 10; ++i) shapes.push_back(test::some_sphere(random, 3.0, {0.1, 0.8}));
  shapes.push_back(test::plane({0, -3, 0}, {0, 1, 0}));
  const TestWorld w(test::scene_of({test::triangle_soup(200, 3.0, 0.5, 5)}, std::move(shapes)));
  const Tracer brute(w.world(), Accel::brute);
  std::vector<Ray> rays;
  for (int i = 0; i < 1500; ++i) {
    const Vec3 origin = random.in_box(5.0);
    rays.push_back({origin, random.in_box(3.0) - origin});
  }
  for (const Accel accel : {Accel::bvh, Accel::bvh_median, Accel::kdtree, Accel::kdtree_cyclic, Accel::octree,
                            Accel::grid, Accel::grid_textbook, Accel::bsp, Accel::two_level}) {
    const Tracer tracer(w.world(), accel);
    int wrong = 0;
    for (const Ray& ray : rays) {
      const auto a = tracer.closest_hit(ray), b = brute.closest_hit(ray);
      wrong +=
          a.has_value() != b.has_value() || (a && (a->t != b->t || a->primitive != b->primitive)) ? 1 : 0;
      wrong += tracer.occluded(ray) != brute.occluded(ray) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0) << static_cast<int>(accel);
  }
}

}  // namespace
}  // namespace gnomon

// Every structure against brute force, which is itself held against Moeller-Trumbore in 128 bits wherever a
// rounding of doubles could not turn the answer.
#include <fmt/core.h>

#include <array>

#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

using raytrace::Accel;
using raytrace::Tracer;

/// One tracer for each structure but brute force.
std::vector<Tracer> every_structure(const Run& run, const World& world) {
  std::vector<Tracer> tracers;
  for (int accel = 0; accel < static_cast<int>(Accel::brute); ++accel)
    tracers.push_back(run.tracer(world, static_cast<Accel>(accel)));
  return tracers;
}

/// Sends the same ray through all structures, through brute force and, now and then, through the oracle.
void agree(const std::vector<Tracer>& tracers, const Tracer& brute, const Ray& ray, bool ask_oracle,
           Tally& tally) {
  const auto plain = brute.closest_hit(ray);
  bool right = brute.occluded(ray) == plain.has_value();
  for (const Tracer& tracer : tracers)
    right = right && same(tracer.closest_hit(ray), plain) && tracer.occluded(ray) == plain.has_value();
  if (right && ask_oracle) {
    const OracleHit truth = oracle_closest(brute.world(), ray);
    right = truth.doubtful || truth.primitive == (plain ? plain->primitive : no_id);
  }
  tally.check(right);
}

}  // namespace

void equal_centroids(Run& run) {
  const std::uint64_t copies = run.rays(0.1, 1'000'000);
  Mesh mesh;  // every other one is a turned and larger triangle about the same centre
  mesh.positions = {{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}, {2, 2, 0}, {-4, 2, 0}, {2, -4, 0}};
  for (std::uint64_t i = 0; i < copies; ++i) {
    mesh.triangles.push_back(i % 2 == 0 ? std::array<std::uint32_t, 3>{0, 1, 2}
                                        : std::array<std::uint32_t, 3>{3, 4, 5});
  }
  const SmallWorld w(mesh);
  const Tracer tracer = run.tracer(w.world());
  // Each ray meets every copy: few of them are many tests.
  run.sample(fmt::format("lowest of {} copies", copies), run.rays(1e-4, 1000), [&](Random& r, Tally& tally) {
    const Vec3 target{r.uniform(-0.9, 0.3), r.uniform(-0.9, 0.3), 0.0};
    const auto hit = tracer.closest_hit({target + Vec3(0.0, 0.0, 1.0), {0.0, 0.0, -1.0}});
    const auto miss = tracer.closest_hit({target + Vec3(8.0, 8.0, 1.0), {0.0, 0.0, -1.0}});
    tally.check(hit && hit->primitive == 0 && !miss);
  });
}

void few_primitives(Run& run) {
  for (int count = 0; count <= 2; ++count) {
    Random random(run.seed() + static_cast<std::uint64_t>(count));
    const SmallWorld w(soup(count, 0.5, 1.0, random));
    const std::vector<Tracer> all = every_structure(run, w.world());
    const Tracer brute = run.tracer(w.world(), Accel::brute);
    run.sample(fmt::format("{} primitives", count), run.rays(0.05), [&](Random& r, Tally& tally) {
      const Vec3 origin = r.in_box(3.0);
      agree(all, brute, {origin, r.in_box(1.0) - origin}, true, tally);
    });
  }
}

void bad_vertices(Run& run) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(run.seed());
  const Mesh sound = soup(200, 2.0, 1.0, random);
  Mesh poisoned = sound;
  const auto first = static_cast<std::uint32_t>(sound.positions.size());
  poisoned.positions.insert(poisoned.positions.end(), {{nan, 0, 0}, {infinity, 1, 0}, {0, -infinity, 0}});
  for (std::uint32_t i = 0; i < 30; ++i) poisoned.triangles.push_back({i, i + 1, first + i % 3});
  const SmallWorld w(sound), bad(poisoned);
  const std::vector<Tracer> all = every_structure(run, bad.world());
  const Tracer plain = run.tracer(w.world(), Accel::brute);
  run.sample("the others", run.rays(0.05), [&](Random& r, Tally& tally) {
    const Vec3 origin = r.in_box(4.0);
    const Ray ray{origin, r.in_box(2.0) - origin};
    const auto hit = plain.closest_hit(ray);
    tally.check(std::all_of(all.begin(), all.end(), [&](const Tracer& tracer) {
      return tracer.stats().dropped == 30 && same(tracer.closest_hit(ray), hit);
    }));
  });
}

void stadium(Run& run) {
  constexpr double small = 1e-3, large = 1e5;
  Random random(run.seed());
  const Vec3 center(30.0, 0.5, -20.0);
  const SmallWorld w(std::vector<Mesh>{in_floats(round_mesh(center, small, 12, 12, 0.0, random)),
                                       box(Vec3(-large), Vec3(large))},
                     {});
  const std::vector<Tracer> all = every_structure(run, w.world());
  const Tracer brute = run.tracer(w.world(), Accel::brute);
  // Bounded memory: ten megabytes are room for the coarsest of grids.
  const bool small_enough = std::all_of(
      all.begin(), all.end(), [](const Tracer& tracer) { return tracer.stats().bytes < 10'000'000; });
  run.sample("hits", run.rays(0.1), [&](Random& r, Tally& tally) {
    const Vec3 origin = r.coin() ? r.in_box(0.9 * large) : center + r.in_box(10.0 * small);
    agree(all, brute, {origin, center + r.in_box(small) - origin}, false, tally);
  });
  run.sample("memory", 256, [&](Random&, Tally& tally) { tally.check(small_enough); });
}

void split_plane(Run& run) {
  // Squares in the planes of whole numbers: wherever a structure splits, a triangle lies in the plane.
  std::vector<Mesh> meshes;
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 3; ++k) {
        Vec3 corner(0.0), a(0.0), b(0.0);
        corner[k] = i, corner[(k + 1) % 3] = j, corner[(k + 2) % 3] = (i + j) % 4;
        a[(k + 1) % 3] = 1.0, b[(k + 2) % 3] = 1.0;
        meshes.push_back(quad(corner, a, b));
      }
  const SmallWorld w(std::move(meshes), {});
  const std::vector<Tracer> all = every_structure(run, w.world());
  const Tracer brute = run.tracer(w.world(), Accel::brute);
  run.sample("rays in the planes", run.rays(0.1), [&](Random& r, Tally& tally) {
    Vec3 origin = r.in_box(6.0), d = r.direction();
    const int a = r.integer(0, 2);
    origin[a] = r.integer(0, 4), d[a] = r.coin() ? 0.0 : -0.0;
    if (r.coin()) d[(a + 1) % 3] = 0.0, origin[(a + 1) % 3] = r.integer(0, 4);
    agree(all, brute, {origin, d}, r.below(4) == 0, tally);
  });
}

void cell_corners(Run& run) {
  // A ball at each third corner of a lattice and squares between them; rays along the diagonals of its cells.
  std::vector<Mesh> meshes;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) {
        if ((x + 2 * y + 4 * z) % 5 != 0) continue;
        meshes.push_back(quad(Vec3(x, y, z), Vec3(1, 0, 0), Vec3(0, 0.5, 1)));
      }
  const SmallWorld w(std::move(meshes), {});
  const std::vector<Tracer> all = every_structure(run, w.world());
  const Tracer brute = run.tracer(w.world(), Accel::brute);
  run.sample("rays through corners", run.rays(0.03), [&](Random& r, Tally& tally) {
    Vec3 corner, d;
    for (int a = 0; a < 3; ++a) corner[a] = r.integer(0, 6), d[a] = r.integer(-2, 2);
    if (d == Vec3(0.0)) d.x = 1.0;
    const Vec3 origin = r.nudged(corner - 8.0 * d, r.coin() ? 0 : 4);
    agree(all, brute, {origin, d}, r.below(4) == 0, tally);
  });
}

}  // namespace gnomon::verify

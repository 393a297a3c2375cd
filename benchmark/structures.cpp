// Acceleration structures side by side: the same single rays in double precision through each. They are primary rays
// of the picture and shadow rays from what they hit to the scene's first light. Brute force gets every n-th
// ray only, so many as its cost allows.
#include <fmt/core.h>

#include <atomic>

#include "benchmark/row.h"
#include "raytrace/tracer.h"
#include "scene/base/expected.h"
#include "scene/base/parallel.h"
#include "scene/base/timing.h"

namespace gnomon::bench {
namespace {

using raytrace::Accel;
using raytrace::Hit;
using raytrace::Tracer;
using raytrace::WorkCounts;

constexpr double brute_force_tests = 2e8;  // ray-primitive tests per pass that brute force is given
constexpr std::size_t grain = 1024;        // rays per task

struct Rays {
  std::vector<Ray> primary, shadow;
  std::vector<std::optional<Hit>> hits;  // of the primary rays
  std::vector<std::uint8_t> shadowed;    // of the shadow rays
};

template <class Body>
void for_each_ray(std::size_t count, std::size_t step, const Body& body) {
  const std::size_t traced = (count + step - 1) / step;
  parallel_for(traced, grain, [&](std::size_t i) { body(i * step); });
}

Rays make_rays(const Tracer& tracer, const Scene& scene, ImageSize size) {
  const View view = make_view(scene.camera, size);
  Rays rays;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) rays.primary.push_back(pixel_ray(view, x + 0.5, y + 0.5));
  for (const Ray& ray : rays.primary) {
    rays.hits.push_back(tracer.closest_hit(ray));
    if (!rays.hits.back() || scene.lights.empty()) continue;
    const auto point = tracer.surface_point(ray, *rays.hits.back());
    if (light_cannot_reach(scene.lights[0], point.position, point.normal)) continue;
    rays.shadow.push_back(tracer.shadow_ray(point, scene.lights[0]));
    rays.shadowed.push_back(tracer.occluded(rays.shadow.back()) ? 1 : 0);
  }
  return rays;
}

bool same(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->t == b->t && a->primitive == b->primitive;
}

struct MeasuredStructure {
  Accel accel;
  double build_ms = 0.0, megabytes = 0.0;
  double primary_mrays = 0.0, shadow_mrays = 0.0;  // per second
  double boxes = 0.0, triangles = 0.0;             // per ray of both kinds
  std::uint64_t wrong = 0;
};

double mrays_per_second(std::size_t rays, std::size_t step, const Times& times) {
  const std::size_t traced = (rays + step - 1) / step;
  return times.median() > 0.0 ? static_cast<double>(traced) / times.median() / 1e3 : 0.0;
}

template <class Pass>
Times time_passes(int runs, const Pass& pass) {
  Times times;
  for (int run = 0; run < runs; ++run) time_run(times, pass);
  return times;
}

/// The nodes of sixteen that the rays go through: made now, so that their making and their bytes count too.
void add_collapsed_tree(const Tracer& tracer, MeasuredStructure& m) {
  const Stopwatch watch;
  prepare_single_rays(tracer);
  if (single_ray_bytes(tracer) == 0) return;
  m.build_ms += watch.elapsed_ms();
  m.megabytes += static_cast<double>(single_ray_bytes(tracer)) / 1048576.0;
}

/// The counted and checked pass comes first: it warms the caches for the timed ones.
MeasuredStructure measure(const BenchInput& input, const Rays& rays, Accel accel) {
  const Tracer tracer(input.world, accel);
  MeasuredStructure m{.accel = accel,
                      .build_ms = tracer.stats().build_ms,
                      .megabytes = static_cast<double>(tracer.stats().bytes) / 1048576.0};
  add_collapsed_tree(tracer, m);
  const double tests = static_cast<double>(rays.primary.size()) * input.world.primitive_count();
  const std::size_t step =
      accel == Accel::brute ? static_cast<std::size_t>(1.0 + tests / brute_force_tests) : 1;
  std::atomic<std::uint64_t> wrong = 0, boxes = 0, triangles = 0, traced = 0;
  const auto count = [&](const WorkCounts& work, bool right) {
    boxes += work.boxes, triangles += work.primitives, wrong += right ? 0 : 1, ++traced;
  };
  for_each_ray(rays.primary.size(), step, [&](std::size_t i) {
    WorkCounts work;
    const bool right = same(counted_closest_hit(tracer, rays.primary[i], work), rays.hits[i]);
    count(work, right);
  });
  for_each_ray(rays.shadow.size(), step, [&](std::size_t i) {
    WorkCounts work;
    const bool right = counted_occluded(tracer, rays.shadow[i], work) == (rays.shadowed[i] != 0);
    count(work, right);
  });
  m.wrong = wrong;
  m.boxes = static_cast<double>(boxes) / static_cast<double>(std::max<std::uint64_t>(1, traced));
  m.triangles = static_cast<double>(triangles) / static_cast<double>(std::max<std::uint64_t>(1, traced));
  std::atomic<std::uint64_t> hits = 0;  // keeps the work from being optimised away
  const Times primary = time_passes(input.runs, [&] {
    for_each_ray(rays.primary.size(), step, [&](std::size_t i) {
      if (tracer.closest_hit(rays.primary[i])) hits.fetch_add(1, std::memory_order_relaxed);
    });
  });
  const Times shadow = time_passes(input.runs, [&] {
    for_each_ray(rays.shadow.size(), step, [&](std::size_t i) {
      if (tracer.occluded(rays.shadow[i])) hits.fetch_add(1, std::memory_order_relaxed);
    });
  });
  m.primary_mrays = mrays_per_second(rays.primary.size(), step, primary);
  m.shadow_mrays = mrays_per_second(rays.shadow.size(), step, shadow);
  return m;
}

std::string table_row(const MeasuredStructure& m) {
  return fmt::format("{:<14}{:>10.1f}{:>9.1f}{:>11.1f}{:>15.1f}{:>18.3f}{:>17.3f}\n",
                     raytrace::accel_name(m.accel), m.build_ms, m.megabytes, m.boxes, m.triangles,
                     m.primary_mrays, m.shadow_mrays);
}

std::string table(const BenchInput& input, const Rays& rays, std::span<const MeasuredStructure> all) {
  std::string text = fmt::format(
      "{}: {} primitives, {} primary rays ({} hit), {} shadow rays; every structure sees the same\n"
      "{:<14}{:>10}{:>9}{:>11}{:>15}{:>18}{:>17}\n",
      one_line(input.scene.name), input.world.primitive_count(), rays.primary.size(),
      std::count_if(rays.hits.begin(), rays.hits.end(), [](const auto& h) { return h.has_value(); }),
      rays.shadow.size(), "structure", "build ms", "MiB", "boxes/ray", "triangles/ray", "primary Mrays/s",
      "shadow Mrays/s");
  for (const MeasuredStructure& m : all) text += table_row(m);
  return text;
}

/// The peer of every structure is the default one.
void add_rows(const BenchInput& input, const MeasuredStructure& m, const MeasuredStructure* base,
              std::vector<BenchRow>& rows) {
  const auto add = [&](const char* what, double MeasuredStructure::*field, const char* unit,
                       bool more_is_better) {
    BenchRow row{fmt::format("{} {}", raytrace::accel_name(m.accel), what),
                 input.scene.name,
                 input.threads,
                 m.*field,
                 unit,
                 more_is_better};
    if (base != nullptr && base != &m)
      row.peer = {std::string(raytrace::accel_name(base->accel)), base->*field};
    rows.push_back(std::move(row));
  };
  add("build", &MeasuredStructure::build_ms, "ms", false);
  add("memory", &MeasuredStructure::megabytes, "MiB", false);
  add("boxes per ray", &MeasuredStructure::boxes, "boxes", false);
  add("triangles per ray", &MeasuredStructure::triangles, "triangles", false);
  add("primary rays", &MeasuredStructure::primary_mrays, "Mrays/s", true);
  add("shadow rays", &MeasuredStructure::shadow_mrays, "Mrays/s", true);
}

}  // namespace

Expected<BenchResult> bench_structures(const BenchInput& input) {
  const Tracer reference(input.world, Accel::bvh);
  const Rays rays = make_rays(reference, input.scene, input.size);
  std::vector<MeasuredStructure> all;
  for (const Accel accel : input.accels) {
    input.progress(std::string(raytrace::accel_name(accel)),
                   static_cast<double>(all.size()) / static_cast<double>(input.accels.size()));
    all.push_back(measure(input, rays, accel));
    if (all.back().wrong == 0) continue;
    return fail(ErrorKind::internal,
                fmt::format("{} and bvh disagree on {} rays", raytrace::accel_name(accel), all.back().wrong));
  }
  BenchResult result{table(input, rays, all), {}};
  const auto base =
      std::find_if(all.begin(), all.end(), [](const MeasuredStructure& m) { return m.accel == Accel::bvh; });
  for (const MeasuredStructure& m : all)
    add_rows(input, m, base == all.end() ? nullptr : &*base, result.rows);
  return result;
}

}  // namespace gnomon::bench

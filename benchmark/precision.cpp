// What accuracy costs: the three precisions side by side. Speed is that of the scene's own primary and hard
// shadow rays, as a picture is rendered (in packets where the precision has them) and one ray at a time. The
// latter compares the arithmetic alone. Wrong shadows are counted on adversarial rays, aimed at corners and
// edges, against rational numbers. A single triangle is wrong where the ray passes its edges by more than rounding. Nearer
// than that robust decides as rounding falls, but alike for both triangles of an edge, so that none slips between them.
#include <fmt/core.h>

#include <atomic>

#include "benchmark/row.h"
#include "raytrace/frame.h"
#include "scene/base/expected.h"
#include "scene/base/parallel.h"
#include "verify/adversarial.h"
#include "verify/rational.h"

namespace gnomon::bench {
namespace {

using raytrace::PointVisibility;
using raytrace::Precision;
using raytrace::Tracer;

struct Speed {
  double primary = 0.0, shadow = 0.0;  ///< Mrays/s
};

struct Wrong {
  std::uint64_t tried = 0, wrong = 0, open = 0;  ///< open: said to be uncertain, or decided by rounding
  Wrong& operator+=(const Wrong& b) {
    tried += b.tried, wrong += b.wrong, open += b.open;
    return *this;
  }
  double per_1e8(std::uint64_t count) const {
    return 1e8 * static_cast<double>(count) / static_cast<double>(std::max<std::uint64_t>(tried, 1));
  }
};

struct MeasuredPrecision {
  Precision precision;
  Speed rendered, single;
  Wrong primary, shadow;
};

double mrays_per_second(std::uint64_t rays, double ms) {
  return ms > 0.0 ? static_cast<double>(rays) / ms * 1e-3 : 0.0;
}

std::vector<std::uint32_t> first_light(const Scene& scene) {
  return scene.lights.empty() ? std::vector<std::uint32_t>{} : std::vector<std::uint32_t>{0};
}

raytrace::RayTracedFrame render(const BenchInput& input, const Tracer& tracer, int runs) {
  raytrace::RaytraceOptions options;
  options.size = input.size, options.runs = runs, options.warm_up = runs > 1, options.picture = false,
  options.shadow_samples = 1;
  return trace_frame(tracer, input.plan, input.scene.camera, first_light(input.scene), options);
}

Speed speed_rendered(const BenchInput& input, const Tracer& tracer) {
  const auto frame = render(input, tracer, std::max(2, input.runs));
  Speed speed;
  speed.primary = mrays_per_second(frame.rays.primary, frame.primary_rays.median());
  if (!frame.lights.empty())
    speed.shadow = mrays_per_second(frame.lights[0].rays, frame.lights[0].shadow_rays.median());
  return speed;
}

/// pixel(x, y) over all threads, `runs` times after a warm-up: the median milliseconds.
template <class Pixel>
double time_pixels(const BenchInput& input, const Pixel& pixel) {
  Times times;
  const auto pass = [&] {
    parallel_for(input.size.height, [&](int y) {
      for (int x = 0; x < input.size.width; ++x) pixel(x, y);
    });
  };
  pass();
  for (int run = 0; run < input.runs; ++run) time_run(times, pass);
  return times.median();
}

Speed speed_single(const BenchInput& input, const Tracer& tracer) {
  const View view = make_view(input.scene.camera, input.size);
  const auto frame = render(input, tracer, 1);
  std::atomic<std::uint64_t> found = 0;  // keeps the work from being optimised away
  Speed speed;
  speed.primary = mrays_per_second(input.size.pixels(), time_pixels(input, [&](int x, int y) {
                                     if (tracer.closest_hit(pixel_ray(view, x + 0.5, y + 0.5)))
                                       found.fetch_add(1, std::memory_order_relaxed);
                                   }));
  if (input.scene.lights.empty()) return speed;
  const Light& light = input.scene.lights[0];
  const double ms = time_pixels(input, [&](int x, int y) {
    const auto& point = frame.receiver.at(x, y);
    if (point.primitive == no_id || light_cannot_reach(light, point.position, point.normal)) return;
    if (tracer.centre_visibility(point, light) == PointVisibility::lit)
      found.fetch_add(1, std::memory_order_relaxed);
  });
  speed.shadow = mrays_per_second(frame.lights[0].rays, ms);
  return speed;
}

/// try_one(random, wrong) for so many rays over all threads; each block has random numbers of its own.
template <class Try>
Wrong count_wrong(std::uint64_t rays, std::uint64_t seed, const Try& try_one) {
  constexpr std::uint64_t block = 4096;
  const std::uint64_t blocks = (rays + block - 1) / block;
  return parallel_reduce(
      blocks, 1, Wrong{},
      [&](std::size_t first, std::size_t last, Wrong wrong) {
        for (std::uint64_t b = first; b < last; ++b) {
          verify::Random random(seed * 0x9e3779b97f4a7c15ULL + b);
          for (std::uint64_t i = b * block; i < std::min(rays, (b + 1) * block); ++i) try_one(random, wrong);
        }
        return wrong;
      },
      [](Wrong a, const Wrong& b) { return a += b; });
}

Wrong wrong_primary(Precision precision, std::uint64_t rays, std::uint64_t seed) {
  const bool exact = precision == Precision::exact;
  return count_wrong(rays, seed, [&](verify::Random& random, Wrong& wrong) {
    const verify::AimedTriangle aimed = verify::aimed_triangle(random);
    const auto truth = verify::rational_triangle(aimed.origin, aimed.direction, aimed.corners);
    // The exact test alone is asked for the sign of t (verify/case_rational.cpp).
    const bool meets = truth.meets && (truth.ahead || !exact);
    ++wrong.tried;
    if (verify::kernel_meets(precision, aimed) == meets) return;
    if (exact || verify::roundings_from_edge(aimed, truth) > verify::roundings_of_an_edge)
      ++wrong.wrong;
    else
      ++wrong.open;
  });
}

Wrong wrong_shadow(Precision precision, std::uint64_t rays, std::uint64_t seed) {
  const verify::AdversarialShadows shadows(seed);
  const Tracer tracer(shadows.world(), raytrace::Accel::bvh, precision);
  return count_wrong(rays, seed, [&](verify::Random& random, Wrong& wrong) {
    const auto point = shadows.receiver(random);
    if (!point) return;
    const PointVisibility found = tracer.centre_visibility(*point, shadows.light());
    ++wrong.tried;
    if (found == PointVisibility::uncertain)
      ++wrong.open;
    else
      wrong.wrong += (found == PointVisibility::shadowed) != shadows.shadowed(*point) ? 1 : 0;
  });
}

std::string table(const BenchInput& input, std::uint64_t rays, std::span<const MeasuredPrecision> all) {
  std::string text = fmt::format(
      "{}: {} primitives, {} x {}, {} threads; wrong of {} aimed rays of each kind, scaled to 1e8\n"
      "{:<10}{:>15}{:>9}{:>12}{:>9}{:>18}{:>13}{:>16}{:>12}\n"
      "{:<10}{:>15}{:>9}{:>12}{:>9}{:>18}{:>13}{:>16}{:>12}\n",
      one_line(input.scene.name), input.world.primitive_count(), input.size.width, input.size.height,
      input.threads, rays, "", "rendered", "shadow", "one by one", "shadow", "triangles wrong", "by rounding",
      "shadows wrong", "uncertain", "precision", "primary Mray/s", "Mray/s", "primary", "Mray/s", "per 1e8",
      "per 1e8", "per 1e8", "per 1e8");
  for (const MeasuredPrecision& m : all)
    text +=
        fmt::format("{:<10}{:>15.2f}{:>9.2f}{:>12.2f}{:>9.2f}{:>18.0f}{:>13.0f}{:>16.0f}{:>12.0f}\n",
                    precision_name(m.precision), m.rendered.primary, m.rendered.shadow, m.single.primary,
                    m.single.shadow, m.primary.per_1e8(m.primary.wrong), m.primary.per_1e8(m.primary.open),
                    m.shadow.per_1e8(m.shadow.wrong), m.shadow.per_1e8(m.shadow.open));
  return text +
         "by rounding: rays within 64 roundings of an edge of a single triangle, decided as rounding falls;\n"
         "robust decides alike for both triangles of an edge, so that no ray slips between them.\n"
         "fast has no packets: rendered, its rays go one by one as well.\n";
}

void add_rows(const BenchInput& input, const MeasuredPrecision& m, const MeasuredPrecision* base,
              std::optional<double> goal, std::vector<BenchRow>& rows) {
  const auto add = [&](const char* what, double value, const char* unit) -> BenchRow& {
    rows.push_back({.name = fmt::format("{}, {}", precision_name(m.precision), what),
                    .scene = input.scene.name,
                    .threads = input.threads,
                    .value = value,
                    .unit = unit,
                    .more_is_better = std::string_view(unit) == "Mrays/s"});
    return rows.back();
  };
  const auto speed = [&](const char* what, const Speed MeasuredPrecision::*which, double Speed::*kind) {
    BenchRow& row = add(what, m.*which.*kind, "Mrays/s");
    if (base == nullptr) return;
    row.peer = BenchPeer{std::string(precision_name(base->precision)), base->*which.*kind};
    row.goal = goal;
  };
  speed("primary rays", &MeasuredPrecision::rendered, &Speed::primary);
  speed("shadow rays", &MeasuredPrecision::rendered, &Speed::shadow);
  speed("primary rays one by one", &MeasuredPrecision::single, &Speed::primary);
  speed("shadow rays one by one", &MeasuredPrecision::single, &Speed::shadow);
  add("wrong triangles per 1e8", m.primary.per_1e8(m.primary.wrong), "rays");
  add("edges by rounding per 1e8", m.primary.per_1e8(m.primary.open), "rays");
  add("wrong shadows per 1e8", m.shadow.per_1e8(m.shadow.wrong), "rays");
}

}  // namespace

BenchResult bench_precisions(const BenchInput& input, std::uint64_t rays, std::uint64_t seed) {
  std::vector<MeasuredPrecision> all;
  for (const Precision precision : {Precision::fast, Precision::robust, Precision::exact}) {
    input.progress(std::string(precision_name(precision)), static_cast<double>(all.size()) / 3.0);
    const Tracer tracer(input.world, raytrace::Accel::bvh, precision);
    MeasuredPrecision m{.precision = precision, .rendered = {}, .single = {}, .primary = {}, .shadow = {}};
    m.rendered = speed_rendered(input, tracer), m.single = speed_single(input, tracer);
    m.primary = wrong_primary(precision, rays, seed), m.shadow = wrong_shadow(precision, rays, seed);
    all.push_back(m);
  }
  BenchResult result{table(input, rays, all), {}};
  constexpr std::optional<double> goals[] = {std::nullopt, 0.9, 0.5};
  for (std::size_t i = 0; i < all.size(); ++i)
    add_rows(input, all[i], i == 0 ? nullptr : &all[i - 1], goals[i], result.rows);
  return result;
}

}  // namespace gnomon::bench

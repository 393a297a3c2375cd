// The hybrid's hard shadows against pure ray tracing of the same receivers, in turn: rays, triangles tested,
// and time. Rows are of a new light as the cost estimate has it, with the sheets built again, and with the sheets kept.
// An error when the two differ.
#include <fmt/core.h>

#include <atomic>

#include "benchmark/row.h"
#include "hybrid/hard_shadows.h"
#include "raytrace/frame.h"
#include "raytrace/tiles.h"
#include "scene/base/expected.h"
#include "scene/base/parallel.h"

namespace gnomon::bench {
namespace {

using hybrid::Decision;
using hybrid::LightCache;
using hybrid::Sheets;
using raytrace::PointVisibility;
using raytrace::SurfacePoint;

constexpr int map_size = 1024;  // texels, as the goals have it

class HybridBench {
 public:
  HybridBench(const BenchInput& input, std::uint32_t light)
      : input_(input),
        world_(input.world),
        light_(input.scene.lights[light]),
        tracer_(world_, raytrace::Accel::bvh),
        topology_(world_),
        pure_(input.size),
        decisions_(input.size) {
    raytrace::RaytraceOptions options;
    options.size = input.size, options.picture = false;
    receivers_ =
        raytrace::make_receivers(trace_frame(tracer_, input.plan, input.scene.camera, {}, options).receiver);
  }

  Expected<BenchResult> run() {
    const Camera& camera = input_.scene.camera;
    const auto view =
        fit_light_view(world_, light_, camera, double(input_.size.width) / input_.size.height, map_size);
    if (!view) return fail(view.error());
    Runs times;
    for (int run = 0; run <= input_.runs; ++run) {  // the first warms up
      Runs now;
      if (auto ok = run_once(*view, run % 2 == 0, now); !ok) return fail(ok.error());
      if (run > 0) times.append(now);
    }
    static_cast<void>(trace_hard_shadows(tracer_, *cache_, receivers_, visibility_, &decisions_));
    return result(times);
  }

 private:
  struct Runs {
    Times by_cost, at_once, kept, pure;
    void append(const Runs& now) {
      const auto add = [](Times& times, const Times& more) { times.runs.push_back(more.runs[0]); };
      add(by_cost, now.by_cost), add(at_once, now.at_once), add(kept, now.kept);
      add(pure, now.pure);
    }
  };

  /// Who comes first finds other things in the caches: so the two take turns. Both free what they made.
  Expected<void> run_once(const LightView& view, bool pure_first, Runs& now) {
    const auto trace = [&] {
      counts_ = trace_hard_shadows(tracer_, *cache_, receivers_, visibility_, nullptr);
    };
    const auto renew = [&](Sheets when) {
      cache_.emplace(tracer_, topology_, light_, view, when);
      trace();
    };
    const auto pure = [&] { time_run(now.pure, [&] { trace_all(); }); };
    cache_.reset();
    if (pure_first) pure();
    time_run(now.by_cost, [&] { renew(Sheets::when_they_pay), cache_.reset(); });
    if (!pure_first) pure();
    new_light_rays_ = counts_.rays;
    std::size_t wrong = differences();
    time_run(now.at_once, [&] { renew(Sheets::at_once); });
    wrong += differences();
    time_run(now.kept, trace);
    wrong += differences();
    if (wrong == 0) return {};
    return fail(ErrorKind::internal, fmt::format("hybrid and ray tracing disagree on {} pixels", wrong));
  }

  void trace_all() { trace_shadows(tracer_, receivers_, light_, pure_); }

  // Where there is a receiver and the ray tracer is certain.
  std::size_t differences() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pure_.data.size(); ++i)
      count += receivers_.points.data[i].primitive != no_id && pure_.data[i] != PointVisibility::uncertain &&
                       pure_.data[i] != visibility_.data[i]
                   ? 1
                   : 0;
    return count;
  }

  /// By single rays: for those cast, and for all.
  std::pair<std::uint64_t, std::uint64_t> triangle_tests() const {
    std::atomic<std::uint64_t> cast = 0, all = 0;
    parallel_for(input_.size.height, [&](int y) {
      for (int x = 0; x < input_.size.width; ++x) {
        const Decision decision = decisions_.at(x, y);
        if (decision == Decision::not_asked) continue;
        raytrace::WorkCounts work;
        static_cast<void>(tracer_.occluded(tracer_.shadow_ray(receivers_.points.at(x, y), light_), work));
        all += work.primitives;
        if (decision == Decision::traced) cast += work.primitives;
      }
    });
    return {cast, all};
  }

  BenchResult result(const Runs& times) const {
    const auto [cast, all] = triangle_tests();
    const double pure = times.pure.median();
    const auto row = [&](std::string name, double value, std::string unit, std::string peer,
                         double peer_value, std::optional<double> goal) {
      return BenchRow{std::move(name),
                      input_.scene.name,
                      input_.threads,
                      value,
                      std::move(unit),
                      false,
                      BenchPeer{std::move(peer), peer_value},
                      goal};
    };
    const std::string tracing = "ray tracing";
    const double asked = double(counts_.asked), goal_rays = input_.scene.name == "courtyard" ? 0.08 : 0.03;
    BenchResult out;
    out.rows = {
        row("hybrid shadow rays", double(counts_.rays), "rays", tracing, asked, 1.0 / goal_rays),
        row("hybrid shadow rays, a new light by cost", double(new_light_rays_), "rays", tracing, asked, {}),
        row("hybrid triangle tests", double(cast), "triangles", tracing, double(all), {}),
        row("hybrid shadows, a new light by cost", times.by_cost.median(), "ms", tracing, pure, 1.0),
        row("hybrid shadows, sheets built anew", times.at_once.median(), "ms", tracing, pure, {}),
        row("hybrid shadows, sheets kept", times.kept.median(), "ms", tracing, pure, 2.0)};
    out.table = fmt::format(
        "{}: hybrid hard shadows of {}, {} x {} pixels, {}² map: the same as ray tracing at every pixel\n"
        "  {} of {} shadow rays ({:.2f} %), {:.2f} % of the triangle tests; surely lit {:.2f} %, surely "
        "shadowed {:.2f} %\n"
        "  {:.1f} ms with the sheets kept, {:.1f} ms with the sheets built anew ({:.1f} MiB); ray tracing "
        "{:.1f} ms\n"
        "  a new light, whose sheets are made from frame {} on by the estimate of costs: {:.1f} ms, {:.2f} % "
        "of the rays\n",
        one_line(input_.scene.name), one_line(light_.name), input_.size.width, input_.size.height, map_size,
        counts_.rays, counts_.asked, percent(counts_.rays, counts_.asked), percent(cast, all),
        percent(counts_.lit, counts_.asked), percent(counts_.shadowed, counts_.asked), times.kept.median(),
        times.at_once.median(), static_cast<double>(cache_->bytes()) / 1048576.0, pure,
        cache_->frames_to_pay(receivers_.points.data.size()) + 1, times.by_cost.median(),
        percent(new_light_rays_, counts_.asked));
    return out;
  }
  static double percent(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  }

  const BenchInput& input_;
  const World& world_;
  const Light& light_;
  raytrace::Tracer tracer_;
  raytrace::Topology topology_;
  raytrace::Receivers receivers_;
  Image<PointVisibility> pure_, visibility_;
  Image<Decision> decisions_;
  std::optional<LightCache> cache_;
  hybrid::ShadowCounts counts_;
  std::uint64_t new_light_rays_ = 0;
};

}  // namespace

Expected<BenchResult> bench_hybrid(const BenchInput& input) {
  if (input.scene.lights.empty()) return BenchResult{};
  input.progress("hybrid", 1.0);
  return HybridBench(input, 0).run();
}

}  // namespace gnomon::bench

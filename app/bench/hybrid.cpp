// The hybrid's hard shadows against pure ray tracing of the same receivers, in turn: rays, triangles tested,
// and time with the sheets built anew and with the sheets kept. An error when the two differ.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "app/bench/row.h"
#include "hybrid/hard_shadows.h"
#include "raytrace/frame.h"
#include "raytrace/tiles.h"

namespace gnomon::app {
namespace {

using hybrid::Decision;
using hybrid::LightCache;
using raytrace::SurfacePoint;
using raytrace::Verdict;

constexpr int map_size = 1024;  // texels, as the goals have it

class HybridBench {
 public:
  HybridBench(const BenchInput& input, std::uint32_t light)
      : input_(input),
        world_(*input.loaded.world),
        light_(input.loaded.scene->lights[light]),
        tracer_(world_, raytrace::Accel::bvh),
        topology_(world_),
        pure_(input.size),
        decisions_(input.size) {
    raytrace::RaytraceOptions options;
    options.size = input.size, options.picture = false;
    receivers_ = hybrid::make_receivers(
        trace_frame(tracer_, input.loaded.plan, input.loaded.scene->camera, {}, options).receiver);
  }

  Expected<BenchResult> run() {
    const Camera& camera = input_.loaded.scene->camera;
    const auto view =
        fit_light_view(world_, light_, camera, double(input_.size.width) / input_.size.height, map_size);
    if (!view) return fail(view.error());
    Times build, kept, pure;
    std::optional<LightCache> cache;
    for (int run = 0; run <= input_.runs; ++run) {  // the first warms up
      Times build_now, kept_now, pure_now;
      const auto trace = [&] {
        counts_ = trace_hard_shadows(tracer_, *cache, receivers_, verdicts_, nullptr);
      };
      time_run(build_now, [&] {
        cache.emplace(tracer_, topology_, light_, *view);
        trace();
      });
      time_run(kept_now, trace);
      time_run(pure_now, [&] { trace_all(); });
      if (run == 0) continue;
      build.runs.push_back(build_now.runs[0]);
      kept.runs.push_back(kept_now.runs[0]), pure.runs.push_back(pure_now.runs[0]);
    }
    static_cast<void>(trace_hard_shadows(tracer_, *cache, receivers_, verdicts_, &decisions_));
    if (const std::size_t wrong = differences(); wrong > 0)
      return fail(ErrorKind::internal, fmt::format("hybrid and ray tracing disagree on {} pixels", wrong));
    return result(build, kept, pure, cache->bytes());
  }

 private:
  void trace_all() {
    const raytrace::Structures& s = tracer_.structures();
    const raytrace::TileGrid grid{input_.size};
    if (!packets_apply(s)) {
      for_each_pixel(grid, [&](int x, int y, std::size_t) {
        const SurfacePoint& p = receivers_.points.at(x, y);
        pure_.at(x, y) = p.primitive == no_id ? Verdict::lit : tracer_.light_verdict(p, light_);
      });
      return;
    }
    const raytrace::Sight sight = sight_of_light(s, light_, receivers_.compact());
    const raytrace::ReceiverSource source{.tracer = tracer_, .stored = &receivers_.points};
    for_each_tile(grid, [&](std::size_t i, int x0, int y0, int x1, int y1) {
      shadow_tile(source, light_, sight, {x0, y0, x1, y1}, &receivers_.tiles[i], pure_);
    });
  }

  // Where the ray tracer is certain.
  std::size_t differences() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < pure_.data.size(); ++i)
      count += decisions_.data[i] != Decision::not_asked && pure_.data[i] != Verdict::uncertain &&
                       pure_.data[i] != verdicts_.data[i]
                   ? 1
                   : 0;
    return count;
  }

  /// By single rays: for those cast, and for all.
  std::pair<std::uint64_t, std::uint64_t> triangle_tests() const {
    std::atomic<std::uint64_t> cast = 0, all = 0;
    tbb::parallel_for(0, input_.size.height, [&](int y) {
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

  BenchResult result(const Times& build, const Times& kept, const Times& pure, std::uint64_t bytes) const {
    const auto [cast, all] = triangle_tests();
    const std::string tracing = "ray tracing";
    const auto row = [&](std::string name, double value, std::string unit, double peer,
                         std::optional<double> goal) {
      return BenchRow{std::move(name), input_.scene, input_.threads,           value,
                      std::move(unit), false,        BenchPeer{tracing, peer}, goal};
    };
    BenchResult out;
    out.rows = {row("hybrid shadow rays", double(counts_.rays), "rays", double(counts_.asked), 1.0 / 0.03),
                row("hybrid triangle tests", double(cast), "triangles", double(all), std::nullopt),
                row("hybrid shadows, sheets built anew", build.median(), "ms", pure.median(), 1.0),
                row("hybrid shadows, sheets kept", kept.median(), "ms", pure.median(), 2.0)};
    out.table = fmt::format(
        "{}: hybrid hard shadows of {}, {} x {} pixels, {}² map: the same as ray tracing at every pixel\n"
        "  {} of {} shadow rays ({:.2f} %), {:.2f} % of the triangle tests; surely lit {:.2f} %, surely "
        "shadowed "
        "{:.2f} %\n"
        "  {:.1f} ms with the sheets kept, {:.1f} ms with the sheets built anew ({:.1f} MiB); ray tracing "
        "{:.1f} ms\n",
        input_.scene, light_.name, input_.size.width, input_.size.height, map_size, counts_.rays,
        counts_.asked, percent(counts_.rays, counts_.asked), percent(cast, all),
        percent(counts_.lit, counts_.asked), percent(counts_.shadowed, counts_.asked), kept.median(),
        build.median(), static_cast<double>(bytes) / 1048576.0, pure.median());
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
  hybrid::Receivers receivers_;
  Image<Verdict> pure_, verdicts_;
  Image<Decision> decisions_;
  hybrid::ShadowCounts counts_;
};

}  // namespace

Expected<BenchResult> bench_hybrid(const BenchInput& input) {
  if (input.loaded.scene->lights.empty()) return BenchResult{};
  input.progress("hybrid", 1.0);
  return HybridBench(input, 0).run();
}

}  // namespace gnomon::app

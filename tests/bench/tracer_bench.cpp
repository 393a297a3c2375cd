#include "tracer_bench.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <string_view>

#include "bench_support.h"
#include "embree_peer.h"
#include "instruction_set.h"
#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/shadow_pass.h"
#include "raytrace/tiles.h"
#include "raytrace/tracer.h"
#include "scene/light_map/light_view.h"

namespace gnomon::bench {
namespace {

using raytrace::Accel;
using raytrace::HugeArray;
using raytrace::PacketUse;
using raytrace::PointVisibility;
using raytrace::QuantisedTile;
using raytrace::RayTracedFrame;
using raytrace::Tracer;

std::string embree_settings(const Settings& settings) {
  return settings.target.empty() ? std::string() : instruction_sets().at(settings.target).embree;
}

constexpr std::uint64_t a_million = 1'000'000;

class Bench {
 public:
  Bench(const BenchScene& scene, const Settings& settings)
      : scene_(scene),
        settings_(settings),
        world_(make_world(scene.scene)),
        tracer_(world_, Accel::bvh),
        embree_(world_, embree_settings(settings)),
        tiny_(make_tiny_bvh(world_)),
        view_(make_view(scene.scene.camera, settings.size)),
        primary_(primary_rays(view_)),
        grid_{settings.size},
        hits_(grid_.count()),
        tiles_(grid_.count()) {
    frame_ = trace({0, 1});
    for (const Light& light : scene.scene.lights)
      shadow_.push_back(shadow_rays(frame_, light, world_.finite_bounds.diagonal()));
  }

  std::vector<BenchRow> run() {
    fmt::print(settings_.table(), "{}: {} triangles{}, {} x {}\n", scene_.name, world_.triangle_count(),
               world_.keeps_instances() ? " by kept instances, as Embree's instances" : "",
               settings_.size.width, settings_.size.height);
    check_hits();
    for (std::size_t i = 0; i < 2; ++i) check_shadows(i);
    for (const int threads : {1, 2}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
      primary(threads), shadows(0, threads), shadows(1, threads);
    }
    two_threads(), mirrors(), ball_light(), map_fits(), memory();
    whole_frame();
    return rows_;
  }

 private:
  RayTracedFrame trace(const std::vector<std::uint32_t>& lights) const {
    raytrace::RaytraceOptions options;
    options.size = settings_.size, options.picture = false;
    return trace_frame(tracer_, plan_effects(scene_.scene), scene_.scene.camera, lights, options);
  }

  void add(std::string name, int threads, double rays, std::pair<double, double> ms, std::string peer,
           std::optional<double> goal) {
    add({.name = std::move(name),
         .scene = scene_.name,
         .threads = threads,
         .value = rays / ms.first * 1e-3,
         .unit = "Mrays/s",
         .peer = BenchPeer{std::move(peer), rays / ms.second * 1e-3},
         .goal = goal});
  }
  /// Adds a row of which less is better: ours and the peer's.
  void add_cost(std::string name, int threads, std::string unit, std::pair<double, double> both,
                std::string peer, std::optional<double> goal) {
    add({.name = std::move(name),
         .scene = scene_.name,
         .threads = threads,
         .value = both.first,
         .unit = std::move(unit),
         .more_is_better = false,
         .peer = BenchPeer{std::move(peer), both.second},
         .goal = goal});
  }
  void add(BenchRow row) {
    show(settings_.table(), row);
    rows_.push_back(std::move(row));
  }

  /// Which primitive each pixel sees, as far as floats can tell.
  void our_hits() {
    primary_pass(tracer_, view_, edge_setup_of_eye(tracer_, view_),
                 {.size = view_.size, .hits = hits_, .receivers = nullptr, .quantised = {}});
  }
  /// What `compare` does: a fresh eye, receivers in double and quantised.
  void our_receivers() {
    primary_pass(tracer_, view_, edge_setup_of_eye(tracer_, view_),
                 {.size = view_.size,
                  .hits = {},
                  .receivers = &frame_.receiver,
                  .quantised = {tiles_.data(), tiles_.size()}});
  }
  /// What `raytrace` does: the primitives, and receivers quantised.
  void our_quantised_receivers() {
    primary_pass(tracer_, view_, edge_setup_of_eye(tracer_, view_),
                 {.size = view_.size,
                  .hits = hits_,
                  .receivers = nullptr,
                  .quantised = {tiles_.data(), tiles_.size()}});
  }
  /// A fresh light, after our_receivers().
  void our_shadows(std::size_t light, PacketUse packets = PacketUse::where_cheaper) {
    our_shadows(light, {.tracer = tracer_,
                        .size = settings_.size,
                        .stored = &frame_.receiver,
                        .quantised = {tiles_.data(), tiles_.size()},
                        .packets = packets});
  }
  /// Traces shadows after our_quantised_receivers().
  void our_shadows_on_quantised(std::size_t light) {
    our_shadows(light, {.tracer = tracer_,
                        .size = settings_.size,
                        .stored = nullptr,
                        .view = &view_,
                        .hits = hits_,
                        .quantised = {tiles_.data(), tiles_.size()}});
  }
  void our_shadows(std::size_t light, const raytrace::PictureReceivers& receivers) {
    shadow_pass(receivers, scene_.scene.lights[light], frame_.lights[light].centre);
  }

  void primary(int threads) {
    const auto rays = static_cast<double>(primary_.count);
    const auto against = [&](const char* name, const auto& ours, const auto& theirs, const char* peer,
                             std::optional<double> goal) {
      add(name, threads, rays, in_turn(settings_.runs, threads, ours, theirs), peer, goal);
    };
    const auto packets = [&] { embree_.closest_packets(primary_, peer_); };
    against(
        "primary, hits alone", [&] { our_hits(); }, packets, "Embree 16 coherent", std::nullopt);
    if (threads > 1) return;
    against(
        "primary, hits alone", [&] { our_hits(); }, [&] { embree_.closest_single(primary_, peer_); },
        "Embree single", std::nullopt);
    if (tiny_ != nullptr)
      against(
          "primary, hits alone", [&] { our_hits(); }, [&] { tiny_->closest(primary_, peer_); },
          "tinybvh single", std::nullopt);
    // The rows above say which primitive alone; Embree says how far it is and where on it as well. These say its place and
    // its normal.
    against(
        "primary, raytrace's receivers", [&] { our_quantised_receivers(); }, packets, "Embree 16 coherent",
        std::nullopt);
    against(
        "primary, compare's receivers", [&] { our_receivers(); }, packets, "Embree 16 coherent",
        std::nullopt);
  }

  /// Whether they are smaller than pixels, so that most of a tile's pixels have triangles of their own.
  bool has_tiny_triangles() const { return world_.triangle_count() > 2 * a_million; }

  void shadows(std::size_t light, int threads) {
    const std::string name = light == 0 ? "point shadow" : "sun shadow";
    const auto rays = static_cast<double>(shadow_[light].count);
    our_receivers();
    const auto packets = [&] { embree_.occluded_packets(shadow_[light], occluded_); };
    const auto ours = [&] { our_shadows(light); };
    add(name, threads, rays, in_turn(settings_.runs, threads, ours, packets), "Embree 16 coherent",
        has_tiny_triangles() ? std::nullopt : std::optional(1.2));
    if (threads > 1) return;
    add(name, threads, rays,
        in_turn(settings_.runs, threads, ours, [&] { embree_.occluded_single(shadow_[light], occluded_); }),
        "Embree single", std::nullopt);
    if (tiny_ != nullptr)
      add(name, threads, rays,
          in_turn(settings_.runs, threads, ours, [&] { tiny_->occluded(shadow_[light], occluded_); }),
          "tinybvh single", std::nullopt);
    choice(name, light);
  }

  /// What a tile's choice between packets and single rays is worth: against either alone, once what single rays need is
  /// there. Ways that are equal differ by a tenth from run to run.
  void choice(const std::string& name, std::size_t light) {
    for (const auto& [way, peer] :
         {std::pair{PacketUse::always, "packets alone"}, std::pair{PacketUse::never, "single rays alone"}})
      add(name + ", as chosen", 1, static_cast<double>(shadow_[light].count),
          in_turn(
              settings_.runs, 1, [&] { our_shadows(light); }, [&, way = way] { our_shadows(light, way); }),
          peer, 0.9);
  }

  /// Runs the same pass on one thread and on two; both are timed by the wall clock.
  void two_threads() {
    our_receivers();
    const auto row = [&](const std::string& name, double rays, const auto& pass) {
      const auto on = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        pass();
      };
      const auto ms = in_turn(
          settings_.runs, 2, [&] { on(2); }, [&] { on(1); });
      add(name, 2, rays, ms, "one thread", std::nullopt);
    };
    row("primary, compare's receivers", static_cast<double>(primary_.count), [&] { our_receivers(); });
    row("point shadow", static_cast<double>(shadow_[0].count), [&] { our_shadows(0); });
  }

  /// One ray at a time, here and there.
  void mirrors() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const PeerRays rays = mirror_rays(frame_, view_, world_.finite_bounds.diagonal());
    std::vector<Ray> ours;
    for (std::size_t i = 0; i < rays.count; ++i)
      ours.push_back(
          {Vec3(Vec3f(rays.ox[i], rays.oy[i], rays.oz[i])), Vec3(Vec3f(rays.dx[i], rays.dy[i], rays.dz[i]))});
    std::size_t hits = 0;
    const auto trace = [&] {
      hits = 0;
      for (const Ray& ray : ours) hits += tracer_.closest_hit(ray) ? 1 : 0;
    };
    const auto against = [&](const char* peer, const auto& closest) {
      const auto ms = in_turn(settings_.runs, 1, trace, closest);
      std::size_t theirs = 0;
      for (std::size_t i = 0; i < rays.count; ++i) theirs += peer_.primitive[i] != no_id ? 1 : 0;
      fmt::print(settings_.table(), "  mirrored rays that hit: {} here, {} by {}\n", hits, theirs, peer);
      add("mirrored rays, one by one", 1, static_cast<double>(rays.count), ms, peer, std::nullopt);
    };
    against("Embree single", [&] { embree_.closest_single(rays, peer_); });
    if (tiny_ != nullptr) against("tinybvh single", [&] { tiny_->closest(rays, peer_); });
  }

  void ball_light() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const BallLight light(tracer_, frame_, scene_.scene.lights[0]);
    double with_shaft = 0.0, by_rays = 0.0;
    const auto ms = in_turn(
        std::min(settings_.runs, 3), 1, [&] { with_shaft = light.share_by_shaft(); },
        [&] { by_rays = light.share_by_every_ray(); });
    fmt::print(settings_.table(), "  mean share of the ball seen: {} with the shaft, {} by every ray\n",
               with_shaft, by_rays);
    add("ball light, 64 samples", 1, light.rays(), ms, "every ray cast", std::nullopt);
  }

  /// The fit of a map to its casters, and the same where every triangle is asked.
  void map_fits() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
    World all = world_;
    for (TriangleBlock& block : all.blocks) block.bounds = {Vec3(-1e100), Vec3(1e100)};
    const double aspect = static_cast<double>(settings_.size.width) / settings_.size.height;
    for (std::size_t i = 0; i < 2; ++i) {
      LightView by_blocks, by_all;
      const auto fit = [&](const World& world) {
        return must(fit_light_view(world, scene_.scene.lights[i], scene_.scene.camera, aspect, 1024));
      };
      const auto ms = in_turn(
          settings_.runs, 2, [&] { by_blocks = fit(world_); }, [&] { by_all = fit(all); });
      const auto depths = [](const LightView& view) { return view.face(0).far_depth; };
      fmt::print(settings_.table(), "  far depth of the map: {} by blocks, {} by every triangle\n",
                 depths(by_blocks), depths(by_all));
      add_cost(i == 0 ? "fit of a point light's map" : "fit of a sun's map", 2, "ms", ms,
               "every triangle asked", std::nullopt);
    }
  }

  /// Measures the memory of all that packets need, and of the tree that many single rays make.
  void memory() {
    const double theirs = 0x1p-20 * static_cast<double>(embree_.bytes());
    const auto row = [&](const char* name, std::uint64_t bytes) {
      add_cost(name, 1, "MiB", {0x1p-20 * static_cast<double>(bytes), theirs}, "Embree medium", 1.0);
    };
    row("memory of the structure", tracer_.stats().bytes);
    row("memory, with single rays", tracer_.stats().bytes + single_ray_bytes(tracer_));
  }

  void whole_frame() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
    Times build, peer_build;
    const auto frame = [&](const auto& ours) {
      return in_turn(
          settings_.runs, 2,
          [&] {
            const Stopwatch watch;
            Tracer fresh(world_, Accel::bvh);
            build.runs.push_back(watch.elapsed_ms());
            tracer_ = std::move(fresh);
            ours();
          },
          [&] {
            const Stopwatch watch;
            const Embree embree(world_, embree_settings(settings_));
            peer_build.runs.push_back(watch.elapsed_ms());
            embree.closest_packets(primary_, peer_), embree.occluded_packets(shadow_[0], occluded_);
          });
    };
    const auto of_compare = frame([&] { our_receivers(), our_shadows(0); });
    const auto of_raytrace = frame([&] { our_quantised_receivers(), our_shadows_on_quantised(0); });
    const auto row = [&](std::string name, std::pair<double, double> ms_of_both, std::string peer,
                         std::optional<double> goal) {
      add_cost(std::move(name), 2, "ms", ms_of_both, std::move(peer), goal);
    };
    row("build", {build.median(), peer_build.median()}, "Embree medium", 1.2);
    const auto with_single = in_turn(
        settings_.runs, 2, [&] { raytrace::prepare_single_rays(Tracer(world_, Accel::bvh)); },
        [&] { const Embree embree(world_, embree_settings(settings_)); });
    row("build, with single rays", with_single, "Embree medium", std::nullopt);
    const double goal = world_.triangle_count() < a_million ? 1.0 : 1.3;
    row("whole frame, raytrace's receivers", of_raytrace, "Embree medium, packets", goal);
    row("whole frame, compare's receivers", of_compare, "Embree medium, packets", goal);
  }

  // Receivers against Embree's hits; how many pixels the floats left to double.
  void check_hits() {
    std::size_t ours = 0, theirs = 0, differ = 0, ambiguous = 0;
    our_hits();
    for (int y = 0; y < settings_.size.height; ++y)
      for (int x = 0; x < settings_.size.width; ++x) {
        const std::size_t at = place(x, y);
        ambiguous +=
            hits_[at / raytrace::tile_rays].leaf[at % raytrace::tile_rays] == raytrace::ambiguous_hit ? 1 : 0;
      }
    our_receivers(), embree_.closest_packets(primary_, peer_);
    const double tolerance = 1e-4 * world_.finite_bounds.diagonal();
    for (int y = 0; y < settings_.size.height; ++y)
      for (int x = 0; x < settings_.size.width; ++x) {
        const std::size_t at = place(x, y);
        const auto& point = frame_.receiver.at(x, y);
        const bool a = point.primitive != no_id, b = peer_.primitive[at] != RTC_INVALID_GEOMETRY_ID;
        ours += a ? 1 : 0, theirs += b ? 1 : 0;
        const double t = a ? glm::length(point.position - view_.eye) : 0.0;
        differ += a != b || (a && std::abs(t - static_cast<double>(peer_.t[at])) > tolerance) ? 1 : 0;
      }
    fmt::print(
        settings_.table(),
        "  hits: {} here, {} by Embree; {} of {} rays hit another surface (silhouettes, float's rounding); "
        "{} decided in double\n",
        ours, theirs, differ, primary_.count, ambiguous);
  }
  std::size_t place(int x, int y) const {
    const std::size_t tile =
        static_cast<std::size_t>(y / 16) * grid_.columns() + static_cast<std::size_t>(x / 16);
    return tile * raytrace::tile_rays + raytrace::tile_lane(x % 16, y % 16);
  }
  void check_shadows(std::size_t light) {
    embree_.occluded_packets(shadow_[light], occluded_);
    std::size_t ours = 0, theirs = 0, differ = 0;
    for (int y = 0; y < settings_.size.height; ++y)
      for (int x = 0; x < settings_.size.width; ++x) {
        const std::size_t at = place(x, y);
        if (shadow_[light].valid[at] == 0) continue;
        const bool a = frame_.lights[light].centre.at(x, y) == PointVisibility::shadowed,
                   b = occluded_[at] != 0;
        ours += a ? 1 : 0, theirs += b ? 1 : 0, differ += a != b ? 1 : 0;
      }
    fmt::print(
        settings_.table(),
        "  {} occluded: {} here, {} by Embree; {} of {} rays differ (its rays start 2^-14 off the surface)\n",
        light == 0 ? "point" : "sun", ours, theirs, differ, shadow_[light].count);
  }

  const BenchScene& scene_;
  const Settings& settings_;
  World world_;
  Tracer tracer_;
  Embree embree_;
  std::unique_ptr<TinyBvh> tiny_;
  View view_;
  PeerRays primary_;
  std::vector<PeerRays> shadow_;
  raytrace::TileGrid grid_;
  std::vector<raytrace::TileHits> hits_;
  HugeArray<QuantisedTile> tiles_;
  RayTracedFrame frame_;
  PeerHits peer_;
  std::vector<std::uint8_t> occluded_;
  std::vector<BenchRow> rows_;
};

}  // namespace

std::vector<BenchRow> bench_tracer(const BenchScene& scene, const Settings& settings) {
  return Bench(scene, settings).run();
}

}  // namespace gnomon::bench

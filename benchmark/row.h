// What gnomon bench measures, row by row, and how the rows are shown. A producer measures one topic on one
// scene.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison.h"
#include "raytrace/tracer.h"
#include "scene/effects.h"
#include "scene/image.h"
#include "scene/world.h"

namespace gnomon::bench {

/// Called with what is measured and the share that is done, in [0, 1].
using Progress = std::function<void(const std::string&, double)>;

struct BenchPeer {
  std::string name;
  double value = 0.0;
};

struct BenchRow {
  std::string name{}, scene{};
  int threads = 0;
  double value = 0.0;
  std::string unit{};
  bool more_is_better = true;
  std::optional<BenchPeer> peer{};
  std::optional<double> goal{};  ///< of the ratio
  /// The power of what grows by which the value grows from the peer, a smaller one of a series.
  std::optional<double> exponent{};

  /// Above 1: better than the peer; none without a peer, or where it would divide by 0.
  std::optional<double> ratio() const;
  /// Whether the ratio reaches the goal; none without a peer or a goal. True where the ratio would divide by 0: nothing
  /// can be better.
  std::optional<bool> met() const;
};

struct BenchInput {
  const Scene& scene;
  const World& world;
  const EffectPlan& plan;
  ImageSize size{};
  int runs = 3;
  int threads = 0;
  std::vector<raytrace::Accel> accels;
  Progress progress;
};

struct BenchResult {
  std::string table;  ///< for people
  std::vector<BenchRow> rows;
};

/// gnomon/bench/1. `target`: the instruction set in use, where it is a matter of the rows.
std::string bench_json(std::span<const BenchRow> rows, const compare::MachineInfo& machine,
                       std::string_view target = {});

/// Every structure on the same rays: build time, memory, work per ray, rays per second. An error when two
/// structures see different things.
Expected<BenchResult> bench_structures(const BenchInput& input);

/// Rays, triangle tests and time of the hybrid's hard shadows against ray tracing, for the scene's first
/// light.
Expected<BenchResult> bench_hybrid(const BenchInput& input);

/// What accuracy costs: for each precision the rays per second on the scene, and the wrong shadows among
/// `rays` adversarial ones of each kind, judged by rational numbers.
BenchResult bench_precisions(const BenchInput& input, std::uint64_t rays, std::uint64_t seed);

}  // namespace gnomon::bench

#include "scale_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include "bench_scenes.h"
#include "bench_support.h"
#include "command_cost.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::bench {
namespace {

/// One comparison of a series; `amount` is what grows.
struct Step {
  double amount;
  std::string name;
  std::function<Words()> words;
};

class ScaleBench {
 public:
  explicit ScaleBench(const Settings& settings) : settings_(settings) {}

  std::vector<BenchRow> run() {
    fmt::print(settings_.table(), "How comparisons grow, one run each\n");
    series("triangles", {terrain(708), terrain(2237), terrain(3163)});
    series("pixels", {picture("1920x1080"), picture("3840x2160"), picture("7680x4320")});
    series("lights", {lights(1), lights(10), lights(50)});
    return rows_;
  }

 private:
  std::string out(const char* name) const { return folder_.path() + "/" + name; }

  Step terrain(int cells) const {
    const double triangles = 2.0 * cells * cells;
    return {triangles, fmt::format("terrain, {:.0f} M", 1e-6 * triangles), [this, cells] {
              Scene scene = terrain_scene("terrain", cells).scene;
              scene.lights.erase(scene.lights.begin());
              return Words{"compare", written_glb(scene, out("terrain.glb")), "--size", "640x360"};
            }};
  }

  static Step picture(const std::string& size) {
    const std::size_t cross = size.find('x');
    return {std::stod(size.substr(0, cross)) * std::stod(size.substr(cross + 1)), "fence, " + size, [size] {
              return Words{"compare", "fence", "--size", size};
            }};
  }

  /// Points on a circle above the teapot, of which each has a share of the first one's intensity.
  Step lights(int count) const {
    return {double(count), fmt::format("teapot, {} light{}", count, count == 1 ? "" : "s"), [this, count] {
              Scene scene = teapot_scene().scene;
              const Light point = scene.lights.front();
              scene.lights.assign(static_cast<std::size_t>(count), point);
              for (int i = 0; i < count; ++i) {
                Light& light = scene.lights[static_cast<std::size_t>(i)];
                const double angle = 2.0 * std::numbers::pi * i / count;
                light.position +=
                    0.3 * glm::length(point.position) * Vec3(std::cos(angle), 0.0, std::sin(angle));
                light.intensity /= count;
              }
              return Words{"compare",      written_glb(scene, out("lights.glb")),
                           "--size",       "320x180",
                           "--max-lights", std::to_string(count)};
            }};
  }

  void series(const char* what, const std::vector<Step>& steps) {
    const Step* before = nullptr;
    Cost less;
    for (const Step& step : steps) {
      Words words = step.words();
      words.insert(words.end(), {"--quiet", "-o", out("scale")});
      const Cost cost = cost_of(std::move(words));
      const auto add = [&](const char* of, double value, double smaller, const char* unit) {
        BenchRow row{.name = fmt::format("{}, {}", what, of),
                     .scene = step.name,
                     .threads = static_cast<int>(std::thread::hardware_concurrency()),
                     .value = value,
                     .unit = unit,
                     .more_is_better = false};
        if (before != nullptr) {
          row.peer = BenchPeer{before->name, smaller};
          row.exponent = std::log(value / smaller) / std::log(step.amount / before->amount);
        }
        show_growth(row);
        rows_.push_back(std::move(row));
      };
      add("processor", cost.processor, less.processor, "s");
      add("memory", 1e-6 * cost.memory, 1e-6 * less.memory, "MB");
      before = &step, less = cost;
    }
  }

  void show_growth(const BenchRow& row) const {
    fmt::print(
        settings_.table(), "  {:<22} {:<20} {:>9.2f} {:<3}{}\n", row.name, row.scene, row.value, row.unit,
        row.exponent ? fmt::format("  grows with the power {:.2f} from {}", *row.exponent, row.peer->name)
                     : "");
    std::fflush(settings_.table());
  }

  const Settings& settings_;
  test::TemporaryFolder folder_;
  std::vector<BenchRow> rows_;
};

}  // namespace

std::vector<BenchRow> bench_scale(const Settings& settings) {
  return ScaleBench(settings).run();
}

}  // namespace gnomon::bench

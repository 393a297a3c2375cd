#include "whole_bench.h"

#include <fmt/format.h>

#include <filesystem>
#include <thread>

#include "bench_scenes.h"
#include "bench_support.h"
#include "command_cost.h"
#include "scale_bench.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::bench {
namespace {

class WholeBench {
 public:
  explicit WholeBench(const Settings& settings) : settings_(settings) {}

  std::vector<BenchRow> run() {
    fmt::print(settings_.table(), "Whole commands, the least of {} runs\n", settings_.runs);
    const std::vector<Named> scenes = compared_scenes();
    for (const ImageSize& size : settings_.whole_sizes) {
      size_ = fmt::format("{}x{}", size.width, size.height);
      for (const Named& scene : scenes) comparison(scene);
      if (&size != &settings_.whole_sizes.front()) continue;
      over_comparison("1,000 biases", "courtyard",
                      {"sweep", "courtyard", "--size", size_, "--bias", "0:0.1:1000"}, 1.5);
      over_comparison("shimmer, 60 frames", "courtyard",
                      {"shimmer", "courtyard", "--size", size_, "--frames", "60"}, 8.0);
    }
    return rows_;
  }

 private:
  struct Named {
    std::string name, path;
  };

  std::vector<Named> compared_scenes() {
    std::vector<Named> scenes{{"fence", "fence"}, {"courtyard", "courtyard"}, {"teapot", "teapot"}};
    const std::string bunny = test::shared_data() + "/common_organic/stanford-bunny.obj";
    if (std::filesystem::exists(bunny)) scenes.push_back({"bunny", bunny});
    scenes.push_back({"terrain, 1 M", written_terrain()});
    scenes.push_back({"forest", "forest"});
    return scenes;
  }

  /// Under its sun alone, as the other scenes are.
  std::string written_terrain() {
    Scene scene = terrain_scene("terrain", 708).scene;
    scene.lights.erase(scene.lights.begin());
    return written_glb(scene, out("terrain.glb"));
  }

  std::string out(const char* name) const { return folder_.path() + "/" + name; }
  Cost compare(const std::string& scene) const {
    return cost_of({"compare", scene, "--size", size_, "--quiet", "-o", out("compare")});
  }

  void comparison(const Named& scene) {
    fmt::print(settings_.table(), "{}, {}\n", scene.name, size_);
    Least whole, pictures;
    for (int i = 0; i < settings_.runs; ++i) {
      whole.add(compare(scene.path));
      pictures.add(cost_of({"raster", scene.path, "--size", size_, "--quiet", "-o", out("raster.png")}) +
                   cost_of({"raytrace", scene.path, "--size", size_, "--quiet", "-o", out("raytrace.png")}));
    }
    const auto row = [&](const char* what, double ours, double theirs, double times) {
      add(fmt::format("whole comparison, {}", what), scene.name, ours, "its two pictures", theirs, times);
    };
    row("processor", whole.cost.processor, pictures.cost.processor, 1.6);
    row("clock", whole.cost.wall, pictures.cost.wall, 1.5);
  }

  void over_comparison(const char* what, const std::string& scene, Words words, double times) {
    words.insert(words.end(), {"--quiet", "-o", out("many")});
    fmt::print(settings_.table(), "{}, {}\n", scene, size_);
    Least whole, one;
    for (int i = 0; i < settings_.runs; ++i) {
      std::filesystem::remove_all(out("many"));  // a sweep goes on where one before it ended
      whole.add(cost_of(words)), one.add(compare(scene));
    }
    add(fmt::format("{}, processor", what), scene, whole.cost.processor, "one comparison", one.cost.processor,
        times);
  }

  /// The goal: at most so many times the peer.
  void add(std::string name, const std::string& scene, double ours, const char* peer, double theirs,
           double times) {
    rows_.push_back({.name = std::move(name),
                     .scene = fmt::format("{}, {}", scene, size_),
                     .threads = static_cast<int>(std::thread::hardware_concurrency()),
                     .value = ours,
                     .unit = "s",
                     .more_is_better = false,
                     .peer = BenchPeer{peer, theirs},
                     .goal = 1.0 / times});
    show(settings_.table(), rows_.back());
  }

  const Settings& settings_;
  std::string size_;
  test::TemporaryFolder folder_;
  std::vector<BenchRow> rows_;
};

}  // namespace

std::vector<BenchRow> bench_whole(const Settings& settings) {
  std::vector<BenchRow> rows = WholeBench(settings).run();
  for (BenchRow& row : bench_scale(settings)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace gnomon::bench

#include "whole_bench.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "bench_scenes.h"
#include "bench_support.h"
#include "scene/files/gltf/gltf_writer.h"
#include "scene/files/write_file.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace gnomon::bench {
namespace {

using Words = std::vector<std::string>;

/// Of one process, seconds.
struct Cost {
  double wall = 0.0, processor = 0.0;
};

Cost operator+(const Cost& a, const Cost& b) {
  return {a.wall + b.wall, a.processor + b.processor};
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

[[noreturn]] void become(const Words& words) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

Cost cost_of(Words words) {
  words.insert(words.begin(), test::program());
  const Stopwatch watch;
  const pid_t child = fork();
  if (child == 0) become(words);
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || status != 0) {
    fmt::print(stderr, "{}: failed\n", fmt::join(words, " "));
    std::exit(1);
  }
  return {1e-3 * watch.elapsed_ms(), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

/// The least of several runs, each by itself: other programs only ever add.
struct Least {
  Cost cost{1e30, 1e30};
  void add(const Cost& run) {
    cost = {std::min(cost.wall, run.wall), std::min(cost.processor, run.processor)};
  }
};

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
    const auto file = write_gltf(scene, true);
    if (!file || !write_file(out("terrain.glb"), file->bytes)) {
      fmt::print(stderr, "{}: cannot be written\n", out("terrain.glb"));
      std::exit(1);
    }
    return out("terrain.glb");
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
  return WholeBench(settings).run();
}

}  // namespace gnomon::bench

#include "benchmark/build_time.h"

#include <fmt/core.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <cerrno>
#include <filesystem>

#include "scene/base/run_program.h"
#include "scene/files/path_status.h"

namespace gnomon::bench {

namespace {

/// A folder that is gone with the object.
class ScratchFolder {
 public:
  static Expected<ScratchFolder> make() {
    std::string path = (std::filesystem::temp_directory_path() / "gnomon-build-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr)
      return failed_call(ErrorKind::cannot_write, path, "a folder to build in", errno);
    return ScratchFolder(std::move(path));
  }
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    if (!path_.empty()) [[maybe_unused]]
      const Expected<void> gone = remove_all_of(path_);
  }
  const std::string& path() const { return path_; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

/// Processor seconds of all programs that ended.
double seconds_of_programs() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

Expected<void> run(std::vector<std::string> words) {
  const std::string tool = words.front();
  const auto code = run_program(std::move(words));
  if (!code) return fail(code.error());
  if (*code != 0) return fail(ErrorKind::graphics, fmt::format("{} ended with exit code {}", tool, *code));
  return {};
}

}  // namespace

Expected<BenchResult> bench_build(const std::string& sources, const std::vector<std::string>& programs,
                                  const Progress& progress) {
  if (file_kind_or_none(sources + "/CMakePresets.json") != FileKind::file) {
    Error error{ErrorKind::bad_input, "no sources of Gnomon"};
    error.file = sources;
    return fail(std::move(error));
  }
  const auto folder = ScratchFolder::make();
  if (!folder) return fail(folder.error());
  const auto configured = run({"cmake", "-S", sources, "-B", folder->path(), "--preset", "release",
                               "-DGNOMON_TESTS=OFF", "-DGNOMON_ALL_VECTORS=OFF", "-DCCACHE_PROGRAM="});
  if (!configured) return fail(configured.error());
  BenchResult result;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (progress) progress("compiling " + programs[i], double(i) / double(programs.size()));
    const double before = seconds_of_programs();
    const auto built = run({"cmake", "--build", folder->path(), "--target", "app/" + programs[i]});
    if (!built) return fail(built.error());
    const double seconds = seconds_of_programs() - before;
    result.rows.push_back(
        {.name = "compile " + programs[i], .value = seconds, .unit = "s", .more_is_better = false});
    result.table += fmt::format("{:<16}{:>8.1f} s of processor time{}\n", programs[i], seconds,
                                i == 0 ? "" : " beyond what is above");
  }
  return result;
}

}  // namespace gnomon::bench

#include "app/bench/techniques.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;
constexpr const char* program_name = "gnomon_bench";

std::string find_program(const fs::path& own_folder) {
  for (const fs::path& folder : {own_folder, own_folder.parent_path() / "tests"}) {
    const fs::path program = folder / program_name;
    if (access(program.c_str(), X_OK) == 0) return program.string();
  }
  return {};
}

}  // namespace

Expected<ExitCode> run_whole_bench(const WholeBench& bench) {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const std::string program = error ? std::string() : find_program(own.parent_path());
  if (program.empty())
    return fail(
        ErrorKind::graphics,
        fmt::format("{} is not beside this program (it needs Embree 3, and is built by ./gnomon test or "
                    "cmake --build BUILD --target {})",
                    program_name, program_name));
  RunFiles files;
  files.writes("--json", bench.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  std::vector<std::string> words{program};
  if (bench.runs > 0) words.insert(words.end(), {"--runs", std::to_string(bench.runs)});
  if (!bench.size.empty()) words.insert(words.end(), {"--size", bench.size});
  if (!bench.json.empty()) words.insert(words.end(), {"--json", bench.json});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  leave_interrupts_to_the_system();
  execv(program.c_str(), arguments.data());
  return fail(ErrorKind::graphics, fmt::format("{}: {}", program, std::strerror(errno)));
}

}  // namespace gnomon::app

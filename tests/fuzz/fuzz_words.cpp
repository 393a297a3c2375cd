// Command lines, a word a line: parsed, and not run. What they print goes nowhere but through the checks here.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <sstream>
#include <utility>

#include "app/command_line.h"
#include "fuzz_target.h"

namespace {

using namespace gnomon;

/// stdout to nowhere and stderr into a file while it lives.
class Listening {
 public:
  Listening() : file_(std::tmpfile()) {
    if (file_ == nullptr) fuzz::broken("no temporary file");
    std::fflush(stdout), std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO), ::dup2(::fileno(file_), STDERR_FILENO), ::close(nowhere);
  }
  ~Listening() { stop(); }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
  /// What came on stderr.
  std::string stop() {
    if (file_ == nullptr) return {};
    std::fflush(stdout), std::fflush(stderr);
    ::dup2(kept_[0], STDOUT_FILENO), ::dup2(kept_[1], STDERR_FILENO);
    std::string text(65536, '\0');
    std::rewind(file_);
    text.resize(std::fread(text.data(), 1, text.size(), file_));
    std::fclose(std::exchange(file_, nullptr));
    return text;
  }

 private:
  static inline const std::array<int, 2> kept_{::dup(STDOUT_FILENO), ::dup(STDERR_FILENO)};
  std::FILE* file_;
};

std::vector<std::string> words_of(const std::uint8_t* data, std::size_t size) {
  std::istringstream bytes(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words{"gnomon"};
  for (std::string word; std::getline(bytes, word) && words.size() < 64;) {
    word.erase(std::remove(word.begin(), word.end(), '\0'), word.end());
    words.push_back(std::move(word));
  }
  return words;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> words = words_of(data, size);
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  Listening listening;
  int code = -1;
  std::string thrown;
  try {
    code = app::check_command_line(static_cast<int>(argv.size()), argv.data());
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  const std::string said = listening.stop();
  if (!thrown.empty()) fuzz::broken("an exception: " + thrown);
  if (code != 0 && code != 2 && code != 3) fuzz::broken("exit code " + std::to_string(code) + ": " + said);
  // Without any word the help is what is said.
  if (code != 0 && words.size() > 1 && std::count(said.begin(), said.end(), '\n') != 1)
    fuzz::broken("an error that is not one line: " + said);
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  std::vector<std::string> lines{
      "compare fence --size 64x36 --map-size 512 --bias 0.5texel --slope-bias 1 --fail-above wrong:1%",
      "compare fence --technique pcf --filter-kernel poisson --filter-radius 2.5 --exposure auto --seed 7",
      "compare fence --camera-orbit 30,20 --light-azimuth 10 --light-elevation 45 --threads 2 --runs 3",
      "sweep fence --bias 0:0.1:64 --map-size 128:8192:x2 --technique hard,pcf --shard 1/2 --zip",
      "tune fence --max-error 0.5% --map-size 256:4096:x2",
      "raytrace fence -o a.png --precision exact --accel kdtree --samples 16",
      "shimmer fence --path drift --drift 0.2,0.1 --frames 8",
      "plan fence --json -",
      "verify --help"};
  for (std::string& line : lines) std::replace(line.begin(), line.end(), ' ', '\n');
  return lines;
}

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
  return {
      "compare\nfence\n--size\n64x36\n--map-size\n512\n--bias\n0.5texel\n--slope-bias\n1\n--fail-"
      "above\nwrong:1%",
      "compare\nfence\n--technique\npcf\n--filter-kernel\npoisson\n--filter-radius\n2.5\n--exposure\nauto\n--"
      "seed\n7",
      "compare\nfence\n--camera-orbit\n30,20\n--light-azimuth\n10\n--light-elevation\n45\n--threads\n2\n--"
      "runs\n3",
      "sweep\nfence\n--bias\n0:0.1:64\n--map-size\n128:8192:x2\n--technique\nhard,pcf\n--shard\n1/2\n--zip",
      "tune\nfence\n--max-error\n0.5%\n--map-size\n256:4096:x2",
      "raytrace\nfence\n-o\na.png\n--precision\nexact\n--accel\nkdtree\n--samples\n16",
      "shimmer\nfence\n--path\ndrift\n--drift\n0.2,0.1\n--frames\n8",
      "plan\nfence\n--json\n-",
      "verify\n--help"};
}

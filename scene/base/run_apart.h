// Another program that reads what a stranger wrote. It sees one file, under its own name in a folder with nothing else, and
// writes one; both are in memory. It has no other files of the user, no network and no other process where the kernel lets
// that be taken from it (confine.h).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon {

struct ApartProgram {
  std::string name;        ///< of the file that it reads, without a folder
  std::string_view bytes;  ///< what that holds
  /// The program's words, given the paths of the file that it reads and of the one that it writes.
  std::function<std::vector<std::string>(const std::string& in, const std::string& out)> words;
  std::vector<std::string> programs;  ///< all that run, as the PATH has them
  double longest_s = 0.0;             ///< then it is ended
};

struct ApartEnd {
  int code = 0;         ///< as run_program() returns it
  std::string said;     ///< the first megabyte; the file has its own name there
  std::string written;  ///< the file that it wrote
};

/// Runs it to its end. ErrorKind::graphics: it cannot be started, there is no memory or no temporary folder, it was ended.
Expected<ApartEnd> run_apart(const ApartProgram& program);

}  // namespace gnomon

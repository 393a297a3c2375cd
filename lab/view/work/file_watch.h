// Whether files have changed since they were last looked at: by the time of their last change and their size,
// asked for now and then.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon::lab {

class FileWatch {
 public:
  FileWatch() = default;
  /// Files, and folders with all that is in them.
  explicit FileWatch(std::vector<std::string> paths);
  /// Another list; the same one again changes nothing.
  void watch(std::vector<std::string> paths);
  /// Since the last call that said so, or the start. A file that is gone or new is a change.
  bool changed();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Stamp&) const = default;
  };
  std::map<std::string, Stamp> look() const;
  std::vector<std::string> paths_;
  std::map<std::string, Stamp> seen_;
};

}  // namespace gnomon::lab

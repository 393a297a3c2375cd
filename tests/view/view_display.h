// A virtual display for tests of windows: Xvfb on the first free number.
#pragma once

#include <string>

namespace gnomon::app_test {

class VirtualDisplay {
 public:
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// Empty when it runs; else why not.
  const std::string& missing() const { return missing_; }
  /// "DISPLAY=:7".
  std::string variable() const { return "DISPLAY=:" + number_; }

 private:
  int process_ = -1;
  std::string number_, missing_;
};

}  // namespace gnomon::app_test

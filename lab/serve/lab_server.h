// The lab's page over HTTP, for browsers on this machine or at the end of a tunnel. Whoever asks has to know the address's token;
// nothing is read from disk or opened by a name that a request brings, but what was dropped on the page.
#pragma once

#include <memory>
#include <string>

#include "lab/serve/http_server.h"
#include "lab/serve/lab_engine.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

class LabServer {
 public:
  /// Binds the place. `folder`: for what is dropped on the page. Error (resources): it is taken.
  static Expected<std::unique_ptr<LabServer>> open(const ServerPlace& place, LabEngine& engine,
                                                   const LabOptions& options, const std::string& folder);
  ~LabServer();
  LabServer(const LabServer&) = delete;
  LabServer& operator=(const LabServer&) = delete;

  /// "http://127.0.0.1:40123/TOKEN/"
  std::string url() const;
  /// Answers until the process ends.
  void run();

 private:
  LabServer();
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace gnomon::lab

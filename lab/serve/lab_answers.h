// What the lab's page asks its engine, answered: the same requests and answers over HTTP and in a page's worker (docs/lab.md, "The
// page and its engine"). Nothing is opened by a name that a request brings, but what was dropped on the page.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "lab/serve/lab_engine.h"

namespace gnomon::lab {

struct LabRequest {
  std::string name;                                          ///< "wish", "news", "picture", "pixel", "file"
  std::function<std::string(const char* name)> parameter{};  ///< of the address; empty: none
  std::string_view body{};
};

struct LabAnswer {
  int status = 200;  ///< of HTTP
  std::string type, body;
};

/// Words for whoever asked.
LabAnswer lab_refusal(int status, const std::string& text);
LabAnswer lab_refusal(const Error& error);

class LabAnswers {
 public:
  /// `folder`: for what is dropped on the page; `longest_wait`: for news.
  LabAnswers(LabEngine& engine, std::string folder, std::chrono::milliseconds longest_wait)
      : engine_(&engine), folder_(std::move(folder)), longest_wait_(longest_wait) {}

  LabAnswer answer(const LabRequest& request);

 private:
  LabAnswer take_wish(const LabRequest& request);
  LabAnswer tell_news(const LabRequest& request);
  LabAnswer send_picture(const LabRequest& request) const;
  LabAnswer tell_pixel(const LabRequest& request) const;
  LabAnswer take_file(const LabRequest& request);

  LabEngine* engine_;
  std::string folder_;
  std::chrono::milliseconds longest_wait_;
  std::atomic<int> waiting_ = 0, dropped_ = 0;
};

/// The lab's page, as build_page() makes it: with what it knows beforehand. `worker`: the page has an engine of its own
/// in the files beside it (gnomon_worker.mjs), and asks no program.
std::string lab_page(const LabOptions& options, bool worker);

}  // namespace gnomon::lab

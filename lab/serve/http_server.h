// HTTP/1.1 for one program's page, on Boost.Beast. A connection has one request and is closed after its answer, so that no byte
// behind a request is ever taken for another one. One thread serves whoever has not sent a whole request; each step that
// waits for a client has a deadline, and of those waiting there are so many at most.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "lab/serve/lab_answers.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

struct ServerPlace {
  std::string address = "127.0.0.1";  ///< that is listened at
  int port = 0;                       ///< 0: any that is free
};

/// A request before its body is read. Each header here comes at most once.
struct HttpHead {
  std::string method;        ///< "GET", "HEAD" or "POST"
  std::string path, query;   ///< as they came: "/a/b", "x=1&y=2"
  std::string host, origin;  ///< headers; empty: none
  std::string fetch_site;    ///< Sec-Fetch-Site
};

/// A parameter of the query, decoded: the first of that name; empty where there is none.
std::string query_parameter(std::string_view query, std::string_view name);

struct HttpService {
  /// Called on the network's thread as soon as the head is there: a refusal, or what needs no work. The body is never looked at
  /// then. None: the request goes on.
  std::function<std::optional<LabAnswer>(const HttpHead& head)> at_once;
  /// Called on one of several other threads, when the body is there.
  std::function<LabAnswer(const HttpHead& head, std::string_view body)> answer;
};

class HttpServer {
 public:
  /// Listens at the place. Errors (graphics): it is taken, or the threads cannot be started.
  static Expected<std::unique_ptr<HttpServer>> open(const ServerPlace& place, HttpService service);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;
  /// Answers until the process ends.
  void run();

 private:
  HttpServer();
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// "[::1]" of "::1": an address as an URL has it.
std::string in_url(const std::string& address);

}  // namespace gnomon::lab

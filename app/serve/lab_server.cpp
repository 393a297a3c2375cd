#include "app/serve/lab_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "app/process/interrupt.h"
#include "app/serve/lab_answers.h"
#include "app/view/work/job.h"
#include "scene/base/threads.h"
#include "scene/files/read_file.h"

namespace gnomon::app {
namespace {

using httplib::Request;
using httplib::Response;

constexpr int answering_threads = 32;
constexpr std::chrono::seconds longest_wait{10};
constexpr time_t patience_seconds = 2;                        ///< with a client that says nothing more
constexpr std::size_t largest_drop = std::size_t{256} << 20;  // bytes

/// 128 bits from the system, in hexadecimal digits.
Expected<std::string> new_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return fail(ErrorKind::graphics, "the system gives no random numbers, which the address needs");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

/// Takes as long whatever the texts have in common.
bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

/// "localhost" of "localhost:9000", "[::1]" of "[::1]:9000".
std::string_view host_name(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, std::min(host.find(']') + 1, host.size()));
  return host.substr(0, host.find(':'));
}

/// A name that goes on after its numbers ("127.0.0.1.example.org") may lead anywhere.
bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" || address == "[::1]" ||
         (address.starts_with("127.") && address.find_first_not_of("0123456789.") == std::string_view::npos);
}

std::string in_url(const std::string& address) {
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

void send(Response& response, const LabAnswer& answer) {
  response.status = answer.status;
  response.set_content(answer.body, answer.type);
}

void say(Response& response, int status, const std::string& text) {
  send(response, lab_refusal(status, text));
}

}  // namespace

struct LabServer::Inside {
  Inside(LabEngine& of, const LabOptions& options, std::string in)
      : engine(of), page(lab_page(options, false)), answers(of, std::move(in), longest_wait) {}

  // Whether the request may be answered at all: who asks, by which name, from where.
  bool admits(const Request& request, Response& response) const;
  void route();

  void send_report(const Request& request, Response& response);

  LabEngine& engine;
  const std::string page;
  LabAnswers answers;
  ServerPlace place;
  std::string token;
  std::atomic<std::uint64_t> report = 0;  ///< the one that was asked for last
  httplib::Server server;                 ///< last: its threads use the rest
};

bool LabServer::Inside::admits(const Request& request, Response& response) const {
  const std::string host = request.get_header_value("Host");
  const std::string_view name = host_name(host);
  // Another name that leads here is that of a page elsewhere (DNS rebinding).
  const bool known = is_loopback(name) || name == in_url(place.address) || !is_loopback(place.address);
  if (host.empty() || !known) return say(response, 421, "This server is not known by that name."), false;
  const std::string origin = request.get_header_value("Origin"),
                    site = request.get_header_value("Sec-Fetch-Site");
  const bool foreign = (!origin.empty() && origin != "http://" + host) ||
                       (!site.empty() && site != "same-origin" && site != "none");
  if (foreign) return say(response, 403, "Pages of other addresses are not answered."), false;
  const std::string& path = request.path;
  const bool told = path.size() > token.size() + 1 && path.front() == '/' && path[token.size() + 1] == '/' &&
                    same_secret(std::string_view(path).substr(1, token.size()), token);
  if (!told)
    return say(response, 404, "Nothing is here. The address that gnomon serve printed is needed whole."),
           false;
  return true;
}

void LabServer::Inside::route() {
  const std::string base = "/" + token + "/";
  const auto answer = [this](const char* name) {
    return [this, name](const Request& request, Response& response) {
      const auto parameter = [&](const char* key) { return request.get_param_value(key); };
      send(response, answers.answer({name, parameter, request.body}));
    };
  };
  server.Get(base, [this](const Request&, Response& response) {
    response.set_content(page, "text/html; charset=utf-8");
  });
  server.Post(base + "wish", answer("wish"));
  server.Get(base + "news", answer("news"));
  server.Get(base + "picture", answer("picture"));
  server.Get(base + "pixel", answer("pixel"));
  server.Post(base + "file", answer("file"));
  server.Get(base + "report",
             [this](const Request& request, Response& response) { send_report(request, response); });
}

/// The report page of what is shown, by a process of its own; a later request takes its place.
void LabServer::Inside::send_report(const Request&, Response& response) {
  const std::uint64_t own = ++report;
  const LabMoment moment = engine.wait(0, std::chrono::milliseconds(0));
  std::vector<std::string> words = engine.compare_words(moment);
  const TemporaryFolder written("gnomon-report");
  if (written.path().empty()) return say(response, 500, "No folder can be made for the report.");
  const std::string out = written.path() + "/out";
  words.insert(words.end(), {"-o", out, "--quiet", "--report-max-mb", "1000"});
  auto job = Job::start("report", words);
  if (!job) return send(response, lab_refusal(job.error()));
  while (!(*job)->ended()) {
    if (report != own) return say(response, 409, "Another report was asked for.");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if ((*job)->exit_code() != 0) return say(response, 500, (*job)->err());
  const auto page_text = read_file(out + "/report.html");
  if (!page_text) return send(response, lab_refusal(page_text.error()));
  response.set_content(*page_text, "text/html; charset=utf-8");
}

LabServer::LabServer() = default;
LabServer::~LabServer() = default;

Expected<std::unique_ptr<LabServer>> LabServer::open(const ServerPlace& place, LabEngine& engine,
                                                     const LabOptions& options, const std::string& folder) {
  auto token = new_token();
  if (!token) return fail(token.error());
  if (startable_threads(answering_threads) < answering_threads)
    return fail(ErrorKind::graphics, fmt::format("the server needs {} threads, and fewer can be started ({})",
                                                 answering_threads, thread_limit_words));
  std::unique_ptr<LabServer> out(new LabServer);
  out->inside_ = std::make_unique<Inside>(engine, options, folder);
  Inside& in = *out->inside_;
  in.place = place, in.token = std::move(*token);
  in.server.new_task_queue = [] { return new httplib::ThreadPool(answering_threads); };
  in.server.set_payload_max_length(largest_drop);
  in.server.set_read_timeout(patience_seconds);
  in.server.set_write_timeout(static_cast<time_t>(longest_wait.count()));
  in.server.set_keep_alive_timeout(patience_seconds);
  in.server.set_tcp_nodelay(true);
  // Not SO_REUSEPORT, the library's own choice, with which another process could listen at the same port.
  in.server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  in.server.set_default_headers({{"Cache-Control", "no-store"},
                                 {"Content-Security-Policy", "frame-ancestors 'self'"},
                                 {"Cross-Origin-Opener-Policy", "same-origin"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"}});
  in.server.set_pre_routing_handler([&in](const Request& request, Response& response) {
    return in.admits(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                        : httplib::Server::HandlerResponse::Handled;
  });
  in.route();
  if (place.port != 0) {
    if (!in.server.bind_to_port(place.address, place.port))
      return fail(ErrorKind::graphics, fmt::format("--port: nothing can listen at {}:{} (is it taken?)",
                                                   in_url(place.address), place.port));
  } else {
    in.place.port = in.server.bind_to_any_port(place.address);
    if (in.place.port <= 0)
      return fail(ErrorKind::graphics, fmt::format("--listen: nothing can listen at {}", place.address));
  }
  return out;
}

/// Of every address of the machine none is better known than its own name for itself.
std::string LabServer::url() const {
  const std::string& address = inside_->place.address;
  const bool any = address == "0.0.0.0" || address == "::";
  return fmt::format("http://{}:{}/{}/", any ? "localhost" : in_url(address), inside_->place.port,
                     inside_->token);
}

Expected<void> LabServer::run() {
  if (inside_->server.listen_after_bind()) return {};
  return fail(ErrorKind::graphics, "the server has ended: the system took its port away");
}

}  // namespace gnomon::app

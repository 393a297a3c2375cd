#include "lab/serve/http_server.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <cerrno>
#include <chrono>
#include <limits>
#include <utility>

#include "lab/serve/waiting_room.h"
#include "scene/base/threads.h"

namespace gnomon::lab {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::seconds;

constexpr int answering_threads = 16;
constexpr int most_worked_on = 64;  ///< requests, of which the threads answer the first ones
constexpr std::size_t largest_head = 16384, largest_body = std::size_t{256} << 20;  // bytes
constexpr seconds head_deadline{5}, farewell{2};

/// Of a body or an answer: a slow line carries 100 kB in a second.
seconds deadline_of(std::size_t bytes) {
  return seconds(10 + bytes / 100'000);
}

bool is_once(const http::fields& fields, http::field name) {
  return fields.count(name) <= 1;
}

std::string text_of(beast::string_view text) {
  return {text.data(), text.size()};
}

HttpHead head_of(const http::request<http::string_body>& request) {
  const std::string target = text_of(request.target());
  const std::size_t mark = std::min(target.find('?'), target.size());
  return {text_of(request.method_string()),
          target.substr(0, mark),
          mark < target.size() ? target.substr(mark + 1) : "",
          text_of(request[http::field::host]),
          text_of(request[http::field::origin]),
          text_of(request["Sec-Fetch-Site"])};
}

/// What could be read in two ways, or needs what this server does not do.
std::optional<LabAnswer> unclear(const http::request<http::string_body>& request, std::uint64_t length) {
  for (const http::field name : {http::field::host, http::field::origin, http::field::content_length})
    if (!is_once(request, name)) return lab_refusal(400, "A header that has to stand once stands twice.");
  if (request.count("Sec-Fetch-Site") > 1)
    return lab_refusal(400, "A header that has to stand once stands twice.");
  if (request[http::field::content_length].find(',') != beast::string_view::npos)
    return lab_refusal(400, "A body has one length.");
  const bool asks = request.method() == http::verb::get || request.method() == http::verb::head;
  if (!asks && request.method() != http::verb::post)
    return lab_refusal(405, "Only GET and POST are answered.");
  if (request.count(http::field::transfer_encoding) > 0)
    return lab_refusal(411, "The length of a body has to be told beforehand.");
  if (request.count(http::field::expect) > 0) return lab_refusal(417, "Nothing is promised beforehand.");
  if (request.count(http::field::content_encoding) > 0)
    return lab_refusal(415, "Bodies are read as they are, not packed.");
  if (asks && length > 0) return lab_refusal(400, "Such a request has no body.");
  return std::nullopt;
}

http::response<http::string_body> response_of(LabAnswer answer, bool without_body) {
  http::response<http::string_body> response(static_cast<http::status>(answer.status), 11);
  response.set(http::field::content_type, answer.type);
  response.set(http::field::cache_control, "no-store");
  response.set("Content-Security-Policy", "frame-ancestors 'self'");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Referrer-Policy", "no-referrer");
  response.set("X-Content-Type-Options", "nosniff");
  response.content_length(answer.body.size());
  response.keep_alive(false);
  if (!without_body) response.body() = std::move(answer.body);
  return response;
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool whole = text[i] == '%' && i + 2 < text.size();
    const int high = whole ? digit(text[i + 1]) : -1, low = whole ? digit(text[i + 2]) : -1;
    if (high >= 0 && low >= 0)
      out += static_cast<char>(16 * high + low), i += 2;
    else
      out += text[i] == '+' ? ' ' : text[i];
  }
  return out;
}

/// Bound and listening; not inherited by programs that are started.
bool listen_at(tcp::acceptor& acceptor, const tcp::endpoint& at) {
  error_code failed;
  acceptor.open(at.protocol(), failed);
  if (failed) return false;
  fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
  acceptor.set_option(tcp::acceptor::reuse_address(true), failed);
  if (at.protocol() == tcp::v6()) acceptor.set_option(asio::ip::v6_only(false), failed);
  acceptor.bind(at, failed);
  if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed) acceptor.close();
  return !failed;
}

}  // namespace

std::string query_parameter(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
    const std::size_t sign = std::min(pair.find('='), pair.size());
    if (decoded(pair.substr(0, sign)) == name) return decoded(pair.substr(std::min(sign + 1, pair.size())));
  }
  return {};
}

std::string in_url(const std::string& address) {
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

struct HttpServer::Inside {
  class Exchange;
  explicit Inside(HttpService of) : service(std::move(of)) {}
  void accept();
  /// False: the process can open no more sockets.
  bool take_waiting_clients();

  HttpService service;
  asio::io_context network;
  tcp::acceptor acceptor{network};
  asio::steady_timer pause{network};
  // Who has not sent a head, or was answered; whose body is under way; whose answer is.
  WaitingRoom strangers{256, std::numeric_limits<std::size_t>::max()};
  WaitingRoom senders{32, 2 * largest_body};
  WaitingRoom readers{64, std::size_t{1} << 30};
  int worked_on = 0;                             ///< requests
  asio::thread_pool workers{answering_threads};  ///< last: they use the rest
};

/// One request and its answer. All of it but the answering is done on the network's thread. Whatever is under way keeps it.
class HttpServer::Inside::Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(Inside& server, tcp::socket socket) : server_(&server), stream_(std::move(socket)) {
    parser_.header_limit(largest_head);
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // looked at where the head is known
  }
  void begin();

 private:
  void wait_in(WaitingRoom& room, std::size_t bytes, seconds most);
  void leave();
  void take_head(error_code failed);
  void take_body();
  void work();
  void send(LabAnswer answer);
  void say_farewell();
  void hear_out();
  template <class Next>
  auto then(Next next) {
    return [self = shared_from_this(), next](error_code failed, std::size_t) { next(*self, failed); };
  }

  Inside* server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{largest_head + 1024};
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  HttpHead head_;
  std::array<char, 4096> unread_{};
  WaitingRoom* room_ = nullptr;  ///< that it is in, at place_
  WaitingRoom::Place place_;
};

/// The deadline is that of all that is waited for in the room: a byte now and then does not move it.
void HttpServer::Inside::Exchange::wait_in(WaitingRoom& room, std::size_t bytes, seconds most) {
  leave();
  place_ = room.enter({bytes, [this] {
                         room_ = nullptr;
                         stream_.close();
                       }});
  room_ = &room;
  stream_.expires_after(most);
}

void HttpServer::Inside::Exchange::leave() {
  if (room_ != nullptr) std::exchange(room_, nullptr)->leave(place_);
  stream_.expires_never();
}

void HttpServer::Inside::Exchange::begin() {
  wait_in(server_->strangers, 0, head_deadline);
  http::async_read_header(stream_, buffer_, parser_,
                          then([](Exchange& self, error_code failed) { self.take_head(failed); }));
}

void HttpServer::Inside::Exchange::take_head(error_code failed) {
  static const auto& of_http = make_error_code(http::error::bad_method).category();
  if (failed == http::error::header_limit || failed == http::error::buffer_overflow)
    return send(lab_refusal(431, "The request's head is too long."));
  if (failed == http::error::end_of_stream || failed == http::error::partial_message) return leave();
  if (failed.category() == of_http) return send(lab_refusal(400, "This is no request of HTTP/1.1."));
  if (failed) return leave();
  head_ = head_of(parser_.get());
  const std::uint64_t length = parser_.content_length().value_or(0);
  if (auto refused = unclear(parser_.get(), length)) return send(std::move(*refused));
  if (auto known = server_->service.at_once(head_)) return send(std::move(*known));
  if (length > largest_body) return send(lab_refusal(413, "A file of 256 MB is the largest that is taken."));
  if (parser_.is_done()) return work();
  wait_in(server_->senders, length, deadline_of(length));
  http::async_read(stream_, buffer_, parser_,
                   then([](Exchange& self, error_code missing) { missing ? self.leave() : self.work(); }));
}

void HttpServer::Inside::Exchange::work() {
  leave();
  if (server_->worked_on >= most_worked_on) return send(lab_refusal(503, "The lab has too much to answer."));
  ++server_->worked_on;
  asio::post(server_->workers, [self = shared_from_this()] {
    LabAnswer answer;
    try {
      answer = self->server_->service.answer(self->head_, self->parser_.get().body());
    } catch (const std::exception& error) {
      answer = lab_refusal(unforeseen(error));
    }
    asio::post(self->server_->network, [self, answer = std::move(answer)]() mutable {
      --self->server_->worked_on;
      self->parser_.get().body() = {};
      self->send(std::move(answer));
    });
  });
}

void HttpServer::Inside::Exchange::send(LabAnswer answer) {
  wait_in(server_->readers, answer.body.size(), deadline_of(answer.body.size()));
  response_ = response_of(std::move(answer), head_.method == "HEAD");
  http::async_write(stream_, response_, then([](Exchange& self, error_code failed) {
                      failed ? self.leave() : self.say_farewell();
                    }));
}

/// A connection that is closed while bytes arrive is reset, and the client may lose the answer: what still comes is read for a
/// moment, and forgotten.
void HttpServer::Inside::Exchange::say_farewell() {
  response_ = {};
  error_code gone;
  stream_.socket().shutdown(tcp::socket::shutdown_send, gone);
  wait_in(server_->strangers, 0, farewell);
  hear_out();
}

void HttpServer::Inside::Exchange::hear_out() {
  stream_.async_read_some(asio::buffer(unread_), then([](Exchange& self, error_code ended) {
                            ended ? self.leave() : self.hear_out();
                          }));
}

bool HttpServer::Inside::take_waiting_clients() {
  constexpr int at_a_time = 64;  // then whoever has something to say is heard again
  for (int i = 0; i < at_a_time; ++i) {
    const int client = accept4(acceptor.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client < 0) return errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM;
    tcp::socket socket(network);
    error_code failed;
    socket.assign(acceptor.local_endpoint(failed).protocol(), client, failed);
    socket.set_option(tcp::no_delay(true), failed);
    std::make_shared<Exchange>(*this, std::move(socket))->begin();
  }
  return true;
}

void HttpServer::Inside::accept() {
  acceptor.async_wait(tcp::acceptor::wait_read, [this](error_code failed) {
    if (failed == asio::error::operation_aborted) return;
    if (!failed && take_waiting_clients()) return accept();
    strangers.close_oldest();
    pause.expires_after(std::chrono::milliseconds(20));
    pause.async_wait([this](error_code ended) {
      if (!ended) accept();
    });
  });
}

HttpServer::HttpServer() = default;
HttpServer::~HttpServer() = default;

Expected<std::unique_ptr<HttpServer>> HttpServer::open(const ServerPlace& place, HttpService service) {
  if (startable_threads(answering_threads) < answering_threads)
    return fail(ErrorKind::graphics, fmt::format("the server needs {} threads, and fewer can be started ({})",
                                                 answering_threads, thread_limit_words));
  std::unique_ptr<HttpServer> out(new HttpServer);
  out->inside_ = std::make_unique<Inside>(std::move(service));
  error_code unknown;
  const auto places = tcp::resolver(out->inside_->network)
                          .resolve(place.address, std::to_string(place.port),
                                   tcp::resolver::passive | tcp::resolver::numeric_service, unknown);
  for (const auto& at : places)
    if (listen_at(out->inside_->acceptor, at.endpoint())) return out;
  if (place.port == 0)
    return fail(ErrorKind::graphics, fmt::format("--listen: nothing can listen at {}", place.address));
  return fail(ErrorKind::graphics, fmt::format("--port: nothing can listen at {}:{} (is it taken?)",
                                               in_url(place.address), place.port));
}

int HttpServer::port() const {
  return inside_->acceptor.local_endpoint().port();
}

void HttpServer::run() {
  inside_->accept();
  inside_->network.run();
}

}  // namespace gnomon::lab

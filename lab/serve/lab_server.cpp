#include "lab/serve/lab_server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "app/process/interrupt.h"
#include "lab/serve/lab_answers.h"
#include "lab/view/work/job.h"
#include "scene/files/read_file.h"

namespace gnomon::lab {
namespace {

constexpr std::chrono::seconds longest_wait{10};

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

/// "localhost" of "localhost:9000", "[::1]" of "[::1]:9000"; empty where this is no name and port.
std::string_view host_name(std::string_view host) {
  const std::size_t bracket = host.starts_with('[') ? host.find(']') : 0;
  if (bracket == std::string_view::npos) return {};
  const std::size_t end = std::min(host.find(':', bracket), host.size());
  const std::string_view name = host.substr(0, end), port = host.substr(std::min(end + 1, host.size()));
  const bool is_plain = name.find_first_of(" \t,@/") == std::string_view::npos &&
                        port.find_first_not_of("0123456789") == std::string_view::npos;
  return is_plain ? name : std::string_view{};
}

/// A name that goes on after its numbers ("127.0.0.1.example.org") may lead anywhere.
bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" || address == "[::1]" ||
         (address.starts_with("127.") && address.find_first_not_of("0123456789.") == std::string_view::npos);
}

}  // namespace

struct LabServer::Inside {
  Inside(LabEngine& of, const LabOptions& options, std::string in)
      : engine(of), page(lab_page(options, false)), answers(of, std::move(in), longest_wait) {}

  /// The refusal by who asks, by which name, from where, or the page; none: the request is to be answered.
  std::optional<LabAnswer> at_once(const HttpHead& head) const;
  LabAnswer answer(const HttpHead& head, std::string_view body);
  LabAnswer make_report();

  LabEngine& engine;
  const std::string page;
  LabAnswers answers;
  std::string address;  ///< that is listened at
  std::string token;
  std::atomic<std::uint64_t> report = 0;  ///< the one that was asked for last
  std::unique_ptr<HttpServer> server;     ///< last: its threads use the rest
};

std::optional<LabAnswer> LabServer::Inside::at_once(const HttpHead& head) const {
  const std::string_view name = host_name(head.host);
  // Another name that leads here is that of a page elsewhere (DNS rebinding).
  const bool known = is_loopback(name) || name == in_url(address) || !is_loopback(address);
  if (name.empty() || !known) return lab_refusal(421, "This server is not known by that name.");
  const bool foreign =
      (!head.origin.empty() && head.origin != "http://" + head.host) ||
      (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none");
  if (foreign) return lab_refusal(403, "Pages of other addresses are not answered.");
  const std::string_view path = head.path;
  const bool told = path.size() > token.size() + 1 && path.front() == '/' && path[token.size() + 1] == '/' &&
                    same_secret(path.substr(1, token.size()), token);
  if (!told)
    return lab_refusal(404, "Nothing is here. The address that gnomon serve printed is needed whole.");
  const std::string_view asked = path.substr(token.size() + 2);
  constexpr std::array<std::string_view, 7> all{"", "wish", "news", "picture", "pixel", "file", "report"};
  if (std::ranges::find(all, asked) == all.end()) return lab_refusal(404, "Nothing is here.");
  const bool gives = asked == "wish" || asked == "file";
  if (gives != (head.method == "POST"))
    return lab_refusal(405, "This is asked for by the other of GET and POST.");
  if (asked.empty()) return LabAnswer{200, "text/html; charset=utf-8", page};
  return std::nullopt;
}

LabAnswer LabServer::Inside::answer(const HttpHead& head, std::string_view body) {
  const std::string name = head.path.substr(token.size() + 2);
  if (name == "report") return make_report();
  const auto parameter = [&](const char* key) { return query_parameter(head.query, key); };
  return answers.answer({name, parameter, body});
}

/// The report page of what is shown, by a process of its own; a later request takes its place.
LabAnswer LabServer::Inside::make_report() {
  const std::uint64_t own = ++report;
  const LabMoment moment = engine.wait(0, std::chrono::milliseconds(0));
  std::vector<std::string> words = engine.compare_words(moment);
  const app::TemporaryFolder written("gnomon-report");
  if (written.path().empty()) return lab_refusal(500, "No folder can be made for the report.");
  const std::string out = written.path() + "/out";
  words.insert(words.end(), {"-o", out, "--quiet", "--report-max-mb", "1000"});
  auto job = Job::start("report", words);
  if (!job) return lab_refusal(job.error());
  while (!(*job)->ended()) {
    if (report != own) return lab_refusal(409, "Another report was asked for.");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if ((*job)->exit_code() != 0) return lab_refusal(500, (*job)->err());
  auto page_text = read_file(out + "/report.html");
  if (!page_text) return lab_refusal(page_text.error());
  return {200, "text/html; charset=utf-8", std::move(*page_text)};
}

LabServer::LabServer() = default;
LabServer::~LabServer() = default;

Expected<std::unique_ptr<LabServer>> LabServer::open(const ServerPlace& place, LabEngine& engine,
                                                     const LabOptions& options, const std::string& folder) {
  auto token = new_token();
  if (!token) return fail(token.error());
  std::unique_ptr<LabServer> out(new LabServer);
  out->inside_ = std::make_unique<Inside>(engine, options, folder);
  Inside& in = *out->inside_;
  in.address = place.address, in.token = std::move(*token);
  auto server = HttpServer::open(
      place, {[&in](const HttpHead& head) { return in.at_once(head); },
              [&in](const HttpHead& head, std::string_view body) { return in.answer(head, body); }});
  if (!server) return fail(server.error());
  in.server = std::move(*server);
  return out;
}

/// Where the server listens at every address of the machine, the URL has the machine's own name for itself.
std::string LabServer::url() const {
  const std::string& address = inside_->address;
  const bool any = address == "0.0.0.0" || address == "::";
  return fmt::format("http://{}:{}/{}/", any ? "localhost" : in_url(address), inside_->server->port(),
                     inside_->token);
}

void LabServer::run() {
  inside_->server->run();
}

}  // namespace gnomon::lab

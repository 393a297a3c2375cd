#include "lab/serve/lab_answers.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "lab/serve/lab_facts.h"
#include "report/shell.h"
#include "scene/base/option_text.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/write_file.h"

namespace gnomon::lab {
namespace {

using nlohmann::json;

constexpr int waiting_pages = 8;        ///< that may wait for news at one time; others are told to come again
constexpr std::size_t most_drops = 64;  // files
constexpr std::size_t longest_name = 100;
constexpr std::size_t longest_wish = 65536;  // bytes

/// Letters, digits, and of signs only those that mean nothing to a path: "house.gltf", "house_0.bin".
bool is_plain_name(const std::string& name) {
  const bool letters = std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_' || c == ' ' || c >= 0x80;
  });
  return letters && !name.empty() && name.size() <= longest_name && name.front() != '.';
}

std::uint64_t number_of(const LabRequest& request, const char* name) {
  const std::string text = request.parameter(name);
  std::uint64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

LabAnswer as_json(std::string text) {
  return {200, "application/json", std::move(text)};
}

}  // namespace

LabAnswer lab_refusal(int status, const std::string& text) {
  return {status, "text/plain; charset=utf-8", text + "\n"};
}

LabAnswer lab_refusal(const Error& error) {
  const int status = error.kind == ErrorKind::usage || error.kind == ErrorKind::bad_input ? 400 : 500;
  return {status, "application/json", json{{"error", error.message()}}.dump()};
}

LabAnswer LabAnswers::answer(const LabRequest& request) {
  if (request.name == "wish") return take_wish(request);
  if (request.name == "news") return tell_news(request);
  if (request.name == "picture") return send_picture(request);
  if (request.name == "pixel") return tell_pixel(request);
  if (request.name == "file") return take_file(request);
  return lab_refusal(404, "Nothing is here.");
}

LabAnswer LabAnswers::take_wish(const LabRequest& request) {
  if (request.body.size() > longest_wish) return lab_refusal(413, "A wish is shorter.");
  const json asked = json::parse(request.body, nullptr, false);
  const auto text = [&](const char* key) {
    return asked.is_object() && asked.contains(key) && asked[key].is_string();
  };
  if (!text("client") || !text("scene") || !asked.contains("words") || !asked["words"].is_array())
    return lab_refusal(400, "A wish has a client, a scene and words.");
  LabWish wish{asked["client"], asked["scene"], {}, {}};
  for (const json& word : asked["words"]) {
    if (!word.is_string()) return lab_refusal(400, "Words are texts.");
    wish.words.push_back(word);
  }
  if (asked.contains("preset") && asked["preset"].is_number_unsigned())
    wish.preset = asked["preset"].get<std::size_t>();
  const auto taken = engine_->ask(wish);
  return taken ? as_json(json{{"number", *taken}}.dump()) : lab_refusal(taken.error());
}

LabAnswer LabAnswers::tell_news(const LabRequest& request) {
  struct Place {
    explicit Place(std::atomic<int>& of) : count(of), number(++of) {}
    ~Place() { --count; }
    std::atomic<int>& count;
    int number;
  };
  const Place own(waiting_);
  if (own.number > waiting_pages) return lab_refusal(503, "Too many pages wait for this lab.");
  const LabMoment moment = engine_->wait(number_of(request, "after"), longest_wait_);
  return as_json(lab_reading(moment, engine_->compare_words(moment)));
}

LabAnswer LabAnswers::send_picture(const LabRequest& request) const {
  const auto picture = parse_picture(request.parameter("name"));
  if (!picture) return lab_refusal(picture.error());
  const LabMoment moment = engine_->wait(0, std::chrono::milliseconds(0));
  const Rgb8Image* image = picture_of(*moment.shown, *picture);
  if (image == nullptr) return lab_refusal(404, "Nothing is drawn yet.");
  auto png = encode_png(*image);
  if (!png) return lab_refusal(png.error());
  return {200, "image/png", std::move(*png)};
}

LabAnswer LabAnswers::tell_pixel(const LabRequest& request) const {
  const LabMoment moment = engine_->wait(0, std::chrono::milliseconds(0));
  const ImageSize size = moment.state.setup.size;
  const std::uint64_t x = number_of(request, "x"), y = number_of(request, "y");
  if (x >= static_cast<std::uint64_t>(size.width) || y >= static_cast<std::uint64_t>(size.height))
    return lab_refusal(400, "The pixel lies outside the picture.");
  return as_json(lab_pixel(moment, {static_cast<int>(x), static_cast<int>(y)}));
}

/// A file that was dropped on the page; further ones with it lie beside it.
LabAnswer LabAnswers::take_file(const LabRequest& request) {
  const std::string name = request.parameter("name");
  if (!is_plain_name(name))
    return lab_refusal(400,
                       "A file's name is of letters, digits, blanks and . - _, and at most 100 of them.");
  if (++dropped_ > static_cast<int>(most_drops))
    return lab_refusal(507, "Too many files were dropped; start the lab again.");
  const std::string path = folder_ + "/" + name;
  if (const auto written = write_file(path, request.body); !written) return lab_refusal(written.error());
  engine_->admit(name, path);
  return as_json(json{{"scene", name}}.dump());
}

std::string lab_page(const LabOptions& options, bool worker) {
  report::PageShell shell;
  shell.title = "Lab – Gnomon";
  shell.main =
      "<noscript><p>The lab is drawn by scripts, which this browser does not run. "
      "<code>gnomon compare</code> writes a page that needs none.</p></noscript>";
  shell.data = lab_facts(options, worker);
  shell.built = "lab.html";
  shell.live = worker ? report::LivePage::worker : report::LivePage::served;
  shell.skip = "Skip to the pictures";
  return report::build_page(shell).html;
}

}  // namespace gnomon::lab

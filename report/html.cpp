#include "report/html.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "scene/base/expected.h"
#include "scene/files/encodings.h"

namespace gnomon::report {

std::string escaped(std::string_view raw) {
  // Control characters first: one_line() would show them.
  std::string text(raw);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  text = one_line(text);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

namespace {

// A browser breaks lines at hyphens, also at those of "--adaptive-bias".
std::string with_whole_options(std::string_view html) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view name = "abcdefghijklmnopqrstuvwxyz0123456789-";
  std::string out;
  std::size_t copied = 0;
  for (std::size_t at = html.find("--"); at != std::string_view::npos; at = html.find("--", copied)) {
    const std::size_t end = std::min(html.find_first_not_of(name, at), html.size());
    out += html.substr(copied, at - copied);
    const bool is_option = end > at + 2 && letters.find(html[at + 2]) != std::string_view::npos;
    const std::string_view word = html.substr(at, end - at);
    if (is_option)
      out += fmt::format(R"(<span class="option">{}</span>)", word);
    else
      out += word;
    copied = end;
  }
  out += html.substr(copied);
  return out;
}

}  // namespace

std::string flowing(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool after_digit = i > 0 && std::isdigit(static_cast<unsigned char>(text[i - 1])) != 0;
    const bool after_times = i >= 2 && text.substr(i - 2, 2) == "\u00d7";
    if (text[i] == ' ' && (after_digit || after_times))
      out += "\u00a0";
    else
      out += text[i];
  }
  return with_whole_options(escaped(out));
}

std::string url_segment(std::string_view name) {
  constexpr std::string_view kept = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  std::string out;
  for (const char c : name)
    out += kept.find(c) != std::string_view::npos ? std::string(1, c)
                                                  : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

std::string data_uri(std::string_view mime, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", mime, base64(bytes));
}

void append_script_safe(std::string& html, std::string_view text) {
  const std::string json = visible_order(text);
  std::size_t copied = 0;
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', copied)) {
    html.append(json, copied, at - copied).append("\\u003c");
    copied = at + 1;
  }
  html.append(json, copied);
}

std::string hex_colour(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

std::string swatch(const glm::u8vec3& c, std::string_view letter) {
  return fmt::format(
      R"(<svg class="swatch" viewBox="0 0 22 22" aria-hidden="true" focusable="false"><rect width="22"
height="22" rx="3" fill="{}"/><text x="11" y="16" fill="{}">{}</text></svg>)",
      hex_colour(c.r, c.g, c.b), 2 * c.r + 5 * c.g + c.b > 8 * 110 ? "#000" : "#fff", letter);
}

namespace {

// A content-security-policy source for one inline block: the base64 of its SHA-256.
std::string hash_source(std::string_view block) {
  const std::string hex = sha256_hex(block);
  std::string digest;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

std::string security_policy(const PageHead& head) {
  const std::string_view beside = head.beside ? " 'self'" : "";
  const std::string_view own = head.live == LivePage::worker ? " 'self' 'wasm-unsafe-eval'" : "";
  const std::string_view live = head.live == LivePage::no       ? ""
                                : head.live == LivePage::served ? "; connect-src 'self'; frame-src 'self'"
                                                                : "; connect-src 'self'; worker-src 'self'";
  return fmt::format(
      "default-src 'none'; img-src data:{0}; style-src {1}; script-src {2}{0}{4}{3}; base-uri 'none'; "
      "form-action "
      "'none'",
      beside, hash_source(head.style), head.script.empty() ? "'none'" : hash_source(head.script), live, own);
}

}  // namespace

std::string page_head(const PageHead& head) {
  return fmt::format(
      R"(<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{}</title>
<link rel="icon" href="data:,">)",
      security_policy(head), escaped(head.title));
}

}  // namespace gnomon::report

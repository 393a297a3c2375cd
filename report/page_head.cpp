#include "report/page_head.h"

#include <fmt/core.h>

#include "report/html.h"
#include "scene/files/encodings.h"

namespace gnomon::compare {
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
  return fmt::format(
      "default-src 'none'; img-src data:{0}; style-src {1}; script-src {2}{0}; base-uri 'none'; form-action "
      "'none'",
      beside, hash_source(head.style), head.script.empty() ? "'none'" : hash_source(head.script));
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

}  // namespace gnomon::compare

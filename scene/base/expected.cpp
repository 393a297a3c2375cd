#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

#include "scene/base/expected.h"

namespace gnomon {
namespace {

// Bytes of the UTF-8 character that begins the text; 0 where none does (Unicode 15, table 3-7).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : (first >= 0xe0 ? 3 : 2);
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
  const unsigned char second = byte(1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  return overlong || beyond ? 0 : length;
}

/// Returns the number of a whole UTF-8 character.
std::uint32_t code_point(std::string_view character) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(character[i]));
  };
  if (character.size() == 1) return byte(0);
  std::uint32_t code = byte(0) & (0xffu >> (character.size() + 1));
  for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte(i) & 0x3fu);
  return code;
}

bool is_control(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0);
}

/// What changes the order in which a whole line is shown (Unicode Standard Annex 9, tables 1 to 3). Or what ends it (line and
/// paragraph separator), or is a letter that nobody sees (tags).
bool is_misleading(std::uint32_t code) {
  return code == 0x061c || code == 0x200e || code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xfeff || (code >= 0xe0000 && code <= 0xe007f);
}

/// Writes a character as JSON escapes it.
std::string unicode_escape(std::uint32_t code) {
  if (code < 0x10000) return fmt::format("\\u{:04x}", code);
  const std::uint32_t rest = code - 0x10000;
  return fmt::format("\\u{:04x}\\u{:04x}", 0xd800 + (rest >> 10), 0xdc00 + (rest & 0x3ff));
}

std::string escape_of(char c) {
  if (c == '\n') return "\\n";
  if (c == '\r') return "\\r";
  if (c == '\t') return "\\t";
  return fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
}

std::string escape_of(std::string_view bytes) {
  std::string out;
  for (const char c : bytes) out += escape_of(c);
  return out;
}

/// kept(rest) says how many bytes at the start of the rest stay as they are, escape(bytes, code) what others become.
template <class Kept, class Escape>
std::string without_unseen(std::string_view text, const Kept& kept, const Escape& escape) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::size_t plain = kept(text);
    while (plain < text.size() && text[plain] >= 0x20 && text[plain] < 0x7f) ++plain;
    out += text.substr(0, plain);
    text.remove_prefix(plain);
    if (text.empty() || plain > 0) continue;
    const std::size_t length = character_length(text);
    const std::string_view bytes = text.substr(0, std::max<std::size_t>(length, 1));
    const std::uint32_t code = length > 0 ? code_point(bytes) : 0;
    if (length == 0 || is_control(code) || is_misleading(code))
      out += escape(bytes, code);
    else
      out += bytes;
    text.remove_prefix(bytes.size());
  }
  return out;
}

}  // namespace

std::string one_line(std::string_view text) {
  return without_unseen(
      text, [](std::string_view) { return std::size_t{0}; },
      [](std::string_view bytes, std::uint32_t code) {
        return is_misleading(code) ? unicode_escape(code) : escape_of(bytes);
      });
}

std::string plain_lines(std::string_view text, std::span<const std::string_view> own) {
  const auto kept = [&](std::string_view rest) -> std::size_t {
    if (rest.front() == '\n' || rest.front() == '\t') return 1;
    if (rest.starts_with("\r\n")) return 2;
    for (const std::string_view sequence : own)
      if (rest.starts_with(sequence)) return sequence.size();
    return 0;
  };
  return without_unseen(text, kept, [](std::string_view bytes, std::uint32_t code) {
    return code >= 0x7f ? unicode_escape(code) : escape_of(bytes);
  });
}

std::string visible_order(std::string_view text) {
  return without_unseen(
      text, [](std::string_view) { return std::size_t{0}; },
      [](std::string_view bytes, std::uint32_t code) {
        return is_misleading(code) || code >= 0x7f ? fmt::format("\\{}", unicode_escape(code))
                                                   : std::string(bytes);
      });
}

std::string Error::message() const {
  std::string out;
  if (!file.empty()) {
    out += file;
    if (line > 0) out += fmt::format(":{}", line);
    if (line > 0 && column > 0) out += fmt::format(":{}", column);
    out += ": ";
  }
  if (!field.empty()) out += field + ": ";
  return one_line(out + reason);
}

}  // namespace gnomon

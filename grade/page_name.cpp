#include "grade/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "scene/files/encodings.h"

namespace gnomon::grade {

namespace {

constexpr std::size_t longest = 64;  // bytes of what stands for the student's name

struct PlainName {
  std::string text;
  bool is_whole = true;  ///< all of the student's name stands in it
};

/// A byte that is no plain letter is written in hexadecimal digits, "a_20b", as far as there is room.
PlainName plain_name(const std::string& student) {
  PlainName name;
  for (const char c : student) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain =
        byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || (c == '.' && !name.text.empty()));
    const std::string next = is_plain ? std::string(1, c) : fmt::format("_{:02x}", byte);
    if (name.text.size() + next.size() > longest) return {name.text, false};
    name.text += next;
  }
  return name;
}

std::string in_small_letters(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

std::vector<std::string> page_names(const std::vector<std::string>& students) {
  std::set<std::string> taken{"index"};
  std::vector<std::string> pages;
  for (const std::string& student : students) {
    const auto [plain, is_whole] = plain_name(student);
    const std::string hashed = fmt::format("{}-{}", plain, sha256_hex(student).substr(0, 16));
    std::string name = is_whole && !plain.empty() ? plain : hashed;
    for (int count = 0; !taken.insert(in_small_letters(name)).second; ++count)
      name = count == 0 ? hashed : fmt::format("{}-{}", hashed, count);
    pages.push_back(name + ".html");
  }
  return pages;
}

}  // namespace gnomon::grade

#include "grade/grade.h"

#include <fmt/core.h>

#include <charconv>
#include <sstream>

#include "scene/base/expected.h"
#include "scene/files/read_file.h"

namespace gnomon::grade {

std::string excerpt_at(const std::string& error, const std::string& folder) {
  constexpr int around = 3;  // lines
  if (folder.empty() || !error.starts_with(folder)) return {};
  const std::size_t colon = error.find(':', folder.size());
  if (colon == std::string::npos) return {};
  int line = 0;
  std::from_chars(error.data() + colon + 1, error.data() + error.size(), line);
  if (line < 1) return {};
  const auto text = read_file(error.substr(0, colon));
  if (!text) return {};
  std::istringstream lines(*text);
  std::string excerpt, words;
  for (int number = 1; std::getline(lines, words); ++number)
    if (number >= line - around && number <= line + around)
      excerpt += fmt::format("{} {:>4}  {}\n", number == line ? '>' : ' ', number, one_line(words));
  return excerpt;
}

}  // namespace gnomon::grade

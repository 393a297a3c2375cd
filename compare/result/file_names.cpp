// File names that carry a light's name: letters, digits, '_' and '-' stay, every other run becomes one '-'.
// Where two lights would then share a name, or one has none left, all get their number in the scene behind it.
#include <algorithm>
#include <cctype>
#include <set>

#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

std::string sanitised(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool keep = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    if (keep)
      out += c;
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  constexpr std::size_t longest = 80;  // a file's name has at most 255 bytes
  out.resize(std::min(out.size(), longest));
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::string light_file_part(std::span<const std::string> names, std::size_t which, std::size_t number) {
  const std::string own = sanitised(names[which]);
  std::set<std::string> seen{""};
  bool all_differ = true;
  for (const std::string& other : names)
    if (!seen.insert(in_small_letters(sanitised(other))).second) all_differ = false;
  if (all_differ) return own;
  return (own.empty() ? "light" : own) + "-" + std::to_string(number);
}

std::string light_file_part(const Comparison& c, const LightComparison& light) {
  std::vector<std::string> names;
  for (const LightComparison& other : c.lights) names.push_back(light_of(c, other).name);
  return light_file_part(names, std::size_t(&light - c.lights.data()), light.light);
}

std::string aov_path(const Comparison& c, const LightComparison& light, const std::string& path) {
  if (c.lights.size() < 2) return path;
  const std::size_t slash = path.find_last_of('/');
  const std::size_t dot = path.find_last_of('.');
  const bool has_extension = dot != std::string::npos && (slash == std::string::npos || dot > slash + 1);
  const std::size_t end = has_extension ? dot : path.size();
  return path.substr(0, end) + "-" + light_file_part(c, light) + path.substr(end);
}

}  // namespace gnomon::compare

#include "grade/participant.h"

#include <fmt/core.h>

#include <regex>

namespace gnomon::grade {

namespace {

std::optional<Participant> in_moodle(const std::string& name) {
  static const std::regex form(R"re(([\s\S]*)_([0-9]+)_assignsubmission_([a-z]+)(_([\s\S]*))?)re");
  std::smatch found;
  if (!std::regex_match(name, found, form)) return {};
  const std::string folder =
      fmt::format("{}_{}_assignsubmission_{}", found[1].str(), found[2].str(), found[3].str());
  return Participant{Platform::moodle, found[1], found[2], found[5].length() == 0 ? name : folder, found[5]};
}

std::optional<Participant> in_canvas(const std::string& name) {
  static const std::regex form(R"re(([\s\S]+?)_(LATE_)?([0-9]+)_([0-9]+)_([\s\S]+))re");
  std::smatch found;
  if (!std::regex_match(name, found, form)) return {};
  return Participant{Platform::canvas, found[1], found[3], name, found[5]};
}

std::optional<Participant> in_blackboard(const std::string& name) {
  static const std::regex form(R"re(([\s\S]+)_([^_]+)_attempt_([0-9]{4}(-[0-9]{2}){5})(_([\s\S]+)|\.txt))re");
  std::smatch found;
  if (!std::regex_match(name, found, form)) return {};
  return Participant{Platform::blackboard, found[2], found[2], name,
                     found[6].matched ? found[6].str() : "attempt.txt"};
}

std::optional<Participant> in_brightspace(const std::string& name) {
  static const std::regex form(
      R"re(([0-9]+-[0-9]+) - ([\s\S]+?) - ([A-Z][a-z]+ [0-9]+, [0-9]+ [0-9: ]+[AP]M)( - ([\s\S]+))?)re");
  std::smatch found;
  if (!std::regex_match(name, found, form)) return {};
  return Participant{Platform::brightspace, found[2], found[1], name, found[5]};
}

}  // namespace

std::optional<Participant> participant_in(const std::string& name, bool is_folder) {
  // Longer names than file systems have would keep std::regex busy.
  if (name.size() > 1024) return {};
  for (const auto form : {in_moodle, in_blackboard, in_brightspace, in_canvas}) {
    auto found = form(name);
    if (!found) continue;
    const bool names_file = !found->file.empty();
    if (is_folder && names_file) continue;
    if (!is_folder && !names_file) continue;
    return found;
  }
  return {};
}

}  // namespace gnomon::grade

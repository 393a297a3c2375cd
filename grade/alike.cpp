#include "grade/alike.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <set>

#include "grade/expand_macros.h"
#include "raster/programs/shader_folder.h"

namespace gnomon::grade {
namespace {

constexpr std::size_t passage = 8;             // words
constexpr std::size_t fewest = 12;             // passages of one's own, for anything to be said
constexpr std::size_t class_with_customs = 6;  // answers, from which on what half of them has is nobody's own
constexpr double alike_from = 0.8;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_of_word(char c) {
  return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Returns the place behind what has no meaning: blanks, comments, and at a line's begin preprocessor lines.
std::size_t skip_blank(std::string_view text, std::size_t at) {
  const auto behind = [&](std::string_view end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  if (std::isspace(static_cast<unsigned char>(text[at])) != 0) return at + 1;
  if (text.substr(at, 2) == "//" || text[at] == '#') return behind("\n", at);
  if (text.substr(at, 2) == "/*") return behind("*/", at + 2);
  return at;
}

/// A number's digits, point and exponent are one word, and so is a name.
std::size_t end_of_word(std::string_view text, std::size_t at) {
  if (!is_of_word(text[at]) && text[at] != '.') return at + 1;
  const bool number = !is_letter(text[at]);
  std::size_t end = at + 1;
  while (end < text.size() && (is_of_word(text[end]) || (number && text[end] == '.'))) ++end;
  return end;
}

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t next = skip_blank(text, at); next != at) {
      at = next;
      continue;
    }
    const std::size_t end = end_of_word(text, at);
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

using Passages = std::set<std::size_t>;  // hashes

Passages passages_of(std::string_view text, const std::vector<std::string>& known) {
  const std::vector<std::string> words = plain_words(with_macros_put_in(std::string(text)), known);
  Passages out;
  for (std::size_t i = 0; i + passage <= words.size(); ++i) {
    std::string joined;
    for (std::size_t k = 0; k < passage; ++k) joined += words[i + k] + ' ';
    out.insert(std::hash<std::string>{}(joined));
  }
  return out;
}

std::vector<std::string> names_in_all(const std::vector<std::string>& texts) {
  std::set<std::string> names;
  for (const std::string& text : texts)
    for (const std::string_view word : words_of(text))
      if (is_letter(word.front())) names.emplace(word);
  return {names.begin(), names.end()};
}

/// Of each answer what is its own.
std::vector<Passages> own_passages(const std::vector<Answer>& answers,
                                   const std::vector<std::string>& given) {
  const std::vector<std::string> known = names_in_all(given);
  Passages begun;
  for (const std::string& text : given) begun.merge(passages_of(text, known));
  std::vector<Passages> all;
  std::map<std::size_t, std::size_t> count;
  for (const Answer& answer : answers) {
    Passages passages = passages_of(answer, known);
    std::erase_if(passages, [&](std::size_t hash) { return begun.contains(hash); });
    for (const std::size_t hash : passages) ++count[hash];
    all.push_back(std::move(passages));
  }
  if (answers.size() < class_with_customs) return all;
  for (Passages& passages : all)
    std::erase_if(passages, [&](std::size_t hash) { return 2 * count[hash] >= answers.size(); });
  return all;
}

}  // namespace

std::vector<std::string> plain_words(std::string_view shader, const std::vector<std::string>& known) {
  std::vector<std::string> words;
  for (const std::string_view word : words_of(shader)) {
    const bool renamed =
        is_letter(word.front()) && !std::binary_search(known.begin(), known.end(), word, std::less<>());
    words.emplace_back(renamed ? "name" : word);
  }
  return words;
}

std::vector<AlikePair> find_alike(const std::vector<Answer>& answers, const std::vector<std::string>& given) {
  const std::vector<Passages> own = own_passages(answers, given);
  std::vector<AlikePair> pairs;
  for (std::size_t i = 0; i < answers.size(); ++i)
    for (std::size_t j = i + 1; j < answers.size(); ++j) {
      AlikePair pair{i, j, 0.0, !answers[i].empty() && answers[i] == answers[j]};
      const std::size_t shorter = std::min(own[i].size(), own[j].size());
      if (pair.same_text) pair.share = 1.0;
      if (!pair.same_text && shorter >= fewest) {
        const auto both =
            std::ranges::count_if(own[i], [&](std::size_t hash) { return own[j].contains(hash); });
        pair.share = static_cast<double>(both) / static_cast<double>(shorter);
      }
      if (pair.share >= alike_from) pairs.push_back(pair);
    }
  std::ranges::stable_sort(pairs, [](const AlikePair& a, const AlikePair& b) { return a.share > b.share; });
  return pairs;
}

std::vector<AlikeGroup> groups_of(const std::vector<AlikePair>& pairs) {
  std::vector<AlikeGroup> groups;
  std::map<std::size_t, std::size_t> group_of;
  const auto join = [&](std::size_t a, std::size_t b) {
    for (const std::size_t student : groups[b].students)
      group_of[student] = a, groups[a].students.push_back(student);
    groups[a].share = std::min(groups[a].share, groups[b].share);
    groups[a].same_text = groups[a].same_text && groups[b].same_text;
    groups[b].students.clear();
  };
  for (const AlikePair& pair : pairs) {
    for (const std::size_t student : {pair.first, pair.second})
      if (group_of.emplace(student, groups.size()).second) groups.push_back({{student}, 1.0, true});
    const std::size_t a = group_of[pair.first], b = group_of[pair.second];
    if (a != b) join(a, b);
    groups[a].share = std::min(groups[a].share, pair.share);
    groups[a].same_text = groups[a].same_text && pair.same_text;
  }
  std::erase_if(groups, [](const AlikeGroup& group) { return group.students.empty(); });
  for (AlikeGroup& group : groups) std::ranges::sort(group.students);
  std::ranges::stable_sort(groups, [](const AlikeGroup& a, const AlikeGroup& b) {
    return a.students.size() != b.students.size() ? a.students.size() > b.students.size() : a.share > b.share;
  });
  return groups;
}

std::vector<AlikePair> alike_in(const std::vector<Answer>& answers, const Rubric& rubric) {
  std::vector<std::string> given = rubric.begun;
  for (const GivenFile& file : rubric.given) given.push_back(file.text);
  for (const raster::ShaderFile& file : raster::own_shaders()) given.emplace_back(file.text);
  return find_alike(answers, given);
}

}  // namespace gnomon::grade

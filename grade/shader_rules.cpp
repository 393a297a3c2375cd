#include "grade/shader_rules.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "grade/glsl_names.h"
#include "raster/programs/shader_folder.h"

namespace gnomon::grade {

namespace {

/// Whole lines, without what ends them: a feed, a return, or both.
std::vector<std::string> plain_lines(const std::string& text) {
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool ends = text[i] == '\n' || text[i] == '\r';
    if (!ends) {
      lines.back() += text[i];
      continue;
    }
    if (i + 1 < text.size() && (text[i + 1] == '\n' || text[i + 1] == '\r') && text[i + 1] != text[i]) ++i;
    lines.emplace_back();
  }
  return lines;
}

std::vector<LogicalLine> joined_lines(const std::string& text) {
  std::vector<LogicalLine> lines;
  int number = 0;
  bool goes_on = false;
  for (std::string& line : plain_lines(text)) {
    ++number;
    if (!goes_on) lines.push_back({number, {}});
    goes_on = line.ends_with('\\');
    if (goes_on) line.pop_back();
    lines.back().text += line;
  }
  return lines;
}

/// A comment is a blank, however many lines it takes.
void blank_comments(std::vector<LogicalLine>& lines) {
  bool in_comment = false;
  for (LogicalLine& line : lines) {
    std::string out;
    for (std::size_t i = 0; i < line.text.size(); ++i) {
      const std::string_view two = std::string_view(line.text).substr(i, 2);
      if (in_comment) {
        if (two != "*/") continue;
        in_comment = false, ++i;
      } else if (two == "//") {
        break;
      } else if (two == "/*") {
        in_comment = true, ++i, out += ' ';
      } else {
        out += line.text[i];
      }
    }
    line.text = std::move(out);
  }
}

std::string name_at_begin(const std::string& text) {
  const auto end = std::ranges::find_if_not(text, is_letter_of_name);
  return {text.begin(), end};
}

void add_names(const std::vector<LogicalLine>& lines, std::set<std::string>& names) {
  for (const LogicalLine& line : lines)
    for (auto at = line.text.begin(); at != line.text.end();) {
      const auto begin = std::find_if(at, line.text.end(), is_letter_of_name);
      at = std::find_if_not(begin, line.text.end(), is_letter_of_name);
      if (begin != at && std::isdigit(static_cast<unsigned char>(*begin)) == 0) names.emplace(begin, at);
    }
}

std::string text_of_own(std::string_view name) {
  for (const raster::ShaderFile& file : raster::own_shaders())
    if (file.name == name) return std::string(file.text);
  return {};
}

/// Those that the program's shaders define or ask for, "PERSPECTIVE": what begins with a small letter is no such name.
std::set<std::string> macros_of_program() {
  std::set<std::string> names;
  for (const raster::ShaderFile& file : raster::own_shaders())
    for (const LogicalLine& line : logical_lines(std::string(file.text))) {
      const Directive directive = directive_of(line.text);
      if (directive.word == "define") names.insert(name_at_begin(directive.rest));
      if (directive.word.starts_with("if") || directive.word == "elif")
        add_names({{line.number, directive.rest}}, names);
    }
  return names;
}

/// The names of what stands around the student's file.
std::set<std::string> names_around(const Rubric& rubric) {
  static const std::set<std::string> of_program = macros_of_program();
  std::set<std::string> names = of_program;
  for (const GivenFile& file : rubric.given) add_names(logical_lines(file.text), names);
  if (rubric.technique.empty()) add_names(logical_lines(text_of_own("function/call.frag")), names);
  // Components, "x" and "r": a macro of such a name ends with its file as all others do.
  std::erase_if(names, [](const std::string& name) { return name.size() < 2; });
  return names;
}

bool keeps_to_itself(const Rubric& rubric) {
  return rubric.technique.empty() || !rubric.given.empty();
}

/// Why one line of the preprocessor's is refused.
std::string why_not(const Directive& line, const std::set<std::string>& around, bool strict) {
  if (line.word == "line" || line.word == "extension" || line.word == "version")
    return fmt::format("#{} is not allowed in an exercise", line.word);
  const std::string name = name_at_begin(line.rest);
  const bool is_taken = is_glsl_name(name) || around.contains(name);
  if (line.word == "define" && is_taken)
    return fmt::format("#define {}: the name is {}, which no macro may take", name,
                       is_glsl_name(name) ? "GLSL's" : "the program's");
  if (line.word == "undef" && strict) return "has an #undef, which this exercise does not allow";
  if (line.word == "undef" && is_taken) return fmt::format("#undef {}: the name is not this file's", name);
  if (strict && line.rest.find("##") != std::string::npos)
    return "## puts names together, which this exercise does not allow";
  if (line.word != "include" || !strict) return {};
  const std::size_t open = line.rest.find('"'), close = line.rest.rfind('"');
  const std::string included = open < close ? line.rest.substr(open + 1, close - open - 1) : std::string();
  return text_of_own(included).empty()
             ? std::string()
             : fmt::format("includes the program's {}, which does what the exercise asks for", included);
}

/// Names by which a function would find more than it is handed; the first one on a line.
std::string forbidden_word(const std::string& line) {
  std::set<std::string> names;
  add_names({{1, line}}, names);
  for (const std::string& name : names)
    if (name == "uniform" || name == "buffer" || name == "layout" || name.starts_with("texelFetch") ||
        name.starts_with("gl_"))
      return name;
  return {};
}

}  // namespace

bool is_letter_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::vector<LogicalLine> logical_lines(const std::string& text) {
  std::vector<LogicalLine> lines = joined_lines(text);
  blank_comments(lines);
  return lines;
}

Directive directive_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\v\f";
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return {};
  line.remove_prefix(1);
  skip_blanks();
  const std::size_t end =
      static_cast<std::size_t>(std::ranges::find_if_not(line, is_letter_of_name) - line.begin());
  Directive directive{end > 0 ? std::string(line.substr(0, end)) : "#", {}};
  line.remove_prefix(end);
  skip_blanks();
  directive.rest = line;
  return directive;
}

std::string why_refused(const std::string& place, const std::string& text, const Rubric& rubric,
                        bool* of_macro) {
  const std::set<std::string> around = names_around(rubric);
  for (const LogicalLine& line : logical_lines(text)) {
    const Directive directive = directive_of(line.text);
    std::string reason =
        directive.word.empty() ? std::string() : why_not(directive, around, keeps_to_itself(rubric));
    if (reason.empty() && rubric.technique.empty())
      if (const std::string word = forbidden_word(line.text); !word.empty())
        reason = fmt::format(
            "has the word {}, which this exercise does not allow: a function is handed what it needs", word);
    if (reason.empty()) continue;
    if (of_macro != nullptr) *of_macro = directive.word == "define";
    return fmt::format("{}:{}: {}", place, line.number, reason);
  }
  return {};
}

std::string ending_macros(const std::string& text) {
  std::set<std::string> names;
  for (const LogicalLine& line : logical_lines(text))
    if (const Directive directive = directive_of(line.text); directive.word == "define")
      if (const std::string name = name_at_begin(directive.rest); !name.empty()) names.insert(name);
  std::string lines;
  for (const std::string& name : names) lines += fmt::format("#undef {}\n", name);
  return lines.empty() ? lines : "\n\n" + lines;
}

}  // namespace gnomon::grade

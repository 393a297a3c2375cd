#include "scene/files/obj_check.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "scene/files/read_file.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

// Walks through lines and words; the words point into the text, so that their offset is at hand.
class ObjChecker {
 public:
  ObjChecker(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Expected<ObjSurvey> run() {
    if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
      add(text_.substr(nul, 1), {}, "byte 0 in a text file (allowed: UTF-8 text)");
      return fail(std::move(*error_));
    }
    for_each_line([&](std::string_view line) { count(line); });
    for_each_line([&](std::string_view line) { check(line); });
    if (error_) return fail(std::move(*error_));
    return survey_;
  }

 private:
  enum Kind : std::size_t { vertex, texcoord, normal };

  // The first such character, or the end. (find_first_of asks memchr about every character.)
  template <class Is>
  static std::size_t next(std::string_view text, std::size_t at, const Is& is) {
    while (at < text.size() && !is(text[at])) ++at;
    return at;
  }

  template <class Visit>
  void for_each_line(const Visit& visit) {
    seen_ = {};
    for (std::size_t at = 0; at < text_.size() && !error_;) {
      const std::size_t end = next(text_, at, [](char c) { return c == '\r' || c == '\n'; });
      visit(text_.substr(at, end - at));
      at = end + 1;
    }
  }

  // Takes the next word off the line; empty at its end.
  static std::string_view next_word(std::string_view& line) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    const std::size_t begin = next(line, 0, [&](char c) { return !is_blank(c); });
    const std::size_t end = next(line, begin, is_blank);
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
  }

  static std::optional<Kind> kind_of(std::string_view word) {
    if (word == "v") return vertex;
    if (word == "vt") return texcoord;
    if (word == "vn") return normal;
    return std::nullopt;
  }

  void count(std::string_view line) {
    if (const auto kind = kind_of(next_word(line))) ++total_[*kind];
  }

  void check(std::string_view line) {
    const std::string_view whole = line;
    const std::string_view word = next_word(line);
    if (word.empty() || word.front() == '#') return;
    if (const auto kind = kind_of(word)) {
      ++seen_[*kind];
      check_numbers(whole, line, *kind);
    } else if (word == "f") {
      check_face(whole, line);
    } else if (word == "p") {
      ++survey_.points;
    } else if (word == "l") {
      ++survey_.lines;
    }
  }

  void check_numbers(std::string_view whole, std::string_view line, Kind kind) {
    static constexpr std::array<std::size_t, 3> needed{3, 1, 3};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#' && !error_;
         word = next_word(line)) {
      check_number(word, kind);
      ++count;
    }
    if (count < needed[kind])
      add(whole, "", fmt::format("too few coordinates (got {}, allowed {} or more)", count, needed[kind]));
    if (kind == vertex && count >= 6) survey_.has_vertex_colors = true;
  }

  void check_number(std::string_view word, Kind kind) {
    const auto value = parse_decimal(word);
    if (!value)
      return add(word, "",
                 fmt::format("not a finite number (got {}, allowed for example -1.5e2)", printable(word)));
    if (kind == vertex && std::abs(*value) > max_coordinate)
      add(word, "",
          fmt::format("coordinate (got {}, allowed up to {:g} in magnitude)", printable(word),
                      max_coordinate));
  }

  void check_face(std::string_view whole, std::string_view line) {
    std::size_t corners = 0;
    for (std::string_view word = next_word(line); !word.empty() && word.front() != '#' && !error_;
         word = next_word(line)) {
      check_corner(word);
      ++corners;
    }
    if (corners > max_polygon_corners)
      return add(whole, "f",
                 fmt::format("too many corners (got {}, allowed 3 to {})", corners, max_polygon_corners));
    if (corners < 3 && survey_.small_faces++ == 0) {
      survey_.first_small_face_line =
          line_column(text_, static_cast<std::size_t>(whole.data() - text_.data())).line;
    }
  }

  // "7", "7/2", "7//3" or "7/2/3".
  void check_corner(std::string_view word) {
    std::string_view rest = word;
    for (std::size_t kind = vertex; kind <= normal; ++kind) {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const std::string_view part = rest.substr(0, slash);
      const bool may_be_empty = kind == texcoord && slash < rest.size();
      if (!part.empty() || !may_be_empty) check_index(part.empty() ? word : part, static_cast<Kind>(kind));
      if (slash == rest.size()) return;
      rest.remove_prefix(slash + 1);
    }
    add(word, "f", fmt::format("too many slashes (got {}, allowed v/vt/vn)", printable(word)));
  }

  void check_index(std::string_view word, Kind kind) {
    static constexpr std::array<std::string_view, 3> names{"vertex", "texture coordinate", "normal"};
    long long index = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (status != std::errc() || end != word.data() + word.size())
      return add(word, "f", fmt::format("not an index (got {}, allowed a whole number)", printable(word)));
    const auto total = static_cast<long long>(total_[kind]);
    const auto before = static_cast<long long>(seen_[kind]);
    if ((index >= 1 && index <= total) || (index <= -1 && index >= -before)) return;
    add(word, "f",
        fmt::format(
            "{} index out of range (got {}, allowed {})", names[kind], index,
            total == 0 ? "none: the file has none" : fmt::format("1 to {} or -{} to -1", total, before)));
  }

  void add(std::string_view where, std::string field, std::string reason) {
    if (error_) return;
    const LineColumn at = line_column(text_, static_cast<std::size_t>(where.data() - text_.data()));
    error_ = Error{ErrorKind::bad_input, std::move(reason), file_, at.line, at.column, std::move(field)};
  }

  std::string_view text_;
  const std::string& file_;
  std::array<std::size_t, 3> total_{}, seen_{};
  ObjSurvey survey_;
  std::optional<Error> error_;
};

}  // namespace

void blank_continuations_and_comments(std::string& text) {
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    const std::size_t end = text.compare(at + 1, 2, "\r\n") == 0 ? at + 3 : at + 2;
    if (end > text.size() || text[end - 1] != '\n') continue;
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end),
              ' ');
  }
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find('\n', line), text.size());
    const std::string_view row = std::string_view(text).substr(line, end - line);
    const std::size_t word = std::min(row.find_first_not_of(" \t"), row.size());
    const std::size_t comment = row.find('#');  // looked for in this line alone: a file may have none
    const bool is_data =
        word < row.size() && std::string_view("vflp").find(row[word]) != std::string_view::npos;
    if (is_data && comment != std::string_view::npos)
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(line + comment),
                text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
    line = end + 1;
  }
}

Expected<ObjSurvey> check_obj(std::string_view text, const std::string& file) {
  return ObjChecker(text, file).run();
}

}  // namespace gnomon

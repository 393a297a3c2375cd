#include "scene/files/obj/obj_text.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "scene/files/read_file.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// The first such character, or the end. (find_first_of asks memchr about every character.)
template <class Is>
std::size_t next(std::string_view text, std::size_t at, const Is& is) {
  while (at < text.size() && !is(text[at])) ++at;
  return at;
}

/// Takes the next word off the line; empty at its end.
std::string_view next_word(std::string_view& line) {
  const std::size_t begin = next(line, 0, [](char c) { return !is_blank(c); });
  const std::size_t end = next(line, begin, is_blank);
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// Without the blanks at both ends.
std::string_view trimmed(std::string_view line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line;
}

std::string_view without_comment(std::string_view line) {
  return line.substr(0, next(line, 0, [](char c) { return c == '#'; }));
}

/// What a `mtllib` statement may name: one file with blanks in its name, or several that blanks divide. A backslash
/// makes a blank part of the name; any other divides folders, as those of Windows do.
std::vector<std::string> library_names(std::string_view line) {
  std::string whole;
  std::vector<std::string> names(1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool escapes = line[i] == '\\' && i + 1 < line.size() && is_blank(line[i + 1]);
    if (escapes) ++i;
    const char c = line[i] == '\\' ? '/' : line[i];
    whole += c;
    if (is_blank(c) && !escapes)
      names.emplace_back();
    else
      names.back() += c;
  }
  std::erase(names, std::string());
  if (names.size() > 1) names.insert(names.begin(), whole);
  return names;
}

/// Words point into the text, so that their offset is at hand.
class ObjReader {
 public:
  /// `text` is what the file says with continued lines joined, `written` what stands in it.
  ObjReader(std::string_view text, std::string_view written, const std::string& file,
            const MaterialLibraries& libraries)
      : text_(text), written_(written), file_(file), libraries_(libraries) {}

  Expected<ObjText> run() {
    if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
      add(text_.substr(nul, 1), {}, "byte 0 in a text file (allowed: UTF-8 text)");
      return fail(std::move(*error_));
    }
    for_each_line([&](std::string_view line) { count(line); });
    out_.positions.reserve(total_[vertex]), out_.texcoords.reserve(total_[texcoord]);
    out_.normals.reserve(total_[normal]);
    for_each_line([&](std::string_view line) { read(line); });
    if (error_) return fail(std::move(*error_));
    if (!out_.colors.empty()) out_.colors.resize(out_.positions.size(), Vec3f(1.0f));
    end_shape();
    return std::move(out_);
  }

 private:
  enum Kind : std::size_t { vertex, texcoord, normal };

  template <class Visit>
  void for_each_line(const Visit& visit) {
    for (std::size_t at = 0; at < text_.size() && !error_;) {
      const std::size_t end = next(text_, at, [](char c) { return c == '\r' || c == '\n'; });
      visit(text_.substr(at, end - at));
      at = end + 1;
    }
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

  void read(std::string_view line) {
    const std::string_view whole = line;
    const std::string_view word = next_word(line);
    if (word.empty() || word.front() == '#') return;
    if (const auto kind = kind_of(word))
      read_numbers(whole, without_comment(line), *kind);
    else if (word == "f")
      read_face(whole, without_comment(line));
    else if (word == "p")
      ++out_.points;
    else if (word == "l")
      ++out_.lines;
    else if (word == "o" || word == "g")
      begin_shape(whole, word == "o" ? std::string(trimmed(line)) : group_name(line));
    else if (word == "usemtl")
      use_material(line);
    else if (word == "mtllib")
      read_library(trimmed(line));
  }

  // Coordinates

  void read_numbers(std::string_view whole, std::string_view line, Kind kind) {
    static constexpr std::array<std::size_t, 3> needed{3, 1, 3};
    std::array<double, 6> numbers{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty() && !error_; word = next_word(line)) {
      const double value = number(word, kind);
      if (count < numbers.size()) numbers[count] = value;
      ++count;
    }
    if (count < needed[kind])
      add(whole, "", fmt::format("too few coordinates (got {}, allowed {} or more)", count, needed[kind]));
    ++seen_[kind];
    if (kind == vertex) out_.positions.emplace_back(numbers[0], numbers[1], numbers[2]);
    if (kind == texcoord) out_.texcoords.emplace_back(numbers[0], numbers[1]);
    if (kind == normal) out_.normals.emplace_back(Vec3(numbers[0], numbers[1], numbers[2]));
    if (kind != vertex || count < 6) return;
    out_.colors.resize(out_.positions.size(), Vec3f(1.0f));
    out_.colors.back() = Vec3f(Vec3(numbers[3], numbers[4], numbers[5]));
  }

  double number(std::string_view word, Kind kind) {
    const auto value = parse_decimal(word);
    if (!value)
      add(word, "", fmt::format("not a finite number (got {}, allowed for example -1.5e2)", printable(word)));
    else if (kind == vertex && std::abs(*value) > max_coordinate)
      add(word, "",
          fmt::format("coordinate (got {}, allowed up to {:g} in magnitude)", printable(word),
                      max_coordinate));
    return value.value_or(0.0);
  }

  // Faces

  void read_face(std::string_view whole, std::string_view line) {
    const std::size_t first = out_.corners.size();
    for (std::string_view word = next_word(line); !word.empty() && !error_; word = next_word(line))
      out_.corners.push_back(corner(word));
    const std::size_t corners = out_.corners.size() - first;
    if (corners > max_polygon_corners)
      return add(whole, "f",
                 fmt::format("too many corners (got {}, allowed 3 to {})", corners, max_polygon_corners));
    if (corners >= 3) return out_.faces.push_back({first, corners, material_});
    out_.corners.resize(first);
    if (out_.small_faces++ == 0) out_.first_small_face_line = line_of(whole);
  }

  /// "7", "7/2", "7//3" or "7/2/3"; some programs write "7/2/", "7/" and "7//", too.
  ObjCorner corner(std::string_view word) {
    std::array<int, 3> of{-1, -1, -1};
    std::string_view rest = word;
    for (std::size_t kind = vertex; kind <= normal; ++kind) {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const std::string_view part = rest.substr(0, slash);
      if (!part.empty() || kind == vertex)
        of[kind] = index(part.empty() ? word : part, static_cast<Kind>(kind));
      if (slash == rest.size()) return {of[vertex], of[texcoord], of[normal]};
      rest.remove_prefix(slash + 1);
    }
    add(word, "f", fmt::format("too many slashes (got {}, allowed v/vt/vn)", printable(word)));
    return {};
  }

  /// From 0.
  int index(std::string_view word, Kind kind) {
    static constexpr std::array<std::string_view, 3> names{"vertex", "texture coordinate", "normal"};
    long long index = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (status != std::errc() || end != word.data() + word.size()) {
      add(word, "f", fmt::format("not an index (got {}, allowed a whole number)", printable(word)));
      return -1;
    }
    const auto total = static_cast<long long>(total_[kind]);
    if (total == 0 && kind != vertex) {
      out_.warnings.insert(fmt::format("Faces name {}s, of which the file has none", names[kind]));
      return -1;
    }
    const auto before = static_cast<long long>(seen_[kind]);
    if (index >= 1 && index <= total) return static_cast<int>(index - 1);
    if (index <= -1 && index >= -before) return static_cast<int>(before + index);
    add(word, "f",
        fmt::format(
            "{} index out of range (got {}, allowed {})", names[kind], index,
            total == 0 ? "none: the file has none" : fmt::format("1 to {} or -{} to -1", total, before)));
    return -1;
  }

  // Objects, groups and materials

  std::string group_name(std::string_view line) {
    std::string name;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
      name.append(name.empty() ? "" : " ").append(word);
    return name;
  }

  void begin_shape(std::string_view whole, std::string name) {
    end_shape();
    if (name.empty()) out_.warnings.insert(fmt::format("Empty group name. line: {}", line_of(whole)));
    shape_ = {std::move(name), out_.faces.size(), 0};
  }

  void end_shape() {
    shape_.faces = out_.faces.size() - shape_.first_face;
    if (shape_.faces > 0) out_.shapes.push_back(std::move(shape_));
  }

  /// A name may hold blanks; what follows a name without them is no part of it.
  void use_material(std::string_view line) {
    const std::string name(trimmed(line));
    material_ = libraries_.find(name);
    if (material_ < 0) material_ = libraries_.find(std::string(next_word(line)));
    if (material_ < 0)
      out_.warnings.insert(fmt::format("The material '{}' {}; its faces are neutral grey.", printable(name),
                                       libraries_read_.empty()
                                           ? "is named, and no material library was read"
                                           : fmt::format("is not in {}", fmt::join(libraries_read_, ", "))));
  }

  /// The first of the names that can be used.
  void read_library(std::string_view line) {
    std::string why = "no name";
    for (const std::string& name : library_names(line)) {
      if (libraries_read_.count(name) > 0) return;
      const auto done = libraries_.read(name);
      if (!done) {
        error_ = done.error();
        return;
      }
      if (done->empty()) {
        libraries_read_.insert(name);
        return;
      }
      why = *done;
    }
    out_.warnings.insert(fmt::format(
        "The material library {} cannot be used ({}); its materials are neutral grey.", line, why));
  }

  LineColumn place_of(std::string_view where) const {
    return line_column(written_, static_cast<std::size_t>(where.data() - text_.data()));
  }
  int line_of(std::string_view where) const { return place_of(where).line; }

  void add(std::string_view where, std::string field, std::string reason) {
    if (error_) return;
    const LineColumn at = place_of(where);
    error_ = Error{ErrorKind::bad_input, std::move(reason), file_, at.line, at.column, std::move(field)};
  }

  std::string_view text_, written_;
  const std::string& file_;
  const MaterialLibraries& libraries_;
  std::array<std::size_t, 3> total_{}, seen_{};
  ObjText out_;
  ObjShape shape_;
  int material_ = -1;
  std::set<std::string> libraries_read_;
  std::optional<Error> error_;
};

}  // namespace

std::string join_continued_lines(std::string_view bytes) {
  std::string text(bytes);
  for (std::size_t at = text.find('\\'); at != std::string::npos; at = text.find('\\', at + 1)) {
    const std::size_t end = text.compare(at + 1, 2, "\r\n") == 0 ? at + 3 : at + 2;
    if (end > text.size() || text[end - 1] != '\n') continue;
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end),
              ' ');
  }
  return text;
}

Expected<ObjText> parse_obj(std::string_view bytes, const std::string& file,
                            const MaterialLibraries& libraries) {
  bytes = without_byte_order_mark(bytes);
  if (bytes.find('\\') == std::string_view::npos) return ObjReader(bytes, bytes, file, libraries).run();
  const std::string text = join_continued_lines(bytes);
  return ObjReader(text, bytes, file, libraries).run();
}

}  // namespace gnomon

#include "scene/files/ply/ply_header.h"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "scene/files/read_file.h"

namespace gnomon {
namespace {

std::optional<PlyType> type_of(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{
      {{"char", PlyType::int8},
       {"int8", PlyType::int8},
       {"uchar", PlyType::uint8},
       {"uint8", PlyType::uint8},
       {"short", PlyType::int16},
       {"int16", PlyType::int16},
       {"ushort", PlyType::uint16},
       {"uint16", PlyType::uint16},
       {"int", PlyType::int32},
       {"int32", PlyType::int32},
       {"uint", PlyType::uint32},
       {"uint32", PlyType::uint32},
       {"float", PlyType::float32},
       {"float32", PlyType::float32},
       {"double", PlyType::float64},
       {"float64", PlyType::float64}}};
  for (const auto& [name, type] : names)
    if (name == word) return type;
  return std::nullopt;
}

bool is_whole(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  Expected<PlyHeader> run() {
    if (next_line() != "ply") return error("not a PLY file (its first line must be \"ply\")");
    bool has_format = false;
    while (at_ < bytes_.size()) {
      const std::string_view line = next_line();
      words_ = line;
      const std::string_view word = next_word();
      if (word == "end_header") {
        if (!has_format) return error("the header has no format line");
        header_.data_begin = at_;
        return check_counts();
      }
      Expected<void> done;
      if (word == "format")
        done = read_format(), has_format = true;
      else if (word == "element")
        done = read_element();
      else if (word == "property")
        done = read_property();
      else if (word == "comment")
        read_comment();
      else if (word != "obj_info" && !word.empty())
        return error(
            fmt::format("unknown header line (got \"{}\", allowed format, element, property, comment, "
                        "obj_info, end_header)",
                        printable(word)));
      if (!done) return fail(done.error());
    }
    return error("the header does not end (there is no end_header line)");
  }

 private:
  std::string_view next_line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  std::string_view next_word() {
    const std::size_t begin = std::min(words_.find_first_not_of(" \t"), words_.size());
    const std::size_t end = std::min(words_.find_first_of(" \t", begin), words_.size());
    const std::string_view word = words_.substr(begin, end - begin);
    words_.remove_prefix(end);
    return word;
  }

  tl::unexpected<Error> error(std::string reason, std::string field = {}) const {
    return error_in_line(line_, std::move(reason), std::move(field));
  }
  tl::unexpected<Error> error_in_line(int line, std::string reason, std::string field = {}) const {
    return fail(Error{ErrorKind::bad_input, std::move(reason), file_, line, 1, std::move(field)});
  }

  Expected<void> read_format() {
    const std::string_view name = next_word();
    if (name == "ascii")
      header_.encoding = PlyEncoding::ascii;
    else if (name == "binary_little_endian")
      header_.encoding = PlyEncoding::little_endian;
    else if (name == "binary_big_endian")
      header_.encoding = PlyEncoding::big_endian;
    else
      return error(fmt::format("unknown (got \"{}\", allowed ascii, binary_little_endian, binary_big_endian)",
                               printable(name)),
                   "format");
    const std::string_view version = next_word();
    if (version != "1.0")
      return error(fmt::format("unknown version (got \"{}\", allowed 1.0)", printable(version)), "format");
    return {};
  }

  void read_comment() {
    if (next_word() == "TextureFile") header_.texture = std::string(next_word());
  }

  Expected<void> read_element() {
    PlyElement element;
    element.name = std::string(next_word());
    element.line = line_;
    const std::string_view count = next_word();
    const auto [end, status] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || status != std::errc() || end != count.data() + count.size())
      return error(fmt::format("element count (got \"{}\", allowed a whole number from 0)", printable(count)),
                   printable(element.name));
    header_.elements.push_back(std::move(element));
    return {};
  }

  Expected<void> read_property() {
    if (header_.elements.empty()) return error("a property before any element");
    PlyProperty property;
    std::string_view type = next_word();
    if (type == "list") {
      property.is_list = true;
      const std::string_view length = next_word();
      const auto length_type = type_of(length);
      if (!length_type || !is_whole(*length_type))
        return error(fmt::format("type of a list's length (got \"{}\", allowed whole number types)",
                                 printable(length)));
      property.length_type = *length_type;
      type = next_word();
    }
    const auto known = type_of(type);
    if (!known)
      return error(fmt::format(
          "unknown property type (got \"{}\", allowed char, uchar, short, ushort, int, uint, float, double)",
          printable(type)));
    property.type = *known;
    property.name = std::string(next_word());
    if (property.name.empty()) return error("the property has no name");
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  // In text a value takes at least a digit and a separator (which the last may lack).
  std::uint64_t least_bytes(const PlyElement& element) const {
    std::uint64_t sum = 0;
    for (const PlyProperty& p : element.properties)
      sum += header_.encoding == PlyEncoding::ascii ? 2 : byte_size(p.is_list ? p.length_type : p.type);
    return sum;
  }

  Expected<PlyHeader> check_counts() const {
    std::uint64_t left = bytes_.size() - header_.data_begin + 1;
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t each = std::max<std::uint64_t>(1, least_bytes(element));
      if (element.count > left / each)
        return error_in_line(
            element.line,
            fmt::format("more elements than the file has data for (got {}, allowed at most {})",
                        element.count, left / each),
            printable(element.name));
      left -= element.count * least_bytes(element);
    }
    return header_;
  }

  std::string_view bytes_;
  const std::string& file_;
  std::string_view words_;
  std::size_t at_ = 0;
  int line_ = 0;
  PlyHeader header_;
};

}  // namespace

std::size_t byte_size(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

Expected<PlyHeader> read_ply_header(std::string_view bytes, const std::string& file) {
  return HeaderReader(bytes, file).run();
}

}  // namespace gnomon

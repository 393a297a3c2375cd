#include "scene/files/mtl_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <optional>
#include <set>

#include "scene/files/obj_text.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

/// An option of a texture statement (Wavefront's "MTL material format", section "Options for texture map
/// statements"): how many words may follow, and how many of them must be numbers where they are there.
struct TextureOption {
  std::string_view name;
  int most;          ///< words
  bool are_numbers;  ///< then the words end where no number follows
};
constexpr std::array<TextureOption, 14> options{{{"-s", 3, true},
                                                 {"-o", 3, true},
                                                 {"-t", 3, true},
                                                 {"-mm", 2, true},
                                                 {"-bm", 1, true},
                                                 {"-boost", 1, true},
                                                 {"-texres", 1, true},
                                                 {"-clamp", 1, false},
                                                 {"-blendu", 1, false},
                                                 {"-blendv", 1, false},
                                                 {"-cc", 1, false},
                                                 {"-imfchan", 1, false},
                                                 {"-type", 1, false},
                                                 {"-colorspace", 1, false}}};

constexpr std::string_view blanks = " \t\r";

/// The next word, taken off the front.
std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// The words after an option; numbers that are missing get `otherwise`.
std::vector<std::string> arguments(const TextureOption& option, std::string_view& rest,
                                   const char* otherwise) {
  std::vector<std::string> words;
  while (static_cast<int>(words.size()) < option.most) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    if (word.empty() || (option.are_numbers && !parse_decimal(word))) break;
    words.emplace_back(word);
    rest = after;
  }
  while (option.are_numbers && static_cast<int>(words.size()) < option.most) words.emplace_back(otherwise);
  return words;
}

/// A statement after its key.
std::string plain_statement(std::string_view key, std::string_view rest, std::set<std::string>& unused) {
  std::string out(key);
  for (;;) {
    std::string_view after = rest;
    const std::string_view word = take_word(after);
    const TextureOption* option = nullptr;
    for (const TextureOption& known : options)
      if (known.name == word) option = &known;
    if (option == nullptr) break;
    rest = after;
    const auto words = arguments(*option, rest, word == "-s" ? "1" : "0");
    if (word == "-s" || word == "-o" || word == "-clamp") {
      out += fmt::format(" {}", word);
      for (const std::string& w : words) out += " " + w;
    } else if (word != "-blendu" && word != "-blendv" && word != "-bm" && word != "-texres") {
      unused.insert(fmt::format("{} {} of textures", key, word));
    }
  }
  return fmt::format("{} {}", out, without_blanks(rest));
}

/// Statements of numbers: how many, where one alone may stand for three.
struct NumberStatement {
  std::string_view key;
  std::size_t count;
};
constexpr std::array<NumberStatement, 8> number_statements{
    {{"Kd", 3}, {"Ks", 3}, {"Ke", 3}, {"Tf", 3}, {"Ns", 1}, {"Ni", 1}, {"d", 1}, {"Tr", 1}}};

/// Nothing: no statement of numbers.
const NumberStatement* number_statement(std::string_view key) {
  for (const NumberStatement& known : number_statements)
    if (known.key == key) return &known;
  return nullptr;
}

/// Rewrites a library line by line.
class MtlRewriter {
 public:
  /// `text` is what the file says with continued lines joined, `written` what stands in it.
  MtlRewriter(std::string_view text, std::string_view written, const std::string& file)
      : text_(text), written_(written), file_(file) {}

  Expected<std::string> run(std::vector<std::string>& notes) {
    for (std::size_t at = 0; at < text_.size() && !error_;) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at), text_.size());
      out_ += plain_line(text_.substr(at, end - at));
      out_ += '\n';
      at = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    }
    if (error_) return fail(std::move(*error_));
    for (const std::string& option : unused_)
      notes.push_back(fmt::format("The option {} is not used.", option));
    if (has_halo_)
      notes.emplace_back("The option d -halo is not used: as much is let through at every angle.");
    return std::move(out_);
  }

 private:
  std::string plain_line(std::string_view line) {
    std::string_view rest = line;
    const std::string_view key = take_word(rest);
    if (key == "map_Kd" || key == "map_d") return plain_statement(key, rest, unused_);
    if (key == "newmtl") return fmt::format("newmtl {}", without_blanks(rest));
    if (const NumberStatement* numbers = number_statement(key)) return plain_numbers(*numbers, rest);
    return std::string(line);
  }

  std::string plain_numbers(const NumberStatement& statement, std::string_view rest) {
    rest = rest.substr(0, rest.find('#'));
    std::string_view after = rest;
    const std::string_view first = take_word(after);
    if (statement.key == "d" && first == "-halo") has_halo_ = true, rest = after;
    if (first == "spectral" || first == "xyz") {
      unused_.insert(fmt::format("{} {}", statement.key, first));
      return {};
    }
    std::vector<std::string> numbers;
    while (numbers.size() < statement.count) {
      const std::string_view word = take_word(rest);
      if (word.empty()) break;
      if (!parse_decimal(word))
        fail_at(statement.key, word,
                fmt::format("not a finite number (got {}, allowed for example 0.8)", printable(word)));
      numbers.emplace_back(word);
    }
    if (numbers.size() == 1) numbers.resize(statement.count, numbers.front());
    if (numbers.size() < statement.count)
      fail_at(statement.key, rest,
              fmt::format("too few numbers (got {}, allowed 1 or {})", numbers.size(), statement.count));
    const bool full =
        statement.key == "Tr" && !numbers.empty() && parse_decimal(numbers.front()).value_or(0.0) == 1.0;
    return fmt::format("{} {}", full ? full_transparency : statement.key, fmt::join(numbers, " "));
  }

  void fail_at(std::string_view key, std::string_view where, std::string reason) {
    if (error_) return;
    const LineColumn at = line_column(written_, static_cast<std::size_t>(where.data() - text_.data()));
    error_ = Error{ErrorKind::bad_input, std::move(reason), file_, at.line, at.column, std::string(key)};
  }

  std::string_view text_, written_;
  const std::string& file_;
  std::string out_;
  std::set<std::string> unused_;
  bool has_halo_ = false;
  std::optional<Error> error_;
};

}  // namespace

Expected<std::string> plain_mtl(std::string_view text, const std::string& file,
                                std::vector<std::string>& notes) {
  text = without_byte_order_mark(text);
  const std::string joined = join_continued_lines(text);
  return MtlRewriter(joined, text, file).run(notes);
}

}  // namespace gnomon
